//! Objectives beside the thin plate: exact gradients, known minimisers, and regions that meet.

#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use ductile_solver::workload::{self, Stream, Workload};
use ductile_solver::{Budget, Frozen, Objective, Objectives, SolverError, SurfaceSolver};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const PI: f64 = std::f64::consts::PI;

fn solver(shape: &Workload, objective: Objective, radius: f64) -> SurfaceSolver {
    let mut solver = shape.solver().unwrap();
    solver.set_objectives(Objectives::uniform(objective, radius)).unwrap();
    solver
}

fn jitter(shape: &mut Workload, amount: f64, seed: u64) {
    let mut stream = Stream::new(seed);
    for position in &mut shape.positions {
        *position += amount * stream.vector();
    }
}

/// Steps until rest and checks on the way that the energy never rises; returns the steps.
fn relax(solver: &mut SurfaceSolver, positions: &mut [DVec3], iterations: u32, limit: usize) -> usize {
    for step in 1..=limit {
        let report = solver.step(positions, Budget { iterations }).unwrap();
        assert!(report.energy <= report.energy_before, "{report:?}");
        if report.at_rest {
            return step;
        }
    }
    panic!("no rest within {limit} steps");
}

/// Largest error of the gradient against fourth-order differences, relative to the largest entry.
fn gradient_error(solver: &mut SurfaceSolver, positions: &[DVec3]) -> f64 {
    solver.evaluate(positions);
    let gradient = solver.gradient().to_vec();
    let scale = gradient.iter().map(|g| g.abs().max_element()).fold(1e-3, f64::max);
    let mut worst = 0.0_f64;
    let mut moved = positions.to_vec();
    for node in 0..positions.len() {
        for axis in DVec3::AXES {
            let mut energy = |step: f64| {
                moved[node] = positions[node] + axis * step;
                solver.fit_all(&moved);
                moved[node] = positions[node];
                solver.energy()
            };
            let h = 2e-5;
            let slope = (8.0 * (energy(h) - energy(-h)) - (energy(2.0 * h) - energy(-2.0 * h))) / (12.0 * h);
            worst = worst.max((slope - gradient[node].dot(axis)).abs() / scale);
        }
    }
    worst
}

/// Sum, torque and virial of the gradient, relative to the sum of its lengths.
fn balance(solver: &mut SurfaceSolver, positions: &[DVec3]) -> (f64, f64, f64) {
    solver.evaluate(positions);
    let gradient = solver.gradient().to_vec();
    let scale: f64 = gradient.iter().map(|g| g.length()).sum();
    let sum: DVec3 = gradient.iter().sum();
    let torque: DVec3 = positions.iter().zip(&gradient).map(|(p, g)| p.cross(*g)).sum();
    let virial: f64 = positions.iter().zip(&gradient).map(|(p, g)| p.dot(*g)).sum();
    (sum.length() / scale, torque.length() / scale, virial)
}

fn rough_shapes() -> Vec<Workload> {
    let mut shapes = vec![workload::disc(4), workload::sphere(1), workload::moebius(14, 3, 0.4)];
    for (shape, seed) in shapes.iter_mut().zip(1..) {
        jitter(shape, 0.04, seed);
    }
    shapes
}

#[test]
fn gradients_are_exact() {
    for shape in rough_shapes() {
        for objective in [Objective::ThinPlate, Objective::Fair, Objective::Membrane] {
            let error = gradient_error(&mut solver(&shape, objective, 1.3), &shape.positions);
            assert!(error < 1e-7, "{objective:?}: {error}");
        }
    }
}

#[test]
fn the_gradient_of_regions_side_by_side_is_exact() {
    for shape in rough_shapes() {
        let kinds = [Objective::ThinPlate, Objective::Fair, Objective::Membrane];
        let choice = (0..shape.triangles.len()).map(|triangle| kinds[triangle * 3 / shape.triangles.len()]);
        let mut solver = shape.solver().unwrap();
        solver.set_objectives(Objectives::by_triangle(choice.collect(), 0.7)).unwrap();
        let error = gradient_error(&mut solver, &shape.positions);
        assert!(error < 1e-7, "{error}");
    }
}

