//! Local interpolants: the surface through a vertex and its whole ring, as weights of those points.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*, equations (1), (2) and (9)-(19). Every interpolant is
//! linear in the points, with weights that sum to 1 and may be negative. Four faces round the vertex: the biquadratic through the 3 x 3
//! points. Five and more: the quadratic generalised Bézier patch over the regular polygon, in a form without quotients, since the
//! paper's (9) is 0/0 at far vertices. Three: the cubic triangle (17)-(19), since (12) divides by `n - 3`.
//!
//! The ring runs counter-clockwise: edge point `E[0]`, corner `C[0]` (opposite in the first quad), `E[1]`, `C[1]` and so on, so that `E[j]`
//! lies between `C[j-1]` and `C[j]`. Weights stand in the order `M`, `C[0..n]`, `E[0..n]`.

use crate::jet::Jet;
use std::f64::consts::PI;

/// Weights of the interpolant of a vertex with `n` faces at `(x, y)`: in [-1,1]² for `n = 4`, in the regular polygon else.
pub(super) fn weights(n: usize, x: Jet, y: Jet) -> Vec<Jet> {
    match n {
        3 => triangle(x, y),
        4 => tensor(x, y),
        _ => generalised(n, x, y),
    }
}

/// Biquadratic Lagrange polynomials on {-1, 0, 1}².
fn tensor(x: Jet, y: Jet) -> Vec<Jet> {
    let lagrange = |t: Jet| [t * (t - Jet::ONE) * 0.5, Jet::ONE - t * t, t * (t + Jet::ONE) * 0.5];
    let (along, across) = (lagrange(x), lagrange(y));
    // M, the corners from (1,1) on, the edge points from (1,0) on.
    [(1, 1), (2, 2), (0, 2), (0, 0), (2, 0), (2, 1), (1, 2), (0, 1), (1, 0)]
        .map(|(i, j)| along[i] * across[j])
        .to_vec()
}

/// The cubic triangle: barycentric coordinates belong to `C[0..3]`.
fn triangle(x: Jet, y: Jet) -> Vec<Jet> {
    let root = libm::sqrt(3.0);
    let third = |jet: Jet| jet * (1.0 / 3.0);
    let lambda = [third(Jet::ONE + x * 2.0), third(Jet::ONE - x + y * root), third(Jet::ONE - x - y * root)];
    let product = lambda[0] * lambda[1] * lambda[2];
    // How much of the quadratic's middle control point each side takes: Ê[j] lies between C[j-1] and C[j].
    let sides: Vec<Jet> = (0..3)
        .map(|j| {
            let (before, after) = (lambda[(j + 2) % 3], lambda[j]);
            before * after * (before + after) * 2.0
        })
        .collect();
    // Of a side's control points (C + 2Ê)/3 the shares that fall to its ends.
    let ends = |j: usize| {
        let (own, before, after) = (lambda[j], lambda[(j + 2) % 3], lambda[(j + 1) % 3]);
        own * own * (own + before + after)
    };
    let mut weights = vec![product * 27.0];
    weights.extend((0..3).map(|j| ends(j) + product - (sides[j] + sides[(j + 1) % 3]) * 0.5));
    weights.extend((0..3).map(|j| sides[j] * 2.0 - product * 8.0));
    weights
}

/// The quadratic generalised Bézier patch.
fn generalised(n: usize, x: Jet, y: Jet) -> Vec<Jet> {
    let lambda = wachspress(n, x, y);
    let before = |j: usize| (j + n - 1) % n;
    let sides: Vec<Jet> = (0..n).map(|j| lambda[before(j)] * lambda[j] * 2.0).collect();
    let squares: Vec<Jet> = lambda.iter().map(|&l| l * l).collect();
    // Twice the products of coordinates that are no neighbours: equation (11) without its cancellation.
    let total = squares.iter().chain(&sides).fold(Jet::default(), |sum, &part| sum + part);
    let rest = Jet::ONE - total;
    let count = n as f64;
    let share = rest * (1.0 / (count * (count - 3.0)));
    let mut weights = vec![share * (count * count)];
    weights.extend((0..n).map(|j| squares[j] + share - (sides[j] + sides[(j + 1) % n]) * 0.5));
    weights.extend(sides.iter().map(|&side| side * 2.0 - share * 4.0));
    weights
}

