//! Paints a picture of the scene into a texture: all passes, in their order.

use crate::background_pass::BackgroundPass;
use crate::buffer::GrowingBuffer;
use crate::camera::Camera;
use crate::layer::{Layer, Marks};
use crate::look::{Highlight, Look};
use crate::mark_pass::MarkPass;
use crate::pipeline::{DEPTH_FORMAT, Layouts, Workshop};
use crate::scene::Scene;
use crate::skeleton::{Skeleton, add_highlight};
use crate::skin_pass::SkinPass;
use crate::surface_pass::SurfacePass;
use crate::theme::Theme;
use crate::triad::add_triad;
use crate::uniforms::{Frame, Segment};
use glam::Vec2;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, Buffer, BufferDescriptor, BufferUsages, Color,
    CommandEncoder, CommandEncoderDescriptor, Device, Extent3d, LoadOp, Operations, Queue, RenderPass,
    RenderPassColorAttachment, RenderPassDepthStencilAttachment, RenderPassDescriptor, StoreOp,
    TextureDescriptor, TextureDimension, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor,
};

/// All passes with what they draw.
#[derive(Debug)]
pub(crate) struct Painter {
    device: Device,
    queue: Queue,
    format: TextureFormat,
    samples: u32,
    layouts: Layouts,
    frame_buffer: Buffer,
    frame_group: BindGroup,
    targets: Option<Targets>,

    background: BackgroundPass,
    surfaces: SurfacePass,
    curves: MarkPass,
    points: MarkPass,
    skins: SkinPass,

    /// The numbers of the frame, on which surfaces and skeleton stand.
    floats: GrowingBuffer,
    has_frame: bool,
    skeleton: Skeleton,
    skeleton_layer: Layer,
    overlay_floats: GrowingBuffer,
    overlay_layer: Layer,
    /// Kept for its memory.
    marks: Marks,
    segments: Vec<Segment>,
}

/// Textures of the size of the canvas.
#[derive(Debug)]
struct Targets {
    size: [u32; 2],
    depth: TextureView,
    /// Where several samples are taken, the picture before they are averaged.
    colour: Option<TextureView>,
}

