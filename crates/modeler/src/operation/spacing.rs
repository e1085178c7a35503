//! The target edge length of the document, of a surface, or of a region of one.

use crate::error::ModelError;
use crate::model::Model;
use ductile_spec::SpacingOf;

/// Sets it and builds everything anew.
pub(super) fn respace(model: &mut Model, of: SpacingOf, spacing: Option<f64>) -> Result<(), ModelError> {
    match of {
        SpacingOf::Document => model.document_mut().spacing = spacing,
        SpacingOf::Surface(id) => {
            let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
            surface.spacing = spacing;
        }
        SpacingOf::Region { surface, at } => {
            if !super::region::change(model, surface, at, |region| region.spacing = spacing)? {
                return respace(model, SpacingOf::Surface(surface), spacing);
            }
        }
    }
    let mut fresh = Model::from_document((*model.document).clone())?;
    fresh.continue_revisions(model);
    fresh.renew_revisions();
    *model = fresh;
    Ok(())
}
