//! Active sets: bays that a drag hardly moves sleep, and only what is awake is fitted and solved for.
//!
//! Source: recipe section 6, "locality and sleep". The response of a plate to a drag fades from bay to bay, so far bays move by
//! less than can be seen. A sleeping bay is held like a control: its nodes are no unknowns, and neighbourhoods in which nothing
//! can move keep their fits, which stay exact to the bit. When a control of a shape at rest is moved, all bays farther than four
//! curves away sleep from the first frame on. Those within as many wake when a control among them is moved, and those on
//! the way when the surface bends more at the border; all when the caller wants everything at rest.

use std::sync::Arc;

use glam::DVec3;

use super::bays::Bays;
use super::{SurfaceSolver, field_preconditioner};
use crate::assembly::Assembly;
use crate::error::SolverError;
use crate::fits::Active;
use crate::laplacian::Acting;
use crate::operator::Unknowns;
use crate::precondition::Preconditioner;

/// Motion within a frame, in units of the mean edge, below which a bay may sleep. Well below what can be seen, so that it
/// takes many frames until its border has stirred.
const QUIET: f64 = 2e-4;
/// The same for a control beside a sleeping bay.
const STIR: f64 = 1e-3;
/// Change of the Jacobian, or of a curvature times the mean edge, at the border of a sleeping bay that wakes it (recipe): what
/// wakes then moves by less than what counts as rest.
const BORDER: f64 = 1e-3;
/// Bays fall asleep one after another only if that leaves at most this share of the nodes that are awake now.
const WORTH: f64 = 0.75;
/// Control curves that a drag reaches across: what lies farther away moves by less than a thousandth of it (recipe).
const REACH: usize = 4;
/// The same for a border that stirs.
const STIRRED_REACH: usize = 1;

/// What is put aside while bays sleep, and how to tell that they should wake.
#[derive(Clone, Debug)]
pub(super) struct Sleep {
    /// How many nodes.
    count: usize,
    /// Per bay.
    asleep: Vec<bool>,
    /// Per node whether it may move: awake and free, or fixed with nothing asleep beside it.
    can_move: Vec<bool>,
    /// Fixed nodes between what sleeps and what is awake, with Jacobian and scaled curvature when it fell asleep.
    border: Vec<(u32, f64, [f64; 3])>,
    whole: Equations,
}

/// Everything that depends on which nodes are unknown.
#[derive(Clone, Debug)]
struct Equations {
    unknowns: Unknowns,
    assembly: Assembly,
    preconditioner: Preconditioner,
    field_preconditioner: Option<Preconditioner>,
}

impl SurfaceSolver {
    /// Ends a frame of a drag: lets bays sleep that it hardly moved, and wakes those whose border it stirred. `before` is where
    /// the nodes were when it began.
    ///
    /// Does nothing where too few nodes could sleep (see [`Settings::least_asleep`](crate::Settings::least_asleep)).
    /// Returns how many free nodes are awake.
    ///
    /// # Errors
    /// [`SolverError`] when there is not one position per node, or the awake part cannot be set up; everything is awake then.
    pub fn doze(&mut self, before: &[DVec3], positions: &[DVec3]) -> Result<usize, SolverError> {
        crate::error::check_length(self.rings.len(), before.len())?;
        crate::error::check_length(self.rings.len(), positions.len())?;
        let bays = self.bays.take().unwrap_or_else(|| Bays::new(&self.rings, &self.fixed));
        let done = self.doze_in(&bays, before, positions);
        self.bays = Some(bays);
        done.map(|()| self.unknowns.len())
    }

    fn doze_in(&mut self, bays: &Bays, before: &[DVec3], positions: &[DVec3]) -> Result<(), SolverError> {
        let stirred = self.stirred_border();
        if !stirred.is_empty() {
            let wakes = bays.within(&self.rings, &stirred, STIRRED_REACH);
            return self.keep_asleep(bays, |bay| !wakes[bay], positions);
        }
        let is_quiet = self.quiet(bays, before, positions);
        let awake = bays.count(|bay| !is_quiet[bay]);
        if awake > 0 && (awake as f64) <= WORTH * self.unknowns.len() as f64 {
            self.fall_asleep(bays, is_quiet, positions)?;
        }
        Ok(())
    }

