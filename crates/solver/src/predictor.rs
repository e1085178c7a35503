//! The predictor: moved constraints are carried by a smooth field, never moved alone.
//!
//! Source: recipe section 5. With the fits of the moment one solves `A_S phi = -A_S[:, moved]`, where `A_S` is the
//! plate matrix of a scalar field. When every moved node has the same displacement one field serves all three
//! coordinates; otherwise each coordinate is solved. The strain limit decides how much of it is applied at once.

use glam::DVec3;

use crate::assembly::Assembly;
use crate::cg::{self, Limit, Outcome, Workspace};
use crate::error::{SolverError, check_finite};
use crate::fits::Fits;
use crate::operator::{FIXED, Unknowns};
use crate::precondition::Preconditioner;
use crate::rings::Rings;

/// What a predictor call did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Predicted {
    /// The share of the motion that was applied, in [0, 1]; ask again for the rest after a step.
    pub fraction: f64,
    /// Largest relative strain of an edge under the whole motion.
    pub strain: f64,
    /// Iterations of the conjugate gradients, all fields together.
    pub iterations: u32,
    /// Largest relative residual of a field.
    pub residual: f64,
}

/// The last field, as a first guess for the next call with the same moved nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Predictor {
    /// Unit field of the last translated handle, per unknown.
    guess: Vec<f64>,
    /// What its residual is relative to.
    reference: f64,
    moved: Vec<u32>,
    rhs: Vec<f64>,
    known: Vec<f64>,
    field: Vec<DVec3>,
    workspace: Workspace,
}

/// What the predictor borrows from the solver.
#[derive(Debug)]
pub(crate) struct Parts<'a> {
    pub(crate) rings: &'a Rings,
    pub(crate) fits: &'a Fits,
    pub(crate) unknowns: &'a Unknowns,
    pub(crate) assembly: &'a Assembly,
    pub(crate) preconditioner: &'a mut Preconditioner,
    pub(crate) limit: Limit,
}

impl Predictor {
    /// Forgets the guess, because unknowns changed.
    pub(crate) fn reset(&mut self) {
        self.guess.clear();
        self.moved.clear();
    }

    /// What is known of a field: a value at every moved node, and zero.
    fn know(&mut self, nodes: usize, moves: &[(u32, DVec3)], value: impl Fn(DVec3) -> f64) {
        self.known.clear();
        self.known.resize(nodes, 0.0);
        for &(node, displacement) in moves {
            self.known[node as usize] = value(displacement);
        }
    }

    /// The displacement of every node when the fixed nodes move by `moves` and all other fixed nodes stay. Of those that are
    /// not fitted and not in `moves` it says nothing: they stay.
    ///
    /// `moves` holds each node once. The field of the last call serves as first guess when the same nodes move.
    pub(crate) fn displacements(&mut self, parts: Parts<'_>, moves: &[(u32, DVec3)]) -> (&[DVec3], Outcome) {
        let Parts { rings, fits, unknowns, assembly, preconditioner, limit } = parts;
        self.field.resize(rings.len(), DVec3::ZERO);
        let mut outcome = Outcome::default();
        let first = moves.first().map_or(DVec3::ZERO, |&(_, displacement)| displacement);
        let is_translation = moves.iter().all(|&(_, displacement)| displacement == first);
        // Every fixed node goes along: so does the whole shape, exactly.
        if is_translation && moves.len() + unknowns.len() == rings.len() {
            self.field.fill(first);
            return (&self.field, outcome);
        }
        let is_guess_good = is_translation && self.moved.iter().eq(moves.iter().map(|(node, _)| node));
        if !is_guess_good {
            self.guess.clear();
        }
        let coordinates = if is_translation { 1 } else { 3 };
        for coordinate in 0..coordinates {
            self.know(
                rings.len(),
                moves,
                |displacement| {
                    if is_translation { 1.0 } else { displacement[coordinate] }
                },
            );
            self.rhs.resize(unknowns.len(), 0.0);
            assembly.pull_fixed(rings, fits, unknowns, &self.known, &mut self.rhs);
            if !is_translation {
                self.guess.clear();
            }
            self.guess.resize(unknowns.len(), 0.0);
            let reference = (is_guess_good && self.reference > 0.0).then_some(self.reference);
            let solved = cg::solve_again(
                |x, y| assembly.matrix().multiply(x, y),
                |r, z| preconditioner.apply(r, z),
                &self.rhs,
                &mut self.guess,
                limit,
                reference,
                &mut self.workspace,
            );
            // Measured anew once the field has changed enough to be solved for.
            self.reference = if solved.iterations == 0 { solved.reference } else { f64::NAN };
            outcome.iterations += solved.iterations;
            outcome.residual = outcome.residual.max(solved.residual);
            let field = &mut self.field;
            let (known, guess) = (&self.known, &self.guess);
            if is_translation {
                tell(fits, unknowns, known, guess, |node, value| field[node] = first * value);
            } else {
                tell(fits, unknowns, known, guess, |node, value| field[node][coordinate] = value);
            }
        }
        // A moved control may lie beside what sleeps only.
        for &(node, displacement) in moves {
            self.field[node as usize] = displacement;
        }
        self.moved.clear();
        if is_translation {
            self.moved.extend(moves.iter().map(|&(node, _)| node));
        }
        (&self.field, outcome)
    }
}

/// Tells the value of a field at every node that is fitted.
fn tell(fits: &Fits, unknowns: &Unknowns, known: &[f64], solved: &[f64], mut take: impl FnMut(usize, f64)) {
    fits.each(|node| match unknowns.index[node] {
        FIXED => take(node, known[node]),
        index => take(node, solved[index as usize]),
    });
}

/// Largest relative strain that the displacements put on an edge with a free end.
///
/// Edges between two fixed nodes are the user's business; an edge much shorter than its ring is measured by its
/// ring, so that one short edge cannot hold up a handle for ever.
pub(crate) fn strain(rings: &Rings, fits: &Fits, unknowns: &Unknowns, field: &[DVec3]) -> f64 {
    let mut worst = 0.0_f64;
    fits.each(|from| {
        for (slot, to) in rings.edges_from(from) {
            if unknowns.index[from] == FIXED && unknowns.index[to] == FIXED {
                continue;
            }
            let length = fits.lengths[slot].max(0.1 * fits.nodes[from].h).max(f64::MIN_POSITIVE);
            worst = worst.max((field[from] - field[to]).length() / length);
        }
    });
    worst
}

/// Every move once (the last one counts), in order of the nodes, checked.
pub(crate) fn checked_moves(
    positions: &[DVec3],
    fixed: &[bool],
    moves: &[(u32, DVec3)],
) -> Result<Vec<(u32, DVec3)>, SolverError> {
    for &(node, displacement) in moves {
        let index = node as usize;
        if index >= fixed.len() {
            return Err(SolverError::UnknownNode(node));
        }
        if !fixed[index] {
            return Err(SolverError::NotFixed(node));
        }
        check_finite(node, displacement)?;
        check_finite(node, positions[index] + displacement)?;
    }
    let mut sorted = moves.to_vec();
    sorted.reverse();
    sorted.sort_by_key(|&(node, _)| node);
    sorted.dedup_by_key(|&mut (node, _)| node);
    Ok(sorted)
}
