//! The mesh itself: flat arrays that say which triangles meet along which edges.
//!
//! Pure connectivity. Positions, normals and sizes live in slices outside, indexed by
//! [`VertexId::index`]. The surface may be of any topological type, closed or bounded, orientable or not,
//! and in several pieces; it is always a simplicial complex (two vertices share at most one edge, three
//! vertices span at most one face), because a curve of nodes must name its edges by its nodes
//! (Welch 1995, §4.2.1).
//!
//! Invariants, checked by [`validate`](crate::validate):
//! 1. `twin[twin[h]] == h` and `twin[h] != h`; a boundary side has no twin.
//! 2. `edge[h] == edge[twin[h]]`; `edge_side[e]` is one of the sides of `e`.
//! 3. Twins join the same two vertices. Their faces are wound alike across the edge if and only if
//!    `origin(h) == target(twin(h))`; otherwise the local orders clash, which is allowed (on a Möbius
//!    strip it cannot be avoided).
//! 4. `anchor[v]` is a side starting at `v`; the faces around `v` form one disc or one half-disc.
//! 5. Dead slots are listed in the free lists, and new elements fill them before the arrays grow.

use crate::{EdgeId, FaceId, HalfedgeId, SourceTag, VertexId};

/// Marks a missing twin and a dead slot.
pub(crate) const NONE: u32 = u32::MAX;

/// Connectivity of a triangulated surface: which triangles meet along which edges.
///
/// It may be of any topological type, closed or bounded, orientable or not, and in several pieces, but is
/// always a simplicial complex: two vertices share at most one edge, three span at most one face, and
/// every vertex has a face. The local orders (windings) of neighbouring faces may clash; on a one-sided
/// surface somewhere they must. Positions are kept outside, in slices indexed by [`VertexId::index`].
#[derive(Clone, Debug, Default)]
pub struct Mesh {
    /// Vertex at each corner, three per face; `NONE` in dead faces.
    pub(crate) corner: Vec<u32>,
    /// The side across the edge, per side; `NONE` on the boundary.
    pub(crate) twin: Vec<u32>,
    /// The edge of each side.
    pub(crate) edge: Vec<u32>,
    /// One side per edge; `NONE` in dead edges.
    pub(crate) edge_side: Vec<u32>,
    /// One side starting at each vertex; `NONE` in dead vertices.
    pub(crate) anchor: Vec<u32>,
    pub(crate) vertex_source: Vec<Option<SourceTag>>,
    pub(crate) edge_source: Vec<Option<SourceTag>>,
    pub(crate) free_vertices: Vec<u32>,
    pub(crate) free_edges: Vec<u32>,
    pub(crate) free_faces: Vec<u32>,
}

/// What lies beyond one side of a face: kept while the face is rewritten.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Outside {
    pub(crate) edge: EdgeId,
    pub(crate) twin: Option<HalfedgeId>,
}

#[inline]
fn some(h: u32) -> Option<HalfedgeId> {
    if h == NONE { None } else { Some(HalfedgeId(h)) }
}

/// Counts, slots and liveness.
impl Mesh {
    /// How many vertices live.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.anchor.len() - self.free_vertices.len()
    }

    /// How many edges live.
    #[must_use]
    pub fn edge_count(&self) -> usize {
        self.edge_side.len() - self.free_edges.len()
    }

    /// How many faces live.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.corner.len() / 3 - self.free_faces.len()
    }

    /// One more than the largest vertex index ever used: the length of slices indexed by vertex.
    #[must_use]
    pub fn vertex_slots(&self) -> usize {
        self.anchor.len()
    }

    /// One more than the largest edge index ever used.
    #[must_use]
    pub fn edge_slots(&self) -> usize {
        self.edge_side.len()
    }

    /// One more than the largest face index ever used.
    #[must_use]
    pub fn face_slots(&self) -> usize {
        self.corner.len() / 3
    }

    /// Whether `v` names a vertex that lives.
    #[inline]
    #[must_use]
    pub fn has_vertex(&self, v: VertexId) -> bool {
        self.anchor.get(v.index()).is_some_and(|&h| h != NONE)
    }

    /// Whether `e` names an edge that lives.
    #[inline]
    #[must_use]
    pub fn has_edge(&self, e: EdgeId) -> bool {
        self.edge_side.get(e.index()).is_some_and(|&h| h != NONE)
    }

    /// Whether `f` names a face that lives.
    #[inline]
    #[must_use]
    pub fn has_face(&self, f: FaceId) -> bool {
        self.corner.get(3 * f.index()).is_some_and(|&v| v != NONE)
    }

    /// Living vertices in index order.
    pub fn vertices(&self) -> impl Iterator<Item = VertexId> + '_ {
        (0..self.vertex_slots()).map(VertexId::from_index).filter(|&v| self.has_vertex(v))
    }

    /// Living edges in index order.
    pub fn edges(&self) -> impl Iterator<Item = EdgeId> + '_ {
        (0..self.edge_slots()).map(EdgeId::from_index).filter(|&e| self.has_edge(e))
    }

    /// Living faces in index order.
    pub fn faces(&self) -> impl Iterator<Item = FaceId> + '_ {
        (0..self.face_slots()).map(FaceId::from_index).filter(|&f| self.has_face(f))
    }
}

