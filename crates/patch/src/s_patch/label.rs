//! The labels of control points, and their numbers: labels in descending lexicographic order, counted from 0 without a
//! map (the recipe's section 3).

use crate::binomial;
use thiserror::Error;

/// Most control points of one patch: beyond, the interior would take minutes and hundreds of megabytes.
const MOST_POINTS: f64 = 300_000.0;

/// A patch would have too many control points: fewer sides, or a lower degree.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{sides} sides and depth {depth} make {points:e} control points, and {MOST_POINTS} are possible")]
pub struct TooManyPoints {
    /// How many sides.
    pub sides: usize,
    /// The depth.
    pub depth: usize,
    /// How many control points these make.
    pub points: f64,
}

/// What a control point is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LabelKind {
    /// On a boundary curve: two neighbouring entries sum to the depth.
    Boundary,
    /// In a boundary panel: two neighbouring entries sum to one less. With the boundary these are all that tangent
    /// planes along the boundary depend on.
    Panel,
    /// Free.
    Interior,
}

/// All labels of patches with a number of sides and a depth.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Labels {
    sides: usize,
    depth: usize,
    /// The labels one after the other, `sides` entries each.
    entries: Vec<u8>,
    /// `b(i + m, m + 1)` at `m * depth + i`: how many labels come before the one whose entry is smaller by `i` than what
    /// is left, with `m` entries to come after the next.
    before: Vec<u32>,
}

impl Labels {
    /// The labels for at least 3 and at most 64 sides and a depth of at least 1.
    ///
    /// # Errors
    /// There are too many of them, or none.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "counts below MOST_POINTS, depths below 300000 / 64 sides"
    )]
    pub fn new(sides: usize, depth: usize) -> Result<Self, TooManyPoints> {
        let points = Self::count(sides, depth);
        if !(3..=crate::ribbon::MOST_SIDES).contains(&sides)
            || !(1..=255).contains(&depth)
            || points > MOST_POINTS
        {
            return Err(TooManyPoints { sides, depth, points });
        }
        let mut entries = Vec::with_capacity(points as usize * sides);
        let mut label = vec![0_u8; sides];
        append(&mut entries, &mut label, 0, depth as u8);
        let mut before = Vec::with_capacity(depth * (sides - 1));
        for m in 0..sides - 1 {
            for i in 0..depth {
                before.push(binomial((i + m + 1) as i64, (m + 1) as i64) as u32);
            }
        }
        Ok(Self { sides, depth, entries, before })
    }

    /// How many labels there are, as a number that cannot overflow.
    #[must_use]
    pub fn count(sides: usize, depth: usize) -> f64 {
        let (n, d) = (sides.min(1 << 20) as i64, depth.min(1 << 20) as i64);
        binomial(n + d - 1, d)
    }

    /// The number of sides.
    #[must_use]
    pub fn sides(&self) -> usize {
        self.sides
    }

    /// The sum of each label.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// How many labels there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.entries.len() / self.sides
    }

    /// There is always a label.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        false
    }

    /// The labels in their order.
    pub fn iter(&self) -> impl Iterator<Item = &[u8]> {
        self.entries.chunks_exact(self.sides)
    }

    /// The label with that number.
    ///
    /// # Panics
    /// There is no label with that number.
    #[must_use]
    pub fn get(&self, rank: usize) -> &[u8] {
        &self.entries[rank * self.sides..(rank + 1) * self.sides]
    }

    /// The number of a label; none if it is no label of these.
    #[must_use]
    pub fn rank(&self, label: &[u8]) -> Option<usize> {
        let sum: usize = label.iter().map(|&entry| usize::from(entry)).sum();
        (label.len() == self.sides && sum == self.depth).then(|| self.rank_of(label))
    }

    /// The number of a label that is one of these.
    pub(super) fn rank_of(&self, label: &[u8]) -> usize {
        let (mut left, mut rank) = (self.depth, 0);
        for (k, &entry) in label[..self.sides - 1].iter().enumerate() {
            let after = left - usize::from(entry);
            if after > 0 {
                // b(after - 1 + m, m) with m = n - 1 - k
                rank += self.before[(self.sides - 2 - k) * self.depth + after - 1] as usize;
            }
            left = after;
        }
        rank
    }

    /// What the control point with that number is for.
    ///
    /// # Panics
    /// There is no label with that number.
    #[must_use]
    pub fn kind(&self, rank: usize) -> LabelKind {
        let label = self.get(rank);
        let pair = |i: usize| usize::from(label[i]) + usize::from(label[(i + 1) % self.sides]);
        match (0..self.sides).map(pair).max() {
            Some(most) if most == self.depth => LabelKind::Boundary,
            Some(most) if most + 1 == self.depth => LabelKind::Panel,
            _ => LabelKind::Interior,
        }
    }

    /// Calls with the numbers of all labels that one shift away reaches: one unit moved from an entry to the entry after
    /// it, then to the one before it.
    pub(super) fn for_each_shift(
        &self,
        rank: usize,
        label: &mut Vec<u8>,
        mut found: impl FnMut(usize, bool),
    ) {
        label.clear();
        label.extend_from_slice(self.get(rank));
        for j in 0..self.sides {
            if label[j] == 0 {
                continue;
            }
            let (after, before) = ((j + 1) % self.sides, (j + self.sides - 1) % self.sides);
            label[j] -= 1;
            for (to, is_forward) in [(after, true), (before, false)] {
                label[to] += 1;
                found(self.rank_of(label), is_forward);
                label[to] -= 1;
            }
            label[j] += 1;
        }
    }

    /// The edges of the control net, each once: pairs of numbers of adjacent labels.
    #[must_use]
    pub fn edges(&self) -> Vec<[usize; 2]> {
        let (mut edges, mut label) = (Vec::new(), Vec::new());
        for rank in 0..self.len() {
            self.for_each_shift(rank, &mut label, |to, is_forward| {
                if is_forward {
                    edges.push([rank, to]);
                }
            });
        }
        edges
    }
}

