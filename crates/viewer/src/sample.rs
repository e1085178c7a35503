//! Small scenes for tests and pictures: plates, a bumpy disc, a Möbius strip.

use crate::scene::Scene;
use ductile_spec::{
    CurveId, CurveRole, CurveSpan, FrameHeader, PointEntry, PointId, PointRole, Structure, SurfaceId,
    SurfaceSpan, SurfaceSummary,
};
use glam::Vec3;
use std::f32::consts::{PI, TAU};

/// A scene in the making.
#[derive(Default)]
pub(crate) struct Sketch {
    structure: Structure,
    indices: Vec<u32>,
    vertices: Vec<f32>,
    samples: Vec<f32>,
    points: Vec<f32>,
}

fn count(n: usize) -> u32 {
    u32::try_from(n).unwrap()
}

fn part(i: u32, n: u32) -> f32 {
    i as f32 / n as f32
}

impl Sketch {
    /// Adds a surface by its vertices and triangles; the normals are made from the triangles.
    pub(crate) fn surface(mut self, places: &[Vec3], triangles: &[[u32; 3]], orientable: bool) -> Self {
        let first_vertex = count(self.vertices.len() / 6);
        let mut normals = vec![Vec3::ZERO; places.len()];
        for &[a, b, c] in triangles {
            let [a, b, c] = [a as usize, b as usize, c as usize];
            let flat = (places[b] - places[a]).cross(places[c] - places[a]);
            for corner in [a, b, c] {
                let sign = if flat.dot(normals[corner]) < 0.0 { -1.0 } else { 1.0 };
                normals[corner] += flat * sign;
            }
        }
        for (at, normal) in places.iter().zip(normals) {
            self.vertices.extend(at.to_array());
            self.vertices.extend(normal.normalize_or_zero().to_array());
        }
        self.structure.surfaces.push(SurfaceSpan {
            id: SurfaceId(count(self.structure.surfaces.len()) + 1),
            first_vertex,
            vertex_count: count(places.len()),
            first_index: count(self.indices.len()),
            index_count: count(3 * triangles.len()),
            kind: ductile_spec::SurfaceKind::Fair,
            summary: SurfaceSummary { orientable, components: 1, boundaries: 1, euler: 1, genus: 0 },
        });
        self.indices.extend(triangles.iter().flatten().map(|corner| corner + first_vertex));
        self
    }

    /// Adds an image of the unit square, of `2 n²` triangles.
    pub(crate) fn grid(self, n: u32, place: impl Fn(f32, f32) -> Vec3, orientable: bool) -> Self {
        let mut places = Vec::new();
        let mut triangles = Vec::new();
        for j in 0..=n {
            for i in 0..=n {
                places.push(place(part(i, n), part(j, n)));
                if i < n && j < n {
                    let a = j * (n + 1) + i;
                    triangles.push([a, a + 1, a + n + 2]);
                    triangles.push([a, a + n + 2, a + n + 1]);
                }
            }
        }
        self.surface(&places, &triangles, orientable)
    }

    /// Adds a curve that no surface follows.
    pub(crate) fn curve(self, samples: &[Vec3], closed: bool) -> Self {
        self.curve_with_role(samples, closed, CurveRole::Free)
    }

    /// Adds a curve.
    pub(crate) fn curve_with_role(mut self, samples: &[Vec3], closed: bool, role: CurveRole) -> Self {
        self.structure.curves.push(CurveSpan {
            id: CurveId(count(self.structure.curves.len()) + 1),
            first: count(self.samples.len() / 3),
            count: count(samples.len()),
            closed,
            role,
        });
        self.samples.extend(samples.iter().flat_map(|at| at.to_array()));
        self
    }

    /// Adds a control point.
    pub(crate) fn point(mut self, at: Vec3) -> Self {
        let id = PointId(count(self.structure.points.len()) + 1);
        self.structure.points.push(PointEntry { id, role: PointRole::Free });
        self.points.extend(at.to_array());
        self
    }

    /// Adds several control points.
    pub(crate) fn points(self, places: &[Vec3]) -> Self {
        places.iter().fold(self, |sketch, at| sketch.point(*at))
    }

    /// The scene, checked.
    pub(crate) fn finish(mut self) -> Scene {
        self.structure.version = 1;
        let mut scene = Scene::default();
        scene.set_structure(self.structure, self.indices).unwrap();
        let floats = [self.vertices, self.samples, self.points].concat();
        scene.set_frame(FrameHeader { topology_version: 1, ..FrameHeader::default() }, &floats).unwrap();
        scene
    }
}

