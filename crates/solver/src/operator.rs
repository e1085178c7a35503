//! A symmetric sparse matrix of which the lower triangle is stored, and its product with a vector.
//!
//! Sign and kind: positive semi-definite, one row per free node. Values lie in one array so that an assembly can
//! scatter into it blindly: strict lower triangle by rows, then the diagonal, then one place for what belongs to
//! fixed nodes and is dropped.

/// Marks a node that is not an unknown.
pub(crate) const FIXED: u32 = u32::MAX;

/// The numbering of the free nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Unknowns {
    /// Per node its unknown, or [`FIXED`].
    pub(crate) index: Vec<u32>,
    /// Per unknown its node.
    pub(crate) nodes: Vec<u32>,
}

impl Unknowns {
    pub(crate) fn new(is_free: impl Iterator<Item = bool>) -> Self {
        let (mut index, mut nodes) = (Vec::new(), Vec::new());
        let (mut node, mut count) = (0, 0);
        for free in is_free {
            index.push(if free { count } else { FIXED });
            if free {
                nodes.push(node);
                count += 1;
            }
            node += 1;
        }
        Self { index, nodes }
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }
}

/// Lower triangle by rows, diagonal apart.
#[derive(Clone, Debug, Default)]
pub(crate) struct SymmetricMatrix {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl SymmetricMatrix {
    /// A matrix of zeros; row `i` has the columns `columns[starts[i]..starts[i + 1]]`, all `< i`.
    pub(crate) fn new(starts: Vec<u32>, columns: Vec<u32>) -> Self {
        let values = vec![0.0; columns.len() + starts.len()];
        Self { starts, columns, values }
    }

    pub(crate) fn size(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// All values, for scattering.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    pub(crate) fn diagonal_mut(&mut self) -> &mut [f64] {
        let (first, size) = (self.columns.len(), self.size());
        &mut self.values[first..first + size]
    }

    /// `y = A x`
    pub(crate) fn multiply(&self, x: &[f64], y: &mut [f64]) {
        let (lower, rest) = self.values.split_at(self.columns.len());
        for i in 0..self.size() {
            let range = self.starts[i] as usize..self.starts[i + 1] as usize;
            let x_i = x[i];
            let mut sum = rest[i] * x_i;
            for (&column, &value) in self.columns[range.clone()].iter().zip(&lower[range]) {
                sum += value * x[column as usize];
                y[column as usize] += value * x_i;
            }
            y[i] = sum;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn product_uses_both_triangles() {
        // [2 1 0; 1 3 4; 0 4 5]
        let mut a = SymmetricMatrix::new(vec![0, 0, 1, 2], vec![0, 1]);
        a.values_mut().copy_from_slice(&[1.0, 4.0, 2.0, 3.0, 5.0, 99.0]);
        let mut y = [f64::NAN; 3];
        a.multiply(&[1.0, 10.0, 100.0], &mut y);
        assert_eq!(y, [12.0, 431.0, 540.0]);
    }

    #[test]
    fn unknowns_skip_fixed_nodes() {
        let unknowns = Unknowns::new([true, false, true].into_iter());
        assert_eq!(unknowns.index, [0, FIXED, 1]);
        assert_eq!(unknowns.nodes, [0, 2]);
    }
}
