use glam::DVec3;

use super::*;
use crate::{SourceTag, measure, quality, summary, validate};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn circle(n: usize, radius: f64, z: f64) -> Vec<DVec3> {
    (0..n)
        .map(|i| {
            let t = core::f64::consts::TAU * f64::from(number(i)) / f64::from(number(n));
            DVec3::new(radius * libm::cos(t), radius * libm::sin(t), z)
        })
        .collect()
}

#[test]
fn every_primitive_is_sound() {
    let loops = (circle(5, 1.0, 0.0), circle(9, 1.0, 1.0));
    for (mesh, positions) in [
        tetrahedron(),
        octahedron(),
        icosphere(2),
        plane(1, 1, 1.0),
        torus(0, 0, 2.0, 1.0),
        moebius(0, 0, 2.0, 1.0),
        klein_bottle(0, 0, 2.0, 1.0),
        sheet(&loops.0, 0).unwrap(),
        cylinder(&loops.0, &loops.1, 2).unwrap(),
    ] {
        assert_eq!(validate(&mesh), Ok(()));
        assert_eq!(positions.len(), mesh.vertex_count());
        assert!(positions.iter().all(|p| p.is_finite()));
    }
}

#[test]
fn closed_primitives_face_outwards() {
    for (mesh, positions) in [tetrahedron(), octahedron(), icosphere(2)] {
        for f in mesh.faces() {
            let p = positions[mesh.face_vertices(f)[0].index()];
            assert!(measure::face_normal(&mesh, &positions, f).dot(p) > 0.0);
        }
    }
    let (mesh, positions) = torus(12, 8, 2.0, 1.0);
    let volume: f64 = mesh
        .faces()
        .map(|f| {
            let p = positions[mesh.face_vertices(f)[0].index()];
            measure::face_normal(&mesh, &positions, f).dot(p) / 6.0
        })
        .sum();
    assert!(volume > 0.0);
}

#[test]
fn icospheres_have_the_textbook_counts() {
    for rounds in 0..4 {
        let (mesh, positions) = icosphere(rounds);
        assert_eq!(mesh.vertex_count(), 10 * (1 << (2 * rounds)) + 2);
        assert!(positions.iter().all(|p| (p.length() - 1.0).abs() < 1e-12));
        assert_eq!(quality(&mesh, &positions).inner_valences[5], 12);
    }
}

#[test]
fn sheets_are_discs_with_their_boundary_first() {
    for n in [3, 4, 5, 12, 31, 60] {
        for rings in [0, 1, natural_rings(n), 2 * natural_rings(n)] {
            let boundary = circle(n, 1.0, 0.0);
            let (mesh, positions) = sheet(&boundary, rings).unwrap();
            assert_eq!(validate(&mesh), Ok(()), "{n} {rings}");
            let s = summary(&mesh);
            assert_eq!((s.euler, s.boundaries, s.components), (1, 1, 1));
            assert_eq!(positions[..n], boundary);
            let rim = &measure::boundary_loops(&mesh)[0];
            assert!(rim.iter().map(|v| v.index()).eq(0..n), "counter-clockwise from vertex 0");
            assert!(mesh.edges().all(|e| mesh.is_wound_alike(e)));
        }
    }
}

#[test]
fn natural_sheets_are_well_shaped() {
    for n in [6, 12, 24, 40, 60] {
        let (mesh, positions) = sheet(&circle(n, 1.0, 0.0), natural_rings(n)).unwrap();
        let q = quality(&mesh, &positions);
        assert!(q.least_angle > 0.55, "{n}: {}", q.least_angle);
        assert!(q.longest_edge < 2.2 * q.shortest_edge, "{n}: {q:?}");
        assert!(mesh.vertices().all(|v| mesh.valence(v) <= 8));
    }
}

#[test]
fn cylinders_join_loops_of_any_count() {
    for (m, n, rows) in [(3, 3, 0), (3, 17, 0), (17, 3, 4), (12, 12, 3), (7, 9, 1)] {
        let (mesh, positions) = cylinder(&circle(m, 1.0, 0.0), &circle(n, 1.0, 1.0), rows).unwrap();
        assert_eq!(validate(&mesh), Ok(()), "{m} {n} {rows}");
        let s = summary(&mesh);
        assert_eq!((s.euler, s.boundaries, s.is_orientable), (0, 2, true));
        for f in mesh.faces() {
            let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()]);
            let out = (a + b + c).with_z(0.0);
            assert!(measure::face_normal(&mesh, &positions, f).dot(out) > 0.0);
        }
    }
}

#[test]
fn bad_loops_are_refused() {
    assert_eq!(sheet(&[DVec3::X, DVec3::Y], 1).unwrap_err(), PrimitiveError::LoopTooShort(2));
    let broken = [DVec3::X, DVec3::NAN, DVec3::Y];
    assert_eq!(sheet(&broken, 1).unwrap_err(), PrimitiveError::NotFinite(1));
    assert_eq!(cylinder(&circle(3, 1.0, 0.0), &broken, 1).unwrap_err(), PrimitiveError::NotFinite(1));
}

#[test]
fn subdividing_keeps_kind_and_sources() {
    let (mut mesh, positions) = moebius(6, 2, 2.0, 1.0);
    let e = mesh.edges().next().unwrap();
    mesh.set_edge_source(e, Some(SourceTag(4)));
    let (fine, points) = subdivided(&mesh, &positions);
    assert_eq!(validate(&fine), Ok(()));
    assert_eq!(summary(&fine).kind(), summary(&mesh).kind());
    assert_eq!(fine.face_count(), 4 * mesh.face_count());
    assert_eq!(points.len(), fine.vertex_count());
    assert_eq!(fine.edges().filter(|&e| fine.is_source_edge(e)).count(), 2);
}
