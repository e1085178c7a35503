//! `fill`: an exact patch in a loop of curves, of rims, or of both (P. Salvi, *G1 hole filling with S-patches made easy*, 2020); and
//! `fill-network`: patches in all loops of a network at once.

mod corners;
mod loops;
mod skin;

use crate::error::{HoleError, ModelError};
use crate::model::Model;
use crate::patch::{self, PatchRim};
use crate::relax::Relaxer;
use ductile_patch::{Ribbon, loops_through, made_compatible, network_faces};
use ductile_spec::{
    CurveId, Edit, Fill, FillRibbon, FillSide, FillStyle, FoundLoop, Hole, PointId, Request, SurfaceId,
};
use glam::DVec3;
use loops::{Curves, Neighbours, reversed};
pub(crate) use skin::{sheet_in, sheet_loop};
use std::collections::BTreeSet;

/// A closed curve by itself has a corner where it turns by more than this at a sample, in radians: 20°.
const CORNER: f64 = 0.35;

/// Fills one hole.
pub(super) fn fill(
    model: &mut Model,
    relaxer: &Relaxer,
    hole: &Hole,
    style: FillStyle,
) -> Result<(), ModelError> {
    let neighbours = Neighbours::of(model);
    let mut fill = Fill { style, ..Fill::default() };
    match hole {
        Hole::Ribbons(ribbons) => fill.ribbons.clone_from(ribbons),
        Hole::CompatibleRibbons(ribbons) => fill.ribbons = compatible(model, ribbons)?,
        Hole::Sides(sides) => fill.sides.clone_from(sides),
        Hole::Corners { curve, points } => {
            fill.sides =
                with_planes(model, &neighbours, corners::between(model, &neighbours, *curve, points)?);
        }
        Hole::Near { curve, at } => {
            let sides = nearest_loop(model, &neighbours, *curve, *at)?;
            fill.sides = with_planes(model, &neighbours, sides);
        }
    }
    let id = add(model, fill)?;
    patch::follow(model, Some(relaxer));
    model.check_fill(id)
}

/// Ribbons with their twist points moved least, so that they fit together.
fn compatible(model: &Model, ribbons: &[FillRibbon]) -> Result<Vec<FillRibbon>, ModelError> {
    let asked: Vec<Ribbon> =
        ribbons.iter().map(|r| Ribbon { row0: r.row0.clone(), row1: r.row1.clone() }).collect();
    let surface = model.document.next_surface();
    let adjusted =
        made_compatible(&asked).map_err(|reason| ModelError::Fill { surface, reason: reason.into() })?;
    let ring = adjusted.ribbons;
    let kept = |ribbon: &Ribbon| FillRibbon { row0: ribbon.row0.clone(), row1: ribbon.row1.clone() };
    Ok(ring.ribbons().iter().map(kept).collect())
}

/// The act that fills with ribbons made compatible, in place of one that does not.
pub(crate) fn mended(request: &Request) -> Option<Edit> {
    match request {
        Request::Edit(Edit::Fill { hole: Hole::Ribbons(ribbons), style }) => {
            Some(Edit::Fill { hole: Hole::CompatibleRibbons(ribbons.clone()), style: *style })
        }
        _ => None,
    }
}

/// Fills all loops of the curves that hang together with one, or of all curves, as far as they can be filled.
pub(super) fn fill_network(
    model: &mut Model,
    relaxer: &Relaxer,
    curve: Option<CurveId>,
    style: FillStyle,
) -> Result<(), ModelError> {
    let members = curve.map(|curve| connected(model, curve)).transpose()?;
    let curves = Curves::of(model, |id| members.as_ref().is_none_or(|members| members.contains(&id)));
    let neighbours = Neighbours::of(model);
    let mut made = Vec::new();
    for face in network_faces(&curves.edges) {
        let sides = curves.sides(&face);
        let is_free = neighbours.crowd(model, &sides) == 0 && !neighbours.is_filled(model, &sides);
        if sides.len() < 3 || !is_free {
            continue;
        }
        // Planes come from what was there before; the new patches agree among themselves.
        let sides = with_planes(model, &neighbours, sides);
        made.push(add(model, Fill { sides, style, ..Fill::default() })?);
    }
    patch::follow(model, Some(relaxer));
    // A face that cannot be filled is no reason not to fill the others.
    let (good, bad): (Vec<SurfaceId>, Vec<SurfaceId>) =
        made.into_iter().partition(|id| model.check_fill(*id).is_ok());
    let why = bad.first().map(|id| model.check_fill(*id));
    for id in bad {
        model.document_mut().fills.remove(&id);
        model.patches.remove(&id);
    }
    if good.is_empty() {
        why.unwrap_or(Ok(()))?;
        return Err(HoleError::NothingToFill.into());
    }
    patch::follow(model, Some(relaxer));
    Ok(())
}

