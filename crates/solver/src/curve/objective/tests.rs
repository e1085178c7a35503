use glam::DVec3;

use crate::workload::Stream;
use crate::{CurveSettings, CurveSolver, Objective, StepReport};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const TAU: f64 = std::f64::consts::TAU;
const ALL: [Objective; 4] = [Objective::ThinPlate, Objective::Fair, Objective::Neutral, Objective::Membrane];

fn solver(objective: Objective, closed: bool, fixed: Vec<bool>) -> CurveSolver {
    let settings = CurveSettings { objective, ..CurveSettings::default() };
    CurveSolver::new(fixed.len(), closed, fixed, settings).unwrap()
}

/// Points of the unit circle at uneven angles, by a seed.
fn uneven_circle(count: usize, seed: u64) -> Vec<DVec3> {
    let mut stream = Stream::new(seed);
    let turn = TAU / count as f64;
    let at = |i: usize, jitter: f64| libm::sincos(turn * (i as f64 + 0.3 * jitter));
    (0..count)
        .map(|i| {
            let (sin, cos) = at(i, stream.vector().x);
            DVec3::new(cos, sin, 0.0)
        })
        .collect()
}

/// A closed curve in space without folds or symmetry, evenly spread in its parameter.
fn knot(count: usize) -> Vec<DVec3> {
    let at = |k: f64, i: usize| libm::sin(k + TAU * i as f64 / count as f64);
    (0..count).map(|i| DVec3::new(2.0 * at(1.5, i), 1.3 * at(0.0, i), 0.4 * at(1.0, 2 * i) + 0.2)).collect()
}

fn relax(solver: &mut CurveSolver, positions: &mut [DVec3], limit: usize) -> Vec<StepReport> {
    let mut reports: Vec<StepReport> = Vec::new();
    for _ in 0..limit {
        let report = solver.step(positions).unwrap();
        assert!(
            solver.settings.objective == Objective::Neutral || report.energy <= report.energy_before,
            "{report:?}"
        );
        reports.push(report);
        if report.at_rest {
            break;
        }
    }
    reports
}

/// Steps and even spacing in turn, as the modeler does it.
fn relax_evenly(solver: &mut CurveSolver, positions: &mut [DVec3], limit: usize) -> Vec<StepReport> {
    let (closed, fixed) = (solver.chain.closed, solver.fixed.clone());
    let mut reports: Vec<StepReport> = Vec::new();
    while reports.len() < limit && !reports.last().is_some_and(|report| report.at_rest) {
        reports.append(&mut relax(solver, positions, 1));
        crate::respace(positions, closed, &fixed).unwrap();
    }
    reports
}

fn rests(reports: &[StepReport]) -> bool {
    reports.last().unwrap().at_rest
}

fn energy_at(solver: &mut CurveSolver, positions: &[DVec3]) -> f64 {
    solver.fit_all(positions);
    solver.energy()
}

#[test]
fn gradients_match_central_differences() {
    let mut stream = Stream::new(21);
    for objective in [Objective::Fair, Objective::Membrane, Objective::ThinPlate] {
        for closed in [false, true] {
            let count = 10;
            let settings = CurveSettings { objective, tension: 0.2, slack: 0.4, ..CurveSettings::default() };
            let fixed = (0..count).map(|i| i % 3 == 0).collect();
            let mut solver = CurveSolver::new(count, closed, fixed, settings).unwrap();
            // Wild enough for folds and for the rope.
            let positions: Vec<DVec3> = (0..count).map(|_| stream.vector()).collect();
            solver.fit_all(&positions);
            let gradient = solver.gradient().to_vec();
            for node in (0..count).filter(|i| i % 3 != 0) {
                for axis in DVec3::AXES {
                    let mut at = |step: f64| {
                        let mut moved = positions.clone();
                        moved[node] += axis * step;
                        energy_at(&mut solver, &moved)
                    };
                    // Fourth order, since curvatures of a wild polygon change fast.
                    let step = 2e-5;
                    let difference =
                        (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step))) / (12.0 * step);
                    let exact = gradient[node].dot(axis);
                    let error = (difference - exact).abs() / (1.0 + exact.abs());
                    assert!(error < 1e-6, "{objective:?}, node {node}: {difference} for {exact}");
                }
            }
        }
    }
}