/// Appends all labels that begin like this one, the largest entry at `k` first.
fn append(entries: &mut Vec<u8>, label: &mut [u8], k: usize, left: u8) {
    if k + 1 == label.len() {
        label[k] = left;
        entries.extend_from_slice(label);
        return;
    }
    for entry in (0..=left).rev() {
        label[k] = entry;
        append(entries, label, k + 1, left - entry);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn numbers_and_labels_are_inverse_and_descend() {
        for (sides, depth) in [(3, 1), (3, 5), (4, 6), (5, 6), (6, 8), (9, 5), (12, 3)] {
            let labels = Labels::new(sides, depth).unwrap();
            assert_eq!(labels.len() as f64, Labels::count(sides, depth));
            let mut before: Option<&[u8]> = None;
            for (rank, label) in labels.iter().enumerate() {
                assert_eq!(labels.rank(label), Some(rank));
                assert!(before.is_none_or(|before| before > label));
                before = Some(label);
            }
            let wrong = vec![1; sides];
            assert_eq!(labels.rank(&wrong).is_some(), sides == depth);
            assert_eq!(labels.rank(&[1; 2]), None);
        }
    }

    #[test]
    fn counts_are_those_of_the_table() {
        // recipe, section 10: n, d, N, boundary, panels including boundary, interior
        for [n, d, all, boundary, panels, interior] in [
            [3, 4, 36, 21, 33, 3],
            [4, 3, 84, 24, 56, 28],
            [5, 3, 210, 30, 95, 115],
            [5, 5, 495, 40, 135, 360],
            [6, 3, 462, 36, 144, 318],
            [6, 5, 1287, 48, 204, 1083],
            [8, 3, 1716, 48, 272, 1444],
            [8, 4, 3432, 56, 328, 3104],
        ] {
            let labels = Labels::new(n, d + 3).unwrap();
            let of = |kind| (0..labels.len()).filter(|&rank| labels.kind(rank) == kind).count();
            assert_eq!(labels.len(), all);
            assert_eq!(of(LabelKind::Boundary), boundary);
            assert_eq!(of(LabelKind::Boundary) + of(LabelKind::Panel), panels);
            assert_eq!(of(LabelKind::Interior), interior);
        }
    }

    #[test]
    fn shifts_are_distinct_and_mutual() {
        for (sides, depth) in [(3, 4), (4, 3), (5, 6)] {
            let labels = Labels::new(sides, depth).unwrap();
            let edges = labels.edges();
            let mut sorted: Vec<_> = edges.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
            sorted.sort_unstable();
            sorted.dedup();
            assert_eq!(sorted.len(), edges.len(), "every edge once");
            let mut valence = vec![0; labels.len()];
            edges.as_flattened().iter().for_each(|&end| valence[end] += 1);
            for (rank, label) in labels.iter().enumerate() {
                assert_eq!(valence[rank], 2 * label.iter().filter(|&&entry| entry > 0).count());
            }
        }
    }

    #[test]
    fn what_is_too_large_is_refused() {
        for (sides, depth) in [(2, 5), (65, 2), (3, 0), (3, 256), (20, 20), (usize::MAX, usize::MAX)] {
            assert!(Labels::new(sides, depth).is_err(), "{sides} {depth}");
        }
    }
}
