//! The least-squares quadratic through a node: derivatives, normal, curvature, area.
//!
//! Source: recipe section 2, after Welch 1995, section 5.3.2. In coordinates divided by the mean chord `h` a chord is
//! approximated by
//!
//! ```text
//! e(u, v) = D1 u + D2 v + D3 u²/2 + D4 uv/√2 + D5 v²/2        (boundary: D1, D2, D3 only)
//! ```
//!
//! The factor 1/√2 is ours: it makes the basis orthonormal for the Frobenius norm of the second derivatives, so that
//! the spectral filter of an ill-conditioned ring depends neither on which neighbour comes first nor on the sense of
//! the ring. In this basis `L = (L11, √2 L12, L22)` and every weight of the thin-plate energy is one.
//!
//! Nearly every node is *ordinary*: its fit is the plain inverse of `M = SᵀS`, its Jacobian is beyond the barrier, and
//! two such nodes are fitted at once. The others are fitted with care, one by one.
//!
//! Filter: the inverse of `M` is `f(M)` with `f(λ) = 1/λ` for `λ >= 0.02`, else `λ/0.02²`. Normalised coordinates
//! make 0.02 free of scale; rings of degree 3 and 4 get their minimum-norm solution without any switching. Whether
//! the plain inverse serves is decided by `trace M⁻¹ < 1/0.02`, which proves that every eigenvalue lies above 0.02
//! (a bound on the pivots, as in the prototypes, does not, and would let the energy jump).

use std::f64::consts::FRAC_1_SQRT_2;

use glam::DVec3;

use crate::barrier;
use crate::dense::{self, Matrix5};
use crate::lanes::{Real, Vector};
use crate::neighbourhood::{Ring, Spoke};

/// Eigenvalue of `M` below which a direction of the fit is faded out.
pub(crate) const FILTER: f64 = 0.02;
/// Mean chord below which a ring counts as collapsed to a point.
const MIN_LENGTH: f64 = 1e-60;
/// Jacobian below which the normal of the fit means nothing.
const MIN_JACOBIAN: f64 = 1e-9;

/// What could be fitted at a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Nothing: fewer than two neighbours, a boundary ear (one triangle is flat), or a collapsed ring.
    #[default]
    Flat,
    /// The plain inverse of `M`.
    Plain,
    /// The filtered inverse `f(M)`.
    Filtered,
    /// A quadratic without a normal; it counts with a constant barrier only.
    Folded,
}

/// The fit of a node, or of two.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Fit<T> {
    /// `f(M)`.
    pub(crate) inverse: Matrix5<T>,
    /// Coefficients D1 to D5, in normalised coordinates.
    pub(crate) d: [Vector<T>; 5],
    pub(crate) normal: Vector<T>,
    /// `|s_u × s_v|`.
    pub(crate) jacobian: T,
    /// `(L11, √2 L12, L22)`.
    pub(crate) l: [T; 3],
    /// The node's share of the parametric fan, one third where it has no part of a rim.
    pub(crate) area: T,
}

/// A fit made with care, and what was out of the ordinary.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CarefulFit {
    pub(crate) fit: Fit<f64>,
    pub(crate) kind: Kind,
    /// Whether the fan was turned inside out and its area set to zero.
    pub(crate) is_area_clamped: bool,
}

impl CarefulFit {
    /// Whether the node has curvature rows and an energy that depends on its ring.
    #[inline]
    pub(crate) fn is_fitted(&self) -> bool {
        matches!(self.kind, Kind::Plain | Kind::Filtered)
    }
}

impl<T: Real> Fit<T> {
    /// The quadratic of one lane.
    #[inline]
    pub(crate) fn quadratic(&self, lane: usize) -> Quadratic {
        Quadratic(self.d.map(|d| d.lane(lane)))
    }
}

/// A fitted quadratic relative to its node, over normalised coordinates: D1 to D5.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quadratic([DVec3; 5]);

impl Quadratic {
    /// Its value; `linear` scales the first-order part.
    #[inline]
    pub(crate) fn evaluate(&self, u: f64, v: f64, linear: f64) -> DVec3 {
        let d = &self.0;
        let second = d[2] * (0.5 * u * u) + d[3] * (u * v * FRAC_1_SQRT_2) + d[4] * (0.5 * v * v);
        (d[0] * u + d[1] * v) * linear + second
    }

    /// Its derivatives by `u` and `v`.
    pub(crate) fn tangents(&self, u: f64, v: f64) -> [DVec3; 2] {
        let d = &self.0;
        let mixed = d[3] * FRAC_1_SQRT_2;
        [d[0] + d[2] * u + mixed * v, d[1] + mixed * u + d[4] * v]
    }
}

/// Mean and Gaussian curvature of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Curvature {
    /// Half the sum of the principal curvatures, negative where the normal points out of a sphere.
    pub mean: f64,
    /// Their product.
    pub gauss: f64,
}