#[test]
fn rigid_motions_and_scaling_act_on_gradients_as_they_must() {
    let positions = knot(60);
    for objective in ALL {
        let mut solver = solver(objective, true, vec![false; 60]);
        let energy = energy_at(&mut solver, &positions);
        let share = solver.bends.character.share;
        let gradient = solver.gradient().to_vec();
        let size: f64 = gradient.iter().map(|g| g.length()).sum();
        let force: DVec3 = gradient.iter().sum();
        assert!(force.length() < 1e-12 * size, "{objective:?}: {force}");
        let torque: DVec3 = positions.iter().zip(&gradient).map(|(p, g)| p.cross(*g)).sum();
        let virial: f64 = positions.iter().zip(&gradient).map(|(p, g)| p.dot(*g)).sum();
        let plate = self::solver(Objective::ThinPlate, true, vec![false; 60]);
        let bending = share * energy_at(&mut { plate }, &positions);
        let expected = match objective {
            Objective::ThinPlate => -energy,
            Objective::Fair => -3.0 * (energy - bending) - bending,
            Objective::Membrane => energy,
            // No energy, so nothing to be homogeneous.
            Objective::Neutral => continue,
        };
        assert!(torque.length() < 1e-12 * size, "{objective:?}: {torque}");
        assert!((virial - expected).abs() < 1e-11 * size, "{objective:?}: {virial} for {expected}");
    }
}

#[test]
fn neutral_is_the_plate_up_to_lower_order() {
    // On a straight line with small waves both pull alike: 2 κ'' per length.
    let at = |i: usize| DVec3::new(0.1 * i as f64, 1e-5 * libm::sin(0.1 * i as f64), 0.0);
    let positions: Vec<DVec3> = (0..100).map(at).collect();
    let pulls = [Objective::ThinPlate, Objective::Neutral].map(|objective| {
        let mut solver = solver(objective, false, vec![false; 100]);
        solver.fit_all(&positions);
        solver.gradient().to_vec()
    });
    for (plate, neutral) in pulls[0].iter().zip(&pulls[1]) {
        assert!((*plate - *neutral).length() < 1e-11, "{plate} {neutral}");
    }
}

#[test]
fn circles_and_lines_cost_nothing_however_they_are_sampled() {
    let circle = uneven_circle(40, 5);
    let mut stream = Stream::new(6);
    let line: Vec<DVec3> =
        (0..40).map(|i| DVec3::new(1.0, 2.0, -1.0) * (i as f64 + 0.3 * stream.vector().x)).collect();
    for (positions, closed) in [(circle, true), (line, false)] {
        let mut solver = solver(Objective::Fair, closed, vec![false; 40]);
        let energy = energy_at(&mut solver, &positions);
        let share = solver.bends.character.share;
        let plate = self::solver(Objective::ThinPlate, closed, vec![false; 40]);
        let bending = energy_at(&mut { plate }, &positions);
        assert!((energy - share * bending).abs() < 1e-20, "{energy}");
        let mut neutral = self::solver(Objective::Neutral, closed, vec![false; 40]);
        neutral.fit_all(&positions);
        // At the free ends of a line the curvature is zero too.
        assert!(neutral.gradient().iter().all(|g| g.length() < 1e-9));
    }
}

/// `∫ (dκ/ds)² ds` of the ellipse (2 cos t, sin t), by quadrature.
fn variation_of_ellipse() -> f64 {
    let count = 2000;
    let term = |i: usize| {
        let (sin, cos) = libm::sincos(TAU * i as f64 / f64::from(count));
        let speed = (4.0 * sin * sin + cos * cos).sqrt();
        // κ = 2 / speed³, speed' = 3 sin cos / speed
        let slope = -6.0 / (speed * speed * speed * speed) * (3.0 * sin * cos / speed) / speed;
        slope * slope * speed
    };
    (0..count as usize).map(term).sum::<f64>() * TAU / f64::from(count)
}

