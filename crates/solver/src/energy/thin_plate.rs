//! The thin plate: `E = Σ a (L11² + 2 L12² + L22²) + beta Σ phi(J)`, the discrete `∫ (κ₁² + κ₂²) dA` and its barrier.
//!
//! Source: recipe sections 2 and 3, steps 1 and 2. With `L = (L11, √2 L12, L22)` the density is `|L|²`.

use glam::DVec3;

use super::Adjoint;
use crate::barrier;
use crate::fit::NodeFit;

/// The thin-plate part of one node's energy (without the barrier).
#[inline]
pub(crate) fn value(fit: &NodeFit) -> f64 {
    fit.area * density(fit)
}

#[inline]
fn density(fit: &NodeFit) -> f64 {
    fit.l[0] * fit.l[0] + fit.l[1] * fit.l[1] + fit.l[2] * fit.l[2]
}

/// The adjoint of energy and barrier together.
#[inline]
pub(crate) fn adjoint(fit: &NodeFit) -> Adjoint {
    let h = fit.frame.h;
    let inverse_square = 1.0 / (h * h);
    let n = fit.normal;
    let mut d = [DVec3::ZERO; 5];
    let mut normal_bar = DVec3::ZERO;
    for (i, &l) in fit.l.iter().enumerate() {
        let factor = 2.0 * fit.area * l * inverse_square;
        d[i + 2] = n * factor;
        normal_bar += fit.d[i + 2] * factor;
    }
    // n = m / |m|, J = |m| / h², m = D1 × D2.
    let slope = barrier::slope(fit.jacobian);
    let length = fit.jacobian * h * h;
    let m_bar = (normal_bar - n * n.dot(normal_bar)) / length + n * (slope * inverse_square);
    d[0] = fit.d[1].cross(m_bar);
    d[1] = m_bar.cross(fit.d[0]);
    let density = density(fit);
    Adjoint { d, area: density, h: -2.0 / h * (2.0 * fit.area * density + slope * fit.jacobian) }
}
