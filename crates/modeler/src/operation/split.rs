//! `split`: a surface is cut and both banks are free (thesis section 7.3.2). Round a closed curve that divides it there are
//! two surfaces afterwards; along an open curve there is a slit.

use crate::error::ModelError;
use crate::model::Model;
use crate::surgery::opening::{border, open};
use crate::surgery::pieces::{Banks, settle};
use ductile_spec::Border;

/// Cuts along a border; the curves along it are doubled, with their control points.
pub(super) fn split(model: &mut Model, along: Border) -> Result<(), ModelError> {
    let (surface, edges) = border(model, along)?;
    let opening = open(model, surface, &edges, None)?;
    settle(model, surface, opening, Banks::Apart).map(drop)
}
