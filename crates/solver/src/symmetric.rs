//! A sparse symmetric positive definite system from its entries: factorised once, solved often.
//!
//! This is the door to the factorisation for the layers above: they bring entries in any order, and know nothing of
//! patterns, orderings or the library below. Entries of the same place are summed in the order in which they come, so
//! the bits depend on nothing else.

use crate::factor::{Cholesky, FactorError};

/// The factor `P A Pᵀ = L Lᵀ` of a symmetric positive definite matrix.
///
/// ```
/// use ductile_solver::SymmetricFactor;
/// // [ 4 1 ]       [ 6 ]            [ 1 ]
/// // [ 1 3 ] x  =  [ 7 ]   has  x = [ 2 ]
/// let mut factor = SymmetricFactor::new(2, &[(0, 0, 4.0), (0, 1, 1.0), (1, 1, 3.0)]).unwrap();
/// let mut x = [6.0, 7.0];
/// factor.solve(&mut x);
/// assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 2.0).abs() < 1e-15);
/// ```
#[derive(Clone, Debug)]
pub struct SymmetricFactor {
    cholesky: Cholesky,
    size: usize,
}

impl SymmetricFactor {
    /// Factorises the matrix of `size` unknowns with these entries `(row, column, value)`. Of each pair of mirrored
    /// entries one is given, on whichever side; entries of one place are summed.
    ///
    /// # Errors
    /// The matrix is not positive definite, an entry lies outside of it or is not finite, or it is too large for 32-bit
    /// indices.
    pub fn new(size: usize, entries: &[(usize, usize, f64)]) -> Result<Self, FactorError> {
        let limit = u32::try_from(size).map_err(|_| FactorError)?;
        let mut sorted = Vec::with_capacity(entries.len());
        for &(row, column, value) in entries {
            let (row, column) = (row.min(column), row.max(column));
            if column >= size || !value.is_finite() {
                return Err(FactorError);
            }
            sorted.push((
                u32::try_from(column).map_err(|_| FactorError)?,
                u32::try_from(row).map_err(|_| FactorError)?,
                value,
            ));
        }
        sorted.sort_by_key(|&(column, row, _)| (column, row));
        let (mut starts, mut rows, mut values) = (vec![0_u32; size + 1], Vec::new(), Vec::<f64>::new());
        let mut before = None;
        for (column, row, value) in sorted {
            if before == Some((column, row)) {
                if let Some(last) = values.last_mut() {
                    *last += value;
                }
                continue;
            }
            before = Some((column, row));
            starts[column as usize + 1] += 1;
            rows.push(row);
            values.push(value);
        }
        for column in 0..size {
            starts[column + 1] += starts[column];
        }
        let has_diagonal = |column: u32| {
            let range = starts[column as usize] as usize..starts[column as usize + 1] as usize;
            rows[range].last() == Some(&column)
        };
        if !(0..limit).all(has_diagonal) {
            return Err(FactorError);
        }
        let mut cholesky = Cholesky::new(starts, rows)?;
        cholesky.refactor(&values)?;
        Ok(Self { cholesky, size })
    }

    /// Number of unknowns.
    #[must_use]
    pub fn size(&self) -> usize {
        self.size
    }

    /// Overwrites `x` with `A⁻¹ x`; several right-hand sides follow one another, each of [`Self::size`] numbers.
    pub fn solve(&mut self, x: &mut [f64]) {
        self.cholesky.solve(x);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn entries_come_in_any_order_and_add_up() {
        let size = 20;
        let mut entries = Vec::new();
        for i in (0..size).rev() {
            entries.push((i, i, 1.5));
            if i > 0 {
                // now below the diagonal, now above it
                let (row, column) = if i % 2 == 0 { (i, i - 1) } else { (i - 1, i) };
                entries.push((row, column, -1.0));
            }
            entries.push((i, i, 0.5));
        }
        let mut factor = SymmetricFactor::new(size, &entries).unwrap();
        let mut x = vec![1.0; 2 * size];
        factor.solve(&mut x);
        for (i, &value) in x.iter().enumerate() {
            let i = (i % size) as f64;
            let exact = 0.5 * (i + 1.0) * (size as f64 - i);
            assert!((value - exact).abs() < 1e-10, "{i}: {value}");
        }
    }

    #[test]
    fn refuses_what_is_no_such_matrix() {
        let bad: [&[(usize, usize, f64)]; 5] = [
            &[(0, 0, 1.0)],
            &[(0, 0, 1.0), (1, 1, -1.0)],
            &[(0, 0, 1.0), (0, 1, 2.0), (1, 1, 1.0)],
            &[(0, 0, 1.0), (1, 1, 1.0), (2, 0, 1.0)],
            &[(0, 0, f64::NAN), (1, 1, 1.0)],
        ];
        for entries in bad {
            assert_eq!(SymmetricFactor::new(2, entries).err(), Some(FactorError), "{entries:?}");
        }
        assert_eq!(SymmetricFactor::new(0, &[]).unwrap().size(), 0);
    }
}
