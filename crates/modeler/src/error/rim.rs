//! Why a curve is no rim of a surface over a cage, or cannot be changed because it is one; and why nothing fits between two rims
//! or curves.

use ductile_spec::{CurveId, PointId, SurfaceId};
use glam::DVec3;
use thiserror::Error;

/// What is wrong with a rim.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum RimError {
    /// The cage does not end there; choose an edge with a face on one side only.
    #[error("the cage of {surface} does not end at an edge between {} and {}", .ends[0], .ends[1])]
    NoEnd {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The ends of the edge.
        ends: [PointId; 2],
    },
    /// Both vertices must lie on the stretch of the rim that has the edge, one before it and one after.
    #[error("the edge does not lie between {} and {} on the rim of {surface}", .between[0], .between[1])]
    NotBetween {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The vertices.
        between: [PointId; 2],
    },
    /// One curve for each stretch is enough.
    #[error("{curve} runs along that rim of {surface} already")]
    Doubled {
        /// The curve that is there.
        curve: CurveId,
        /// The surface over the cage.
        surface: SurfaceId,
    },
    /// Change the cage instead.
    #[error("{curve} is a rim of {surface}: {why}")]
    Leads {
        /// The curve.
        curve: CurveId,
        /// The surface over the cage.
        surface: SurfaceId,
        /// What to do instead.
        why: &'static str,
    },
}

/// Where two curves or rims have no room between them. What would be made there would be pinched.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TouchError {
    /// Every place of a surface is closest to itself.
    #[error(
        "{0} has no places closest to each other of its own: say where the tube begins and where it ends"
    )]
    ClosestToItself(SurfaceId),
    /// A tube needs room between the surfaces.
    #[error("{0} and {1} meet, so that no tube is between them: trim them, or move one of them")]
    Meeting(SurfaceId, SurfaceId),
    /// They share a control point.
    #[error("{0} and {1} share {2}: a skin between them would be pinched there")]
    Share(CurveId, CurveId, PointId),
    /// They have control points at the same place.
    #[error("{one} has {at} in common with {other}: a skin between them would be pinched there")]
    Curves {
        /// The first.
        one: CurveId,
        /// The second.
        other: CurveId,
        /// Where.
        at: DVec3,
    },
    /// They lie on one another there.
    #[error(
        "the rims meet at {0}: a band between them would be pinched there. Join them without one, or move them apart"
    )]
    Rims(DVec3),
}
