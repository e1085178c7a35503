//! Why there is no hole where one was to be filled, or no such side of a fill.

use ductile_spec::{CurveId, SurfaceId};
use thiserror::Error;

/// What is wrong with a hole, or with a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum HoleError {
    /// All loops along a curve are filled.
    #[error("the loop at {0} is filled already")]
    LoopFilled(CurveId),
    /// A curve lies on no loop.
    #[error(
        "{0} lies on no loop that could be filled: curves must meet at control points, three sides or more"
    )]
    NoLoop(CurveId),
    /// A sheet needs a closed curve, or a loop of curves.
    #[error(
        "{0} is open, and no curves lead from its one end to the other: only a closed curve can be skinned, or a loop of curves that meet at control points"
    )]
    NoRing(CurveId),
    /// Insert a control point into one of the curves.
    #[error("the loop along {0} has two control points; a skin needs three: insert one into a curve")]
    FewPoints(CurveId),
    /// Pick corners along one loop.
    #[error("no loop of curves along {0} passes through all of these corners")]
    NoLoopThrough(CurveId),
    /// The loops have too few corners.
    #[error(
        "the loop along {0} has {1} corners; a patch needs at least 3. Choose corners, or skin it with Sheet"
    )]
    FewCorners(CurveId, usize),
    /// All loops of a network are filled, or it has none.
    #[error("there is no loop of curves left that could be filled")]
    NothingToFill,
    /// The surface is no fill.
    #[error("{0} is no fill")]
    NoFill(SurfaceId),
    /// A fill has fewer sides, or is given by ribbons and has none.
    #[error("{surface} has no side {side}: it has {sides} sides along curves")]
    NoSide {
        /// Which fill.
        surface: SurfaceId,
        /// The side that was named, from 1.
        side: usize,
        /// How many there are.
        sides: usize,
    },
    /// Let the fill meet what lies around it in tangent planes first.
    #[error("{0} meets its curves in positions only: it has no planes along them that could be turned")]
    Positions(SurfaceId),
}
