//! From a list of triangles to a [`Mesh`], or to a refusal that names the offender; and back.
//!
//! The winding of the triangles is kept as given and need not be consistent:
//! [`propagate_orientation`](crate::propagate_orientation) makes it so where the surface allows.

use thiserror::Error;

use crate::topology::NONE;
use crate::{FaceId, HalfedgeId, Mesh, VertexId};

/// Why a list of triangles is no triangulated surface. Faces are numbered by their place in the list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BuildError {
    /// A corner names a vertex that does not exist, as in `from_triangles(3, &[[0, 1, 7]])`. Raise the
    /// vertex count or mend the index.
    #[error("face {face:?} names vertex {index}, but there are only {count} vertices")]
    IndexOutOfRange {
        /// The face.
        face: FaceId,
        /// The index it names.
        index: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// A triangle visits a vertex twice, as in `[0, 1, 1]`. Leave it out.
    #[error("face {face:?} has vertex {vertex:?} at two corners")]
    RepeatedVertex {
        /// The face.
        face: FaceId,
        /// The vertex.
        vertex: VertexId,
    },
    /// Two triangles have the same three corners. Leave one out.
    #[error("faces {0:?} and {1:?} have the same corners")]
    DuplicateFace(FaceId, FaceId),
    /// More than two triangles meet along an edge, like the pages of a book. Double the edge's vertices.
    #[error("edge {0:?} {1:?} belongs to more than two faces; {2:?} is one too many")]
    CrowdedEdge(VertexId, VertexId, FaceId),
    /// The faces at a vertex form more than one fan, as where two cones touch. Double the vertex.
    #[error("the faces around {0:?} form more than one fan")]
    PinchedVertex(VertexId),
    /// No triangle uses the vertex. Leave it out.
    #[error("no face uses {0:?}")]
    IsolatedVertex(VertexId),
    /// The list is too long for 32-bit handles.
    #[error("too many vertices or faces for 32-bit handles")]
    TooLarge,
}

impl Mesh {
    /// Builds the surface of `triangles` over vertices `0..vertex_count`. Face `i` becomes triangle `i`
    /// with its corners in the given order; edges are numbered in order of first appearance.
    ///
    /// ```
    /// use ductile_mesh::{BuildError, Mesh, VertexId};
    /// // Two triangles wound against each other are welcome: no winding is demanded.
    /// let mesh = Mesh::from_triangles(4, &[[0, 1, 2], [0, 1, 3]])?;
    /// assert_eq!((mesh.vertex_count(), mesh.edge_count(), mesh.face_count()), (4, 5, 2));
    /// // A third page on the same spine is not.
    /// let book = Mesh::from_triangles(5, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
    /// assert!(matches!(book, Err(BuildError::CrowdedEdge(..))));
    /// # Ok::<(), BuildError>(())
    /// ```
    ///
    /// # Errors
    /// See [`BuildError`]: the first offender found is named.
    pub fn from_triangles(vertex_count: usize, triangles: &[[u32; 3]]) -> Result<Self, BuildError> {
        if vertex_count >= NONE as usize || triangles.len() >= NONE as usize / 3 {
            return Err(BuildError::TooLarge);
        }
        check_corners(vertex_count, triangles)?;
        let mut mesh = Self {
            corner: triangles.as_flattened().to_vec(),
            twin: vec![NONE; 3 * triangles.len()],
            edge: vec![NONE; 3 * triangles.len()],
            anchor: vec![NONE; vertex_count],
            vertex_source: vec![None; vertex_count],
            ..Self::default()
        };
        mesh.pair_sides()?;
        mesh.number_edges();
        mesh.set_anchors()?;
        Ok(mesh)
    }

    /// The living faces as index triples, in index order and local orientation.
    #[must_use]
    pub fn to_triangles(&self) -> Vec<[u32; 3]> {
        self.faces().map(|f| self.face_vertices(f).map(|v| v.0)).collect()
    }

    /// A copy without dead slots, and for every old vertex slot its new name. Order, windings and sources
    /// are kept.
    #[must_use]
    pub fn compacted(&self) -> (Self, Vec<Option<VertexId>>) {
        let mut name = vec![None; self.vertex_slots()];
        for (new, old) in self.vertices().enumerate() {
            name[old.index()] = Some(VertexId::from_index(new));
        }
        let renamed = |v: VertexId| name[v.index()].map_or(NONE, |w| w.0);
        let triangles: Vec<_> = self.faces().map(|f| self.face_vertices(f).map(renamed)).collect();
        let mut new = Self::from_triangles(self.vertex_count(), &triangles).unwrap_or_default();
        debug_assert_eq!(new.face_count(), self.face_count(), "a valid mesh stays one when renumbered");
        for (v, w) in self.vertices().filter_map(|v| Some((v, name[v.index()]?))) {
            new.vertex_source[w.index()] = self.vertex_source(v);
        }
        for (f, g) in self.faces().zip(0..).map(|(f, g)| (f, FaceId(g))) {
            for (h, k) in f.halfedges().into_iter().zip(g.halfedges()) {
                let e = new.edge_of(k);
                new.edge_source[e.index()] = self.edge_source(self.edge_of(h));
            }
        }
        (new, name)
    }

