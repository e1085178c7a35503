//! The clamp: the neighbourhood of a node whose tangent plane is prescribed.
//!
//! Source: Welch 1995, section 5.5 (ribbons) and recipe section 10, which prescribe `s_v` by a row of weight; the form is
//! ours. An ordinary fit finds its tangent plane from the neighbours and lets a row pull at it: on a boundary, where the fit
//! is one-sided, that meets the plane with an error of order `h`, and its multipliers make the matrix indefinite. Here
//! the prescribed plane *is* the tangent plane of the fit, as a clamp is in a finite element (and as the prescribed
//! tangent of a curve is, see `curve/hinge`). Nothing is left to satisfy: the matrix stays positive definite, every
//! step goes down the true energy, and a plane that cannot be had (across a curve) costs a finite amount.
//!
//! With the unit normal `N`, every chord tells a normal curvature, exact on spheres:
//!
//! ```text
//! κ_j = 2 e_j·N / r_j²          κ_j ≈ H + A cos 2θ_j + B sin 2θ_j          L = (H + A, √2 B, H - A)
//! E = a [ |L|² + γ Σ_j (κ_j - H - A cos 2θ_j - B sin 2θ_j)² ]              γ = 8 / (3 d)
//! ```
//!
//! by least squares, `A` and `B` held by [`HOLD`] where the ring is too poor to tell. What is left over is what a tilt of the
//! ring against the plane makes (odd in `θ`), and a jump of the curvature across an inner curve; the factor 8/3
//! is one over the mean of `cos⁴ θ`, so that a curve along which both sides bend differently costs the mean of both.
//! The derivative is exact.

use std::f64::consts::SQRT_2;

use glam::DVec3;

use crate::dense;
use crate::fit::{CarefulFit, Fit};
use crate::gradient::Backward;
use crate::lanes::Vector;
use crate::neighbourhood::Ring;
use crate::rings::MAX_RING;

/// What holds `A` and `B`, per neighbour: a thousandth of what a good ring says of them.
const HOLD: f64 = 5e-4;

/// A node's fit to its prescribed plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Clamp {
    degree: usize,
    /// `(1, cos 2θ, sin 2θ)` of every neighbour.
    basis: [[f64; 3]; MAX_RING],
    /// `κ`, what the fit leaves of it, and its derivative by the height of the neighbour, `2 / r²`.
    kappa: [f64; MAX_RING],
    residual: [f64; MAX_RING],
    slope: [f64; MAX_RING],
    /// Inverse of the held normal matrix, and its solution `(H, A, B)`.
    inverse: [[f64; 3]; 3],
    bend: [f64; 3],
    area: f64,
    h: f64,
    /// The unit normal that the neighbours alone would have it take.
    pub(crate) follower: DVec3,
}

impl Default for Clamp {
    /// A clamp without neighbours.
    fn default() -> Self {
        Self {
            degree: 0,
            basis: [[0.0; 3]; MAX_RING],
            kappa: [0.0; MAX_RING],
            residual: [0.0; MAX_RING],
            slope: [0.0; MAX_RING],
            inverse: [[0.0; 3]; 3],
            bend: [0.0; 3],
            area: 0.0,
            h: 1.0,
            follower: DVec3::ZERO,
        }
    }
}

/// What the fit of a clamp costs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Demand {
    /// Weight of `a |L|²`.
    pub(crate) plate: f64,
    /// Weight of what is left over.
    pub(crate) tilt: f64,
    /// The same over `h²`: where the variation of curvature counts.
    pub(crate) variation: f64,
    /// Derivative of other terms by `(L11, √2 L12, L22)`.
    pub(crate) bending: [f64; 3],
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn product(matrix: &[[f64; 3]; 3], x: &[f64; 3]) -> [f64; 3] {
    [dot(&matrix[0], x), dot(&matrix[1], x), dot(&matrix[2], x)]
}

