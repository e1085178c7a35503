//! The tangent strip of a surface along one of its curves: a band that leaves the curve within the tangent planes that the surface
//! has there, as wide in the picture everywhere.
//!
//! Planes and samples are those of the frame: every sample of a curve in a surface is a vertex of it.

use crate::camera::Camera;
use crate::scene::Scene;
use ductile_spec::{CurveId, SurfaceId};
use glam::Vec3;

/// Which vertices of a surface a curve runs through, in one structure.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StripCourse {
    version: u32,
    surface: SurfaceId,
    curve: CurveId,
    /// By sample, the vertex of the frame.
    vertices: Vec<u32>,
    /// The corner beside the first edge, if only one triangle is there: the surface lies on its side.
    beside: Option<u32>,
    closed: bool,
}

/// A band along a curve.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Strip {
    /// From each sample to the outer edge.
    pub rungs: Vec<[Vec3; 2]>,
    /// Whether the last is joined to the first.
    pub closed: bool,
    /// Whether it is only what a click would take.
    pub is_ghost: bool,
}

impl StripCourse {
    /// Finds the vertices; none where the curve or the surface is unknown or has no frame yet.
    #[must_use]
    pub fn find(scene: &Scene, surface: SurfaceId, curve: CurveId) -> Option<Self> {
        let closed = scene.curve(curve)?.closed;
        let (span, triangles, _) = scene.surfaces().find(|(span, ..)| span.id == surface)?;
        let own = span.first_vertex..span.first_vertex + span.vertex_count;
        let nearest = |at: Vec3| {
            let distance = |v: &u32| scene.vertex(*v).distance_squared(at);
            own.clone().min_by(|a, b| distance(a).total_cmp(&distance(b)))
        };
        let vertices = scene.samples(curve).map(nearest).collect::<Option<Vec<u32>>>()?;
        let [from, to, ..] = vertices[..] else { return None };
        let mut corners = triangles
            .chunks_exact(3)
            .filter(|t| t.contains(&from) && t.contains(&to))
            .filter_map(|t| t.iter().copied().find(|v| *v != from && *v != to));
        let (beside, other) = (corners.next(), corners.next());
        let beside = beside.filter(|_| other.is_none());
        Some(Self { version: scene.structure.version, surface, curve, vertices, beside, closed })
    }

    /// Whether it is the course of that curve in the present structure.
    #[must_use]
    pub fn is_of(&self, scene: &Scene, surface: SurfaceId, curve: CurveId) -> bool {
        (self.version, self.surface, self.curve) == (scene.structure.version, surface, curve)
    }

    /// The band as things are now, so many CSS pixels wide, on the side of a direction at a place of the curve if there is one;
    /// else inside the surface, or to the left of the curve.
    #[must_use]
    pub fn strip(&self, scene: &Scene, camera: &Camera, width: f32, side: Option<(Vec3, Vec3)>) -> Strip {
        let places: Vec<Vec3> = self.vertices.iter().map(|v| scene.vertex(*v)).collect();
        let count = places.len();
        let along = |k: usize| {
            let (before, after) = if self.closed {
                ((k + count - 1) % count, (k + 1) % count)
            } else {
                (k.saturating_sub(1), (k + 1).min(count - 1))
            };
            places[after] - places[before]
        };
        // Normals of a surface with one side may turn round on the way: each direction agrees with the one before.
        let mut away: Vec<Vec3> = Vec::with_capacity(count);
        for (k, v) in self.vertices.iter().enumerate() {
            let left = scene.vertex_normal(*v).cross(along(k)).normalize_or_zero();
            let turned = away.last().is_some_and(|before: &Vec3| before.dot(left) < 0.0);
            away.push(if turned { -left } else { left });
        }
        let wanted = side.and_then(|(at, way)| {
            let distance = |k: &usize| places[*k].distance_squared(at);
            Some(((0..count).min_by(|a, b| distance(a).total_cmp(&distance(b)))?, way))
        });
        let inside = self.beside.map(|v| (0, scene.vertex(v) - places[0]));
        let is_other = wanted.or(inside).is_some_and(|(k, way)| away[k].dot(way) < 0.0);
        let sign = if is_other { -width } else { width };
        let rung = |(at, way): (&Vec3, &Vec3)| [*at, *at + *way * (sign * camera.unit_per_pixel(*at))];
        let rungs = places.iter().zip(&away).map(rung).collect();
        Strip { rungs, closed: self.closed, is_ghost: false }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_strip_lies_in_the_tangent_planes_inside_the_rim_and_is_as_wide_in_the_picture() {
        let (scene, camera) = (sample::bumpy_disc(6), Camera::default());
        let surface = scene.structure.surfaces[0].id;
        let rim = scene.structure.curves[0];
        let course = StripCourse::find(&scene, surface, rim.id).unwrap();
        assert!(course.is_of(&scene, surface, rim.id) && course.beside.is_some());
        let strip = course.strip(&scene, &camera, 40.0, None);
        assert_eq!((strip.rungs.len(), strip.closed), (rim.count as usize, rim.closed));
        for ([foot, end], v) in strip.rungs.iter().zip(&course.vertices) {
            let width = 40.0 * camera.unit_per_pixel(*foot);
            assert!((foot.distance(*end) - width).abs() < 1e-4 * width);
            assert!((*end - *foot).dot(scene.vertex_normal(*v)).abs() < 1e-3 * width, "in the plane");
            assert!((*end - *foot).dot(-foot.with_z(0.0)) > 0.0, "inwards");
        }
        // A ribbon that leads outwards is shown as it leads.
        let (at, out) = (strip.rungs[3][0], strip.rungs[3][0] - strip.rungs[3][1]);
        let turned = course.strip(&scene, &camera, 40.0, Some((at, out)));
        assert!((turned.rungs[0][1] - turned.rungs[0][0]).dot(turned.rungs[0][0]) > 0.0);
    }

    #[test]
    fn what_is_not_there_has_no_course() {
        let scene = sample::bumpy_disc(4);
        let surface = scene.structure.surfaces[0].id;
        assert_eq!(StripCourse::find(&scene, surface, CurveId(99)), None);
        assert_eq!(StripCourse::find(&scene, SurfaceId(99), scene.structure.curves[0].id), None);
    }
}
