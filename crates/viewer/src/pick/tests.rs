use super::*;
use crate::camera::{Pose, View};
use crate::sample::{self, Sketch};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Looks at the sketch below from above.
fn from_above(orthographic: bool) -> Camera {
    let mut camera = Camera::default();
    camera.set_viewport(800.0, 600.0);
    camera.set_pose(Pose { distance: 6.0, ..camera.pose_from(View::Top) });
    if orthographic {
        camera.toggle_projection();
    }
    camera
}

/// A square plate at z = 0, a curve across it, and points on it, above it and below it.
fn plate() -> Scene {
    Sketch::default()
        .grid(20, |u, v| Vec3::new(2.0 * u - 1.0, 2.0 * v - 1.0, 0.0), true)
        .curve(&[Vec3::new(-1.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 0.0), Vec3::new(1.0, 0.0, 0.0)], false)
        .curve(&[Vec3::new(-1.0, 0.6, -0.5), Vec3::new(1.0, 0.6, -0.5)], false)
        .point(Vec3::new(0.5, 0.0, 0.0))
        .point(Vec3::new(-0.5, -0.5, 0.7))
        .point(Vec3::new(0.5, -0.5, -0.7))
        .finish()
}

#[track_caller]
fn at(scene: &Scene, camera: &Camera, world: Vec3, offset: Vec2) -> Option<Hit> {
    pick(scene, camera, camera.project(world).unwrap() + offset, 8.0)
}

#[test]
fn points_come_before_curves_before_surfaces() {
    let scene = plate();
    for camera in [from_above(false), from_above(true)] {
        let on_both = at(&scene, &camera, Vec3::new(0.5, 0.0, 0.0), Vec2::new(5.0, 0.0));
        assert!(matches!(on_both, Some(Hit::Point { id: PointId(1), .. })), "{on_both:?}");
        let curve = at(&scene, &camera, Vec3::new(0.2, 0.0, 0.0), Vec2::new(0.0, 4.0));
        let Some(Hit::Curve { id: CurveId(1), at: place }) = curve else { panic!("{curve:?}") };
        assert!(place.distance(Vec3::new(0.2, 0.0, 0.0)) < 1e-3, "{place}");
        let surface = at(&scene, &camera, Vec3::new(0.2, 0.2, 0.0), Vec2::ZERO);
        let Some(Hit::Surface { id: SurfaceId(1), at: place, normal, triangle }) = surface else {
            panic!("{surface:?}")
        };
        assert!(place.distance(Vec3::new(0.2, 0.2, 0.0)) < 1e-3);
        assert!(normal.distance(Vec3::Z) < 1e-4 && (triangle as usize) < scene.indices.len() / 3);
    }
}

#[test]
fn a_curve_that_a_surface_hides_is_taken_by_those_who_see_through_unless_one_is_in_sight() {
    let scene = plate();
    for camera in [from_above(false), from_above(true)] {
        let under = camera.project(Vec3::new(0.3, 0.6, -0.5)).unwrap();
        let through = Wanted { hidden: true, points: false, surfaces: false, ..Wanted::ALL };
        let among = |cursor, wanted| pick_among(&scene, &camera, cursor, 8.0, wanted);
        assert_eq!(among(under, Wanted { hidden: false, ..through }), None);
        let Some(Hit::Curve { id: CurveId(2), at }) = among(under, through) else { panic!("the hidden one") };
        assert!(at.distance(Vec3::new(0.3, 0.6, -0.5)) < 1e-3, "{at}");
        // Where the reach is wide enough for both, the one in sight is meant, though it is farther off.
        let seen = pick_among(&scene, &camera, under, 400.0, through);
        assert!(matches!(seen, Some(Hit::Curve { id: CurveId(1), .. })), "{seen:?}");
    }
}

