//! The collapse: a vertex slides along an edge into its neighbour.
//!
//! The surface keeps its kind when the links of the two vertices meet in the link of their edge only
//! (Dey, Edelsbrunner, Guha, Nekhayev 1999), the boundary being thought closed by one more vertex. The
//! test below spells this out for triangles.

use super::{Blocked, Track};
use crate::topology::Outside;
use crate::{HalfedgeId, Mesh, VertexId, Wedge};

impl Mesh {
    /// Whether `remove` can slide into its neighbour `keep`.
    ///
    /// # Errors
    /// Control points never go. A vertex of a control curve or of the boundary goes only along it, and
    /// only if the loop has more than three vertices. The link condition must hold.
    pub fn can_collapse(&self, remove: VertexId, keep: VertexId) -> Result<(), Blocked> {
        let Some(e) = self.edge_between(remove, keep) else {
            return Err(Blocked::NotNeighbours(remove, keep));
        };
        let track = self.track(remove)?;
        let (x, y) = self.edge_opposites(e);
        let is_opposite = |w: VertexId| w == x || Some(w) == y;
        if let Track::Along(first, second) = track {
            if e != first && e != second {
                let on_curve = self.is_source_edge(first);
                return Err(if on_curve {
                    Blocked::LeavesCurve(remove)
                } else {
                    Blocked::LeavesBoundary(remove)
                });
            }
            let ahead = self.other_end(if e == first { second } else { first }, remove);
            // Sliding along lays the line on the edge that closes the triangle.
            if let Some(closing) = self.edge_between(keep, ahead)
                && (self.is_source_edge(closing) || self.is_boundary_edge(closing))
            {
                return Err(Blocked::SmallestLoop(remove));
            }
        }
        for w in self.neighbours_of(remove) {
            if !is_opposite(w) && w != keep && self.are_neighbours(w, keep) {
                return Err(Blocked::CommonNeighbour(remove, keep, w));
            }
        }
        // The face (remove, x, y) would fall upon (keep, x, y).
        if let Some(y) = y
            && self.face_between(remove, x, y).is_some()
            && self.face_between(keep, x, y).is_some()
        {
            return Err(Blocked::SmallestPiece(remove));
        }
        Ok(())
    }

    /// Slides `remove` into `keep`. The faces at their edge vanish; edges from `remove` to the vertices
    /// opposite merge into those from `keep`, which keep their handles and take over a control curve that
    /// ran through `remove`.
    ///
    /// ```text
    ///        x                x
    ///      / | \              |
    ///     /  |  \             |
    ///   ── r ── k ──   →   ── k ──
    ///     \  |  /             |
    ///      \ | /              |
    ///        y                y
    /// ```
    pub fn collapse(&mut self, remove: VertexId, keep: VertexId) {
        debug_assert_eq!(self.can_collapse(remove, keep), Ok(()));
        let Some(e) = self.edge_between(remove, keep) else { return };
        let around: Vec<Wedge> = self.wedges(remove).collect();
        let h = self.halfedge_of(e);
        let doomed = [Some(h), self.twin(h)];
        for wedge in &around {
            self.corner[wedge.corner.index()] = keep.0;
        }
        for h in doomed.into_iter().flatten() {
            // The two corners at the edge now both name `keep`; the apex tells the other sides apart.
            let corner_of_remove = around.iter().find(|w| w.face() == h.face()).map(|w| w.corner);
            let starts_at_remove = corner_of_remove == Some(h);
            let (from_keep, from_remove) =
                if starts_at_remove { (h.next(), h.prev()) } else { (h.prev(), h.next()) };
            let apex = self.apex(h);
            let (kept, gone) = (self.outside(from_keep), self.outside(from_remove));
            self.free_face(h.face());
            self.zip(kept, gone);
            if let Some(side) = kept.twin.or(gone.twin) {
                self.anchor_at(side, apex);
                self.anchor_at(side, keep);
            }
        }
        self.free_edge(e);
        self.free_vertex(remove);
        if let Some(w) = around.iter().find(|w| self.has_face(w.face())) {
            self.anchor[keep.index()] = w.corner.0;
        }
    }

    /// Sews together what lay beyond two sides of a face that is gone: `gone` is merged into `kept`.
    pub(super) fn zip(&mut self, kept: Outside, gone: Outside) {
        if let Some(tag) = self.edge_source(gone.edge) {
            self.edge_source[kept.edge.index()] = Some(tag);
        }
        self.free_edge(gone.edge);
        match (kept.twin, gone.twin) {
            (Some(h), twin) => self.join(h, Outside { edge: kept.edge, twin }),
            (None, Some(h)) => self.join(h, Self::open(kept.edge)),
            (None, None) => debug_assert!(false, "{:?} would dangle", kept.edge),
        }
    }

    /// Anchors `v` at the end of `side` where it lies.
    pub(super) fn anchor_at(&mut self, side: HalfedgeId, v: VertexId) {
        let h = if self.origin(side) == v { side } else { side.next() };
        self.anchor[v.index()] = h.0;
    }
}
