//! Small dense systems between feet: inverse by elimination with pivots, and the condition that goes with it.

/// The inverse of a square matrix, by rows; `None` when a pivot vanishes or something is not finite.
pub(super) fn inverse(matrix: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
    let size = matrix.len();
    let mut left = matrix.to_vec();
    let unit = |row: usize| (0..size).map(|column| f64::from(u8::from(row == column))).collect();
    let mut right: Vec<Vec<f64>> = (0..size).map(unit).collect();
    for column in 0..size {
        let pivot =
            (column..size).max_by(|&a, &b| left[a][column].abs().total_cmp(&left[b][column].abs()))?;
        left.swap(column, pivot);
        right.swap(column, pivot);
        let scale = 1.0 / left[column][column];
        if !scale.is_finite() {
            return None;
        }
        left[column].iter_mut().chain(&mut right[column]).for_each(|x| *x *= scale);
        for row in (0..size).filter(|&row| row != column) {
            let factor = left[row][column];
            for k in 0..size {
                left[row][k] -= factor * left[column][k];
                right[row][k] -= factor * right[column][k];
            }
        }
    }
    right.iter().flatten().all(|x| x.is_finite()).then_some(right)
}

/// The condition in the 1-norm, from a matrix and its inverse.
pub(super) fn condition(matrix: &[Vec<f64>], inverse: &[Vec<f64>]) -> f64 {
    norm(matrix) * norm(inverse)
}

fn norm(matrix: &[Vec<f64>]) -> f64 {
    let column = |k: usize| matrix.iter().map(|row| row[k].abs()).sum::<f64>();
    (0..matrix.len()).map(column).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn inverts_with_pivots_and_refuses_singular_matrices() {
        let matrix = vec![vec![0.0, 2.0], vec![4.0, 0.0]];
        let found = inverse(&matrix).unwrap();
        assert_eq!(found, [[0.0, 0.25], [0.5, 0.0]]);
        assert_eq!(condition(&matrix, &found), 2.0);
        assert!(inverse(&[vec![1.0, 2.0], vec![2.0, 4.0]]).is_none());
        assert!(inverse(&[vec![f64::NAN]]).is_none());
        assert!(inverse(&[]).unwrap().is_empty());
    }
}
