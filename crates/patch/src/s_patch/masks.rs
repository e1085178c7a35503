//! Interior control points by masks on the graph of labels: harmonic, or biharmonic, which is the harmonic mask applied
//! twice (the source's algorithm 1, after G. Farin, D. Hansford, *Discrete Coons patches*, 1999).
//!
//! Both systems are symmetric and positive definite and depend on nothing but the kind of the patch. Where their factor
//! is small it is made once and kept; above that the factor fills up (the graph has `n - 1` dimensions), and conjugate
//! gradients with two sweeps over the neighbours for each step take less time and no room. What is filled again and again gets
//! weights by them ([`Influence`]).

use super::build::Join;
use super::influence::Influence;
use super::label::{LabelKind, Labels};
use ductile_solver::SymmetricFactor;
use glam::DVec3;
use thiserror::Error;

/// By what rule interior control points are placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Fill {
    /// The mask applied twice: what fits prescribed tangent planes.
    #[default]
    Biharmonic,
    /// Each point is the mean of its neighbours.
    Harmonic,
}

/// The interior could not be solved for: coordinates of a size at which their arithmetic breaks down.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("the interior control points of {sides} sides and depth {depth} could not be found")]
pub struct MaskError {
    /// How many sides.
    pub sides: usize,
    /// The depth.
    pub depth: usize,
}

/// Above this many unknowns the system is solved step by step.
const MOST_FACTORED: usize = 1200;
/// Where steps may end, as a share of the right-hand side: what rounding leaves.
const RESIDUAL: f64 = 1e-14;
/// What the residual must come down to at the least.
const ACCEPTED: f64 = 1e-11;
/// Steps before giving up; the hardest kinds that are possible need some hundreds.
const MOST_STEPS: usize = 5000;
/// How many kinds of patches a cache keeps.
const KEPT: usize = 8;
/// No unknown.
const FIXED: u32 = u32::MAX;

/// What each kind of patch needs to be filled, made when it is first wanted. Kept by the caller; the kind not used for the
/// longest time goes when there are more than eight.
#[derive(Debug, Default)]
pub struct MaskCache {
    kinds: Vec<Masks>,
}

impl MaskCache {
    /// An empty cache.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The masks of a kind of patch.
    pub(super) fn masks(
        &mut self,
        sides: usize,
        depth: usize,
        join: Join,
        fill: Fill,
    ) -> Result<&mut Masks, super::BuildError> {
        let is_it = |masks: &Masks| {
            (masks.labels.sides(), masks.labels.depth(), masks.join, masks.fill) == (sides, depth, join, fill)
        };
        let masks = match self.kinds.iter().position(is_it) {
            Some(at) => self.kinds.remove(at),
            None => Masks::new(sides, depth, join, fill)?,
        };
        self.kinds.truncate(KEPT - 1);
        self.kinds.insert(0, masks);
        Ok(&mut self.kinds[0])
    }
}

/// The system of one kind of patch.
#[derive(Debug)]
pub(super) struct Masks {
    labels: Labels,
    join: Join,
    fill: Fill,
    /// Numbers of the free labels.
    free: Vec<u32>,
    /// Which neighbours each label has, one list after the other.
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    factor: Option<SymmetricFactor>,
    influence: Option<Influence>,
}

