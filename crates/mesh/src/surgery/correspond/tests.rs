//! Rims with source nodes that belong together, glued so that they meet.

use glam::DVec3;

use crate::measure::euler_characteristic;
use crate::{GlueError, Mesh, Seam, SourceTag, VertexId, boundary_loops, primitive, summary, validate};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A cylinder with ends of these numbers of vertices, and its ends, along one another.
fn cylinder(n: usize, m: usize) -> (Mesh, Seam) {
    let rim = |n: usize| (0..n).map(|i| DVec3::new(i as f64, (i * i) as f64, 0.0)).collect::<Vec<_>>();
    let (mesh, _) = primitive::cylinder(&rim(n), &rim(m), 2).unwrap();
    let [kept, mut gone] = <[_; 2]>::try_from(boundary_loops(&mesh)).unwrap();
    gone.reverse();
    (mesh, Seam { kept, gone, is_closed: true })
}

fn nodes(rim: &[VertexId], places: &[usize]) -> Vec<VertexId> {
    places.iter().map(|&k| rim[k]).collect()
}

/// Glues, and checks that the nodes met; gives by how many vertices the stretches were lengthened.
fn glue(mesh: &mut Mesh, seam: &Seam, places: [&[usize]; 2]) -> usize {
    let named = [nodes(&seam.kept, places[0]), nodes(&seam.gone, places[1])];
    for (&v, tag) in named[1].iter().zip(1..) {
        mesh.set_vertex_source(v, Some(SourceTag(tag)));
    }
    let euler = euler_characteristic(mesh);
    let mut even = seam.clone();
    let made = mesh.correspond(&mut even, [&named[0], &named[1]]).unwrap();
    assert_eq!(validate(mesh), Ok(()));
    assert_eq!(even.kept.len(), even.gone.len());
    for [kept, gone] in named[0].iter().zip(&named[1]).map(|(k, g)| [k, g]) {
        let place = |rim: &[VertexId], v| rim.iter().position(|w| w == v).unwrap();
        assert_eq!(place(&even.kept, kept), place(&even.gone, gone), "they lie on one another");
    }
    mesh.make_room(&even).unwrap();
    mesh.glue(&even);
    assert_eq!(validate(mesh), Ok(()));
    assert_eq!(euler_characteristic(mesh), euler, "a loop has as many edges as vertices");
    // The vertex that stays has taken over the tag of the one that was laid on it.
    for (&v, tag) in named[0].iter().zip(1..) {
        assert_eq!(mesh.vertex_source(v), Some(SourceTag(tag)));
    }
    made.len()
}

#[test]
fn stretches_that_correspond_already_are_laid_on_one_another() {
    let (mut mesh, seam) = cylinder(6, 6);
    assert_eq!(glue(&mut mesh, &seam, [&[0, 2, 4], &[0, 2, 4]]), 0);
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, true));
}

#[test]
fn each_stretch_gets_as_many_vertices_as_the_longer_one_has() {
    // 1, 1 and 3 edges against 4, 3 and 1: three and two are missing in the one, two in the other.
    let (mut mesh, seam) = cylinder(5, 8);
    assert_eq!(glue(&mut mesh, &seam, [&[0, 1, 2], &[0, 4, 7]]), 3 + 2 + 2);
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, true));
    // As many vertices on both, and yet they do not correspond.
    let (mut mesh, seam) = cylinder(6, 6);
    assert_eq!(glue(&mut mesh, &seam, [&[0, 1], &[0, 4]]), 3 + 3);
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, true));
}

#[test]
fn a_shifted_correspondence_begins_at_its_first_nodes() {
    let (mut mesh, seam) = cylinder(7, 7);
    assert_eq!(glue(&mut mesh, &seam, [&[5, 0, 3], &[1, 3, 6]]), 0);
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, true));
    let (mut mesh, seam) = cylinder(4, 9);
    assert_eq!(glue(&mut mesh, &seam, [&[2], &[7]]), 5, "one pair of nodes is a correspondence, too");
}

#[test]
fn rims_that_run_the_same_way_make_a_klein_bottle() {
    let (mut mesh, mut seam) = cylinder(6, 8);
    seam.gone.reverse();
    glue(&mut mesh, &seam, [&[0, 2, 4], &[7, 1, 3]]);
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, false));
}

