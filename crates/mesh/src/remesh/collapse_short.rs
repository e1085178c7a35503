//! Removing vertices that have no room: short edges are collapsed, the shortest first.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use super::potential::{LEAST_FALL, fall_of_cotangents};
use super::split_long::{LONG, TOO_LONG};
use super::{Edits, Limits, Seeds, Sizing};
use crate::surgery::Track;
use crate::{EdgeId, Mesh, VertexId};

/// An edge is short below this multiple of its target: a little less than half a long one.
///
/// The recipe waits until *every* edge around a vertex is short (0.72); then edges of half the length of their neighbours
/// stay, and with them corners of 20°. A triangle with sides of 0.66 and twice 1.33 still has a corner of 29°.
pub(super) const SHORT: f64 = 0.66;

/// A collapse may make edges longer by this than the longest there is at a vertex that is to be split across anyway.
const STRETCH: f64 = 1.1;

/// cos 84°: a collapse may turn no triangle further than this.
const COS_OF_LARGEST_TURN: f64 = 0.104_528_463_267_653_47;

/// Collapses edges shorter than 0.66 of their target, the shortest (for its target) first. Of the two ways to do so, the
/// one that makes the shorter edges is taken.
///
/// A vertex on a boundary loop or a curve goes along its line, where that is allowed at all. A collapse is refused if
/// [`Mesh::can_collapse`] says so, if it turns a triangle by more than 84°, lets a ring grow past the limit, or makes an
/// edge so long that the next batch would split it (see [`Limits::may_lengthen`]).
pub fn collapse_short(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
) -> Edits {
    let mut edits = Edits::default();
    if !limits.may_collapse {
        return edits;
    }
    let mut queue = BinaryHeap::new();
    let offer = |mesh: &Mesh, e: EdgeId, queue: &mut BinaryHeap<_>| {
        let ratio = sizing.ratio(mesh, positions, e);
        if ratio < SHORT {
            queue.push(Reverse((ratio.to_bits(), e)));
        }
    };
    for e in seeds.edges(mesh) {
        offer(mesh, e, &mut queue);
    }
    let mut ring = Vec::new();
    while let Some(Reverse((bits, e))) = queue.pop() {
        // Gone, or the handle of another edge by now, which was offered in its turn.
        if !mesh.has_edge(e) || sizing.ratio(mesh, positions, e).to_bits() != bits {
            continue;
        }
        let [a, b] = mesh.edge_vertices(e);
        let Some((v, w)) = better_way(mesh, positions, sizing, [a, b], &mut ring, limits) else { continue };
        mesh.ring(v, &mut ring);
        mesh.collapse(v, w);
        edits.collapses += 1;
        edits.touched.extend_from_slice(&ring);
        for e in mesh.edges_at(w) {
            offer(mesh, e, &mut queue);
        }
    }
    edits.settle(mesh);
    edits
}

/// Which end of a short edge slides into which, if either may.
fn better_way(
    mesh: &Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    [a, b]: [VertexId; 2],
    ring: &mut Vec<VertexId>,
    limits: &Limits<'_>,
) -> Option<(VertexId, VertexId)> {
    let mut best = None;
    let mut least = f64::INFINITY;
    for (v, w) in [(a, b), (b, a)] {
        if (limits.is_pinned)(v) || !may_vanish(mesh, v, limits) {
            continue;
        }
        mesh.ring(v, ring);
        let others = ring.iter().filter(|&&x| x != w);
        let longest = others.map(|&x| sizing.ratio_between(positions, x, w)).fold(0.0, f64::max);
        if longest < least && is_welcome(mesh, positions, sizing, ring, (v, w), limits) {
            least = longest;
            best = Some((v, w));
        }
    }
    best
}

/// Whether the lines through `v` allow it to go. (In which direction is for [`Mesh::can_collapse`] to say.)
fn may_vanish(mesh: &Mesh, v: VertexId, limits: &Limits<'_>) -> bool {
    match mesh.track(v) {
        Ok(Track::Free) => true,
        Ok(Track::Along(first, second)) => limits.may_edit(mesh, first) && limits.may_edit(mesh, second),
        Err(_) => false,
    }
}

/// Whether a vertex with this ring may slide into its neighbour.
fn is_welcome(
    mesh: &Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    ring: &[VertexId],
    (v, w): (VertexId, VertexId),
    limits: &Limits<'_>,
) -> bool {
    // The new ring is the union of both, less the two ends and one or two that both have.
    ring.len() + mesh.valence(w) <= limits.most_neighbours + 3
        && lasts(mesh, positions, sizing, ring, (v, w), limits)
        && mesh.can_collapse(v, w).is_ok()
        && keeps_normals(mesh, positions, v, w)
}

/// Collapses `v` into the nearest vertex of its `ring` that passes all tests, and tells whether it did.
pub(super) fn collapse_into_nearest(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    ring: &[VertexId],
    v: VertexId,
    limits: &Limits<'_>,
) -> bool {
    let here = positions[v.index()];
    let distance = |w: VertexId| here.distance_squared(positions[w.index()]);
    let mut candidates = ring.to_vec();
    candidates.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
    let found = candidates.into_iter().find(|&w| is_welcome(mesh, positions, sizing, ring, (v, w), limits));
    if let Some(w) = found {
        mesh.collapse(v, w);
    }
    found.is_some()
}

/// Whether collapsing a vertex with this ring into `w` will not be undone by the next batch: it makes no
/// edge so long that it is split, and leaves no diagonal so bad that it is flipped to such an edge.
fn lasts(
    mesh: &Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    ring: &[VertexId],
    (v, w): (VertexId, VertexId),
    limits: &Limits<'_>,
) -> bool {
    let longest = || ring.iter().map(|&x| sizing.ratio_between(positions, x, v)).fold(0.0, f64::max);
    // Computed only where an edge is too long: rarely.
    let is_split_anyway =
        |ratio: f64| limits.may_lengthen && longest() > TOO_LONG && ratio <= STRETCH * longest();
    let is_short = ring.iter().filter(|&&x| x != w).all(|&x| {
        let ratio = sizing.ratio_between(positions, x, w);
        ratio <= LONG || mesh.are_neighbours(x, w) || is_split_anyway(ratio)
    });
    let Ok([a, b, c, d]) = <[VertexId; 4]>::try_from(ring) else { return is_short };
    let [p, q, r, s] = if w == a || w == c { [a, c, b, d] } else { [b, d, a, c] };
    is_short && fall_of_cotangents([p, q, r, s].map(|v| positions[v.index()])) <= LEAST_FALL
}

/// Whether moving `v` onto `w` turns no surviving triangle by more than 84° and flattens none to nothing.
fn keeps_normals(mesh: &Mesh, positions: &[DVec3], v: VertexId, w: VertexId) -> bool {
    let (old, new) = (positions[v.index()], positions[w.index()]);
    mesh.wedges(v).all(|wedge| {
        let (p, q) = (mesh.target(wedge.corner), mesh.apex(wedge.corner));
        if p == w || q == w {
            return true;
        }
        let (p, q) = (positions[p.index()], positions[q.index()]);
        let (before, after) = ((p - old).cross(q - old), (p - new).cross(q - new));
        let scale = before.length() * after.length();
        after.length_squared() > 0.0 && before.dot(after) >= COS_OF_LARGEST_TURN * scale
    })
}
