use proptest::prelude::*;

use super::*;
use crate::family::{draw_curve, family, nature, tag_boundary};
use crate::property_test::cases;
use crate::{SourceTag, primitive, summary, validate, validate_curves};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn v(i: u32) -> VertexId {
    VertexId(i)
}

/// One random move: which kind, and which of the candidates.
fn play(mesh: &mut Mesh, kind: u8, pick: usize) -> bool {
    let edges: Vec<_> = mesh.edges().collect();
    let vertices: Vec<_> = mesh.vertices().collect();
    let faces: Vec<_> = mesh.faces().collect();
    let e = edges[pick % edges.len()];
    let v = vertices[pick % vertices.len()];
    let [a, b] = mesh.edge_vertices(e);
    match kind {
        0 => {
            mesh.split_edge(e);
            true
        }
        1 => {
            mesh.split_face(faces[pick % faces.len()]);
            true
        }
        2 | 3 => {
            let can = mesh.can_flip(e).is_ok();
            can.then(|| mesh.flip(e)).is_some()
        }
        4..=6 => {
            let can = mesh.can_collapse(a, b).is_ok();
            can.then(|| mesh.collapse(a, b)).is_some()
        }
        _ => {
            let can = mesh.can_delete(v).is_ok();
            can.then(|| mesh.delete_vertex(v)).is_some()
        }
    }
}

proptest! {
    #![proptest_config(cases(96, 32))]

    #[test]
    fn no_sequence_of_moves_changes_the_surface(
        moves in prop::collection::vec((0_u8..9, any::<u32>()), 1..60),
        curves in prop::collection::vec((any::<u32>(), prop::collection::vec(any::<u32>(), 1..5)), 0..3),
        boundary in any::<bool>(),
    ) {
        for (name, mut mesh) in family() {
            if boundary {
                tag_boundary(&mut mesh);
            }
            for (tag, (from, steps)) in (0..).zip(&curves) {
                let steps: Vec<_> = steps.iter().map(|&s| s as usize).collect();
                draw_curve(&mut mesh, *from as usize, &steps, tag);
            }
            let before = nature(&mesh);
            for &(kind, pick) in &moves {
                let text = mesh.to_triangles();
                let done = play(&mut mesh, kind, pick as usize);
                prop_assert_eq!(validate(&mesh), Ok(()), "{} {} {}", name, kind, pick);
                let after = nature(&mesh);
                prop_assert_eq!(&after, &before, "{} {} {} {:?}", name, kind, pick, text);
                prop_assert!(done || mesh.to_triangles() == text);
            }
        }
    }

    #[test]
    fn unrelated_handles_survive(moves in prop::collection::vec((0_u8..9, any::<u32>()), 1..30)) {
        let (mut mesh, _) = primitive::torus(6, 6, 2.0, 1.0);
        for (kind, pick) in moves {
            let before: Vec<_> = mesh.faces().map(|f| (f, mesh.face_vertices(f))).collect();
            let count = mesh.face_count();
            play(&mut mesh, kind, pick as usize);
            let kept = before.iter().filter(|(f, t)| mesh.has_face(*f) && mesh.face_vertices(*f) == *t).count();
            prop_assert!(kept + 24 >= count, "only the faces at the place of the move may differ");
        }
    }
}

#[test]
fn deleting_reduces_a_sphere_to_a_tetrahedron() {
    let (mut mesh, _) = primitive::icosphere(2);
    let mut left = true;
    while left {
        left = false;
        for x in mesh.vertices().collect::<Vec<_>>() {
            if mesh.can_delete(x).is_ok() {
                mesh.delete_vertex(x);
                assert_eq!(validate(&mesh), Ok(()));
                left = true;
            }
        }
    }
    assert_eq!(mesh.vertex_count(), 4);
    assert!(mesh.vertices().all(|x| mesh.can_delete(x) == Err(Blocked::SmallestPiece(x))));
    let corner = mesh.vertices().next().unwrap();
    assert_eq!(mesh.can_collapse(corner, corner), Err(Blocked::NotNeighbours(corner, corner)));
}

#[test]
fn splitting_an_edge_names_both_halves() {
    let mut mesh = Mesh::from_triangles(4, &[[0, 1, 2], [0, 1, 3]]).unwrap();
    let e = mesh.edge_between(v(0), v(1)).unwrap();
    mesh.set_edge_source(e, Some(SourceTag(1)));
    let [a, b] = mesh.edge_vertices(e);
    let m = mesh.split_edge(e);
    assert_eq!(mesh.edge_vertices(e), [a, m], "the near half keeps the name and the direction");
    let far = mesh.edge_between(m, b).unwrap();
    assert_eq!(mesh.edge_source(far), Some(SourceTag(1)));
    assert_eq!(mesh.spokes(m).filter(|&e| mesh.is_source_edge(e)).count(), 2);
    assert_eq!(mesh.valence(m), 4);
}

#[test]
fn flips_are_refused_for_cause() {
    let (mut mesh, _) = primitive::octahedron();
    let e = mesh.edge_between(v(0), v(1)).unwrap();
    mesh.set_edge_source(e, Some(SourceTag(0)));
    assert_eq!(mesh.can_flip(e), Err(Blocked::SourceEdge(e)));
    let (small, _) = primitive::tetrahedron();
    let e = small.edge_between(v(0), v(1)).unwrap();
    assert!(matches!(small.can_flip(e), Err(Blocked::SecondEdge(..))));
    let flat = Mesh::from_triangles(3, &[[0, 1, 2]]).unwrap();
    assert_eq!(flat.can_flip(EdgeId(0)), Err(Blocked::BoundaryEdge(EdgeId(0))));
}

