//! What curves and points look like: roles, hover, selection, and the marks that tools add.

use crate::camera::Camera;
use crate::layer::{Marks, length};
use crate::look::Highlight;
use crate::pick::Hit;
use crate::polyline::append_polyline;
use crate::scene::Scene;
use crate::strip::Strip;
use crate::theme::Theme;
use crate::uniforms::{Dot, Segment, Style};
use ductile_spec::{CurveRole, CurveSpan, PointEntry, PointId};
use glam::{Vec3, Vec4};
use std::f32::consts::TAU;

/// Half the width of a curve, and of a boundary, in CSS pixels.
const CURVE: f32 = 1.3;
const BOUNDARY: f32 = 1.6;
/// Half the width of an edge of a control net.
const NET: f32 = 0.6;
/// Half the width of the selected edge or face of one.
const NET_SELECTED: f32 = 2.0;
/// What hover adds to half a width or a radius.
const THICKER: f32 = 0.9;
/// Half the width of a line that shows what a tool would make.
const SKETCH: f32 = 0.8;
/// Opacity of a skin that shows what a tool would make or take.
const SKIN: f32 = 0.34;
/// Widths of the two banks of a line that would become an edge, and of the glow of one that would be smoothed.
const SHARP: f32 = 1.8;
const SOFT: f32 = 8.0;
/// Width of the glow of a rim.
const RIM_GLOW: f32 = 2.6;
/// Radius of a control point.
const POINT: f32 = 4.6;
/// Radius of the end of a handle.
const HANDLE: f32 = 5.2;
/// Opacity of a handle where a surface hides it.
const HANDLE_HIDDEN: f32 = 0.75;
/// Opacity of the rungs of a tangent strip and of its outer edge, and what of it is left where a surface hides them.
const STRIP_RUNG: f32 = 0.55;
const STRIP_EDGE: f32 = 0.85;
const STRIP_HIDDEN: f32 = 0.4;
/// Width of the thin outline of a point.
const HALO: f32 = 1.4;
/// Width of the outline of what is selected.
const SELECTED: f32 = 2.2;
/// Opacity where a surface hides a curve, and a point.
const HIDDEN_CURVE: f32 = 0.22;
const HIDDEN_POINT: f32 = 0.30;
/// Radius of the ring that lies on a surface where a grab would take hold.
const RING: f32 = 10.0;
const RING_CORNERS: u8 = 48;
/// Length of a prescribed direction.
const DIRECTION: f32 = 44.0;

/// The parts of a scene's structure that the skeleton needs, and where its points are.
#[derive(Debug, Default)]
pub(crate) struct Skeleton {
    curves: Vec<CurveSpan>,
    points: Vec<PointEntry>,
    places: Vec<Vec3>,
    points_at: u32,
    /// Points from back to front.
    order: Vec<(f32, u32)>,
}

impl Skeleton {
    /// Takes the structure and makes the segments of all curves.
    pub(crate) fn take_structure(&mut self, scene: &Scene, segments: &mut Vec<Segment>) {
        self.curves.clone_from(&scene.structure.curves);
        self.points.clone_from(&scene.structure.points);
        self.places.clear();
        self.points_at = u32::try_from(scene.structure.points_at()).unwrap_or(u32::MAX);
        let samples_at = u32::try_from(scene.structure.samples_at()).unwrap_or(u32::MAX);
        segments.clear();
        for (curve, style) in self.curves.iter().zip(0..) {
            append_polyline(segments, samples_at + 3 * curve.first, curve.count, curve.closed, style);
        }
        let nets_at = u32::try_from(scene.structure.nets_at()).unwrap_or(u32::MAX);
        // All nets have one style, after those of the curves.
        let style = length(&self.curves);
        for net in &scene.structure.nets {
            for [from, to] in &net.edges {
                let [start, stop] = [from, to].map(|end| nets_at + 3 * (net.first + end));
                segments.push(Segment { before: start, start, stop, after: stop, style });
            }
        }
    }

    /// Takes the places of the points.
    pub(crate) fn take_frame(&mut self, scene: &Scene) {
        self.places.clear();
        self.places.extend(scene.points().map(|(_, at)| at));
    }

