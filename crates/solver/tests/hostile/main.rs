//! Hostile meshes and positions at every public entry of the solver: a typed refusal that leaves everything as it was,
//! or a correct result; never a hang, a panic or a silent wrong answer.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

mod choices;
mod curves;

use ductile_solver::workload::{self, Workload};
use ductile_solver::{Budget, Fill, RingError, Rings, SolverError, SurfaceSolver, Weights, fill};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// What an entry has to do with positions.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expected {
    /// Work on them.
    Served,
    /// Refuse them.
    Refused,
}
use Expected::{Refused, Served};

fn bases() -> [(&'static str, Workload); 3] {
    let mut ball = workload::sphere(2);
    workload::pin_axes(&mut ball);
    [("disc", workload::disc(4)), ("ball", ball), ("strip", workload::moebius(24, 4, 0.3))]
}

fn hostile(shape: &Workload) -> Vec<(&'static str, Expected, Vec<DVec3>)> {
    let good = &shape.positions;
    let face = shape.triangles[shape.triangles.len() / 2].map(|node| node as usize);
    let with = |change: &dyn Fn(&mut Vec<DVec3>)| {
        let mut positions = good.clone();
        change(&mut positions);
        positions
    };
    vec![
        ("good", Served, good.clone()),
        ("zero-area face", Served, with(&|p| p[face[2]] = p[face[0]].midpoint(p[face[1]]))),
        ("duplicate vertex", Served, with(&|p| p[face[1]] = p[face[0]])),
        ("sliver", Served, with(&|p| p[face[2]] = p[face[0]].midpoint(p[face[1]]) + DVec3::splat(1e-12))),
        ("all equal", Served, vec![DVec3::ONE; good.len()]),
        ("a line", Served, good.iter().map(|p| DVec3::X * p.x).collect()),
        ("folded", Served, with(&|p| p.iter_mut().for_each(|p| p.x = p.x.abs()))),
        ("large", Served, good.iter().map(|p| *p * 1e40).collect()),
        ("small", Served, good.iter().map(|p| *p * 1e-40).collect()),
        ("huge", Refused, good.iter().map(|p| *p * 1e150).collect()),
        ("tiny", Refused, good.iter().map(|p| *p * 1e-150).collect()),
        ("NaN", Refused, with(&|p| p[face[0]] = DVec3::new(0.0, f64::NAN, 0.0))),
        ("infinite", Refused, with(&|p| p[face[0]] = DVec3::new(f64::NEG_INFINITY, 0.0, 0.0))),
    ]
}

fn bits(positions: &[DVec3]) -> Vec<[u64; 3]> {
    positions.iter().map(|p| p.to_array().map(f64::to_bits)).collect()
}

fn is_refusal(error: &SolverError) -> bool {
    matches!(error, SolverError::NotFinite(_) | SolverError::TooSmall)
}

#[test]
fn connectivity_that_is_no_surface_is_refused() {
    let ball = workload::sphere(1);
    let count = ball.positions.len();
    let outside = u32::try_from(count).unwrap();
    let with = |more: &[[u32; 3]]| [ball.triangles.clone(), more.to_vec()].concat();
    let [a, b, c] = ball.triangles[0];
    let from = |count, triangles: &[[u32; 3]]| Rings::from_triangles(count, triangles).unwrap_err();
    assert_eq!(from(count, &with(&[[a, b, outside]])), RingError::UnknownNode(outside));
    assert_eq!(from(count, &with(&[[a, b, u32::MAX]])), RingError::UnknownNode(u32::MAX));
    assert!(matches!(from(count + 1, &with(&[[a, b, outside]])), RingError::NotManifold(_)));
    assert!(matches!(from(count, &with(&[[a, a, b]])), RingError::DegenerateTriangle(_)));
    assert!(matches!(from(count, &with(&[[c, b, a]])), RingError::NotManifold(_)));
    assert!(matches!(from(count + 2, &with(&[[a, outside, outside + 1]])), RingError::NotManifold(_)));
    // A node of no triangle is taken as fixed, and a flipped face changes nothing but the sense of rings.
    let lone = Rings::from_triangles(count + 1, &ball.triangles).unwrap();
    let mut solver =
        SurfaceSolver::new(lone, vec![false; count + 1], ductile_solver::Settings::default()).unwrap();
    let mut positions = [ball.positions.clone(), vec![DVec3::splat(7.0)]].concat();
    solver.step(&mut positions, Budget::default()).unwrap();
    assert_eq!(positions[count], DVec3::splat(7.0));
    let energy = |triangles: Vec<[u32; 3]>| {
        let mut solver = Workload { triangles, ..ball.clone() }.solver().unwrap();
        solver.fit_all(&ball.positions);
        solver.energy()
    };
    let mut flipped = ball.triangles.clone();
    flipped[11].swap(1, 2);
    assert!((energy(flipped) / energy(ball.triangles.clone()) - 1.0).abs() < 1e-12);
    // Parts that a caller made up.
    let parts = Rings::from_parts(vec![0, 3, 2], vec![0, 1], vec![true; 2], vec![]);
    assert!(parts.is_err());
    assert!(Rings::from_parts(vec![], vec![], vec![], vec![]).is_err());
    assert!(Rings::from_parts(vec![0, 1], vec![0], vec![true], vec![]).is_err());
}

#[test]
fn a_surface_is_refused_untouched_or_served_without_harm() {
    for (base, shape) in bases() {
        let handle = u32::try_from(shape.fixed.iter().position(|fixed| *fixed).unwrap()).unwrap();
        for (name, expected, start) in hostile(&shape) {
            let says = format!("{base}, {name}");
            let mut solver = shape.solver().unwrap();
            let mut positions = start.clone();
            let size = start.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max).min(1e60);
            solver.fit_all(&positions);
            assert_eq!(solver.energy().is_nan(), expected == Refused, "{says}: {}", solver.energy());
            solver.evaluate(&positions);
            assert_eq!(solver.energy().is_nan(), expected == Refused, "{says}: {}", solver.energy());
            assert_eq!(solver.figures().len(), start.len());
            for round in 0..6 {
                let before = bits(&positions);
                let moved = solver.predict(&mut positions, &[(handle, DVec3::Z * (0.1 * size))]);
                match (expected, &moved) {
                    (Served, Ok(done)) => assert!((0.0..=1.0).contains(&done.fraction), "{says}: {done:?}"),
                    (Refused, Err(error)) if is_refusal(error) => {
                        assert_eq!(bits(&positions), before, "{says}")
                    }
                    _ => panic!("{says}, round {round}: {moved:?}"),
                }
                let before = bits(&positions);
                let step = solver.step(&mut positions, Budget::default());
                match (expected, &step) {
                    (Served, Ok(report)) => {
                        assert!(
                            report.energy.is_finite() && report.energy <= report.energy_before,
                            "{says}: {report:?}"
                        );
                        assert!(!report.damped || bits(&positions) == before, "{says}");
                    }
                    (Refused, Err(error)) if is_refusal(error) => {
                        assert_eq!(bits(&positions), before, "{says}")
                    }
                    _ => panic!("{says}, round {round}: {step:?}"),
                }
                let was_finite: Vec<bool> = positions.iter().map(|p| p.is_finite()).collect();
                solver.smooth(&mut positions, &vec![true; start.len()], 0.6);
                let is_kept = positions.iter().zip(&was_finite).all(|(p, was)| p.is_finite() || !was);
                assert!(
                    is_kept && (expected == Refused || positions.iter().all(|p| p.is_finite())),
                    "{says}"
                );
            }
            for node in 0..u32::try_from(start.len()).unwrap() {
                let place = solver.place_near(&positions, node, positions[0]);
                assert!(place.is_none_or(DVec3::is_finite), "{says}");
            }
        }
    }
}

