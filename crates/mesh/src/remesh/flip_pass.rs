//! Better triangles and more regular vertices by flips (after Welch 1995, §6.2.4).
//!
//! Welch restores the constrained Delaunay triangulation. Here each flip lowers a potential, which is that of Delaunay
//! plus a price on irregular vertices: see `potential` for it and for the proof that flips come to an end.

use std::collections::VecDeque;

use glam::DVec3;

use super::diagonal::Diagonal;
use super::potential::{self, Degrees, LEAST_FALL};
use super::split_long::TOO_LONG;
use super::{Edits, LEAST_CORNER, Limits, Seeds, Sizing};
use crate::{EdgeId, Mesh, VertexId};

/// The proof bounds the flips of any pass, but generously; real passes make far less than one per edge, and a page
/// cannot wait for more.
const MOST_FLIPS_PER_EDGE: usize = 8;

/// Flips edges until no flip would lower the potential by more than 0.1.
///
/// Frozen are: curve and boundary edges; dihedral angles above 90° before or after; flips that would face
/// a triangle away from the old ones; flips that make an edge longer than 1.6 of its target; flips that leave an inner vertex fewer than 5 neighbours, a boundary
/// vertex fewer than 3, or give one more than the limit. To be rid of a corner sharper than 15° an inner
/// vertex may go down to 4 (a boundary vertex still to 3): [`repair_valence`](super::repair_valence) would
/// undo any other such flip, and the two would never rest.
pub fn flip_pass(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
) -> Edits {
    let budget = MOST_FLIPS_PER_EDGE * mesh.edge_count();
    flips_within(mesh, positions, sizing, seeds, limits, budget)
}

/// The same, with so many flips at most.
pub(super) fn flips_within(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
    mut left: usize,
) -> Edits {
    let mut edits = Edits::default();
    let mut degrees = Degrees::new(mesh);
    let mut waiting = vec![false; mesh.edge_slots()];
    let mut queue: VecDeque<EdgeId> = seeds.edges(mesh).into();
    queue.iter().for_each(|e| waiting[e.index()] = true);
    let push = |e: EdgeId, waiting: &mut [bool], queue: &mut VecDeque<EdgeId>| {
        if !waiting[e.index()] {
            waiting[e.index()] = true;
            queue.push_back(e);
        }
    };
    while let Some(e) = queue.pop_front() {
        waiting[e.index()] = false;
        let Some(diagonal) = wanted(mesh, &mut degrees, positions, sizing, e, limits) else { continue };
        if left == 0 {
            edits.is_cut_short = true;
            break;
        }
        left -= 1;
        mesh.flip(e);
        degrees.flipped(&diagonal);
        edits.flips += 1;
        edits.touched.extend(diagonal.ends.into_iter().chain(diagonal.opposite));
        // Four vertices have other neighbours than before, which counts at every edge of the faces around them.
        for v in diagonal.ends.into_iter().chain(diagonal.opposite) {
            for wedge in mesh.wedges(v) {
                mesh.face_edges(wedge.face()).into_iter().for_each(|e| push(e, &mut waiting, &mut queue));
            }
        }
    }
    edits.settle(mesh);
    edits
}

/// The quadrilateral of `e` if flipping `e` is allowed and worth it. The cheap tests come first.
fn wanted(
    mesh: &Mesh,
    degrees: &mut Degrees,
    positions: &[DVec3],
    sizing: &Sizing,
    e: EdgeId,
    limits: &Limits<'_>,
) -> Option<Diagonal> {
    if mesh.is_source_edge(e) {
        return None;
    }
    let diagonal = Diagonal::of(mesh, e)?;
    let is_welcome = potential::fall(mesh, degrees, positions, &diagonal) > LEAST_FALL
        && is_short_enough(positions, sizing, &diagonal)
        && diagonal.is_flat_enough(mesh, positions)
        && can_spare_neighbours(mesh, degrees, positions, &diagonal)
        && diagonal.opposite.iter().all(|&v| degrees.of(mesh, v).0 < limits.most_neighbours)
        && mesh.can_flip(e).is_ok();
    is_welcome.then_some(diagonal)
}

/// Whether the new edge is not too long, or else no longer than the old one.
fn is_short_enough(positions: &[DVec3], sizing: &Sizing, diagonal: &Diagonal) -> bool {
    let ratio = |[a, b]: [VertexId; 2]| sizing.ratio_between(positions, a, b);
    let flipped = ratio(diagonal.opposite);
    flipped <= TOO_LONG || flipped <= ratio(diagonal.ends)
}

/// Whether the ends of the diagonal may lose a neighbour each.
fn can_spare_neighbours(
    mesh: &Mesh,
    degrees: &mut Degrees,
    positions: &[DVec3],
    diagonal: &Diagonal,
) -> bool {
    let is_sliver = || diagonal.corner_now(positions) < LEAST_CORNER;
    diagonal.ends.into_iter().all(|v| match degrees.of(mesh, v) {
        (n, false) => n > 3,
        (n, true) => n > 5 || (n == 5 && is_sliver()),
    })
}
