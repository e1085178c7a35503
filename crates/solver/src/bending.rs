//! The curvature rows as an operator: how normal offsets bend every neighbourhood, and the transpose.
//!
//! Source: recipe section 4. The same rows that the assembly multiplies out,
//! `Σ_j √a Z_cj (s_kj alpha_j - alpha_k) + √a (L²)_c alpha_k`, for objectives whose matrix is too wide to be assembled.

use crate::fits::Fits;
use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

/// The rows of all nodes over the unknowns.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bending<'a> {
    pub(crate) rings: &'a Rings,
    pub(crate) fits: &'a Fits,
    pub(crate) unknowns: &'a Unknowns,
    /// Whether an offset of a node bends its own neighbourhood by `L²`.
    pub(crate) has_squares: bool,
}

impl Bending<'_> {
    /// `bends = rows x`, per node; times the root of the node's area.
    pub(crate) fn apply(&self, x: &[f64], bends: &mut [[f64; 3]]) {
        let value = |node: usize| match self.unknowns.index[node] {
            FIXED => 0.0,
            index => x[index as usize],
        };
        for batch in self.rings.batches() {
            let rows = &self.fits.rows[batch.rows()];
            for lane in 0..batch.count {
                let node = batch.nodes[lane] as usize;
                let here = value(node);
                let mut bend = if self.has_squares { rows[0].map(|row| row[lane] * here) } else { [0.0; 3] };
                let spokes = self.rings.ring(node).iter().zip(self.rings.senses(node));
                for ((&far, sense), row) in spokes.zip(&rows[1..]) {
                    let offset = sense * value(far as usize) - here;
                    for c in 0..3 {
                        bend[c] += row[c][lane] * offset;
                    }
                }
                bends[node] = bend;
            }
        }
    }

    /// `y += rowsᵀ prices`.
    pub(crate) fn add_transpose(&self, prices: &[[f64; 3]], y: &mut [f64]) {
        let mut add = |node: usize, value: f64| {
            if self.unknowns.index[node] != FIXED {
                y[self.unknowns.index[node] as usize] += value;
            }
        };
        let dot = |row: &[[f64; 2]; 3], lane: usize, price: &[f64; 3]| {
            row[0][lane] * price[0] + row[1][lane] * price[1] + row[2][lane] * price[2]
        };
        for batch in self.rings.batches() {
            let rows = &self.fits.rows[batch.rows()];
            for lane in 0..batch.count {
                let node = batch.nodes[lane] as usize;
                let price = &prices[node];
                let mut here = if self.has_squares { dot(&rows[0], lane, price) } else { 0.0 };
                let spokes = self.rings.ring(node).iter().zip(self.rings.senses(node));
                for ((&far, sense), row) in spokes.zip(&rows[1..]) {
                    let pull = dot(row, lane, price);
                    add(far as usize, sense * pull);
                    here -= pull;
                }
                add(node, here);
            }
        }
    }
}
