//! The rims of surfaces: loops of edges that belong to one triangle only, found in the frame itself, whether a curve
//! runs along them or not.

use crate::camera::Camera;
use crate::pick::{Line, pick_line};
use crate::scene::Scene;
use ductile_spec::SurfaceId;
use glam::{Vec2, Vec3};

/// The rims of a structure.
#[derive(Clone, Debug, Default)]
pub struct Rims {
    version: Option<u32>,
    rims: Vec<Rim>,
}

/// A rim of a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Rim {
    surface: SurfaceId,
    /// Vertices of the frame, in order; the last is joined to the first.
    corners: Vec<u32>,
}

/// A rim that was pointed at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RimHit {
    /// Which of the rims.
    pub index: usize,
    /// Whose rim it is.
    pub surface: SurfaceId,
    /// The place on it.
    pub at: Vec3,
}

impl Rims {
    /// Finds the rims anew if the structure is another.
    pub fn refresh(&mut self, scene: &Scene) {
        if self.version != Some(scene.structure.version) {
            self.version = Some(scene.structure.version);
            self.rims = scene
                .surfaces()
                .flat_map(|(span, triangles, _)| {
                    loops(triangles).into_iter().map(|corners| Rim { surface: span.id, corners })
                })
                .collect();
        }
    }

    /// The places along a rim.
    #[must_use]
    pub fn places(&self, scene: &Scene, index: usize) -> Vec<Vec3> {
        let corners = self.rims.get(index).map_or(&[][..], |rim| &rim.corners);
        if scene.has_frame() { corners.iter().map(|v| scene.vertex(*v)).collect() } else { Vec::new() }
    }

    /// The rim under the pointer, and where on it.
    #[must_use]
    pub fn under(&self, scene: &Scene, camera: &Camera, cursor: Vec2, reach_px: f32) -> Option<RimHit> {
        let lines =
            (0..self.rims.len()).map(|index| Line { places: self.places(scene, index), closed: true });
        let (index, at) = pick_line(scene, camera, cursor, reach_px, lines)?;
        Some(RimHit { index, surface: self.rims[index].surface, at })
    }

    /// The rim of a surface that comes nearest to a place on it, and where.
    #[must_use]
    pub fn nearest(&self, scene: &Scene, surface: SurfaceId, place: Vec3) -> Option<RimHit> {
        let own = self.rims.iter().enumerate().filter(|(_, rim)| rim.surface == surface);
        let corners = own.flat_map(|(index, rim)| rim.corners.iter().map(move |v| (index, *v)));
        let hits = corners.map(|(index, v)| RimHit { index, surface, at: scene.vertex(v) });
        let distance = |hit: &RimHit| hit.at.distance_squared(place);
        hits.min_by(|a, b| distance(a).total_cmp(&distance(b))).filter(|_| scene.has_frame())
    }
}

/// The loops of edges that one triangle has.
pub(crate) fn loops(triangles: &[u32]) -> Vec<Vec<u32>> {
    let mut edges: Vec<(u32, u32)> = Vec::with_capacity(triangles.len());
    for t in triangles.chunks_exact(3) {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            edges.push((a.min(b), a.max(b)));
        }
    }
    edges.sort_unstable();
    let single = edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).map(|same| same[0]);
    // Each edge from both of its ends; walked once, it is taken off both.
    let mut ways: Vec<(u32, u32, bool)> = single.flat_map(|(a, b)| [(a, b, true), (b, a, true)]).collect();
    ways.sort_unstable();
    let mut found = Vec::new();
    for first in 0..ways.len() {
        if !ways[first].2 {
            continue;
        }
        let mut corners = vec![ways[first].0];
        let mut next = Some(first);
        while let Some(way) = next {
            let (from, to, _) = ways[way];
            ways[way].2 = false;
            if let Ok(back) = ways.binary_search_by_key(&(to, from), |(a, b, _)| (*a, *b)) {
                ways[back].2 = false;
            }
            let begin = ways.partition_point(|(a, ..)| *a < to);
            next = (begin..ways.len()).take_while(|i| ways[*i].0 == to).find(|i| ways[*i].2);
            if next.is_some() {
                corners.push(to);
            }
        }
        found.push(corners);
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_disc_has_one_rim_all_round_and_a_moebius_strip_as_well() {
        let mut rims = Rims::default();
        for (scene, count) in [(sample::bumpy_disc(6), 36), (sample::moebius(40, 4), 80)] {
            rims.version = None;
            rims.refresh(&scene);
            assert_eq!(rims.rims.len(), 1);
            let places = rims.places(&scene, 0);
            assert_eq!(places.len(), count);
            let next = places.iter().cycle().skip(1);
            assert!(places.iter().zip(next).all(|(a, b)| a.distance(*b) < 0.35), "neighbours are neighbours");
        }
    }

    #[test]
    fn a_tube_has_two_rims_and_the_one_pointed_at_is_found() {
        let around = |u: f32, v: f32| {
            let (s, c) = (std::f32::consts::TAU * u).sin_cos();
            Vec3::new(c, s, 2.0 * v)
        };
        // Open along a seam of the grid, so both ends and the seam are one rim; a ring of quads without it:
        let n = 24_u32;
        let places: Vec<Vec3> =
            (0..2 * n).map(|i| around((i % n) as f32 / n as f32, (i / n) as f32)).collect();
        let quad = |i: u32| {
            let j = (i + 1) % n;
            [[i, j, n + j], [i, n + j, n + i]]
        };
        let triangles: Vec<[u32; 3]> = (0..n).flat_map(quad).collect();
        let scene = sample::Sketch::default().surface(&places, &triangles, true).finish();
        let mut rims = Rims::default();
        rims.refresh(&scene);
        assert_eq!(rims.rims.iter().map(|rim| rim.corners.len()).collect::<Vec<_>>(), [24, 24]);
        let mut camera = Camera::default();
        camera.fit(Vec3::Z, 2.0);
        let toward = -camera.forward();
        let top = Vec3::new(toward.x, toward.y, 0.0).normalize() + 2.0 * Vec3::Z;
        let cursor = camera.project(top).unwrap() + Vec2::Y * 3.0;
        let hit = rims.under(&scene, &camera, cursor, 9.0).unwrap();
        assert!((hit.at.z - 2.0).abs() < 1e-4, "{hit:?}");
        assert_eq!(rims.under(&scene, &camera, Vec2::ZERO, 9.0), None);
        let low = rims.nearest(&scene, SurfaceId(1), Vec3::new(1.0, 0.0, 0.4)).unwrap();
        assert!(low.at.z.abs() < 1e-6 && low.index != hit.index);
    }
}