    /// Which bays hardly moved.
    fn quiet(&self, bays: &Bays, before: &[DVec3], positions: &[DVec3]) -> Vec<bool> {
        let mut is_quiet = vec![true; bays.len()];
        // What is not fitted has not moved.
        self.fits.each(|node| {
            if let Some(bay) = bays.of(node) {
                let moved = positions[node].distance(before[node]);
                is_quiet[bay] &= moved <= QUIET * self.fits.nodes[node].h;
            }
        });
        is_quiet
    }

    /// Wakes every bay; returns whether any slept.
    pub fn wake(&mut self) -> bool {
        let Some(sleep) = self.sleep.take() else { return false };
        let Equations { unknowns, assembly, preconditioner, field_preconditioner } = sleep.whole;
        (self.unknowns, self.assembly) = (unknowns, assembly);
        (self.preconditioner, self.field_preconditioner) = (preconditioner, field_preconditioner);
        for fits in [&mut self.fits, &mut self.trial] {
            fits.active = None;
            fits.forget();
        }
        self.predictor.reset();
        self.stir();
        true
    }

    /// How many free nodes sleep.
    pub fn asleep(&self) -> usize {
        self.sleep.as_ref().map_or(0, |sleep| sleep.count)
    }

    /// Controls are about to be moved. Of a shape at rest only what they reach stays awake; of one that sleeps in parts all that
    /// they reach wakes, if a control beside a sleeping bay is among them.
    ///
    /// # Errors
    /// [`SolverError`] when the awake part cannot be set up; everything is awake then.
    pub(super) fn heed_moves(
        &mut self,
        positions: &[DVec3],
        moves: &[(u32, DVec3)],
    ) -> Result<(), SolverError> {
        let stirs = |&&(node, by): &&(u32, DVec3)| by.length() > STIR * self.fits.nodes[node as usize].h;
        let is_asked = match &self.sleep {
            Some(sleep) => moves.iter().filter(stirs).any(|&(node, _)| !sleep.can_move[node as usize]),
            // The fits tell where bays may sleep.
            None => self.rests && self.fits.are_at(positions),
        };
        if !is_asked {
            return Ok(());
        }
        let moved: Vec<u32> = moves.iter().map(|&(node, _)| node).collect();
        let bays = self.bays.take().unwrap_or_else(|| Bays::new(&self.rings, &self.fixed));
        let reached = bays.within(&self.rings, &moved, REACH);
        let done = if self.sleep.is_some() {
            self.keep_asleep(&bays, |bay| !reached[bay], positions)
        } else if bays.count(|bay| reached[bay]) as f64 <= WORTH * self.unknowns.len() as f64 {
            self.fall_asleep(&bays, reached.iter().map(|is_reached| !is_reached).collect(), positions)
        } else {
            Ok(())
        };
        self.bays = Some(bays);
        done
    }

    /// Wakes everything if a node that cannot move has been moved by the caller.
    pub(super) fn heed_positions(&mut self, positions: &[DVec3]) {
        let Some(sleep) = &self.sleep else { return };
        let nodes = positions.iter().zip(&self.fits.positions).zip(&sleep.can_move);
        if nodes.into_iter().any(|((new, old), &can_move)| !can_move && new != old) {
            self.wake();
        }
    }

