//! Curves: the same positions for a curve by itself, under every objective, with prescribed directions, and in a network.

use super::*;
use ductile_solver::{
    CurveSettings, CurveSolver, Network, Objective, Spoke, Strand, resample, respace, respace_graded,
};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A wavy closed or open curve of so many nodes, every fourth of them fixed, and what may have become of it.
fn table() -> Vec<(&'static str, Expected, Vec<DVec3>)> {
    let node = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 16.0);
        DVec3::new(cos, sin, 0.2 * libm::sin(f64::from(3 * k)))
    };
    let good: Vec<DVec3> = (0..16).map(node).collect();
    let with = |change: &dyn Fn(&mut Vec<DVec3>)| {
        let mut positions = good.clone();
        change(&mut positions);
        positions
    };
    vec![
        ("good", Served, good.clone()),
        ("duplicate node", Served, with(&|p| p[6] = p[5])),
        ("duplicate controls", Served, with(&|p| p[4] = p[0])),
        ("a stretch without length", Served, with(&|p| (1..5).for_each(|k| p[k] = p[0]))),
        ("all equal", Served, vec![DVec3::ONE; 16]),
        ("a line", Served, good.iter().map(|p| DVec3::X * p.x).collect()),
        ("there and back", Served, with(&|p| (0..8).for_each(|k| p[15 - k] = p[k]))),
        ("large", Served, good.iter().map(|p| *p * 1e40).collect()),
        ("small", Served, good.iter().map(|p| *p * 1e-40).collect()),
        ("huge", Refused, good.iter().map(|p| *p * 1e150).collect()),
        ("tiny", Refused, good.iter().map(|p| *p * 1e-150).collect()),
        ("NaN", Refused, with(&|p| p[3].y = f64::NAN)),
        ("infinite", Refused, with(&|p| p[3].y = f64::INFINITY)),
    ]
}

#[test]
fn a_curve_is_refused_untouched_or_served_without_harm() {
    let fixed: Vec<bool> = (0..16).map(|k| k % 4 == 0 || k == 15).collect();
    for (name, expected, start) in table() {
        for closed in [false, true] {
            let says = format!("{name}, closed {closed}");
            let mut solver = CurveSolver::new(16, closed, fixed.clone(), CurveSettings::default()).unwrap();
            let mut positions = start.clone();
            let size = start.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max).min(1e60);
            for _ in 0..6 {
                let before = bits(&positions);
                let moved = solver.predict(&mut positions, &[(4, DVec3::Z * (0.1 * size))]);
                let step = solver.step(&mut positions);
                match (expected, &moved, &step) {
                    (Served, Ok(_), Ok(report)) => {
                        assert!(
                            report.energy.is_finite() && report.energy <= report.energy_before,
                            "{says}: {report:?}"
                        );
                        assert!(positions.iter().all(|p| p.is_finite()), "{says}");
                    }
                    (Refused, Err(one), Err(other)) if is_refusal(one) && is_refusal(other) => {
                        assert_eq!(bits(&positions), before, "{says}");
                    }
                    _ => panic!("{says}: {moved:?}, {step:?}"),
                }
            }
            for spacing in [0.1, 0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300] {
                let sampled = resample(&start, closed, &fixed, spacing, 2);
                match (expected, &sampled) {
                    (Served, Ok(sampled)) => {
                        assert!(sampled.positions.iter().all(|p| p.is_finite()), "{says}, {spacing}");
                        let kept = start.iter().zip(&fixed).filter(|(_, fixed)| **fixed).map(|(p, _)| *p);
                        let held = sampled.positions.iter().zip(&sampled.fixed).filter(|(_, fixed)| **fixed);
                        assert!(kept.eq(held.map(|(p, _)| *p)), "{says}, {spacing}");
                    }
                    (Refused, Err(error)) if is_refusal(error) => {}
                    _ => panic!("{says}, {spacing}: {:?}", sampled.map(|s| s.positions.len())),
                }
            }
            let mut positions = start.clone();
            match (expected, respace(&mut positions, closed, &fixed)) {
                (Served, Ok(())) => assert!(positions.iter().all(|p| p.is_finite()), "{says}"),
                (Refused, Err(error)) if is_refusal(&error) => {
                    assert_eq!(bits(&positions), bits(&start), "{says}")
                }
                (_, other) => panic!("{says}: {other:?}"),
            }
        }
    }
}

