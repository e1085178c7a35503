//! A fill: an exact n-sided patch in a loop of curves (P. Salvi, *G1 hole filling with S-patches made easy*, 2020).

use crate::id::{CurveId, PointId};
use serde::{Deserialize, Serialize};

/// A patch that fills a loop of curves.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    /// Its sides, at least three, each beginning where the one before ends, the last ending where the first begins.
    pub sides: Vec<FillSide>,
}

/// A side of a fill: a stretch of a control curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FillSide {
    /// Which curve.
    pub curve: CurveId,
    /// The control point of that curve where the side begins.
    pub from: PointId,
    /// The control point of that curve where it ends.
    pub to: PointId,
}
