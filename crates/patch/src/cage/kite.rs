//! Parameter maps: from the unit square to the kite of a regular polygon, its sector at one corner.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*, section 3.2, equations (13)-(16). The polygon has its
//! vertices at `(cos 2πk/n, sin 2πk/n)`; the kite has the corners `(0,0)` at the centre, `V2` and `V4` in the middles of the two sides at
//! polygon vertex 0, and `V3 = (1,0)` there. `(u, v) = (1,0)` goes to `V2`, `(0,1)` to `V4`.
//!
//! Two maps. [`Map::Rational`] is the paper's: where a u-curve meets a v-curve, both rational quadratics. The paper's weight
//! `1/u` is infinite at `u = 0`; with `y = u / (u + 2(1-t)/t)` in place of the curve's parameter `t` the curves are regular there, and
//! plain Newton finds the meeting point to the last bits, where the paper's nested golden section stalls at 1e-7. It is
//! only C1 across the spokes of the polygon, so surfaces over irregular vertices are G1. [`Map::Smooth`] is a closed form, analytic off
//! the origin also across spokes: surfaces are G2. Its far sides leave the kite, where the blend has faded to nothing.

use crate::jet::Jet;
use std::f64::consts::{PI, SQRT_2};

/// How the square is mapped to the kite.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Map {
    /// Where two rational quadratic curves meet (the paper): surfaces are G1.
    Rational,
    /// A closed form: surfaces are G2.
    #[default]
    Smooth,
}

/// A place in the polygon with its derivatives by the parameters of the square.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KitePoint {
    /// The place.
    pub point: [f64; 2],
    /// Its derivative by `u`.
    pub du: [f64; 2],
    /// Its derivative by `v`.
    pub dv: [f64; 2],
    /// Its second derivatives by `uu`, `uv` and `vv`: none at the origin, where the derivatives depend on the direction.
    pub second: Option<[[f64; 2]; 3]>,
}

/// Below this both parameters are taken for 0: products of them would vanish.
const ORIGIN: f64 = 1e-100;

/// The place in the kite of the regular `n`-gon (`n >= 3`) where `(u, v)` in [0, 1]² is mapped to. At the origin the derivatives are
/// those along the axes. `None` for parameters outside, not finite, or `n < 3`.
///
/// ```
/// use ductile_patch::cage::{Map, kite};
/// let middle = kite(Map::Smooth, 5, 0.5, 0.5).unwrap();
/// assert!((middle.point[0] - 0.5).abs() < 1e-15 && middle.point[1].abs() < 1e-15);
/// assert!(kite(Map::Smooth, 5, 1.5, 0.5).is_none());
/// ```
#[must_use]
pub fn kite(map: Map, n: usize, u: f64, v: f64) -> Option<KitePoint> {
    let inside = 0.0..=1.0;
    if n < 3 || !inside.contains(&u) || !inside.contains(&v) {
        return None;
    }
    let [x, y] = jets(map, n, u, v);
    let second = (!is_origin(u, v)).then_some([[x.aa, y.aa], [x.ab, y.ab], [x.bb, y.bb]]);
    Some(KitePoint { point: [x.value, y.value], du: [x.a, y.a], dv: [x.b, y.b], second })
}

/// Whether derivatives there depend on the direction.
pub(super) fn is_origin(u: f64, v: f64) -> bool {
    u < ORIGIN && v < ORIGIN
}

/// The same as jets in `u` and `v`. At the origin second derivatives are 0 for want of any.
pub(super) fn jets(map: Map, n: usize, u: f64, v: f64) -> [Jet; 2] {
    match (map, is_origin(u, v)) {
        (Map::Rational, false) => rational(n, u, v),
        (Map::Smooth, false) => smooth(n, u, v),
        (_, true) => {
            let angle = PI / n as f64;
            // F_u = (1 + cos 2a) V2 and |V2| = cos a for the rational map.
            let length = match map {
                Map::Rational => (1.0 + libm::cos(2.0 * angle)) * libm::cos(angle),
                Map::Smooth => libm::cos(angle),
            };
            let [x, y] = [length * libm::cos(angle), length * libm::sin(angle)];
            [Jet { a: x, b: x, ..Jet::default() }, Jet { a: -y, b: y, ..Jet::default() }]
        }
    }
}

