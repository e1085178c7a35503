//! The layout of a frame: what the worker sends to be drawn.
//!
//! The numbers of a frame travel as one `Float32Array`, in four parts one after the other:
//!
//! 1. the surface vertices, [`VERTEX_FLOATS`] floats each: position x y z, unit normal x y z;
//! 2. the curve samples, 3 floats each: position;
//! 3. the control points, 3 floats each: position;
//! 4. the vertices of control nets, 3 floats each: position.
//!
//! How many there are of each and what they belong to is the [`Structure`]; it travels, together with the
//! triangle indices (a `Uint32Array`), only when its version changes.

use crate::document::Objective;
use crate::id::{CurveId, PointId, SurfaceId};
use crate::shadow::Shadow;
use serde::{Deserialize, Serialize};

/// Floats of one surface vertex: position and normal.
pub const VERTEX_FLOATS: usize = 6;

/// Byte offsets of position and normal in a vertex, and its stride.
#[must_use]
pub const fn vertex_layout() -> [u64; 3] {
    [0, 12, 24]
}

/// The small part of a frame, sent with each.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrameHeader {
    /// Version of the [`Structure`] that the buffer has; a new one means new counts and indices.
    pub topology_version: u32,
    /// Nothing moves any more: no further step is needed.
    pub settled: bool,
    /// The point that a drag holds.
    pub held: Option<PointId>,
    /// What the status line shows.
    pub figures: Figures,
}

/// What the status line shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Figures {
    /// Mesh nodes of all surfaces and curves.
    pub nodes: u32,
    /// The true energy of all surfaces, dimensionless (the integral of squared curvatures over area).
    pub energy: f64,
    /// Relative energy that the next step is predicted to remove; 0 at rest.
    pub residual: f64,
    /// Conjugate-gradient iterations of the last step.
    pub iterations: u32,
    /// Steps since the model was opened.
    pub steps: u32,
    /// Steps that had to be damped, shortened to nothing or undone since the model was opened.
    pub rescues: u32,
    /// Wall time of the last step in milliseconds, measured at the edge of the core; 0 where nobody measures.
    pub step_milliseconds: f64,
}

/// What the numbers of a frame belong to.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Structure {
    /// Counts up with each change.
    pub version: u32,
    /// The surfaces, in the order of their vertices.
    pub surfaces: Vec<SurfaceSpan>,
    /// The curves, in the order of their samples.
    pub curves: Vec<CurveSpan>,
    /// The control points, in order.
    pub points: Vec<PointEntry>,
    /// The regions of surfaces that their curves cut in pieces.
    pub regions: Vec<RegionEntry>,
    /// Per triangle its place in `regions`; empty when there are none. Surfaces in one piece have [`NO_REGION`].
    pub region_of_triangle: Vec<u16>,
    /// The control nets of exact surfaces, in the order of their vertices.
    pub nets: Vec<Net>,
    /// The feet of displacements, in order of surface and number.
    pub feet: Vec<FootEntry>,
    /// The shadows that do not show at the moment, in order of surface.
    pub failed_shadows: Vec<FailedShadow>,
}

/// A shadow that does not show: its region or its stamp is no disc at the moment.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct FailedShadow {
    /// Of which surface a region shadows.
    pub surface: SurfaceId,
    /// What it shadows.
    pub shadow: Shadow,
    /// Why nothing of it shows, in words for the designer.
    pub why: String,
}

/// A foot of a displacement. A curve that is one has an entry for each of its vertices, in order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct FootEntry {
    /// Of which surface.
    pub surface: SurfaceId,
    /// Of which of its displacements, from 1.
    pub number: u32,
    /// The vertex of the frame that stands there.
    pub vertex: u32,
}

/// The control net of an exact surface.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Net {
    /// Whose it is.
    pub surface: SurfaceId,
    /// Its first vertex among those of all nets.
    pub first: u32,
    /// How many vertices it has.
    pub count: u32,
    /// Its edges, pairs of its vertices counted from its first.
    pub edges: Vec<[u32; 2]>,
}

