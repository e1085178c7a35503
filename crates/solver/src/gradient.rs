//! The exact gradient of the discrete energy at a node whatever its state, by reverse mode through its neighbourhood.
//!
//! Ordinary nodes, which are nearly all, take a shorter way ([`ordinary`](crate::ordinary)); this one is for the others.
//!
//! Source: recipe section 3; the numbered steps below are its numbers. Angles, radii, areas, normals and the spectral
//! filter are all differentiated: the terms that the literal scheme freezes do not vanish at the solution.
//! Units: energy per length. The sum over nodes and the torque are zero up to rounding.

use crate::dense::{self, Matrix5};
use crate::energy::Adjoint;
use crate::fit::{self, CarefulFit, Fit, Kind};
use crate::lanes::{Real, Vector};
use crate::neighbourhood::{COLLINEAR, Ring};
use crate::rings::MAX_RING;

/// Where the way back begins and ends; kept and used again. Entries beyond the degree are left over.
#[derive(Clone, Debug)]
pub(crate) struct Backward<T> {
    /// Derivative with respect to every chord `e_j`.
    pub(crate) chords: [Vector<T>; MAX_RING],
    /// With respect to the polar coordinates of every chord.
    pub(crate) r: [T; MAX_RING],
    pub(crate) theta: [T; MAX_RING],
    /// With respect to the scaled angle between a chord and the next (the area sees it directly).
    gap: [T; MAX_RING],
    /// One over a chord's length and its square; zero for a chord without length.
    pub(crate) inverse: [T; MAX_RING],
    inverse_square: [T; MAX_RING],
    /// How much of every chord itself the angles add to its derivative.
    along: [T; MAX_RING],
}

impl<T: Real> Default for Backward<T> {
    fn default() -> Self {
        let numbers = [T::default(); MAX_RING];
        Self {
            chords: [Vector::zero(); MAX_RING],
            r: numbers,
            theta: numbers,
            gap: numbers,
            inverse: numbers,
            inverse_square: numbers,
            along: numbers,
        }
    }
}

/// What a careful fit adds on the way back.
struct Exceptions {
    is_area_clamped: bool,
    /// `M̄ + M̄ᵀ` of a filtered fit.
    filter: Option<Matrix5<f64>>,
}

impl<T: Real> Backward<T> {
    #[inline(always)]
    pub(crate) fn add_turning(&mut self, ring: &Ring<T>, turning: Option<&[T; MAX_RING]>) {
        for (theta, &turning) in self.theta[..ring.degree].iter_mut().zip(turning.into_iter().flatten()) {
            *theta += turning;
        }
    }

    #[inline(always)]
    pub(crate) fn begin(&mut self, ring: &Ring<T>) {
        let degree = ring.degree;
        self.gap[..degree].fill(T::splat(0.0));
        self.along[..degree].fill(T::splat(0.0));
        let zero = T::splat(0.0);
        for j in 0..degree {
            let inverse = T::choose(zero.less(ring.spokes[j].r), T::splat(1.0) / ring.spokes[j].r, zero);
            (self.inverse[j], self.inverse_square[j]) = (inverse, inverse * inverse);
        }
    }

    /// Steps 2 to 4: least squares, basis, polar coordinates.
    #[inline(always)]
    fn through_fit<const N: usize>(&mut self, ring: &Ring<T>, fit: &Fit<T>, adjoint: &Adjoint<T>) {
        let x = weights::<T, N>(fit, adjoint);
        let inverse_h = T::splat(1.0) / ring.h;
        for j in 0..ring.degree {
            let (u, v) = ring.uv(j);
            let row = ring.basis((u, v));
            let mut q = x[0] * row[0];
            let mut residual = ring.spokes[j].chord - fit.d[0] * row[0];
            for i in 1..N {
                q += x[i] * row[i];
                residual -= fit.d[i] * row[i];
            }
            self.chords[j] = q;
            let mut row_bar = [T::splat(0.0); 5];
            for i in 0..N {
                row_bar[i] = residual.dot(x[i]) - q.dot(fit.d[i]);
            }
            self.through_basis(ring, j, (u, v), &row_bar, inverse_h);
        }
    }