/// Wachspress coordinates in the regular polygon, from products of the distances to all sides but two.
fn wachspress(n: usize, x: Jet, y: Jet) -> Vec<Jet> {
    let half = PI / n as f64;
    let apothem = Jet::constant(libm::cos(half));
    let distances: Vec<Jet> = (0..n)
        .map(|j| {
            let (sin, cos) = libm::sincos((2 * j + 1) as f64 * half);
            apothem - x * cos - y * sin
        })
        .collect();
    // Products of the first and of the last distances; leaving out j-1 and j is then one product.
    let mut first = vec![Jet::ONE];
    let mut last = vec![Jet::ONE];
    for j in 0..n {
        first.push(first[j] * distances[j]);
        last.push(last[j] * distances[n - 1 - j]);
    }
    let inner = distances[1..n - 1].iter().fold(Jet::ONE, |product, &d| product * d);
    let products: Vec<Jet> =
        (0..n).map(|j| if j == 0 { inner } else { first[j - 1] * last[n - 1 - j] }).collect();
    let sum = products.iter().fold(Jet::default(), |sum, &w| sum + w);
    products.into_iter().map(|w| w / sum).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn at(n: usize, x: f64, y: f64) -> Vec<Jet> {
        weights(n, Jet::first(x), Jet::second(y))
    }

    /// The place of a ring point: `C[k]` is corner k of the polygon, `E[k]` the middle of the side before it.
    fn place(n: usize, index: usize) -> (f64, f64) {
        if n == 4 {
            let places = [(0, 0), (1, 1), (-1, 1), (-1, -1), (1, -1), (1, 0), (0, 1), (-1, 0), (0, -1)];
            let (x, y) = places[index];
            return (f64::from(x), f64::from(y));
        }
        let side = PI / n as f64;
        let (radius, angle) = match index {
            0 => (0.0, 0.0),
            c if c <= n => (1.0, 2.0 * side * (c - 1) as f64),
            e => (libm::cos(side), side * (2.0 * (e - 1 - n) as f64 - 1.0)),
        };
        (radius * libm::cos(angle), radius * libm::sin(angle))
    }

    #[test]
    fn every_point_of_the_ring_is_met() {
        for n in 3..=16 {
            for own in 0..=2 * n {
                let (x, y) = place(n, own);
                for (index, weight) in at(n, x, y).iter().enumerate() {
                    let exact = f64::from(u8::from(index == own));
                    assert!((weight.value - exact).abs() < 1e-13, "n = {n}, {own}: {index} {}", weight.value);
                }
            }
        }
    }

    #[test]
    fn weights_sum_to_one_and_their_derivatives_to_nothing() {
        for n in [3, 4, 5, 6, 9, 64] {
            for (x, y) in [(0.0, 0.0), (0.3, -0.2), (0.61, 0.1), (-0.2, 0.33)] {
                let sum = at(n, x, y).into_iter().fold(Jet::default(), |sum, w| sum + w);
                assert!((sum.value - 1.0).abs() < 1e-13, "n = {n}");
                let rest = [sum.a, sum.b, sum.aa, sum.ab, sum.bb];
                assert!(rest.iter().all(|d| d.abs() < 1e-10), "n = {n}: {rest:?}");
            }
        }
    }

    /// The paper's own formulas (9)-(12), where they are no 0/0.
    #[test]
    fn the_form_without_quotients_is_the_papers() {
        for n in [5_usize, 6, 7, 9] {
            let (x, y) = (0.23, -0.31);
            let lambda: Vec<f64> =
                wachspress(n, Jet::constant(x), Jet::constant(y)).iter().map(|l| l.value).collect();
            let mut paper = vec![0.0; 2 * n + 1];
            let mut deficiency = 1.0;
            let count = n as f64;
            let add_hat = |paper: &mut Vec<f64>, j: usize, weight: f64| {
                paper[1 + n + j] += 2.0 * weight;
                paper[1 + (j + n - 1) % n] -= weight / 2.0;
                paper[1 + j] -= weight / 2.0;
            };
            for j in 0..n {
                let (before, own) = (lambda[(j + n - 1) % n], lambda[j]);
                let (s, d) = (own / (before + own), 1.0 - before - own);
                let depth = (1.0 - d) * (1.0 - d);
                let parts =
                    [(1.0 - s) * (1.0 - s) / 2.0, 2.0 * s * (1.0 - s), s * s / 2.0].map(|b| b * depth);
                paper[1 + (j + n - 1) % n] += parts[0];
                paper[1 + j] += parts[2];
                add_hat(&mut paper, j, parts[1]);
                deficiency -= parts.iter().sum::<f64>();
            }
            paper[0] += deficiency * count * count / (count * (count - 3.0));
            let share = deficiency / (count * (count - 3.0));
            for j in 0..n {
                paper[1 + j] -= share;
                add_hat(&mut paper, j, -2.0 * share);
            }
            for (index, (ours, theirs)) in at(n, x, y).iter().zip(&paper).enumerate() {
                assert!((ours.value - theirs).abs() < 1e-13, "n = {n}, {index}: {} {theirs}", ours.value);
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for n in [3, 4, 5, 7] {
            let (x, y, h) = (0.21, -0.17, 1e-4);
            let exact = at(n, x, y);
            let value = |i: f64, j: f64| at(n, x + i * h, y + j * h);
            let stencil = [value(1.0, 0.0), value(-1.0, 0.0), value(0.0, 1.0), value(0.0, -1.0)];
            for (k, w) in exact.iter().enumerate() {
                let [right, left, up, down] = [0, 1, 2, 3].map(|s| stencil[s][k].value);
                assert!((w.a - (right - left) / (2.0 * h)).abs() < 1e-5);
                assert!((w.b - (up - down) / (2.0 * h)).abs() < 1e-5);
                assert!((w.aa - (right - 2.0 * w.value + left) / (h * h)).abs() < 1e-4);
                assert!((w.bb - (up - 2.0 * w.value + down) / (h * h)).abs() < 1e-4);
            }
        }
    }
}
