//! Draws the surfaces.

use crate::buffer::GrowingBuffer;
use crate::look::Highlight;
use crate::pipeline::{Layouts, Meets, Recipe, Workshop};
use crate::scene::Scene;
use crate::theme::Theme;
use crate::uniforms::SurfaceStyle;
use ductile_spec::SurfaceSpan;
use wgpu::{BindGroup, Device, Queue, RenderPass, RenderPipeline};

/// The surfaces.
pub(crate) const SURFACE_SHADER: &str =
    concat!(include_str!("../../../shaders/frame.wgsl"), include_str!("../../../shaders/surface.wgsl"));

/// Strength of the tint of a surface that a tool is about to touch.
const TINT: f32 = 0.30;

#[derive(Debug)]
pub(crate) struct SurfacePass {
    pipeline: RenderPipeline,
    indices: GrowingBuffer,
    styles: GrowingBuffer,
    group: Option<BindGroup>,
    spans: Vec<SurfaceSpan>,
    styles_of_now: Vec<SurfaceStyle>,
}

impl SurfacePass {
    pub(crate) fn new(workshop: &Workshop<'_>) -> Self {
        let recipe = Recipe {
            label: "surface",
            vertex: "surface_vertex",
            fragment: "surface_fragment",
            meets: Meets::Solid,
            is_quad: false,
            pulls: true,
        };
        Self {
            pipeline: workshop.pipeline(&workshop.shader("surface", SURFACE_SHADER), &recipe),
            indices: GrowingBuffer::new(workshop.device, "triangles"),
            styles: GrowingBuffer::new(workshop.device, "surface styles"),
            group: None,
            spans: Vec::new(),
            styles_of_now: Vec::new(),
        }
    }

    pub(crate) fn upload_structure(&mut self, device: &Device, queue: &Queue, scene: &Scene) {
        self.spans.clone_from(&scene.structure.surfaces);
        if self.indices.write(device, queue, &scene.indices) {
            self.group = None;
        }
    }

    /// Forgets the binding after the numbers have moved to another buffer.
    pub(crate) fn unbind(&mut self) {
        self.group = None;
    }

    pub(crate) fn prepare(
        &mut self,
        device: &Device,
        queue: &Queue,
        layouts: &Layouts,
        floats: &GrowingBuffer,
        highlight: &Highlight,
        theme: &Theme,
    ) {
        self.styles_of_now.clear();
        self.styles_of_now.extend(self.spans.iter().map(|span| {
            let tint = if highlight.tinted.contains(&span.id) { TINT } else { 0.0 };
            let sides = if span.summary.orientable { glam::Vec4::X } else { glam::Vec4::ZERO };
            SurfaceStyle { tint: theme.accent.truncate().extend(tint), sides }
        }));
        if self.styles.write(device, queue, &self.styles_of_now) {
            self.group = None;
        }
        if self.group.is_none() {
            self.group = Some(layouts.pull(device, "surfaces", [floats, &self.indices, &self.styles]));
        }
    }

    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>) {
        let Some(group) = &self.group else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, group, &[]);
        for (span, number) in self.spans.iter().zip(0_u32..) {
            // The instance tells the shader which surface it is.
            pass.draw(span.first_index..span.first_index + span.index_count, number..number + 1);
        }
    }
}
