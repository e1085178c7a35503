//! The Jacobian barrier: a price on folding that is exactly zero wherever the mesh resolves the shape.
//!
//! The discrete thin-plate energy is blind to folds and to spikes of one node (recipe, section 2): a spike costs at
//! most a constant however high it is. The fitted quadratic sees it: its Jacobian `J = |s_u × s_v|` drops towards
//! zero, while `J = 1 - O(k² h²)` on resolved geometry.

/// Below this Jacobian the barrier starts: three sigma away from anything a resolved mesh shows (`k h <= 0.7`).
pub(crate) const START: f64 = 0.5;
/// The Jacobian is not followed below this, so that a flat fold has a large but finite price.
const CLAMP: f64 = 1e-3;
/// Weight `beta` of the barrier; the energy of a half sphere is 4π, so one folded node outweighs any shape.
const WEIGHT: f64 = 1.0;

/// `beta phi(J)` with `phi = (J0 / J - 1)²` below `J0`.
#[inline]
pub(crate) fn value(jacobian: f64) -> f64 {
    if jacobian >= START {
        return 0.0;
    }
    let excess = START / jacobian.max(CLAMP) - 1.0;
    WEIGHT * excess * excess
}

/// `beta phi'(J)`; zero where the Jacobian is clamped, so that it stays the exact derivative of [`value`].
#[inline]
pub(crate) fn slope(jacobian: f64) -> f64 {
    if !(CLAMP..START).contains(&jacobian) {
        return 0.0;
    }
    -2.0 * WEIGHT * (START / jacobian - 1.0) * START / (jacobian * jacobian)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn resolved_geometry_costs_nothing() {
        assert_eq!((value(0.5), slope(0.5)), (0.0, 0.0));
        assert_eq!((value(1.2), slope(1.2)), (0.0, 0.0));
    }

    #[test]
    fn slope_is_the_derivative() {
        for jacobian in [0.002, 0.01, 0.1, 0.3, 0.49] {
            let step = 1e-6 * jacobian;
            let difference = (value(jacobian + step) - value(jacobian - step)) / (2.0 * step);
            assert!((difference / slope(jacobian) - 1.0).abs() < 1e-6);
        }
    }

    #[test]
    fn flat_fold_is_dear_but_finite() {
        assert!(value(0.0) > 1e5 && value(0.0).is_finite());
        assert_eq!(slope(0.0), 0.0);
    }
}