impl Masks {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "there are at most 300000 labels with few neighbours each"
    )]
    pub(super) fn new(sides: usize, depth: usize, join: Join, fill: Fill) -> Result<Self, super::BuildError> {
        let labels = Labels::new(sides, depth)?;
        let is_free = |rank: &usize| match join {
            Join::Tangent => labels.kind(*rank) == LabelKind::Interior,
            Join::Position => labels.kind(*rank) != LabelKind::Boundary,
        };
        let free: Vec<u32> = (0..labels.len()).filter(is_free).map(|rank| rank as u32).collect();
        let (mut starts, mut neighbours, mut label) = (vec![0], Vec::new(), Vec::new());
        for rank in 0..labels.len() {
            labels.for_each_shift(rank, &mut label, |to, _| neighbours.push(to as u32));
            starts.push(neighbours.len() as u32);
        }
        let mut masks = Self { labels, join, fill, free, starts, neighbours, factor: None, influence: None };
        if masks.free.len() <= MOST_FACTORED {
            let factor = SymmetricFactor::new(masks.free.len(), &masks.entries());
            masks.factor = Some(factor.map_err(|_| MaskError { sides, depth })?);
        }
        Ok(masks)
    }

    /// Makes many fills quick, where there is no factor: finds out how each point inside hangs on those around it.
    pub(super) fn weigh(&mut self) -> Result<(), MaskError> {
        if self.factor.is_some() || self.free.is_empty() {
            return Ok(());
        }
        let failed = core::cell::Cell::new(false);
        let solve = |points: &mut [DVec3]| {
            failed.set(self.fill_by(None, points).is_err());
            (!failed.get()).then_some(())
        };
        self.influence = Influence::new(self, solve);
        if failed.get() {
            return Err(MaskError { sides: self.labels.sides(), depth: self.labels.depth() });
        }
        Ok(())
    }

    pub(super) fn labels(&self) -> &Labels {
        &self.labels
    }

    /// The numbers of the points that are placed.
    pub(super) fn free(&self) -> &[u32] {
        &self.free
    }

    fn around(&self, rank: usize) -> &[u32] {
        &self.neighbours[self.starts[rank] as usize..self.starts[rank + 1] as usize]
    }

    /// The mask of the harmonic rule at a label: itself, then its neighbours.
    fn mask(&self, rank: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let around = self.around(rank);
        core::iter::once((rank, -(around.len() as f64))).chain(around.iter().map(|&q| (q as usize, 1.0)))
    }

    /// The lower triangle of the system, in parts to be summed.
    fn entries(&self) -> Vec<(usize, usize, f64)> {
        let mut slots = vec![FIXED; self.labels.len()];
        for (slot, &rank) in (0..).zip(&self.free) {
            slots[rank as usize] = slot;
        }
        let mut entries = Vec::new();
        for (row, &rank) in self.free.iter().enumerate() {
            let mut put = |to: usize, weight: f64| {
                let column = slots[to];
                if column != FIXED && column as usize <= row {
                    entries.push((row, column as usize, weight));
                }
            };
            for (q, weight) in self.mask(rank as usize) {
                match self.fill {
                    Fill::Harmonic => put(q, -weight),
                    Fill::Biharmonic => self.mask(q).for_each(|(r, again)| put(r, weight * again)),
                }
            }
        }
        entries
    }

    /// The positive operator on all labels: minus the harmonic mask, or that mask twice.
    fn apply(&self, points: &[DVec3], between: &mut Vec<DVec3>, result: &mut [DVec3]) {
        let sweep = |from: &[DVec3], rank: usize| {
            let around = self.around(rank);
            from[rank] * around.len() as f64 - around.iter().map(|&q| from[q as usize]).sum::<DVec3>()
        };
        match self.fill {
            Fill::Harmonic => {
                self.free.iter().zip(result).for_each(|(&rank, out)| *out = sweep(points, rank as usize));
            }
            Fill::Biharmonic => {
                between.clear();
                between.extend((0..points.len()).map(|rank| sweep(points, rank)));
                self.free.iter().zip(result).for_each(|(&rank, out)| *out = sweep(between, rank as usize));
            }
        }
    }

    /// Places the free control points; what they hold before is of no account.
    pub(super) fn fill(&mut self, points: &mut [DVec3]) -> Result<(), MaskError> {
        let mut factor = self.factor.take();
        let filled = self.fill_by(factor.as_mut(), points);
        self.factor = factor;
        filled
    }

    /// The same for masks that several hold: the factor, which keeps notes while it solves, is copied.
    pub(super) fn fill_shared(&self, points: &mut [DVec3]) -> Result<(), MaskError> {
        self.fill_by(self.factor.clone().as_mut(), points)
    }

    fn fill_by(&self, factor: Option<&mut SymmetricFactor>, points: &mut [DVec3]) -> Result<(), MaskError> {
        if self.free.is_empty() {
            return Ok(());
        }
        // Seen from one of the points, so that a patch far from the origin loses no digits.
        let origin = points[0];
        points.iter_mut().for_each(|point| *point -= origin);
        let failed = MaskError { sides: self.labels.sides(), depth: self.labels.depth() };
        if let (None, Some(influence)) = (&factor, &self.influence) {
            influence.fill(points);
            if self.free.iter().any(|&rank| !points[rank as usize].is_finite()) {
                return Err(failed);
            }
            points.iter_mut().for_each(|point| *point += origin);
            return Ok(());
        }
        self.free.iter().for_each(|&rank| points[rank as usize] = DVec3::ZERO);
        let mut right = vec![DVec3::ZERO; self.free.len()];
        self.apply(points, &mut Vec::new(), &mut right);
        right.iter_mut().for_each(|value| *value = -*value);
        let solution = match factor {
            Some(factor) => solve_factored(factor, &right),
            None => self.iterate(&right),
        };
        let solution = solution.filter(|found| found.iter().all(|point| point.is_finite())).ok_or(failed)?;
        for (&rank, value) in self.free.iter().zip(solution) {
            points[rank as usize] = value;
        }
        points.iter_mut().for_each(|point| *point += origin);
        Ok(())
    }

    /// Conjugate gradients, scaled by the diagonal, and once more from the residual that is then found to be left.
    fn iterate(&self, right: &[DVec3]) -> Option<Vec<DVec3>> {
        let valence = |rank: u32| self.around(rank as usize).len() as f64;
        let diagonal: Vec<f64> = match self.fill {
            Fill::Harmonic => self.free.iter().map(|&rank| valence(rank)).collect(),
            Fill::Biharmonic => self.free.iter().map(|&rank| valence(rank) * (valence(rank) + 1.0)).collect(),
        };
        let norm = |v: &[DVec3]| v.iter().map(|x| x.length_squared()).sum::<f64>().sqrt();
        let size = norm(right);
        let (mut x, mut spread) = (vec![DVec3::ZERO; right.len()], vec![DVec3::ZERO; self.labels.len()]);
        let (mut product, mut between) = (x.clone(), Vec::new());
        let (mut residual, mut steps) = (right.to_vec(), 0);
        for _ in 0..2 {
            if norm(&residual) <= RESIDUAL * size {
                break;
            }
            let mut direction: Vec<DVec3> = residual.iter().zip(&diagonal).map(|(r, d)| *r / *d).collect();
            let mut slope: f64 = residual.iter().zip(&direction).map(|(r, z)| r.dot(*z)).sum();
            while steps < MOST_STEPS && slope > 0.0 && norm(&residual) > RESIDUAL * size {
                steps += 1;
                self.free.iter().zip(&direction).for_each(|(&rank, p)| spread[rank as usize] = *p);
                self.apply(&spread, &mut between, &mut product);
                let bend: f64 = direction.iter().zip(&product).map(|(p, q)| p.dot(*q)).sum();
                let step = slope / bend;
                x.iter_mut().zip(&direction).for_each(|(x, p)| *x += *p * step);
                residual.iter_mut().zip(&product).for_each(|(r, q)| *r -= *q * step);
                let before = slope;
                slope = residual.iter().zip(&diagonal).map(|(r, d)| r.length_squared() / d).sum();
                let keep = slope / before;
                for ((p, r), d) in direction.iter_mut().zip(&residual).zip(&diagonal) {
                    *p = *r / *d + *p * keep;
                }
            }
            self.free.iter().zip(&x).for_each(|(&rank, x)| spread[rank as usize] = *x);
            self.apply(&spread, &mut between, &mut product);
            residual = right.iter().zip(&product).map(|(b, q)| *b - *q).collect();
        }
        (norm(&residual) <= ACCEPTED * size).then_some(x)
    }
}

fn solve_factored(factor: &mut SymmetricFactor, right: &[DVec3]) -> Option<Vec<DVec3>> {
    let size = right.len();
    let mut flat = vec![0.0; 3 * size];
    for (at, value) in right.iter().enumerate() {
        [flat[at], flat[size + at], flat[2 * size + at]] = value.to_array();
    }
    factor.solve(&mut flat);
    Some((0..size).map(|at| DVec3::new(flat[at], flat[size + at], flat[2 * size + at])).collect())
}

#[cfg(test)]
impl Masks {
    /// Makes the next fill go step by step.
    pub(super) fn forget_factor(&mut self) {
        self.factor = None;
    }

    pub(super) fn is_weighed(&self) -> bool {
        self.influence.is_some()
    }
}
