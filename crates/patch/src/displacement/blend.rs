//! Blend functions, which carry 0 to 1 with all derivatives vanishing at both ends, and the range that says how far a
//! displacement reaches.
//!
//! Source: P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*, eq. (5)–(10). All of
//! it is dimensionless. Values are exactly 0 and 1 at the ends: only so does a foot move by exactly what is asked.

use super::erbs::Erbs;
use thiserror::Error;

/// A family of blend functions with its parameter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Blend {
    /// The expo-rational B-spline, eq. (9): the gentlest slope, 1.66 at most.
    #[default]
    Erbs,
    /// The bump function, eq. (6), with its exponent in (0, 100]; slope 2 at most for 1, and 8 for 2.
    Bump(f64),
    /// The function η, eq. (7) and (8), with its margin δ in [0, 1/2): 0 up to δ, and 1 from 1 - δ on.
    Eta(f64),
}

/// A parameter of a blend or of a range that makes no sense.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BlendError {
    /// As in `Blend::Bump(0.0)`.
    #[error("the exponent {0} of a bump is not above 0 and at most 100")]
    BumpExponent(f64),
    /// As in `Blend::Eta(0.5)`.
    #[error("the margin {0} of an eta blend is not in [0, 1/2)")]
    EtaMargin(f64),
    /// As in `Range::new(1.0)`.
    #[error("the range {0} is not a number below 1")]
    Range(f64),
    /// As in `Range::of_size(0.0)`.
    #[error("the size {0} is not above 0 and below 1")]
    Size(f64),
}

/// A blend ready to be evaluated.
///
/// ```
/// use ductile_patch::{Blend, BlendFunction};
/// let bump = BlendFunction::new(Blend::Bump(1.0)).unwrap();
/// assert_eq!([bump.value(0.0), bump.value(0.5), bump.value(1.0)], [0.0, 0.5, 1.0]);
/// ```
#[derive(Clone, Debug)]
pub struct BlendFunction {
    blend: Blend,
    erbs: Erbs,
}

impl BlendFunction {
    /// Prepares a blend.
    ///
    /// # Errors
    /// A parameter out of its interval: [`BlendError::BumpExponent`], [`BlendError::EtaMargin`].
    pub fn new(blend: Blend) -> Result<Self, BlendError> {
        match blend {
            Blend::Bump(k) if !(k > 0.0 && k <= 100.0) => Err(BlendError::BumpExponent(k)),
            Blend::Eta(delta) if !(0.0..0.5).contains(&delta) => Err(BlendError::EtaMargin(delta)),
            _ => Ok(Self { blend, erbs: Erbs::new() }),
        }
    }

    /// What was prepared.
    #[must_use]
    pub fn blend(&self) -> Blend {
        self.blend
    }

    /// The value in [0, 1]; 0 for parameters up to 0 and for NaN, 1 from 1 on.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        match self.blend {
            Blend::Erbs => self.erbs.value(t),
            Blend::Bump(k) => logistic(t, bump_exponent(t, k)),
            Blend::Eta(delta) => {
                let tau = (t - delta) / (1.0 - 2.0 * delta);
                logistic(tau, eta_exponent(tau))
            }
        }
    }

    /// The first derivative; 0 at the ends and outside.
    #[must_use]
    pub fn derivative(&self, t: f64) -> f64 {
        match self.blend {
            Blend::Erbs => Erbs::derivative(t),
            Blend::Bump(k) => logistic_slope(t, bump_exponent(t, k), || {
                -k * (libm::pow(t, -k - 1.0) + libm::pow(1.0 - t, -k - 1.0))
            }),
            Blend::Eta(delta) => {
                let tau = (t - delta) / (1.0 - 2.0 * delta);
                let slope = || eta_logarithm_slope(tau, 1.0 - tau) + eta_logarithm_slope(1.0 - tau, tau);
                logistic_slope(tau, eta_exponent(tau), slope) / (1.0 - 2.0 * delta)
            }
        }
    }
}

/// `Ψ(t) / (Ψ(t) + Ψ(1 - t)) = 1 / (1 + exp x)` for eq. (6): with the quotient of the two no `0 / 0` can come.
fn bump_exponent(t: f64, k: f64) -> f64 {
    libm::pow(t, -k) - libm::pow(1.0 - t, -k)
}

/// The same for eq. (7): `ϕ(1 - τ)` above, so the difference of the logarithms of eq. (8).
fn eta_exponent(tau: f64) -> f64 {
    eta_logarithm(tau, 1.0 - tau) - eta_logarithm(1.0 - tau, tau)
}

/// Of `τ` and `1 - τ`, each as it is: from a `1 - τ` that was rounded to 1 there is no way back to `τ`.
fn eta_logarithm(tau: f64, rest: f64) -> f64 {
    -2.0 * libm::exp(-1.0 / tau) / rest
}

