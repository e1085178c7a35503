//! `sweep`: skins the space between two curves, closed or open, or between stretches of curves (thesis section 7.3.2).

use crate::error::{ModelError, TouchError};
use crate::model::Model;
use crate::operation::sheet::add;
use crate::rehydrate::has_extent;
use crate::skeleton::sweep_skeleton;
use crate::surgery::dividing::{Part, divide_at};
use ductile_spec::{CurveId, PointId, Surface};
use glam::DVec3;
use std::collections::BTreeMap;

/// A curve, or its stretch between two control points: on a closed one from the first to the second.
type Side = (CurveId, Option<[PointId; 2]>);

/// Makes a cylinder between two closed curves, or a strip between two open ones or stretches.
pub(crate) fn sweep(model: &mut Model, sides: [Side; 2], reversed: bool) -> Result<(), ModelError> {
    let [from, to] = stretches(model, sides)?;
    let ((low, closed), (high, other)) = (points(model, from)?, points(model, to)?);
    if closed != other {
        return Err(ModelError::UnlikeCurves(from, to));
    }
    if let Some((shared, _)) = low.iter().find(|(id, _)| high.iter().any(|(other, _)| other == id)) {
        return Err(TouchError::Share(from, to, *shared).into());
    }
    let size = low.iter().chain(&high).map(|(_, at)| at.abs().max_element()).fold(0.0, f64::max);
    let is_apart = |at: DVec3| high.iter().all(|(_, other)| has_extent(at.distance(*other), size));
    if let Some((_, at)) = low.iter().find(|(_, at)| !is_apart(*at)) {
        return Err(TouchError::Curves { one: from, other: to, at: *at }.into());
    }
    let skeleton = sweep_skeleton((from, &low), (to, &high), closed, reversed);
    add(model, Surface::new(skeleton))
}

/// Curves of which nothing is left out: those that are wanted only in part are divided.
fn stretches(model: &mut Model, sides: [Side; 2]) -> Result<[CurveId; 2], ModelError> {
    let [(from, first), (to, second)] = sides;
    if from == to && (first.is_none() || second.is_none()) {
        return Err(ModelError::SweepToItself);
    }
    let mut ends: BTreeMap<CurveId, Vec<PointId>> = BTreeMap::new();
    for (curve, stretch) in sides {
        let Some([a, b]) = stretch else { continue };
        if a == b {
            return Err(ModelError::NoStretch(curve));
        }
        ends.entry(curve).or_default().extend([a, b]);
    }
    let mut parts: BTreeMap<CurveId, (bool, Vec<Part>)> = BTreeMap::new();
    for (curve, points) in ends {
        let closed = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?.closed;
        parts.insert(curve, (closed, divide_at(model, curve, &points)?));
    }
    let part = |(curve, stretch): Side| -> Result<CurveId, ModelError> {
        let (Some([a, b]), Some((closed, parts))) = (stretch, parts.get(&curve)) else { return Ok(curve) };
        // An open curve leads only one way between two of its points.
        let is_it = |part: &&Part| part.ends == [a, b] || (!closed && part.ends == [b, a]);
        parts.iter().find(is_it).map(|part| part.curve).ok_or(ModelError::StretchesOverlap(curve))
    };
    let [from, to] = [part(sides[0])?, part(sides[1])?];
    if from == to { Err(ModelError::StretchesOverlap(sides[0].0)) } else { Ok([from, to]) }
}

/// The control points of a curve, in order, and whether it closes.
fn points(model: &Model, id: CurveId) -> Result<(Vec<(PointId, DVec3)>, bool), ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let points = curve.through.iter().map(|point| Ok((*point, model.point(*point)?)));
    Ok((points.collect::<Result<_, ModelError>>()?, curve.closed))
}
