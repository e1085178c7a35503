//! `curve`: a fair curve through control points, open or closed (thesis section 7.3.2).

use crate::error::ModelError;
use crate::model::{Model, default_spacing};
use crate::operation::point;
use ductile_spec::{Curve, PointId};
use glam::DVec3;

/// Makes the curve through existing points.
pub(crate) fn curve(model: &mut Model, through: &[PointId], closed: bool) -> Result<(), ModelError> {
    let id = model.document.next_curve();
    let spacing = default_spacing(&model.document);
    let document = model.document_mut();
    document.curves.insert(id, Curve { through: through.to_vec(), closed });
    // A document states its spacing from the first curve on, so that everybody who opens it gets the same.
    document.spacing.get_or_insert(spacing);
    model.document.validate()?;
    model.build_curve(id)
}

/// Places points and makes the curve through them.
pub(crate) fn draw(model: &mut Model, at: &[DVec3], closed: bool) -> Result<(), ModelError> {
    let through = at.iter().map(|at| point::place(model, *at)).collect::<Result<Vec<_>, _>>()?;
    curve(model, &through, closed)
}
