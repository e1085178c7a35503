//! A sparse triangular factor laid out for being solved with: columns of like pattern stand side by side in blocks.
//!
//! The preconditioner solves with the same factor dozens of times for each time it is computed, so the solves are what
//! counts. A column whose rows below the diagonal begin with the next column, and go on like it, shares a block with
//! it: one row index then serves up to eight entries, which lie side by side and are worked on in vector registers.
//! Places that only one of the columns has are padded with zeros where that pays. The blocks are chosen once for a
//! pattern, by the cheapest way from the last column to the first under a simple price for rows and entries.
//!
//! The order of operations depends on the pattern alone, so the bits are the same everywhere.

use crate::lanes::Pair;

/// Widths that the loops below are made for.
const WIDTHS: [usize; 4] = [1, 2, 4, 8];
/// Price of a row of a block, beside that of its entries.
const ROW_PRICE: usize = 4;

/// Up to eight neighbouring columns.
#[derive(Clone, Copy, Debug)]
struct Block {
    first: u32,
    width: u32,
    /// Where its row indices begin.
    row: u32,
    /// Where its values begin: the triangle by rows (with the inverse of the diagonal), then the rows below.
    value: u32,
}

/// The factor in blocks.
#[derive(Clone, Debug, Default)]
pub(crate) struct Blocks {
    blocks: Vec<Block>,
    rows: Vec<u32>,
    values: Vec<f64>,
}

impl Blocks {
    /// Lays out a pattern by columns: `rows[starts[j]..starts[j + 1]]` ascend and begin with the diagonal `j`.
    #[expect(clippy::cast_possible_truncation, reason = "the factor's entries are counted by u32")]
    pub(crate) fn new(starts: &[u32], rows: &[u32]) -> Self {
        let size = starts.len().saturating_sub(1);
        let below = |column: usize| &rows[starts[column] as usize + 1..starts[column + 1] as usize];
        let widths = widths(size, |column| (below(column).len(), below(column).first().copied()));
        let mut layout = Self::default();
        let (mut first, mut values) = (0, 0);
        while first < size {
            let width = widths[first];
            let shared = below(first + width - 1);
            layout.blocks.push(Block {
                first: first as u32,
                width: width as u32,
                row: layout.rows.len() as u32,
                value: values as u32,
            });
            values += width * (width + 1) / 2 + width * shared.len();
            layout.rows.extend_from_slice(shared);
            first += width;
        }
        layout.values = vec![0.0; values];
        // They stay as they are for as long as the mesh does.
        layout.rows.shrink_to_fit();
        layout.blocks.shrink_to_fit();
        layout
    }

    /// Takes over the numbers of a factor with this pattern, the one that they were laid out for.
    pub(crate) fn refresh(&mut self, factor: &[f64], starts: &[u32], rows: &[u32]) {
        // Columns of a block that lack a row have zeros there.
        self.values.fill(0.0);
        for (index, block) in self.blocks.iter().enumerate() {
            let end = self.blocks.get(index + 1).map_or(self.rows.len(), |next| next.row as usize);
            let shared = &self.rows[block.row as usize..end];
            let (first, width) = (block.first as usize, block.width as usize);
            for column in 0..width {
                let from = starts[first + column] as usize..starts[first + column + 1] as usize;
                let shape = Shape { first, width, column, shared };
                lay(&mut self.values[block.value as usize..], (&factor[from.clone()], &rows[from]), shape);
            }
        }
        for block in &self.blocks {
            let mut diagonal = block.value as usize;
            for row in 0..block.width as usize {
                self.values[diagonal] = 1.0 / self.values[diagonal];
                diagonal += row + 2;
            }
        }
    }

    /// Overwrites `x` with `L⁻ᵀ L⁻¹ x`.
    pub(crate) fn solve(&self, x: &mut [f64]) {
        for index in 0..self.blocks.len() {
            match self.blocks[index].width {
                1 => self.forward::<1>(index, x),
                2 => self.forward::<2>(index, x),
                4 => self.forward::<4>(index, x),
                _ => self.forward::<8>(index, x),
            }
        }
        for index in (0..self.blocks.len()).rev() {
            match self.blocks[index].width {
                1 => self.backward::<1>(index, x),
                2 => self.backward::<2>(index, x),
                4 => self.backward::<4>(index, x),
                _ => self.backward::<8>(index, x),
            }
        }
    }

