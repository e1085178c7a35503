//! `expand`: the loop of a closed curve grows or shrinks about its centre (thesis figure 3.1 f, section 7.4.3).

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::point;
use ductile_spec::{CurveId, Extent, MAX_COORDINATE, PointId};
use glam::DVec3;

/// Moves the control points of a closed curve away from their centre, all in the same proportion.
pub(super) fn expand(model: &mut Model, curve: CurveId, to: Extent) -> Result<(), ModelError> {
    let points = points(model, curve)?;
    let (centre, radius) = size(&points);
    let wanted = match to {
        Extent::Radius(radius) => radius,
        Extent::Like(other) => size(&self::points(model, other)?).1,
    };
    if !(wanted > 0.0 && wanted <= MAX_COORDINATE) {
        return Err(ModelError::BadRadius);
    }
    if radius <= 1e-9 * (1.0 + centre.abs().max_element()) {
        return Err(ModelError::NothingToExpand(curve));
    }
    for (id, at) in points {
        point::shift(model, id, centre + (at - centre) * (wanted / radius))?;
    }
    Ok(())
}

/// The control points of a closed curve.
fn points(model: &Model, id: CurveId) -> Result<Vec<(PointId, DVec3)>, ModelError> {
    super::sheet::closed_points(model, id)
}

/// Centre of some points, and their mean distance from it.
fn size(points: &[(PointId, DVec3)]) -> (DVec3, f64) {
    let count = points.len().max(1) as f64;
    let centre = points.iter().map(|(_, at)| *at).sum::<DVec3>() / count;
    (centre, points.iter().map(|(_, at)| at.distance(centre)).sum::<f64>() / count)
}
