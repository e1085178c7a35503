//! The page: wgpu passes, camera, picking, controls.
#![cfg_attr(not(test), warn(clippy::expect_used))]

pub mod address;
mod background_pass;
mod buffer;
mod camera;
mod curve_pass;
mod gpu;
pub mod input;
mod layer;
pub mod limit;
mod look;
mod loss;
pub mod memory;
pub mod number;
mod painter;
mod pick;
mod pipeline;
mod point_pass;
#[cfg(test)]
mod sample;
mod scene;
pub mod schedule;
#[cfg(test)]
mod shader_test;
mod skeleton;
mod surface_pass;
mod theme;
pub mod tool;
mod triad;
mod uniforms;
pub mod web;

pub use camera::{Camera, Pose, Ray, View};
pub use gpu::{GpuError, Renderer};
pub use look::{Highlight, Look, Shading, WorkPlane};
pub use pick::{Hit, Wanted, pick, pick_among};
pub use scene::{Scene, SceneError};
