//! What a tool that joins two things would make, as lines: ties between two curves or rims, a tube between two
//! places. Only a likeness: the modeler makes the surface, and the surface becomes fair.

use super::Place;
use glam::Vec3;
use std::f32::consts::TAU;

/// Ties between two curves: enough for a skin between them. Every so many are drawn, to show how the one runs along the other.
const TIES: usize = 96;
const DRAWN: usize = 4;
/// Corners of a circle of the tube, and pieces of a strut along it.
const CIRCLE: usize = 24;
const PIECES: u8 = 10;
/// Every so many corners of the circles a strut.
const EVERY: usize = 2;

/// Lines between two polylines of one kind (both closed or both open) as a sweep ties them: laid with their centres on one another,
/// run through from the start and in the sense in which they lie nearest; `reversed` takes the other sense.
#[must_use]
pub fn ties(one: &[Vec3], other: &[Vec3], closed: bool, reversed: bool) -> Vec<[Vec3; 2]> {
    if one.len() < 2 || other.len() < 2 {
        return Vec::new();
    }
    let [a, b] = [one, other].map(|line| resampled(line, closed, TIES));
    pair(&a, &b, closed, reversed)
}

/// The ties that are drawn.
#[must_use]
pub fn drawn_ties(ties: &[[Vec3; 2]]) -> Vec<Vec<Vec3>> {
    ties.iter().step_by(DRAWN).map(|ends| ends.to_vec()).collect()
}

/// Pairs as many places of one line with those of another.
fn pair(a: &[Vec3], b: &[Vec3], closed: bool, reversed: bool) -> Vec<[Vec3; 2]> {
    let count = a.len();
    let centre = |line: &[Vec3]| line.iter().sum::<Vec3>() / line.len() as f32;
    let shift = centre(a) - centre(b);
    let partner = |i: usize, start: usize, backwards: bool| {
        let step = if backwards { count - i } else { i };
        b[(start + step) % count]
    };
    // An open line begins at its one end or at its other.
    let starts = |backwards: bool| match (closed, backwards) {
        (true, _) => 0..count,
        (false, false) => 0..1,
        (false, true) => count - 1..count,
    };
    let best = |backwards: bool| {
        let cost = |start: usize| -> f32 {
            (0..count).map(|i| a[i].distance_squared(partner(i, start, backwards) + shift)).sum()
        };
        starts(backwards).map(|start| (cost(start), start, backwards)).min_by(|x, y| x.0.total_cmp(&y.0))
    };
    let [forth, back] = [best(false), best(true)];
    let (Some(forth), Some(back)) = (forth, back) else { return Vec::new() };
    let (_, start, backwards) = if (back.0 < forth.0) == reversed { forth } else { back };
    (0..count).map(|i| [a[i], partner(i, start, backwards)]).collect()
}

/// So many places along a polyline, at equal distances; the first of a closed one is not repeated.
pub(super) fn resampled(line: &[Vec3], closed: bool, count: usize) -> Vec<Vec3> {
    let ends =
        line.iter().zip(line.iter().cycle().skip(1)).take(if closed { line.len() } else { line.len() - 1 });
    let pieces: Vec<(Vec3, Vec3, f32)> = ends.map(|(a, b)| (*a, *b, a.distance(*b))).collect();
    let whole: f32 = pieces.iter().map(|piece| piece.2).sum();
    let parts = if closed { count } else { count - 1 };
    let (mut out, mut piece, mut before) = (Vec::with_capacity(count), 0, 0.0);
    for i in 0..count {
        let wanted = whole * i as f32 / parts as f32;
        while piece + 1 < pieces.len() && before + pieces[piece].2 < wanted {
            before += pieces[piece].2;
            piece += 1;
        }
        let (from, to, length) = pieces[piece];
        let part = if length > 0.0 { ((wanted - before) / length).clamp(0.0, 1.0) } else { 0.0 };
        out.push(from.lerp(to, part));
    }
    out
}

/// A tube between two places.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tube {
    /// A circle in the tangent plane of each place, closed by its first corner; and some struts.
    pub lines: Vec<Vec<Vec3>>,
    /// All struts. They leave both surfaces upright.
    pub struts: Vec<Vec<Vec3>>,
}

