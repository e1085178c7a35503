//! Taking a mesh apart and putting meshes together, without joining or opening anything: what was connected stays so.

use crate::topology::{NONE, Outside};
use crate::{FaceId, Mesh, VertexId};

/// A part of a mesh as a mesh of its own.
#[derive(Clone, Debug, Default)]
pub struct Extracted {
    /// The part, without dead slots. Order, windings and tags are kept.
    pub mesh: Mesh,
    /// For every vertex slot of the whole its name in the part.
    pub vertices: Vec<Option<VertexId>>,
    /// For every face slot of the whole its name in the part.
    pub faces: Vec<Option<FaceId>>,
}

/// Names in the mesh that another was added to.
#[derive(Clone, Debug, Default)]
pub struct Appended {
    /// For every vertex slot of the other its new name.
    pub vertices: Vec<Option<VertexId>>,
    /// For every face slot of the other its new name.
    pub faces: Vec<Option<FaceId>>,
}

impl Mesh {
    /// The faces that are wanted, as a mesh of their own. Take whole pieces: where a border of wanted and unwanted faces
    /// meets itself in a single vertex the part would be pinched, and `None` comes out. [`Mesh::cut`] along it first.
    #[must_use]
    pub fn extract(&self, is_wanted: impl Fn(FaceId) -> bool) -> Option<Extracted> {
        let mut vertices = vec![None; self.vertex_slots()];
        let mut faces = vec![None; self.face_slots()];
        let wanted: Vec<FaceId> = self.faces().filter(|f| is_wanted(*f)).collect();
        for (new, f) in wanted.iter().enumerate() {
            faces[f.index()] = Some(FaceId::from_index(new));
            for v in self.face_vertices(*f) {
                vertices[v.index()] = Some(VertexId::from_index(0));
            }
        }
        let kept: Vec<VertexId> = self.vertices().filter(|v| vertices[v.index()].is_some()).collect();
        for (new, v) in kept.iter().enumerate() {
            vertices[v.index()] = Some(VertexId::from_index(new));
        }
        let name = |v: VertexId| vertices[v.index()].map_or(NONE, |w| w.0);
        let triangles: Vec<_> = wanted.iter().map(|f| self.face_vertices(*f).map(name)).collect();
        let mut mesh = Self::from_triangles(kept.len(), &triangles).ok()?;
        for (new, v) in kept.iter().enumerate() {
            mesh.vertex_source[new] = self.vertex_source(*v);
        }
        for (new, f) in wanted.iter().enumerate() {
            for (old, side) in f.halfedges().into_iter().zip(FaceId::from_index(new).halfedges()) {
                let edge = mesh.edge_of(side);
                mesh.edge_source[edge.index()] = self.edge_source(self.edge_of(old));
            }
        }
        Some(Extracted { mesh, vertices, faces })
    }

    /// Adds the pieces of another mesh beside its own. Everything of its own keeps its name.
    pub fn append(&mut self, other: &Self) -> Appended {
        let mut appended =
            Appended { vertices: vec![None; other.vertex_slots()], faces: vec![None; other.face_slots()] };
        let mut edges = vec![None; other.edge_slots()];
        for v in other.vertices() {
            let new = self.add_vertex();
            self.vertex_source[new.index()] = other.vertex_source(v);
            appended.vertices[v.index()] = Some(new);
        }
        for f in other.faces() {
            let new = self.add_face();
            appended.faces[f.index()] = Some(new);
            let mut outside = [None; 3];
            for (slot, h) in outside.iter_mut().zip(f.halfedges()) {
                let old = other.edge_of(h);
                let edge = *edges[old.index()].get_or_insert_with(|| self.add_edge(other.edge_source(old)));
                // The face beyond, if it has been added already, lies at the other side of the edge.
                let beyond = other.twin(h).and_then(|t| {
                    let face = appended.faces[t.face().index()].filter(|face| *face != new)?;
                    let corner = t.face().halfedges().iter().position(|own| *own == t)?;
                    Some(face.halfedges()[corner])
                });
                *slot = Some(Outside { edge, twin: beyond });
            }
            let corners = other.face_vertices(f).map(|v| appended.vertices[v.index()]);
            if let ([Some(a), Some(b), Some(c)], [Some(x), Some(y), Some(z)]) = (corners, outside) {
                self.place(new, [a, b, c], [x, y, z]);
            }
        }
        appended
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SourceTag, components, primitive, summary, validate};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn what_is_added_is_taken_out_again() {
        let wholes = [
            primitive::torus(6, 5, 2.0, 1.0).0,
            primitive::moebius(6, 2, 2.0, 1.0).0,
            primitive::plane(4, 3, 1.0).0,
        ];
        for (k, first) in wholes.iter().enumerate() {
            let mut second = wholes[(k + 1) % 3].clone();
            let edge = second.edges().nth(4).unwrap();
            second.set_edge_source(edge, Some(SourceTag(7)));
            second.set_vertex_source(VertexId::from_index(3), Some(SourceTag(9)));
            let mut both = first.clone();
            let added = both.append(&second);
            assert_eq!(validate(&both), Ok(()));
            assert_eq!(summary(&both).euler, summary(first).euler + summary(&second).euler);
            let pieces = components(&both);
            let of_second = added.faces[0].unwrap();
            let out = both.extract(|f| pieces.of(f) == pieces.of(of_second)).unwrap();
            assert_eq!(validate(&out.mesh), Ok(()));
            assert_eq!(out.mesh.to_triangles(), second.to_triangles());
            assert_eq!(out.mesh.vertex_source(VertexId::from_index(3)), Some(SourceTag(9)));
            let ends = second.edge_vertices(edge);
            let same = out.mesh.edge_between(ends[0], ends[1]).unwrap();
            assert_eq!(out.mesh.edge_source(same), Some(SourceTag(7)));
            assert!(out.mesh.edges().filter(|e| out.mesh.is_source_edge(*e)).count() == 1);
        }
    }

    #[test]
    fn names_of_dead_slots_are_given_anew() {
        let (mut mesh, _) = primitive::icosphere(1);
        let (v, w) = (VertexId::from_index(20), VertexId::from_index(3));
        mesh.delete_vertex(v);
        let (other, _) = primitive::octahedron();
        let added = mesh.append(&other);
        assert_eq!(validate(&mesh), Ok(()));
        assert!(added.vertices.iter().flatten().any(|new| *new == v) && mesh.has_vertex(w));
    }

    #[test]
    fn a_part_that_would_be_pinched_is_refused() {
        let (mesh, _) = primitive::plane(2, 2, 1.0);
        let middle = mesh.vertices().find(|v| !mesh.is_boundary_vertex(*v)).unwrap();
        let mut ring = Vec::new();
        mesh.ring_faces(middle, &mut ring);
        let (one, opposite) = (ring[0], ring[ring.len() / 2]);
        assert!(mesh.extract(|f| f == one || f == opposite).is_none());
    }
}
