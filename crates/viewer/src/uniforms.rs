//! What every pass knows: the mirror of `shaders/frame.wgsl`, filled from camera, look and theme.

use crate::camera::{Camera, tangent};
use crate::look::{Look, Shading, Slices, WorkPlane};
use crate::theme::Theme;
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Distance of the fine lines of the grid on the canvas, in CSS pixels, at which they begin to show.
const GRID_PIXELS: f32 = 7.0;

/// `Frame` of `frame.wgsl`; the members are explained there.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Frame {
    pub(crate) clip_from_world: Mat4,
    pub(crate) eye: Vec4,
    pub(crate) forward: Vec4,
    pub(crate) key: Vec4,
    pub(crate) fill: Vec4,
    pub(crate) sky: Vec4,
    pub(crate) ground: Vec4,
    pub(crate) front: Vec4,
    pub(crate) back: Vec4,
    pub(crate) wire: Vec4,
    pub(crate) top: Vec4,
    pub(crate) bottom: Vec4,
    pub(crate) grid: Vec4,
    pub(crate) axis_u: Vec4,
    pub(crate) axis_v: Vec4,
    pub(crate) plane_origin: Vec4,
    pub(crate) plane_u: Vec4,
    pub(crate) plane_v: Vec4,
    pub(crate) plane_centre: Vec4,
    pub(crate) viewport: Vec4,
    pub(crate) options: Vec4,
    pub(crate) look: Vec4,
    pub(crate) slices: Vec4,
}

/// `Style` of `frame.wgsl`: how a mark is drawn.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Style {
    pub(crate) fill: Vec4,
    pub(crate) outline: Vec4,
    pub(crate) half_width: f32,
    pub(crate) outline_width: f32,
    pub(crate) hidden: f32,
    pub(crate) flags: u32,
}

/// `SurfaceStyle` of `surface.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct SurfaceStyle {
    pub(crate) tint: Vec4,
    pub(crate) sides: Vec4,
}

/// `Segment` of `curve.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Segment {
    pub(crate) before: u32,
    pub(crate) start: u32,
    pub(crate) stop: u32,
    pub(crate) after: u32,
    pub(crate) style: u32,
}

/// `Dot` of `point.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub(crate) struct Dot {
    pub(crate) at: u32,
    pub(crate) style: u32,
}

/// The places of a mark are device pixels.
pub(crate) const ON_SCREEN: u32 = 1;

impl Frame {
    /// Fills the frame; the canvas in device pixels.
    pub(crate) fn new(camera: &Camera, look: &Look, theme: &Theme, plane: &WorkPlane, canvas: Vec2) -> Self {
        let unit = 2.0 * tangent() / canvas.y;
        let (perspective, unit) =
            if camera.is_orthographic() { (0.0, unit * camera.pose().distance) } else { (1.0, unit) };
        let (key, fill) = lights(camera);
        let wireframe = if look.wireframe { 1.0 } else { 0.0 };
        let mut frame = Self {
            clip_from_world: camera.clip_from_world(),
            eye: camera.eye().extend(perspective),
            forward: camera.forward().extend(unit),
            key: key.extend(theme.key),
            fill: fill.extend(theme.fill),
            sky: theme.sky,
            ground: theme.ground,
            front: theme.front,
            back: theme.back,
            wire: theme.wire,
            top: theme.top,
            bottom: theme.bottom,
            grid: theme.grid,
            axis_u: faint(theme.axes[main_axis(plane.u)]),
            axis_v: faint(theme.axes[main_axis(plane.v)]),
            viewport: Vec4::new(canvas.x, canvas.y, 1.0 / canvas.x, 1.0 / canvas.y),
            options: Vec4::new(look.device_pixel_ratio, camera.near(), wireframe, 0.0),
            look: question(look),
            slices: slices(look, camera),
            ..Self::default()
        };
        frame.lay_grid(camera, plane);
        frame
    }

    /// Chooses the distance of the grid lines: a power of ten that is clear on the canvas.
    fn lay_grid(&mut self, camera: &Camera, plane: &WorkPlane) {
        let centre = camera.pose().centre - plane.origin;
        let height = camera.unit_per_pixel(camera.pose().centre) * GRID_PIXELS;
        let level = height.log10();
        let (decade, share) = (level.ceil(), level.ceil() - level);
        self.plane_origin = plane.origin.extend(10.0_f32.powf(decade));
        self.plane_u = plane.u.extend(share);
        self.plane_v = plane.v.extend(camera.pose().distance * 6.0);
        self.plane_centre = Vec4::new(centre.dot(plane.u), centre.dot(plane.v), 0.0, 0.0);
    }
}

/// What is asked of surfaces, with its numbers.
fn question(look: &Look) -> Vec4 {
    match look.shading {
        Shading::Shaded => Vec4::ZERO,
        Shading::Isophotes => Vec4::new(1.0, look.bands, 0.0, 0.0),
        Shading::Contours => Vec4::new(2.0, 0.0, 0.0, 0.0),
        Shading::Mean => {
            let [low, high] = look.range;
            // A range without width still has two sides.
            let width = (high - low).max(1e-6 * (low.abs() + high.abs())).max(f32::MIN_POSITIVE);
            Vec4::new(3.0, low, 1.0 / width, 0.0)
        }
    }
}

/// The slices whose borders are the contours.
fn slices(look: &Look, camera: &Camera) -> Vec4 {
    let across = match look.slices {
        Slices::X => Vec3::X,
        Slices::Y => Vec3::Y,
        Slices::Z => Vec3::Z,
        Slices::View => camera.forward(),
    };
    across.extend(1.0 / look.distance.max(f32::MIN_POSITIVE))
}

/// Directions toward the key light and the fill light. Half of the key light stays where it is in the
/// world and half of it comes along with the eye, so that a shape turned in the hand shows its form.
fn lights(camera: &Camera) -> (Vec3, Vec3) {
    let of_camera = |x: f32, y: f32, z: f32| camera.right() * x + camera.up() * y - camera.forward() * z;
    let key = of_camera(-0.48, 0.62, 0.62) + Vec3::new(-0.25, -0.3, 0.92) * 0.8;
    let fill = of_camera(0.85, -0.1, 0.5);
    (key.normalize_or(Vec3::Z), fill.normalize_or(Vec3::Z))
}

/// The axis that a direction follows most.
fn main_axis(direction: Vec3) -> usize {
    direction.abs().max_position()
}

fn faint(colour: Vec4) -> Vec4 {
    colour.truncate().extend(0.55)
}
