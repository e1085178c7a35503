//! The stepping object: one frozen connectivity, its fits, its matrix, and the two verbs `predict` and `step`.
//!
//! Source: recipe sections 4 and 5. A step fits, takes the exact gradient, solves a damped Gauss-Newton system by a
//! budget of preconditioned conjugate gradients and searches along the normals on the true discrete energy, which
//! therefore never rises (other objectives than the thin plate: see `objective`). The accepted fit serves the next step. No buffer is allocated while the connectivity and
//! the fixed nodes stay.
//!
//! ```
//! use ductile_solver::{Budget, workload};
//! let shape = workload::disc(4);
//! let (mut solver, mut positions) = (shape.solver().unwrap(), shape.positions.clone());
//! solver.predict(&mut positions, &[(0, glam::DVec3::Z * 0.1)]).unwrap();
//! let report = solver.step(&mut positions, Budget::default()).unwrap();
//! assert!(report.energy <= report.energy_before);
//! ```

mod advance;
mod bays;
mod figures;
mod frozen;
mod matrix;
mod prescribe;
mod sleep;

pub use figures::NodeFigures;
pub use frozen::Frozen;

use std::cell::OnceCell;

use glam::DVec3;

use crate::assembly::{Assembly, Rows};
use crate::cg::{self, Limit, Workspace};
use crate::component::{Components, Looseness};
use crate::error::{Budget, Settings, SolverError, check_length, check_positions};
use crate::factor::FactorError;
use crate::fit::Curvature;
use crate::fits::{Fits, Wanted};
use crate::laplacian::Acting;
use crate::objective::{Goals, Objectives};
use crate::operator::Unknowns;
use crate::precondition::Preconditioner;
use crate::predictor::{self, Parts, Predicted, Predictor};
use crate::report::StepReport;
use crate::rings::Rings;
use crate::smooth::{self, Aim, EdgePlaces, SmoothReport};

use bays::Bays;
use matrix::{Matrix, Scratch};
use sleep::Sleep;

/// Fair surfaces over one frozen connectivity.
#[derive(Clone, Debug)]
pub struct SurfaceSolver {
    rings: Rings,
    settings: Settings,
    objectives: Objectives,
    goals: Goals,
    fixed: Vec<bool>,
    components: Components,
    unknowns: Unknowns,
    assembly: Assembly,
    preconditioner: Preconditioner,
    /// For scalar fields, where that is something else than for offsets: on rings of mixed senses.
    field_preconditioner: Option<Preconditioner>,
    predictor: Predictor,
    fits: Fits,
    trial: Fits,
    trial_positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// `-g/2` per unknown, and the direction.
    rhs: Vec<f64>,
    trial_rhs: Vec<f64>,
    alpha: Vec<f64>,
    workspace: Workspace,
    scratch: Scratch,
    /// The parts between fixed nodes, once somebody asked for them.
    bays: Option<Bays>,
    /// What is put aside while bays sleep.
    sleep: Option<Sleep>,
    /// Factor on the mass damping, above 1 after failed searches.
    damping: f64,
    quiet_steps: u32,
    still_steps: u32,
    /// Whether the last step ended at rest, and nothing was changed since.
    rests: bool,
    /// What the fits at the end of a step should hold.
    next_wanted: Wanted,
}

