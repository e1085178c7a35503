//! The eye: an orbiting camera over a ground plane, z up.
//!
//! A [`Pose`] looks at a centre from an azimuth and an elevation; the camera adds the projection and the
//! size of the canvas. All places on the canvas are CSS pixels from its upper left corner. Depth in clip
//! space is reversed (1 near, 0 far), which with a float depth buffer keeps its precision at every scale,
//! so that there is no far plane to choose. The camera has no clock: a [flight](Camera::fly_to) is moved by
//! the time that the caller gives.

use glam::camera::rh::proj::directx;
use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Vertical angle of view: long enough a lens that shapes keep their proportions.
const FIELD_OF_VIEW: f32 = 0.6;
/// Radians of orbit per CSS pixel: a hand's width of 450 px turns the model by half a turn.
const RADIANS_PER_PIXEL: f32 = PI / 450.0;
/// How long a flight takes, in milliseconds; the page allows 200.
const FLIGHT_MILLISECONDS: f64 = 180.0;
/// The near plane, relative to the distance of the centre.
const NEAR: f32 = 0.01;
/// Depth range of the orthographic projection on either side of the centre, relative to the distance.
const DEPTH_RANGE: f32 = 50.0;
/// Distances that keep the numbers of f32 meaningful; a document reaches to 1e6.
const DISTANCES: (f32, f32) = (1e-5, 1e9);

/// A standard view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum View {
    /// From −y.
    Front,
    /// From +y.
    Back,
    /// From +x.
    Right,
    /// From −x.
    Left,
    /// From +z.
    Top,
    /// From −z.
    Bottom,
}

impl View {
    /// All six.
    pub const ALL: [Self; 6] = [Self::Front, Self::Back, Self::Right, Self::Left, Self::Top, Self::Bottom];

    /// Unit vector from the centre to the eye.
    #[must_use]
    pub fn toward_eye(self) -> Vec3 {
        match self {
            Self::Front => Vec3::NEG_Y,
            Self::Back => Vec3::Y,
            Self::Right => Vec3::X,
            Self::Left => Vec3::NEG_X,
            Self::Top => Vec3::Z,
            Self::Bottom => Vec3::NEG_Z,
        }
    }

    /// The same axis from the other side.
    #[must_use]
    pub fn opposite(self) -> Self {
        match self {
            Self::Front => Self::Back,
            Self::Back => Self::Front,
            Self::Right => Self::Left,
            Self::Left => Self::Right,
            Self::Top => Self::Bottom,
            Self::Bottom => Self::Top,
        }
    }

    /// Azimuth and elevation.
    fn angles(self) -> (f32, f32) {
        match self {
            Self::Front => (0.0, 0.0),
            Self::Right => (FRAC_PI_2, 0.0),
            Self::Back => (PI, 0.0),
            Self::Left => (-FRAC_PI_2, 0.0),
            Self::Top => (0.0, FRAC_PI_2),
            Self::Bottom => (0.0, -FRAC_PI_2),
        }
    }
}

/// Where the eye is and where it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// What it looks at.
    pub centre: Vec3,
    /// Turn about z; 0 looks along +y (the front view).
    pub azimuth: f32,
    /// Height above the ground plane, between −π/2 and π/2.
    pub elevation: f32,
    /// From the centre to the eye; also the scale of the orthographic projection.
    pub distance: f32,
}

impl Default for Pose {
    fn default() -> Self {
        Self { centre: Vec3::ZERO, azimuth: 0.52, elevation: 0.45, distance: 4.0 }
    }
}

impl Pose {
    /// Columns: right, up, forward; orthonormal.
    fn basis(&self) -> Mat3 {
        let (sa, ca) = self.azimuth.sin_cos();
        let (se, ce) = self.elevation.sin_cos();
        let forward = Vec3::new(-sa * ce, ca * ce, -se);
        let right = Vec3::new(ca, sa, 0.0);
        Mat3::from_cols(right, right.cross(forward), forward)
    }

    /// The pose a part of the way to another, the short way round.
    fn toward(&self, to: &Self, part: f32) -> Self {
        let turn = (to.azimuth - self.azimuth + PI).rem_euclid(TAU) - PI;
        Self {
            centre: self.centre.lerp(to.centre, part),
            azimuth: self.azimuth + turn * part,
            elevation: self.elevation + (to.elevation - self.elevation) * part,
            distance: self.distance * (to.distance / self.distance).powf(part),
        }
    }
}

/// A half-line from the eye into the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Unit vector.
    pub direction: Vec3,
}

impl Ray {
    /// The place a distance along.
    #[must_use]
    pub fn at(&self, distance: f32) -> Vec3 {
        self.origin + self.direction * distance
    }

