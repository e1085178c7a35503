//! Walking over the mesh: ends and sides of edges, rings of vertices.
//!
//! Around a vertex `v` every incident face is a *wedge* between two edges of `v`. A ring is walked
//! wedge by wedge; each wedge is entered by one edge and left by the other:
//!
//! ```text
//!        w2 ______ w1
//!          \      /\        The faces' winding is counter-clockwise, and so is the ring:
//!     exit  \ f  /  \       w0, w1, w2, …  The wedge in face f = (v, w1, w2) is entered by
//!            \  / entry     v w1 and left by v w2.
//!             \/______\
//!             v        w0
//! ```
//!
//! Where neighbouring faces are wound against each other the walk carries the sense of the face of
//! [`Mesh::anchor`] on; [`Wedge::agrees`] tells which faces are wound with the ring.

use crate::{EdgeId, FaceId, HalfedgeId, Mesh, VertexId};

/// One face seen from one of its corners, walked through in a sense.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Wedge {
    /// The side starting at the vertex; its [`HalfedgeId::face`] is the face.
    pub corner: HalfedgeId,
    /// Whether the face's own local order runs in the sense of the walk.
    pub agrees: bool,
}

impl Wedge {
    /// The wedge's face.
    #[inline]
    #[must_use]
    pub const fn face(self) -> FaceId {
        self.corner.face()
    }

    /// The side by which the walk comes in.
    #[inline]
    #[must_use]
    pub const fn entry(self) -> HalfedgeId {
        if self.agrees { self.corner } else { self.corner.prev() }
    }

    /// The side by which the walk goes on.
    #[inline]
    #[must_use]
    pub const fn exit(self) -> HalfedgeId {
        if self.agrees { self.corner.prev() } else { self.corner }
    }
}

/// Faces and edges.
impl Mesh {
    /// The corners of a face in its local order.
    #[inline]
    #[must_use]
    pub fn face_vertices(&self, f: FaceId) -> [VertexId; 3] {
        f.halfedges().map(|h| self.origin(h))
    }

    /// The edges of a face in its local order.
    #[inline]
    #[must_use]
    pub fn face_edges(&self, f: FaceId) -> [EdgeId; 3] {
        f.halfedges().map(|h| self.edge_of(h))
    }

    /// The ends of an edge, in the direction of [`Mesh::halfedge_of`].
    #[inline]
    #[must_use]
    pub fn edge_vertices(&self, e: EdgeId) -> [VertexId; 2] {
        let h = self.halfedge_of(e);
        [self.origin(h), self.target(h)]
    }

    /// The faces on both sides of an edge: the face of [`Mesh::halfedge_of`] and, inside, the other one.
    #[inline]
    #[must_use]
    pub fn edge_faces(&self, e: EdgeId) -> (FaceId, Option<FaceId>) {
        let h = self.halfedge_of(e);
        (h.face(), self.twin(h).map(HalfedgeId::face))
    }

    /// The vertices opposite an edge, in the order of [`Mesh::edge_faces`].
    #[inline]
    #[must_use]
    pub fn edge_opposites(&self, e: EdgeId) -> (VertexId, Option<VertexId>) {
        let h = self.halfedge_of(e);
        (self.apex(h), self.twin(h).map(|t| self.apex(t)))
    }

    /// The edge joining `a` and `b`, if they are neighbours.
    #[must_use]
    pub fn edge_between(&self, a: VertexId, b: VertexId) -> Option<EdgeId> {
        self.sides_around(a).find(|&h| self.far_end(a, h) == b).map(|h| self.edge_of(h))
    }

    /// The end of `e` that is not `v`.
    #[inline]
    #[must_use]
    pub fn other_end(&self, e: EdgeId, v: VertexId) -> VertexId {
        let [a, b] = self.edge_vertices(e);
        debug_assert!(v == a || v == b, "{v} is no end of {e}");
        if v == a { b } else { a }
    }

    /// Whether only one face lies at the edge.
    #[inline]
    #[must_use]
    pub fn is_boundary_edge(&self, e: EdgeId) -> bool {
        self.twin(self.halfedge_of(e)).is_none()
    }

    /// Whether the two faces at the edge are wound alike; `true` on the boundary.
    #[inline]
    #[must_use]
    pub fn is_wound_alike(&self, e: EdgeId) -> bool {
        let h = self.halfedge_of(e);
        self.twin(h).is_none_or(|t| self.origin(h) != self.origin(t))
    }

