//! `point` and `move`: control points in space.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::kept_position;
use ductile_spec::PointId;
use glam::DVec3;

/// Places a free control point.
pub(crate) fn place(model: &mut Model, at: DVec3) -> Result<PointId, ModelError> {
    let at = kept_position(model, at)?;
    let id = model.document.next_point();
    model.document_mut().points.insert(id, at);
    model.document.validate()?;
    Ok(id)
}

/// Moves a control point; the shapes follow as they relax.
pub(crate) fn shift(model: &mut Model, point: PointId, to: DVec3) -> Result<(), ModelError> {
    let to = kept_position(model, to)?;
    let at = model.document_mut().points.get_mut(&point).ok_or(ModelError::NoPoint(point))?;
    *at = to;
    Ok(())
}
