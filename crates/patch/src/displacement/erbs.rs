//! The expo-rational B-spline of one variable: the C∞ step of which all derivatives vanish at both ends.
//!
//! Source: P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*, eq. (9), after
//! Dechevsky, Lakså and Bang (2006). With `q = s (1 - s)` the exponent `-(s - 1/2)² / q` is `1 - 1 / (4 q)`, so that
//!
//! ```text
//! f(t) = K ∫₀ᵗ exp(1 - 1 / (4 s (1 - s))) ds,      f(0) = 0, f(1) = 1, f(t) + f(1 - t) = 1.
//! ```
//!
//! Parameters and values are dimensionless, in [0, 1]; parameters outside are taken to the nearer end.

/// The scale that makes `f(1) = 1`. The program published with the paper has it wrong by 9e-11.
pub(crate) const K: f64 = 1.657_137_679_738_210_3;

/// Gauss points of the exact value: 64 leave 2e-15, 48 leave 5e-13, 32 leave 1.6e-10.
const EXACT_POINTS: usize = 64;
/// Gauss points in a cell of the table.
const CELL_POINTS: usize = 20;
/// Cells of the table on [0, 1/2]; 512 in the unit give an error of 1e-13.
const CELLS: usize = 256;

/// The step, with a table for fast values and a Gauss rule for exact ones. Building it takes about a tenth of a
/// millisecond; keep it.
///
/// ```
/// let erbs = ductile_patch::Erbs::new();
/// assert_eq!([erbs.value(0.0), erbs.value(0.5), erbs.value(1.0)], [0.0, 0.5, 1.0]);
/// assert!((erbs.value(0.25) - 0.122967283277329).abs() < 1e-12);
/// assert!((erbs.exact(0.25) - 0.122967283277329).abs() < 1e-14);
/// ```
#[derive(Clone, Debug)]
pub struct Erbs {
    /// Value and first two derivatives at the nodes `i / 512` of [0, 1/2].
    nodes: Vec<[f64; 3]>,
    /// Points of [0, 1] with their weights.
    rule: Vec<[f64; 2]>,
}

impl Default for Erbs {
    fn default() -> Self {
        Self::new()
    }
}

impl Erbs {
    /// Builds the table.
    #[must_use]
    pub fn new() -> Self {
        let cell_rule = gauss_legendre(CELL_POINTS);
        let width = 0.5 / CELLS as f64;
        let mut value = 0.0;
        let mut values = vec![0.0];
        for cell in 0..CELLS {
            value += integral(&cell_rule, cell as f64 * width, width);
            values.push(value);
        }
        // What the sum lost is shared out, so that the middle is met exactly.
        let scale = 0.5 / value;
        let node = |(index, value): (usize, &f64)| {
            let t = index as f64 * width;
            [value * scale, Self::derivative(t), Self::second_derivative(t)]
        };
        Self { nodes: values.iter().enumerate().map(node).collect(), rule: gauss_legendre(EXACT_POINTS) }
    }

    /// The value from the table: exactly 0 and 1 at the ends, error 1e-13, never decreasing beyond rounding. NaN gives 0.
    #[must_use]
    pub fn value(&self, t: f64) -> f64 {
        let half = |a: f64| {
            let at = a * (2 * CELLS) as f64;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "between 0 and the number of cells, for a lies in (0, 1/2]"
            )]
            let cell = (at as usize).min(CELLS - 1);
            quintic_hermite(self.nodes[cell], self.nodes[cell + 1], at - cell as f64, 0.5 / CELLS as f64)
        };
        by_symmetry(t, half)
    }

    /// The value by 64-point Gauss-Legendre quadrature: error 2e-15, some hundred times slower than [`Self::value`].
    #[must_use]
    pub fn exact(&self, t: f64) -> f64 {
        by_symmetry(t, |a| integral(&self.rule, 0.0, a))
    }

    /// The first derivative: 0 at the ends and outside, at most 1.6571… (in the middle).
    #[must_use]
    pub fn derivative(t: f64) -> f64 {
        let q = t * (1.0 - t);
        if q > 0.0 { K * libm::exp(1.0 - 0.25 / q) } else { 0.0 }
    }

    /// The second derivative: 0 at the ends and outside.
    #[must_use]
    pub fn second_derivative(t: f64) -> f64 {
        let slope = Self::derivative(t);
        let q = t * (1.0 - t);
        // Where the slope is below the least number, q² may be too: 0 / 0.
        if slope > 0.0 { slope * (1.0 - 2.0 * t) / (4.0 * q * q) } else { 0.0 }
    }
}

/// Values on (0, 1/2] carried to the whole line.
fn by_symmetry(t: f64, half: impl Fn(f64) -> f64) -> f64 {
    if t >= 1.0 {
        1.0
    } else if t > 0.5 {
        1.0 - half(1.0 - t)
    } else if t > 0.0 {
        half(t)
    } else {
        0.0
    }
}

/// `∫ f'` over an interval.
fn integral(rule: &[[f64; 2]], from: f64, width: f64) -> f64 {
    rule.iter().map(|[point, weight]| weight * Erbs::derivative(from + width * point)).sum::<f64>() * width
}