#[test]
fn a_point_that_a_surface_hides_comes_after_all_that_is_in_sight() {
    let scene = plate();
    for camera in [from_above(false), from_above(true)] {
        let under = camera.project(Vec3::new(0.5, -0.5, -0.7)).unwrap();
        let through = Wanted { hidden: true, surfaces: false, ..Wanted::ALL };
        let among = |reach, wanted| pick_among(&scene, &camera, under, reach, wanted);
        assert_eq!(among(8.0, Wanted { hidden: false, ..through }), None);
        let found = among(8.0, through);
        assert!(matches!(found, Some(Hit::Point { id: PointId(3), .. })), "{found:?}");
        // A curve that is in sight is meant before it, and so is another point.
        let curve = among(400.0, Wanted { except: Some(PointId(1)), ..through });
        assert!(matches!(curve, Some(Hit::Point { id: PointId(2), .. })), "{curve:?}");
        let beside = camera.project(Vec3::new(0.5, 0.0, 0.0)).unwrap().distance(under) + 1.0;
        let others =
            pick_among(&scene, &camera, under, beside, Wanted { except: Some(PointId(1)), ..through });
        assert!(matches!(others, Some(Hit::Curve { id: CurveId(1), .. })), "{others:?}");
    }
}

#[test]
fn what_a_surface_hides_is_left_to_it() {
    let scene = plate();
    for camera in [from_above(false), from_above(true)] {
        let above = at(&scene, &camera, Vec3::new(-0.5, -0.5, 0.7), Vec2::ZERO);
        assert!(matches!(above, Some(Hit::Point { id: PointId(2), .. })));
        let below = at(&scene, &camera, Vec3::new(0.5, -0.5, -0.7), Vec2::ZERO);
        assert!(matches!(below, Some(Hit::Surface { .. })), "{below:?}");
        let curve_below = at(&scene, &camera, Vec3::new(0.1, 0.6, -0.5), Vec2::ZERO);
        assert!(matches!(curve_below, Some(Hit::Surface { .. })));
    }
    let mut from_below = from_above(false);
    from_below.look_from(View::Bottom);
    let seen = at(&scene, &from_below, Vec3::new(0.5, -0.5, -0.7), Vec2::ZERO);
    assert!(matches!(seen, Some(Hit::Point { id: PointId(3), .. })));
    let back = at(&scene, &from_below, Vec3::new(0.2, 0.2, 0.0), Vec2::ZERO);
    let Some(Hit::Surface { normal, .. }) = back else { panic!("{back:?}") };
    assert!(normal.distance(Vec3::NEG_Z) < 1e-4, "the normal points to the eye");
}

#[test]
fn misses_are_misses() {
    let scene = plate();
    for camera in [from_above(false), from_above(true)] {
        assert_eq!(pick(&scene, &camera, Vec2::new(3.0, 3.0), 8.0), None);
        let beside = at(&scene, &camera, Vec3::new(-0.5, -0.5, 0.7), Vec2::new(9.0, 0.0));
        assert!(matches!(beside, Some(Hit::Surface { .. })));
    }
    assert_eq!(pick(&Scene::default(), &Camera::default(), Vec2::ZERO, 8.0), None);
}

#[test]
fn nothing_behind_the_eye_is_picked() {
    let scene = plate();
    let mut camera = from_above(false);
    camera.set_pose(Pose { centre: Vec3::new(0.0, 0.0, -20.0), distance: 6.0, ..camera.pose() });
    for x in 0..8 {
        for y in 0..6 {
            #[expect(clippy::cast_precision_loss, reason = "small")]
            let cursor = Vec2::new(x as f32, y as f32) * 100.0;
            assert_eq!(pick(&scene, &camera, cursor, 50.0), None);
        }
    }
    // The orthographic eye stands behind everything.
    camera.toggle_projection();
    camera.set_pose(Pose { centre: Vec3::new(0.0, 0.0, -2.0), distance: 1.0, ..camera.pose() });
    assert!(matches!(at(&scene, &camera, Vec3::new(0.1, 0.1, 0.0), Vec2::ZERO), Some(Hit::Surface { .. })));
}

