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

/// When a vertex should go, low first. Bits of non-negative floats sort like the floats.
type Urgency = (u64, u64);

/// Deletes what can be deleted, starting from `candidates`; returns those that were refused, since edits
/// elsewhere may have made room for them.
fn dry(mesh: &mut Mesh, positions: &[DVec3], candidates: &[VertexId]) -> Vec<VertexId> {
    let mut newest: Vec<Option<Urgency>> = vec![None; mesh.vertex_slots()];
    let mut queue = BinaryHeap::new();
    let mut around = Vec::new();
    let mut offer = |mesh: &Mesh, v: VertexId, newest: &mut [Option<Urgency>], queue: &mut BinaryHeap<_>| {
        newest[v.index()] = urgency(mesh, positions, v, &mut around);
        queue.extend(newest[v.index()].map(|key| Reverse((key, v))));
    };
    for &v in candidates {
        offer(mesh, v, &mut newest, &mut queue);
    }
    let mut refused = Vec::new();
    let mut ring = Vec::new();
    while let Some(Reverse((key, v))) = queue.pop() {
        if newest[v.index()] != Some(key) {
            continue; // gone, or queued again under a newer key
        }
        newest[v.index()] = None;
        mesh.ring(v, &mut ring);
        if mesh.delete_vertex_by(v, |t| price(t.map(|w| positions[w.index()]))).is_err() {
            refused.push(v);
            continue;
        }
        for &w in &ring {
            offer(mesh, w, &mut newest, &mut queue);
        }
    }
    refused.retain(|&v| mesh.has_vertex(v));
    refused.sort_unstable();
    refused.dedup();
    refused
}

/// The distance of `v` from the plane (or the chord) of its neighbours, then its mean edge length; `None`
/// for vertices that stay.
fn urgency(mesh: &Mesh, positions: &[DVec3], v: VertexId, ring: &mut Vec<VertexId>) -> Option<Urgency> {
    let track = mesh.track(v).ok()?;
    mesh.ring(v, ring);
    let here = positions[v.index()];
    let at = |w: VertexId| positions[w.index()];
    let count = f64::from(u32::try_from(ring.len()).unwrap_or(u32::MAX));
    let centre = ring.iter().map(|&w| at(w)).sum::<DVec3>() / count;
    let length = ring.iter().map(|&w| at(w).distance(here)).sum::<f64>() / count;
    let deviation = match track {
        Track::Along(a, b) => {
            let (p, q) = (at(mesh.other_end(a, v)), at(mesh.other_end(b, v)));
            let along = (q - p).normalize_or_zero();
            (here - p - (here - p).dot(along) * along).length()
        }
        Track::Free => {
            let ahead = ring.iter().cycle().skip(1);
            let normal: DVec3 =
                ring.iter().zip(ahead).map(|(&w, &x)| (at(w) - centre).cross(at(x) - centre)).sum();
            (here - centre).dot(normal.normalize_or_zero()).abs()
        }
    };
    let bits = |x: f64| if x >= 0.0 { x.to_bits() } else { 0 };
    Some((bits(deviation), bits(length)))
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