#[test]
fn energies_converge_with_the_square_of_the_spacing() {
    let exact = variation_of_ellipse();
    let error = |count: usize| {
        let at = |i: usize| libm::sincos(TAU * i as f64 / count as f64);
        let positions: Vec<DVec3> = (0..count).map(|i| DVec3::new(2.0 * at(i).1, at(i).0, 0.0)).collect();
        let mut fair = solver(Objective::Fair, true, vec![false; count]);
        let total = energy_at(&mut fair, &positions);
        let share = fair.bends.character.share;
        let plate = energy_at(&mut solver(Objective::ThinPlate, true, vec![false; count]), &positions);
        (total - share * plate - exact).abs() / exact
    };
    let (coarse, fine) = (error(80), error(160));
    assert!(fine < 1e-2 && libm::log2(coarse / fine) > 1.9, "{coarse} {fine}");
    // A helix turns out of its plane: |κ'| = κ τ. The ends lack an edge each.
    let helix = |count: usize| {
        let at = |i: usize| 6.0 * i as f64 / (count - 1) as f64;
        let point = |t: f64| DVec3::new(libm::cos(t), libm::sin(t), 0.5 * t);
        let positions: Vec<DVec3> = (0..count).map(|i| point(at(i))).collect();
        let mut fair = solver(Objective::Fair, false, vec![false; count]);
        let total = energy_at(&mut fair, &positions);
        let plate = energy_at(&mut solver(Objective::ThinPlate, false, vec![false; count]), &positions);
        let squared = 1.25;
        let (curvature, torsion) = (1.0 / squared, 0.5 / squared);
        let length = 6.0 * f64::sqrt(squared) * (count - 3) as f64 / (count - 1) as f64;
        let exact = (curvature * torsion) * (curvature * torsion) * length;
        (total - fair.bends.character.share * plate - exact).abs() / exact
    };
    let (coarse, fine) = (helix(61), helix(121));
    assert!(fine < 2e-3 && libm::log2(coarse / fine) > 1.9, "{coarse} {fine}");
}

/// The circle through four points of it, uneven, from a wave around it.
fn wavy_circle(objective: Objective, count: usize) -> (CurveSolver, Vec<DVec3>) {
    let controls = [0, count / 5, count / 2, 4 * count / 5];
    let at = |i: usize| libm::sincos(TAU * i as f64 / count as f64);
    let wave = |i: usize| libm::sin(3.0 * TAU * i as f64 / count as f64);
    let fixed: Vec<bool> = (0..count).map(|i| controls.contains(&i)).collect();
    let positions = (0..count)
        .map(|i| {
            let on_circle = DVec3::new(at(i).1, at(i).0, 0.0);
            let wave = DVec3::new(0.1 * wave(i), 0.0, 0.1 * wave(i));
            if fixed[i] { on_circle } else { on_circle + wave }
        })
        .collect();
    (solver(objective, true, fixed), positions)
}

/// Puts the samples on the polygon through the control points: how every new curve starts.
fn along_polygon(positions: &mut [DVec3], fixed: &[bool]) {
    let count = positions.len();
    let corners: Vec<usize> = (0..count).filter(|&i| fixed[i]).collect();
    for (rank, &from) in corners.iter().enumerate() {
        let to = corners.get(rank + 1).copied().unwrap_or(corners[0] + count);
        for i in from + 1..to {
            let part = (i - from) as f64 / (to - from) as f64;
            positions[i % count] = positions[from].lerp(positions[to % count], part);
        }
    }
}

fn deviation_from_circle(positions: &[DVec3]) -> f64 {
    let off = |p: &DVec3| (p.truncate().length() - 1.0).abs().max(p.z.abs());
    positions.iter().map(off).fold(0.0, f64::max)
}

#[test]
fn circle_through_four_points_is_what_fair_and_neutral_make() {
    // The thin plate within `fair` bulges by a thousandth of what it does alone.
    for (objective, tolerance) in [(Objective::Fair, 3e-5), (Objective::Neutral, 1e-4)] {
        for is_polygon in [false, true] {
            let (mut solver, mut positions) = wavy_circle(objective, 100);
            if is_polygon {
                along_polygon(&mut positions, &solver.fixed);
            }
            let reports = relax_evenly(&mut solver, &mut positions, 60);
            assert!(rests(&reports) && reports.len() <= 20, "{objective:?}: {} steps", reports.len());
            let off = deviation_from_circle(&positions);
            assert!(off < tolerance, "{objective:?}: {off}");
        }
    }
}

