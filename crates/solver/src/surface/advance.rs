//! The second half of a step: how far to go along the direction, what to accept, and when a shape rests.
//!
//! Source: recipe section 4.

use glam::DVec3;

use super::{SurfaceSolver, matrix};
use crate::cg;
use crate::line_search::{Found, Search};
use crate::report::StepReport;

/// Move below which a step counts as rest, in units of the local mean edge.
const REST_MOVE: f64 = 1e-3;
/// Predicted decrease below which a step counts towards rest, relative to the energy.
const REST_DECREASE: f64 = 1e-6;
/// The same for a small move to count as rest where curvature variation is minimised: a rough spot can outweigh all the
/// rest of a shape so far that a short direction mends nothing else.
const REST_VARIATION: f64 = 1e-4;
/// Steps of small predicted decrease that make rest.
const REST_STEPS: u32 = 3;
/// Residual above which a direction says nothing about rest: the budget was too small.
const REST_RESIDUAL: f64 = 0.3;
/// Decrease, relative to the energy, that rounding could fake: nothing is left to gain.
const NOISE: f64 = 1e-14;
/// Damping is raised by this after a failed search, up to the maximum, and lowered again by success.
const DAMPING_RAISE: f64 = 10.0;
const DAMPING_LOWER: f64 = 0.2;
const DAMPING_MAX: f64 = 1e8;

impl SurfaceSolver {
    /// Line search along the direction, acceptance, rest.
    pub(super) fn advance(&mut self, positions: &mut [DVec3], report: &mut StepReport) {
        let slope = -2.0 * cg::dot(&self.rhs, &self.alpha);
        let energy = self.fits.energy;
        let is_converged = report.residual <= REST_RESIDUAL;
        // Nothing left to gain, or nothing to go by.
        if !(slope < -NOISE * energy) || !slope.is_finite() || !energy.is_finite() {
            report.damped = !(slope.is_finite() && energy.is_finite());
            // A gradient of rounding errors need not let the conjugate gradients converge: then it must show three times.
            self.quiet_steps = if report.damped { 0 } else { self.quiet_steps + 1 };
            let is_sure = is_converged || (report.cg_iterations > 0 && self.quiet_steps >= REST_STEPS);
            report.at_rest = !report.damped && is_sure;
            return;
        }
        let found = self.search(slope);
        report.halvings = found.halvings;
        report.step_scale = found.scale;
        report.predicted_decrease = -slope * found.scale;
        self.quiet_steps =
            if -slope < REST_DECREASE * energy && is_converged { self.quiet_steps + 1 } else { 0 };
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
        positions.copy_from_slice(&self.fits.positions);
        for (normal, fit) in self.normals.iter_mut().zip(&self.fits.nodes) {
            *normal = fit.normal;
        }
        report.energy = self.fits.energy;
        let is_small = report.largest_relative_move < REST_MOVE
            && found.halvings == 0
            && report.residual <= self.settings.step_tolerance
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