impl SurfaceSolver {
    /// Sets up a solver. Nodes without neighbours are taken as fixed.
    pub fn new(rings: Rings, fixed: Vec<bool>, settings: Settings) -> Result<Self, SolverError> {
        check_length(rings.len(), fixed.len())?;
        let unknowns = unknowns(&rings, &fixed);
        let objectives = Objectives::default();
        let goals = Goals::new((&rings, &fixed), &objectives, settings.sampling, None);
        Ok(Self {
            components: Components::new(&rings),
            assembly: Assembly::new(&rings, &unknowns),
            preconditioner: Preconditioner::new(&rings, &unknowns, Acting::OnOffsets)?,
            field_preconditioner: field_preconditioner(&rings, &unknowns)?,
            predictor: Predictor::default(),
            fits: Fits::new(&rings, &goals),
            trial: Fits::new(&rings, &goals),
            trial_positions: vec![DVec3::ZERO; rings.len()],
            normals: vec![DVec3::Z; rings.len()],
            rhs: Vec::new(),
            trial_rhs: Vec::new(),
            alpha: Vec::new(),
            workspace: Workspace::default(),
            scratch: Scratch::default(),
            bays: None,
            sleep: None,
            objectives,
            goals,
            damping: 1.0,
            quiet_steps: 0,
            still_steps: 0,
            rests: false,
            next_wanted: Wanted::Gradient,
            unknowns,
            settings,
            fixed,
            rings,
        })
    }

    /// The connectivity.
    pub fn rings(&self) -> &Rings {
        &self.rings
    }

    /// Which nodes are fixed.
    pub fn fixed(&self) -> &[bool] {
        &self.fixed
    }

    /// Changes which nodes are fixed; the symbolic work is done again only if they differ. Prescribed normals all go if
    /// one of their nodes is set free.
    pub fn set_fixed(&mut self, fixed: Vec<bool>) -> Result<(), SolverError> {
        check_length(self.rings.len(), fixed.len())?;
        if fixed != self.fixed {
            self.wake();
            let unknowns = unknowns(&self.rings, &fixed);
            self.preconditioner = Preconditioner::new(&self.rings, &unknowns, Acting::OnOffsets)?;
            self.field_preconditioner = field_preconditioner(&self.rings, &unknowns)?;
            self.assembly = Assembly::new(&self.rings, &unknowns);
            self.predictor.reset();
            self.unknowns = unknowns;
            self.fixed = fixed;
            self.bays = None;
            self.heed_fixed();
        }
        Ok(())
    }

    /// Chooses what is minimised; at first it is the thin plate. Nothing is done where that is the choice already.
    ///
    /// # Errors
    /// [`SolverError::Length`] when there is a choice for each triangle, but not for each of these.
    pub fn set_objectives(&mut self, objectives: Objectives) -> Result<(), SolverError> {
        if let Some(found) = objectives.triangles() {
            check_length(self.rings.triangles().len(), found)?;
        }
        if let (Some(radius), true) =
            (objectives.only_radius(&self.objectives), objectives != self.objectives)
        {
            self.goals.radius = radius;
            self.fits.forget();
            self.trial.forget();
            self.stir();
            self.objectives = objectives;
        } else if objectives != self.objectives {
            self.wake();
            self.objectives = objectives;
            let planes = self.goals.planes.take();
            self.set_goals(planes);
        }
        Ok(())
    }

    /// Carries moved constraint nodes and everything between them by a smooth field.
    ///
    /// `moves` names fixed nodes and their displacements; a node named twice moves by the last. Fixed nodes not
    /// named stay. At most the strain-limited fraction is applied; the caller asks again for the rest.
    pub fn predict(
        &mut self,
        positions: &mut [DVec3],
        moves: &[(u32, DVec3)],
    ) -> Result<Predicted, SolverError> {
        check_positions(self.rings.len(), positions)?;
        let moves = predictor::checked_moves(positions, &self.fixed, moves)?;
        if moves.iter().all(|&(_, displacement)| displacement == DVec3::ZERO) {
            return Ok(Predicted { fraction: 1.0, ..Predicted::default() });
        }
        self.heed_moves(positions, &moves)?;
        self.refit(positions, Wanted::Rows);
        self.prepare()?;
        self.assembly.assemble(&self.rings, &self.goals, &self.fits, Rows::Field, |_| 0.0);
        let limit = Limit {
            iterations: self.settings.predictor_iterations,
            tolerance: self.settings.predictor_tolerance,
        };
        let parts = Parts {
            rings: &self.rings,
            fits: &self.fits,
            unknowns: &self.unknowns,
            assembly: &self.assembly,
            preconditioner: self.field_preconditioner.as_mut().unwrap_or(&mut self.preconditioner),
            limit,
        };
        let (field, outcome) = self.predictor.displacements(parts, &moves);
        let strain = predictor::strain(&self.rings, &self.fits, &self.unknowns, field);
        let fraction =
            if strain > self.settings.strain_limit { self.settings.strain_limit / strain } else { 1.0 };
        self.fits.each(|node| positions[node] += field[node] * fraction);
        if let Some(active) = &self.fits.active {
            for &(node, displacement) in moves.iter().filter(|(node, _)| !active.has(*node)) {
                positions[node as usize] += displacement * fraction;
            }
        }
        self.served(outcome.iterations);
        self.stir();
        Ok(Predicted { fraction, strain, iterations: outcome.iterations, residual: outcome.residual })
    }

