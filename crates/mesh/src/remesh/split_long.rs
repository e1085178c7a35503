//! Splitting long edges, the longest first.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::{Edits, Limits, Place, Sizing, midpoint};
use crate::{EdgeId, Mesh};

/// An edge is long above this multiple of its target: halves are then at least 0.675 of it, and crowding
/// below 0.72 still needs a whole ring of such halves.
pub(super) const LONG: f64 = 1.35;

/// Splits edges longer than 1.35 of their target, the longest (for its target) first, until none is left or
/// a limit is reached. `place` says where the new vertex goes; `positions` is extended as needed.
pub fn split_long(
    mesh: &mut Mesh,
    positions: &mut Vec<DVec3>,
    sizing: &mut Sizing,
    limits: &Limits<'_>,
    place: &mut Place<'_>,
) -> Edits {
    let mut edits = Edits::default();
    let mut queue = BinaryHeap::new();
    // Bits of non-negative floats sort like the floats; among equals the lowest edge goes first.
    let offer = |mesh: &Mesh, at: &[DVec3], sizing: &Sizing, e: EdgeId, queue: &mut BinaryHeap<_>| {
        let ratio = sizing.ratio(mesh, at, e);
        if ratio > LONG && limits.may_edit(mesh, e) {
            queue.push((ratio.to_bits(), Reverse(e)));
        }
    };
    mesh.edges().for_each(|e| offer(mesh, positions, sizing, e, &mut queue));
    let mut left = limits.allowance(mesh.vertex_count());
    while let Some((bits, Reverse(e))) = queue.pop() {
        if sizing.ratio(mesh, positions, e).to_bits() != bits {
            continue; // it was split meanwhile, and its shorter half is queued
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
