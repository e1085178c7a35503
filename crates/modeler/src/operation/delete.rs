//! `delete`: removes a point, a curve or a surface, and the points that only it used.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{forget_unused_points, is_unused, refresh_skeleton, region, release, ribbon, rim};
use crate::shape::{SurfaceShape, edit};
use ductile_spec::{CurveId, PointId, SkeletonVertex, SurfaceId};

/// Removes a control point; what hangs on it is released first.
pub(crate) fn point(model: &mut Model, id: PointId) -> Result<(), ModelError> {
    model.point(id)?;
    if is_unused(model, id) {
        model.document_mut().points.remove(&id);
        return Ok(());
    }
    release::release(model, id)
}

/// Removes a curve that bounds no surface; surfaces that it runs through are freed from it.
pub(crate) fn curve(model: &mut Model, id: CurveId) -> Result<(), ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?.clone();
    if let Some(surface) = model.document.fills_on(id).next() {
        return Err(ModelError::NeededByFill { surface, curve: id });
    }
    let surfaces: Vec<SurfaceId> = model.document.surfaces_on(id).collect();
    for surface in &surfaces {
        let shape = model.surfaces.get(surface).ok_or(ModelError::NoSurface(*surface))?;
        // Its ends may lie on a rim; it bounds the surface where it runs along one.
        let is_own = |e: &ductile_mesh::EdgeId| shape.mesh.edge_source(*e).is_some_and(|tag| tag.0 == id.0);
        if shape.mesh.edges().any(|e| is_own(&e) && shape.mesh.is_boundary_edge(e)) {
            return Err(ModelError::BoundsSurface { curve: id, surface: *surface });
        }
    }
    for surface in &surfaces {
        let revision = model.next_revision();
        let Some(shape) = model.surfaces.get_mut(surface).map(edit) else { continue };
        let tagged: Vec<_> =
            shape.mesh.edges().filter(|e| shape.mesh.edge_source(*e).is_some_and(|t| t.0 == id.0)).collect();
        for edge in tagged {
            shape.mesh.set_edge_source(edge, None);
        }
        for vertex in shape
            .embeddings
            .iter()
            .filter(|e| e.curve == id)
            .flat_map(|e| e.vertices.clone())
            .collect::<Vec<_>>()
        {
            // A curve beside the surface may share the point: that does not hold the surface.
            let shared = shape.embeddings.iter().any(|e| e.curve != id && e.vertices.contains(&vertex));
            if !shared {
                shape.mesh.set_vertex_source(vertex, None);
            }
        }
        shape.embeddings.retain(|e| e.curve != id);
        shape.revision = revision;
    }
    region::forget_curve(model, id);
    model.document_mut().curves.remove(&id);
    model.curves.remove(&id);
    for surface in surfaces {
        refresh_skeleton(model, surface);
    }
    drop_unused(model, curve.through);
    ribbon::forget_lost(model);
    model.document.validate()?;
    Ok(())
}

/// Removes a surface; its curves stay.
pub(crate) fn surface(model: &mut Model, id: SurfaceId) -> Result<(), ModelError> {
    ribbon::forget_onto(model, id);
    take_out(model, id)
}

/// Removes a surface with its displacements, but nothing that names it elsewhere.
pub(super) fn take_out(model: &mut Model, id: SurfaceId) -> Result<(), ModelError> {
    model.document_mut().displacements.remove(&id);
    if let Some(cage) = model.document_mut().cages.remove(&id) {
        model.patches.remove(&id);
        rim::free_lost(model.document_mut());
        drop_unused(model, cage.points());
        return Ok(());
    }
    let document = model.document_mut();
    if document.fills.remove(&id).is_some() || document.meshes.remove(&id).is_some() {
        model.patches.remove(&id);
        return Ok(());
    }
    let surface = model.document_mut().surfaces.remove(&id).ok_or(ModelError::NoSurface(id))?;
    model.surfaces.remove(&id);
    let points = surface.skeleton.vertices.into_iter().filter_map(|v| match v {
        SkeletonVertex::Control(point) => Some(point),
        SkeletonVertex::Free(_) => None,
    });
    drop_unused(model, points);
    Ok(())
}

/// Removes curves of a surface as it was that no surface follows any more, and the points that only they used.
pub(crate) fn forget_lost_curves(model: &mut Model, before: &SurfaceShape) {
    for embedded in &before.embeddings {
        let is_needed = model.document.surfaces_on(embedded.curve).next().is_some()
            || model.document.fills_on(embedded.curve).next().is_some();
        if !is_needed {
            model.document_mut().curves.remove(&embedded.curve);
            model.curves.remove(&embedded.curve);
        }
    }
    forget_unused_points(model, before);
}

/// Removes those of some points that nothing uses.
pub(crate) fn drop_unused(model: &mut Model, points: impl IntoIterator<Item = PointId>) {
    for point in points {
        if is_unused(model, point) {
            model.document_mut().points.remove(&point);
        }
    }
}
