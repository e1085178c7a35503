//! Active sets: bays that a drag hardly moves sleep, and only what is awake is fitted and solved for.
//!
//! Source: recipe section 6, "locality and sleep". A bay is a part of the free nodes that fixed ones (control curves)
//! divide from the rest. The response of a plate to a drag fades from bay to bay, so far bays move by less than can be
//! seen. A sleeping bay is held like a control: its nodes are no unknowns, and neighbourhoods in which nothing can move keep
//! their fits, which stay exact to the bit. A bay wakes, with all others, when a control beside it is moved, when the
//! surface bends more at its border, or when the caller wants everything at rest.

use std::sync::Arc;

use glam::DVec3;

use super::{SurfaceSolver, field_preconditioner};
use crate::assembly::Assembly;
use crate::error::SolverError;
use crate::fits::Active;
use crate::laplacian::Acting;
use crate::operator::{FIXED, Unknowns};
use crate::precondition::Preconditioner;
use crate::rings::Rings;

/// Motion within a frame, in units of the mean edge, below which a bay may sleep. Well below what can be seen, so that it
/// takes many frames until its border has stirred.
const QUIET: f64 = 2e-4;
/// The same for a control beside a sleeping bay.
const STIR: f64 = 1e-3;
/// Change of the Jacobian, or of a curvature times the mean edge, at the border of a sleeping bay that wakes it.
const BORDER: f64 = 1e-3;
/// Bays fall asleep one after another only if that leaves at most this share of the nodes that are awake now.
const WORTH: f64 = 0.7;

/// What is put aside while bays sleep, and how to tell that they should wake.
#[derive(Clone, Debug)]
pub(super) struct Sleep {
    /// How many nodes.
    count: usize,
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

/// The parts of the free nodes between fixed ones.
#[derive(Clone, Debug)]
pub(super) struct Bays {
    /// The bay of every node, numbered by first node; fixed nodes are in none.
    of: Vec<u32>,
    sizes: Vec<usize>,
}

impl Bays {
    fn new(rings: &Rings, fixed: &[bool]) -> Self {
        let mut of = vec![FIXED; rings.len()];
        let mut sizes = Vec::new();
        let mut stack = Vec::new();
        let mut number = 0;
        for first in 0..rings.len() {
            if of[first] != FIXED || fixed[first] {
                continue;
            }
            of[first] = number;
            stack.push(first);
            let mut size = 0;
            while let Some(node) = stack.pop() {
                size += 1;
                for &far in rings.ring(node) {
                    if of[far as usize] == FIXED && !fixed[far as usize] {
                        of[far as usize] = number;
                        stack.push(far as usize);
                    }
                }
            }
            sizes.push(size);
            number += 1;
        }
        Self { of, sizes }
    }
}

impl SurfaceSolver {
    /// Ends a frame of a drag: lets bays sleep that it hardly moved. `before` is where the nodes were when it began.
    ///
    /// Does nothing where too few nodes could sleep (see [`Settings::least_asleep`](crate::Settings::least_asleep)).
    /// Returns how many free nodes are awake.
    ///
    /// # Errors
    /// [`SolverError`] when there is not one position per node, or the awake part cannot be set up; everything is awake then.
    pub fn doze(&mut self, before: &[DVec3], positions: &[DVec3]) -> Result<usize, SolverError> {
        crate::error::check_length(self.rings.len(), before.len())?;
        crate::error::check_length(self.rings.len(), positions.len())?;
        if self.is_border_stirred() {
            self.wake();
            return Ok(self.unknowns.len());
        }
        let bays = self.bays.take().unwrap_or_else(|| Bays::new(&self.rings, &self.fixed));
        let (is_quiet, sleeping) = self.quiet(&bays, before, positions);
        let awake = bays.sizes.iter().sum::<usize>() - sleeping;
        let is_worth_it = sleeping >= self.settings.least_asleep
            && awake > 0
            && (awake as f64) <= WORTH * self.unknowns.len() as f64;
        let asleep = |&bay: &u32| bay != FIXED && is_quiet[bay as usize];
        let asleep: Option<Vec<bool>> = is_worth_it.then(|| bays.of.iter().map(asleep).collect());
        self.bays = Some(bays);
        if let Some(asleep) = asleep {
            self.wake();
            self.fall_asleep(asleep, sleeping)?;
        }
        Ok(self.unknowns.len())
    }

