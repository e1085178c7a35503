//! Prescribed tangents: met, fair on both sides, sound from any start.

use glam::DVec3;

use crate::workload::Stream;
use crate::{CurveSettings, CurveSolver, Objective, SolverError, StepReport};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const PI: f64 = std::f64::consts::PI;
const BENDING: [Objective; 3] = [Objective::ThinPlate, Objective::Fair, Objective::Neutral];

/// An open curve along x from 0 to `spans`, with a control point at every whole number.
fn line(objective: Objective, spans: usize, edges: usize) -> (CurveSolver, Vec<DVec3>) {
    let count = spans * edges + 1;
    let fixed = (0..count).map(|i| i.is_multiple_of(edges)).collect();
    let settings = CurveSettings { objective, ..CurveSettings::default() };
    let positions = (0..count).map(|i| DVec3::X * (i as f64 / edges as f64)).collect();
    (CurveSolver::new(count, false, fixed, settings).unwrap(), positions)
}

/// Steps and even spacing in turn, as the modeler does it.
fn relax(solver: &mut CurveSolver, positions: &mut [DVec3], limit: usize) -> Vec<StepReport> {
    let fixed = solver.fixed.clone();
    let mut reports: Vec<StepReport> = Vec::new();
    while reports.len() < limit && !reports.last().is_some_and(|report| report.at_rest) {
        let report = solver.step(positions).unwrap();
        let falls = solver.settings.objective == Objective::Neutral || report.energy <= report.energy_before;
        assert!(falls, "{report:?}");
        reports.push(report);
        if !report.at_rest && reports.len().is_multiple_of(3) {
            crate::respace(positions, solver.chain.closed, &fixed).unwrap();
        }
    }
    reports
}

/// The angle between a direction and the tangent of the circle through the first three places, at the first.
fn angle_at_start(positions: [DVec3; 3], direction: DVec3) -> f64 {
    let [here, near, far] = positions;
    let (short, long) = (near - here, far - here);
    let (r, l) = (short.length(), long.length());
    // The parabola by chord length; its error is of second order.
    let tangent = short * (l / (r * (l - r))) - long * (r / (l * (l - r)));
    tangent.angle_between(direction)
}

#[test]
fn gradients_with_clamps_match_central_differences() {
    let mut stream = Stream::new(31);
    for objective in [Objective::ThinPlate, Objective::Fair] {
        for closed in [false, true] {
            let count = 10;
            let settings = CurveSettings { objective, ..CurveSettings::default() };
            let fixed = (0..count).map(|i| i % 3 == 0).collect();
            let mut solver = CurveSolver::new(count, closed, fixed, settings).unwrap();
            solver.set_tangents(&[(0, stream.vector()), (6, stream.vector())]).unwrap();
            let positions: Vec<DVec3> = (0..count).map(|_| stream.vector()).collect();
            solver.fit_all(&positions);
            let gradient = solver.gradient().to_vec();
            for node in (0..count).filter(|i| i % 3 != 0) {
                for axis in DVec3::AXES {
                    let mut at = |step: f64| {
                        let mut moved = positions.clone();
                        moved[node] += axis * step;
                        solver.fit_all(&moved);
                        solver.energy()
                    };
                    let step = 2e-5;
                    let wide = at(2.0 * step) - at(-2.0 * step);
                    let difference = (8.0 * (at(step) - at(-step)) - wide) / (12.0 * step);
                    let exact = gradient[node].dot(axis);
                    let error = (difference - exact).abs() / (1.0 + exact.abs());
                    assert!(error < 1e-6, "{objective:?}, node {node}: {difference} for {exact}");
                }
            }
        }
    }
}

#[test]
fn small_slopes_give_the_cubic_of_beam_theory() {
    // y'' ² least with y(0) = y(1) = 0, y'(0) = 1e-3, and a free or a clamped far end.
    let slope = 1e-3;
    for (far_end, at_middle) in [(None, 3.0 / 16.0), (Some(DVec3::X), 1.0 / 8.0)] {
        let (mut solver, mut positions) = line(Objective::ThinPlate, 1, 40);
        let mut tangents = vec![(0, DVec3::new(1.0, slope, 0.0))];
        tangents.extend(far_end.map(|direction| (40, direction)));
        solver.set_tangents(&tangents).unwrap();
        let reports = relax(&mut solver, &mut positions, 20);
        assert!(reports.last().unwrap().at_rest);
        let height = positions[20].y / slope;
        assert!((height / at_middle - 1.0).abs() < 2e-3, "{height} for {at_middle}");
    }
}

