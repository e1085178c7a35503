//! Ribbons for a loop of curves: second rows that are fair by default and, where tangent planes are given, lie in them as
//! well as possible.
//!
//! By default the cross derivative of a side goes linearly from the end tangent of the curve before it to the tangent of
//! the curve after it, as the boundary blend of a Coons patch does (G. Farin, *Curves and Surfaces for CAGD*, chapter
//! 22). Twist points belong to two sides and end up between what both ask for. All sides are solved for at once, so that the
//! result fits together and no later step spoils what an earlier one has met:
//!
//! ```text
//! least  Σ over planes (W(u) · n)² + μ (W(u) · b - w)² + ε Σ over points |row1 - default|²,    ends of each row 1 on the neighbours' curves
//! ```
//!
//! Here `b` is across the curve in the plane, and `w` how far the default reaches across: turned into the plane, it keeps its length.
//! Without that a cross derivative could meet any plane by vanishing. `μ` and, far more so, `ε` are so small that they only decide
//! what the planes leave open.

use super::{PAIRS, Ribbon, RibbonError, RibbonLoop};
use crate::basis;
use crate::bezier::elevated;
use ductile_solver::SymmetricFactor;
use glam::DVec3;

/// What the length across the curve weighs beside the planes.
const REACH_WEIGHT: f64 = 1e-6;
/// What it weighs where planes turn more than a ribbon of the degree can follow: before it vanishes it shall rather miss them a little.
const HEAVIER: [f64; 3] = [1e-4, 1e-2, 1.0];
/// Up to this angle to its planes, in radians, a ribbon follows them: 0.5°.
const FOLLOWS: f64 = 0.0087;
/// The least degree of ribbons that have points enough to follow planes.
const FREE: usize = 7;
/// What the default weighs beside the planes.
const DEFAULT_WEIGHT: f64 = 1e-9;

/// A plane that a ribbon should lie in at one place of its side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneSample {
    /// The side, from 0.
    pub side: usize,
    /// The parameter on it, in [0, 1].
    pub u: f64,
    /// Normal of the plane, of any length but 0, on either side.
    pub normal: DVec3,
    /// By how much the plane is turned about the side first, in radians from -π/2 to π/2. A positive turn takes what leads inwards to
    /// the side of the ribbon's normal.
    pub turn: f64,
    /// How far the ribbon is to reach across the side, 1 as far as it does where nothing is turned and reaches 1.
    pub reach: f64,
    /// What it weighs beside others, 1 as a rule.
    pub weight: f64,
    /// Whether the plane, before it is turned, is the one that the ribbon has by default.
    pub is_own: bool,
}

/// Ribbons along a loop of curves.
#[derive(Clone, Debug, PartialEq)]
pub struct Planed {
    /// The ribbons; they fit.
    pub ribbons: RibbonLoop,
    /// For each side the largest angle between the ribbon's plane and a given one, in radians from 0 to π/2; 0 for a side
    /// without planes, π/2 where the ribbon has none.
    pub angles: Vec<f64>,
}

/// Gives a loop of boundary curves second rows. All curves are raised to one degree, at least 3; higher degrees have more
/// freedom to follow planes. Planes of sides that do not exist, at parameters outside [0, 1] or without a direction are
/// left out.
///
/// # Errors
/// As [`RibbonLoop::of_curves`].
pub fn ribbons_along(curves: &[Vec<DVec3>], planes: &[PlaneSample]) -> Result<Planed, RibbonError> {
    ribbons_raised(curves, planes, 0)
}