/// The quintic with these values and first two derivatives at both ends of a cell, at a share `x` of its width.
fn quintic_hermite(left: [f64; 3], right: [f64; 3], x: f64, width: f64) -> f64 {
    let [f0, d0, s0] = [left[0], left[1] * width, left[2] * width * width];
    let [f1, d1, s1] = [right[0], right[1] * width, right[2] * width * width];
    // What the parabola at the left end misses at the right end, in value and derivatives.
    let miss = f1 - (f0 + d0 + 0.5 * s0);
    let miss_slope = d1 - (d0 + s0);
    let miss_bend = s1 - s0;
    let c3 = 10.0 * miss - 4.0 * miss_slope + 0.5 * miss_bend;
    let c4 = -15.0 * miss + 7.0 * miss_slope - miss_bend;
    let c5 = 6.0 * miss - 3.0 * miss_slope + 0.5 * miss_bend;
    f0 + x * (d0 + x * (0.5 * s0 + x * (c3 + x * (c4 + x * c5))))
}

/// Points in (0, 1) and weights, which sum to 1, of the Gauss-Legendre rule with so many points.
fn gauss_legendre(count: usize) -> Vec<[f64; 2]> {
    let n = count as f64;
    let mut rule = vec![[0.5, 0.0]; count];
    for index in 0..count.div_ceil(2) {
        // Newton's method on the Legendre polynomial from Tricomi's estimate of its root; it converges quadratically.
        let mut x = libm::cos(core::f64::consts::PI * (index as f64 + 0.75) / (n + 0.5));
        let mut slope = 1.0;
        for _ in 0..8 {
            let (mut value, mut before) = (1.0, 0.0);
            for k in 0..count {
                let k = k as f64;
                (value, before) = (((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0), value);
            }
            slope = n * (x * value - before) / (x * x - 1.0);
            x -= value / slope;
        }
        let weight = 1.0 / ((1.0 - x * x) * slope * slope);
        rule[index] = [0.5 - 0.5 * x, weight];
        rule[count - 1 - index] = [0.5 + 0.5 * x, weight];
    }
    rule
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn gauss_rules_are_exact_on_polynomials() {
        for count in [1, 2, 5, 20, 64] {
            let rule = gauss_legendre(count);
            for degree in 0..2 * count {
                let power = |x: f64| (0..degree).fold(1.0, |product, _| product * x);
                let sum: f64 = rule.iter().map(|[point, weight]| weight * power(*point)).sum();
                assert!((sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-14, "{count} points, degree {degree}");
            }
        }
    }

    #[test]
    fn known_values_are_met() {
        let erbs = Erbs::new();
        for (t, known, by) in [
            (0.5, 0.5, 2e-15),
            (0.25, 0.122_967_283_277_329, 1e-15),
            (0.1, 0.006_790_999_529_43, 1e-14),
            (0.01, 1.805e-14, 1e-17),
        ] {
            assert!((erbs.exact(t) - known).abs() <= by, "{t}: {}", erbs.exact(t));
            assert!((erbs.value(t) - known).abs() <= by.max(1e-12), "{t}: {}", erbs.value(t));
        }
        assert_eq!(Erbs::derivative(0.5), K);
        for t in [-1.0, 0.0, f64::NAN, f64::NEG_INFINITY] {
            assert_eq!([erbs.value(t), erbs.exact(t), Erbs::derivative(t)], [0.0; 3], "{t}");
        }
        for t in [1.0, 2.0, f64::INFINITY] {
            assert_eq!([erbs.value(t), erbs.exact(t), Erbs::derivative(t)], [1.0, 1.0, 0.0], "{t}");
        }
    }

    #[test]
    fn the_table_is_as_good_as_stated_and_monotone() {
        let erbs = Erbs::new();
        let (mut worst, mut before) = (0.0_f64, 0.0);
        for step in 0..=20_000 {
            let t = f64::from(step) / 20_000.0;
            let value = erbs.value(t);
            assert!((0.0..=1.0).contains(&value));
            assert!(value >= before - 1e-18, "falls at {t} by {:e}", before - value);
            assert!((value + erbs.value(1.0 - t) - 1.0).abs() < 1e-15);
            before = value;
            if step % 7 == 0 {
                worst = worst.max((value - erbs.exact(t)).abs());
            }
        }
        assert!(worst < 1.1e-13, "{worst:e}");
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let erbs = Erbs::new();
        for step in 1..100 {
            let (t, h) = (f64::from(step) / 100.0, 1e-4);
            let slope = (erbs.exact(t + h) - erbs.exact(t - h)) / (2.0 * h);
            let bend = (Erbs::derivative(t + h) - Erbs::derivative(t - h)) / (2.0 * h);
            assert!((Erbs::derivative(t) - slope).abs() < 2e-6, "{t}");
            assert!((Erbs::second_derivative(t) - bend).abs() < 2e-4, "{t}");
        }
        assert_eq!(Erbs::second_derivative(1e-300), 0.0);
    }
}
