//! The tangent planes along the sides of a fill: those of the surface beside it, where the document names one, and planes that two
//! fills agree on, where neither does.
//!
//! An agreed plane lies half way between what the two ribbons would have by themselves. At a corner all curves of fills there
//! should lie in one plane (see `modeler/network`), and the agreed planes lead up to that one, turning as `twist` says.

use super::precedence::Precedence;
use super::twist::Twists;
use super::{Drawn, FillShape, Side, shape};
use crate::bank;
use crate::model::Model;
use crate::patch::PatchRim;
use crate::relax::Relaxer;
use ductile_patch::s_patch::Domain;
use ductile_patch::{PlaneSample, Ribbon, RibbonLoop, curve_derivative, plane_of_directions};
use ductile_spec::{CurveId, CurveStretch, Document, Fill, FillJoin, FillSide, PointId, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

/// How far from its ends a ribbon that goes first is given planes: there they say how it turns, to this part of that.
const END: f64 = 1e-4;
/// Step in the parameter over which the slope of planes is taken.
const STEP: f64 = 1e-3;
/// Places along a side at which planes are asked for.
const PLACES: usize = 32;
/// Two ribbons whose sum of normals is shorter than this fold back on one another by more than 150°: they agree on nothing.
const FOLDED: f64 = 0.5;
/// Sine of the angle up to which curves at a corner count as lying in one plane: 20°.
pub(super) const COPLANAR: f64 = 0.342;

/// A plane that a side is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Given {
    /// What the ribbon can do about it: the plane turned until the Bézier curve lies in it.
    pub(super) sample: PlaneSample,
    /// The normal of the plane itself, before it is turned.
    normal: DVec3,
}

/// How a side is left in its middle, and with that how along all of it.
#[derive(Clone, Copy, Debug)]
struct Lean {
    /// In radians.
    turn: f64,
    strength: f64,
}

impl Lean {
    /// Whether there is anything but what is fair.
    fn is_some(self) -> bool {
        self.turn != 0.0 || self.strength != 1.0
    }

    /// How the planes are turned at a parameter, in radians, and how far the ribbon reaches across, 1 as is fair.
    ///
    /// With `f = 16 u² (1 - u)²`, which is 1 in the middle and at both ends begins with slope zero, the fair cross derivative `W`, across
    /// the curve, becomes `(1 + (s - 1) f) ((1 + (cos a - 1) f) W + f sin a T × W)`, with `a` the turn, `s` the strength and `T` the unit
    /// tangent. So it leaves corners and twist points as they are, and is a polynomial of a degree that is four higher where the
    /// planes stay and where they turn only.
    fn at(self, u: f64) -> (f64, f64) {
        let f = 16.0 * (u * (1.0 - u)) * (u * (1.0 - u));
        let (sin, cos) = libm::sincos(self.turn);
        let (up, in_plane) = (f * sin, 1.0 + (cos - 1.0) * f);
        (libm::atan2(up, in_plane), libm::hypot(up, in_plane) * (1.0 + (self.strength - 1.0) * f))
    }
}

/// Whether ribbons of a fill are to be otherwise than fair, or follow some that are.
pub(super) fn leans(document: &Document, id: SurfaceId, fill: &Fill) -> bool {
    fill.style.join == FillJoin::Tangent && fill.sides.iter().any(|side| leans_at(document, id, side))
}

fn leans_at(document: &Document, id: SurfaceId, side: &FillSide) -> bool {
    if side.leans() || document.turn_along(id, side) != 0.0 {
        return true;
    }
    let Some((beside, curve)) = side.planes.zip(document.curves.get(&side.curve)) else { return false };
    let is_there =
        |there: &&FillSide| there.curve == side.curve && there.stretch(curve).0 == side.stretch(curve).0;
    // The document is valid: planes never come, round about, from the fill itself.
    let there = document.fills.get(&beside).and_then(|fill| fill.sides.iter().find(is_there));
    there.is_some_and(|there| leans_at(document, beside, there))
}

impl Given {
    /// The angle between the plane and that of a ribbon there, in radians from 0 to π/2: what the curve misses of its direction is in
    /// it. π/2 where the ribbon has no plane.
    pub(super) fn angle(&self, ribbons: &RibbonLoop) -> f64 {
        let Some(ribbon) = ribbons.ribbons().get(self.sample.side) else { return FRAC_PI_2 };
        let along = ribbon.tangent(self.sample.u).normalize_or_zero();
        let normal = PlaneSample { normal: self.normal, ..self.sample }.turned(along);
        let own = ribbon.normal(self.sample.u);
        own.map_or(FRAC_PI_2, |own| libm::atan2(own.cross(normal).length(), own.dot(normal).abs()))
    }
}

