//! `delete-face`: takes a face out of a cage, which leaves a hole, and the points that only it used.

use crate::error::ModelError;
use crate::model::Model;
use crate::patch::change;
use ductile_patch::cage::edit;
use ductile_spec::SurfaceId;

/// Deletes a face.
pub(crate) fn delete_face(model: &mut Model, surface: SurfaceId, face: u32) -> Result<(), ModelError> {
    change(model, surface, "Delete face", |polygons| Ok(edit::delete_face(&polygons.cage, face)))
}
