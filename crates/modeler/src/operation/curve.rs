//! `curve`: a fair curve through control points, open or closed (thesis section 7.3.2).

use crate::error::ModelError;
use crate::model::{Model, default_spacing};
use crate::operation::point;
use ductile_spec::{Curve, Through};

/// Makes the curve, and the points that it wants in new places: they are numbered upwards along the curve.
pub(crate) fn curve(model: &mut Model, through: &[Through], closed: bool) -> Result<(), ModelError> {
    let mut points = Vec::with_capacity(through.len());
    for corner in through {
        points.push(match corner {
            Through::Point(point) => *point,
            Through::Place(at) => point::place(model, *at)?,
        });
    }
    let id = model.document.next_curve();
    let spacing = default_spacing(&model.document);
    let document = model.document_mut();
    document.curves.insert(id, Curve::new(points, closed));
    // A document states its spacing from the first curve on, so that everybody who opens it gets the same.
    document.spacing.get_or_insert(spacing);
    model.document.validate()?;
    model.build_curve(id)
}