    /// One non-linear step; a failed search leaves the positions alone. Never raises the energy, except where neutral
    /// nodes have none.
    pub fn step(&mut self, positions: &mut [DVec3], budget: Budget) -> Result<StepReport, SolverError> {
        check_positions(self.rings.len(), positions)?;
        // Positions that somebody moved will most likely be moved again before the next step, as in a drag: then nobody
        // asks for the gradient at its end. The predictor asks for the rows.
        let is_led = !self.fits.are_at(positions) && !self.goals.has_neutral;
        self.next_wanted = if is_led { Wanted::Rows } else { Wanted::Gradient };
        self.refit(positions, Wanted::Gradient);
        if self.turn_planes() {
            self.refit(positions, Wanted::Gradient);
        }
        self.slopes();
        let looseness = self.components.looseness(positions, &self.fixed);
        self.prepare()?;
        let (fits, unknowns, components) = (&self.fits, &self.unknowns, &self.components);
        let (settings, damping) = (&self.settings, self.damping);
        self.assembly.assemble(&self.rings, &self.goals, fits, Rows::Offset, |unknown| {
            let node = unknowns.nodes[unknown] as usize;
            damping * mass(fits, components, &looseness, settings, node)
        });
        self.alpha.clear();
        self.alpha.resize(self.unknowns.len(), 0.0);
        let matrix = Matrix {
            goals: &self.goals,
            rings: &self.rings,
            fits: &self.fits,
            unknowns: &self.unknowns,
            plate: self.assembly.matrix(),
        };
        // The wider equations of curvature variation take about twice the iterations.
        let (share, tolerance) = match &self.goals.network {
            Some(_) => (2, self.settings.variation_tolerance),
            None => (1, self.settings.step_tolerance),
        };
        let iterations = budget.iterations.saturating_mul(share);
        let outcome = cg::solve(
            |x, y| matrix.multiply(x, y, &mut self.scratch),
            |r, z| matrix.precondition(&mut self.preconditioner, r, z),
            &self.rhs,
            &mut self.alpha,
            Limit { iterations, tolerance },
            &mut self.workspace,
        );
        self.served(outcome.iterations);
        let mut report = StepReport {
            energy_before: self.fits.energy,
            energy: self.fits.energy,
            cg_iterations: outcome.iterations,
            residual: outcome.residual,
            sufficient: sufficient(outcome, (iterations, tolerance), share),
            turning: self.turning(),
            ..StepReport::default()
        };
        self.advance(positions, &mut report);
        report.at_rest &= report.turning == 0.0;
        self.rests = report.at_rest;
        Ok(report)
    }

    /// Refreshes the fits; steps and predictions do so themselves.
    ///
    /// # Panics
    /// When there is not one position per node.
    pub fn fit_all(&mut self, positions: &[DVec3]) {
        assert_eq!(positions.len(), self.rings.len(), "one position per node");
        self.refit(positions, Wanted::Energy);
    }

    /// The same with the gradient and the rows of the matrix: the next step or prediction from here begins with them.
    ///
    /// # Panics
    /// When there is not one position per node.
    pub fn evaluate(&mut self, positions: &[DVec3]) {
        assert_eq!(positions.len(), self.rings.len(), "one position per node");
        self.refit(positions, Wanted::Gradient);
    }

