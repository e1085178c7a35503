//! Sparse Cholesky factorisation `P A Pᵀ = L Lᵀ` with an approximate-minimum-degree ordering, by the library `faer`.
//!
//! Why `faer`, and why only this part of it: its *simplicial* code (symbolic analysis, up-looking numeric factor,
//! triangular solves, AMD) is plain scalar arithmetic in a fixed order: multiply, subtract, one reciprocal and one
//! square root a column. It never reaches `pulp` (run-time choice of vector instructions) nor a fused multiply-add;
//! those live in its dense and supernodal code. So the simplicial path is forced below and gives the same bits
//! native and in wasm32; `tests/bits.rs` proves it on both. Indices are `u32` on every target, because the ordering
//! hashes them and must not see the width of a pointer. Looked at and not taken: `sprs-ldl` (licence), the solver
//! inside `clarabel` (an interior-point package for the sake of one module).
//!
//! The symbolic factor is kept while the pattern is unchanged; only numbers are refreshed.

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};
use thiserror::Error;

/// The matrix could not be factorised: not positive definite, or too large for 32-bit indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the matrix could not be factorised")]
pub struct FactorError;

/// A factorisation whose pattern is fixed. The pattern is the upper triangle by columns, diagonal included.
pub(crate) struct Cholesky {
    pattern: SymbolicSparseColMat<u32>,
    symbolic: Arc<SymbolicCholesky<u32>>,
    factor: Vec<f64>,
    scratch: MemBuffer,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky").field("entries", &self.factor.len()).finish_non_exhaustive()
    }
}

impl Clone for Cholesky {
    fn clone(&self) -> Self {
        Self {
            pattern: self.pattern.clone(),
            symbolic: Arc::clone(&self.symbolic),
            factor: self.factor.clone(),
            scratch: MemBuffer::new(scratch_size(&self.symbolic)),
        }
    }
}

impl Cholesky {
    /// Orders and analyses a pattern: column `j` has the rows `rows[starts[j]..starts[j + 1]]`, all `<= j`.
    pub(crate) fn new(starts: Vec<u32>, rows: Vec<u32>) -> Result<Self, FactorError> {
        let size = starts.len() - 1;
        let pattern = SymbolicSparseColMat::new_checked(size, size, starts, None, rows);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SIMPLICIAL,
            ..CholeskySymbolicParams::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern.as_ref(), Side::Upper, SymmetricOrdering::Amd, params)
                .map_err(|_| FactorError)?;
        let factor = vec![0.0; symbolic.len_val()];
        let scratch = MemBuffer::new(scratch_size(&symbolic));
        Ok(Self { pattern, symbolic: Arc::new(symbolic), factor, scratch })
    }

    /// Refreshes the numbers; `values` are parallel to the rows of the pattern.
    pub(crate) fn refactor(&mut self, values: &[f64]) -> Result<(), FactorError> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                matrix,
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut self.scratch),
                faer::Spec::default(),
            )
            .map(|_| ())
            .map_err(|_| FactorError)
    }

    /// Overwrites `x` with `A⁻¹ x`; several right-hand sides follow one another.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        let size = self.symbolic.nrows();
        if size == 0 {
            return;
        }
        let stack = MemStack::new(&mut self.scratch);
        let solver = LltRef::new(&self.symbolic, &self.factor);
        for column in x.chunks_exact_mut(size) {
            let column = MatMut::from_column_major_slice_mut(column, size, 1);
            solver.solve_in_place_with_conj(Conj::No, column, Par::Seq, stack);
        }
    }
}

fn scratch_size(symbolic: &SymbolicCholesky<u32>) -> StackReq {
    StackReq::any_of(&[
        symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, faer::Spec::default()),
        symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn solves_a_chain() {
        // tridiag(-1, 2, -1), upper triangle by columns
        let size = 30_u32;
        let (mut starts, mut rows, mut values) = (vec![0], vec![], vec![]);
        for j in 0..size {
            if j > 0 {
                rows.push(j - 1);
                values.push(-1.0);
            }
            rows.push(j);
            values.push(2.0);
            starts.push(u32::try_from(rows.len()).unwrap());
        }
        let mut cholesky = Cholesky::new(starts, rows).unwrap();
        cholesky.refactor(&values).unwrap();
        let mut x = vec![1.0; 30];
        cholesky.solve(&mut x);
        for (i, &value) in x.iter().enumerate() {
            let exact = 0.5 * (i as f64 + 1.0) * (30.0 - i as f64);
            assert!((value - exact).abs() < 1e-10);
        }
        for value in &mut values {
            *value = -*value;
        }
        assert_eq!(cholesky.refactor(&values), Err(FactorError));
    }

    #[test]
    fn accepts_the_empty_matrix() {
        let mut cholesky = Cholesky::new(vec![0], vec![]).unwrap();
        cholesky.refactor(&[]).unwrap();
        cholesky.solve(&mut []);
    }
}