#[test]
fn half_a_circle_comes_from_its_two_tangents() {
    // Tangents up at both ends' outer sides: the fair and the neutral answer is the half circle on the diameter.
    for (objective, tolerance) in [(Objective::Fair, 1e-4), (Objective::Neutral, 1e-3)] {
        let (mut solver, mut positions) = line(objective, 1, 48);
        solver.set_tangents(&[(0, DVec3::Y), (48, DVec3::NEG_Y)]).unwrap();
        let reports = relax(&mut solver, &mut positions, 100);
        assert!(reports.last().unwrap().at_rest, "{objective:?}: {:?}", reports.last());
        let centre = DVec3::X * 0.5;
        let off = positions.iter().map(|p| (p.distance(centre) - 0.5).abs()).fold(0.0, f64::max);
        assert!(off < tolerance, "{objective:?}: {off}");
    }
}

#[test]
fn both_sides_meet_the_tangent_to_second_order() {
    let direction = DVec3::new(1.0, 1.0, 0.5);
    for objective in BENDING {
        let angles = |edges: usize| {
            let (mut solver, mut positions) = line(objective, 2, edges);
            solver.set_tangents(&[(u32::try_from(edges).unwrap(), direction)]).unwrap();
            let reports = relax(&mut solver, &mut positions, 100);
            assert!(reports.last().unwrap().at_rest, "{objective:?}: {:?}", reports.last());
            // What the curve is told to do it does exactly.
            let told = solver.tangents()[edges].angle_between(direction);
            assert!(told < 1e-9, "{told}");
            let after = angle_at_start([0, 1, 2].map(|k| positions[edges + k]), direction);
            let before = angle_at_start([0, 1, 2].map(|k| positions[edges - k]), -direction);
            after.max(before)
        };
        let (coarse, fine) = (angles(20), angles(40));
        assert!(coarse < 0.03 && fine < coarse / 3.0, "{objective:?}: {coarse} {fine}");
    }
}

#[test]
fn reversed_and_wild_tangents_come_to_rest() {
    let mut stream = Stream::new(4);
    for objective in BENDING {
        for turn in 0..8 {
            let direction = if turn == 0 { DVec3::NEG_X } else { stream.vector() };
            let (mut solver, mut positions) = line(objective, 3, 16);
            solver.set_tangents(&[(16, direction)]).unwrap();
            let reports = relax(&mut solver, &mut positions, 300);
            let last = reports.last().unwrap();
            assert!(positions.iter().all(|p| p.is_finite() && p.length() < 20.0));
            assert!(last.at_rest, "{objective:?}, {direction}: {last:?}");
            // Not with a fold at the clamp: the next chords follow the tangent.
            let chord = (positions[17] - positions[16]).normalize_or_zero();
            assert!(chord.angle_between(direction) < PI / 3.0, "{objective:?}, {direction}: {chord}");
        }
    }
}

#[test]
fn a_moved_clamp_keeps_its_direction_on_the_way() {
    let (mut solver, mut positions) = line(Objective::ThinPlate, 2, 20);
    solver.set_tangents(&[(20, DVec3::Y)]).unwrap();
    relax(&mut solver, &mut positions, 100);
    let before = positions.clone();
    solver.predict(&mut positions, &[(20, DVec3::Z * 0.3)]).unwrap();
    // The field is level at the clamp: its neighbours go along, less the second order.
    for neighbour in [19, 21] {
        let moved = positions[neighbour] - before[neighbour];
        assert!((moved - DVec3::Z * 0.3).length() < 0.01, "{moved}");
    }
}

#[test]
fn tangents_that_are_none_are_refused() {
    let (mut solver, _) = line(Objective::Fair, 1, 4);
    assert_eq!(solver.set_tangents(&[(9, DVec3::X)]), Err(SolverError::UnknownNode(9)));
    assert_eq!(solver.set_tangents(&[(1, DVec3::X)]), Err(SolverError::NotFixed(1)));
    for bad in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NAN, 1.0)] {
        assert_eq!(solver.set_tangents(&[(0, bad)]), Err(SolverError::NotFinite(0)), "{bad}");
    }
    solver.set_tangents(&[(0, DVec3::X * 1e-200), (4, DVec3::X * 1e200)]).unwrap();
    assert_eq!(solver.given, [(0, DVec3::X), (4, DVec3::X)]);
    solver.set_fixed(vec![false, false, false, false, true]).unwrap();
    assert_eq!(solver.given, [(4, DVec3::X)]);
}
