//! `lean`: how a fill leaves one of its sides, beside what is fair: its planes turned about the curve, and the derivative across it
//! longer or shorter.

use crate::error::{HoleError, ModelError};
use crate::model::Model;
use crate::patch;
use crate::relax::Relaxer;
use ductile_spec::{FillJoin, SurfaceId};

/// Turns a fill about its side of that number, from 1, by `turn` in radians, and gives it that strength there.
pub(super) fn lean(
    model: &mut Model,
    relaxer: &Relaxer,
    id: SurfaceId,
    number: usize,
    (turn, strength): (f64, f64),
) -> Result<(), ModelError> {
    let is_there = model.document.kind_of(id).is_some();
    let none = if is_there { HoleError::NoFill(id).into() } else { ModelError::NoSurface(id) };
    let fill = model.document_mut().fills.get_mut(&id).ok_or(none)?;
    let sides = fill.sides.len();
    let side = number.checked_sub(1).and_then(|at| fill.sides.get_mut(at));
    let side = side.ok_or(HoleError::NoSide { surface: id, side: number, sides })?;
    // Adding zero turns -0 into 0.
    (side.turn, side.strength) = (turn + 0.0, strength);
    if side.leans() && fill.style.join == FillJoin::Position {
        return Err(HoleError::Positions(id).into());
    }
    model.document.validate()?;
    patch::follow(model, Some(relaxer));
    model.check_fill(id)
}
