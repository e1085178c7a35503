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

use super::planes::{Agreement, agreement};
use super::shape;
use crate::model::Model;
use ductile_solver::SymmetricFactor;
use ductile_spec::{CurveStretch, FillJoin, PointId};
use glam::DVec3;
use std::collections::BTreeMap;

/// What is unchanged weighs beside the equations.
const KEPT: f64 = 1e-6;
/// What it weighs where a curve has too low a degree: the twist points are all that a ribbon of degree 3 has, and it could follow such planes
/// at its ends only.
const STIFF: f64 = 1e3;
/// The least degree of a ribbon that has points beside its twist points.
const LEAST_DEGREE: usize = 4;
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

impl Twists {
    /// Those of all corners of fills as their curves are now.
    pub(super) fn new(model: &Model) -> Self {
        let mut ends: BTreeMap<End, Leaving> = BTreeMap::new();
        let mut corners: BTreeMap<PointId, Vec<[End; 2]>> = BTreeMap::new();
        for (id, fill) in model.document.fills.iter().filter(|(_, fill)| fill.style.join == FillJoin::Tangent)
        {
            let Some(own) = shape(model, *id).filter(|own| own.sides.len() == fill.sides.len()) else {
                continue;
            };
            let count = own.sides.len();
            for (at, side) in own.sides.iter().enumerate() {
                let (before, drawn) = (&own.sides[(at + count - 1) % count].drawn, &side.drawn);
                let pair = [(drawn.stretch, drawn.back), (before.stretch, !before.back)];
                corners.entry(fill.sides[at].from).or_default().push(pair);
                let Some(agreed) = agreement(model, *id, at, side) else { continue };
                for is_last in [false, true] {
                    if let Some(leaving) = Leaving::new(&agreed, &side.fit.points, is_last) {
                        ends.entry((drawn.stretch, is_last)).or_insert(leaving);
                    }
                }
            }
        }
        Self(corners.values().flat_map(|pairs| around(pairs, &ends)).collect())
    }

    /// What to add to the slope of the normals, by the parameter from an end on, where the curve leaves with that derivative.
    pub(super) fn slope(&self, end: End, normal: DVec3, derivative: DVec3) -> DVec3 {
        self.0.get(&end).map_or(DVec3::ZERO, |more| normal.cross(derivative) * *more)
    }
}

impl Leaving {
    fn new(agreed: &Agreement<'_>, points: &[DVec3], is_last: bool) -> Option<Self> {
        let normal = |step: f64| agreed.normal(points, if is_last { 1.0 - step * STEP } else { step * STEP });
        let [here, next, far] = [normal(0.0)?, normal(1.0)?, normal(2.0)?];
        let derivative = super::planes::leaving(points, is_last);
        let slope = (next * 4.0 - here * 3.0 - far) / (2.0 * STEP * derivative.length());
        let kept = if points.len() > LEAST_DEGREE { KEPT } else { STIFF };
        slope.is_finite().then_some(Self { normal: here, along: derivative.normalize_or_zero(), slope, kept })
    }

    fn flipped(self) -> Self {
        Self { normal: -self.normal, slope: -self.slope, ..self }
    }
}

/// The changes at one point: by end, what is to be added to `σ`.
fn around(pairs: &[[End; 2]], ends: &BTreeMap<End, Leaving>) -> Vec<(End, f64)> {
    let met: Vec<&[End; 2]> =
        pairs.iter().filter(|pair| pair.iter().all(|end| ends.contains_key(end))).collect();
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
