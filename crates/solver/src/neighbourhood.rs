//! The faceted parameterisation: one node's ring unrolled into the plane, lengths kept, angles scaled to fill it.
//!
//! Source: recipe section 1, after Welch 1995, section 5.3.1. `theta_j = (target / total) * (angle_0 + ... +
//! angle_{j-1})` with target 2π inside and π on the boundary, where the ring starts and ends on the boundary, so
//! those two neighbours lie on the ± u axis. The radius is the chord; it is exact on spheres and must not be
//! corrected by the metric.

use glam::DVec3;

use crate::rings::MAX_RING;

/// Sum of angles below which a ring is a needle without a parameterisation.
const MIN_TOTAL: f64 = 1e-9;

/// One neighbour in polar coordinates.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Spoke {
    /// Chord length.
    pub(crate) r: f64,
    /// Cosine and sine of `theta_j`.
    pub(crate) cos: f64,
    pub(crate) sin: f64,
    /// The unscaled angle between this spoke and the next one; 0 for the last spoke of an open ring.
    pub(crate) angle: f64,
}

/// What the ring has in common.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Frame {
    /// Mean chord length; `u` and `v` are divided by it.
    pub(crate) h: f64,
    /// Sum of the unscaled angles, at least the guard.
    pub(crate) total: f64,
    /// `target / total`.
    pub(crate) scale: f64,
    /// Whether `total` is the true sum (not the guard).
    pub(crate) is_total_true: bool,
}

/// The vectors from a node to its ring, on the stack.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chords {
    vectors: [DVec3; MAX_RING],
    count: usize,
}

impl Chords {
    #[inline]
    pub(crate) fn new(positions: &[DVec3], node: usize, ring: &[u32]) -> Self {
        let centre = positions[node];
        let mut vectors = [DVec3::ZERO; MAX_RING];
        for (vector, &far) in vectors.iter_mut().zip(ring) {
            *vector = positions[far as usize] - centre;
        }
        Self { vectors, count: ring.len().min(MAX_RING) }
    }

    #[inline]
    pub(crate) fn all(&self) -> &[DVec3] {
        &self.vectors[..self.count]
    }
}

/// Number of angles in a ring: a closed ring has one per spoke, an open ring one less.
#[inline]
pub(crate) fn gaps(degree: usize, is_boundary: bool) -> usize {
    if is_boundary { degree.saturating_sub(1) } else { degree }
}

/// The angle the scaled ring fills.
#[inline]
pub(crate) fn target(is_boundary: bool) -> f64 {
    if is_boundary { std::f64::consts::PI } else { 2.0 * std::f64::consts::PI }
}

/// Unrolls one ring into `spokes`.
#[inline]
pub(crate) fn unroll(chords: &[DVec3], is_boundary: bool, spokes: &mut [Spoke]) -> Frame {
    let degree = chords.len();
    let gaps = gaps(degree, is_boundary);
    let mut sum_r = 0.0;
    for (spoke, chord) in spokes.iter_mut().zip(chords) {
        spoke.r = chord.length();
        spoke.angle = 0.0;
        sum_r += spoke.r;
    }
    let mut total = 0.0;
    for j in 0..gaps {
        let next = if j + 1 == degree { 0 } else { j + 1 };
        // Never by arc cosine: this form keeps its digits near 0 and π.
        let angle = libm::atan2(chords[j].cross(chords[next]).length(), chords[j].dot(chords[next]));
        spokes[j].angle = angle;
        total += angle;
    }
    let is_total_true = total >= MIN_TOTAL;
    let total = if is_total_true { total } else { MIN_TOTAL };
    let scale = target(is_boundary) / total;
    let mut cumulative = 0.0;
    for spoke in spokes.iter_mut() {
        (spoke.sin, spoke.cos) = libm::sincos(scale * cumulative);
        cumulative += spoke.angle;
    }
    Frame { h: sum_r / degree as f64, total, scale, is_total_true }
}
