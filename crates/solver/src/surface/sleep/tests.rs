//! Tubes in bays, whose first circle is dragged.

use super::super::advance::REST_MOVE;
use super::*;
use crate::{Budget, Rings, Settings, workload};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A tube of eight bays between nine fixed circles, and the nodes of each circle.
fn tube() -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
    tube_that_sleeps_from(100)
}

/// The same, of which no fewer nodes may sleep.
fn tube_that_sleeps_from(least_asleep: usize) -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
    let (around, along) = (24, 64);
    let mut shape = workload::cylinder(around, along, 8.0);
    let mut circles = Vec::new();
    for level in (0..=along).step_by(8) {
        let circle: Vec<u32> = (level * around..(level + 1) * around).collect();
        circle.iter().for_each(|&node| shape.fixed[node as usize] = true);
        circles.push(circle);
    }
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
    let settings = Settings { least_asleep, ..Settings::default() };
    let mut solver = SurfaceSolver::new(rings, shape.fixed, settings).unwrap();
    let mut positions = shape.positions;
    assert!((0..60).any(|_| solver.step(&mut positions, Budget::default()).unwrap().at_rest));
    (solver, positions, circles)
}

/// Moves the first circle along in small steps, with or without sleep; the energy at rest, and the most that slept.
fn drag(may_sleep: bool) -> (f64, usize, Vec<DVec3>) {
    let least = if may_sleep { 100 } else { usize::MAX };
    let (mut solver, mut positions, circles) = tube_that_sleeps_from(least);
    let mut most = 0;
    for _ in 0..20 {
        let before = positions.clone();
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
        solver.predict(&mut positions, &moves).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
        solver.doze(&before, &positions).unwrap();
        most = most.max(solver.asleep());
    }
    solver.wake();
    assert!((0..60).any(|_| solver.step(&mut positions, Budget::default()).unwrap().at_rest));
    (solver.energy(), most, positions)
}

#[test]
fn far_bays_sleep_through_a_drag_and_the_shape_is_the_same() {
    let (energy, none, positions) = drag(false);
    let (slept, most, same) = drag(true);
    assert_eq!(none, 0);
    assert!(most >= 24 * 7 * 3, "{most} slept");
    assert!((slept / energy - 1.0).abs() < 1e-6, "{slept} for {energy}");
    let worst = positions.iter().zip(&same).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(worst < 1e-3, "{worst}");
}

/// What is not fitted again is what a fit of everything would say.
#[test]
fn fits_of_sleeping_bays_are_exact() {
    let (mut solver, mut positions, circles) = tube();
    for _ in 0..12 {
        if solver.asleep() > 0 && positions[circles[0][0] as usize].x > 1.03 {
            break;
        }
        let before = positions.clone();
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
        solver.predict(&mut positions, &moves).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
        solver.doze(&before, &positions).unwrap();
    }
    assert!(solver.asleep() > 0);
    let energy = solver.energy();
    let normals = solver.normals().to_vec();
    assert!(solver.wake());
    solver.evaluate(&positions);
    assert_eq!(solver.energy().to_bits(), energy.to_bits());
    assert_eq!(solver.normals(), normals);
}

/// What a drag of a shape at rest does not reach need not be solved for once: it sleeps before the first frame, and nobody
/// sees it.
#[test]
fn the_first_frame_of_a_drag_solves_for_what_it_reaches() {
    let (mut solver, mut positions, circles) = tube();
    let (mut other, mut awake, _) = tube_that_sleeps_from(usize::MAX);
    let h = solver.fits.nodes[circles[4][0] as usize].h;
    let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.05)).collect();
    solver.predict(&mut positions, &moves).unwrap();
    assert_eq!(solver.asleep(), 24 * 7 * 3, "five bays lie within four curves");
    other.predict(&mut awake, &moves).unwrap();
    for _ in 0..3 {
        solver.step(&mut positions, Budget::default()).unwrap();
        other.step(&mut awake, Budget::default()).unwrap();
    }
    let apart = positions.iter().zip(&awake).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(apart > 0.0 && apart < STIR * h, "{apart} of edges of {h}");
    // Only what is at rest begins so: a shape that somebody moved is all awake.
    let (mut solver, mut positions, circles) = tube();
    positions[circles[3][0] as usize + 30].x += 1e-3;
    let moves = [(circles[0][0], DVec3::X * 1e-4)];
    solver.predict(&mut positions, &moves).unwrap();
    assert_eq!(solver.asleep(), 0);
}

