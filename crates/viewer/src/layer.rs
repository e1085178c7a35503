//! A layer of marks: curves and points with the numbers they stand on.
//!
//! There are two. The *skeleton* stands on the numbers of the frame; only its styles change between frames.
//! The *overlay* (ring, ghosts, triad) is a handful of marks made anew for each picture.

use crate::buffer::GrowingBuffer;
use crate::pipeline::Layouts;
use crate::polyline::append_polyline;
use crate::uniforms::{Dot, Segment, Style};
use glam::Vec3;
use wgpu::{BindGroup, Device, Queue};

/// Marks as the processor makes them.
#[derive(Debug, Default)]
pub(crate) struct Marks {
    pub(crate) floats: Vec<f32>,
    pub(crate) segments: Vec<Segment>,
    pub(crate) curve_styles: Vec<Style>,
    pub(crate) dots: Vec<Dot>,
    pub(crate) dot_styles: Vec<Style>,
    /// Corners of skins, three for a triangle, with styles of curves.
    pub(crate) skins: Vec<Dot>,
}

impl Marks {
    pub(crate) fn clear(&mut self) {
        self.floats.clear();
        self.segments.clear();
        self.curve_styles.clear();
        self.dots.clear();
        self.dot_styles.clear();
        self.skins.clear();
    }

    /// Adds a polyline with numbers of its own.
    pub(crate) fn add_polyline(&mut self, places: impl Iterator<Item = Vec3>, closed: bool, style: Style) {
        let first = length(&self.floats);
        self.floats.extend(places.flat_map(|at| at.to_array()));
        let count = (length(&self.floats) - first) / 3;
        append_polyline(&mut self.segments, first, count, closed, length(&self.curve_styles));
        self.curve_styles.push(style);
    }

    /// Adds triangles with numbers of their own.
    pub(crate) fn add_skin(&mut self, facets: &[[Vec3; 3]], style: Style) {
        for at in facets.as_flattened() {
            self.skins.push(Dot { at: length(&self.floats), style: length(&self.curve_styles) });
            self.floats.extend(at.to_array());
        }
        self.curve_styles.push(style);
    }

    /// Adds a point with numbers of its own.
    pub(crate) fn add_dot(&mut self, at: Vec3, style: Style) {
        self.dots.push(Dot { at: length(&self.floats), style: length(&self.dot_styles) });
        self.floats.extend(at.to_array());
        self.dot_styles.push(style);
    }
}

/// The length of a list that goes to the device.
pub(crate) fn length<T>(list: &[T]) -> u32 {
    u32::try_from(list.len()).unwrap_or(u32::MAX)
}

/// Marks as the device has them, but for the numbers.
#[derive(Debug)]
pub(crate) struct Layer {
    segments: GrowingBuffer,
    curve_styles: GrowingBuffer,
    dots: GrowingBuffer,
    dot_styles: GrowingBuffer,
    skins: GrowingBuffer,
    groups: Option<[BindGroup; 3]>,
    pub(crate) segment_count: u32,
    pub(crate) dot_count: u32,
    pub(crate) skin_count: u32,
}

impl Layer {
    pub(crate) fn new(device: &Device) -> Self {
        Self {
            segments: GrowingBuffer::new(device, "segments"),
            curve_styles: GrowingBuffer::new(device, "curve styles"),
            dots: GrowingBuffer::new(device, "dots"),
            dot_styles: GrowingBuffer::new(device, "dot styles"),
            skins: GrowingBuffer::new(device, "skins"),
            groups: None,
            segment_count: 0,
            dot_count: 0,
            skin_count: 0,
        }
    }

    /// Forgets the bindings after the numbers have moved to another buffer.
    pub(crate) fn unbind(&mut self) {
        self.groups = None;
    }

    pub(crate) fn write_segments(&mut self, device: &Device, queue: &Queue, segments: &[Segment]) {
        self.segment_count = length(segments);
        if self.segments.write(device, queue, segments) {
            self.groups = None;
        }
    }

    /// Writes what a picture may change.
    pub(crate) fn write_styles(&mut self, device: &Device, queue: &Queue, marks: &Marks) {
        self.dot_count = length(&marks.dots);
        self.skin_count = length(&marks.skins);
        let moved = [
            self.curve_styles.write(device, queue, &marks.curve_styles),
            self.dots.write(device, queue, &marks.dots),
            self.dot_styles.write(device, queue, &marks.dot_styles),
            self.skins.write(device, queue, &marks.skins),
        ];
        if moved.contains(&true) {
            self.groups = None;
        }
    }

    pub(crate) fn bind(&mut self, device: &Device, layouts: &Layouts, floats: &GrowingBuffer) {
        if self.groups.is_none() {
            self.groups = Some([
                layouts.pull(device, "curves", [floats, &self.segments, &self.curve_styles]),
                layouts.pull(device, "points", [floats, &self.dots, &self.dot_styles]),
                layouts.pull(device, "skins", [floats, &self.skins, &self.curve_styles]),
            ]);
        }
    }

    /// The bindings of curves, points and skins, once made.
    pub(crate) fn groups(&self) -> Option<&[BindGroup; 3]> {
        self.groups.as_ref()
    }
}
