//! Choosing how edge lengths vary: the document's own choice, or that of one surface.

use crate::error::ModelError;
use crate::model::Model;
use ductile_spec::{Density, SurfaceId};

/// Sets the choice; the meshes follow it from where they are.
pub(super) fn choose(
    model: &mut Model,
    of: Option<SurfaceId>,
    density: Option<Density>,
) -> Result<(), ModelError> {
    match of {
        None => model.document_mut().density = density.unwrap_or_default(),
        Some(id) => {
            let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
            surface.density = density;
        }
    }
    Ok(model.document.validate()?)
}
