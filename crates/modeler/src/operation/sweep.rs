//! `sweep`: skins the space between two closed curves (thesis section 7.3.2).

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::sheet::{add, closed_points};
use crate::skeleton::sweep_skeleton;
use ductile_spec::{CurveId, Surface};

/// Makes a cylinder between two closed curves.
pub(crate) fn sweep(model: &mut Model, from: CurveId, to: CurveId) -> Result<(), ModelError> {
    if from == to {
        return Err(ModelError::SweepToItself);
    }
    let (low, high) = (closed_points(model, from)?, closed_points(model, to)?);
    if let Some((shared, _)) = low.iter().find(|(id, _)| high.iter().any(|(other, _)| other == id)) {
        return Err(ModelError::CurvesTouch(from, to, *shared));
    }
    let skeleton = sweep_skeleton((from, &low), (to, &high));
    add(model, Surface::new(skeleton))
}
