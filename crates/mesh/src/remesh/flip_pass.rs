//! Restoring the constrained Delaunay triangulation by flips (Welch 1995, §6.2.4).

use std::collections::VecDeque;

use glam::DVec3;

use super::diagonal::Diagonal;
use super::{Edits, LEAST_CORNER, Limits};
use crate::{EdgeId, Mesh, VertexId};

/// The smallest angle at the diagonal must gain more than this (radians). Without it, edges of nearly
/// square quadrilaterals chatter.
pub(super) const LEAST_GAIN: f64 = 0.05;

/// In the plane, flips that raise the smallest angle come to an end by themselves; in space with sharp
/// edges they need not. So a pass makes at most this many per edge of the mesh (real passes make far less
/// than one).
const MOST_FLIPS_PER_EDGE: usize = 4;

/// Where a flip pass starts.
#[derive(Clone, Copy, Debug)]
pub enum Seeds<'a> {
    /// At every edge.
    All,
    /// At the edges of the faces around these vertices.
    Around(&'a [VertexId]),
}

/// Flips edges whose smallest angle with the sides of their quadrilateral would grow by more than 0.05.
///
/// Frozen are: curve and boundary edges; dihedral angles above 90° before or after; flips that would face
/// a triangle away from the old ones; flips that leave an inner vertex fewer than 5 neighbours, a boundary
/// vertex fewer than 3, or give one more than the limit. To be rid of a corner sharper than 15° an inner
/// vertex may go down to 4 (a boundary vertex still to 3): [`repair_valence`](super::repair_valence) would
/// undo any other such flip, and the two would never rest.
pub fn flip_pass(mesh: &mut Mesh, positions: &[DVec3], seeds: Seeds<'_>, limits: &Limits<'_>) -> Edits {
    let mut edits = Edits::default();
    let mut waiting = vec![false; mesh.edge_slots()];
    let mut queue = VecDeque::new();
    let push = |e: EdgeId, waiting: &mut [bool], queue: &mut VecDeque<EdgeId>| {
        if !waiting[e.index()] {
            waiting[e.index()] = true;
            queue.push_back(e);
        }
    };
    match seeds {
        Seeds::All => mesh.edges().for_each(|e| push(e, &mut waiting, &mut queue)),
        Seeds::Around(vertices) => {
            for &v in vertices.iter().filter(|&&v| mesh.has_vertex(v)) {
                for e in mesh.wedges(v).flat_map(|w| mesh.face_edges(w.face())) {
                    push(e, &mut waiting, &mut queue);
                }
            }
        }
    }
    let mut left = MOST_FLIPS_PER_EDGE * mesh.edge_count();
    while let Some(e) = queue.pop_front() {
        waiting[e.index()] = false;
        let Some(diagonal) = wanted(mesh, positions, e, limits) else { continue };
        if left == 0 {
            edits.is_cut_short = true;
            break;
        }
        left -= 1;
        mesh.flip(e);
        edits.flips += 1;
        edits.touched.extend(diagonal.ends.into_iter().chain(diagonal.opposite));
        let (f, g) = mesh.edge_faces(e);
        for side in [Some(f), g].into_iter().flatten().flat_map(|f| mesh.face_edges(f)) {
            if side != e {
                push(side, &mut waiting, &mut queue);
            }
        }
    }
    edits.settle(mesh);
    edits
}

/// The quadrilateral of `e` if flipping `e` is allowed and worth it. The cheap tests come first.
fn wanted(mesh: &Mesh, positions: &[DVec3], e: EdgeId, limits: &Limits<'_>) -> Option<Diagonal> {
    if mesh.is_source_edge(e) {
        return None;
    }
    let diagonal = Diagonal::of(mesh, e)?;
    let is_welcome = diagonal.gain(positions) > LEAST_GAIN
        && diagonal.is_flat_enough(mesh, positions)
        && can_spare_neighbours(mesh, positions, &diagonal)
        && diagonal.opposite.iter().all(|&v| mesh.valence(v) < limits.most_neighbours)
        && mesh.can_flip(e).is_ok();
    is_welcome.then_some(diagonal)
}

/// Whether the ends of the diagonal may lose a neighbour each.
pub(super) fn can_spare_neighbours(mesh: &Mesh, positions: &[DVec3], diagonal: &Diagonal) -> bool {
    let is_sliver = || diagonal.corner_now(positions) < LEAST_CORNER;
    diagonal.ends.into_iter().all(|v| match mesh.valence(v) {
        n if mesh.is_boundary_vertex(v) => n > 3,
        n => n > 5 || (n == 5 && is_sliver()),
    })
}