#[test]
fn gradients_balance_and_scale_as_their_energies_do() {
    let mut shape = workload::torus(18, 9, 2.0, 0.8);
    jitter(&mut shape, 0.03, 5);
    // Degree of homogeneity in the positions: an area has 2, the others have none.
    for objective in [Objective::Fair, Objective::Membrane, Objective::ThinPlate] {
        let mut solver = solver(&shape, objective, 1.0);
        let (sum, torque, virial) = balance(&mut solver, &shape.positions);
        assert!(sum < 1e-12 && torque < 1e-11, "{objective:?}: {sum} {torque}");
        let energy = solver.energy();
        let wanted = if objective == Objective::Membrane { 2.0 * energy } else { 0.0 };
        assert!((virial - wanted).abs() < 1e-9 * energy, "{objective:?}: {virial} for {wanted}");
    }
}

/// `∫ |∇L|²` of a torus, by the trapezoidal rule over the exact integrand.
///
/// The curvature around the axis is `k = cos v / w` with `w = R + r cos v`, that around the tube is constant. Of `∇L` only
/// `dk/ds = -R sin v / (r w²)` is not zero; by Codazzi's equation it stands in three places.
fn exact_torus(major: f64, minor: f64) -> f64 {
    let steps = 2000;
    let mut sum = 0.0;
    for i in 0..steps {
        let (sin, cos) = libm::sincos(2.0 * PI * f64::from(i) / f64::from(steps));
        let w = major + minor * cos;
        let derivative = -major * sin / (minor * w * w);
        sum += 3.0 * derivative * derivative * w * minor;
    }
    sum * (2.0 * PI / f64::from(steps)) * 2.0 * PI
}

#[test]
fn the_variation_of_a_torus_converges_to_its_integral() {
    let exact = exact_torus(2.0, 1.0);
    assert!((exact - 45.59).abs() < 0.01, "{exact}");
    // 4π² R r, over that of the unit sphere.
    let area = 2.0 * PI;
    let error = |around, across| {
        let torus = workload::torus(around, across, 2.0, 1.0);
        let mut solver = solver(&torus, Objective::Fair, 1.0);
        let mut plate = torus.solver().unwrap();
        solver.fit_all(&torus.positions);
        plate.fit_all(&torus.positions);
        ((solver.energy() - plate.energy() / 900.0) / (exact * area) - 1.0).abs()
    };
    let (coarse, fine) = (error(48, 24), error(96, 48));
    assert!(fine < 0.01, "{fine}");
    let order = libm::log2(coarse / fine);
    assert!(order > 1.8, "{order}");
}

#[test]
fn spheres_and_cylinders_cost_no_variation() {
    for shape in [workload::sphere(3), workload::cylinder(24, 12, 3.0)] {
        let mut fair = solver(&shape, Objective::Fair, 1.0);
        let mut plate = shape.solver().unwrap();
        fair.fit_all(&shape.positions);
        plate.fit_all(&shape.positions);
        let variation = fair.energy() - plate.energy() / 900.0;
        assert!(variation < 1e-3 * plate.energy(), "{variation}");
    }
}

#[test]
fn six_points_of_a_sphere_make_a_sphere_again() {
    let mut shape = workload::sphere(3);
    workload::pin_axes(&mut shape);
    let mut stream = Stream::new(7);
    for (position, _) in shape.positions.iter_mut().zip(&shape.fixed).filter(|(_, fixed)| !**fixed) {
        let wave = 0.08 * libm::sin(3.0 * position.x) * libm::cos(2.0 * position.y + 1.0);
        *position *= 1.0 + wave + 0.002 * stream.unit();
    }
    let mut solver = solver(&shape, Objective::Fair, 1.7);
    let mut positions = shape.positions.clone();
    relax(&mut solver, &mut positions, 30, 12);
    let worst = positions.iter().map(|p| (p.length() - 1.0).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-4, "{worst}");
}

/// The waist of a cylinder between two circles after rest, started with a bulge.
fn waist(length: f64, along: u32, bulge: f64, objective: Objective) -> f64 {
    let mut shape = workload::cylinder(24, along, length);
    for (position, _) in shape.positions.iter_mut().zip(&shape.fixed).filter(|(_, fixed)| !**fixed) {
        let swell = 1.0 + bulge * libm::cos(PI * position.z / length);
        (position.x, position.y) = (position.x * swell, position.y * swell);
    }
    let radius = 0.5 * (length * length + 8.0).sqrt();
    let mut solver = solver(&shape, objective, radius);
    let mut positions = shape.positions.clone();
    for _ in 0..80 {
        if solver.step(&mut positions, Budget { iterations: 60 }).unwrap().at_rest {
            break;
        }
    }
    let middle = positions.iter().filter(|p| p.z.abs() < 0.6 * length / f64::from(along));
    let radii: Vec<f64> = middle.map(|p| p.truncate().length()).collect();
    radii.iter().sum::<f64>() / radii.len() as f64
}

