//! Looking only at what has changed: where passes begin, and what was looked at already.
//!
//! Whether a pass splits, collapses or flips at an edge depends on positions, wanted lengths and rings close by: for
//! every edge within the faces around the *neighbours* of a vertex, and for no other, can a change at that vertex
//! change the answer. So after a pass that looked everywhere it is enough to look around the vertices that moved since,
//! or were given another ring. When a pass from such seeds finds nothing more, a pass everywhere finds nothing either
//! (`what_a_ledger_leaves_out_needs_no_edit` among the tests).

use glam::DVec3;

use super::{Edits, Sizing};
use crate::{EdgeId, Mesh, VertexId};

/// Where a pass starts.
#[derive(Clone, Copy, Debug)]
pub enum Seeds<'a> {
    /// At every edge.
    All,
    /// At the edges of the faces around these vertices and around their neighbours.
    Around(&'a [VertexId]),
}

impl Seeds<'_> {
    /// These seeds and what was touched since, collected in `room`.
    pub(super) fn with<'b>(self, edits: &Edits, room: &'b mut Vec<VertexId>) -> Seeds<'b> {
        let Self::Around(vertices) = self else { return Seeds::All };
        room.clear();
        room.extend_from_slice(vertices);
        room.extend_from_slice(&edits.touched);
        Seeds::Around(room)
    }

    /// The ends of the edges to look at, in index order.
    pub(super) fn vertices(self, mesh: &Mesh) -> Vec<VertexId> {
        if matches!(self, Self::All) {
            return mesh.vertices().collect();
        }
        let mut ends: Vec<_> = self.edges(mesh).into_iter().flat_map(|e| mesh.edge_vertices(e)).collect();
        ends.sort_unstable();
        ends.dedup();
        ends
    }

    /// The edges to look at, in index order.
    pub(super) fn edges(self, mesh: &Mesh) -> Vec<EdgeId> {
        let Self::Around(vertices) = self else { return mesh.edges().collect() };
        let mut is_near = vec![false; mesh.vertex_slots()];
        let mut near = Vec::new();
        for &v in vertices.iter().filter(|&&v| mesh.has_vertex(v)) {
            for w in mesh.neighbours_of(v).chain([v]) {
                if !core::mem::replace(&mut is_near[w.index()], true) {
                    near.push(w);
                }
            }
        }
        let mut edges = Vec::new();
        for v in near {
            edges.extend(mesh.wedges(v).flat_map(|wedge| mesh.face_edges(wedge.face())));
        }
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}

/// Remembers in which state each vertex was last looked at.
#[derive(Clone, Debug, Default)]
pub struct Ledger {
    /// Place and wanted edge length by vertex slot; a length of NaN, which equals nothing, if never.
    seen: Vec<(DVec3, f64)>,
}

impl Ledger {
    /// The living vertices that are not as they were last looked at, in index order: moved by more than `slack` of
    /// their wanted edge length, wanting another length, or edited. From now on they count as looked at.
    ///
    /// With a slack of 0 nothing is overlooked. With more, a pass may leave out what a vertex that crept on by less
    /// would have changed; so a sequence of passes must end with one of slack 0.
    pub fn take(&mut self, mesh: &Mesh, positions: &[DVec3], sizing: &Sizing, slack: f64) -> Vec<VertexId> {
        self.seen.resize(mesh.vertex_slots(), NEVER);
        let mut changed = Vec::new();
        for v in mesh.vertices() {
            let (at, target) = (positions[v.index()], sizing.at(v));
            let seen = &mut self.seen[v.index()];
            let is_near = seen.0 == at || seen.0.distance(at) <= slack * target;
            if !(is_near && seen.1 == target) {
                *seen = (at, target);
                changed.push(v);
            }
        }
        changed
    }

    /// Notes what a pass did: the next one looks at these vertices again, or everywhere if a limit stopped it.
    pub fn note(&mut self, edits: &Edits) {
        if edits.is_cut_short {
            self.seen.clear();
        }
        for v in &edits.touched {
            if let Some(seen) = self.seen.get_mut(v.index()) {
                *seen = NEVER;
            }
        }
    }
}

const NEVER: (DVec3, f64) = (DVec3::NAN, f64::NAN);
