//! Choosing what shapes minimise: the document's own choice, or that of one curve, surface or region.

use crate::error::ModelError;
use crate::model::Model;
use crate::region;
use ductile_mesh::regions;
use ductile_spec::{CurveId, Objective, ObjectiveOf, PointId, Region, SurfaceId};
use glam::DVec3;
use std::sync::Arc;

/// Sets the choice; the shapes keep their places and relax from there.
pub(super) fn choose(
    model: &mut Model,
    of: ObjectiveOf,
    objective: Option<Objective>,
) -> Result<(), ModelError> {
    match of {
        ObjectiveOf::Document => model.document_mut().objective = objective.unwrap_or_default(),
        ObjectiveOf::Curve(id) => {
            let curve = model.document_mut().curves.get_mut(&id).ok_or(ModelError::NoCurve(id))?;
            curve.objective = objective;
        }
        ObjectiveOf::Surface(id) => of_surface(model, id, objective)?,
        ObjectiveOf::Region { surface, at } => of_region(model, surface, at, objective)?,
    }
    Ok(model.document.validate()?)
}

fn of_surface(model: &mut Model, id: SurfaceId, objective: Option<Objective>) -> Result<(), ModelError> {
    let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
    surface.objective = objective;
    Ok(())
}

fn of_region(
    model: &mut Model,
    id: SurfaceId,
    at: DVec3,
    objective: Option<Objective>,
) -> Result<(), ModelError> {
    if !at.is_finite() {
        return Err(ModelError::BadPosition);
    }
    let shape = Arc::clone(model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?);
    let labels = regions(&shape.mesh);
    let face = region::nearest_face(&shape, at).ok_or(ModelError::NoSurface(id))?;
    let piece = labels.of(face);
    let name = (labels.count() > 1).then(|| region::name_of(&shape, &labels, piece)).flatten();
    // A surface in one piece is its own region; so is a piece that no curve bounds.
    let Some((curve, from, side)) = name else { return of_surface(model, id, objective) };
    let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
    surface.regions.retain(|region| {
        let own = region::own_objectives(&shape, &labels, core::slice::from_ref(region));
        own[piece].is_none()
    });
    if let Some(objective) = objective {
        surface.regions.push(Region { curve, from, side, objective });
    }
    Ok(())
}

/// Keeps the names of regions right when a control point leaves a curve: its stretch becomes part of the one before.
pub(super) fn forget_point(model: &mut Model, id: CurveId, point: PointId, before: PointId) {
    for surface in model.document_mut().surfaces.values_mut() {
        let others = surface.regions.clone();
        surface.regions.retain_mut(|region| {
            if region.curve != id || region.from != point {
                return true;
            }
            region.from = before;
            !others.iter().any(|o| o.curve == id && o.from == before && o.side == region.side)
        });
    }
}

/// The same when a whole curve goes.
pub(super) fn forget_curve(model: &mut Model, id: CurveId) {
    for surface in model.document_mut().surfaces.values_mut() {
        surface.regions.retain(|region| region.curve != id);
    }
}