    /// Makes the styles of all curves and the points in their order from back to front.
    pub(crate) fn mark(&mut self, marks: &mut Marks, camera: &Camera, highlight: &Highlight, theme: &Theme) {
        marks.clear();
        marks.curve_styles.extend(self.curves.iter().map(|curve| curve_style(curve, highlight, theme)));
        marks.curve_styles.push(net_style(theme));
        self.order.clear();
        self.order.extend(self.places.iter().zip(0..).map(|(at, i)| (camera.depth(*at), i)));
        self.order.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for &(_, i) in &self.order {
            let style = length(&marks.dot_styles);
            marks.dots.push(Dot { at: self.points_at + 3 * i, style });
            marks.dot_styles.push(point_style(self.points[i as usize].id, highlight, theme));
        }
    }
}

fn curve_style(curve: &CurveSpan, highlight: &Highlight, theme: &Theme) -> Style {
    let (fill, half_width) = match curve.role {
        CurveRole::Boundary => (theme.boundary, BOUNDARY),
        CurveRole::Free | CurveRole::Inner => (theme.curve, CURVE),
    };
    let is_hovered = matches!(highlight.hover, Some(Hit::Curve { id, .. }) if id == curve.id);
    let is_selected = highlight.selected_curve == Some(curve.id);
    Style {
        fill,
        outline: theme.selected,
        half_width: half_width + if is_hovered { THICKER } else { 0.0 },
        outline_width: if is_selected { SELECTED } else { 0.0 },
        hidden: if is_hovered || is_selected { 2.0 * HIDDEN_CURVE } else { HIDDEN_CURVE },
        flags: 0,
    }
}

/// The lines of control nets: thin, and behind what they control.
fn net_style(theme: &Theme) -> Style {
    Style {
        fill: theme.net,
        outline: theme.selected,
        half_width: NET,
        outline_width: 0.0,
        hidden: HIDDEN_CURVE,
        flags: 0,
    }
}

fn point_style(id: PointId, highlight: &Highlight, theme: &Theme) -> Style {
    let is_held = highlight.held == Some(id);
    let is_hovered = is_held || matches!(highlight.hover, Some(Hit::Point { id: over, .. }) if over == id);
    let is_selected = is_held || highlight.selected.contains(&id);
    let (outline, outline_width) = if is_selected { (theme.selected, SELECTED) } else { (theme.halo, HALO) };
    Style {
        fill: theme.point,
        outline,
        half_width: POINT + if is_hovered { THICKER } else { 0.0 },
        outline_width,
        hidden: if is_hovered || is_selected { 2.0 * HIDDEN_POINT } else { HIDDEN_POINT },
        flags: 0,
    }
}

/// Adds what pointer and tools mark: the ring, points and lines to be.
pub(crate) fn add_highlight(marks: &mut Marks, camera: &Camera, highlight: &Highlight, theme: &Theme) {
    match highlight.hover {
        Some(Hit::Surface { at, normal, .. }) => add_ring(marks, camera, at, normal, theme),
        Some(Hit::Curve { at, .. }) => marks.add_dot(at, ghost(theme)),
        Some(Hit::Point { .. } | Hit::Edge { .. } | Hit::Face { .. }) | None => {}
    }
    for (at, way) in &highlight.directions {
        add_direction(marks, camera, *at, *way, theme);
    }
    if highlight.ghost_line.len() > 1 {
        let fill = theme.curve.with_w(0.75);
        let style = Style { fill, half_width: CURVE, hidden: 0.5, ..Style::default() };
        marks.add_polyline(highlight.ghost_line.iter().copied(), false, style);
    }
    for skin in &highlight.skins {
        let colour = if skin.is_refused { theme.boundary } else { theme.accent };
        marks.add_skin(&skin.facets, Style { fill: colour.with_w(SKIN), ..Style::default() });
    }
    for edge in &highlight.edges {
        let (fill, outline, outline_width) = if edge.is_soft {
            (theme.accent, theme.accent.with_w(SKIN), SOFT)
        } else {
            (theme.halo, theme.accent, SHARP)
        };
        let style = Style { fill, outline, outline_width, half_width: CURVE, hidden: 0.5, flags: 0 };
        marks.add_polyline(edge.places.iter().copied(), edge.closed, style);
    }
    for line in &highlight.sketch {
        let fill = theme.accent.with_w(0.8);
        let style = Style { fill, half_width: SKETCH, hidden: 0.35, ..Style::default() };
        marks.add_polyline(line.iter().copied(), false, style);
    }
    for part in &highlight.parts {
        let (fill, half_width) =
            if part.is_selected { (theme.selected, NET_SELECTED) } else { (theme.accent, CURVE) };
        let style = Style { fill, half_width, hidden: 0.6, ..Style::default() };
        marks.add_polyline(part.places.iter().copied(), part.places.len() > 2, style);
    }
    for rim in &highlight.rims {
        let style = Style {
            fill: theme.boundary,
            outline: theme.boundary.with_w(0.35),
            half_width: BOUNDARY + THICKER,
            outline_width: RIM_GLOW,
            hidden: 2.0 * HIDDEN_CURVE,
            flags: 0,
        };
        marks.add_polyline(rim.iter().copied(), true, style);
    }
    for at in &highlight.ghost {
        marks.add_dot(*at, ghost(theme));
    }
    for strip in &highlight.strips {
        add_strip(marks, strip, theme);
    }
    for (foot, end, is_hovered) in &highlight.arms {
        add_arm(marks, *foot, *end, *is_hovered, theme);
    }
}

