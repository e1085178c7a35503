//! What a drag takes hold of: a point, a place that becomes one, a part of a cage, a foot of a displacement, or a direction.

use crate::displacement::Displacing;
use crate::id::{CurveId, PointId, SurfaceId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What a drag takes hold of.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum GrabTarget {
    /// An existing control point.
    Point(PointId),
    /// A place on a curve, which becomes a control point.
    Curve {
        /// Which curve.
        curve: CurveId,
        /// Where, roughly.
        at: DVec3,
    },
    /// A place on a surface, which becomes a control point.
    Surface {
        /// Which surface.
        surface: SurfaceId,
        /// Where, roughly.
        at: DVec3,
    },
    /// A place or a curve of a surface from which its inside is displaced: it follows the hand.
    Displace(Displacing),
    /// The foot of a displacement; of several feet, and of a curve, the first place.
    Foot {
        /// Which surface.
        surface: SurfaceId,
        /// Which of its displacements, from 1.
        number: usize,
    },
    /// An edge of a cage: both ends go with the hand.
    Edge {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Its ends.
        ends: [PointId; 2],
        /// Where the hand is that takes hold of it.
        at: DVec3,
    },
    /// A face of a cage: all corners go with the hand.
    Face {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Which face of the cage, from 0.
        face: u32,
        /// Where the hand is that takes hold of it.
        at: DVec3,
    },
    /// A direction at a control point. Where the hand is, less the point's place, is the direction.
    Handle(Handle),
}

/// A direction that a drag can turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Handle {
    /// That of a curve at one of its control points; one that is free is prescribed from the first move on.
    Tangent {
        /// Which curve.
        curve: CurveId,
        /// Where on it.
        point: PointId,
    },
    /// The prescribed normal of a surface at one of its control points.
    Normal {
        /// Which surface.
        surface: SurfaceId,
        /// Where in it.
        point: PointId,
    },
    /// The prescribed direction in which a surface leaves a curve at one of the curve's control points.
    Ribbon {
        /// Which surface.
        surface: SurfaceId,
        /// Which curve in it.
        curve: CurveId,
        /// Where on the curve.
        point: PointId,
    },
}
