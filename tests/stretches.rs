//! Sweeps between stretches of curves (thesis section 7.3.2).

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use acceptance::kinds::kinds;
use ductile_modeler::Model;
use ductile_spec::{CurveId, Edit, PointId, Request, SpacingOf, SurfaceId, Through, from_text};
use glam::{DVec3, dvec3};

type Stretch = Option<[u32; 2]>;

fn ring(radius: f64, count: u32, z: f64) -> Vec<DVec3> {
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / f64::from(count));
        dvec3(radius * cos, radius * sin, z)
    };
    (0..count).map(corner).collect()
}

/// Curves through places: points count from 1.
fn curves(all: &[(Vec<DVec3>, bool)]) -> Bench {
    let mut bench = Bench::new();
    for (through, closed) in all {
        let through = through.iter().map(|at| Through::Place(*at)).collect();
        bench.edit(Edit::Curve { through, closed: *closed });
    }
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.15) });
    bench.rest(600);
    bench
}

fn sweep([from, to]: [u32; 2], stretches: [Stretch; 2]) -> Edit {
    let stretches = stretches.map(|ends| ends.map(|ends| ends.map(PointId)));
    Edit::Sweep { from: CurveId(from), to: CurveId(to), stretches, reversed: false }
}

fn act(bench: &mut Bench, edit: &Edit) -> Vec<(SurfaceId, (i64, usize, bool))> {
    let before = bench.document.clone();
    bench.edit(edit.clone());
    let after = bench.document.clone();
    let again = Model::from_document(from_text(&after).unwrap()).unwrap();
    assert_eq!(kinds(&again), kinds(bench.modeler.model()), "{after}");
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
    bench.accept(Request::Redo);
    assert_eq!(bench.document, after);
    kinds(bench.modeler.model())
}

/// The samples of all curves.
fn samples(bench: &Bench) -> Vec<DVec3> {
    bench.modeler.model().curves.values().flat_map(|curve| curve.nodes.clone()).collect()
}