/// As [`ribbons_along`], with ribbons of a degree of at least `least`. They have the same defaults as without, and more freedom to be
/// turned and to reach farther.
///
/// # Errors
/// As [`RibbonLoop::of_curves`].
pub fn ribbons_raised(
    curves: &[Vec<DVec3>],
    planes: &[PlaneSample],
    least: usize,
) -> Result<Planed, RibbonError> {
    let loose = RibbonLoop::of_curves(curves)?;
    let mut rows: Vec<Vec<DVec3>> = loose.ribbons.into_iter().map(|ribbon| ribbon.row0).collect();
    let degree = rows[0].len() - 1;
    for row in &mut rows {
        *row = (degree..3).fold(core::mem::take(row), |row, _| elevated(&row));
    }
    let (sides, d) = (rows.len(), degree.max(3));
    // The corners are one point each.
    for side in 0..sides {
        let before = (side + sides - 1) % sides;
        rows[before][d] = rows[side][0];
    }
    let mut ribbons: Vec<Ribbon> = (0..sides).map(|side| by_default(&rows, side)).collect();
    let given = planes.iter().filter(|plane| !plane.is_own);
    let fair: Vec<PlaneSample> = given.map(|plane| PlaneSample { turn: 0.0, reach: 1.0, ..*plane }).collect();
    let raise = |ribbons: &mut Vec<Ribbon>| {
        for ribbon in ribbons {
            *ribbon = (ribbon.degree()..least).fold(ribbon.clone(), |ribbon, _| ribbon.elevated());
        }
    };
    let leans = planes != fair;
    if !leans && d < FREE {
        // Twist points that gave way to planes would be no default to start from.
        raise(&mut ribbons);
    }
    ribbons = followed(ribbons, &fair);
    let is_raised = ribbons[0].degree() >= least;
    raise(&mut ribbons);
    if leans || !is_raised {
        // Turned and stretched beside what is fair; then back into the planes, whose part in this was spoiled by the lengths.
        meet(&mut ribbons, planes, REACH_WEIGHT);
        meet(&mut ribbons, planes, 0.0);
    }
    let ribbons = RibbonLoop::raised(&ribbons, 2)?;
    ribbons.check_pairs(&PAIRS)?;
    let angles = angles(ribbons.ribbons(), planes);
    Ok(Planed { ribbons, angles })
}

/// Second rows that follow planes as well as they can.
fn followed(ribbons: Vec<Ribbon>, planes: &[PlaneSample]) -> Vec<Ribbon> {
    let mut best = ribbons.clone();
    meet(&mut best, planes, REACH_WEIGHT);
    let worst = |ribbons: &[Ribbon]| angles(ribbons, planes).into_iter().fold(0.0, f64::max);
    let mut least = worst(&best);
    for weight in HEAVIER {
        if least <= FOLLOWS {
            break;
        }
        let mut heavier = ribbons.clone();
        meet(&mut heavier, planes, weight);
        let angle = worst(&heavier);
        if angle < least {
            (best, least) = (heavier, angle);
        }
    }
    best
}

/// For each side the largest angle between the ribbon's plane and a given one.
fn angles(ribbons: &[Ribbon], planes: &[PlaneSample]) -> Vec<f64> {
    let mut angles = vec![0.0; ribbons.len()];
    for plane in planes.iter().filter(|plane| plane.is_for(ribbons.len())) {
        let own = ribbons[plane.side].normal(plane.u);
        let turn = own.map_or(core::f64::consts::FRAC_PI_2, |own| {
            let normal = plane.turned(ribbons[plane.side].tangent(plane.u).normalize_or_zero());
            libm::atan2(own.cross(normal).length(), own.dot(normal).abs())
        });
        angles[plane.side] = f64::max(angles[plane.side], turn);
    }
    angles
}

impl PlaneSample {
    /// A plane that is not turned, and a ribbon that reaches as far as by default.
    #[must_use]
    pub fn new(side: usize, u: f64, normal: DVec3) -> Self {
        Self { side, u, normal, turn: 0.0, reach: 1.0, weight: 1.0, is_own: false }
    }

    /// The normal, turned about the unit tangent of the side.
    #[must_use]
    pub fn turned(&self, along: DVec3) -> DVec3 {
        if self.turn == 0.0 {
            return self.normal;
        }
        let (sin, cos) = libm::sincos(self.turn);
        let kept = along * along.dot(self.normal);
        kept + (self.normal - kept) * cos + along.cross(self.normal) * sin
    }

    fn is_for(&self, sides: usize) -> bool {
        self.side < sides
            && (0.0..=1.0).contains(&self.u)
            && self.normal.try_normalize().is_some()
            && self.turn.is_finite()
            && self.reach.is_finite()
            && self.weight.is_finite()
    }
}

/// The side with legs that go from the curve before it to the curve after it.
fn by_default(rows: &[Vec<DVec3>], side: usize) -> Ribbon {
    let (sides, row0) = (rows.len(), &rows[side]);
    let d = row0.len() - 1;
    let (before, after) = (&rows[(side + sides - 1) % sides], &rows[(side + 1) % sides]);
    let (first, last) = (before[d - 1] - before[d], after[1] - after[0]);
    let row1 = (0..=d).map(|j| row0[j] + first.lerp(last, j as f64 / d as f64)).collect();
    Ribbon { row0: row0.clone(), row1 }
}

