//! Corners that the designer picks: of a closed curve all of them, of a chain of curves those inside its curves; where one curve ends and
//! the next begins there is a corner anyway.

use super::loops::{Curves, Neighbours};
use crate::error::{HoleError, ModelError};
use crate::model::Model;
use ductile_patch::loops_through;
use ductile_spec::{CurveId, FillSide, PointId};

/// The sides of the hole along a curve with given corners.
pub(super) fn between(
    model: &Model,
    neighbours: &Neighbours,
    id: CurveId,
    corners: &[PointId],
) -> Result<Vec<FillSide>, ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    if curve.closed && corners.iter().all(|point| curve.through.contains(point)) {
        on_closed(model, id, corners)
    } else {
        on_chain(model, neighbours, id, corners)
    }
}

/// The sides of a closed curve between given points of it.
pub(super) fn on_closed(
    model: &Model,
    id: CurveId,
    corners: &[PointId],
) -> Result<Vec<FillSide>, ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    // In the order of the curve, each once.
    let corners: Vec<PointId> =
        curve.through.iter().copied().filter(|point| corners.contains(point)).collect();
    if corners.len() < 3 {
        return Err(HoleError::FewCorners(id, corners.len()).into());
    }
    let next = corners.iter().cycle().skip(1);
    Ok(corners.iter().zip(next).map(|(from, to)| FillSide::new(id, *from, *to)).collect())
}

/// The sides of the loop of several curves that runs along one and passes through all given points: of several loops one along which
/// nothing lies on both sides already, and of these the one with fewest curves.
fn on_chain(
    model: &Model,
    neighbours: &Neighbours,
    id: CurveId,
    corners: &[PointId],
) -> Result<Vec<FillSide>, ModelError> {
    let curves = Curves::of(model, |_| true);
    let mut best: Option<((usize, usize), Vec<FillSide>)> = None;
    let mut is_filled = false;
    let found = curves.parts_of(id).into_iter().flat_map(|part| loops_through(&curves.edges, part));
    for found in found.filter(|found| curves.alone(found).is_none()) {
        let sides = curves.sides(&found);
        let along: Vec<Vec<PointId>> = sides.iter().map(|side| points_along(model, side)).collect();
        if !corners.iter().all(|point| along.iter().flatten().any(|other| other == point)) {
            continue;
        }
        if neighbours.is_filled(model, &sides) {
            is_filled = true;
            continue;
        }
        let key = (neighbours.crowd(model, &sides), sides.len());
        if best.as_ref().is_none_or(|(least, _)| key < *least) {
            best = Some((
                key,
                sides.iter().zip(&along).flat_map(|(side, along)| cut(side, along, corners)).collect(),
            ));
        }
    }
    let none = if is_filled { HoleError::LoopFilled(id) } else { HoleError::NoLoopThrough(id) };
    let (_, sides) = best.ok_or(none)?;
    if sides.len() < 3 { Err(HoleError::FewCorners(id, sides.len()).into()) } else { Ok(sides) }
}

/// The control points along a side, in its direction, both ends included.
fn points_along(model: &Model, side: &FillSide) -> Vec<PointId> {
    let Some(curve) = model.document.curves.get(&side.curve) else { return Vec::new() };
    let (stretch, back) = side.stretch(curve);
    let place = |point| curve.through.iter().position(|other| *other == point);
    let (Some(from), Some(to)) = (place(stretch.from), place(stretch.to)) else { return Vec::new() };
    let count = curve.through.len();
    let steps = if to > from { to - from } else { to + count - from };
    let mut points: Vec<PointId> = (0..=steps).map(|k| curve.through[(from + k) % count]).collect();
    if back {
        points.reverse();
    }
    points
}

/// A side in parts, cut at those of its points that are corners.
fn cut(side: &FillSide, along: &[PointId], corners: &[PointId]) -> Vec<FillSide> {
    let inner = along
        .iter()
        .copied()
        .filter(|point| *point != side.from && *point != side.to && corners.contains(point));
    let ends: Vec<PointId> = [side.from].into_iter().chain(inner).chain([side.to]).collect();
    ends.windows(2).map(|ends| FillSide { from: ends[0], to: ends[1], ..*side }).collect()
}