    /// Steps 3 and 4 of one neighbour: basis row -> (u, v) -> (r, theta). Returns `u ū + v v̄`.
    #[inline(always)]
    fn through_basis(
        &mut self,
        ring: &Ring<T>,
        j: usize,
        (u, v): (T, T),
        row_bar: &[T; 5],
        inverse_h: T,
    ) -> T {
        let mut u_bar = row_bar[0] + u * row_bar[2];
        let mut v_bar = row_bar[1];
        // The boundary has no rows 4 and 5.
        if !ring.is_boundary {
            let mixed = row_bar[3] * T::splat(std::f64::consts::FRAC_1_SQRT_2);
            u_bar += v * mixed;
            v_bar += u * mixed + v * row_bar[4];
        }
        self.r[j] = (u_bar * ring.spokes[j].cos + v_bar * ring.spokes[j].sin) * inverse_h;
        self.theta[j] =
            (v_bar * ring.spokes[j].cos - u_bar * ring.spokes[j].sin) * ring.spokes[j].r * inverse_h;
        u_bar * u + v_bar * v
    }

    /// Step 4, last part: the area of the fan.
    #[inline(always)]
    pub(crate) fn through_area(&mut self, ring: &Ring<T>, area_bar: T) {
        let sixth = area_bar * T::splat(1.0 / 6.0);
        for j in 0..ring.gaps() {
            let next = ring.next(j);
            let sin = ring.spokes[j].cos * ring.spokes[next].sin - ring.spokes[j].sin * ring.spokes[next].cos;
            let cos = ring.spokes[j].cos * ring.spokes[next].cos + ring.spokes[j].sin * ring.spokes[next].sin;
            let sixth = sixth * ring.shares[j];
            self.r[j] += sixth * ring.spokes[next].r * sin;
            self.r[next] += sixth * ring.spokes[j].r * sin;
            self.gap[j] = sixth * ring.spokes[j].r * ring.spokes[next].r * cos;
        }
    }

    /// Step 5: scaled angles -> unscaled angles -> chords.
    #[inline(always)]
    pub(crate) fn through_angles(&mut self, ring: &Ring<T>) {
        let (degree, gaps) = (ring.degree, ring.gaps());
        let zero = T::splat(0.0);
        // theta_j = start + s cum_j, gap_j = s angle_j, s = target / total, start = (π - target) / 2
        let (mut scale_bar, mut cumulative) = (zero, zero);
        for j in 0..degree {
            scale_bar += self.theta[j] * cumulative + self.gap[j] * ring.spokes[j].angle;
            cumulative += ring.spokes[j].angle;
        }
        let turned = || self.theta[..degree].iter().fold(zero, |sum, &theta| sum + theta);
        let total_bar = if ring.is_total_true { ring.total_bar(scale_bar, turned) } else { zero };
        // Angle j turns every later chord: run backwards over the sum of their theta_bar.
        let mut later = zero;
        for j in (0..degree).rev() {
            if j < gaps {
                let angle_bar = ring.scale * (later + self.gap[j]) + total_bar;
                let next = ring.next(j);
                let (near, far) = (ring.spokes[j].chord, ring.spokes[next].chord);
                let length = ring.spokes[j].cross_length;
                // Collinear chords have no plane to turn in.
                let is_plane = (ring.spokes[j].r * ring.spokes[next].r * T::splat(COLLINEAR)).less(length);
                let factor = T::choose(is_plane, angle_bar / length, zero);
                // (a x b) x a = b (a.a) - a (a.b): across, and along the chord itself, where the length adds its part.
                let along = factor * ring.spokes[j].dot;
                self.chords[j] -= far * factor;
                self.chords[next] -= near * factor;
                self.along[j] += along * self.inverse_square[j];
                self.along[next] += along * self.inverse_square[next];
            }
            later += self.theta[j];
        }
    }

