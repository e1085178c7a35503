//! A line that a tool draws, laid on the surface that it is drawn on.
//!
//! Each sample goes along the line of sight onto the surface. One pass over the triangles serves all samples; of several
//! places below one pixel the one nearest to the sample counts, so that a line round the back stays at the back.

use crate::camera::Camera;
use crate::scene::Scene;
use ductile_spec::SurfaceId;
use glam::{Vec2, Vec3};

/// The line on the surface; a sample below which there is none within `reach` model units stays where it is.
#[must_use]
pub fn drape(scene: &Scene, camera: &Camera, surface: SurfaceId, line: &[Vec3], reach: f32) -> Vec<Vec3> {
    let mut laid = line.to_vec();
    let Some((_, triangles, _)) = scene.surfaces().find(|(span, ..)| span.id == surface) else { return laid };
    // Samples from left to right, so that a triangle looks only at those within its width.
    let mut order: Vec<(Vec2, usize)> =
        line.iter().enumerate().filter_map(|(i, at)| Some((camera.project(*at)?, i))).collect();
    order.sort_unstable_by(|a, b| a.0.x.total_cmp(&b.0.x).then(a.1.cmp(&b.1)));
    let mut off = vec![reach; line.len()];
    for t in triangles.chunks_exact(3) {
        let corners = [t[0], t[1], t[2]].map(|v| scene.vertex(v));
        let [Some(a), Some(b), Some(c)] = corners.map(|at| camera.project(at)) else { continue };
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let first = order.partition_point(|(pixel, _)| pixel.x < low.x);
        for (pixel, i) in order[first..].iter().take_while(|(pixel, _)| pixel.x <= high.x) {
            let Some(weights) = weights([a, b, c], *pixel).filter(|_| (low.y..=high.y).contains(&pixel.y))
            else {
                continue;
            };
            let place = corners[0] * weights.x + corners[1] * weights.y + corners[2] * weights.z;
            let distance = place.distance(line[*i]);
            if distance < off[*i] {
                off[*i] = distance;
                laid[*i] = place;
            }
        }
    }
    laid
}

/// Weights of the corners of a triangle at a place in it. (On the picture, not in space: across one triangle of a mesh
/// the difference is less than a pixel.)
fn weights([a, b, c]: [Vec2; 3], at: Vec2) -> Option<Vec3> {
    let whole = (b - a).perp_dot(c - a);
    if whole == 0.0 {
        return None;
    }
    let weights =
        Vec3::new((b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)) / whole;
    (weights.min_element() >= -1e-4).then_some(weights)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_chord_is_laid_on_the_hill_that_it_cuts() {
        let hill = |u: f32, v: f32| Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 1.0 - (2.0 * u - 1.0).powi(2));
        let scene = sample::Sketch::default().grid(40, hill, true).finish();
        let mut camera = Camera::default();
        camera.fit(Vec3::ZERO, 2.0);
        let line: Vec<Vec3> = (0_u8..=20).map(|i| Vec3::new(f32::from(i) * 0.06 - 0.6, 0.1, 0.64)).collect();
        let laid = drape(&scene, &camera, SurfaceId(1), &line, 1.0);
        for (before, at) in line.iter().zip(&laid) {
            assert!((at.z - (1.0 - at.x * at.x)).abs() < 2e-3, "{at} lies on the hill");
            let [one, other] = [*before, *at].map(|place| camera.project(place).unwrap());
            assert!(one.distance(other) < 0.5, "and on the same pixel");
        }
        assert_eq!(drape(&scene, &camera, SurfaceId(1), &line, 1e-4)[10], line[10], "too far away");
        assert_eq!(drape(&scene, &camera, SurfaceId(7), &line, 1.0), line);
    }
}