/// What a surface is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum SurfaceKind {
    /// A fair surface, approximated by a mesh that relaxes.
    #[default]
    Fair,
    /// An exact surface over a cage.
    Cage,
    /// An exact patch in a loop of curves.
    Fill,
    /// A fixed mesh.
    Mesh,
}

/// Stands for no region.
pub const NO_REGION: u16 = u16::MAX;

/// A region of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RegionEntry {
    /// Of which surface.
    pub surface: SurfaceId,
    /// What it minimises, if it has a choice of its own.
    pub objective: Option<Objective>,
    /// Its target edge length, if it has one of its own.
    pub spacing: Option<f64>,
    /// Whose relief it takes on, if any.
    pub shadow: Option<Shadow>,
}

/// The part of a frame that belongs to a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceSpan {
    /// Which surface.
    pub id: SurfaceId,
    /// Its first vertex.
    pub first_vertex: u32,
    /// How many vertices it has.
    pub vertex_count: u32,
    /// Its first index; indices count from the start of the frame's vertices.
    pub first_index: u32,
    /// How many indices it has: three per triangle.
    pub index_count: u32,
    /// What it is.
    pub kind: SurfaceKind,
    /// Its topology.
    pub summary: SurfaceSummary,
}

/// The topology of a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct SurfaceSummary {
    /// Vertices − edges + faces.
    pub euler: i32,
    /// How many boundary loops it has.
    pub boundaries: u32,
    /// How many pieces it is in.
    pub components: u32,
    /// Whether it has two sides.
    pub orientable: bool,
    /// Handles, or crosscaps if it is not orientable.
    pub genus: u32,
}

/// The part of a frame that belongs to a curve.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CurveSpan {
    /// Which curve.
    pub id: CurveId,
    /// Its first sample.
    pub first: u32,
    /// How many samples it has; a closed curve does not repeat its first.
    pub count: u32,
    /// Whether the last sample joins the first.
    pub closed: bool,
    /// What it is to the surfaces.
    pub role: CurveRole,
}

/// What a curve is to the surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum CurveRole {
    /// No surface follows it.
    Free,
    /// A surface ends at it.
    Boundary,
    /// It runs inside a surface.
    Inner,
}

/// A control point of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PointEntry {
    /// Which point.
    pub id: PointId,
    /// What hangs on it.
    pub role: PointRole,
}

/// What hangs on a control point.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum PointRole {
    /// Nothing.
    Free,
    /// A curve, and perhaps surfaces.
    Curve,
    /// A surface only.
    Surface,
}

impl Structure {
    /// Vertices of all surfaces.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        self.surfaces.iter().map(|s| s.vertex_count as usize).sum()
    }

    /// Samples of all curves.
    #[must_use]
    pub fn sample_count(&self) -> usize {
        self.curves.iter().map(|c| c.count as usize).sum()
    }

    /// Floats of a whole frame.
    #[must_use]
    pub fn float_count(&self) -> usize {
        self.nets_at() + 3 * self.nets.iter().map(|net| net.count as usize).sum::<usize>()
    }

    /// Where the curve samples begin in a frame, in floats.
    #[must_use]
    pub fn samples_at(&self) -> usize {
        VERTEX_FLOATS * self.vertex_count()
    }

    /// Where the control points begin in a frame, in floats.
    #[must_use]
    pub fn points_at(&self) -> usize {
        self.samples_at() + 3 * self.sample_count()
    }

    /// Where the vertices of control nets begin in a frame, in floats.
    #[must_use]
    pub fn nets_at(&self) -> usize {
        self.points_at() + 3 * self.points.len()
    }

    /// Indices of all triangles.
    #[must_use]
    pub fn index_count(&self) -> usize {
        self.surfaces.iter().map(|s| s.index_count as usize).sum()
    }
}
