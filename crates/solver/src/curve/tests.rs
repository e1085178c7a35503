use glam::DVec3;

use super::*;
use crate::StepReport;
use crate::workload::Stream;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const TAU: f64 = std::f64::consts::TAU;

fn circle(count: usize, pins: usize) -> (CurveSolver, Vec<DVec3>) {
    let at = |i: usize| libm::sincos(TAU * i as f64 / count as f64);
    let positions = (0..count).map(|i| DVec3::new(at(i).1, at(i).0, 0.0)).collect();
    let fixed = (0..count).map(|i| pins > 0 && i % (count / pins.max(1)) == 0).collect();
    (CurveSolver::new(count, true, fixed, CurveSettings::default()).unwrap(), positions)
}

fn relax(solver: &mut CurveSolver, positions: &mut [DVec3], limit: usize) -> Vec<StepReport> {
    let mut reports: Vec<StepReport> = Vec::new();
    for _ in 0..limit {
        let report = solver.step(positions).unwrap();
        assert!(report.energy <= report.energy_before);
        reports.push(report);
        if report.at_rest {
            break;
        }
    }
    reports
}

#[test]
fn gradient_matches_central_differences() {
    let mut stream = Stream::new(7);
    for closed in [false, true] {
        let settings = CurveSettings { tension: 0.3, slack: 0.5, ..CurveSettings::default() };
        let count = 9;
        let fixed = (0..count).map(|i| i % 3 == 0).collect();
        let mut solver = CurveSolver::new(count, closed, fixed, settings).unwrap();
        // Wild enough for sharp folds, where the barrier acts.
        let positions: Vec<DVec3> = (0..count).map(|_| stream.vector()).collect();
        solver.fit_all(&positions);
        let gradient = solver.gradient().to_vec();
        // The control polygon is a given: difference at free nodes only.
        for node in (0..count).filter(|i| i % 3 != 0) {
            for axis in DVec3::AXES {
                let mut energy = |step: f64| {
                    let mut moved = positions.clone();
                    moved[node] += axis * step;
                    solver.fit_all(&moved);
                    solver.energy()
                };
                let step = 1e-6;
                let difference = (energy(step) - energy(-step)) / (2.0 * step);
                let exact = gradient[node].dot(axis);
                assert!((difference - exact).abs() < 1e-6 * (1.0 + exact.abs()), "{difference} {exact}");
            }
        }
    }
}

#[test]
fn circle_through_four_points_bulges_as_the_minimiser_does() {
    let (mut solver, mut positions) = circle(128, 4);
    let reports = relax(&mut solver, &mut positions, 60);
    assert!(reports.last().unwrap().at_rest, "{} steps", reports.len());
    assert!(reports.len() <= 8, "{} steps", reports.len());
    let radius = positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    assert!((solver.energy() - 6.266).abs() < 2e-3, "{}", solver.energy());
    assert!((radius - 1.0096).abs() < 1e-3, "{radius}");
    assert!(positions.iter().all(|p| p.z.abs() < 1e-9));
}

#[test]
fn energy_of_a_circle_converges_with_the_square_of_the_spacing() {
    let error = |count: usize| {
        let (mut solver, positions) = circle(count, 0);
        solver.fit_all(&positions);
        (solver.energy() - TAU).abs()
    };
    let order = libm::log2(error(64) / error(128));
    assert!(order > 1.9, "{order}");
}

#[test]
fn zigzag_between_two_points_becomes_straight() {
    let count = 21;
    let fixed: Vec<bool> = (0..count).map(|i| i == 0 || i == count - 1).collect();
    let mut solver = CurveSolver::new(count, false, fixed, CurveSettings::default()).unwrap();
    let wave = |i: usize| if i == 0 || i == count - 1 { 0.0 } else { 0.3 * (i % 2) as f64 };
    let mut positions: Vec<DVec3> = (0..count).map(|i| DVec3::new(i as f64, wave(i), wave(i))).collect();
    let reports = relax(&mut solver, &mut positions, 60);
    assert!(
        reports.last().unwrap().at_rest && solver.energy() < 1e-6,
        "{} {}",
        reports.len(),
        solver.energy()
    );
    assert!(positions.iter().all(|p| p.y.abs() < 1e-2 && p.z.abs() < 1e-2));
}

