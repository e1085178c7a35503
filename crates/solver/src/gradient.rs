//! The exact gradient of the discrete energy, by reverse mode through one neighbourhood, all nodes in one sweep.
//!
//! Source: recipe section 3; the numbered steps below are its numbers. Angles, radii, areas, normals and the spectral
//! filter are all differentiated: the terms that the literal scheme freezes do not vanish at the solution.
//! Units: energy per length. The sum over nodes and the torque are zero up to rounding.

use glam::DVec3;

use crate::dense::{self, Matrix5, ZERO5};
use crate::energy::{Adjoint, thin_plate};
use crate::fit::{self, Fits, Kind, NodeFit};
use crate::neighbourhood::{self, Chords, Spoke};
use crate::rings::{MAX_RING, Rings};

/// Writes `dE/dp` of every node into `gradient`.
pub(crate) fn gradient(rings: &Rings, fits: &Fits, gradient: &mut [DVec3]) {
    gradient.fill(DVec3::ZERO);
    for (node, fit) in fits.nodes.iter().enumerate().filter(|(_, fit)| fit.is_fitted()) {
        let ring = rings.ring(node);
        let chords = Chords::new(&fits.positions, node, ring);
        let ring_view = Ring {
            fit,
            chords: chords.all(),
            spokes: &fits.spokes[rings.slots(node)],
            is_boundary: rings.is_boundary(node),
        };
        let bars = ring_view.chord_bars(&thin_plate::adjoint(fit));
        let mut sum = DVec3::ZERO;
        for (&far, &bar) in ring.iter().zip(&bars) {
            gradient[far as usize] += bar;
            sum += bar;
        }
        gradient[node] -= sum;
    }
}

/// One neighbourhood on its way back.
struct Ring<'a> {
    fit: &'a NodeFit,
    chords: &'a [DVec3],
    spokes: &'a [Spoke],
    is_boundary: bool,
}

/// Derivatives with respect to the polar coordinates of every spoke.
struct PolarBars {
    r: [f64; MAX_RING],
    theta: [f64; MAX_RING],
    /// With respect to the scaled angle between a spoke and the next (the area sees it directly).
    gap: [f64; MAX_RING],
}

