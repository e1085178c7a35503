//! `split-face`: divides a face of a cage between two of its corners, or into triangles round its centre.

use crate::error::ModelError;
use crate::model::Model;
use crate::patch::change;
use ductile_patch::cage::edit;
use ductile_spec::{PointId, SurfaceId};

/// Splits a face.
pub(crate) fn split_face(
    model: &mut Model,
    surface: SurfaceId,
    face: u32,
    between: Option<[PointId; 2]>,
) -> Result<(), ModelError> {
    change(model, surface, "Split face", |polygons| {
        let Some(corners) = between else { return Ok(edit::split_face_at_centre(&polygons.cage, face)) };
        let [from, to] = [polygons.index(corners[0])?, polygons.index(corners[1])?];
        Ok(edit::split_face(&polygons.cage, face, from, to))
    })
}
