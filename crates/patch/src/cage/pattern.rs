//! Tables of weights for tessellation: what one quad's samples are made of, shared by all quads that look alike.
//!
//! A quad looks like another when their corners have rings of the same vertices by the order in which the walk round the four rings
//! first meets them, with the same shares where the rings were completed at a boundary. Away from irregular places all
//! quads of a cage look alike.

use super::error::CageError;
use super::links::name;
use super::surface::CageSurface;
use crate::jet::Jet;
use std::collections::BTreeMap;
use wide::f64x2;

/// Samples that are evaluated side by side.
pub(super) const LANES: usize = 2;
/// Most numbers in all tables: 134 MB.
const MOST_NUMBERS: usize = 1 << 24;

/// The table of all quads that look alike.
#[derive(Clone, Debug)]
pub(super) struct Pattern {
    /// Its blocks: the inside of the quad, its four sides, its four corners.
    blocks: Vec<Block>,
}

/// Samples that are evaluated together, and what enters them: towards a side or a corner the weights of what lies across vanish.
#[derive(Clone, Debug)]
pub(super) struct Block {
    /// The slots that enter a sample of it, in their order.
    pub(super) slots: Vec<u32>,
    /// For each pair of samples and each of these slots the weights of both, those of their derivatives by `u`, and by `v`.
    weights: Vec<[f64x2; 3]>,
}

impl Block {
    /// The weights of each pair of samples, slot by slot.
    #[inline]
    pub(super) fn pairs(&self) -> std::slice::ChunksExact<'_, [f64x2; 3]> {
        // Weights of a vertex sum to one, so that no sample is without.
        self.weights.chunks_exact(self.slots.len().max(1))
    }
}

impl Pattern {
    /// A block by its number.
    #[inline]
    pub(super) fn block(&self, block: u32) -> &Block {
        &self.blocks[block as usize]
    }

    /// How many numbers the table has.
    pub(super) fn number_count(&self) -> usize {
        self.blocks.iter().map(|block| 3 * LANES * block.weights.len()).sum()
    }
}

/// Value and first derivatives.
type Weight = [f64; 3];

/// All tables of a surface at one resolution, made as quads ask for them.
pub(super) struct Tables {
    resolution: usize,
    /// Nodes of each block in the order of a quad's samples, each filled up to pairs by repetition.
    blocks: Vec<Vec<(usize, usize)>>,
    /// For a valence the weights of each node of the grid as a corner sees it.
    corners: BTreeMap<usize, Vec<Vec<Weight>>>,
    known: BTreeMap<Vec<u64>, usize>,
    patterns: Vec<Pattern>,
    numbers: usize,
}

impl Tables {
    pub(super) fn new(resolution: usize) -> Self {
        let inner = 1..resolution;
        let mut blocks = Vec::new();
        let mut run = |part: &mut dyn Iterator<Item = (usize, usize)>| {
            let mut nodes: Vec<_> = part.collect();
            while !nodes.len().is_multiple_of(LANES) {
                nodes.extend(nodes.last().copied());
            }
            blocks.push(nodes);
        };
        let last = resolution;
        run(&mut inner.clone().flat_map(|q| (1..last).map(move |p| (p, q))));
        run(&mut inner.clone().map(|p| (p, 0)));
        run(&mut inner.clone().map(|q| (last, q)));
        run(&mut inner.clone().rev().map(|p| (p, last)));
        run(&mut inner.rev().map(|q| (0, q)));
        for corner in [(0, 0), (last, 0), (last, last), (0, last)] {
            run(&mut std::iter::once(corner));
        }
        let (corners, known) = (BTreeMap::new(), BTreeMap::new());
        Self { resolution, blocks, corners, known, patterns: Vec::new(), numbers: 0 }
    }

    pub(super) fn into_patterns(self) -> Vec<Pattern> {
        self.patterns
    }

