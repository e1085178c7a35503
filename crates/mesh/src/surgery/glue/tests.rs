//! Cuts and glue: the kind of the surface changes exactly as each of them promises.

use proptest::prelude::*;

use crate::family::{draw_curve, family};
use crate::measure::{boundary_loops, euler_characteristic};
use crate::property_test::cases;
use crate::{
    Cut, CutError, EdgeId, GlueError, Mesh, Seam, SourceTag, VertexId, primitive, summary, validate,
};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn v(i: u32) -> VertexId {
    VertexId(i)
}

fn walk(mesh: &Mesh, vertices: &[VertexId], is_closed: bool) -> Vec<EdgeId> {
    let last = if is_closed { vertices.len() } else { vertices.len() - 1 };
    (0..last).map(|i| mesh.edge_between(vertices[i], vertices[(i + 1) % vertices.len()]).unwrap()).collect()
}

/// The seam that undoes a cut along a closed two-sided curve.
fn seam_of(cut: &Cut, curve: &[VertexId]) -> Seam {
    let copy = |v: &VertexId| cut.vertices.iter().find(|(old, _)| old == v).unwrap().1;
    Seam { kept: curve.to_vec(), gone: curve.iter().map(copy).collect(), is_closed: true }
}

#[test]
fn a_torus_is_cut_to_a_cylinder_and_glued_to_a_torus_again() {
    let (mut mesh, _) = primitive::torus(5, 4, 2.0, 1.0);
    let start = mesh.vertices().next().unwrap();
    // The shortest loop through the first vertex that bounds nothing: along the neighbours of a column.
    let triangles = mesh.to_triangles();
    let loop_ = (0..4).map(v).collect::<Vec<_>>();
    let is_walk = (0..4).all(|i| mesh.are_neighbours(loop_[i], loop_[(i + 1) % 4]));
    assert!(is_walk, "the columns of a torus are numbered first");
    mesh.set_vertex_source(start, Some(SourceTag(7)));
    let edges = walk(&mesh, &loop_, true);
    mesh.set_edge_source(edges[0], Some(SourceTag(8)));
    let cut = mesh.cut(&edges);
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh).kind(), (0, 2, 1, true));
    assert_eq!((cut.vertices.len(), cut.edges.len()), (4, 4));
    let copy = cut.vertices.iter().find(|(old, _)| *old == start).unwrap().1;
    assert_eq!(mesh.vertex_source(copy), Some(SourceTag(7)), "the tag of a point is cloned");
    assert!(cut.edges.iter().any(|&(_, copy)| mesh.edge_source(copy) == Some(SourceTag(8))));
    // The originals are one boundary, the copies the other.
    let loops = boundary_loops(&mesh);
    assert!(loops.iter().any(|rim| rim.iter().all(|v| loop_.contains(v))), "{loops:?}");
    let seam = seam_of(&cut, &loop_);
    mesh.glue(&seam);
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, true));
    assert_eq!(mesh.to_triangles(), triangles);
}

#[test]
fn the_core_of_a_moebius_strip_is_cut_to_a_band_with_two_sides() {
    let (mut mesh, _) = primitive::moebius(7, 2, 2.0, 1.0);
    let rim: Vec<_> = mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).collect();
    let core: Vec<_> =
        mesh.edges().filter(|&e| mesh.edge_vertices(e).iter().all(|v| !rim.contains(v))).collect();
    assert_eq!(core.len(), 7);
    mesh.cut(&core);
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh).kind(), (0, 2, 1, true));
}

#[test]
fn a_slit_is_opened_and_sewn_up() {
    let hexagon: Vec<_> = (0..6).map(|i| glam::DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect();
    let (mut mesh, _) = primitive::sheet(&hexagon, 3).unwrap();
    let inner: Vec<_> = mesh.vertices().filter(|&v| !mesh.is_boundary_vertex(v)).collect();
    let middle = *inner.iter().find(|&&v| mesh.neighbours(v).all(|w| inner.contains(&w))).unwrap();
    let ends: Vec<_> = mesh.neighbours(middle).collect();
    let (one, other) = (ends[0], ends[ends.len() / 2]);
    let before = summary(&mesh);
    let lone = mesh.edge_between(one, middle).unwrap();
    assert_eq!(mesh.can_cut(&[lone]), Err(CutError::LoneEdge(lone)));
    let cut = mesh.cut(&walk(&mesh, &[one, middle, other], false));
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh).kind(), (before.euler - 1, before.boundaries + 1, 1, true));
    let copy = cut.vertices[0].1;
    let seam = Seam { kept: vec![one, middle, other], gone: vec![one, copy, other], is_closed: false };
    mesh.glue(&seam);
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh), before);
}