/// The planes of all sides of a fill as things are now.
pub(super) fn of(
    model: &Model,
    relaxer: Option<&Relaxer>,
    (precedence, twists): (&Precedence, &Twists),
    id: SurfaceId,
) -> Vec<Given> {
    let (Some(fill), Some(own)) = (model.document.fills.get(&id), shape(model, id)) else {
        return Vec::new();
    };
    if fill.style.join == FillJoin::Position || own.sides.len() != fill.sides.len() {
        return Vec::new();
    }
    let mut planes = Vec::new();
    for (at, (side, drawn)) in fill.sides.iter().zip(&own.sides).enumerate() {
        let first = precedence.first(id, at);
        let is_first = first == Some(id);
        let normals = match side.planes.or(first.filter(|_| !is_first)) {
            Some(beside) if model.document.fills.contains_key(&beside) => of_fill(model, beside, drawn),
            Some(beside) => of_others(model, relaxer, beside, drawn),
            None => match model.document.partner(id, side) {
                None => followed(own, twists, at, drawn),
                Some(_) if is_first => agreed(model, twists, (id, at, drawn), false, [END, 1.0 - END]),
                Some((other, ..)) => {
                    let is_carried = precedence.carries([id, other], drawn.fit.points.len() - 1);
                    agreed(model, twists, (id, at, drawn), is_carried, places())
                }
            },
        };
        let is_end = |u: f64| u == END || u == 1.0 - END;
        let lean = Lean { turn: model.document.turn_along(id, side), strength: side.strength };
        // What leans does so beside the planes that it has by itself.
        let is_alone = side.planes.is_none() && normals.iter().all(|(u, _)| is_end(*u));
        let is_own = is_alone && lean.is_some();
        let normals = if is_own { fair(own, at) } else { normals };
        let on_side = |(u, normal): (f64, DVec3)| {
            // What runs along the curve says nothing of the plane.
            let along = curve_derivative(&drawn.fit.points, u).normalize_or_zero();
            let within = normal - along * along.dot(normal);
            let u = drawn.parameter(u);
            let (turn, reach) = lean.at(u);
            let weight = if is_end(u) { 1.0 / (END * END) } else { 1.0 };
            // What is agreed on is only what is across; of a surface, what the curve misses of its direction counts.
            let normal = if side.planes.is_some() { normal } else { within };
            Given { sample: PlaneSample { side: at, u, normal: within, turn, reach, weight, is_own }, normal }
        };
        planes.extend(normals.into_iter().map(on_side));
    }
    planes
}

/// The normals of a surface that is no fill along a side, by the parameter in the sense of the control curve.
pub(super) fn of_others(
    model: &Model,
    relaxer: Option<&Relaxer>,
    beside: SurfaceId,
    side: &Side,
) -> Vec<(f64, DVec3)> {
    if model.surfaces.contains_key(&beside) {
        of_fair(model, relaxer, beside, side)
    } else {
        of_rim(model, beside, side)
    }
}

fn places() -> impl Iterator<Item = f64> {
    (0..=PLACES).map(|place| place as f64 / PLACES as f64)
}

/// The normals of a fair surface at the samples of a stretch.
fn of_fair(model: &Model, relaxer: Option<&Relaxer>, beside: SurfaceId, side: &Side) -> Vec<(f64, DVec3)> {
    let Some(shape) = model.surfaces.get(&beside) else { return Vec::new() };
    let Some(bound) = relaxer.and_then(|relaxer| relaxer.surface(beside, shape)) else { return Vec::new() };
    let curve: CurveId = side.drawn.stretch.curve;
    let Some(embedded) = shape.embeddings.iter().find(|e| e.curve == curve) else { return Vec::new() };
    let normals = bank::along(model, bound, embedded);
    let sample = |edge: usize| {
        let normal = normals.get((side.drawn.first + edge) % normals.len())?;
        Some((side.parameter_of_sample(edge), *normal))
    };
    (0..=side.drawn.edges).filter_map(sample).collect()
}

/// The normals of a surface over a cage, or of a fixed mesh, along a stretch at its rim: exact at all places where the rim leads the
/// curve, else those of the tessellation at the samples.
fn of_rim(model: &Model, beside: SurfaceId, side: &Side) -> Vec<(f64, DVec3)> {
    let Drawn { stretch, steps, ref places, .. } = side.drawn;
    if let Some(normals) = side.drawn.normals.as_ref().filter(|_| leads(model, beside, stretch.curve)) {
        return side.fit.parameters.iter().copied().zip(normals.iter().copied()).collect();
    }
    let Some(patch) = model.patches.get(&beside) else { return Vec::new() };
    let rim = PatchRim::new(patch);
    let samples = places.iter().step_by(steps).enumerate();
    samples.filter_map(|(edge, at)| Some((side.parameter_of_sample(edge), rim.normal(*at)?))).collect()
}

