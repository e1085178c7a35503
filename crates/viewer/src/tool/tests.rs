use super::*;
use ductile_spec::{CurveRole, PointRole, Through};
use glam::DVec3;
use std::sync::LazyLock;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn structure() -> Structure {
    let curve = |id, closed| CurveSpan { id: CurveId(id), first: 0, count: 4, closed, role: CurveRole::Free };
    Structure {
        version: 1,
        surfaces: Vec::new(),
        curves: vec![curve(1, true), curve(2, true), curve(3, false)],
        points: [1, 2, 3].map(|id| PointEntry { id: PointId(id), role: PointRole::Curve }).to_vec(),
        ..Structure::default()
    }
}

fn click(tools: &mut Toolbox, aim: Aim<'_>) -> Vec<Act> {
    tools.click(aim, around(&structure()))
}

fn key(tools: &mut Toolbox, key: ToolKey) -> Vec<Act> {
    tools.key(key, around(&structure()))
}

/// A document of which the tools that ask for none see nothing.
static NOTHING: LazyLock<Document> = LazyLock::new(Document::default);

fn around(structure: &Structure) -> Surroundings<'_> {
    Surroundings { structure, document: &NOTHING, forward: Vec3::NEG_Z, radius: 0.25, size: 0.5 }
}

fn on_plane(x: f32) -> Aim<'static> {
    Aim { place: Some(Vec3::new(x, 0.0, 0.0)), ..Aim::default() }
}

fn curve_hit(id: u32) -> Hit {
    Hit::Curve { id: CurveId(id), at: Vec3::ONE }
}

fn point_hit(id: u32) -> Hit {
    Hit::Point { id: PointId(id), at: Vec3::Y }
}

fn with(kind: ToolKind) -> Toolbox {
    let mut tools = Toolbox::default();
    tools.choose(kind);
    tools
}

#[test]
fn new_corners_become_one_act() {
    let mut tools = with(ToolKind::Curve);
    assert!(click(&mut tools, on_plane(0.0)).is_empty());
    assert!(click(&mut tools, on_plane(1.0)).is_empty());
    let through = vec![Through::Place(DVec3::ZERO), Through::Place(DVec3::X)];
    assert_eq!(key(&mut tools, ToolKey::Done), [Act::Edit(Edit::Curve { through, closed: false })]);
    assert_eq!(tools.kind(), ToolKind::Curve, "the tool stays");
    assert!(tools.corners().is_empty());
}

#[test]
fn the_first_corner_closes_a_curve_of_three() {
    let mut tools = with(ToolKind::Curve);
    for x in [0.0, 1.0] {
        click(&mut tools, on_plane(x));
    }
    let first = Aim { corner: Some(0), ..on_plane(0.0) };
    assert!(matches!(click(&mut tools, first)[..], [Act::Say(_)]));
    click(&mut tools, on_plane(2.0));
    assert!(matches!(click(&mut tools, first)[..], [Act::Edit(Edit::Curve { closed: true, .. })]));
}

#[test]
fn points_that_exist_are_taken_over() {
    let mut tools = with(ToolKind::Curve);
    for id in [1, 2, 3] {
        click(&mut tools, Aim { hit: Some(&point_hit(id)), ..Aim::default() });
    }
    let closing = click(&mut tools, Aim { hit: Some(&point_hit(1)), ..Aim::default() });
    let through = [1, 2, 3].map(|id| Through::Point(PointId(id))).to_vec();
    assert_eq!(closing, [Act::Edit(Edit::Curve { through, closed: true })]);
}

#[test]
fn new_corners_among_points_that_exist_become_one_act() {
    let mut tools = with(ToolKind::Curve);
    click(&mut tools, on_plane(5.0));
    click(&mut tools, Aim { hit: Some(&point_hit(2)), ..Aim::default() });
    click(&mut tools, on_plane(6.0));
    let acts = key(&mut tools, ToolKey::Done);
    let place = |x| Through::Place(DVec3::X * x);
    let through = vec![place(5.0), Through::Point(PointId(2)), place(6.0)];
    assert_eq!(acts, [Act::Edit(Edit::Curve { through, closed: false })]);
}

#[test]
fn backspace_takes_the_last_corner_and_escape_all_of_them_before_it_leaves() {
    let mut tools = with(ToolKind::Curve);
    click(&mut tools, on_plane(0.0));
    click(&mut tools, on_plane(1.0));
    assert!(tools.is_under_way());
    key(&mut tools, ToolKey::Back);
    assert_eq!(tools.corners().len(), 1);
    assert!(matches!(key(&mut tools, ToolKey::Done)[..], [Act::Say(_)]));
    assert!(key(&mut tools, ToolKey::Escape).is_empty());
    assert!(!tools.is_under_way());
    assert_eq!(key(&mut tools, ToolKey::Escape), [Act::Leave]);
}

