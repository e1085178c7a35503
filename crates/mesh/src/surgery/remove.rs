//! Removing faces: a part of the surface is burnt out and leaves its border as boundary.
//!
//! Source: Welch 1995, §7.3.2 (burning out regions). Where what is left would hang together in a single vertex, that vertex
//! falls into as many copies as there are fans, as in a cut, so that the rest is a surface whatever is taken.

use crate::{FaceId, HalfedgeId, Mesh, VertexId};

/// What became of the vertices around removed faces.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Removed {
    /// How many faces went.
    pub faces: usize,
    /// Vertices that were left without a face and went too, with their tags.
    pub gone: Vec<VertexId>,
    /// Vertices in which the rest would have hung together, and their copies, with the same tag. One that fell into more
    /// than two parts occurs more than once.
    pub split: Vec<(VertexId, VertexId)>,
}

impl Mesh {
    /// Takes away the doomed faces, with the edges and vertices that belong to no other. Always possible; what is left
    /// keeps its names, and tags stay where they are. A curve that ran through what is gone ends at its border: the
    /// model must say what becomes of it.
    ///
    /// ```
    /// use ductile_mesh::{primitive, summary, validate};
    /// let (mut mesh, positions) = primitive::icosphere(2);
    /// let low = |f| mesh.face_vertices(f).iter().all(|v| positions[v.index()].z < -0.5);
    /// let doomed: Vec<_> = mesh.faces().map(|f| (f, low(f))).collect();
    /// let removed = mesh.remove_faces(|f| doomed[f.index()].1);
    /// assert!(removed.faces > 0 && removed.split.is_empty());
    /// assert_eq!((validate(&mesh), summary(&mesh).boundaries), (Ok(()), 1));
    /// ```
    pub fn remove_faces(&mut self, is_doomed: impl Fn(FaceId) -> bool) -> Removed {
        let mut doom = vec![false; self.face_slots()];
        let doomed: Vec<FaceId> = self.faces().filter(|&f| is_doomed(f)).collect();
        doomed.iter().for_each(|f| doom[f.index()] = true);
        let mut touched: Vec<VertexId> = doomed.iter().flat_map(|&f| self.face_vertices(f)).collect();
        touched.sort_unstable();
        touched.dedup();
        let fans: Vec<_> = touched.into_iter().map(|v| (v, self.fans_left(v, &doom))).collect();
        for &f in &doomed {
            for h in f.halfedges() {
                let outside = self.outside(h);
                // A neighbour that is doomed too has either taken its twin away already, or frees the edge later.
                self.bare(outside);
                self.twin[h.index()] = crate::topology::NONE;
                if outside.twin.is_none() {
                    self.free_edge(outside.edge);
                }
            }
            self.free_face(f);
        }
        let mut removed = Removed { faces: doomed.len(), ..Removed::default() };
        for (v, fans) in fans {
            if fans.is_empty() {
                self.free_vertex(v);
                removed.gone.push(v);
            }
            for (index, fan) in fans.into_iter().enumerate() {
                let vertex = if index == 0 { v } else { self.add_vertex() };
                if vertex != v {
                    self.vertex_source[vertex.index()] = self.vertex_source[v.index()];
                    removed.split.push((v, vertex));
                }
                for corner in fan {
                    self.corner[corner.index()] = vertex.0;
                    self.anchor[vertex.index()] = corner.0;
                }
            }
        }
        removed
    }

    /// The fans of faces around a vertex that are not doomed, by their corners at it; that of the lowest face first.
    fn fans_left(&self, v: VertexId, doom: &[bool]) -> Vec<Vec<HalfedgeId>> {
        let mut corners: Vec<HalfedgeId> = self.wedges(v).map(|wedge| wedge.corner).collect();
        let is_doomed = |corner: &HalfedgeId| doom[corner.face().index()];
        if !self.is_boundary_vertex(v) {
            // Begin behind a gap, so that no fan is torn.
            let gap = corners.iter().position(is_doomed).unwrap_or(0);
            corners.rotate_left(gap);
        }
        let mut fans: Vec<Vec<HalfedgeId>> =
            corners.split(is_doomed).filter(|fan| !fan.is_empty()).map(<[_]>::to_vec).collect();
        fans.sort_by_key(|fan| fan.iter().map(|corner| corner.face()).min());
        fans
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::family::family;
    use crate::property_test::cases;
    use crate::{SourceTag, primitive, summary, validate};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    proptest! {
        #![proptest_config(cases(192, 48))]

        #[test]
        fn whatever_is_removed_the_rest_is_a_surface(seed in any::<u64>(), share in 0.0..1.0) {
            for (name, mut mesh) in family() {
                for e in mesh.edges().collect::<Vec<_>>() {
                    mesh.split_edge(e);
                }
                let is_doomed = |f: FaceId| {
                    let x = libm::sin(12.9898 * (seed % 1000) as f64 + 78.233 * f.index() as f64) * 43758.5453;
                    x - libm::floor(x) < share
                };
                let left: Vec<_> = mesh.faces().filter(|&f| !is_doomed(f)).collect();
                let before: Vec<_> = left.iter().map(|&f| mesh.face_vertices(f)).collect();
                let count = mesh.vertex_count();
                let removed = mesh.remove_faces(is_doomed);
                prop_assert_eq!(validate(&mesh), Ok(()), "{}", name);
                prop_assert_eq!(mesh.faces().collect::<Vec<_>>(), left.clone());
                prop_assert_eq!(mesh.vertex_count() + removed.gone.len(), count + removed.split.len());
                // Corners keep their vertices, but for copies.
                for (f, old) in left.into_iter().zip(before) {
                    for (now, old) in mesh.face_vertices(f).into_iter().zip(old) {
                        prop_assert!(now == old || removed.split.contains(&(old, now)));
                    }
                }
            }
        }
    }

    #[test]
    fn a_vertex_between_two_fans_is_split_and_bears_its_tag_twice() {
        let (mut mesh, _) = primitive::plane(2, 2, 1.0);
        let middle = mesh.vertices().find(|v| !mesh.is_boundary_vertex(*v)).unwrap();
        mesh.set_vertex_source(middle, Some(SourceTag(4)));
        let mut ring = Vec::new();
        mesh.ring_faces(middle, &mut ring);
        let doomed = [ring[0], ring[3]];
        let removed = mesh.remove_faces(|f| doomed.contains(&f));
        assert_eq!(validate(&mesh), Ok(()));
        let [(old, copy)] = removed.split[..] else { panic!("one copy: {removed:?}") };
        assert_eq!((old, mesh.vertex_source(copy)), (middle, Some(SourceTag(4))));
        assert_eq!(mesh.valence(old) + mesh.valence(copy), 6);
    }

    #[test]
    fn removing_everything_leaves_nothing_and_nothing_everything() {
        let (mut mesh, _) = primitive::moebius(6, 2, 2.0, 1.0);
        let was = summary(&mesh);
        assert_eq!(mesh.remove_faces(|_| false), Removed::default());
        assert_eq!(summary(&mesh), was);
        let removed = mesh.remove_faces(|_| true);
        assert_eq!((removed.gone.len(), removed.faces), (was.vertices, was.faces));
        assert_eq!((validate(&mesh), mesh.vertex_count(), mesh.edge_count()), (Ok(()), 0, 0));
    }
}
