//! Fair curves and surfaces: energies with exact gradients, predictor, preconditioned conjugate gradients.
//!
//! A surface is a triangle mesh over which a quadratic is fitted at every node; its discrete thin-plate energy is
//! minimised by moving nodes along their fitted normals. Sources: Welch, *Serious Putty*, 1995, chapter 5, and
//! the project's recipe for it, which replaces the frozen derivatives of the thesis by exact ones.
//!
//! Everything is pure numerics over flat arrays: no clock, no threads, no hash maps, `libm` for angles, no fused
//! multiply-add. The same input gives the same bits on every target.

#![expect(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "a comparison that NaN must fail is written negated on purpose"
)]
#![expect(
    clippy::needless_range_loop,
    reason = "loops over the indices of a small matrix read like its formula"
)]

mod angle;
mod assembly;
mod barrier;
mod batch;
mod bending;
mod blocks;
mod cg;
mod clamp;
mod component;
mod constraint;
mod curve;
mod dense;
mod energy;
mod error;
mod even_ring;
mod factor;
mod fit;
mod fits;
mod gradient;
mod harmonic;
mod lanes;
mod laplacian;
mod line_search;
mod neighbourhood;
mod objective;
mod operator;
mod ordinary;
mod precondition;
mod predictor;
mod quadrature;
mod report;
mod rings;
mod smooth;
mod surface;
mod symmetric;
pub mod workload;

pub use curve::{
    CurveSettings, CurveSolver, Network, Resampled, Spoke, Strand, resample, respace, respace_graded,
};
pub use error::{Budget, Settings, SolverError};
pub use factor::FactorError;
pub use fit::Curvature;
pub use harmonic::{Fill, fill};
pub use laplacian::Weights;
pub use objective::{Objective, Objectives};
pub use predictor::Predicted;
pub use quadrature::Sampling;
pub use report::StepReport;
pub use rings::{MAX_RING, RingError, Rings};
pub use smooth::{Aim, EdgePlaces, SmoothReport, place_on_edge, smooth};
pub use surface::{Frozen, NodeFigures, SurfaceSolver};
pub use symmetric::SymmetricFactor;
