//! `burnout`: a region is destroyed; the curves around it stay, those inside it go (thesis section 7.3.2).

use crate::error::ModelError;
use crate::model::Model;
use crate::surgery::opening::{edges_around, open, region_at};
use crate::surgery::pieces::{Banks, settle};
use ductile_spec::On;

/// Destroys the region at a place. A surface may fall in pieces by it; each is then a surface of its own.
pub(super) fn burnout(model: &mut Model, region: On) -> Result<(), ModelError> {
    let is_gone = region_at(model, region)?;
    let shape = model.surfaces.get(&region.surface).ok_or(ModelError::NoSurface(region.surface))?;
    let edges = edges_around(&shape.mesh, &is_gone);
    let opening = open(model, region.surface, &edges, Some(is_gone))?;
    settle(model, region.surface, opening, Banks::Joint).map(drop)
}
