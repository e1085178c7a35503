//! One step of a curve: a direction, a line search, and whether it rests.
//!
//! Source: recipe sections 4 and 10. A direction solves the Gauss-Newton system of the objective; the search starts at a
//! clamp that does not depend on the sampling and halves until the true energy falls. `neutral` has no energy: there
//! the pull along the direction has to fall without turning round.
//!
//! The third-order systems are good near a fair curve only: from a crease they ask for moves without bound, and the
//! clamp leaves nothing of them. There the direction of the thin plate is tried as well, which smooths a crease in a
//! step or two, and what does more for the energy is taken. (Ours; the recipe starts from smooth curves.)

use glam::DVec3;

use super::{CurveSolver, Solved, half_diagonal};
use crate::error::{SolverError, check_positions};
use crate::objective::Objective;
use crate::report::StepReport;

/// Move below which a step counts as rest, in units of the local edge.
pub(super) const REST_MOVE: f64 = 1e-3;
/// Predicted decrease below which a step counts towards rest, relative to the energy; three such steps make rest.
pub(super) const REST_DECREASE: f64 = 1e-6;
pub(super) const REST_STEPS: u32 = 3;
/// Decrease that rounding could fake.
pub(super) const NOISE: f64 = 1e-14;
pub(super) const MAX_HALVINGS: u32 = 20;
pub(super) const SUFFICIENT: f64 = 1e-4;
/// A move in units of the local edge that a failed search may leave undone.
pub(super) const UNSEEN: f64 = 1e-9;
/// A direction of which the clamp leaves less than this comes from a rough curve.
pub(super) const ROUGH: f64 = 0.25;
/// A rough curve is smoothed as long as that promises to take this part of its bending.
const SMOOTHING: f64 = 1e-3;

/// A clamp folded up to this (half the length of the sum of chord and tangent) is stuck.
const AGAINST: f64 = 1e-2;
/// How far aside its chord's end is moved, in chords: enough for the barrier to see which way is out.
const ASIDE: f64 = 0.1;

/// A way to go, and how fast the objective falls along it at first.
struct Direction {
    moves: Vec<DVec3>,
    slope: f64,
    /// Whether the objective's pull is judged, for want of an energy.
    by_pull: bool,
}

/// A trial that passed.
#[derive(Clone, Copy)]
struct Found {
    scale: f64,
    halvings: u32,
    energy: f64,
}

impl CurveSolver {
    /// One non-linear step. Never raises the energy; a failed search leaves the positions alone. (The energy of
    /// `neutral` is not what it follows and may rise.)
    pub fn step(&mut self, positions: &mut [DVec3]) -> Result<StepReport, SolverError> {
        check_positions(self.chain.count, positions)?;
        // Alone, a curve is in no network.
        self.set_turning(Vec::new())?;
        self.measure(positions);
        let energy = self.bends.energy;
        let mut report = StepReport { energy_before: energy, energy, ..StepReport::default() };
        self.unfold(positions);
        let energy = self.bends.energy;
        report.energy = energy;
        self.frames.transport(self.chain, &self.bends);
        let Ok(own) = self.direction(positions, self.settings.objective) else {
            self.damp(&mut report);
            return Ok(report);
        };
        if !(own.slope < -NOISE * energy) || !own.slope.is_finite() || !energy.is_finite() {
            report.damped = !(own.slope.is_finite() && energy.is_finite());
            report.at_rest = !report.damped;
            return Ok(report);
        }
        self.quiet_steps = if -own.slope < REST_DECREASE * energy { self.quiet_steps + 1 } else { 0 };
        let mut found = self.search(positions, &own);
        let mut taken = &own;
        let smoother = self.smoother(positions, &own, found);
        if let Some(smoother) = &smoother {
            let other = self.search(positions, smoother);
            let is_less = |other: Found| {
                smoother.by_pull == own.by_pull && found.is_some_and(|own| own.energy <= other.energy)
            };
            match (other.filter(|other| !is_less(*other)), found) {
                (Some(other), _) => (found, taken) = (Some(other), smoother),
                // Back to the state of the first trial.
                (None, Some(_)) => found = self.search(positions, &own),
                (None, None) => {}
            }
        }
        match found {
            Some(found) => self.accept(positions, taken, found, &mut report),
            // A straight line has no energy to compare with: what is left are the roundings of its places.
            None if self.damping <= 1.0 && self.relative(&own.moves) < UNSEEN => report.at_rest = true,
            None => {
                self.damp(&mut report);
                report.at_rest = self.quiet_steps >= REST_STEPS;
            }
        }
        Ok(report)
    }

    /// Largest move in units of the length that belongs to its node.
    pub(super) fn relative(&self, moves: &[DVec3]) -> f64 {
        moves.iter().zip(&self.bends.ds).fold(0.0, |largest, (offset, ds)| largest.max(offset.length() / ds))
    }

    /// A chord that runs straight against its prescribed tangent is pulled to no side at all, though it may be at the top
    /// of a hill: its free end is moved aside a little, if that costs nothing.
    pub(super) fn unfold(&mut self, positions: &mut [DVec3]) {
        let is_stuck = |jacobian: f64| jacobian < AGAINST;
        if !self.bends.hinges.iter().any(|h| h.is_clamp() && h.is_sound && is_stuck(h.jacobian)) {
            return;
        }
        self.trial_positions.copy_from_slice(positions);
        for hinge in self.bends.hinges.iter().filter(|h| h.is_clamp() && h.is_sound && is_stuck(h.jacobian)) {
            if let Some(end) = hinge.before.or(hinge.after).filter(|&end| !self.fixed[end]) {
                let aside = hinge.tangent().any_orthonormal_vector();
                self.trial_positions[end] += aside * (ASIDE * 2.0 * hinge.ds);
            }
        }
        self.trial.measure(self.chain, &self.trial_positions, self.bends.character);
        if self.trial.energy < self.bends.energy {
            positions.copy_from_slice(&self.trial_positions);
            std::mem::swap(&mut self.bends, &mut self.trial);
        }
    }

