//! Edges and curves inserted anywhere: they join what they should, and the surface stays what it is.

use glam::DVec3;
use proptest::prelude::*;

use super::*;
use crate::family::{draw_curve, family, nature};
use crate::property_test::cases;
use crate::{SourceTag, primitive, validate};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A square of 7 by 7 vertices, and its vertex in a row and column.
fn square() -> (Mesh, Vec<DVec3>, impl Fn(u32, u32) -> VertexId) {
    let mut triangles = Vec::new();
    for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))) {
        let at = |i: u32, j: u32| 7 * i + j;
        triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
        triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
    }
    let positions = (0..49).map(|k| DVec3::new(f64::from(k / 7), f64::from(k % 7), 0.0)).collect();
    (Mesh::from_triangles(49, &triangles).unwrap(), positions, |i, j| VertexId(7 * i + j))
}

#[test]
fn an_edge_is_flipped_in_across_a_square_without_a_fold() {
    let (mut mesh, positions, at) = square();
    let (from, to) = (at(1, 1), at(4, 6));
    let before = nature(&mesh);
    let edge = mesh.insert_edge(from, to, &positions).unwrap();
    assert_eq!(mesh.edge_vertices(edge).iter().filter(|v| [from, to].contains(v)).count(), 2);
    assert_eq!((validate(&mesh), nature(&mesh)), (Ok(()), before));
    // The straight line passes through no other vertex, so no triangle need turn over.
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()]);
        assert!((b - a).cross(c - a).z > 0.0, "{f:?}");
    }
    // Asked again, it is there.
    assert_eq!(mesh.insert_edge(to, from, &positions), Ok(edge));
}

#[test]
fn flips_respect_curves_and_splits_cross_them() {
    let (mut mesh, positions, at) = square();
    for j in 0..6 {
        let edge = mesh.edge_between(at(3, j), at(3, j + 1)).unwrap();
        mesh.set_edge_source(edge, Some(SourceTag(1)));
    }
    for j in [0, 6] {
        mesh.set_vertex_source(at(3, j), Some(SourceTag(10 + j)));
    }
    let (from, to) = (at(1, 2), at(5, 3));
    let (before, old) = (nature(&mesh), mesh.to_triangles());
    assert_eq!(mesh.insert_edge(from, to, &positions), Err(InsertError::NoWay(from, to)));
    assert_eq!(mesh.to_triangles(), old, "a refusal changes nothing");
    let made = mesh.insert_chain(from, to, &positions).unwrap();
    assert_eq!((validate(&mesh), nature(&mesh)), (Ok(()), before));
    let chain: Vec<_> = [from].into_iter().chain(made.iter().map(|m| m.vertex)).chain([to]).collect();
    assert!(chain.windows(2).all(|pair| mesh.are_neighbours(pair[0], pair[1])));
    // The line from (1, 2) to (5, 3) meets the curve at (3, 2.5).
    let crossing: Vec<_> = made.iter().filter(|m| mesh.is_on_source_curve(m.vertex)).collect();
    let place = |m: &CrossingVertex| positions[m.ends[0].index()].lerp(positions[m.ends[1].index()], m.place);
    assert_eq!(crossing.len(), 1);
    assert!(place(crossing[0]).distance(DVec3::new(3.0, 2.5, 0.0)) < 1e-9);
    for m in &made {
        let at = place(m);
        assert!((at.y - (2.0 + (at.x - 1.0) / 4.0)).abs() < 0.06, "{at}: straight, but for the margin");
    }
}

