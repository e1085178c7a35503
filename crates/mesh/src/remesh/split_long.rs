//! Splitting long edges, the longest first.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::collapse_short::SHORT;
use super::{Edits, Limits, Place, Seeds, Sizing, midpoint};
use crate::{EdgeId, Mesh, VertexId};

/// An edge is long above this multiple of its target: its halves are then not short. No collapse makes an edge so long.
pub(super) const LONG: f64 = 1.33;

/// Above this multiple an edge is split even where the new vertex has little room. No flip makes an edge so long. (Were
/// flips held to 1.33, vertices with four neighbours would stay for want of a flip.)
pub(super) const TOO_LONG: f64 = 1.6;

/// Splits edges longer than 1.33 of their target, the longest (for its target) first, until none is left or
/// a limit is reached; where the new vertex would lie close to one across from the edge, only from 1.6 on. `place` says where the new vertex goes; `positions` is extended as needed.
pub fn split_long(
    mesh: &mut Mesh,
    positions: &mut Vec<DVec3>,
    sizing: &mut Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
    place: &mut Place<'_>,
) -> Edits {
    let mut edits = Edits::default();
    let mut queue = BinaryHeap::new();
    // Bits of non-negative floats sort like the floats; among equals the lowest edge goes first.
    let offer = |mesh: &Mesh, at: &[DVec3], sizing: &Sizing, e: EdgeId, queue: &mut BinaryHeap<_>| {
        let ratio = sizing.ratio(mesh, at, e);
        if ratio > LONG && is_long(mesh, at, sizing, e) && limits.may_edit(mesh, e) {
            queue.push((ratio.to_bits(), Reverse(e)));
        }
    };
    for e in seeds.edges(mesh) {
        offer(mesh, positions, sizing, e, &mut queue);
    }
    let mut left = limits.allowance(mesh.vertex_count());
    while let Some((bits, Reverse(e))) = queue.pop() {
        if sizing.ratio(mesh, positions, e).to_bits() != bits || !is_long(mesh, positions, sizing, e) {
            continue; // it was split meanwhile, and its longer half is queued
        }
        let (c, d) = mesh.edge_opposites(e);
        if [Some(c), d].into_iter().flatten().any(|v| mesh.valence(v) >= limits.most_neighbours) {
            continue;
        }
        if left == 0 {
            edits.is_cut_short = true;
            break;
        }
        left -= 1;
        let [a, b] = mesh.edge_vertices(e);
        let wanted = place(mesh, positions, e);
        let at = if wanted.is_finite() { wanted } else { midpoint(mesh, positions, e) };
        let target = sizing.along(mesh, e);
        let m = mesh.split_edge(e);
        if positions.len() < mesh.vertex_slots() {
            positions.resize(mesh.vertex_slots(), DVec3::ZERO);
        }
        positions[m.index()] = at;
        sizing.set(m, target);
        edits.splits += 1;
        edits.touched.extend([a, b, c, m].into_iter().chain(d));
        for e in mesh.spokes(m) {
            offer(mesh, positions, sizing, e, &mut queue);
        }
    }
    edits.settle(mesh);
    edits
}

/// Whether an edge is too long, or long with room for another vertex: one that would not be collapsed at once into a
/// vertex across from the edge.
fn is_long(mesh: &Mesh, positions: &[DVec3], sizing: &Sizing, e: EdgeId) -> bool {
    let ratio = sizing.ratio(mesh, positions, e);
    let middle = midpoint(mesh, positions, e);
    let (c, d) = mesh.edge_opposites(e);
    let target = sizing.along(mesh, e);
    let is_clear =
        |v: VertexId| positions[v.index()].distance(middle) >= SHORT * 0.5 * (target + sizing.at(v));
    ratio > TOO_LONG || (ratio > LONG && [Some(c), d].into_iter().flatten().all(is_clear))
}
