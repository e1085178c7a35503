//! `shift`: moves several control points by the same way, such as the corners of a face of a cage.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::kept_position;
use ductile_spec::PointId;
use glam::DVec3;
use std::collections::BTreeSet;

/// Moves points; a point that is named twice moves once. The shapes follow as they relax.
pub(crate) fn shift(model: &mut Model, points: &[PointId], by: DVec3) -> Result<(), ModelError> {
    if points.is_empty() {
        return Err(ModelError::NothingToShift);
    }
    let points: BTreeSet<PointId> = points.iter().copied().collect();
    let moved = |point: PointId| Ok((point, kept_position(model, model.point(point)? + by)?));
    let places = points.into_iter().map(moved).collect::<Result<Vec<_>, ModelError>>()?;
    model.document_mut().points.extend(places);
    Ok(())
}