    fn damp(&mut self, report: &mut StepReport) {
        self.damping = (self.damping * 10.0).min(1e8);
        report.damped = true;
    }

    /// The Newton direction of an objective, priced by the curve's own.
    fn direction(&mut self, positions: &[DVec3], objective: Objective) -> Solved<Direction> {
        let own = self.settings.objective;
        let character = self.character(positions, objective);
        let mu =
            self.damping * if self.is_loose() { self.settings.loose_damping } else { self.settings.damping };
        let mass = character.mass(mu, half_diagonal(positions));
        self.bends.gradient(self.chain, character, &mut self.gradient);
        if objective == Objective::Membrane {
            let moves = self.fields.tighten(self.chain, &self.bends, &self.gradient, mass)?;
            let slope = self.gradient.iter().zip(&moves).map(|(g, m)| g.dot(*m)).sum();
            return Ok(Direction { moves, slope, by_pull: false });
        }
        let mut slope =
            self.offsets.newton(self.chain, &self.bends, &self.frames, character, &self.gradient, mass)?;
        let moves = self.offsets.displacements(&self.frames, self.chain.count);
        if objective != own && own != Objective::Neutral {
            self.bends.gradient(self.chain, self.bends.character, &mut self.gradient);
            slope = self.gradient.iter().zip(&moves).map(|(g, m)| g.dot(*m)).sum();
        }
        Ok(Direction { moves, slope, by_pull: objective == Objective::Neutral })
    }

    /// The direction of the thin plate, where the curve is too rough for its own.
    fn smoother(&mut self, positions: &[DVec3], own: &Direction, found: Option<Found>) -> Option<Direction> {
        let is_third_order = matches!(self.settings.objective, Objective::Fair | Objective::Neutral);
        if !is_third_order || (found.is_some() && self.first_scale(&own.moves) >= ROUGH) {
            return None;
        }
        let plate = self.direction(positions, Objective::ThinPlate).ok()?;
        let least = if self.settings.objective == Objective::Neutral { SMOOTHING } else { NOISE };
        (plate.slope < -least * self.bends.energy).then_some(plate)
    }

    /// Line search; the trial that passed is left in `trial`.
    fn search(&mut self, positions: &[DVec3], direction: &Direction) -> Option<Found> {
        let is_taut = self.settings.objective == Objective::Membrane;
        // A taut string has one shape and no folds to fear: its own system bounds its length from above.
        let mut scale = if is_taut { 1.0 } else { self.first_scale(&direction.moves) };
        for halvings in 0..=MAX_HALVINGS {
            let moved = positions.iter().zip(&direction.moves);
            for (trial, (&position, &offset)) in self.trial_positions.iter_mut().zip(moved) {
                *trial = position + offset * scale;
            }
            self.trial.measure(self.chain, &self.trial_positions, self.bends.character);
            if self.is_better(direction, scale) {
                return Some(Found { scale, halvings, energy: self.trial.energy });
            }
            scale *= 0.5;
        }
        None
    }

    /// Whether the trial does.
    fn is_better(&mut self, direction: &Direction, scale: f64) -> bool {
        if !direction.by_pull {
            return self.trial.energy <= self.bends.energy + SUFFICIENT * scale * direction.slope;
        }
        self.trial.gradient(self.chain, self.trial.character, &mut self.gradient);
        let pulls = self.gradient.iter().zip(&direction.moves);
        let pull: f64 = pulls.map(|(pull, offset)| pull.dot(*offset)).sum();
        pull.abs() <= -direction.slope * (1.0 - SUFFICIENT * scale)
    }

    fn accept(
        &mut self,
        positions: &mut [DVec3],
        direction: &Direction,
        found: Found,
        report: &mut StepReport,
    ) {
        self.damping = (self.damping * 0.2).max(1.0);
        let scale = found.scale;
        for (&offset, &ds) in direction.moves.iter().zip(&self.bends.ds) {
            let distance = scale * offset.length();
            report.largest_move = report.largest_move.max(distance);
            report.largest_relative_move = report.largest_relative_move.max(distance / ds);
        }
        positions.copy_from_slice(&self.trial_positions);
        std::mem::swap(&mut self.bends, &mut self.trial);
        report.energy = self.bends.energy;
        report.step_scale = scale;
        report.halvings = found.halvings;
        report.predicted_decrease = -direction.slope * scale;
        let is_small = report.largest_relative_move < REST_MOVE && report.halvings == 0;
        report.at_rest = is_small || self.quiet_steps >= REST_STEPS;
    }

    /// Below half a radius of curvature, and no edge sheared by more than one half.
    pub(super) fn first_scale(&self, moves: &[DVec3]) -> f64 {
        let mut worst = 0.5_f64;
        for (offset, curvature) in moves.iter().zip(&self.bends.curvatures) {
            worst = worst.max(offset.length() * curvature.length());
        }
        0.5 / worst.max(self.strain(moves))
    }

    /// Largest relative strain of an edge with a free end.
    pub(super) fn strain(&self, field: &[DVec3]) -> f64 {
        let mut worst = 0.0_f64;
        for (from, to) in self.chain.edges() {
            if self.fixed[from] && self.fixed[to] {
                continue;
            }
            let floor = 0.1 * self.bends.ds[from];
            let length = self.bends.positions[from].distance(self.bends.positions[to]).max(floor);
            worst = worst.max((field[from] - field[to]).length() / length.max(f64::MIN_POSITIVE));
        }
        worst
    }
}

#[cfg(test)]
mod tests;