impl Painter {
    pub(crate) fn new(device: Device, queue: Queue, format: TextureFormat, samples: u32) -> Self {
        let layouts = Layouts::new(&device);
        let frame_buffer = device.create_buffer(&BufferDescriptor {
            label: Some("frame"),
            size: size_of::<Frame>() as u64,
            usage: BufferUsages::UNIFORM | BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let frame_group = device.create_bind_group(&BindGroupDescriptor {
            label: Some("frame"),
            layout: &layouts.frame,
            entries: &[BindGroupEntry { binding: 0, resource: frame_buffer.as_entire_binding() }],
        });
        let workshop = Workshop { device: &device, format, samples, layouts: &layouts };
        Self {
            background: BackgroundPass::new(&workshop),
            surfaces: SurfacePass::new(&workshop),
            curves: MarkPass::curves(&workshop),
            points: MarkPass::points(&workshop),
            skins: SkinPass::new(&workshop),
            floats: GrowingBuffer::new(&device, "numbers"),
            has_frame: false,
            skeleton: Skeleton::default(),
            skeleton_layer: Layer::new(&device),
            overlay_floats: GrowingBuffer::new(&device, "overlay numbers"),
            overlay_layer: Layer::new(&device),
            marks: Marks::default(),
            segments: Vec::new(),
            targets: None,
            frame_buffer,
            frame_group,
            layouts,
            samples,
            format,
            queue,
            device,
        }
    }

    pub(crate) fn device(&self) -> &Device {
        &self.device
    }

    pub(crate) fn queue(&self) -> &Queue {
        &self.queue
    }

    /// Takes spans and triangles; nothing of the scene is drawn until the numbers come.
    pub(crate) fn upload_structure(&mut self, scene: &Scene) {
        self.has_frame = false;
        self.surfaces.upload_structure(&self.device, &self.queue, scene);
        self.skeleton.take_structure(scene, &mut self.segments);
        self.skeleton_layer.write_segments(&self.device, &self.queue, &self.segments);
    }

    /// Takes the numbers of a frame.
    pub(crate) fn upload_frame(&mut self, scene: &Scene) {
        self.has_frame = scene.has_frame();
        self.skeleton.take_frame(scene);
        if self.floats.write(&self.device, &self.queue, &scene.floats) {
            self.surfaces.unbind();
            self.skeleton_layer.unbind();
        }
    }

    /// Paints; the size in device pixels is that of the texture.
    pub(crate) fn paint(
        &mut self,
        view: &TextureView,
        size: [u32; 2],
        camera: &Camera,
        look: &Look,
        highlight: &Highlight,
    ) {
        self.prepare(size, camera, look, highlight);
        let mut encoder =
            self.device.create_command_encoder(&CommandEncoderDescriptor { label: Some("picture") });
        self.encode(&mut encoder, view, size, look);
        self.queue.submit([encoder.finish()]);
    }

    /// Writes everything that changes between pictures.
    fn prepare(&mut self, size: [u32; 2], camera: &Camera, look: &Look, highlight: &Highlight) {
        let (device, queue) = (&self.device, &self.queue);
        let theme = Theme::new(look.dark);
        let plane = highlight.work_plane.unwrap_or_default();
        #[expect(clippy::cast_precision_loss, reason = "a canvas has fewer than 2^24 pixels across")]
        let canvas = Vec2::new(size[0] as f32, size[1] as f32);
        let frame = Frame::new(camera, look, &theme, &plane, canvas);
        queue.write_buffer(&self.frame_buffer, 0, bytemuck::bytes_of(&frame));

        self.surfaces.prepare(device, queue, &self.layouts, &self.floats, highlight, &theme);

        self.skeleton.mark(&mut self.marks, camera, highlight, &theme);
        self.skeleton_layer.write_styles(device, queue, &self.marks);
        self.skeleton_layer.bind(device, &self.layouts, &self.floats);

        self.marks.clear();
        add_highlight(&mut self.marks, camera, highlight, &theme);
        if look.triad {
            add_triad(&mut self.marks, camera, &theme, look.device_pixel_ratio, highlight.hover_view);
        }
        self.overlay_layer.write_segments(device, queue, &self.marks.segments);
        self.overlay_layer.write_styles(device, queue, &self.marks);
        if self.overlay_floats.write(device, queue, &self.marks.floats) {
            self.overlay_layer.unbind();
        }
        self.overlay_layer.bind(device, &self.layouts, &self.overlay_floats);

        if self.targets.as_ref().is_none_or(|targets| targets.size != size) {
            self.targets = Some(Targets::new(device, self.format, self.samples, size));
        }
    }

    fn encode(&self, encoder: &mut CommandEncoder, view: &TextureView, size: [u32; 2], look: &Look) {
        let Some(targets) = self.targets.as_ref().filter(|targets| targets.size == size) else { return };
        let (view, resolve_target) = match &targets.colour {
            Some(colour) => (colour, Some(view)),
            None => (view, None),
        };
        let store = if resolve_target.is_some() { StoreOp::Discard } else { StoreOp::Store };
        let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target,
                ops: Operations { load: LoadOp::Clear(Color::BLACK), store },
            })],
            depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(Operations { load: LoadOp::Clear(0.0), store: StoreOp::Discard }),
                stencil_ops: None,
            }),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        if self.has_frame && look.surface {
            self.surfaces.draw(&mut pass);
        }
        // Only where no surface is.
        self.background.draw_gradient(&mut pass);
        if look.grid {
            self.background.draw_grid(&mut pass);
        }
        if let Some([.., skins]) = self.overlay_layer.groups() {
            self.skins.draw(&mut pass, skins, self.overlay_layer.skin_count);
        }
        if self.has_frame && look.skeleton {
            self.draw_layer(&mut pass, &self.skeleton_layer);
        }
        self.draw_layer(&mut pass, &self.overlay_layer);
    }

    /// First what is hidden, then what is not.
    fn draw_layer(&self, pass: &mut RenderPass<'_>, layer: &Layer) {
        let Some([curves, points, _]) = layer.groups() else { return };
        for is_hidden in [true, false] {
            self.curves.draw(pass, curves, 0..layer.segment_count, is_hidden);
            self.points.draw(pass, points, 0..layer.dot_count, is_hidden);
        }
    }
}

impl Targets {
    fn new(device: &Device, format: TextureFormat, samples: u32, size: [u32; 2]) -> Self {
        let texture = |label, format| {
            let texture = device.create_texture(&TextureDescriptor {
                label: Some(label),
                size: Extent3d { width: size[0], height: size[1], depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: samples,
                dimension: TextureDimension::D2,
                format,
                usage: TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&TextureViewDescriptor::default())
        };
        Self {
            size,
            depth: texture("depth", DEPTH_FORMAT),
            colour: (samples > 1).then(|| texture("samples", format)),
        }
    }
}