/// The tube between two places.
#[must_use]
pub fn tube(from: Place, to: Place, radius: f32) -> Tube {
    let way = to.at - from.at;
    let Some(direction) = way.try_normalize() else { return Tube::default() };
    // Toward the other place; where that is beside it, toward the eye, as it was picked.
    let upright = |place: Place, ahead: Vec3| {
        let normal = place.normal.unwrap_or(ahead);
        if normal.dot(ahead) < -0.2 { -normal } else { normal }
    };
    let normals = [upright(from, direction), upright(to, -direction)];
    let circle = |centre: Vec3, normal: Vec3| -> Vec<Vec3> {
        let (u, v) = normal.any_orthonormal_pair();
        let corner = |i: usize| {
            let (s, c) = (TAU * i as f32 / CIRCLE as f32).sin_cos();
            centre + (u * c + v * s) * radius
        };
        (0..CIRCLE).map(corner).collect()
    };
    let [first, second] = [circle(from.at, normals[0]), circle(to.at, normals[1])];
    let lead = way.length() * 0.8;
    let strut = |[a, b]: [Vec3; 2]| -> Vec<Vec3> {
        // Hermite's cubic: it leaves a along the one normal and arrives at b against the other.
        let place = |i: u8| {
            let t = f32::from(i) / f32::from(PIECES);
            let (t2, t3) = (t * t, t * t * t);
            a * (2.0 * t3 - 3.0 * t2 + 1.0)
                + normals[0] * (lead * (t3 - 2.0 * t2 + t))
                + b * (3.0 * t2 - 2.0 * t3)
                - normals[1] * (lead * (t3 - t2))
        };
        (0..=PIECES).map(place).collect()
    };
    let struts: Vec<Vec<Vec3>> = pair(&first, &second, true, false).into_iter().map(strut).collect();
    let circles = [first, second].map(|circle| [&circle[..], &circle[..1]].concat());
    let lines = circles.into_iter().chain(struts.iter().step_by(EVERY).cloned()).collect();
    Tube { lines, struts }
}

/// Mean distance of places from their centre: what a closed curve's control points give as its radius.
#[must_use]
pub fn mean_radius(places: &[glam::DVec3]) -> Option<f64> {
    let count = places.len() as f64;
    let centre = places.iter().sum::<glam::DVec3>() / count;
    (!places.is_empty()).then(|| places.iter().map(|at| at.distance(centre)).sum::<f64>() / count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::SurfaceId;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn ring(count: usize, radius: f32, height: f32, turn: f32) -> Vec<Vec3> {
        let at = |i: usize| {
            let (s, c) = (TAU * i as f32 / count as f32 + turn).sin_cos();
            Vec3::new(radius * c, radius * s, height)
        };
        (0..count).map(at).collect()
    }

    #[test]
    fn rings_are_tied_straight_up_however_they_are_wound_and_wherever_they_begin() {
        let low = ring(48, 1.0, 0.0, 0.0);
        let mut high = ring(36, 1.0, 2.0, 1.3);
        for _ in 0..2 {
            let made = ties(&low, &high, true, false);
            assert_eq!((made.len(), drawn_ties(&made).len()), (TIES, TIES / DRAWN));
            // A ring begins at one of as many places: half of such a step is the worst that can be.
            let worst = made.iter().map(|[a, b]| a.truncate().distance(b.truncate())).fold(0.0, f32::max);
            assert!(worst < 0.5 * TAU / TIES as f32 + 0.02, "{worst}");
            high.reverse();
        }
        let crossed = ties(&low, &high, true, true);
        let across = crossed.iter().map(|[a, b]| a.truncate().distance(b.truncate())).fold(0.0, f32::max);
        assert!(across > 1.9, "the other sense crosses over: {across}");
    }

    #[test]
    fn open_lines_are_tied_end_to_end() {
        let one = [Vec3::ZERO, Vec3::X * 0.2, Vec3::X];
        let other = [Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
        let made = ties(&one, &other, false, false);
        assert!(made.iter().all(|[a, b]| (a.x - b.x).abs() < 1e-5), "the near ends belong together");
        let crossed = ties(&one, &other, false, true);
        assert!((crossed[0][0].x - crossed[0][1].x).abs() > 0.9);
    }

    #[test]
    fn a_tube_has_its_radius_and_leaves_both_surfaces_upright() {
        let place = |z, normal| Place { surface: SurfaceId(1), at: Vec3::Z * z, normal: Some(normal) };
        // One normal as the eye saw it from the other side.
        let Tube { lines, struts } = tube(place(0.0, -Vec3::Z), place(3.0, -Vec3::Z), 0.5);
        assert_eq!((lines.len(), struts.len()), (2 + CIRCLE / EVERY, CIRCLE));
        assert!(lines[..2].iter().all(|circle| circle.len() == CIRCLE + 1 && circle[0] == circle[CIRCLE]));
        for line in &struts {
            assert!(
                line.iter().all(|at| (at.truncate().length() - 0.5).abs() < 1e-4),
                "straight up: {line:?}"
            );
            assert!(line.is_sorted_by(|a, b| a.z < b.z));
        }
        assert!(tube(place(1.0, Vec3::Z), place(1.0, Vec3::Z), 0.5).struts.is_empty());
    }

    #[test]
    fn the_radius_of_a_square_is_half_its_diagonal() {
        let square =
            [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, y]| glam::DVec3::new(x, y, 7.0));
        assert!((mean_radius(&square).unwrap() - 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(mean_radius(&[]), None);
    }
}
