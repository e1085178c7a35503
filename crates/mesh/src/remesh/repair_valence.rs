//! Mending inner vertices with three or four neighbours, which fit no quadratic well, and all with more than can be fitted at all.

use glam::DVec3;

use super::collapse_short::collapse_into_nearest;
use super::diagonal::Diagonal;
use super::split_long::LONG;
use super::{Edits, LEAST_CORNER, Limits, Seeds, Sizing};
use crate::{EdgeId, Mesh, VertexId};

/// A full quadratic through the centre needs five neighbours.
const ENOUGH: usize = 5;
/// The proof bounds the edits of a pass, but generously; real passes make far less than one per edge, and a page cannot wait
/// for more.
const MOST_EDITS_PER_EDGE: usize = 8;

/// Gives every inner vertex at least five neighbours where that is possible: the link edge whose flip
/// makes the widest corners is turned towards it, if they are wider than 15° and the edge's ends keep five
/// neighbours (three on the boundary); failing that, the vertex is collapsed into its nearest neighbour,
/// unless it is pinned or on a curve, or the other passes would only bring it back.
///
/// A vertex with more neighbours than `limits.most_neighbours` gives some away, first those whose edge flips into the widest
/// corners, be they ever so sharp or bent: no pass makes such a vertex, but the cuts along a curve may, and where
/// the surface is folded nothing else takes them from it.
///
/// This ends: every edit makes (vertices, surplus neighbours, missing neighbours) less, read like a word in a dictionary. A collapse
/// leaves fewer vertices. A flip away from a crowded vertex takes a surplus neighbour from it and gives its new edge to two that
/// are below the limit. A flip towards a poor vertex gives it one that it misses, its ends can spare theirs, and neither
/// end of the new edge comes above the limit. There is a budget all the same, as for flips.
pub fn repair_valence(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
) -> Edits {
    let budget = MOST_EDITS_PER_EDGE * mesh.edge_count();
    repairs_within(mesh, positions, sizing, seeds, limits, budget)
}

/// The same, with so many edits at most.
pub(super) fn repairs_within(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
    most: usize,
) -> Edits {
    let mut edits = Edits::default();
    let mut stack = seeds.vertices(mesh);
    stack.retain(|&v| is_poor(mesh, v) || is_crowded(mesh, v, limits));
    stack.reverse();
    let mut ring = Vec::new();
    while let Some(v) = stack.pop() {
        if !mesh.has_vertex(v) || !(is_poor(mesh, v) || is_crowded(mesh, v, limits)) {
            continue;
        }
        if edits.count() >= most {
            // Whether anything could be done about it is not worth finding out.
            edits.is_cut_short = true;
            break;
        }
        if is_crowded(mesh, v, limits) {
            if let Some((e, diagonal)) = relief(mesh, positions, v, limits) {
                mesh.flip(e);
                edits.flips += 1;
                edits.touched.extend(diagonal.ends.into_iter().chain(diagonal.opposite));
                stack.push(v);
            }
            continue;
        }
        if let Some((e, diagonal)) = best_flip(mesh, positions, sizing, v, limits) {
            mesh.flip(e);
            edits.flips += 1;
            edits.touched.extend(diagonal.ends.into_iter().chain(diagonal.opposite));
            stack.push(v);
            continue;
        }
        if !limits.may_collapse || (limits.is_pinned)(v) || mesh.is_on_source_curve(v) {
            continue;
        }
        mesh.ring(v, &mut ring);
        if collapse_into_nearest(mesh, positions, sizing, &ring, v, limits) {
            edits.collapses += 1;
            edits.touched.extend_from_slice(&ring);
            stack.extend_from_slice(&ring);
        }
    }
    edits.settle(mesh);
    edits
}

fn is_poor(mesh: &Mesh, v: VertexId) -> bool {
    let (valence, is_closed) = mesh.degree(v);
    is_closed && valence < ENOUGH
}

fn is_crowded(mesh: &Mesh, v: VertexId, limits: &Limits<'_>) -> bool {
    mesh.valence(v) > limits.most_neighbours
}

/// The edge at `v` whose flip away from it makes the widest corners, if one may be flipped; one whose ends keep enough
/// neighbours goes first.
fn relief(mesh: &Mesh, positions: &[DVec3], v: VertexId, limits: &Limits<'_>) -> Option<(EdgeId, Diagonal)> {
    let mut best: Option<((bool, f64), EdgeId, Diagonal)> = None;
    for e in mesh.spokes(v).filter(|&e| mesh.can_flip(e).is_ok()) {
        let Some(diagonal) = Diagonal::of(mesh, e) else { continue };
        let can_spare = |&w: &VertexId| mesh.valence(w) > if mesh.is_boundary_vertex(w) { 3 } else { ENOUGH };
        let merit = (diagonal.ends.iter().all(can_spare), diagonal.corner_flipped(positions));
        if best.is_none_or(|(other, ..)| merit > other)
            && diagonal.opposite.iter().all(|&w| mesh.valence(w) < limits.most_neighbours)
        {
            best = Some((merit, e, diagonal));
        }
    }
    best.map(|(_, e, diagonal)| (e, diagonal))
}

/// The edge across from `v` whose flip towards `v` makes the widest corners, if one may be flipped. An edge
/// made so long that it is split again would be no gain.
fn best_flip(
    mesh: &Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    v: VertexId,
    limits: &Limits<'_>,
) -> Option<(EdgeId, Diagonal)> {
    let mut best = None;
    let mut widest = LEAST_CORNER;
    for wedge in mesh.wedges(v) {
        let e = mesh.edge_of(wedge.corner.next());
        if mesh.can_flip(e).is_err() {
            continue;
        }
        let Some(diagonal) = Diagonal::of(mesh, e) else { continue };
        let corner = diagonal.corner_flipped(positions);
        let can_spare = |&w: &VertexId| mesh.valence(w) > if mesh.is_boundary_vertex(w) { 3 } else { ENOUGH };
        let [c, d] = diagonal.opposite;
        if corner > widest
            && sizing.ratio_between(positions, c, d) <= LONG
            && diagonal.ends.iter().all(can_spare)
            && diagonal.opposite.iter().all(|&w| mesh.valence(w) < limits.most_neighbours)
            && diagonal.is_flat_enough(mesh, positions)
        {
            widest = corner;
            best = Some((e, diagonal));
        }
    }
    best
}
