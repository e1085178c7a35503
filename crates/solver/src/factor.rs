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
//! The symbolic factor is kept while the pattern is unchanged; only numbers are refreshed. The triangular solves are
//! our own ([`Blocks`]).

use std::sync::Arc;

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, SymbolicCholesky, SymbolicCholeskyRaw, SymmetricOrdering,
    factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMat};
use faer::{Par, Side};
use thiserror::Error;

use crate::blocks::Blocks;

/// The matrix could not be factorised: not positive definite, or too large for 32-bit indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the matrix could not be factorised")]
pub struct FactorError;

/// A factorisation whose pattern is fixed. The pattern is the upper triangle by columns, diagonal included.
pub(crate) struct Cholesky {
    pattern: SymbolicSparseColMat<u32>,
    symbolic: Arc<SymbolicCholesky<u32>>,
    blocks: Blocks,
    /// Per place in the factor's order the unknown that sits there.
    order: Arc<[u32]>,
    ordered: Vec<f64>,
}

impl std::fmt::Debug for Cholesky {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Cholesky").field("entries", &self.symbolic.len_val()).finish_non_exhaustive()
    }
}

impl Clone for Cholesky {
    fn clone(&self) -> Self {
        Self {
            pattern: self.pattern.clone(),
            symbolic: Arc::clone(&self.symbolic),
            blocks: self.blocks.clone(),
            order: Arc::clone(&self.order),
            ordered: self.ordered.clone(),
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
        let SymbolicCholeskyRaw::Simplicial(columns) = symbolic.raw() else {
            return Err(FactorError); // forced above
        };
        let blocks = Blocks::new(columns.col_ptr(), columns.row_idx());
        let order = symbolic.perm().ok_or(FactorError)?.arrays().0.into();
        let ordered = vec![0.0; size];
        Ok(Self { pattern, symbolic: Arc::new(symbolic), blocks, order, ordered })
    }

    /// Refreshes the numbers; `values` are parallel to the rows of the pattern.
    pub(crate) fn refactor(&mut self, values: &[f64]) -> Result<(), FactorError> {
        let matrix = SparseColMatRef::new(self.pattern.as_ref(), values);
        // The blocks take the numbers over, and they are many: nothing keeps them in between.
        let mut factor = vec![0.0; self.symbolic.len_val()];
        let mut scratch = MemBuffer::new(scratch_size(&self.symbolic));
        self.symbolic
            .factorize_numeric_llt(
                &mut factor,
                matrix,
                Side::Upper,
                LltRegularization::default(),
                Par::Seq,
                MemStack::new(&mut scratch),
                faer::Spec::default(),
            )
            .map_err(|_| FactorError)?;
        if let SymbolicCholeskyRaw::Simplicial(columns) = self.symbolic.raw() {
            self.blocks.refresh(&factor, columns.col_ptr(), columns.row_idx());
        }
        Ok(())
    }

    /// Overwrites `x` with `A⁻¹ x`; several right-hand sides follow one another.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        for column in x.chunks_exact_mut(self.order.len().max(1)) {
            self.take(column);
            self.blocks.solve(&mut self.ordered);
            self.give(column);
        }
    }

    /// `z = A⁻¹ M A⁻¹ r` with a diagonal `M`, given in the factor's order (see [`Self::ordered`]).
    pub(crate) fn solve_around(&mut self, diagonal: &[f64], r: &[f64], z: &mut [f64]) {
        self.take(r);
        self.blocks.solve(&mut self.ordered);
        for (value, factor) in self.ordered.iter_mut().zip(diagonal) {
            *value *= factor;
        }
        self.blocks.solve(&mut self.ordered);
        self.give(z);
    }

    /// Overwrites `x` with `A⁻¹ M x` for a diagonal `M` in the factor's order.
    pub(crate) fn solve_after(&mut self, diagonal: &[f64], x: &mut [f64]) {
        self.take(x);
        for (value, factor) in self.ordered.iter_mut().zip(diagonal) {
            *value *= factor;
        }
        self.blocks.solve(&mut self.ordered);
        self.give(x);
    }

    /// One number per unknown, brought into the factor's order.
    pub(crate) fn ordered(&self, x: &[f64]) -> Vec<f64> {
        self.order.iter().map(|&unknown| x[unknown as usize]).collect()
    }

    fn take(&mut self, x: &[f64]) {
        for (value, &unknown) in self.ordered.iter_mut().zip(&*self.order) {
            *value = x[unknown as usize];
        }
    }

    fn give(&self, x: &mut [f64]) {
        for (&value, &unknown) in self.ordered.iter().zip(&*self.order) {
            x[unknown as usize] = value;
        }
    }
}

fn scratch_size(symbolic: &SymbolicCholesky<u32>) -> StackReq {
    symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, faer::Spec::default())
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