fn leads(model: &Model, surface: SurfaceId, curve: CurveId) -> bool {
    model.document.curves.get(&curve).is_some_and(|curve| curve.rim == Some(surface))
}

/// The side of a fill that is this stretch, with its number.
pub(crate) fn side_on(model: &Model, fill: SurfaceId, stretch: CurveStretch) -> Option<(usize, &Side)> {
    shape(model, fill)?.sides.iter().enumerate().find(|(_, side)| side.drawn.stretch == stretch)
}

/// The normals of another fill along a stretch, as it is built.
fn of_fill(model: &Model, beside: SurfaceId, side: &Side) -> Vec<(f64, DVec3)> {
    let (Some((at, there)), Some(built)) = (
        side_on(model, beside, side.drawn.stretch),
        shape(model, beside).and_then(|shape| shape.built.as_ref()),
    ) else {
        return Vec::new();
    };
    let is_tangent =
        model.document.fills.get(&beside).is_some_and(|fill| fill.style.join == FillJoin::Tangent);
    let domain = Domain::new(built.patch.sides());
    let normal = |u: f64| {
        let own = there.parameter(u);
        if is_tangent {
            built.ribbons.ribbons().get(at)?.normal(own)
        } else {
            built.patch.at(&domain, domain.on_side(at, own))?.normal()
        }
    };
    places().filter_map(|u| Some((u, normal(u)?))).collect()
}

/// The normals that a side has by itself, by the parameter in the sense of the control curve.
fn fair(own: &FillShape, at: usize) -> Vec<(f64, DVec3)> {
    let Some((side, ribbon)) =
        own.sides.get(at).zip(own.base.as_ref().and_then(|base| base.ribbons().get(at)))
    else {
        return Vec::new();
    };
    places().filter_map(|u| Some((u, ribbon.normal(side.parameter(u))?))).collect()
}

/// What two fills agree on along a stretch: half way between their ribbons, bent at both ends to the planes of the corners.
pub(super) struct Agreement<'a> {
    /// Both ribbons, with their sides.
    between: [(&'a Ribbon, &'a Side); 2],
    /// What is to be added to the normal at the ends.
    bends: [DVec3; 2],
}

/// What a fill and another one agree on along a side, if they do.
pub(super) fn agreement<'a>(
    model: &'a Model,
    id: SurfaceId,
    at: usize,
    side: &'a Side,
) -> Option<Agreement<'a>> {
    let stretch = side.drawn.stretch;
    let asked = model.document.fills.get(&id)?.sides.get(at).filter(|asked| asked.planes.is_none())?;
    let (other, ..) = model.document.partner(id, asked)?;
    let (place, there) = side_on(model, other, stretch)?;
    let ribbon = |id, at: usize| shape(model, id)?.base.as_ref()?.ribbons().get(at);
    let between = [(ribbon(id, at)?, side), (ribbon(other, place)?, there)];
    let mut agreement = Agreement { between, bends: [DVec3::ZERO; 2] };
    let ends = [(stretch.from, 0.0), (stretch.to, 1.0)].map(|(point, u)| {
        let (wanted, now) = (plane_at(model, point)?, agreement.half_way(u)?);
        Some(if wanted.dot(now) < 0.0 { -wanted - now } else { wanted - now })
    });
    agreement.bends = ends.map(Option::unwrap_or_default);
    Some(agreement)
}

impl Agreement<'_> {
    /// The unit normal half way, by the parameter in the sense of the control curve.
    fn half_way(&self, u: f64) -> Option<DVec3> {
        // Normals as they would be if the side ran with the curve; beyond a smooth seam that is the other way up.
        let normal = |(ribbon, side): (&Ribbon, &Side)| {
            let normal = ribbon.normal(side.parameter(u))?;
            Some(if side.drawn.back { -normal } else { normal })
        };
        let sum = normal(self.between[0])? - normal(self.between[1])?;
        (sum.length() > FOLDED).then(|| sum.try_normalize()).flatten()
    }

    /// The normal, not quite of length 1.
    fn bent(&self, u: f64) -> Option<DVec3> {
        // Both bends start at their end with slope zero, so that the planes do not turn in haste.
        let ease = |t: f64| (1.0 - t) * (1.0 - t) * (1.0 + 2.0 * t);
        Some(self.half_way(u)? + self.bends[0] * ease(u) + self.bends[1] * ease(1.0 - u))
    }

    /// The unit normal of the plane that has the tangent of the Bézier curve with these control points in it.
    pub(super) fn normal(&self, points: &[DVec3], u: f64) -> Option<DVec3> {
        let (normal, along) = (self.bent(u)?, curve_derivative(points, u).normalize_or_zero());
        (normal - along * along.dot(normal)).try_normalize()
    }
}

