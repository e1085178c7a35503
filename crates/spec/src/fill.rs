//! A fill: an exact n-sided patch in a loop of curves (P. Salvi, *G1 hole filling with S-patches made easy*, 2020).
//!
//! Its sides are stretches of control curves, so that it follows whatever moves those; or it is given by ribbons, whose control
//! points are in the document itself.

use crate::document::{Curve, Document};
use crate::id::{CurveId, PointId, SurfaceId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A patch that fills a loop of curves.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Fill {
    /// Its sides, at least three, each beginning where the one before ends, the last ending where the first begins. None if it has
    /// ribbons.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub sides: Vec<FillSide>,
    /// Ribbons around it in place of sides, at least three.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub ribbons: Vec<FillRibbon>,
    /// How it is filled.
    #[serde(default, skip_serializing_if = "FillStyle::is_default")]
    pub style: FillStyle,
}

/// A side of a fill: a stretch of a control curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FillSide {
    /// Which curve.
    pub curve: CurveId,
    /// The control point of that curve where the side begins.
    pub from: PointId,
    /// The control point of that curve where it ends.
    pub to: PointId,
    /// Whether it runs against the sense of a closed curve, which leads from the one point to the other in two ways.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub back: bool,
    /// The surface beside it whose tangent planes it takes; without one they are fair, and agree with those of another fill that has
    /// the same side and says nothing either.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub planes: Option<SurfaceId>,
    /// By how much its fair planes are turned about it in the middle, in radians from -π/2 to π/2: a positive turn lifts the patch
    /// inside to the side of its normal. Towards both corners, where the next curves give the planes, the turn fades to nothing.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub turn: f64,
    /// By what the derivative across it is multiplied in the middle, from [`LEAST_LEAN`] to [`MOST_LEAN`]: a strong side keeps
    /// its direction farther into the patch. It fades to 1 towards the corners.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub strength: f64,
}

/// The largest turn of a side of a fill, in radians: a right angle.
pub const MOST_TURN: f64 = core::f64::consts::FRAC_PI_2;
/// The least strength of a side of a fill.
pub const LEAST_LEAN: f64 = 0.1;
/// The largest strength of a side of a fill.
pub const MOST_LEAN: f64 = 5.0;

/// A ribbon: a Bézier curve with a second row of control points, which says in what plane the patch leaves it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FillRibbon {
    /// The boundary curve.
    pub row0: Vec<DVec3>,
    /// The next row inward of a tensor product patch of the same degree in both directions; as many points.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub row1: Vec<DVec3>,
}

/// How a fill is filled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FillStyle {
    /// Degree of the Bézier curves along its sides, 3 to 10; without one it is chosen by the number of sides, and by whether one of them
    /// winds along several edges of a cage.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub degree: Option<u8>,
    /// How its inside is placed.
    #[serde(default, skip_serializing_if = "FillInterior::is_default")]
    pub interior: FillInterior,
    /// How it meets what lies around it.
    #[serde(default, skip_serializing_if = "FillJoin::is_default")]
    pub join: FillJoin,
    /// Edges of its mesh along each side, 1 to 64; without one 16.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub resolution: Option<u8>,
    /// Which of its control points are shown.
    #[serde(default, skip_serializing_if = "FillNet::is_default")]
    pub net: FillNet,
}

/// What of its control net a fill shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FillNet {
    /// The rows along its sides: what curves and planes lead.
    #[default]
    Ribbons,
    /// All control points, joined where their labels differ by one step around: the panels of the S-patch.
    Whole,
}

/// How control points inside a fill are placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FillInterior {
    /// By the mask of neighbours applied twice: what suits tangent planes.
    #[default]
    Biharmonic,
    /// Each at the mean of its neighbours.
    Harmonic,
}

/// How a fill meets what lies around it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum FillJoin {
    /// In its tangent planes (G1).
    #[default]
    Tangent,
    /// Along its curves only.
    Position,
}

/// Edges of the mesh of a fill along each side where nothing else is said.
pub const FILL_RESOLUTION: u8 = 16;

