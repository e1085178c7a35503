//! Where the patches of a file meet: sides that run along one another, whole or in part, and how well they do.
//!
//! A long side that meets two short ones (a T-junction) is two seams. Sides are told to run along one another by their curves
//! alone, exactly, so this needs no mesh; and more generously than a mesh is sewn, so that a gap is told and not passed over.

use super::Patch;
use ductile_patch::s_patch::Domain;
use ductile_patch::{Seam, SurfacePoint, curve_derivative, curve_point, seam};
use glam::DVec3;
use serde::Serialize;

/// The worst of a seam, at 65 places.
#[derive(Serialize)]
pub(super) struct SeamReport {
    patch: usize,
    side: usize,
    /// From where to where the seam runs, in the parameter of the side: `[0, 1]` for a whole side.
    along: [f64; 2],
    other_patch: usize,
    other_side: usize,
    /// The same places in the parameter of the other side: `[1, 0]` for a whole one that runs the other way.
    other_along: [f64; 2],
    /// In model units.
    gap: f64,
    /// Between the tangent planes, in radians.
    angle: f64,
    /// Of the mean curvature, per model unit.
    curvature_jump: f64,
    /// How many of the places have no normal on one side.
    without_normal: usize,
    /// At how many of the places curvatures were not compared.
    without_curvature: usize,
}

/// Places along a seam.
const STEPS: usize = 64;
/// How far apart sides that meet may run, as a share of the extent of all of them.
const NEAR: f64 = 1e-4;
/// The shortest part of a side, in its parameter, that is a seam and no common corner.
const SHORTEST: f64 = 1e-3;
/// Places of a curve from which the search for its nearest point begins, and its steps.
const STARTS: usize = 32;
const MOST_STEPS: usize = 30;

/// A side as a curve.
struct Side<'a> {
    patch: usize,
    side: usize,
    row: &'a [DVec3],
    starts: Vec<DVec3>,
    low: DVec3,
    high: DVec3,
}

/// All seams between different patches, in the order of the patches and of their sides.
pub(super) fn seams(patches: &[Patch]) -> Vec<SeamReport> {
    let sides: Vec<Side<'_>> = patches
        .iter()
        .enumerate()
        .flat_map(|(patch, of)| {
            of.rows.iter().enumerate().map(move |(side, row)| Side::new(patch, side, row))
        })
        .collect();
    let low = sides.iter().fold(DVec3::INFINITY, |low, side| low.min(side.low));
    let high = sides.iter().fold(DVec3::NEG_INFINITY, |high, side| high.max(side.high));
    let near = NEAR * (high - low).length();
    let mut found = Vec::new();
    for (at, one) in sides.iter().enumerate() {
        let beyond =
            sides[at + 1..].iter().filter(|other| other.patch != one.patch && one.is_near(other, near));
        found.extend(beyond.filter_map(|other| compared(one, other, near, patches)));
    }
    found
}

fn compared(one: &Side<'_>, other: &Side<'_>, near: f64, patches: &[Patch]) -> Option<SeamReport> {
    let [from, to] = common(one, other, near)?;
    let places: Vec<(f64, f64)> = (0..=STEPS)
        .map(|step| {
            let u = from + (to - from) * (step as f64 / STEPS as f64);
            let (v, distance) = other.nearest(curve_point(one.row, u));
            (distance <= near).then_some((u, v))
        })
        .collect::<Option<_>>()?;
    let points = |side: &Side<'_>, parameters: &mut dyn Iterator<Item = f64>| -> Option<Vec<SurfacePoint>> {
        let patch = &patches[side.patch].patch;
        let domain = Domain::new(patch.sides());
        parameters.map(|u| patch.at(&domain, domain.on_side(side.side, u))).collect()
    };
    let own = points(one, &mut places.iter().map(|place| place.0))?;
    let there = points(other, &mut places.iter().map(|place| place.1))?;
    let Seam { gap, angle, curvature_jump, without_normal, without_curvature, .. } = seam(&own, &there)?;
    Some(SeamReport {
        patch: one.patch,
        side: one.side,
        along: [from, to],
        other_patch: other.patch,
        other_side: other.side,
        other_along: [places[0].1, places[STEPS].1],
        gap,
        angle,
        curvature_jump,
        without_normal,
        without_curvature,
    })
}

/// The part of the first side, in its parameter, whose ends lie on the second too; none if that is but a point.
fn common(one: &Side<'_>, other: &Side<'_>, near: f64) -> Option<[f64; 2]> {
    let ends = |side: &Side<'_>| [(0.0, side.starts[0]), (1.0, side.starts[STARTS])];
    let own = ends(one).into_iter().filter(|(_, end)| other.nearest(*end).1 <= near).map(|(u, _)| u);
    let met = ends(other).map(|(_, end)| one.nearest(end));
    let met = met.into_iter().filter(|(_, distance)| *distance <= near).map(|(u, _)| u);
    let (mut from, mut to) = (f64::INFINITY, f64::NEG_INFINITY);
    own.chain(met).for_each(|u| (from, to) = (from.min(u), to.max(u)));
    (to - from > SHORTEST).then_some([from, to])
}

impl<'a> Side<'a> {
    fn new(patch: usize, side: usize, row: &'a [DVec3]) -> Self {
        let starts: Vec<DVec3> =
            (0..=STARTS).map(|step| curve_point(row, step as f64 / STARTS as f64)).collect();
        // A Bézier curve lies in the box of its control points.
        let low = row.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
        let high = row.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
        Self { patch, side, row, starts, low, high }
    }

    /// Whether the boxes of both come that near.
    fn is_near(&self, other: &Self, near: f64) -> bool {
        (self.low - near).cmple(other.high).all() && (other.low - near).cmple(self.high).all()
    }

    /// The parameter of the nearest place of the curve, and its distance: Gauss and Newton's steps from the nearest of some places.
    /// They end on a place that lies on the curve; how far from one that does not is told within the tolerance only.
    fn nearest(&self, place: DVec3) -> (f64, f64) {
        let closest = |(at, best): (usize, f64), (start, p): (usize, &DVec3)| {
            let distance = p.distance_squared(place);
            if distance < best { (start, distance) } else { (at, best) }
        };
        let (start, _) = self.starts.iter().enumerate().fold((0, f64::INFINITY), closest);
        let mut u = start as f64 / STARTS as f64;
        for _ in 0..MOST_STEPS {
            let slope = curve_derivative(self.row, u);
            let step = (place - curve_point(self.row, u)).dot(slope) / slope.length_squared();
            let next = (u + step).clamp(0.0, 1.0);
            // A slope of zero leads nowhere; neither does a step that is lost to rounding.
            if step.is_nan() || (next - u).abs() <= f64::EPSILON {
                break;
            }
            u = next;
        }
        (u, curve_point(self.row, u).distance(place))
    }
}