    /// First unknown, rows below, triangle, values below.
    #[inline(always)]
    fn parts<const W: usize>(&self, index: usize) -> (usize, &[u32], &[f64], &[[f64; W]]) {
        let block = self.blocks[index];
        let (row, value) = match self.blocks.get(index + 1) {
            Some(next) => (next.row as usize, next.value as usize),
            None => (self.rows.len(), self.values.len()),
        };
        let (triangle, below) = self.values[block.value as usize..value].split_at(W * (W + 1) / 2);
        (block.first as usize, &self.rows[block.row as usize..row], triangle, below.as_chunks().0)
    }

    #[inline(always)]
    fn forward<const W: usize>(&self, index: usize, x: &mut [f64]) {
        let (first, rows, triangle, below) = self.parts::<W>(index);
        let mut mine = [0.0; W];
        mine.copy_from_slice(&x[first..first + W]);
        let mut place = 0;
        for i in 0..W {
            let mut sum = mine[i];
            for k in 0..i {
                sum -= triangle[place + k] * mine[k];
            }
            mine[i] = sum * triangle[place + i];
            place += i + 1;
        }
        x[first..first + W].copy_from_slice(&mine);
        for (&row, entries) in rows.iter().zip(below) {
            x[row as usize] -= dot(entries, &mine);
        }
    }

    #[inline(always)]
    fn backward<const W: usize>(&self, index: usize, x: &mut [f64]) {
        let (first, rows, triangle, below) = self.parts::<W>(index);
        let mut mine = [0.0; W];
        mine.copy_from_slice(&x[first..first + W]);
        for (&row, entries) in rows.iter().zip(below) {
            subtract(&mut mine, entries, x[row as usize]);
        }
        let mut place = triangle.len();
        for i in (0..W).rev() {
            place -= i + 1;
            mine[i] *= triangle[place + i];
            let value = mine[i];
            for k in 0..i {
                mine[k] -= triangle[place + k] * value;
            }
        }
        x[first..first + W].copy_from_slice(&mine);
    }
}

#[inline(always)]
fn dot<const W: usize>(a: &[f64; W], b: &[f64; W]) -> f64 {
    if W == 1 {
        return a[0] * b[0];
    }
    let mut sum = Pair::new([a[0], a[1]]) * Pair::new([b[0], b[1]]);
    for k in 1..W / 2 {
        sum += Pair::new([a[2 * k], a[2 * k + 1]]) * Pair::new([b[2 * k], b[2 * k + 1]]);
    }
    let [even, odd] = sum.to_array();
    even + odd
}

/// `a -= b x`
#[inline(always)]
fn subtract<const W: usize>(a: &mut [f64; W], b: &[f64; W], x: f64) {
    for k in 0..W {
        a[k] -= b[k] * x;
    }
}

/// A column of a block.
struct Shape<'a> {
    first: usize,
    width: usize,
    column: usize,
    /// The rows below the block's triangle.
    shared: &'a [u32],
}

/// Enters where the values of a column come from; what it does not have stays padding.
fn lay(values: &mut [f64], (numbers, rows): (&[f64], &[u32]), shape: Shape<'_>) {
    let Shape { first, width, column, shared } = shape;
    let below = width * (width + 1) / 2;
    let inside = (column..width).map(|row| (first + row, row * (row + 1) / 2 + column));
    let beneath =
        shared.iter().enumerate().map(|(index, &row)| (row as usize, below + index * width + column));
    // Without gaps the entries follow one another.
    if numbers.len() == width - column + shared.len() {
        numbers.iter().zip(inside.chain(beneath)).for_each(|(number, (_, place))| values[place] = *number);
        return;
    }
    let mut own = numbers.iter().zip(rows).peekable();
    for (row, place) in inside.chain(beneath) {
        if let Some((number, _)) = own.next_if(|&(_, &own_row)| own_row as usize == row) {
            values[place] = *number;
        }
    }
}