#[test]
fn tools_can_want_less() {
    let scene = plate();
    let camera = from_above(false);
    let cursor = camera.project(Vec3::new(0.5, 0.0, 0.0)).unwrap();
    let among = |wanted| pick_among(&scene, &camera, cursor, 8.0, wanted);
    assert!(matches!(among(Wanted { points: false, ..Wanted::ALL }), Some(Hit::Curve { .. })));
    let except = Wanted { except: Some(PointId(1)), ..Wanted::ALL };
    assert!(matches!(among(except), Some(Hit::Curve { .. })));
    let surfaces = Wanted { points: false, curves: false, ..Wanted::ALL };
    assert!(matches!(among(surfaces), Some(Hit::Surface { .. })));
    let points = Wanted { except: Some(PointId(1)), curves: false, surfaces: false, ..Wanted::ALL };
    assert_eq!(among(points), None);
}

#[test]
fn curves_in_perspective_are_met_in_space() {
    let scene =
        Sketch::default().curve(&[Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.2, 30.0, 0.0)], false).finish();
    let mut camera = Camera::default();
    camera.set_pose(Pose { azimuth: 0.1, elevation: 0.3, ..Pose::default() });
    let target = Vec3::new(0.0, -1.0, 0.0).lerp(Vec3::new(0.2, 30.0, 0.0), 0.3);
    let Some(Hit::Curve { at: place, .. }) = at(&scene, &camera, target, Vec2::ZERO) else { panic!() };
    assert!(place.distance(target) < 0.05, "{place} {target}");
}

#[test]
fn the_closing_segment_belongs_to_the_curve() {
    let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)];
    let middle = (corners[2] + corners[0]) * 0.5;
    let camera = from_above(false);
    let open = Sketch::default().curve(&corners, false).finish();
    assert_eq!(at(&open, &camera, middle, Vec2::ZERO), None);
    let closed = Sketch::default().curve(&corners, true).finish();
    assert!(matches!(at(&closed, &camera, middle, Vec2::ZERO), Some(Hit::Curve { .. })));
}

#[test]
fn normals_of_a_one_sided_surface_point_to_the_eye() {
    let scene = sample::moebius(48, 6);
    let mut camera = Camera::default();
    for step in 0_u8..40 {
        camera.set_pose(Pose { azimuth: 0.16 * f32::from(step), ..Pose::default() });
        for x in (0..1280_u16).step_by(40) {
            for y in (0..720_u16).step_by(40) {
                let cursor = Vec2::new(f32::from(x), f32::from(y));
                if let Some(Hit::Surface { at, normal, .. }) = pick(&scene, &camera, cursor, 0.1) {
                    let toward = (camera.eye() - at).normalize();
                    assert!(normal.dot(toward) > -0.35, "{normal} {toward}");
                }
            }
        }
    }
}

/// Not a limit but a figure: `cargo test --release -- --ignored --nocapture pick_time`.
#[cfg(not(target_arch = "wasm32"))]
#[test]
#[ignore = "a measurement"]
#[expect(clippy::disallowed_methods, reason = "a native measurement")]
fn pick_time() {
    let scene = sample::bumpy_disc(58);
    let camera = Camera::default();
    let start = std::time::Instant::now();
    let mut hits = 0;
    for x in 0..40_u16 {
        for y in 0..25_u16 {
            let cursor = Vec2::new(440.0 + 10.0 * f32::from(x), 235.0 + 10.0 * f32::from(y));
            hits += u32::from(pick(&scene, &camera, cursor, 10.0).is_some());
        }
    }
    let each = start.elapsed().as_secs_f64() * 1e3 / 1000.0;
    println!("{} triangles, {hits} hits of 1000: {each:.3} ms each", scene.indices.len() / 3);
}
