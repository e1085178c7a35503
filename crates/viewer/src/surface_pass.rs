//! Draws the surfaces, region by region.

use crate::buffer::GrowingBuffer;
use crate::curvature::Rings;
use crate::layer::length;
use crate::look::{Highlight, Tinted};
use crate::pipeline::{Layouts, Meets, Pulls, Recipe, Workshop};
use crate::scene::Scene;
use crate::theme::Theme;
use crate::uniforms::SurfaceStyle;
use ductile_spec::{NO_REGION, SurfaceId};
use std::ops::Range;
use std::rc::Rc;
use wgpu::{BindGroup, Device, Queue, RenderPass, RenderPipeline};

/// The surfaces.
pub(crate) const SURFACE_SHADER: &str = concat!(
    include_str!("../../../shaders/frame.wgsl"),
    include_str!("../../../shaders/surface.wgsl"),
    include_str!("../../../shaders/interrogate.wgsl")
);

/// Strength of the tint of a surface that a tool is about to touch.
const TINT: f32 = 0.30;
/// The same where it would follow a hand entirely.
const INFLUENCE: f32 = 0.55;

/// A region of a surface, or a surface in one piece.
#[derive(Clone, Copy, Debug)]
struct Part {
    surface: SurfaceId,
    region: Option<u16>,
    is_orientable: bool,
    first_index: u32,
    index_count: u32,
}

#[derive(Debug)]
pub(crate) struct SurfacePass {
    pipeline: RenderPipeline,
    indices: GrowingBuffer,
    styles: GrowingBuffer,
    rings: GrowingBuffer,
    influence: GrowingBuffer,
    group: Option<BindGroup>,
    parts: Vec<Part>,
    /// Triangles in the order of the parts; kept for its memory.
    sorted: Vec<u32>,
    styles_of_now: Vec<SurfaceStyle>,
    /// The vertices of each surface.
    spans: Vec<(SurfaceId, Range<usize>)>,
    /// What the buffer of influences was made of.
    influence_of_now: Option<(SurfaceId, Rc<[u8]>)>,
}

impl SurfacePass {
    pub(crate) fn new(workshop: &Workshop<'_>) -> Self {
        let recipe = Recipe {
            label: "surface",
            vertex: "surface_vertex",
            fragment: "surface_fragment",
            meets: Meets::Solid,
            is_quad: false,
            pulls: Pulls::FiveBuffers,
        };
        Self {
            pipeline: workshop.pipeline(&workshop.shader("surface", SURFACE_SHADER), &recipe),
            indices: GrowingBuffer::new(workshop.device, "triangles"),
            styles: GrowingBuffer::new(workshop.device, "surface styles"),
            rings: GrowingBuffer::new(workshop.device, "rings"),
            influence: GrowingBuffer::new(workshop.device, "influence"),
            group: None,
            parts: Vec::new(),
            sorted: Vec::new(),
            styles_of_now: Vec::new(),
            spans: Vec::new(),
            influence_of_now: None,
        }
    }

    pub(crate) fn upload_structure(&mut self, device: &Device, queue: &Queue, scene: &Scene) {
        divide(scene, &mut self.parts, &mut self.sorted);
        let vertices = |first: u32, count: u32| first as usize..(first + count) as usize;
        let spans = scene.structure.surfaces.iter();
        self.spans = spans.map(|span| (span.id, vertices(span.first_vertex, span.vertex_count))).collect();
        self.influence_of_now = None;
        let rings = Rings::new(scene.structure.vertex_count(), &self.sorted);
        let moved = [
            self.indices.write(device, queue, &self.sorted),
            self.rings.write(device, queue, rings.as_slice()),
        ];
        if moved.contains(&true) {
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
        let followed =
            highlight.influence.as_ref().filter(|(id, _)| self.spans.iter().any(|(own, _)| own == id));
        if let Some(followed) = followed {
            self.write_influence(device, queue, followed);
        }
        self.styles_of_now.clear();
        self.styles_of_now.extend(self.parts.iter().map(|part| {
            let is_tinted = |tinted: &Tinted| match *tinted {
                Tinted::Surface(id) => id == part.surface,
                Tinted::Region(id, region) => id == part.surface && Some(region) == part.region,
            };
            // A tint all over would hide where it is soft.
            let is_followed = followed.is_some_and(|(id, _)| *id == part.surface);
            let tint = if !is_followed && highlight.tinted.iter().any(is_tinted) { TINT } else { 0.0 };
            let mut sides = if part.is_orientable { glam::Vec4::X } else { glam::Vec4::ZERO };
            if is_followed {
                sides.y = INFLUENCE;
            }
            SurfaceStyle { tint: theme.accent.truncate().extend(tint), sides }
        }));
        if self.styles.write(device, queue, &self.styles_of_now) {
            self.group = None;
        }
        if self.group.is_none() {
            let parts = [floats, &self.indices, &self.styles, &self.rings, &self.influence];
            self.group = Some(layouts.pull(device, "surfaces", parts));
        }
    }

    fn write_influence(&mut self, device: &Device, queue: &Queue, followed: &(SurfaceId, Rc<[u8]>)) {
        let is_known = |(id, of): &(SurfaceId, Rc<[u8]>)| *id == followed.0 && Rc::ptr_eq(of, &followed.1);
        if self.influence_of_now.as_ref().is_some_and(is_known) {
            return;
        }
        self.influence_of_now = Some(followed.clone());
        let Some((_, span)) = self.spans.iter().find(|(id, _)| *id == followed.0) else { return };
        if self.influence.write(device, queue, &spread(span, &self.sorted, &followed.1)) {
            self.group = None;
        }
    }

    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>) {
        let Some(group) = &self.group else { return };
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(1, group, &[]);
        for (part, number) in self.parts.iter().zip(0_u32..) {
            // The instance tells the shader which part it is.
            pass.draw(part.first_index..part.first_index + part.index_count, number..number + 1);
        }
    }
}

