//! Choosing what shapes minimise: the document's own choice, or that of one curve or surface.

use crate::error::ModelError;
use crate::model::Model;
use ductile_spec::{Objective, ObjectiveOf};

/// Sets the choice; the shapes keep their places and relax from there.
pub(super) fn choose(
    model: &mut Model,
    of: ObjectiveOf,
    objective: Option<Objective>,
) -> Result<(), ModelError> {
    let document = model.document_mut();
    match of {
        ObjectiveOf::Document => document.objective = objective.unwrap_or_default(),
        ObjectiveOf::Curve(id) => {
            document.curves.get_mut(&id).ok_or(ModelError::NoCurve(id))?.objective = objective;
        }
        ObjectiveOf::Surface(id) => {
            document.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?.objective = objective;
        }
    }
    Ok(())
}
