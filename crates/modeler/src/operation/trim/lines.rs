//! The lines in which two surfaces meet, and fair curves in their place.

use crate::error::{ModelError, TrimError};
use crate::model::Model;
use crate::operation::refresh_skeleton;
use crate::operation::s_loop::draw;
use crate::surgery::following::follow;
use crate::surgery::joining::{said, say};
use crate::surgery::tracing::{Stop, rim_near};
use ductile_mesh::{CommonLine, IntersectError, intersections};
use ductile_spec::{CurveId, MeetingLine, SurfaceId};
use glam::DVec3;

/// A control point for so much turning of the intersection, in radians: six round a circle.
const TURNING: f64 = core::f64::consts::FRAC_PI_3;
/// Fewest and most control points of a closed intersection.
const FEWEST: usize = 6;
const MOST: usize = 24;
/// Fewest of one that is open: its ends and one between, so that it can be bent.
const FEWEST_OPEN: usize = 3;
/// Chords of the coarse line whose turning is measured: what the mesh's own zigzag does is averaged away.
const CHORDS: usize = 30;
/// Least length of a line, in edges of the finer surface: if it closes, and if it does not.
const LEAST_LOOP: f64 = 2.0;
const LEAST_CUT: f64 = 1.0;

/// A curve in the place of a line in which two surfaces meet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Snapshot {
    pub(super) curve: CurveId,
    pub(super) closed: bool,
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
        return Err(TrimError::TrimsItself(one).into());
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
    intersections((&a.mesh, &a.positions), (&b.mesh, &b.positions)).map_err(|why| {
        let at = match why {
            IntersectError::Tangent(f, _) | IntersectError::Unresolved(f, _) => {
                a.mesh.face_vertices(f).iter().map(|v| a.positions[v.index()]).sum::<DVec3>() / 3.0
            }
            IntersectError::NotFinite(..) => DVec3::NAN,
        };
        TrimError::Untold { one, other, at, why }.into()
    })
}

/// Refuses a line that is too short to be a curve on meshes like these: a hole of less than two edges, a cut of less than one.
/// To leave it out would leave surfaces that run through one another there.
fn check_length(
    model: &Model,
    [one, other]: [SurfaceId; 2],
    line: &[DVec3],
    closed: bool,
) -> Result<(), ModelError> {
    let spacing = model.spacing_of(one).min(model.spacing_of(other));
    let least = if closed { LEAST_LOOP * spacing } else { LEAST_CUT * spacing };
    let closing = closed.then(|| line[0].distance(line[line.len() - 1]));
    let length = line.windows(2).map(|pair| pair[0].distance(pair[1])).chain(closing).sum::<f64>();
    if length < least {
        let at = line.iter().sum::<DVec3>() / line.len() as f64;
        return Err(TrimError::OnlyTouch { one, other, at, least }.into());
    }
    Ok(())
}

/// Lays fair curves into both surfaces, in the place of all lines that may divide one of them: those that close, and those
/// that run from rim to rim of one. One that ends inside both surfaces divides neither.
pub(super) fn snapshots(
    model: &mut Model,
    one: SurfaceId,
    other: SurfaceId,
) -> Result<Vec<Snapshot>, ModelError> {
    let lines = common(model, one, other)?;
    if lines.is_empty() {
        return Err(TrimError::NoMeeting(one, other).into());
    }
    let (mut sound, mut loose) = (Vec::new(), None);
    for line in lines {
        let points: Vec<DVec3> = line.points.iter().map(|point| point.position).collect();
        check_length(model, [one, other], &points, line.is_closed)?;
        match host(model, [one, other], &points, line.is_closed) {
            Ok(host) => sound.push((points, line.is_closed, host)),
            Err(at) => loose = loose.or(Some(at)),
        }
    }
    if let (true, Some(at)) = (sound.is_empty(), loose) {
        return Err(TrimError::OpenMeeting { one, other, at }.into());
    }
    let mut curves = Vec::new();
    for (points, closed, host) in sound {
        let guest = if host == one { other } else { one };
        curves.push(Snapshot { curve: snapshot(model, host, guest, &points, closed)?, closed });
    }
    Ok(curves)
}

/// The surface on which a line is drawn first: if it is open, one of which it runs from rim to rim. If there is none, where the
/// line ends inside the first surface, or else inside the second.
fn host(model: &Model, both: [SurfaceId; 2], line: &[DVec3], closed: bool) -> Result<SurfaceId, DVec3> {
    if closed {
        return Ok(both[0]);
    }
    let mut inside = None;
    for id in both {
        let Some(shape) = model.surfaces.get(&id) else { continue };
        let ends = [line[0], line[line.len() - 1]];
        match ends.into_iter().find(|end| rim_near(shape, *end).is_none()) {
            None => return Ok(id),
            Some(end) => inside = inside.or(Some(end)),
        }
    }
    Err(inside.unwrap_or(line[0]))
}

/// Lays a fair curve through points of a line into both surfaces.
fn snapshot(
    model: &mut Model,
    host: SurfaceId,
    guest: SurfaceId,
    line: &[DVec3],
    closed: bool,
) -> Result<CurveId, ModelError> {
    let stops = samples(line, closed).into_iter().map(|at| Stop { at, point: None }).collect();
    let curve = draw(model, host, stops, closed)?;
    let told = said(model, guest);
    follow(model, guest, curve)?;
    refresh_skeleton(model, guest);
    say(model, guest, &told);
    Ok(curve)
}

/// Points spread evenly along a line, as many as its turning asks for; those of an open one begin and end where it does.
fn samples(line: &[DVec3], closed: bool) -> Vec<DVec3> {
    let count = line.len();
    let steps = if closed { count } else { count - 1 };
    let total: f64 = (0..steps).map(|k| line[k].distance(line[(k + 1) % count])).sum();
    let place = |k: usize, of: usize| along(line, closed, total * k as f64 / of as f64);
    let coarse: Vec<DVec3> = (0..=CHORDS).map(|k| place(k, CHORDS)).collect();
    let chord = |k: usize| (coarse[k % CHORDS + 1] - coarse[k % CHORDS]).normalize_or_zero();
    let bends = if closed { CHORDS } else { CHORDS - 1 };
    let turning: f64 = (0..bends).map(|k| libm::acos(chord(k).dot(chord(k + 1)).clamp(-1.0, 1.0))).sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small positive number")]
    let wanted = libm::ceil(turning / TURNING - 0.5).max(0.0) as usize;
    if closed {
        let wanted = wanted.clamp(FEWEST, MOST);
        return (0..wanted).map(|k| place(k, wanted)).collect();
    }
    let wanted = (wanted + 1).clamp(FEWEST_OPEN, MOST);
    (0..wanted).map(|k| place(k, wanted - 1)).collect()
}

/// The place at a distance along a line.
fn along(line: &[DVec3], closed: bool, mut distance: f64) -> DVec3 {
    let count = line.len();
    let steps = if closed { count } else { count - 1 };
    for k in 0..steps {
        let (from, to) = (line[k], line[(k + 1) % count]);
        let length = from.distance(to);
        if distance <= length && length > 0.0 {
            return from.lerp(to, distance / length);
        }
        distance -= length;
    }
    line[if closed { 0 } else { count - 1 }]
}