    /// Where it meets a plane in front of its start; `None` if it runs along it or away from it.
    #[must_use]
    pub fn meets_plane(&self, origin: Vec3, normal: Vec3) -> Option<Vec3> {
        let slope = self.direction.dot(normal);
        let distance = (origin - self.origin).dot(normal) / slope;
        (slope.abs() > 1e-5 && distance.is_finite() && distance > 0.0).then(|| self.at(distance))
    }
}

/// A flight from one pose to another.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Flight {
    from: Pose,
    to: Pose,
    start: f64,
}

/// The eye.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    pose: Pose,
    orthographic: bool,
    viewport: Vec2,
    /// Upper left and lower right corner of the part of the canvas that no panel covers; `None`: all of it.
    free: Option<(Vec2, Vec2)>,
    stored: Option<(Pose, bool)>,
    flight: Option<Flight>,
    /// A ball around the scene: the orthographic depth range holds it.
    extent: (Vec3, f32),
}

impl Default for Camera {
    fn default() -> Self {
        Self {
            pose: Pose::default(),
            orthographic: false,
            viewport: Vec2::new(1280.0, 720.0),
            free: None,
            stored: None,
            flight: None,
            extent: (Vec3::ZERO, 1.0),
        }
    }
}

impl Camera {
    /// Sets the size of the canvas in CSS pixels; all of it is free until [`Self::set_free`] says otherwise.
    pub fn set_viewport(&mut self, width: f32, height: f32) {
        self.viewport = Vec2::new(width.max(1.0), height.max(1.0));
        self.free = None;
    }

    /// Size of the canvas in CSS pixels.
    #[must_use]
    pub fn viewport(&self) -> Vec2 {
        self.viewport
    }

    /// Says which part of the canvas panels leave free, by its upper left and lower right corner in CSS
    /// pixels: the centre of the pose is shown in its middle, and what is fitted fits into it. `None`, or a
    /// part less than a third as wide or high as the canvas: the whole canvas.
    pub fn set_free(&mut self, free: Option<(Vec2, Vec2)>) {
        let is_enough = |(lower, upper): &(Vec2, Vec2)| (*upper - *lower).cmpge(self.viewport / 3.0).all();
        self.free = free.filter(is_enough);
    }

    /// The place of the canvas where the centre of the pose is shown, in CSS pixels.
    #[must_use]
    pub fn middle(&self) -> Vec2 {
        self.free.map_or(self.viewport * 0.5, |(lower, upper)| 0.5 * (lower + upper))
    }

    /// Where the eye is and where it looks.
    #[must_use]
    pub fn pose(&self) -> Pose {
        self.pose
    }

    /// Goes to a pose at once; for reduced motion. Ends a flight.
    pub fn set_pose(&mut self, pose: Pose) {
        self.flight = None;
        self.pose = Pose {
            elevation: pose.elevation.clamp(-FRAC_PI_2, FRAC_PI_2),
            distance: pose.distance.clamp(DISTANCES.0, DISTANCES.1),
            ..pose
        };
    }

    /// Tells the camera how far the scene reaches, so that the orthographic view cuts nothing off.
    pub fn set_extent(&mut self, centre: Vec3, radius: f32) {
        self.extent = (centre, radius);
    }

    /// Whether the projection is orthographic.
    #[must_use]
    pub fn is_orthographic(&self) -> bool {
        self.orthographic
    }

    /// Changes between perspective and orthographic; the centre keeps its size.
    pub fn toggle_projection(&mut self) {
        self.orthographic = !self.orthographic;
    }

    /// Shows a ball as large as the free part of the canvas allows, from where the eye is now.
    pub fn fit(&mut self, centre: Vec3, radius: f32) {
        self.set_extent(centre, radius);
        self.set_pose(self.pose_that_fits(centre, radius));
    }

    /// The pose that [`Self::fit`] goes to, for a flight.
    #[must_use]
    pub fn pose_that_fits(&self, centre: Vec3, radius: f32) -> Pose {
        let radius = if radius > 0.0 { radius } else { 1.0 };
        let free = self.free.map_or(self.viewport, |(lower, upper)| upper - lower);
        let half_angle = (tangent() * free.min_element() / self.viewport.y).atan();
        let distance = (1.05 * radius / half_angle.sin()).clamp(DISTANCES.0, DISTANCES.1);
        Pose { centre, distance, ..self.pose }
    }

    /// Puts a place in the middle, with the same scale.
    pub fn focus(&mut self, point: Vec3) {
        self.set_pose(self.pose_that_focuses(point));
    }

    /// The pose that [`Self::focus`] goes to, for a flight.
    #[must_use]
    pub fn pose_that_focuses(&self, point: Vec3) -> Pose {
        Pose { centre: point, ..self.pose }
    }

