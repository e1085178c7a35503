//! How passes are made: the bindings they share and the few things in which they differ.
//!
//! Every pass pulls its vertices from three storage buffers (numbers, elements, styles), so all share one
//! layout and no pass has vertex buffers.

use crate::buffer::GrowingBuffer;
use wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor,
    BindGroupLayoutEntry, BindingType, BlendState, BufferBindingType, ColorTargetState, ColorWrites,
    CompareFunction, DepthBiasState, DepthStencilState, Device, FragmentState, MultisampleState,
    PipelineCompilationOptions, PipelineLayout, PipelineLayoutDescriptor, PrimitiveState, PrimitiveTopology,
    RenderPipeline, RenderPipelineDescriptor, ShaderModule, ShaderModuleDescriptor, ShaderSource,
    ShaderStages, StencilState, TextureFormat, VertexState,
};

/// Reversed depth wants floats.
pub(crate) const DEPTH_FORMAT: TextureFormat = TextureFormat::Depth32Float;

/// What passes need to be made.
#[derive(Debug)]
pub(crate) struct Workshop<'a> {
    pub(crate) device: &'a Device,
    pub(crate) format: TextureFormat,
    pub(crate) samples: u32,
    pub(crate) layouts: &'a Layouts,
}

/// The bindings that passes share.
#[derive(Debug)]
pub(crate) struct Layouts {
    /// Group 0: the frame.
    pub(crate) frame: BindGroupLayout,
    /// Group 1: numbers, elements, styles; and for surfaces also the triangles around each vertex, and a tint for each.
    pub(crate) pulled: [BindGroupLayout; 2],
}

impl Layouts {
    pub(crate) fn new(device: &Device) -> Self {
        let entry = |binding, kind| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: BindingType::Buffer { ty: kind, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        };
        let group = |label, entries: &[BindGroupLayoutEntry]| {
            device.create_bind_group_layout(&BindGroupLayoutDescriptor { label: Some(label), entries })
        };
        let storage = |binding| entry(binding, BufferBindingType::Storage { read_only: true });
        Self {
            frame: group("frame", &[entry(0, BufferBindingType::Uniform)]),
            pulled: [
                group("pulled", &[storage(0), storage(1), storage(2)]),
                group("pulled with rings", &[storage(0), storage(1), storage(2), storage(3), storage(4)]),
            ],
        }
    }

    /// Binds numbers, elements and styles, and rings and tints where there are five.
    pub(crate) fn pull<const N: usize>(
        &self,
        device: &Device,
        label: &str,
        parts: [&GrowingBuffer; N],
    ) -> BindGroup {
        let resources = parts.map(|part| part.buffer().as_entire_binding());
        let entries: Vec<BindGroupEntry<'_>> =
            (0..).zip(resources).map(|(binding, resource)| BindGroupEntry { binding, resource }).collect();
        let layout = &self.pulled[usize::from(N > 3)];
        device.create_bind_group(&BindGroupDescriptor { label: Some(label), layout, entries: &entries })
    }
}

/// What a pass pulls.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pulls {
    /// Nothing.
    Nothing,
    /// Numbers, elements and styles.
    ThreeBuffers,
    /// These, the triangles around each vertex, and how softly each vertex is tinted.
    FiveBuffers,
}

/// How a pass meets what is drawn already.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meets {
    /// Behind everything, opaque: at depth 0, where nothing is.
    Background,
    /// Solid: hides what is behind it.
    Solid,
    /// A mark where nothing hides it.
    Visible,
    /// A mark where something hides it.
    Hidden,
}

/// In which things a pass differs from others.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recipe<'a> {
    pub(crate) label: &'a str,
    pub(crate) vertex: &'a str,
    pub(crate) fragment: &'a str,
    pub(crate) meets: Meets,
    pub(crate) is_quad: bool,
    pub(crate) pulls: Pulls,
}

impl Workshop<'_> {
    pub(crate) fn shader(&self, label: &str, source: &'static str) -> ShaderModule {
        self.device.create_shader_module(ShaderModuleDescriptor {
            label: Some(label),
            source: ShaderSource::Wgsl(source.into()),
        })
    }

    fn layout(&self, recipe: &Recipe<'_>) -> PipelineLayout {
        let pulled = &self.layouts.pulled[usize::from(recipe.pulls == Pulls::FiveBuffers)];
        let both = [Some(&self.layouts.frame), Some(pulled)];
        self.device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some(recipe.label),
            bind_group_layouts: if recipe.pulls == Pulls::Nothing { &both[..1] } else { &both },
            immediate_size: 0,
        })
    }

    pub(crate) fn pipeline(&self, shader: &ShaderModule, recipe: &Recipe<'_>) -> RenderPipeline {
        let (compare, writes_depth, blend) = match recipe.meets {
            Meets::Background => (CompareFunction::GreaterEqual, false, None),
            // Reversed depth: what is nearer is greater.
            Meets::Solid => (CompareFunction::Greater, true, None),
            Meets::Visible => {
                (CompareFunction::GreaterEqual, false, Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING))
            }
            Meets::Hidden => (CompareFunction::Less, false, Some(BlendState::PREMULTIPLIED_ALPHA_BLENDING)),
        };
        let topology =
            if recipe.is_quad { PrimitiveTopology::TriangleStrip } else { PrimitiveTopology::TriangleList };
        self.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some(recipe.label),
            layout: Some(&self.layout(recipe)),
            vertex: VertexState {
                module: shader,
                entry_point: Some(recipe.vertex),
                compilation_options: PipelineCompilationOptions::default(),
                buffers: &[],
            },
            primitive: PrimitiveState { topology, ..PrimitiveState::default() },
            depth_stencil: Some(DepthStencilState {
                format: DEPTH_FORMAT,
                depth_write_enabled: Some(writes_depth),
                depth_compare: Some(compare),
                stencil: StencilState::default(),
                bias: DepthBiasState::default(),
            }),
            multisample: MultisampleState { count: self.samples, ..MultisampleState::default() },
            fragment: Some(FragmentState {
                module: shader,
                entry_point: Some(recipe.fragment),
                compilation_options: PipelineCompilationOptions::default(),
                targets: &[Some(ColorTargetState {
                    format: self.format,
                    blend,
                    write_mask: ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    }
}
