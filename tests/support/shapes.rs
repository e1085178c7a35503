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

/// A saddle in a closed curve, with a closed control curve inside of it that bends against it.
#[must_use]
pub fn ringed_saddle() -> Document {
    let mut document = Document::default();
    for (ring, radius, height, count) in [(0, 1.0, 0.35, 8), (1, 0.5, -0.1, 4)] {
        let first = 8 * ring;
        let through: Vec<PointId> = (first..first + count).map(|k| PointId(k + 1)).collect();
        for (k, id) in through.iter().enumerate() {
            let (sin, cos) = libm::sincos(k as f64 * std::f64::consts::TAU / f64::from(count));
            let at = dvec3(radius * cos, radius * sin, height * (cos * cos - sin * sin));
            document.points.insert(*id, at);
        }
        document.curves.insert(CurveId(ring + 1), Curve::new(through, true));
    }
    let mut triangles = vec![[8, 9, 10], [8, 10, 11]];
    for k in 0..4 {
        let (inner, next) = (8 + k, 8 + (k + 1) % 4);
        let [a, b, c] = [2 * k, 2 * k + 1, (2 * k + 2) % 8];
        triangles.extend([[a, b, inner], [b, next, inner], [b, c, next]]);
    }
    let curves = vec![
        Embedding { curve: CurveId(1), along: (0..8).collect() },
        Embedding { curve: CurveId(2), along: (8..12).collect() },
    ];
    let vertices = (1..=12).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// A Möbius strip on a curve along its core, which halves its five quadrilaterals.
#[must_use]
pub fn moebius() -> Document {
    let mut document = Document::default();
    let (mut vertices, mut edges) = (Vec::new(), Vec::new());
    for k in 0..5_u32 {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 5.0);
        let (lift, lean) = libm::sincos(f64::from(k) * std::f64::consts::PI / 5.0);
        document.points.insert(PointId(k + 1), dvec3(2.0 * cos, 2.0 * sin, 0.0));
        vertices.push(SkeletonVertex::Control(PointId(k + 1)));
        edges.extend([0.6, -0.6].map(|side| {
            let r = 2.0 + side * lean;
            SkeletonVertex::Free(dvec3(r * cos, r * sin, side * lift))
        }));
    }
    vertices.extend(edges);
    let mut triangles = Vec::new();
    for k in 0..5 {
        let next = (k + 1) % 5;
        for side in [0, 1] {
            // After one turn the one edge goes on as the other.
            let there = if k == 4 { 1 - side } else { side };
            let (here, beyond) = (5 + 2 * k + side, 5 + 2 * next + there);
            triangles.extend([[k, next, here], [next, beyond, here]]);
        }
    }
    document.curves.insert(CurveId(1), Curve::new((1..=5).map(PointId).collect(), true));
    let curves = vec![Embedding { curve: CurveId(1), along: (0..5).collect() }];
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// A Klein bottle on four figures of eight, each turned by an eighth of a circle against the one before; after half a turn the
/// last one lies on the first with its ends exchanged.
#[must_use]
pub fn klein_bottle() -> Document {
    let mut document = Document::default();
    let (mut triangles, mut curves) = (Vec::new(), Vec::new());
    for turn in 0..4_u32 {
        let (sin, cos) = libm::sincos(f64::from(turn) * std::f64::consts::FRAC_PI_2);
        let (lift, lean) = libm::sincos(f64::from(turn) * std::f64::consts::FRAC_PI_4);
        let mut through = Vec::new();
        for (k, [out, up]) in (0_u32..).zip([[0.9, 0.4], [0.9, -0.4], [-0.9, 0.4], [-0.9, -0.4]]) {
            let id = PointId(4 * turn + k + 1);
            let radius = 2.5 + out * lean - up * lift;
            document.points.insert(id, dvec3(radius * cos, radius * sin, out * lift + up * lean));
            through.push(id);
            // The first two points and the last two are exchanged where it closes.
            let at = |turn: u32, k: u32| if turn == 4 { 3 - k % 4 } else { 4 * turn + k % 4 };
            let (a, b, c, d) = (at(turn, k), at(turn + 1, k), at(turn + 1, k + 1), at(turn, k + 1));
            triangles.extend([[a, b, d], [b, c, d]]);
        }
        document.curves.insert(CurveId(turn + 1), Curve::new(through, true));
        curves.push(Embedding { curve: CurveId(turn + 1), along: (4 * turn..4 * turn + 4).collect() });
    }
    let vertices = (1..=16).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// A tube on three circles, each through four points: two of radius 1, so far above and below the third, its waist.
#[must_use]
pub fn waisted(waist: f64, half: f64) -> Document {
    let mut document = Document::default();
    let (mut triangles, mut curves) = (Vec::new(), Vec::new());
    for (ring, (radius, height)) in (0_u32..).zip([(1.0, -half), (waist, 0.0), (1.0, half)]) {
        let mut through = Vec::new();
        for (k, [x, y]) in (0_u32..).zip([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]) {
            let id = PointId(4 * ring + k + 1);
            document.points.insert(id, dvec3(radius * x, radius * y, height));
            through.push(id);
            if ring < 2 {
                let at = |ring: u32, k: u32| 4 * ring + k % 4;
                let (a, b, c, d) = (at(ring, k), at(ring, k + 1), at(ring + 1, k + 1), at(ring + 1, k));
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
        document.curves.insert(CurveId(ring + 1), Curve::new(through, true));
        curves.push(Embedding { curve: CurveId(ring + 1), along: (4 * ring..4 * ring + 4).collect() });
    }
    let vertices = (1..=12).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// Two unit discs, one over the other.
#[must_use]
pub fn two_discs() -> Document {
    let mut document = Document::default();
    for disc in 0..2_u32 {
        let ids: Vec<PointId> = (1..=4).map(|k| PointId(4 * disc + k)).collect();
        for (id, [x, y]) in ids.iter().zip([[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]]) {
            document.points.insert(*id, dvec3(x, y, 1.2 * f64::from(disc)));
        }
        let vertices = ids.iter().map(|id| SkeletonVertex::Control(*id)).collect();
        document.curves.insert(CurveId(disc + 1), Curve::new(ids, true));
        let curves = vec![Embedding { curve: CurveId(disc + 1), along: vec![0, 1, 2, 3] }];
        let skeleton = Skeleton { vertices, triangles: vec![[0, 1, 2], [0, 2, 3]], curves };
        document.surfaces.insert(SurfaceId(disc + 1), Surface::new(skeleton));
    }
    document
}

/// Shapes of every kind, coarse, so that many acts can be tried on them.
#[must_use]
pub fn for_surgery() -> Vec<Document> {
    use ductile_spec::Example;
    let example = ductile_modeler::example;
    let all = [
        (example(Example::Disc), 0.25),
        (example(Example::Cylinder), 0.3),
        (example(Example::Ball), 0.35),
        (moebius(), 0.4),
        (torus(), 0.45),
        (two_discs(), 0.3),
    ];
    all.into_iter().map(|(document, spacing)| Document { spacing: Some(spacing), ..document }).collect()
}
