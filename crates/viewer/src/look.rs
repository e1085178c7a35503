//! What the designer has chosen to see, and what the pointer and the tools mark in the picture.

use crate::camera::View;
use crate::pick::Hit;
use crate::strip::Strip;
use ductile_spec::{CurveId, PointId, SurfaceId};
use glam::Vec3;
use std::rc::Rc;

/// How surfaces are coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Phong, with a key light that follows the camera a little.
    #[default]
    Shaded,
    /// Bands of equal angle between normal and key light: a kink in a band is a kink in the normals, a corner in it one
    /// in the curvatures.
    Isophotes,
    /// Lines of equal height over shaded matter.
    Contours,
    /// Mean curvature in colours.
    Mean,
}

impl Shading {
    /// All of them, in the order of the menu.
    pub const ALL: [Self; 4] = [Self::Shaded, Self::Isophotes, Self::Contours, Self::Mean];

    /// Its word in the page: `look-isophotes` is its menu item.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Shaded => "shaded",
            Self::Isophotes => "isophotes",
            Self::Contours => "contours",
            Self::Mean => "mean",
        }
    }

    /// The one that a digit chooses together with Alt.
    #[must_use]
    pub fn of_digit(digit: char) -> Option<Self> {
        // The digits between are those of looks to come.
        match digit {
            '1' => Some(Self::Shaded),
            '4' => Some(Self::Isophotes),
            '6' => Some(Self::Contours),
            '7' => Some(Self::Mean),
            _ => None,
        }
    }
}

/// Across which direction contours are drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Slices {
    /// Along x.
    X,
    /// Along y.
    Y,
    /// Along z: lines of equal height.
    #[default]
    Z,
    /// Along the line of sight.
    View,
}

impl Slices {
    /// All of them, in the order of a menu.
    pub const ALL: [Self; 4] = [Self::X, Self::Y, Self::Z, Self::View];

    /// Its name on the page.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::X => "X",
            Self::Y => "Y",
            Self::Z => "Z",
            Self::View => "Line of sight",
        }
    }
}

/// What is drawn, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How surfaces are coloured.
    pub shading: Shading,
    /// Isophotes: how many bands there are in half a turn, dark and light ones.
    pub bands: f32,
    /// Contours: across which direction.
    pub slices: Slices,
    /// Contours: distance from one to the next, in model units, above zero.
    pub distance: f32,
    /// Mean curvature: which values have the first and the last colour, in one over model units.
    pub range: [f32; 2],
    /// Whether the edges of the mesh are drawn.
    pub wireframe: bool,
    /// Whether control curves and control points are drawn.
    pub skeleton: bool,
    /// Whether surfaces are drawn.
    pub surface: bool,
    /// Whether the work plane shows its grid.
    pub grid: bool,
    /// Whether the axis triad is drawn in the lower right corner.
    pub triad: bool,
    /// Light marks on dark ground instead of dark marks on light.
    pub dark: bool,
    /// Device pixels per CSS pixel.
    pub device_pixel_ratio: f32,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            shading: Shading::Shaded,
            bands: 32.0,
            slices: Slices::Z,
            distance: 0.1,
            range: [-1.0, 1.0],
            wireframe: false,
            skeleton: true,
            surface: true,
            grid: false,
            triad: true,
            dark: false,
            device_pixel_ratio: 1.0,
        }
    }
}

/// What the pointer and the tools mark.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Highlight {
    /// What is under the pointer: a press would take it. A surface shows a ring that lies on it.
    pub hover: Option<Hit>,
    /// The selected control points.
    pub selected: Vec<PointId>,
    /// The selected control curve.
    pub selected_curve: Option<CurveId>,
    /// The control point that a drag holds.
    pub held: Option<PointId>,
    /// Prescribed directions at what is selected: where, and which way; drawn at one length on the screen.
    pub directions: Vec<(Vec3, Vec3)>,
    /// Points that a tool would make.
    pub ghost: Vec<Vec3>,
    /// A polyline that a tool would make.
    pub ghost_line: Vec<Vec3>,
    /// Handles, from the point that each stands on to its end, and whether the pointer is on it.
    pub arms: Vec<(Vec3, Vec3, bool)>,
    /// What a tool is about to touch: tinted with the accent.
    pub tinted: Vec<Tinted>,
    /// By how much each vertex of a surface would follow what a tool pulls, in 255ths: tinted as softly.
    pub influence: Option<(SurfaceId, Rc<[u8]>)>,
    /// Rims that a tool is about to join: closed polylines in the colour of boundaries.
    pub rims: Vec<Vec<Vec3>>,
    /// Tangent strips: how surfaces leave curves.
    pub strips: Vec<Strip>,
    /// Translucent skins of what a tool would make or take.
    pub skins: Vec<Skin>,
    /// Lines that would become sharp edges, or soft.
    pub edges: Vec<SharpOrSoft>,
    /// Lines that show what a tool would make.
    pub sketch: Vec<Vec<Vec3>>,
    /// Edges and faces of cages: a face by its corners, an edge by its ends.
    pub parts: Vec<NetPart>,
    /// Where new points go; the grid lies in it. The ground (z = 0) where there is none.
    pub work_plane: Option<WorkPlane>,
    /// The axis of the triad under the pointer.
    pub hover_view: Option<View>,
}

/// An edge or a face of a cage that is marked.
#[derive(Clone, Debug, PartialEq)]
pub struct NetPart {
    /// Its corners.
    pub places: Vec<Vec3>,
    /// Whether it is selected; else the pointer is on it.
    pub is_selected: bool,
}

/// A translucent skin.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Skin {
    /// Its triangles.
    pub facets: Vec<[Vec3; 3]>,
    /// Whether what it stands for would be refused.
    pub is_refused: bool,
}

/// A line on a surface that would become an edge, or be smoothed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SharpOrSoft {
    /// The places along it.
    pub places: Vec<Vec3>,
    /// Whether the last is joined to the first.
    pub closed: bool,
    /// Whether the surface would run smoothly through it.
    pub is_soft: bool,
}

/// What is tinted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Tinted {
    /// A whole surface.
    Surface(SurfaceId),
    /// A region of one, by its place in `Structure::regions`.
    Region(SurfaceId, u16),
}

/// A plane with two directions in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WorkPlane {
    /// A place in the plane, where its lines cross.
    pub origin: Vec3,
    /// A unit vector in the plane.
    pub u: Vec3,
    /// The unit vector in the plane at a right angle to `u`.
    pub v: Vec3,
}

impl Default for WorkPlane {
    fn default() -> Self {
        Self { origin: Vec3::ZERO, u: Vec3::X, v: Vec3::Y }
    }
}

impl WorkPlane {
    /// The unit vector that stands on the plane.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        self.u.cross(self.v)
    }
}
