//! The first promise: the mesh is an approximation, and the shape does not depend on it.
//!
//! One document is solved at several densities. What the coarser meshes say is held against a fine one: every vertex
//! by its distance to the fine surface. The distance must fall with the spacing, and be small beside the model.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_spec::{Example, Request, to_text};
use glam::DVec3;

/// A shape at rest.
struct Solved {
    positions: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
    energy: f64,
}

fn solve(example: Example, spacing: f64) -> Solved {
    let mut document = ductile_modeler::example(example);
    document.spacing = Some(spacing);
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    let energy = bench.rest(600);
    let shape = bench.modeler.model().surfaces.values().next().expect("the document has a surface");
    let mut index = vec![usize::MAX; shape.mesh.vertex_slots()];
    let mut positions = Vec::new();
    for v in shape.mesh.vertices() {
        index[v.index()] = positions.len();
        positions.push(shape.positions[v.index()]);
    }
    let triangles =
        shape.mesh.faces().map(|f| shape.mesh.face_vertices(f).map(|v| index[v.index()])).collect();
    Solved { positions, triangles, energy }
}

/// The point of a triangle nearest to `p`: its projection if it falls inside, else the nearest of the edges'.
fn nearest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let is_inside =
        [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0);
    if is_inside {
        return p - normal * ((p - a).dot(normal) / normal.length_squared());
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let along = ((p - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        from.lerp(to, along)
    };
    [on_edge(a, b), on_edge(b, c), on_edge(c, a)]
        .into_iter()
        .min_by(|one, other| one.distance_squared(p).total_cmp(&other.distance_squared(p)))
        .unwrap()
}

/// Largest and root-mean-square distance of a shape's vertices from another surface.
fn deviation(shape: &Solved, from: &Solved) -> (f64, f64) {
    let corners: Vec<[DVec3; 3]> =
        from.triangles.iter().map(|triangle| triangle.map(|node| from.positions[node])).collect();
    let distances = shape.positions.iter().map(|&p| {
        let near = corners.iter().filter(|corners| corners[0].distance_squared(p) < 0.04);
        near.map(|&corners| nearest_on_triangle(p, corners).distance(p)).fold(f64::INFINITY, f64::min)
    });
    let (worst, sum) = distances.fold((0.0_f64, 0.0), |(worst, sum), d| (worst.max(d), sum + d * d));
    (worst, (sum / shape.positions.len() as f64).sqrt())
}

/// Solves an example at three densities and two of nearly the same spacing, so that the triangulations differ.
fn is_independent(example: Example) {
    let fine = solve(example, 0.05);
    let size = fine.positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let mut errors = Vec::new();
    for (spacing, most) in [(0.2, 0.01), (0.1, 0.004), (0.093, 0.004)] {
        let coarse = solve(example, spacing);
        let (worst, mean) = deviation(&coarse, &fine);
        let energy = (coarse.energy / fine.energy - 1.0).abs();
        println!(
            "{example:?} at {spacing}: {} nodes, worst {:.4} %, rms {:.4} % of the size, energy off by {:.2} %",
            coarse.positions.len(),
            100.0 * worst / size,
            100.0 * mean / size,
            100.0 * energy
        );
        assert!(worst < most * size, "{example:?} at {spacing}: {worst}");
        errors.push(mean);
    }
    // Halving the spacing at the least halves the error: first order, and mostly nearer the second.
    assert!(errors[0] > 2.0 * errors[1] && errors[0] > 2.0 * errors[2], "{example:?}: {errors:?}");
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
