//! Curves that meet in a surface: they agree on a plane where they do, and the surface is smooth there.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    Curve, CurveId, Document, Embedding, GrabTarget, PointId, Request, Skeleton, SkeletonVertex, Surface,
    SurfaceId, to_text,
};
use glam::DVec3;

const NORTH: PointId = PointId(1);

/// A sphere of three great circles through both poles and six points of the equator.
fn globe(spacing: f64) -> Document {
    let mut document = Document { name: "Globe".to_owned(), spacing: Some(spacing), ..Document::default() };
    let (north, south) = (NORTH, PointId(2));
    document.points.insert(north, DVec3::Z);
    document.points.insert(south, -DVec3::Z);
    let equator: Vec<PointId> = (3..9).map(PointId).collect();
    for (k, point) in (0_u32..).zip(&equator) {
        let (y, x) = libm::sincos(core::f64::consts::FRAC_PI_3 * f64::from(k));
        document.points.insert(*point, DVec3::new(x, y, 0.0));
    }
    let all: Vec<PointId> = [north, south].into_iter().chain(equator.iter().copied()).collect();
    let mut skeleton = Skeleton {
        vertices: all.into_iter().map(SkeletonVertex::Control).collect(),
        triangles: Vec::new(),
        curves: Vec::new(),
    };
    for k in 0..6 {
        let (here, next) = (2 + k, 2 + (k + 1) % 6);
        skeleton.triangles.push([0, here, next]);
        skeleton.triangles.push([1, next, here]);
    }
    for k in 0..3_u32 {
        let id = CurveId(k + 1);
        let (east, west) = (equator[k as usize], equator[k as usize + 3]);
        document.curves.insert(id, Curve::new(vec![north, east, south, west], true));
        skeleton.curves.push(Embedding { curve: id, along: vec![0, 2 + k, 1, 5 + k] });
    }
    document.surfaces.insert(SurfaceId(1), Surface::new(skeleton));
    document
}

fn open(document: &Document) -> Bench {
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(document) });
    bench.rest(300);
    bench
}

/// How far the directions in which the curves leave the north pole, to second order in the spacing, are out of a plane.
fn out_of_plane(bench: &Bench) -> f64 {
    let tangents: Vec<DVec3> = (1..4)
        .map(|curve| {
            let shape = &bench.modeler.model().curves[&CurveId(curve)];
            let sample = shape.sample_of(NORTH).unwrap();
            let at = |k: usize| shape.nodes[(sample + k) % shape.nodes.len()] - shape.nodes[sample];
            (at(1) * 4.0 - at(2)).try_normalize().unwrap()
        })
        .collect();
    tangents[0].dot(tangents[1].cross(tangents[2]).try_normalize().unwrap()).abs()
}

#[test]
fn great_circles_through_the_poles_agree_and_make_a_sphere() {
    let bench = open(&globe(0.12));
    assert!(out_of_plane(&bench) < 4e-3, "{}", out_of_plane(&bench));
    // A curve through four points of a circle bulges by 0.96 %.
    let model = bench.modeler.model();
    for node in model.curves.values().flat_map(|curve| &curve.nodes) {
        assert!((0.999..1.0115).contains(&node.length()), "{}", node.length());
    }
    let shape = &model.surfaces[&SurfaceId(1)];
    for v in shape.mesh.vertices() {
        assert!((shape.positions[v.index()].length() - 1.0).abs() < 0.02);
    }
}

#[test]
fn a_dragged_hub_tilts_as_a_whole_and_its_surface_is_smooth() {
    let mut bench = open(&globe(0.12));
    bench.accept(Request::Grab(GrabTarget::Point(NORTH)));
    for step in 1..=15 {
        let reply = bench.step(Some(DVec3::Z + DVec3::new(0.05, 0.02, -0.03) * f64::from(step)));
        assert!(reply.frame.figures.energy.is_finite());
    }
    bench.accept(Request::Drop);
    bench.rest(600);
    // Each curve by itself leaves the pole 0.2 out of the plane of the others.
    let (here, again) = (out_of_plane(&bench), out_of_plane(&open(&bench.document())));
    assert!(here < 1e-2 && again < 1e-2, "{here} {again}");
    bench.accept(Request::Undo);
    bench.rest(600);
    assert!(out_of_plane(&bench) < 4e-3, "{}", out_of_plane(&bench));
}