    /// Nodes at the border of what sleeps where the surface bends more than when it fell asleep.
    fn stirred_border(&self) -> Vec<u32> {
        let border = self.sleep.iter().flat_map(|sleep| &sleep.border);
        let is_stirred = |&&(node, jacobian, bend): &&(u32, f64, [f64; 3])| {
            let fit = &self.fits.nodes[node as usize];
            let change = fit.l.iter().zip(bend).map(|(l, bend)| (l * fit.h - bend).abs());
            // Negated, so that NaN wakes too.
            !(change.fold((fit.jacobian - jacobian).abs(), f64::max) <= BORDER)
        };
        border.filter(is_stirred).map(|&(node, ..)| node).collect()
    }

    /// Wakes some of the bays that sleep.
    fn keep_asleep(
        &mut self,
        bays: &Bays,
        is_kept: impl Fn(usize) -> bool,
        positions: &[DVec3],
    ) -> Result<(), SolverError> {
        let Some(sleep) = &self.sleep else { return Ok(()) };
        let asleep: Vec<bool> =
            sleep.asleep.iter().enumerate().map(|(bay, &is)| is && is_kept(bay)).collect();
        if asleep == sleep.asleep {
            return Ok(());
        }
        self.stir();
        self.fall_asleep(bays, asleep, positions)
    }

    /// Lets these bays sleep and no others, or none if they are too few.
    fn fall_asleep(
        &mut self,
        bays: &Bays,
        asleep: Vec<bool>,
        positions: &[DVec3],
    ) -> Result<(), SolverError> {
        let count = bays.count(|bay| asleep[bay]);
        if count < self.settings.least_asleep {
            self.wake();
            return Ok(());
        }
        let Parts { can_move, border, active, unknowns } = self.parts(bays, &asleep);
        let awake = Preconditioner::new(&self.rings, &unknowns, Acting::OnOffsets)
            .and_then(|first| Ok((first, field_preconditioner(&self.rings, &unknowns)?)));
        let (preconditioner, fields) = match awake {
            Ok(awake) => awake,
            Err(reason) => {
                self.wake();
                return Err(reason.into());
            }
        };
        let mut new = Equations {
            assembly: Assembly::new(&self.rings, &unknowns),
            unknowns,
            preconditioner,
            field_preconditioner: fields,
        };
        self.exchange(&mut new);
        let whole = match self.sleep.take() {
            Some(sleep) => sleep.whole,
            None => new,
        };
        // Both sets of fits must know the nodes that will not be fitted again.
        self.fits.refit(&self.rings, &self.goals, positions, crate::fits::Wanted::Energy);
        self.fits.take_active(Arc::clone(&active));
        self.trial.follow(&self.fits, active);
        self.trial_positions.copy_from_slice(positions);
        let border = border.into_iter().map(|node| {
            let fit = &self.fits.nodes[node as usize];
            (node, fit.jacobian, fit.l.map(|l| l * fit.h))
        });
        self.sleep = Some(Sleep { count, asleep, can_move, border: border.collect(), whole });
        self.predictor.reset();
        Ok(())
    }

    /// Puts these equations in the place of those there are.
    fn exchange(&mut self, new: &mut Equations) {
        std::mem::swap(&mut self.assembly, &mut new.assembly);
        std::mem::swap(&mut self.unknowns, &mut new.unknowns);
        std::mem::swap(&mut self.preconditioner, &mut new.preconditioner);
        std::mem::swap(&mut self.field_preconditioner, &mut new.field_preconditioner);
    }

    /// What is what while these bays sleep.
    fn parts(&self, bays: &Bays, asleep: &[bool]) -> Parts {
        let sleeps = |node: usize| bays.of(node).is_some_and(|bay| asleep[bay]);
        let has = |node: usize, what: &dyn Fn(usize) -> bool| {
            self.rings.ring(node).iter().any(|&far| what(far as usize))
        };
        let can_move: Vec<bool> = (0..self.rings.len())
            .map(|node| !sleeps(node) && (!self.fixed[node] || !has(node, &sleeps)))
            .collect();
        let is_awake = |node: usize| !self.fixed[node] && !sleeps(node);
        let is_border = |node: usize| self.fixed[node] && has(node, &sleeps) && has(node, &is_awake);
        #[expect(clippy::cast_possible_truncation, reason = "nodes are counted by u32")]
        let border = (0..self.rings.len()).filter(|&node| is_border(node)).map(|node| node as u32).collect();
        let stirs = |node: u32| can_move[node as usize] || has(node as usize, &|far| can_move[far]);
        let active = Arc::new(Active::new(&self.rings, stirs));
        let unknowns = Unknowns::new(
            (0..self.rings.len()).map(|node| is_awake(node) && !self.rings.ring(node).is_empty()),
        );
        Parts { can_move, border, active, unknowns }
    }
}

