//! Mean curvature of what is shown: the processor's twin of `shaders/interrogate.wgsl`, which colours the surface. It says
//! which range of values the colours should span.
//!
//! The unit normals of the vertices are a field that is linear on each triangle; minus half its divergence, averaged
//! over the triangles around a vertex by area, is the mean curvature there. Positive where the surface bends toward its normals.

use crate::scene::Scene;
use glam::Vec3;

/// Part of the area whose values are beyond either end of the range that is proposed: a single wild vertex should not take
/// all the colours.
const BEYOND: f64 = 0.01;
/// Least width of a proposed range, as a part of the largest value: a sphere is not to show the noise of its figures.
const LEAST_WIDTH: f32 = 0.02;

/// The triangles around each vertex.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Rings {
    /// For each vertex, and one more, where its triangles begin; then, for each of them, the place of its first corner.
    list: Vec<u32>,
}

impl Rings {
    /// Of triangles given by three corners each.
    pub(crate) fn new(vertices: usize, indices: &[u32]) -> Self {
        let mut list = vec![0_u32; vertices + 1 + indices.len()];
        for corner in indices {
            list[*corner as usize] += 1;
        }
        // Counts become ends, and filling from behind makes beginnings of them.
        let mut end = u32::try_from(vertices + 1).unwrap_or(u32::MAX);
        for count in &mut list[..=vertices] {
            end += *count;
            *count = end;
        }
        for (place, corner) in indices.iter().enumerate().rev() {
            let begin = list[*corner as usize] - 1;
            list[*corner as usize] = begin;
            list[begin as usize] = u32::try_from(place - place % 3).unwrap_or(u32::MAX);
        }
        Self { list }
    }

    pub(crate) fn as_slice(&self) -> &[u32] {
        &self.list
    }

    /// Where the triangles around a vertex begin among the corners.
    fn of(&self, vertex: u32) -> &[u32] {
        let vertex = vertex as usize;
        &self.list[self.list[vertex] as usize..self.list[vertex + 1] as usize]
    }
}

/// Mean curvature at a vertex, and the area around it.
fn mean(scene: &Scene, rings: &Rings, vertex: u32) -> (f32, f32) {
    let side = scene.vertex_normal(vertex);
    let turned = |v: Vec3, side: Vec3| if v.dot(side) < 0.0 { -v } else { v };
    let (mut divergence, mut twice) = (0.0, 0.0);
    for &first in rings.of(vertex) {
        let corners = [0, 1, 2].map(|k| scene.indices[first as usize + k]);
        let [a, b, c] = corners.map(|corner| scene.vertex(corner));
        let cross = (b - a).cross(c - a);
        let Some(flat) = cross.try_normalize() else { continue };
        let own = turned(flat, side);
        let edges = [c - b, a - c, b - a];
        for (corner, edge) in corners.into_iter().zip(edges) {
            divergence += turned(scene.vertex_normal(corner), own).dot(flat.cross(edge));
        }
        twice += cross.length();
    }
    if twice > 0.0 { (-0.5 * divergence / twice, twice) } else { (0.0, 0.0) }
}

/// A range of values that shows the differences: all but the utmost hundredths of the area lie in it.
#[must_use]
pub fn mean_range(scene: &Scene) -> Option<[f32; 2]> {
    if !scene.has_frame() {
        return None;
    }
    let rings = Rings::new(scene.structure.vertex_count(), &scene.indices);
    let count = u32::try_from(scene.structure.vertex_count()).unwrap_or(u32::MAX);
    let mut values: Vec<(f32, f32)> = (0..count).map(|vertex| mean(scene, &rings, vertex)).collect();
    values.retain(|(mean, area)| mean.is_finite() && *area > 0.0);
    values.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let all: f64 = values.iter().map(|(_, area)| f64::from(*area)).sum();
    let mut below = 0.0;
    let mut range = None;
    for (mean, area) in values {
        let middle = below + 0.5 * f64::from(area);
        below += f64::from(area);
        if middle < BEYOND * all {
            continue;
        }
        if range.is_some() && middle > (1.0 - BEYOND) * all {
            break;
        }
        let [low, _] = range.unwrap_or([mean; 2]);
        range = Some([low, mean]);
    }
    range.map(widened)
}

