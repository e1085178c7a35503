//! Draws marks, which are curves or points: dimmed where something hides them, in full elsewhere.

use crate::pipeline::{Meets, Pulls, Recipe, Workshop};
use std::ops::Range;
use wgpu::{BindGroup, RenderPass, RenderPipeline};

/// The shader of curves.
pub(crate) const CURVE_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/curve.wgsl"));
/// The shader of points.
pub(crate) const POINT_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/point.wgsl"));

#[derive(Debug)]
pub(crate) struct MarkPass {
    visible: RenderPipeline,
    hidden: RenderPipeline,
}

impl MarkPass {
    /// Draws the segments of curves.
    pub(crate) fn curves(workshop: &Workshop<'_>) -> Self {
        let entries = ["curve_vertex", "curve_fragment", "hidden_curve_fragment"];
        Self::new(workshop, ["curves", "hidden curves"], CURVE_SHADER, entries)
    }

    /// Draws points.
    pub(crate) fn points(workshop: &Workshop<'_>) -> Self {
        let entries = ["point_vertex", "point_fragment", "hidden_point_fragment"];
        Self::new(workshop, ["points", "hidden points"], POINT_SHADER, entries)
    }

    fn new(
        workshop: &Workshop<'_>,
        [label, hidden_label]: [&str; 2],
        shader: &'static str,
        [vertex, fragment, hidden_fragment]: [&str; 3],
    ) -> Self {
        let shader = workshop.shader(label, shader);
        let visible = Recipe {
            label,
            vertex,
            fragment,
            meets: Meets::Visible,
            is_quad: true,
            pulls: Pulls::ThreeBuffers,
        };
        let hidden =
            Recipe { label: hidden_label, fragment: hidden_fragment, meets: Meets::Hidden, ..visible };
        Self { visible: workshop.pipeline(&shader, &visible), hidden: workshop.pipeline(&shader, &hidden) }
    }

    /// Draws so many marks of a group.
    pub(crate) fn draw(
        &self,
        pass: &mut RenderPass<'_>,
        group: &BindGroup,
        marks: Range<u32>,
        is_hidden: bool,
    ) {
        if marks.is_empty() {
            return;
        }
        pass.set_pipeline(if is_hidden { &self.hidden } else { &self.visible });
        pass.set_bind_group(1, group, &[]);
        pass.draw(0..4, marks);
    }
}
