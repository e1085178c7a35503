//! How agreed planes turn about their curves at a corner, so that patches can be smooth there.
//!
//! A twist point of a patch belongs to two sides, and both say what its height over the tangent plane is: the cross derivative of
//! side `k` begins as the derivative of side `l`, and has to stay in the planes of `k`, and the other way round. With normals `n`,
//! unit directions `e` that leave the corner, and `c = n × e`,
//!
//! ```text
//! e_l · dn_k/ds = e_k · dn_l/ds,   that is   (e_k · e_l) (α_k - α_l) + n · (e_k × e_l) (σ_k + σ_l) = 0
//! ```
//!
//! Here `α = e · dn/ds` is minus the normal curvature of the curve, and `σ = c · dn/ds`, which the planes are free in. (The
//! derivatives are Gauss' and Weingarten's; the system is that of vertex enclosure, J. Peters 1991.) Around an odd number of curves
//! it has one solution, around an even number none or many: it is met in the sense of least squares, with the least change.
//!
//! A side that takes its planes from another surface has the slope of those, and stays as it is. A fill that others follow, without planes from
//! elsewhere along that side, turns as the corner asks for, and they turn along.

use super::planes::{Agreement, agreement, of_others};
use super::precedence::Precedence;
use super::{Side, shape, side_on};
use crate::model::Model;
use crate::relax::Relaxer;
use ductile_patch::curve_derivative;
use ductile_solver::SymmetricFactor;
use ductile_spec::{CurveStretch, FillJoin, PointId, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;

/// What is unchanged weighs beside the equations.
const KEPT: f64 = 1e-6;
/// What it weighs where a curve has too low a degree: the twist points are all that a ribbon of degree 3 has, and it could follow such planes
/// at its ends only.
const STIFF: f64 = 1e3;
/// What it weighs where another surface has it so.
const GIVEN: f64 = 1e9;
/// The least degree of a ribbon that has points beside its twist points.
const LEAST_DEGREE: usize = 4;
/// Places from an end on that the slope of given planes is taken from.
const LOOKS: usize = 4;
/// Step in the parameter of a side over which a slope is taken.
const STEP: f64 = 1e-3;

/// An end of a stretch: whether it is the last one in the sense of the curve.
type End = (CurveStretch, bool);

/// For ends of stretches along which two fills agree: by how much more their planes turn about the curve, per length, than what lies
/// half way between the fills does.
#[derive(Clone, Debug, Default)]
pub(super) struct Twists(BTreeMap<End, f64>);

/// An agreed plane at an end of its stretch.
#[derive(Clone, Copy, Debug)]
struct Leaving {
    normal: DVec3,
    /// The unit direction in which the curve leaves.
    along: DVec3,
    /// Derivative of the normal by the length of the curve.
    slope: DVec3,
    /// What leaving it as it is weighs.
    kept: f64,
}

/// A corner of a fill: the ends of its two sides there.
#[derive(Clone, Copy, Debug)]
struct Corner {
    id: SurfaceId,
    /// The numbers of the sides.
    sides: [usize; 2],
    ends: [End; 2],
}

impl Twists {
    /// Those of all corners of fills as their curves are now. Without a relaxer nothing is known of fair surfaces.
    pub(super) fn new(model: &Model, relaxer: Option<&Relaxer>, precedence: &Precedence) -> Self {
        let mut ends: BTreeMap<End, Leaving> = BTreeMap::new();
        let mut corners: BTreeMap<PointId, Vec<Corner>> = BTreeMap::new();
        for (id, fill) in model.document.fills.iter().filter(|(_, fill)| fill.style.join == FillJoin::Tangent)
        {
            let Some(own) = shape(model, *id).filter(|own| own.sides.len() == fill.sides.len()) else {
                continue;
            };
            let count = own.sides.len();
            for (at, side) in own.sides.iter().enumerate() {
                let previous = (at + count - 1) % count;
                let (before, drawn) = (&own.sides[previous].drawn, &side.drawn);
                let pair = [(drawn.stretch, drawn.back), (before.stretch, !before.back)];
                let corner = Corner { id: *id, sides: [at, previous], ends: pair };
                corners.entry(fill.sides[at].from).or_default().push(corner);
                let Some(agreed) = agreement(model, *id, at, side) else { continue };
                let is_free = side.fit.points.len() > LEAST_DEGREE || can_turn(model, precedence, *id, at);
                for is_last in [false, true] {
                    let kept = if is_free { KEPT } else { STIFF };
                    if let Some(leaving) = Leaving::new(&agreed, &side.fit.points, is_last, kept) {
                        ends.entry((drawn.stretch, is_last)).or_insert(leaving);
                    }
                }
            }
        }
        for corners in corners.values() {
            let given = given(model, relaxer, corners, &ends);
            ends.extend(given);
        }
        Self(corners.values().flat_map(|corners| around(corners, &ends)).collect())
    }

    /// What to add to the slope of the normals, by the parameter from an end on, where the curve leaves with that derivative.
    pub(super) fn slope(&self, end: End, normal: DVec3, derivative: DVec3) -> DVec3 {
        self.0.get(&end).map_or(DVec3::ZERO, |more| normal.cross(derivative) * *more)
    }

    /// Whether anything is said of an end.
    pub(super) fn knows(&self, end: End) -> bool {
        self.0.contains_key(&end)
    }
}

/// Whether ribbons along a curve of the least degree can turn their planes at its ends all the same: one of them follows the other, or both are
/// of higher degrees.
fn can_turn(model: &Model, precedence: &Precedence, id: SurfaceId, at: usize) -> bool {
    let Some(side) = model.document.fills.get(&id).and_then(|fill| fill.sides.get(at)) else { return false };
    let is_higher = |id| precedence.degree(id) > LEAST_DEGREE;
    let both =
        || model.document.partner(id, side).is_some_and(|(other, ..)| is_higher(id) && is_higher(other));
    precedence.first(id, at).is_some() || both()
}

/// The planes that other surfaces give at a point where fills agree on others.
fn given(
    model: &Model,
    relaxer: Option<&Relaxer>,
    corners: &[Corner],
    ends: &BTreeMap<End, Leaving>,
) -> Vec<(End, Leaving)> {
    let mut found = Vec::new();
    if !corners.iter().flat_map(|corner| corner.ends).any(|end| ends.contains_key(&end)) {
        return found;
    }
    for corner in corners {
        for (at, end) in corner.sides.into_iter().zip(corner.ends) {
            let asked = model.document.fills.get(&corner.id).and_then(|fill| fill.sides.get(at));
            let Some(beside) = asked.and_then(|asked| asked.planes) else { continue };
            let Some(side) = shape(model, corner.id).and_then(|shape| shape.sides.get(at)) else { continue };
            // A fill that has no planes along it can turn its own there.
            let turns = |(at, _): (usize, &Side)| {
                model.document.fills.get(&beside).is_some_and(|fill| fill.sides[at].planes.is_none())
            };
            let kept =
                if side_on(model, beside, side.drawn.stretch).is_some_and(turns) { KEPT } else { GIVEN };
            let normals = if model.document.fills.contains_key(&beside) {
                of_fill(model, beside, side, end)
            } else {
                of_others(model, relaxer, beside, side)
            };
            found.extend(Leaving::of(normals, &side.fit.points, end.1, kept).map(|leaving| (end, leaving)));
        }
    }
    found
}

/// The normals near an end that a fill has beside another one, before its planes are turned.
fn of_fill(model: &Model, beside: SurfaceId, side: &Side, (_, is_last): End) -> Vec<(f64, DVec3)> {
    let Some((at, there)) = side_on(model, beside, side.drawn.stretch) else { return Vec::new() };
    let Some(base) = shape(model, beside).and_then(|shape| shape.base.as_ref()) else { return Vec::new() };
    let place = |step: usize| {
        let u = step as f64 * STEP;
        let u = if is_last { 1.0 - u } else { u };
        Some((u, base.ribbons().get(at)?.normal(there.parameter(u))?))
    };
    (0..LOOKS).filter_map(place).collect()
}

impl Leaving {
    /// Of planes with these normals, by the parameter.
    fn of(mut normals: Vec<(f64, DVec3)>, points: &[DVec3], is_last: bool, kept: f64) -> Option<Self> {
        normals.sort_by(|a, b| if is_last { b.0.total_cmp(&a.0) } else { a.0.total_cmp(&b.0) });
        normals.truncate(LOOKS);
        let (end, first) = *normals.first()?;
        let within = |(u, normal): (f64, DVec3)| {
            let along = curve_derivative(points, u).normalize_or_zero();
            let within = (normal - along * along.dot(normal)).try_normalize()?;
            Some((u, if within.dot(first) < 0.0 { -within } else { within }))
        };
        let all: Vec<(f64, DVec3)> = normals.into_iter().map(within).collect::<Option<_>>()?;
        // The derivative of the polynomial through them, by the differences to the first.
        let mut slope = DVec3::ZERO;
        for (k, (u, normal)) in all.iter().enumerate().skip(1) {
            let others = all.iter().enumerate().skip(1).filter(|(other, _)| *other != k);
            let share: f64 = others.map(|(_, (other, _))| (end - other) / (u - other)).product();
            slope += (*normal - all[0].1) * (share / (u - end).abs());
        }
        let derivative = super::planes::leaving(points, is_last);
        let slope = slope / derivative.length();
        let found = Self { normal: all[0].1, along: derivative.normalize_or_zero(), slope, kept };
        (all.len() > 1 && slope.is_finite()).then_some(found)
    }

    fn new(agreed: &Agreement<'_>, points: &[DVec3], is_last: bool, kept: f64) -> Option<Self> {
        let normal = |step: f64| agreed.normal(points, if is_last { 1.0 - step * STEP } else { step * STEP });
        let [here, next, far] = [normal(0.0)?, normal(1.0)?, normal(2.0)?];
        let derivative = super::planes::leaving(points, is_last);
        let slope = (next * 4.0 - here * 3.0 - far) / (2.0 * STEP * derivative.length());
        slope.is_finite().then_some(Self { normal: here, along: derivative.normalize_or_zero(), slope, kept })
    }

    fn flipped(self) -> Self {
        Self { normal: -self.normal, slope: -self.slope, ..self }
    }
}

/// The changes at one point: by end, what is to be added to `σ`.
fn around(corners: &[Corner], ends: &BTreeMap<End, Leaving>) -> Vec<(End, f64)> {
    let pairs = corners.iter().map(|corner| &corner.ends);
    let met: Vec<&[End; 2]> = pairs.filter(|pair| pair.iter().all(|end| ends.contains_key(end))).collect();
    let mut unknowns: Vec<End> = met.iter().flat_map(|pair| pair.iter().copied()).collect();
    unknowns.sort_unstable();
    unknowns.dedup();
    let Some(up) = unknowns.first().map(|end| ends[end].normal) else { return Vec::new() };
    let upright = |end: &End| if ends[end].normal.dot(up) < 0.0 { ends[end].flipped() } else { ends[end] };
    let mut entries: Vec<(usize, usize, f64)> =
        unknowns.iter().enumerate().map(|(k, end)| (k, k, ends[end].kept)).collect();
    let mut right = vec![0.0; unknowns.len()];
    for [one, other] in met {
        let (k, l) = (upright(one), upright(other));
        let misses = l.along.dot(k.slope) - k.along.dot(l.slope);
        let sine = up.dot(k.along.cross(l.along));
        let places = [one, other].map(|end| unknowns.binary_search(end).unwrap_or_default());
        for row in places {
            right[row] -= sine * misses;
            entries.extend(
                places.iter().filter(|column| **column <= row).map(|column| (row, *column, sine * sine)),
            );
        }
    }
    let solved = SymmetricFactor::new(unknowns.len(), &entries).map(|mut factor| factor.solve(&mut right));
    if solved.is_err() || right.iter().any(|more| !more.is_finite()) {
        return Vec::new();
    }
    unknowns.into_iter().zip(right).collect()
}