/// How wide the block should be that begins at each column, if one begins there.
///
/// `column` gives the number of rows below the diagonal and the first of them.
fn widths(size: usize, column: impl Fn(usize) -> (usize, Option<u32>)) -> Vec<usize> {
    let mut widths = vec![1; size];
    // Price of everything from a column on.
    let mut prices = vec![0_usize; size + 1];
    for first in (0..size).rev() {
        let mut best = usize::MAX;
        for width in WIDTHS {
            let last = first + width - 1;
            // A longer block begins with a shorter one.
            let is_chain = last < size
                && (first..last).all(|here| column(here).1.is_some_and(|next| next as usize == here + 1));
            if !is_chain {
                break;
            }
            let price =
                column(last).0 * (ROW_PRICE + width) + width * (ROW_PRICE + width / 2) + prices[last + 1];
            if price < best {
                best = price;
                widths[first] = width;
            }
        }
        prices[first] = best;
    }
    widths
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload::Stream;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Pattern and numbers of a factor: fill of a random sparse matrix, so that the rule of nested columns holds.
    fn factor(size: usize, seed: u64) -> (Vec<u32>, Vec<u32>, Vec<f64>) {
        let mut stream = Stream::new(seed);
        let mut full = vec![vec![false; size]; size];
        for (row, entries) in full.iter_mut().enumerate() {
            for entry in entries.iter_mut().take(row) {
                *entry = stream.unit() < 0.08;
            }
            entries[row] = true;
        }
        for column in 0..size {
            let rows: Vec<usize> = (column + 1..size).filter(|&row| full[row][column]).collect();
            for (index, &low) in rows.iter().enumerate() {
                for &high in &rows[index..] {
                    full[high][low] = true;
                }
            }
        }
        let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
        for column in 0..size {
            for row in (column..size).filter(|&row| full[row][column]) {
                rows.push(u32::try_from(row).unwrap());
                values.push(if row == column { 2.0 + stream.unit() } else { stream.unit() - 0.5 });
            }
            starts.push(u32::try_from(rows.len()).unwrap());
        }
        (starts, rows, values)
    }

    #[test]
    fn solves_as_the_plain_columns_do() {
        for (size, seed) in [(0, 1), (1, 2), (7, 3), (40, 4), (90, 5)] {
            let (starts, rows, values) = factor(size, seed);
            let mut blocks = Blocks::new(&starts, &rows);
            blocks.refresh(&values, &starts, &rows);
            let mut stream = Stream::new(seed);
            let right: Vec<f64> = (0..size).map(|_| stream.unit() - 0.5).collect();
            let mut x = right.clone();
            blocks.solve(&mut x);
            // L Lᵀ x = right
            let mut y = vec![0.0; size];
            for column in 0..size {
                for place in starts[column] as usize..starts[column + 1] as usize {
                    y[column] += values[place] * x[rows[place] as usize];
                }
            }
            let mut z = vec![0.0; size];
            for column in 0..size {
                for place in starts[column] as usize..starts[column + 1] as usize {
                    z[rows[place] as usize] += values[place] * y[column];
                }
            }
            assert!(z.iter().zip(&right).all(|(a, b)| (a - b).abs() < 1e-10), "{size}");
        }
    }

    #[test]
    fn every_entry_has_its_place() {
        let (starts, rows, _) = factor(60, 9);
        let mut blocks = Blocks::new(&starts, &rows);
        let numbers: Vec<f64> = (1..=rows.len()).map(|number| number as f64).collect();
        blocks.refresh(&numbers, &starts, &rows);
        // Of diagonals the inverse is kept; nothing stands where the factor has nothing.
        let number = |value: f64| if value < 1.0 { (1.0 / value).round() } else { value };
        let mut seen: Vec<f64> =
            blocks.values.iter().filter(|value| **value != 0.0).map(|v| number(*v)).collect();
        seen.sort_by(f64::total_cmp);
        assert_eq!(seen, numbers);
        assert!(blocks.blocks.iter().any(|block| block.width > 1), "dense ends make blocks");
    }
}
