//! Curves that meet at hubs, solved together.
//!
//! Source: recipe section 10 (see `hub` for what is kept, and how). The unknowns are the offsets of every curve, as in
//! `step`, and at each spoke the turn `δt` of its tangent, in the plane normal to it. Without its hub every curve has its
//! own Gauss-Newton system, solved as ever; `couples` bends the solutions to the hubs. The search halves until the sum
//! of the true energies falls.

use glam::DVec3;

use super::couples;
use super::hub::{Hub, Rib};
use super::step::{MAX_HALVINGS, NOISE, REST_DECREASE, REST_MOVE, REST_STEPS, ROUGH, SUFFICIENT, UNSEEN};
use super::{CurveSolver, Solved, half_diagonal};
use crate::error::{SolverError, check_positions};
use crate::objective::Objective;
use crate::report::StepReport;

/// Most spokes of a network: its small system is dense.
const MOST_SPOKES: usize = 256;
/// Largest turn of a tangent in one step, in radians.
const LARGEST_TURN: f64 = 0.5;
/// A curve that passes through a hub.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spoke {
    /// Which of the network's curves.
    pub curve: usize,
    /// The fixed node at the hub.
    pub node: u32,
}

/// A curve of a network with its positions.
#[derive(Debug)]
pub struct Strand<'a> {
    /// Its solver.
    pub solver: &'a mut CurveSolver,
    /// Its nodes.
    pub positions: &'a mut [DVec3],
}

/// The hubs of curves that are solved together.
#[derive(Clone, Debug, Default)]
pub struct Network {
    hubs: Vec<Hub>,
    /// Which of the hubs that were asked for each one is.
    places: Vec<usize>,
    is_laid: bool,
    damping: f64,
    quiet_steps: u32,
}

/// A way to go: offsets by curve, tilts by hub, turns by hub and rib.
struct Direction {
    moves: Vec<Vec<DVec3>>,
    tilts: Vec<DVec3>,
    turns: Vec<Vec<DVec3>>,
    slope: f64,
}

/// A trial that passed.
struct Found {
    scale: f64,
    halvings: u32,
    energy: f64,
    hubs: Vec<Hub>,
}

impl Network {
    /// A network with these hubs. Fewer than three spokes make no hub, and a spoke belongs to the first that names it.
    ///
    /// # Errors
    /// [`SolverError::TooManySpokes`].
    pub fn new(hubs: &[Vec<Spoke>]) -> Result<Self, SolverError> {
        let free: Vec<(Vec<Spoke>, Option<DVec3>)> =
            hubs.iter().map(|spokes| (spokes.clone(), None)).collect();
        Self::with_planes(&free)
    }

    /// The same, where planes of hubs may be prescribed by their normals, of any length but zero: then a single spoke makes a hub.
    ///
    /// # Errors
    /// [`SolverError::TooManySpokes`].
    pub fn with_planes(hubs: &[(Vec<Spoke>, Option<DVec3>)]) -> Result<Self, SolverError> {
        let mut taken = std::collections::BTreeSet::new();
        let mut network = Self { damping: 1.0, ..Self::default() };
        for (place, (spokes, plane)) in hubs.iter().enumerate() {
            let free: Vec<Spoke> = spokes.iter().copied().filter(|spoke| !taken.contains(spoke)).collect();
            let plane = plane.and_then(DVec3::try_normalize);
            if free.len() < if plane.is_some() { 1 } else { 3 } {
                continue;
            }
            taken.extend(free.iter().copied());
            let rib = |spoke: &Spoke| Rib {
                curve: spoke.curve,
                node: spoke.node as usize,
                tangent: DVec3::X,
                is_given: false,
            };
            let ribs = free.iter().map(rib).collect();
            let normal = plane.unwrap_or(DVec3::Z);
            network.hubs.push(Hub { ribs, normal, is_held: plane.is_some() });
            network.places.push(place);
        }
        if taken.len() > MOST_SPOKES {
            return Err(SolverError::TooManySpokes(taken.len()));
        }
        Ok(network)
    }

    /// Prescribes the planes of hubs anew, in the order in which they were asked for; only of those that were prescribed before.
    /// Returns the largest angle by which that turns one, in radians.
    pub fn set_planes(&mut self, planes: &[Option<DVec3>]) -> f64 {
        let mut most = 0.0_f64;
        for (hub, place) in self.hubs.iter_mut().zip(&self.places).filter(|(hub, _)| hub.is_held) {
            if let Some(normal) = planes.get(*place).copied().flatten().and_then(DVec3::try_normalize) {
                most = most.max(hub.hold(normal));
            }
        }
        most
    }

