//! Hostile meshes at every public entry: a typed refusal or a correct result, never a hang, a crash or a silent wrong
//! answer. One table of connectivities and one of positions; every entry goes over both.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

mod acts;
mod places;
mod ply;

use ductile_mesh::io::obj::{self, ObjError};
use ductile_mesh::remesh::{self, Limits, Seeds, Sizing};
use ductile_mesh::{
    BuildError, Mesh, VertexId, boundary_loops, components, dehydrate, is_orientable, measure, primitive,
    propagate_orientation, quality, regions, reverse, summary, validate, validate_curves,
};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Most vertices that a pass may make here: what asks for more is cut short.
const MOST: usize = 2_000;

/// A sphere of 42 vertices, a sheet with a boundary, and a one-sided strip.
fn bases() -> [(&'static str, Mesh, Vec<DVec3>); 3] {
    let (ball, at) = primitive::icosphere(1);
    let (sheet, flat) = primitive::plane(5, 4, 1.0);
    let (strip, twisted) = primitive::moebius(9, 2, 2.0, 1.0);
    [("ball", ball, at), ("sheet", sheet, flat), ("strip", strip, twisted)]
}

/// Positions that a mesh may come with, by name.
fn hostile(mesh: &Mesh, good: &[DVec3]) -> Vec<(&'static str, Vec<DVec3>)> {
    let face = mesh.face_vertices(mesh.faces().nth(3).unwrap()).map(VertexId::index);
    let with = |change: &dyn Fn(&mut Vec<DVec3>)| {
        let mut positions = good.to_vec();
        change(&mut positions);
        positions
    };
    vec![
        ("good", good.to_vec()),
        ("zero-area face", with(&|p| p[face[2]] = p[face[0]].midpoint(p[face[1]]))),
        ("duplicate vertex", with(&|p| p[face[1]] = p[face[0]])),
        ("sliver", with(&|p| p[face[2]] = p[face[0]].midpoint(p[face[1]]) + DVec3::splat(1e-12))),
        ("all equal", vec![DVec3::ONE; good.len()]),
        ("a line", good.iter().map(|p| DVec3::X * p.x).collect()),
        ("folded", with(&|p| p.iter_mut().for_each(|p| p.x = p.x.abs()))),
        ("huge", good.iter().map(|p| *p * 1e150).collect()),
        ("tiny", good.iter().map(|p| *p * 1e-150).collect()),
        ("NaN", with(&|p| p[face[0]] = DVec3::NAN)),
        ("infinite", with(&|p| p[face[0]] = DVec3::INFINITY)),
    ]
}

#[test]
fn connectivity_that_is_no_surface_is_refused_with_its_offender() {
    let (ball, _) = primitive::icosphere(1);
    let good = ball.to_triangles();
    let count = ball.vertex_count();
    let with = |more: &[[u32; 3]]| [good.clone(), more.to_vec()].concat();
    let [a, b, c] = good[0];
    let outside = u32::try_from(count).unwrap();
    type Is = fn(&BuildError) -> bool;
    let table: [(&str, usize, Vec<[u32; 3]>, Is); 8] = [
        ("index out of range", count, with(&[[a, b, outside]]), |e| {
            matches!(e, BuildError::IndexOutOfRange { .. })
        }),
        ("largest index", count, with(&[[a, b, u32::MAX]]), |e| {
            matches!(e, BuildError::IndexOutOfRange { .. })
        }),
        ("non-manifold edge", count + 1, with(&[[a, b, outside]]), |e| {
            matches!(e, BuildError::CrowdedEdge(..))
        }),
        ("repeated vertex", count, with(&[[a, a, b]]), |e| matches!(e, BuildError::RepeatedVertex { .. })),
        ("duplicate face", 3, vec![[0, 1, 2], [2, 1, 0]], |e| matches!(e, BuildError::DuplicateFace(..))),
        ("duplicate face on a ball", count, with(&[[c, b, a]]), |e| matches!(e, BuildError::CrowdedEdge(..))),
        ("isolated vertex", count + 1, good.clone(), |e| matches!(e, BuildError::IsolatedVertex(_))),
        ("pinched vertex", count + 2, with(&[[a, outside, outside + 1]]), |e| {
            matches!(e, BuildError::PinchedVertex(_))
        }),
    ];
    for (name, count, triangles, is) in table {
        let error = Mesh::from_triangles(count, &triangles).unwrap_err();
        assert!(is(&error), "{name}: {error}");
    }
    // A flipped face is no defect: windings need not agree, and they are put right.
    let mut flipped = good.clone();
    flipped[7].swap(0, 1);
    let mut mesh = Mesh::from_triangles(count, &flipped).unwrap();
    assert_eq!(validate(&mesh), Ok(()));
    assert!(mesh.edges().any(|e| !mesh.is_wound_alike(e)) && is_orientable(&mesh));
    assert!(propagate_orientation(&mut mesh));
    assert_eq!(mesh.to_triangles().len(), good.len());
    assert!(mesh.edges().all(|e| mesh.is_wound_alike(e)));
    reverse(&mut mesh);
    assert_eq!((validate(&mesh), summary(&mesh)), (Ok(()), summary(&ball)));
}

#[test]
fn measures_say_what_is_there_or_that_it_is_no_number() {
    for (base, mesh, good) in bases() {
        let area = measure::total_area(&mesh, &good);
        let best = quality(&mesh, &good);
        for (name, positions) in hostile(&mesh, &good) {
            let q = quality(&mesh, &positions);
            let total = measure::total_area(&mesh, &positions);
            let mean = measure::mean_edge_length(&mesh, &positions);
            // What does not look at positions is not moved by them.
            assert_eq!(
                (q.inner_valences.as_slice(), summary(&mesh)),
                (best.inner_valences.as_slice(), summary(&mesh))
            );
            let says = format!("{base}, {name}: {q:?}, area {total}, mean edge {mean}");
            let close = |x: f64, y: f64| (x / y - 1.0).abs() < 1e-12;
            match name {
                "good" => assert!(close(total, area)),
                "huge" | "tiny" => {
                    let scale: f64 = if name == "huge" { 1e150 } else { 1e-150 };
                    assert!(close(total, area * scale * scale), "{says}");
                    assert!(close(q.least_angle, best.least_angle), "{says}");
                    assert!(close(q.longest_edge, best.longest_edge * scale), "{says}");
                }
                "NaN" | "infinite" => assert!(!total.is_finite() && !mean.is_finite(), "{says}"),
                "all equal" => assert!(total == 0.0 && mean == 0.0 && q.least_angle == 0.0, "{says}"),
                "a line" => assert!(total.abs() < 1e-12 && q.least_angle < 1e-6, "{says}"),
                "duplicate vertex" => assert!(q.shortest_edge == 0.0 && q.least_angle == 0.0, "{says}"),
                "zero-area face" | "sliver" => assert!(q.least_angle < 1e-6 && total > 0.0, "{says}"),
                _ => assert!(total.is_finite() && mean > 0.0, "{says}"),
            }
        }
    }
}

#[test]
fn files_bring_back_what_was_written_or_name_the_line() {
    for (base, mesh, good) in bases() {
        for (name, positions) in hostile(&mesh, &good) {
            let text = obj::write(&mesh, &positions, None);
            match obj::read_mesh(&text) {
                Ok((back, points)) => {
                    assert_eq!(
                        (back.to_triangles(), &points),
                        (mesh.to_triangles(), &positions),
                        "{base}, {name}"
                    );
                }
                Err(error) => {
                    let is_due = matches!(name, "NaN" | "infinite");
                    assert!(is_due && matches!(error, ObjError::BadCoordinate(_)), "{base}, {name}: {error}");
                }
            }
        }
    }
    for (text, is) in [
        ("v 0 0 0\nf 1 1 1\n", "form no surface"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", "line 4"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -9 2 3\n", "line 4"),
        ("v 0 0 1e999\n", "line 1"),
        ("f\n", "line 1"),
    ] {
        let error = obj::read_mesh(text).unwrap_err().to_string();
        assert!(error.contains(is), "{text:?}: {error}");
    }
}

#[test]
fn labels_loops_and_rings_do_not_look_at_positions() {
    for (base, mesh, _) in bases() {
        assert_eq!((components(&mesh).count(), regions(&mesh).count()), (1, 1), "{base}");
        assert_eq!(boundary_loops(&mesh).len(), summary(&mesh).boundaries, "{base}");
        assert_eq!((validate(&mesh), validate_curves(&mesh)), (Ok(()), Ok(())), "{base}");
        let mut ring = Vec::new();
        for v in mesh.vertices() {
            mesh.ring(v, &mut ring);
            assert_eq!(ring.len(), mesh.valence(v), "{base}");
        }
    }
}

/// What no pass may change, whatever the positions.
fn is_whole(says: &str, mesh: &Mesh, positions: &[DVec3], was: &measure::Summary, old: &[DVec3]) {
    assert_eq!(validate(mesh), Ok(()), "{says}");
    assert_eq!(summary(mesh).kind(), was.kind(), "{says}");
    assert!(mesh.vertex_count() <= MOST && positions.len() >= mesh.vertex_slots(), "{says}");
    let was_finite = old.iter().all(|p| p.is_finite());
    assert!(!was_finite || mesh.vertices().all(|v| positions[v.index()].is_finite()), "{says}");
}

#[test]
fn improving_ends_and_keeps_the_surface_whatever_the_positions_and_targets() {
    let targets = [0.3, 0.0, -1.0, f64::NAN, f64::INFINITY, 1e-300, 1e300, 1e-9];
    for (base, mesh, good) in bases() {
        let was = summary(&mesh);
        for (name, start) in hostile(&mesh, &good) {
            let graded = [Sizing::PerVertex(vec![]), Sizing::PerVertex(vec![0.2; 5])];
            let seeds = [(VertexId::from_index(0), 0.1), (VertexId::from_index(1), f64::NAN)];
            let spread = Sizing::spread(&mesh, &start, &seeds, 0.25, 1.0);
            for sizing in targets.map(Sizing::Uniform).into_iter().chain(graded).chain([spread]) {
                let says = format!("{base}, {name}, {sizing:?}");
                let limits = Limits { most_vertices: MOST, growth: 1.0, ..Limits::default() };
                let (mut mesh, mut positions, mut sizing) = (mesh.clone(), start.clone(), sizing);
                for _ in 0..4 {
                    remesh::improve(&mut mesh, &mut positions, &mut sizing, &limits, &mut remesh::midpoint);
                    is_whole(&says, &mesh, &positions, &was, &start);
                }
                // A place that is none is not taken.
                let mut nowhere = |_: &Mesh, _: &[DVec3], _| DVec3::NAN;
                remesh::split_long(&mut mesh, &mut positions, &mut sizing, Seeds::All, &limits, &mut nowhere);
                remesh::flip_pass(&mut mesh, &positions, &sizing, Seeds::All, &limits);
                remesh::collapse_short(&mut mesh, &positions, &sizing, Seeds::All, &limits);
                remesh::repair_valence(&mut mesh, &positions, &sizing, Seeds::All, &limits);
                is_whole(&says, &mesh, &positions, &was, &start);
            }
        }
    }
}

#[test]
fn a_good_mesh_is_improved_alike_at_any_scale() {
    // Powers of two scale without rounding: every decision must be the same.
    let (mesh, good) = primitive::icosphere(2);
    let improved = |scale: f64| {
        let (mut mesh, mut sizing) = (mesh.clone(), Sizing::Uniform(0.2 * scale));
        let mut positions: Vec<DVec3> = good.iter().map(|p| *p * scale).collect();
        let limits = Limits { most_vertices: MOST, ..Limits::default() };
        for _ in 0..3 {
            remesh::improve(&mut mesh, &mut positions, &mut sizing, &limits, &mut remesh::midpoint);
        }
        let positions: Vec<DVec3> = mesh.vertices().map(|v| positions[v.index()] / scale).collect();
        (mesh.to_triangles(), positions)
    };
    let at_one = improved(1.0);
    assert!(at_one.0.len() > mesh.face_count());
    for exponent in [-120, -60, 60, 120] {
        assert_eq!(improved(libm::ldexp(1.0, exponent)), at_one, "2^{exponent}");
    }
}

#[test]
fn drying_ends_and_keeps_the_surface() {
    for (base, mesh, good) in bases() {
        for (name, positions) in hostile(&mesh, &good) {
            let dried = dehydrate(&mesh, &positions);
            assert_eq!(validate(&dried.mesh), Ok(()), "{base}, {name}");
            assert_eq!(summary(&dried.mesh).kind(), summary(&mesh).kind(), "{base}, {name}");
            assert!(dried.mesh.vertex_count() < mesh.vertex_count(), "{base}, {name}");
            assert_eq!(dried.carry(&positions).len(), dried.mesh.vertex_count(), "{base}, {name}");
        }
    }
}

#[test]
fn surgery_that_is_allowed_keeps_the_surface_and_what_is_not_says_why() {
    for (base, mesh, _) in bases() {
        let was = summary(&mesh).kind();
        let check = |mesh: &Mesh, says: &str| {
            assert_eq!((validate(mesh), summary(mesh).kind()), (Ok(()), was), "{base}, {says}");
        };
        for e in mesh.edges() {
            let mut split = mesh.clone();
            split.split_edge(e);
            check(&split, "split");
            if mesh.can_flip(e).is_ok() {
                let mut flipped = mesh.clone();
                flipped.flip(e);
                check(&flipped, "flip");
            }
            let [a, b] = mesh.edge_vertices(e);
            for (gone, kept) in [(a, b), (b, a)] {
                if mesh.can_collapse(gone, kept).is_ok() {
                    let mut collapsed = mesh.clone();
                    collapsed.collapse(gone, kept);
                    check(&collapsed, "collapse");
                }
            }
        }
        for v in mesh.vertices() {
            let mut deleted = mesh.clone();
            // A price that is no number must not make a hole.
            match deleted.delete_vertex_by(v, |_| f64::NAN) {
                Ok(()) => check(&deleted, "delete"),
                Err(_) => assert_eq!(deleted.to_triangles(), mesh.to_triangles(), "{base}"),
            }
        }
        let far = mesh
            .vertices()
            .find(|&v| !mesh.are_neighbours(v, VertexId::from_index(0)) && v.index() > 0)
            .unwrap();
        assert!(mesh.can_collapse(VertexId::from_index(0), far).is_err(), "{base}: no edge to collapse");
    }
}
