//! Source tags: which vertices are control points and which edges belong to control curves.
//!
//! Special nodes and edges of a triangulation are called *source* elements (Welch 1995, §4.2.1). The mesh
//! carries one number for each, the model knows what the number means. Surgery and remeshing keep source
//! vertices alive and source curves connected; new edges of a split source edge inherit its tag.

use crate::{EdgeId, Mesh, VertexId};

/// The model's number for a control point (on a vertex) or a control curve (on an edge).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SourceTag(pub u32);

impl Mesh {
    /// The control point at `v`, if any.
    #[inline]
    #[must_use]
    pub fn vertex_source(&self, v: VertexId) -> Option<SourceTag> {
        self.vertex_source[v.index()]
    }

    /// The control curve along `e`, if any.
    #[inline]
    #[must_use]
    pub fn edge_source(&self, e: EdgeId) -> Option<SourceTag> {
        self.edge_source[e.index()]
    }

    /// Makes `v` a control point (`Some`) or an ordinary vertex (`None`).
    pub fn set_vertex_source(&mut self, v: VertexId, tag: Option<SourceTag>) {
        debug_assert!(self.has_vertex(v), "{v} is dead");
        self.vertex_source[v.index()] = tag;
    }

    /// Makes `e` part of a control curve (`Some`) or an ordinary edge (`None`).
    pub fn set_edge_source(&mut self, e: EdgeId, tag: Option<SourceTag>) {
        debug_assert!(self.has_edge(e), "{e} is dead");
        self.edge_source[e.index()] = tag;
    }

    /// Forgets every source tag.
    pub fn clear_sources(&mut self) {
        self.vertex_source.fill(None);
        self.edge_source.fill(None);
    }

    /// Whether `v` is a control point.
    #[inline]
    #[must_use]
    pub fn is_source_vertex(&self, v: VertexId) -> bool {
        self.vertex_source(v).is_some()
    }

    /// Whether `e` belongs to a control curve.
    #[inline]
    #[must_use]
    pub fn is_source_edge(&self, e: EdgeId) -> bool {
        self.edge_source(e).is_some()
    }

    /// Whether a control curve passes through, ends at or forks at `v`.
    #[must_use]
    pub fn is_on_source_curve(&self, v: VertexId) -> bool {
        self.edges_at(v).any(|e| self.is_source_edge(e))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn tags_are_set_read_and_cleared() {
        let mut mesh = Mesh::from_triangles(3, &[[0, 1, 2]]).unwrap();
        let [v, w] = [VertexId::from_index(0), VertexId::from_index(2)];
        let e = mesh.edge_between(v, VertexId::from_index(1)).unwrap();
        mesh.set_vertex_source(v, Some(SourceTag(5)));
        mesh.set_edge_source(e, Some(SourceTag(6)));
        assert_eq!(mesh.vertex_source(v), Some(SourceTag(5)));
        assert_eq!(mesh.edge_source(e), Some(SourceTag(6)));
        assert!(mesh.is_on_source_curve(v) && !mesh.is_on_source_curve(w));
        mesh.clear_sources();
        assert!(!mesh.is_source_vertex(v) && !mesh.is_source_edge(e));
    }
}
