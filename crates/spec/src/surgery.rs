//! What acts of surgery are aimed at: borders to cut along, rims to glue, sizes to grow to.
//!
//! Regions and rims have no identity: they come and go with the curves around them. They are named by a place on them,
//! which is how a pointer finds them.

use crate::id::{CurveId, SurfaceId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A place on a surface: the nearest to where it is said to be.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct On {
    /// Which surface.
    pub surface: SurfaceId,
    /// Where, roughly.
    pub at: DVec3,
}

/// Where a surface is cut.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Border {
    /// Along a curve inside it, closed or open.
    Curve(CurveId),
    /// Around the region, between its curves, at a place.
    Region(On),
}

/// How two surfaces that are trimmed are held where they are joined.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum JoinRibbon {
    /// In the directions in which they meet now; joined smoothly, in the plane half way between.
    AsMet,
    /// At this angle between them, in radians, above 0 and at most π: each turns by as much as the other.
    Angle(f64),
}

/// What the loop of a curve grows or shrinks to.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Extent {
    /// A mean distance of its control points from their centre, in model units.
    Radius(f64),
    /// The mean distance that the control points of another curve have from theirs.
    Like(CurveId),
}
