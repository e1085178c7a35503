//! The faceted parameterisation: a node's ring unrolled into the plane, lengths kept, angles scaled to fill it.
//!
//! Source: recipe section 1, after Welch 1995, section 5.3.1. `theta_j = (target / total) * (angle_0 + ... +
//! angle_{j-1})` with target 2π inside and π on the boundary, where the ring starts and ends on the boundary, so
//! those two neighbours lie on the ± u axis. The radius is the chord; it is exact on spheres and must not be
//! corrected by the metric.
//!
//! Beyond the recipe: where a boundary turns back, as at the end of a slit, the angles are let be what they are
//! ([`open_target`]). Squeezed into half a plane, a flat ring of 2π has a Jacobian of a half at best and of a tenth where its
//! chords differ, which the barrier takes for a fold.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use glam::DVec3;

use crate::angle;
use crate::even_ring;
use crate::lanes::{Real, Vector};
use crate::rings::{MAX_RING, Rings};

/// Sum of angles below which a ring is a needle without a parameterisation.
const MIN_TOTAL: f64 = 1e-9;
/// Sine of the angle between two chords below which they span no plane.
pub(crate) const COLLINEAR: f64 = 1e-14;

/// Room for a ring, with one more place: a closed ring repeats its first neighbour after the last, so that nothing need wrap.
pub(crate) const ROOM: usize = MAX_RING + 1;

/// A neighbour, and the angle to the next one.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spoke<T> {
    /// From the node to the neighbour.
    pub(crate) chord: Vector<T>,
    /// Its length.
    pub(crate) r: T,
    /// Cosine and sine of `theta_j`.
    pub(crate) cos: T,
    pub(crate) sin: T,
    /// `r cos / h` and `r sin / h`.
    pub(crate) u: T,
    pub(crate) v: T,
    /// The unscaled angle between the chord and the next one; 0 for the last chord of an open ring.
    pub(crate) angle: T,
    /// Scalar product of the chord with the next one, and the length of their cross product.
    pub(crate) dot: T,
    pub(crate) cross_length: T,
}

/// A node's neighbours in polar coordinates (of two nodes at once where `T` has two lanes); kept and used again.
///
/// Entries beyond `degree`, and the one repeated, are left over from earlier nodes.
#[derive(Clone, Debug)]
pub(crate) struct Ring<T> {
    pub(crate) degree: usize,
    pub(crate) is_boundary: bool,
    /// One for each neighbour; a closed ring has its first once more at the end.
    pub(crate) spokes: [Spoke<T>; ROOM],
    /// Per neighbour the part of the triangle up to the next one that is the node's, in thirds.
    pub(crate) shares: [T; ROOM],
    /// Whether all of these are 1.
    pub(crate) is_even: bool,
    /// Mean chord length; `u` and `v` are divided by it.
    pub(crate) h: T,
    /// Sum of the unscaled angles, at least the guard.
    pub(crate) total: T,
    /// `target / total`.
    pub(crate) scale: T,
    /// The scaled angle of the first chord: 0, or less where the boundary turns back, so that `v` halves the ring.
    pub(crate) start: T,
    /// How the target grows with the total; 0 but where the boundary turns back.
    pub(crate) target_slope: T,
    /// Whether it does in any lane.
    pub(crate) turns_back: bool,
    /// Whether `total` is the true sum (not the guard), in all lanes.
    pub(crate) is_total_true: bool,
}

impl<T: Real> Default for Ring<T> {
    fn default() -> Self {
        let zero = T::default();
        Self {
            degree: 0,
            is_boundary: false,
            spokes: [Spoke::default(); ROOM],
            shares: [T::splat(1.0); ROOM],
            is_even: true,
            h: zero,
            total: zero,
            scale: zero,
            start: zero,
            target_slope: zero,
            turns_back: false,
            is_total_true: false,
        }
    }
}

/// Up to this total, a corner of 315°, an open ring fills half a plane: a flat and even one then has a Jacobian of 4/7, which the
/// barrier lets pass. Skins that are still crumpled often have more than 270° at a rim.
const BEND_FROM: f64 = 1.75 * PI;
/// From here on the ring is what it is.
const BENT: f64 = 1.95 * PI;
/// From here on no more is added than another quarter of π: a crumpled ring must not wind round and round.
const BEND_TO: f64 = 2.25 * PI;