/// What a fill through a place of a curve would take, or a sheet along the curve; for a sheet no sides where it takes the curve
/// by itself.
pub(crate) fn found_loop(model: &Model, curve: CurveId, at: DVec3, sheet: bool) -> FoundLoop {
    let places = |side: &FillSide| patch::fill::places(model, side).unwrap_or_default();
    let none = FoundLoop { curve, at, sides: Vec::new(), why: None };
    let found = if sheet {
        sheet_loop(model, curve)
    } else {
        nearest_loop(model, &Neighbours::of(model), curve, Some(at))
    };
    match found {
        Ok(sides) => FoundLoop { sides: sides.iter().map(places).collect(), ..none },
        Err(why) => FoundLoop { why: Some(why.to_string()), ..none },
    }
}

/// Chooses anew how a fill is filled.
pub(super) fn refill(
    model: &mut Model,
    relaxer: &Relaxer,
    id: SurfaceId,
    style: FillStyle,
) -> Result<(), ModelError> {
    let is_there = model.document.kind_of(id).is_some();
    let none = if is_there { HoleError::NoFill(id).into() } else { ModelError::NoSurface(id) };
    model.document_mut().fills.get_mut(&id).ok_or(none)?.style = style;
    model.document.validate()?;
    patch::follow(model, Some(relaxer));
    model.check_fill(id)
}

fn add(model: &mut Model, fill: Fill) -> Result<SurfaceId, ModelError> {
    let id = model.document.next_surface();
    model.document_mut().fills.insert(id, fill);
    model.document.validate()?;
    model.build_patch(id)?;
    Ok(id)
}

/// Turns a loop to face as its neighbours do, and lets each side take its planes from the surface that ends there.
fn with_planes(model: &Model, neighbours: &Neighbours, sides: Vec<FillSide>) -> Vec<FillSide> {
    let is_closed = |id: CurveId| model.document.curves.get(&id).is_some_and(|curve| curve.closed);
    let sides = if neighbours.is_against(model, &sides) { reversed(&sides, is_closed) } else { sides };
    sides.into_iter().map(|side| FillSide { planes: neighbours.beside(model, &side), ..side }).collect()
}

/// The loop through a place of a curve: one along which nothing lies on both sides already, and of these the shortest.
fn nearest_loop(
    model: &Model,
    neighbours: &Neighbours,
    curve: CurveId,
    at: Option<DVec3>,
) -> Result<Vec<FillSide>, ModelError> {
    let shape = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
    if at.is_some_and(|at| !at.is_finite()) {
        return Err(ModelError::BadPosition);
    }
    let curves = Curves::of(model, |_| true);
    let edge = at.and_then(|at| shape.nearest(at)).map_or(0, |(edge, _)| edge);
    let part = curves.part_at(curve, edge, shape.nodes.len()).ok_or(HoleError::NoLoop(curve))?;
    let mut best: Option<((bool, usize, usize), Vec<FillSide>)> = None;
    let mut is_filled = false;
    for found in loops_through(&curves.edges, part) {
        let sides = match curves.alone(&found) {
            Some(alone) => at_corners(model, alone)?,
            None => curves.sides(&found),
        };
        if neighbours.is_filled(model, &sides) {
            is_filled = true;
            continue;
        }
        let key = (sides.len() < 3, neighbours.crowd(model, &sides), sides.len());
        // Of two that are alike in this the shorter one comes first.
        if best.as_ref().is_none_or(|(least, _)| (key.0, key.1) < (least.0, least.1)) {
            best = Some((key, sides));
        }
    }
    let none = if is_filled { HoleError::LoopFilled(curve) } else { HoleError::NoLoop(curve) };
    let (_, sides) = best.ok_or(none)?;
    if sides.len() < 3 { Err(HoleError::FewCorners(curve, sides.len()).into()) } else { Ok(sides) }
}

