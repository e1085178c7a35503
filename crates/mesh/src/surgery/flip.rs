//! The flip: an edge gives way to the other diagonal of its quadrilateral.

use super::Blocked;
use crate::topology::Outside;
use crate::{EdgeId, Mesh};

impl Mesh {
    /// Whether `e` can be exchanged for the other diagonal.
    ///
    /// No vertex can end up with too few neighbours: if an inner end of `e` has only three, the opposite
    /// vertices are already joined; and an end on the boundary keeps its two boundary edges.
    ///
    /// # Errors
    /// `e` lies on the boundary or on a control curve, or the opposite vertices are neighbours already.
    pub fn can_flip(&self, e: EdgeId) -> Result<(), Blocked> {
        if self.is_source_edge(e) {
            return Err(Blocked::SourceEdge(e));
        }
        let (c, Some(d)) = self.edge_opposites(e) else {
            return Err(Blocked::BoundaryEdge(e));
        };
        if self.are_neighbours(c, d) {
            return Err(Blocked::SecondEdge(c, d));
        }
        Ok(())
    }

    /// Turns `e = ab` into `cd`, `c` and `d` being the vertices opposite. The edge and both faces keep
    /// their handles; both faces take the winding of the first of [`Mesh::edge_faces`].
    ///
    /// ```text
    ///       c                c
    ///      / \              /|\
    ///     / f \            / | \
    ///   a ─ e ─ b   →    a f e g b
    ///     \ g /            \ | /
    ///      \ /              \|/
    ///       d                d
    /// ```
    pub fn flip(&mut self, e: EdgeId) {
        debug_assert_eq!(self.can_flip(e), Ok(()));
        let h = self.halfedge_of(e);
        let Some(t) = self.twin(h) else { return };
        let (a, b, c, d) = (self.origin(h), self.target(h), self.apex(h), self.apex(t));
        let (bc, ca) = (self.outside(h.next()), self.outside(h.prev()));
        let (ad, db) = if self.origin(t) == b {
            (self.outside(t.next()), self.outside(t.prev()))
        } else {
            (self.outside(t.prev()), self.outside(t.next()))
        };
        let (f, g) = (h.face(), t.face());
        self.place(f, [c, a, d], [ca, ad, Self::open(e)]);
        self.place(g, [d, b, c], [db, bc, Outside { edge: e, twin: Some(f.halfedge(2)) }]);
    }
}
