//! Long play: after hundreds of drags there and back the shape is what it was, and its triangles are good.
//!
//! Thesis figures 2.9, 5.6 and 8.2: there the meshes decay. Here a shape at rest is what its document opens to, whatever way it came, so
//! that what is left is where the controls came back to.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::{Bench, shapes};
use ductile_modeler::SurfaceShape;
use ductile_spec::{CurveId, Document, Example, GrabTarget, PointId, Request, to_text};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// Of the smallest angles of all triangles, in degrees, the least and the first percentile.
fn quality(shape: &SurfaceShape) -> (f64, f64) {
    let mut angles = Vec::new();
    for face in shape.mesh.faces() {
        let corners = shape.mesh.face_vertices(face).map(|v| shape.positions[v.index()]);
        let angle = |k: usize| {
            let (one, other) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
            one.angle_between(other).to_degrees()
        };
        angles.push((0..3).map(angle).fold(180.0, f64::min));
    }
    angles.sort_by(f64::total_cmp);
    (angles[0], angles[angles.len() / 100])
}

fn surface(bench: &Bench) -> &SurfaceShape {
    bench.modeler.model().surfaces.values().next().unwrap()
}

fn highest(bench: &Bench) -> (PointId, DVec3) {
    let document = bench.document();
    let (id, at) = document.points.iter().max_by(|a, b| a.1.z.total_cmp(&b.1.z)).unwrap();
    (*id, *at)
}

/// Compares a shape that came back with what it was.
fn is_as_before(bench: &mut Bench, energy: f64, nodes: usize) {
    let after = bench.rest(600);
    let count = surface(bench).mesh.vertices().count();
    assert_eq!(bench.modeler.kept(), 0, "the shape did not settle");
    // All triangles, those at the controls too; `quality` asks more of the others.
    let (least, percentile) = quality(surface(bench));
    println!(
        "{count} nodes, energy {energy} -> {after}, least angle {least:.1}, first percentile {percentile:.1}"
    );
    assert!(least > 28.0 && percentile > 37.0, "least angle {least:.1}, first percentile {percentile:.1}");
    assert!((after / energy - 1.0).abs() < 1e-6, "energy {energy} became {after}");
    assert_eq!(count, nodes, "{nodes} nodes became {count}");
}

#[test]
fn a_point_goes_a_hundred_times_round_the_disc() {
    let mut bench = Bench::with(Example::RaisedDisc);
    let energy = bench.rest(600);
    let nodes = surface(&bench).mesh.vertices().count();
    let (point, home) = highest(&bench);
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    for turn in 0..100 {
        for part in 0..8 {
            let angle = TAU * (f64::from(turn) + f64::from(part) / 8.0);
            let aside = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0) * 0.35;
            bench.step(Some(home + aside));
        }
    }
    // A little beside, and home in a second drag: one that ends where it began is no drag, and puts the old mesh back.
    for _ in 0..20 {
        bench.step(Some(home + DVec3::X * 0.002));
    }
    assert!(bench.accept(Request::Drop).committed.is_some());
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    for _ in 0..20 {
        bench.step(Some(home));
    }
    assert!(bench.accept(Request::Drop).committed.is_some());
    is_as_before(&mut bench, energy, nodes);
}

/// Turns points about the z axis, one after the other, by a twelfth of a turn each time: round once and back.
fn twists_round_and_back(bench: &mut Bench, points: &[(PointId, DVec3)]) {
    let start = bench.document();
    for twelfth in (1..=12).chain((0..12).rev()) {
        let turn = DQuat::from_rotation_z(TAU * f64::from(twelfth) / 12.0);
        for (id, from) in points {
            bench.accept(Request::Grab(GrabTarget::Point(*id)));
            for _ in 0..3 {
                bench.step(Some(turn * *from));
            }
            bench.accept(Request::Drop);
        }
        for _ in 0..6 {
            bench.step(None);
        }
    }
    let back = bench.document();
    for (id, from) in &start.points {
        assert!(back.points[id].distance(*from) < 1e-5, "{id} is not back");
    }
}

#[test]
fn a_twist_round_and_back_leaves_no_trace() {
    let mut bench = Bench::with(Example::Cylinder);
    let energy = bench.rest(600);
    let nodes = surface(&bench).mesh.vertices().count();
    // The points of the upper curve.
    let start = bench.document();
    let top = start.points.values().map(|at| at.z).fold(f64::NEG_INFINITY, f64::max);
    let upper: Vec<(PointId, DVec3)> =
        start.points.iter().filter(|(_, at)| at.z > top - 1e-6).map(|(id, at)| (*id, *at)).collect();
    assert!(upper.len() >= 3);
    twists_round_and_back(&mut bench, &upper);
    is_as_before(&mut bench, energy, nodes);
}

/// Figures 2.9 and 8.2: the curve lies inside the surface, which is wound up on both sides of it and unwound again.
fn a_curve_inside_is_twisted(document: &Document, spacing: f64) {
    let mut bench = Bench::new();
    let mut document = Document { spacing: Some(spacing), ..document.clone() };
    // As a document keeps places after a drag: what comes back is this very document, and no other one a rounding away.
    document.points.values_mut().for_each(|at| *at = (*at * 1e4).round() / 1e4);
    bench.accept(Request::OpenText { text: to_text(&document) });
    let energy = bench.rest(600);
    let nodes = surface(&bench).mesh.vertices().count();
    let inside: Vec<(PointId, DVec3)> =
        document.curves[&CurveId(2)].through.iter().map(|id| (*id, document.points[id])).collect();
    let embedded = surface(&bench).embeddings.iter().find(|e| e.curve == CurveId(2)).unwrap();
    assert!(embedded.vertices.iter().all(|v| !surface(&bench).mesh.is_boundary_vertex(*v)), "it is a rim");
    twists_round_and_back(&mut bench, &inside);
    is_as_before(&mut bench, energy, nodes);
}

#[test]
fn a_ring_round_a_tube_is_twisted_round_and_back_and_leaves_no_trace() {
    a_curve_inside_is_twisted(&shapes::waisted(0.9, 1.0), 0.15);
}

#[test]
fn a_closed_curve_in_a_disc_is_twisted_round_and_back_and_leaves_no_trace() {
    a_curve_inside_is_twisted(&shapes::ringed_saddle(), 0.1);
}
