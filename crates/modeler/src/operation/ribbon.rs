//! `ribbon`: how a surface leaves one of its curves (thesis sections 2.5.3 and 5.5).

use crate::error::ModelError;
use crate::model::{Model, round_to_digits};
use crate::patch::PatchRim;
use crate::plane;
use crate::relax::Relaxer;
use ductile_spec::{CurveId, Leave, Objective, PointId, Ribbon, SkeletonVertex, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;

/// Digits of a direction: an angle is kept to less than a millionth of a radian.
const DIRECTION_DIGITS: usize = 8;

/// Prescribes how a surface leaves a curve, or sets it free; the surface relaxes from where it is.
pub(super) fn ribbon(
    model: &mut Model,
    relaxer: &Relaxer,
    id: SurfaceId,
    curve: CurveId,
    leave: Option<&Leave>,
) -> Result<(), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let ribbon = match leave {
        None => None,
        Some(Leave::Cross(cross)) => Some(Ribbon::directed(cross.clone())),
        Some(Leave::Onto(other)) => {
            let patch = model.patches.get(other).ok_or(ModelError::NoPatch(*other))?;
            let along = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
            if !PatchRim::new(patch).is_at(&along.nodes) {
                return Err(ModelError::NotAtRim { curve, surface: *other });
            }
            Some(Ribbon { onto: Some(*other), ..Ribbon::default() })
        }
        Some(Leave::Angle(angle)) => {
            if angle.is_nan() || angle.abs() > core::f64::consts::PI {
                return Err(ModelError::BadAngle);
            }
            let bound = relaxer.surface(id, shape).ok_or(ModelError::NoSurface(id))?;
            Some(Ribbon::directed(kept(bound.planes(model, shape).leaving(id, curve, *angle)?)))
        }
        Some(Leave::Now) => {
            let bound = relaxer.surface(id, shape).ok_or(ModelError::NoSurface(id))?;
            let mut cross = kept(bound.planes(model, shape).left_now(id, curve)?);
            let given = model.document.surfaces.get(&id).and_then(|surface| surface.ribbons.get(&curve));
            cross.extend(given.into_iter().flat_map(|ribbon| &ribbon.cross));
            Some(Ribbon::directed(cross))
        }
    };
    let ribbons = &mut model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?.ribbons;
    let Some(ribbon) = ribbon else {
        ribbons.remove(&curve);
        return Ok(model.document.validate()?);
    };
    ribbons.insert(curve, ribbon.clone());
    model.document.validate()?;
    check_bends(model, id)?;
    plane::check_cross(model, id, curve, &ribbon)
}

/// The direction that a document keeps for a unit vector that was reckoned.
pub(crate) fn kept_direction(direction: DVec3) -> DVec3 {
    let kept = |x: f64| round_to_digits(x, DIRECTION_DIGITS) + 0.0;
    // Noise of a sine is no digit.
    DVec3::from_array(direction.to_array().map(|x| if x.abs() < 1e-12 { 0.0 } else { kept(x) }))
}

/// As [`kept_direction`], for each point.
fn kept(mut cross: BTreeMap<PointId, DVec3>) -> BTreeMap<PointId, DVec3> {
    cross.values_mut().for_each(|at| *at = kept_direction(*at));
    cross
}

/// Refuses a plane for a surface that has no bending to hold it with.
pub(super) fn check_bends(model: &Model, id: SurfaceId) -> Result<(), ModelError> {
    let is_film = model.document.objective_of_surface(id) == Objective::Membrane;
    let has_regions = model.document.surfaces.get(&id).is_some_and(|surface| !surface.regions.is_empty());
    if is_film && !has_regions { Err(ModelError::MembraneHasNoPlane(id)) } else { Ok(()) }
}

/// Forgets what was prescribed where surfaces have no controls any more.
pub(crate) fn forget_lost(model: &mut Model) {
    let document = model.document_mut();
    let curves = &document.curves;
    for surface in document.surfaces.values_mut() {
        let skeleton = &surface.skeleton;
        surface.normals.retain(|point, _| skeleton.vertices.contains(&SkeletonVertex::Control(*point)));
        surface.ribbons.retain(|id, ribbon| {
            let curve = curves.get(id).filter(|_| skeleton.curves.iter().any(|e| e.curve == *id));
            ribbon.cross.retain(|point, _| curve.is_some_and(|curve| curve.through.contains(point)));
            !ribbon.cross.is_empty() || ribbon.onto.is_some()
        });
    }
}

/// Forgets the ribbons that go on from a surface that is no more.
pub(super) fn forget_onto(model: &mut Model, patch: SurfaceId) {
    for surface in model.document_mut().surfaces.values_mut() {
        surface.ribbons.retain(|_, ribbon| ribbon.onto != Some(patch));
    }
}