/// `F = c r (A + B cos 4θ) (cos φ, sin φ)`, `φ = 4θ/n - π/n`, in polar coordinates of the square.
fn smooth(n: usize, u: f64, v: f64) -> [Jet; 2] {
    let sides = n as f64;
    let c = libm::cos(PI / sides);
    let ripple = (1.0 - 1.0 / (SQRT_2 * c)) / 2.0;
    let length = libm::sqrt(u * u + v * v);
    let (cu, cv) = (u / length, v / length);
    let r = Jet {
        value: length,
        a: cu,
        b: cv,
        aa: cv * cv / length,
        ab: -cu * cv / length,
        bb: cu * cu / length,
    };
    let turn = 2.0 * cu * cv / length / length;
    let theta = Jet {
        value: libm::atan2(v, u),
        a: -cv / length,
        b: cu / length,
        aa: turn,
        ab: (cv * cv - cu * cu) / length / length,
        bb: -turn,
    };
    let [wave, _] = cos_sin(theta * 4.0);
    let [cos, sin] = cos_sin(theta * (4.0 / sides) - Jet::constant(PI / sides));
    let radius = r * (Jet::constant(1.0 - ripple) + wave * ripple) * c;
    [radius * cos, radius * sin]
}

fn cos_sin(angle: Jet) -> [Jet; 2] {
    let (sin, cos) = libm::sincos(angle.value);
    [angle.through([cos, -sin, -cos]), angle.through([sin, cos, -sin])]
}

/// A curve of one of the two pencils: `near` are the end points at its beginning for the parameter 0 and 1, `bend` the direction of
/// its middle control point, `far` the end points at its end.
struct Pencil {
    near: [[f64; 2]; 2],
    bend: [f64; 2],
    far: [[f64; 2]; 2],
}

impl Pencil {
    /// The point at `y` of the curve for `u`, equations (14) and (16) in the recipe's parameter: both coordinates as jets
    /// in (`u`, `y`).
    fn point(&self, u: f64, y: f64) -> [Jet; 2] {
        let (u, y) = (Jet::first(u), Jet::second(y));
        let rest = Jet::ONE - u;
        let q = Jet::ONE - y;
        let e = bulge(u.value);
        let bulge = u.through([
            e,
            e * (2.0 * u.value - 1.0),
            e * (2.0 + (2.0 * u.value - 1.0) * (2.0 * u.value - 1.0)),
        ]);
        let ends = [u * u * q * q, y * y * 4.0];
        let middle = u * y * q * bulge * 4.0;
        let below = ends[0] + y * 4.0;
        [0, 1].map(|k| {
            let near = rest * self.near[0][k] + u * self.near[1][k];
            let far = rest * self.far[0][k] + u * self.far[1][k];
            (near * ends[0] + middle * self.bend[k] + far * ends[1]) / below
        })
    }
}

/// `e(t) = exp(t² - t)`.
fn bulge(t: f64) -> f64 {
    libm::exp(t * t - t)
}