#[test]
fn neutral_curvature_grows_linearly_between_control_points() {
    let count = 121;
    let fixed: Vec<bool> = (0..count).map(|i| i % 40 == 0).collect();
    let height = |i: usize| [0.0, 1.0, -0.5, 0.3][i / 40] * f64::from(u8::from(i.is_multiple_of(40)));
    let mut positions: Vec<DVec3> = (0..count).map(|i| DVec3::new(i as f64 / 40.0, height(i), 0.0)).collect();
    for i in 0..count {
        let (low, part) = (i / 40 * 40, (i % 40) as f64 / 40.0);
        positions[i] = positions[low].lerp(positions[(low + 40).min(count - 1)], part);
    }
    let mut solver = solver(Objective::Neutral, false, fixed.clone());
    let reports = relax_evenly(&mut solver, &mut positions, 60);
    assert!(rests(&reports), "{} steps", reports.len());
    let curvature: Vec<f64> =
        solver.curvatures().iter().zip(solver.tangents()).map(|(k, t)| t.cross(*k).z).collect();
    let largest = curvature.iter().fold(0.0_f64, |most, k| most.max(k.abs()));
    assert!(largest > 1.0);
    for span in [0, 40, 80] {
        // At a control point the spacing changes, and three uneven points tell the curvature less well.
        let (from, to) = (curvature[span + 1], curvature[span + 39]);
        for step in 2..39 {
            let linear = from + (to - from) * (step - 1) as f64 / 38.0;
            let off = (curvature[span + step] - linear).abs() / largest;
            assert!(off < 1e-4, "{span}+{step}: {off}");
        }
    }
}

#[test]
fn membrane_is_the_polygon_of_its_control_points() {
    let (mut solver, mut positions) = wavy_circle(Objective::Membrane, 80);
    let corners: Vec<DVec3> = [0, 16, 40, 64].map(|i| positions[i]).to_vec();
    let reports = relax(&mut solver, &mut positions, 60);
    assert!(rests(&reports), "{} steps", reports.len());
    let sides = (0..4).map(|i| corners[i].distance(corners[(i + 1) % 4]));
    let polygon: f64 = sides.sum();
    for r in &reports {
        eprintln!(
            "mem {} {} {} h{} m{}",
            r.energy_before, r.energy, r.step_scale, r.halvings, r.largest_relative_move
        );
    }
    assert!((solver.energy() / polygon - 1.0).abs() < 1e-9, "{} for {polygon}", solver.energy());
}

#[test]
fn storms_recover_under_every_objective() {
    for objective in ALL {
        let (mut solver, start) = wavy_circle(objective, 60);
        let mut positions = start.clone();
        relax_evenly(&mut solver, &mut positions, 60);
        let calm = positions.clone();
        let fixed = solver.fixed.clone();
        let mut stream = Stream::new(3);
        for jump in 0..30 {
            let target = if jump == 29 { start[0] } else { start[0] + 0.4 * stream.vector() };
            for _ in 0..6 {
                let moves = [(0, target - positions[0])];
                solver.predict(&mut positions, &moves).unwrap();
                let report = solver.step(&mut positions).unwrap();
                let falls = objective == Objective::Neutral || report.energy <= report.energy_before;
                assert!(falls && positions.iter().all(|p| p.is_finite()));
                crate::respace(&mut positions, true, &fixed).unwrap();
            }
        }
        let reports = relax_evenly(&mut solver, &mut positions, 200);
        let off = positions.iter().zip(&calm).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(rests(&reports) && off < 2e-3, "{objective:?}: {off} after {}", reports.len());
    }
}

#[test]
fn loose_and_degenerate_curves_stay_finite_under_every_objective() {
    for objective in ALL {
        for closed in [false, true] {
            for pins in [0, 1, 2] {
                let mut positions = knot(24);
                let fixed = (0..24).map(|i| i < pins).collect();
                let mut solver = solver(objective, closed, fixed);
                for _ in 0..100 {
                    solver.step(&mut positions).unwrap();
                }
                let size = crate::curve::half_diagonal(&positions);
                assert!(size < 20.0, "{objective:?}, {pins} pins: {size}");
            }
            for count in 0..5 {
                let mut solver = solver(objective, closed, vec![false; count]);
                let mut positions = vec![DVec3::ONE; count];
                for _ in 0..3 {
                    solver.step(&mut positions).unwrap();
                }
                assert!(positions.iter().all(|p| p.is_finite()));
            }
        }
    }
}
