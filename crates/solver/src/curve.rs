//! Fair curves over a polygon, with the same verbs as a surface.
//!
//! Source: recipe section 10 and Welch 1995, sections 5.3.3 and 5.4.1: the surface's story in one dimension, with
//! the exact gradient instead of the frozen one. A node has two unknowns, offsets in the plane normal to its tangent.
//! Curves are short, so the linear systems are solved directly. What is minimised is chosen by [`CurveSettings`] (see
//! `objective`). `∫ κ² ds` favours growth; a rope that is slack on ordinary shapes (see `price`) keeps a curve within
//! reach of its control points.
//!
//! ```
//! use ductile_solver::{CurveSettings, CurveSolver};
//! use glam::DVec3;
//! let mut solver = CurveSolver::new(5, false, vec![true, false, true, false, true], CurveSettings::default()).unwrap();
//! let mut positions: Vec<DVec3> = (0..5).map(|i| DVec3::new(i as f64, (i % 2) as f64, 0.0)).collect();
//! let report = solver.step(&mut positions).unwrap();
//! assert!(report.energy <= report.energy_before);
//! ```

mod bends;
mod couples;
mod fair;
mod hinge;
mod hub;
mod network;
mod neutral;
mod objective;
mod price;
mod resample;
mod step;
mod system;

use std::collections::BTreeMap;

use glam::DVec3;

use crate::error::{SolverError, check_length, check_positions};
use crate::factor::FactorError;
use crate::objective::Objective;
use crate::predictor::{self, Predicted};

pub use network::{Network, Spoke, Strand};
pub use resample::{Resampled, resample, respace, respace_graded};

use bends::Bends;
use objective::Character;
use price::Price;
use system::{Frames, System};

/// Numbers that steer a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CurveSettings {
    /// What is minimised.
    pub objective: Objective,
    /// Largest relative strain of an edge in one predictor call.
    pub strain_limit: f64,
    /// Mass damping where the constraints hold the curve.
    pub damping: f64,
    /// Mass damping where they do not.
    pub loose_damping: f64,
    /// Price of length, per length. Zero is the pure objective.
    pub tension: f64,
    /// Length, in units of the control polygon, up to which nothing pulls it back; infinite for no limit at all.
    /// A curve without a control polygon may grow to its first length.
    pub slack: f64,
}

impl Default for CurveSettings {
    fn default() -> Self {
        // A circle through both ends of its diameter is π/2 as long as its control polygon; more points need less.
        Self {
            objective: Objective::ThinPlate,
            strain_limit: 0.5,
            damping: 0.1,
            loose_damping: 10.0,
            tension: 0.0,
            slack: 1.6,
        }
    }
}

/// How the nodes of a curve hang together.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Chain {
    count: usize,
    closed: bool,
}

impl Chain {
    /// Both neighbours of an inner node.
    fn neighbours(self, node: usize) -> Option<(usize, usize)> {
        let (before, after) = self.sides(node);
        before.zip(after)
    }

    /// The neighbours from behind and ahead, as far as there are any.
    fn sides(self, node: usize) -> (Option<usize>, Option<usize>) {
        let joins = self.closed && self.count > 2;
        let last = self.count.saturating_sub(1);
        let before = if node > 0 { Some(node - 1) } else { joins.then_some(last) };
        let after = if node < last { Some(node + 1) } else { joins.then_some(0) };
        (before, after)
    }

    /// Both ends of every edge, in order.
    fn edges(self) -> impl Iterator<Item = (usize, usize)> {
        let edges = if self.closed && self.count > 2 { self.count } else { self.count.saturating_sub(1) };
        (0..edges).map(move |node| (node, if node + 1 == self.count { 0 } else { node + 1 }))
    }
}

/// A fair curve over a fixed number of nodes.
#[derive(Clone, Debug)]
pub struct CurveSolver {
    chain: Chain,
    fixed: Vec<bool>,
    /// Prescribed unit tangents, by fixed node in ascending order.
    given: Vec<(usize, DVec3)>,
    /// Fixed nodes whose tangents a network turns, in ascending order.
    turning: Vec<usize>,
    settings: CurveSettings,
    /// The first length and radius seen: how long a curve without a control polygon may get, and how large it is.
    first_size: Option<(f64, f64)>,
    bends: Bends,
    trial: Bends,
    trial_positions: Vec<DVec3>,
    gradient: Vec<DVec3>,
    offsets: System,
    fields: System,
    frames: Frames,
    damping: f64,
    quiet_steps: u32,
}

impl CurveSolver {
    /// Sets up a curve of `node_count` nodes in order; a closed one joins the last to the first.
    pub fn new(
        node_count: usize,
        closed: bool,
        fixed: Vec<bool>,
        settings: CurveSettings,
    ) -> Result<Self, SolverError> {
        check_length(node_count, fixed.len())?;
        let chain = Chain { count: node_count, closed };
        Ok(Self {
            offsets: System::new(chain, &fixed, &[], 2, reach(settings.objective))?,
            fields: System::new(chain, &fixed, &[], 1, reach(Objective::ThinPlate))?,
            bends: Bends::new(chain, &[]),
            trial: Bends::new(chain, &[]),
            trial_positions: vec![DVec3::ZERO; node_count],
            gradient: vec![DVec3::ZERO; node_count],
            frames: Frames::default(),
            first_size: None,
            damping: 1.0,
            quiet_steps: 0,
            chain,
            fixed,
            given: Vec::new(),
            turning: Vec::new(),
            settings,
        })
    }