#[test]
fn a_bulged_tube_becomes_a_cylinder_again() {
    let fair = waist(4.0, 16, 0.1, Objective::Fair);
    let plate = waist(4.0, 16, 0.1, Objective::ThinPlate);
    assert!((fair - 1.0).abs() < 1e-3, "{fair}");
    assert!(plate > 1.05, "{plate}");
}

#[test]
fn neutral_tubes_keep_their_radius_where_the_plate_bulges() {
    let neutral = waist(2.0, 8, 0.05, Objective::Neutral);
    let plate = waist(2.0, 8, 0.05, Objective::ThinPlate);
    assert!((neutral - 1.0).abs() < 2e-3, "{neutral}");
    assert!((plate - 1.098).abs() < 0.01, "{plate}");
}

#[test]
fn neutral_rests_where_the_frozen_scheme_does() {
    let (mut frozen, mut expected) = workload::raised_disc(8, 0.5).unwrap();
    assert!((0..200).any(|_| frozen.frozen_step(&mut expected, Frozen::Neutral).unwrap() < 1e-9));
    let (mut solver, mut positions) = workload::raised_disc(8, 0.5).unwrap();
    solver.set_objectives(Objectives::uniform(Objective::Neutral, 1.0)).unwrap();
    let steps = (1..60).find(|_| solver.step(&mut positions, Budget { iterations: 60 }).unwrap().at_rest);
    // Nodes move along normals of their own on the way, so a measure of the surface is compared.
    let highest =
        |positions: &[DVec3]| positions.iter().map(|p| p.z * p.truncate().length()).fold(0.0, f64::max);
    assert!(steps.is_some());
    assert!((highest(&positions) - highest(&expected)).abs() < 1e-5);
}

#[test]
fn a_membrane_between_circles_is_a_catenoid() {
    // r(z) = a cosh(z / a) with r(L / 2) = 1: the wide one of the two, by bisection.
    let length: f64 = 0.8;
    let (mut low, mut high) = (0.6_f64, 1.0_f64);
    for _ in 0..80 {
        let a = 0.5 * (low + high);
        if a * libm::cosh(0.5 * length / a) > 1.0 { high = a } else { low = a }
    }
    let exact = low;
    let error = |around, along| {
        let shape = workload::cylinder(around, along, length);
        let mut solver = solver(&shape, Objective::Membrane, 1.0);
        let mut positions = shape.positions.clone();
        relax(&mut solver, &mut positions, 40, 60);
        let least = positions.iter().map(|p| p.truncate().length()).fold(f64::INFINITY, f64::min);
        (least - exact).abs()
    };
    let (coarse, fine) = (error(24, 4), error(48, 8));
    assert!(fine < 2e-3 && coarse / fine > 3.0, "{coarse} {fine}");
}

#[test]
fn a_fair_raised_disc_is_a_cap_of_a_sphere() {
    let (_, start) = workload::raised_disc(12, 0.5).unwrap();
    let mut shape = workload::disc(12);
    shape.positions = start;
    let mut solver = solver(&shape, Objective::Fair, 1.0);
    let mut positions = shape.positions.clone();
    relax(&mut solver, &mut positions, 40, 30);
    // Through the unit circle and (0, 0, 0.5): radius 1.25, centre at -0.75.
    let worst = positions.iter().map(|p| ((*p + 0.75 * DVec3::Z).length() - 1.25).abs()).fold(0.0, f64::max);
    assert!(worst < 1e-4, "{worst}");
}