/// The sides of a closed curve between the control points where it turns sharply.
fn at_corners(model: &Model, id: CurveId) -> Result<Vec<FillSide>, ModelError> {
    let shape = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let count = shape.nodes.len();
    let turns = |sample: usize| {
        let (before, after) = ((sample + count - 1) % count, (sample + 1) % count);
        let (a, b) = (shape.nodes[sample] - shape.nodes[before], shape.nodes[after] - shape.nodes[sample]);
        libm::atan2(a.cross(b).length(), a.dot(b)) > CORNER
    };
    let corners: Vec<PointId> = shape
        .controls
        .iter()
        .filter(|(sample, _)| turns(*sample as usize))
        .map(|(_, point)| *point)
        .collect();
    corners::on_closed(model, id, &corners)
}

/// The curves that hang together with one by points in common.
fn connected(model: &Model, curve: CurveId) -> Result<BTreeSet<CurveId>, ModelError> {
    if !model.document.curves.contains_key(&curve) {
        return Err(ModelError::NoCurve(curve));
    }
    let mut found = BTreeSet::from([curve]);
    let mut open = vec![curve];
    while let Some(id) = open.pop() {
        let Some(curve) = model.document.curves.get(&id) else { continue };
        for other in curve.through.iter().flat_map(|point| model.document.curves_through(*point)) {
            if found.insert(other) {
                open.push(other);
            }
        }
    }
    Ok(found)
}

/// Takes from fills what an act has taken away: the planes of surfaces that are no more, or end at the side no more.
pub(crate) fn forget_lost(model: &mut Model) {
    let lost: Vec<(SurfaceId, usize)> = model
        .document
        .fills
        .iter()
        .flat_map(|(id, fill)| fill.sides.iter().enumerate().map(|(at, side)| (*id, at, side)))
        .filter(|(_, _, side)| side.planes.is_some_and(|beside| !lies_on(model, beside, side)))
        .map(|(id, at, _)| (id, at))
        .collect();
    for (id, at) in lost {
        if let Some(fill) = model.document_mut().fills.get_mut(&id) {
            fill.sides[at].planes = None;
        }
    }
}

fn lies_on(model: &Model, surface: SurfaceId, side: &FillSide) -> bool {
    let curve = side.curve;
    if model.document.curves.get(&curve).is_some_and(|curve| curve.rim == Some(surface)) {
        return true;
    }
    let has_rim = model.document.meshes.contains_key(&surface) || model.document.cages.contains_key(&surface);
    if let Some(patch) = model.patches.get(&surface).filter(|_| has_rim) {
        return patch::fill::places(model, side).is_some_and(|places| PatchRim::new(patch).is_at(&places));
    }
    let fair = model.document.surfaces.get(&surface);
    let fill = model.document.fills.get(&surface);
    fair.is_some_and(|surface| surface.skeleton.curves.iter().any(|e| e.curve == curve))
        || fill.is_some_and(|fill| fill.sides.iter().any(|side| side.curve == curve))
}

/// Refuses an act that took a curve, or a point of one, from a fill that it had before; and one that leaves a fill which could follow its curves
/// before unable to.
pub(super) fn check_kept(model: &Model, before: &Model) -> Result<(), ModelError> {
    for (surface, fill) in &model.document.fills {
        for side in &fill.sides {
            let curve = model.document.curves.get(&side.curve);
            let has = |point| curve.is_some_and(|curve| curve.through.contains(point));
            if !has(&side.from) || !has(&side.to) {
                return Err(ModelError::NeededByFill { surface: *surface, curve: side.curve });
            }
        }
        if before.check_fill(*surface).is_ok() {
            model.check_fill(*surface)?;
        }
    }
    Ok(())
}
