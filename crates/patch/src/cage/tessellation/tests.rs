//! The tables give what evaluation gives; updates leave nothing behind; the result is a closed mesh.

use super::*;
use crate::cage::{Blend, Boundary, Cage, Map, Settings, Split, primitive};
use proptest::prelude::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Every vertex a little elsewhere, so that no symmetry hides an exchange.
fn irregular(cage: &Cage) -> Cage {
    let shift = |(k, p): (usize, &DVec3)| {
        let k = k as f64;
        *p + DVec3::new(libm::sin(3.0 * k), libm::sin(5.0 * k + 1.0), libm::cos(7.0 * k)) * 0.05
    };
    Cage::new(cage.positions().iter().enumerate().map(shift).collect(), cage.faces().to_vec()).unwrap()
}

fn family() -> [Cage; 7] {
    [
        primitive::cube(1.0).unwrap(),
        primitive::icosahedron(1.0).unwrap(),
        primitive::torus(3.0, 1.0, 6, 5).unwrap(),
        primitive::trebol(2.0).unwrap(),
        primitive::grid(1.0, 4, 3).unwrap(),
        primitive::grid(1.0, 1, 1).unwrap(),
        primitive::disc(2.0, 7).unwrap(),
    ]
    .map(|cage| irregular(&cage))
}

fn surface(cage: &Cage, map: Map, blend: Blend) -> CageSurface {
    let settings = Settings { map, blend, split: cage.split_needed(), boundary: Boundary::Borrow };
    CageSurface::new(cage, settings).unwrap()
}

/// The sample at every node of every quad, as evaluation has it and as the tables have it.
fn worst(surface: &CageSurface, tessellation: &Tessellation) -> (f64, f64) {
    let steps = tessellation.resolution();
    let layout = Layout::new(surface, steps);
    let mut worst = (0.0_f64, 0.0_f64);
    for (quad, &corners) in surface.quads().iter().enumerate() {
        for (p, q) in (0..=steps).flat_map(|p| (0..=steps).map(move |q| (p, q))) {
            let exact = surface.evaluate(quad, p as f64 / steps as f64, q as f64 / steps as f64).unwrap();
            let sample = layout.sample(corners, quad, p, q) as usize;
            worst.0 = worst.0.max(exact.point.distance(tessellation.positions()[sample]));
            worst.1 = worst.1.max(exact.normal.unwrap().distance(tessellation.normals()[sample]));
        }
    }
    worst
}

#[test]
fn tables_give_what_evaluation_gives() {
    for (number, cage) in family().iter().enumerate() {
        for (map, blend) in [(Map::Smooth, Blend::Erbs), (Map::Rational, Blend::default())] {
            let surface = surface(cage, map, blend);
            for resolution in [1, 2, 3, 6] {
                let tessellation = Tessellation::new(&surface, resolution).unwrap();
                let (off, turned) = worst(&surface, &tessellation);
                assert!(off < 1e-13 && turned < 1e-12, "cage {number}, {resolution}: {off:e} {turned:e}");
            }
        }
    }
}

/// Every edge of the triangles is shared by two, in opposite directions, except along a boundary.
#[test]
fn the_result_is_watertight() {
    for cage in family() {
        let surface = surface(&cage, Map::Smooth, Blend::default());
        for resolution in [1, 4] {
            let tessellation = Tessellation::new(&surface, resolution).unwrap();
            let triangles: Vec<Vec<u32>> = tessellation.triangles().iter().map(|t| t.to_vec()).collect();
            let mesh = Cage::new(tessellation.positions().to_vec(), triangles).unwrap();
            assert_eq!(mesh.is_closed(), cage.is_closed());
            assert_eq!(mesh.euler_characteristic(), cage.euler_characteristic());
            assert!(
                (0..mesh.positions().len()).all(|sample| mesh.valence(sample) > 0),
                "no sample is unused"
            );
        }
    }
}

#[test]
fn quads_that_look_alike_share_a_table() {
    let torus = surface(&primitive::torus(3.0, 1.0, 12, 8).unwrap(), Map::Smooth, Blend::default());
    assert_eq!(Tessellation::new(&torus, 4).unwrap().fixed.patterns.len(), 1);
    let grid = surface(&primitive::grid(1.0, 9, 9).unwrap(), Map::Smooth, Blend::default());
    assert!(Tessellation::new(&grid, 4).unwrap().fixed.patterns.len() <= 25);
}

