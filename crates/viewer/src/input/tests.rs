use super::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn pointer(device: Device, id: i32, x: f32, y: f32, time: f64) -> Pointer {
    Pointer { id, device, at: Vec2::new(x, y), modifiers: Modifiers::default(), time }
}

fn mouse(x: f32, y: f32, time: f64) -> Pointer {
    pointer(Device::Mouse, 1, x, y, time)
}

fn finger(id: i32, x: f32, y: f32, time: f64) -> Pointer {
    pointer(Device::Touch, id, x, y, time)
}

#[test]
fn a_press_that_wanders_little_is_a_click() {
    let mut hand = Recogniser::default();
    assert!(hand.down(mouse(10.0, 10.0, 0.0), Button::Primary, true).is_empty());
    assert!(hand.moved(mouse(12.0, 11.0, 10.0), true).is_empty());
    assert_eq!(
        hand.up(mouse(12.0, 11.0, 20.0)),
        [Gesture::Click { at: Vec2::new(10.0, 10.0), modifiers: Modifiers::default() }]
    );
    assert!(!hand.is_busy());
}

#[test]
fn two_clicks_soon_after_each_other_are_a_double_click_and_three_are_no_two() {
    let mut hand = Recogniser::default();
    let mut click = |time| {
        hand.down(mouse(10.0, 10.0, time), Button::Primary, true);
        hand.up(mouse(10.0, 10.0, time + 20.0))
    };
    assert!(matches!(click(0.0)[..], [Gesture::Click { .. }]));
    assert!(matches!(click(200.0)[..], [Gesture::DoubleClick { .. }]));
    assert!(matches!(click(400.0)[..], [Gesture::Click { .. }]));
    assert!(matches!(click(1400.0)[..], [Gesture::Click { .. }]));
}

#[test]
fn a_drag_on_something_grabs_where_the_press_was() {
    let mut hand = Recogniser::default();
    hand.down(mouse(10.0, 10.0, 0.0), Button::Primary, true);
    let out = hand.moved(mouse(20.0, 10.0, 10.0), true);
    assert_eq!(out[0], Gesture::Grab { at: Vec2::new(10.0, 10.0) });
    assert!(matches!(out[1], Gesture::Drag { at, .. } if at == Vec2::new(20.0, 10.0)));
    assert_eq!(hand.up(mouse(20.0, 10.0, 20.0)), [Gesture::Drop]);
}

#[test]
fn a_drag_on_nothing_orbits() {
    let mut hand = Recogniser::default();
    hand.down(mouse(10.0, 10.0, 0.0), Button::Primary, false);
    let out = hand.moved(mouse(20.0, 10.0, 10.0), true);
    assert_eq!(out, [Gesture::OrbitFrom(Vec2::new(10.0, 10.0)), Gesture::Orbit(Vec2::new(10.0, 0.0))]);
    assert!(hand.up(mouse(20.0, 10.0, 20.0)).is_empty());
}

#[test]
fn buttons_and_keys_choose_between_orbit_and_pan() {
    let drag = |button, modifiers| {
        let mut hand = Recogniser::default();
        hand.down(Pointer { modifiers, ..mouse(0.0, 0.0, 0.0) }, button, true);
        hand.moved(Pointer { modifiers, ..mouse(8.0, 0.0, 0.0) }, true).pop().unwrap()
    };
    let none = Modifiers::default();
    let shift = Modifiers { shift: true, ..none };
    let alt = Modifiers { alt: true, ..none };
    assert!(matches!(drag(Button::Secondary, none), Gesture::Orbit(_)));
    assert!(matches!(drag(Button::Primary, alt), Gesture::Orbit(_)));
    assert!(matches!(drag(Button::Middle, none), Gesture::Pan { .. }));
    assert!(matches!(drag(Button::Secondary, shift), Gesture::Pan { .. }));
    assert!(matches!(drag(Button::Primary, shift), Gesture::Drag { .. }));
}