#[test]
fn predictor_carries_and_translates() {
    let (mut solver, start) = circle(64, 4);
    let mut positions = start.clone();
    let all: Vec<(u32, DVec3)> = (0..4).map(|k| (16 * k, DVec3::new(3.0, -4.0, 5.0))).collect();
    assert_eq!(solver.predict(&mut positions, &all).unwrap().fraction, 1.0);
    let shift = |(a, b): (&DVec3, &DVec3)| (*a - *b).distance(DVec3::new(3.0, -4.0, 5.0));
    assert!(positions.iter().zip(&start).map(shift).all(|error| error < 1e-12));
    let mut positions = start.clone();
    assert_eq!(solver.predict(&mut positions, &[(0, DVec3::X * 0.5)]).unwrap().fraction, 1.0);
    assert!(positions[0].distance(DVec3::X * 1.5) < 1e-12);
    assert!(positions[16].distance(start[16]) < 1e-12);
    assert!(positions[1].x > start[1].x + 0.4);
    let reports = relax(&mut solver, &mut positions, 20);
    assert!(reports.last().unwrap().at_rest);
}

#[test]
fn storms_recover() {
    let (mut solver, start) = circle(64, 4);
    let mut positions = start.clone();
    relax(&mut solver, &mut positions, 40);
    let calm = solver.energy();
    let mut stream = Stream::new(3);
    let mut target = start[0];
    for jump in 0..30 {
        target = if jump == 29 { start[0] } else { start[0] + 0.8 * stream.vector() };
        for _ in 0..6 {
            let moves = [(0, target - positions[0])];
            solver.predict(&mut positions, &moves).unwrap();
            let report = solver.step(&mut positions).unwrap();
            assert!(report.energy <= report.energy_before && positions.iter().all(|p| p.is_finite()));
        }
    }
    relax(&mut solver, &mut positions, 100);
    assert!(positions[0].distance(target) < 1e-9);
    assert!((solver.energy() / calm - 1.0).abs() < 0.02, "{} for {calm}", solver.energy());
}

#[test]
fn loose_closed_curve_keeps_its_size() {
    for pins in [0, 1, 2] {
        let (mut solver, mut positions) = circle(48, pins);
        relax(&mut solver, &mut positions, 200);
        let size = half_diagonal(&positions) / half_diagonal(&circle(48, 0).1);
        assert!((0.5..2.0).contains(&size), "{pins} pins: {size}");
    }
}

#[test]
fn short_and_degenerate_curves_are_harmless() {
    for count in 0..4 {
        for closed in [false, true] {
            let mut solver =
                CurveSolver::new(count, closed, vec![false; count], CurveSettings::default()).unwrap();
            let mut positions = vec![DVec3::ONE; count];
            for _ in 0..3 {
                solver.step(&mut positions).unwrap();
            }
            assert!(positions.iter().all(|p| p.is_finite()));
            respace(&mut positions, closed, &vec![false; count]).unwrap();
            resample(&positions, closed, &vec![false; count], 0.1, 1).unwrap();
        }
    }
}

#[test]
fn nonsense_is_refused_and_changes_nothing() {
    let (mut solver, start) = circle(16, 4);
    let mut positions = start.clone();
    assert_eq!(solver.predict(&mut positions, &[(99, DVec3::X)]), Err(SolverError::UnknownNode(99)));
    assert_eq!(solver.predict(&mut positions, &[(1, DVec3::X)]), Err(SolverError::NotFixed(1)));
    assert_eq!(solver.predict(&mut positions, &[(0, DVec3::NAN)]), Err(SolverError::NotFinite(0)));
    assert_eq!(positions, start);
    positions[3] = DVec3::INFINITY;
    assert_eq!(solver.step(&mut positions), Err(SolverError::NotFinite(3)));
}

#[test]
fn resampling_keeps_a_circle_and_its_control_points() {
    let (_, positions) = circle(24, 0);
    let fixed: Vec<bool> = (0..24).map(|i| i % 8 == 0).collect();
    let even = resample(&positions, true, &fixed, TAU / 60.0, 1).unwrap();
    assert_eq!(even.positions.len(), 60);
    assert_eq!(even.fixed.iter().filter(|fixed| **fixed).count(), 3);
    for (new, old) in even.source.iter().enumerate().filter_map(|(new, old)| old.map(|old| (new, old))) {
        assert_eq!(even.positions[new], positions[old as usize]);
    }
    assert!(even.positions.iter().all(|p| (p.length() - 1.0).abs() < 2e-4));
    let gaps: Vec<f64> = (0..60).map(|i| even.positions[i].distance(even.positions[(i + 1) % 60])).collect();
    assert!(gaps.iter().all(|gap| (gap * 60.0 / TAU - 1.0).abs() < 0.01));
}

