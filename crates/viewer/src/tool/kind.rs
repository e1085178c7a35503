//! The tools by name: their words, their keys, what they may take.

use crate::Hit;
use ductile_spec::{CurveRole, PointRole, Structure};

use super::{entry, span};

/// The tools, in the order of the bar.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToolKind {
    /// Takes hold of anything.
    #[default]
    Shape,
    /// Places control points.
    Point,
    /// Makes curves through points.
    Curve,
    /// Draws curves on surfaces.
    Draw,
    /// Skins a closed curve.
    Sheet,
    /// Skins the space between two curves.
    Sweep,
    /// Makes curves near a surface control curves of it.
    Embed,
    /// Destroys a region.
    Burnout,
    /// Makes creases, and smooths them.
    Crease,
    /// Cuts surfaces apart.
    Split,
    /// Joins two rims.
    Glue,
    /// Makes a tube between two places.
    Merge,
    /// Cuts two surfaces where they meet, and joins them there.
    Trim,
    /// Fills loops of curves with exact patches.
    Fill,
    /// Turns how surfaces leave curves.
    Ribbon,
    /// Places cages and takes hold of their parts.
    Cage,
    /// Pulls the inside of surfaces.
    Displace,
    /// Lets a region take on the relief of another surface.
    Shadow,
    /// Lets a curve grow or shrink to the size of another; a button of the properties, not of the bar.
    Match,
    /// Divides faces of cages between two corners; a key of the Cage tool and a button of the properties.
    Divide,
}

impl ToolKind {
    /// Those of the bar.
    pub const ALL: [Self; 18] = [
        Self::Shape,
        Self::Point,
        Self::Curve,
        Self::Draw,
        Self::Sheet,
        Self::Sweep,
        Self::Embed,
        Self::Burnout,
        Self::Crease,
        Self::Split,
        Self::Glue,
        Self::Merge,
        Self::Trim,
        Self::Ribbon,
        Self::Fill,
        Self::Cage,
        Self::Displace,
        Self::Shadow,
    ];

    /// Its word in the page: `tool-shape` is its button.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Shape => "shape",
            Self::Point => "point",
            Self::Curve => "curve",
            Self::Draw => "draw",
            Self::Sheet => "sheet",
            Self::Sweep => "sweep",
            Self::Embed => "embed",
            Self::Burnout => "burnout",
            Self::Crease => "crease",
            Self::Split => "split",
            Self::Glue => "glue",
            Self::Merge => "merge",
            Self::Trim => "trim",
            Self::Ribbon => "ribbon",
            Self::Fill => "fill",
            Self::Cage => "cage",
            Self::Displace => "displace",
            Self::Shadow => "shadow",
            Self::Match => "match",
            Self::Divide => "divide",
        }
    }

    /// The tool that a key chooses.
    #[must_use]
    pub fn of_key(key: &str) -> Option<Self> {
        match key {
            "v" => Some(Self::Shape),
            "p" => Some(Self::Point),
            "c" => Some(Self::Curve),
            "d" => Some(Self::Draw),
            "s" => Some(Self::Sheet),
            "w" => Some(Self::Sweep),
            "i" => Some(Self::Embed),
            "b" => Some(Self::Burnout),
            "k" => Some(Self::Crease),
            "x" => Some(Self::Split),
            "g" => Some(Self::Glue),
            "m" => Some(Self::Merge),
            "t" => Some(Self::Trim),
            "r" => Some(Self::Ribbon),
            "f" => Some(Self::Fill),
            "q" => Some(Self::Cage),
            "e" => Some(Self::Displace),
            "l" => Some(Self::Shadow),
            _ => None,
        }
    }

    /// Whether it takes control points.
    #[must_use]
    pub fn wants_points(self) -> bool {
        matches!(
            self,
            Self::Shape
                | Self::Point
                | Self::Curve
                | Self::Draw
                | Self::Sweep
                | Self::Ribbon
                | Self::Cage
                | Self::Divide
                | Self::Fill
        )
    }

    /// Whether it takes curves.
    #[must_use]
    pub fn wants_curves(self) -> bool {
        !matches!(
            self,
            Self::Burnout | Self::Glue | Self::Merge | Self::Trim | Self::Cage | Self::Shadow | Self::Divide
        )
    }

    /// Whether it takes surfaces, or places on them.
    #[must_use]
    pub fn wants_surfaces(self) -> bool {
        !matches!(self, Self::Sheet | Self::Sweep | Self::Match | Self::Fill | Self::Ribbon | Self::Divide)
    }

    /// Whether it takes points and curves that a surface hides, where none is in sight: it has no business with surfaces.
    #[must_use]
    pub fn sees_through(self) -> bool {
        matches!(self, Self::Sheet | Self::Sweep | Self::Match | Self::Fill | Self::Divide)
    }

    /// Whether it acts on a whole region rather than at a place.
    #[must_use]
    pub fn wants_regions(self) -> bool {
        matches!(self, Self::Burnout | Self::Crease | Self::Split)
    }

    /// Whether a click on a thing could lead to anything. What is marked under the pointer is what would be taken.
    #[must_use]
    pub fn takes(self, hit: &Hit, structure: &Structure) -> bool {
        let curve = |id| span(structure, id);
        match (self, hit) {
            (Self::Draw, Hit::Point { id, .. }) => {
                entry(structure, *id).is_some_and(|point| point.role != PointRole::Free)
            }
            (Self::Ribbon, Hit::Point { id, .. }) => {
                entry(structure, *id).is_some_and(|point| point.role == PointRole::Surface)
            }
            (Self::Sweep, Hit::Point { id, .. }) => {
                entry(structure, *id).is_some_and(|point| point.role == PointRole::Curve)
            }
            (Self::Draw | Self::Crease | Self::Split | Self::Ribbon, Hit::Curve { id, .. }) => {
                curve(*id).is_some_and(|curve| curve.role != CurveRole::Free)
            }
            (Self::Displace, Hit::Curve { id, .. }) => {
                curve(*id).is_some_and(|curve| curve.role == CurveRole::Inner)
            }
            (Self::Match, Hit::Curve { id, .. }) => curve(*id).is_some_and(|curve| curve.closed),
            (_, Hit::Point { .. }) => self.wants_points(),
            (_, Hit::Curve { .. }) => self.wants_curves(),
            (_, Hit::Surface { .. }) => self.wants_surfaces(),
            (_, Hit::Edge { .. } | Hit::Face { .. }) => matches!(self, Self::Shape | Self::Cage),
        }
    }
}