/// A side lies in the local surfaces of its two ends, a corner in its own; only the inside is blended from all four.
#[test]
fn what_lies_across_does_not_enter_a_side() {
    let torus = surface(&primitive::torus(3.0, 1.0, 12, 8).unwrap(), Map::Smooth, Blend::default());
    let tessellation = Tessellation::new(&torus, 4).unwrap();
    let pattern = &tessellation.fixed.patterns[0];
    let entering: Vec<usize> = (0..9).map(|block| pattern.block(block).slots.len()).collect();
    assert_eq!(entering, [16, 12, 12, 12, 12, 5, 5, 5, 5]);
}

#[test]
fn senseless_sizes_are_refused() {
    let cube = surface(&primitive::cube(1.0).unwrap(), Map::Smooth, Blend::default());
    assert_eq!(Tessellation::new(&cube, 0).unwrap_err(), CageError::Resolution(0));
    assert_eq!(Tessellation::new(&cube, 257).unwrap_err(), CageError::Resolution(257));
    let many = surface(&primitive::grid(1.0, 40, 40).unwrap(), Map::Smooth, Blend::default());
    assert!(matches!(Tessellation::new(&many, 256), Err(CageError::TooLarge(_))));
    let wheel = surface(&primitive::disc(1.0, 200).unwrap(), Map::Smooth, Blend::default());
    assert!(matches!(Tessellation::new(&wheel, 256), Err(CageError::TooLarge(_))));
}

/// A vertex that no face uses has no sample and disturbs nothing.
#[test]
fn unused_vertices_have_no_samples() {
    let cube = primitive::cube(1.0).unwrap();
    let mut positions = vec![DVec3::splat(9.0)];
    positions.extend(cube.positions());
    let faces = cube.faces().iter().map(|face| face.iter().map(|v| v + 1).collect()).collect();
    let spare = surface(&Cage::new(positions, faces).unwrap(), Map::Smooth, Blend::default());
    let with = Tessellation::new(&spare, 3).unwrap();
    let without = Tessellation::new(&surface(&cube, Map::Smooth, Blend::default()), 3).unwrap();
    assert_eq!(with.positions(), without.positions());
    assert_eq!(with.triangles(), without.triangles());
}

proptest! {
    #![proptest_config(ProptestConfig { cases: if cfg!(target_arch = "wasm32") { 8 } else { 64 }, ..Default::default() })]

    /// To the bit what a new evaluation would give, and less work for a vertex of a larger cage.
    #[test]
    fn an_update_leaves_nothing_behind(
        which in 0_usize..7,
        vertex in any::<prop::sample::Index>(),
        by in prop::array::uniform3(-0.3..0.3),
        split in prop_oneof![Just(Split::Linear), Just(Split::Offset), Just(Split::CatmullClark)],
    ) {
        let cage = &family()[which];
        let settings = Settings { split, ..Settings::default() };
        let mut surface = CageSurface::new(cage, settings).unwrap();
        let mut tessellation = Tessellation::new(&surface, 3).unwrap();
        let mut positions = cage.positions().to_vec();
        positions[vertex.index(cage.positions().len())] += DVec3::from(by);
        let moved = surface.move_to(&positions).unwrap();
        let evaluated = tessellation.update(surface.positions(), &moved);
        let anew = Tessellation::new(&surface, 3).unwrap();
        prop_assert_eq!(tessellation.positions(), anew.positions());
        prop_assert_eq!(tessellation.normals(), anew.normals());
        prop_assert!(evaluated > 0 && evaluated <= anew.positions().len());
    }
}

/// In a regular cage one vertex enters four by four quads.
#[test]
fn one_vertex_touches_sixteen_quads() {
    let cage = primitive::torus(3.0, 1.0, 12, 10).unwrap();
    let mut surface = surface(&cage, Map::Smooth, Blend::default());
    let mut tessellation = Tessellation::new(&surface, 4).unwrap();
    let mut positions = cage.positions().to_vec();
    positions[17].z += 0.1;
    let moved = surface.move_to(&positions).unwrap();
    assert_eq!(moved, [17]);
    let evaluated = tessellation.update(surface.positions(), &moved);
    assert!((16 * 9..=16 * 25).contains(&evaluated), "{evaluated}");
    assert_eq!(tessellation.update(surface.positions(), &[]), 0);
}