/// Attended to when a hand takes hold, nodes have everything set up before they move, and move as they would have.
#[test]
fn what_a_hand_takes_hold_of_is_set_up_before_it_moves() {
    let (mut solver, mut positions, circles) = tube();
    let (mut other, mut unheeded, _) = tube();
    let still = positions.clone();
    solver.attend(&positions, &circles[0]).unwrap();
    assert_eq!((solver.asleep(), &positions), (24 * 7 * 3, &still));
    let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.05)).collect();
    for _ in 0..3 {
        solver.predict(&mut positions, &moves).unwrap();
        other.predict(&mut unheeded, &moves).unwrap();
        assert_eq!(solver.asleep(), other.asleep());
        solver.step(&mut positions, Budget::default()).unwrap();
        other.step(&mut unheeded, Budget::default()).unwrap();
    }
    assert!(positions == unheeded, "the same bits");
    // Another hand, elsewhere: what it reaches wakes, and what is awake stays so.
    solver.attend(&positions, &circles[8]).unwrap();
    assert_eq!(solver.asleep(), 0);
    // What is no control is refused, and nothing happens.
    let (mut solver, positions, circles) = tube();
    let free = circles[0][0] + 30;
    assert!(matches!(solver.attend(&positions, &[free]), Err(SolverError::NotFixed(_))));
    assert!(solver.attend(&positions[1..], &circles[0]).is_err());
    assert_eq!(solver.asleep(), 0);
}

/// The border of what sleeps moves on bay by bay; the rest goes on sleeping.
#[test]
fn a_border_that_stirs_wakes_the_bays_beside_it_alone() {
    let (mut solver, mut positions, circles) = dozing();
    let first = solver.asleep();
    let mut counts = vec![first];
    for _ in 0..60 {
        let before = positions.clone();
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.02)).collect();
        solver.predict(&mut positions, &moves).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
        solver.doze(&before, &positions).unwrap();
        if Some(&solver.asleep()) != counts.last() {
            counts.push(solver.asleep());
        }
    }
    assert!(counts.len() > 1 && counts[1] > 0 && counts[1] < first, "{counts:?}");
}

fn dozing() -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
    let (mut solver, mut positions, circles) = tube();
    let before = positions.clone();
    let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
    solver.predict(&mut positions, &moves).unwrap();
    solver.step(&mut positions, Budget::default()).unwrap();
    solver.doze(&before, &positions).unwrap();
    assert!(solver.asleep() > 0);
    (solver, positions, circles)
}

#[test]
fn a_control_beside_a_sleeping_bay_wakes_it() {
    let (mut solver, mut positions, circles) = dozing();
    solver.predict(&mut positions, &[(circles[6][0], DVec3::X * 0.02)]).unwrap();
    assert_eq!(solver.asleep(), 0);
}

#[test]
fn a_sleeping_node_that_somebody_moved_wakes_all() {
    let (mut solver, mut positions, circles) = dozing();
    let node = circles[6][0] as usize + 30;
    positions[node] += DVec3::X * 1e-3;
    solver.step(&mut positions, Budget::default()).unwrap();
    assert_eq!(solver.asleep(), 0);
}

#[test]
fn a_stronger_drag_wakes_the_bays_that_it_reaches() {
    let (mut solver, mut positions, circles) = dozing();
    let mut woke = false;
    for _ in 0..40 {
        let before = positions.clone();
        let asleep = solver.asleep();
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.05)).collect();
        solver.predict(&mut positions, &moves).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
        solver.doze(&before, &positions).unwrap();
        woke |= solver.asleep() < asleep;
    }
    assert!(woke, "the border never stirred");
}