#[test]
fn a_corner_twice_in_the_middle_is_refused_and_the_last_one_again_ends_the_curve() {
    let mut tools = with(ToolKind::Curve);
    for x in [0.0, 1.0, 2.0] {
        click(&mut tools, on_plane(x));
    }
    assert!(matches!(click(&mut tools, Aim { corner: Some(1), ..Aim::default() })[..], [Act::Say(_)]));
    let last = Aim { corner: Some(2), ..Aim::default() };
    assert!(matches!(click(&mut tools, last)[..], [Act::Edit(Edit::Curve { closed: false, .. })]));
}

#[test]
fn a_sheet_wants_a_curve_and_the_modeler_finds_its_loop() {
    let mut tools = with(ToolKind::Sheet);
    let hit = curve_hit(1);
    assert_eq!(
        click(&mut tools, Aim { hit: Some(&hit), ..Aim::default() }),
        [Act::Edit(Edit::Sheet { boundary: CurveId(1) })]
    );
    // An open one may close a loop with others.
    let open = curve_hit(3);
    assert_eq!(
        click(&mut tools, Aim { hit: Some(&open), ..Aim::default() }),
        [Act::Edit(Edit::Sheet { boundary: CurveId(3) })]
    );
    assert!(matches!(click(&mut tools, on_plane(0.0))[..], [Act::Say(_)]));
}

#[test]
fn a_sweep_wants_two_different_curves() {
    let mut tools = with(ToolKind::Sweep);
    let [one, two] = [curve_hit(1), curve_hit(2)];
    assert!(click(&mut tools, Aim { hit: Some(&one), ..Aim::default() }).is_empty());
    assert!(matches!(click(&mut tools, Aim { hit: Some(&one), ..Aim::default() })[..], [Act::Say(_)]));
    let acts = click(&mut tools, Aim { hit: Some(&two), ..Aim::default() });
    assert_eq!(
        acts,
        [Act::Edit(Edit::Sweep { from: CurveId(1), to: CurveId(2), stretches: [None; 2], reversed: false })]
    );
    assert_eq!(tools.sweep_from(), None);
}

#[test]
fn a_point_goes_where_the_click_is() {
    let mut tools = with(ToolKind::Point);
    assert!(matches!(click(&mut tools, on_plane(1.0))[..], [Act::Edit(Edit::Point { .. })]));
    let curve = curve_hit(1);
    let on_curve = click(&mut tools, Aim { hit: Some(&curve), ..Aim::default() });
    assert!(matches!(on_curve[..], [Act::Edit(Edit::Insert { .. })]));
    let point = point_hit(2);
    let on_point = click(&mut tools, Aim { hit: Some(&point), ..Aim::default() });
    assert!(matches!(on_point[..], [Act::Select(Selection::Point(PointId(2))), Act::Say(_)]));
    assert!(matches!(click(&mut tools, Aim::default())[..], [Act::Say(_)]));
}

#[test]
fn walking_goes_round_both_ways() {
    let structure = structure();
    let mut at = Selection::None;
    let mut seen = Vec::new();
    for _ in 0..4 {
        at = at.walk(&structure, false);
        seen.push(at);
    }
    let point = |id| Selection::Point(PointId(id));
    assert_eq!(seen, [point(1), point(2), point(3), point(1)]);
    assert_eq!(at.walk(&structure, true), point(3));
    assert_eq!(Selection::None.walk(&Structure::default(), false), Selection::None);
}

#[test]
fn a_selection_goes_with_its_thing_and_a_used_point_is_released() {
    let structure = structure();
    assert_eq!(Selection::Point(PointId(9)).still_in(&structure), Selection::None);
    assert_eq!(Selection::Curve(CurveId(3)).still_in(&structure), Selection::Curve(CurveId(3)));
    let release = Edit::Release { point: PointId(1) };
    assert_eq!(Selection::Point(PointId(1)).removal(&structure), Some(release));
    assert_eq!(Selection::None.removal(&structure), None);
}

#[test]
fn the_grid_follows_the_size_of_the_model() {
    assert!((grid_step(1.0) - 0.1).abs() < 1e-12);
    assert!((grid_step(100.0) - 10.0).abs() < 1e-9);
    assert!(grid_step(0.01) < 0.01);
    assert!((grid_step(f32::NAN) - 0.1).abs() < 1e-12);
}

#[test]
fn the_ghost_passes_through_every_corner() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::ONE, Vec3::Y];
    for closed in [false, true] {
        let line = ghost_line(&corners, closed);
        assert!(corners.iter().all(|c| line.iter().any(|p| p.distance(*c) < 1e-6)));
        assert_eq!(line[0].distance(line[line.len() - 1]) < 1e-6, closed);
    }
}

#[test]
fn a_closed_curve_runs_counterclockwise_for_the_eye() {
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    let clockwise = [square[0], square[3], square[2], square[1]];
    for corners in [square, clockwise] {
        let mut tools = with(ToolKind::Curve);
        for at in corners {
            click(&mut tools, Aim { place: Some(at), ..Aim::default() });
        }
        let acts = click(&mut tools, Aim { corner: Some(0), ..Aim::default() });
        let through = square.map(|at| Through::Place(at.as_dvec3())).to_vec();
        assert_eq!(acts, [Act::Edit(Edit::Curve { through, closed: true })]);
    }
}
