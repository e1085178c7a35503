//! The words that cross a boundary: the document, the edits, the messages between page and worker,
//! the layout of a frame and the share link.
//!
//! This crate knows no mesh, no solver and no browser. Both sides of every boundary (worker and page,
//! command line and file, one user and the next) depend on it and on nothing of each other.
#![cfg_attr(not(test), warn(clippy::expect_used))]

mod bytes;
mod cage;
mod cage_source;
mod displacement;
mod document;
mod edit;
mod example;
mod fill;
mod fixed_mesh;
mod frame;
mod grab;
mod id;
mod protocol;
mod ribbon_file;
mod seams;
mod shadow;
mod share;
mod surgery;
mod text;
mod validate;

pub use cage::{
    Cage, CageBlend, CageBoundary, CageMap, CageSettings, CageSplit, MAX_BUMP, MAX_CAGE_RESOLUTION,
    MAX_HERMITE, RimEdge,
};
pub use cage_source::{CageForm, CageSource};
pub use displacement::{
    Blend, Blending, Combination, Displaced, Displacement, Displacing, Foot, Hold, LEAST_RANGE, MOST_FEET,
    MOST_RANGE, Profile, Stretch,
};
pub use document::{
    Curve, Density, Document, Embedding, MAX_COORDINATE, Objective, Region, Ribbon, Side, Skeleton,
    SkeletonVertex, Surface,
};
pub use edit::{Edit, Leave, ObjectiveOf, SpacingOf, Through};
pub use example::Example;
pub use fill::{
    CurveStretch, FILL_RESOLUTION, Fill, FillInterior, FillJoin, FillNet, FillRibbon, FillSide, FillStyle,
    Hole, LEAST_LEAN, MOST_LEAN, MOST_TURN,
};
pub use fixed_mesh::{FixedMesh, MOST_MESH_TRIANGLES, MOST_MESH_VERTICES, MeshSource};
pub use frame::{
    CurveRole, CurveSpan, FailedShadow, Figures, FootEntry, FrameHeader, NO_REGION, Net, PointEntry,
    PointRole, RegionEntry, Structure, SurfaceKind, SurfaceSpan, SurfaceSummary, VERTEX_FLOATS,
    vertex_layout,
};
pub use grab::{GrabTarget, Handle};
pub use id::{CurveId, PointId, SurfaceId};
pub use protocol::{
    Committed, ExportFormat, Exported, FoundLoop, Grabbed, ImportAs, ImportFormat, Meeting, MeetingLine,
    Pulled, Reach, Refusal, Remembered, Reply, Request, Resume, Step, TRAP,
};
pub use ribbon_file::{RibbonFileError, RibbonHole, ribbon_holes};
pub use seams::{FillFigures, SeamFigures, Seams};
pub use shadow::{MOST_STRENGTH, Shadow};
pub use share::{FRAGMENT_KEY, LinkError, MAX_LINK_BYTES, from_fragment, to_fragment};
pub use surgery::{Border, Extent, JoinRibbon, On};
pub use text::{FORMAT_VERSION, MAX_TEXT_BYTES, TextError, from_text, to_compact_text, to_text};
pub use validate::Defect;

#[cfg(test)]
mod tests;