/// How far places lie from the chords between samples, at most.
fn off(bench: &Bench, places: &[DVec3]) -> f64 {
    let mut chords = Vec::new();
    for curve in bench.modeler.model().curves.values() {
        chords.extend((0..curve.edge_count()).map(|k| {
            let (a, b) = curve.edge(k);
            (curve.nodes[a], curve.nodes[b])
        }));
    }
    let distance = |at: DVec3, (a, b): &(DVec3, DVec3)| {
        let t = ((at - *a).dot(*b - *a) / (*b - *a).length_squared()).clamp(0.0, 1.0);
        at.distance(a.lerp(*b, t))
    };
    let nearest = |at: &DVec3| chords.iter().map(|chord| distance(*at, chord)).fold(f64::INFINITY, f64::min);
    places.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_strip_lies_between_stretches_of_two_rings_whose_shapes_stay() {
    let mut bench = curves(&[(ring(1.0, 6, 0.0), true), (ring(0.8, 5, 1.0), true)]);
    let before = samples(&bench);
    // From the first point forward to the third; round through the first of the other.
    let made = act(&mut bench, &sweep([1, 2], [Some([1, 3]), Some([11, 8])]));
    assert_eq!(made, [(SurfaceId(1), (1, 1, true))]);
    let document = bench.document();
    let through = |id: u32| document.curves[&CurveId(id)].through.iter().map(|p| p.0).collect::<Vec<_>>();
    let all: Vec<_> = document.curves.keys().map(|id| through(id.0)).collect();
    assert_eq!(all, [vec![1, 2, 3], vec![3, 4, 5, 6, 1], vec![8, 9, 10, 11], vec![11, 7, 8]]);
    let rims: Vec<_> =
        document.surfaces[&SurfaceId(1)].skeleton.curves.iter().map(|e| through(e.curve.0)).collect();
    assert_eq!(rims, [vec![1, 2, 3], vec![11, 7, 8]]);
    bench.rest(900);
    let off = off(&bench, &before);
    println!("the rings are off by {off:.2e}");
    assert!(off < 4e-3, "{off}");
}

#[test]
fn a_stretch_of_a_rim_is_swept_and_the_surface_follows_its_parts() {
    let line = vec![dvec3(1.5, -0.6, 0.8), dvec3(1.6, 0.0, 0.9), dvec3(1.5, 0.6, 0.8)];
    let mut bench = curves(&[(ring(1.0, 8, 0.0), true), (line, false)]);
    bench.edit(Edit::Sheet { boundary: CurveId(1) });
    bench.rest(600);
    let made = act(&mut bench, &sweep([1, 2], [Some([8, 2]), None]));
    assert_eq!(made, [(SurfaceId(1), (1, 1, true)), (SurfaceId(2), (1, 1, true))]);
    let document = bench.document();
    let on =
        |id| document.surfaces[&SurfaceId(id)].skeleton.curves.iter().map(|e| e.curve).collect::<Vec<_>>();
    let shared: Vec<_> = on(1).into_iter().filter(|curve| on(2).contains(curve)).collect();
    assert_eq!((on(1).len(), shared.len()), (2, 1), "both follow the stretch");
    bench.rest(900);
    // The common stretch is moved, and both come along.
    let to = dvec3(1.1, 0.0, 0.3);
    bench.edit(Edit::Move { point: PointId(1), to });
    bench.rest(900);
    for shape in bench.modeler.model().surfaces.values() {
        assert!(shape.positions.iter().any(|at| at.distance(to) < 1e-9));
    }
}

#[test]
fn two_stretches_may_be_of_one_curve() {
    let mut bench = curves(&[(ring(1.0, 8, 0.0), true)]);
    let made = act(&mut bench, &sweep([1, 1], [Some([1, 3]), Some([5, 7])]));
    assert_eq!(made, [(SurfaceId(1), (1, 1, true))]);
    assert_eq!(bench.document().curves.len(), 4);
    bench.rest(900);
    // On an open curve it does not matter which end comes first, and a whole one is not divided.
    let lines = [0.0, 1.0].map(|y| ((0..5).map(|k| dvec3(f64::from(k), y, 0.1 * y)).collect(), false));
    let mut bench = curves(&lines);
    let made = act(&mut bench, &sweep([1, 2], [Some([4, 2]), Some([6, 10])]));
    assert_eq!(made, [(SurfaceId(1), (1, 1, true))]);
    assert_eq!(bench.document().curves.len(), 4);
    bench.rest(900);
}

#[test]
fn what_is_no_stretch_is_refused_with_a_reason() {
    let line = vec![dvec3(0.0, 0.0, 2.0), dvec3(1.0, 0.0, 2.0)];
    let mut bench = curves(&[(ring(1.0, 6, 0.0), true), (ring(1.0, 6, 1.0), true), (line, false)]);
    for (curves, stretches, why) in [
        ([1, 2], [Some([1, 3]), None], "closed"),
        ([1, 3], [None, None], "closed"),
        ([1, 1], [Some([1, 3]), None], "two different curves"),
        ([1, 1], [Some([1, 4]), Some([3, 5])], "overlap"),
        ([1, 1], [Some([1, 3]), Some([3, 5])], "point 3"),
        ([1, 1], [Some([1, 3]), Some([1, 3])], "overlap"),
        ([1, 2], [Some([1, 1]), Some([7, 9])], "two different control points"),
        ([1, 2], [Some([1, 9]), Some([7, 9])], "does not pass through point 9"),
        ([9, 2], [Some([1, 3]), Some([7, 9])], "curve 9 does not exist"),
    ] {
        let before = bench.document.clone();
        let told = bench.send(Request::Edit(sweep(curves, stretches))).refused.unwrap().reason;
        assert!(told.contains(why), "{curves:?} {stretches:?}: {told}");
        assert_eq!(bench.document, before);
    }
}