impl Clamp {
    /// Fits an unrolled ring of at least three neighbours, of which the plain fit is known.
    pub(crate) fn new(ring: &Ring<f64>, plain: &Fit<f64>, normal: DVec3) -> Self {
        let follower = plain.normal.lane(0);
        let mut clamp =
            Self { degree: ring.degree, area: plain.area, h: ring.h, follower, ..Self::default() };
        let mut m = dense::Matrix5::<f64>::default();
        let mut b = [0.0; 3];
        for j in 0..ring.degree {
            let spoke = &ring.spokes[j];
            let (cos, sin) = (spoke.cos, spoke.sin);
            let row = [1.0, cos * cos - sin * sin, 2.0 * cos * sin];
            let squared = spoke.r * spoke.r;
            // A neighbour that lies on the node says nothing of its height.
            let slope = if squared > 0.0 { 2.0 / squared } else { 0.0 };
            let kappa = slope * spoke.chord.lane(0).dot(normal);
            for i in 0..3 {
                for k in 0..3 {
                    m[i][k] += row[i] * row[k];
                }
                b[i] += row[i] * kappa;
            }
            (clamp.basis[j], clamp.kappa[j], clamp.slope[j]) = (row, kappa, slope);
        }
        let hold = HOLD * ring.degree as f64;
        m[1][1] += hold;
        m[2][2] += hold;
        // Held, it is regular: the first row counts the neighbours.
        let (inverse, _) = dense::invert::<f64, 3>(&m);
        clamp.inverse = std::array::from_fn(|i| [inverse[i][0], inverse[i][1], inverse[i][2]]);
        clamp.bend = product(&clamp.inverse, &b);
        for j in 0..ring.degree {
            clamp.residual[j] = clamp.kappa[j] - dot(&clamp.basis[j], &clamp.bend);
        }
        clamp
    }

    /// One of which nothing is known but where its neighbours would have it.
    #[cfg(test)]
    pub(crate) fn following(follower: DVec3) -> Self {
        Self { follower, ..Self::default() }
    }

    /// `(L11, √2 L12, L22)`
    pub(crate) fn l(&self) -> [f64; 3] {
        let [h, a, b] = self.bend;
        [h + a, SQRT_2 * b, h - a]
    }

    /// `|L|²`
    fn density(&self) -> f64 {
        2.0 * dot(&self.bend, &self.bend)
    }

    fn gamma(&self) -> f64 {
        8.0 / (3.0 * self.degree.max(1) as f64)
    }

    /// `γ Σ (what is left over)²`
    fn left_over(&self) -> f64 {
        self.gamma() * self.residual[..self.degree].iter().map(|rest| rest * rest).sum::<f64>()
    }

    /// `a (plate |L|² + tilt rest)`
    pub(crate) fn value(&self, plate: f64, tilt: f64) -> f64 {
        self.area * (plate * self.density() + tilt * self.left_over())
    }

    /// `a rest / h²`, what a tilt costs where the variation of curvature counts.
    pub(crate) fn variation(&self) -> f64 {
        self.area * self.left_over() / (self.h * self.h)
    }

    /// The rows `√a dL/dα`, the centre's first.
    pub(crate) fn write_rows(&self, mut write: impl FnMut(usize, usize, f64)) {
        let root = self.area.sqrt();
        (0..3).for_each(|c| write(0, c, 0.0));
        for j in 0..self.degree {
            let [h, a, b] = product(&self.inverse, &self.basis[j]).map(|value| value * root * self.slope[j]);
            write(j + 1, 0, h + a);
            write(j + 1, 1, SQRT_2 * b);
            write(j + 1, 2, h - a);
        }
    }

    /// The matrix of what is left over, `weight` being its price: entries between neighbours, `i >= j`, the centre being 0.
    /// `senses` are those of the spokes.
    pub(crate) fn products(&self, demand: &Demand, senses: &[f64], mut add: impl FnMut(usize, usize, f64)) {
        let price = self.area * self.gamma() * (demand.tilt + demand.variation / (self.h * self.h));
        if !(price > 0.0) {
            return;
        }
        let rows = self.tilts(senses);
        for i in 0..=self.degree {
            for j in 0..=i {
                add(i, j, price * rows[..self.degree].iter().map(|row| row[i] * row[j]).sum::<f64>());
            }
        }
    }

