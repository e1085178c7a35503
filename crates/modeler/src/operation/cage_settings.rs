//! `cage-settings`: how a surface over a cage is made.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::rim;
use crate::patch::caged;
use ductile_spec::{CageSettings, SurfaceId};

/// Makes a surface over a cage anew with other settings.
pub(crate) fn choose(
    model: &mut Model,
    surface: SurfaceId,
    settings: CageSettings,
) -> Result<(), ModelError> {
    caged(&model.document, surface, "Cage settings")?;
    if let Some(cage) = model.document_mut().cages.get_mut(&surface) {
        cage.settings = settings;
    }
    rim::free_lost(model.document_mut());
    model.document.validate()?;
    model.build_patch(surface)
}
