//! The first promise: the mesh is an approximation, and the shape does not depend on it.
//!
//! One document is solved at several densities. What the coarser meshes say is held against a fine one: every vertex
//! by its distance to the fine surface. The distance must fall with the spacing, and be small beside the model.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use acceptance::shapes::{ridged_saddle, torus};
use acceptance::solved::{Solved, deviation, opened, solve, solved};
use ductile_spec::{Document, Edit, Example, GrabTarget, Request};
use glam::dvec3;

/// Solves an example at three densities and two of nearly the same spacing, so that the triangulations differ.
fn is_independent(example: Example) {
    let name = format!("{example:?}");
    let example = &ductile_modeler::example(example);
    let fine = solve(example, 0.05);
    let size = fine.positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let mut errors = Vec::new();
    for (spacing, most) in [(0.2, 0.01), (0.1, 0.004), (0.093, 0.004)] {
        let coarse = solve(example, spacing);
        let (worst, mean) = deviation(&coarse, &fine);
        let energy = (coarse.energy / fine.energy - 1.0).abs();
        println!(
            "{name} at {spacing}: {} nodes, worst {:.4} %, rms {:.4} % of the size, energy off by {:.2} %",
            coarse.positions.len(),
            100.0 * worst / size,
            100.0 * mean / size,
            100.0 * energy
        );
        assert!(worst < most * size, "{name} at {spacing}: {worst}");
        errors.push(mean);
    }
    // Halving the spacing at the least halves the error: first order, and mostly nearer the second.
    assert!(errors[0] > 2.0 * errors[1] && errors[0] > 2.0 * errors[2], "{name}: {errors:?}");
}

#[test]
fn a_raised_disc_is_the_same_on_any_mesh() {
    is_independent(Example::RaisedDisc);
}

#[test]
fn a_cylinder_is_the_same_on_any_mesh() {
    is_independent(Example::Cylinder);
}

#[test]
fn a_closed_surface_on_six_points_is_the_same_on_any_mesh() {
    is_independent(Example::Ball);
}

#[test]
fn a_saddle_is_the_same_on_any_mesh() {
    is_independent(Example::Saddle);
}

/// Leads some control points out and home again, in directions of its own for each seed. The document is as before; the
/// triangulation, edited on the way, is not.
fn scramble(bench: &mut Bench, seed: u32, reach: f64) {
    let points: Vec<_> = bench.document().points.into_iter().collect();
    for (place, (point, home)) in
        points.iter().enumerate().filter(|(place, _)| place % 3 == seed as usize % 3)
    {
        let angle = 2.4 * (f64::from(seed) + 3.0 * place as f64);
        let (sin, cos) = libm::sincos(angle);
        let out = dvec3(cos, sin, libm::sin(0.7 * angle)) * reach;
        bench.accept(Request::Grab(GrabTarget::Point(*point)));
        for step in (1..=16).chain((0..16).rev()) {
            bench.step(Some(*home + out * (f64::from(step) / 16.0)));
            bench.step(Some(*home + out * (f64::from(step) / 16.0)));
        }
        bench.accept(Request::Drop);
        bench.edit(Edit::Move { point: *point, to: *home });
    }
}

/// Solves a document at h, h/2 and h/4, and at h/2 on three scrambled triangulations.
fn is_independent_of_scrambling(name: &str, document: &Document, coarse: f64, most: f64) {
    let fine = solve(document, 0.25 * coarse);
    let size = fine.positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let measure = |shape: &Solved, what: &str| {
        let (worst, mean) = deviation(shape, &fine);
        println!(
            "{name}, {what}: {} nodes, worst {:.4} %, rms {:.4} % of the size",
            shape.positions.len(),
            100.0 * worst / size,
            100.0 * mean / size
        );
        (worst, mean)
    };
    let (_, first) = measure(&solve(document, coarse), "h");
    let mut bench = opened(document, 0.5 * coarse);
    let half = solved(&mut bench);
    let (worst, second) = measure(&half, "h/2");
    assert!(worst < most * size, "{name}: {worst}");
    assert!(first > 2.0 * second, "{name}: {first} {second}");
    for seed in 0..3 {
        scramble(&mut bench, seed, 0.2);
        let scrambled = solved(&mut bench);
        assert_ne!(scrambled.triangles, half.triangles, "{name}: nothing was scrambled");
        let (worst, mean) = measure(&scrambled, "h/2, scrambled");
        assert!(worst < most * size, "{name}: {worst}");
        assert!(first > 2.0 * mean, "{name}: {first} {mean}");
        let energy = (scrambled.energy / half.energy - 1.0).abs();
        assert!(energy < 5e-3, "{name}: energy off by {energy}");
    }
}

#[test]
fn a_torus_of_three_curves_is_the_same_on_any_mesh() {
    is_independent_of_scrambling("torus", &torus(), 0.5, 0.008);
}

#[test]
fn a_saddle_with_a_curve_inside_is_the_same_on_any_mesh() {
    is_independent_of_scrambling("ridged saddle", &ridged_saddle(), 0.16, 0.008);
}
