//! How long edges should be, here and there.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::{EdgeId, Mesh, VertexId};

/// The target length of edges.
#[derive(Clone, Debug, PartialEq)]
pub enum Sizing {
    /// The same everywhere.
    Uniform(f64),
    /// One per vertex slot; vertices made by splits get the mean of the edge's ends.
    PerVertex(Vec<f64>),
}

impl Sizing {
    /// The target at a vertex; infinite (no demand) where none is known.
    #[inline]
    #[must_use]
    pub fn at(&self, v: VertexId) -> f64 {
        match self {
            Self::Uniform(h) => *h,
            Self::PerVertex(all) => all.get(v.index()).copied().unwrap_or(f64::INFINITY),
        }
    }

    /// The target along an edge: the mean of its ends.
    #[inline]
    #[must_use]
    pub fn along(&self, mesh: &Mesh, e: EdgeId) -> f64 {
        let [a, b] = mesh.edge_vertices(e);
        0.5 * (self.at(a) + self.at(b))
    }

    /// The length of `e` in units of its target; 0 if the target makes no sense.
    #[inline]
    #[must_use]
    pub fn ratio(&self, mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> f64 {
        let [a, b] = mesh.edge_vertices(e);
        self.ratio_between(positions, a, b)
    }

    /// As [`Sizing::ratio`], for an edge that may not exist yet.
    pub(super) fn ratio_between(&self, positions: &[DVec3], a: VertexId, b: VertexId) -> f64 {
        let target = 0.5 * (self.at(a) + self.at(b));
        let ratio = positions[a.index()].distance(positions[b.index()]) / target;
        if target > 0.0 && ratio.is_finite() { ratio } else { 0.0 }
    }

    /// Sets the target at one vertex. A uniform sizing stays as it is.
    pub fn set(&mut self, v: VertexId, target: f64) {
        if let Self::PerVertex(all) = self {
            if all.len() <= v.index() {
                all.resize(v.index() + 1, f64::INFINITY);
            }
            all[v.index()] = target;
        }
    }

    /// Spreads the targets of `seeds` over the surface: each vertex gets the least of seed target plus
    /// `slope` times the distance along edges. A slope of 0.25 keeps neighbouring triangles of similar
    /// size, which cures the abrupt densities that Welch reports. Targets grow no larger than `most`.
    ///
    /// For a bounded gradation of targets already known everywhere, give all vertices as seeds.
    #[must_use]
    pub fn spread(
        mesh: &Mesh,
        positions: &[DVec3],
        seeds: &[(VertexId, f64)],
        slope: f64,
        most: f64,
    ) -> Self {
        let mut target = vec![most; mesh.vertex_slots()];
        let mut queue = BinaryHeap::new();
        // Bits of non-negative floats sort like the floats.
        let offer =
            |v: VertexId, h: f64, target: &mut [f64], queue: &mut BinaryHeap<Reverse<(u64, VertexId)>>| {
                if h >= 0.0 && h < target[v.index()] {
                    target[v.index()] = h;
                    queue.push(Reverse((h.to_bits(), v)));
                }
            };
        for &(v, h) in seeds {
            offer(v, h, &mut target, &mut queue);
        }
        while let Some(Reverse((bits, v))) = queue.pop() {
            let h = target[v.index()];
            if h.to_bits() != bits {
                continue;
            }
            for w in mesh.neighbours(v) {
                let step = positions[v.index()].distance(positions[w.index()]);
                offer(w, h + slope.max(0.0) * step, &mut target, &mut queue);
            }
        }
        Self::PerVertex(target)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{measure, primitive};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn spreading_bounds_the_slope() {
        let (mesh, positions) = primitive::plane(12, 12, 1.0);
        let corner = VertexId::from_index(0);
        let sizing = Sizing::spread(&mesh, &positions, &[(corner, 0.1)], 0.25, 2.0);
        assert_eq!(sizing.at(corner), 0.1);
        for e in mesh.edges() {
            let [a, b] = mesh.edge_vertices(e);
            let step = measure::edge_length(&mesh, &positions, e);
            assert!((sizing.at(a) - sizing.at(b)).abs() <= 0.25 * step + 1e-12);
        }
        assert_eq!(sizing.at(VertexId::from_index(13 * 13 - 1)), 2.0, "far away the cap holds");
    }

    #[test]
    fn new_vertices_get_a_target_by_setting_it() {
        let mut sizing = Sizing::PerVertex(vec![1.0, 2.0]);
        sizing.set(VertexId::from_index(4), 3.0);
        assert_eq!(sizing, Sizing::PerVertex(vec![1.0, 2.0, f64::INFINITY, f64::INFINITY, 3.0]));
        let mut sizing = Sizing::Uniform(1.0);
        sizing.set(VertexId::from_index(4), 3.0);
        assert_eq!(sizing.at(VertexId::from_index(4)), 1.0);
    }
}
