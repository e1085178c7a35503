use super::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Cameras of both projections in several poses, with panels at the edges and without.
fn cameras() -> Vec<Camera> {
    let mut all = Vec::new();
    let panels = Some((Vec2::new(90.0, 50.0), Vec2::new(700.0, 560.0)));
    for (orthographic, free) in [(false, None), (true, None), (false, panels), (true, panels)] {
        for (azimuth, elevation) in [(0.0, 0.0), (0.7, 0.4), (-2.5, -1.2), (3.0, FRAC_PI_2)] {
            let mut camera = Camera::default();
            camera.set_viewport(1000.0, 600.0);
            camera.set_free(free);
            camera.set_pose(Pose { centre: Vec3::new(0.3, -0.2, 0.5), azimuth, elevation, distance: 5.0 });
            if orthographic {
                camera.toggle_projection();
            }
            all.push(camera);
        }
    }
    all
}

/// A few places in front of every camera above.
const PLACES: [Vec3; 4] = [
    Vec3::new(0.3, -0.2, 0.5),
    Vec3::new(0.9, 0.1, 0.0),
    Vec3::new(-0.4, 0.5, 1.3),
    Vec3::new(0.0, -1.0, 0.2),
];

#[track_caller]
fn assert_near(a: Vec2, b: Vec2) {
    assert!(a.distance(b) < 0.02, "{a} is not {b}");
}

#[test]
fn project_agrees_with_clip_space() {
    for camera in cameras() {
        for at in PLACES {
            let clip = camera.clip_from_world() * at.extend(1.0);
            let ndc = clip.truncate() / clip.w;
            assert!((0.0..=1.0).contains(&ndc.z), "{ndc}");
            let pixel = (Vec2::new(ndc.x, -ndc.y) * 0.5 + 0.5) * camera.viewport();
            assert_near(camera.project(at).unwrap(), pixel);
        }
    }
}

#[test]
fn depth_is_reversed() {
    for camera in cameras() {
        let depth = |at: Vec3| {
            let clip = camera.clip_from_world() * at.extend(1.0);
            clip.z / clip.w
        };
        let centre = camera.pose().centre;
        assert!(depth(centre - camera.forward()) > depth(centre));
    }
}

#[test]
fn rays_pass_through_what_they_point_at() {
    for camera in cameras() {
        for at in PLACES {
            let ray = camera.ray(camera.project(at).unwrap());
            assert!((ray.direction.length() - 1.0).abs() < 1e-5);
            let along = ray.direction.dot(at - ray.origin);
            assert!(along > 0.0);
            assert!(ray.at(along).distance(at) < 2e-4, "{:?}", camera.pose());
        }
    }
}

#[test]
fn what_is_behind_the_eye_has_no_place() {
    let camera = Camera::default();
    assert_eq!(camera.project(camera.eye() - camera.forward()), None);
    assert!(camera.project(camera.pose().centre).is_some());
}

#[test]
fn orbit_keeps_distance_and_place_of_the_pivot() {
    for mut camera in cameras() {
        for pivot in PLACES {
            let distance = camera.eye().distance(pivot);
            let pixel = camera.project(pivot).unwrap();
            camera.orbit(pivot, Vec2::new(37.0, -21.0));
            assert!((camera.eye().distance(pivot) - distance).abs() < 1e-4);
            assert_near(camera.project(pivot).unwrap(), pixel);
        }
    }
}

#[test]
fn orbit_stops_at_the_poles() {
    let mut camera = Camera::default();
    camera.orbit(Vec3::ZERO, Vec2::new(0.0, 1e5));
    assert_eq!(camera.pose().elevation, FRAC_PI_2);
    assert!(camera.forward().distance(Vec3::NEG_Z) < 1e-5);
    camera.orbit(Vec3::ZERO, Vec2::new(1e5, -1e5));
    assert_eq!(camera.pose().elevation, -FRAC_PI_2);
    assert!(camera.pose().azimuth.abs() <= PI);
}

