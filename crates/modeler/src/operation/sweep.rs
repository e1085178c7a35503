//! `sweep`: skins the space between two curves, closed or open (thesis section 7.3.2).

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::sheet::add;
use crate::skeleton::sweep_skeleton;
use ductile_spec::{CurveId, PointId, Surface};
use glam::DVec3;

/// Makes a cylinder between two closed curves, or a strip between two open ones.
pub(crate) fn sweep(model: &mut Model, from: CurveId, to: CurveId, reversed: bool) -> Result<(), ModelError> {
    if from == to {
        return Err(ModelError::SweepToItself);
    }
    let ((low, closed), (high, other)) = (points(model, from)?, points(model, to)?);
    if closed != other {
        return Err(ModelError::UnlikeCurves(from, to));
    }
    if let Some((shared, _)) = low.iter().find(|(id, _)| high.iter().any(|(other, _)| other == id)) {
        return Err(ModelError::CurvesTouch(from, to, *shared));
    }
    let skeleton = sweep_skeleton((from, &low), (to, &high), closed, reversed);
    add(model, Surface::new(skeleton))
}

/// The control points of a curve, in order, and whether it closes.
fn points(model: &Model, id: CurveId) -> Result<(Vec<(PointId, DVec3)>, bool), ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let points = curve.through.iter().map(|point| Ok((*point, model.point(*point)?)));
    Ok((points.collect::<Result<_, ModelError>>()?, curve.closed))
}
