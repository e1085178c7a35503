//! `trim`: two surfaces are cut along their intersection and joined there (thesis section 3.4.1). The intersection is taken
//! as a snapshot: a fair curve through points of it, which is a control curve of both from then on.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::delete::forget_lost_curves;
use crate::operation::s_loop::draw;
use crate::operation::{refresh_skeleton, smooth};
use crate::shape::SurfaceShape;
use crate::surgery::following::follow;
use crate::surgery::joining::{said, say};
use crate::surgery::opening::{edges_around, open};
use crate::surgery::pieces::{Banks, settle};
use crate::surgery::tracing::Stop;
use ductile_mesh::{CommonLine, FaceId, SourceTag, intersections, nearest_place};
use ductile_spec::{CurveId, MeetingLine, On, SurfaceId};
use glam::DVec3;
use std::collections::BTreeSet;
use std::sync::Arc;

/// A control point for so much turning of the intersection, in radians: six round a circle.
const TURNING: f64 = core::f64::consts::FRAC_PI_3;
/// Fewest and most control points of an intersection.
const FEWEST: usize = 6;
const MOST: usize = 24;

/// Cuts two surfaces along the lines in which they meet, keeps the parts at two places and joins them there.
pub(super) fn trim(model: &mut Model, first: On, second: On, is_smooth: bool) -> Result<(), ModelError> {
    let (one, other) = (first.surface, second.surface);
    if one == other {
        return Err(ModelError::TrimsItself(one));
    }
    if !(first.at.is_finite() && second.at.is_finite()) {
        return Err(ModelError::BadPosition);
    }
    let lines = lines(model, one, other)?;
    let curves = lines.iter().map(|line| snapshot(model, one, other, line)).collect::<Result<Vec<_>, _>>()?;
    // A line counts if it bounds what is kept on both surfaces; the others cut nothing off.
    let bounds = |on: On| -> Result<BTreeSet<CurveId>, ModelError> {
        let shape = model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?;
        let is_in = part_at(shape, on, &curves)?;
        let around = edges_around(&shape.mesh, &is_in);
        Ok(around.into_iter().filter_map(|e| shape.mesh.edge_source(e)).map(|tag| CurveId(tag.0)).collect())
    };
    let (of_first, of_second) = (bounds(first)?, bounds(second)?);
    let common: Vec<CurveId> =
        curves.iter().copied().filter(|c| of_first.contains(c) && of_second.contains(c)).collect();
    if common.is_empty() {
        return Err(ModelError::PartsApart(one, other));
    }
    let before = [one, other].map(|id| model.surfaces.get(&id).map(Arc::clone));
    for on in [first, second] {
        let shape = model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?;
        let is_in = part_at(shape, on, &common)?;
        let edges = edges_around(&shape.mesh, &is_in);
        let is_gone = is_in.iter().map(|is_in| !is_in).collect();
        let opening = open(model, on.surface, &edges, Some(is_gone))?;
        settle(model, on.surface, opening, Banks::Joint)?;
    }
    // The rims of what was cut off are nobody's any more.
    before.iter().flatten().for_each(|shape| forget_lost_curves(model, shape));
    for curve in curves.iter().filter(|curve| !common.contains(curve)) {
        if model.document.curves.contains_key(curve) {
            super::delete::curve(model, *curve)?;
        }
    }
    if is_smooth {
        for curve in common {
            smooth::smooth(model, curve)?;
        }
    }
    Ok(())
}

/// The lines in which two surfaces meet now: what a trim would cut along, and those that it would refuse.
///
/// # Errors
/// [`ModelError`] if there is no such surface, if both are the same or if it cannot be told.
pub(crate) fn meeting(
    model: &Model,
    one: SurfaceId,
    other: SurfaceId,
) -> Result<Vec<MeetingLine>, ModelError> {
    if one == other {
        return Err(ModelError::TrimsItself(one));
    }
    let told = |line: CommonLine| MeetingLine {
        along: line.points.iter().map(|point| point.position).collect(),
        closed: line.is_closed,
    };
    Ok(common(model, one, other)?.into_iter().map(told).collect())
}

/// All lines in which two surfaces meet.
fn common(model: &Model, one: SurfaceId, other: SurfaceId) -> Result<Vec<CommonLine>, ModelError> {
    let [a, b] = [one, other].map(|id| model.surfaces.get(&id).ok_or(ModelError::NoSurface(id)));
    let (a, b) = (a?, b?);
    intersections((&a.mesh, &a.positions), (&b.mesh, &b.positions)).map_err(|why| ModelError::Untold {
        one,
        other,
        why,
    })
}

/// The closed lines in which two surfaces meet.
fn lines(model: &Model, one: SurfaceId, other: SurfaceId) -> Result<Vec<CommonLine>, ModelError> {
    let lines = common(model, one, other)?;
    if lines.is_empty() {
        return Err(ModelError::NoMeeting(one, other));
    }
    if lines.iter().any(|line| !line.is_closed) {
        return Err(ModelError::OpenMeeting(one, other));
    }
    Ok(lines)
}

/// Lays a fair curve through points of a line into both surfaces.
fn snapshot(
    model: &mut Model,
    one: SurfaceId,
    other: SurfaceId,
    line: &CommonLine,
) -> Result<CurveId, ModelError> {
    let points: Vec<DVec3> = line.points.iter().map(|point| point.position).collect();
    let stops = samples(&points).into_iter().map(|at| Stop { at, point: None }).collect();
    let curve = draw(model, one, stops, true)?;
    let told = said(model, other);
    follow(model, other, curve)?;
    refresh_skeleton(model, other);
    say(model, other, &told);
    Ok(curve)
}

/// Points spread evenly along a closed line, as many as its turning asks for.
fn samples(line: &[DVec3]) -> Vec<DVec3> {
    let count = line.len();
    let step = |k: usize| line[(k + 1) % count] - line[k];
    let total: f64 = (0..count).map(|k| step(k).length()).sum();
    // The turning of what is left when the mesh's own zigzag is averaged away: chords of a thirtieth of the whole.
    let coarse: Vec<DVec3> = (0..30).map(|k| along(line, total * f64::from(k) / 30.0)).collect();
    let chord = |k: usize| (coarse[(k + 1) % 30] - coarse[k % 30]).normalize_or_zero();
    let turning: f64 = (0..30).map(|k| libm::acos(chord(k).dot(chord(k + 1)).clamp(-1.0, 1.0))).sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
    let wanted = (libm::ceil(turning / TURNING - 0.5) as usize).clamp(FEWEST, MOST);
    (0..wanted).map(|k| along(line, total * k as f64 / wanted as f64)).collect()
}

/// The place at a distance along a closed line.
fn along(line: &[DVec3], mut distance: f64) -> DVec3 {
    for k in 0..line.len() {
        let (from, to) = (line[k], line[(k + 1) % line.len()]);
        let length = from.distance(to);
        if distance <= length && length > 0.0 {
            return from.lerp(to, distance / length);
        }
        distance -= length;
    }
    line[0]
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