#[test]
fn pan_follows_the_pointer() {
    for mut camera in cameras() {
        for at in PLACES {
            let pixel = camera.project(at).unwrap();
            camera.pan(at, Vec2::new(12.0, 7.0));
            assert_near(camera.project(at).unwrap(), pixel + Vec2::new(12.0, 7.0));
        }
    }
}

#[test]
fn zoom_keeps_the_place_under_the_pointer() {
    for mut camera in cameras() {
        for factor in [1.2, 0.7] {
            let cursor = Vec2::new(700.0, 150.0);
            let under = camera.drag_on_view_plane(camera.pose().centre, cursor);
            camera.zoom_to(cursor, factor);
            assert_near(camera.project(under).unwrap(), cursor);
            for at in PLACES {
                let pixel = camera.project(at).unwrap();
                camera.zoom_about(at, factor);
                assert_near(camera.project(at).unwrap(), pixel);
            }
        }
    }
}

#[test]
fn zoom_has_ends() {
    let mut camera = Camera::default();
    for _ in 0..2000 {
        camera.zoom_to(Vec2::new(3.0, 4.0), 1.5);
    }
    assert!(camera.pose().distance >= DISTANCES.0 && camera.eye().is_finite());
    for _ in 0..4000 {
        camera.zoom_to(Vec2::new(3.0, 4.0), 0.5);
    }
    assert!(camera.pose().distance <= DISTANCES.1 && camera.eye().is_finite());
    camera.zoom_about(Vec3::ZERO, 0.0);
    camera.zoom_about(Vec3::ZERO, f32::NAN);
    assert!(camera.eye().is_finite());
}

#[test]
fn drag_on_the_view_plane_follows_the_pointer() {
    for camera in cameras() {
        for anchor in PLACES {
            let cursor = Vec2::new(412.0, 233.0);
            let to = camera.drag_on_view_plane(anchor, cursor);
            assert_near(camera.project(to).unwrap(), cursor);
            assert!((camera.depth(to) - camera.depth(anchor)).abs() < 1e-5);
            let stay = camera.drag_on_view_plane(anchor, camera.project(anchor).unwrap());
            assert!(stay.distance(anchor) < 1e-4);
        }
    }
}

#[test]
fn drag_along_an_axis_stays_on_it_and_comes_nearest() {
    let axis = Vec3::new(1.0, 2.0, 0.5);
    for camera in cameras() {
        for anchor in PLACES {
            let cursor = Vec2::new(612.0, 203.0);
            let to = camera.drag_along(anchor, axis, cursor);
            assert!((to - anchor).cross(axis).length() < 1e-3 * (1.0 + (to - anchor).length()));
            let ray = camera.ray(cursor);
            let miss = |at: Vec3| (at - ray.origin).cross(ray.direction).length();
            assert!(miss(to) <= miss(to + axis * 0.01) + 1e-5 && miss(to) <= miss(to - axis * 0.01) + 1e-5);
            let stay = camera.drag_along(anchor, axis, camera.project(anchor).unwrap());
            assert!(stay.distance(anchor) < 1e-3);
        }
    }
}

#[test]
fn drag_along_the_line_of_sight_does_nothing() {
    let camera = Camera::default();
    let centre = camera.pose().centre;
    let cursor = camera.viewport() * 0.5 + Vec2::new(9.0, 9.0);
    assert_eq!(camera.drag_along(centre, camera.forward(), cursor), centre);
    assert_eq!(camera.drag_along(centre, Vec3::ZERO, cursor), centre);
}

#[test]
fn fit_shows_the_whole_ball() {
    for (width, height) in [(1000.0, 500.0), (300.0, 900.0)] {
        for mut camera in cameras() {
            camera.set_viewport(width, height);
            let (centre, radius) = (Vec3::new(4.0, 5.0, 6.0), 2.0);
            camera.fit(centre, radius);
            for side in [camera.right(), -camera.right(), camera.up(), -camera.up()] {
                let pixel = camera.project(centre + side * radius).unwrap();
                assert!(pixel.cmpge(Vec2::ZERO).all() && pixel.cmple(camera.viewport()).all(), "{pixel}");
            }
        }
    }
    let mut camera = Camera::default();
    camera.fit(Vec3::ZERO, 0.0);
    assert!(camera.pose().distance > 1.0);
}

