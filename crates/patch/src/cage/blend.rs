//! Blends: how the weight of a corner fades from 1 to 0 along an edge of its quad, flat at both ends.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*, equations (6)-(8), where "some k" must be read as "all
//! derivatives up to order k"; bump and expo-rational blends from P. Salvi, *Editing the interior of arbitrary surfaces using C∞
//! displacement blends*, equations (6) and (9). `Ψ(t) + Ψ(1-t) = 1` for all of them.

use super::error::CageError;
use crate::{Erbs, basis, basis_derivative};

/// The kind of a blend.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Blend {
    /// The polynomial of degree `2k + 1` whose derivatives up to order `k`, 1 to 24, vanish at both ends.
    Hermite(u32),
    /// `exp(-t^-k)` against its mirror image, `k` from 1 to 8: infinitely flat.
    Bump(u32),
    /// The expo-rational B-spline blend: infinitely flat.
    Erbs,
}

impl Default for Blend {
    fn default() -> Self {
        Self::Hermite(2)
    }
}

/// A blend with what it needs to be evaluated.
#[derive(Clone, Debug)]
pub(super) struct Blender {
    blend: Blend,
    /// Only where it is needed: it has a table.
    erbs: Option<Erbs>,
}

impl Blender {
    pub(super) fn new(blend: Blend) -> Result<Self, CageError> {
        let erbs = match blend {
            Blend::Hermite(k) if !(1..=24).contains(&k) => return Err(CageError::HermiteOrder(k)),
            Blend::Bump(k) if !(1..=8).contains(&k) => return Err(CageError::BumpExponent(k)),
            Blend::Erbs => Some(Erbs::new()),
            _ => None,
        };
        Ok(Self { blend, erbs })
    }

    /// `Ψ` with its first and second derivative at `t` in [0, 1].
    pub(super) fn at(&self, t: f64) -> [f64; 3] {
        match self.blend {
            Blend::Hermite(k) => hermite(k as usize, t),
            Blend::Bump(k) => bump(k, t),
            Blend::Erbs => self.erbs(t),
        }
    }

    /// Equation (9) of the displacement blends, turned round: by quadrature, since tables of weights are made once.
    fn erbs(&self, t: f64) -> [f64; 3] {
        let value = self.erbs.as_ref().map_or(0.0, |erbs| erbs.exact(1.0 - t));
        [value, -Erbs::derivative(t), -Erbs::second_derivative(t)]
    }
}

/// Equation (8). Its derivative has one term, since the sum telescopes.
fn hermite(k: usize, t: f64) -> [f64; 3] {
    let degree = 2 * k + 1;
    // The smaller half of the sum: the other one would carry the rounding of many terms next to 1.
    let basis_at = basis(degree, t);
    let value =
        if t > 0.5 { basis_at[..=k].iter().sum() } else { 1.0 - basis_at[k + 1..].iter().sum::<f64>() };
    let scale = -(degree as f64);
    [value, scale * basis(degree - 1, t)[k], scale * basis_derivative(degree - 1, t)[k]]
}

/// `f(t) = ψ(t) / (ψ(t) + ψ(1-t))`, `ψ(t) = exp(-t^-k)`, turned round: `Ψ = 1 / (1 + exp(h))` with `h = (1-t)^-k - t^-k`.
fn bump(k: u32, t: f64) -> [f64; 3] {
    /// Where `exp` is still finite, with room for the powers beside it.
    const MOST: f64 = 600.0;
    let power = |base: f64, times: u32| (0..times).fold(1.0, |product, _| product / base);
    let exponent = power(1.0 - t, k) - power(t, k);
    if t <= 0.0 || exponent < -MOST {
        return [1.0, 0.0, 0.0];
    }
    if t >= 1.0 || exponent > MOST {
        return [0.0; 3];
    }
    let order = f64::from(k);
    let slope = order * (power(1.0 - t, k + 1) + power(t, k + 1));
    let bend = order * (order + 1.0) * (power(1.0 - t, k + 2) - power(t, k + 2));
    let growth = libm::exp(exponent.abs());
    let (small, large) = (1.0 / (1.0 + growth), growth / (1.0 + growth));
    let value = if exponent > 0.0 { small } else { large };
    let both = small * large;
    let rest = if exponent > 0.0 { large - small } else { small - large };
    [value, -both * slope, both * (rest * slope * slope - bend)]
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const ALL: [Blend; 7] = [
        Blend::Hermite(1),
        Blend::Hermite(2),
        Blend::Hermite(5),
        Blend::Hermite(24),
        Blend::Bump(1),
        Blend::Bump(2),
        Blend::Erbs,
    ];

    #[test]
    fn blends_fade_flatly_and_evenly() {
        for blend in ALL {
            let blender = Blender::new(blend).unwrap();
            assert_eq!(blender.at(0.0)[0], 1.0, "{blend:?}");
            assert_eq!(blender.at(1.0)[..2], [0.0; 2], "{blend:?}");
            assert!(blender.at(0.0)[1].abs() < 1e-15);
            let mut before = 1.0;
            for step in 0..=200 {
                let t = f64::from(step) / 200.0;
                let [value, slope, _] = blender.at(t);
                assert!((value + blender.at(1.0 - t)[0] - 1.0).abs() < 4e-15, "{blend:?} at {t}");
                // As even as the values themselves are.
                assert!(slope <= 0.0 && value <= before + 4e-15, "{blend:?} at {t}");
                before = value;
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for blend in ALL {
            let blender = Blender::new(blend).unwrap();
            for t in [0.08, 0.2, 0.45, 0.5, 0.71, 0.9] {
                let h = 1e-5;
                let [ahead, here, behind] = [t + h, t, t - h].map(|t| blender.at(t));
                let close = |exact: f64, difference: f64| {
                    assert!((exact - difference).abs() < 1e-6 * (1.0 + exact.abs()), "{blend:?} at {t}");
                };
                close(here[1], (ahead[0] - behind[0]) / (2.0 * h));
                close(here[2], (ahead[1] - behind[1]) / (2.0 * h));
            }
        }
    }

    #[test]
    fn known_values() {
        let at = |blend, t| Blender::new(blend).unwrap().at(t);
        let t: f64 = 0.3;
        let papers = 1.0 - t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
        assert!((at(Blend::Hermite(2), t)[0] - papers).abs() < 1e-15);
        assert!((at(Blend::Erbs, 0.5)[0] - 0.5).abs() < 5e-15);
        assert!((at(Blend::Erbs, 0.75)[0] - 0.122_967_283_277_329).abs() < 1e-14);
        assert!((at(Blend::Erbs, 0.9)[0] - 0.006_790_999_529_43).abs() < 1e-14);
        assert!((at(Blend::Bump(1), 0.5)[1] + 2.0).abs() < 1e-15);
        assert!((at(Blend::Bump(2), 0.5)[1] + 8.0).abs() < 1e-14);
    }

    #[test]
    fn senseless_orders_are_refused() {
        assert_eq!(Blender::new(Blend::Hermite(0)).unwrap_err(), CageError::HermiteOrder(0));
        assert_eq!(Blender::new(Blend::Hermite(u32::MAX)).unwrap_err(), CageError::HermiteOrder(u32::MAX));
        assert_eq!(Blender::new(Blend::Bump(0)).unwrap_err(), CageError::BumpExponent(0));
    }
}
