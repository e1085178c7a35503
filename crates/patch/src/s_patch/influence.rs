//! How the points inside a patch hang on those around it, for kinds that are too large to be factored: a weight for each pair, solved
//! for once, so that a patch that is dragged takes one pass over them instead of hundreds of sweeps.
//!
//! Turning the polygon by a corner, or mirroring it, only renumbers labels. So one column of weights is solved for among all that
//! turns and mirrors lead to, and rows are kept for one point of those that turns lead to.

use super::label::Labels;
use super::masks::Masks;
use glam::DVec3;

/// More weights than this are not looked for: with nine sides and depth 8 that takes ten times as long as a fill by steps does.
const MOST_WEIGHTS: usize = 500_000;
/// Sums that are run side by side.
const LANES: usize = 8;

/// The weights of one kind of patch.
#[derive(Debug)]
pub(super) struct Influence {
    turns: Turns,
    /// The points around, and one of the points inside for each turn.
    fixed: Vec<u32>,
    rows: Vec<u32>,
    /// One row after the other.
    weights: Vec<f64>,
}

impl Influence {
    /// The weights, if there are not too many; `solve` tells what lies inside when three values of those around are given.
    pub(super) fn new(masks: &Masks, solve: impl Fn(&mut [DVec3]) -> Option<()>) -> Option<Self> {
        let turns = Turns::new(masks.labels());
        let mut is_fixed = vec![true; masks.labels().len()];
        masks.free().iter().for_each(|rank| is_fixed[*rank as usize] = false);
        let fixed: Vec<u32> =
            (0..).zip(&is_fixed).filter(|(_, fixed)| **fixed).map(|(rank, _)| rank).collect();
        let rows: Vec<u32> = masks
            .free()
            .iter()
            .copied()
            .filter(|rank| turns.all(*rank).all(|other| other >= *rank))
            .collect();
        if rows.len().saturating_mul(fixed.len()) > MOST_WEIGHTS {
            return None;
        }
        let mut weights = vec![0.0; rows.len() * fixed.len()];
        let likes: Vec<u32> = fixed.iter().copied().filter(|rank| turns.least(*rank).0 == *rank).collect();
        let mut found = vec![DVec3::ZERO; is_fixed.len()];
        for three in likes.chunks(3) {
            found.fill(DVec3::ZERO);
            for (rank, axis) in three.iter().zip(DVec3::AXES) {
                found[*rank as usize] = axis;
            }
            solve(&mut found)?;
            for (column, rank) in fixed.iter().enumerate() {
                let (least, turn, is_mirrored) = turns.least(*rank);
                let Some(axis) = three.iter().position(|rank| *rank == least) else { continue };
                for (row, inside) in rows.iter().enumerate() {
                    let seen = turns.seen(*inside, turn, is_mirrored) as usize;
                    weights[row * fixed.len() + column] = found[seen][axis];
                }
            }
        }
        Some(Self { turns, fixed, rows, weights })
    }

    /// Places the points inside.
    pub(super) fn fill(&self, points: &mut [DVec3]) {
        let sides = self.turns.sides;
        let mut seen = vec![[0.0; LANES]; self.fixed.len()];
        let mut found = vec![DVec3::ZERO; self.rows.len() * sides];
        // A lane for each axis of each turn.
        for first in (0..3 * sides).step_by(LANES) {
            let lanes = first..(first + LANES).min(3 * sides);
            for (lane, of) in lanes.clone().enumerate() {
                for (values, rank) in seen.iter_mut().zip(&self.fixed) {
                    values[lane] = points[self.turns.turned(*rank, of / 3) as usize][of % 3];
                }
            }
            for (row, weights) in self.weights.chunks_exact(self.fixed.len()).enumerate() {
                let mut sums = [0.0; LANES];
                for (weight, values) in weights.iter().zip(&seen) {
                    for (sum, value) in sums.iter_mut().zip(values) {
                        *sum += weight * value;
                    }
                }
                for (of, sum) in lanes.clone().zip(sums) {
                    found[row * sides + of / 3][of % 3] = sum;
                }
            }
        }
        for (rank, turned) in self.rows.iter().zip(found.chunks_exact(sides)) {
            for (turn, place) in turned.iter().enumerate() {
                points[self.turns.turned(*rank, turn) as usize] = *place;
            }
        }
    }
}

