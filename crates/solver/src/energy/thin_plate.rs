//! The thin plate: `E = Σ a (L11² + 2 L12² + L22²) + beta Σ phi(J)`, the discrete `∫ (κ₁² + κ₂²) dA` and its barrier.
//!
//! Source: recipe sections 2 and 3, steps 1 and 2. With `L = (L11, √2 L12, L22)` the density is `|L|²`. The barrier
//! comes in as its value and slope, because it is zero for all ordinary nodes.

use super::Adjoint;
use crate::fit::Fit;
use crate::lanes::{Real, Vector};

/// The thin-plate part of a node's energy (without the barrier).
#[inline(always)]
pub(crate) fn value<T: Real>(fit: &Fit<T>) -> T {
    fit.area * density(fit)
}

#[inline(always)]
fn density<T: Real>(fit: &Fit<T>) -> T {
    fit.l[0] * fit.l[0] + fit.l[1] * fit.l[1] + fit.l[2] * fit.l[2]
}

/// What is asked of the fit of a node, or of two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand<T> {
    /// Weight of the thin plate.
    pub(crate) weight: T,
    /// Derivative of other terms with respect to `L = (L11, √2 L12, L22)`.
    pub(crate) bending: [T; 3],
    /// Slope of the barrier.
    pub(crate) slope: T,
}

/// The adjoint of weighted plate, bending and barrier together; `h` is the mean chord.
#[inline(always)]
pub(crate) fn adjoint<T: Real>(fit: &Fit<T>, h: T, demand: &Demand<T>) -> Adjoint<T> {
    let Demand { weight, bending, slope } = *demand;
    let two = T::splat(2.0);
    let inverse_square = T::splat(1.0) / (h * h);
    let n = fit.normal;
    let mut d = [Vector::zero(); 5];
    let mut normal_bar = Vector::zero();
    let scale = two * fit.area * inverse_square;
    for i in 0..3 {
        let factor = scale * fit.l[i] * weight + bending[i] * inverse_square;
        d[i + 2] = n * factor;
        normal_bar += fit.d[i + 2] * factor;
    }
    // n = m / |m|, J = |m| / h², m = D1 × D2.
    let length = fit.jacobian * h * h;
    let m_bar =
        (normal_bar - n * n.dot(normal_bar)) * (T::splat(1.0) / length) + n * (slope * inverse_square);
    d[0] = fit.d[1].cross(m_bar);
    d[1] = m_bar.cross(fit.d[0]);
    let density = density(fit);
    let other = bending[0] * fit.l[0] + bending[1] * fit.l[1] + bending[2] * fit.l[2];
    let along = two * fit.area * density * weight + other + slope * fit.jacobian;
    Adjoint { d, area: density * weight, h: -(two / h) * along }
}

/// The derivative of weighted plate and bending with respect to the fit of an ordinary node, which has no barrier.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NormalAdjoint<T> {
    /// With respect to D1 to D5: all of it lies along the normal.
    pub(crate) d: [T; 5],
    /// With respect to the area.
    pub(crate) area: T,
}

/// As [`adjoint`], for ordinary nodes.
#[inline(always)]
pub(crate) fn normal_adjoint<T: Real>(
    fit: &Fit<T>,
    h: T,
    weight: T,
    bending: Option<[T; 3]>,
) -> NormalAdjoint<T> {
    let squared = h * h;
    let inverse_square = T::splat(1.0) / squared;
    let scale = T::splat(2.0) * fit.area * weight;
    let mut asked = fit.l.map(|l| scale * l);
    if let Some(bending) = bending {
        for c in 0..3 {
            asked[c] += bending[c];
        }
    }
    let asked = asked.map(|asked| asked * inverse_square);
    // m = D1 × D2 = |m| n: an upright m̄ would be the barrier's.
    let normal_bar = fit.d[2] * asked[0] + fit.d[3] * asked[1] + fit.d[4] * asked[2];
    let price = normal_bar * (T::splat(1.0) / (fit.jacobian * squared));
    let d = [
        price.dot(fit.normal.cross(fit.d[1])),
        price.dot(fit.d[0].cross(fit.normal)),
        asked[0],
        asked[1],
        asked[2],
    ];
    NormalAdjoint { d, area: density(fit) * weight }
}
