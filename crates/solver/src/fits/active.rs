//! Which nodes are fitted while bays sleep: everything that a frame does to nodes is done to these alone.

use crate::rings::Rings;

/// The neighbourhoods in which anything can move.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Active {
    /// Their batches, by place.
    pub(crate) batches: Vec<usize>,
    /// The nodes of these batches, in index order: all that can move are among them.
    pub(crate) nodes: Vec<u32>,
    /// These and their neighbours, which feel the chords of both.
    pub(crate) felt: Vec<u32>,
}

impl Active {
    /// The batches with a node that `stirs`.
    pub(crate) fn new(rings: &Rings, stirs: impl Fn(u32) -> bool) -> Self {
        let all = rings.batches();
        let has_stir = |place: &usize| all[*place].nodes.iter().any(|&node| stirs(node));
        let batches: Vec<usize> = (0..all.len()).filter(has_stir).collect();
        let (mut is_fitted, mut is_felt) = (vec![false; rings.len()], vec![false; rings.len()]);
        for node in batches.iter().flat_map(|&place| all[place].nodes) {
            is_fitted[node as usize] = true;
            is_felt[node as usize] = true;
            rings.ring(node as usize).iter().for_each(|&far| is_felt[far as usize] = true);
        }
        let listed =
            |flags: &[bool]| (0_u32..).zip(flags).filter_map(|(node, &is)| is.then_some(node)).collect();
        Self { batches, nodes: listed(&is_fitted), felt: listed(&is_felt) }
    }

    /// Whether a node is fitted.
    pub(crate) fn has(&self, node: u32) -> bool {
        self.nodes.binary_search(&node).is_ok()
    }
}
