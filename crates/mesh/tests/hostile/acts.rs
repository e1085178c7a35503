//! Surgery guided by hostile positions: they choose among ways, and may never make a mesh that is none.

use super::*;
use ductile_mesh::remesh::Ledger;
use ductile_mesh::{
    Bridge, BridgeError, CutError, EdgeId, FaceId, GlueError, Place, Seam, Sense, nearest_place,
};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const NOBODY: usize = 9999;

/// A ball of 162 vertices with two holes, far apart, and their loops.
fn holed() -> (Mesh, Vec<DVec3>, [Vec<VertexId>; 2]) {
    let (mut mesh, positions) = primitive::icosphere(2);
    let poles = [2, 160].map(FaceId::from_index);
    mesh.remove_faces(|f| poles.contains(&f));
    let loops = boundary_loops(&mesh).try_into().unwrap();
    (mesh, positions, loops)
}

#[test]
fn batches_that_look_only_where_something_changed_end_and_keep_the_surface() {
    let targets = [0.3, 0.0, f64::NAN, 1e300, 1e-9];
    for (base, mesh, good) in bases() {
        let was = summary(&mesh);
        for (name, start) in hostile(&mesh, &good) {
            for target in targets {
                let says = format!("{base}, {name}, {target}");
                let limits = Limits { most_vertices: MOST, growth: 1.0, ..Limits::default() };
                let (mut mesh, mut positions) = (mesh.clone(), start.clone());
                let (mut sizing, mut ledger) = (Sizing::Uniform(target), Ledger::default());
                for slack in [0.0, 0.02, f64::NAN, 0.0] {
                    let mut place = |mesh: &Mesh, at: &[DVec3], e| remesh::midpoint(mesh, at, e);
                    let ledger = (&mut ledger, slack);
                    remesh::improve_changed(
                        &mut mesh,
                        &mut positions,
                        &mut sizing,
                        ledger,
                        &limits,
                        &mut place,
                    );
                    is_whole(&says, &mesh, &positions, &was, &start);
                }
            }
        }
    }
}

#[test]
fn tightening_ends_and_keeps_the_surface() {
    for (base, mesh, good) in bases() {
        let was = summary(&mesh);
        for (name, positions) in hostile(&mesh, &good) {
            let mut mesh = mesh.clone();
            let flips = remesh::tighten(&mut mesh, &positions);
            assert!(flips <= 4 * mesh.edge_count(), "{base}, {name}");
            is_whole(&format!("{base}, {name}"), &mesh, &positions, &was, &positions);
        }
    }
}

#[test]
fn bridges_are_bands_or_refused_with_the_mesh_untouched() {
    let (mesh, good, [one, other]) = holed();
    for (name, positions) in hostile(&mesh, &good).into_iter().chain([("missing", vec![])]) {
        for sense in [Sense::Oriented, Sense::Reversed, Sense::AsGiven, Sense::Shortest] {
            let says = format!("{name}, {sense:?}");
            let bridge = Bridge {
                one: one.clone(),
                other: other.clone(),
                nodes: Default::default(),
                is_closed: true,
                sense,
            };
            let mut bridged = mesh.clone();
            let made = bridged.bridge(&bridge, &positions).unwrap_or_else(|e| panic!("{says}: {e}"));
            assert_eq!(made.faces.len(), one.len() + other.len(), "{says}");
            assert_eq!(validate(&bridged), Ok(()), "{says}");
            assert_eq!((summary(&bridged).euler, summary(&bridged).boundaries), (0, 0), "{says}");
            assert!(
                bridged.make_room_to_bridge(&bridge, &positions).is_err(),
                "{says}: it is closed already"
            );
        }
    }
    type Is = fn(&BridgeError) -> bool;
    let nobody = VertexId::from_index(NOBODY);
    let inside = mesh.vertices().find(|v| !mesh.is_boundary_vertex(*v)).unwrap();
    let bad: [(&str, Vec<VertexId>, Is); 5] = [
        ("nothing", vec![], |e| matches!(e, BridgeError::TooShort(0))),
        ("two of a loop", other[..2].to_vec(), |e| matches!(e, BridgeError::TooShort(2))),
        ("itself", one.clone(), |e| matches!(e, BridgeError::Repeated(_))),
        ("inside", vec![other[0], inside, other[1]], |e| matches!(e, BridgeError::NotOnBoundary(..))),
        ("nobody", vec![other[0], other[1], nobody], |e| matches!(e, BridgeError::NotOnBoundary(..))),
    ];
    for (name, other, is) in bad {
        let bridge = Bridge {
            one: one.clone(),
            other,
            nodes: Default::default(),
            is_closed: true,
            sense: Sense::Oriented,
        };
        let mut bridged = mesh.clone();
        let error = bridged.bridge(&bridge, &good).unwrap_err();
        assert!(is(&error), "{name}: {error}");
        assert_eq!(bridged.to_triangles(), mesh.to_triangles(), "{name}");
    }
}