#[test]
fn curves_of_hardly_any_nodes_are_harmless() {
    for count in 0..4 {
        for closed in [false, true] {
            for fixed in [false, true] {
                let mut solver =
                    CurveSolver::new(count, closed, vec![fixed; count], CurveSettings::default()).unwrap();
                let mut positions: Vec<DVec3> = (0..count).map(|k| DVec3::X * k as f64).collect();
                for _ in 0..3 {
                    assert!(solver.step(&mut positions).unwrap().energy.is_finite());
                }
                assert!(positions.iter().all(|p| p.is_finite()));
                respace(&mut positions, closed, &vec![fixed; count]).unwrap();
                resample(&positions, closed, &vec![fixed; count], 0.1, 1).unwrap();
            }
        }
    }
    let wrong = CurveSolver::new(3, true, vec![true; 2], CurveSettings::default());
    assert_eq!(wrong.unwrap_err(), SolverError::Length { expected: 3, found: 2 });
}

const ALL: [Objective; 4] = [Objective::ThinPlate, Objective::Fair, Objective::Neutral, Objective::Membrane];

#[test]
fn every_objective_and_any_directions_are_served_or_refused() {
    let fixed: Vec<bool> = (0..16).map(|k| k % 4 == 0 || k == 15).collect();
    // Across the curve, along it, against it; neighbours that contradict each other; of lengths without sense.
    let directions = [
        vec![],
        vec![(0, DVec3::Z), (4, DVec3::X * 1e-200), (8, DVec3::NEG_Z * 1e200), (12, DVec3::ONE)],
        vec![(0, DVec3::Y), (4, DVec3::Y), (8, DVec3::Y), (12, DVec3::Y), (15, DVec3::NEG_Y)],
    ];
    for (name, expected, start) in table() {
        for (objective, given) in ALL.into_iter().flat_map(|one| directions.iter().map(move |d| (one, d))) {
            for closed in [false, true] {
                let says = format!("{name}, {objective:?}, closed {closed}, {given:?}");
                let mut settings = CurveSettings::default();
                settings.objective = objective;
                let mut solver = CurveSolver::new(16, closed, fixed.clone(), settings).unwrap();
                solver.set_tangents(given).unwrap_or_else(|e| panic!("{says}: {e}"));
                let mut positions = start.clone();
                let size = start.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max).min(1e60);
                for _ in 0..4 {
                    let before = bits(&positions);
                    let moved = solver.predict(&mut positions, &[(4, DVec3::Z * (0.1 * size))]);
                    let step = solver.step(&mut positions);
                    match (expected, &moved, &step) {
                        (Served, Ok(_), Ok(report)) => {
                            let falls =
                                objective == Objective::Neutral || report.energy <= report.energy_before;
                            assert!(report.energy.is_finite() && falls, "{says}: {report:?}");
                            assert!(positions.iter().all(|p| p.is_finite()), "{says}");
                        }
                        (Refused, Err(one), Err(other)) if is_refusal(one) && is_refusal(other) => {
                            assert_eq!(bits(&positions), before, "{says}");
                        }
                        _ => panic!("{says}: {moved:?}, {step:?}"),
                    }
                }
                assert!(expected == Refused || solver.tangents().iter().all(|t| t.is_finite()), "{says}");
            }
        }
    }
    let mut solver = CurveSolver::new(16, true, fixed, CurveSettings::default()).unwrap();
    for nonsense in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
        assert_eq!(solver.set_tangents(&[(0, nonsense)]), Err(SolverError::NotFinite(0)), "{nonsense}");
    }
    assert_eq!(solver.set_tangents(&[(1, DVec3::X)]), Err(SolverError::NotFixed(1)));
    assert_eq!(solver.set_tangents(&[(16, DVec3::X)]), Err(SolverError::UnknownNode(16)));
}

