//! What a region has of its own: written under the name of the piece that was pointed at, and kept right when controls go.

use crate::error::ModelError;
use crate::model::Model;
use crate::region;
use ductile_mesh::{FaceId, regions};
use ductile_spec::{CurveId, PointId, Region, SurfaceId};
use glam::DVec3;
use std::sync::Arc;

/// Changes what is said of the region nearest to a place. Returns whether there is one: a surface in one piece is its own
/// region, and so is a piece that no curve bounds.
pub(super) fn change(
    model: &mut Model,
    id: SurfaceId,
    at: DVec3,
    change: impl FnOnce(&mut Region),
) -> Result<bool, ModelError> {
    if !at.is_finite() {
        return Err(ModelError::BadPosition);
    }
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let face = region::nearest_face(shape, at).ok_or(ModelError::NoSurface(id))?;
    change_around(model, id, face, false, change)
}

/// The same for the region of a face. A surface in one piece has a name only if that is wanted.
pub(super) fn change_around(
    model: &mut Model,
    id: SurfaceId,
    face: FaceId,
    wants_whole: bool,
    change: impl FnOnce(&mut Region),
) -> Result<bool, ModelError> {
    let shape = Arc::clone(model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?);
    let labels = regions(&shape.mesh);
    let piece = labels.of(face);
    let is_whole = labels.count() < 2 && !wants_whole;
    let name = if is_whole { None } else { region::name_of(&shape, &labels, piece) };
    let Some((curve, from, side)) = name else { return Ok(false) };
    let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
    let mut own = Region { curve, from, side, objective: None, spacing: None, shadow: None };
    // The piece may have been spoken of under several names: what they said is gathered under one.
    surface.regions.retain(|region| {
        let place = region::own(&shape, &labels, core::slice::from_ref(region), |_| Some(()));
        let is_other = place[piece].is_none();
        if !is_other {
            own.objective = own.objective.or(region.objective);
            own.spacing = own.spacing.or(region.spacing);
            own.shadow = own.shadow.or(region.shadow);
        }
        is_other
    });
    change(&mut own);
    if !own.is_idle() {
        surface.regions.push(own);
    }
    Ok(true)
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
