//! Tools that want one click: burn out a region, crease or smooth along a curve, split.
//!
//! A click on a curve is about the curve, a click beside it about the region.

use super::{Act, Aim, Place, Surroundings, say, span};
use crate::Hit;
use ductile_spec::{Border, CurveId, CurveRole, Document, Edit};

const NO_SURFACE: &str = "There is no surface here.";

/// How often the surfaces of a document end at a curve, and how often they run on through it.
fn uses(document: &Document, curve: CurveId) -> (usize, usize) {
    let (mut rims, mut inner) = (0, 0);
    for surface in document.surfaces.values() {
        let skeleton = &surface.skeleton;
        for embedding in skeleton.curves.iter().filter(|embedding| embedding.curve == curve) {
            let [from, to, ..] = embedding.along[..] else { continue };
            let has_edge = |t: &&[u32; 3]| t.contains(&from) && t.contains(&to);
            match skeleton.triangles.iter().filter(has_edge).count() {
                0 | 1 => rims += 1,
                _ => inner += 1,
            }
        }
    }
    (rims, inner)
}

/// What a click beside every curve is about.
fn region(aim: Aim<'_>) -> Result<Border, Vec<Act>> {
    Place::of(aim.hit).map(|place| Border::Region(place.on())).ok_or_else(|| say(NO_SURFACE))
}

pub(super) fn burn_out(aim: Aim<'_>) -> Vec<Act> {
    match Place::of(aim.hit) {
        Some(place) => vec![Act::Edit(Edit::Burnout { region: place.on() })],
        None => say("There is no surface here that could be burnt out."),
    }
}

/// Whether Crease would smooth a curve rather than crease it; none where it would refuse.
#[must_use]
pub fn would_smooth(document: &Document, curve: CurveId) -> Option<bool> {
    match uses(document, curve) {
        (2.., _) => Some(true),
        (_, 1..) => Some(false),
        (0 | 1, 0) => None,
    }
}

pub(super) fn crease(aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
    let Some(Hit::Curve { id, .. }) = aim.hit else {
        return region(aim).map_or_else(|no| no, |border| vec![Act::Edit(Edit::Crease { border })]);
    };
    match uses(around.document, *id) {
        (2.., _) => vec![Act::Edit(Edit::Smooth { curve: *id })],
        (_, 1..) => vec![Act::Edit(Edit::Crease { border: Border::Curve(*id) })],
        (1, 0) => {
            say("Only one surface ends at this curve: there is nothing to crease and nothing to smooth.")
        }
        (0, 0) => say("No surface follows this curve. Draw one on the surface with D."),
    }
}

pub(super) fn split(aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
    let Some(Hit::Curve { id, .. }) = aim.hit else {
        return region(aim).map_or_else(|no| no, |border| vec![Act::Edit(Edit::Split { border })]);
    };
    match span(around.structure, *id).map(|span| span.role) {
        Some(CurveRole::Free) | None => say("No surface follows this curve. Draw one on the surface with D."),
        Some(_) if matches!(uses(around.document, *id), (1, 0)) => {
            say("The surface ends at this curve already.")
        }
        Some(_) => vec![Act::Edit(Edit::Split { border: Border::Curve(*id) })],
    }
}