    /// The face with these corners, if there is one.
    #[must_use]
    pub fn face_between(&self, a: VertexId, b: VertexId, c: VertexId) -> Option<FaceId> {
        let (f, g) = self.edge_faces(self.edge_between(a, b)?);
        [Some(f), g].into_iter().flatten().find(|&x| self.face_vertices(x).contains(&c))
    }
}

/// Rings.
impl Mesh {
    /// The wedge of `v` entered by the side `h`.
    #[inline]
    pub(crate) fn wedge_entered_by(&self, v: VertexId, h: HalfedgeId) -> Wedge {
        let agrees = self.origin(h) == v;
        Wedge { corner: if agrees { h } else { h.next() }, agrees }
    }

    /// The wedge of `v` left by the side `h`.
    #[inline]
    pub(crate) fn wedge_left_by(&self, v: VertexId, h: HalfedgeId) -> Wedge {
        let agrees = self.origin(h) != v;
        Wedge { corner: if agrees { h.next() } else { h }, agrees }
    }

    /// The wedge after `w` around `v`; `None` past the boundary.
    #[inline]
    pub(crate) fn wedge_after(&self, v: VertexId, w: Wedge) -> Option<Wedge> {
        self.twin(w.exit()).map(|t| self.wedge_entered_by(v, t))
    }

    /// The wedge before `w` around `v`; `None` past the boundary.
    #[inline]
    pub(crate) fn wedge_before(&self, v: VertexId, w: Wedge) -> Option<Wedge> {
        self.twin(w.entry()).map(|t| self.wedge_left_by(v, t))
    }

    /// The first wedge of the ring of `v` (at the boundary, if there is one), and whether the ring closes.
    fn first_wedge(&self, v: VertexId) -> (Wedge, bool) {
        let start = Wedge { corner: self.anchor(v), agrees: true };
        let mut first = start;
        while let Some(w) = self.wedge_before(v, first) {
            if w.corner == start.corner {
                return (start, true);
            }
            first = w;
        }
        (first, false)
    }

