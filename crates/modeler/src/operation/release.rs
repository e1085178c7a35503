//! `release`: lets a control point go; the shape relaxes, the topology stays.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{is_unused, refresh_skeleton, region, ribbon};
use crate::shape::edit;
use ductile_mesh::{SourceTag, VertexId};
use ductile_spec::{CurveId, FillSide, PointId, SurfaceId};

/// Frees every curve and surface from a control point and removes it.
pub(crate) fn release(model: &mut Model, point: PointId) -> Result<(), ModelError> {
    model.point(point)?;
    if is_unused(model, point) {
        return Err(ModelError::NothingToRelease(point));
    }
    if let Some(surface) = model.document.cages_on(point).next() {
        return Err(ModelError::NeededByCage { surface, point });
    }
    let surfaces: Vec<_> = model.document.surfaces_through(point).collect();
    for id in &surfaces {
        if let Some(curve) = crossing(model, *id, point) {
            let why = "another curve of the surface crosses it there";
            return Err(ModelError::NeededByCurve { curve, point, why });
        }
    }
    for id in model.document.curves_through(point).collect::<Vec<_>>() {
        release_from_curve(model, id, point)?;
    }
    for id in &surfaces {
        let revision = model.next_revision();
        if let Some(shape) = model.surfaces.get_mut(id).map(edit) {
            shape.pins.retain(|pin| pin.point != point);
            let tagged: Vec<_> = shape
                .mesh
                .vertices()
                .filter(|v| shape.mesh.vertex_source(*v) == Some(SourceTag(point.0)))
                .collect();
            for vertex in tagged {
                shape.mesh.set_vertex_source(vertex, None);
            }
            shape.revision = revision;
        }
        refresh_skeleton(model, *id);
    }
    model.document_mut().points.remove(&point);
    ribbon::forget_lost(model);
    model.document.validate()?;
    Ok(())
}

/// A curve that another one crosses at a control point of a surface: a single vertex follows both, and without a control
/// in common they would pull it apart.
fn crossing(model: &Model, id: SurfaceId, point: PointId) -> Option<CurveId> {
    let shape = model.surfaces.get(&id)?;
    let is_there = |v: &VertexId| shape.mesh.vertex_source(*v) == Some(SourceTag(point.0));
    let mut met = Vec::new();
    for embedded in &shape.embeddings {
        let vertices = embedded.vertices.iter().filter(|v| is_there(v));
        for v in vertices {
            if met.contains(v) {
                return Some(embedded.curve);
            }
            met.push(*v);
        }
    }
    None
}

fn release_from_curve(model: &mut Model, id: CurveId, point: PointId) -> Result<(), ModelError> {
    let refuse = |why| Err(ModelError::NeededByCurve { curve: id, point, why });
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let is_end = curve.through.first() == Some(&point) || curve.through.last() == Some(&point);
    if !curve.closed && is_end {
        return refuse("an open curve ends at it");
    }
    if curve.closed && curve.through.len() <= 3 {
        return refuse("a closed curve needs three points");
    }
    let ends_there = |side: &FillSide| side.curve == id && (side.from == point || side.to == point);
    let filled = model.document.fills.iter().find(|(_, fill)| fill.sides.iter().any(ends_there));
    if let Some((surface, _)) = filled {
        return Err(ModelError::NeededByFill { surface: *surface, curve: id });
    }
    let place = curve.through.iter().position(|other| *other == point).unwrap_or(0);
    let before = curve.through[(place + curve.through.len() - 1) % curve.through.len()];
    region::forget_point(model, id, point, before);
    if let Some(curve) = model.document_mut().curves.get_mut(&id) {
        curve.through.retain(|other| *other != point);
        curve.tangents.remove(&point);
    }
    let revision = model.next_revision();
    if let Some(shape) = model.curves.get_mut(&id).map(edit) {
        shape.controls.retain(|(_, other)| *other != point);
        shape.revision = revision;
    }
    Ok(())
}
