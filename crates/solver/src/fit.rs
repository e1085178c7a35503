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
//! Filter: the inverse of `M = SᵀS` is `f(M)` with `f(λ) = 1/λ` for `λ >= 0.02`, else `λ/0.02²`. Normalised coordinates
//! make 0.02 free of scale; rings of degree 3 and 4 get their minimum-norm solution without any switching. Whether
//! the plain inverse serves is decided by `trace M⁻¹ < 1/0.02`, which proves that every eigenvalue lies above 0.02
//! (a bound on the pivots, as in the prototypes, does not, and would let the energy jump).

use std::f64::consts::{FRAC_1_SQRT_2, SQRT_2};

use glam::DVec3;

use crate::barrier;
use crate::dense::{self, Matrix5, ZERO5};
use crate::energy::thin_plate;
use crate::neighbourhood::{self, Chords, Frame, Spoke};
use crate::rings::Rings;

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

/// The fit of one node.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct NodeFit {
    pub(crate) kind: Kind,
    pub(crate) frame: Frame,
    /// `f(M)`.
    pub(crate) inverse: Matrix5,
    /// Coefficients D1 to D5, in normalised coordinates.
    pub(crate) d: [DVec3; 5],
    pub(crate) normal: DVec3,
    /// `|s_u × s_v|`.
    pub(crate) jacobian: f64,
    /// `(L11, √2 L12, L22)`.
    pub(crate) l: [f64; 3],
    /// One third of the parametric fan.
    pub(crate) area: f64,
    /// Whether the fan was turned inside out and its area set to zero.
    pub(crate) is_area_clamped: bool,
    /// Thin-plate plus barrier.
    pub(crate) energy: f64,
}

impl NodeFit {
    /// Whether the node has curvature rows and an energy that depends on its ring.
    #[inline]
    pub(crate) fn is_fitted(&self) -> bool {
        matches!(self.kind, Kind::Plain | Kind::Filtered)
    }

    /// Mean and Gaussian curvature. The mean curvature is negative where the normal points out of a sphere.
    #[inline]
    pub(crate) fn curvature(&self) -> Curvature {
        let [l11, l12, l22] = [self.l[0], self.l[1] * FRAC_1_SQRT_2, self.l[2]];
        Curvature { mean: 0.5 * (l11 + l22), gauss: l11 * l22 - l12 * l12 }
    }

    /// The square of the second fundamental form in the basis of `l`.
    #[inline]
    pub(crate) fn l_squared(&self) -> [f64; 3] {
        let [l11, l12, l22] = self.l; // l12 carries its √2
        let half = 0.5 * l12 * l12;
        [l11 * l11 + half, l12 * (l11 + l22), l22 * l22 + half]
    }

    /// The fitted quadratic at normalised coordinates, relative to the node; `linear` scales the first-order part.
    pub(crate) fn evaluate(&self, u: f64, v: f64, linear: f64) -> DVec3 {
        let second =
            self.d[2] * (0.5 * u * u) + self.d[3] * (u * v * FRAC_1_SQRT_2) + self.d[4] * (0.5 * v * v);
        (self.d[0] * u + self.d[1] * v) * linear + second
    }

    /// The derivatives of the fitted quadratic by `u` and `v`.
    pub(crate) fn tangents(&self, u: f64, v: f64) -> [DVec3; 2] {
        let mixed = self.d[3] * FRAC_1_SQRT_2;
        [self.d[0] + self.d[2] * u + mixed * v, self.d[1] + mixed * u + self.d[4] * v]
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
    /// The larger principal curvature by magnitude.
    pub fn largest(&self) -> f64 {
        let discriminant = self.mean * self.mean - self.gauss;
        self.mean.abs() + discriminant.max(0.0).sqrt()
    }
}

/// The fits of all nodes at one set of positions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fits {
    pub(crate) nodes: Vec<NodeFit>,
    pub(crate) spokes: Vec<Spoke>,
    /// Where the fits were made.
    pub(crate) positions: Vec<DVec3>,
    /// Sum over all nodes, in index order.
    pub(crate) energy: f64,
}

impl Fits {
    /// Room for one connectivity.
    pub(crate) fn new(rings: &Rings) -> Self {
        Self {
            nodes: vec![NodeFit::default(); rings.len()],
            spokes: vec![Spoke::default(); rings.spokes()],
            positions: vec![DVec3::NAN; rings.len()],
            energy: f64::NAN,
        }
    }

    /// Fits every node, unless these are the positions of the last call.
    pub(crate) fn refit(&mut self, rings: &Rings, positions: &[DVec3]) {
        if self.positions == positions {
            return;
        }
        self.positions.copy_from_slice(positions);
        let mut energy = 0.0;
        for node in 0..rings.len() {
            let spokes = &mut self.spokes[rings.slots(node)];
            let chords = Chords::new(positions, node, rings.ring(node));
            fit_node(&mut self.nodes[node], chords.all(), rings.is_boundary(node), spokes);
            energy += self.nodes[node].energy;
        }
        self.energy = energy;
    }
}