    /// Which bays hardly moved, and how many nodes they have.
    fn quiet(&self, bays: &Bays, before: &[DVec3], positions: &[DVec3]) -> (Vec<bool>, usize) {
        let mut is_quiet = vec![true; bays.sizes.len()];
        // What is not fitted has not moved.
        self.fits.each(|node| {
            let bay = bays.of[node];
            if bay != FIXED {
                let moved = positions[node].distance(before[node]);
                is_quiet[bay as usize] &= moved <= QUIET * self.fits.nodes[node].h;
            }
        });
        let sizes = bays.sizes.iter().zip(&is_quiet).filter(|(_, is_quiet)| **is_quiet);
        let sleeping = sizes.map(|(&size, _)| size).sum();
        (is_quiet, sleeping)
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

    /// Wakes everything if a control beside a sleeping bay is about to be moved.
    pub(super) fn heed_moves(&mut self, moves: &[(u32, DVec3)]) {
        let Some(sleep) = &self.sleep else { return };
        let stirs = |&(node, by): &(u32, DVec3)| {
            !sleep.can_move[node as usize] && by.length() > STIR * self.fits.nodes[node as usize].h
        };
        if moves.iter().any(stirs) {
            self.wake();
        }
    }

    /// Wakes everything if a node that cannot move has been moved by the caller.
    pub(super) fn heed_positions(&mut self, positions: &[DVec3]) {
        let Some(sleep) = &self.sleep else { return };
        let nodes = positions.iter().zip(&self.fits.positions).zip(&sleep.can_move);
        if nodes.into_iter().any(|((new, old), &can_move)| !can_move && new != old) {
            self.wake();
        }
    }

    fn is_border_stirred(&self) -> bool {
        let Some(sleep) = &self.sleep else { return false };
        sleep.border.iter().any(|&(node, jacobian, bend)| {
            let fit = &self.fits.nodes[node as usize];
            let change = fit.l.iter().zip(bend).map(|(l, bend)| (l * fit.h - bend).abs());
            // Negated, so that NaN wakes too.
            !(change.fold((fit.jacobian - jacobian).abs(), f64::max) <= BORDER)
        })
    }

    fn fall_asleep(&mut self, asleep: Vec<bool>, count: usize) -> Result<(), SolverError> {
        // Both sets of fits must know the nodes that will not be fitted again.
        let positions = self.fits.positions.clone();
        self.fits.forget();
        self.fits.refit(&self.rings, &self.goals, &positions, crate::fits::Wanted::Gradient);
        self.trial.clone_from(&self.fits);
        self.trial_positions.copy_from_slice(&positions);
        let has =
            |node: usize, what: &dyn Fn(u32) -> bool| self.rings.ring(node).iter().any(|&far| what(far));
        let sleeps = |node: u32| asleep[node as usize];
        let can_move: Vec<bool> = (0..self.rings.len())
            .map(|node| !asleep[node] && (!self.fixed[node] || !has(node, &sleeps)))
            .collect();
        let is_awake = |node: u32| !self.fixed[node as usize] && !asleep[node as usize];
        let border = (0..self.rings.len())
            .filter(|&node| self.fixed[node] && has(node, &sleeps) && has(node, &is_awake));
        let border = border
            .zip(std::iter::repeat(&self.fits.nodes))
            .map(|(node, fits)| {
                let fit = &fits[node];
                #[expect(clippy::cast_possible_truncation, reason = "nodes are counted by u32")]
                let index = node as u32;
                (index, fit.jacobian, fit.l.map(|l| l * fit.h))
            })
            .collect();
        let stirs = |node: u32| can_move[node as usize] || has(node as usize, &|far| can_move[far as usize]);
        let active = Arc::new(Active::new(&self.rings, stirs));
        let nodes = self.fixed.iter().zip(&asleep).enumerate();
        let unknowns = Unknowns::new(
            nodes.map(|(node, (fixed, asleep))| !fixed && !asleep && !self.rings.ring(node).is_empty()),
        );
        let preconditioner = Preconditioner::new(&self.rings, &unknowns, Acting::OnOffsets)?;
        let fields = field_preconditioner(&self.rings, &unknowns)?;
        let whole = Equations {
            assembly: std::mem::replace(&mut self.assembly, Assembly::new(&self.rings, &unknowns)),
            unknowns: std::mem::replace(&mut self.unknowns, unknowns),
            preconditioner: std::mem::replace(&mut self.preconditioner, preconditioner),
            field_preconditioner: std::mem::replace(&mut self.field_preconditioner, fields),
        };
        for fits in [&mut self.fits, &mut self.trial] {
            fits.active = Some(Arc::clone(&active));
        }
        self.predictor.reset();
        self.sleep = Some(Sleep { count, can_move, border, whole });
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Budget, Rings, Settings, workload};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A tube of eight bays between nine fixed circles, and the nodes of each circle.
    fn tube() -> (SurfaceSolver, Vec<DVec3>, Vec<Vec<u32>>) {
        let (around, along) = (24, 64);
        let mut shape = workload::cylinder(around, along, 8.0);
        let mut circles = Vec::new();
        for level in (0..=along).step_by(8) {
            let circle: Vec<u32> = (level * around..(level + 1) * around).collect();
            circle.iter().for_each(|&node| shape.fixed[node as usize] = true);
            circles.push(circle);
        }
        let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
        let settings = Settings { least_asleep: 100, ..Settings::default() };
        let mut solver = SurfaceSolver::new(rings, shape.fixed, settings).unwrap();
        let mut positions = shape.positions;
        assert!((0..60).any(|_| solver.step(&mut positions, Budget::default()).unwrap().at_rest));
        (solver, positions, circles)
    }

    /// Moves the first circle along in small steps, with or without sleep; the energy at rest, and the most that slept.
    fn drag(may_sleep: bool) -> (f64, usize, Vec<DVec3>) {
        let (mut solver, mut positions, circles) = tube();
        let mut most = 0;
        for _ in 0..20 {
            let before = positions.clone();
            let moves: Vec<_> = circles[0].iter().map(|&node| (node, DVec3::X * 0.01)).collect();
            solver.predict(&mut positions, &moves).unwrap();
            solver.step(&mut positions, Budget::default()).unwrap();
            if may_sleep {
                solver.doze(&before, &positions).unwrap();
                most = most.max(solver.asleep());
            }
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
        assert!(most > 24 * 7 * 3, "{most} slept");
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
        let ((mut solver, mut positions, circles), (mut other, mut awake, _)) = (tube(), tube());
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
        // No more than a bay may move in a frame and be taken to sleep, and beside the border still less.
        assert!(jumps[0] < 0.5 * QUIET && jumps[1] < QUIET, "{jumps:?} of an edge");
        assert!(tilt < BORDER && fold < BORDER, "normals by {tilt}, facets by {fold} radians");
        assert!(apart < STIR * h, "{apart}");
        assert!(border.iter().all(|&node| positions[node as usize] == before[node as usize]));
    }
}
