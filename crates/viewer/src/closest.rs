//! The two places at which two surfaces come closest: where a tube between them is shortest (thesis section 7.4.3).
//!
//! Vertices stand for the surfaces. A sparse choice of both is compared pair by pair, then each end goes in turn to the
//! vertex nearest to the other until neither moves: a tube is set to a tenth of an edge at best, so this is enough.

use crate::scene::Scene;
use crate::tool::Place;
use ductile_spec::SurfaceId;
use glam::Vec3;

/// So many vertices of each surface are compared pair by pair.
const SPARSE: usize = 1000;
/// Most turns of the two ends; each brings them nearer.
const TURNS: usize = 64;

/// The closest places of two different surfaces.
#[must_use]
pub fn closest_places(scene: &Scene, one: SurfaceId, other: SurfaceId) -> Option<(Place, Place)> {
    let [a, b] = [one, other].map(|id| vertices(scene, id));
    let sparse = |all: &[(Vec3, Vec3)]| -> Vec<Vec3> {
        all.iter().step_by(all.len() / SPARSE + 1).map(|vertex| vertex.0).collect()
    };
    let (some, others) = (sparse(&a), sparse(&b));
    let pairs = some.iter().flat_map(|p| others.iter().map(move |q| (*p, *q)));
    let start = pairs.min_by(|x, y| x.0.distance_squared(x.1).total_cmp(&y.0.distance_squared(y.1)))?;
    let mut ends = (nearest(&a, start.1)?, nearest(&b, start.0)?);
    for _ in 0..TURNS {
        let next = nearest(&a, ends.1.0)?;
        let last = nearest(&b, next.0)?;
        if (next, last) == ends {
            break;
        }
        ends = (next, last);
    }
    let place = |surface, (at, normal): (Vec3, Vec3)| Place { surface, at, normal: Some(normal) };
    Some((place(one, ends.0), place(other, ends.1)))
}

/// The places and normals of a surface's vertices.
fn vertices(scene: &Scene, id: SurfaceId) -> Vec<(Vec3, Vec3)> {
    let span = scene.structure.surfaces.iter().find(|span| span.id == id).filter(|_| scene.has_frame());
    let own = span.map_or(0..0, |span| span.first_vertex..span.first_vertex + span.vertex_count);
    own.map(|v| (scene.vertex(v), scene.vertex_normal(v))).collect()
}

fn nearest(all: &[(Vec3, Vec3)], to: Vec3) -> Option<(Vec3, Vec3)> {
    all.iter().copied().min_by(|a, b| a.0.distance_squared(to).total_cmp(&b.0.distance_squared(to)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample::Sketch;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn two_bowls_come_closest_at_their_poles() {
        let bowl = |up: f32| {
            move |u: f32, v: f32| {
                let (x, y) = (2.0 * u - 1.0, 2.0 * v - 1.0);
                Vec3::new(x, y, up * (1.0 + x * x + y * y))
            }
        };
        let scene = Sketch::default().grid(60, bowl(1.0), true).grid(60, bowl(-1.0), true).finish();
        let (one, other) = closest_places(&scene, SurfaceId(1), SurfaceId(2)).unwrap();
        assert_eq!((one.at, other.at), (Vec3::Z, -Vec3::Z));
        assert!(one.normal.unwrap().z.abs() > 0.99);
        assert_eq!(closest_places(&scene, SurfaceId(1), SurfaceId(9)), None);
    }
}