#[test]
fn a_second_finger_abandons_the_drag_and_pans_and_zooms() {
    let mut hand = Recogniser::default();
    hand.down(finger(1, 100.0, 100.0, 0.0), Button::Primary, true);
    hand.moved(finger(1, 120.0, 100.0, 50.0), true);
    assert_eq!(hand.down(finger(2, 220.0, 100.0, 80.0), Button::Primary, true), [Gesture::Abandon]);
    let mut out = hand.moved(finger(2, 320.0, 100.0, 90.0), true);
    assert!(matches!(out.pop(), Some(Gesture::Zoom { factor, .. }) if factor > 1.5));
    assert!(matches!(out.pop(), Some(Gesture::Pan { by, .. }) if by == Vec2::new(50.0, 0.0)));
}

#[test]
fn taps_of_two_and_three_fingers_undo_and_redo() {
    for (count, wanted) in [(2, Gesture::Undo), (3, Gesture::Redo)] {
        let mut hand = Recogniser::default();
        for id in 0..count {
            assert!(hand.down(finger(id, 50.0 * id as f32, 0.0, 0.0), Button::Primary, true).is_empty());
        }
        let mut all = Vec::new();
        for id in 0..count {
            all.extend(hand.up(finger(id, 50.0 * id as f32, 0.0, 100.0)));
        }
        assert_eq!(all, [wanted]);
        assert!(!hand.is_busy());
    }
}

#[test]
fn two_down_and_one_lifted_orbits() {
    let mut hand = Recogniser::default();
    hand.down(finger(1, 0.0, 0.0, 0.0), Button::Primary, true);
    hand.down(finger(2, 100.0, 0.0, 10.0), Button::Primary, true);
    assert!(hand.up(finger(1, 0.0, 0.0, 600.0)).is_empty());
    let out = hand.moved(finger(2, 110.0, 0.0, 650.0), true);
    assert!(matches!(out[..], [Gesture::OrbitFrom(_), Gesture::Orbit(_)]));
    hand.up(finger(2, 110.0, 0.0, 700.0));
    assert!(!hand.is_busy());
}

#[test]
fn a_lost_pointer_puts_everything_back() {
    let mut hand = Recogniser::default();
    hand.down(mouse(0.0, 0.0, 0.0), Button::Primary, true);
    hand.moved(mouse(9.0, 0.0, 1.0), true);
    assert_eq!(hand.cancelled(1), [Gesture::Abandon]);
    assert!(!hand.is_busy());
    assert!(hand.cancelled(1).is_empty());

    hand.down(mouse(0.0, 0.0, 2.0), Button::Primary, true);
    hand.moved(mouse(9.0, 0.0, 3.0), true);
    let out = hand.moved(mouse(30.0, 0.0, 4.0), false);
    assert_eq!(out, [Gesture::Abandon, Gesture::Hover(Vec2::new(30.0, 0.0))]);
}

#[test]
fn escape_makes_the_rest_of_the_press_mean_nothing() {
    let mut hand = Recogniser::default();
    hand.down(mouse(0.0, 0.0, 0.0), Button::Primary, true);
    hand.moved(mouse(9.0, 0.0, 1.0), true);
    assert_eq!(hand.abandon(), [Gesture::Abandon]);
    assert!(hand.moved(mouse(40.0, 0.0, 2.0), true).is_empty());
    assert!(hand.up(mouse(40.0, 0.0, 3.0)).is_empty());
    assert!(!hand.is_busy());
}

#[test]
fn numbers_that_are_none_are_left_out() {
    let mut hand = Recogniser::default();
    assert!(hand.down(mouse(f32::NAN, 0.0, 0.0), Button::Primary, true).is_empty());
    assert!(!hand.is_busy());
    hand.down(mouse(0.0, 0.0, 0.0), Button::Primary, true);
    assert!(hand.moved(mouse(f32::INFINITY, 0.0, 1.0), true).is_empty());
    assert_eq!(Recogniser::wheel(Vec2::NAN, Vec2::ONE, Modifiers::default()), None);
}

#[test]
fn the_wheel_zooms_and_never_by_more_than_one_e_at_a_time() {
    let zoom = |y, modifiers| Recogniser::wheel(Vec2::ZERO, Vec2::new(0.0, y), modifiers);
    let none = Modifiers::default();
    assert!(matches!(zoom(-100.0, none), Some(Gesture::Zoom { factor, .. }) if factor > 1.0));
    assert!(matches!(zoom(1e9, none), Some(Gesture::Zoom { factor, .. }) if factor > 0.3));
    assert!(matches!(zoom(5.0, Modifiers { shift: true, ..none }), Some(Gesture::Pan { .. })));
}
