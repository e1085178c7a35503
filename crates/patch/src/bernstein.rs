//! Bernstein polynomials of one variable and the binomial coefficients in them (Farin, *Curves and Surfaces for CAGD*,
//! chapter 5). Parameters are dimensionless; [0, 1] is the curve, values outside continue it.

/// `n` over `k`, and 0 unless `0 <= k <= n`: the convention by which sums over the rows of a control net need no guards.
/// Exact in `f64` for `n <= 56`.
#[must_use]
pub fn binomial(n: i64, k: i64) -> f64 {
    if k < 0 || k > n {
        return 0.0;
    }
    let k = k.min(n - k);
    // Each partial product is a binomial coefficient, so every division comes out even.
    (0..k).fold(1.0, |product, i| product * (n - i) as f64 / (i + 1) as f64)
}

/// All `degree + 1` Bernstein polynomials of a degree at `t`, by their recurrence: sums of products without
/// cancellation for `t` in [0, 1].
///
/// ```
/// assert_eq!(ductile_patch::basis(2, 0.5), [0.25, 0.5, 0.25]);
/// ```
#[must_use]
pub fn basis(degree: usize, t: f64) -> Vec<f64> {
    let mut values = vec![0.0; degree + 1];
    values[0] = 1.0;
    for raised in 1..=degree {
        let mut carried = 0.0;
        for value in &mut values[..raised] {
            let share = *value;
            *value = carried + (1.0 - t) * share;
            carried = t * share;
        }
        values[raised] = carried;
    }
    values
}

/// First derivatives by `t` of what [`basis`] gives.
#[must_use]
pub fn basis_derivative(degree: usize, t: f64) -> Vec<f64> {
    let Some(lower) = degree.checked_sub(1) else {
        return vec![0.0];
    };
    let below = basis(lower, t);
    let at = |index: usize| below.get(index).copied().unwrap_or(0.0);
    (0..=degree).map(|j| degree as f64 * (j.checked_sub(1).map_or(0.0, at) - at(j))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn binomials_vanish_outside_and_add_up() {
        assert_eq!([binomial(5, -1), binomial(5, 0), binomial(5, 2), binomial(5, 6)], [0.0, 1.0, 10.0, 0.0]);
        assert_eq!(binomial(-1, 0), 0.0);
        for n in 0..=50 {
            let sum: f64 = (0..=n).map(|k| binomial(n, k)).sum();
            assert_eq!(sum, (0..n).fold(1.0, |power, _| 2.0 * power), "row {n}");
        }
    }

    #[test]
    fn the_basis_is_its_formula() {
        for degree in 0..=9_usize {
            for t in [0.0, 0.125, 0.3, 0.5, 0.99, 1.0] {
                let values = basis(degree, t);
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-15);
                for (j, value) in values.iter().enumerate() {
                    let power = |base: f64, times: usize| (0..times).fold(1.0, |p, _| p * base);
                    let exact = binomial(degree as i64, j as i64) * power(t, j) * power(1.0 - t, degree - j);
                    assert!((value - exact).abs() < 1e-15, "degree {degree}, {j} at {t}");
                }
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        for degree in 0..=8_usize {
            let (t, step) = (0.37, 1e-5);
            let (ahead, behind) = (basis(degree, t + step), basis(degree, t - step));
            for (j, derivative) in basis_derivative(degree, t).into_iter().enumerate() {
                let difference = (ahead[j] - behind[j]) / (2.0 * step);
                assert!((derivative - difference).abs() < 1e-8, "degree {degree}, {j}");
            }
        }
    }
}