#[test]
fn flipping_twice_comes_back() {
    for (name, mesh) in family() {
        for e in mesh.edges().filter(|&e| mesh.can_flip(e).is_ok()) {
            let mut turned = mesh.clone();
            turned.flip(e);
            assert_eq!(validate(&turned), Ok(()), "{name}");
            let ends = |m: &Mesh| {
                let [a, b] = m.edge_vertices(e);
                [a.min(b), a.max(b)]
            };
            let (c, d) = mesh.edge_opposites(e);
            let d = d.unwrap();
            assert_eq!(ends(&turned), [c.min(d), c.max(d)]);
            turned.flip(e);
            assert_eq!(ends(&turned), ends(&mesh));
        }
    }
}

/// A fan of `n` triangles around vertex 0, with a collar of squares around it.
fn collared_fan(n: u32) -> Mesh {
    let next = |i: u32| (i + 1) % n;
    let triangles: Vec<_> = (0..n)
        .flat_map(|i| {
            let (a, b, c, d) = (1 + i, 1 + next(i), 1 + n + i, 1 + n + next(i));
            [[0, a, b], [a, c, d], [a, d, b]]
        })
        .collect();
    Mesh::from_triangles(2 * n as usize + 1, &triangles).unwrap()
}

#[test]
fn a_curve_closes_over_a_deleted_vertex() {
    let mut mesh = collared_fan(6);
    for (a, b) in [(1, 0), (0, 4)] {
        let e = mesh.edge_between(v(a), v(b)).unwrap();
        mesh.set_edge_source(e, Some(SourceTag(7)));
    }
    mesh.set_vertex_source(v(1), Some(SourceTag(0)));
    mesh.set_vertex_source(v(4), Some(SourceTag(1)));
    mesh.delete_vertex(v(0));
    assert_eq!(validate_curves(&mesh), Ok(()));
    assert_eq!(mesh.edge_source(mesh.edge_between(v(1), v(4)).unwrap()), Some(SourceTag(7)));
}

#[test]
fn control_points_and_curve_ends_stay() {
    let mut mesh = collared_fan(6);
    mesh.set_vertex_source(v(0), Some(SourceTag(0)));
    assert_eq!(mesh.can_delete(v(0)), Err(Blocked::SourceVertex(v(0))));
    assert_eq!(mesh.can_collapse(v(0), v(1)), Err(Blocked::SourceVertex(v(0))));
    mesh.set_vertex_source(v(0), None);
    let e = mesh.edge_between(v(0), v(1)).unwrap();
    mesh.set_edge_source(e, Some(SourceTag(3)));
    assert_eq!(mesh.can_delete(v(0)), Err(Blocked::CurveEnd(v(0))));
    let e = mesh.edge_between(v(0), v(4)).unwrap();
    mesh.set_edge_source(e, Some(SourceTag(3)));
    assert_eq!(mesh.can_collapse(v(0), v(2)), Err(Blocked::LeavesCurve(v(0))));
    assert_eq!(mesh.can_collapse(v(0), v(1)), Ok(()));
}

#[test]
fn loops_of_three_lose_no_vertex() {
    let mut mesh = collared_fan(3);
    for (a, b) in [(1, 2), (2, 3), (3, 1)] {
        let e = mesh.edge_between(v(a), v(b)).unwrap();
        mesh.set_edge_source(e, Some(SourceTag(0)));
    }
    assert_eq!(mesh.can_delete(v(1)), Err(Blocked::SmallestLoop(v(1))));
    assert_eq!(mesh.can_collapse(v(1), v(2)), Err(Blocked::SmallestLoop(v(1))));
    assert_eq!(mesh.can_delete(v(4)), Err(Blocked::SmallestLoop(v(4))), "the boundary has three too");
    assert!(mesh.can_collapse(v(4), v(5)).is_err());
    mesh.delete_vertex(v(0));
    assert_eq!(validate(&mesh), Ok(()));
    let single = Mesh::from_triangles(3, &[[0, 1, 2]]).unwrap();
    assert_eq!(single.can_delete(v(0)), Err(Blocked::SmallestPiece(v(0))));
    assert_eq!(single.can_collapse(v(0), v(1)), Err(Blocked::SmallestLoop(v(0))));
}

#[test]
fn boundary_vertices_stay_on_the_boundary() {
    let mesh = collared_fan(6);
    let rim = v(7);
    assert!(mesh.is_boundary_vertex(rim));
    assert_eq!(mesh.can_collapse(rim, v(1)), Err(Blocked::LeavesBoundary(rim)));
    assert_eq!(mesh.can_collapse(v(1), rim), Ok(()));
    assert_eq!(mesh.can_delete(rim), Ok(()));
}

#[test]
fn a_forbidding_cost_leaves_the_mesh_alone() {
    let mut mesh = collared_fan(6);
    let before = mesh.to_triangles();
    assert_eq!(mesh.delete_vertex_by(v(0), |_| f64::INFINITY), Err(Blocked::NoFilling(v(0))));
    assert_eq!(mesh.to_triangles(), before);
}

#[test]
fn the_seven_vertex_torus_cannot_shrink() {
    let triangles: Vec<_> =
        (0..7_u32).flat_map(|i| [[i, (i + 1) % 7, (i + 3) % 7], [i, (i + 3) % 7, (i + 2) % 7]]).collect();
    let mesh = Mesh::from_triangles(7, &triangles).unwrap();
    assert_eq!(summary(&mesh).genus, 1);
    assert!(mesh.vertices().all(|x| mesh.can_delete(x) == Err(Blocked::NoFilling(x))));
    assert!(mesh.edges().all(|e| {
        let [a, b] = mesh.edge_vertices(e);
        mesh.can_collapse(a, b).is_err() && mesh.can_flip(e).is_err()
    }));
}