fn eta_logarithm_slope(tau: f64, rest: f64) -> f64 {
    eta_logarithm(tau, rest) * (1.0 / (tau * tau) + 1.0 / rest)
}

fn logistic(t: f64, exponent: f64) -> f64 {
    if t >= 1.0 {
        1.0
    } else if t > 0.0 {
        1.0 / (1.0 + libm::exp(exponent))
    } else {
        0.0
    }
}

/// The derivative of [`logistic`]; `slope` is that of the exponent.
fn logistic_slope(t: f64, exponent: f64, slope: impl Fn() -> f64) -> f64 {
    let falls = 1.0 / (1.0 + libm::exp(-exponent));
    let product = if t > 0.0 && t < 1.0 { falls / (1.0 + libm::exp(exponent)) } else { 0.0 };
    // Near the ends the slope of the exponent overflows long after the product has vanished.
    if product > 0.0 { -product * slope() } else { 0.0 }
}

/// How far a displacement reaches: `R(t) = 1 - (1 - t)^p` with `p = 1 / (1 - r)`, eq. (10).
///
/// ```
/// use ductile_patch::Range;
/// let range = Range::new(0.5).unwrap();
/// assert_eq!(range.apply(0.25), 1.0 - 0.75 * 0.75);
/// // A size says where the blend is 1/2: at this share of the way from foot to boundary.
/// let range = Range::of_size(0.3).unwrap();
/// assert!((range.apply(0.7) - 0.5).abs() < 1e-15);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    exponent: f64,
}

impl Default for Range {
    fn default() -> Self {
        Self { exponent: 1.0 }
    }
}

impl Range {
    /// The range `r`, below 1: 0 changes nothing, larger ones widen the plateau around the foot, negative ones make it
    /// smaller than the paper allows.
    ///
    /// # Errors
    /// [`BlendError::Range`].
    pub fn new(r: f64) -> Result<Self, BlendError> {
        let exponent = 1.0 / (1.0 - r);
        if r < 1.0 && exponent > 0.0 && exponent.is_finite() {
            Ok(Self { exponent })
        } else {
            Err(BlendError::Range(r))
        }
    }

    /// The range by which the blend is 1/2 where the conformal radius is `size`, in (0, 1); up to 0.9 is sensible.
    ///
    /// # Errors
    /// [`BlendError::Size`].
    pub fn of_size(size: f64) -> Result<Self, BlendError> {
        let exponent = -core::f64::consts::LN_2 / libm::log(size);
        if size > 0.0 && size < 1.0 && exponent > 0.0 && exponent.is_finite() {
            Ok(Self { exponent })
        } else {
            Err(BlendError::Size(size))
        }
    }

    /// The exponent `p = 1 / (1 - r)`, above 0.
    #[must_use]
    pub fn exponent(self) -> f64 {
        self.exponent
    }

    /// The range `r = 1 - 1 / p`.
    #[must_use]
    pub fn range(self) -> f64 {
        1.0 - 1.0 / self.exponent
    }

    /// The size `s`, where `s^p = 1/2`.
    #[must_use]
    pub fn size(self) -> f64 {
        libm::exp(-core::f64::consts::LN_2 / self.exponent)
    }

    /// `R(t)`, which is in [0, 1] for any `t`: those outside of [0, 1], and NaN, are taken to an end.
    #[must_use]
    pub fn apply(self, t: f64) -> f64 {
        if t >= 1.0 {
            1.0
        } else if t > 0.0 {
            self.apply_to_logarithm(libm::log1p(-t))
        } else {
            0.0
        }
    }

