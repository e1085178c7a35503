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

/// One item for [`pairwise`]: items in different parts of a surface do not see each other.
#[derive(Clone, Debug)]
pub(super) struct Seen<'a> {
    pub(super) part: u32,
    pub(super) vertices: &'a [usize],
    pub(super) rho: Vec<f64>,
}

/// The normalised weights of all items at all vertices.
pub(super) fn pairwise(items: &[Seen<'_>], function: &BlendFunction) -> Vec<Vec<f64>> {
    let mut weights: Vec<Vec<f64>> = items.iter().map(|item| vec![1.0; item.rho.len()]).collect();
    for j in 0..items.len() {
        for k in j + 1..items.len() {
            if items[j].part != items[k].part {
                continue;
            }
            let (before, after) = weights.split_at_mut(k);
            for (vertex, (one, other)) in before[j].iter_mut().zip(&mut after[0]).enumerate() {
                let (rho_j, rho_k) = (items[j].rho[vertex], items[k].rho[vertex]);
                let sum = rho_j + rho_k;
                // Clamped on a bad mesh, both can be at their foot as far as numbers tell.
                let share = if sum > 0.0 { function.value(rho_k / sum) } else { 0.5 };
                *one *= share;
                *other *= 1.0 - share;
            }
        }
    }
    // On an item itself nothing is left to arithmetic.
    for (j, item) in items.iter().enumerate() {
        for &vertex in item.vertices {
            for (k, weight) in weights.iter_mut().enumerate().filter(|(k, _)| items[*k].part == item.part) {
                weight[vertex] = f64::from(u8::from(k == j));
            }
        }
    }
    let mut parts: Vec<u32> = items.iter().map(|item| item.part).collect();
    parts.sort_unstable();
    parts.dedup();
    for part in parts {
        let mut sum = vec![0.0; items[0].rho.len()];
        let is_in = |k: &usize| items[*k].part == part;
        for k in (0..items.len()).filter(is_in) {
            sum.iter_mut().zip(&weights[k]).for_each(|(sum, weight)| *sum += weight);
        }
        for k in (0..items.len()).filter(is_in) {
            weights[k].iter_mut().zip(&sum).for_each(|(weight, sum)| *weight /= sum);
        }
    }
    weights
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
