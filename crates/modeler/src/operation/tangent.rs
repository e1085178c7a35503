//! `tangent`: the direction of a curve at one of its control points (thesis section 4.1, linear constraints).

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::rim;
use ductile_spec::{CurveId, PointId};
use glam::DVec3;

/// Prescribes a direction, in the curve's own sense, or sets it free; the curve relaxes from where it is.
pub(super) fn tangent(
    model: &mut Model,
    curve: CurveId,
    point: PointId,
    direction: Option<DVec3>,
) -> Result<(), ModelError> {
    model.point(point)?;
    rim::check_free(&model.document, curve, "its directions are those of the surface; move the cage")?;
    let tangents =
        &mut model.document_mut().curves.get_mut(&curve).ok_or(ModelError::NoCurve(curve))?.tangents;
    match direction {
        Some(direction) => drop(tangents.insert(point, direction)),
        None => drop(tangents.remove(&point)),
    }
    Ok(model.document.validate()?)
}