/// A tangent strip: its outer edge, and rungs from the curve to it.
fn add_strip(marks: &mut Marks, strip: &Strip, theme: &Theme) {
    let opacity = if strip.is_ghost { 0.5 } else { 1.0 };
    let rung = Style {
        fill: theme.handle.with_w(STRIP_RUNG * opacity),
        half_width: SKETCH,
        hidden: STRIP_HIDDEN,
        ..Style::default()
    };
    for ends in &strip.rungs {
        marks.add_polyline(ends.iter().copied(), false, rung);
    }
    let edge = Style { fill: theme.handle.with_w(STRIP_EDGE * opacity), half_width: CURVE, ..rung };
    marks.add_polyline(strip.rungs.iter().map(|ends| ends[1]), strip.closed, edge);
}

/// A handle: a line from its point, and a dot to take hold of. It is as plain before a surface as behind one.
fn add_arm(marks: &mut Marks, foot: Vec3, end: Vec3, is_hovered: bool, theme: &Theme) {
    let thicker = if is_hovered { THICKER } else { 0.0 };
    let style = Style {
        fill: theme.handle,
        outline: theme.halo,
        half_width: CURVE + thicker,
        outline_width: 0.0,
        hidden: HANDLE_HIDDEN,
        flags: 0,
    };
    marks.add_polyline([foot, end].into_iter(), false, style);
    marks.add_dot(end, Style { half_width: HANDLE + thicker, outline_width: HALO, ..style });
}

/// A prescribed direction: a line of one length on the screen, with a dot at its end.
fn add_direction(marks: &mut Marks, camera: &Camera, at: Vec3, way: Vec3, theme: &Theme) {
    let Some(way) = (way / way.abs().max_element()).try_normalize() else { return };
    let end = at + way * (DIRECTION * camera.unit_per_pixel(at));
    let line = Style {
        fill: theme.handle,
        outline: theme.halo.with_w(0.6),
        half_width: CURVE,
        outline_width: 1.0,
        hidden: 0.5,
        flags: 0,
    };
    marks.add_polyline([at, end].into_iter(), false, line);
    marks.add_dot(end, Style { half_width: 2.4, ..line });
}

/// A point that is not there yet.
fn ghost(theme: &Theme) -> Style {
    Style {
        fill: theme.point.with_w(0.55),
        outline: theme.halo,
        half_width: POINT - 0.6,
        outline_width: HALO,
        hidden: 0.6,
        flags: 0,
    }
}

