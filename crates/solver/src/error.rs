//! What a solver can refuse, how it is set up, and what a step is allowed to cost.

use glam::DVec3;
use thiserror::Error;

use crate::factor::FactorError;
use crate::quadrature::Sampling;
use crate::rings::RingError;

/// Why a solver refuses. Positions are as they were.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SolverError {
    /// An array does not have one entry per node: rebuild the solver after a mesh edit.
    #[error("expected {expected} entries, one per node, and found {found}")]
    Length {
        /// Number of nodes.
        expected: usize,
        /// Length of the array.
        found: usize,
    },
    /// A position or displacement of this node is NaN, infinite, or beyond 1e50 in size: clamp the input.
    #[error("the position or displacement of node {0} is not a reasonable number")]
    NotFinite(u32),
    /// The whole shape is smaller than 1e-50 (and yet no point): its curvatures have no numbers. Scale it.
    #[error("the shape is too small for its curvatures to be numbers")]
    TooSmall,
    /// A move names a node that does not exist.
    #[error("node {0} does not exist")]
    UnknownNode(u32),
    /// Only fixed nodes can be moved; call `set_fixed` first.
    #[error("node {0} is not fixed and so cannot be moved")]
    NotFixed(u32),
    /// The normal prescribed at this node has no direction: one of its coordinates must differ from zero.
    #[error("the normal prescribed at node {0} has no direction")]
    NoDirection(u32),
    /// The connectivity is not one the solver can work with.
    #[error(transparent)]
    Rings(#[from] RingError),
    /// A curve whose objective has no energy, or lets it kink at its control points, cannot share a hub.
    #[error("curve {0} of the network minimises nothing that could be shared at a hub")]
    NoPartInNetwork(u32),
    /// More curves meet at the hubs of one network than its dense system is made for.
    #[error("{0} curves meet at hubs, too many to be solved together")]
    TooManySpokes(usize),
    /// The preconditioner could not be factorised; happens on positions that are degenerate beyond use only.
    #[error(transparent)]
    Factor(#[from] FactorError),
}

/// Largest coordinate taken in: its fourth power still fits an `f64`.
const LARGEST: f64 = 1e50;

/// Refuses vectors that are not finite or beyond use.
pub(crate) fn check_finite(node: u32, vector: DVec3) -> Result<(), SolverError> {
    // Written so that NaN fails.
    let is_good = vector.abs().max_element() <= LARGEST && !vector.is_nan();
    if is_good { Ok(()) } else { Err(SolverError::NotFinite(node)) }
}

/// Smallest extent of a shape that is no point: the fourth power of its curvature still fits an `f64`.
const SMALLEST: f64 = 1e-50;

/// Refuses positions of the wrong number or without sense.
pub(crate) fn check_positions(expected: usize, positions: &[DVec3]) -> Result<(), SolverError> {
    check_length(expected, positions.len())?;
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (node, &position) in (0_u32..).zip(positions) {
        check_finite(node, position)?;
        (low, high) = (low.min(position), high.max(position));
    }
    let extent = (high - low).max_element();
    if extent > 0.0 && extent < SMALLEST { Err(SolverError::TooSmall) } else { Ok(()) }
}

/// Refuses arrays that do not have one entry per node.
pub(crate) fn check_length(expected: usize, found: usize) -> Result<(), SolverError> {
    if expected == found { Ok(()) } else { Err(SolverError::Length { expected, found }) }
}

/// Numbers that steer a solver; the defaults are the recipe's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settings {
    /// Where the bending of a surface with rims is sampled.
    pub sampling: Sampling,
    /// Relative residual at which a step's conjugate gradients may stop early.
    pub step_tolerance: f64,
    /// The same where curvature variation is minimised: its residuals span a wider range.
    pub variation_tolerance: f64,
    /// Relative residual of the predictor's field.
    pub predictor_tolerance: f64,
    /// Iterations the predictor may spend on one field.
    pub predictor_iterations: u32,
    /// Largest relative strain of an edge in one predictor call.
    pub strain_limit: f64,
    /// Nodes that must be able to sleep for it to be worth setting up what stays awake.
    pub least_asleep: usize,
    /// Mass damping `mu` where four or more constraint points span space.
    pub damping: f64,
    /// Mass damping where they do not: such shapes have families of minimisers to drift along.
    pub loose_damping: f64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            sampling: Sampling::default(),
            step_tolerance: 3e-2,
            variation_tolerance: 3e-3,
            predictor_tolerance: 1e-3,
            predictor_iterations: 60,
            strain_limit: 0.5,
            least_asleep: 2000,
            damping: 0.1,
            loose_damping: 10.0,
        }
    }
}

/// What one step may cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Budget {
    /// Iterations of the conjugate gradients; twice as many where curvature variation is minimised.
    pub iterations: u32,
}

impl Default for Budget {
    fn default() -> Self {
        Self { iterations: 8 }
    }
}