/// What the angles of an open ring are scaled to fill, and how that grows with their sum.
///
/// π up to 7/4 π, the sum itself from 1.95 π to 9/4 π, at most 5/2 π; a quadratic or cubic between, so that the slope is continuous.
fn open_target<T: Real>(total: T) -> (T, T) {
    let (zero, one) = (T::splat(0.0), T::splat(1.0));
    let (rising, falling) = (T::splat(BENT - BEND_FROM), T::splat(0.5 * PI));
    let clamp = |x: T, most: T| {
        let x = T::choose(x.less(zero), zero, x);
        T::choose(x.less(most), x, most)
    };
    let rise = clamp((total - T::splat(BEND_FROM)) / rising, one);
    let own = clamp(total - T::splat(BENT), T::splat(BEND_TO - BENT));
    let fall = clamp((total - T::splat(BEND_TO)) / falling, one);
    // The cubic through (0, 0) and (1, 0.95 π) with the slopes 0 and 0.2 π.
    let lifted = rise * rise * (T::splat(2.65 * PI) - T::splat(1.7 * PI) * rise);
    let target = T::splat(PI) + lifted + own + falling * fall * (one - T::splat(0.5) * fall);
    let while_rising = rise * (T::splat(5.3 * PI) - T::splat(5.1 * PI) * rise) / rising;
    (target, T::choose(rise.less(one), while_rising, one - fall))
}

/// Number of angles in a ring: a closed ring has one per spoke, an open ring one less.
#[inline]
pub(crate) fn gaps(degree: usize, is_boundary: bool) -> usize {
    if is_boundary { degree.saturating_sub(1) } else { degree }
}

impl<T: Real> Ring<T> {
    /// Takes the chords of one node per lane; all have the same degree and lie inside or on the boundary alike.
    #[inline(always)]
    pub(crate) fn load(&mut self, rings: &Rings, positions: &[DVec3], nodes: [u32; 2]) {
        let nodes = nodes.map(|node| node as usize);
        let near = rings.ring(nodes[0]);
        let far = rings.ring(nodes[T::LANES - 1]);
        self.degree = near.len().min(far.len()).min(MAX_RING);
        self.is_boundary = rings.is_boundary(nodes[0]);
        let centre = Vector::<T>::gather(|lane| positions[nodes[lane]]);
        for (spoke, (&first, &second)) in self.spokes.iter_mut().zip(near.iter().zip(far)) {
            let end = Vector::gather(|lane| positions[if lane == 0 { first } else { second } as usize]);
            spoke.chord = end - centre;
        }
    }

    /// Number of angles.
    #[inline(always)]
    pub(crate) fn gaps(&self) -> usize {
        gaps(self.degree, self.is_boundary)
    }

    /// The neighbour after `j`.
    #[inline(always)]
    pub(crate) fn next(&self, j: usize) -> usize {
        if j + 1 == self.degree { 0 } else { j + 1 }
    }

    /// Unrolls the loaded chords. True where every lane is free of the exceptions that ask for care.
    #[inline(always)]
    pub(crate) fn unroll(&mut self) -> bool {
        let (degree, gaps) = (self.degree, self.gaps());
        let mut sum_r = T::splat(0.0);
        for spoke in &mut self.spokes[..degree] {
            spoke.r = spoke.chord.length();
            sum_r += spoke.r;
        }
        self.h = sum_r / T::splat(degree as f64);
        self.spokes[degree] = self.spokes[0];
        let is_plane = self.measure_angles();
        let inverse_h = T::splat(1.0) / self.h;
        let mut cumulative = T::splat(0.0);
        for (spoke, even) in self.spokes.iter_mut().zip(even_ring::spokes(degree, gaps)) {
            (spoke.sin, spoke.cos) = angle::direction_near(self.start + self.scale * cumulative, even);
            let radius = spoke.r * inverse_h;
            (spoke.u, spoke.v) = (radius * spoke.cos, radius * spoke.sin);
            cumulative += spoke.angle;
        }
        self.spokes[degree] = self.spokes[0];
        is_plane && self.is_total_true
    }

