//! Measuring: what kind of surface it is (here), how large and how well shaped (in `shape`).
//!
//! The kind of a connected surface is settled by three facts: its Euler characteristic χ, its number of
//! boundary loops b, and whether it is orientable. With g handles or crosscaps,
//! χ = 2 − 2g − b (orientable) or χ = 2 − g − b (not).

mod shape;

pub(crate) use shape::angle_between;
pub use shape::{
    Quality, bounding_box, corner_angle, edge_length, face_area, face_normal, mean_edge_length, quality,
    total_area,
};

use crate::{EdgeId, HalfedgeId, Mesh, VertexId, components, is_orientable};

/// The facts about a mesh that no surgery may change, with the counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Summary {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of edges.
    pub edges: usize,
    /// Number of faces.
    pub faces: usize,
    /// Vertices less edges plus faces.
    pub euler: i64,
    /// Number of boundary loops.
    pub boundaries: usize,
    /// Number of connected pieces.
    pub components: usize,
    /// Whether every piece has two sides.
    pub is_orientable: bool,
    /// Handles of an orientable surface, crosscaps of another, over all pieces. Where both kinds of piece
    /// occur, a handle counts as two crosscaps.
    pub genus: i64,
}

impl Summary {
    /// The part that tells one topological type from another: everything but the counts.
    #[must_use]
    pub const fn kind(&self) -> (i64, usize, usize, bool) {
        (self.euler, self.boundaries, self.components, self.is_orientable)
    }
}

/// Counts and kind of a mesh.
///
/// ```
/// use ductile_mesh::{primitive, summary};
/// let torus = summary(&primitive::torus(8, 6, 2.0, 1.0).0);
/// assert_eq!((torus.euler, torus.boundaries, torus.genus, torus.is_orientable), (0, 0, 1, true));
/// let strip = summary(&primitive::moebius(8, 2, 2.0, 1.0).0);
/// assert_eq!((strip.euler, strip.boundaries, strip.genus, strip.is_orientable), (0, 1, 1, false));
/// ```
#[must_use]
pub fn summary(mesh: &Mesh) -> Summary {
    let boundaries = boundary_loops(mesh).len();
    let components = components(mesh).count();
    let is_orientable = is_orientable(mesh);
    let euler = euler_characteristic(mesh);
    let missing = 2 * signed(components) - signed(boundaries) - euler;
    Summary {
        vertices: mesh.vertex_count(),
        edges: mesh.edge_count(),
        faces: mesh.face_count(),
        euler,
        boundaries,
        components,
        is_orientable,
        genus: if is_orientable { missing / 2 } else { missing },
    }
}

/// Vertices less edges plus faces: 2 for a sphere, 1 for a disc, 0 for a torus, a Klein bottle, a cylinder
/// and a Möbius strip.
#[must_use]
pub fn euler_characteristic(mesh: &Mesh) -> i64 {
    signed(mesh.vertex_count()) - signed(mesh.edge_count()) + signed(mesh.face_count())
}

fn signed(n: usize) -> i64 {
    i64::try_from(n).unwrap_or(i64::MAX)
}

/// The closed loops of boundary vertices, each starting at its lowest edge, in order of that edge.
///
/// Where the windings agree a loop runs along its faces' winding, the surface lying to its left.
#[must_use]
pub fn boundary_loops(mesh: &Mesh) -> Vec<Vec<VertexId>> {
    boundary_walks(mesh).into_iter().map(|walk| walk.into_iter().map(|(v, _)| v).collect()).collect()
}

/// As [`boundary_loops`], giving the edges: edge `k` joins vertices `k` and `k + 1` of the loop.
#[must_use]
pub fn boundary_edge_loops(mesh: &Mesh) -> Vec<Vec<EdgeId>> {
    boundary_walks(mesh)
        .into_iter()
        .map(|walk| walk.into_iter().map(|(_, h)| mesh.edge_of(h)).collect())
        .collect()
}

/// Each loop as vertices with the side that leads on from there.
fn boundary_walks(mesh: &Mesh) -> Vec<Vec<(VertexId, HalfedgeId)>> {
    let mut seen = vec![false; mesh.edge_slots()];
    let mut walks = Vec::new();
    for e in mesh.edges() {
        if seen[e.index()] || !mesh.is_boundary_edge(e) {
            continue;
        }
        let mut walk = Vec::new();
        let mut h = mesh.halfedge_of(e);
        let mut v = mesh.origin(h);
        while !seen[mesh.edge_of(h).index()] {
            seen[mesh.edge_of(h).index()] = true;
            walk.push((v, h));
            v = mesh.other_end(mesh.edge_of(h), v);
            // At `v` the ring leaves the surface by `h`; go back through it to where it comes in.
            let mut wedge = mesh.wedge_left_by(v, h);
            while let Some(before) = mesh.wedge_before(v, wedge) {
                wedge = before;
            }
            h = wedge.entry();
        }
        walks.push(walk);
    }
    walks
}

#[cfg(test)]
mod tests;
