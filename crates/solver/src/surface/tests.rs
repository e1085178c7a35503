use super::*;
use crate::workload::{self, Stream, Workload};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Steps the same shape with its rings as found and with some of them turned round.
fn compare_under_reversal(shape: &Workload, seed: u64, tolerance: f64) {
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
    let mut stream = Stream::new(seed);
    let reversed: Vec<bool> = (0..rings.len()).map(|_| stream.unit() < 0.5).collect();
    let mut runs = [rings.clone(), rings.with_reversed(&reversed)].map(|rings| {
        let solver = SurfaceSolver::new(rings, shape.fixed.clone(), Settings::default()).unwrap();
        (solver, shape.positions.clone())
    });
    for _ in 0..6 {
        let reports = runs.each_mut().map(|(solver, positions)| {
            solver.predict(positions, &[(0, DVec3::new(0.01, 0.0, 0.02))]).unwrap();
            solver.step(positions, Budget::default()).unwrap()
        });
        assert!((reports[0].energy / reports[1].energy - 1.0).abs() < tolerance, "{reports:?}");
        let [(_, one), (_, other)] = &runs;
        let worst = one.iter().zip(other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(worst < tolerance, "{worst}");
    }
    let gradients = runs.each_mut().map(|(solver, _)| solver.gradient().to_vec());
    let scale = gradients[0].iter().map(|g| g.length()).fold(1.0, f64::max);
    assert!(gradients[0].iter().zip(&gradients[1]).all(|(a, b)| a.distance(*b) < 10.0 * tolerance * scale));
}

#[test]
fn nothing_depends_on_the_sense_of_a_ring() {
    let mut stream = Stream::new(21);
    let mut shake = |mut shape: Workload, amount: f64| {
        for position in &mut shape.positions {
            *position += amount * stream.vector();
        }
        shape
    };
    for seed in 0..3 {
        compare_under_reversal(&shake(workload::disc(5), 0.02), seed, 1e-8);
        compare_under_reversal(&shake(workload::moebius(40, 4, 0.4), 0.01), seed, 1e-8);
        compare_under_reversal(&shake(octahedron(), 0.05), seed, 1e-8);
    }
}

/// Degree 4 everywhere: every fit is filtered.
fn octahedron() -> Workload {
    let triangles =
        vec![[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [1, 0, 5], [2, 1, 5], [3, 2, 5], [0, 3, 5]];
    let positions = vec![DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    Workload { positions, triangles, fixed: vec![true, false, false, false, false, false] }
}
