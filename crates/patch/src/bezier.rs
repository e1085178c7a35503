//! Bézier curves over their control points, by the algorithm of de Casteljau (Farin, *Curves and Surfaces for CAGD*,
//! chapters 4 and 6). Parameters are dimensionless; [0, 1] is the curve, values outside continue it.

mod fit;

pub use fit::{CurveFit, FitError, MOST_FITTED_DEGREE, fit_curve, fit_curve_along};

use glam::DVec3;

/// The point of a curve at `u`; the origin if there are no control points.
#[must_use]
pub fn curve_point(points: &[DVec3], u: f64) -> DVec3 {
    let mut left = points.to_vec();
    for count in (1..points.len()).rev() {
        for j in 0..count {
            left[j] = left[j] * (1.0 - u) + left[j + 1] * u;
        }
    }
    left.first().copied().unwrap_or_default()
}

/// The first derivative of a curve by `u`, in model units.
#[must_use]
pub fn curve_derivative(points: &[DVec3], u: f64) -> DVec3 {
    curve_point(&hodograph(points), u)
}

/// The control points of the derivative: one fewer.
#[must_use]
pub fn hodograph(points: &[DVec3]) -> Vec<DVec3> {
    let degree = points.len().saturating_sub(1) as f64;
    points.windows(2).map(|pair| (pair[1] - pair[0]) * degree).collect()
}

/// The control points of the same curve, one degree higher. The ends stay as they are, to the bit.
///
/// ```
/// use glam::DVec3;
/// let raised = ductile_patch::elevated(&[DVec3::ZERO, DVec3::X * 2.0]);
/// assert_eq!(raised, [DVec3::ZERO, DVec3::X, DVec3::X * 2.0]);
/// ```
#[must_use]
pub fn elevated(points: &[DVec3]) -> Vec<DVec3> {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else { return Vec::new() };
    let degree = points.len() as f64;
    let inside = points.windows(2).enumerate().map(|(j, pair)| {
        let share = (j + 1) as f64 / degree;
        pair[0] * share + pair[1] * (1.0 - share)
    });
    core::iter::once(first).chain(inside).chain(core::iter::once(last)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::basis;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn cubic() -> Vec<DVec3> {
        [[0.0, 0.0, 0.1], [1.0, 2.0, 0.3], [3.0, -1.0, -2.0], [4.0, 0.5, 0.7]].map(DVec3::from_array).to_vec()
    }

    #[test]
    fn the_point_is_the_sum_over_the_basis() {
        for u in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let sum: DVec3 = cubic().iter().zip(basis(3, u)).map(|(&point, b)| point * b).sum();
            assert!(curve_point(&cubic(), u).distance(sum) < 1e-15 * 8.0);
        }
        assert_eq!(curve_point(&[], 0.5), DVec3::ZERO);
    }

    #[test]
    fn the_derivative_agrees_with_differences() {
        let step = 1e-6;
        for u in [0.1, 0.5, 0.8] {
            let difference =
                (curve_point(&cubic(), u + step) - curve_point(&cubic(), u - step)) / (2.0 * step);
            assert!(curve_derivative(&cubic(), u).distance(difference) < 1e-8);
        }
        assert_eq!(curve_derivative(&cubic()[..1], 0.5), DVec3::ZERO);
    }

    #[test]
    fn elevation_keeps_the_curve_and_its_ends() {
        let mut raised = cubic();
        for _ in 0..5 {
            raised = elevated(&raised);
        }
        assert_eq!((raised.len(), raised[0], raised[8]), (9, cubic()[0], cubic()[3]));
        for u in [0.0, 0.3, 0.7, 1.0] {
            assert!(curve_point(&raised, u).distance(curve_point(&cubic(), u)) < 1e-15 * 8.0);
        }
        assert!(elevated(&[]).is_empty());
    }
}
