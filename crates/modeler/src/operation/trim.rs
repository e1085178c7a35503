//! `trim`: two surfaces are cut along their intersection and joined there (thesis section 3.4.1). The intersection is taken
//! as a snapshot: fair curves through points of it, which are control curves of both from then on.
//!
//! A closed line counts if it bounds what is kept of both surfaces. A line that ends at rims counts if it bounds what is kept
//! of one: that surface is cut along it. The other one is cut, too, if the line divides it; if not, the line becomes a control
//! curve inside it, and what was cut of the first stands there. So nothing is ever slit.

mod lines;
mod ribbon;

use crate::error::{ModelError, TrimError};
use crate::model::Model;
use crate::operation::delete::forget_lost_curves;
use crate::operation::smooth;
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use crate::surgery::opening::{edges_around, open};
use crate::surgery::pieces::{Banks, settle};
use ductile_mesh::{FaceId, SourceTag, nearest_place};
use ductile_spec::{CurveId, JoinRibbon, On};
use lines::{Snapshot, snapshots};
use ribbon::{Fitted, at_angle, hold, hold_between};
use std::collections::BTreeSet;
use std::sync::Arc;

pub(crate) use lines::meeting;

/// Cuts two surfaces along the lines in which they meet, keeps the parts at two places and joins them there.
pub(super) fn trim(
    (model, relaxer): (&mut Model, &Relaxer),
    kept: [On; 2],
    is_smooth: bool,
    ribbon: Option<JoinRibbon>,
) -> Result<(), ModelError> {
    let [one, other] = kept.map(|on| on.surface);
    check(kept, is_smooth, ribbon)?;
    let fitted = match ribbon {
        Some(_) => Some([Fitted::new(model, relaxer, one)?, Fitted::new(model, relaxer, other)?]),
        None => None,
    };
    let curves = snapshots(model, one, other)?;
    let of = [bounding(model, kept[0], &curves)?, bounding(model, kept[1], &curves)?];
    let counts = |line: &&Snapshot| {
        let [first, second] = [&of[0], &of[1]].map(|of| of.contains(&line.curve));
        if line.closed { first && second } else { first || second }
    };
    let common: Vec<CurveId> = curves.iter().filter(counts).map(|line| line.curve).collect();
    if common.is_empty() {
        return Err(TrimError::PartsApart(one, other).into());
    }
    if let Some(stands) = common.iter().find(|curve| !of.iter().all(|of| of.contains(curve)))
        && (is_smooth || matches!(ribbon, Some(JoinRibbon::Angle(_))))
    {
        let on = if of[0].contains(stands) { other } else { one };
        return Err(TrimError::StandsInside(on).into());
    }
    let mut leaving = Vec::new();
    if let (Some(fitted), Some(ribbon)) = (&fitted, ribbon) {
        let parts = [part_of(model, kept[0], &common)?, part_of(model, kept[1], &common)?];
        for curve in &common {
            let cross = |k: usize| fitted[k].leaving(model, (&parts[k].0, &parts[k].1), *curve);
            leaving.push((*curve, at_angle(model, *curve, ribbon, [cross(0)?, cross(1)?])?));
        }
    }
    cut(model, kept, &common)?;
    for curve in curves.iter().map(|line| line.curve).filter(|curve| !common.contains(curve)) {
        if model.document.curves.contains_key(&curve) {
            super::delete::curve(model, curve)?;
        }
    }
    if is_smooth {
        for curve in &common {
            smooth::smooth(model, *curve)?;
        }
    }
    for (curve, both) in leaving {
        if is_smooth {
            hold_between(model, curve, &both)?;
            continue;
        }
        for ((id, cross), own) in [one, other].into_iter().zip(both).zip(&of) {
            // What is not cut runs on through the curve.
            if own.contains(&curve) {
                hold(model, id, curve, cross)?;
            }
        }
    }
    Ok(())
}

