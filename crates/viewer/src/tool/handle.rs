//! Handles: arrows that stand on a control point and show a direction that a control has there. A drag of the end
//! turns the direction; a whole drag is one act, as with everything that is held.
//!
//! What a handle turns is named by [`ductile_spec::Handle`]; everything else here is the same for every kind.

use super::Drag;
use crate::Camera;
use ductile_spec::{Document, GrabTarget, Handle, PointId};
use glam::{Vec2, Vec3};

/// A handle in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arm {
    /// What it turns.
    pub handle: Handle,
    /// Where it stands.
    pub foot: Vec3,
    /// Where it is taken hold of.
    pub end: Vec3,
}

impl Arm {
    /// Length of a handle in the picture, in CSS pixels: clear of the point that it stands on, and of a fingertip there.
    pub const LENGTH: f32 = 64.0;

    /// A handle of the usual length.
    #[must_use]
    pub fn new(handle: Handle, foot: Vec3, direction: Vec3, camera: &Camera) -> Self {
        let unit = direction.try_normalize().unwrap_or(Vec3::X);
        Self { handle, foot, end: foot + unit * (Self::LENGTH * camera.unit_per_pixel(foot)) }
    }

    /// How far the end is from a cursor, in CSS pixels, if it is within reach. A handle is shown before everything else, so
    /// nothing hides it; but one that points at the eye leaves its point to the hand.
    #[must_use]
    pub fn distance(&self, camera: &Camera, cursor: Vec2, reach_px: f32) -> Option<f32> {
        let [foot, end] = [self.foot, self.end].map(|at| camera.project(at));
        let distance = end?.distance(cursor);
        let is_on_foot = foot.is_some_and(|foot| foot.distance(cursor) <= reach_px);
        (distance <= reach_px && !is_on_foot).then_some(distance)
    }

    /// The handle nearest to a cursor, of those within reach.
    #[must_use]
    pub fn nearest(arms: &[Self], camera: &Camera, cursor: Vec2, reach_px: f32) -> Option<Self> {
        let reached = arms.iter().filter_map(|arm| Some((arm.distance(camera, cursor, reach_px)?, *arm)));
        reached.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, arm)| arm)
    }

    /// Takes hold of the end.
    #[must_use]
    pub fn drag(&self, press: Vec2) -> Drag {
        Drag::of_place(GrabTarget::Handle(self.handle), self.end, press)
    }
}

/// The directions that a document prescribes at a control point, each with what turns it.
#[must_use]
pub fn handles_at(document: &Document, point: PointId) -> Vec<(Handle, Vec3)> {
    let tangents = document.curves.iter().filter_map(|(id, curve)| {
        let direction = curve.tangents.get(&point)?;
        Some((Handle::Tangent { curve: *id, point }, direction.try_normalize()?.as_vec3()))
    });
    let normals = document.surfaces.iter().filter_map(|(id, surface)| {
        let normal = surface.normals.get(&point)?;
        Some((Handle::Normal { surface: *id, point }, normal.try_normalize()?.as_vec3()))
    });
    tangents.chain(normals).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{Curve, CurveId, Skeleton, Surface, SurfaceId};
    use glam::DVec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const HANDLE: Handle = Handle::Tangent { curve: CurveId(1), point: PointId(2) };

    #[test]
    fn a_handle_is_as_long_in_the_picture_however_far_away_and_is_hit_at_its_end() {
        let mut camera = Camera::default();
        let across = camera.right();
        for distance in [2.0, 20.0] {
            camera.set_pose(crate::Pose { distance, ..camera.pose() });
            let arm = Arm::new(HANDLE, Vec3::ZERO, across * 7.0, &camera);
            let [foot, end] = [arm.foot, arm.end].map(|at| camera.project(at).unwrap());
            assert!((foot.distance(end) - Arm::LENGTH).abs() < 1.0, "{}", foot.distance(end));
            assert_eq!(Arm::nearest(&[arm], &camera, end + Vec2::X * 5.0, 9.0), Some(arm));
            assert_eq!(Arm::nearest(&[arm], &camera, foot, 9.0), None);
            let at_the_eye = Arm::new(HANDLE, Vec3::ZERO, camera.forward(), &camera);
            assert_eq!(Arm::nearest(&[at_the_eye], &camera, foot, 9.0), None);
        }
    }

    #[test]
    fn the_nearest_of_two_handles_is_taken() {
        let camera = Camera::default();
        let [one, other] = [camera.right(), camera.up()].map(|d| Arm::new(HANDLE, Vec3::ZERO, d, &camera));
        let at = camera.project(other.end).unwrap();
        assert_eq!(Arm::nearest(&[one, other], &camera, at, 50.0), Some(other));
    }

    #[test]
    fn a_drag_begins_at_the_end_and_follows_the_cursor() {
        let camera = Camera::default();
        let arm = Arm::new(HANDLE, Vec3::ZERO, camera.right(), &camera);
        let press = camera.project(arm.end).unwrap() + Vec2::ONE;
        let drag = arm.drag(press);
        assert_eq!(drag.target(), GrabTarget::Handle(HANDLE));
        let place = |by: Vec2| drag.place(&camera, press + by, crate::input::Modifiers::default(), 0.1);
        assert!(place(Vec2::ZERO).unwrap().distance(arm.end.as_dvec3()) < 1e-5);
        let up = place(Vec2::NEG_Y * 40.0).unwrap() - arm.end.as_dvec3();
        assert!(up.dot(camera.up().as_dvec3()) > 0.99 * up.length());
    }

    #[test]
    fn only_prescribed_directions_have_handles() {
        let mut document = Document::default();
        let mut curve = Curve::new(vec![PointId(1), PointId(2)], false);
        document.curves.insert(CurveId(2), curve.clone());
        curve.tangents.insert(PointId(2), DVec3::Y * 3.0);
        document.curves.insert(CurveId(1), curve);
        assert_eq!(handles_at(&document, PointId(1)), []);
        assert_eq!(handles_at(&document, PointId(2)), [(HANDLE, Vec3::Y)]);
        let mut surface = Surface::new(Skeleton::default());
        surface.normals.insert(PointId(2), DVec3::Z * 0.5);
        document.surfaces.insert(SurfaceId(4), surface);
        let normal = Handle::Normal { surface: SurfaceId(4), point: PointId(2) };
        assert_eq!(handles_at(&document, PointId(2)), [(HANDLE, Vec3::Y), (normal, Vec3::Z)]);
    }
}