#[test]
fn graded_samples_are_spread_or_refused_untouched() {
    let fixed: Vec<bool> = (0..16).map(|k| k % 4 == 0 || k == 15).collect();
    let even = vec![0.1; 16];
    let steep: Vec<f64> = (0..16).map(|k| if k % 2 == 0 { 1e-300 } else { 1e300 }).collect();
    for (name, expected, start) in table() {
        for (closed, wanted) in [(false, &even), (true, &even), (false, &steep), (true, &steep)] {
            let says = format!("{name}, closed {closed}, {}", wanted[0]);
            let mut positions = start.clone();
            match (expected, respace_graded(&mut positions, closed, &fixed, wanted)) {
                (Served, Ok(())) => {
                    assert!(positions.iter().all(|p| p.is_finite()), "{says}");
                    let held = (0..16).filter(|k| fixed[*k]).all(|k| positions[k] == start[k]);
                    assert!(held, "{says}");
                }
                (Refused, Err(error)) if is_refusal(&error) => {
                    assert_eq!(bits(&positions), bits(&start), "{says}");
                }
                (_, other) => panic!("{says}: {other:?}"),
            }
            for nonsense in [0.0, -1.0, f64::NAN, f64::INFINITY] {
                let mut wanted = wanted.clone();
                wanted[7] = nonsense;
                let refused = respace_graded(&mut positions, closed, &fixed, &wanted);
                assert!(refused.is_err_and(|e| is_refusal(&e)), "{says}, {nonsense}");
            }
            let short = respace_graded(&mut positions, closed, &fixed, &wanted[1..]);
            assert_eq!(short, Err(SolverError::Length { expected: 16, found: 15 }), "{says}");
        }
    }
}

#[test]
fn a_network_with_a_bad_strand_is_refused_whole_or_served_without_harm() {
    let fixed: Vec<bool> = (0..16).map(|k| k % 4 == 0 || k == 15).collect();
    let hub: Vec<Spoke> = (0..3).map(|curve| Spoke { curve, node: 4 }).collect();
    let good = table().swap_remove(0).2;
    for (name, expected, start) in table() {
        for (objective, plane) in [
            (Objective::ThinPlate, None),
            (Objective::Fair, None),
            (Objective::ThinPlate, Some(DVec3::Z)),
            (Objective::ThinPlate, Some(DVec3::X * 1e-200)),
        ] {
            let says = format!("{name}, {objective:?}, {plane:?}");
            let mut settings = CurveSettings::default();
            settings.objective = objective;
            let new = || CurveSolver::new(16, false, fixed.clone(), settings).unwrap();
            let mut solvers = [new(), new(), new()];
            // One strand of the table between two that are good, turned so that all three meet in one point.
            let turned = |k: f64| -> Vec<DVec3> {
                let turn = glam::DQuat::from_rotation_x(k);
                good.iter().map(|p| good[4] + turn * (*p - good[4])).collect()
            };
            let mut places = [turned(1.0), start.clone(), turned(2.0)];
            let mut network = Network::with_planes(&[(hub.clone(), plane)]).unwrap();
            for _ in 0..4 {
                let before: Vec<_> = places.iter().map(|p| bits(p)).collect();
                let mut strands: Vec<Strand<'_>> = solvers
                    .iter_mut()
                    .zip(&mut places)
                    .map(|(solver, positions)| Strand { solver, positions })
                    .collect();
                let step = network.step(&mut strands);
                match (expected, &step) {
                    (Served, Ok(report)) => {
                        let falls = report.energy <= report.energy_before;
                        assert!(report.energy.is_finite() && falls, "{says}: {report:?}");
                        assert!(places.iter().flatten().all(|p| p.is_finite()), "{says}");
                        assert!(network.normals().iter().all(|n| n.is_finite()), "{says}");
                    }
                    (Refused, Err(error)) if is_refusal(error) => {
                        let after: Vec<_> = places.iter().map(|p| bits(p)).collect();
                        assert_eq!(after, before, "{says}");
                    }
                    _ => panic!("{says}: {step:?}"),
                }
            }
        }
    }
}