    /// The wedges around `v` in ring order. For a boundary vertex they run from boundary to boundary.
    pub fn wedges(&self, v: VertexId) -> impl Iterator<Item = Wedge> + '_ {
        let (first, _) = self.first_wedge(v);
        let mut ahead = Some(first);
        core::iter::from_fn(move || {
            let now = ahead?;
            ahead = self.wedge_after(v, now).filter(|w| w.corner != first.corner);
            Some(now)
        })
    }

    /// The edges at `v` in ring order.
    pub fn spokes(&self, v: VertexId) -> impl Iterator<Item = EdgeId> + '_ {
        self.spoke_sides(v).map(|h| self.edge_of(h))
    }

    /// The neighbours of `v` in ring order.
    pub fn neighbours(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.spoke_sides(v).map(move |h| self.far_end(v, h))
    }

    #[inline]
    fn far_end(&self, v: VertexId, h: HalfedgeId) -> VertexId {
        let a = self.origin(h);
        if a == v { self.target(h) } else { a }
    }

    /// One side per edge at `v` from the anchor on, in a single sweep; at a boundary not in ring order.
    fn sides_around(&self, v: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let start = Wedge { corner: self.anchor(v), agrees: true };
        let (mut ahead, mut rim, mut behind) = (Some(start), None, None);
        core::iter::from_fn(move || {
            let Some(now) = ahead else {
                if let Some(last) = rim.take() {
                    return Some(last);
                }
                let now: Wedge = behind?;
                behind = self.wedge_before(v, now);
                return Some(now.entry());
            };
            ahead = self.wedge_after(v, now);
            if ahead.is_none() {
                rim = Some(now.exit());
                behind = self.wedge_before(v, start);
            }
            ahead = ahead.filter(|w| w.corner != start.corner);
            Some(now.entry())
        })
    }

    /// The edges at `v`, at a boundary not in ring order: for questions that need no order.
    pub(crate) fn edges_at(&self, v: VertexId) -> impl Iterator<Item = EdgeId> + '_ {
        self.sides_around(v).map(|h| self.edge_of(h))
    }

    /// The neighbours of `v`, at a boundary not in ring order.
    pub(crate) fn neighbours_of(&self, v: VertexId) -> impl Iterator<Item = VertexId> + '_ {
        self.sides_around(v).map(move |h| self.far_end(v, h))
    }

    /// One side per edge at `v` in ring order: the entries of its wedges, and at a boundary the last exit.
    fn spoke_sides(&self, v: VertexId) -> impl Iterator<Item = HalfedgeId> + '_ {
        let (first, closed) = self.first_wedge(v);
        let mut ahead = Some(first);
        let mut last = None;
        core::iter::from_fn(move || {
            let Some(now) = ahead else { return last.take() };
            ahead = self.wedge_after(v, now).filter(|w| w.corner != first.corner);
            if ahead.is_none() && !closed {
                last = Some(now.exit());
            }
            Some(now.entry())
        })
    }

    /// Fills `ring` with the neighbours of `v` in order and returns whether they close around `v`.
    ///
    /// The order is counter-clockwise for one who sees the face of [`Mesh::anchor`] wound
    /// counter-clockwise, so a normal fitted by the right-hand rule points to him. For a boundary vertex
    /// the ring starts and ends with its two boundary neighbours. Neighbours `k` and `k + 1` span a face
    /// with `v`; the last and the first do so if the ring closes.
    pub fn ring(&self, v: VertexId, ring: &mut Vec<VertexId>) -> bool {
        ring.clear();
        let start = Wedge { corner: self.anchor(v), agrees: true };
        let mut at = start;
        loop {
            ring.push(self.entry_neighbour(at));
            match self.wedge_after(v, at) {
                Some(w) if w.corner == start.corner => return true,
                Some(w) => at = w,
                None => break,
            }
        }
        ring.push(if at.agrees { self.apex(at.corner) } else { self.target(at.corner) });
        let ahead = ring.len();
        at = start;
        while let Some(w) = self.wedge_before(v, at) {
            ring.push(self.entry_neighbour(w));
            at = w;
        }
        ring[ahead..].reverse();
        ring.rotate_left(ahead);
        false
    }

    /// The neighbour at the far end of the side by which `w` is entered.
    #[inline]
    fn entry_neighbour(&self, w: Wedge) -> VertexId {
        if w.agrees { self.target(w.corner) } else { self.apex(w.corner) }
    }

    /// Fills `faces` with the faces around `v`, face `k` lying between ring neighbours `k` and `k + 1`,
    /// and returns whether they close.
    pub fn ring_faces(&self, v: VertexId, faces: &mut Vec<FaceId>) -> bool {
        faces.clear();
        faces.extend(self.wedges(v).map(Wedge::face));
        self.first_wedge(v).1
    }

    /// The number of neighbours of `v`, and whether they close around it.
    pub(crate) fn degree(&self, v: VertexId) -> (usize, bool) {
        let start = Wedge { corner: self.anchor(v), agrees: true };
        let (mut at, mut count) = (start, 1);
        while let Some(w) = self.wedge_after(v, at) {
            if w.corner == start.corner {
                return (count, true);
            }
            at = w;
            count += 1;
        }
        // At a boundary there is one neighbour more than wedges.
        count += 1;
        at = start;
        while let Some(w) = self.wedge_before(v, at) {
            at = w;
            count += 1;
        }
        (count, false)
    }

    /// The number of neighbours of `v`.
    #[must_use]
    pub fn valence(&self, v: VertexId) -> usize {
        self.degree(v).0
    }

    /// Whether `v` lies on the boundary.
    #[must_use]
    pub fn is_boundary_vertex(&self, v: VertexId) -> bool {
        !self.first_wedge(v).1
    }

    /// Whether `a` and `b` are joined by an edge.
    #[must_use]
    pub fn are_neighbours(&self, a: VertexId, b: VertexId) -> bool {
        self.neighbours_of(a).any(|w| w == b)
    }

    /// Whether the rings of the two ends of `e` are walked in the same sense, seen across the edge.
    ///
    /// Always so after [`propagate_orientation`](crate::propagate_orientation) on an orientable mesh. Where
    /// it is not, a normal at one end must change sign before it is compared with one at the other.
    #[must_use]
    pub fn do_rings_agree(&self, e: EdgeId) -> bool {
        let f = self.halfedge_of(e).face();
        let sense = |v| self.wedges(v).find(|w| w.face() == f).is_some_and(|w| w.agrees);
        let [a, b] = self.edge_vertices(e);
        sense(a) == sense(b)
    }
}

#[cfg(test)]
mod tests;
