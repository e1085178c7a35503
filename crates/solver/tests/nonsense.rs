//! Whatever a pointer sends, positions stay finite: property tests over NaN, infinities and huge numbers.
#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use ductile_solver::{Budget, SolverError, SurfaceSolver, workload};
use glam::DVec3;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        6 => -2.0..2.0,
        1 => Just(f64::NAN),
        1 => Just(f64::INFINITY),
        1 => Just(f64::NEG_INFINITY),
        1 => Just(1e300),
        1 => Just(-1e49),
        1 => Just(1e20),
        1 => Just(1e-300),
        1 => Just(0.0),
    ]
}

fn vector() -> impl Strategy<Value = DVec3> {
    (number(), number(), number()).prop_map(|(x, y, z)| DVec3::new(x, y, z))
}

fn shape() -> (SurfaceSolver, Vec<DVec3>, [u32; 6]) {
    let mut sphere = workload::sphere(1);
    let pins = workload::pin_axes(&mut sphere);
    (sphere.solver().unwrap(), sphere.positions, pins)
}

/// In the browser there are fewer random cases, the same ones in every run, and no file in which to keep a failure.
fn cases() -> ProptestConfig {
    if cfg!(target_arch = "wasm32") {
        let rng_seed = RngSeed::Fixed(1995);
        ProptestConfig { cases: 32, rng_seed, failure_persistence: None, ..ProptestConfig::default() }
    } else {
        ProptestConfig::with_cases(64)
    }
}

proptest! {
    #![proptest_config(cases())]

    #[test]
    fn drags_keep_positions_finite(drags in prop::collection::vec((0_usize..6, vector()), 1..12)) {
        let (mut solver, mut positions, pins) = shape();
        for (pin, displacement) in drags {
            let before = positions.clone();
            match solver.predict(&mut positions, &[(pins[pin], displacement)]) {
                Ok(done) => prop_assert!((0.0..=1.0).contains(&done.fraction)),
                Err(SolverError::NotFinite(node)) => {
                    prop_assert_eq!(node, pins[pin]);
                    prop_assert_eq!(&before, &positions);
                }
                Err(other) => prop_assert!(false, "{}", other),
            }
            let before = positions.clone();
            let report = solver.step(&mut positions, Budget::default()).unwrap();
            prop_assert!(report.energy <= report.energy_before);
            prop_assert!(!report.damped || before == positions);
            prop_assert!(positions.iter().all(|p| p.is_finite()));
        }
    }

    #[test]
    fn positions_are_refused_or_kept_finite(node in 0_usize..42, position in vector()) {
        let (mut solver, mut positions, _) = shape();
        positions[node] = position;
        let before = positions.clone();
        match solver.step(&mut positions, Budget::default()) {
            Ok(report) => {
                prop_assert!(report.energy <= report.energy_before);
                prop_assert!(positions.iter().all(|p| p.is_finite()));
            }
            Err(SolverError::NotFinite(refused)) => {
                prop_assert_eq!(refused as usize, node);
                let unchanged = before.iter().zip(&positions)
                    .all(|(a, b)| a.to_array().map(f64::to_bits) == b.to_array().map(f64::to_bits));
                prop_assert!(unchanged);
            }
            Err(other) => prop_assert!(false, "{}", other),
        }
    }
}

#[test]
fn wrong_lengths_and_names_are_refused() {
    let (mut solver, mut positions, pins) = shape();
    positions.pop();
    let expected = SolverError::Length { expected: 42, found: 41 };
    assert_eq!(solver.step(&mut positions, Budget::default()), Err(expected));
    positions.push(DVec3::X);
    assert_eq!(solver.set_fixed(vec![]), Err(SolverError::Length { expected: 42, found: 0 }));
    assert_eq!(solver.predict(&mut positions, &[(42, DVec3::X)]), Err(SolverError::UnknownNode(42)));
    let free = (0..42).find(|node| !pins.contains(node)).unwrap();
    assert_eq!(solver.predict(&mut positions, &[(free, DVec3::X)]), Err(SolverError::NotFixed(free)));
}
