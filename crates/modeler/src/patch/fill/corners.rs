//! The corners of fills: which curves have to leave one in a common plane, and where that plane is given.
//!
//! A fill is smooth at a corner only in the plane of its two curves there. Where fills join smoothly, all curves of theirs at a corner have
//! to agree on one. Where a fill takes its planes from a surface beside it, the plane is that surface's, and a curve that comes
//! there from elsewhere has to leave in it.

use super::Lead;
use crate::bank;
use crate::model::Model;
use crate::patch::{Led, PatchRim};
use crate::relax::Relaxer;
use ductile_spec::{CurveId, CurveStretch, Document, Fill, FillJoin, FillSide, PointId, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// The corners at which fills join smoothly along a curve, with all curves of those fills there: they have to lie in one plane.
pub(crate) fn corners(document: &Document) -> BTreeMap<PointId, BTreeSet<CurveId>> {
    let mut on: BTreeMap<CurveStretch, Vec<(&Fill, usize)>> = BTreeMap::new();
    for fill in document.fills.values().filter(|fill| fill.style.join == FillJoin::Tangent) {
        for (at, side) in fill.sides.iter().enumerate() {
            let Some(curve) = document.curves.get(&side.curve) else { continue };
            on.entry(side.stretch(curve).0).or_default().push((fill, at));
        }
    }
    let mut corners: BTreeMap<PointId, BTreeSet<CurveId>> = BTreeMap::new();
    for (stretch, fills) in on.into_iter().filter(|(_, fills)| fills.len() == 2) {
        for (fill, at) in fills {
            let count = fill.sides.len();
            let (before, after) = (&fill.sides[(at + count - 1) % count], &fill.sides[(at + 1) % count]);
            for (point, other) in [(fill.sides[at].from, before), (fill.sides[at].to, after)] {
                corners.entry(point).or_default().extend([stretch.curve, other.curve]);
            }
        }
    }
    corners
}

/// Another fill that joins one smoothly without going on from it, and the curve along which it does.
pub(crate) fn joined(document: &Document, id: SurfaceId) -> Option<(SurfaceId, CurveId)> {
    let is_smooth = |fill: &&Fill| fill.style.join == FillJoin::Tangent;
    let stretch = |side: &FillSide| document.curves.get(&side.curve).map(|curve| side.stretch(curve).0);
    let own = document.fills.get(&id).filter(is_smooth)?;
    let others = document.fills.iter().filter(|(other, fill)| **other != id && is_smooth(fill));
    others.into_iter().find_map(|(other, fill)| {
        let joins = |side: &&FillSide| {
            fill.sides.iter().any(|there| stretch(there) == stretch(side) && there.planes != Some(id))
        };
        own.sides.iter().find(joins).map(|side| (*other, side.curve))
    })
}

/// The corners at which a surface gives the plane, with its normal there, and the curves that have to leave in it: those of fills
/// that do not lie in that surface. Without a relaxer nothing is known of the planes of fair surfaces.
pub(crate) fn held(model: &Model, relaxer: Option<&Relaxer>) -> BTreeMap<PointId, Lead> {
    let mut held: BTreeMap<PointId, Lead> = BTreeMap::new();
    for fill in model.document.fills.values().filter(|fill| fill.style.join == FillJoin::Tangent) {
        let count = fill.sides.len();
        for (at, side) in fill.sides.iter().enumerate() {
            let Some(beside) = side.planes else { continue };
            let (before, after) = (&fill.sides[(at + count - 1) % count], &fill.sides[(at + 1) % count]);
            for (point, other) in [(side.from, before), (side.to, after)] {
                if lies_in(&model.document, beside, other) {
                    continue;
                }
                let Some(normal) = normal_at(model, relaxer, beside, (side.curve, point)) else { continue };
                let lead =
                    held.entry(point).or_insert(Lead { surface: beside, normal, curves: BTreeSet::new() });
                lead.curves.insert(other.curve);
            }
        }
    }
    // Other curves of fills that meet there have to lie in the same plane.
    for (point, curves) in corners(&model.document) {
        if let Some(lead) = held.get_mut(&point) {
            let is_own = |id: &CurveId| follows(&model.document, lead.surface, *id);
            lead.curves.extend(curves.into_iter().filter(|id| !is_own(id)).collect::<Vec<_>>());
        }
    }
    held
}

/// Whether a side lies in a surface as well, or takes its planes from it.
fn lies_in(document: &Document, surface: SurfaceId, side: &FillSide) -> bool {
    side.planes == Some(surface) || follows(document, surface, side.curve)
}

/// Whether a curve and a surface follow one another.
fn follows(document: &Document, surface: SurfaceId, curve: CurveId) -> bool {
    let fair = document.surfaces.get(&surface);
    fair.is_some_and(|fair| fair.skeleton.curves.iter().any(|embedding| embedding.curve == curve))
        || document.curves.get(&curve).is_some_and(|curve| curve.rim == Some(surface))
}

/// The unit normal of a surface at a point of a curve at which it ends. (What lies between fills is for their curves to say.)
fn normal_at(
    model: &Model,
    relaxer: Option<&Relaxer>,
    surface: SurfaceId,
    (curve, point): (CurveId, PointId),
) -> Option<DVec3> {
    let drawn = model.curves.get(&curve)?;
    let sample = drawn.sample_of(point)?;
    if let Some(shape) = model.surfaces.get(&surface) {
        let bound = relaxer?.surface(surface, shape)?;
        let embedded = shape.embeddings.iter().find(|embedded| embedded.curve == curve)?;
        return bank::along(model, bound, embedded).get(sample).copied();
    }
    if model.document.fills.contains_key(&surface) {
        return None;
    }
    match Led::of(model, curve).filter(|led| led.surface == surface) {
        Some(led) => Some(led.on_sampling(drawn, sample, 0.0)?.normal),
        None => PatchRim::new(model.patches.get(&surface)?).normal(*model.document.points.get(&point)?),
    }
}