#[test]
fn of_the_edges_in_the_way_the_one_goes_first_whose_flip_leaves_the_flattest_pair() {
    // Two edges lead from the left to the right bank; which of them goes first decides the diagonal of the right bank.
    let [south, north, left, right, beyond] = [0, 1, 2, 3, 4].map(VertexId);
    let triangles = [[0, 3, 2], [3, 4, 2], [4, 1, 2]];
    let plan = |heights: [f64; 2]| {
        let [near, far] = heights;
        [(0.0, -1.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (1.0, -0.4, near), (1.0, 0.4, far)]
            .map(DVec3::from)
    };
    let bend = |places: &[DVec3; 5], [a, b]: [VertexId; 2], [c, d]: [VertexId; 2]| {
        let at = |v: VertexId| places[v.index()];
        let normal = |p, q, r| (at(q) - at(p)).cross(at(r) - at(p)).normalize_or_zero();
        normal(a, b, c).angle_between(normal(b, a, d))
    };
    for heights in [[0.0, 0.5], [0.5, 0.0], [-0.3, 0.4], [0.4, -0.3]] {
        let places = plan(heights);
        let mut mesh = Mesh::from_triangles(5, &triangles).unwrap();
        mesh.insert_edge(south, north, &places).unwrap();
        // Over the southern edge first: the pair at south to beyond. Over the northern first: the pair at right to north.
        let first = bend(&places, [south, beyond], [left, right]);
        let second = bend(&places, [right, north], [left, beyond]);
        assert!(
            (first - second).abs() > 0.02,
            "{heights:?}: {first} and {second} must differ for this to tell anything"
        );
        assert_eq!(mesh.are_neighbours(south, beyond), first < second, "{heights:?}: {first} {second}");
        assert_eq!(mesh.are_neighbours(right, north), second < first, "{heights:?}: {first} {second}");
    }
}

/// The edges that join these vertices in order bear the tag, and no other edge does.
fn is_curve(mesh: &Mesh, vertices: &[VertexId], is_closed: bool, tag: SourceTag) -> bool {
    let next = vertices.iter().skip(1).chain(is_closed.then_some(&vertices[0]));
    let legs = vertices.iter().zip(next).map(|(&a, &b)| mesh.edge_between(a, b));
    let mut legs: Vec<_> = legs.flatten().collect();
    legs.sort_unstable();
    let mut tagged: Vec<_> = mesh.edges().filter(|&e| mesh.edge_source(e) == Some(tag)).collect();
    tagged.sort_unstable();
    legs.len() == vertices.len() - usize::from(!is_closed) && legs == tagged
}

#[test]
fn a_curve_by_flips_has_exactly_the_given_vertices() {
    let (mut mesh, positions, at) = square();
    let before = nature(&mesh);
    let ring = [at(1, 1), at(4, 2), at(5, 5), at(2, 4)];
    let edges = mesh.insert_curve(&ring, true, &positions, SourceTag(7)).unwrap();
    assert_eq!(edges.len(), 4);
    assert!(is_curve(&mesh, &ring, true, SourceTag(7)));
    // An open one beside it, and one that has no way round it.
    let line = [at(6, 0), at(5, 3), at(6, 6)];
    mesh.insert_curve(&line, false, &positions, SourceTag(8)).unwrap();
    assert!(is_curve(&mesh, &line, false, SourceTag(8)) && is_curve(&mesh, &ring, true, SourceTag(7)));
    let after = nature(&mesh);
    // The ring parts a disc from the square, the line from rim to rim parts what is left.
    assert_eq!((validate(&mesh), after.kind, after.regions), (Ok(()), before.kind, before.regions + 2));
    let (vertices, triangles) = (mesh.vertex_count(), mesh.to_triangles());
    let within = mesh.vertices().find(|&v| v == at(3, 3)).unwrap();
    let out = [at(0, 0), within];
    let refused = mesh.insert_curve(&out, false, &positions, SourceTag(9));
    assert_eq!(refused, Err(InsertError::NoWay(out[0], within)), "the ring lies between them");
    let taken = mesh.insert_curve(&[at(0, 3), ring[0], ring[1]], false, &positions, SourceTag(9));
    assert_eq!(taken, Err(InsertError::Taken(edges[0])));
    assert_eq!(
        (mesh.vertex_count(), mesh.to_triangles()),
        (vertices, triangles),
        "a refusal changes nothing"
    );
    assert!(mesh.edges().all(|e| mesh.edge_source(e) != Some(SourceTag(9))), "nor does it tag anything");
}

#[test]
fn a_curve_of_too_few_or_repeated_vertices_is_refused() {
    let (mut mesh, positions, at) = square();
    let tag = SourceTag(1);
    let mut refusal =
        |list: &[VertexId], is_closed| mesh.insert_curve(list, is_closed, &positions, tag).unwrap_err();
    assert_eq!(refusal(&[], false), InsertError::TooShort(0));
    assert_eq!(refusal(&[at(0, 0), at(2, 2)], true), InsertError::TooShort(2));
    assert_eq!(refusal(&[at(0, 0), at(2, 2), at(0, 0)], false), InsertError::Repeated(at(0, 0)));
    assert_eq!(refusal(&[at(0, 0), VertexId(99)], false), InsertError::NoVertex(VertexId(99)));
}

#[test]
fn nonsense_is_refused() {
    let (mut mesh, positions) = primitive::tetrahedron();
    let v = VertexId(0);
    assert_eq!(mesh.insert_edge(v, v, &positions), Err(InsertError::Same(v)));
    let nobody = VertexId(77);
    assert_eq!(mesh.insert_chain(v, nobody, &positions), Err(InsertError::NoVertex(nobody)));
    let mut pieces = Mesh::from_triangles(6, &[[0, 1, 2], [3, 4, 5]]).unwrap();
    let (a, b) = (VertexId(0), VertexId(4));
    assert_eq!(pieces.insert_edge(a, b, &[]), Err(InsertError::NoWay(a, b)));
    assert_eq!(pieces.insert_chain(a, b, &[]), Err(InsertError::NoWay(a, b)));
}

proptest! {
    #![proptest_config(cases(128, 16))]

    #[test]
    fn whatever_is_joined_the_surface_stays_what_it_is(
        acts in prop::collection::vec((any::<bool>(), any::<u32>(), any::<u32>(), any::<u32>()), 1..16),
        curve in prop::collection::vec(any::<u32>(), 1..6),
        spots in prop::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0), 64),
        is_placed in any::<bool>(),
    ) {
        for (name, mut mesh) in family() {
            let steps: Vec<_> = curve.iter().map(|&step| step as usize).collect();
            draw_curve(&mut mesh, steps[0], &steps, 3);
            for &(by_flips, one, other, split) in &acts {
                let edges: Vec<_> = mesh.edges().collect();
                mesh.split_edge(edges[split as usize % edges.len()]);
                let vertices: Vec<_> = mesh.vertices().collect();
                let pick = |k: u32| vertices[k as usize % vertices.len()];
                let (from, to) = (pick(one), pick(other));
                // Positions may mean nothing, or not be there at all.
                let positions: Vec<_> = (0..if is_placed { mesh.vertex_slots() } else { 0 })
                    .map(|k| DVec3::from(spots[k % spots.len()]))
                    .collect();
                let (before, old) = (nature(&mesh), mesh.to_triangles());
                let is_done = if by_flips {
                    let edge = mesh.insert_edge(from, to, &positions);
                    prop_assert!(edge.is_err() || mesh.are_neighbours(from, to));
                    edge.is_ok()
                } else {
                    let made = mesh.insert_chain(from, to, &positions);
                    if let Ok(made) = &made {
                        let chain: Vec<_> =
                            [from].into_iter().chain(made.iter().map(|m| m.vertex)).chain([to]).collect();
                        prop_assert!(chain.windows(2).all(|pair| mesh.are_neighbours(pair[0], pair[1])), "{}", name);
                    }
                    // Splits always work, unless the piece is another one.
                    prop_assert!(made.is_ok() || from == to || name == "pieces", "{} {:?}", name, made);
                    made.is_ok()
                };
                prop_assert_eq!(validate(&mesh), Ok(()), "{}", name);
                prop_assert_eq!(nature(&mesh), before, "{}", name);
                prop_assert!(is_done || mesh.to_triangles() == old, "a refusal changes nothing");
            }
        }
    }
}
