//! The page: wgpu passes, camera, picking, controls.
#![cfg_attr(not(test), warn(clippy::expect_used))]

pub mod address;
mod background_pass;
mod buffer;
mod cage_net;
mod camera;
mod closest;
mod curvature;
mod drape;
mod gpu;
pub mod input;
pub mod keys;
mod layer;
pub mod limit;
mod look;
mod looping;
mod loss;
mod mark_pass;
mod meeting;
pub mod memory;
pub mod number;
mod painter;
mod part;
mod pick;
mod pipeline;
mod polyline;
mod reaching;
mod reporting;
mod rim;
#[cfg(test)]
mod sample;
mod scene;
pub mod schedule;
#[cfg(test)]
mod shader_test;
mod skeleton;
mod skin_pass;
mod strip;
mod surface_pass;
mod theme;
pub mod tool;
mod triad;
mod uniforms;
pub mod web;

pub use cage_net::{cage_edge_at, cage_face, with_cage_face};
pub use camera::{Camera, Pose, Ray, View};
pub use closest::closest_places;
pub use curvature::mean_range;
pub use drape::drape;
pub use gpu::{GpuError, Renderer};
pub use look::{Highlight, Look, NetPart, Shading, SharpOrSoft, Skin, Slices, Tinted, WorkPlane};
pub use looping::Looping;
pub use meeting::Meetings;
pub use part::{outline, part_at, region_around, side_of};
pub use pick::{Hit, Wanted, pick, pick_among};
pub use reaching::Reaching;
pub use reporting::Reporting;
pub use rim::{RimHit, Rims};
pub use scene::{Scene, SceneError};
pub use strip::{Strip, StripCourse};
