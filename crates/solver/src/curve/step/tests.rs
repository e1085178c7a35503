use super::*;
use crate::CurveSettings;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A wave between two points, with an inner one.
fn wave(count: usize) -> (CurveSolver, Vec<DVec3>) {
    let at = |i: usize| DVec3::new(i as f64, libm::sin(i as f64), 0.3 * libm::cos(0.7 * i as f64));
    let fixed = (0..count).map(|i| i % (count / 2) == 0).collect();
    let solver = CurveSolver::new(count, false, fixed, CurveSettings::default()).unwrap();
    (solver, (0..count).map(at).collect())
}

#[test]
fn a_curve_that_is_led_uphill_gives_up_after_twenty_halvings_and_damps_the_next_step() {
    let (mut solver, mut positions) = wave(21);
    solver.measure(&positions);
    solver.frames.transport(solver.chain, &solver.bends);
    let down = solver.direction(&positions, Objective::ThinPlate).unwrap();
    // The same way backwards, with the promise of a fall.
    let moves: Vec<DVec3> = down.moves.iter().map(|offset| -*offset).collect();
    let uphill = Direction { moves, slope: down.slope, by_pull: false };
    assert!(solver.search(&positions, &uphill).is_none());
    // The last trial was the twentieth half of the first.
    let first = solver.first_scale(&uphill.moves);
    let last = first / f64::from(1_u32 << MAX_HALVINGS);
    for (trial, (at, offset)) in solver.trial_positions.iter().zip(positions.iter().zip(&uphill.moves)) {
        assert_eq!(*trial, *at + *offset * last);
    }
    let largest = |direction: &Direction| direction.moves.iter().map(|m| m.length()).fold(0.0, f64::max);
    let mut report = StepReport::default();
    for expected in [10.0, 100.0, 1000.0] {
        solver.damp(&mut report);
        assert!(report.damped && solver.damping == expected);
    }
    (0..10).for_each(|_| solver.damp(&mut report));
    assert_eq!(solver.damping, 1e8);
    // What is damped is shorter, still leads downhill, and a step that succeeds lowers the damping again.
    let damped = solver.direction(&positions, Objective::ThinPlate).unwrap();
    assert!(largest(&damped) < 0.5 * largest(&down) && damped.slope < 0.0);
    let report = solver.step(&mut positions).unwrap();
    assert!(report.step_scale > 0.0 && report.energy < report.energy_before);
    assert_eq!(solver.damping, 2e7);
    for _ in 0..40 {
        solver.step(&mut positions).unwrap();
    }
    assert_eq!(solver.damping, 1.0);
}

/// Far from the origin places are so coarse that a line cannot be made straight.
#[test]
fn a_step_that_finds_nothing_is_damped_and_moves_nothing() {
    let count = 21;
    let along = DVec3::new(0.3, 0.7, 0.5);
    let mut positions: Vec<DVec3> = (0..count).map(|i| DVec3::splat(1e9) + along * i as f64).collect();
    let fixed = (0..count).map(|i| i % 20 == 0).collect();
    let mut solver = CurveSolver::new(count, false, fixed, CurveSettings::default()).unwrap();
    for _ in 0..20 {
        let (before, damping) = (positions.clone(), solver.damping);
        let report = solver.step(&mut positions).unwrap();
        if report.step_scale == 0.0 {
            assert!(report.damped && solver.damping == 10.0 * damping);
            assert_eq!((positions, report.energy), (before, report.energy_before));
            return;
        }
    }
    panic!("every step found something");
}
