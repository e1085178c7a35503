//! Exact shapes beside the fair ones: S-patches that fill n-sided holes, surfaces blended over cages, displacements
//! that move the interior of any surface.
//!
//! Sources: P. Salvi, *G1 hole filling with S-patches made easy* (2020); P. Salvi, *Polyhedral design with blended
//! n-sided interpolants*; P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*. Each
//! module says where it departs from them and why.
//!
//! Everything is pure arithmetic over flat arrays: no clock, no threads, no hash maps, `libm` for what is not
//! arithmetic, no fused multiply-add. The same input gives the same bits on every target.

mod bernstein;
mod bezier;
pub mod cage;
mod displacement;
mod jet;
mod network;
#[cfg(test)]
mod property_test;
pub mod relief;
mod ribbon;
pub mod s_patch;
mod seam;
pub(crate) mod surface_point;

pub use bernstein::{basis, basis_derivative, binomial};
pub use bezier::{
    CurveFit, FitError, MOST_FITTED_DEGREE, curve_derivative, curve_point, elevated, fit_curve,
    fit_curve_along, hodograph,
};
pub use displacement::{
    Blend, BlendError, BlendFunction, Combination, Direction, DisplacementError, Displacements, Domain, Erbs,
    Item, ItemReport, Laplacian, Placed, Profile, Range, Settings, nearest_spot, place,
};
pub use network::{Directed, NetworkEdge, loops_through, network_faces, plane_of_directions};
pub use ribbon::{
    Adjusted, MOST_DEGREE, MOST_SIDES, NoNormal, PlaneSample, Planed, Ribbon, RibbonError, RibbonLoop,
    made_compatible, ribbons_along, ribbons_raised,
};
pub use seam::{Seam, seam};
pub use surface_point::SurfacePoint;
