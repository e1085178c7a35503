//! The family of test meshes, and what surgery must leave as it was.

use glam::DVec3;

use crate::{EdgeId, Mesh, SourceTag, Summary, VertexId, primitive, summary};

/// Every kind of surface: closed, bounded, with handles, one-sided, in several pieces, very small.
pub(crate) fn family() -> Vec<(&'static str, Mesh)> {
    let hexagon: Vec<_> = (0..6).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect();
    let pieces = [[0, 1, 2], [0, 2, 3], [4, 5, 6], [5, 6, 7], [4, 6, 7], [4, 5, 7]];
    vec![
        ("triangle", Mesh::from_triangles(3, &[[0, 1, 2]]).unwrap()),
        ("tetrahedron", primitive::tetrahedron().0),
        ("octahedron", primitive::octahedron().0),
        ("sheet", primitive::sheet(&hexagon, 2).unwrap().0),
        ("cylinder", primitive::cylinder(&hexagon, &hexagon[..4], 1).unwrap().0),
        ("torus", primitive::torus(5, 4, 2.0, 1.0).0),
        ("moebius", primitive::moebius(5, 1, 2.0, 1.0).0),
        ("broad moebius", primitive::moebius(7, 3, 2.0, 1.0).0),
        ("klein", primitive::klein_bottle(5, 5, 2.0, 1.0).0),
        ("pieces", Mesh::from_triangles(8, &pieces).unwrap()),
    ]
}

/// What must not change: the kind, the control points, the control curves (their ends and how often they
/// close), and the number of regions.
#[derive(Debug, PartialEq)]
pub(crate) struct Nature {
    pub(crate) kind: Summary,
    pub(crate) points: Vec<(VertexId, SourceTag)>,
    curves: Vec<(SourceTag, usize, i64)>,
    pub(crate) regions: usize,
}

pub(crate) fn nature(mesh: &Mesh) -> Nature {
    let mut kind = summary(mesh);
    (kind.vertices, kind.edges, kind.faces) = (0, 0, 0);
    let points = mesh.vertices().filter_map(|v| Some((v, mesh.vertex_source(v)?))).collect();
    let mut tags: Vec<_> = mesh.edges().filter_map(|e| mesh.edge_source(e)).collect();
    tags.sort_unstable();
    tags.dedup();
    let curves = tags
        .into_iter()
        .map(|tag| {
            let on = |e: &EdgeId| mesh.edge_source(*e) == Some(tag);
            let edges = mesh.edges().filter(on).count();
            let degrees: Vec<_> =
                mesh.vertices().map(|v| mesh.spokes(v).filter(on).count()).filter(|&n| n > 0).collect();
            let ends = degrees.iter().filter(|&&n| n == 1).count();
            (tag, ends, i64::try_from(degrees.len()).unwrap() - i64::try_from(edges).unwrap())
        })
        .collect();
    Nature { kind, points, curves, regions: crate::regions(mesh).count() }
}

/// Tags the edges along the given walk, and its ends as control points.
pub(crate) fn draw_curve(mesh: &mut Mesh, from: usize, steps: &[usize], tag: u32) {
    let vertices: Vec<_> = mesh.vertices().collect();
    let mut at = vertices[from % vertices.len()];
    mesh.set_vertex_source(at, Some(SourceTag(2 * tag)));
    let mut visited = vec![at];
    for &step in steps {
        let ahead: Vec<_> =
            mesh.neighbours(at).filter(|w| !visited.contains(w) && !mesh.is_on_source_curve(*w)).collect();
        let Some(&to) = ahead.get(step % ahead.len().max(1)) else { break };
        let e = mesh.edge_between(at, to).unwrap();
        mesh.set_edge_source(e, Some(SourceTag(tag)));
        at = to;
        visited.push(at);
    }
    mesh.set_vertex_source(at, Some(SourceTag(2 * tag + 1)));
}

/// Tags all boundary loops as closed curves without control points.
pub(crate) fn tag_boundary(mesh: &mut Mesh) {
    for (i, edges) in (100..).zip(crate::measure::boundary_edge_loops(mesh)) {
        edges.into_iter().for_each(|e| mesh.set_edge_source(e, Some(SourceTag(i))));
    }
}