/// A range that is no narrower than what can be trusted.
fn widened([low, high]: [f32; 2]) -> [f32; 2] {
    let least = LEAST_WIDTH * low.abs().max(high.abs()).max(f32::MIN_POSITIVE);
    let lack = (0.5 * (least - (high - low))).max(0.0);
    [low - lack, high + lack]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::Sketch;
    use std::f32::consts::{PI, TAU};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A scene with exact normals, which are those of the places moved by a little.
    fn with_normals(mut scene: Scene, normal: impl Fn(Vec3) -> Vec3) -> Scene {
        for vertex in scene.floats.chunks_exact_mut(6) {
            let at = Vec3::from_slice(&vertex[..3]);
            vertex[3..].copy_from_slice(&normal(at).to_array());
        }
        scene
    }

    fn torus(n: u32, turned: bool) -> Scene {
        let place = |u: f32, v: f32| {
            let ring = Vec3::new((u * TAU).cos(), (u * TAU).sin(), 0.0);
            ring * (3.0 + (v * TAU).cos()) + Vec3::Z * (v * TAU).sin()
        };
        let scene = Sketch::default().grid(n, place, true).finish();
        let sign = if turned { -1.0 } else { 1.0 };
        with_normals(scene, |at| {
            let ring = Vec3::new(at.x, at.y, 0.0).normalize();
            (at - ring * 3.0).normalize() * sign
        })
    }

    /// The largest error on the torus away from the seam of the grid.
    fn error(n: u32, turned: bool) -> f32 {
        let scene = torus(n, turned);
        let rings = Rings::new(scene.structure.vertex_count(), &scene.indices);
        let sign = if turned { -1.0 } else { 1.0 };
        let inner = (1..n).flat_map(|j| (1..n).map(move |i| j * (n + 1) + i));
        let errors = inner.map(|vertex| {
            let at = scene.vertex(vertex);
            let ring = Vec3::new(at.x, at.y, 0.0).length();
            let exact = -0.5 * sign * (1.0 + (ring - 3.0) / ring);
            (mean(&scene, &rings, vertex).0 - exact).abs()
        });
        errors.fold(0.0, f32::max)
    }

    #[test]
    fn it_tends_to_that_of_a_torus_whichever_way_the_normals_point() {
        for turned in [false, true] {
            let [coarse, fine] = [24, 48].map(|n| error(n, turned));
            assert!(fine < 0.01 && coarse > 3.0 * fine, "{coarse} and {fine}");
        }
    }

    #[test]
    fn every_triangle_is_found_around_its_corners() {
        let scene = torus(4, false);
        let rings = Rings::new(25, &scene.indices);
        for vertex in 0..25 {
            let own: Vec<u32> =
                (0..).zip(&scene.indices).filter(|(_, v)| **v == vertex).map(|(k, _)| k - k % 3).collect();
            assert_eq!(rings.of(vertex), own);
        }
        assert_eq!(Rings::new(0, &[]).as_slice(), [1]);
    }

    #[test]
    fn the_range_is_that_of_the_surface_and_wild_vertices_do_not_count() {
        let [low, high] = mean_range(&torus(48, true)).unwrap();
        // From 0.25 inside, (1 - 1/2) / 2, to 0.625 outside.
        assert!((0.24..0.28).contains(&low) && (0.6..0.63).contains(&high), "{low} {high}");
        let mut wild = torus(48, true);
        wild.floats[6 * 600 + 2] += 0.5;
        let [a, b] = mean_range(&wild).unwrap();
        assert!((a - low).abs() < 0.02 && (b - high).abs() < 0.02, "{a} {b}");
        assert_eq!(mean_range(&Scene::default()), None);
    }

    #[test]
    fn a_sphere_and_a_plane_do_not_show_noise() {
        let ball = |u: f32, v: f32| {
            let (angle, height) = (u * TAU, (v * 0.8 + 0.1) * PI);
            Vec3::new(angle.cos() * height.sin(), angle.sin() * height.sin(), height.cos()) * 2.0
        };
        let scene = with_normals(Sketch::default().grid(40, ball, true).finish(), Vec3::normalize);
        let [low, high] = mean_range(&scene).unwrap();
        assert!(low < -0.5 && -0.5 < high && high - low < 0.03, "{low} {high}");
        let flat = Sketch::default().grid(5, |u, v| Vec3::new(u, v, 0.0), true).finish();
        let [low, high] = mean_range(&flat).unwrap();
        assert!(low < high && high < 1e-6, "{low} {high}");
    }
}