    /// How the offset of each place, the centre being 0, changes what is left over at each neighbour.
    fn tilts(&self, senses: &[f64]) -> [[f64; MAX_RING + 1]; MAX_RING] {
        let weights: [[f64; 3]; MAX_RING] = std::array::from_fn(|j| product(&self.inverse, &self.basis[j]));
        let mut rows = [[0.0; MAX_RING + 1]; MAX_RING];
        for (k, row) in rows[..self.degree].iter_mut().enumerate() {
            for j in 0..self.degree {
                let left = f64::from(u8::from(k == j)) - dot(&self.basis[k], &weights[j]);
                row[j + 1] = left * self.slope[j] * senses[j];
                row[0] -= left * self.slope[j];
            }
        }
        rows
    }

    /// The frozen pull of what is left over: half of what its price would fall by with the offset of each place.
    pub(crate) fn pull(&self, weight: f64, senses: &[f64], mut add: impl FnMut(usize, f64)) {
        let price = weight * self.area * self.gamma();
        let rows = self.tilts(senses);
        for i in 0..=self.degree {
            let tilts = rows[..self.degree].iter().zip(&self.residual);
            add(i, -price * tilts.map(|(row, residual)| row[i] * residual).sum::<f64>());
        }
    }

    /// Derivative by the coefficients: of `(H, A, B)`, and of what is left over per unit of it.
    fn bars(&self, demand: &Demand) -> ([f64; 3], f64) {
        let squared = self.h * self.h;
        let rest = 2.0 * self.area * self.gamma() * (demand.tilt + demand.variation / squared);
        let plate = 4.0 * self.area * demand.plate;
        let [x, y, z] = demand.bending;
        let mut bar = [x + z, x - z, SQRT_2 * y];
        for (bar, bend) in bar.iter_mut().zip(self.bend) {
            *bar += plate * bend;
        }
        for (row, residual) in self.basis[..self.degree].iter().zip(&self.residual) {
            for (bar, value) in bar.iter_mut().zip(row) {
                *bar -= rest * residual * value;
            }
        }
        (bar, rest)
    }
}

impl Backward<f64> {
    /// The derivative of a clamp's price with respect to every chord.
    pub(crate) fn run_clamped(
        &mut self,
        ring: &Ring<f64>,
        careful: &CarefulFit,
        clamp: &Clamp,
        normal: DVec3,
        demand: &Demand,
        turning: Option<&[f64; MAX_RING]>,
    ) {
        self.begin(ring);
        let (bar, rest) = clamp.bars(demand);
        let y = product(&clamp.inverse, &bar);
        let left_over = clamp.left_over();
        let per_square = demand.variation / (clamp.h * clamp.h);
        // h is the mean chord.
        let h_bar = -2.0 * per_square * clamp.area * left_over / clamp.h;
        for j in 0..ring.degree {
            let (row, residual) = (&clamp.basis[j], clamp.residual[j]);
            let kappa_bar = rest * residual + dot(row, &y);
            let across = dot(row, &y);
            // x = M⁻¹ Bᵀκ and the residual, by the basis row.
            let row_bar: [f64; 3] =
                std::array::from_fn(|c| residual * y[c] - (across + rest * residual) * clamp.bend[c]);
            self.theta[j] = 2.0 * (row_bar[2] * row[1] - row_bar[1] * row[2]);
            self.chords[j] = Vector::gather(|_| normal * (kappa_bar * clamp.slope[j]));
            self.r[j] = -2.0 * clamp.kappa[j] * kappa_bar * self.inverse[j] + h_bar / ring.degree as f64;
        }
        self.add_turning(ring, turning);
        if !careful.is_area_clamped {
            let area_bar = demand.plate * clamp.density() + (demand.tilt + per_square) * left_over;
            self.through_area(ring, area_bar);
        }
        self.through_angles(ring);
        self.through_lengths(ring);
    }
}
