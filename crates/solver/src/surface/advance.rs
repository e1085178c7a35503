//! The second half of a step: how far to go along the direction, what to accept, and when a shape rests.
//!
//! Source: recipe section 4.

use glam::DVec3;

use super::{SurfaceSolver, matrix};
use crate::cg;
use crate::line_search::{Found, Search};
use crate::report::StepReport;

/// Move below which a step counts as rest, in units of the local mean edge.
pub(super) const REST_MOVE: f64 = 1e-3;
/// Predicted decrease below which a step counts towards rest, relative to the energy.
const REST_DECREASE: f64 = 1e-6;
/// The same for a small move to count as rest where curvature variation is minimised: a rough spot can outweigh all the
/// rest of a shape so far that a short direction mends nothing else.
const REST_VARIATION: f64 = 1e-4;
/// Steps of small predicted decrease that make rest.
const REST_STEPS: u32 = 3;
/// Move below which nothing moves any more, in units of the local mean edge, and the steps of such moves that make rest: an
/// energy can have a kink at its least place, where every direction promises a decrease that no length of step keeps.
const STILL_MOVE: f64 = 1e-6;
const STILL_STEPS: u32 = 20;
/// Damping up to which a short move is not short because it is damped.
const STILL_DAMPING: f64 = 100.0;
/// Residual above which a direction says nothing about rest: the budget was too small.
const REST_RESIDUAL: f64 = 0.3;
/// Decrease, relative to the energy, that rounding could fake: nothing is left to gain.
const NOISE: f64 = 1e-14;
/// Part of a plane's own size by which a fit is off for each node of it.
const NOISE_OF_NODE: f64 = 32.0 * f64::EPSILON;
/// Damping is raised by this after a failed search, up to the maximum, and lowered again by success.
const DAMPING_RAISE: f64 = 10.0;
const DAMPING_LOWER: f64 = 0.2;
const DAMPING_MAX: f64 = 1e8;

impl SurfaceSolver {
    /// Line search along the direction, acceptance, rest.
    pub(super) fn advance(&mut self, positions: &mut [DVec3], report: &mut StepReport) {
        let is_hardly_damped = self.damping <= STILL_DAMPING;
        self.search_and_accept(positions, report);
        let is_telling = is_hardly_damped && report.residual <= REST_RESIDUAL;
        // Of rounding errors no direction is sure, and damping helps none.
        let is_still = report.energy.is_finite()
            && (is_telling || report.energy <= self.energy_of_rounding())
            && report.largest_relative_move < STILL_MOVE;
        self.still_steps = if is_still { self.still_steps + 1 } else { 0 };
        report.at_rest |= self.still_steps >= STILL_STEPS;
    }

    /// What rounding makes of a plane: each node's curvature is off by some `ε R/h²`, and `R²/h²` is about the number of nodes.
    fn energy_of_rounding(&self) -> f64 {
        let noise = NOISE_OF_NODE * self.unknowns.len() as f64;
        noise * noise
    }

    /// What was on its way to rest has to show it anew: the shape or what it minimises was changed.
    pub(super) fn stir(&mut self) {
        self.quiet_steps = 0;
        self.still_steps = 0;
        self.rests = false;
    }

