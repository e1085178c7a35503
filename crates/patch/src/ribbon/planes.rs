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
    meet(&mut ribbons, planes);
    let ribbons = RibbonLoop::raised(&ribbons, 2)?;
    ribbons.check_pairs(&PAIRS)?;
    let mut angles = vec![0.0; sides];
    for plane in planes.iter().filter(|plane| plane.is_for(sides)) {
        let own = ribbons.ribbons[plane.side].normal(plane.u);
        let turn = own.map_or(core::f64::consts::FRAC_PI_2, |own| {
            libm::atan2(own.cross(plane.normal).length(), own.dot(plane.normal).abs())
        });
        angles[plane.side] = f64::max(angles[plane.side], turn);
    }
    Ok(Planed { ribbons, angles })
}

impl PlaneSample {
    fn is_for(&self, sides: usize) -> bool {
        self.side < sides && (0.0..=1.0).contains(&self.u) && self.normal.try_normalize().is_some()
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

/// Moves the free points of all rows 1 into the planes, and leaves them at their defaults where planes do not care.
fn meet(ribbons: &mut [Ribbon], planes: &[PlaneSample]) {
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
        let Some(normal) = plane.normal.try_normalize() else { continue };
        let (ribbon, weights) = (&ribbons[plane.side], basis(d, plane.u));
        let along = ribbon.tangent(plane.u).normalize_or_zero();
        let leg: DVec3 =
            weights.iter().zip(ribbon.row1.iter().zip(&ribbon.row0)).map(|(w, (a, b))| (*a - *b) * *w).sum();
        let across = leg - along * along.dot(leg);
        let within = normal.cross(along).normalize_or_zero();
        let reach = if within.dot(across) < 0.0 { -across.length() } else { across.length() };
        for (direction, value, share) in [(normal, 0.0, 1.0), (within, reach, REACH_WEIGHT)] {
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
                planes.push(PlaneSample {
                    side,
                    u,
                    normal: if side % 2 == 0 { normal } else { -3.0 * normal },
                });
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
            PlaneSample { side: 9, u: 0.5, normal: DVec3::Z },
            PlaneSample { side: 0, u: f64::NAN, normal: DVec3::Z },
            PlaneSample { side: 0, u: 0.5, normal: DVec3::ZERO },
            PlaneSample { side: 0, u: 0.5, normal: DVec3::NAN },
        ];
        let found = ribbons_along(&curves, &nonsense).unwrap();
        assert_eq!((found.ribbons.degree(), found.angles), (3, vec![0.0; 4]));
        let mut open = curves.clone();
        open[2][0] = DVec3::ONE * 5.0;
        assert!(matches!(ribbons_along(&open, &[]), Err(RibbonError::Incompatible { side: 2, row: 0, .. })));
    }
}