/// The numbers of labels after the polygon was turned or mirrored.
#[derive(Debug)]
struct Turns {
    sides: usize,
    /// By turn, then by number.
    turned: Vec<u32>,
    mirrored: Vec<u32>,
}

impl Turns {
    #[expect(clippy::cast_possible_truncation, reason = "there are at most 300000 labels")]
    fn new(labels: &Labels) -> Self {
        let sides = labels.sides();
        let mut label = vec![0; sides];
        let mut renumbered = |to: &dyn Fn(usize) -> usize| -> Vec<u32> {
            let one = |own: &[u8]| {
                (0..sides).for_each(|k| label[to(k) % sides] = own[k]);
                labels.rank_of(&label) as u32
            };
            labels.iter().map(one).collect()
        };
        let turned = (0..sides).flat_map(|turn| renumbered(&|k| k + turn)).collect();
        Self { sides, turned, mirrored: renumbered(&|k| sides - k) }
    }

    fn turned(&self, rank: u32, turn: usize) -> u32 {
        self.turned[turn * self.mirrored.len() + rank as usize]
    }

    /// What a number becomes by mirroring, or not, and then turning.
    fn seen(&self, rank: u32, turn: usize, is_mirrored: bool) -> u32 {
        self.turned(if is_mirrored { self.mirrored[rank as usize] } else { rank }, turn)
    }

    fn all(&self, rank: u32) -> impl Iterator<Item = u32> + '_ {
        (0..self.sides).map(move |turn| self.turned(rank, turn))
    }

    /// The least number among all that one becomes, and how it becomes that.
    fn least(&self, rank: u32) -> (u32, usize, bool) {
        let ways =
            [false, true].into_iter().flat_map(|mirror| (0..self.sides).map(move |turn| (turn, mirror)));
        let all = ways.map(|(turn, mirror)| (self.seen(rank, turn, mirror), turn, mirror));
        all.min().unwrap_or((rank, 0, false))
    }
}

#[cfg(test)]
mod tests {
    use super::super::build::Join;
    use super::super::masks::Fill;
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn weights_place_what_steps_place() {
        for (sides, depth, fill) in [
            (3, 12, Fill::Biharmonic),
            (4, 8, Fill::Biharmonic),
            (4, 8, Fill::Harmonic),
            (5, 10, Fill::Biharmonic),
            (6, 6, Fill::Biharmonic),
            (7, 6, Fill::Harmonic),
        ] {
            let mut masks = Masks::new(sides, depth, Join::Tangent, fill).unwrap();
            masks.forget_factor();
            let place = |k: usize| {
                let k = k as f64;
                DVec3::new(libm::sin(k), libm::cos(3.0 * k), libm::sin(0.1 * k * k)) + DVec3::X * 1000.0
            };
            let mut stepped: Vec<DVec3> = (0..masks.labels().len()).map(place).collect();
            let mut weighed = stepped.clone();
            masks.fill_shared(&mut stepped).unwrap();
            masks.weigh().unwrap();
            assert!(masks.is_weighed());
            masks.fill_shared(&mut weighed).unwrap();
            let off = stepped.iter().zip(&weighed).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(off < 1e-11 && off > 0.0, "{sides} sides, depth {depth}, {fill:?}: {off:e}");
        }
    }

    #[test]
    fn a_kind_with_too_many_weights_keeps_to_steps() {
        let mut masks = Masks::new(9, 9, Join::Tangent, Fill::Harmonic).unwrap();
        masks.weigh().unwrap();
        assert!(!masks.is_weighed());
    }
}
