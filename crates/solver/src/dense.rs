//! Small symmetric matrices: inverse by `L D Lᵀ` and eigen-decomposition by cyclic Jacobi rotations, both 5 × 5.
//!
//! Written out here because a node needs exactly these two and nothing else, in scalar code with a fixed order of
//! operations. Sources: Golub, Van Loan, *Matrix Computations*, 4.1.2 and 8.5 (cyclic-by-row Jacobi).

use crate::lanes::Real;

/// A symmetric 5 × 5 matrix, both triangles filled.
pub(crate) type Matrix5<T> = [[T; 5]; 5];

/// Inverse of the leading `N` × `N` block of a symmetric positive definite matrix; the rest of the result is zero.
///
/// False when a pivot falls below `1e-12` of its diagonal entry in any lane: the matrix is numerically singular, and
/// what comes with it is worthless.
#[inline(always)]
pub(crate) fn invert<T: Real, const N: usize>(m: &Matrix5<T>) -> (Matrix5<T>, bool) {
    // m = L D Lᵀ with unit L; `w` = D Lᵀ while it is built.
    let (zero, one) = (T::splat(0.0), T::splat(1.0));
    let mut l = [[zero; 5]; 5];
    let mut w = [[zero; 5]; 5];
    let mut inverse_pivot = [zero; 5];
    let mut is_regular = true;
    for i in 0..N {
        for j in 0..i {
            let mut sum = m[i][j];
            for k in 0..j {
                sum -= w[i][k] * l[j][k];
            }
            w[i][j] = sum;
            l[i][j] = sum * inverse_pivot[j];
        }
        let mut pivot = m[i][i];
        for k in 0..i {
            pivot -= w[i][k] * l[i][k];
        }
        // Written so that NaN fails too; a zero matrix fails because zero is not less than zero.
        is_regular &= T::all((T::splat(1e-12) * m[i][i]).less(pivot));
        inverse_pivot[i] = one / pivot;
    }
    // k = L⁻¹, unit lower triangular.
    let mut k = [[zero; 5]; 5];
    for i in 0..N {
        k[i][i] = one;
        for j in (0..i).rev() {
            let mut sum = -l[i][j];
            for p in j + 1..i {
                sum -= l[i][p] * k[p][j];
            }
            k[i][j] = sum;
        }
    }
    let mut inverse = [[zero; 5]; 5];
    for i in 0..N {
        for j in 0..=i {
            // k[i][i] is one.
            let mut sum = inverse_pivot[i] * k[i][j];
            for p in i + 1..N {
                sum += k[p][i] * inverse_pivot[p] * k[p][j];
            }
            inverse[i][j] = sum;
            inverse[j][i] = sum;
        }
    }
    (inverse, is_regular)
}

/// Eigenvalues and eigenvectors (as columns) of a symmetric matrix.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eigen {
    pub(crate) values: [f64; 5],
    pub(crate) vectors: Matrix5<f64>,
}

/// Cyclic Jacobi. Sweeps until the off-diagonal part is negligible, at most 12 times (it converges quadratically).
pub(crate) fn eigen(m: &Matrix5<f64>) -> Eigen {
    let mut a = *m;
    let mut v = [[0.0; 5]; 5];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for _ in 0..12 {
        let mut off = 0.0;
        let mut scale = 0.0;
        for i in 0..5 {
            scale += a[i][i] * a[i][i];
            for j in 0..i {
                off += a[i][j] * a[i][j];
            }
        }
        if off <= 1e-32 * scale {
            break;
        }
        for p in 0..4 {
            for q in p + 1..5 {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    Eigen { values: [a[0][0], a[1][1], a[2][2], a[3][3], a[4][4]], vectors: v }
}

/// One Jacobi rotation in the plane (p, q) that makes `a[p][q]` zero.
fn rotate(a: &mut Matrix5<f64>, v: &mut Matrix5<f64>, p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = if tau >= 0.0 { 1.0 } else { -1.0 } / (tau.abs() + (1.0 + tau * tau).sqrt());
    let c = 1.0 / (1.0 + t * t).sqrt();
    let s = t * c;
    for row in a.iter_mut() {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
    for k in 0..5 {
        (a[p][k], a[q][k]) = (c * a[p][k] - s * a[q][k], s * a[p][k] + c * a[q][k]);
    }
    a[p][q] = 0.0;
    a[q][p] = 0.0;
    for row in v.iter_mut() {
        (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
    }
}

impl Eigen {
    /// The symmetric matrix `V g(Λ) Vᵀ`.
    pub(crate) fn map(&self, g: impl Fn(f64) -> f64) -> Matrix5<f64> {
        let scaled = self.values.map(g);
        let v = &self.vectors;
        let mut result = [[0.0; 5]; 5];
        for i in 0..5 {
            for j in 0..=i {
                let mut sum = 0.0;
                for k in 0..5 {
                    sum += v[i][k] * scaled[k] * v[j][k];
                }
                result[i][j] = sum;
                result[j][i] = sum;
            }
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn sample() -> Matrix5<f64> {
        let rows = [[1.0, 0.3, -0.2], [0.2, -1.1, 0.4], [0.9, 0.8, 0.7], [-0.5, 0.6, 1.2], [0.3, 0.1, -0.9]];
        let mut m = [[0.0; 5]; 5];
        for i in 0..5 {
            for j in 0..5 {
                m[i][j] = (0..3).map(|k| rows[i][k] * rows[j][k]).sum::<f64>();
            }
            m[i][i] += 0.1 * (i as f64 + 1.0);
        }
        m
    }

    fn product(a: &Matrix5<f64>, b: &Matrix5<f64>) -> Matrix5<f64> {
        let mut c = [[0.0; 5]; 5];
        for i in 0..5 {
            for j in 0..5 {
                c[i][j] = (0..5).map(|k| a[i][k] * b[k][j]).sum();
            }
        }
        c
    }

    fn assert_identity(m: &Matrix5<f64>, size: usize) {
        for (i, row) in m.iter().enumerate().take(size) {
            for (j, &entry) in row.iter().enumerate().take(size) {
                let expected = if i == j { 1.0 } else { 0.0 };
                assert!((entry - expected).abs() < 1e-12, "[{i}][{j}] = {entry}");
            }
        }
    }

    fn regular((inverse, is_regular): (Matrix5<f64>, bool)) -> Matrix5<f64> {
        assert!(is_regular);
        inverse
    }

    #[test]
    fn inverse_times_matrix_is_identity() {
        let m = sample();
        assert_identity(&product(&regular(invert::<f64, 5>(&m)), &m), 5);
        assert_identity(&product(&regular(invert::<f64, 3>(&m)), &m), 3);
    }

    #[test]
    fn singular_matrix_is_refused() {
        let mut m = sample();
        m[4] = m[3];
        for row in &mut m {
            row[4] = row[3];
        }
        assert!(!invert::<f64, 5>(&m).1);
        m[0][0] = f64::NAN;
        assert!(!invert::<f64, 5>(&m).1);
    }

    #[test]
    fn eigen_decomposition_rebuilds_matrix_and_inverse() {
        let m = sample();
        let eigen = eigen(&m);
        let rebuilt = eigen.map(|value| value);
        let inverse = eigen.map(|value| 1.0 / value);
        for i in 0..5 {
            for j in 0..5 {
                assert!((rebuilt[i][j] - m[i][j]).abs() < 1e-13);
            }
        }
        assert_identity(&product(&inverse, &m), 5);
    }
}
