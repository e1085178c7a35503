//! Regions: the pieces into which its curves cut a surface, and what each of them minimises.
//!
//! A document names a region by a stretch of a curve at its border and a side of it, for triangles come and go
//! ([`Region`]). Here the names are found again on the mesh.

use crate::shape::{EmbeddedCurve, SurfaceShape};
use ductile_mesh::{FaceId, Labels, Mesh, VertexId, regions};
use ductile_solver::Objectives;
use ductile_spec::{CurveId, Objective, PointId, Region, Side};
use glam::DVec3;

/// What a surface minimises, and in which of its regions something else.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Choice {
    pub(crate) of_surface: Objective,
    pub(crate) regions: Vec<Region>,
    /// Half the diagonal of the controls' box.
    pub(crate) radius: f64,
}

/// The solver's word for an objective.
pub(crate) fn solver_objective(objective: Objective) -> ductile_solver::Objective {
    match objective {
        Objective::ThinPlate => ductile_solver::Objective::ThinPlate,
        Objective::Fair => ductile_solver::Objective::Fair,
        Objective::Neutral => ductile_solver::Objective::Neutral,
        Objective::Membrane => ductile_solver::Objective::Membrane,
    }
}

/// The objectives for the triangles of a shape, in the order of its faces.
pub(crate) fn objectives(shape: &SurfaceShape, choice: &Choice) -> Objectives {
    if choice.regions.is_empty() {
        return Objectives::uniform(solver_objective(choice.of_surface), choice.radius);
    }
    let labels = regions(&shape.mesh);
    let own = own(shape, &labels, &choice.regions, |region| region.objective);
    let of = |f: FaceId| solver_objective(own[labels.of(f)].unwrap_or(choice.of_surface));
    Objectives::by_triangle(shape.mesh.faces().map(of).collect(), choice.radius)
}

/// What each piece has of its own; the first name of a piece that says something counts.
pub(crate) fn own<T: Clone>(
    shape: &SurfaceShape,
    labels: &Labels,
    regions: &[Region],
    said: impl Fn(&Region) -> Option<T>,
) -> Vec<Option<T>> {
    let mut own = vec![None; labels.count()];
    for region in regions {
        if let Some(said) = said(region)
            && let Some(face) = face_beside(shape, region.curve, region.from, region.side)
        {
            own[labels.of(face)].get_or_insert(said);
        }
    }
    own
}

/// A name for the piece of a face: a stretch of a curve at its border, and the side. None if no curve bounds it.
pub(crate) fn name_of(
    shape: &SurfaceShape,
    labels: &Labels,
    piece: usize,
) -> Option<(CurveId, PointId, Side)> {
    for embedded in &shape.embeddings {
        for from in starts(&shape.mesh, embedded) {
            for side in [Side::Left, Side::Right] {
                let face = face_beside(shape, embedded.curve, from, side);
                if face.is_some_and(|face| labels.of(face) == piece) {
                    return Some((embedded.curve, from, side));
                }
            }
        }
    }
    None
}

/// The face nearest to a place, by its middle.
pub(crate) fn nearest_face(shape: &SurfaceShape, at: DVec3) -> Option<FaceId> {
    let middle =
        |f| shape.mesh.face_vertices(f).map(|v| shape.positions[v.index()]).iter().sum::<DVec3>() / 3.0;
    let mut best: Option<(f64, FaceId)> = None;
    for face in shape.mesh.faces() {
        let distance = middle(face).distance_squared(at);
        if best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, face));
        }
    }
    best.map(|(_, face)| face)
}

/// The control points at which a stretch of an embedded curve may begin.
fn starts(mesh: &Mesh, embedded: &EmbeddedCurve) -> Vec<PointId> {
    let point = |v: &VertexId| mesh.vertex_source(*v).map(|tag| PointId(tag.0));
    embedded.vertices.iter().filter_map(point).collect()
}

/// The face beside the first edge of a stretch. A curve that a surface follows on two rims has one on each.
pub(crate) fn face_beside(shape: &SurfaceShape, curve: CurveId, from: PointId, side: Side) -> Option<FaceId> {
    let lines = shape.embeddings.iter().filter(|e| e.curve == curve);
    lines.into_iter().find_map(|embedded| face_beside_line(shape, embedded, from, side))
}

fn face_beside_line(
    shape: &SurfaceShape,
    embedded: &EmbeddedCurve,
    from: PointId,
    side: Side,
) -> Option<FaceId> {
    let mesh = &shape.mesh;
    let is_start = |v: &&VertexId| mesh.vertex_source(**v).is_some_and(|tag| tag.0 == from.0);
    let start = *embedded.vertices.iter().find(is_start)?;
    let place = embedded.vertices.iter().position(|v| *v == start)?;
    let next = *embedded.vertices.get(place + 1).or_else(|| embedded.vertices.first())?;
    let (f, g) = mesh.edge_faces(mesh.edge_between(start, next)?);
    let runs_along = |face: &FaceId| {
        let [a, b, c] = mesh.face_vertices(*face);
        [(a, b), (b, c), (c, a)].contains(&(start, next))
    };
    // Where both run the same way the surface has one side there, and the first face is its left.
    let mut faces = [Some(f), g].into_iter().flatten();
    match side {
        Side::Left => faces.find(runs_along),
        Side::Right => {
            let first_left = [Some(f), g].into_iter().flatten().find(runs_along);
            faces.find(|face| Some(*face) != first_left)
        }
    }
}
