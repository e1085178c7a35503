//! Several displacements at once.
//!
//! Source: the recipe, section 9. `pairwise` is ours: with the conformal radius `ρ_j` of each foot,
//! `W_j = Π_k f(ρ_k / (ρ_j + ρ_k))`, divided by their sum, which is at least `2^(1-m)`. Every foot is met exactly, whatever
//! the order, and the sum of the weights is 1, so that nothing overshoots. `cardinal` is the paper's "modified harmonic
//! equation"; `gram` solves for the displacements whose plain sum meets all feet.

use super::blend::BlendFunction;
use super::dense;
use super::error::DisplacementError;

/// What is asked of a surface with several feet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Combination {
    /// Every foot and curve is met exactly; no equations.
    #[default]
    Pairwise,
    /// The paper's sum: a displacement moves its own foot by exactly what is asked, and other feet along with it.
    Plain,
    /// Every foot is met exactly by other displacements at the same blends; refused when feet are inside each other's
    /// plateau.
    Gram,
    /// Every foot is met exactly by harmonic functions that vanish at the other feet; depends on the mesh as the harmonic
    /// profile does.
    Cardinal,
}

/// Beyond this condition the displacements that `gram` finds are some thousand times what was asked.
pub(super) const GRAM_CONDITION: f64 = 1e6;
/// The sum of so many pairwise weights is far from the smallest number.
pub(super) const MOST_ITEMS: usize = 512;

/// One item for [`Pairwise`]: items in different parts of a surface do not see each other.
#[derive(Clone, Debug)]
pub(super) struct Seen<'a> {
    pub(super) part: u32,
    pub(super) vertices: &'a [usize],
    pub(super) rho: Vec<f64>,
}

/// The products `W_j` of all items at all vertices, not yet divided by their sum. One more item at the end costs its own pairs
/// alone and gives the same bits as all at once.
#[derive(Clone, Debug, Default)]
pub(super) struct Pairwise {
    products: Vec<Vec<f64>>,
}

impl Pairwise {
    /// How many items it knows.
    pub(super) fn len(&self) -> usize {
        self.products.len()
    }

    /// Multiplies the last of these items into what is known of those before it.
    pub(super) fn append(&mut self, items: &[Seen<'_>], function: &BlendFunction) {
        let Some((new, before)) = items.split_last() else { return };
        let mut own = vec![1.0; new.rho.len()];
        for (item, product) in before.iter().zip(&mut self.products) {
            if item.part != new.part {
                continue;
            }
            for (vertex, (one, other)) in product.iter_mut().zip(&mut own).enumerate() {
                let (rho_j, rho_k) = (item.rho[vertex], new.rho[vertex]);
                let sum = rho_j + rho_k;
                // Clamped on a bad mesh, both can be at their foot as far as numbers tell.
                let share = if sum > 0.0 { function.value(rho_k / sum) } else { 0.5 };
                *one *= share;
                *other *= 1.0 - share;
            }
        }
        self.products.push(own);
        // On an item itself nothing is left to arithmetic.
        for (j, item) in items.iter().enumerate() {
            for &vertex in item.vertices {
                let alike = self.products.iter_mut().enumerate().filter(|(k, _)| items[*k].part == item.part);
                alike.for_each(|(k, product)| product[vertex] = f64::from(u8::from(k == j)));
            }
        }
    }

    /// What the products in a part of the surface add up to, by which they are divided; `parts` are those of all items.
    pub(super) fn sum(&self, parts: &[u32], part: u32) -> Vec<f64> {
        let mut sum = vec![0.0; self.products.first().map_or(0, Vec::len)];
        for (product, _) in self.products.iter().zip(parts).filter(|(_, own)| **own == part) {
            sum.iter_mut().zip(product).for_each(|(sum, product)| *sum += product);
        }
        sum
    }

    /// The products of an item.
    pub(super) fn of(&self, item: usize) -> Option<&[f64]> {
        self.products.get(item).map(Vec::as_slice)
    }
}

/// The inverse of `G_jk = B_k(j)`.
pub(super) fn gram(blends: &[&[f64]], feet: &[usize]) -> Result<Vec<Vec<f64>>, DisplacementError> {
    let row = |&foot: &usize| blends.iter().map(|blend| blend[foot]).collect();
    let matrix: Vec<Vec<f64>> = feet.iter().map(row).collect();
    let most = GRAM_CONDITION;
    let inverse = dense::inverse(&matrix);
    let inverse = inverse.ok_or(DisplacementError::IllConditioned { condition: f64::INFINITY, most })?;
    let condition = dense::condition(&matrix, &inverse);
    if condition <= most { Ok(inverse) } else { Err(DisplacementError::IllConditioned { condition, most }) }
}

/// For each foot the function of Green's that is 1 there and 0 at the others, in [0, 1].
pub(super) fn cardinal(greens: &[&[f64]], feet: &[usize]) -> Result<Vec<Vec<f64>>, DisplacementError> {
    let row = |&foot: &usize| greens.iter().map(|green| green[foot]).collect();
    let matrix: Vec<Vec<f64>> = feet.iter().map(row).collect();
    let first = feet.first().copied().unwrap_or(0);
    let inverse = dense::inverse(&matrix).ok_or(DisplacementError::Unsolvable(first))?;
    let count = greens.first().map_or(0, |green| green.len());
    let function = |j: usize| {
        let mut values = vec![0.0; count];
        for (green, row) in greens.iter().zip(&inverse) {
            values.iter_mut().zip(*green).for_each(|(value, g)| *value += row[j] * g);
        }
        values.iter_mut().for_each(|value| *value = value.clamp(0.0, 1.0));
        for (k, &foot) in feet.iter().enumerate() {
            values[foot] = f64::from(u8::from(k == j));
        }
        values
    };
    Ok((0..feet.len()).map(function).collect())
}
