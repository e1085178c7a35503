//! The Cage tool: a click where nothing is places a cage, a click on a part of a cage selects it.

use super::{Act, Aim, Options, Selection, path, say};
use crate::Hit;
use ductile_spec::{CageSource, Edit};

/// A click. `suited` is the size of a new cage while nobody has chosen another.
pub(super) fn click(aim: Aim<'_>, options: &Options, suited: f64) -> Vec<Act> {
    let place = match aim.hit {
        Some(hit @ (Hit::Point { .. } | Hit::Edge { .. } | Hit::Face { .. })) => {
            return vec![Act::Select(Selection::of(Some(hit)))];
        }
        Some(Hit::Curve { at, .. } | Hit::Surface { at, .. }) => Some(*at),
        None => aim.place,
    };
    let Some(centre) = place else { return say(path::NO_PLACE) };
    let (form, size) = (options.form, options.size.unwrap_or(suited));
    vec![Act::Edit(Edit::Cage { from: CageSource::BuiltIn { form, centre: centre.as_dvec3(), size } })]
}
