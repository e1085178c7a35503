//! Mending inner vertices with three or four neighbours, which fit no quadratic well.

use glam::DVec3;

use super::collapse_short::collapse_into_nearest;
use super::diagonal::Diagonal;
use super::split_long::LONG;
use super::{Edits, LEAST_CORNER, Limits, Seeds, Sizing};
use crate::{EdgeId, Mesh, VertexId};

/// A full quadratic through the centre needs five neighbours.
const ENOUGH: usize = 5;

/// Gives every inner vertex at least five neighbours where that is possible: the link edge whose flip
/// makes the widest corners is turned towards it, if they are wider than 15° and the edge's ends keep five
/// neighbours (three on the boundary); failing that, the vertex is collapsed into its nearest neighbour,
/// unless it is pinned or on a curve, or the other passes would only bring it back.
///
/// This ends: every collapse leaves fewer vertices, and between collapses every flip leaves fewer missing
/// neighbours, for no flip makes a vertex that lacks some.
pub fn repair_valence(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
) -> Edits {
    let mut edits = Edits::default();
    let mut stack = seeds.vertices(mesh);
    stack.retain(|&v| is_poor(mesh, v));
    stack.reverse();
    let mut ring = Vec::new();
    while let Some(v) = stack.pop() {
        if !mesh.has_vertex(v) || !is_poor(mesh, v) {
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
