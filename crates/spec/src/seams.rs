//! How well surfaces meet: what the page and the command line are told of the stretches of curves that two surfaces share, and of the
//! fit of the patches beside them.

use crate::fill::CurveStretch;
use crate::id::SurfaceId;
use serde::{Deserialize, Serialize};

/// The seams of a model, and how well its fills follow what they were made from.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Seams {
    /// One for each stretch of a curve and each pair of surfaces that end there, in that order.
    pub seams: Vec<SeamFigures>,
    /// One for each fill, in order.
    pub fills: Vec<FillFigures>,
}

/// The worst of a seam, wherever on it that is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SeamFigures {
    /// Which stretch of which curve.
    #[serde(flatten)]
    pub stretch: CurveStretch,
    /// The two surfaces.
    pub surfaces: [SurfaceId; 2],
    /// Largest distance between them, in model units.
    pub gap: f64,
    /// Largest angle between their tangent planes, in degrees from 0 to 90.
    pub angle: f64,
    /// Largest difference of their mean curvatures, per model unit.
    pub curvature_jump: f64,
    /// At how many places they were compared.
    pub places: u32,
    /// At how many of these one of them has no normal, so that neither angle nor curvature could be compared.
    pub without_normal: u32,
    /// At how many of these curvature was not compared: those without a normal, and those where one of them is squeezed to less than a
    /// tenth of its mean area along the seam, as beside a corner without a normal.
    #[serde(default)]
    pub without_curvature: u32,
}

/// How well a fill follows its curves and planes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FillFigures {
    /// Which fill.
    pub surface: SurfaceId,
    /// How many sides it has.
    pub sides: u32,
    /// Degree of its ribbons.
    pub degree: u32,
    /// How many control points it has.
    pub control_points: u32,
    /// Largest distance of a Bézier boundary curve from its control curve, in model units.
    pub curve_deviation: f64,
    /// Largest angle between its tangent plane and one that it was given, in degrees; 0 where none was given.
    pub plane_deviation: f64,
    /// The side (from 1) at whose beginning the hole turns outwards, if there is one: the tangents span the plane there with the other
    /// side up, and the patch folds over itself.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turned_out: Option<u32>,
    /// Why it does not follow its curves at the moment, if it cannot.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stuck: Option<String>,
}
