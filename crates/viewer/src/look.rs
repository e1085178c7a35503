//! What the designer has chosen to see, and what the pointer and the tools mark in the picture.

use crate::camera::View;
use crate::pick::Hit;
use ductile_spec::{CurveId, PointId, SurfaceId};
use glam::Vec3;

/// How surfaces are coloured.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shading {
    /// Phong, with a key light that follows the camera a little.
    #[default]
    Shaded,
}

/// What is drawn, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Look {
    /// How surfaces are coloured.
    pub shading: Shading,
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
    /// Rims that a tool is about to join: closed polylines in the colour of boundaries.
    pub rims: Vec<Vec<Vec3>>,
    /// Lines that show what a tool would make.
    pub sketch: Vec<Vec<Vec3>>,
    /// Where new points go; the grid lies in it. The ground (z = 0) where there is none.
    pub work_plane: Option<WorkPlane>,
    /// The axis of the triad under the pointer.
    pub hover_view: Option<View>,
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
