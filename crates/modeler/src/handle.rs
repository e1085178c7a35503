//! Handles: the directions that a drag turns. Of a curve at a point, of a surface's plane there, of a ribbon (thesis sections
//! 2.5.3, 3.2 and 4.1).
//!
//! Of what a hand points at only the part counts that can be: a surface that follows a curve lies along it, so its normal and the
//! directions of its ribbon stay across the curve.

use crate::error::ModelError;
use crate::model::Model;
use crate::plane;
use ductile_spec::{Handle, PointId};
use glam::DVec3;

/// The point about which a handle turns, if there is such a handle. The direction of a curve may be free yet, those of a
/// surface must be prescribed.
pub(crate) fn foot(model: &Model, handle: Handle) -> Result<PointId, ModelError> {
    match handle {
        Handle::Tangent { curve, point } => {
            let through = model.document.curves.get(&curve).map(|curve| &curve.through);
            let is_on = through.ok_or(ModelError::NoCurve(curve))?.contains(&point);
            model.point(point).ok().filter(|_| is_on).ok_or(ModelError::NotOnCurve { curve, point })?;
            Ok(point)
        }
        Handle::Normal { surface, point } | Handle::Ribbon { surface, point, .. } => {
            model.document.surfaces.get(&surface).ok_or(ModelError::NoSurface(surface))?;
            direction(model, handle).ok_or(ModelError::NotPrescribed { surface, point })?;
            Ok(point)
        }
    }
}

/// The direction that a document prescribes, as far as it does.
pub(crate) fn direction(model: &Model, handle: Handle) -> Option<DVec3> {
    let document = &model.document;
    match handle {
        Handle::Tangent { curve, point } => document.curves.get(&curve)?.tangents.get(&point).copied(),
        Handle::Normal { surface, point } => document.surfaces.get(&surface)?.normals.get(&point).copied(),
        Handle::Ribbon { surface, curve, point } => {
            document.surfaces.get(&surface)?.ribbons.get(&curve)?.cross.get(&point).copied()
        }
    }
}

/// What of a unit direction can be prescribed, as a unit vector; none if it runs along the curve that it must lead away from.
pub(crate) fn possible(model: &Model, handle: Handle, unit: DVec3) -> Option<DVec3> {
    match handle {
        Handle::Tangent { .. } => Some(unit),
        Handle::Normal { surface, point } => {
            let embeddings = &model.surfaces.get(&surface)?.embeddings;
            let is_on = |curve| model.curves.get(&curve).is_some_and(|at| at.sample_of(point).is_some());
            let curve = embeddings.iter().map(|embedded| embedded.curve).find(|curve| is_on(*curve));
            curve.map_or(Some(unit), |curve| plane::across_at(model, curve, point, unit))
        }
        Handle::Ribbon { curve, point, .. } => plane::across_at(model, curve, point, unit),
    }
}

/// Prescribes a direction.
pub(crate) fn point_to(model: &mut Model, handle: Handle, direction: DVec3) {
    let document = model.document_mut();
    match handle {
        Handle::Tangent { curve, point } => {
            if let Some(curve) = document.curves.get_mut(&curve) {
                curve.tangents.insert(point, direction);
            }
        }
        Handle::Normal { surface, point } => {
            if let Some(surface) = document.surfaces.get_mut(&surface) {
                surface.normals.insert(point, direction);
            }
        }
        Handle::Ribbon { surface, curve, point } => {
            let surface = document.surfaces.get_mut(&surface);
            if let Some(ribbon) = surface.and_then(|surface| surface.ribbons.get_mut(&curve)) {
                ribbon.cross.insert(point, direction);
            }
        }
    }
}

/// The name of the act that a drag of a handle is.
pub(crate) fn act(handle: Handle) -> &'static str {
    match handle {
        Handle::Tangent { .. } => "Tangent",
        Handle::Normal { .. } => "Normal",
        Handle::Ribbon { .. } => "Ribbon",
    }
}
