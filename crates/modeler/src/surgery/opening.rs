//! Opening: a surface is cut along edges, and some of its faces may be given up.

use crate::error::ModelError;
use crate::model::Model;
use crate::region;
use crate::shape::SurfaceShape;
use crate::surgery::runs::{Run, runs};
use ductile_mesh::{CutError, EdgeId, FaceId, Mesh, VertexId, regions};
use ductile_spec::{Border, CurveId, On, SurfaceId};
use glam::DVec3;

/// A surface that was cut: everything but the curves, which are runs now.
#[derive(Clone, Debug)]
pub(crate) struct Opening {
    /// Faces that were given up are still in it, as pieces of their own.
    pub(crate) mesh: Mesh,
    pub(crate) positions: Vec<DVec3>,
    pub(crate) wanted: Vec<f64>,
    pub(crate) runs: Vec<Run>,
    /// Vertices and the copies of them, in the order in which they were made.
    pub(crate) copies: Vec<(VertexId, VertexId)>,
    /// By face slot, whether it was given up.
    pub(crate) is_gone: Vec<bool>,
}

/// The region of a surface at a place: by face slot, whether it belongs to it.
pub(crate) fn region_at(model: &Model, on: On) -> Result<Vec<bool>, ModelError> {
    if !on.at.is_finite() {
        return Err(ModelError::BadPosition);
    }
    let shape = model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?;
    let labels = regions(&shape.mesh);
    let face = region::nearest_face(shape, on.at).ok_or(ModelError::NoSurface(on.surface))?;
    let mut is_in = vec![false; shape.mesh.face_slots()];
    for f in shape.mesh.faces() {
        is_in[f.index()] = labels.of(f) == labels.of(face);
    }
    Ok(is_in)
}

/// The edges between faces that are in and faces that are not.
pub(crate) fn edges_around(mesh: &Mesh, is_in: &[bool]) -> Vec<EdgeId> {
    let parts = |e: &EdgeId| match mesh.edge_faces(*e) {
        (f, Some(g)) => is_in[f.index()] != is_in[g.index()],
        _ => false,
    };
    mesh.edges().filter(parts).collect()
}

/// The surface and the edges that a border means.
pub(crate) fn border(model: &Model, border: Border) -> Result<(SurfaceId, Vec<EdgeId>), ModelError> {
    match border {
        Border::Region(on) => {
            let is_in = region_at(model, on)?;
            let shape = model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?;
            let edges = edges_around(&shape.mesh, &is_in);
            if edges.is_empty() {
                Err(ModelError::NothingAround(on.surface))
            } else {
                Ok((on.surface, edges))
            }
        }
        Border::Curve(curve) => along(model, curve),
    }
}

/// The surface inside which a curve lies, and the edges along it.
fn along(model: &Model, curve: CurveId) -> Result<(SurfaceId, Vec<EdgeId>), ModelError> {
    let closed = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?.closed;
    let mut bounds = None;
    for (id, shape) in &model.surfaces {
        // A surface may follow a curve more than once.
        let mut inside = Vec::new();
        for embedded in shape.embeddings.iter().filter(|e| e.curve == curve) {
            let mesh = &shape.mesh;
            let edges = edges_of(mesh, &embedded.vertices, closed)
                .ok_or(ModelError::TornOff { curve, surface: *id })?;
            inside.extend(edges.into_iter().filter(|e| !mesh.is_boundary_edge(*e)));
            bounds = Some(*id);
        }
        if !inside.is_empty() {
            return Ok((*id, inside));
        }
    }
    Err(bounds.map_or(ModelError::InNoSurface(curve), |surface| ModelError::OnRim { curve, surface }))
}

/// The edges along a chain of vertices.
pub(crate) fn edges_of(mesh: &Mesh, vertices: &[VertexId], is_closed: bool) -> Option<Vec<EdgeId>> {
    let count = vertices.len();
    let last = if is_closed { count } else { count.saturating_sub(1) };
    (0..last).map(|k| mesh.edge_between(vertices[k], vertices[(k + 1) % count])).collect()
}

/// Cuts a surface along edges and gives some of its faces up (by face slot).
pub(crate) fn open(
    model: &Model,
    id: SurfaceId,
    edges: &[EdgeId],
    is_gone: Option<Vec<bool>>,
) -> Result<Opening, ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let mut shape = SurfaceShape::clone(shape);
    let is_gone = is_gone.unwrap_or_else(|| vec![false; shape.mesh.face_slots()]);
    // The originals are to stay with what stays: the first edge decides.
    let stays = |e: &EdgeId| !is_gone[shape.mesh.edge_faces(*e).0.index()];
    let mut edges = edges.to_vec();
    edges.sort_by_key(|e| !stays(e));
    let mut lined = Vec::new();
    for embedded in &shape.embeddings {
        let closed = model.curves.get(&embedded.curve).is_some_and(|curve| curve.closed);
        let line = edges_of(&shape.mesh, &embedded.vertices, closed)
            .ok_or(ModelError::TornOff { curve: embedded.curve, surface: id })?;
        lined.push((closed, line));
    }
    match shape.mesh.can_cut(&edges) {
        Ok(()) => {}
        Err(CutError::LoneEdge(_)) => return Err(ModelError::ShortSlit(id)),
        Err(CutError::NoEdge(_) | CutError::OnBoundary(_)) => return Err(ModelError::NothingAround(id)),
    }
    let cut = shape.mesh.cut(&edges);
    shape.make_room();
    let mut origin: Vec<usize> = (0..shape.mesh.vertex_slots()).collect();
    for (v, copy) in &cut.vertices {
        origin[copy.index()] = v.index();
        shape.positions[copy.index()] = shape.positions[v.index()];
        if !shape.wanted.is_empty() {
            shape.wanted[copy.index()] = shape.wanted[v.index()];
        }
    }
    let mesh = &shape.mesh;
    let remains = |f: FaceId| !is_gone[f.index()];
    let is_there = |e: &EdgeId| {
        let (f, g) = mesh.edge_faces(*e);
        remains(f) || g.is_some_and(remains)
    };
    let mut found = Vec::new();
    for (embedded, (closed, line)) in shape.embeddings.iter().zip(&lined) {
        let banks: Vec<Vec<EdgeId>> = line
            .iter()
            .map(|e| {
                let copies = cut.edges.iter().filter(|(own, _)| own == e).map(|(_, copy)| *copy);
                core::iter::once(*e).chain(copies).filter(is_there).collect()
            })
            .collect();
        found.extend(runs(mesh, embedded, *closed, &banks, &|v| VertexId::from_index(origin[v.index()])));
    }
    let SurfaceShape { mesh, positions, wanted, .. } = shape;
    Ok(Opening { mesh, positions, wanted, runs: found, copies: cut.vertices, is_gone })
}
