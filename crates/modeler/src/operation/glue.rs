//! `glue`: two rims are joined, by a band between them or by laying one on the other (thesis section 7.3.5).

use crate::error::ModelError;
use crate::model::Model;
use crate::surgery::rims::{band, lay, rim_at};
use ductile_spec::On;

/// Joins the rims nearest to two places.
pub(super) fn glue(
    model: &mut Model,
    from: On,
    to: On,
    skirt: bool,
    reversed: bool,
) -> Result<(), ModelError> {
    let (one, other) = (rim_at(model, from)?, rim_at(model, to)?);
    let (one, other) = ((from.surface, one), (to.surface, other));
    if skirt {
        band(model, one, other, (reversed, true)).map(drop)
    } else {
        lay(model, one, other, reversed).map(drop)
    }
}