/// A square sheet of `2 n` by `2 n` cells of size `1 / n`, raised to a hill that leans; rim and middle line are held.
fn halved(n: u32) -> Workload {
    let rows = 2 * n + 1;
    let (mut positions, mut fixed, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for j in 0..rows {
        for i in 0..rows {
            let [x, y] = [i, j].map(|k| f64::from(k) / f64::from(n) - 1.0);
            let hill = 0.3 * libm::cos(0.5 * PI * x) * libm::cos(0.5 * PI * y);
            positions.push(DVec3::new(x, y, hill * (1.0 + 0.4 * y)));
            fixed.push([0, n, 2 * n].contains(&j) || i == 0 || i == 2 * n);
            if i + 1 < rows && j + 1 < rows {
                let at = |i: u32, j: u32| j * rows + i;
                let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
                if (i + j) % 2 == 0 {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
    }
    Workload { positions, triangles, fixed }
}

/// The largest jump of slope and of second derivative across the middle line, away from its ends, seen from either side alone.
fn jumps(n: u32, positions: &[DVec3]) -> [f64; 2] {
    let (h, rows) = (1.0 / f64::from(n), 2 * n + 1);
    let mut most = [0.0_f64; 2];
    for i in n / 2..=n + n / 2 {
        let z = |k: i64| {
            positions[usize::try_from((i64::from(n) + k) * i64::from(rows) + i64::from(i)).unwrap()].z
        };
        let side = |s: i64| {
            let slope = (-11.0 * z(0) + 18.0 * z(s) - 9.0 * z(2 * s) + 2.0 * z(3 * s)) / (6.0 * h);
            let bend = (2.0 * z(0) - 5.0 * z(s) + 4.0 * z(2 * s) - z(3 * s)) / (h * h);
            [slope * s as f64, bend]
        };
        let (up, down) = (side(1), side(-1));
        most = [0, 1].map(|k| most[k].max((up[k] - down[k]).abs()));
    }
    most
}

/// The jumps across the middle line of a halved sheet at rest, on three sheets each twice as fine as the one before, and the
/// orders at which they fall.
fn meeting(one: Objective, other: Objective) -> ([[f64; 2]; 3], [[f64; 2]; 2]) {
    let measured = [8, 16, 32].map(|n| {
        let shape = halved(n);
        let is_upper =
            |t: &[u32; 3]| t.iter().map(|&node| shape.positions[node as usize].y).sum::<f64>() > 0.0;
        let choice = shape.triangles.iter().map(|t| if is_upper(t) { one } else { other }).collect();
        let mut solver = shape.solver().unwrap();
        solver.set_objectives(Objectives::by_triangle(choice, 1.0)).unwrap();
        let mut positions = shape.positions.clone();
        let rests = (0..120).any(|_| solver.step(&mut positions, Budget { iterations: 60 }).unwrap().at_rest);
        assert!(rests, "{one:?} beside {other:?}");
        assert!(positions.iter().all(|p| p.is_finite()));
        jumps(n, &positions)
    });
    let orders = [0, 1].map(|k| [0, 1].map(|what| libm::log2(measured[k][what] / measured[k + 1][what])));
    println!("{one:?} | {other:?}: slope and bend jump by {measured:.4?}, orders {orders:.2?}");
    (measured, orders)
}

/// Curvature, too, where both sides have the same order of equation. Where only one prices its variation, that of the other is
/// free at the line.
#[test]
fn regions_meet_smoothly() {
    use Objective::{Fair, Neutral, ThinPlate};
    for (one, other, has_bend) in [
        (ThinPlate, ThinPlate, true),
        (Fair, Fair, true),
        (Neutral, ThinPlate, true),
        (ThinPlate, Fair, false),
        (Neutral, Fair, false),
    ] {
        let (jumps, orders) = meeting(one, other);
        let says = format!("{one:?} | {other:?}: {jumps:?}, {orders:?}");
        assert!(orders[0][0] > 0.2 && orders[1][0] > 0.7 && jumps[2][0] < 0.05, "slope, {says}");
        assert!(!has_bend || orders.iter().all(|of| of[1] > 1.1) && jumps[2][1] < 0.02, "bend, {says}");
    }
}

/// A film has no bending by which it could meet anything but the line: along a curve that is held it stands at an angle.
#[test]
fn a_film_meets_other_regions_at_an_angle() {
    for one in [Objective::ThinPlate, Objective::Fair] {
        let (jumps, _) = meeting(one, Objective::Membrane);
        assert!(jumps.iter().all(|of| of[0] > 0.5), "{one:?}: {jumps:?}");
    }
}

#[test]
fn a_choice_for_other_triangles_is_refused() {
    let shape = workload::disc(2);
    let mut solver = shape.solver().unwrap();
    let choice = vec![Objective::Fair, Objective::Membrane];
    let found = choice.len();
    assert_eq!(
        solver.set_objectives(Objectives::by_triangle(choice, 1.0)),
        Err(SolverError::Length { expected: shape.triangles.len(), found })
    );
}
