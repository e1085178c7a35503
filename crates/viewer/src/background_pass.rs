//! Draws the gradient behind everything and the grid of the work plane.

use crate::pipeline::{Meets, Pulls, Recipe, Workshop};
use wgpu::{RenderPass, RenderPipeline};

/// The gradient.
pub(crate) const BACKGROUND_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/background.wgsl"));
/// The grid.
pub(crate) const GRID_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/grid.wgsl"));

#[derive(Debug)]
pub(crate) struct BackgroundPass {
    gradient: RenderPipeline,
    grid: RenderPipeline,
}

impl BackgroundPass {
    pub(crate) fn new(workshop: &Workshop<'_>) -> Self {
        let gradient = Recipe {
            label: "background",
            vertex: "background_vertex",
            fragment: "background_fragment",
            meets: Meets::Background,
            is_quad: false,
            pulls: Pulls::Nothing,
        };
        let grid = Recipe {
            label: "grid",
            vertex: "grid_vertex",
            fragment: "grid_fragment",
            meets: Meets::Visible,
            is_quad: true,
            pulls: Pulls::Nothing,
        };
        Self {
            gradient: workshop.pipeline(&workshop.shader("background", BACKGROUND_SHADER), &gradient),
            grid: workshop.pipeline(&workshop.shader("grid", GRID_SHADER), &grid),
        }
    }

    pub(crate) fn draw_gradient(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.gradient);
        pass.draw(0..3, 0..1);
    }

    /// After the surfaces, which hide it.
    pub(crate) fn draw_grid(&self, pass: &mut RenderPass<'_>) {
        pass.set_pipeline(&self.grid);
        pass.draw(0..4, 0..1);
    }
}
