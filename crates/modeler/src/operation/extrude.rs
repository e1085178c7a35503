//! `extrude`: a face of a cage moves out along its normal, with a wall of quads around it.

use crate::error::ModelError;
use crate::model::Model;
use crate::patch::change;
use ductile_patch::cage::edit;
use ductile_spec::{MAX_COORDINATE, SurfaceId};

/// Extrudes a face.
pub(crate) fn extrude(
    model: &mut Model,
    surface: SurfaceId,
    face: u32,
    distance: f64,
) -> Result<(), ModelError> {
    if !(distance.is_finite() && distance.abs() <= MAX_COORDINATE && distance != 0.0) {
        return Err(ModelError::BadDistance);
    }
    change(model, surface, "Extrude", |polygons| Ok(edit::extrude_face(&polygons.cage, face, distance)))
}
