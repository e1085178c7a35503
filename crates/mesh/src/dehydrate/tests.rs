use proptest::prelude::*;

use super::*;
use crate::family::{draw_curve, family, nature, tag_boundary};
use crate::property_test::cases;
use crate::{SourceTag, boundary_loops, measure, primitive, summary, validate};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn v(i: usize) -> VertexId {
    VertexId::from_index(i)
}

fn circle(n: u32) -> Vec<DVec3> {
    (0..n)
        .map(|i| {
            let t = core::f64::consts::TAU * f64::from(i) / f64::from(n);
            DVec3::new(libm::cos(t), libm::sin(t), 0.0)
        })
        .collect()
}

/// Dehydrates and checks what must hold for every mesh.
fn dried(mesh: &Mesh, positions: &[DVec3]) -> Dehydrated {
    let dry = dehydrate(mesh, positions);
    assert_eq!(validate(&dry.mesh), Ok(()));
    assert_eq!(summary(&dry.mesh).kind(), summary(mesh).kind());
    assert_eq!(crate::regions(&dry.mesh).count(), crate::regions(mesh).count());
    for old in mesh.vertices().filter(|&v| mesh.is_source_vertex(v)) {
        let new = dry.kept[old.index()].expect("control points stay");
        assert_eq!(dry.mesh.vertex_source(new), mesh.vertex_source(old));
    }
    assert_eq!(dry.kept.iter().flatten().count(), dry.mesh.vertex_count());
    assert_eq!(dry.carry(positions).len(), dry.mesh.vertex_count());
    let again = dehydrate(mesh, positions);
    assert_eq!((again.mesh.to_triangles(), again.kept), (dry.mesh.to_triangles(), dry.kept.clone()));
    dry
}

#[test]
fn a_sphere_dries_to_a_tetrahedron() {
    for rounds in 0..4 {
        let (mesh, positions) = primitive::icosphere(rounds);
        assert_eq!(dried(&mesh, &positions).mesh.vertex_count(), 4);
    }
}

#[test]
fn a_disc_with_three_control_points_dries_to_a_triangle() {
    let (mut mesh, positions) = primitive::sheet(&circle(24), 4).unwrap();
    for (tag, i) in [(0, 0), (1, 8), (2, 16)] {
        mesh.set_vertex_source(v(i), Some(SourceTag(tag)));
    }
    assert_eq!(dried(&mesh, &positions).mesh.face_count(), 1);
    let rim = measure::boundary_edge_loops(&mesh).concat();
    for (k, e) in rim.into_iter().enumerate() {
        mesh.set_edge_source(e, Some(SourceTag(u32::try_from(k / 8).unwrap())));
    }
    let dry = dried(&mesh, &positions);
    assert_eq!(dry.mesh.face_count(), 1);
    let tags: Vec<_> = dry.mesh.edges().filter_map(|e| dry.mesh.edge_source(e)).collect();
    assert_eq!(tags.len(), 3, "one edge per curve: {tags:?}");
    mesh.set_vertex_source(v(30), Some(SourceTag(9)));
    assert_eq!(dried(&mesh, &positions).mesh.face_count(), 3, "an inner control point makes three");
}

#[test]
fn a_disc_without_sources_keeps_a_boundary_of_three() {
    let (mesh, positions) = primitive::sheet(&circle(40), 6).unwrap();
    let dry = dried(&mesh, &positions);
    assert_eq!((dry.mesh.face_count(), boundary_loops(&dry.mesh)[0].len()), (1, 3));
}

#[test]
fn closed_curves_keep_three_vertices() {
    let (mut mesh, mut positions) = primitive::octahedron();
    for _ in 0..3 {
        (mesh, positions) = primitive::subdivided(&mesh, &positions);
    }
    let ring: Vec<_> = positions.iter().map(|p| p.z.abs() < 1e-9).collect();
    for e in mesh.edges().collect::<Vec<_>>() {
        if mesh.edge_vertices(e).iter().all(|v| ring[v.index()]) {
            mesh.set_edge_source(e, Some(SourceTag(5)));
        }
    }
    assert_eq!(crate::regions(&mesh).count(), 2, "the equator parts the sphere");
    let dry = dried(&mesh, &positions);
    assert_eq!(dry.mesh.edges().filter(|&e| dry.mesh.is_source_edge(e)).count(), 3);
    assert!(dry.mesh.vertex_count() <= 5, "{}", dry.mesh.vertex_count());
}

#[test]
fn other_surfaces_come_near_their_least_triangulations() {
    // Fewest vertices: torus 7, Klein bottle 8, Möbius strip 5, cylinder 6.
    let cylinder = primitive::cylinder(&circle(20), &circle(16), 3).unwrap();
    for ((mesh, positions), most) in [
        (primitive::torus(20, 12, 2.0, 1.0), 10),
        (primitive::klein_bottle(20, 12, 2.0, 1.0), 12),
        (primitive::moebius(20, 4, 2.0, 1.0), 9),
        (cylinder, 6),
    ] {
        let dry = dried(&mesh, &positions);
        assert!(dry.mesh.vertex_count() <= most, "{} > {most}", dry.mesh.vertex_count());
    }
}

#[test]
fn many_control_points_all_stay() {
    let (mut mesh, positions) = primitive::sheet(&circle(48), 8).unwrap();
    for i in (0..mesh.vertex_count()).step_by(5) {
        mesh.set_vertex_source(v(i), Some(SourceTag(u32::try_from(i).unwrap())));
    }
    let wanted = mesh.vertices().filter(|&v| mesh.is_source_vertex(v)).count();
    assert_eq!(dried(&mesh, &positions).mesh.vertex_count(), wanted);
}

proptest! {
    #![proptest_config(cases(48, 16))]

    #[test]
    fn drying_keeps_kind_points_curves_and_regions(
        curves in prop::collection::vec((any::<u32>(), prop::collection::vec(any::<u32>(), 1..6)), 0..4),
        boundary in any::<bool>(),
        seed in any::<u32>(),
    ) {
        for (name, mesh) in family() {
            // Curves need room: every triangle is cut into sixteen.
            let points = vec![DVec3::ZERO; mesh.vertex_slots()];
            let (finer, points) = primitive::subdivided(&mesh, &points);
            let (mut fine, points) = primitive::subdivided(&finer, &points);
            if boundary {
                tag_boundary(&mut fine);
            }
            for (tag, (from, steps)) in (0..).zip(&curves) {
                let steps: Vec<_> = steps.iter().map(|&s| s as usize).collect();
                draw_curve(&mut fine, *from as usize, &steps, tag);
            }
            let tossed: Vec<_> = (0..points.len())
                .map(|i| {
                    let x = f64::from(seed) + i as f64;
                    DVec3::new(libm::sin(x), libm::sin(3.0 * x), libm::cos(7.0 * x))
                })
                .collect();
            let dry = dried(&fine, &tossed);
            let mut before = nature(&fine);
            // Control points keep their tags under new names.
            for point in &mut before.points {
                point.0 = dry.kept[point.0.index()].unwrap();
            }
            prop_assert_eq!(nature(&dry.mesh), before, "{}", name);
            prop_assert!(dry.mesh.vertex_count() <= mesh.vertex_count() + 12 * curves.len() + 12, "{}", name);
        }
    }
}