/// Influences of all vertices up to the end of a surface's own. Those that nothing is said of lie inside triangles of the others, and
/// have what their neighbours have on average.
fn spread(span: &Range<usize>, triangles: &[u32], influence: &[u8]) -> Vec<f32> {
    let mut all = vec![0.0; span.end];
    for (own, said) in all[span.clone()].iter_mut().zip(influence) {
        *own = f32::from(*said) / 255.0;
    }
    let unsaid = (span.start + influence.len()).min(span.end);
    let mut around = vec![(0.0_f32, 0.0_f32); span.end - unsaid];
    for t in
        triangles.chunks_exact(3).filter(|t| t.iter().any(|v| (unsaid..span.end).contains(&(*v as usize))))
    {
        let said: Vec<f32> = t.iter().map(|v| *v as usize).filter(|v| *v < unsaid).map(|v| all[v]).collect();
        for v in t.iter().map(|v| *v as usize).filter(|v| (unsaid..span.end).contains(v)) {
            for value in &said {
                around[v - unsaid].0 += value;
                around[v - unsaid].1 += 1.0;
            }
        }
    }
    for (own, (sum, count)) in all[unsaid..].iter_mut().zip(around) {
        *own = sum / count.max(1.0);
    }
    all
}

/// Puts the triangles of every region one after the other, so that each is drawn with a style of its own.
fn divide(scene: &Scene, parts: &mut Vec<Part>, sorted: &mut Vec<u32>) {
    parts.clear();
    sorted.clear();
    for span in &scene.structure.surfaces {
        let first = span.first_index as usize;
        let own = &scene.indices[first..first + span.index_count as usize];
        let labels = scene.structure.region_of_triangle.get(first / 3..(first + own.len()) / 3);
        let mut order: Vec<(u16, &[u32])> = own
            .chunks_exact(3)
            .enumerate()
            .map(|(number, t)| (labels.map_or(NO_REGION, |labels| labels[number]), t))
            .collect();
        order.sort_by_key(|(region, _)| *region);
        for same in order.chunk_by(|a, b| a.0 == b.0) {
            parts.push(Part {
                surface: span.id,
                region: Some(same[0].0).filter(|region| *region != NO_REGION),
                is_orientable: span.summary.orientable,
                first_index: length(sorted),
                index_count: length(same) * 3,
            });
            sorted.extend(same.iter().flat_map(|(_, t)| t.iter()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use ductile_spec::{RegionEntry, SurfaceId};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn feet_that_are_vertices_of_their_own_have_the_influence_of_their_neighbours() {
        // A triangle with a foot in it, after one vertex of another surface.
        let triangles = [1, 2, 4, 2, 3, 4, 3, 1, 4];
        let close =
            |all: Vec<f32>, wanted: [f32; 5]| all.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6);
        assert!(close(spread(&(1..5), &triangles, &[255, 51, 0]), [0.0, 1.0, 0.2, 0.0, 0.4]));
        assert!(close(spread(&(1..5), &triangles, &[255, 51, 0, 102, 9]), [0.0, 1.0, 0.2, 0.0, 0.4]));
    }

    #[test]
    fn every_triangle_is_drawn_once_with_the_others_of_its_region() {
        let mut scene = sample::bumpy_disc(6);
        let count = scene.indices.len() / 3;
        let (mut parts, mut sorted) = (Vec::new(), Vec::new());
        divide(&scene, &mut parts, &mut sorted);
        assert_eq!((parts.len(), parts[0].region), (1, None));
        assert_eq!(sorted, scene.indices, "in one piece it is as it came");
        let region = RegionEntry { surface: SurfaceId(1), objective: None, spacing: None, shadow: None };
        scene.structure.regions = vec![region; 2];
        scene.structure.region_of_triangle = (0..count).map(|number| u16::from(number % 3 == 0)).collect();
        divide(&scene, &mut parts, &mut sorted);
        assert_eq!(parts.iter().map(|part| part.region).collect::<Vec<_>>(), [Some(0), Some(1)]);
        assert_eq!(parts[1].first_index, parts[0].index_count);
        assert_eq!(sorted.len(), scene.indices.len());
        let second = parts[1].first_index as usize;
        assert_eq!(sorted[second..second + 3], scene.indices[..3]);
        assert_eq!(sorted[second + 3..second + 6], scene.indices[9..12]);
    }
}