    /// Changes which nodes are fixed.
    pub fn set_fixed(&mut self, fixed: Vec<bool>) -> Result<(), SolverError> {
        check_length(self.chain.count, fixed.len())?;
        if fixed != self.fixed {
            self.offsets = System::new(self.chain, &fixed, &[], 2, reach(self.settings.objective))?;
            self.fields = System::new(self.chain, &fixed, &[], 1, reach(Objective::ThinPlate))?;
            self.fixed = fixed;
            self.quiet_steps = 0;
            if !self.turning.is_empty() {
                self.turning.clear();
                self.hinge();
            }
            let mut given = std::mem::take(&mut self.given);
            given.retain(|(node, _)| self.fixed[*node]);
            self.clamp(given);
        }
        Ok(())
    }

    /// Prescribes the direction of the curve at fixed nodes, along the order of the nodes; at all others it is free.
    ///
    /// A direction is part of what is minimised (see `hinge`), so it is met in every state: the curve leaves the node, and
    /// arrives at it, along it, and [`Self::tangents`] gives it back. Curvature may jump there, except under `fair`.
    /// Where a node occurs twice the last direction counts. Any length but zero will do.
    ///
    /// ```
    /// use ductile_solver::{CurveSettings, CurveSolver};
    /// use glam::DVec3;
    /// let ends = vec![true, false, false, false, true];
    /// let mut solver = CurveSolver::new(5, false, ends, CurveSettings::default()).unwrap();
    /// solver.set_tangents(&[(0, DVec3::Y * 2.0)]).unwrap();
    /// let mut positions: Vec<DVec3> = (0..5).map(|i| DVec3::X * i as f64).collect();
    /// solver.step(&mut positions).unwrap();
    /// assert!(solver.tangents()[0] == DVec3::Y && positions[1].y > 0.0);
    /// ```
    ///
    /// # Errors
    /// [`SolverError::UnknownNode`], [`SolverError::NotFixed`]; [`SolverError::NotFinite`] for a direction that is none.
    pub fn set_tangents(&mut self, tangents: &[(u32, DVec3)]) -> Result<(), SolverError> {
        let mut given: BTreeMap<usize, DVec3> = BTreeMap::new();
        for &(node, direction) in tangents {
            let fixed = self.fixed.get(node as usize).ok_or(SolverError::UnknownNode(node))?;
            if !fixed {
                return Err(SolverError::NotFixed(node));
            }
            // Scaled first: the square of what is large or small is not a number of use.
            let largest = direction.abs().max_element();
            let unit = (direction / largest).try_normalize().filter(|_| !direction.is_nan());
            given.insert(node as usize, unit.ok_or(SolverError::NotFinite(node))?);
        }
        self.clamp(given.into_iter().collect());
        Ok(())
    }

    fn clamp(&mut self, given: Vec<(usize, DVec3)>) {
        if given != self.given {
            self.given = given;
            self.hinge();
        }
    }

    /// Sets up the hinges; tangents that turn are given later.
    fn hinge(&mut self) {
        let turning = self.turning.iter().map(|&node| (node, DVec3::X));
        let mut clamps: BTreeMap<usize, DVec3> = turning.collect();
        clamps.extend(self.given.iter().copied());
        let clamps: Vec<(usize, DVec3)> = clamps.into_iter().collect();
        self.bends = Bends::new(self.chain, &clamps);
        self.trial = Bends::new(self.chain, &clamps);
        self.quiet_steps = 0;
    }

    /// Changes which tangents a network turns: ascending fixed nodes without a prescribed tangent.
    fn set_turning(&mut self, turning: Vec<usize>) -> Solved<()> {
        if turning != self.turning {
            self.offsets = System::new(self.chain, &self.fixed, &turning, 2, reach(self.settings.objective))?;
            self.turning = turning;
            self.hinge();
        }
        Ok(())
    }

