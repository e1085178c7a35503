//! The loop of curves that a sheet takes: found as a fill's is, but it needs no corners.

use super::loops::{Curves, Neighbours, reversed};
use crate::error::{HoleError, ModelError};
use crate::model::Model;
use crate::patch::fill::places;
use crate::skeleton::least_area;
use ductile_mesh::nearest_place;
use ductile_patch::loops_through;
use ductile_spec::{CurveId, FillSide, SkeletonVertex, Surface, SurfaceId};
use glam::DVec3;
use std::collections::BTreeSet;

/// The sides of the loop along a curve in which a sheet is laid; none if that is the curve by itself.
///
/// A closed curve is taken by itself, unless something lies on both its sides somewhere and it bounds a hole with others. Of
/// several loops along an open one those come first along which nothing lies on both sides, then the shortest. The loop
/// faces as most of its neighbours do.
pub(crate) fn sheet_loop(model: &Model, curve: CurveId) -> Result<Vec<FillSide>, ModelError> {
    let drawn = model.document.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
    let neighbours = Neighbours::of(model);
    let whole = drawn.through.first().map(|first| FillSide::new(curve, *first, *first));
    if drawn.closed && whole.is_none_or(|whole| neighbours.crowd(model, &[whole]) == 0) {
        return Ok(Vec::new());
    }
    let curves = Curves::of(model, |_| true);
    let mut best: Option<(usize, Vec<FillSide>)> = None;
    let mut skin = None;
    for part in curves.parts_of(curve) {
        for found in loops_through(&curves.edges, part) {
            let sides = curves.sides(&found);
            if sides.len() < 2 || neighbours.is_filled(model, &sides) {
                continue;
            }
            let crowd = neighbours.crowd(model, &sides);
            if let Some(id) = skin_in(model, &sides) {
                skin = Some(id);
            } else if best.as_ref().is_none_or(|(least, _)| crowd < *least) {
                best = Some((crowd, sides));
            }
        }
    }
    let is_hole = |crowd: usize| crowd == 0 || !drawn.closed && skin.is_none();
    match (best.filter(|(crowd, _)| is_hole(*crowd)), skin) {
        (Some((_, sides)), _) => {
            let is_closed = |id: CurveId| model.document.curves.get(&id).is_some_and(|curve| curve.closed);
            let is_against = neighbours.is_against(model, &sides);
            Ok(if is_against { reversed(&sides, is_closed) } else { sides })
        }
        (None, _) if drawn.closed => Ok(Vec::new()),
        (None, Some(surface)) => Err(ModelError::AlreadySkinned { curve, surface }),
        (None, None) => Err(HoleError::NoRing(curve).into()),
    }
}

/// The least skin in a rim is found between so many places of it.
const CORNERS: usize = 48;
/// A surface from which that skin lies farther than this part of its own size is not what fills the rim, which is a hole then.
const FAR: f64 = 0.25;

/// The sheet in a loop of whole curves, if there is one. A cylinder that is slit from rim to rim bounds such a loop, too.
fn skin_in(model: &Model, sides: &[FillSide]) -> Option<SurfaceId> {
    let is_whole = |side: &FillSide| {
        let curve = model.document.curves.get(&side.curve);
        curve.is_some_and(|curve| {
            let ends = [curve.through.first(), curve.through.last()];
            !curve.closed && ends.into_iter().flatten().all(|end| [side.from, side.to].contains(end))
        })
    };
    let curves: BTreeSet<CurveId> = sides.iter().map(|side| side.curve).collect();
    let id = if sides.iter().all(is_whole) { sheet_in(model, &curves)? } else { return None };
    let shape = model.surfaces.get(&id)?;
    let mut line = Vec::new();
    for side in sides {
        let places = places(model, side)?;
        // The last of them is the first of the next side.
        line.extend_from_slice(&places[..places.len().saturating_sub(1)]);
    }
    let every = line.len().div_ceil(CORNERS).max(1);
    let line: Vec<_> = line.into_iter().step_by(every).collect();
    let centre = line.iter().sum::<DVec3>() / line.len().max(1) as f64;
    let size = line.iter().map(|at| at.distance(centre)).fold(0.0, f64::max);
    let is_near = |t: &[u32; 3]| {
        let middle = t.map(|k| line[k as usize]).iter().sum::<DVec3>() / 3.0;
        let place = nearest_place(&shape.mesh, &shape.positions, middle);
        let place = place.and_then(|place| place.position(&shape.mesh, &shape.positions));
        place.is_some_and(|place| place.distance(middle) < FAR * size)
    };
    let is_it = line.len() < 3 || least_area(&line).iter().all(is_near);
    is_it.then_some(id)
}

/// The surface that follows just these curves and hangs on no other points.
pub(crate) fn sheet_in(model: &Model, curves: &BTreeSet<CurveId>) -> Option<SurfaceId> {
    let lies_on = |vertex: &SkeletonVertex| match vertex {
        SkeletonVertex::Control(point) => {
            model.document.curves_through(*point).any(|id| curves.contains(&id))
        }
        SkeletonVertex::Free(_) => true,
    };
    let is_sheet = |surface: &Surface| {
        let own: Vec<CurveId> = surface.skeleton.curves.iter().map(|embedded| embedded.curve).collect();
        // One that follows a curve twice is a band.
        own.len() == curves.len()
            && own.iter().all(|id| curves.contains(id))
            && surface.skeleton.vertices.iter().all(lies_on)
    };
    model.document.surfaces.iter().find(|(_, surface)| is_sheet(surface)).map(|(id, _)| *id)
}