#[test]
fn fit_shows_the_whole_ball_beside_the_panels() {
    let (lower, upper) = (Vec2::new(90.0, 60.0), Vec2::new(660.0, 500.0));
    for mut camera in cameras() {
        camera.set_viewport(900.0, 560.0);
        camera.set_free(Some((lower, upper)));
        let (centre, radius) = (Vec3::new(4.0, 5.0, 6.0), 2.0);
        camera.fit(centre, radius);
        assert!(camera.project(centre).unwrap().distance(0.5 * (lower + upper)) < 1e-2);
        for side in [camera.right(), -camera.right(), camera.up(), -camera.up()] {
            let pixel = camera.project(centre + side * radius).unwrap();
            assert!(pixel.cmpge(lower).all() && pixel.cmple(upper).all(), "{pixel}");
        }
        camera.look_from(View::Top);
        assert!(camera.project(centre).unwrap().distance(0.5 * (lower + upper)) < 1e-2);
        // What is left of the canvas is too little to show anything in.
        camera.set_free(Some((lower, lower + 50.0)));
        assert!(camera.project(centre).unwrap().distance(Vec2::new(450.0, 280.0)) < 1e-2);
    }
}

#[test]
fn standard_views_look_along_the_axes() {
    let mut camera = Camera::default();
    for view in View::ALL {
        camera.look_from(view);
        assert!(camera.forward().distance(-view.toward_eye()) < 1e-5, "{view:?}");
        assert_eq!(view.opposite().opposite(), view);
        assert!(view.opposite().toward_eye() == -view.toward_eye());
    }
    camera.look_from(View::Front);
    assert!(camera.right().distance(Vec3::X) < 1e-5 && camera.up().distance(Vec3::Z) < 1e-5);
    camera.look_from(View::Top);
    assert!(camera.right().distance(Vec3::X) < 1e-5 && camera.up().distance(Vec3::Y) < 1e-5);
}

#[test]
fn flights_arrive_in_time_by_the_short_way() {
    let mut camera = Camera::default();
    let start = Pose { azimuth: 3.0, ..Pose::default() };
    camera.set_pose(start);
    let to = Pose { azimuth: -3.0, distance: 8.0, centre: Vec3::X, ..start };
    camera.fly_to(to, 1000.0);
    assert!(camera.advance(1000.0) && camera.pose() == start);
    assert!(camera.advance(1090.0) && camera.is_flying());
    assert!(camera.pose().azimuth.abs() > 3.0, "the short way passes through the back");
    assert!(camera.pose().distance > 4.0 && camera.pose().distance < 8.0);
    assert!(!camera.advance(1200.0) && camera.pose() == to && !camera.is_flying());
    camera.fly_to(start, 2000.0);
    camera.orbit(Vec3::ZERO, Vec2::X);
    assert!(!camera.is_flying(), "the hand takes over");
}

#[test]
fn stored_view_comes_back() {
    let mut camera = Camera::default();
    assert_eq!(camera.recall(), None);
    camera.store();
    let pose = camera.pose();
    camera.toggle_projection();
    camera.look_from(View::Left);
    assert_eq!(camera.recall(), Some(pose));
    assert!(!camera.is_orthographic());
}

#[test]
fn rays_meet_planes_in_front() {
    let ray = Ray { origin: Vec3::Z, direction: Vec3::NEG_Z };
    assert_eq!(ray.meets_plane(Vec3::ZERO, Vec3::Z), Some(Vec3::ZERO));
    assert_eq!(ray.meets_plane(Vec3::Z * 2.0, Vec3::Z), None);
    assert_eq!(ray.meets_plane(Vec3::ZERO, Vec3::X), None);
}
