//! Why a loop cannot be filled.

use ductile_patch::s_patch::{BuildError, KindError};
use ductile_patch::{FitError, RibbonError};
use ductile_spec::{CurveId, PointId};
use thiserror::Error;

/// Why there is no patch in a loop.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum FillError {
    /// A curve or one of its points is not there.
    #[error("{0} does not run between the corners of the patch")]
    NoStretch(CurveId),
    /// No Bézier curve follows the stretch.
    #[error("{curve}: {reason}")]
    Fit {
        /// Along which curve.
        curve: CurveId,
        /// Why not.
        reason: FitError,
    },
    /// The loop does not turn at a corner, or runs back into itself: a patch has no tangent plane of its own there.
    #[error(
        "the loop turns by {degrees:.0}° at {point}: a patch needs corners that turn, by no more than 175° and no less than 5°. A round hole can be skinned with Sheet, or filled up to its curves only"
    )]
    FlatCorner {
        /// The corner.
        point: PointId,
        /// By how much the loop turns there, in degrees from 0 to 180.
        degrees: f64,
    },
    /// The ribbons do not bound a patch.
    #[error(transparent)]
    Ribbons(#[from] RibbonError),
    /// The patch cannot be built.
    #[error(transparent)]
    Patch(#[from] BuildError),
    /// It, or its mesh, would be too large.
    #[error(transparent)]
    Kind(#[from] KindError),
    /// There would be more control points than can follow a hand.
    #[error(
        "a patch with {sides} sides of degree {degree} would have more than {limit} control points; choose a lower degree, or divide the hole by a curve"
    )]
    TooLarge {
        /// How many sides.
        sides: usize,
        /// Of which degree.
        degree: usize,
        /// How many control points are allowed.
        limit: usize,
    },
}
