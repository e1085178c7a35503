//! The axis triad in the lower right corner: shows where x, y and z point, and takes clicks.

use crate::camera::{Camera, View};
use crate::layer::Marks;
use crate::theme::Theme;
use crate::uniforms::{ON_SCREEN, Style};
use glam::{Vec2, Vec4};

/// Centre of the triad from the lower right corner, in CSS pixels; it leaves the status line free.
const INSET: Vec2 = Vec2::new(60.0, 84.0);
/// Length of an axis.
const ARM: f32 = 34.0;
/// Radius of the disc at the positive end of an axis, and at the negative end.
const RADII: [f32; 2] = [9.0, 6.0];

/// The ends of the axes: the view from there and the letter of a positive end.
const ENDS: [(View, usize, bool); 6] = [
    (View::Right, 0, true),
    (View::Left, 0, false),
    (View::Back, 1, true),
    (View::Front, 1, false),
    (View::Top, 2, true),
    (View::Bottom, 2, false),
];

/// The centre of the triad on the canvas, in CSS pixels.
fn centre(camera: &Camera) -> Vec2 {
    camera.viewport() - INSET
}

/// Where an end is on the canvas, and how near to the eye.
fn place(camera: &Camera, view: View) -> (Vec2, f32) {
    let axis = view.toward_eye();
    let aside = Vec2::new(axis.dot(camera.right()), -axis.dot(camera.up()));
    (centre(camera) + aside * ARM, -axis.dot(camera.forward()))
}

impl Camera {
    /// The end of an axis of the triad under the pointer, and so the view that a click asks for.
    #[must_use]
    pub fn triad_hit(&self, cursor: Vec2) -> Option<View> {
        let hits = ENDS.iter().filter_map(|&(view, _, is_positive)| {
            let (at, nearness) = place(self, view);
            let radius = RADII[usize::from(!is_positive)] + 2.0;
            (at.distance(cursor) <= radius).then_some((view, nearness))
        });
        hits.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(view, _)| view)
    }
}

/// Adds the triad to the marks, in the order from back to front.
pub(crate) fn add_triad(marks: &mut Marks, camera: &Camera, theme: &Theme, ratio: f32, hover: Option<View>) {
    // On the canvas, before everything.
    let on_screen = |at: Vec2| (at * ratio).extend(1.0);
    let mut ends = ENDS.map(|(view, axis, is_positive)| (place(camera, view), view, axis, is_positive));
    ends.sort_by(|a, b| a.0.1.total_cmp(&b.0.1));
    for ((at, nearness), _, axis, is_positive) in ends {
        if is_positive {
            let style = Style { fill: toned(theme, axis, nearness), half_width: 1.25, ..on_canvas() };
            marks.add_polyline([centre(camera), at].into_iter().map(on_screen), false, style);
        }
    }
    for ((at, nearness), view, axis, is_positive) in ends {
        let colour = toned(theme, axis, nearness);
        let fill = if is_positive { colour } else { colour.lerp(theme.top, 0.6) };
        let (outline, outline_width) =
            if hover == Some(view) { (theme.selected, 2.0) } else { (colour, 1.25) };
        let flags = ON_SCREEN | if is_positive { (letter(axis)) << 8 } else { 0 };
        let radius = RADII[usize::from(!is_positive)] - 1.25;
        marks.add_dot(
            on_screen(at),
            Style { fill, outline, half_width: radius, outline_width, flags, ..on_canvas() },
        );
    }
}

fn on_canvas() -> Style {
    Style { flags: ON_SCREEN, ..Style::default() }
}

fn letter(axis: usize) -> u32 {
    [1, 2, 3][axis]
}

/// The colour of an axis, paler where it points away.
fn toned(theme: &Theme, axis: usize, nearness: f32) -> Vec4 {
    let ground = theme.bottom;
    let away = (-nearness).max(0.0);
    theme.axes[axis].lerp(ground, 0.35 * away).with_w(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn ends_are_clickable_and_the_front_one_wins() {
        let mut camera = Camera::default();
        for view in View::ALL {
            let (at, _) = place(&camera, view);
            assert_eq!(camera.triad_hit(at), Some(view));
        }
        assert_eq!(camera.triad_hit(Vec2::new(100.0, 100.0)), None);
        camera.look_from(View::Front);
        assert_eq!(camera.triad_hit(centre(&camera)), Some(View::Front));
        camera.look_from(View::Top);
        assert_eq!(camera.triad_hit(centre(&camera)), Some(View::Top));
    }

    #[test]
    fn axes_follow_the_eye() {
        let positive = ENDS.iter().filter(|end| end.2).map(|end| end.0.toward_eye());
        assert!(positive.eq([Vec3::X, Vec3::Y, Vec3::Z]));
        let mut camera = Camera::default();
        camera.look_from(View::Front);
        let (x, _) = place(&camera, View::Right);
        assert!((x - centre(&camera) - Vec2::new(ARM, 0.0)).length() < 1e-3);
        let (z, _) = place(&camera, View::Top);
        assert!((z - centre(&camera) - Vec2::new(0.0, -ARM)).length() < 1e-3);
    }

    #[test]
    fn triad_lies_on_the_canvas() {
        let mut marks = Marks::default();
        add_triad(&mut marks, &Camera::default(), &Theme::new(true), 2.0, Some(View::Top));
        assert_eq!((marks.segments.len(), marks.dots.len()), (3, 6));
        for at in marks.floats.chunks_exact(3) {
            assert!((0.0..2560.0).contains(&at[0]) && (0.0..1440.0).contains(&at[1]) && at[2] == 1.0);
        }
    }
}