impl Curvature {
    /// From `(L11, √2 L12, L22)`.
    #[inline]
    pub(crate) fn new(l: [f64; 3]) -> Self {
        let [l11, l12, l22] = [l[0], l[1] * FRAC_1_SQRT_2, l[2]];
        Self { mean: 0.5 * (l11 + l22), gauss: l11 * l22 - l12 * l12 }
    }

    /// The larger principal curvature by magnitude.
    pub fn largest(&self) -> f64 {
        let discriminant = self.mean * self.mean - self.gauss;
        self.mean.abs() + discriminant.max(0.0).sqrt()
    }
}

/// The square of the second fundamental form in the basis of `l`.
#[inline(always)]
pub(crate) fn square<T: Real>(l: [T; 3]) -> [T; 3] {
    let [l11, l12, l22] = l; // l12 carries its √2
    let half = T::splat(0.5) * l12 * l12;
    [l11 * l11 + half, l12 * (l11 + l22), l22 * l22 + half]
}

/// Fits an unrolled ring; true where every lane is ordinary. The result is worthless where it is false.
///
/// `N` is 5 inside and 3 on the boundary.
#[inline(always)]
pub(crate) fn fit_ordinary<T: Real, const N: usize>(ring: &Ring<T>) -> (Fit<T>, bool) {
    let mut fit = Fit::default();
    let sum = fan(ring);
    fit.area = sum / T::splat(6.0);
    let (m, b) = moments::<T, N>(ring);
    let (inverse, is_regular) = dense::invert::<T, N>(&m);
    fit.inverse = inverse;
    let mut trace = T::splat(0.0);
    for i in 0..N {
        trace += inverse[i][i];
    }
    coefficients::<T, N>(&mut fit, &b);
    let squared = ring.h * ring.h;
    let m = fit.d[0].cross(fit.d[1]);
    let length = m.length();
    fit.jacobian = length / squared;
    fit.normal = m * (T::splat(1.0) / length);
    second_form(&mut fit, squared);
    let zero = T::splat(0.0);
    let is_ordinary = is_regular
        && T::all(zero.less(sum))
        && T::all(trace.less(T::splat(1.0 / FILTER)))
        && T::all(T::splat(barrier::START).less(fit.jacobian))
        && T::all(T::splat(MIN_LENGTH).less(ring.h));
    (fit, is_ordinary)
}

/// Unrolls and fits one node, whatever state its ring is in.
pub(crate) fn fit_carefully(ring: &mut Ring<f64>) -> CarefulFit {
    let mut careful = CarefulFit::default();
    if ring.degree < 2 {
        return careful;
    }
    ring.unroll();
    let fit = &mut careful.fit;
    fit.jacobian = 1.0;
    fit.normal = facet_normal(ring);
    let sum = fan(ring);
    // A sliver can turn the fan inside out; a negative area would reward it.
    careful.is_area_clamped = !(sum > 0.0);
    fit.area = if careful.is_area_clamped { 0.0 } else { sum / 6.0 };
    // A boundary node with two neighbours is an ear: one flat triangle, no second direction to fit.
    if ring.degree == 2 || !(ring.h > MIN_LENGTH) {
        return careful;
    }
    let (m, b) = careful_moments(ring);
    let (plain, is_regular) =
        if ring.is_boundary { dense::invert::<f64, 3>(&m) } else { dense::invert::<f64, 5>(&m) };
    let trace = (0..5).map(|i| plain[i][i]).sum::<f64>();
    let is_plain = is_regular && trace < 1.0 / FILTER;
    careful.kind = if is_plain { Kind::Plain } else { Kind::Filtered };
    fit.inverse = if is_plain { plain } else { dense::eigen(&m).map(filter) };
    coefficients::<f64, 5>(fit, &b);
    let squared = ring.h * ring.h;
    let m = fit.d[0].cross(fit.d[1]);
    let length = m.length();
    fit.jacobian = length / squared;
    if fit.jacobian > MIN_JACOBIAN {
        fit.normal = m * (1.0 / length);
        second_form(fit, squared);
    } else {
        careful.kind = Kind::Folded;
    }
    careful
}

/// `M` and `Sᵀe` with the basis that the ring has.
pub(crate) fn careful_moments(ring: &Ring<f64>) -> (Matrix5<f64>, [Vector<f64>; 5]) {
    if ring.is_boundary { moments::<f64, 3>(ring) } else { moments::<f64, 5>(ring) }
}

/// `M = SᵀS` and `Sᵀe`, from the sums of the monomials of `u` and `v`: the basis is made of them.
#[inline(always)]
fn moments<T: Real, const N: usize>(ring: &Ring<T>) -> (Matrix5<T>, [Vector<T>; 5]) {
    if N == 3 { boundary_moments(ring) } else { inner_moments(ring) }
}

