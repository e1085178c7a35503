//! Deletion of nodes as Welch 1995, §4.2.3 has it, case by case: inner nodes, those of the boundary, those of source curves.

use crate::family::{nature, tag_boundary};
use crate::measure::euler_characteristic;
use crate::{Blocked, Mesh, SourceTag, VertexId, boundary_loops, primitive, validate, validate_curves};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn v(i: usize) -> VertexId {
    VertexId::from_index(i)
}

/// Five by five vertices: `5 i + j` lies in column `i` and row `j`.
fn square() -> Mesh {
    primitive::plane(4, 4, 1.0).0
}

fn draw(mesh: &mut Mesh, vertices: &[usize], tag: u32) {
    for pair in vertices.windows(2) {
        let e = mesh.edge_between(v(pair[0]), v(pair[1])).unwrap();
        mesh.set_edge_source(e, Some(SourceTag(tag)));
    }
}

#[test]
fn an_inner_node_goes_with_two_faces_and_three_edges() {
    let mut mesh = square();
    let (faces, edges, was) = (mesh.face_count(), mesh.edge_count(), nature(&mesh));
    let mut ring = Vec::new();
    mesh.ring(v(12), &mut ring);
    mesh.delete_vertex(v(12));
    assert_eq!((validate(&mesh), nature(&mesh)), (Ok(()), was));
    assert_eq!((mesh.face_count(), mesh.edge_count()), (faces - 2, edges - 3));
    assert!(!mesh.has_vertex(v(12)) && ring.iter().all(|&w| mesh.has_vertex(w)));
}

#[test]
fn a_boundary_node_goes_with_one_face_and_two_edges_and_the_boundary_closes_over_it() {
    let mut mesh = square();
    let (faces, edges, was) = (mesh.face_count(), mesh.edge_count(), nature(&mesh));
    mesh.delete_vertex(v(2));
    assert_eq!((validate(&mesh), nature(&mesh)), (Ok(()), was));
    assert_eq!((mesh.face_count(), mesh.edge_count()), (faces - 1, edges - 2));
    let e = mesh.edge_between(v(1), v(3)).unwrap();
    assert!(mesh.is_boundary_edge(e));
    assert_eq!(boundary_loops(&mesh)[0].len(), 15);
}

#[test]
fn a_node_of_a_source_curve_goes_and_its_neighbours_on_the_curve_are_joined() {
    // Through the inside, across the flow of the diagonals, and along the boundary.
    for (curve, gone) in [([10, 11, 12, 13, 14], 12), ([2, 7, 12, 17, 22], 7), ([0, 1, 2, 3, 4], 2)] {
        let mut mesh = square();
        draw(&mut mesh, &curve, 6);
        mesh.set_vertex_source(v(curve[0]), Some(SourceTag(0)));
        mesh.set_vertex_source(v(curve[4]), Some(SourceTag(1)));
        let (was, euler) = (nature(&mesh), euler_characteristic(&mesh));
        mesh.delete_vertex(v(gone));
        assert_eq!((validate_curves(&mesh), nature(&mesh)), (Ok(()), was));
        assert_eq!(euler_characteristic(&mesh), euler);
        let place = curve.iter().position(|&w| w == gone).unwrap();
        let e = mesh.edge_between(v(curve[place - 1]), v(curve[place + 1])).unwrap();
        assert_eq!(mesh.edge_source(e), Some(SourceTag(6)));
    }
}

#[test]
fn a_curve_of_three_nodes_cannot_lose_one() {
    let (mut mesh, _) = primitive::octahedron();
    let face = mesh.face_vertices(mesh.faces().next().unwrap()).map(VertexId::index);
    draw(&mut mesh, &[face[0], face[1], face[2], face[0]], 4);
    for node in face {
        let old = mesh.to_triangles();
        assert_eq!(mesh.can_delete(v(node)), Err(Blocked::SmallestLoop(v(node))));
        assert_eq!(mesh.delete_vertex_by(v(node), |_| 0.0), Err(Blocked::SmallestLoop(v(node))));
        assert_eq!(mesh.to_triangles(), old);
    }
    // With a fourth node it can lose any one of them, and then no more.
    let e = mesh.edge_between(v(face[0]), v(face[1])).unwrap();
    let fourth = mesh.split_edge(e);
    assert_eq!(mesh.can_delete(v(face[2])), Ok(()));
    mesh.delete_vertex(fourth);
    assert_eq!(validate_curves(&mesh), Ok(()));
    assert!(face.iter().all(|&node| mesh.can_delete(v(node)) == Err(Blocked::SmallestLoop(v(node)))));
}

#[test]
fn a_boundary_of_three_nodes_cannot_lose_one_tagged_or_not() {
    for is_tagged in [false, true] {
        let (mut mesh, _) = primitive::icosphere(1);
        let rim = mesh.face_vertices(mesh.faces().next().unwrap());
        let face = mesh.faces().next().unwrap();
        mesh.remove_faces(|f| f == face);
        if is_tagged {
            tag_boundary(&mut mesh);
        }
        assert!(rim.iter().all(|&w| mesh.can_delete(w) == Err(Blocked::SmallestLoop(w))));
    }
}