    /// Looks from a standard side at the same centre.
    pub fn look_from(&mut self, view: View) {
        self.set_pose(self.pose_from(view));
    }

    /// The pose that [`Self::look_from`] goes to, for a flight.
    #[must_use]
    pub fn pose_from(&self, view: View) -> Pose {
        let (azimuth, elevation) = view.angles();
        Pose { azimuth, elevation, ..self.pose }
    }

    /// Remembers the present view.
    pub fn store(&mut self) {
        self.stored = Some((self.pose, self.orthographic));
    }

    /// Takes the projection of the remembered view and tells its pose; `None` if nothing was stored.
    pub fn recall(&mut self) -> Option<Pose> {
        let (pose, orthographic) = self.stored?;
        self.orthographic = orthographic;
        Some(pose)
    }

    /// Begins a flight to a pose; `now` in milliseconds, as for [`Self::advance`].
    pub fn fly_to(&mut self, pose: Pose, now: f64) {
        self.flight = Some(Flight { from: self.pose, to: pose, start: now });
    }

    /// Moves a flight on; says whether it goes on after this.
    pub fn advance(&mut self, now: f64) -> bool {
        let Some(flight) = self.flight else { return false };
        let part = ((now - flight.start) / FLIGHT_MILLISECONDS).clamp(0.0, 1.0);
        #[expect(clippy::cast_possible_truncation, reason = "between 0 and 1")]
        let part = part as f32;
        if part >= 1.0 {
            self.set_pose(flight.to);
            return false;
        }
        self.pose = flight.from.toward(&flight.to, part * part * (3.0 - 2.0 * part));
        true
    }

    /// Whether a flight is under way.
    #[must_use]
    pub fn is_flying(&self) -> bool {
        self.flight.is_some()
    }

    /// Turns about a pivot, which keeps its place on the canvas; the motion in CSS pixels. The model follows
    /// the hand.
    pub fn orbit(&mut self, pivot: Vec3, motion: Vec2) {
        let before = self.pose.basis();
        let azimuth = (self.pose.azimuth - motion.x * RADIANS_PER_PIXEL + PI).rem_euclid(TAU) - PI;
        let elevation = self.pose.elevation + motion.y * RADIANS_PER_PIXEL;
        self.set_pose(Pose { azimuth, elevation, ..self.pose });
        self.pose.centre = pivot + self.pose.basis() * (before.transpose() * (self.pose.centre - pivot));
    }

    /// Moves sideways so that a place under the pointer follows it; the motion in CSS pixels.
    pub fn pan(&mut self, under_pointer: Vec3, motion: Vec2) {
        self.flight = None;
        let basis = self.pose.basis();
        let shift = basis.x_axis * -motion.x + basis.y_axis * motion.y;
        self.pose.centre += shift * self.unit_per_pixel(under_pointer);
    }

    /// Comes nearer by a factor (smaller than 1: goes away), keeping what lies under the pointer at the
    /// depth of the centre.
    pub fn zoom_to(&mut self, cursor: Vec2, factor: f32) {
        self.zoom_about(self.drag_on_view_plane(self.pose.centre, cursor), factor);
    }

    /// Comes nearer by a factor, keeping a place where it is on the canvas.
    pub fn zoom_about(&mut self, anchor: Vec3, factor: f32) {
        self.flight = None;
        let distance = (self.pose.distance / factor).clamp(DISTANCES.0, DISTANCES.1);
        let shrink = distance / self.pose.distance;
        if shrink.is_finite() {
            self.pose.distance = distance;
            self.pose.centre = anchor + (self.pose.centre - anchor) * shrink;
        }
    }

    /// Where the eye is. In the orthographic projection, where it would be in perspective.
    #[must_use]
    pub fn eye(&self) -> Vec3 {
        self.pose.centre - self.forward() * self.pose.distance
    }

    /// Unit vector to the right of the canvas.
    #[must_use]
    pub fn right(&self) -> Vec3 {
        self.pose.basis().x_axis
    }

    /// Unit vector to the top of the canvas.
    #[must_use]
    pub fn up(&self) -> Vec3 {
        self.pose.basis().y_axis
    }

    /// Unit vector into the canvas.
    #[must_use]
    pub fn forward(&self) -> Vec3 {
        self.pose.basis().z_axis
    }

