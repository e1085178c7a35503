//! Splits: a new vertex on an edge or in a face (Alexander's refinements of order 1 and 2).

use crate::topology::Outside;
use crate::{EdgeId, FaceId, HalfedgeId, Mesh, VertexId};

impl Mesh {
    /// Puts a new vertex `m` on `e = ab` and joins it to the opposite vertices. Always possible.
    ///
    /// `e` becomes the half at `a`, the first of [`Mesh::edge_vertices`]; the other half is a new edge with
    /// the same source tag. The new edges to the opposite vertices carry none.
    ///
    /// ```text
    ///       c                 c
    ///      / \              / | \
    ///     / f \            / f|f'\
    ///   a ─ e ─ b   →    a ─e─ m ── b
    ///     \ g /            \ g|g'/
    ///      \ /              \ | /
    ///       d                 d
    /// ```
    pub fn split_edge(&mut self, e: EdgeId) -> VertexId {
        let h = self.halfedge_of(e);
        let twin = self.twin(h);
        let (a, b) = (self.origin(h), self.target(h));
        let m = self.add_vertex();
        let far = self.add_edge(self.edge_source(e));
        let (near_side, far_side) = self.halve_face(h, m, e, far);
        if let Some(t) = twin {
            let turned = self.origin(t) != b;
            let (near, far_edge) = if turned { (e, far) } else { (far, e) };
            let (first, second) = self.halve_face(t, m, near, far_edge);
            let (at_a, at_b) = if turned { (first, second) } else { (second, first) };
            self.join(near_side, Outside { edge: e, twin: Some(at_a) });
            self.join(far_side, Outside { edge: far, twin: Some(at_b) });
        }
        debug_assert_eq!(self.edge_vertices(e), [a, m], "the face of `h` was written last at `e`");
        m
    }

    /// Cuts the face of `h = pq` from its apex to `m` on `h`. The halves of `h` become sides of `first`
    /// (at `p`) and `second` (at `q`), left open towards the other face, and are returned.
    fn halve_face(
        &mut self,
        h: HalfedgeId,
        m: VertexId,
        first: EdgeId,
        second: EdgeId,
    ) -> (HalfedgeId, HalfedgeId) {
        let (p, q, c) = (self.origin(h), self.target(h), self.apex(h));
        let (qc, cp) = (self.outside(h.next()), self.outside(h.prev()));
        let spoke = self.add_edge(None);
        let (f, g) = (h.face(), self.add_face());
        self.place(f, [p, m, c], [Self::open(first), Self::open(spoke), cp]);
        let across = Outside { edge: spoke, twin: Some(f.halfedge(1)) };
        self.place(g, [m, q, c], [Self::open(second), qc, across]);
        (f.halfedge(0), g.halfedge(0))
    }

    /// Puts a new vertex in `f` and joins it to the corners. Always possible.
    ///
    /// ```text
    ///        c               c
    ///       / \            / | \
    ///      /   \    →     / .m. \
    ///     /  f  \        /.     .\
    ///    a ───── b      a ─────── b
    /// ```
    pub fn split_face(&mut self, f: FaceId) -> VertexId {
        let [a, b, c] = self.face_vertices(f);
        let [ab, bc, ca] = f.halfedges().map(|h| self.outside(h));
        let m = self.add_vertex();
        let [am, bm, cm] = [(); 3].map(|()| self.add_edge(None));
        let (g, k) = (self.add_face(), self.add_face());
        self.place(f, [a, b, m], [ab, Self::open(bm), Self::open(am)]);
        let beside = |edge, h| Outside { edge, twin: Some(h) };
        self.place(g, [b, c, m], [bc, Self::open(cm), beside(bm, f.halfedge(1))]);
        self.place(k, [c, a, m], [ca, beside(am, f.halfedge(2)), beside(cm, g.halfedge(1))]);
        m
    }
}