    /// Finds the twin of every side; sides are sorted by their ends, so the outcome is unique.
    fn pair_sides(&mut self) -> Result<(), BuildError> {
        let mut sides: Vec<(u32, u32, u32)> = (0..)
            .zip(&self.corner)
            .map(|(h, &a)| {
                let b = self.corner[HalfedgeId(h).next().index()];
                (a.min(b), a.max(b), h)
            })
            .collect();
        sides.sort_unstable();
        for run in sides.chunk_by(|s, t| (s.0, s.1) == (t.0, t.1)) {
            match *run {
                [(_, _, h), (_, _, t)] => {
                    let (h, t) = (HalfedgeId(h), HalfedgeId(t));
                    if self.apex(h) == self.apex(t) {
                        return Err(BuildError::DuplicateFace(h.face(), t.face()));
                    }
                    self.twin[h.index()] = t.0;
                    self.twin[t.index()] = h.0;
                }
                [(a, b, _), _, (_, _, h), ..] => {
                    return Err(BuildError::CrowdedEdge(VertexId(a), VertexId(b), HalfedgeId(h).face()));
                }
                _ => {}
            }
        }
        Ok(())
    }

    fn number_edges(&mut self) {
        for h in 0..self.corner.len() {
            if self.edge[h] == NONE {
                let e = self.add_edge(None);
                self.join(
                    HalfedgeId::from_index(h),
                    crate::topology::Outside { edge: e, twin: self.twin(HalfedgeId::from_index(h)) },
                );
            }
        }
    }

    /// Anchors every vertex at its first corner and checks that its faces form a single fan.
    fn set_anchors(&mut self) -> Result<(), BuildError> {
        let mut corners = vec![0_usize; self.anchor.len()];
        for (h, &v) in (0..).zip(&self.corner) {
            let v = v as usize;
            corners[v] += 1;
            if self.anchor[v] == NONE {
                self.anchor[v] = h;
            }
        }
        for v in (0..self.anchor.len()).map(VertexId::from_index) {
            match corners[v.index()] {
                0 => return Err(BuildError::IsolatedVertex(v)),
                n if n != self.wedges(v).count() => return Err(BuildError::PinchedVertex(v)),
                _ => {}
            }
        }
        Ok(())
    }
}

fn check_corners(vertex_count: usize, triangles: &[[u32; 3]]) -> Result<(), BuildError> {
    for (face, &[a, b, c]) in triangles.iter().enumerate() {
        let face = FaceId::from_index(face);
        if let Some(index) = [a, b, c].into_iter().find(|&v| v as usize >= vertex_count) {
            return Err(BuildError::IndexOutOfRange { face, index, count: vertex_count });
        }
        if a == b || a == c {
            return Err(BuildError::RepeatedVertex { face, vertex: VertexId(a) });
        }
        if b == c {
            return Err(BuildError::RepeatedVertex { face, vertex: VertexId(b) });
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn v(i: u32) -> VertexId {
        VertexId(i)
    }

    #[test]
    fn every_refusal_names_the_offender() {
        let refusal = |n, triangles: &[[u32; 3]]| Mesh::from_triangles(n, triangles).unwrap_err();
        assert_eq!(
            refusal(3, &[[0, 1, 2], [0, 1, 7]]),
            BuildError::IndexOutOfRange { face: FaceId(1), index: 7, count: 3 }
        );
        assert_eq!(refusal(3, &[[0, 2, 2]]), BuildError::RepeatedVertex { face: FaceId(0), vertex: v(2) });
        assert_eq!(refusal(3, &[[0, 1, 2], [2, 1, 0]]), BuildError::DuplicateFace(FaceId(0), FaceId(1)));
        assert_eq!(
            refusal(5, &[[0, 1, 2], [1, 0, 3], [4, 0, 1]]),
            BuildError::CrowdedEdge(v(0), v(1), FaceId(2))
        );
        assert_eq!(refusal(5, &[[0, 1, 2], [0, 3, 4]]), BuildError::PinchedVertex(v(0)));
        assert_eq!(refusal(4, &[[0, 1, 2]]), BuildError::IsolatedVertex(v(3)));
    }

    #[test]
    fn two_closed_fans_at_a_vertex_are_refused() {
        let tetrahedron = |a: u32, b, c, d| [[a, b, c], [a, c, d], [a, d, b], [b, d, c]];
        let both = [tetrahedron(0, 1, 2, 3), tetrahedron(0, 4, 5, 6)].concat();
        assert_eq!(Mesh::from_triangles(7, &both).unwrap_err(), BuildError::PinchedVertex(v(0)));
    }

    #[test]
    fn triangles_come_back_as_given() {
        let given = [[0, 1, 2], [3, 1, 2], [0, 3, 2]];
        let mesh = Mesh::from_triangles(4, &given).unwrap();
        assert_eq!(mesh.to_triangles(), given);
        assert_eq!(mesh.edge_count(), 6);
        assert!(Mesh::from_triangles(0, &[]).unwrap().to_triangles().is_empty());
    }

    #[test]
    fn compacting_renames_and_keeps_sources() {
        let mut mesh = Mesh::from_triangles(4, &[[0, 1, 2], [1, 3, 2]]).unwrap();
        let centre = mesh.split_face(FaceId(1));
        mesh.collapse(v(0), v(1)); // snips a corner off the boundary
        let e = mesh.edge_between(v(1), v(2)).unwrap();
        mesh.set_edge_source(e, Some(crate::SourceTag(9)));
        mesh.set_vertex_source(v(2), Some(crate::SourceTag(3)));
        let (small, name) = mesh.compacted();
        assert_eq!(name[0], None);
        assert_eq!((small.vertex_count(), small.vertex_slots()), (4, 4));
        let [b, c] = [name[1].unwrap(), name[2].unwrap()];
        assert_eq!(small.vertex_source(c), Some(crate::SourceTag(3)));
        assert_eq!(small.edge_source(small.edge_between(b, c).unwrap()), Some(crate::SourceTag(9)));
        assert!(small.are_neighbours(name[centre.index()].unwrap(), b));
    }
}