    /// Unit normals of the newest fit, towards the side from which the rings run counter-clockwise.
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Discrete energy of the newest fit, in units of the thin plate; NaN before the first. Neutral nodes count with the
    /// thin plate's, though no step seeks to lower it.
    pub fn energy(&self) -> f64 {
        self.fits.energy
    }

    /// Curvature of every node in the newest fit.
    pub fn curvatures(&self) -> impl ExactSizeIterator<Item = Curvature> {
        self.fits.nodes.iter().map(|fit| fit.curvature())
    }

    /// Jacobian of every node's fit: near 1 where the mesh resolves the shape, below 0.7 where it should be refined.
    pub fn jacobians(&self) -> impl ExactSizeIterator<Item = f64> {
        self.fits.nodes.iter().map(|fit| fit.jacobian)
    }

    /// The mean length of the edges at every node in the newest fit.
    pub fn mean_edges(&self) -> impl ExactSizeIterator<Item = f64> {
        self.fits.nodes.iter().map(|fit| fit.h)
    }

    /// The longest edge in the newest fit.
    pub fn longest_edge(&self) -> f64 {
        self.fits.lengths.iter().fold(0.0, |longest, &length| longest.max(length))
    }

    /// The Jacobian of one node's fit.
    ///
    /// # Panics
    /// When there is no such node.
    pub fn jacobian(&self, node: u32) -> f64 {
        self.fits.nodes[node as usize].jacobian
    }

    /// Exact `dE/dp` of every node in the newest fit. Neutral nodes have no energy to differentiate.
    pub fn gradient(&mut self) -> &[DVec3] {
        let positions = std::mem::take(&mut self.trial_positions);
        let mut here = positions;
        here.copy_from_slice(&self.fits.positions);
        self.fits.refit(&self.rings, &self.goals, &here, Wanted::Gradient);
        self.trial_positions = here;
        &self.fits.gradient
    }

    /// Moves nodes along the fitted surface towards the middle of their rings (recipe, section 7).
    ///
    /// `fraction` of the way, 0.5 to 0.7; nodes not `movable` stay, whether fixed or not. Moves below 0.01 of the
    /// local edge are left out.
    ///
    /// # Panics
    /// When the arrays do not have one entry per node.
    pub fn smooth(&mut self, positions: &mut [DVec3], movable: &[bool], fraction: f64) -> SmoothReport {
        self.smooth_graded(positions, movable, fraction, Aim::Even, None)
    }

    /// The same with a choice of aim, and on a graded mesh: triangles are weighed by `area / h*²` with the wanted edge length of each node.
    ///
    /// # Panics
    /// When the arrays do not have one entry per node.
    pub fn smooth_graded(
        &mut self,
        positions: &mut [DVec3],
        movable: &[bool],
        fraction: f64,
        aim: Aim,
        lengths: Option<&[f64]>,
    ) -> SmoothReport {
        assert_eq!(positions.len(), self.rings.len(), "one position per node");
        let report = smooth::smooth(&self.rings, positions, movable, fraction, aim, lengths);
        if report.moved > 0 {
            self.stir();
        }
        report
    }

    /// The middle of an edge, lifted onto the fitted quadratics of both ends: where a split puts its new node.
    ///
    /// Uses the newest fit. The plain middle when the nodes are not neighbours or have no fit.
    pub fn place_on_edge(&self, positions: &[DVec3], a: u32, b: u32) -> DVec3 {
        smooth::place_on_edge(&self.rings, positions, a, b)
    }

    /// The same for many edges, each node fitted once.
    ///
    /// # Panics
    /// When there is not one position per node.
    pub fn edge_places<'a>(&'a self, positions: &'a [DVec3]) -> EdgePlaces<'a> {
        EdgePlaces::new(&self.rings, positions)
    }

