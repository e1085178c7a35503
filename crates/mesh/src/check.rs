//! The sharp eye: what, if anything, is wrong with a mesh.
//!
//! [`validate`] trusts nothing but the lengths of the arrays. It is meant for tests, after every surgery,
//! and for documents that come from elsewhere.

use thiserror::Error;

use crate::topology::NONE;
use crate::{EdgeId, FaceId, HalfedgeId, Mesh, VertexId};

/// One thing wrong with a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Defect {
    /// Arrays that belong together have different lengths.
    #[error("arrays of {0} differ in length")]
    Lengths(&'static str),
    /// A face names a dead or missing vertex, or one vertex twice.
    #[error("{0:?} has bad corners")]
    BadCorner(FaceId),
    /// A side names a dead or missing edge.
    #[error("{0:?} names a bad edge")]
    BadEdge(HalfedgeId),
    /// The twin of the twin is someone else, is dead, or is the side itself.
    #[error("the twin of {0:?} does not answer")]
    BadTwin(HalfedgeId),
    /// Twins join different vertices or name different edges.
    #[error("{0:?} and its twin disagree about their edge")]
    TwinsDisagree(HalfedgeId),
    /// The edge points to a side that does not point back, or too many or few sides name it.
    #[error("{0:?} and its sides disagree")]
    BadEdgeSide(EdgeId),
    /// The same two vertices are joined twice.
    #[error("{0:?} and {1:?} join the same vertices")]
    SecondEdge(EdgeId, EdgeId),
    /// Two faces have the same corners.
    #[error("{0:?} and {1:?} have the same corners")]
    SecondFace(FaceId, FaceId),
    /// The anchor does not start at its vertex.
    #[error("the anchor of {0:?} does not start there")]
    BadAnchor(VertexId),
    /// The faces around the vertex are neither one disc nor one half-disc.
    #[error("the faces around {0:?} form more than one fan")]
    BadLink(VertexId),
    /// A living element that nothing uses, or a dead slot missing from its free list (or listed twice).
    #[error("the free list of {0} is wrong")]
    BadFreeList(&'static str),
    /// A dead slot still carries a source tag.
    #[error("a dead slot of {0} carries a source tag")]
    TagOnDead(&'static str),
    /// A control curve ends at a vertex that is no control point, so its edges are not contiguous.
    #[error("a control curve stops at {0:?}, which is no control point")]
    DanglingCurve(VertexId),
}

/// Whether `mesh` keeps all its invariants.
///
/// # Errors
/// Everything that is wrong, in order: arrays, faces, edges, vertices.
pub fn validate(mesh: &Mesh) -> Result<(), Vec<Defect>> {
    let mut defects = Vec::new();
    check_arrays(mesh, &mut defects);
    if defects.is_empty() {
        check_faces(mesh, &mut defects);
        check_edges(mesh, &mut defects);
    }
    if defects.is_empty() {
        check_vertices(mesh, &mut defects);
        check_duplicates(mesh, &mut defects);
    }
    if defects.is_empty() { Ok(()) } else { Err(defects) }
}

/// [`validate`], and moreover every control curve ends at control points (or is closed).
///
/// # Errors
/// As [`validate`], and [`Defect::DanglingCurve`].
pub fn validate_curves(mesh: &Mesh) -> Result<(), Vec<Defect>> {
    validate(mesh)?;
    let dangling: Vec<_> = mesh
        .vertices()
        .filter(|&v| !mesh.is_source_vertex(v))
        .filter(|&v| {
            let mut tags: Vec<_> = mesh.spokes(v).filter_map(|e| mesh.edge_source(e)).collect();
            tags.sort_unstable();
            tags.chunk_by(|a, b| a == b).any(|run| run.len() == 1)
        })
        .map(Defect::DanglingCurve)
        .collect();
    if dangling.is_empty() { Ok(()) } else { Err(dangling) }
}

fn check_arrays(mesh: &Mesh, defects: &mut Vec<Defect>) {
    let sides = mesh.corner.len();
    let same = |ok: bool, what, defects: &mut Vec<Defect>| {
        if !ok {
            defects.push(Defect::Lengths(what));
        }
    };
    same(sides.is_multiple_of(3) && mesh.twin.len() == sides && mesh.edge.len() == sides, "faces", defects);
    same(mesh.edge_side.len() == mesh.edge_source.len(), "edges", defects);
    same(mesh.anchor.len() == mesh.vertex_source.len(), "vertices", defects);
    check_free(&mesh.anchor, &mesh.free_vertices, "vertices", defects);
    check_free(&mesh.edge_side, &mesh.free_edges, "edges", defects);
    let heads: Vec<u32> = mesh.corner.iter().step_by(3).copied().collect();
    check_free(&heads, &mesh.free_faces, "faces", defects);
    let tagged = |head: &[u32], tags: &[Option<crate::SourceTag>]| {
        head.iter().zip(tags).any(|(&h, tag)| h == NONE && tag.is_some())
    };
    if tagged(&mesh.anchor, &mesh.vertex_source) {
        defects.push(Defect::TagOnDead("vertices"));
    }
    if tagged(&mesh.edge_side, &mesh.edge_source) {
        defects.push(Defect::TagOnDead("edges"));
    }
}

/// The free list must name every dead slot exactly once.
fn check_free(heads: &[u32], free: &[u32], what: &'static str, defects: &mut Vec<Defect>) {
    let mut listed = free.to_vec();
    listed.sort_unstable();
    let dead = (0..).zip(heads).filter(|&(_, &head)| head == NONE).map(|(i, _)| i);
    if !dead.eq(listed.iter().copied()) {
        defects.push(Defect::BadFreeList(what));
    }
}

fn check_faces(mesh: &Mesh, defects: &mut Vec<Defect>) {
    for f in mesh.faces() {
        let corners = f.halfedges().map(|h| VertexId(mesh.corner[h.index()]));
        let [a, b, c] = corners;
        if a == b || b == c || a == c || corners.iter().any(|&v| !mesh.has_vertex(v)) {
            defects.push(Defect::BadCorner(f));
            continue;
        }
        for h in f.halfedges() {
            if !mesh.has_edge(EdgeId(mesh.edge[h.index()])) {
                defects.push(Defect::BadEdge(h));
            }
            let t = mesh.twin[h.index()];
            if t == NONE {
                continue;
            }
            let t = HalfedgeId(t);
            if t == h || !mesh.has_face(t.face()) || mesh.twin[t.index()] != h.0 {
                defects.push(Defect::BadTwin(h));
                continue;
            }
            let ends = |h| {
                let (a, b) = (mesh.origin(h), mesh.target(h));
                (a.min(b), a.max(b))
            };
            if ends(h) != ends(t) || mesh.edge[h.index()] != mesh.edge[t.index()] {
                defects.push(Defect::TwinsDisagree(h));
            }
        }
    }
}

fn check_edges(mesh: &Mesh, defects: &mut Vec<Defect>) {
    let mut sides = vec![0_usize; mesh.edge_slots()];
    for f in mesh.faces() {
        for h in f.halfedges() {
            if let Some(n) = sides.get_mut(mesh.edge[h.index()] as usize) {
                *n += 1;
            }
        }
    }
    for e in mesh.edges() {
        let h = HalfedgeId(mesh.edge_side[e.index()]);
        let is_answered = mesh.has_face(h.face()) && mesh.edge[h.index()] == e.0;
        if !is_answered || sides[e.index()] != 1 + usize::from(mesh.twin[h.index()] != NONE) {
            defects.push(Defect::BadEdgeSide(e));
        }
    }
}

fn check_vertices(mesh: &Mesh, defects: &mut Vec<Defect>) {
    let mut corners = vec![0_usize; mesh.vertex_slots()];
    for f in mesh.faces() {
        for v in mesh.face_vertices(f) {
            corners[v.index()] += 1;
        }
    }
    for v in mesh.vertices() {
        let h = HalfedgeId(mesh.anchor[v.index()]);
        if !mesh.has_face(h.face()) || mesh.origin(h) != v {
            defects.push(Defect::BadAnchor(v));
        } else if mesh.wedges(v).count() != corners[v.index()] {
            defects.push(Defect::BadLink(v));
        }
    }
}

fn check_duplicates(mesh: &Mesh, defects: &mut Vec<Defect>) {
    let mut edges: Vec<_> = mesh
        .edges()
        .map(|e| {
            let [a, b] = mesh.edge_vertices(e);
            (a.min(b), a.max(b), e)
        })
        .collect();
    edges.sort_unstable();
    for pair in edges.windows(2) {
        if (pair[0].0, pair[0].1) == (pair[1].0, pair[1].1) {
            defects.push(Defect::SecondEdge(pair[0].2, pair[1].2));
        }
    }
    let mut faces: Vec<_> = mesh
        .faces()
        .map(|f| {
            let mut corners = mesh.face_vertices(f);
            corners.sort_unstable();
            (corners, f)
        })
        .collect();
    faces.sort_unstable();
    for pair in faces.windows(2) {
        if pair[0].0 == pair[1].0 {
            defects.push(Defect::SecondFace(pair[0].1, pair[1].1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::SourceTag;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn strip() -> Mesh {
        Mesh::from_triangles(5, &[[0, 1, 2], [2, 1, 3], [2, 3, 4]]).unwrap()
    }

    fn defects(mesh: &Mesh) -> Vec<Defect> {
        validate(mesh).unwrap_err()
    }

    #[test]
    fn a_sound_mesh_passes() {
        assert_eq!(validate(&strip()), Ok(()));
        assert_eq!(validate(&Mesh::default()), Ok(()));
    }

    #[test]
    fn each_injury_is_found() {
        let mut mesh = strip();
        let h = mesh.halfedge_of(EdgeId(1));
        mesh.twin[h.index()] = NONE;
        assert!(defects(&mesh).iter().any(|d| matches!(d, Defect::BadTwin(_))));
        let mut mesh = strip();
        mesh.anchor[0] = 4;
        assert_eq!(defects(&mesh), [Defect::BadAnchor(VertexId(0))]);
        let mut mesh = strip();
        mesh.free_edges.push(3);
        assert_eq!(defects(&mesh), [Defect::BadFreeList("edges")]);
        let mut mesh = strip();
        mesh.edge[0] = 6;
        assert!(defects(&mesh).iter().any(|d| matches!(d, Defect::BadEdgeSide(_))));
        let mut mesh = strip();
        mesh.corner[0] = 2;
        assert_eq!(defects(&mesh)[0], Defect::BadCorner(FaceId(0)));
        let mut mesh = strip();
        mesh.edge_source.pop();
        assert_eq!(defects(&mesh), [Defect::Lengths("edges")]);
    }

    #[test]
    fn a_vertex_in_two_pieces_is_found() {
        let mut mesh = Mesh::from_triangles(6, &[[0, 1, 2], [3, 4, 5]]).unwrap();
        mesh.corner[3] = 0;
        mesh.free_vertices.push(3);
        mesh.anchor[3] = NONE;
        assert_eq!(defects(&mesh), [Defect::BadLink(VertexId(0))]);
    }

    #[test]
    fn a_curve_must_end_at_control_points() {
        let mut mesh = strip();
        let (a, b) = (VertexId(0), VertexId(1));
        let e = mesh.edge_between(a, b).unwrap();
        mesh.set_edge_source(e, Some(SourceTag(1)));
        mesh.set_vertex_source(a, Some(SourceTag(0)));
        assert_eq!(validate_curves(&mesh).unwrap_err(), [Defect::DanglingCurve(b)]);
        mesh.set_vertex_source(b, Some(SourceTag(0)));
        assert_eq!(validate_curves(&mesh), Ok(()));
    }
}