    /// Carries moved control points by a smooth field; as [`SurfaceSolver::predict`](crate::SurfaceSolver::predict).
    pub fn predict(
        &mut self,
        positions: &mut [DVec3],
        moves: &[(u32, DVec3)],
    ) -> Result<Predicted, SolverError> {
        check_positions(self.chain.count, positions)?;
        let mut field = self.checked_moves(positions, moves)?;
        if field.iter().all(|&displacement| displacement == DVec3::ZERO) {
            return Ok(Predicted { fraction: 1.0, ..Predicted::default() });
        }
        self.measure(positions);
        let fixed = || field.iter().zip(&self.fixed).filter(|(_, fixed)| **fixed).map(|(field, _)| *field);
        let first = fixed().next().unwrap_or(DVec3::ZERO);
        if fixed().all(|displacement| displacement == first) {
            // Every control point goes along, and so does the whole curve, exactly.
            field.fill(first);
        } else {
            // Tangents that are free to turn go along as they will.
            let hinges = self.bends.without_clamps(&self.turning);
            self.fields.carry(&hinges, &mut field)?;
        }
        let strain = self.strain(&field);
        let fraction =
            if strain > self.settings.strain_limit { self.settings.strain_limit / strain } else { 1.0 };
        for (position, &displacement) in positions.iter_mut().zip(&field) {
            *position += displacement * fraction;
        }
        self.quiet_steps = 0;
        Ok(Predicted { fraction, strain, iterations: 0, residual: 0.0 })
    }

    /// Measures the curve at these positions; steps and predictions do so themselves.
    ///
    /// # Panics
    /// When there is not one position per node.
    pub fn fit_all(&mut self, positions: &[DVec3]) {
        assert_eq!(positions.len(), self.chain.count, "one position per node");
        self.measure(positions);
    }

    /// Discrete energy at the newest positions (with tension, if there is any); NaN before the first.
    pub fn energy(&self) -> f64 {
        self.bends.energy
    }

    /// Unit tangents, along the order of the nodes.
    pub fn tangents(&self) -> &[DVec3] {
        &self.bends.tangents
    }

    /// Curvature vectors, towards the centre of curvature; zero at the ends of an open curve.
    pub fn curvatures(&self) -> &[DVec3] {
        &self.bends.curvatures
    }

    /// Exact `dE/dp` at the newest positions.
    pub fn gradient(&mut self) -> &[DVec3] {
        self.bends.gradient(self.chain, self.bends.character, &mut self.gradient);
        &self.gradient
    }

    /// Whether too few points are fixed for the curve to have a minimiser of its own.
    fn is_loose(&self) -> bool {
        let needed = if self.chain.closed { 3 } else { 2 };
        self.fixed.iter().filter(|fixed| **fixed).take(needed).count() < needed
    }

    fn measure(&mut self, positions: &[DVec3]) {
        let character = self.character(positions, self.settings.objective);
        self.bends.measure(self.chain, positions, character);
    }

    /// An objective with the numbers that these controls give it.
    fn character(&mut self, positions: &[DVec3], objective: Objective) -> Character {
        let (first_length, first_radius) = *self.first_size.get_or_insert_with(|| {
            let lengths = self.chain.edges().map(|(from, to)| positions[from].distance(positions[to]));
            (lengths.sum(), half_diagonal(positions))
        });
        let CurveSettings { tension, slack, .. } = self.settings;
        let polygon = self.polygon(positions);
        let reference = if polygon > 0.0 { slack * polygon } else { first_length };
        let reference = if reference > 0.0 { reference } else { f64::INFINITY };
        let controls = positions.iter().zip(&self.fixed).filter(|(_, fixed)| **fixed);
        let radius = half_diagonal_of(controls.map(|(position, _)| *position));
        let radius = if radius > 0.0 { radius } else { first_radius };
        let edges = self.chain.edges().count().max(1) as f64;
        let spacing = if polygon > 0.0 { polygon } else { first_length } / edges;
        Character::new(objective, Price::new(objective, tension, reference), radius, spacing)
    }

    /// Length of the polygon through the fixed nodes.
    fn polygon(&self, positions: &[DVec3]) -> f64 {
        let mut fixed =
            positions.iter().zip(&self.fixed).filter(|(_, fixed)| **fixed).map(|(position, _)| *position);
        let Some(first) = fixed.next() else { return 0.0 };
        let (mut length, mut last) = (0.0, first);
        for position in fixed {
            length += last.distance(position);
            last = position;
        }
        if self.chain.closed { length + last.distance(first) } else { length }
    }

    /// The displacement of every node: given at moved ones, zero elsewhere.
    fn checked_moves(&self, positions: &[DVec3], moves: &[(u32, DVec3)]) -> Result<Vec<DVec3>, SolverError> {
        let mut field = vec![DVec3::ZERO; self.chain.count];
        for (node, displacement) in predictor::checked_moves(positions, &self.fixed, moves)? {
            field[node as usize] = displacement;
        }
        Ok(field)
    }
}

/// How many nodes to either side the rows of an objective reach.
fn reach(objective: Objective) -> usize {
    if objective == Objective::Fair { 3 } else { 2 }
}

fn half_diagonal(positions: &[DVec3]) -> f64 {
    half_diagonal_of(positions.iter().copied())
}

/// Zero for no points.
fn half_diagonal_of(positions: impl Iterator<Item = DVec3>) -> f64 {
    let box_of = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (low, high) = positions.fold(box_of, |(low, high), p| (low.min(p), high.max(p)));
    if low.x <= high.x { 0.5 * (high - low).length() } else { 0.0 }
}

/// A direct solve can fail on degenerate curves only.
type Solved<T> = Result<T, FactorError>;

#[cfg(test)]
mod tests;