    /// `R(t)` from `ln(1 - t)`, which is minus infinity at a foot and 0 at the boundary: one exponential, no power, and no
    /// digits lost near the boundary.
    pub(crate) fn apply_to_logarithm(self, logarithm: f64) -> f64 {
        -libm::expm1(self.exponent * logarithm)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn blends() -> Vec<BlendFunction> {
        let blends = [
            Blend::Erbs,
            Blend::Bump(1.0),
            Blend::Bump(2.0),
            Blend::Bump(0.5),
            Blend::Bump(100.0),
            Blend::Eta(0.0),
            Blend::Eta(0.1),
            Blend::Eta(0.49),
        ];
        blends.map(|blend| BlendFunction::new(blend).unwrap()).into()
    }

    #[test]
    fn every_blend_is_a_symmetric_monotone_step() {
        for function in blends() {
            let blend = function.blend();
            assert_eq!([0.0, 0.5, 1.0].map(|t| function.value(t)), [0.0, 0.5, 1.0], "{blend:?}");
            assert_eq!([-1.0, f64::NAN, 2.0].map(|t| function.value(t)), [0.0, 0.0, 1.0], "{blend:?}");
            assert_eq!(
                [-1.0, 0.0, f64::NAN, 1.0, 2.0].map(|t| function.derivative(t)),
                [0.0; 5],
                "{blend:?}"
            );
            let mut before = 0.0;
            for step in 0..=20_000 {
                let t = f64::from(step) / 20_000.0;
                let (value, mirrored) = (function.value(t), function.value(1.0 - t));
                assert!(value >= before - 1e-18, "{blend:?} falls at {t}");
                // 1 - t is rounded where the steepest of them climbs fastest.
                assert!((value + mirrored - 1.0).abs() < 2e-14, "{blend:?} is not symmetric at {t}");
                assert!(function.derivative(t).is_finite() && function.derivative(t) >= 0.0);
                before = value;
            }
        }
    }

    /// However near to its ends, where `1 - t` is 1: a mesh has heights of 1e-17 beside its boundary.
    #[test]
    fn every_blend_stays_near_its_ends() {
        for function in blends() {
            for t in [1e-300, 1e-100, 1e-17, 1e-16, 1e-12, 1e-9, 1e-5] {
                let (value, slope) = (function.value(t), function.derivative(t));
                assert!(value < 1e-50 && slope < 1e-50, "{:?} at {t:e}: {value} {slope}", function.blend());
                let mirrored = function.value(1.0 - t);
                assert!(mirrored > 1.0 - 1e-8 && mirrored <= 1.0, "{:?} at 1 - {t:e}", function.blend());
            }
        }
    }

    #[test]
    fn slopes_agree_with_differences_and_with_the_paper() {
        for function in blends() {
            for step in 1..200 {
                let (t, h) = (f64::from(step) / 200.0, 1e-6);
                let difference = (function.value(t + h) - function.value(t - h)) / (2.0 * h);
                let slope = function.derivative(t);
                let by = 1e-6 * (1.0 + slope);
                // The steepest of them bend too much for this difference.
                if slope < 10.0 && !matches!(function.blend(), Blend::Bump(100.0) | Blend::Eta(0.49)) {
                    assert!((slope - difference).abs() < by, "{:?} at {t}: {slope}", function.blend());
                }
            }
        }
        let slope = |blend| BlendFunction::new(blend).unwrap().derivative(0.5);
        assert!((slope(Blend::Bump(1.0)) - 2.0).abs() < 1e-14);
        assert!((slope(Blend::Bump(2.0)) - 8.0).abs() < 1e-13);
    }

    #[test]
    fn parameters_out_of_their_intervals_are_refused() {
        for k in [0.0, -1.0, 101.0, f64::NAN] {
            assert!(matches!(BlendFunction::new(Blend::Bump(k)), Err(BlendError::BumpExponent(_))));
        }
        for delta in [0.5, -0.1, f64::NAN] {
            assert!(matches!(BlendFunction::new(Blend::Eta(delta)), Err(BlendError::EtaMargin(_))));
        }
        for r in [1.0, 2.0, f64::NAN, f64::NEG_INFINITY] {
            assert!(matches!(Range::new(r), Err(BlendError::Range(_))), "{r}");
        }
        for size in [0.0, 1.0, -0.5, f64::NAN] {
            assert!(matches!(Range::of_size(size), Err(BlendError::Size(_))), "{size}");
        }
    }

    #[test]
    fn ranges_are_the_paper_s_formula() {
        for r in [-3.0, 0.0, 0.25, 0.5, 0.75, 0.95] {
            let range = Range::new(r).unwrap();
            assert!((range.range() - r).abs() < 1e-14);
            let same = Range::of_size(range.size()).unwrap();
            assert!((same.exponent() - range.exponent()).abs() < 1e-12 * range.exponent());
            for step in 0..=100 {
                let t = f64::from(step) / 100.0;
                let formula = 1.0 - libm::pow(1.0 - t, 1.0 / (1.0 - r));
                assert!((range.apply(t) - formula).abs() < 1e-14, "r {r}, t {t}");
            }
            assert_eq!([range.apply(0.0), range.apply(1.0)], [0.0, 1.0]);
            assert_eq!([-1.0, 1.0 + 1e-16, 1.5, f64::NAN].map(|t| range.apply(t)), [0.0, 1.0, 1.0, 0.0]);
        }
        // Where the blend is 1/2: recipe, section 8.
        for (r, h) in [(0.0, 0.5), (0.5, 0.293), (0.9, 0.067), (0.95, 0.034)] {
            assert!((Range::new(r).unwrap().apply(h) - 0.5).abs() < 6e-3, "{r}");
        }
        assert!((Range::new(0.95).unwrap().size() - 0.966).abs() < 5e-4);
        let same = Range::new(0.25).unwrap();
        assert_eq!(same.apply_to_logarithm(f64::NEG_INFINITY), 1.0);
        assert_eq!(same.apply_to_logarithm(0.0), 0.0);
    }
}
