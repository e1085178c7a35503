//! Nodes in twos: which nodes are fitted side by side.
//!
//! Two nodes can share every instruction when they have the same degree and both lie inside or both on the boundary.
//! Each node is paired with the next such node, so partners lie near each other in memory; what is left over at the
//! end stands alone.

use std::ops::Range;

/// Two nodes of the same kind, or one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Batch {
    /// The second repeats the first when there is only one.
    pub(crate) nodes: [u32; 2],
    /// 1 or 2.
    pub(crate) count: usize,
    pub(crate) degree: usize,
    pub(crate) is_boundary: bool,
    /// Where its rows begin, in an array with `degree + 1` entries for each batch.
    row: u32,
    /// Where its pairs of rows begin, in an array with one entry for each of them and batch.
    pair: u32,
}

impl Batch {
    /// Its rows: the centre first, then the neighbours.
    #[inline]
    pub(crate) fn rows(&self) -> Range<usize> {
        self.row as usize..self.row as usize + self.degree + 1
    }

    /// The lower triangle of its rows' products, by rows.
    #[inline]
    pub(crate) fn pairs(&self) -> Range<usize> {
        self.pair as usize..self.pair as usize + (self.degree + 1) * (self.degree + 2) / 2
    }

    /// Whether a quadratic can be fitted at all, with the plain method.
    #[inline]
    pub(crate) fn is_regular(&self) -> bool {
        self.degree > 2
    }
}

/// Pairs nodes given as `(degree, is_boundary)`, in their order.
#[expect(
    clippy::cast_possible_truncation,
    reason = "nodes, and pairs of at most 325 a node, are counted by u32"
)]
pub(crate) fn pair(nodes: impl Iterator<Item = (usize, bool)>) -> Vec<Batch> {
    let mut batches: Vec<Batch> = Vec::new();
    // Per kind the batch that still has room.
    let mut open: Vec<Option<usize>> = Vec::new();
    for (node, (degree, is_boundary)) in (0_u32..).zip(nodes) {
        let kind = 2 * degree + usize::from(is_boundary);
        if open.len() <= kind {
            open.resize(kind + 1, None);
        }
        match open[kind].take() {
            Some(index) => {
                batches[index].nodes[1] = node;
                batches[index].count = 2;
            }
            None => {
                open[kind] = Some(batches.len());
                batches.push(Batch { nodes: [node; 2], count: 1, degree, is_boundary, row: 0, pair: 0 });
            }
        }
    }
    let (mut row, mut pair) = (0, 0);
    for batch in &mut batches {
        (batch.row, batch.pair) = (row, pair);
        row += batch.degree as u32 + 1;
        pair += ((batch.degree + 1) * (batch.degree + 2) / 2) as u32;
    }
    batches
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn neighbours_of_a_kind_are_paired_and_nobody_is_lost() {
        let kinds = [(6, false), (5, false), (6, false), (4, true), (6, false), (6, true), (4, true)];
        let batches = pair(kinds.into_iter());
        let nodes: Vec<_> = batches.iter().map(|batch| (batch.nodes, batch.count)).collect();
        assert_eq!(nodes, [([0, 2], 2), ([1, 1], 1), ([3, 6], 2), ([4, 4], 1), ([5, 5], 1)]);
        assert_eq!(batches[1].rows(), 7..13);
        assert_eq!(batches[1].pairs(), 28..49);
    }
}
