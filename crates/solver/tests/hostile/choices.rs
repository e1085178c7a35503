//! The same hostile positions under everything that the page chooses: bending sampled inside held rims, every objective and
//! mixtures of them, prescribed tangent planes, and bays that fall asleep.

use super::*;
use ductile_solver::{Objective, Objectives, Sampling, Settings};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const ALL: [Objective; 4] = [Objective::ThinPlate, Objective::Fair, Objective::Neutral, Objective::Membrane];

/// Set up as the modeler does, except that bays may sleep however small they are.
fn as_in_the_page(shape: &Workload) -> SurfaceSolver {
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
    let mut settings = Settings::default();
    settings.sampling = Sampling::Inside;
    settings.least_asleep = 1;
    SurfaceSolver::new(rings, shape.fixed.clone(), settings).unwrap()
}

/// Each objective by itself, and all of them side by side.
fn objectives(shape: &Workload) -> Vec<(String, Objectives)> {
    let mixed = (0..shape.triangles.len()).map(|k| ALL[k * 8 / shape.triangles.len() % 4]).collect();
    let alone = ALL.map(|what| (format!("{what:?}"), Objectives::uniform(what, 1.0)));
    alone.into_iter().chain([("mixed".to_owned(), Objectives::by_triangle(mixed, 1.0))]).collect()
}

/// Shapes of the table, and one of several bays, so that some can fall asleep.
fn shapes() -> Vec<(&'static str, Workload)> {
    bases().into_iter().chain([("bays", workload::tube_of_bays(8, 4, 3))]).collect()
}

/// One frame of a drag on positions that harm nobody: it comes to numbers, and goes up only where nothing could fall.
fn serves(says: &str, solver: &mut SurfaceSolver, positions: &mut [DVec3], hand: (u32, DVec3), falls: bool) {
    let start = positions.to_vec();
    let moved = solver.predict(positions, &[hand]).unwrap_or_else(|e| panic!("{says}: {e}"));
    assert!((0.0..=1.0).contains(&moved.fraction), "{says}: {moved:?}");
    let before = bits(positions);
    let report = solver.step(positions, Budget::default()).unwrap_or_else(|e| panic!("{says}: {e}"));
    assert!(report.energy.is_finite(), "{says}: {report:?}");
    assert!(!falls || report.energy <= report.energy_before, "{says}: {report:?}");
    assert!(!report.damped || bits(positions) == before, "{says}");
    assert!(positions.iter().all(|p| p.is_finite()), "{says}");
    solver.doze(&start, positions).unwrap_or_else(|e| panic!("{says}: {e}"));
}

/// The same on positions that are none: each entry says so, and leaves them alone.
fn refuses(says: &str, solver: &mut SurfaceSolver, positions: &mut [DVec3], hand: (u32, DVec3)) {
    let before = bits(positions);
    let moved = solver.predict(positions, &[hand]);
    assert!(moved.as_ref().is_err_and(is_refusal), "{says}: {moved:?}");
    let step = solver.step(positions, Budget::default());
    assert!(step.as_ref().is_err_and(is_refusal), "{says}: {step:?}");
    assert_eq!(bits(positions), before, "{says}");
    let start = positions.to_vec();
    // Nothing can be told from such fits; nobody may sleep on them.
    if solver.doze(&start, positions).is_ok() {
        assert_eq!(solver.asleep(), 0, "{says}");
    }
}

#[test]
fn every_objective_is_served_or_refused_under_the_settings_of_the_page() {
    let mut slept = 0;
    for (base, shape) in shapes() {
        let handle = u32::try_from(shape.fixed.iter().position(|fixed| *fixed).unwrap()).unwrap();
        for (name, expected, start) in hostile(&shape) {
            for (what, objectives) in objectives(&shape) {
                let says = format!("{base}, {name}, {what}");
                let falls = what != "Neutral" && what != "mixed";
                let mut solver = as_in_the_page(&shape);
                solver.set_objectives(objectives).unwrap();
                let mut positions = start.clone();
                let size = start.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max).min(1e60);
                for round in 0..4 {
                    // First hardly at all, so that bays fall asleep, then far.
                    let by = DVec3::Z * (size * if round < 2 { 1e-6 } else { 0.1 });
                    match expected {
                        Served => serves(&says, &mut solver, &mut positions, (handle, by), falls),
                        Refused => refuses(&says, &mut solver, &mut positions, (handle, by)),
                    }
                    slept += solver.asleep();
                    solver.smooth(&mut positions, &vec![true; start.len()], 0.6);
                    assert!(expected == Refused || positions.iter().all(|p| p.is_finite()), "{says}");
                }
                assert_eq!(solver.figures().len(), start.len());
            }
        }
    }
    assert!(slept > 0, "no bay ever slept");
}

#[test]
fn prescribed_planes_are_served_or_refused_on_any_positions() {
    for (base, shape) in bases() {
        let fixed: Vec<u32> =
            (0_u32..).zip(&shape.fixed).filter(|(_, is)| **is).map(|(node, _)| node).collect();
        let handle = fixed[0];
        // Planes that agree, planes against each other at neighbours, and one straight against the surface's.
        let alike: Vec<(u32, DVec3)> = fixed.iter().map(|node| (*node, DVec3::Z)).collect();
        let turns = [DVec3::X, DVec3::NEG_X * 1e-200, DVec3::Y * 1e40, DVec3::NEG_Z];
        let against: Vec<(u32, DVec3)> =
            fixed.iter().zip(turns.iter().cycle()).map(|(n, t)| (*n, *t)).collect();
        for (name, expected, start) in hostile(&shape) {
            for (what, objectives) in objectives(&shape) {
                for (how, planes) in [("alike", &alike), ("against", &against)] {
                    let says = format!("{base}, {name}, {what}, planes {how}");
                    let mut solver = as_in_the_page(&shape);
                    solver.set_objectives(objectives.clone()).unwrap();
                    solver.set_normals(planes).unwrap_or_else(|e| panic!("{says}: {e}"));
                    let mut positions = start.clone();
                    let size = start.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max).min(1e60);
                    for _ in 0..3 {
                        let hand = (handle, DVec3::Z * (0.1 * size));
                        match expected {
                            // A plane that turns is a control that moves: the energy belongs to where it is.
                            Served => serves(&says, &mut solver, &mut positions, hand, false),
                            Refused => refuses(&says, &mut solver, &mut positions, hand),
                        }
                    }
                    assert!(solver.turning().is_finite(), "{says}");
                }
            }
        }
        let mut solver = as_in_the_page(&shape);
        for nonsense in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY] {
            assert!(solver.set_normals(&[(handle, nonsense)]).is_err(), "{base}: {nonsense}");
        }
        assert_eq!(solver.set_normals(&[(u32::MAX, DVec3::X)]), Err(SolverError::UnknownNode(u32::MAX)));
    }
}

#[test]
fn frames_of_the_wrong_length_put_nobody_to_sleep() {
    let shape = workload::tube_of_bays(8, 4, 3);
    let mut solver = as_in_the_page(&shape);
    let mut positions = shape.positions.clone();
    solver.step(&mut positions, Budget::default()).unwrap();
    for (before, after) in [(&positions[1..], &positions[..]), (&positions[..], &positions[1..])] {
        assert!(matches!(solver.doze(before, after), Err(SolverError::Length { .. })));
        assert_eq!(solver.asleep(), 0);
    }
}