    fn search_and_accept(&mut self, positions: &mut [DVec3], report: &mut StepReport) {
        let slope = -2.0 * cg::dot(&self.rhs, &self.alpha);
        let energy = self.fits.energy;
        let is_converged = report.residual <= REST_RESIDUAL;
        // Nothing left to gain, or nothing to go by.
        if !(slope < -NOISE * energy) || !slope.is_finite() || !energy.is_finite() {
            report.damped = !(slope.is_finite() && energy.is_finite());
            if !report.damped && self.damping > 1.0 {
                // So little may be left because of the damping alone.
                self.damping = (self.damping * DAMPING_LOWER).max(1.0);
                return;
            }
            // A gradient of rounding errors need not let the conjugate gradients converge: then it must show three times.
            self.quiet_steps = if report.damped { 0 } else { self.quiet_steps + 1 };
            let is_sure = is_converged || (report.cg_iterations > 0 && self.quiet_steps >= REST_STEPS);
            report.at_rest = !report.damped && is_sure;
            return;
        }
        // A damped direction is short because it is damped, which says nothing about rest; unless no damping helps.
        let is_free = self.damping <= 1.0;
        let is_telling = is_converged && (is_free || self.damping >= DAMPING_MAX);
        let found = self.search(slope);
        report.halvings = found.halvings;
        report.step_scale = found.scale;
        report.predicted_decrease = -slope * found.scale;
        self.quiet_steps =
            if -slope < REST_DECREASE * energy && is_telling { self.quiet_steps + 1 } else { 0 };
        if !found.is_accepted {
            self.damping = (self.damping * DAMPING_RAISE).min(DAMPING_MAX);
            report.damped = true;
            report.at_rest = self.quiet_steps >= REST_STEPS;
            return;
        }
        self.damping = (self.damping * DAMPING_LOWER).max(1.0);
        for (&node, &alpha) in self.unknowns.nodes.iter().zip(&self.alpha) {
            let distance = found.scale * alpha.abs();
            report.largest_move = report.largest_move.max(distance);
            let h = self.fits.nodes[node as usize].h;
            report.largest_relative_move = report.largest_relative_move.max(distance / h);
        }
        std::mem::swap(&mut self.fits, &mut self.trial);
        self.fits.copy_positions(positions);
        self.take_normals();
        report.energy = self.fits.energy;
        let is_small = report.largest_relative_move < REST_MOVE
            && found.halvings == 0
            && report.residual <= self.settings.step_tolerance
            && is_free
            && (self.goals.network.is_none() || -slope < REST_VARIATION * energy);
        report.at_rest = is_small || self.quiet_steps >= REST_STEPS;
    }

