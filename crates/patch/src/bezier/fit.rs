//! A Bézier curve through the ends of a polyline and as near as possible to what lies between: least squares at
//! chord-length parameters (Farin, *Curves and Surfaces for CAGD*, section 9.2).

use super::{curve_derivative, curve_point};
use crate::basis;
use ductile_solver::SymmetricFactor;
use glam::DVec3;
use thiserror::Error;

/// Highest degree that is fitted: the normal equations lose four digits for each three degrees.
pub const MOST_FITTED_DEGREE: usize = 10;

/// Why no curve is fitted. Points count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum FitError {
    /// Degrees from 1 to 10 are fitted.
    #[error("a curve of degree {0} cannot be fitted: degrees are 1 to {MOST_FITTED_DEGREE}")]
    Degree(usize),
    /// Take more points, or a lower degree.
    #[error("{points} points do not determine a curve of degree {degree}: {} are needed", degree + 1)]
    TooFewPoints {
        /// How many points there are.
        points: usize,
        /// The degree asked for.
        degree: usize,
    },
    /// A coordinate is infinite, no number or beyond 1e100.
    #[error("point {0} is not finite, or beyond 1e100")]
    NotFinite(usize),
    /// All points are one, or so many of them that the others do not determine a curve of this degree.
    #[error("the points do not determine a curve of degree {0}: too many of them coincide")]
    Coincident(usize),
}

/// A fitted curve.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveFit {
    /// Its control points; the first and the last are the ends of the polyline, to the bit.
    pub points: Vec<DVec3>,
    /// The parameter of each given point, from 0 to 1.
    pub parameters: Vec<f64>,
    /// The largest distance of a given point from the curve at its parameter, in model units.
    pub deviation: f64,
}

/// Fits a curve of a degree to a polyline, ends exact.
///
/// # Errors
/// See [`FitError`].
pub fn fit_curve(polyline: &[DVec3], degree: usize) -> Result<CurveFit, FitError> {
    if !(1..=MOST_FITTED_DEGREE).contains(&degree) {
        return Err(FitError::Degree(degree));
    }
    let too_few = FitError::TooFewPoints { points: polyline.len(), degree };
    if polyline.len() < degree + 1 {
        return Err(too_few);
    }
    let is_sound = |p: &DVec3| p.to_array().iter().all(|x| x.abs() <= 1e100);
    if let Some(bad) = polyline.iter().position(|p| !is_sound(p)) {
        return Err(FitError::NotFinite(bad));
    }
    let (Some(&first), Some(&last)) = (polyline.first(), polyline.last()) else { return Err(too_few) };
    let parameters = chord_lengths(polyline).ok_or(FitError::Coincident(degree))?;
    // Least squares over the inner control points; each given point is one equation.
    let inner = degree - 1;
    let (mut entries, mut right) = (Vec::new(), vec![0.0; 3 * inner]);
    for (point, &u) in polyline.iter().zip(&parameters) {
        let weights = basis(degree, u);
        let rest = *point - first * weights[0] - last * weights[degree];
        for row in 0..inner {
            for column in 0..=row {
                entries.push((row, column, weights[row + 1] * weights[column + 1]));
            }
            for (axis, value) in rest.to_array().into_iter().enumerate() {
                right[axis * inner + row] += weights[row + 1] * value;
            }
        }
    }
    let mut factor = SymmetricFactor::new(inner, &entries).map_err(|_| FitError::Coincident(degree))?;
    factor.solve(&mut right);
    let middle = (0..inner).map(|j| DVec3::new(right[j], right[inner + j], right[2 * inner + j]));
    let points: Vec<DVec3> = core::iter::once(first).chain(middle).chain(core::iter::once(last)).collect();
    let off = polyline.iter().zip(&parameters).map(|(point, &u)| point.distance(curve_point(&points, u)));
    let deviation = off.fold(0.0, f64::max);
    if !points.iter().all(|point| point.is_finite()) {
        return Err(FitError::Coincident(degree));
    }
    Ok(CurveFit { points, parameters, deviation })
}

