//! Displacements: what moves the inside of a finished surface, of whatever kind (P. Salvi, *Editing the interior of arbitrary
//! surfaces using C∞ displacement blends*).
//!
//! A foot is named by its place in space, on the surface as it is without displacements. A vertex or a triangle would not
//! do: meshes are made anew, at the latest when the document is opened again. Nor would parameters: a fair surface has none.
//! A place is found again on any mesh as the nearest one, to within the error of the mesh. When the surface below it
//! moves, the act that moved it carries the foot along, and the new place is part of that act.

use crate::id::{CurveId, SurfaceId};
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Largest range: beyond it a displacement has no width left in which to vanish.
pub const MOST_RANGE: f64 = 0.99;
/// Smallest range: below it a displacement is smaller than any triangle.
pub const LEAST_RANGE: f64 = -20.0;
/// Most feet that a surface may have.
pub const MOST_FEET: usize = 64;

/// The displacements of a surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displaced {
    /// What all of them have in common.
    #[serde(default, skip_serializing_if = "Blending::is_default")]
    pub blending: Blending,
    /// In the order in which they were made. They are named by their numbers, from 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub items: Vec<Displacement>,
}

/// What the displacements of a surface have in common.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Blending {
    /// How far they reach at the same range.
    #[serde(default, skip_serializing_if = "is_default")]
    pub profile: Profile,
    /// How several are met.
    #[serde(default, skip_serializing_if = "is_default")]
    pub combination: Combination,
    /// How they rise.
    #[serde(default, skip_serializing_if = "is_default")]
    pub blend: Blend,
    /// What stays where it is, beside the boundary. A closed surface needs a pin.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub pins: Vec<Hold>,
}

/// A displacement.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// What it moves.
    pub foot: Foot,
    /// By what it moves it, in model units.
    pub by: DVec3,
    /// How far around: 0 as far as the surface would by itself, up to 0.99 nearly all of it, below 0 less.
    #[serde(default, skip_serializing_if = "is_default")]
    pub range: f64,
    /// Whether it reaches further in one direction than in others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<Stretch>,
}

/// What a displacement moves by exactly what is asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Foot {
    /// The place of the surface, as it is without displacements, nearest to this one.
    At(DVec3),
    /// Several places that move together, at least one.
    All(Vec<DVec3>),
    /// A curve inside the surface.
    Along(CurveId),
}

/// A direction along which a displacement reaches further than across.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stretch {
    /// The direction, of any length but zero; it is projected into the surface.
    pub along: DVec3,
    /// How many times further, between 1/64 and 64; up to 4 is unproblematic.
    pub times: f64,
}

/// A displacement that a tool would begin: where it points, and how far that would reach.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displacing {
    /// Of which surface.
    pub surface: SurfaceId,
    /// Where the hand is, on the surface as it is shown.
    pub at: DVec3,
    /// The curve inside the surface that moves as a whole; without one the place moves.
    #[serde(default)]
    pub along: Option<CurveId>,
    /// How far around, as a displacement says it.
    pub range: f64,
    /// Whether it reaches further in one direction than in others.
    #[serde(default)]
    pub direction: Option<Stretch>,
}

/// What stays where it is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Hold {
    /// Everything within a distance of a place.
    Around {
        /// The place, on the surface as it is without displacements.
        at: DVec3,
        /// In model units, straight through space; the vertex nearest to the place stays in any case.
        radius: f64,
    },
    /// A curve inside the surface.
    Curve(CurveId),
}

/// How a function that is 1 at a foot and 0 at the border is made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Profile {
    /// From the conformal radius: independent of the mesh.
    #[default]
    Conformal,
    /// The paper's harmonic function, which gets narrower with a finer mesh.
    Harmonic,
}

/// How several displacements of a surface are met.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Combination {
    /// Every foot moves by exactly what is asked.
    #[default]
    Pairwise,
    /// The paper's sum: displacements drag other feet along.
    Plain,
}

/// The step from 0 to 1 by which displacements rise.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Blend {
    /// The expo-rational B-spline.
    #[default]
    Erbs,
    /// The bump function, with its exponent above 0 and at most 100.
    Bump(f64),
    /// The function η, with its margin in [0, 1/2).
    Eta(f64),
}

impl Blending {
    fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

impl Displaced {
    /// Whether nothing is said: then it is not kept.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        *self == Self::default()
    }

    /// The curves that it hangs on.
    pub fn curves(&self) -> impl Iterator<Item = CurveId> + '_ {
        let feet = self.items.iter().filter_map(|item| item.foot.curve());
        let pins = self.blending.pins.iter().filter_map(|pin| match pin {
            Hold::Curve(curve) => Some(*curve),
            Hold::Around { .. } => None,
        });
        feet.chain(pins)
    }

    /// The places of all feet and pins that are places, to be changed.
    pub fn places_mut(&mut self) -> impl Iterator<Item = &mut DVec3> {
        let feet = self.items.iter_mut().flat_map(|item| item.foot.places_mut());
        let pins = self.blending.pins.iter_mut().filter_map(|pin| match pin {
            Hold::Around { at, .. } => Some(at),
            Hold::Curve(_) => None,
        });
        feet.chain(pins)
    }
}

impl Displacement {
    /// A displacement of one place, with the usual reach.
    #[must_use]
    pub fn new(at: DVec3, by: DVec3) -> Self {
        Self { foot: Foot::At(at), by, range: 0.0, direction: None }
    }
}

impl Displacing {
    /// The displacement that it begins, by `by`; `below` is the place of the hand on the surface without displacements.
    #[must_use]
    pub fn displacement(&self, below: DVec3, by: DVec3) -> Displacement {
        let foot = self.along.map_or(Foot::At(below), Foot::Along);
        Displacement { foot, by, range: self.range, direction: self.direction }
    }
}

impl Foot {
    /// The places that move; none of a curve.
    #[must_use]
    pub fn places(&self) -> &[DVec3] {
        match self {
            Self::At(at) => core::slice::from_ref(at),
            Self::All(places) => places,
            Self::Along(_) => &[],
        }
    }

    /// The curve that moves, if one does.
    #[must_use]
    pub fn curve(&self) -> Option<CurveId> {
        if let Self::Along(curve) = self { Some(*curve) } else { None }
    }

    /// The same, to be changed.
    pub fn places_mut(&mut self) -> &mut [DVec3] {
        match self {
            Self::At(at) => core::slice::from_mut(at),
            Self::All(places) => places,
            Self::Along(_) => &mut [],
        }
    }
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}
