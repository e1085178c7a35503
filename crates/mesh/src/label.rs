//! Naming the pieces: connected components, and regions bounded by control curves.
//!
//! The thesis labels regions of dimension 0, 1 and 2 (Welch 1995, §4.2.1); the first two are the source
//! tags themselves, so what remains is to label faces. One union-find does both jobs: faces are joined
//! across all edges for components, across all but source edges for regions.

use crate::{EdgeId, FaceId, Mesh};

/// A number for every face, counted from 0 in order of each piece's lowest face.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Labels {
    of_face: Vec<u32>,
    count: usize,
}

impl Labels {
    /// How many pieces there are.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }

    /// The piece a living face belongs to.
    #[must_use]
    pub fn of(&self, f: FaceId) -> usize {
        self.of_face[f.index()] as usize
    }

    /// The faces of each piece, in index order.
    #[must_use]
    pub fn faces(&self, mesh: &Mesh) -> Vec<Vec<FaceId>> {
        let mut faces = vec![Vec::new(); self.count];
        mesh.faces().for_each(|f| faces[self.of(f)].push(f));
        faces
    }

    /// The edges that bound each piece: boundary edges, edges towards other pieces, and source edges
    /// even where the piece lies on both sides (a slit). Each in index order.
    #[must_use]
    pub fn bounds(&self, mesh: &Mesh) -> Vec<Vec<EdgeId>> {
        let mut bounds = vec![Vec::new(); self.count];
        for e in mesh.edges() {
            let (f, g) = mesh.edge_faces(e);
            let (here, there) = (self.of(f), g.map(|g| self.of(g)));
            if there != Some(here) || mesh.is_source_edge(e) {
                bounds[here].push(e);
                if let Some(there) = there.filter(|&there| there != here) {
                    bounds[there].push(e);
                }
            }
        }
        bounds
    }
}

/// The connected pieces of the surface.
#[must_use]
pub fn components(mesh: &Mesh) -> Labels {
    label(mesh, |_| true)
}

/// The pieces into which the source edges cut the surface.
#[must_use]
pub fn regions(mesh: &Mesh) -> Labels {
    label(mesh, |e| !mesh.is_source_edge(e))
}

fn label(mesh: &Mesh, is_open: impl Fn(EdgeId) -> bool) -> Labels {
    let mut forest = Forest::new(mesh.face_slots());
    for e in mesh.edges() {
        if let (f, Some(g)) = mesh.edge_faces(e)
            && is_open(e)
        {
            forest.join(f.0, g.0);
        }
    }
    let mut of_face = vec![u32::MAX; mesh.face_slots()];
    let mut count = 0;
    for f in mesh.faces() {
        // Roots are lowest, so a root is met before the rest of its tree.
        let root = forest.root(f.0);
        if root == f.0 {
            of_face[f.index()] = count;
            count += 1;
        } else {
            of_face[f.index()] = of_face[root as usize];
        }
    }
    Labels { of_face, count: count as usize }
}

/// Union-find over `u32`, halving paths; the lowest number of a set is its root.
struct Forest {
    parent: Vec<u32>,
}

impl Forest {
    fn new(n: usize) -> Self {
        Self { parent: (0..).take(n).collect() }
    }

    fn root(&mut self, mut i: u32) -> u32 {
        while self.parent[i as usize] != i {
            let above = self.parent[self.parent[i as usize] as usize];
            self.parent[i as usize] = above;
            i = above;
        }
        i
    }

    fn join(&mut self, i: u32, j: u32) {
        let (i, j) = (self.root(i), self.root(j));
        self.parent[i.max(j) as usize] = i.min(j);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SourceTag, VertexId, primitive};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn two_pieces_are_two_components() {
        let mesh = Mesh::from_triangles(7, &[[0, 1, 2], [3, 4, 5], [2, 1, 6]]).unwrap();
        let pieces = components(&mesh);
        assert_eq!(pieces.count(), 2);
        assert_eq!([0, 1, 2].map(|f| pieces.of(FaceId(f))), [0, 1, 0]);
        assert_eq!(pieces.faces(&mesh)[0], [FaceId(0), FaceId(2)]);
        assert_eq!(pieces.bounds(&mesh)[1].len(), 3);
    }

    #[test]
    fn the_equator_cuts_an_octahedron_in_two() {
        let (mut mesh, _) = primitive::octahedron();
        for (a, b) in [(0, 1), (1, 3), (3, 4), (4, 0)] {
            let e = mesh.edge_between(VertexId(a), VertexId(b)).unwrap();
            mesh.set_edge_source(e, Some(SourceTag(0)));
        }
        assert_eq!(components(&mesh).count(), 1);
        let halves = regions(&mesh);
        assert_eq!(halves.count(), 2);
        assert!(halves.faces(&mesh).iter().all(|faces| faces.len() == 4));
        let bounds = halves.bounds(&mesh);
        assert_eq!(bounds[0].len(), 4);
        assert_eq!(bounds[0], bounds[1]);
    }

    #[test]
    fn a_slit_bounds_the_one_region_it_lies_in() {
        let (mut mesh, _) = primitive::octahedron();
        let e = mesh.edge_between(VertexId(0), VertexId(1)).unwrap();
        mesh.set_edge_source(e, Some(SourceTag(0)));
        let one = regions(&mesh);
        assert_eq!(one.count(), 1);
        assert_eq!(one.bounds(&mesh), [vec![e]]);
    }
}
