//! Fair curves: `∫ κ² ds` over a polygon, with the same verbs as a surface.
//!
//! Source: recipe section 10 and Welch 1995, sections 5.3.3 and 5.4.1: the surface's story in one dimension, with
//! the exact gradient instead of the frozen one. A node has two unknowns, offsets in the plane normal to its tangent.
//! Curves are short, so the linear systems are solved directly. `∫ κ² ds` favours growth; a rope that is slack on
//! ordinary shapes (see `energy`) keeps a curve within reach of its control points.
//!
//! ```
//! use ductile_solver::{CurveSettings, CurveSolver};
//! use glam::DVec3;
//! let mut solver = CurveSolver::new(5, false, vec![true, false, true, false, true], CurveSettings::default()).unwrap();
//! let mut positions: Vec<DVec3> = (0..5).map(|i| DVec3::new(i as f64, (i % 2) as f64, 0.0)).collect();
//! let report = solver.step(&mut positions).unwrap();
//! assert!(report.energy <= report.energy_before);
//! ```

mod energy;
mod resample;
mod system;

use glam::DVec3;

use crate::error::{SolverError, check_length, check_positions};
use crate::factor::FactorError;
use crate::predictor::{self, Predicted};
use crate::report::StepReport;

pub use resample::{Resampled, resample, respace};

use energy::{Bends, Price};
use system::{Frames, System};

/// Move below which a step counts as rest, in units of the local edge.
const REST_MOVE: f64 = 1e-3;
/// Predicted decrease below which a step counts towards rest, relative to the energy; three such steps make rest.
const REST_DECREASE: f64 = 1e-6;
const REST_STEPS: u32 = 3;
/// Decrease that rounding could fake.
const NOISE: f64 = 1e-14;
const MAX_HALVINGS: u32 = 20;
const SUFFICIENT: f64 = 1e-4;

/// Numbers that steer a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct CurveSettings {
    /// Largest relative strain of an edge in one predictor call.
    pub strain_limit: f64,
    /// Mass damping where the constraints hold the curve.
    pub damping: f64,
    /// Mass damping where they do not.
    pub loose_damping: f64,
    /// Price of length, per length. Zero is the pure `∫ κ² ds`.
    pub tension: f64,
    /// Length, in units of the control polygon, up to which nothing pulls it back; infinite for no limit at all.
    /// A curve without a control polygon may grow to its first length.
    pub slack: f64,
}

