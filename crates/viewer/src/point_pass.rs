//! Draws points: dimmed where something hides them, in full elsewhere.

use crate::pipeline::{Meets, Pulls, Recipe, Workshop};
use std::ops::Range;
use wgpu::{BindGroup, RenderPass, RenderPipeline};

/// The points.
pub(crate) const POINT_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/point.wgsl"));

#[derive(Debug)]
pub(crate) struct PointPass {
    visible: RenderPipeline,
    hidden: RenderPipeline,
}

impl PointPass {
    pub(crate) fn new(workshop: &Workshop<'_>) -> Self {
        let shader = workshop.shader("point", POINT_SHADER);
        let visible = Recipe {
            label: "points",
            vertex: "point_vertex",
            fragment: "point_fragment",
            meets: Meets::Visible,
            is_quad: true,
            pulls: Pulls::ThreeBuffers,
        };
        let hidden = Recipe {
            label: "hidden points",
            fragment: "hidden_point_fragment",
            meets: Meets::Hidden,
            ..visible
        };
        Self { visible: workshop.pipeline(&shader, &visible), hidden: workshop.pipeline(&shader, &hidden) }
    }

    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        group: &BindGroup,
        dots: Range<u32>,
        is_hidden: bool,
    ) {
        if dots.is_empty() {
            return;
        }
        pass.set_pipeline(if is_hidden { &self.hidden } else { &self.visible });
        pass.set_bind_group(1, group, &[]);
        pass.draw(0..4, dots);
    }
}