    /// The pattern of a quad, and its vertices in the order of the pattern's slots.
    pub(super) fn pattern_of(
        &mut self,
        surface: &CageSurface,
        quad: usize,
    ) -> Result<(usize, Vec<u32>), CageError> {
        let corners = surface.quads()[quad];
        let mut slots: Vec<u32> = corners.to_vec();
        let mut key = Vec::new();
        let mut shares: Vec<Vec<Vec<(usize, f64)>>> = Vec::new();
        for (corner, _) in corners.iter().enumerate() {
            let ring = surface.ring(quad, corner);
            key.push(ring.valence() as u64);
            let mut points = vec![vec![(corner, 1.0)]];
            for terms in ring.from(surface.place_in_fan(quad, corner)) {
                key.push(terms.len() as u64);
                let mut point = Vec::with_capacity(terms.len());
                for &(vertex, share) in terms {
                    let slot = slots.iter().position(|&known| known == vertex).unwrap_or_else(|| {
                        slots.push(vertex);
                        slots.len() - 1
                    });
                    key.extend([slot as u64, share.to_bits()]);
                    point.push((slot, share));
                }
                points.push(point);
            }
            shares.push(points);
        }
        if let Some(&pattern) = self.known.get(&key) {
            return Ok((pattern, slots));
        }
        let pattern = self.build(surface, slots.len(), &shares)?;
        self.patterns.push(pattern);
        self.known.insert(key, self.patterns.len() - 1);
        Ok((self.patterns.len() - 1, slots))
    }

    fn build(
        &mut self,
        surface: &CageSurface,
        slots: usize,
        shares: &[Vec<Vec<(usize, f64)>>],
    ) -> Result<Pattern, CageError> {
        self.count(3 * slots * self.blocks.iter().map(Vec::len).sum::<usize>())?;
        for points in shares {
            self.know_corner(surface, points.len() / 2)?;
        }
        let blocks = self.blocks.iter().map(|nodes| self.block(nodes, slots, shares));
        Ok(Pattern { blocks: blocks.collect() })
    }

    fn block(&self, nodes: &[(usize, usize)], slots: usize, shares: &[Vec<Vec<(usize, f64)>>]) -> Block {
        let last = self.resolution;
        let mut weights = vec![[0.0; 3 * LANES]; slots * nodes.len() / LANES];
        for (node, &(p, q)) in nodes.iter().enumerate() {
            let row = &mut weights[node / LANES * slots..][..slots];
            let lane = node % LANES;
            let local = [(p, q), (q, last - p), (last - p, last - q), (last - q, p)];
            for (corner, (points, (a, b))) in shares.iter().zip(local).enumerate() {
                let table = &self.corners[&(points.len() / 2)][a * (last + 1) + b];
                for (point, &[value, by_a, by_b]) in points.iter().zip(table) {
                    let turned = Jet { value, a: by_a, b: by_b, ..Jet::default() }.turned(corner);
                    for &(slot, share) in point {
                        row[slot][lane] += share * turned.value;
                        row[slot][LANES + lane] += share * turned.a;
                        row[slot][2 * LANES + lane] += share * turned.b;
                    }
                }
            }
        }
        let enters = |slot: &usize| weights.iter().skip(*slot).step_by(slots).flatten().any(|w| *w != 0.0);
        let entering: Vec<usize> = (0..slots).filter(enters).collect();
        let kept = weights.chunks_exact(slots).flat_map(|row| entering.iter().map(|&slot| row[slot]));
        let kept = kept.map(|[a, b, c, d, e, f]| [[a, b], [c, d], [e, f]].map(f64x2::new)).collect();
        Block { slots: entering.into_iter().map(name).collect(), weights: kept }
    }

    /// Sees to it that the weights of a valence are there.
    fn know_corner(&mut self, surface: &CageSurface, n: usize) -> Result<(), CageError> {
        if self.corners.contains_key(&n) {
            return Ok(());
        }
        let side = self.resolution + 1;
        self.count(3 * (2 * n + 1) * side * side)?;
        let at = |step: usize| step as f64 / self.resolution as f64;
        let nodes = (0..side).flat_map(|a| (0..side).map(move |b| (a, b)));
        let weights = |(a, b): (usize, usize)| {
            surface.corner_weights(n, at(a), at(b)).iter().map(|jet| [jet.value, jet.a, jet.b]).collect()
        };
        let table = nodes.map(weights).collect();
        self.corners.insert(n, table);
        Ok(())
    }

    fn count(&mut self, more: usize) -> Result<(), CageError> {
        self.numbers = self.numbers.saturating_add(more);
        if self.numbers > MOST_NUMBERS { Err(CageError::TooLarge(self.numbers)) } else { Ok(()) }
    }
}