/// What is to be filled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hole {
    /// The loop of curves, or of rims of surfaces, through a place of a curve: the shortest one, rather one that bounds nothing yet.
    Near {
        /// The curve.
        curve: CurveId,
        /// The place on it, roughly; without one anywhere.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        at: Option<DVec3>,
    },
    /// A loop with given corners. They are control points of a closed curve, at least three of them, and the loop has its sense. Or they
    /// lie on a loop of several curves, which have corners where they meet and get these besides.
    Corners {
        /// The closed curve, or one of the loop.
        curve: CurveId,
        /// Those points, in any order.
        points: Vec<PointId>,
    },
    /// Sides that are given one by one.
    Sides(Vec<FillSide>),
    /// A hole between ribbons.
    Ribbons(Vec<FillRibbon>),
    /// The same between ribbons that do not quite fit together: their twist points are moved least, so that they do.
    CompatibleRibbons(Vec<FillRibbon>),
}

/// A stretch of a curve, in the sense of the curve: two sides with one stretch are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct CurveStretch {
    /// Which curve.
    pub curve: CurveId,
    /// The control point where it begins.
    pub from: PointId,
    /// The control point where it ends.
    pub to: PointId,
}

impl FillSide {
    /// A stretch of a curve, with fair planes.
    #[must_use]
    pub fn new(curve: CurveId, from: PointId, to: PointId) -> Self {
        Self { curve, from, to, back: false, planes: None, turn: 0.0, strength: 1.0 }
    }

    /// Whether the patch leaves it otherwise than is fair.
    #[must_use]
    pub fn leans(&self) -> bool {
        !is_zero(&self.turn) || !is_one(&self.strength)
    }

    /// The stretch that it is of its curve, and whether it runs against the curve's sense.
    #[must_use]
    pub fn stretch(&self, curve: &Curve) -> (CurveStretch, bool) {
        let place = |point| curve.through.iter().position(|other| *other == point);
        let back = if curve.closed { self.back } else { place(self.from) > place(self.to) };
        let (from, to) = if back { (self.to, self.from) } else { (self.from, self.to) };
        (CurveStretch { curve: self.curve, from, to }, back)
    }
}

impl Document {
    /// The other fill that joins one smoothly along a side, where neither says whose planes count: with its side there, and whether it
    /// runs along the curve in the same sense. None if there are several.
    #[must_use]
    pub fn partner<'a>(&'a self, id: SurfaceId, side: &FillSide) -> Option<(SurfaceId, &'a FillSide, bool)> {
        let curve = self.curves.get(&side.curve)?;
        let (stretch, back) = side.stretch(curve);
        let there = |(other, fill): (&SurfaceId, &'a Fill)| {
            let found = fill.sides.iter().find(|there| {
                there.curve == side.curve && there.planes.is_none() && there.stretch(curve).0 == stretch
            })?;
            Some((*other, found, found.stretch(curve).1 == back))
        };
        let mut others = self
            .fills
            .iter()
            .filter(|(other, fill)| **other != id && fill.style.join == FillJoin::Tangent)
            .filter_map(there);
        let only = others.next()?;
        others.next().is_none().then_some(only)
    }

    /// By how much the planes along a side of a fill are turned about it, in radians, in the sense of its [`FillSide::turn`]: its own
    /// turn, and that of a patch that joins it smoothly there.
    #[must_use]
    pub fn turn_along(&self, id: SurfaceId, side: &FillSide) -> f64 {
        let is_smooth = self.fills.get(&id).is_some_and(|fill| fill.style.join == FillJoin::Tangent);
        if !is_smooth || side.planes.is_some() {
            return 0.0;
        }
        side.turn
            + self.partner(id, side).map_or(
                0.0,
                |(_, there, is_along)| {
                    if is_along { there.turn } else { -there.turn }
                },
            )
    }
}

fn one() -> f64 {
    1.0
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

impl FillStyle {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl FillNet {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl FillInterior {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl FillJoin {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}
