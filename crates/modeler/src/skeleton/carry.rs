//! Free vertices of skeletons go along when control points are moved.
//!
//! A free vertex is a place where the surface was when its skeleton was taken. Left behind by a tube that is dragged away, it would pull a spike
//! out of it when the document is opened. So it moves by the mean of what its neighbours in the skeleton move by, which is harmonic over the
//! skeleton: what is moved as a whole stays whole, and what is moved back comes back.

use crate::operation::kept_in;
use ductile_spec::{Document, Skeleton, SkeletonVertex};
use glam::DVec3;
use std::collections::BTreeSet;

/// Rounds of Gauss and Seidel's method: chains of free vertices are some vertices long.
const ROUNDS: usize = 100;

/// Moves the free vertices of all skeletons that stayed the same since `before`, as control points were moved.
pub(crate) fn carry_free(before: &Document, now: &mut Document) {
    if before.points == now.points {
        return;
    }
    let mut carried = Vec::new();
    for (id, surface) in &now.surfaces {
        let same = before.surfaces.get(id).filter(|old| old.skeleton == surface.skeleton);
        let Some(shifts) = same.and_then(|old| shifts(&old.skeleton, before, now)) else { continue };
        // In decimals as positions have them, so that the way back leads back.
        let kept = |at: DVec3| kept_in(now, at).unwrap_or(DVec3::ZERO);
        let move_on = |(vertex, by): (&SkeletonVertex, DVec3)| match (vertex, kept(by)) {
            (SkeletonVertex::Free(at), by) if by != DVec3::ZERO => SkeletonVertex::Free(kept(*at + by)),
            _ => *vertex,
        };
        let vertices: Vec<_> = surface.skeleton.vertices.iter().zip(shifts).map(move_on).collect();
        carried.push((*id, vertices));
    }
    for (id, vertices) in carried {
        if let Some(surface) = now.surfaces.get_mut(&id) {
            surface.skeleton.vertices = vertices;
        }
    }
}

/// What each vertex of a skeleton moves by; `None` if no control point moved or no vertex is free.
fn shifts(skeleton: &Skeleton, before: &Document, now: &Document) -> Option<Vec<DVec3>> {
    let mut shifts = vec![DVec3::ZERO; skeleton.vertices.len()];
    let mut free = Vec::new();
    for (k, vertex) in skeleton.vertices.iter().enumerate() {
        match vertex {
            SkeletonVertex::Control(point) => {
                let ends = before.points.get(point).zip(now.points.get(point));
                shifts[k] = ends.map_or(DVec3::ZERO, |(from, to)| *to - *from);
            }
            SkeletonVertex::Free(_) => free.push(k),
        }
    }
    if free.is_empty() || shifts.iter().all(|by| *by == DVec3::ZERO) {
        return None;
    }
    let mut around = vec![BTreeSet::new(); shifts.len()];
    for t in &skeleton.triangles {
        let [a, b, c] = t.map(|v| v as usize);
        for (one, other) in [(a, b), (b, c), (c, a)] {
            around[one].insert(other);
            around[other].insert(one);
        }
    }
    for _ in 0..ROUNDS {
        for &k in &free {
            let total: DVec3 = around[k].iter().map(|&j| shifts[j]).sum();
            shifts[k] = total / around[k].len().max(1) as f64;
        }
    }
    Some(shifts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{PointId, Surface, SurfaceId};
    use glam::dvec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A prism over three control points, closed below by three more, with a ring of free vertices between.
    fn prism() -> Document {
        let mut document = Document::default();
        let at = |k: u32, z: f64| {
            let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / 3.0);
            dvec3((cos * 1e3).round() / 1e3, (sin * 1e3).round() / 1e3, z)
        };
        let mut vertices = Vec::new();
        for (first, z) in [(1, 0.0), (4, 2.0)] {
            for k in 0..3 {
                document.points.insert(PointId(first + k), at(k, z));
                vertices.push(SkeletonVertex::Control(PointId(first + k)));
            }
        }
        vertices.extend((0..3).map(|k| SkeletonVertex::Free(at(k, 1.0))));
        let mut triangles = vec![[2, 1, 0], [3, 4, 5]];
        for (low, high) in [(0, 6), (6, 3)] {
            for k in 0..3 {
                let next = (k + 1) % 3;
                triangles.extend([[low + k, low + next, high + k], [low + next, high + next, high + k]]);
            }
        }
        let skeleton = Skeleton { vertices, triangles, curves: Vec::new() };
        document.surfaces.insert(SurfaceId(1), Surface::new(skeleton));
        document
    }

    fn moved(document: &Document, points: &[u32], by: DVec3) -> Document {
        let mut now = document.clone();
        for point in points {
            *now.points.get_mut(&PointId(*point)).unwrap() += by;
        }
        carry_free(document, &mut now);
        now
    }

    fn free(document: &Document) -> Vec<DVec3> {
        let vertices = &document.surfaces[&SurfaceId(1)].skeleton.vertices;
        let places = vertices.iter().filter_map(|v| match v {
            SkeletonVertex::Free(at) => Some(*at),
            SkeletonVertex::Control(_) => None,
        });
        places.collect()
    }

    #[test]
    fn what_is_moved_as_a_whole_stays_whole() {
        let document = prism();
        let by = dvec3(0.25, -0.5, 3.0);
        let now = moved(&document, &[1, 2, 3, 4, 5, 6], by);
        for (was, is) in free(&document).into_iter().zip(free(&now)) {
            assert!((is - was).distance(by) < 1e-5, "{was} to {is}");
        }
    }

    #[test]
    fn a_lifted_lid_lifts_what_is_half_way_by_half() {
        let document = prism();
        let now = moved(&document, &[4, 5, 6], DVec3::Z);
        for (was, is) in free(&document).into_iter().zip(free(&now)) {
            assert!((is - was).distance(0.5 * DVec3::Z) < 1e-5, "{was} to {is}");
        }
    }

    #[test]
    fn what_is_moved_back_comes_back_to_the_bit() {
        let document = prism();
        let by = dvec3(0.318_417, 0.271_963, -0.141_537);
        let there = moved(&document, &[2, 5], by);
        assert_ne!(free(&there), free(&document));
        let mut back = there.clone();
        back.points.clone_from(&document.points);
        carry_free(&there, &mut back);
        assert_eq!(back, document);
    }

    #[test]
    fn a_skeleton_that_was_taken_anew_is_left_alone() {
        let document = prism();
        let mut now = document.clone();
        *now.points.get_mut(&PointId(1)).unwrap() += DVec3::X;
        let surface = now.surfaces.get_mut(&SurfaceId(1)).unwrap();
        surface.skeleton.vertices[6] = SkeletonVertex::Free(DVec3::splat(0.5));
        let wanted = now.clone();
        carry_free(&document, &mut now);
        assert_eq!(now, wanted);
    }
}