#[test]
fn the_ends_of_a_cylinder_make_a_torus_or_a_klein_bottle() {
    let rim: Vec<_> = (0..5).map(|i| glam::DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect();
    for is_reversed in [false, true] {
        let (mut mesh, _) = primitive::cylinder(&rim, &rim, 3).unwrap();
        let [kept, mut gone] = <[_; 2]>::try_from(boundary_loops(&mesh)).unwrap();
        // Both loops have the surface to their left: laid on one another as they run, the sides clash.
        if !is_reversed {
            gone.reverse();
        }
        let seam = Seam { kept, gone, is_closed: true };
        let made = mesh.make_room(&seam).unwrap();
        assert!(made.is_empty(), "four rows of triangles are room enough");
        mesh.glue(&seam);
        assert_eq!(validate(&mesh), Ok(()));
        assert_eq!(summary(&mesh).kind(), (0, 0, 1, !is_reversed));
    }
}

#[test]
fn two_triangles_are_glued_to_a_sphere_if_room_is_made() {
    let mut mesh = Mesh::from_triangles(6, &[[0, 1, 2], [3, 4, 5]]).unwrap();
    let seam = Seam { kept: vec![v(0), v(1), v(2)], gone: vec![v(3), v(4), v(5)], is_closed: true };
    assert!(matches!(mesh.can_glue(&seam), Err(GlueError::SecondFace(..))));
    assert_eq!(mesh.make_room(&seam).unwrap().len(), 1);
    mesh.glue(&seam);
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh).kind(), (2, 0, 1, true));
}