    /// Step 6: the chord's own length.
    #[inline(always)]
    pub(crate) fn through_lengths(&mut self, ring: &Ring<T>) {
        for j in 0..ring.degree {
            self.chords[j] += ring.spokes[j].chord * (self.along[j] + self.r[j] * self.inverse[j]);
        }
    }
}

impl Backward<f64> {
    /// The same for a fit that needed care.
    pub(crate) fn run_carefully(
        &mut self,
        ring: &Ring<f64>,
        careful: &CarefulFit,
        adjoint: &Adjoint<f64>,
        turning: Option<&[f64; MAX_RING]>,
    ) {
        let is_filtered = careful.kind == Kind::Filtered;
        let exceptions = Exceptions {
            is_area_clamped: careful.is_area_clamped,
            filter: is_filtered.then(|| filter_bar(ring, &adjoint.d)),
        };
        self.begin(ring);
        match &exceptions.filter {
            Some(filter) => self.through_filter(ring, &careful.fit, adjoint, filter),
            None => self.through_fit::<5>(ring, &careful.fit, adjoint),
        }
        self.add_turning(ring, turning);
        if !exceptions.is_area_clamped {
            self.through_area(ring, adjoint.area);
        }
        self.through_angles(ring);
        self.through_lengths(ring);
    }

    /// Steps 2 to 4 through the spectral filter. Unlike a plain fit it depends on `h`.
    fn through_filter(
        &mut self,
        ring: &Ring<f64>,
        fit: &Fit<f64>,
        adjoint: &Adjoint<f64>,
        filter: &Matrix5<f64>,
    ) {
        let x = weights::<f64, 5>(fit, adjoint);
        let inverse_h = 1.0 / ring.h;
        let mut h_bar = adjoint.h;
        for j in 0..ring.degree {
            let (u, v) = ring.uv(j);
            let row = ring.basis((u, v));
            let mut q = Vector::zero();
            let mut row_bar = [0.0; 5];
            for i in 0..5 {
                q += x[i] * row[i];
                row_bar[i] =
                    ring.spokes[j].chord.dot(x[i]) + (0..5).map(|k| filter[i][k] * row[k]).sum::<f64>();
            }
            self.chords[j] = q;
            h_bar -= self.through_basis(ring, j, (u, v), &row_bar, inverse_h) * inverse_h;
        }
        let share = h_bar / ring.degree as f64;
        for r_bar in &mut self.r[..ring.degree] {
            *r_bar += share;
        }
    }
}

/// Step 2: `X = f(M) D̄`
#[inline(always)]
fn weights<T: Real, const N: usize>(fit: &Fit<T>, adjoint: &Adjoint<T>) -> [Vector<T>; 5] {
    let mut x = [Vector::zero(); 5];
    for i in 0..N {
        let mut sum = adjoint.d[0] * fit.inverse[i][0];
        for k in 1..N {
            sum += adjoint.d[k] * fit.inverse[i][k];
        }
        x[i] = sum;
    }
    x
}

/// `M̄ + M̄ᵀ` of a filtered node: the derivative of the matrix function `f(M)`.
fn filter_bar(ring: &Ring<f64>, d_bar: &[Vector<f64>; 5]) -> Matrix5<f64> {
    let (m, b) = fit::careful_moments(ring);
    let eigen = dense::eigen(&m);
    let v = &eigen.vectors;
    // D̄ and Sᵀe in the eigenbasis.
    let turn = |rows: &[Vector<f64>; 5]| -> [Vector<f64>; 5] {
        std::array::from_fn(|k| {
            let mut sum = Vector::zero();
            for i in 0..5 {
                sum += rows[i] * v[i][k];
            }
            sum
        })
    };
    let (d_turned, b_turned) = (turn(d_bar), turn(&b));
    let mut inner = Matrix5::<f64>::default();
    for x in 0..5 {
        for y in 0..5 {
            let difference = fit::filter_difference(eigen.values[x], eigen.values[y]);
            inner[x][y] = difference * (d_turned[x].dot(b_turned[y]) + d_turned[y].dot(b_turned[x]));
        }
    }
    let mut result = Matrix5::<f64>::default();
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
