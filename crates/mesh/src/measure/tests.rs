use core::f64::consts::PI;

use glam::DVec3;

use super::*;
use crate::primitive::{self, klein_bottle, moebius, plane, torus};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn the_family_has_the_kinds_of_the_textbook() {
    let kind = |mesh: &Mesh| {
        let s = summary(mesh);
        (s.euler, s.boundaries, s.is_orientable, s.genus)
    };
    assert_eq!(kind(&primitive::octahedron().0), (2, 0, true, 0));
    assert_eq!(kind(&plane(3, 2, 1.0).0), (1, 1, true, 0));
    assert_eq!(kind(&torus(5, 4, 2.0, 1.0).0), (0, 0, true, 1));
    assert_eq!(kind(&moebius(6, 2, 2.0, 1.0).0), (0, 1, false, 1));
    assert_eq!(kind(&klein_bottle(6, 6, 2.0, 1.0).0), (0, 0, false, 2));
    let empty = summary(&Mesh::default());
    assert_eq!((empty.euler, empty.components, empty.genus), (0, 0, 0));
}

#[test]
fn boundary_loops_keep_the_surface_on_their_left() {
    let (mesh, positions) = plane(3, 2, 1.0);
    let loops = boundary_loops(&mesh);
    assert_eq!(loops.len(), 1);
    let p: Vec<_> = loops[0].iter().map(|v| positions[v.index()]).collect();
    let area: f64 = (0..p.len()).map(|i| 0.5 * p[i].cross(p[(i + 1) % p.len()]).z).sum();
    assert!((area - 6.0).abs() < 1e-12, "counter-clockwise around the rectangle");
}

#[test]
fn the_boundary_of_a_moebius_strip_goes_round_twice() {
    let (mesh, _) = moebius(6, 2, 2.0, 1.0);
    let (loops, edges) = (boundary_loops(&mesh), boundary_edge_loops(&mesh));
    assert_eq!((loops.len(), loops[0].len()), (1, 12));
    for (k, &e) in edges[0].iter().enumerate() {
        assert_eq!(mesh.edge_between(loops[0][k], loops[0][(k + 1) % 12]), Some(e));
    }
}

#[test]
fn sizes_of_a_unit_octahedron() {
    let (mesh, positions) = primitive::octahedron();
    assert!((total_area(&mesh, &positions) - 4.0 * libm::sqrt(3.0)).abs() < 1e-12);
    assert!((mean_edge_length(&mesh, &positions) - libm::sqrt(2.0)).abs() < 1e-12);
    assert_eq!(bounding_box(&mesh, &positions), Some((-DVec3::ONE, DVec3::ONE)));
    let q = quality(&mesh, &positions);
    assert!((q.least_angle - PI / 3.0).abs() < 1e-12 && (q.mean_least_angle - PI / 3.0).abs() < 1e-12);
    assert_eq!((q.inner_valences[4], q.boundary_valences.len()), (6, 0));
    for f in mesh.faces() {
        let centre: DVec3 = mesh.face_vertices(f).map(|v| positions[v.index()]).into_iter().sum();
        assert!(face_normal(&mesh, &positions, f).dot(centre) > 0.0);
    }
}

#[test]
fn the_area_of_a_fine_sphere_is_four_pi() {
    let (mesh, positions) = primitive::icosphere(4);
    assert!((total_area(&mesh, &positions) - 4.0 * PI).abs() < 0.02);
}