/// The angles between the facets on both sides of a circle's edges.
fn folds(solver: &SurfaceSolver, positions: &[DVec3], circle: &[u32]) -> Vec<f64> {
    let triangles = solver.rings().triangles();
    let normal = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|node| positions[node as usize]);
        (b - a).cross(c - a)
    };
    let sides = circle.iter().zip(circle.iter().cycle().skip(1)).filter_map(|(a, b)| {
        let on = triangles.iter().filter(|t| t.contains(a) && t.contains(b)).collect::<Vec<_>>();
        let [one, other] = on[..] else { return None };
        Some(normal(one).angle_between(normal(other)))
    });
    sides.collect()
}

/// Asleep or not, what a hand sees of the border is the same, and nothing jumps when all wakes.
#[test]
fn no_seam_shows_at_the_border_of_sleeping_bays_and_nothing_jumps_when_they_wake() {
    let (mut solver, mut positions, circles) = tube();
    let (mut other, mut awake, _) = tube_that_sleeps_from(usize::MAX);
    let h = solver.fits.nodes[circles[4][0] as usize].h;
    let (mut tilt, mut fold, mut apart) = (0.0_f64, 0.0_f64, 0.0_f64);
    let mut frames = 0;
    for _ in 0..20 {
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
        let before = positions.clone();
        solver.predict(&mut positions, &moves).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
        let is_asleep = solver.asleep() > 0;
        solver.evaluate(&positions);
        other.predict(&mut awake, &moves).unwrap();
        other.step(&mut awake, Budget::default()).unwrap();
        other.evaluate(&awake);
        frames += u32::from(is_asleep);
        for circle in circles[1..8].iter().filter(|_| is_asleep) {
            for &node in circle {
                let node = node as usize;
                assert_eq!(positions[node], awake[node], "a control that nobody moved");
                tilt = tilt.max(solver.normals()[node].angle_between(other.normals()[node]));
            }
            let [ours, theirs] = [folds(&solver, &positions, circle), folds(&other, &awake, circle)];
            fold = ours.iter().zip(&theirs).fold(fold, |most, (a, b)| most.max((a - b).abs()));
        }
        apart = positions.iter().zip(&awake).fold(apart, |most, (a, b)| most.max(a.distance(*b)));
        solver.doze(&before, &positions).unwrap();
    }
    assert!(frames > 10 && solver.asleep() > 0, "{frames}");
    // The hand stops: all wakes, and the next step is one of the whole.
    let border: Vec<u32> = solver.sleep.as_ref().unwrap().border.iter().map(|border| border.0).collect();
    let beside = |node: u32| solver.rings.ring(node as usize).to_vec();
    let beside: Vec<u32> = border.iter().flat_map(|&node| beside(node)).collect();
    let before = positions.clone();
    assert!(!border.is_empty() && solver.wake());
    let moved = |now: &[DVec3], node: usize| now[node].distance(before[node]) / h;
    let mut jumps = [0.0_f64; 2];
    for _ in 0..2 {
        solver.step(&mut positions, Budget::default()).unwrap();
        let beside = beside.iter().map(|&node| moved(&positions, node as usize)).fold(0.0, f64::max);
        let anywhere = (0..positions.len()).map(|node| moved(&positions, node)).fold(0.0, f64::max);
        jumps = [jumps[0].max(beside), jumps[1].max(anywhere)];
    }
    // A step that moves nothing farther counts as rest.
    println!(
        "{jumps:?} of an edge, normals by {tilt}, facets by {fold} radians, apart by {} of an edge",
        apart / h
    );
    assert!(jumps[0] < 0.5 * REST_MOVE && jumps[1] < 0.5 * REST_MOVE, "{jumps:?} of an edge");
    assert!(tilt < BORDER && fold < BORDER, "normals by {tilt}, facets by {fold} radians");
    assert!(apart < STIR * h, "{apart}");
    assert!(border.iter().all(|&node| positions[node as usize] == before[node as usize]));
}