/// Header and numbers of a scene, to be spoilt.
pub(crate) fn frame_of(scene: &Scene) -> (FrameHeader, Vec<f32>) {
    (scene.header.clone(), scene.floats.clone())
}

/// Height of the bumpy disc.
fn bump(x: f32, y: f32) -> f32 {
    let r2 = x * x + y * y;
    let lift = |cx: f32, cy: f32, h: f32, w: f32| h * (-((x - cx).powi(2) + (y - cy).powi(2)) / w).exp();
    (1.0 - r2) * (lift(0.3, 0.2, 0.75, 0.16) + lift(-0.45, -0.1, -0.35, 0.1) + lift(-0.1, 0.6, 0.5, 0.12))
}

/// A disc with bumps, a boundary, an inner curve and points: about `6 rings²` triangles.
pub(crate) fn bumpy_disc(rings: u32) -> Scene {
    sketch_bumpy_disc(rings).finish()
}

/// The sketch of [`bumpy_disc`].
pub(crate) fn sketch_bumpy_disc(rings: u32) -> Sketch {
    let at = |x: f32, y: f32| Vec3::new(x, y, bump(x, y));
    let on_ring = |i: u32, k: u32| {
        let (s, c) = (TAU * part(k % (6 * i).max(1), (6 * i).max(1))).sin_cos();
        let r = part(i, rings);
        at(r * c, r * s)
    };
    let mut places = vec![at(0.0, 0.0)];
    let mut triangles = Vec::new();
    let first = |i: u32| if i == 0 { 0 } else { 1 + 3 * i * (i - 1) };
    for i in 1..=rings {
        let (inner, outer) = (6 * (i - 1), 6 * i);
        places.extend((0..outer).map(|k| on_ring(i, k)));
        let outside = |k: u32| first(i) + k % outer;
        let inside = |k: u32| first(i - 1) + if inner == 0 { 0 } else { k % inner };
        for sector in 0..6 {
            for k in 0..i {
                let (o, n) = (sector * i + k, sector * (i - 1) + k);
                triangles.push([inside(n), outside(o), outside(o + 1)]);
                if k + 1 < i {
                    triangles.push([inside(n), outside(o + 1), inside(n + 1)]);
                }
            }
        }
    }
    let boundary: Vec<Vec3> = (0..6 * rings).map(|k| on_ring(rings, k)).collect();
    let inner: Vec<Vec3> = (0..=60)
        .map(|k| {
            let t = -1.0 + 2.0 * part(k, 60);
            at(0.8 * t, 0.35 * (3.0 * t).sin())
        })
        .collect();
    let ends = [inner[0], inner[30], inner[60]];
    Sketch::default()
        .surface(&places, &triangles, true)
        .curve_with_role(&boundary, true, CurveRole::Boundary)
        .curve_with_role(&inner, false, CurveRole::Inner)
        .points(&ends)
        .points(&[at(0.3, 0.2), at(-0.45, -0.1), at(-0.1, 0.6)])
}

/// A Möbius strip with its boundary, windings broken at one seam.
pub(crate) fn moebius(around: u32, across: u32) -> Scene {
    sketch_moebius(Sketch::default(), around, across, Vec3::ZERO).finish()
}

/// Adds a Möbius strip to a sketch.
pub(crate) fn sketch_moebius(sketch: Sketch, around: u32, across: u32, centre: Vec3) -> Sketch {
    let place = |u: f32, v: f32| {
        let (s, c) = (TAU * u).sin_cos();
        let (hs, hc) = (PI * u).sin_cos();
        let r = 1.0 + 0.4 * v * hc;
        centre + Vec3::new(r * c, r * s, 0.4 * v * hs)
    };
    let row = across + 1;
    let mut places = Vec::new();
    let mut triangles = Vec::new();
    for i in 0..around {
        for j in 0..=across {
            places.push(place(part(i, around), 2.0 * part(j, across) - 1.0));
            if j < across {
                let vertex = |i: u32, j: u32| if i == around { across - j } else { i * row + j };
                let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
                triangles.push([a, b, c]);
                triangles.push([a, c, d]);
            }
        }
    }
    let boundary: Vec<Vec3> = (0..2 * around).map(|i| place(part(i, around), 1.0)).collect();
    sketch.surface(&places, &triangles, false).curve_with_role(&boundary, true, CurveRole::Boundary)
}