    /// On the energy, or where neutral nodes have none, on the slope along the direction.
    fn search(&mut self, slope: f64) -> Found {
        let search = Search {
            goals: &self.goals,
            rings: &self.rings,
            unknowns: &self.unknowns,
            fits: &self.fits,
            alpha: &self.alpha,
            slope,
            wanted: self.next_wanted,
        };
        let (positions, trial) = (&mut self.trial_positions, &mut self.trial);
        if !self.goals.has_neutral {
            return search.by_energy(positions, trial);
        }
        let (rhs, scratch) = (&mut self.trial_rhs, &mut self.scratch);
        search.by_slope(positions, trial, |trial| {
            matrix::slopes(&self.goals, &self.rings, trial, &self.unknowns, rhs, scratch);
            -2.0 * cg::dot(rhs, &self.alpha)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A raised disc with the exact slopes in hand.
    fn ready() -> (SurfaceSolver, Vec<DVec3>) {
        let (mut solver, positions) = workload::raised_disc(6, 0.3).unwrap();
        solver.evaluate(&positions);
        solver.slopes();
        (solver, positions)
    }

    fn report(solver: &SurfaceSolver, residual: f64, cg_iterations: u32) -> StepReport {
        let energy = solver.energy();
        StepReport { energy_before: energy, energy, residual, cg_iterations, ..StepReport::default() }
    }

    #[test]
    fn a_direction_that_leads_uphill_is_given_up_after_twenty_halvings_and_damps_the_next() {
        let (mut solver, mut positions) = ready();
        let before = positions.clone();
        // Both turned round: the slope claims a descent that is none.
        solver.rhs.iter_mut().for_each(|value| *value = -*value);
        solver.alpha = solver.rhs.clone();
        let mut wanted = 1.0;
        for _ in 0..10 {
            let mut report = report(&solver, 0.0, 5);
            solver.advance(&mut positions, &mut report);
            wanted = f64::min(10.0 * wanted, 1e8);
            assert_eq!((report.halvings, report.damped, report.step_scale), (20, true, 0.0));
            assert_eq!(solver.damping, wanted);
            assert_eq!(positions, before);
        }
        // A step that succeeds lowers the damping again, in the end to what it was.
        let mut last = solver.damping;
        for _ in 0..30 {
            let report = solver.step(&mut positions, crate::Budget::default()).unwrap();
            assert!(!report.damped, "{report:?}");
            assert!(solver.damping < last || last == 1.0, "{} after {last}: {report:?}", solver.damping);
            last = solver.damping;
            if report.at_rest {
                break;
            }
        }
        assert_eq!(last, 1.0, "no rest is claimed before the damping is gone");
    }

    #[test]
    fn three_steps_of_hardly_any_decrease_are_rest() {
        let (mut solver, mut positions) = ready();
        for step in 1..=3 {
            solver.evaluate(&positions);
            solver.slopes();
            let squares = cg::dot(&solver.rhs, &solver.rhs);
            let share = 0.1 * REST_DECREASE * solver.energy() / squares;
            solver.alpha = solver.rhs.iter().map(|value| share * value).collect();
            // A residual that does not let a small move count by itself.
            let mut report = report(&solver, 0.2, 5);
            solver.advance(&mut positions, &mut report);
            assert!(!report.damped);
            assert_eq!(report.at_rest, step == 3, "step {step}");
        }
    }

    #[test]
    fn where_twenty_steps_move_nothing_though_hardly_damped_is_rest() {
        let (mut solver, mut positions) = ready();
        let before = positions.clone();
        solver.rhs.iter_mut().for_each(|value| *value = -*value);
        solver.alpha = solver.rhs.clone();
        for step in 1..=20 {
            solver.damping = 2.0;
            let mut report = report(&solver, 0.0, 5);
            solver.advance(&mut positions, &mut report);
            assert!(report.damped);
            assert_eq!(report.at_rest, step == 20, "step {step}");
        }
        assert_eq!(positions, before);
        // One that moves, or is short because it is damped, begins the count anew.
        solver.damping = 1e4;
        let mut report = report(&solver, 0.0, 5);
        solver.advance(&mut positions, &mut report);
        assert!(!report.at_rest && solver.still_steps == 0);
        // So does whatever stirs the shape: one failed step after it is no rest.
        solver.still_steps = 19;
        solver.damping = 2.0;
        let held = solver.fixed().iter().position(|fixed| *fixed).unwrap();
        solver.predict(&mut positions, &[(u32::try_from(held).unwrap(), DVec3::Z * 1e-3)]).unwrap();
        assert_eq!(solver.still_steps, 0);
    }

    #[test]
    fn what_has_only_the_energy_of_rounding_errors_rests_though_no_direction_is_sure() {
        for (raise, rests) in [(1e-14, true), (1e-3, false)] {
            let (mut solver, mut positions) = workload::raised_disc(6, raise).unwrap();
            solver.evaluate(&positions);
            solver.slopes();
            assert_eq!(solver.energy() <= solver.energy_of_rounding(), rests, "{}", solver.energy());
            solver.rhs.iter_mut().for_each(|value| *value = -*value);
            solver.alpha = solver.rhs.clone();
            for step in 1..=STILL_STEPS {
                solver.damping = 1e4;
                let mut report = report(&solver, 0.9, 40);
                solver.advance(&mut positions, &mut report);
                assert_eq!(report.at_rest, rests && step == STILL_STEPS, "step {step}");
            }
        }
    }

    #[test]
    fn a_slope_of_rounding_errors_is_rest_at_once_if_the_direction_is_sure_and_else_the_third_time() {
        let (mut solver, mut positions) = ready();
        solver.rhs.fill(0.0);
        solver.alpha = solver.rhs.clone();
        let mut sure = report(&solver, 0.0, 5);
        solver.advance(&mut positions, &mut sure);
        assert!(sure.at_rest && !sure.damped);
        solver.quiet_steps = 0;
        for step in 1..=3 {
            let mut unsure = report(&solver, 1.0, 5);
            solver.advance(&mut positions, &mut unsure);
            assert_eq!(unsure.at_rest, step == 3, "step {step}");
        }
    }

    #[test]
    fn a_direction_that_is_no_number_is_not_rest() {
        let (mut solver, mut positions) = ready();
        let before = positions.clone();
        solver.alpha = vec![f64::NAN; solver.rhs.len()];
        let mut report = report(&solver, 0.0, 5);
        solver.advance(&mut positions, &mut report);
        assert!(report.damped && !report.at_rest);
        assert_eq!(positions, before);
    }
}
