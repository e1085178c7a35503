//! Where a dragged thing goes: in the plane of the screen, along the surface normal, along an axis, on the
//! grid. Every path is measured from the place of the press, so nothing jumps when a drag begins.

use crate::input::Modifiers;
use crate::{Camera, Hit, WorkPlane};
use ductile_spec::{GrabTarget, MAX_COORDINATE};
use glam::{DVec3, Vec2, Vec3};

/// Below this sine of the angle of view the ground is seen edge-on, and a click on it could mean anywhere.
const EDGE_ON: f32 = 0.12;

/// An axis of the model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The first.
    X,
    /// The second.
    Y,
    /// The third.
    Z,
}

impl Axis {
    /// The axis that a key locks.
    #[must_use]
    pub fn of_key(key: &str) -> Option<Self> {
        match key {
            "x" => Some(Self::X),
            "y" => Some(Self::Y),
            "z" => Some(Self::Z),
            _ => None,
        }
    }

    fn unit(self) -> Vec3 {
        match self {
            Self::X => Vec3::X,
            Self::Y => Vec3::Y,
            Self::Z => Vec3::Z,
        }
    }
}

/// A drag under way.
#[derive(Clone, Copy, Debug)]
pub struct Drag {
    target: GrabTarget,
    anchor: Vec3,
    origin: DVec3,
    normal: Option<Vec3>,
    press: Vec2,
    lock: Option<Axis>,
}

impl Drag {
    /// Takes hold of what was hit.
    #[must_use]
    pub fn begin(hit: &Hit, press: Vec2) -> Self {
        let (target, anchor, normal) = match *hit {
            Hit::Point { id, at } => (GrabTarget::Point(id), at, None),
            Hit::Curve { id, at } => (GrabTarget::Curve { curve: id, at: at.as_dvec3() }, at, None),
            Hit::Surface { id, at, normal, .. } => {
                (GrabTarget::Surface { surface: id, at: at.as_dvec3() }, at, normal.try_normalize())
            }
            Hit::Edge { surface, ends, at } => {
                (GrabTarget::Edge { surface, ends, at: at.as_dvec3() }, at, None)
            }
            Hit::Face { surface, face, at, normal } => {
                (GrabTarget::Face { surface, face, at: at.as_dvec3() }, at, normal.try_normalize())
            }
        };
        Self { target, anchor, origin: anchor.as_dvec3(), normal, press, lock: None }
    }

    /// Takes hold of a place as it is.
    #[must_use]
    pub fn of_place(target: GrabTarget, anchor: Vec3, press: Vec2) -> Self {
        Self { target, anchor, origin: anchor.as_dvec3(), normal: None, press, lock: None }
    }

    /// What it takes hold of.
    #[must_use]
    pub fn target(&self) -> GrabTarget {
        self.target
    }

    /// Whether it holds an edge or a face of a cage, rather than a point.
    #[must_use]
    pub fn holds_part(&self) -> bool {
        matches!(self.target, GrabTarget::Edge { .. } | GrabTarget::Face { .. })
    }

    /// The surface normal for Shift, where the hit itself has none (on a point of a surface).
    pub fn set_normal(&mut self, normal: Option<Vec3>) {
        self.normal = self.normal.or_else(|| normal.and_then(Vec3::try_normalize));
    }

    /// The modeler says where exactly the held point is. (A handle's end is where it was taken hold of.)
    pub fn set_origin(&mut self, at: DVec3) {
        if at.is_finite() && !matches!(self.target, GrabTarget::Handle(_)) {
            self.origin = at;
        }
    }

    /// Locks an axis, or frees it again.
    pub fn toggle(&mut self, axis: Axis) {
        self.lock = if self.lock == Some(axis) { None } else { Some(axis) };
    }

    /// The axis that is locked.
    #[must_use]
    pub fn lock(&self) -> Option<Axis> {
        self.lock
    }

    /// Where the held point should be, for a cursor; `grid` is the step that Ctrl snaps to.
    #[must_use]
    pub fn place(&self, camera: &Camera, cursor: Vec2, modifiers: Modifiers, grid: f64) -> Option<DVec3> {
        let line = match self.lock {
            Some(axis) => Some(axis.unit()),
            None if modifiers.shift => Some(self.normal.unwrap_or(Vec3::Z)),
            None => None,
        };
        let along = |cursor| match line {
            Some(direction) => camera.drag_along(self.anchor, direction, cursor),
            None => camera.drag_on_view_plane(self.anchor, cursor),
        };
        let mut by = (along(cursor) - along(self.press)).as_dvec3();
        if modifiers.ctrl && grid > 0.0 {
            by = match (line, self.lock) {
                // Along a normal the distance is what is round, else the place.
                (Some(direction), None) => {
                    let direction = direction.as_dvec3();
                    direction * ((by.dot(direction) / grid).round() * grid)
                }
                (Some(direction), Some(_)) => {
                    let mask = direction.as_dvec3();
                    (((self.origin + by) / grid).round() * grid - self.origin) * mask
                }
                (None, _) => ((self.origin + by) / grid).round() * grid - self.origin,
            };
        }
        let place = self.origin + by;
        place.is_finite().then(|| place.clamp(DVec3::splat(-MAX_COORDINATE), DVec3::splat(MAX_COORDINATE)))
    }
}

/// The step of the grid that suits a model of this radius: a power of ten, about a tenth of it.
#[must_use]
pub fn grid_step(radius: f32) -> f64 {
    if !(radius.is_finite() && radius > 0.0) {
        return 0.1;
    }
    let mut step = 0.1;
    let radius = f64::from(radius);
    while step * 50.0 < radius {
        step *= 10.0;
    }
    while step * 5.0 > radius && step > 1e-6 {
        step /= 10.0;
    }
    step
}

/// An arrow key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrow {
    /// To the left on the screen.
    Left,
    /// To the right.
    Right,
    /// Upwards.
    Up,
    /// Downwards.
    Down,
}

/// The model axis, with its sign, that looks most like an arrow key on the screen at a place.
#[must_use]
pub fn nudge_direction(camera: &Camera, at: Vec3, arrow: Arrow, step: f32) -> Option<Vec3> {
    let wanted = match arrow {
        Arrow::Left => Vec2::NEG_X,
        Arrow::Right => Vec2::X,
        Arrow::Up => Vec2::NEG_Y,
        Arrow::Down => Vec2::Y,
    };
    let here = camera.project(at)?;
    let mut best = None;
    for direction in [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z] {
        let Some(there) = camera.project(at + direction * step) else { continue };
        let score = (there - here).dot(wanted);
        if score > 0.0 && best.is_none_or(|(most, _)| score > most) {
            best = Some((score, direction));
        }
    }
    best.map(|(_, direction)| direction)
}

/// Where new points go: the ground, or the upright plane that faces the eye where the ground is seen edge-on.
#[must_use]
pub fn work_plane(forward: Vec3) -> WorkPlane {
    let [x, y, z] = forward.abs().to_array();
    if z > EDGE_ON {
        WorkPlane::default()
    } else if y >= x {
        WorkPlane { origin: Vec3::ZERO, u: Vec3::X, v: Vec3::Z }
    } else {
        WorkPlane { origin: Vec3::ZERO, u: Vec3::Y, v: Vec3::Z }
    }
}
