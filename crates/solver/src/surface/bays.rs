//! Bays: the parts of the free nodes that fixed ones (control curves) divide from each other, and which lie beside which.
//!
//! Source: recipe section 6, "locality and sleep".

use crate::operator::FIXED;
use crate::rings::Rings;

/// The parts of the free nodes between fixed ones.
#[derive(Clone, Debug)]
pub(super) struct Bays {
    /// The bay of every node, numbered by first node; fixed nodes are in none.
    of: Vec<u32>,
    sizes: Vec<usize>,
    /// Pairs of bays that share a fixed neighbour, both ways, sorted.
    beside: Vec<(u32, u32)>,
}

impl Bays {
    pub(super) fn new(rings: &Rings, fixed: &[bool]) -> Self {
        let mut of = vec![FIXED; rings.len()];
        let mut sizes = Vec::new();
        let mut stack = Vec::new();
        let mut number = 0;
        for first in 0..rings.len() {
            if of[first] != FIXED || fixed[first] {
                continue;
            }
            of[first] = number;
            stack.push(first);
            let mut size = 0;
            while let Some(node) = stack.pop() {
                size += 1;
                for &far in rings.ring(node) {
                    if of[far as usize] == FIXED && !fixed[far as usize] {
                        of[far as usize] = number;
                        stack.push(far as usize);
                    }
                }
            }
            sizes.push(size);
            number += 1;
        }
        let beside = neighbours(rings, &of);
        Self { of, sizes, beside }
    }

    /// How many there are.
    pub(super) fn len(&self) -> usize {
        self.sizes.len()
    }

    /// The bay of a node; none if it is fixed.
    pub(super) fn of(&self, node: usize) -> Option<usize> {
        let bay = self.of[node];
        (bay != FIXED).then_some(bay as usize)
    }

    /// How many nodes the bays have that are `wanted`.
    pub(super) fn count(&self, wanted: impl Fn(usize) -> bool) -> usize {
        self.sizes.iter().enumerate().filter(|(bay, _)| wanted(*bay)).map(|(_, size)| size).sum()
    }

    /// Per bay whether it lies at one of these nodes, or no more than so many curves away from one that does.
    pub(super) fn within(&self, rings: &Rings, nodes: &[u32], curves: usize) -> Vec<bool> {
        let mut is_reached = vec![false; self.len()];
        let mut last = Vec::new();
        let reach = |bay: usize, is_reached: &mut Vec<bool>, next: &mut Vec<usize>| {
            if !is_reached[bay] {
                is_reached[bay] = true;
                next.push(bay);
            }
        };
        for &node in nodes {
            let around = rings.ring(node as usize).iter().map(|&far| far as usize);
            for bay in around.chain([node as usize]).filter_map(|node| self.of(node)) {
                reach(bay, &mut is_reached, &mut last);
            }
        }
        for _ in 0..curves {
            let mut next = Vec::new();
            for bay in last {
                let from = self.beside.partition_point(|pair| (pair.0 as usize) < bay);
                let pairs = self.beside[from..].iter().take_while(|pair| pair.0 as usize == bay);
                pairs.for_each(|pair| reach(pair.1 as usize, &mut is_reached, &mut next));
            }
            last = next;
        }
        is_reached
    }
}

/// Which bays have a fixed neighbour in common.
fn neighbours(rings: &Rings, of: &[u32]) -> Vec<(u32, u32)> {
    let mut beside = Vec::new();
    for node in (0..rings.len()).filter(|&node| of[node] == FIXED) {
        let around = || rings.ring(node).iter().map(|&far| of[far as usize]).filter(|&bay| bay != FIXED);
        for a in around() {
            beside.extend(around().filter(|&b| b != a).map(|b| (a, b)));
        }
    }
    beside.sort_unstable();
    beside.dedup();
    beside
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn bays_of_a_tube_lie_beside_each_other_in_a_row() {
        let shape = workload::tube_of_bays(12, 6, 4);
        let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
        let bays = Bays::new(&rings, &shape.fixed);
        assert_eq!((bays.len(), bays.count(|_| true)), (6, shape.fixed.iter().filter(|is| !**is).count()));
        assert_eq!(
            bays.beside,
            [(0, 1), (1, 0), (1, 2), (2, 1), (2, 3), (3, 2), (3, 4), (4, 3), (4, 5), (5, 4)]
        );
        // A node of the first circle, and one of that between the second bay and the third.
        assert_eq!(bays.within(&rings, &[0], 0), [true, false, false, false, false, false]);
        assert_eq!(bays.within(&rings, &[0], 2), [true, true, true, false, false, false]);
        let inner = (0_u32..).find(|&node| {
            let node = node as usize;
            let has = |bay| rings.ring(node).iter().any(|&far| bays.of(far as usize) == Some(bay));
            bays.of(node).is_none() && has(1) && has(2)
        });
        assert_eq!(bays.within(&rings, &[inner.unwrap()], 1), [true, true, true, true, false, false]);
        assert_eq!(bays.within(&rings, &[], 5), [false; 6]);
    }
}