fn rational(n: usize, u: f64, v: f64) -> [Jet; 2] {
    let angle = PI / n as f64;
    let c = libm::cos(angle);
    // Signed zeros and exact mirror images: V6..V4 are V0..V2 with y turned.
    let at = |radius: f64, k: f64| [radius * libm::cos(k * angle), radius * libm::sin(k * angle)];
    let mirror = |[x, y]: [f64; 2]| [x, -y];
    let (v6, v5, v4, v3) = (at(c, 3.0), at(1.0, 2.0), at(c, 1.0), [1.0, 0.0]);
    let along_u = Pencil { near: [mirror(v6), mirror(v5)], bend: mirror(v4), far: [v4, v3] };
    let along_v = Pencil { near: [v6, v5], bend: v4, far: [mirror(v4), v3] };
    let double = libm::cos(2.0 * angle);
    let (y, z) = meet(&along_u, &along_v, double, u, v);
    let (on_u, on_v) = (along_u.point(u, y), along_v.point(v, z));
    // Implicit derivatives of Q(y; u) = P(z; v); in the jets `a` is by the curve and `b` along it.
    let solve = |right: [f64; 2]| {
        let [[qy, pz], [ry, sz]] = [[on_u[0].b, -on_v[0].b], [on_u[1].b, -on_v[1].b]];
        let determinant = qy * sz - pz * ry;
        [(right[0] * sz - pz * right[1]) / determinant, (qy * right[1] - ry * right[0]) / determinant]
    };
    let [yu, zu] = solve([-on_u[0].a, -on_u[1].a]);
    let [yv, zv] = solve([on_v[0].a, on_v[1].a]);
    let right = |of: &dyn Fn(&Jet, &Jet) -> f64| [of(&on_u[0], &on_v[0]), of(&on_u[1], &on_v[1])];
    let [_, zuu] = solve(right(&|q, p| p.bb * zu * zu - q.bb * yu * yu - 2.0 * q.ab * yu - q.aa));
    let [_, zuv] = solve(right(&|q, p| p.bb * zu * zv + p.ab * zu - q.bb * yu * yv - q.ab * yv));
    let [yvv, _] = solve(right(&|q, p| p.bb * zv * zv + 2.0 * p.ab * zv + p.aa - q.bb * yv * yv));
    [0, 1].map(|k| {
        let (q, p) = (&on_u[k], &on_v[k]);
        Jet {
            // The mean keeps the mirror symmetry of the map to the last bit but one.
            value: (q.value + p.value) / 2.0,
            a: p.b * zu,
            b: q.b * yv,
            aa: p.bb * zu * zu + p.b * zuu,
            ab: p.bb * zu * zv + p.ab * zu + p.b * zuv,
            bb: q.bb * yv * yv + q.b * yvv,
        }
    })
}

/// Where the two curves meet, by Newton's method from a start that is exact on the sides of the square. At most six
/// steps were ever seen; the cap is for rounding at very many sides.
fn meet(along_u: &Pencil, along_v: &Pencil, double: f64, u: f64, v: f64) -> (f64, f64) {
    let start = |t: f64| t * ((1.0 - t) * double + t + bulge(t)) / (1.0 + t);
    let mut y = (1.0 - u) * start(v) + u * (1.0 + v) / (3.0 - v);
    let mut z = (1.0 - v) * start(u) + v * (1.0 + u) / (3.0 - u);
    let (least_y, least_z) = (u / (2.0 * (u + 2.0)), v / (2.0 * (v + 2.0)));
    for _ in 0..30 {
        let (q, p) = (along_u.point(u, y), along_v.point(v, z));
        let off = [q[0].value - p[0].value, q[1].value - p[1].value];
        let determinant = -q[0].b * p[1].b + p[0].b * q[1].b;
        let dy = (-off[0] * p[1].b + p[0].b * off[1]) / determinant;
        let dz = (q[0].b * off[1] - q[1].b * off[0]) / determinant;
        if !dy.is_finite() || !dz.is_finite() {
            break;
        }
        let (next_y, next_z) = ((y - dy).clamp(least_y, 1.5), (z - dz).clamp(least_z, 1.5));
        let is_still = (next_y - y).abs() <= 1e-14 * y && (next_z - z).abs() <= 1e-14 * z;
        (y, z) = (next_y, next_z);
        if is_still {
            break;
        }
    }
    (y, z)
}

#[cfg(test)]
mod tests;
