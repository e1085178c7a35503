//! The faceted parameterisation: a node's ring unrolled into the plane, lengths kept, angles scaled to fill it.
//!
//! Source: recipe section 1, after Welch 1995, section 5.3.1. `theta_j = (target / total) * (angle_0 + ... +
//! angle_{j-1})` with target 2π inside and π on the boundary, where the ring starts and ends on the boundary, so
//! those two neighbours lie on the ± u axis. The radius is the chord; it is exact on spheres and must not be
//! corrected by the metric.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use glam::DVec3;

use crate::angle;
use crate::lanes::{Real, Vector};
use crate::rings::{MAX_RING, Rings};

/// Sum of angles below which a ring is a needle without a parameterisation.
const MIN_TOTAL: f64 = 1e-9;
/// Sine of the angle between two chords below which they span no plane.
pub(crate) const COLLINEAR: f64 = 1e-14;

/// A node's neighbours in polar coordinates (of two nodes at once where `T` has two lanes); kept and used again.
///
/// Entries beyond `degree` are left over from earlier nodes.
#[derive(Clone, Debug)]
pub(crate) struct Ring<T> {
    pub(crate) degree: usize,
    pub(crate) is_boundary: bool,
    /// From the node to its neighbours.
    pub(crate) chords: [Vector<T>; MAX_RING],
    /// Their lengths.
    pub(crate) r: [T; MAX_RING],
    /// Cosine and sine of `theta_j`.
    pub(crate) cos: [T; MAX_RING],
    pub(crate) sin: [T; MAX_RING],
    /// The unscaled angle between a chord and the next one; 0 for the last chord of an open ring.
    pub(crate) angle: [T; MAX_RING],
    /// Scalar product of a chord with the next one, and the length of their cross product.
    pub(crate) dot: [T; MAX_RING],
    pub(crate) cross_length: [T; MAX_RING],
    /// Mean chord length; `u` and `v` are divided by it.
    pub(crate) h: T,
    /// Sum of the unscaled angles, at least the guard.
    pub(crate) total: T,
    /// `target / total`.
    pub(crate) scale: T,
    /// Whether `total` is the true sum (not the guard), in all lanes.
    pub(crate) is_total_true: bool,
}

impl<T: Real> Default for Ring<T> {
    fn default() -> Self {
        let zero = T::default();
        let (numbers, vectors) = ([zero; MAX_RING], [Vector::zero(); MAX_RING]);
        Self {
            degree: 0,
            is_boundary: false,
            chords: vectors,
            r: numbers,
            cos: numbers,
            sin: numbers,
            angle: numbers,
            dot: numbers,
            cross_length: numbers,
            h: zero,
            total: zero,
            scale: zero,
            is_total_true: false,
        }
    }
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
        for (chord, (&first, &second)) in self.chords.iter_mut().zip(near.iter().zip(far)) {
            let end = Vector::gather(|lane| positions[if lane == 0 { first } else { second } as usize]);
            *chord = end - centre;
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
        let zero = T::splat(0.0);
        let mut sum_r = zero;
        for j in 0..degree {
            self.r[j] = self.chords[j].length();
            sum_r += self.r[j];
        }
        let mut total = zero;
        let mut is_ordinary = true;
        for j in 0..gaps {
            let next = self.next(j);
            let length = self.chords[j].cross(self.chords[next]).length();
            let dot = self.chords[j].dot(self.chords[next]);
            let product = self.r[j] * self.r[next];
            let is_plane = (product * T::splat(COLLINEAR)).less(length);
            let found = angle::angle_between(length, dot, product, is_plane);
            // Two chords without length have no angle: the quotient is NaN there.
            let found = T::choose(found.less(T::splat(4.0)), found, zero);
            is_ordinary &= T::all(is_plane);
            self.dot[j] = dot;
            self.cross_length[j] = length;
            self.angle[j] = found;
            total += found;
        }
        if self.is_boundary && degree > 0 {
            self.angle[degree - 1] = zero;
        }
        let is_true = T::splat(MIN_TOTAL).less(total);
        self.is_total_true = T::all(is_true);
        self.total = T::choose(is_true, total, T::splat(MIN_TOTAL));
        self.scale = T::splat(if self.is_boundary { PI } else { TAU }) / self.total;
        self.h = sum_r / T::splat(degree as f64);
        let mut cumulative = zero;
        for j in 0..degree {
            (self.sin[j], self.cos[j]) = angle::direction(self.scale * cumulative);
            cumulative += self.angle[j];
        }
        is_ordinary && self.is_total_true
    }

    /// Coordinates of a neighbour, divided by `h`; `inverse_h` is `1 / h`.
    #[inline(always)]
    pub(crate) fn uv(&self, j: usize, inverse_h: T) -> (T, T) {
        let radius = self.r[j] * inverse_h;
        (radius * self.cos[j], radius * self.sin[j])
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