#[test]
fn seams_are_glued_or_refused_with_their_offender() {
    let (mesh, _, [one, other]) = holed();
    let nobody = VertexId::from_index(NOBODY);
    let seam = |kept: &[VertexId], gone: &[VertexId]| Seam {
        kept: kept.to_vec(),
        gone: gone.to_vec(),
        is_closed: true,
    };
    let mut glued = mesh.clone();
    glued.make_room(&seam(&one, &other)).unwrap();
    glued.glue(&seam(&one, &other));
    assert_eq!((validate(&glued), summary(&glued).boundaries), (Ok(()), 0));
    type Is = fn(&GlueError) -> bool;
    let bad: [(&str, Seam, Is); 6] = [
        ("nothing", seam(&[], &[]), |e| matches!(e, GlueError::TooShort(0))),
        ("unlike", seam(&one, &other[..2]), |e| matches!(e, GlueError::Unlike(3, 2))),
        ("two of a loop", seam(&one[..2], &other[..2]), |e| matches!(e, GlueError::TooShort(2))),
        ("itself", seam(&one, &one), |e| matches!(e, GlueError::Repeated(_) | GlueError::NotOnBoundary(..))),
        ("nobody", seam(&one, &[other[0], other[1], nobody]), |e| matches!(e, GlueError::NotOnBoundary(..))),
        (
            "the largest index",
            seam(&[one[0], one[1], VertexId::from_index(u32::MAX as usize - 1)], &other),
            |e| matches!(e, GlueError::NotOnBoundary(..)),
        ),
    ];
    for (name, seam, is) in bad {
        let error = mesh.can_glue(&seam).unwrap_err();
        assert!(is(&error), "{name}: {error}");
        let mut room = mesh.clone();
        assert!(room.make_room(&seam).is_err(), "{name}");
        assert_eq!(room.to_triangles(), mesh.to_triangles(), "{name}");
    }
}

#[test]
fn cuts_open_the_surface_or_are_refused_with_their_offender() {
    for (base, mesh, _) in bases() {
        assert!(
            mesh.can_cut(&[EdgeId::from_index(NOBODY)]).is_err_and(|e| matches!(e, CutError::NoEdge(_))),
            "{base}"
        );
        assert!(mesh.can_cut(&[]).is_ok(), "{base}: nothing to cut");
        for e in mesh.edges() {
            for edges in [vec![e], vec![e, e]] {
                match mesh.can_cut(&edges) {
                    Ok(()) => {
                        let mut cut = mesh.clone();
                        cut.cut(&edges);
                        assert_eq!(validate(&cut), Ok(()), "{base}, {edges:?}");
                    }
                    Err(CutError::OnBoundary(edge)) => {
                        assert!(edge == e && mesh.is_boundary_edge(e), "{base}")
                    }
                    Err(error) => assert!(matches!(error, CutError::LoneEdge(_)), "{base}: {error}"),
                }
            }
        }
        // All at once: every face comes away by itself.
        let inner: Vec<EdgeId> = mesh.edges().filter(|&e| !mesh.is_boundary_edge(e)).collect();
        let mut apart = mesh.clone();
        apart.can_cut(&inner).unwrap();
        apart.cut(&inner);
        assert_eq!((validate(&apart), components(&apart).count()), (Ok(()), mesh.face_count()), "{base}");
    }
}

#[test]
fn edges_chains_and_paths_are_laid_or_refused_with_the_mesh_untouched() {
    for (base, mesh, good) in bases() {
        let was = summary(&mesh).kind();
        let last = VertexId::from_index(mesh.vertex_count() - 1);
        let nobody = VertexId::from_index(NOBODY);
        let pairs =
            [(VertexId::from_index(0), last), (last, VertexId::from_index(1)), (last, last), (last, nobody)];
        for (name, positions) in hostile(&mesh, &good).into_iter().chain([("missing", vec![])]) {
            for (from, to) in pairs {
                let says = format!("{base}, {name}, {from:?} to {to:?}");
                let mut edged = mesh.clone();
                match edged.insert_edge(from, to, &positions) {
                    Ok(e) => assert!(edged.edge_vertices(e).contains(&to), "{says}"),
                    Err(_) => assert_eq!(edged.to_triangles(), mesh.to_triangles(), "{says}"),
                }
                assert_eq!((validate(&edged), summary(&edged).kind()), (Ok(()), was), "{says}");
                let mut chained = mesh.clone();
                match chained.insert_chain(from, to, &positions) {
                    Ok(made) => {
                        let is_good = positions.iter().all(|p| p.is_finite());
                        let places = made.iter().map(|made| made.place);
                        assert!(
                            !is_good || places.into_iter().all(|p| (0.0..=1.0).contains(&p)),
                            "{says}: {made:?}"
                        );
                    }
                    Err(_) => assert_eq!(chained.to_triangles(), mesh.to_triangles(), "{says}"),
                }
                assert_eq!((validate(&chained), summary(&chained).kind()), (Ok(()), was), "{says}");
                assert!(to != nobody || chained.vertex_count() == mesh.vertex_count(), "{says}");
            }
            let near = |at: DVec3| nearest_place(&mesh, &good, at).unwrap();
            let places: Vec<Place> = [DVec3::X, DVec3::Y, DVec3::Z].map(near).to_vec();
            let nowhere = vec![places[0], Place::Vertex(nobody)];
            for (places, closed) in [(&places, true), (&places, false), (&nowhere, false), (&vec![], true)] {
                let says = format!("{base}, {name}, {places:?}, {closed}");
                let mut laid = mesh.clone();
                match laid.lay_path(places, closed, &positions) {
                    Ok(path) => {
                        let links = path.edges.iter().enumerate();
                        let count = path.vertices.len();
                        for (k, e) in links {
                            let ends = laid.edge_vertices(*e);
                            let [a, b] = [path.vertices[k], path.vertices[(k + 1) % count]];
                            assert!(ends == [a, b] || ends == [b, a], "{says}");
                        }
                    }
                    Err(_) => assert_eq!(laid.to_triangles(), mesh.to_triangles(), "{says}"),
                }
                assert_eq!((validate(&laid), summary(&laid).kind()), (Ok(()), was), "{says}");
            }
        }
    }
}
