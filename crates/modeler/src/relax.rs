//! The basic shape iteration (thesis section 7.1.1): points, then curves, then the surfaces that follow
//! them, each a step towards its fairest shape; then the mesh is improved, when nothing moves fast.

use crate::bound::{BoundCurve, BoundSurface, Motion};
use crate::density;
use crate::maintain::{self, Upkeep};
use crate::model::Model;
use crate::network::Networks;
use crate::patch::{Led, fill};
use crate::settle;
use crate::shape::{CurveShape, GROWN, SurfaceShape, edit};
use ductile_solver::Budget;
use ductile_spec::{CurveId, Figures, PointId, SurfaceId};
use std::collections::{BTreeMap, BTreeSet};

/// The mesh is improved at most every so many steps (recipe, section 6).
const MAINTENANCE_PERIOD: u32 = 3;
/// Slow steps after a fast one before the mesh is improved again (recipe, section 7).
const SLOW_STEPS: u32 = 3;
/// Rounds of improvement after an act; afterwards the mesh is left as it is, so that rest is certain.
const MOST_ROUNDS: u32 = 60;
/// Rounds of these in which vertices may be collapsed away: splits and collapses could answer each other for ever.
const COLLAPSING_ROUNDS: u32 = 40;
/// A step that promises to lower the energy by less than this part ends near the rest: the bends of the shape tell how fine it should be.
const STEADY: f64 = 0.01;
/// They do from this round on in any case: a neck that the mesh cannot show may never rest.
const STEADY_ROUNDS: u32 = 8;
/// Part of the spacing by which a vertex may creep, while the shape still moves, before the mesh around it is looked at
/// again. At rest everything is looked at.
const SLACK: f64 = 0.02;
/// Steps after an act before a shape that does not come to rest is called settled all the same.
const MOST_STEPS: u32 = 600;
/// Strain-limited parts of a motion that one step carries out (recipe, section 5).
const SUBSTEPS: u32 = 4;
/// Jacobian of a fit below which a surface counts as folded (recipe, section 2: J₀).
const FOLDED: f64 = 0.5;

/// How a relaxation stands.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Relaxation {
    /// Energy of the surface.
    pub energy: f64,
    /// Decrease that the last step promised, relative to the energy.
    pub residual: f64,
    /// Iterations of the last step.
    pub iterations: u32,
    /// The solver rests and every control is met.
    pub at_rest: bool,
    /// The mesh needs no improvement.
    pub is_quiet: bool,
}

/// The solvers of a model and how far they are.
#[derive(Clone, Debug, Default)]
pub struct Relaxer {
    surfaces: BTreeMap<SurfaceId, BoundSurface>,
    pub(crate) curves: BTreeMap<CurveId, BoundCurve>,
    pub(crate) networks: Networks,
    upkeep: BTreeMap<SurfaceId, Upkeep>,
    states: BTreeMap<SurfaceId, Relaxation>,
    curves_at_rest: BTreeMap<CurveId, bool>,
    /// The curves need no other samples.
    are_curves_quiet: bool,
    steps: u32,
    /// Steps since the shapes were built from a document: maintenance keeps time with these, so that what comes of a document
    /// does not depend on what was done before it was opened.
    phase: u32,
    /// Whether a step since then had not the budget of a step out of sight, and could have come out otherwise with it.
    is_stinted: bool,
    steps_since_act: u32,
    rounds: u32,
    fast: u32,
    hand: f64,
    rescues: u32,
}

impl Relaxer {
    /// The bound solver of a surface, if it is for this shape.
    #[must_use]
    pub fn surface(&self, id: SurfaceId, shape: &SurfaceShape) -> Option<&BoundSurface> {
        self.surfaces.get(&id).filter(|bound| bound.revision == shape.revision)
    }

