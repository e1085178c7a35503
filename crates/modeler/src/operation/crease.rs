//! `crease`: a surface is cut, and both banks go on following the same curves, so that it is bent sharply there (thesis
//! section 7.3.2). Pieces that come apart are surfaces of their own.

use crate::error::ModelError;
use crate::model::Model;
use crate::surgery::opening::{border, open};
use crate::surgery::pieces::{Banks, settle};
use ductile_spec::Border;

/// Creases along a border.
pub(super) fn crease(model: &mut Model, along: Border) -> Result<(), ModelError> {
    let (surface, edges) = border(model, along)?;
    let opening = open(model, surface, &edges, None)?;
    settle(model, surface, opening, Banks::Joint).map(drop)
}