/// The derivative with which a Bézier curve leaves its first point, or its last one.
pub(super) fn leaving(points: &[DVec3], is_last: bool) -> DVec3 {
    if is_last { -curve_derivative(points, 1.0) } else { curve_derivative(points, 0.0) }
}

/// The normals that two fills agree on along a stretch; at its ends they turn as the corners ask for.
fn agreed(
    model: &Model,
    twists: &Twists,
    (id, at, side): (SurfaceId, usize, &Side),
    is_carried: bool,
    places: impl IntoIterator<Item = f64>,
) -> Vec<(f64, DVec3)> {
    let Some(agreement) = agreement(model, id, at, side) else { return Vec::new() };
    let points = &side.fit.points;
    let slope = |is_last: bool| {
        let end = agreement.bent(if is_last { 1.0 } else { 0.0 })?;
        Some(twists.slope((side.drawn.stretch, is_last), end, leaving(points, is_last)))
    };
    let [first, last] = [false, true].map(|is_last| slope(is_last).unwrap_or_default());
    // Of slope 1 at its end, and gone with slope zero at the other one.
    let turn = |t: f64| t * (1.0 - t) * (1.0 - t);
    let normal = |u: f64| Some(agreement.bent(u)? + first * turn(u) + last * turn(1.0 - u));
    let carried = if is_carried { carried(points, normal) } else { None };
    let normal = |u: f64| {
        let Some(across) = carried else { return normal(u) };
        Some(curve_derivative(points, u).normalize_or_zero().cross(hermite(across, u)))
    };
    places.into_iter().filter_map(|u| Some((u, normal(u)?))).collect()
}

/// The normals near the ends of a side that others follow, turned as the corners there ask for.
fn followed(own: &FillShape, twists: &Twists, at: usize, side: &Side) -> Vec<(f64, DVec3)> {
    let Some(ribbon) = own.base.as_ref().and_then(|base| base.ribbons().get(at)) else { return Vec::new() };
    let end = |is_last: bool| {
        let end = (side.drawn.stretch, is_last);
        let u = if is_last { 1.0 - END } else { END };
        let normal = ribbon.normal(side.parameter(u)).filter(|_| twists.knows(end))?;
        Some((u, normal + twists.slope(end, normal, leaving(&side.fit.points, is_last)) * END))
    };
    [false, true].into_iter().filter_map(end).collect()
}

/// What leads across a curve in planes with these normals, at both ends, and how it turns there: with it agreed planes are polynomials.
fn carried(points: &[DVec3], normal: impl Fn(f64) -> Option<DVec3>) -> Option<[DVec3; 4]> {
    let across = |u: f64| {
        let (normal, along) = (normal(u)?, curve_derivative(points, u).normalize_or_zero());
        normal.cross(along).try_normalize()
    };
    let end = |at: fn(f64) -> f64| {
        let [here, next, far] = [across(at(0.0))?, across(at(STEP))?, across(at(2.0 * STEP))?];
        Some([here, (next * 4.0 - here * 3.0 - far) / (2.0 * STEP)])
    };
    let ([first, leaves], [last, arrives]) = (end(|t| t)?, end(|t| 1.0 - t)?);
    Some([first, leaves, last, arrives])
}

/// The cubic with these values and inward slopes at its ends.
fn hermite([first, leaves, last, arrives]: [DVec3; 4], u: f64) -> DVec3 {
    let half =
        |value: DVec3, slope: DVec3, t: f64| (value * (1.0 + 2.0 * t) + slope * t) * ((1.0 - t) * (1.0 - t));
    half(first, leaves, u) + half(last, arrives, 1.0 - u)
}

/// The normal of the plane in which all curves of fills at a corner lie, if they nearly do.
fn plane_at(model: &Model, point: PointId) -> Option<DVec3> {
    let mut leaving: BTreeMap<CurveStretch, DVec3> = BTreeMap::new();
    for id in model.document.fills.keys() {
        for side in shape(model, *id).into_iter().flat_map(|shape| &shape.sides) {
            let points = &side.fit.points;
            let stretch = side.drawn.stretch;
            if stretch.from == point {
                leaving.insert(stretch, points[1] - points[0]);
            } else if stretch.to == point {
                leaving.insert(stretch, points[points.len() - 2] - points[points.len() - 1]);
            }
        }
    }
    let directions: Vec<DVec3> = leaving.into_values().collect();
    plane_of_directions(&directions).filter(|(_, off)| *off < COPLANAR).map(|(normal, _)| normal)
}