/// Which nodes can move, lie between, are fitted and are solved for while bays sleep.
struct Parts {
    can_move: Vec<bool>,
    border: Vec<u32>,
    active: Arc<Active>,
    unknowns: Unknowns,
}

#[cfg(test)]
mod tests {
    use super::super::advance::REST_MOVE;
    use super::*;
    use crate::{Budget, Rings, Settings, workload};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A tube of eight bays between nine fixed circles, and the nodes of each circle.
    fn tube() -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
        tube_that_sleeps_from(100)
    }

    /// The same, of which no fewer nodes may sleep.
    fn tube_that_sleeps_from(least_asleep: usize) -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
        let (around, along) = (24, 64);
        let mut shape = workload::cylinder(around, along, 8.0);
        let mut circles = Vec::new();
        for level in (0..=along).step_by(8) {
            let circle: Vec<u32> = (level * around..(level + 1) * around).collect();
            circle.iter().for_each(|&node| shape.fixed[node as usize] = true);
            circles.push(circle);
        }
        let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
        let settings = Settings { least_asleep, ..Settings::default() };
        let mut solver = SurfaceSolver::new(rings, shape.fixed, settings).unwrap();
        let mut positions = shape.positions;
        assert!((0..60).any(|_| solver.step(&mut positions, Budget::default()).unwrap().at_rest));
        (solver, positions, circles)
    }

    /// Moves the first circle along in small steps, with or without sleep; the energy at rest, and the most that slept.
    fn drag(may_sleep: bool) -> (f64, usize, Vec<DVec3>) {
        let least = if may_sleep { 100 } else { usize::MAX };
        let (mut solver, mut positions, circles) = tube_that_sleeps_from(least);
        let mut most = 0;
        for _ in 0..20 {
            let before = positions.clone();
            let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
            solver.predict(&mut positions, &moves).unwrap();
            solver.step(&mut positions, Budget::default()).unwrap();
            solver.doze(&before, &positions).unwrap();
            most = most.max(solver.asleep());
        }
        solver.wake();
        assert!((0..60).any(|_| solver.step(&mut positions, Budget::default()).unwrap().at_rest));
        (solver.energy(), most, positions)
    }

    #[test]
    fn far_bays_sleep_through_a_drag_and_the_shape_is_the_same() {
        let (energy, none, positions) = drag(false);
        let (slept, most, same) = drag(true);
        assert_eq!(none, 0);
        assert!(most >= 24 * 7 * 3, "{most} slept");
        assert!((slept / energy - 1.0).abs() < 1e-6, "{slept} for {energy}");
        let worst = positions.iter().zip(&same).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(worst < 1e-3, "{worst}");
    }

    /// What is not fitted again is what a fit of everything would say.
    #[test]
    fn fits_of_sleeping_bays_are_exact() {
        let (mut solver, mut positions, circles) = tube();
        for _ in 0..12 {
            if solver.asleep() > 0 && positions[circles[0][0] as usize].x > 1.03 {
                break;
            }
            let before = positions.clone();
            let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
            solver.predict(&mut positions, &moves).unwrap();
            solver.step(&mut positions, Budget::default()).unwrap();
            solver.doze(&before, &positions).unwrap();
        }
        assert!(solver.asleep() > 0);
        let energy = solver.energy();
        let normals = solver.normals().to_vec();
        assert!(solver.wake());
        solver.evaluate(&positions);
        assert_eq!(solver.energy().to_bits(), energy.to_bits());
        assert_eq!(solver.normals(), normals);
    }

    /// What a drag of a shape at rest does not reach need not be solved for once: it sleeps before the first frame, and nobody
    /// sees it.
    #[test]
    fn the_first_frame_of_a_drag_solves_for_what_it_reaches() {
        let (mut solver, mut positions, circles) = tube();
        let (mut other, mut awake, _) = tube_that_sleeps_from(usize::MAX);
        let h = solver.fits.nodes[circles[4][0] as usize].h;
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.05)).collect();
        solver.predict(&mut positions, &moves).unwrap();
        assert_eq!(solver.asleep(), 24 * 7 * 3, "five bays lie within four curves");
        other.predict(&mut awake, &moves).unwrap();
        for _ in 0..3 {
            solver.step(&mut positions, Budget::default()).unwrap();
            other.step(&mut awake, Budget::default()).unwrap();
        }
        let apart = positions.iter().zip(&awake).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(apart > 0.0 && apart < STIR * h, "{apart} of edges of {h}");
        // Only what is at rest begins so: a shape that somebody moved is all awake.
        let (mut solver, mut positions, circles) = tube();
        positions[circles[3][0] as usize + 30].x += 1e-3;
        let moves = [(circles[0][0], DVec3::X * 1e-4)];
        solver.predict(&mut positions, &moves).unwrap();
        assert_eq!(solver.asleep(), 0);
    }

    /// The border of what sleeps moves on bay by bay; the rest goes on sleeping.
    #[test]
    fn a_border_that_stirs_wakes_the_bays_beside_it_alone() {
        let (mut solver, mut positions, circles) = dozing();
        let first = solver.asleep();
        let mut counts = vec![first];
        for _ in 0..60 {
            let before = positions.clone();
            let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.02)).collect();
            solver.predict(&mut positions, &moves).unwrap();
            solver.step(&mut positions, Budget::default()).unwrap();
            solver.doze(&before, &positions).unwrap();
            if Some(&solver.asleep()) != counts.last() {
                counts.push(solver.asleep());
            }
        }
        assert!(counts.len() > 1 && counts[1] > 0 && counts[1] < first, "{counts:?}");
    }

    fn dozing() -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
        let (mut solver, mut positions, circles) = tube();
        let before = positions.clone();
        let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
        solver.predict(&mut positions, &moves).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
        solver.doze(&before, &positions).unwrap();
        assert!(solver.asleep() > 0);
        (solver, positions, circles)
    }

    #[test]
    fn a_control_beside_a_sleeping_bay_wakes_it() {
        let (mut solver, mut positions, circles) = dozing();
        solver.predict(&mut positions, &[(circles[6][0], DVec3::X * 0.02)]).unwrap();
        assert_eq!(solver.asleep(), 0);
    }

    #[test]
    fn a_sleeping_node_that_somebody_moved_wakes_all() {
        let (mut solver, mut positions, circles) = dozing();
        let node = circles[6][0] as usize + 30;
        positions[node] += DVec3::X * 1e-3;
        solver.step(&mut positions, Budget::default()).unwrap();
        assert_eq!(solver.asleep(), 0);
    }

    #[test]
    fn a_stronger_drag_wakes_the_bays_that_it_reaches() {
        let (mut solver, mut positions, circles) = dozing();
        let mut woke = false;
        for _ in 0..40 {
            let before = positions.clone();
            let asleep = solver.asleep();
            let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.05)).collect();
            solver.predict(&mut positions, &moves).unwrap();
            solver.step(&mut positions, Budget::default()).unwrap();
            solver.doze(&before, &positions).unwrap();
            woke |= solver.asleep() < asleep;
        }
        assert!(woke, "the border never stirred");
    }

    /// The angles between the facets on both sides of a circle's edges.
    fn folds(solver: &SurfaceSolver, positions: &[DVec3], circle: &[u32]) -> Vec<f64> {
        let triangles = solver.rings().triangles();
        let normal = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|node| positions[node as usize]);
            (b - a).cross(c - a)
        };
        let sides = circle.iter().zip(circle.iter().cycle().skip(1)).filter_map(|(a, b)| {
            let on = triangles.iter().filter(|t| t.contains(a) && t.contains(b)).collect::<Vec<_>>();
            let [one, other] = on[..] else { return None };
            Some(normal(one).angle_between(normal(other)))
        });
        sides.collect()
    }

    /// Asleep or not, what a hand sees of the border is the same, and nothing jumps when all wakes.
    #[test]
    fn no_seam_shows_at_the_border_of_sleeping_bays_and_nothing_jumps_when_they_wake() {
        let (mut solver, mut positions, circles) = tube();
        let (mut other, mut awake, _) = tube_that_sleeps_from(usize::MAX);
        let h = solver.fits.nodes[circles[4][0] as usize].h;
        let (mut tilt, mut fold, mut apart) = (0.0_f64, 0.0_f64, 0.0_f64);
        let mut frames = 0;
        for _ in 0..20 {
            let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
            let before = positions.clone();
            solver.predict(&mut positions, &moves).unwrap();
            solver.step(&mut positions, Budget::default()).unwrap();
            let is_asleep = solver.asleep() > 0;
            solver.evaluate(&positions);
            other.predict(&mut awake, &moves).unwrap();
            other.step(&mut awake, Budget::default()).unwrap();
            other.evaluate(&awake);
            frames += u32::from(is_asleep);
            for circle in circles[1..8].iter().filter(|_| is_asleep) {
                for &node in circle {
                    let node = node as usize;
                    assert_eq!(positions[node], awake[node], "a control that nobody moved");
                    tilt = tilt.max(solver.normals()[node].angle_between(other.normals()[node]));
                }
                let [ours, theirs] = [folds(&solver, &positions, circle), folds(&other, &awake, circle)];
                fold = ours.iter().zip(&theirs).fold(fold, |most, (a, b)| most.max((a - b).abs()));
            }
            apart = positions.iter().zip(&awake).fold(apart, |most, (a, b)| most.max(a.distance(*b)));
            solver.doze(&before, &positions).unwrap();
        }
        assert!(frames > 10 && solver.asleep() > 0, "{frames}");
        // The hand stops: all wakes, and the next step is one of the whole.
        let border: Vec<u32> = solver.sleep.as_ref().unwrap().border.iter().map(|border| border.0).collect();
        let beside = |node: u32| solver.rings.ring(node as usize).to_vec();
        let beside: Vec<u32> = border.iter().flat_map(|&node| beside(node)).collect();
        let before = positions.clone();
        assert!(!border.is_empty() && solver.wake());
        let moved = |now: &[DVec3], node: usize| now[node].distance(before[node]) / h;
        let mut jumps = [0.0_f64; 2];
        for _ in 0..2 {
            solver.step(&mut positions, Budget::default()).unwrap();
            let beside = beside.iter().map(|&node| moved(&positions, node as usize)).fold(0.0, f64::max);
            let anywhere = (0..positions.len()).map(|node| moved(&positions, node)).fold(0.0, f64::max);
            jumps = [jumps[0].max(beside), jumps[1].max(anywhere)];
        }
        // A step that moves nothing farther counts as rest.
        println!(
            "{jumps:?} of an edge, normals by {tilt}, facets by {fold} radians, apart by {} of an edge",
            apart / h
        );
        assert!(jumps[0] < 0.5 * REST_MOVE && jumps[1] < 0.5 * REST_MOVE, "{jumps:?} of an edge");
        assert!(tilt < BORDER && fold < BORDER, "normals by {tilt}, facets by {fold} radians");
        assert!(apart < STIR * h, "{apart}");
        assert!(border.iter().all(|&node| positions[node as usize] == before[node as usize]));
    }
}
