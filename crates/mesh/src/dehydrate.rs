//! Drying a mesh to its skeleton: the smallest mesh with the same topology and the same sources.
//!
//! What a document must keep of a surface is its kind and how the control points and curves lie in it;
//! the many vertices between can be grown again by refining. Vertices are deleted
//! ([`Mesh::delete_vertex_by`]), the flattest and most crowded first, until none can go: control points
//! stay, closed curves and boundary loops keep three vertices, and the mesh remains a simplicial complex.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::surgery::Track;
use crate::{Mesh, VertexId};

/// A reduced mesh and what became of the old vertices.
#[derive(Clone, Debug)]
pub struct Dehydrated {
    /// The reduced mesh, without dead slots. Windings follow the old faces.
    pub mesh: Mesh,
    /// For every vertex slot of the old mesh its new name, if it was kept.
    pub kept: Vec<Option<VertexId>>,
}

impl Dehydrated {
    /// Picks the values of the kept vertices from a slice beside the old mesh.
    #[must_use]
    pub fn carry<T: Copy>(&self, old: &[T]) -> Vec<T> {
        // Names were given in the order of the old vertices, so they come out in order.
        self.kept.iter().zip(old).filter_map(|(name, value)| name.map(|_| *value)).collect()
    }
}

/// Reduces `mesh` as far as its topology and sources allow. The same input gives the same output;
/// `positions` only guide the order and the shape of what remains.
///
/// ```
/// use ductile_mesh::{SourceTag, VertexId, dehydrate, primitive};
/// let (mut mesh, positions) = primitive::icosphere(3);
/// assert_eq!(dehydrate(&mesh, &positions).mesh.face_count(), 4);
/// for i in 0..12 {
///     mesh.set_vertex_source(VertexId::from_index(i), Some(SourceTag(i as u32)));
/// }
/// assert_eq!(dehydrate(&mesh, &positions).mesh.vertex_count(), 12);
/// ```
#[must_use]
pub fn dehydrate(mesh: &Mesh, positions: &[DVec3]) -> Dehydrated {
    let mut work = mesh.clone();
    let mut waiting: Vec<VertexId> = work.vertices().collect();
    loop {
        let before = work.vertex_count();
        waiting = dry(&mut work, positions, &waiting);
        if work.vertex_count() == before {
            break;
        }
    }
    let (mesh, kept) = work.compacted();
    Dehydrated { mesh, kept }
}

/// Deletes what can be deleted, starting from `candidates`; returns those that were refused, since edits
/// elsewhere may have made room for them.
fn dry(mesh: &mut Mesh, positions: &[DVec3], candidates: &[VertexId]) -> Vec<VertexId> {
    let mut queue = BinaryHeap::new();
    for &v in candidates {
        queue.extend(urgency(mesh, positions, v).map(|key| Reverse((key, v))));
    }
    let mut refused = Vec::new();
    let mut ring = Vec::new();
    while let Some(Reverse((key, v))) = queue.pop() {
        if !mesh.has_vertex(v) || urgency(mesh, positions, v) != Some(key) {
            continue; // gone, or queued again under a newer key
        }
        mesh.ring(v, &mut ring);
        match mesh.delete_vertex_by(v, |t| price(t.map(|w| positions[w.index()]))) {
            Ok(()) => {
                for &w in &ring {
                    queue.extend(urgency(mesh, positions, w).map(|key| Reverse((key, w))));
                }
            }
            Err(_) => refused.push(v),
        }
    }
    refused.retain(|&v| mesh.has_vertex(v));
    refused.sort_unstable();
    refused.dedup();
    refused
}

/// How soon `v` should go, low first: by its distance from the plane (or the chord) of its neighbours,
/// then by its mean edge length. As bits, which sort like the non-negative floats they are; `None` for
/// vertices that stay.
fn urgency(mesh: &Mesh, positions: &[DVec3], v: VertexId) -> Option<(u64, u64)> {
    let here = positions[v.index()];
    let at = |w: VertexId| positions[w.index()];
    let (mut total, mut length, mut count) = (DVec3::ZERO, 0.0, 0.0);
    for w in mesh.neighbours(v) {
        total += at(w);
        length += at(w).distance(here);
        count += 1.0;
    }
    let deviation = match mesh.track(v).ok()? {
        Track::Along(a, b) => {
            let (p, q) = (at(mesh.other_end(a, v)), at(mesh.other_end(b, v)));
            let along = (q - p).normalize_or_zero();
            (here - p - (here - p).dot(along) * along).length()
        }
        Track::Free => {
            let centre = total / count;
            let mut normal = DVec3::ZERO;
            for w in mesh.wedges(v) {
                let side = (at(mesh.target(w.corner)) - centre).cross(at(mesh.apex(w.corner)) - centre);
                normal += if w.agrees { side } else { -side };
            }
            (here - centre).dot(normal.normalize_or_zero()).abs()
        }
    };
    let bits = |x: f64| if x >= 0.0 { x.to_bits() } else { 0 };
    Some((bits(deviation), bits(length / count)))
}

/// Small triangles first, compact ones among equals: fillings of least area fold least.
fn price([a, b, c]: [DVec3; 3]) -> f64 {
    let area = 0.5 * (b - a).cross(c - a).length();
    let around = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
    let price = area + 0.02 * around;
    if price.is_finite() { price } else { f64::MAX.sqrt() }
}

#[cfg(test)]
mod tests;
