//! Places: a control point stands where it was pointed at, on the surface or on the curve, and the mesh bears it.

use acceptance::Bench;
use ductile_mesh::measure::{corner_angle, face_normal};
use ductile_mesh::{FaceId, SourceTag, VertexId};
use ductile_modeler::SurfaceShape;
use ductile_spec::{CurveId, Edit, Example, GrabTarget, PointId, Request, SurfaceId};
use glam::DVec3;

/// Shares of a facet's corners: its middle, near a corner, near and on an edge, and odd ones.
const SHARES: [[f64; 3]; 5] =
    [[0.34, 0.33, 0.33], [0.9, 0.06, 0.04], [0.48, 0.49, 0.03], [0.5, 0.5, 0.0], [0.2, 0.1, 0.7]];
/// What rounding to the digits of a document can cost at the examples' size.
const ROUNDING: f64 = 2e-6;
/// What a vertex may do to the corners around it (the modeler's limit is 15°).
const SHARP: f64 = 14.9;

fn shape(bench: &Bench) -> &SurfaceShape {
    &bench.modeler.model().surfaces[&SurfaceId(1)]
}

fn least_angle(shape: &SurfaceShape, face: FaceId) -> f64 {
    let angles = face.halfedges().map(|h| corner_angle(&shape.mesh, &shape.positions, h).to_degrees());
    angles.into_iter().fold(f64::INFINITY, f64::min)
}

/// The vertex that a point controls.
fn vertex_of(shape: &SurfaceShape, point: PointId) -> VertexId {
    shape
        .mesh
        .vertices()
        .find(|v| shape.mesh.vertex_source(*v) == Some(SourceTag(point.0)))
        .expect("a mesh marks its controls")
}

/// A place on a facet.
struct Spot {
    at: DVec3,
    normal: DVec3,
    /// Radius of the corners about the origin.
    radius: f64,
    /// Distance to the nearest controlled vertex, in edges.
    clearance: f64,
}

fn spots(bench: &Bench, every: usize) -> Vec<Spot> {
    let shape = shape(bench);
    let mut spots = Vec::new();
    for (index, face) in shape.mesh.faces().enumerate().filter(|(index, _)| index % every == 0) {
        let share = SHARES[index / every % SHARES.len()];
        let corners = shape.mesh.face_vertices(face).map(|v| shape.positions[v.index()]);
        let at = (0..3).map(|k| corners[k] * share[k]).sum::<DVec3>();
        let radius = (0..3).map(|k| corners[k].length() * share[k]).sum();
        let normal = face_normal(&shape.mesh, &shape.positions, face).normalize_or_zero();
        let far = shape.controlled().map(|v| shape.positions[v.index()].distance(at));
        let clearance = far.fold(f64::INFINITY, f64::min) / shape.spacing;
        spots.push(Spot { at, normal, radius, clearance });
    }
    spots
}

#[test]
fn a_grabbed_place_is_the_very_place_on_the_fitted_surface() {
    for example in [Example::RaisedDisc, Example::Saddle, Example::Ball] {
        let mut bench = Bench::with(example);
        bench.rest(300);
        let spacing = shape(&bench).spacing;
        let mut exact = 0;
        for spot in spots(&bench, 29) {
            let target = GrabTarget::Surface { surface: SurfaceId(1), at: spot.at };
            let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
            let by = grabbed.at - spot.at;
            let aside = by.reject_from_normalized(spot.normal).length();
            if spot.clearance > 1.0 {
                exact += 1;
                // A facet leans against the surface by a fraction of h/R, and the lift is a fraction of h²/R.
                assert!(
                    aside < 0.05 * spacing * spacing + ROUNDING,
                    "{example:?}: {aside} beside {}",
                    spot.at
                );
                assert!(by.length() < 2.0 * spacing * spacing, "{example:?}: lifted by {by} at {}", spot.at);
            }
            if example == Example::Ball {
                let depth = spot.radius - spot.at.length();
                let error = (grabbed.at.length() - spot.radius).abs();
                assert!(
                    error < 0.25 * depth + 0.05 * spacing * spacing,
                    "{error} off the ball, facets {depth}"
                );
            }
            let shape = shape(&bench);
            let vertex = vertex_of(shape, grabbed.point);
            assert_eq!(shape.positions[vertex.index()], grabbed.at, "the mesh passes through the control");
            bench.accept(Request::Cancel);
        }
        assert!(exact > 20, "{example:?}: {exact} places are far enough from controls");
    }
}