impl Default for CurveSettings {
    fn default() -> Self {
        // A circle through both ends of its diameter is π/2 as long as its control polygon; more points need less.
        Self { strain_limit: 0.5, damping: 0.1, loose_damping: 10.0, tension: 0.0, slack: 1.6 }
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
        let last = self.count.checked_sub(1)?;
        match (node == 0, node == last) {
            (false, false) => Some((node - 1, node + 1)),
            _ if !self.closed || self.count < 3 => None,
            (true, _) => Some((last, 1)),
            (_, true) => Some((node - 1, 0)),
        }
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
    settings: CurveSettings,
    /// The first length seen: how long a curve without a control polygon may get.
    first_length: Option<f64>,
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
            offsets: System::new(chain, &fixed, 2)?,
            fields: System::new(chain, &fixed, 1)?,
            bends: Bends::new(node_count),
            trial: Bends::new(node_count),
            trial_positions: vec![DVec3::ZERO; node_count],
            gradient: vec![DVec3::ZERO; node_count],
            frames: Frames::default(),
            first_length: None,
            damping: 1.0,
            quiet_steps: 0,
            chain,
            fixed,
            settings,
        })
    }

    /// Changes which nodes are fixed.
    pub fn set_fixed(&mut self, fixed: Vec<bool>) -> Result<(), SolverError> {
        check_length(self.chain.count, fixed.len())?;
        if fixed != self.fixed {
            self.offsets = System::new(self.chain, &fixed, 2)?;
            self.fields = System::new(self.chain, &fixed, 1)?;
            self.fixed = fixed;
            self.quiet_steps = 0;
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
            self.fields.carry(self.chain, &self.bends, &mut field)?;
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

    /// One non-linear step. Never raises the energy; a failed search leaves the positions alone.
    pub fn step(&mut self, positions: &mut [DVec3]) -> Result<StepReport, SolverError> {
        check_positions(self.chain.count, positions)?;
        self.measure(positions);
        let mut report = StepReport {
            energy_before: self.bends.energy,
            energy: self.bends.energy,
            ..StepReport::default()
        };
        self.bends.gradient(self.chain, &mut self.gradient);
        self.frames.transport(self.chain, &self.bends);
        let radius = half_diagonal(positions);
        let mu =
            self.damping * if self.is_loose() { self.settings.loose_damping } else { self.settings.damping };
        let mass = if radius > 0.0 { mu / (radius * radius * radius * radius) } else { 0.0 };
        let solved = self.offsets.newton(self.chain, &self.bends, &self.frames, &self.gradient, mass);
        let Ok(slope) = solved else {
            self.damping = (self.damping * 10.0).min(1e8);
            report.damped = true;
            return Ok(report);
        };
        self.advance(positions, slope, &mut report);
        Ok(report)
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
        self.bends.gradient(self.chain, &mut self.gradient);
        &self.gradient
    }

    /// Whether too few points are fixed for the curve to have a minimiser of its own.
    fn is_loose(&self) -> bool {
        let needed = if self.chain.closed { 3 } else { 2 };
        self.fixed.iter().filter(|fixed| **fixed).take(needed).count() < needed
    }

    fn measure(&mut self, positions: &[DVec3]) {
        let polygon = self.polygon(positions);
        let first = *self.first_length.get_or_insert_with(|| {
            self.chain.edges().map(|(from, to)| positions[from].distance(positions[to])).sum()
        });
        let reference = if polygon > 0.0 { self.settings.slack * polygon } else { first };
        let reference = if reference > 0.0 { reference } else { f64::INFINITY };
        let price = Price { tension: self.settings.tension, reference };
        self.bends.measure(self.chain, positions, price);
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

    /// Line search along the offsets, acceptance, rest.
    fn advance(&mut self, positions: &mut [DVec3], slope: f64, report: &mut StepReport) {
        let energy = self.bends.energy;
        if !(slope < -NOISE * energy) || !slope.is_finite() || !energy.is_finite() {
            report.damped = !(slope.is_finite() && energy.is_finite());
            report.at_rest = !report.damped;
            return;
        }
        let moves = self.offsets.displacements(&self.frames, self.chain.count);
        let mut scale = self.first_scale(&moves);
        self.quiet_steps = if -slope < REST_DECREASE * energy { self.quiet_steps + 1 } else { 0 };
        for halvings in 0..=MAX_HALVINGS {
            for ((trial, &position), &offset) in self.trial_positions.iter_mut().zip(&*positions).zip(&moves)
            {
                *trial = position + offset * scale;
            }
            self.trial.measure(self.chain, &self.trial_positions, self.bends.price);
            report.halvings = halvings;
            if self.trial.energy <= energy + SUFFICIENT * scale * slope {
                self.accept(positions, &moves, scale, report);
                report.predicted_decrease = -slope * scale;
                return;
            }
            scale *= 0.5;
        }
        self.damping = (self.damping * 10.0).min(1e8);
        report.damped = true;
        report.at_rest = self.quiet_steps >= REST_STEPS;
    }

    fn accept(&mut self, positions: &mut [DVec3], moves: &[DVec3], scale: f64, report: &mut StepReport) {
        self.damping = (self.damping * 0.2).max(1.0);
        for (&offset, bend) in moves.iter().zip(&self.bends.nodes) {
            let distance = scale * offset.length();
            report.largest_move = report.largest_move.max(distance);
            report.largest_relative_move = report.largest_relative_move.max(distance / bend.ds);
        }
        positions.copy_from_slice(&self.trial_positions);
        std::mem::swap(&mut self.bends, &mut self.trial);
        report.energy = self.bends.energy;
        report.step_scale = scale;
        let is_small = report.largest_relative_move < REST_MOVE && report.halvings == 0;
        report.at_rest = is_small || self.quiet_steps >= REST_STEPS;
    }

    /// Below half a radius of curvature, and no edge sheared by more than one half.
    fn first_scale(&self, moves: &[DVec3]) -> f64 {
        let mut worst = 0.5_f64;
        for (offset, curvature) in moves.iter().zip(&self.bends.curvatures) {
            worst = worst.max(offset.length() * curvature.length());
        }
        0.5 / worst.max(self.strain(moves))
    }

    /// Largest relative strain of an edge with a free end.
    fn strain(&self, field: &[DVec3]) -> f64 {
        let mut worst = 0.0_f64;
        for (from, to) in self.chain.edges() {
            if self.fixed[from] && self.fixed[to] {
                continue;
            }
            let floor = 0.1 * self.bends.nodes[from].ds;
            let length = self.bends.positions[from].distance(self.bends.positions[to]).max(floor);
            worst = worst.max((field[from] - field[to]).length() / length.max(f64::MIN_POSITIVE));
        }
        worst
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

fn half_diagonal(positions: &[DVec3]) -> f64 {
    let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    if positions.is_empty() { 0.0 } else { 0.5 * (high - low).length() }
}

/// A direct solve can fail on degenerate curves only.
type Solved<T> = Result<T, FactorError>;

#[cfg(test)]
mod tests;