/// The same with the directions in which the curve leaves its first end and arrives at its last, which it then has exactly; and with
/// parameters at which it comes nearest to the points. Where that would turn an end round, or a direction has no length, the curve is that of [`fit_curve`].
///
/// # Errors
/// See [`FitError`].
pub fn fit_curve_along(
    polyline: &[DVec3],
    degree: usize,
    directions: [DVec3; 2],
) -> Result<CurveFit, FitError> {
    let plain = fit_curve(polyline, degree)?;
    let [Some(leaves), Some(arrives)] = directions.map(DVec3::try_normalize) else { return Ok(plain) };
    if degree < 3 {
        return Ok(plain);
    }
    let mut best = plain.clone();
    let mut parameters = plain.parameters.clone();
    for round in 0..ROUNDS {
        let Some(points) = along(polyline, degree, [leaves, arrives], &parameters) else { break };
        let off = polyline.iter().zip(&parameters).map(|(point, &u)| point.distance(curve_point(&points, u)));
        let deviation = off.fold(0.0, f64::max);
        if round == 0 || deviation < best.deviation {
            best = CurveFit { points, parameters: parameters.clone(), deviation };
        }
        if !corrected(polyline, &best.points, &mut parameters) {
            break;
        }
    }
    Ok(best)
}

/// Rounds of fits, each at the parameters at which the one before comes nearest to the places.
const ROUNDS: usize = 6;

/// Moves parameters towards those of the nearest points of a curve by a step of Newton's (J. Hoschek, *Intrinsic parametrization for
/// approximation*, 1988); not if they would change their order.
fn corrected(polyline: &[DVec3], points: &[DVec3], parameters: &mut [f64]) -> bool {
    let ends = parameters.len() - 1;
    let mut moved = parameters.to_vec();
    for (point, u) in polyline.iter().zip(&mut moved).take(ends).skip(1) {
        let along = curve_derivative(points, *u);
        *u += (*point - curve_point(points, *u)).dot(along) / along.length_squared();
    }
    let is_sound = moved.windows(2).all(|pair| pair[0] < pair[1]);
    if is_sound {
        parameters.copy_from_slice(&moved);
    }
    is_sound
}

/// The curve with these directions at its ends that is nearest to places at given parameters, if it does not turn round there.
fn along(
    polyline: &[DVec3],
    degree: usize,
    [leaves, arrives]: [DVec3; 2],
    parameters: &[f64],
) -> Option<Vec<DVec3>> {
    let (first, last) = (*polyline.first()?, *polyline.last()?);
    // The unknowns: how far the two points beside the ends are from them, then the coordinates of those between.
    let count = 2 + 3 * (degree - 3);
    let (mut matrix, mut right) = (vec![0.0; count * count], vec![0.0; count]);
    for (point, &u) in polyline.iter().zip(parameters) {
        let weights = basis(degree, u);
        let rest =
            *point - first * (weights[0] + weights[1]) - last * (weights[degree] + weights[degree - 1]);
        let ends = [leaves * weights[1], -arrives * weights[degree - 1]];
        let inner = (2..degree - 1).flat_map(|j| DVec3::AXES.map(|axis| axis * weights[j]));
        let columns: Vec<DVec3> = ends.into_iter().chain(inner).collect();
        for (row, one) in columns.iter().enumerate() {
            right[row] += one.dot(rest);
            for (column, other) in columns.iter().enumerate().take(row + 1) {
                matrix[row * count + column] += one.dot(*other);
            }
        }
    }
    let places = (0..count).flat_map(|row| (0..=row).map(move |column| (row, column)));
    let entries: Vec<_> = places.map(|(row, column)| (row, column, matrix[row * count + column])).collect();
    let mut factor = SymmetricFactor::new(count, &entries).ok()?;
    factor.solve(&mut right);
    if !(right.iter().all(|value| value.is_finite()) && right[0] > 0.0 && right[1] > 0.0) {
        return None;
    }
    let inner = right[2..].chunks_exact(3).map(DVec3::from_slice);
    let before_last = last - arrives * right[1];
    Some([first, first + leaves * right[0]].into_iter().chain(inner).chain([before_last, last]).collect())
}

