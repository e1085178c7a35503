//! Draws the translucent skins of the overlay.

use crate::pipeline::{Meets, Pulls, Recipe, Workshop};
use wgpu::{BindGroup, RenderPass, RenderPipeline};

/// The shader of skins.
pub(crate) const SKIN_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/skin.wgsl"));

#[derive(Debug)]
pub(crate) struct SkinPass(RenderPipeline);

impl SkinPass {
    pub(crate) fn new(workshop: &Workshop<'_>) -> Self {
        let recipe = Recipe {
            label: "skins",
            vertex: "skin_vertex",
            fragment: "skin_fragment",
            meets: Meets::Visible,
            is_quad: false,
            pulls: Pulls::ThreeBuffers,
        };
        Self(workshop.pipeline(&workshop.shader("skins", SKIN_SHADER), &recipe))
    }

    /// Draws so many corners of a group.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>, group: &BindGroup, corners: u32) {
        if corners > 0 {
            pass.set_pipeline(&self.0);
            pass.set_bind_group(1, group, &[]);
            pass.draw(0..corners, 0..1);
        }
    }
}
