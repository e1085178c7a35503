//! Surfaces whose bending is sampled away from their rims: exactness, order, and what must hold the rim all the same.

#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]

use ductile_solver::workload::{self, Stream, Workload};
use ductile_solver::{Budget, Objective, Objectives, Rings, Sampling, Settings, SurfaceSolver};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const PI: f64 = std::f64::consts::PI;

fn solver(shape: &Workload, sampling: Sampling) -> SurfaceSolver {
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
    let mut settings = Settings::default();
    settings.sampling = sampling;
    SurfaceSolver::new(rings, shape.fixed.clone(), settings).unwrap()
}

fn energy(shape: &Workload, sampling: Sampling) -> f64 {
    let mut solver = solver(shape, sampling);
    solver.fit_all(&shape.positions);
    solver.energy()
}

fn jitter(shape: &mut Workload, amount: f64, seed: u64) {
    let mut stream = Stream::new(seed);
    for position in &mut shape.positions {
        *position += amount * stream.vector();
    }
}

/// A band of equilateral triangles, so many rows of them wide and so many edges long; nothing fixed.
fn band(rows: u32, edges: u32) -> Workload {
    let height = 0.75_f64.sqrt();
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let at = |i: u32, j: u32| j * (edges + 1) + i;
    for j in 0..=rows {
        for i in 0..=edges {
            positions.push(DVec3::new(f64::from(i) + 0.5 * f64::from(j), height * f64::from(j), 0.0));
            if i < edges && j < rows {
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    let fixed = vec![false; positions.len()];
    Workload { positions, triangles, fixed }
}

/// A sector of a disc whose corner in the middle has that angle, three rows of triangles wide; nothing fixed. Beyond a whole turn it
/// winds up.
///
/// Its first chord is twice as long as the others.
fn sector(angle: f64) -> Workload {
    const SPOKES: u32 = 8;
    let mut shape = Workload { positions: vec![DVec3::ZERO], triangles: Vec::new(), fixed: Vec::new() };
    let at = |row: u32, spoke: u32| 1 + (row - 1) * SPOKES + spoke;
    for row in 1..=3 {
        for spoke in 0..SPOKES {
            let turn = angle * f64::from(spoke) / f64::from(SPOKES - 1);
            let reach = f64::from(row) * if spoke == 0 && row == 1 { 2.0 } else { 1.0 };
            let reach = reach.min(f64::from(row) + 0.9);
            shape.positions.push(DVec3::new(
                reach * libm::cos(turn),
                reach * libm::sin(turn),
                0.3 * (turn - 2.0 * PI).max(0.0),
            ));
            if spoke + 1 < SPOKES {
                let (near, far) = (at(row, spoke), at(row, spoke + 1));
                match row {
                    1 => shape.triangles.push([0, near, far]),
                    _ => shape
                        .triangles
                        .extend([[near - SPOKES, near, far], [near - SPOKES, far, far - SPOKES]]),
                }
            }
        }
    }
    shape.fixed = vec![false; shape.positions.len()];
    shape
}

#[test]
fn the_end_of_a_slit_costs_nothing_where_the_surface_is_flat() {
    for angle in [1.0, 1.5, 1.75, 1.95, 2.0].map(|angle| angle * PI) {
        let shape = sector(angle);
        for sampling in [Sampling::Everywhere, Sampling::Inside] {
            // At least one node inside, which is the one that takes over what rims give away.
            let energy = energy(&shape, sampling);
            assert!(energy < 1e-20, "{angle} {sampling:?}: {energy}");
        }
    }
}

#[test]
fn what_a_corner_costs_does_not_jump_while_it_opens() {
    let bent = |angle: f64| {
        let mut shape = sector(angle);
        shape.positions.iter_mut().for_each(|p| p.z = 0.1 * p.x * p.x - 0.05 * p.y);
        energy(&shape, Sampling::Everywhere)
    };
    // Steps of a thousandth of a turn, over both ends of every stretch of the target.
    let costs: Vec<_> = (1100..2000).map(|k| bent(f64::from(k) * 1e-3 * PI)).collect();
    let changes: Vec<_> = costs.windows(2).map(|two| two[1] - two[0]).collect();
    let largest = changes.iter().fold(0.0, |most, c| f64::max(most, c.abs()));
    assert!(largest < 0.02 * costs.iter().fold(0.0, |most, &c| f64::max(most, c)), "{largest}");
    for three in changes.windows(2) {
        assert!((three[1] - three[0]).abs() < 0.2 * largest, "the slope does not jump either: {three:?}");
    }
}

/// A disc, two bands, a Möbius strip and four sectors, all shaken, their rims held but for the sectors' corner.
fn shaken() -> Vec<Workload> {
    let mut shapes: Vec<_> = [workload::disc(5), band(1, 6), band(2, 8), workload::moebius(30, 4, 0.4)]
        .into_iter()
        .chain([1.35, 1.85, 2.0, 2.4].map(|angle| sector(angle * PI)))
        .map(|mut shape| {
            jitter(&mut shape, 0.03, 7);
            let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
            shape.fixed = (0..rings.len()).map(|node| rings.is_boundary(node)).collect();
            shape
        })
        .collect();
    // A spike beside the rim: the barrier acts.
    shapes[0].positions[50].z += 0.6;
    shapes
}

#[test]
fn the_gradient_is_exact_and_balanced() {
    // Sampled from inside, what a rim says weighs next to nothing.
    let samplings = [Sampling::Everywhere, Sampling::Inside];
    for (shape, sampling) in shaken().iter().flat_map(|shape| samplings.map(|sampling| (shape, sampling))) {
        let mut solver = solver(shape, sampling);
        solver.fit_all(&shape.positions);
        let gradient = solver.gradient().to_vec();
        let scale = gradient.iter().map(|g| g.abs().max_element()).fold(1.0, f64::max);
        for node in 0..shape.positions.len() {
            for axis in DVec3::AXES {
                let mut energy = |step: f64| {
                    let mut moved = shape.positions.clone();
                    moved[node] += axis * step;
                    solver.fit_all(&moved);
                    solver.energy()
                };
                let h = 2e-5;
                let difference =
                    (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
                let error = (difference - gradient[node].dot(axis)).abs() / scale;
                assert!(error < 1e-7, "node {node} of {}: {error}", shape.positions.len());
            }
        }
        let size = gradient.iter().map(|g| g.length()).sum::<f64>();
        let force: DVec3 = gradient.iter().sum();
        let torque: DVec3 = shape.positions.iter().zip(&gradient).map(|(p, g)| p.cross(*g)).sum();
        let growth: f64 = shape.positions.iter().zip(&gradient).map(|(p, g)| p.dot(*g)).sum();
        assert!(force.length() < 1e-11 * size && torque.length() < 1e-11 * size, "{force} {torque}");
        assert!(growth.abs() < 1e-10 * size, "{growth}");
    }
}

/// `∫ κ₁² + κ₂² dA` of the graph `z = c x y` over the unit disc.
fn exact_saddle(c: f64) -> f64 {
    let n = 400;
    let mut sum = 0.0;
    for i in 0..n {
        let r = (f64::from(i) + 0.5) / f64::from(n);
        for k in 0..n {
            let (sin, cos) = libm::sincos(2.0 * PI * (f64::from(k) + 0.5) / f64::from(n));
            let (x, y) = (r * cos, r * sin);
            let w = 1.0 + c * c * r * r;
            let (mean, gauss) = (-c * c * c * x * y / (w * w.sqrt()), -c * c / (w * w));
            sum += (4.0 * mean * mean - 2.0 * gauss) * w.sqrt() * r;
        }
    }
    sum * 2.0 * PI / f64::from(n * n)
}

/// The errors of a saddle's energy on discs of 12, 24 and 48 rows, shaken along the surface or not.
fn saddle_errors(sampling: Sampling, shake: f64) -> [f64; 3] {
    let c = 0.8;
    let exact = exact_saddle(c);
    [12, 24, 48].map(|rings| {
        let mut shape = workload::disc(rings);
        let mut stream = Stream::new(11);
        for position in &mut shape.positions {
            // The rim stays round.
            let inside = if position.length() < 0.999 { shake / rings as f64 } else { 0.0 };
            let by = inside * stream.vector();
            (position.x, position.y) = (position.x + by.x, position.y + by.y);
            position.z = c * position.x * position.y;
        }
        energy(&shape, sampling) / exact - 1.0
    })
}

fn order(errors: [f64; 3]) -> f64 {
    0.5 * libm::log2((errors[0] / errors[2]).abs())
}

#[test]
fn the_energy_of_a_saddle_that_twists_along_its_rim_converges_at_second_order() {
    for shake in [0.0, 0.2] {
        let everywhere = saddle_errors(Sampling::Everywhere, shake);
        assert!(order(everywhere) < 1.2 && everywhere[2] < -0.01, "{everywhere:?}");
        let inside = saddle_errors(Sampling::Inside, shake);
        assert!(order(inside) > 1.8 && inside[2].abs() < 2e-4, "{inside:?}");
    }
}

#[test]
fn surfaces_without_rims_and_rims_without_inside_are_sampled_as_ever() {
    let mut sphere = workload::sphere(2);
    jitter(&mut sphere, 0.05, 3);
    let mut strip = band(1, 8);
    jitter(&mut strip, 0.1, 4);
    strip.fixed.fill(true);
    for shape in [sphere, strip] {
        let energies = [Sampling::Everywhere, Sampling::Inside].map(|s| energy(&shape, s).to_bits());
        assert_eq!(energies[0], energies[1]);
    }
}

/// A rim that is free, or held by single points, is sampled as ever: its own bending is all that holds it.
#[test]
fn only_rims_that_are_held_are_sampled_from_inside() {
    let mut shape = band(2, 20);
    jitter(&mut shape, 0.05, 5);
    // Every other node of the rims.
    for node in (0..21).step_by(2) {
        (shape.fixed[node], shape.fixed[42 + node]) = (true, true);
    }
    let mut solvers = [Sampling::Everywhere, Sampling::Inside].map(|sampling| solver(&shape, sampling));
    let mut energies = |fixed: Vec<bool>| {
        solvers.each_mut().map(|solver| {
            solver.set_fixed(fixed.clone()).unwrap();
            solver.fit_all(&shape.positions);
            solver.energy()
        })
    };
    let [everywhere, inside] = energies(shape.fixed.clone());
    assert_eq!(everywhere.to_bits(), inside.to_bits());
    // The whole of one rim.
    let one: Vec<bool> = (0..shape.positions.len()).map(|node| node < 21).collect();
    let [_, held] = energies(one);
    assert!((held / everywhere - 1.0).abs() > 1e-3, "{held} beside {everywhere}");
    let [_, free] = energies(vec![false; shape.positions.len()]);
    assert_eq!(free.to_bits(), everywhere.to_bits());
}

#[test]
fn a_plane_that_is_prescribed_at_the_rim_keeps_its_weight() {
    let shape = workload::disc(6);
    let mut positions = shape.positions.clone();
    let mut stream = Stream::new(8);
    for (position, fixed) in positions.iter_mut().zip(&shape.fixed) {
        position.z = if *fixed { 0.0 } else { 0.05 * stream.unit() };
    }
    let rim: Vec<(u32, DVec3)> = (0_u32..)
        .zip(&shape.positions)
        .filter(|(node, _)| *node > 0 && shape.fixed[*node as usize])
        .map(|(node, _)| (node, DVec3::Z))
        .collect();
    // With all of the rim prescribed, no node is left whose fit is half a ring's: both samplings are one.
    let energies = [Sampling::Everywhere, Sampling::Inside].map(|sampling| {
        let mut solver = solver(&shape, sampling);
        solver.set_normals(&rim).unwrap();
        solver.arrive();
        solver.fit_all(&positions);
        solver.energy().to_bits()
    });
    assert_eq!(energies[0], energies[1]);
}

#[test]
fn every_objective_goes_down_its_energy_to_rest() {
    for objective in [Objective::ThinPlate, Objective::Fair, Objective::Neutral] {
        let shape = workload::disc(8);
        let mut solver = solver(&shape, Sampling::Inside);
        solver.set_objectives(Objectives::uniform(objective, 1.0)).unwrap();
        let mut positions = shape.positions.clone();
        workload::carry(&mut solver, &mut positions, 0, DVec3::Z * 0.4).unwrap();
        let is_at_rest = (0..60).any(|_| {
            let report = solver.step(&mut positions, Budget::default()).unwrap();
            assert!(objective == Objective::Neutral || report.energy <= report.energy_before, "{report:?}");
            report.at_rest
        });
        assert!(is_at_rest, "{objective:?}");
    }
}