/// The share of the length up to each point; none if there is no length.
fn chord_lengths(polyline: &[DVec3]) -> Option<Vec<f64>> {
    let mut lengths = vec![0.0];
    let mut length = 0.0;
    for pair in polyline.windows(2) {
        length += pair[0].distance(pair[1]);
        lengths.push(length);
    }
    (length > 0.0).then(|| lengths.into_iter().map(|so_far| so_far / length).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn an_arc_is_met_better_by_higher_degrees() {
        let arc: Vec<DVec3> = (0..=40)
            .map(|k| f64::from(k) * 0.03)
            .map(|angle| DVec3::new(2.0 * libm::cos(angle), 2.0 * libm::sin(angle), 0.5 * angle))
            .collect();
        let mut before = f64::INFINITY;
        for degree in 1..=7 {
            let fit = fit_curve(&arc, degree).unwrap();
            assert_eq!((fit.points.len(), fit.points[0], fit.points[degree]), (degree + 1, arc[0], arc[40]));
            assert!(fit.deviation < 0.35 * before, "degree {degree}: {:e}", fit.deviation);
            before = fit.deviation;
        }
        assert!(before < 1e-7, "{before:e}");
    }

    #[test]
    fn a_straight_line_of_even_steps_is_itself() {
        let line: Vec<DVec3> = (0..=12).map(|k| DVec3::new(1.0, 2.0, -1.0) * f64::from(k)).collect();
        for degree in 1..=10 {
            let fit = fit_curve(&line, degree).unwrap();
            assert!(fit.deviation < 1e-10, "degree {degree}: {:e}", fit.deviation);
            for (j, point) in fit.points.iter().enumerate() {
                let exact = line[12] * (j as f64 / degree as f64);
                assert!(point.distance(exact) < 1e-8, "degree {degree}, {j}: {point}");
            }
        }
    }

    #[test]
    fn the_fit_is_the_best_one() {
        // Moving any inner control point makes the sum of squares larger.
        let points: Vec<DVec3> =
            (0..20).map(f64::from).map(|k| DVec3::new(k, libm::sin(k), libm::cos(0.7 * k))).collect();
        let fit = fit_curve(&points, 5).unwrap();
        let cost = |control: &[DVec3]| {
            let off = points.iter().zip(&fit.parameters);
            off.map(|(p, &u)| p.distance_squared(curve_point(control, u))).sum::<f64>()
        };
        for j in 1..5 {
            for step in [DVec3::X, -DVec3::Y, DVec3::Z] {
                let mut other = fit.points.clone();
                other[j] += step * 1e-3;
                assert!(cost(&other) > cost(&fit.points));
            }
        }
    }

    #[test]
    fn given_directions_are_met_exactly_and_the_curve_stays_near() {
        let at = |a: f64| DVec3::new(libm::cos(a), libm::sin(a), 0.3 * a);
        let arc: Vec<DVec3> = (0..=40).map(|k| at(f64::from(k) * 0.03)).collect();
        let along = |a: f64| DVec3::new(-libm::sin(a), libm::cos(a), 0.3);
        for degree in [3, 4, 5, 7, 10] {
            let fit = fit_curve_along(&arc, degree, [along(0.0) * 7.0, along(1.2)]).unwrap();
            assert_eq!((fit.points.len(), fit.points[0], fit.points[degree]), (degree + 1, arc[0], arc[40]));
            let ends = [fit.points[1] - fit.points[0], fit.points[degree] - fit.points[degree - 1]];
            for (end, direction) in ends.into_iter().zip([along(0.0), along(1.2)]) {
                assert!(end.normalize_or_zero().distance(direction.normalize_or_zero()) < 1e-13);
            }
            let plain = fit_curve(&arc, degree).unwrap().deviation;
            assert!(fit.deviation < 4.0 * plain + 1e-12, "{degree}: {:e} {plain:e}", fit.deviation);
        }
        // A direction that leads away is no use.
        let plain = fit_curve(&arc, 5).unwrap();
        assert_eq!(fit_curve_along(&arc, 5, [-along(0.0), along(1.2)]).unwrap(), plain);
        assert_eq!(fit_curve_along(&arc, 5, [DVec3::ZERO, along(1.2)]).unwrap(), plain);
    }

    #[test]
    fn what_determines_no_curve_is_refused() {
        let line = [DVec3::ZERO, DVec3::X, DVec3::new(f64::NAN, 0.0, 0.0), DVec3::ONE];
        assert_eq!(fit_curve(&line, 0), Err(FitError::Degree(0)));
        assert_eq!(fit_curve(&line, 11), Err(FitError::Degree(11)));
        assert_eq!(fit_curve(&line[..2], 2), Err(FitError::TooFewPoints { points: 2, degree: 2 }));
        assert_eq!(fit_curve(&[], 1), Err(FitError::TooFewPoints { points: 0, degree: 1 }));
        assert_eq!(fit_curve(&line, 2), Err(FitError::NotFinite(2)));
        assert_eq!(fit_curve(&[DVec3::ONE; 8], 3), Err(FitError::Coincident(3)));
        // Two different points only, many times.
        let two: Vec<DVec3> = (0..8).map(|k| if k < 4 { DVec3::ZERO } else { DVec3::X }).collect();
        assert_eq!(fit_curve(&two, 3), Err(FitError::Coincident(3)));
    }
}
