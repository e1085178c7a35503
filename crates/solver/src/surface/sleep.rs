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

    /// A hand took hold of controls and is going to move these nodes: sets up what their first move would, so that it costs
    /// no more than the next ones. Nothing moves.
    ///
    /// # Errors
    /// [`SolverError`] when there is not one finite position per node, a node is none or not fixed, or what stays awake cannot
    /// be set up; everything is awake then.
    pub fn attend(&mut self, positions: &[DVec3], nodes: &[u32]) -> Result<(), SolverError> {
        crate::error::check_positions(self.rings.len(), positions)?;
        let still: Vec<(u32, DVec3)> = nodes.iter().map(|&node| (node, DVec3::ZERO)).collect();
        crate::predictor::checked_moves(positions, &self.fixed, &still)?;
        let is_asked = match &self.sleep {
            Some(sleep) => nodes.iter().any(|&node| !sleep.can_move[node as usize]),
            None => self.rests && self.fits.are_at(positions),
        };
        if is_asked {
            self.sleep_beyond(positions, nodes)?;
        }
        self.refit(positions, crate::fits::Wanted::Rows);
        self.prepare()
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
        self.sleep_beyond(positions, &moved)
    }

    /// Lets what these nodes do not reach sleep, or go on sleeping.
    fn sleep_beyond(&mut self, positions: &[DVec3], nodes: &[u32]) -> Result<(), SolverError> {
        let bays = self.bays.take().unwrap_or_else(|| Bays::new(&self.rings, &self.fixed));
        let reached = bays.within(&self.rings, nodes, REACH);
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
mod tests;
