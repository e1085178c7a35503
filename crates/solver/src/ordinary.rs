//! The exact gradient and the curvature rows of ordinary nodes, two side by side, all in scalars.
//!
//! Source: recipe section 3, steps 1 to 6, as in [`gradient`](crate::gradient), which does the same for any node. What is
//! special here: without a barrier, everything that an energy of the second fundamental form asks of the coefficients
//! `D1` to `D5` points along the normal `n`. (`D̄3` to `D̄5` do by definition; `n̄` lies in the tangent plane, so that
//! `D̄1 = D2 × m̄` and `D̄2 = m̄ × D1` stand upright on it.) So `X = M⁻¹ D̄` is `ξ n` with five numbers `ξ`, the adjoint of
//! a chord by the fit is a multiple of `n`, and of the chord and the coefficients only what they have along `n` counts:
//!
//! ```text
//! q(u, v) = ξ·row        s(u, v) = L h²·(second-order part of the row)        ρ = e·n - s
//! ū = ρ q_u - q s_u      v̄ = ρ q_v - q s_v      ē = q n + (polar coordinates)
//! ```
//!
//! With `u = r cos θ / h` and `v = r sin θ / h` the derivative by `log r` is `u ū + v v̄` and that by `θ` is `u v̄ - v ū`.

use std::f64::consts::FRAC_1_SQRT_2;

use crate::energy::thin_plate::NormalAdjoint;
use crate::fit::{self, Fit};
use crate::lanes::{Real, Vector};
use crate::neighbourhood::{ROOM, Ring, Spoke};
use crate::rings::MAX_RING;

/// What one chord feels.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct End<T> {
    /// Derivative with respect to the chord `e_j`.
    pub(crate) chord: Vector<T>,
    /// With respect to the logarithm of its length.
    stretch: T,
    /// With respect to `theta_j`.
    theta: T,
    /// With respect to the scaled angle between the chord and the next (the area sees it directly).
    gap: T,
}

/// Where the way back ends; kept and used again. Entries beyond the degree are left over.
#[derive(Clone, Debug)]
pub(crate) struct Ordinary<T> {
    pub(crate) ends: [End<T>; ROOM],
}

impl<T: Real> Default for Ordinary<T> {
    fn default() -> Self {
        Self { ends: [End::default(); ROOM] }
    }
}

/// A quadratic form `½ uu x² + mixed xy + ½ vv y²`, with the factor of the basis in `mixed`.
struct Form<T> {
    uu: T,
    mixed: T,
    vv: T,
}

impl<T: Real> Form<T> {
    #[inline(always)]
    fn new([uu, mixed, vv]: [T; 3]) -> Self {
        Self { uu, mixed: mixed * T::splat(FRAC_1_SQRT_2), vv }
    }

    /// Its derivatives.
    #[inline(always)]
    fn slope(&self, u: T, v: T) -> (T, T) {
        (self.uu * u + self.mixed * v, self.mixed * u + self.vv * v)
    }
}

impl<T: Real> Ordinary<T> {
    /// The derivative with respect to every chord. `turning` is what else there is to the derivative by every `theta_j`.
    #[inline(always)]
    pub(crate) fn run<const N: usize>(
        &mut self,
        ring: &Ring<T>,
        fit: &Fit<T>,
        adjoint: &NormalAdjoint<T>,
        turning: Option<&[T; MAX_RING]>,
    ) {
        self.through_fit::<N>(ring, fit, adjoint);
        for (end, &turning) in self.ends[..ring.degree].iter_mut().zip(turning.into_iter().flatten()) {
            end.theta += turning;
        }
        self.through_area(ring, adjoint.area);
        self.through_angles(ring);
        for (end, spoke) in self.ends[..ring.degree].iter_mut().zip(&ring.spokes) {
            end.chord += spoke.chord * (end.stretch / (spoke.r * spoke.r));
        }
    }

    /// Steps 2 to 4: least squares, basis, polar coordinates.
    #[inline(always)]
    fn through_fit<const N: usize>(&mut self, ring: &Ring<T>, fit: &Fit<T>, adjoint: &NormalAdjoint<T>) {
        let mut xi = [T::splat(0.0); 5];
        for i in 0..N {
            xi[i] = adjoint.d[0] * fit.inverse[i][0];
            for k in 1..N {
                xi[i] += adjoint.d[k] * fit.inverse[i][k];
            }
        }
        let (squared, half, zero, n) = (ring.h * ring.h, T::splat(0.5), T::splat(0.0), fit.normal);
        let surface = Form::new(fit.l.map(|l| l * squared));
        let price = Form::new([xi[2], xi[3], xi[4]]);
        for (end, &Spoke { chord, u, v, .. }) in self.ends[..ring.degree].iter_mut().zip(&ring.spokes) {
            let (s_u, s_v) = surface.slope(u, v);
            let (q_u, q_v) = price.slope(u, v);
            let q = u * (xi[0] + half * q_u) + v * (xi[1] + half * q_v);
            let rho = chord.dot(n) - half * (u * s_u + v * s_v);
            let u_bar = rho * (xi[0] + q_u) - q * s_u;
            let v_bar = rho * (xi[1] + q_v) - q * s_v;
            *end =
                End { chord: n * q, stretch: u * u_bar + v * v_bar, theta: u * v_bar - v * u_bar, gap: zero };
        }
    }