/// The number of the unknown that a point of row 1 is, for degrees of at least 3: twist points first, one for each corner.
fn unknown(sides: usize, d: usize, side: usize, column: usize) -> Option<usize> {
    match column {
        0 => None,
        1 => Some(side),
        _ if column == d => None,
        _ if column == d - 1 => Some((side + 1) % sides),
        _ => Some(sides + side * (d - 3) + column - 2),
    }
}

/// Adds one equation to the normal ones: the sum of weighted points along a direction is known.
fn weigh_in(
    entries: &mut Vec<(usize, usize, f64)>,
    right: &mut [f64],
    (free, direction): (&[(usize, f64)], DVec3),
    share: f64,
    known: f64,
) {
    for &(row, weight) in free {
        for (i, along) in direction.to_array().into_iter().enumerate() {
            let own = share * weight * along;
            right[3 * row + i] += own * known;
            for &(column, other) in free {
                for (j, beside) in direction.to_array().into_iter().enumerate() {
                    if 3 * column + j <= 3 * row + i {
                        entries.push((3 * row + i, 3 * column + j, own * other * beside));
                    }
                }
            }
        }
    }
}

/// Moves the free points of all rows 1 into the planes, and leaves them where they are where planes do not care; what they reach across
/// is kept with that weight.
fn meet(ribbons: &mut [Ribbon], planes: &[PlaneSample], reach_weight: f64) {
    let (sides, d) = (ribbons.len(), ribbons[0].degree());
    let count = sides + sides * (d - 3);
    let (mut entries, mut right) = (Vec::new(), vec![0.0; 3 * count]);
    // The unknowns are ways from a place, so that nothing is lost far from the origin: row 1 itself, from the first corner.
    let origin = ribbons[0].row0[0];
    for (side, ribbon) in ribbons.iter().enumerate() {
        for (column, wanted) in ribbon.row1.iter().enumerate() {
            let Some(slot) = unknown(sides, d, side, column) else { continue };
            for (axis, value) in (*wanted - origin).to_array().into_iter().enumerate() {
                entries.push((3 * slot + axis, 3 * slot + axis, DEFAULT_WEIGHT));
                right[3 * slot + axis] += DEFAULT_WEIGHT * value;
            }
        }
    }
    for plane in planes.iter().filter(|plane| plane.is_for(sides)) {
        let (ribbon, weights) = (&ribbons[plane.side], basis(d, plane.u));
        let along = ribbon.tangent(plane.u).normalize_or_zero();
        let leg: DVec3 =
            weights.iter().zip(ribbon.row1.iter().zip(&ribbon.row0)).map(|(w, (a, b))| (*a - *b) * *w).sum();
        let across = leg - along * along.dot(leg);
        // What leads inwards in the plane before it is turned does so in it afterwards.
        let way = if plane.normal.cross(along).dot(across) < 0.0 { -plane.reach } else { plane.reach };
        let Some(normal) = plane.turned(along).try_normalize() else { continue };
        let within = normal.cross(along).normalize_or_zero();
        let reach = way * across.length();
        for (direction, value, share) in [(normal, 0.0, plane.weight), (within, reach, reach_weight)] {
            // Σ b_j (row1_j - row0_j) · direction = value, with what is fixed on the right.
            let mut known = value;
            let mut free: Vec<(usize, f64)> = Vec::new();
            for (column, &weight) in weights.iter().enumerate() {
                known += weight * (ribbon.row0[column] - origin).dot(direction);
                match unknown(sides, d, plane.side, column) {
                    Some(slot) => free.push((slot, weight)),
                    None => known -= weight * (ribbon.row1[column] - origin).dot(direction),
                }
            }
            weigh_in(&mut entries, &mut right, (&free, direction), share, known);
        }
    }
    // Every unknown has its default, so the matrix is positive definite; if rounding says otherwise, defaults stay.
    let solved = SymmetricFactor::new(3 * count, &entries).is_ok_and(|mut factor| {
        factor.solve(&mut right);
        right.iter().all(|value| value.is_finite())
    });
    for side in 0..sides {
        for column in 0..=d {
            let Some(slot) = unknown(sides, d, side, column) else { continue };
            if solved {
                let found = DVec3::new(right[3 * slot], right[3 * slot + 1], right[3 * slot + 2]);
                ribbons[side].row1[column] = origin + found;
            } else if column == 1 {
                let before = (side + sides - 1) % sides;
                let mean = (ribbons[side].row1[1] + ribbons[before].row1[d - 1]) * 0.5;
                ribbons[side].row1[1] = mean;
                ribbons[before].row1[d - 1] = mean;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bezier::curve_point;
    use crate::fit_curve;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A hole in the unit sphere, cut by `n` planes through chords of a circle of latitude: fitted arcs, with the sphere's
    /// normals.
    fn hole(n: usize, degree: usize, offset: DVec3) -> (Vec<Vec<DVec3>>, Vec<PlaneSample>) {
        let corner = |k: usize| {
            let angle = core::f64::consts::TAU * k as f64 / n as f64;
            DVec3::new(0.6 * libm::cos(angle), 0.6 * libm::sin(angle), 0.8)
        };
        let (mut curves, mut planes) = (Vec::new(), Vec::new());
        for side in 0..n {
            let on_arc =
                |k: usize| corner(side).lerp(corner(side + 1), k as f64 / 30.0).try_normalize().unwrap();
            let arc: Vec<DVec3> = (0..=30).map(|k| on_arc(k) + offset).collect();
            let fit = fit_curve(&arc, degree).unwrap();
            for &u in &fit.parameters {
                let normal = curve_point(&fit.points, u) - offset;
                planes.push(PlaneSample::new(side, u, if side % 2 == 0 { normal } else { -3.0 * normal }));
            }
            curves.push(fit.points);
        }
        (curves, planes)
    }

    #[test]
    fn planes_of_a_sphere_are_met_better_by_higher_degrees() {
        for n in [3, 4, 5, 6] {
            let mut before = 1.0;
            for degree in [3, 5, 7] {
                let (curves, planes) = hole(n, degree, DVec3::ZERO);
                let found = ribbons_along(&curves, &planes).unwrap();
                let worst = found.angles.iter().copied().fold(0.0, f64::max);
                assert!(worst < 0.2 * before, "{n} sides, degree {degree}: {worst:e}");
                before = worst;
            }
            assert!(before < 1e-6, "{n}: {before:e}");
        }
    }

    /// Planes that lean by more and more towards the middle of the sides, up to an angle from the sphere's.
    #[test]
    fn a_ribbon_turned_into_its_planes_keeps_its_reach() {
        let (curves, planes) = hole(4, 5, DVec3::ZERO);
        let plain = ribbons_along(&curves, &planes).unwrap().ribbons;
        for most in [0.3, 0.6, 0.9] {
            let leaning: Vec<PlaneSample> = planes
                .iter()
                .map(|plane| {
                    let along = plain.ribbons[plane.side].tangent(plane.u).normalize_or_zero();
                    let (sin, cos) = libm::sincos(most * 4.0 * plane.u * (1.0 - plane.u));
                    PlaneSample { normal: plane.normal * cos + along.cross(plane.normal) * sin, ..*plane }
                })
                .collect();
            let found = ribbons_along(&curves, &leaning).unwrap();
            assert!(found.angles.iter().all(|angle| *angle < 0.02), "{most}: {:?}", found.angles);
            for (side, ribbon) in found.ribbons.ribbons().iter().enumerate() {
                for u in [0.25, 0.5, 0.75] {
                    let across = |ribbon: &Ribbon| {
                        let along = ribbon.tangent(u).normalize_or_zero();
                        (ribbon.cross(u) - along * along.dot(ribbon.cross(u))).length()
                    };
                    let share = across(ribbon) / across(&plain.ribbons()[side]);
                    assert!((0.8..1.25).contains(&share), "{most}, side {side} at {u}: {share}");
                }
            }
        }
    }

    /// The same planes, turned by what the samples say: nothing else than planes that lean.
    #[test]
    fn a_turn_of_a_sample_turns_the_plane_and_keeps_the_reach_that_is_asked_for() {
        let (curves, planes) = hole(5, 9, DVec3::ZERO);
        let fair = ribbons_along(&curves, &planes).unwrap().ribbons;
        for (turn, reach) in [(0.5, 1.0), (-0.5, 2.0), (0.0, 0.5), (1.5, 1.0)] {
            let f = |u: f64| 16.0 * (u * (1.0 - u)) * (u * (1.0 - u));
            let leaning: Vec<PlaneSample> = planes
                .iter()
                .map(|plane| {
                    let of_one = plane.side == 2;
                    let f = if of_one { f(plane.u) } else { 0.0 };
                    let (sin, cos) = libm::sincos(turn);
                    let (up, within) = (f * sin, 1.0 + (cos - 1.0) * f);
                    let far = libm::hypot(up, within) * (1.0 + (reach - 1.0) * f);
                    PlaneSample { turn: libm::atan2(up, within), reach: far, ..*plane }
                })
                .collect();
            let found = ribbons_along(&curves, &leaning).unwrap();
            println!("{turn}, {reach}: {:?}", found.angles);
            assert!(found.angles.iter().all(|angle| *angle < 1e-3), "{turn}, {reach}: {:?}", found.angles);
            let (own, before) = (&found.ribbons.ribbons()[2], &fair.ribbons()[2]);
            let along = before.tangent(0.5).normalize_or_zero();
            let across = |ribbon: &Ribbon| ribbon.cross(0.5) - along * along.dot(ribbon.cross(0.5));
            let (was, is) = (across(before), across(own));
            // Counter-clockwise about the side, from what it was.
            let angle = libm::atan2(along.dot(was.cross(is)), was.dot(is));
            assert!((angle - turn).abs() < 1e-3, "{turn}: {angle}");
            assert!((is.length() / was.length() / reach - 1.0).abs() < 0.05, "{reach}: {}", is.length());
            for side in [0, 1, 3, 4] {
                let (one, other) = (&found.ribbons.ribbons()[side], &fair.ribbons()[side]);
                let off =
                    (0..=20).map(|k| f64::from(k) / 20.0).map(|u| one.cross(u).distance(other.cross(u)));
                assert!(off.fold(0.0, f64::max) < 0.02 * across(before).length(), "{turn}: side {side}");
            }
        }
    }

    #[test]
    fn the_place_does_not_matter() {
        let (curves, planes) = hole(5, 5, DVec3::ZERO);
        let (moved_curves, moved_planes) = hole(5, 5, DVec3::new(1000.0, -2000.0, 500.0));
        let one = ribbons_along(&curves, &planes).unwrap();
        let other = ribbons_along(&moved_curves, &moved_planes).unwrap();
        for (a, b) in one.angles.iter().zip(&other.angles) {
            assert!((a - b).abs() < 1e-6, "{a:e} {b:e}");
        }
    }

    #[test]
    fn without_planes_legs_are_those_of_the_neighbours() {
        let (curves, _) = hole(6, 3, DVec3::ZERO);
        let found = ribbons_along(&curves, &[]).unwrap();
        assert_eq!(found.angles, [0.0; 6]);
        assert!(found.ribbons.without_normal().is_empty());
        // All sides are alike: their normals in the middle lean alike, and inward means towards the axis.
        let middle: Vec<DVec3> = found.ribbons.ribbons().iter().map(|r| r.normal(0.5).unwrap()).collect();
        assert!(
            middle.iter().all(|normal| (normal.z - middle[0].z).abs() < 1e-9 && normal.z > 0.5),
            "{middle:?}"
        );
        for (side, ribbon) in found.ribbons.ribbons().iter().enumerate() {
            let inward = -ribbon.point(0.5).truncate();
            assert!(ribbon.cross(0.5).truncate().dot(inward) > 0.0, "side {side}");
        }
    }

    #[test]
    fn straight_sides_and_nonsense_are_no_trouble() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.2), DVec3::Y];
        let curves: Vec<Vec<DVec3>> = (0..4).map(|k| vec![corners[k], corners[(k + 1) % 4]]).collect();
        let nonsense = [
            PlaneSample::new(9, 0.5, DVec3::Z),
            PlaneSample::new(0, f64::NAN, DVec3::Z),
            PlaneSample::new(0, 0.5, DVec3::ZERO),
            PlaneSample::new(0, 0.5, DVec3::NAN),
        ];
        let found = ribbons_along(&curves, &nonsense).unwrap();
        assert_eq!((found.ribbons.degree(), found.angles), (3, vec![0.0; 4]));
        let mut open = curves.clone();
        open[2][0] = DVec3::ONE * 5.0;
        assert!(matches!(ribbons_along(&open, &[]), Err(RibbonError::Incompatible { side: 2, row: 0, .. })));
    }
}
