//! Closed surfaces without holes: the regular solids with triangular faces, and finer balls from them.

use glam::DVec3;

use super::{built, number};
use crate::Mesh;

/// A regular tetrahedron with its corners on the unit sphere: the smallest closed surface.
#[must_use]
pub fn tetrahedron() -> (Mesh, Vec<DVec3>) {
    let r = 1.0 / libm::sqrt(3.0);
    let positions = [[r, r, r], [r, -r, -r], [-r, r, -r], [-r, -r, r]].map(DVec3::from_array).to_vec();
    built(&[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]], positions)
}

/// A regular octahedron with its corners on the unit sphere: every valence is four.
#[must_use]
pub fn octahedron() -> (Mesh, Vec<DVec3>) {
    let positions = vec![DVec3::X, DVec3::Y, DVec3::Z, -DVec3::X, -DVec3::Y, -DVec3::Z];
    let triangles = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    built(&triangles, positions)
}

/// A unit sphere from an icosahedron, each triangle quartered `rounds` times: 10·4ʳ + 2 vertices.
#[must_use]
pub fn icosphere(rounds: usize) -> (Mesh, Vec<DVec3>) {
    let golden = 0.5 * (1.0 + libm::sqrt(5.0));
    let s = 1.0 / libm::sqrt(1.0 + golden * golden);
    let l = golden * s;
    let rectangle = |f: fn(f64, f64) -> DVec3| [f(s, l), f(s, -l), f(-s, l), f(-s, -l)];
    let positions = [
        rectangle(|a, b| DVec3::new(0.0, a, b)),
        rectangle(|a, b| DVec3::new(a, b, 0.0)),
        rectangle(|a, b| DVec3::new(b, 0.0, a)),
    ]
    .concat();
    // Faces: the triples of mutual neighbours, at the distance of one edge, wound outwards.
    let edge = 2.0 * s * 1.001;
    let near = |i: usize, j: usize| positions[i].distance(positions[j]) < edge;
    let mut triangles = Vec::with_capacity(20);
    for i in 0..12 {
        for j in i + 1..12 {
            for k in j + 1..12 {
                if near(i, j) && near(j, k) && near(i, k) {
                    let (a, b, c) = (positions[i], positions[j], positions[k]);
                    let outwards = (b - a).cross(c - a).dot(a) > 0.0;
                    let [i, j, k] = [i, j, k].map(number);
                    triangles.push(if outwards { [i, j, k] } else { [i, k, j] });
                }
            }
        }
    }
    let (mut mesh, mut positions) = built(&triangles, positions);
    for _ in 0..rounds {
        (mesh, positions) = subdivided(&mesh, &positions);
        for p in &mut positions {
            *p = p.normalize_or_zero();
        }
    }
    (mesh, positions)
}

/// The mesh with every triangle cut into four at the midpoints of its edges. Sources and windings are
/// kept, dead slots are dropped; the old vertices come first, in order.
#[must_use]
pub fn subdivided(mesh: &Mesh, positions: &[DVec3]) -> (Mesh, Vec<DVec3>) {
    let (mesh, name) = mesh.compacted();
    let mut points = vec![DVec3::ZERO; mesh.vertex_count()];
    for (old, new) in name.iter().enumerate().filter_map(|(i, v)| v.map(|v| (i, v))) {
        points[new.index()] = positions[old];
    }
    let middle = |e: crate::EdgeId| number(mesh.vertex_count() + e.index());
    for e in mesh.edges() {
        let [a, b] = mesh.edge_vertices(e);
        points.push(0.5 * (points[a.index()] + points[b.index()]));
    }
    let mut triangles = Vec::with_capacity(4 * mesh.face_count());
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| v.0);
        let [ab, bc, ca] = mesh.face_edges(f).map(middle);
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    let (mut fine, points) = built(&triangles, points);
    for v in mesh.vertices() {
        fine.set_vertex_source(v, mesh.vertex_source(v));
    }
    for e in mesh.edges().filter(|&e| mesh.is_source_edge(e)) {
        for end in mesh.edge_vertices(e) {
            if let Some(half) = fine.edge_between(end, crate::VertexId(middle(e))) {
                fine.set_edge_source(half, mesh.edge_source(e));
            }
        }
    }
    (fine, points)
}