#[inline(always)]
fn inner_moments<T: Real>(ring: &Ring<T>) -> (Matrix5<T>, [Vector<T>; 5]) {
    let zero = T::splat(0.0);
    // Of second, third and fourth order, by falling powers of `u`.
    let (mut second, mut third, mut fourth) = ([zero; 3], [zero; 4], [zero; 5]);
    for &Spoke { u, v, .. } in &ring.spokes[..ring.degree] {
        let (uu, uv, vv) = (u * u, u * v, v * v);
        add(&mut second, [uu, uv, vv]);
        add(&mut third, [u * uu, v * uu, u * vv, v * vv]);
        add(&mut fourth, [uu * uu, uu * uv, uu * vv, uv * vv, vv * vv]);
    }
    let (half, root) = (T::splat(0.5), T::splat(FRAC_1_SQRT_2));
    let (quarter, mixed) = (T::splat(0.25), T::splat(0.5 * FRAC_1_SQRT_2));
    let (uuu, uuv, uvv, vvv) = (half * third[0], third[1], third[2], half * third[3]);
    let m13 = [uuu, root * uuv, half * uvv];
    let m23 = [half * uuv, root * uvv, vvv];
    let (m34, m35) = (mixed * fourth[1], quarter * fourth[2]);
    let (m44, m45) = (half * fourth[2], mixed * fourth[3]);
    let m = [
        [second[0], second[1], m13[0], m13[1], m13[2]],
        [second[1], second[2], m23[0], m23[1], m23[2]],
        [m13[0], m23[0], quarter * fourth[0], m34, m35],
        [m13[1], m23[1], m34, m44, m45],
        [m13[2], m23[2], m35, m45, quarter * fourth[4]],
    ];
    let mut b = [Vector::zero(); 5];
    for &Spoke { chord, u, v, .. } in &ring.spokes[..ring.degree] {
        b[0] += chord * u;
        b[1] += chord * v;
        b[2] += chord * (u * u);
        b[3] += chord * (u * v);
        b[4] += chord * (v * v);
    }
    (m, [b[0], b[1], b[2] * half, b[3] * root, b[4] * half])
}

/// On the boundary the basis is `u`, `v` and `u²/2`.
#[inline(always)]
fn boundary_moments<T: Real>(ring: &Ring<T>) -> (Matrix5<T>, [Vector<T>; 5]) {
    let mut m = Matrix5::<T>::default();
    let mut b = [Vector::zero(); 5];
    for j in 0..ring.degree {
        let row = ring.basis(ring.uv(j));
        for i in 0..3 {
            for k in 0..3 {
                m[i][k] += row[i] * row[k];
            }
            b[i] += ring.spokes[j].chord * row[i];
        }
    }
    (m, b)
}

#[inline(always)]
fn add<T: Real, const N: usize>(sums: &mut [T; N], terms: [T; N]) {
    for (sum, term) in sums.iter_mut().zip(terms) {
        *sum += term;
    }
}

/// `D = f(M) Sᵀe`
#[inline(always)]
fn coefficients<T: Real, const N: usize>(fit: &mut Fit<T>, b: &[Vector<T>; 5]) {
    for i in 0..N {
        let row = &fit.inverse[i];
        let mut sum = b[0] * row[0];
        for k in 1..N {
            sum += b[k] * row[k];
        }
        fit.d[i] = sum;
    }
}

#[inline(always)]
fn second_form<T: Real>(fit: &mut Fit<T>, squared: T) {
    let inverse = T::splat(1.0) / squared;
    for c in 0..3 {
        fit.l[c] = fit.d[c + 2].dot(fit.normal) * inverse;
    }
}

/// Twice the area of the parametric fan: the sum of `r_j r_{j+1} sin(scaled angle)`, each by the node's share of the triangle.
#[inline(always)]
fn fan<T: Real>(ring: &Ring<T>) -> T {
    let gaps = ring.gaps();
    let mut sum = T::splat(0.0);
    for (pair, &share) in ring.spokes[..=gaps].windows(2).zip(&ring.shares) {
        sum += share * (pair[0].u * pair[1].v - pair[0].v * pair[1].u);
    }
    sum * (ring.h * ring.h)
}

/// Unit sum of the triangles' area vectors: the normal where no quadratic gives one.
fn facet_normal(ring: &Ring<f64>) -> Vector<f64> {
    let sum: DVec3 =
        (0..ring.gaps()).map(|j| ring.spokes[j].chord.cross(ring.spokes[ring.next(j)].chord).lane(0)).sum();
    let normal = sum.try_normalize().unwrap_or(DVec3::Z);
    Vector::gather(|_| normal)
}

/// The spectral filter `f`.
pub(crate) fn filter(lambda: f64) -> f64 {
    if lambda >= FILTER { 1.0 / lambda } else { lambda / (FILTER * FILTER) }
}

/// Divided difference `(f(x) - f(y)) / (x - y)`, which tends to `f'` on the diagonal.
pub(crate) fn filter_difference(x: f64, y: f64) -> f64 {
    match (x >= FILTER, y >= FILTER) {
        (true, true) => -1.0 / (x * y),
        (false, false) => 1.0 / (FILTER * FILTER),
        // One on either side of the kink: they cannot be equal.
        _ => (filter(x) - filter(y)) / (x - y),
    }
}
