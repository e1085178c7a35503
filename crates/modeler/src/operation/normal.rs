//! `normal`: the tangent plane of a surface at one of its control points (thesis section 3.2).

use super::ribbon::check_bends;
use crate::error::ModelError;
use crate::model::Model;
use crate::plane;
use ductile_spec::{PointId, SurfaceId};
use glam::DVec3;

/// Prescribes a normal, in either sense, or sets the plane free; the surface relaxes from where it is.
pub(super) fn normal(
    model: &mut Model,
    id: SurfaceId,
    point: PointId,
    normal: Option<DVec3>,
) -> Result<(), ModelError> {
    model.point(point)?;
    let normals = &mut model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?.normals;
    match normal {
        Some(normal) => drop(normals.insert(point, normal)),
        None => drop(normals.remove(&point)),
    }
    model.document.validate()?;
    let Some(normal) = normal else { return Ok(()) };
    check_bends(model, id)?;
    plane::check_normal(model, id, point, normal)
}
