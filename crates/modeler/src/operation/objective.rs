//! Choosing what shapes minimise: the document's own choice, or that of one curve, surface or region.

use crate::error::ModelError;
use crate::model::Model;
use ductile_spec::{Objective, ObjectiveOf, SurfaceId};

/// Sets the choice; the shapes keep their places and relax from there.
pub(super) fn choose(
    model: &mut Model,
    of: ObjectiveOf,
    objective: Option<Objective>,
) -> Result<(), ModelError> {
    match of {
        ObjectiveOf::Document => model.document_mut().objective = objective.unwrap_or_default(),
        ObjectiveOf::Curve(id) => {
            super::rim::check_free(
                &model.document,
                id,
                "it minimises nothing, but goes where the cage leads it",
            )?;
            let curve = model.document_mut().curves.get_mut(&id).ok_or(ModelError::NoCurve(id))?;
            curve.objective = objective;
        }
        ObjectiveOf::Surface(id) => of_surface(model, id, objective)?,
        ObjectiveOf::Region { surface, at } => {
            if !super::region::change(model, surface, at, |region| region.objective = objective)? {
                of_surface(model, surface, objective)?;
            }
        }
    }
    Ok(model.document.validate()?)
}

fn of_surface(model: &mut Model, id: SurfaceId, objective: Option<Objective>) -> Result<(), ModelError> {
    let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
    surface.objective = objective;
    Ok(())
}