/// Refuses what is no trim, whatever the surfaces are.
fn check(kept: [On; 2], is_smooth: bool, ribbon: Option<JoinRibbon>) -> Result<(), ModelError> {
    if kept[0].surface == kept[1].surface {
        return Err(TrimError::TrimsItself(kept[0].surface).into());
    }
    if kept.iter().any(|on| !on.at.is_finite()) {
        return Err(ModelError::BadPosition);
    }
    match ribbon {
        Some(JoinRibbon::Angle(angle)) if is_smooth || !(angle > 0.0 && angle <= core::f64::consts::PI) => {
            Err(TrimError::BadJoinAngle.into())
        }
        _ => Ok(()),
    }
}

/// Cuts both surfaces along curves that bound what is kept of them, and gives up the rest.
fn cut(model: &mut Model, kept: [On; 2], common: &[CurveId]) -> Result<(), ModelError> {
    let before = kept.map(|on| model.surfaces.get(&on.surface).map(Arc::clone));
    let known: BTreeSet<CurveId> = model.curves.keys().copied().collect();
    for on in kept {
        let (shape, is_in) = part_of(model, on, common)?;
        let edges = edges_around(&shape.mesh, &is_in);
        if edges.is_empty() {
            continue;
        }
        let is_gone = is_in.iter().map(|is_in| !is_in).collect();
        let opening = open(model, on.surface, &edges, Some(is_gone))?;
        settle(model, on.surface, opening, Banks::Joint)?;
    }
    // The rims of what was cut off are nobody's any more, nor are those parts of divided curves that lay there.
    for part in model.curves.keys().copied().filter(|id| !known.contains(id)).collect::<Vec<_>>() {
        if model.document.surfaces_on(part).next().is_none() {
            model.document_mut().curves.remove(&part);
            model.curves.remove(&part);
        }
    }
    before.iter().flatten().for_each(|shape| forget_lost_curves(model, shape));
    Ok(())
}

/// The curves around the part of a surface at a place.
fn bounding(model: &Model, on: On, curves: &[Snapshot]) -> Result<BTreeSet<CurveId>, ModelError> {
    let curves: Vec<CurveId> = curves.iter().map(|line| line.curve).collect();
    let (shape, is_in) = part_of(model, on, &curves)?;
    let around = edges_around(&shape.mesh, &is_in);
    Ok(around.into_iter().filter_map(|e| shape.mesh.edge_source(e)).map(|tag| CurveId(tag.0)).collect())
}

/// A surface, and its part at a place.
fn part_of(model: &Model, on: On, curves: &[CurveId]) -> Result<(Arc<SurfaceShape>, Vec<bool>), ModelError> {
    let shape = Arc::clone(model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?);
    let is_in = part_at(&shape, on, curves)?;
    Ok((shape, is_in))
}

/// The part of a surface at a place, bounded by some curves and rims: by face slot, whether it belongs to it.
fn part_at(shape: &SurfaceShape, on: On, curves: &[CurveId]) -> Result<Vec<bool>, ModelError> {
    let mesh = &shape.mesh;
    let place = nearest_place(mesh, &shape.positions, on.at).ok_or(ModelError::NoSurface(on.surface))?;
    let mut is_in = vec![false; mesh.face_slots()];
    let start = place.face(mesh);
    is_in[start.index()] = true;
    let mut ahead: Vec<FaceId> = vec![start];
    while let Some(face) = ahead.pop() {
        for side in face.halfedges() {
            let tag = mesh.edge_source(mesh.edge_of(side));
            let is_border = tag.is_some_and(|SourceTag(curve)| curves.contains(&CurveId(curve)));
            if let Some(beyond) = mesh.twin(side).map(|twin| twin.face()).filter(|_| !is_border)
                && !core::mem::replace(&mut is_in[beyond.index()], true)
            {
                ahead.push(beyond);
            }
        }
    }
    Ok(is_in)
}