#[test]
fn steps_scale_with_the_shape_to_the_bit() {
    // Powers of two scale without rounding, so that every number of a step is the same number, scaled.
    let run = |scale: f64| {
        let mut shape = workload::sphere(2);
        let pins = workload::pin_axes(&mut shape);
        let mut solver = shape.solver().unwrap();
        let mut positions: Vec<DVec3> = shape.positions.iter().map(|p| *p * scale).collect();
        let mut energies = Vec::new();
        for _ in 0..4 {
            solver.predict(&mut positions, &[(pins[0], DVec3::X * (0.1 * scale))]).unwrap();
            energies.push(solver.step(&mut positions, Budget::default()).unwrap().energy.to_bits());
        }
        (energies, positions.into_iter().map(|p| p / scale).collect::<Vec<_>>())
    };
    let at_one = run(1.0);
    for exponent in [-100, -30, 30, 100] {
        assert_eq!(run(libm::ldexp(1.0, exponent)), at_one, "2^{exponent}");
    }
}

#[test]
fn a_skin_is_refused_untouched_or_filled_with_numbers() {
    for (base, shape) in bases() {
        let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
        for (name, expected, start) in hostile(&shape) {
            for weights in [Weights::Uniform, Weights::Cotangent] {
                for kind in [Fill::Membrane, Fill::Plate] {
                    let says = format!("{base}, {name}, {weights:?}, {kind:?}");
                    let mut positions = start.clone();
                    match fill(&rings, &shape.fixed, &mut positions, weights, kind) {
                        Ok(()) => {
                            assert_eq!(expected, Served, "{says}");
                            assert!(positions.iter().all(|p| p.is_finite()), "{says}");
                            let kept = shape.fixed.iter().zip(positions.iter().zip(&start));
                            assert!(
                                kept.filter(|(fixed, _)| **fixed).all(|(_, (now, then))| now == then),
                                "{says}"
                            );
                        }
                        Err(error) => {
                            assert!(expected == Refused && is_refusal(&error), "{says}: {error}");
                            assert_eq!(bits(&positions), bits(&start), "{says}");
                        }
                    }
                }
            }
        }
    }
}