    /// Step 4, last part: the area of the fan, the sum of `h² (u_j v_{j+1} - v_j u_{j+1}) / 6`.
    #[inline(always)]
    fn through_area(&mut self, ring: &Ring<T>, area_bar: T) {
        let (degree, gaps) = (ring.degree, ring.gaps());
        let sixth = area_bar * (ring.h * ring.h) * T::splat(1.0 / 6.0);
        self.ends[degree] = End::default();
        // What the gap before adds to a chord, besides the one after.
        let mut before = T::splat(0.0);
        let pairs = ring.spokes[..=gaps].windows(2).zip(&ring.shares);
        for (end, (pair, &share)) in self.ends.iter_mut().zip(pairs) {
            let [near, far] = [&pair[0], &pair[1]];
            let sixth = sixth * share;
            let sine = sixth * (near.u * far.v - near.v * far.u);
            end.gap = sixth * (near.u * far.u + near.v * far.v);
            end.stretch += before + sine;
            before = sine;
        }
        self.ends[gaps].stretch += before;
    }

    /// Step 5: scaled angles -> unscaled angles -> chords.
    #[inline(always)]
    fn through_angles(&mut self, ring: &Ring<T>) {
        let (degree, gaps) = (ring.degree, ring.gaps());
        let zero = T::splat(0.0);
        // theta_j = start + s cum_j, gap_j = s angle_j, s = target / total, start = (π - target) / 2
        let (mut scale_bar, mut cumulative) = (zero, zero);
        for (end, spoke) in self.ends[..degree].iter().zip(&ring.spokes) {
            scale_bar += end.theta * cumulative + end.gap * spoke.angle;
            cumulative += spoke.angle;
        }
        let turned = || self.ends[..degree].iter().fold(zero, |sum, end| sum + end.theta);
        let total_bar = ring.total_bar(scale_bar, turned);
        // Angle j turns every later chord: run backwards over the sum of their theta_bar.
        let mut later = if ring.is_boundary { self.ends[degree - 1].theta } else { zero };
        for j in (0..gaps).rev() {
            let ([near, far], [end, next]) = (&ring.spokes[j..j + 2], &mut self.ends[j..j + 2]) else {
                break;
            };
            let angle_bar = ring.scale * (later + end.gap) + total_bar;
            let factor = angle_bar / near.cross_length;
            let along = factor * near.dot;
            // (a x b) x a = b (a.a) - a (a.b): across, and along the chord itself, where its length adds its part.
            end.chord -= far.chord * factor;
            next.chord -= near.chord * factor;
            end.stretch += along;
            next.stretch += along;
            later += end.theta;
        }
        if !ring.is_boundary {
            let repeated = self.ends[degree];
            self.ends[0].chord += repeated.chord;
            self.ends[0].stretch += repeated.stretch;
        }
    }
}

/// The rows `√a Z / h²` of the neighbours, and `√a L²` in the centre's place.
#[inline(always)]
pub(crate) fn write_rows<T: Real, const N: usize>(
    ring: &Ring<T>,
    fit: &Fit<T>,
    mut write: impl FnMut(usize, usize, T),
) {
    let root = fit.area.sqrt();
    let squared = fit::square(fit.l);
    let factor = root / (ring.h * ring.h);
    let (half, mixed) = (factor * T::splat(0.5), factor * T::splat(FRAC_1_SQRT_2));
    for c in 0..3 {
        write(0, c, root * squared[c]);
    }
    for c in 0..3 {
        if c + 2 >= N {
            (0..ring.degree).for_each(|j| write(j + 1, c, T::splat(0.0)));
            continue;
        }
        let inverse = &fit.inverse[c + 2];
        let [a, b] = [inverse[0] * factor, inverse[1] * factor];
        let form = [inverse[2] * half, inverse[3] * mixed, inverse[4] * half];
        for (j, &Spoke { u, v, .. }) in ring.spokes[..ring.degree].iter().enumerate() {
            let mut sum = u * (a + form[0] * u);
            if N == 5 {
                sum += v * (b + form[1] * u + form[2] * v);
            } else {
                sum += v * b;
            }
            write(j + 1, c, sum);
        }
    }
}