/// The row of the basis at a spoke.
#[inline]
pub(crate) fn basis(spoke: &Spoke, h: f64, is_boundary: bool) -> [f64; 5] {
    let (u, v) = (spoke.r * spoke.cos / h, spoke.r * spoke.sin / h);
    if is_boundary {
        [u, v, 0.5 * u * u, 0.0, 0.0]
    } else {
        [u, v, 0.5 * u * u, FRAC_1_SQRT_2 * u * v, 0.5 * v * v]
    }
}

/// Fits one node in place: a fit is half a kilobyte, too much to hand back by value.
fn fit_node(fit: &mut NodeFit, chords: &[DVec3], is_boundary: bool, spokes: &mut [Spoke]) {
    *fit = NodeFit::default();
    if chords.len() < 2 {
        return;
    }
    fit.frame = neighbourhood::unroll(chords, is_boundary, spokes);
    fit.jacobian = 1.0;
    fit.normal = facet_normal(chords, is_boundary);
    fan_area(fit, is_boundary, spokes);
    // A boundary node with two neighbours is an ear: one flat triangle, no second direction to fit.
    if chords.len() == 2 || !(fit.frame.h > MIN_LENGTH) {
        return;
    }
    let (m, b) = moments(chords, is_boundary, spokes, fit.frame.h);
    let plain = if is_boundary { dense::invert::<3>(&m) } else { dense::invert::<5>(&m) };
    let trace = |inverse: &Matrix5| (0..5).map(|i| inverse[i][i]).sum::<f64>();
    (fit.inverse, fit.kind) = match plain {
        Some(inverse) if trace(&inverse) < 1.0 / FILTER => (inverse, Kind::Plain),
        _ => (dense::eigen(&m).map(filter), Kind::Filtered),
    };
    for (row, d) in fit.inverse.iter().zip(&mut fit.d) {
        *d = b[0] * row[0] + b[1] * row[1] + b[2] * row[2] + b[3] * row[3] + b[4] * row[4];
    }
    derive(fit);
    fit.energy = thin_plate::value(fit) + barrier::value(fit.jacobian);
}

/// Normal, Jacobian and second fundamental form from the coefficients.
#[inline]
fn derive(fit: &mut NodeFit) {
    let squared = fit.frame.h * fit.frame.h;
    let m = fit.d[0].cross(fit.d[1]);
    let length = m.length();
    fit.jacobian = length / squared;
    if !(fit.jacobian > MIN_JACOBIAN) {
        fit.kind = Kind::Folded;
        return;
    }
    fit.normal = m / length;
    for (l, d) in fit.l.iter_mut().zip(&fit.d[2..]) {
        *l = d.dot(fit.normal) / squared;
    }
}

/// `M = SᵀS` and `Sᵀe`.
#[inline]
pub(crate) fn moments(
    chords: &[DVec3],
    is_boundary: bool,
    spokes: &[Spoke],
    h: f64,
) -> (Matrix5, [DVec3; 5]) {
    let mut m = ZERO5;
    let mut b = [DVec3::ZERO; 5];
    for (chord, spoke) in chords.iter().zip(spokes) {
        let row = basis(spoke, h, is_boundary);
        for i in 0..5 {
            for j in 0..=i {
                m[i][j] += row[i] * row[j];
            }
            b[i] += *chord * row[i];
        }
    }
    for i in 0..5 {
        for j in 0..i {
            m[j][i] = m[i][j];
        }
    }
    (m, b)
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

/// One third of the fan in the parameter plane: the sum of `r_j r_{j+1} sin(scaled angle) / 6`.
#[inline]
fn fan_area(fit: &mut NodeFit, is_boundary: bool, spokes: &[Spoke]) {
    let mut sum = 0.0;
    for j in 0..neighbourhood::gaps(spokes.len(), is_boundary) {
        let (near, far) = (&spokes[j], &spokes[if j + 1 == spokes.len() { 0 } else { j + 1 }]);
        sum += near.r * far.r * (near.cos * far.sin - near.sin * far.cos);
    }
    // A sliver can turn the fan inside out; a negative area would reward it.
    fit.is_area_clamped = !(sum > 0.0);
    fit.area = if fit.is_area_clamped { 0.0 } else { sum / 6.0 };
}

/// Unit sum of the triangles' area vectors: the normal where no quadratic gives one.
fn facet_normal(chords: &[DVec3], is_boundary: bool) -> DVec3 {
    let mut sum = DVec3::ZERO;
    for j in 0..neighbourhood::gaps(chords.len(), is_boundary) {
        sum += chords[j].cross(chords[if j + 1 == chords.len() { 0 } else { j + 1 }]);
    }
    sum.try_normalize().unwrap_or(DVec3::Z)
}

/// `√2`, for those who need `L12` or `uv` without their factor.
pub(crate) const ROOT_TWO: f64 = SQRT_2;