impl Ring<'_> {
    /// The derivative with respect to every chord `e_j`.
    #[inline]
    fn chord_bars(&self, adjoint: &Adjoint) -> [DVec3; MAX_RING] {
        let mut chord_bars = [DVec3::ZERO; MAX_RING];
        let mut polar = PolarBars { r: [0.0; MAX_RING], theta: [0.0; MAX_RING], gap: [0.0; MAX_RING] };
        self.through_fit(adjoint, &mut chord_bars, &mut polar);
        if !self.fit.is_area_clamped {
            self.through_area(adjoint.area, &mut polar);
        }
        self.through_angles(&mut polar, &mut chord_bars);
        // 6. the chord's own length
        for (j, spoke) in self.spokes.iter().enumerate() {
            if spoke.r > 0.0 {
                chord_bars[j] += self.chords[j] * (polar.r[j] / spoke.r);
            }
        }
        chord_bars
    }

    /// Steps 2 to 4: least squares, basis, polar coordinates.
    #[inline]
    fn through_fit(&self, adjoint: &Adjoint, chord_bars: &mut [DVec3; MAX_RING], polar: &mut PolarBars) {
        let (h, d) = (self.fit.frame.h, &self.fit.d);
        let inverse_h = 1.0 / h;
        // 2. X = f(M) D̄
        let mut x = [DVec3::ZERO; 5];
        for (row, x) in self.fit.inverse.iter().zip(&mut x) {
            for (&factor, &bar) in row.iter().zip(&adjoint.d) {
                *x += bar * factor;
            }
        }
        let m_bar = (self.fit.kind == Kind::Filtered).then(|| self.filter_bar(&adjoint.d));
        let mut h_bar = adjoint.h;
        for (j, (spoke, &chord)) in self.spokes.iter().zip(self.chords).enumerate() {
            let row = fit::basis(spoke, h, self.is_boundary);
            let mut q = DVec3::ZERO;
            let mut residual = chord;
            for i in 0..5 {
                q += x[i] * row[i];
                residual -= d[i] * row[i];
            }
            chord_bars[j] += q;
            let mut row_bar = [0.0; 5];
            if let Some(m_bar) = &m_bar {
                for i in 0..5 {
                    row_bar[i] = chord.dot(x[i]) + (0..5).map(|k| m_bar[i][k] * row[k]).sum::<f64>();
                }
            } else {
                for i in 0..5 {
                    row_bar[i] = residual.dot(x[i]) - q.dot(d[i]);
                }
            }
            // 3. basis row -> (u, v); the boundary has no rows 4 and 5.
            let (u, v) = (row[0], row[1]);
            let mut u_bar = row_bar[0] + u * row_bar[2];
            let mut v_bar = row_bar[1];
            if !self.is_boundary {
                let mixed = row_bar[3] / fit::ROOT_TWO;
                u_bar += v * mixed;
                v_bar += u * mixed + v * row_bar[4];
            }
            // 4. (u, v) -> (r, theta)
            polar.r[j] = (u_bar * spoke.cos + v_bar * spoke.sin) * inverse_h;
            polar.theta[j] = (v_bar * spoke.cos - u_bar * spoke.sin) * spoke.r * inverse_h;
            h_bar -= (u_bar * u + v_bar * v) * inverse_h;
        }
        // A plain fit does not depend on h at all: its h_bar is zero up to rounding.
        if m_bar.is_some() {
            let share = h_bar / self.spokes.len() as f64;
            for r_bar in &mut polar.r[..self.spokes.len()] {
                *r_bar += share;
            }
        }
    }

    /// `M̄ + M̄ᵀ` of a filtered node: the derivative of the matrix function `f(M)`.
    fn filter_bar(&self, d_bar: &[DVec3; 5]) -> Matrix5 {
        let (m, b) = fit::moments(self.chords, self.is_boundary, self.spokes, self.fit.frame.h);
        let eigen = dense::eigen(&m);
        let v = &eigen.vectors;
        // D̄ and Sᵀe in the eigenbasis.
        let turn = |rows: &[DVec3; 5]| -> [DVec3; 5] {
            std::array::from_fn(|k| (0..5).map(|i| rows[i] * v[i][k]).sum())
        };
        let (d_turned, b_turned) = (turn(d_bar), turn(&b));
        let mut inner = ZERO5;
        for x in 0..5 {
            for y in 0..5 {
                let difference = fit::filter_difference(eigen.values[x], eigen.values[y]);
                inner[x][y] = difference * (d_turned[x].dot(b_turned[y]) + d_turned[y].dot(b_turned[x]));
            }
        }
        let mut result = ZERO5;
        for i in 0..5 {
            for j in 0..5 {
                for x in 0..5 {
                    for y in 0..5 {
                        result[i][j] += v[i][x] * inner[x][y] * v[j][y];
                    }
                }
            }
        }
        result
    }

    /// Step 4, last part: the area of the fan.
    #[inline]
    fn through_area(&self, area_bar: f64, polar: &mut PolarBars) {
        let degree = self.spokes.len();
        let sixth = area_bar / 6.0;
        for j in 0..neighbourhood::gaps(degree, self.is_boundary) {
            let next = if j + 1 == degree { 0 } else { j + 1 };
            let (near, far) = (&self.spokes[j], &self.spokes[next]);
            let sin = near.cos * far.sin - near.sin * far.cos;
            let cos = near.cos * far.cos + near.sin * far.sin;
            polar.r[j] += sixth * far.r * sin;
            polar.r[next] += sixth * near.r * sin;
            polar.gap[j] = sixth * near.r * far.r * cos;
        }
    }

    /// Step 5: scaled angles -> unscaled angles -> chords.
    #[inline]
    fn through_angles(&self, polar: &mut PolarBars, chord_bars: &mut [DVec3; MAX_RING]) {
        let degree = self.spokes.len();
        let gaps = neighbourhood::gaps(degree, self.is_boundary);
        let frame = &self.fit.frame;
        // theta_j = s cum_j, gap_j = s angle_j, s = target / total
        let mut scale_bar = 0.0;
        let mut cumulative = 0.0;
        for j in 0..degree {
            scale_bar += polar.theta[j] * cumulative + polar.gap[j] * self.spokes[j].angle;
            cumulative += self.spokes[j].angle;
        }
        let total_bar = if frame.is_total_true { -scale_bar * frame.scale / frame.total } else { 0.0 };
        // Angle j turns every later spoke: run backwards over the sum of their theta_bar.
        let mut later = 0.0;
        for j in (0..degree).rev() {
            if j < gaps {
                let angle_bar = frame.scale * (later + polar.gap[j]) + total_bar;
                let next = if j + 1 == degree { 0 } else { j + 1 };
                let (near, far) = (self.chords[j], self.chords[next]);
                let cross = near.cross(far);
                let (length, near_r, far_r) = (cross.length(), self.spokes[j].r, self.spokes[next].r);
                // Collinear chords have no plane to turn in.
                if length > 1e-14 * near_r * far_r {
                    let nu = cross * (angle_bar / length);
                    chord_bars[j] -= nu.cross(near) / (near_r * near_r);
                    chord_bars[next] += nu.cross(far) / (far_r * far_r);
                }
            }
            later += polar.theta[j];
        }
    }
}
