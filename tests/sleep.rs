//! Far bays of a surface sleep through a drag and wake for the rest; nobody can tell from the shape.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    Curve, CurveId, Document, Embedding, GrabTarget, PointId, Request, Skeleton, SkeletonVertex, Surface,
    SurfaceId, to_text,
};
use glam::{DVec3, dvec3};

/// A tube on nine circles through four points each: eight bays of about 470 nodes.
fn tube() -> Document {
    let levels = 9_u32;
    let mut document = Document { spacing: Some(0.09), ..Document::default() };
    let (mut triangles, mut curves) = (Vec::new(), Vec::new());
    for level in 0..levels {
        let mut through = Vec::new();
        for k in 0..4_u32 {
            let id = PointId(4 * level + k + 1);
            let (x, y) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][k as usize];
            document.points.insert(id, dvec3(x, y, 0.7 * f64::from(level)));
            through.push(id);
            if level > 0 {
                let (a, b) = (4 * (level - 1) + k, 4 * (level - 1) + (k + 1) % 4);
                triangles.extend([[a, b, a + 4], [b, b + 4, a + 4]]);
            }
        }
        document.curves.insert(CurveId(level + 1), Curve::new(through, true));
        curves.push(Embedding { curve: CurveId(level + 1), along: (4 * level..4 * level + 4).collect() });
    }
    let vertices = (1..=4 * levels).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

#[test]
fn far_bays_sleep_through_a_drag_and_wake_for_the_rest() {
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&tube()) });
    bench.rest(600);
    let asleep = |bench: &Bench| {
        let model = bench.modeler.model();
        let shape = &model.surfaces[&SurfaceId(1)];
        bench.modeler.relaxer().surface(SurfaceId(1), shape).unwrap().asleep()
    };
    let point = PointId(1);
    let start = bench.document().points[&point];
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    let mut most = 0;
    for frame in 1..=40 {
        bench.step(Some(start + DVec3::X * (0.005 * f64::from(frame))));
        most = most.max(asleep(&bench));
    }
    assert!(most >= 2000, "{most} slept");
    bench.accept(Request::Drop);
    let energy = bench.rest(600);
    assert_eq!(asleep(&bench), 0);
    // The same document without any drag.
    let mut other = Bench::new();
    other.accept(Request::OpenText { text: bench.document.clone() });
    let same = other.rest(600);
    assert!((energy / same - 1.0).abs() < 5e-3, "{energy} for {same}");
}