#[test]
fn boundaries_of_unlike_lengths_are_evened_out_and_glued() {
    let rim = |n: i32| -> Vec<_> {
        (0..n).map(|i| glam::DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect()
    };
    let (mut mesh, _) = primitive::cylinder(&rim(5), &rim(8), 2).unwrap();
    let [mut kept, mut gone] = <[_; 2]>::try_from(boundary_loops(&mesh)).unwrap();
    gone.reverse();
    let refused = mesh.can_glue(&Seam { kept: kept.clone(), gone: gone.clone(), is_closed: true });
    assert_eq!(refused, Err(GlueError::Unlike(kept.len(), gone.len())));
    // A loop is a stretch that comes back to its first vertex.
    let (long, short) =
        if kept.len() > gone.len() { (kept.len(), &mut gone) } else { (gone.len(), &mut kept) };
    short.push(short[0]);
    let made = mesh.even_out(short, long + 1);
    assert_eq!(made.len(), 3);
    assert!(made.iter().all(|&(_, _, place)| place > 0.0 && place < 1.0));
    short.pop();
    let seam = Seam { kept, gone, is_closed: true };
    mesh.make_room(&seam).unwrap();
    mesh.glue(&seam);
    assert_eq!(validate(&mesh), Ok(()));
    assert_eq!(summary(&mesh).kind(), (0, 0, 1, true));
}

#[test]
fn nonsense_is_refused_with_its_reason() {
    let (mesh, _) = primitive::moebius(7, 2, 2.0, 1.0);
    let rim = boundary_loops(&mesh).remove(0);
    let edge = mesh.edge_between(rim[0], rim[1]).unwrap();
    assert_eq!(mesh.can_cut(&[edge]), Err(CutError::OnBoundary(edge)));
    let nowhere = EdgeId::from_index(9_999);
    assert_eq!(mesh.can_cut(&[nowhere]), Err(CutError::NoEdge(nowhere)));
    let seam = |kept: &[VertexId], gone: &[VertexId]| Seam {
        kept: kept.into(),
        gone: gone.into(),
        is_closed: false,
    };
    assert_eq!(mesh.can_glue(&seam(&rim[..2], &rim[..3])), Err(GlueError::Unlike(2, 3)));
    assert_eq!(mesh.can_glue(&seam(&rim[..1], &rim[3..4])), Err(GlueError::TooShort(1)));
    assert_eq!(mesh.can_glue(&seam(&rim[..3], &rim[2..5])), Err(GlueError::Repeated(rim[2])));
    let inner = mesh.vertices().find(|&v| !mesh.is_boundary_vertex(v)).unwrap();
    assert_eq!(
        mesh.can_glue(&seam(&[rim[0], inner], &[rim[5], rim[6]])),
        Err(GlueError::NotOnBoundary(rim[0], inner))
    );
    let gone = v(9_999);
    assert_eq!(mesh.can_glue(&seam(&[rim[0], gone], &rim[5..7])), Err(GlueError::NotOnBoundary(gone, gone)));
}

/// What a random cut or glue did to the Euler characteristic, as it promises; none where it was refused.
fn operate(mesh: &mut Mesh, kind: u8, picks: &[u32]) -> Option<i64> {
    let pick = |k: usize| picks[k % picks.len()] as usize;
    if kind == 0 {
        // A walk, often closed, often crossing itself.
        let vertices: Vec<_> = mesh.vertices().collect();
        let mut at = vertices[pick(0) % vertices.len()];
        let mut edges = Vec::new();
        for k in 1..picks.len() {
            let around: Vec<_> = mesh.spokes(at).collect();
            let e = around[pick(k) % around.len()];
            at = mesh.other_end(e, at);
            edges.push(e);
        }
        edges.retain(|&e| !mesh.is_boundary_edge(e));
        edges.sort_unstable();
        edges.dedup();
        mesh.can_cut(&edges).ok()?;
        let cut = mesh.cut(&edges);
        assert_eq!(cut.edges.len(), edges.len());
        return Some(i64::try_from(cut.vertices.len()).unwrap() - i64::try_from(edges.len()).unwrap());
    }
    let loops = boundary_loops(mesh);
    if loops.is_empty() {
        return None;
    }
    let (one, other) = (&loops[pick(0) % loops.len()], &loops[pick(1) % loops.len()]);
    let is_closed = pick(2) % 2 == 0 && one != other && one.len() == other.len();
    let length = if is_closed { one.len() } else { 2 + pick(3) % one.len().min(other.len()) };
    let stretch = |rim: &[VertexId], from: usize, back: bool| -> Vec<VertexId> {
        let n = rim.len();
        (0..length).map(|k| rim[(from + if back { n * length - k } else { k }) % n]).collect()
    };
    let from = pick(4);
    // Often from a common end, as when a slit is sewn up.
    let to = if pick(5) % 3 == 0 && one == other { from } else { pick(5) };
    let seam =
        Seam { kept: stretch(one, from, false), gone: stretch(other, to, pick(6) % 4 != 0), is_closed };
    let before = mesh.clone();
    match mesh.make_room(&seam) {
        Err(_) => {
            assert_eq!(mesh.to_triangles(), before.to_triangles(), "a refusal changes nothing");
            None
        }
        Ok(_) => {
            assert_eq!(euler_characteristic(mesh), euler_characteristic(&before), "room is made by splits");
            mesh.glue(&seam);
            let edges = if is_closed { length } else { length - 1 };
            let gone = seam.kept.iter().zip(&seam.gone).filter(|(kept, gone)| kept != gone).count();
            Some(i64::try_from(edges).unwrap() - i64::try_from(gone).unwrap())
        }
    }
}

proptest! {
    #![proptest_config(cases(512, 24))]

    #[test]
    fn cuts_and_glue_do_to_the_surface_what_they_promise(
        acts in prop::collection::vec((0_u8..2, prop::collection::vec(any::<u32>(), 7..12)), 1..24),
        curve in prop::collection::vec(any::<u32>(), 1..6),
    ) {
        for (name, mut mesh) in family() {
            let steps: Vec<_> = curve.iter().map(|&step| step as usize).collect();
            draw_curve(&mut mesh, steps[0], &steps, 3);
            for (kind, picks) in &acts {
                let before = mesh.clone();
                let promised = operate(&mut mesh, *kind, picks);
                prop_assert_eq!(validate(&mesh), Ok(()), "{} {} {:?}", name, kind, picks);
                let change = euler_characteristic(&mesh) - euler_characteristic(&before);
                prop_assert_eq!(change, promised.unwrap_or(0), "{} {} {:?}", name, kind, picks);
                if promised.is_none() {
                    prop_assert_eq!(mesh.to_triangles(), before.to_triangles(), "a refused act changes nothing");
                }
            }
        }
    }
}
