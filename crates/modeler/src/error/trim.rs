//! Why two surfaces cannot be trimmed, in words for the designer.

use ductile_mesh::IntersectError;
use ductile_spec::SurfaceId;
use glam::DVec3;
use thiserror::Error;

/// Why two surfaces cannot be trimmed. Both are as they were before.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TrimError {
    /// Two surfaces are trimmed against each other.
    #[error("{0} cannot be trimmed against itself; choose two surfaces")]
    TrimsItself(SurfaceId),
    /// The surfaces do not meet.
    #[error("{0} and {1} do not meet: move them so that they run through one another")]
    NoMeeting(SurfaceId, SurfaceId),
    /// The line in which they meet ends inside both.
    #[error(
        "{one} and {other} meet in a line that divides neither of them, for it ends inside at {at}; let one of them run right through the other"
    )]
    OpenMeeting {
        /// The first.
        one: SurfaceId,
        /// The second.
        other: SurfaceId,
        /// Where it ends.
        at: DVec3,
    },
    /// What is cut stands inside a surface that runs on there.
    #[error(
        "the line in which they meet does not divide {0}: what is cut stands on it, and can neither be joined smoothly nor at an angle"
    )]
    StandsInside(SurfaceId),
    /// An angle between two surfaces is none.
    #[error("the angle of a join is above 0° and at most 180°; a smooth join has none")]
    BadJoinAngle,
    /// How the surfaces meet cannot be told.
    #[error("{one} and {other} touch rather than cross at {at}: move one of them a little")]
    Untold {
        /// The first.
        one: SurfaceId,
        /// The second.
        other: SurfaceId,
        /// Where.
        at: DVec3,
        /// Why.
        why: IntersectError,
    },
    /// A line in which they meet is too short to be a curve.
    #[error(
        "{one} and {other} only touch at {at}: they meet there in a line shorter than {least:.3}, too short to be cut along. Move them farther into one another, or apart"
    )]
    OnlyTouch {
        /// The first.
        one: SurfaceId,
        /// The second.
        other: SurfaceId,
        /// Where.
        at: DVec3,
        /// How long it must be.
        least: f64,
    },
    /// No line bounds both parts that are to stay.
    #[error("the parts of {0} and {1} that are to stay do not meet anywhere")]
    PartsApart(SurfaceId, SurfaceId),
}