    /// How each surface stands.
    pub fn states(&self) -> impl Iterator<Item = (SurfaceId, Relaxation)> + '_ {
        self.states.iter().map(|(id, state)| (*id, *state))
    }

    /// Something was changed: everything must prove again that it rests.
    pub(crate) fn wake(&mut self) {
        self.states.clear();
        self.curves_at_rest.clear();
        self.are_curves_quiet = false;
        self.rounds = 0;
        self.steps_since_act = 0;
    }

    /// A hand took hold of points of shapes at rest: what they lead is made ready to move.
    pub(crate) fn attend(&mut self, model: &Model, points: &[PointId]) {
        let curves = model.document.curves.iter();
        let leads = curves.filter(|(_, curve)| curve.through.iter().any(|point| points.contains(point)));
        let curves: BTreeSet<CurveId> = leads.map(|(id, _)| *id).collect();
        for (id, bound) in &mut self.surfaces {
            let Some(shape) = model.surfaces.get(id).filter(|shape| shape.revision == bound.revision) else {
                continue;
            };
            let nodes = bound.held(shape, &curves, points);
            if !nodes.is_empty() && bound.solver.attend(&bound.positions, &nodes).is_err() {
                self.rescues = self.rescues.saturating_add(1);
            }
        }
    }

    /// The hand moved what it holds by a distance.
    pub(crate) fn hand_moved(&mut self, distance: f64) {
        self.hand = distance;
        if distance > 0.0 {
            self.are_curves_quiet = false;
            self.rounds = 0;
            self.steps_since_act = 0;
        }
    }

    /// Whether the hand has been slow for a while.
    pub(crate) fn is_hand_slow(&self) -> bool {
        self.fast == 0
    }

    /// The true energy of all surfaces as they are now.
    pub(crate) fn energy(&self) -> f64 {
        self.surfaces.values().map(BoundSurface::energy).sum()
    }

    /// Something impossible was asked for and ignored.
    pub(crate) fn count_rescue(&mut self) {
        self.rescues = self.rescues.saturating_add(1);
    }

    /// One for shapes that were just built from a document; only the counts go on.
    pub(crate) fn anew(&self) -> Self {
        Self { steps: self.steps, rescues: self.rescues, ..Self::default() }
    }

    /// Goes on with the counts of another one whose place it takes.
    pub(crate) fn in_place_of(self, other: &Self) -> Self {
        Self { steps: other.steps, rescues: other.rescues, ..self }
    }

    /// Counts a step in which the shapes were left to themselves.
    pub(crate) fn count_step(&mut self) {
        self.states.values_mut().for_each(|state| state.iterations = 0);
        self.steps = self.steps.saturating_add(1);
    }

    /// Whether steps with the budget of those out of sight could have led elsewhere.
    pub(crate) fn is_stinted(&self) -> bool {
        self.is_stinted
    }

    /// Takes it for granted that the shapes rest: they were at rest when they looked like this before.
    pub(crate) fn rest(&mut self, model: &Model) {
        self.rebind(model);
        // Planes turn little by little; in the shapes of before they had arrived.
        self.surfaces.values_mut().for_each(|bound| bound.solver.arrive());
        self.surfaces.values_mut().for_each(BoundSurface::fit);
        let rest = |bound: &BoundSurface| Relaxation {
            energy: bound.energy(),
            at_rest: true,
            is_quiet: true,
            ..Relaxation::default()
        };
        self.states = self.surfaces.iter().map(|(id, bound)| (*id, rest(bound))).collect();
        self.curves_at_rest = self.curves.keys().map(|id| (*id, true)).collect();
        self.are_curves_quiet = true;
    }

    /// Whether nothing will move any more, or not enough came of it for so long that nothing shall.
    #[must_use]
    pub fn is_settled(&self) -> bool {
        self.is_at_rest() || self.steps_since_act >= MOST_STEPS
    }

    /// Whether every shape rests.
    pub(crate) fn is_at_rest(&self) -> bool {
        let rests = |state: &Relaxation| state.at_rest && state.is_quiet;
        self.states.len() == self.surfaces.len()
            && self.states.values().all(rests)
            && (self.are_curves_quiet || self.curves.is_empty())
            && self.curves_at_rest.len() == self.curves.len()
            && self.curves_at_rest.values().all(|rests| *rests)
    }

    /// Whether a surface is folded anywhere, by its newest fits: no shape that its mesh resolves pays the price on folds.
    pub(crate) fn is_folded(&self) -> bool {
        self.surfaces.values().any(|bound| bound.solver.jacobians().any(|jacobian| jacobian < FOLDED))
    }

    /// Makes sure that there is a solver for each shape as it is now, fitted to it, and none for others.
    pub(crate) fn bind(&mut self, model: &Model) {
        self.rebind(model);
        self.surfaces.values_mut().for_each(BoundSurface::fit);
    }

    /// The same without the fits.
    fn rebind(&mut self, model: &Model) {
        self.surfaces
            .retain(|id, bound| model.surfaces.get(id).is_some_and(|s| s.revision == bound.revision));
        self.curves.retain(|id, bound| {
            model.curves.get(id).is_some_and(|shape| bound.is_for(&model.document, *id, shape))
        });
        self.upkeep.retain(|id, _| model.surfaces.contains_key(id));
        self.states.retain(|id, _| model.surfaces.contains_key(id));
        self.curves_at_rest.retain(|id, _| model.curves.contains_key(id));
        for (id, shape) in &model.surfaces {
            if let Some(bound) = self.surfaces.get_mut(id) {
                bound.read(shape);
                let is_chosen = bound.choose(model, *id, shape);
                if bound.prescribe(model, *id, shape) || is_chosen {
                    self.states.remove(id);
                }
                continue;
            }
            self.states.remove(id);
            match BoundSurface::new(*id, shape) {
                Ok(mut bound) => {
                    bound.choose(model, *id, shape);
                    bound.prescribe(model, *id, shape);
                    self.surfaces.insert(*id, bound);
                }
                Err(_) => self.rescues = self.rescues.saturating_add(1),
            }
        }
        for (id, shape) in &model.curves {
            if !self.curves.contains_key(id) {
                self.curves_at_rest.remove(id);
                match BoundCurve::new(&model.document, *id, shape) {
                    Ok(bound) => drop(self.curves.insert(*id, bound)),
                    Err(_) => self.rescues = self.rescues.saturating_add(1),
                }
            }
        }
    }

    /// One shape iteration with at most so many conjugate-gradient iterations for each surface.
    pub(crate) fn step(&mut self, model: &mut Model, iterations: u32) {
        self.rebind(model);
        let budget = Budget { iterations: iterations.clamp(1, 10_000) };
        let is_fast = self.hand > model.spacing();
        let is_moving = self.hand > 0.0;
        self.fast = if is_fast { SLOW_STEPS } else { self.fast.saturating_sub(1) };
        self.hand = 0.0;
        self.steps = self.steps.saturating_add(1);
        self.phase = self.phase.wrapping_add(1);
        self.steps_since_act = self.steps_since_act.saturating_add(1);
        let together = self.step_networks(model);
        for id in model.curves.keys().copied().filter(|id| !together.contains(id)).collect::<Vec<_>>() {
            self.step_curve(model, id);
        }
        for id in model.surfaces.keys().copied().collect::<Vec<_>>() {
            self.step_surface(model, id, budget, is_moving);
        }
        if self.is_due(model, is_moving) {
            self.maintain(model, is_moving);
        }
        self.surfaces.values_mut().for_each(BoundSurface::fit);
    }

    /// Whether the meshes are to be improved after this step. A new mesh costs the frame a new factorisation: one that still
    /// does waits until the hand rests, and one that does not until it is slow, unless it would break before.
    fn is_due(&self, model: &Model, is_moving: bool) -> bool {
        let is_time = self.phase.is_multiple_of(MAINTENANCE_PERIOD);
        let is_any = |asks: fn(&BoundSurface, f64) -> bool| {
            let of = |(id, bound)| model.surfaces.get(id).is_some_and(|s| asks(bound, s.longest_wanted()));
            self.surfaces.iter().any(of)
        };
        if self.fast > 0 {
            return is_time && is_any(BoundSurface::is_breaking);
        }
        is_time && (!is_moving || is_any(BoundSurface::is_worn)) || density::is_overdue(model, &self.surfaces)
    }

    /// Steps the curves that have to agree where they meet; returns which those are.
    fn step_networks(&mut self, model: &mut Model) -> BTreeSet<CurveId> {
        let leads = fill::held(model, Some(self));
        let refused = self.networks.bind(model, &leads);
        self.rescues = self.rescues.saturating_add(refused);
        let rests = |id: CurveId| self.curves_at_rest.get(&id) == Some(&true);
        let mut together = BTreeSet::new();
        for outcome in self.networks.step(model, &mut self.curves, rests) {
            self.rescues = self.rescues.saturating_add(u32::from(outcome.is_rescued));
            self.curves_at_rest.extend(outcome.curves.iter().map(|id| (*id, outcome.at_rest)));
            together.extend(outcome.curves);
        }
        together
    }

    fn step_curve(&mut self, model: &mut Model, id: CurveId) {
        if let (Some(led), Some(shape)) = (Led::of(model, id), model.curves.get(&id)) {
            let nodes = led.nodes(&model.document, shape).filter(|nodes| *nodes != shape.nodes);
            self.curves_at_rest.insert(id, nodes.is_none());
            if let (Some(nodes), Some(shape)) = (nodes, model.curves.get_mut(&id).map(edit::<CurveShape>)) {
                shape.nodes = nodes;
            }
            return;
        }
        let (Some(bound), Some(shape)) = (self.curves.get_mut(&id), model.curves.get(&id)) else { return };
        let motion = BoundCurve::motion(model, shape);
        if motion.is_empty() && self.curves_at_rest.get(&id) == Some(&true) {
            return;
        }
        let mut nodes = shape.nodes.clone();
        let outcome = bound.relax(&mut nodes, &motion);
        let is_met = motion.is_empty() || outcome.is_ok_and(|(met, _)| met);
        let rests = matches!(outcome, Ok((_, true)));
        if outcome.is_err() {
            self.rescues = self.rescues.saturating_add(1);
        } else if let Some(shape) = model.curves.get_mut(&id).map(edit::<CurveShape>) {
            shape.nodes = nodes;
        }
        self.curves_at_rest.insert(id, is_met && rests && motion.is_empty());
    }

    fn step_surface(&mut self, model: &mut Model, id: SurfaceId, budget: Budget, is_moving: bool) {
        let (Some(bound), Some(shape)) = (self.surfaces.get_mut(&id), model.surfaces.get(&id)) else {
            return;
        };
        let mut motion = bound.motion(&model.document, &model.curves, shape);
        let before = self.states.get(&id).copied().unwrap_or_default();
        if motion.is_empty() && before.at_rest {
            return;
        }
        // Far bays may sleep while the hand moves; what comes to rest is the whole shape.
        if !is_moving {
            bound.solver.wake();
        }
        let start = bound.positions.clone();
        let mut state = Relaxation { is_quiet: before.is_quiet, ..Relaxation::default() };
        for _ in 0..SUBSTEPS {
            if motion.is_empty() {
                break;
            }
            match bound.carry(&motion) {
                Ok(true) => {
                    motion = Motion::default();
                    break;
                }
                Ok(false) => {}
                Err(_) => {
                    self.rescues = self.rescues.saturating_add(1);
                    break;
                }
            }
            motion = bound.motion(&model.document, &model.curves, shape);
            if let Ok(report) = bound.solver.step(&mut bound.positions, budget) {
                self.rescues = self.rescues.saturating_add(u32::from(report.damped));
                self.is_stinted |= is_stinted(budget, report.sufficient);
            }
        }
        match bound.solver.step(&mut bound.positions, budget) {
            Ok(report) => {
                self.is_stinted |= is_stinted(budget, report.sufficient);
                state.energy = report.energy;
                state.residual =
                    if report.energy > 0.0 { report.predicted_decrease / report.energy } else { 0.0 };
                state.iterations = report.cg_iterations;
                state.at_rest =
                    report.at_rest && motion.is_empty() && bound.solver.asleep() == 0 && !bound.is_beginning;
                self.rescues = self.rescues.saturating_add(u32::from(report.damped));
            }
            Err(_) => self.rescues = self.rescues.saturating_add(1),
        }
        if is_moving && bound.solver.doze(&start, &bound.positions).is_err() {
            self.rescues = self.rescues.saturating_add(1);
        }
        self.states.insert(id, state);
        if let Some(shape) = model.surfaces.get_mut(&id) {
            let shape = edit(shape);
            bound.write(shape);
            shape.age = GROWN.min(shape.age + 1);
        }
    }

    /// Improves the meshes (thesis chapter 6) and binds anew what was changed.
    fn maintain(&mut self, model: &mut Model, is_moving: bool) {
        if self.rounds >= MOST_ROUNDS {
            self.states.values_mut().for_each(|state| state.is_quiet = true);
            self.are_curves_quiet = true;
            return;
        }
        let are_surfaces_quiet = self.states.len() == self.surfaces.len()
            && self.states.values().all(|state| state.is_quiet && state.at_rest);
        if are_surfaces_quiet && self.are_curves_quiet {
            return;
        }
        self.rounds += 1;
        // With the last collapses the wanted lengths stay as they are, too: then rest is certain.
        if self.rounds <= COLLAPSING_ROUNDS {
            let has_come = |state: &Relaxation| state.at_rest || state.residual < STEADY;
            let has_come = |id| self.states.get(&id).is_some_and(has_come);
            let is_steady = |id| has_come(id) || (self.rounds >= STEADY_ROUNDS && !is_moving);
            density::update(model, &self.surfaces, is_steady);
        }
        self.are_curves_quiet = true;
        for id in model.curves.keys().copied().collect::<Vec<_>>() {
            if maintain::curve(model, id) {
                self.curves_at_rest.remove(&id);
                self.are_curves_quiet = false;
            }
        }
        self.bind(model);
        for id in model.surfaces.keys().copied().collect::<Vec<_>>() {
            let Some(bound) = self.surfaces.get(&id) else { continue };
            let rests = self.states.get(&id).is_some_and(|state| state.at_rest);
            let how = (if rests { 0.0 } else { SLACK }, self.rounds <= COLLAPSING_ROUNDS);
            let edited = maintain::surface(model, id, bound, self.upkeep.entry(id).or_default(), how);
            if edited {
                self.rebind(model);
            }
            let (Some(bound), Some(shape)) = (self.surfaces.get_mut(&id), model.surfaces.get_mut(&id)) else {
                continue;
            };
            let moved = maintain::smooth(shape, bound);
            let state = self.states.entry(id).or_default();
            state.is_quiet = !edited && !moved && rests;
            state.at_rest &= state.is_quiet;
        }
    }

    /// What the status line shows.
    #[must_use]
    pub(crate) fn figures(&self, model: &Model) -> Figures {
        Figures {
            nodes: u32::try_from(model.node_count()).unwrap_or(u32::MAX),
            energy: self.energy(),
            residual: self.states.values().map(|state| state.residual).fold(0.0, f64::max),
            iterations: self.states.values().map(|state| state.iterations).max().unwrap_or(0),
            steps: self.steps,
            rescues: self.rescues,
            step_milliseconds: 0.0,
        }
    }
}

/// Whether a step out of sight could have come out otherwise than one with this budget, of which so much was needed.
fn is_stinted(budget: Budget, sufficient: u32) -> bool {
    budget.iterations != settle::ITERATIONS && sufficient > settle::ITERATIONS.min(budget.iterations)
}

#[cfg(test)]
mod tests;