    /// The transform to clip space, depth reversed.
    #[must_use]
    pub fn clip_from_world(&self) -> Mat4 {
        let aspect = self.viewport.x / self.viewport.y;
        let clip_from_view = if self.orthographic {
            let y = self.pose.distance * tangent();
            let range = self.depth_range();
            // Seen from the eye; far and near change places for the reversed depth.
            let (near, far) = (self.pose.distance - range, self.pose.distance + range);
            directx::orthographic(-y * aspect, y * aspect, -y, y, far, near)
        } else {
            directx::perspective_infinite_reverse(FIELD_OF_VIEW, aspect, self.near())
        };
        // A lens that is shifted, not an eye that is turned: an orbit goes round what is in the middle.
        let shift = 2.0 * (self.middle() - self.viewport * 0.5) / self.viewport;
        Mat4::from_translation(Vec3::new(shift.x, -shift.y, 0.0)) * clip_from_view * self.view_from_world()
    }

    /// Distance of the near plane in perspective.
    #[must_use]
    pub fn near(&self) -> f32 {
        self.pose.distance * NEAR
    }

    /// How far the orthographic projection sees before and behind the centre.
    fn depth_range(&self) -> f32 {
        let (centre, radius) = self.extent;
        let reach = centre.distance(self.pose.centre) + radius;
        (self.pose.distance * DEPTH_RANGE).max(2.0 * reach)
    }

    fn view_from_world(&self) -> Mat4 {
        let basis = self.pose.basis();
        // The view looks along its −z.
        let rotation = Mat3::from_cols(basis.x_axis, basis.y_axis, -basis.z_axis).transpose();
        let shift = rotation * -self.eye();
        Mat4::from_cols(
            rotation.x_axis.extend(0.0),
            rotation.y_axis.extend(0.0),
            rotation.z_axis.extend(0.0),
            Vec4::new(shift.x, shift.y, shift.z, 1.0),
        )
    }

    /// Depth of a place along the direction of view, from the eye.
    #[must_use]
    pub fn depth(&self, world: Vec3) -> f32 {
        self.forward().dot(world - self.eye())
    }

    /// Model units that a CSS pixel measures at the depth of a place.
    #[must_use]
    pub fn unit_per_pixel(&self, at: Vec3) -> f32 {
        let depth =
            if self.orthographic { self.pose.distance } else { self.depth(at).abs().max(self.near()) };
        2.0 * tangent() * depth / self.viewport.y
    }

    /// Where a place is on the canvas, perhaps outside of it; `None` if it lies behind the eye.
    #[must_use]
    pub fn project(&self, world: Vec3) -> Option<Vec2> {
        let offset = self.pose.basis().transpose() * (world - self.eye());
        if !self.orthographic && offset.z < self.near() {
            return None;
        }
        let unit = self.unit_per_pixel(world);
        Some(self.middle() + Vec2::new(offset.x, -offset.y) / unit)
    }

    /// The half-line of all places under the pointer.
    #[must_use]
    pub fn ray(&self, cursor: Vec2) -> Ray {
        let aside = self.aside(cursor);
        if self.orthographic {
            let behind = self.forward() * (self.pose.distance - self.depth_range());
            return Ray {
                origin: self.eye() + aside * self.pose.distance + behind,
                direction: self.forward(),
            };
        }
        Ray { origin: self.eye(), direction: (self.forward() + aside).normalize() }
    }

    /// What the pointer adds to the direction of view, at depth 1.
    fn aside(&self, cursor: Vec2) -> Vec3 {
        let basis = self.pose.basis();
        let offset = (cursor - self.middle()) * (2.0 * tangent() / self.viewport.y);
        basis.x_axis * offset.x - basis.y_axis * offset.y
    }

    /// The place under the pointer at the depth of an anchor: a drag in the plane of the screen.
    #[must_use]
    pub fn drag_on_view_plane(&self, anchor: Vec3, cursor: Vec2) -> Vec3 {
        let depth = self.depth(anchor);
        let scale = if self.orthographic { self.pose.distance } else { depth };
        self.eye() + self.forward() * depth + self.aside(cursor) * scale
    }

    /// The place on a line that comes nearest to the pointer: a drag along an axis. The anchor itself where
    /// the line points at the eye, and no drag could be told from another.
    #[must_use]
    pub fn drag_along(&self, anchor: Vec3, axis: Vec3, cursor: Vec2) -> Vec3 {
        let Some(axis) = axis.try_normalize() else { return anchor };
        let ray = self.ray(cursor);
        // The nearest places of two lines, anchor + s axis and origin + t direction.
        let slope = axis.dot(ray.direction);
        let steepness = 1.0 - slope * slope;
        if steepness < 1e-3 {
            return anchor;
        }
        // From the place of the ray that is nearest to the anchor, which keeps the numbers small.
        let nearest = ray.at(ray.direction.dot(anchor - ray.origin));
        anchor + axis * ((nearest - anchor).dot(axis) / steepness)
    }
}

/// Tangent of half the vertical angle of view.
pub(crate) fn tangent() -> f32 {
    (0.5 * FIELD_OF_VIEW).tan()
}

#[cfg(test)]
mod tests;
