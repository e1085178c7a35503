//! Of which degree the Bézier curves along the sides of a fill are. It hangs on the document alone, not on where anything is, so that
//! nothing jumps in a drag.

use super::{join, precedence};
use ductile_patch::s_patch::PatchKind;
use ductile_spec::{CurveStretch, Document, Fill, FillSide};
use std::collections::BTreeMap;

/// A degree that nobody chose leaves this many control points at the most, down to the least degree: with more, what is made once for a kind
/// of patch takes a good part of a second.
const EASY_POINTS: f64 = 1_800.0;
/// The least degree: with a lower one a ribbon has no freedom to follow planes.
const LEAST: usize = 3;
/// The highest that is taken by itself. A corner of a hole in a fair surface, dragged by a fifth of the model, leaves 0.56° between the
/// surfaces with degree 5 and 0.21° with 7.
const MOST: usize = 7;
/// The same where a side runs along several edges of a cage: it bends as often as there are edges. With a vertex of four edges dragged
/// by a third of an edge, degree 7 is 0.018 off the rim and 8.4° off its planes, degree 10 a fifth of that and 3.5°; from there on
/// higher degrees gain little.
const MOST_ALONG_RIMS: usize = 10;

/// The degree of a fill: what was chosen, or the highest that leaves it light.
pub(super) fn of(document: &Document, fill: &Fill) -> usize {
    let is_light = |degree: &usize| {
        PatchKind::control_points(fill.sides.len(), *degree, join(fill.style)) <= EASY_POINTS
    };
    let winds = fill.sides.iter().any(|side| rim_edges(document, side) > 1);
    let most = if winds { MOST_ALONG_RIMS } else { MOST };
    let chosen = fill.style.degree.map(usize::from);
    chosen.unwrap_or_else(|| (LEAST..=most).rev().find(is_light).unwrap_or(LEAST))
}

/// By how much higher the degree of ribbons is that lean: what makes them do so is of the fourth degree in the parameter. With the degree of
/// the curves, 7, a turn by 20° leaves 0.27° between two patches.
const LEANING: usize = 4;
/// As many of them are taken as leave this many control points at the most, but one at least above degree 4.
const LEANING_POINTS: f64 = 3_100.0;

/// Ribbons of a lower degree than this get a higher one than their curves, if that is light, where they have planes to follow: at degree 3
/// their only free points are the twist points, which two sides share. Below the other one they get it as far as they have this many
/// control points at the most: degree 5 with eight sides.
const FREE: usize = 7;
const BARE: usize = 5;
const BARE_POINTS: f64 = 6_500.0;

/// The degree of the ribbons of a fill: that of its curves, and more if they lean, or are bound to planes that they could not follow.
pub(super) fn of_ribbons(document: &Document, fill: &Fill, leans: bool, is_bound: bool) -> usize {
    let own = of(document, fill);
    if !leans {
        let points = if own < BARE { BARE_POINTS } else { EASY_POINTS };
        let is_light =
            |degree: &usize| PatchKind::control_points(fill.sides.len(), *degree, join(fill.style)) <= points;
        let most = if is_bound && own < FREE { own + precedence::FREE } else { own };
        return (own..=most).rev().find(is_light).unwrap_or(own);
    }
    let is_light = |degree: &usize| {
        PatchKind::control_points(fill.sides.len(), *degree, join(fill.style)) <= LEANING_POINTS
    };
    (own..=own + LEANING).rev().find(is_light).unwrap_or(own).max(LEANING + 1)
}

/// The degree of the Bézier curve along each stretch: the lowest among the fills that have it, so that all have the same curve.
pub(super) fn of_stretches(document: &Document) -> BTreeMap<CurveStretch, usize> {
    let mut degrees = BTreeMap::new();
    for fill in document.fills.values() {
        let own = of(document, fill);
        for side in &fill.sides {
            let Some(curve) = document.curves.get(&side.curve) else { continue };
            let lowest = degrees.entry(side.stretch(curve).0).or_insert(own);
            *lowest = own.min(*lowest);
        }
    }
    degrees
}

/// Along how many edges of a cage's rim a side runs; 0 if its curve is none.
fn rim_edges(document: &Document, side: &FillSide) -> usize {
    let Some(curve) = document.curves.get(&side.curve).filter(|curve| curve.rim.is_some()) else { return 0 };
    let (stretch, _) = side.stretch(curve);
    let place = |point| curve.through.iter().position(|other| *other == point);
    let (Some(from), Some(to)) = (place(stretch.from), place(stretch.to)) else { return 0 };
    if to > from { to - from } else { to + curve.through.len() - from }
}