#[test]
fn no_triangle_turns_over_or_becomes_a_needle() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(300);
    let before = shape(&bench).mesh.faces().map(|f| least_angle(shape(&bench), f)).fold(90.0, f64::min);
    for spot in spots(&bench, 7) {
        let target = GrabTarget::Surface { surface: SurfaceId(1), at: spot.at };
        let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
        let shape = shape(&bench);
        let mut ring = Vec::new();
        shape.mesh.ring_faces(vertex_of(shape, grabbed.point), &mut ring);
        for face in ring {
            let normal = face_normal(&shape.mesh, &shape.positions, face);
            assert!(normal.dot(spot.normal) > 0.3 * normal.length(), "a triangle turned over at {}", spot.at);
            let angle = least_angle(shape, face);
            assert!(
                angle > SHARP.min(before),
                "a corner of {angle}° at {}, {} edges off",
                spot.at,
                spot.clearance
            );
        }
        bench.accept(Request::Cancel);
    }
}

#[test]
fn taking_hold_leaves_the_shape_as_it_is() {
    let mut bench = Bench::with(Example::RaisedDisc);
    let before = bench.rest(300);
    for spot in spots(&bench, 211) {
        let edit = Edit::Pin { surface: SurfaceId(1), at: spot.at };
        bench.edit(edit);
        let energy = bench.rest(300);
        assert!(
            (energy / before - 1.0).abs() < 0.01,
            "{energy} after a control at {}, {before} before",
            spot.at
        );
        bench.accept(Request::Undo);
        bench.rest(300);
    }
}

#[test]
fn a_grabbed_place_of_a_curve_is_the_very_place_on_the_fair_curve() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let before = bench.modeler.model().curves[&CurveId(1)].clone();
    for edge in (0..before.edge_count()).step_by(3) {
        for t in [0.0, 0.3, 0.5, 0.8] {
            let (a, b) = before.edge(edge);
            let flat = before.nodes[a].lerp(before.nodes[b], t);
            let clearance = before.controls.iter().map(|(_, id)| bench.document().points[id].distance(flat));
            let clearance =
                clearance.fold(f64::INFINITY, f64::min) / before.nodes[a].distance(before.nodes[b]);
            if clearance < 0.3 {
                continue;
            }
            let target = GrabTarget::Curve { curve: CurveId(1), at: flat };
            let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
            let (chord, by) = (before.nodes[b] - before.nodes[a], grabbed.at - flat);
            assert!(
                by.dot(chord).abs() < 0.05 * by.length() * chord.length() + ROUNDING,
                "{by} along {chord}"
            );
            // A chord of a circle of radius 1 lies l² t (1 - t) / 2 under it; this curve is one nearly.
            let lift = 0.5 * chord.length_squared() * t * (1.0 - t);
            assert!((by.length() - lift).abs() < 0.2 * lift + ROUNDING, "{by} at {t} for {lift}");
            let shape = shape(&bench);
            let vertex = vertex_of(shape, grabbed.point);
            assert_eq!(shape.positions[vertex.index()], grabbed.at, "the surface passes through the control");
            bench.accept(Request::Cancel);
        }
    }
}

#[test]
fn the_same_places_give_the_same_bits() {
    let run = || {
        let mut bench = Bench::with(Example::Saddle);
        bench.rest(300);
        for spot in spots(&bench, 311) {
            bench.edit(Edit::Pin { surface: SurfaceId(1), at: spot.at });
            bench.step(None);
        }
        shape(&bench).positions.iter().flat_map(|p| p.to_array()).map(f64::to_bits).collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}