    /// The place of a node's fitted quadratic nearest to a given one: what a place pointed at on the facets means.
    ///
    /// Uses the newest fit; the error is of third order in the distance from the node. `None` on the boundary, whose
    /// fit knows nothing across it, where there is no fit, and farther away than the quadratic reaches (1.25 mean edges).
    pub fn place_near(&self, positions: &[DVec3], node: u32, at: DVec3) -> Option<DVec3> {
        smooth::place_near(&self.rings, positions, node, at)
    }

    /// Fits at these positions, and the normals that go with them.
    fn refit(&mut self, positions: &[DVec3], wanted: Wanted) {
        self.heed_positions(positions);
        self.begin_planes(positions);
        self.fits.refit(&self.rings, &self.goals, positions, wanted);
        self.take_normals();
    }

    /// Keeps the normals of the newest fit.
    fn take_normals(&mut self) {
        let (normals, nodes) = (&mut self.normals, &self.fits.nodes);
        self.fits.each(|node| normals[node] = nodes[node].normal);
    }

    /// Right-hand side `-g/2`.
    fn slopes(&mut self) {
        matrix::slopes(
            &self.goals,
            &self.rings,
            &self.fits,
            &self.unknowns,
            &mut self.rhs,
            &mut self.scratch,
        );
    }

    /// Brings the preconditioners up to date, both at once, so that their ages never depend on the senses.
    fn prepare(&mut self) -> Result<(), SolverError> {
        let (fits, unknowns, components) = (&self.fits, &self.unknowns, &self.components);
        let (settings, fixed) = (&self.settings, &self.fixed);
        // Asked for only if a factor is stale.
        let looseness = OnceCell::new();
        let looseness = || looseness.get_or_init(|| components.looseness(&fits.positions, fixed));
        let shift = |unknown: usize, diagonal: f64| {
            let node = unknowns.nodes[unknown] as usize;
            if looseness().of(components, node).has_fixed {
                return 0.0;
            }
            // (Lc + sqrt(mu) Ma/R²) Ma⁻¹ (Lc + ...) then stands for the damped plate on constants too.
            let mass = mass(fits, components, looseness(), settings, node);
            let shift = (mass * fits.nodes[node].area).sqrt();
            shift.max(1e-9 * diagonal)
        };
        for preconditioner in self.field_preconditioner.iter_mut().chain([&mut self.preconditioner]) {
            preconditioner.prepare(&self.rings, fits, unknowns, shift)?;
        }
        Ok(())
    }

    /// Tells the preconditioners how many iterations a solve took.
    fn served(&mut self, iterations: u32) {
        for preconditioner in self.field_preconditioner.iter_mut().chain([&mut self.preconditioner]) {
            preconditioner.served(iterations);
        }
    }
}

/// `mu a / Rm⁴` of one node.
fn mass(
    fits: &Fits,
    components: &Components,
    looseness: &Looseness,
    settings: &Settings,
    node: usize,
) -> f64 {
    let part = looseness.of(components, node);
    let mu = if part.is_loose { settings.loose_damping } else { settings.damping };
    let squared = part.radius * part.radius;
    if squared > 0.0 { mu * fits.nodes[node].area / (squared * squared) } else { 0.0 }
}

/// Rings of mixed senses need a second preconditioner for scalar fields.
fn field_preconditioner(rings: &Rings, unknowns: &Unknowns) -> Result<Option<Preconditioner>, FactorError> {
    rings.is_mixed().then(|| Preconditioner::new(rings, unknowns, Acting::OnField)).transpose()
}

/// The least budget that leads to the same outcome, where `share` iterations are done for each of the budget.
fn sufficient(outcome: cg::Outcome, (limit, tolerance): (u32, f64), share: u32) -> u32 {
    let is_cut_short = outcome.iterations >= limit && outcome.residual > tolerance;
    if is_cut_short { u32::MAX } else { outcome.iterations.div_ceil(share) }
}

fn unknowns(rings: &Rings, fixed: &[bool]) -> Unknowns {
    Unknowns::new(fixed.iter().enumerate().map(|(node, &fixed)| !fixed && !rings.ring(node).is_empty()))
}

#[cfg(test)]
mod tests;