    /// The unit normals of the hubs' planes.
    #[must_use]
    pub fn normals(&self) -> Vec<DVec3> {
        self.hubs.iter().map(|hub| hub.normal).collect()
    }

    /// One non-linear step of all curves; as [`CurveSolver::step`], for the sum of their energies.
    ///
    /// # Errors
    /// [`SolverError::NoPartInNetwork`] for a curve whose objective leaves it free to kink or has no energy;
    /// [`SolverError::UnknownNode`] and [`SolverError::NotFixed`] for a spoke; what a step refuses. Positions are as they were.
    pub fn step(&mut self, strands: &mut [Strand<'_>]) -> Result<StepReport, SolverError> {
        self.join(strands)?;
        let mut energy = self.lay(strands);
        let mut report = StepReport { energy_before: energy, energy, ..StepReport::default() };
        for strand in strands.iter_mut() {
            strand.solver.unfold(strand.positions);
        }
        energy = strands.iter().map(|strand| strand.solver.bends.energy).sum();
        report.energy = energy;
        let Ok(own) = self.direction(strands, None) else {
            self.damp(&mut report);
            return Ok(report);
        };
        if !(own.slope < -NOISE * energy) || !own.slope.is_finite() || !energy.is_finite() {
            report.damped = !(own.slope.is_finite() && energy.is_finite());
            report.at_rest = !report.damped;
            return Ok(report);
        }
        self.quiet_steps = if -own.slope < REST_DECREASE * energy { self.quiet_steps + 1 } else { 0 };
        let mut taken = own;
        let mut found = self.search(strands, &taken, energy);
        if let Some(smoother) = self.smoother(strands, &taken, found.is_some(), energy) {
            let other = self.search(strands, &smoother, energy);
            let is_less = |other: &Found| found.as_ref().is_none_or(|own| other.energy < own.energy);
            if other.as_ref().is_some_and(is_less) {
                (found, taken) = (other, smoother);
            } else if found.is_some() {
                // Back to the state of the first trial.
                found = self.search(strands, &taken, energy);
            }
        }
        match found {
            Some(found) => self.accept(strands, &taken, found, &mut report),
            None if self.damping <= 1.0 && is_unseen(strands, &taken) => report.at_rest = true,
            None => {
                self.damp(&mut report);
                report.at_rest = self.quiet_steps >= REST_STEPS;
            }
        }
        Ok(report)
    }

    /// Checks what is asked for and lets the tangents at the hubs turn.
    fn join(&mut self, strands: &mut [Strand<'_>]) -> Result<(), SolverError> {
        for (curve, strand) in (0_u32..).zip(strands.iter()) {
            check_positions(strand.solver.chain.count, strand.positions)?;
            if matches!(strand.solver.settings.objective, Objective::Neutral | Objective::Membrane) {
                return Err(SolverError::NoPartInNetwork(curve));
            }
        }
        let mut turning = vec![Vec::new(); strands.len()];
        for rib in self.hubs.iter_mut().flat_map(|hub| &mut hub.ribs) {
            let name = SolverError::UnknownNode(u32::try_from(rib.node).unwrap_or(u32::MAX));
            let solver = &strands.get(rib.curve).ok_or(name)?.solver;
            match solver.fixed.get(rib.node) {
                Some(true) => {}
                Some(false) => {
                    return Err(SolverError::NotFixed(u32::try_from(rib.node).unwrap_or(u32::MAX)));
                }
                None => return Err(name),
            }
            let given = solver.given.iter().find(|(node, _)| *node == rib.node);
            rib.is_given = given.is_some();
            match given {
                Some((_, tangent)) => rib.tangent = *tangent,
                None => turning[rib.curve].push(rib.node),
            }
        }
        for (strand, mut turning) in strands.iter_mut().zip(turning) {
            turning.sort_unstable();
            strand.solver.set_turning(turning)?;
        }
        Ok(())
    }

    /// Lays the planes anew as the chords have it, if that is better than what is there. Returns the energy.
    fn lay(&mut self, strands: &mut [Strand<'_>]) -> f64 {
        let mut laid = self.hubs.clone();
        for hub in &mut laid {
            let chords: Vec<DVec3> =
                hub.ribs.iter().map(|rib| chord(&strands[rib.curve], rib.node)).collect();
            hub.align(chords.into_iter());
        }
        let energy = measure(&laid, strands);
        if self.is_laid {
            let kept = measure(&self.hubs, strands);
            if kept <= energy {
                return kept;
            }
        }
        self.is_laid = true;
        self.hubs = laid;
        measure(&self.hubs, strands)
    }

    /// The Newton direction of all curves, of their own objectives or of one for all, priced by their own.
    fn direction(&self, strands: &mut [Strand<'_>], objective: Option<Objective>) -> Solved<Direction> {
        for strand in strands.iter_mut() {
            alone(strand, objective, self.damping)?;
        }
        let tilts = couples::bind(&self.hubs, strands, objective)?;
        let mut slope = 0.0;
        let mut moves = Vec::with_capacity(strands.len());
        for Strand { solver, .. } in strands.iter_mut() {
            let CurveSolver { chain, bends, gradient, turning, offsets, frames, .. } = &mut **solver;
            bends.gradient(*chain, bends.character, gradient);
            bends.pull_on_tangents(*chain, bends.character, turning, gradient);
            let own = offsets.displacements(frames, chain.count);
            slope += gradient.iter().zip(&own).map(|(g, m)| g.dot(*m)).sum::<f64>();
            moves.push(own);
        }
        let turn = |moves: &[Vec<DVec3>], rib: &Rib| match rib.is_given {
            true => DVec3::ZERO,
            false => moves[rib.curve][rib.node],
        };
        let turns =
            self.hubs.iter().map(|hub| hub.ribs.iter().map(|rib| turn(&moves, rib)).collect()).collect();
        for rib in self.hubs.iter().flat_map(|hub| &hub.ribs) {
            moves[rib.curve][rib.node] = DVec3::ZERO;
        }
        Ok(Direction { moves, tilts, turns, slope })
    }

    /// The direction of the thin plate, where a curve is too rough for its own (see `step`).
    fn smoother(
        &self,
        strands: &mut [Strand<'_>],
        own: &Direction,
        is_found: bool,
        energy: f64,
    ) -> Option<Direction> {
        let is_third_order = strands.iter().any(|strand| strand.solver.settings.objective == Objective::Fair);
        if !is_third_order || (is_found && first_scale(strands, own) >= ROUGH) {
            return None;
        }
        let plate = self.direction(strands, Some(Objective::ThinPlate)).ok()?;
        (plate.slope < -NOISE * energy).then_some(plate)
    }

    /// Line search; the trial that passed is left in the solvers' trials.
    fn search(&self, strands: &mut [Strand<'_>], direction: &Direction, energy: f64) -> Option<Found> {
        let mut scale = first_scale(strands, direction);
        for halvings in 0..=MAX_HALVINGS {
            let ways = self.hubs.iter().zip(direction.tilts.iter().zip(&direction.turns));
            let hubs: Vec<Hub> = ways.map(|(hub, (tilt, turns))| hub.turned(*tilt, turns, scale)).collect();
            for rib in hubs.iter().flat_map(|hub| &hub.ribs) {
                strands[rib.curve].solver.trial.aim(rib.node, rib.tangent);
            }
            let mut trial_energy = 0.0;
            for (Strand { solver, positions }, moves) in strands.iter_mut().zip(&direction.moves) {
                let moved = positions.iter().zip(moves);
                for (trial, (&position, &offset)) in solver.trial_positions.iter_mut().zip(moved) {
                    *trial = position + offset * scale;
                }
                solver.trial.measure(solver.chain, &solver.trial_positions, solver.bends.character);
                trial_energy += solver.trial.energy;
            }
            if trial_energy <= energy + SUFFICIENT * scale * direction.slope {
                return Some(Found { scale, halvings, energy: trial_energy, hubs });
            }
            scale *= 0.5;
        }
        None
    }

    fn accept(
        &mut self,
        strands: &mut [Strand<'_>],
        direction: &Direction,
        found: Found,
        report: &mut StepReport,
    ) {
        self.damping = (self.damping * 0.2).max(1.0);
        for (Strand { solver, positions }, moves) in strands.iter_mut().zip(&direction.moves) {
            for (offset, ds) in moves.iter().zip(&solver.bends.ds) {
                let distance = found.scale * offset.length();
                report.largest_move = report.largest_move.max(distance);
                report.largest_relative_move = report.largest_relative_move.max(distance / ds);
            }
            positions.copy_from_slice(&solver.trial_positions);
            std::mem::swap(&mut solver.bends, &mut solver.trial);
        }
        let turns = direction.turns.iter().flatten();
        let largest_turn = turns.fold(0.0_f64, |largest, turn| largest.max(found.scale * turn.length()));
        self.hubs = found.hubs;
        aim(&self.hubs, strands);
        report.energy = found.energy;
        report.step_scale = found.scale;
        report.halvings = found.halvings;
        report.predicted_decrease = -direction.slope * found.scale;
        let is_small = report.largest_relative_move.max(largest_turn) < REST_MOVE && report.halvings == 0;
        report.at_rest = is_small || self.quiet_steps >= REST_STEPS;
    }

    fn damp(&mut self, report: &mut StepReport) {
        self.damping = (self.damping * 10.0).min(1e8);
        report.damped = true;
    }
}

/// What a curve's direction is of.
pub(super) fn target(solver: &CurveSolver, objective: Option<Objective>) -> Objective {
    objective.unwrap_or(solver.settings.objective)
}

/// Solves the system of one curve as if its tangents were free.
fn alone(strand: &mut Strand<'_>, objective: Option<Objective>, damping: f64) -> Solved<()> {
    let Strand { solver, positions } = strand;
    let character = solver.character(positions, target(solver, objective));
    let settings = solver.settings;
    let mu = damping * if solver.is_loose() { settings.loose_damping } else { settings.damping };
    let mass = character.mass(mu, half_diagonal(positions));
    let CurveSolver { chain, bends, frames, offsets, gradient, turning, .. } = &mut **solver;
    frames.transport(*chain, bends);
    bends.gradient(*chain, character, gradient);
    bends.pull_on_tangents(*chain, character, turning, gradient);
    offsets.newton(*chain, bends, frames, character, gradient, mass).map(|_| ())
}

/// `b / r₋ + a / r₊`.
fn chord(strand: &Strand<'_>, node: usize) -> DVec3 {
    let (before, after) = strand.solver.chain.sides(node);
    let here = strand.positions[node];
    let pull = |chord: DVec3| (chord.length_squared() > 0.0).then(|| chord / chord.length_squared());
    let behind = before.and_then(|before| pull(here - strand.positions[before]));
    let ahead = after.and_then(|after| pull(strand.positions[after] - here));
    behind.unwrap_or(DVec3::ZERO) + ahead.unwrap_or(DVec3::ZERO)
}

/// Hands the tangents of the hubs to the curves.
fn aim(hubs: &[Hub], strands: &mut [Strand<'_>]) {
    for rib in hubs.iter().flat_map(|hub| &hub.ribs) {
        let solver = &mut strands[rib.curve].solver;
        solver.bends.aim(rib.node, rib.tangent);
        solver.trial.aim(rib.node, rib.tangent);
    }
}

/// The sum of the energies with these hubs.
fn measure(hubs: &[Hub], strands: &mut [Strand<'_>]) -> f64 {
    aim(hubs, strands);
    strands.iter_mut().for_each(|strand| strand.solver.measure(strand.positions));
    strands.iter().map(|strand| strand.solver.bends.energy).sum()
}

/// Where the search begins: what every curve allows, and no tangent turned by more than half a radian.
fn first_scale(strands: &[Strand<'_>], direction: &Direction) -> f64 {
    let turns = direction.turns.iter().flatten();
    let largest = turns.fold(LARGEST_TURN, |largest, turn| largest.max(turn.length()));
    let curves = strands.iter().zip(&direction.moves);
    curves.fold(LARGEST_TURN / largest, |least, (strand, moves)| least.min(strand.solver.first_scale(moves)))
}

/// Whether a direction leads nowhere.
fn is_unseen(strands: &[Strand<'_>], direction: &Direction) -> bool {
    let mut curves = strands.iter().zip(&direction.moves);
    curves.all(|(strand, moves)| strand.solver.relative(moves) < UNSEEN)
        && direction.turns.iter().flatten().all(|turn| turn.length() < UNSEEN)
}

#[cfg(test)]
mod tests;