/// A small ring that lies on the surface, with a dot in its middle.
fn add_ring(marks: &mut Marks, camera: &Camera, at: Vec3, normal: Vec3, theme: &Theme) {
    let (u, v) = normal.try_normalize().unwrap_or(-camera.forward()).any_orthonormal_pair();
    let radius = RING * camera.unit_per_pixel(at);
    let place = |corner: u8| {
        let (s, c) = (TAU * f32::from(corner) / f32::from(RING_CORNERS)).sin_cos();
        at + (u * c + v * s) * radius
    };
    let ring = Style {
        fill: theme.accent,
        outline: theme.halo.with_w(0.6),
        half_width: 1.0,
        outline_width: 1.0,
        hidden: 0.3,
        flags: 0,
    };
    marks.add_polyline((0..RING_CORNERS).map(place), true, ring);
    let dot = Style { fill: theme.accent, half_width: 1.6, outline_width: 0.9, ..ring };
    marks.add_dot(at, Style { outline: Vec4::new(1.0, 1.0, 1.0, 0.5), ..dot });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::{NetPart, SharpOrSoft, Skin};
    use crate::sample;
    use ductile_spec::CurveId;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn points_are_marked_from_back_to_front() {
        let scene = sample::bumpy_disc(6);
        let camera = Camera::default();
        let (mut skeleton, mut marks) = (Skeleton::default(), Marks::default());
        skeleton.take_structure(&scene, &mut Vec::new());
        skeleton.take_frame(&scene);
        skeleton.mark(&mut marks, &camera, &Highlight::default(), &Theme::new(false));
        let depths: Vec<f32> = marks
            .dots
            .iter()
            .map(|dot| {
                let at = dot.at as usize;
                camera.depth(Vec3::from_slice(&scene.floats[at..at + 3]))
            })
            .collect();
        assert_eq!(depths.len(), scene.structure.points.len());
        assert!(depths.is_sorted_by(|a, b| a >= b));
    }

    #[test]
    fn segments_stand_on_the_samples() {
        let scene = sample::bumpy_disc(6);
        let mut segments = Vec::new();
        Skeleton::default().take_structure(&scene, &mut segments);
        let [boundary, inner] = [scene.structure.curves[0], scene.structure.curves[1]];
        assert_eq!(length(&segments), boundary.count + inner.count - 1);
        let at = segments[0].start as usize;
        let first = scene.samples(boundary.id).next().unwrap();
        assert_eq!(Vec3::from_slice(&scene.floats[at..at + 3]), first);
        assert!(segments.iter().all(|s| (s.after as usize) < scene.structure.points_at()));
    }

    #[test]
    fn hover_thickens_and_selection_outlines() {
        let theme = Theme::new(false);
        let scene = sample::bumpy_disc(6);
        let curve = &scene.structure.curves[0];
        let plain = curve_style(curve, &Highlight::default(), &theme);
        let hover = Some(Hit::Curve { id: curve.id, at: Vec3::ZERO });
        let marked = Highlight { hover, selected_curve: Some(CurveId(1)), ..Highlight::default() };
        let style = curve_style(curve, &marked, &theme);
        assert!(style.half_width > plain.half_width && style.outline_width > plain.outline_width);
        let held = Highlight { held: Some(PointId(3)), ..Highlight::default() };
        assert_eq!(point_style(PointId(3), &held, &theme).outline, theme.selected);
        assert_eq!(point_style(PointId(2), &held, &theme).outline, theme.halo);
    }

    #[test]
    fn a_face_of_a_cage_is_a_closed_line_and_an_edge_an_open_one() {
        let (mut marks, camera, theme) = (Marks::default(), Camera::default(), Theme::new(false));
        let face = NetPart { places: vec![Vec3::ZERO, Vec3::X, Vec3::Y], is_selected: true };
        let edge = NetPart { places: vec![Vec3::ZERO, Vec3::Z], is_selected: false };
        let highlight = Highlight { parts: vec![face, edge], ..Highlight::default() };
        add_highlight(&mut marks, &camera, &highlight, &theme);
        assert_eq!(marks.segments.len(), 3 + 1);
        let [selected, hovered] = [marks.curve_styles[0], marks.curve_styles[1]];
        assert_eq!((selected.fill, hovered.fill), (theme.selected, theme.accent));
    }

    #[test]
    fn a_handle_is_a_green_line_with_a_dot_at_its_end() {
        let (mut marks, camera, theme) = (Marks::default(), Camera::default(), Theme::new(false));
        let arms = vec![(Vec3::ZERO, Vec3::X, false), (Vec3::ZERO, Vec3::Y, true)];
        add_highlight(&mut marks, &camera, &Highlight { arms, ..Highlight::default() }, &theme);
        assert_eq!((marks.segments.len(), marks.dots.len()), (2, 2));
        let at = marks.dots[1].at as usize;
        assert_eq!(Vec3::from_slice(&marks.floats[at..at + 3]), Vec3::Y);
        let [plain, hovered] = [marks.dot_styles[0], marks.dot_styles[1]];
        assert!(plain.fill == theme.handle && hovered.half_width > plain.half_width);
    }

    #[test]
    fn a_strip_has_a_rung_at_every_sample_and_an_edge_and_a_ghost_is_fainter() {
        let theme = Theme::new(false);
        let rungs = vec![[Vec3::ZERO, Vec3::Z], [Vec3::X, Vec3::X + Vec3::Z], [Vec3::Y, Vec3::Y + Vec3::Z]];
        let strip = Strip { rungs, closed: true, is_ghost: false };
        let edges = [false, true].map(|is_ghost| {
            let mut marks = Marks::default();
            add_strip(&mut marks, &Strip { is_ghost, ..strip.clone() }, &theme);
            assert_eq!(marks.segments.len(), 3 + 3);
            marks.curve_styles[3].fill
        });
        assert_eq!(edges[0].truncate(), theme.handle.truncate());
        assert!(edges[1].w < edges[0].w);
    }

    #[test]
    fn a_skin_is_translucent_and_vermilion_where_it_would_be_refused() {
        let (mut marks, camera, theme) = (Marks::default(), Camera::default(), Theme::new(false));
        let facets = vec![[Vec3::ZERO, Vec3::X, Vec3::Y], [Vec3::X, Vec3::Y, Vec3::Z]];
        let skins = [false, true].map(|is_refused| Skin { facets: facets.clone(), is_refused }).to_vec();
        let edge = |is_soft| SharpOrSoft { places: vec![Vec3::ZERO, Vec3::X], closed: false, is_soft };
        let edges = [false, true].map(edge).to_vec();
        add_highlight(&mut marks, &camera, &Highlight { skins, edges, ..Highlight::default() }, &theme);
        assert_eq!((marks.skins.len(), marks.segments.len()), (12, 2));
        let fills = [0, 6].map(|k| marks.curve_styles[marks.skins[k].style as usize].fill);
        assert_eq!(fills, [theme.accent, theme.boundary].map(|colour| colour.with_w(SKIN)));
        let at = marks.skins[11].at as usize;
        assert_eq!(Vec3::from_slice(&marks.floats[at..at + 3]), Vec3::Z);
        let [sharp, soft] = [marks.curve_styles[2], marks.curve_styles[3]];
        assert!(soft.outline_width > sharp.outline_width && soft.outline.w < sharp.outline.w);
    }

    #[test]
    fn rims_are_closed_and_vermilion_and_what_would_be_made_is_thinner() {
        let (mut marks, camera, theme) = (Marks::default(), Camera::default(), Theme::new(false));
        let rims = vec![vec![Vec3::ZERO, Vec3::X, Vec3::Y]];
        let sketch = vec![vec![Vec3::ZERO, Vec3::Z]];
        add_highlight(&mut marks, &camera, &Highlight { rims, sketch, ..Highlight::default() }, &theme);
        assert_eq!(marks.segments.len(), 1 + 3);
        let [line, rim] = [marks.curve_styles[0], marks.curve_styles[1]];
        assert!(rim.fill == theme.boundary && rim.half_width > line.half_width);
    }

    #[test]
    fn a_prescribed_direction_has_one_length_on_the_screen_however_long_it_is() {
        let camera = Camera::default();
        for length in [1e-7, 1.0, 1e6] {
            let mut marks = Marks::default();
            let way = Vec3::new(0.0, 0.6, 0.8);
            let directions = vec![(Vec3::X, way * length), (Vec3::Y, Vec3::ZERO)];
            let highlight = Highlight { directions, ..Highlight::default() };
            add_highlight(&mut marks, &camera, &highlight, &Theme::new(true));
            assert_eq!((marks.segments.len(), marks.dots.len()), (1, 1), "none where there is no direction");
            let end = Vec3::from_slice(&marks.floats[3..6]);
            let wanted = Vec3::X + way * (DIRECTION * camera.unit_per_pixel(Vec3::X));
            assert!(end.distance(wanted) < 1e-5, "{end}");
        }
    }

    #[test]
    fn the_ring_lies_in_the_tangent_plane() {
        let (mut marks, camera) = (Marks::default(), Camera::default());
        let normal = Vec3::new(1.0, 2.0, 2.0) / 3.0;
        let hit = Hit::Surface { id: ductile_spec::SurfaceId(1), at: Vec3::splat(0.1), normal, triangle: 0 };
        let highlight = Highlight { hover: Some(hit), ..Highlight::default() };
        add_highlight(&mut marks, &camera, &highlight, &Theme::new(false));
        assert_eq!(marks.segments.len(), usize::from(RING_CORNERS));
        let radius = RING * camera.unit_per_pixel(Vec3::splat(0.1));
        for at in marks.floats.chunks_exact(3).take(usize::from(RING_CORNERS)) {
            let offset = Vec3::from_slice(at) - Vec3::splat(0.1);
            assert!(offset.dot(normal).abs() < 1e-5 && (offset.length() - radius).abs() < 1e-5);
        }
    }
}