    /// The angles between neighbouring chords and their sum. True where all of them span a plane.
    #[inline(always)]
    fn measure_angles(&mut self) -> bool {
        let (degree, gaps) = (self.degree, self.gaps());
        let zero = T::splat(0.0);
        let mut total = zero;
        let mut is_plane_everywhere = true;
        for j in 0..gaps {
            let [spoke, next] = &mut self.spokes[j..j + 2] else { break };
            let length = spoke.chord.cross(next.chord).length();
            let product = spoke.r * next.r;
            let is_plane = (product * T::splat(COLLINEAR)).less(length);
            spoke.dot = spoke.chord.dot(next.chord);
            spoke.cross_length = length;
            let between = angle::angle_between(length, spoke.dot, product, is_plane);
            // Two chords without length have no angle: the quotient is NaN there.
            spoke.angle = if T::all(is_plane) {
                between
            } else {
                is_plane_everywhere = false;
                T::choose(between.less(T::splat(4.0)), between, zero)
            };
            total += spoke.angle;
        }
        if self.is_boundary && degree > 0 {
            self.spokes[degree - 1].angle = zero;
        }
        let is_true = T::splat(MIN_TOTAL).less(total);
        self.is_total_true = T::all(is_true);
        self.total = T::choose(is_true, total, T::splat(MIN_TOTAL));
        self.aim();
        is_plane_everywhere
    }

    /// What the angles are scaled to fill.
    #[inline(always)]
    fn aim(&mut self) {
        self.turns_back = self.is_boundary && !T::all(self.total.less(T::splat(BEND_FROM)));
        if self.turns_back {
            let (target, slope) = open_target(self.total);
            self.scale = target / self.total;
            self.start = T::splat(0.5) * (T::splat(PI) - target);
            self.target_slope = slope;
        } else {
            self.scale = T::splat(if self.is_boundary { PI } else { TAU }) / self.total;
            self.start = T::splat(0.0);
        }
    }

    /// The derivative with respect to the sum of the angles, by those with respect to the scale and to the sum of all directions.
    #[inline(always)]
    pub(crate) fn total_bar(&self, scale_bar: T, turned: impl FnOnce() -> T) -> T {
        let shrunk = -(scale_bar * self.scale / self.total);
        if self.turns_back {
            shrunk + self.target_slope * (scale_bar / self.total - T::splat(0.5) * turned())
        } else {
            shrunk
        }
    }

    /// Coordinates of a neighbour, divided by `h`.
    #[inline(always)]
    pub(crate) fn uv(&self, j: usize) -> (T, T) {
        (self.spokes[j].u, self.spokes[j].v)
    }

    /// The row of the quadratic's basis at normalised coordinates; on the boundary it has three entries.
    #[inline(always)]
    pub(crate) fn basis(&self, (u, v): (T, T)) -> [T; 5] {
        let half = T::splat(0.5);
        if self.is_boundary {
            let zero = T::splat(0.0);
            [u, v, half * u * u, zero, zero]
        } else {
            [u, v, half * u * u, T::splat(FRAC_1_SQRT_2) * u * v, half * v * v]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn an_open_ring_is_scaled_to_half_a_plane_until_it_turns_back() {
        for (total, target, slope) in [(0.2, 1.0, 0.0), (1.0, 1.0, 0.0), (1.75, 1.0, 0.0), (1.95, 1.95, 1.0)]
            .into_iter()
            .chain([(2.0, 2.0, 1.0), (2.25, 2.25, 1.0), (2.75, 2.5, 0.0), (9.0, 2.5, 0.0)])
        {
            let found = open_target(total * PI);
            assert!(
                (found.0 - target * PI).abs() < 1e-14 && (found.1 - slope).abs() < 1e-14,
                "{total}: {found:?}"
            );
        }
    }

    #[test]
    fn the_slope_of_the_target_is_its_derivative() {
        for k in 1..600 {
            let (total, step) = (0.005 * f64::from(k) * PI + 1e-3, 1e-6);
            let difference = (open_target(total + step).0 - open_target(total - step).0) / (2.0 * step);
            let slope = open_target(total).1;
            assert!((difference - slope).abs() < 1e-8 && slope >= 0.0, "{total}: {difference} {slope}");
        }
    }
}
