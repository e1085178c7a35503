use super::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn v(i: usize) -> VertexId {
    VertexId::from_index(i)
}

/// A closed fan of `n` triangles around vertex 0; those in `turned` are wound the other way.
fn fan(n: u32, closed: bool, turned: &[u32]) -> Mesh {
    let last = if closed { n } else { n - 1 };
    let triangles: Vec<_> = (0..last)
        .map(|i| {
            let (a, b) = (1 + i, 1 + (i + 1) % n);
            if turned.contains(&i) { [a, 0, b] } else { [a, b, 0] }
        })
        .collect();
    Mesh::from_triangles(n as usize + 1, &triangles).unwrap()
}

#[test]
fn ring_follows_the_winding() {
    let mut ring = Vec::new();
    assert!(fan(5, true, &[]).ring(v(0), &mut ring));
    assert_eq!(ring, [1, 2, 3, 4, 5].map(v));
    assert!(!fan(5, false, &[]).ring(v(0), &mut ring));
    assert_eq!(ring, [1, 2, 3, 4, 5].map(v));
}

#[test]
fn ring_carries_its_sense_over_turned_faces() {
    let mut ring = Vec::new();
    let mut faces = Vec::new();
    for closed in [true, false] {
        let mesh = fan(6, closed, &[1, 2, 4]);
        assert_eq!(mesh.ring(v(0), &mut ring), closed);
        assert_eq!(ring, [1, 2, 3, 4, 5, 6].map(v));
        assert_eq!(mesh.ring_faces(v(0), &mut faces), closed);
        let agrees: Vec<_> = mesh.wedges(v(0)).map(|w| w.agrees).take(5).collect();
        assert_eq!(agrees, [true, false, false, true, false]);
        assert_eq!(faces.len(), if closed { 6 } else { 5 });
        for (k, &f) in faces.iter().enumerate() {
            let corners = mesh.face_vertices(f);
            assert!(corners.contains(&ring[k]) && corners.contains(&ring[(k + 1) % 6]));
        }
    }
}

#[test]
fn a_boundary_ring_starts_at_the_boundary_wherever_the_anchor_is() {
    let mut mesh = fan(6, false, &[]);
    let mut ring = Vec::new();
    let wedges: Vec<_> = mesh.wedges(v(0)).collect();
    for w in wedges {
        mesh.anchor[0] = w.corner.0;
        mesh.ring(v(0), &mut ring);
        assert_eq!(ring, [1, 2, 3, 4, 5, 6].map(v));
        assert_eq!(mesh.neighbours(v(0)).collect::<Vec<_>>(), ring);
    }
}

#[test]
fn the_anchor_decides_the_sense() {
    let mut mesh = fan(6, true, &[2]);
    let turned = mesh.wedges(v(0)).find(|w| !w.agrees).unwrap();
    mesh.anchor[0] = turned.corner.0;
    let mut ring = Vec::new();
    assert!(mesh.ring(v(0), &mut ring));
    assert_eq!(ring, [4, 3, 2, 1, 6, 5].map(v));
}

#[test]
fn edges_know_their_ends_sides_and_opposites() {
    let mesh = fan(5, true, &[3]);
    let e = mesh.edge_between(v(0), v(2)).unwrap();
    let (o, p) = mesh.edge_opposites(e);
    assert_eq!([o, p.unwrap()].map(VertexId::index).iter().sum::<usize>(), 4);
    assert_eq!(mesh.other_end(e, v(0)), v(2));
    assert!(!mesh.is_boundary_edge(e) && mesh.is_wound_alike(e));
    let rim = mesh.edge_between(v(1), v(2)).unwrap();
    assert!(mesh.is_boundary_edge(rim) && mesh.edge_opposites(rim).1.is_none());
    assert!(!mesh.is_wound_alike(mesh.edge_between(v(0), v(4)).unwrap()));
    assert_eq!(mesh.edge_between(v(1), v(3)), None);
    assert!(mesh.face_between(v(0), v(4), v(5)).is_some());
    assert!(mesh.face_between(v(0), v(3), v(5)).is_none());
}

#[test]
fn valence_and_boundary() {
    let mesh = fan(5, true, &[]);
    assert_eq!((mesh.valence(v(0)), mesh.is_boundary_vertex(v(0))), (5, false));
    assert_eq!((mesh.valence(v(1)), mesh.is_boundary_vertex(v(1))), (3, true));
    assert!(mesh.are_neighbours(v(1), v(5)) && !mesh.are_neighbours(v(1), v(4)));
}

#[test]
fn rings_agree_where_the_windings_do() {
    let alike = fan(5, true, &[]);
    assert!(alike.edges().all(|e| alike.do_rings_agree(e)));
    let turned = fan(5, true, &[1]);
    let e = turned.edge_between(v(2), v(3)).unwrap();
    let f = turned.edge_faces(e).0;
    let sense = |x: usize| turned.wedges(v(x)).find(|w| w.face() == f).unwrap().agrees;
    assert_eq!(turned.do_rings_agree(e), sense(2) == sense(3));
}

#[test]
fn rings_run_counter_clockwise_seen_from_the_side_the_faces_face() {
    use crate::{measure, primitive};
    for (mesh, positions) in [
        primitive::icosphere(2),
        primitive::torus(9, 7, 2.0, 0.8),
        primitive::plane(4, 3, 1.0),
        primitive::octahedron(),
    ] {
        let mut ring = Vec::new();
        for v in mesh.vertices() {
            let closed = mesh.ring(v, &mut ring);
            assert_eq!(closed, !mesh.is_boundary_vertex(v));
            assert_eq!(ring.len(), mesh.valence(v));
            let here = positions[v.index()];
            let pairs = ring.len() - usize::from(!closed);
            let fitted: glam::DVec3 = (0..pairs)
                .map(|k| {
                    let [p, q] = [ring[k], ring[(k + 1) % ring.len()]].map(|w| positions[w.index()] - here);
                    p.cross(q)
                })
                .sum();
            let faces: glam::DVec3 =
                mesh.wedges(v).map(|w| measure::face_normal(&mesh, &positions, w.face())).sum();
            assert!(fitted.dot(faces) > 0.0 && fitted.distance(faces) < 1e-12 * faces.length());
            for w in mesh.wedges(v) {
                assert!(measure::face_normal(&mesh, &positions, w.face()).dot(fitted) > 0.0);
            }
        }
    }
}