#[test]
fn respacing_evens_a_bunched_curve() {
    let count = 41;
    let fixed: Vec<bool> = (0..count).map(|i| i == 0 || i == 20 || i == count - 1).collect();
    let bend = |i: usize| {
        let t = i as f64 / 40.0;
        let t = t + 0.1 * libm::sin(2.0 * TAU * t) / TAU;
        DVec3::new(4.0 * t, libm::sin(2.0 * t), t * t)
    };
    let start: Vec<DVec3> = (0..count).map(bend).collect();
    let mut positions = start.clone();
    respace(&mut positions, false, &fixed).unwrap();
    assert!([0, 20, 40].iter().all(|&i| positions[i] == start[i]));
    for span in [0..20, 20..40] {
        let gaps: Vec<f64> = span.map(|i| positions[i].distance(positions[i + 1])).collect();
        let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
        assert!(gaps.iter().all(|gap| (gap / mean - 1.0).abs() < 0.005));
    }
}

/// An ellipse-like closed curve through six controls, sampled at random between them: the widths of edges differ up to 1 : 3.
fn sampled(per_span: usize, stream: &mut Stream) -> (Vec<DVec3>, Vec<bool>) {
    let controls = [(0.0, 1.3), (0.9, 0.9), (2.1, 1.1), (3.0, 1.4), (4.3, 0.8), (5.2, 1.0)];
    let place = |turn: f64, radius: f64| {
        let (sin, cos) = libm::sincos(turn);
        DVec3::new(1.2 * radius * cos, radius * sin, 0.3 * libm::cos(2.0 * turn))
    };
    let (mut positions, mut fixed) = (Vec::new(), Vec::new());
    for (k, &(turn, radius)) in controls.iter().enumerate() {
        let (next_turn, next_radius) = controls[(k + 1) % controls.len()];
        let next_turn = if k + 1 == controls.len() { TAU } else { next_turn };
        let widths: Vec<f64> = (0..per_span).map(|_| 0.5 + stream.unit()).collect();
        let total: f64 = widths.iter().sum();
        let mut walked = 0.0;
        for (sample, width) in widths.iter().enumerate() {
            let part = walked / total;
            positions.push(place(turn + part * (next_turn - turn), radius + part * (next_radius - radius)));
            fixed.push(sample == 0);
            walked += width;
        }
    }
    (positions, fixed)
}

/// Largest distance of nodes from a fine polygon.
fn off(positions: &[DVec3], fine: &[DVec3]) -> f64 {
    let distance = |p: DVec3, a: DVec3, b: DVec3| {
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, along))
    };
    let nearest = |p: DVec3| {
        (0..fine.len())
            .map(|i| distance(p, fine[i], fine[(i + 1) % fine.len()]))
            .fold(f64::INFINITY, f64::min)
    };
    positions.iter().map(|&p| nearest(p)).fold(0.0, f64::max)
}

#[test]
fn the_shape_does_not_depend_on_where_the_samples_sit() {
    for objective in [Objective::ThinPlate, Objective::Fair] {
        let settings = CurveSettings { objective, ..CurveSettings::default() };
        let rested = |per_span: usize, seed: u64| {
            let (mut positions, fixed) = sampled(per_span, &mut Stream::new(seed));
            let mut solver = CurveSolver::new(positions.len(), true, fixed, settings).unwrap();
            let reports = relax(&mut solver, &mut positions, 200);
            assert!(reports.last().unwrap().at_rest, "{objective:?}, {per_span}, {seed}");
            positions
        };
        let fine = rested(64, 9);
        let worst = |per_span| (1..=3).map(|seed| off(&rested(per_span, seed), &fine)).fold(0.0, f64::max);
        let (coarse, half) = (worst(8), worst(16));
        // Second order: an error of a quarter, and room for the draw of the samples.
        assert!(half < 2e-3 && coarse / half > 2.8, "{objective:?}: {coarse} {half}");
    }
}