#[test]
fn the_rim_of_a_moebius_strip_is_sewn_to_itself_between_its_nodes() {
    let (mut mesh, _) = primitive::moebius(9, 2, 2.0, 1.0);
    let rim = boundary_loops(&mesh).remove(0);
    let n = rim.len();
    // Two open stretches with one common end, of three and six edges.
    let gone: Vec<_> = (0..=6).map(|k| rim[(n - k) % n]).collect();
    let mut seam = Seam { kept: rim[..=3].to_vec(), gone, is_closed: false };
    let before = summary(&mesh);
    let (kept, gone) = (vec![rim[0], rim[2]], vec![rim[0], rim[n - 1]]);
    let made = mesh.correspond(&mut seam, [&kept, &gone]).unwrap();
    // Two edges against one, then one against five.
    assert_eq!((made.len(), seam.kept.len(), seam.gone.len()), (1 + 4, 8, 8));
    assert_eq!((seam.kept[2], seam.gone[2]), (rim[2], rim[n - 1]));
    mesh.make_room(&seam).unwrap();
    mesh.glue(&seam);
    assert_eq!(validate(&mesh), Ok(()));
    let after = summary(&mesh);
    assert_eq!((after.euler, after.is_orientable), (before.euler, false), "seven edges and seven vertices");
}

#[test]
fn without_nodes_a_loop_is_one_stretch() {
    let (mut mesh, mut seam) = cylinder(5, 8);
    let first = (seam.kept[0], seam.gone[0]);
    assert_eq!(mesh.correspond(&mut seam, [&[], &[]]).unwrap().len(), 3);
    assert_eq!((seam.kept[0], seam.gone[0]), first);
    assert_eq!((seam.kept.len(), seam.gone.len()), (8, 8));
}

#[test]
fn a_bad_correspondence_is_refused_and_nothing_changes() {
    let (mut mesh, seam) = cylinder(5, 8);
    let (old, old_seam) = (mesh.to_triangles(), seam.clone());
    let inner = mesh.vertices().find(|v| !mesh.is_boundary_vertex(*v)).unwrap();
    let [k, g] = [&seam.kept, &seam.gone];
    let order = |places: &[usize]| nodes(g, places);
    let three = nodes(k, &[0, 1, 3]);
    let bad = [
        ("of unlike numbers", three.clone(), order(&[0, 1]), GlueError::UnlikeNodes(3, 2)),
        ("inside", vec![k[0], inner], order(&[0, 1]), GlueError::NotOnRim(inner)),
        ("of the other rim", nodes(k, &[0, 1]), vec![g[0], k[0]], GlueError::NotOnRim(k[0])),
        ("named twice", three.clone(), order(&[0, 4, 4]), GlueError::Repeated(g[4])),
        ("named twice at the ends", three.clone(), order(&[4, 0, 4]), GlueError::Repeated(g[4])),
        ("in the wrong sense", three, order(&[6, 4, 0]), GlueError::OutOfOrder(g[0])),
        ("crosswise", nodes(k, &[0, 1, 2, 3]), order(&[0, 5, 2, 7]), GlueError::OutOfOrder(g[2])),
    ];
    for (name, kept, gone, error) in bad {
        let mut tried = seam.clone();
        assert_eq!(mesh.correspond(&mut tried, [&kept, &gone]), Err(error), "{name}");
        assert_eq!((mesh.to_triangles(), &tried), (old.clone(), &old_seam), "{name}");
    }
    // Rims that are none: a vertex is skipped.
    let mut gap = Seam { kept: nodes(k, &[0, 2, 3, 4]), ..seam };
    assert_eq!(
        mesh.correspond(&mut gap, [&[], &[]]),
        Err(GlueError::NotOnBoundary(old_seam.kept[0], old_seam.kept[2]))
    );
    assert_eq!(mesh.to_triangles(), old);
    // An end of one open rim belongs to an end of the other, and to nothing else.
    let mut open = Seam {
        kept: nodes(&old_seam.kept, &[0, 1, 2]),
        gone: nodes(&old_seam.gone, &[0, 1, 2]),
        is_closed: false,
    };
    let nodes = [vec![open.kept[0]], vec![open.gone[1]]];
    assert_eq!(mesh.correspond(&mut open, [&nodes[0], &nodes[1]]), Err(GlueError::TooShort(1)));
}