/// Half-edges.
impl Mesh {
    /// The vertex a half-edge starts from.
    #[inline]
    #[must_use]
    pub fn origin(&self, h: HalfedgeId) -> VertexId {
        debug_assert!(self.has_face(h.face()), "{h} belongs to a dead face");
        VertexId(self.corner[h.index()])
    }

    /// The vertex a half-edge runs to.
    #[inline]
    #[must_use]
    pub fn target(&self, h: HalfedgeId) -> VertexId {
        self.origin(h.next())
    }

    /// The corner of the face that does not lie on the half-edge.
    #[inline]
    #[must_use]
    pub fn apex(&self, h: HalfedgeId) -> VertexId {
        self.origin(h.prev())
    }

    /// The half-edge across the edge; `None` on the boundary.
    #[inline]
    #[must_use]
    pub fn twin(&self, h: HalfedgeId) -> Option<HalfedgeId> {
        some(self.twin[h.index()])
    }

    /// The edge of a half-edge.
    #[inline]
    #[must_use]
    pub fn edge_of(&self, h: HalfedgeId) -> EdgeId {
        debug_assert!(self.has_face(h.face()), "{h} belongs to a dead face");
        EdgeId(self.edge[h.index()])
    }

    /// One half-edge of an edge.
    #[inline]
    #[must_use]
    pub fn halfedge_of(&self, e: EdgeId) -> HalfedgeId {
        debug_assert!(self.has_edge(e), "{e} is dead");
        HalfedgeId(self.edge_side[e.index()])
    }

    /// The half-edge from `v` whose face fixes the sense in which the ring of `v` is walked.
    #[inline]
    #[must_use]
    pub fn anchor(&self, v: VertexId) -> HalfedgeId {
        debug_assert!(self.has_vertex(v), "{v} is dead");
        HalfedgeId(self.anchor[v.index()])
    }
}

/// Making and unmaking elements; every surgery is written in these.
impl Mesh {
    pub(crate) fn add_vertex(&mut self) -> VertexId {
        if let Some(v) = self.free_vertices.pop() {
            return VertexId(v);
        }
        self.anchor.push(NONE);
        self.vertex_source.push(None);
        VertexId::from_index(self.anchor.len() - 1)
    }

    pub(crate) fn add_edge(&mut self, source: Option<SourceTag>) -> EdgeId {
        let e = self.free_edges.pop().map_or_else(
            || {
                self.edge_side.push(NONE);
                self.edge_source.push(None);
                EdgeId::from_index(self.edge_side.len() - 1)
            },
            EdgeId,
        );
        self.edge_source[e.index()] = source;
        e
    }

    pub(crate) fn add_face(&mut self) -> FaceId {
        if let Some(f) = self.free_faces.pop() {
            return FaceId(f);
        }
        for array in [&mut self.corner, &mut self.twin, &mut self.edge] {
            array.extend([NONE; 3]);
        }
        FaceId::from_index(self.corner.len() / 3 - 1)
    }

    pub(crate) fn free_vertex(&mut self, v: VertexId) {
        self.anchor[v.index()] = NONE;
        self.vertex_source[v.index()] = None;
        self.free_vertices.push(v.0);
    }

    pub(crate) fn free_edge(&mut self, e: EdgeId) {
        self.edge_side[e.index()] = NONE;
        self.edge_source[e.index()] = None;
        self.free_edges.push(e.0);
    }

    pub(crate) fn free_face(&mut self, f: FaceId) {
        for h in f.halfedges() {
            self.corner[h.index()] = NONE;
            self.twin[h.index()] = NONE;
            self.edge[h.index()] = NONE;
        }
        self.free_faces.push(f.0);
    }

    /// What lies beyond `h` now.
    pub(crate) fn outside(&self, h: HalfedgeId) -> Outside {
        Outside { edge: self.edge_of(h), twin: self.twin(h) }
    }

    /// The same edge with nothing beyond: for an edge just made, before its second face is placed.
    pub(crate) const fn open(edge: EdgeId) -> Outside {
        Outside { edge, twin: None }
    }

    /// Writes face `f` with `corners`, side `k` (corner `k` to `k + 1`) lying against `outside[k]`, and
    /// points the edges and corner vertices at it.
    pub(crate) fn place(&mut self, f: FaceId, corners: [VertexId; 3], outside: [Outside; 3]) {
        for (k, h) in f.halfedges().into_iter().enumerate() {
            self.corner[h.index()] = corners[k].0;
            self.anchor[corners[k].index()] = h.0;
            self.join(h, outside[k]);
        }
    }

    /// Lays side `h` against `outside`.
    pub(crate) fn join(&mut self, h: HalfedgeId, outside: Outside) {
        self.edge[h.index()] = outside.edge.0;
        self.edge_side[outside.edge.index()] = h.0;
        self.twin[h.index()] = outside.twin.map_or(NONE, |t| t.0);
        if let Some(t) = outside.twin {
            self.twin[t.index()] = h.0;
            self.edge[t.index()] = outside.edge.0;
        }
    }

    /// Opens `h` as a boundary side (nothing beyond it any more).
    pub(crate) fn bare(&mut self, outside: Outside) {
        if let Some(t) = outside.twin {
            self.twin[t.index()] = NONE;
            self.edge[t.index()] = outside.edge.0;
            self.edge_side[outside.edge.index()] = t.0;
        }
    }
}
