//! Documents that no example holds.

use ductile_spec::{
    Curve, CurveId, Document, Embedding, PointId, Skeleton, SkeletonVertex, Surface, SurfaceId,
};
use glam::dvec3;

/// A torus on three of its meridians, each through four points.
#[must_use]
pub fn torus() -> Document {
    let mut document = Document::default();
    let (mut triangles, mut curves) = (Vec::new(), Vec::new());
    for turn in 0..3_u32 {
        let (sin, cos) = libm::sincos(f64::from(turn) * std::f64::consts::TAU / 3.0);
        let mut through = Vec::new();
        for k in 0..4_u32 {
            let (out, up) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][k as usize];
            let id = PointId(4 * turn + k + 1);
            let radius = 2.0 + 0.8 * out;
            document.points.insert(id, dvec3(radius * cos, radius * sin, 0.8 * up));
            through.push(id);
            let at = |turn: u32, k: u32| 4 * (turn % 3) + k % 4;
            let (a, b, c, d) = (at(turn, k), at(turn + 1, k), at(turn + 1, k + 1), at(turn, k + 1));
            triangles.extend([[a, b, d], [b, c, d]]);
        }
        document.curves.insert(CurveId(turn + 1), Curve::new(through, true));
        curves.push(Embedding { curve: CurveId(turn + 1), along: (4 * turn..4 * turn + 4).collect() });
    }
    let vertices = (1..=12).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// A saddle in a closed curve, with a control curve inside of it that bends against it.
#[must_use]
pub fn ridged_saddle() -> Document {
    let mut document = Document::default();
    let mut through = Vec::new();
    for k in 0..8_u32 {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 8.0);
        let id = PointId(k + 1);
        document.points.insert(id, dvec3(cos, sin, 0.35 * (cos * cos - sin * sin)));
        through.push(id);
    }
    let ridge = [dvec3(-0.45, 0.0, 0.1), dvec3(0.0, 0.05, 0.25), dvec3(0.45, 0.0, 0.1)];
    document.points.extend((9..).map(PointId).zip(ridge));
    document.curves.insert(CurveId(1), Curve::new(through, true));
    document.curves.insert(CurveId(2), Curve::new(vec![PointId(9), PointId(10), PointId(11)], false));
    let triangles = vec![
        [0, 1, 10],
        [1, 9, 10],
        [1, 2, 9],
        [2, 3, 9],
        [3, 8, 9],
        [3, 4, 8],
        [4, 5, 8],
        [5, 9, 8],
        [5, 6, 9],
        [6, 7, 9],
        [7, 10, 9],
        [7, 0, 10],
    ];
    let curves = vec![
        Embedding { curve: CurveId(1), along: (0..8).collect() },
        Embedding { curve: CurveId(2), along: vec![8, 9, 10] },
    ];
    let vertices = (1..=11).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}
