//! The tools of surgery, without a page.

use super::*;
use ductile_spec::{
    Border, Curve, CurveRole, Embedding, Extent, JoinRibbon, PointRole, Skeleton, SkeletonVertex, Surface,
    SurfaceSpan, SurfaceSummary,
};
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const SURFACES: [SurfaceId; 2] = [SurfaceId(1), SurfaceId(2)];

/// Two surfaces. Curve 1 is the rim of the first, 2 runs inside it, 3 is free, at 4 both end, 5 is open and free.
fn model() -> (Structure, Document) {
    let curve = |id: u32, role, closed| CurveSpan { id: CurveId(id), first: 0, count: 4, closed, role };
    let span = |id| SurfaceSpan {
        id,
        first_vertex: 0,
        vertex_count: 0,
        first_index: 0,
        index_count: 0,
        kind: ductile_spec::SurfaceKind::Fair,
        summary: SurfaceSummary::default(),
    };
    let structure = Structure {
        version: 1,
        surfaces: SURFACES.map(span).to_vec(),
        curves: vec![
            curve(1, CurveRole::Boundary, true),
            curve(2, CurveRole::Inner, true),
            curve(3, CurveRole::Free, true),
            curve(4, CurveRole::Boundary, true),
            curve(5, CurveRole::Free, false),
        ],
        points: [PointRole::Free, PointRole::Curve]
            .iter()
            .zip(1..)
            .map(|(role, id)| PointEntry { id: PointId(id), role: *role })
            .collect(),
        ..Structure::default()
    };
    let mut document = Document::default();
    let through = vec![PointId(2), PointId(3), PointId(4)];
    for (id, closed) in [(1, true), (2, true), (3, true), (4, true), (5, false)] {
        document.curves.insert(CurveId(id), Curve::new(through.clone(), closed));
    }
    // A square of two triangles: its diagonal is inside, its sides are not.
    let embedding = |curve, along: &[u32]| Embedding { curve: CurveId(curve), along: along.to_vec() };
    let skeleton = |curves| Skeleton {
        vertices: vec![SkeletonVertex::Free(DVec3::ZERO); 4],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        curves,
    };
    let first = skeleton(vec![embedding(1, &[0, 1]), embedding(2, &[0, 2]), embedding(4, &[2, 3])]);
    document.surfaces.insert(SURFACES[0], Surface::new(first));
    document.surfaces.insert(SURFACES[1], Surface::new(skeleton(vec![embedding(4, &[1, 2])])));
    (structure, document)
}

/// Clicks with a tool; the surface is the first one.
fn click(tools: &mut Toolbox, hit: Option<Hit>) -> Vec<Act> {
    let surface = match hit {
        Some(Hit::Surface { id, .. }) => Some(id),
        Some(_) => Some(SURFACES[0]),
        None => None,
    };
    let rim = Place::of(hit.as_ref()).map(|place| Place { normal: None, ..place });
    aimed(tools, Aim { hit: hit.as_ref(), surface, rim, ..Aim::default() })
}

fn aimed(tools: &mut Toolbox, aim: Aim<'_>) -> Vec<Act> {
    let (structure, document) = model();
    let around = Surroundings {
        structure: &structure,
        document: &document,
        forward: Vec3::NEG_Z,
        radius: 0.25,
        size: 0.5,
    };
    tools.click(aim, around)
}

fn key(tools: &mut Toolbox, key: ToolKey) -> Vec<Act> {
    let (structure, document) = model();
    tools.key(
        key,
        Surroundings {
            structure: &structure,
            document: &document,
            forward: Vec3::NEG_Z,
            radius: 0.25,
            size: 0.5,
        },
    )
}

fn on(surface: u32, x: f32) -> Option<Hit> {
    let at = Vec3::new(x, 0.0, 0.0);
    Some(Hit::Surface { id: SurfaceId(surface), at, normal: Vec3::Z, triangle: 0 })
}

fn curve(id: u32) -> Option<Hit> {
    Some(Hit::Curve { id: CurveId(id), at: Vec3::Y })
}

fn place(surface: u32, x: f64) -> On {
    On { surface: SurfaceId(surface), at: DVec3::X * x }
}

fn with(kind: ToolKind) -> Toolbox {
    let mut tools = Toolbox::default();
    tools.choose(kind);
    tools
}

fn refuses(acts: &[Act]) -> bool {
    matches!(acts, [Act::Say(_)])
}

#[test]
fn a_curve_is_drawn_on_one_surface_and_closed_at_its_beginning() {
    let mut tools = with(ToolKind::Draw);
    assert!(refuses(&click(&mut tools, None)), "beside every surface there is nothing to draw on");
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    for at in corners {
        let hit = Hit::Surface { id: SURFACES[0], at, normal: Vec3::Z, triangle: 0 };
        assert!(click(&mut tools, Some(hit)).is_empty());
    }
    assert!(refuses(&click(&mut tools, on(2, 5.0))), "another surface");
    assert_eq!((tools.canvas(), tools.corners().len()), (Some(SURFACES[0]), 3));
    let acts = aimed(&mut tools, Aim { corner: Some(0), ..Aim::default() });
    let along = corners.map(|at| at.as_dvec3()).to_vec();
    assert_eq!(acts, [Act::Edit(Edit::SLoop { surface: SURFACES[0], along, closed: true })]);
    assert!(tools.kind() == ToolKind::Draw && !tools.is_under_way(), "the tool stays");
}

#[test]
fn a_drawn_curve_may_begin_on_a_curve_and_ends_by_enter() {
    let mut tools = with(ToolKind::Draw);
    click(&mut tools, curve(1));
    assert_eq!(key(&mut tools, ToolKey::Back), []);
    assert!(!tools.is_under_way());
    click(&mut tools, curve(1));
    click(&mut tools, on(1, 2.0));
    let along = vec![DVec3::Y, DVec3::X * 2.0];
    let edit = Edit::SLoop { surface: SURFACES[0], along, closed: false };
    assert_eq!(key(&mut tools, ToolKey::Done), [Act::Edit(edit)]);
    click(&mut tools, on(1, 2.0));
    assert_eq!(key(&mut tools, ToolKey::Escape), [], "the first gives up");
    assert_eq!(key(&mut tools, ToolKey::Escape), [Act::Leave], "the second leaves");
}

#[test]
fn a_region_is_burnt_out_where_it_was_clicked() {
    let mut tools = with(ToolKind::Burnout);
    assert_eq!(click(&mut tools, on(1, 3.0)), [Act::Edit(Edit::Burnout { region: place(1, 3.0) })]);
    assert!(refuses(&click(&mut tools, None)));
}

#[test]
fn crease_takes_curves_and_regions_and_smooths_what_is_creased() {
    let mut tools = with(ToolKind::Crease);
    let crease = |border| [Act::Edit(Edit::Crease { border })];
    assert_eq!(click(&mut tools, curve(2)), crease(Border::Curve(CurveId(2))));
    assert_eq!(click(&mut tools, curve(4)), [Act::Edit(Edit::Smooth { curve: CurveId(4) })]);
    assert_eq!(click(&mut tools, on(1, 1.0)), crease(Border::Region(place(1, 1.0))));
    for nothing in [curve(1), curve(3), None] {
        assert!(refuses(&click(&mut tools, nothing)));
    }
    let (_, document) = model();
    let shown = [1, 2, 3, 4].map(|id| would_smooth(&document, CurveId(id)));
    assert_eq!(shown, [None, Some(false), None, Some(true)], "what is shown before the click");
}

#[test]
fn split_takes_curves_inside_and_regions() {
    let mut tools = with(ToolKind::Split);
    let split = |border| [Act::Edit(Edit::Split { border })];
    assert_eq!(click(&mut tools, curve(2)), split(Border::Curve(CurveId(2))));
    assert_eq!(click(&mut tools, curve(4)), split(Border::Curve(CurveId(4))));
    assert_eq!(click(&mut tools, on(2, 1.0)), split(Border::Region(place(2, 1.0))));
    for nothing in [curve(1), curve(3), None] {
        assert!(refuses(&click(&mut tools, nothing)));
    }
}

#[test]
fn a_sweep_joins_curves_of_one_kind_and_forgets_its_turn() {
    let mut tools = with(ToolKind::Sweep);
    click(&mut tools, curve(1));
    assert!(refuses(&click(&mut tools, curve(5))), "closed and open");
    tools.options_mut().turn(Toggle::Reversed);
    let edit = Edit::Sweep { from: CurveId(1), to: CurveId(3), stretches: [None; 2], reversed: true };
    assert_eq!(click(&mut tools, curve(3)), [Act::Edit(edit)]);
    assert!(!tools.options().reversed, "the next one is not turned round");
    click(&mut tools, curve(1));
    assert!(tools.is_under_way());
    key(&mut tools, ToolKey::Escape);
    assert!(!tools.is_under_way());
}

#[test]
fn glue_wants_two_rims_and_keeps_the_choice_of_a_band() {
    let mut tools = with(ToolKind::Glue);
    assert!(refuses(&click(&mut tools, None)));
    for skirt in [true, false] {
        assert!(click(&mut tools, on(1, 0.0)).is_empty());
        if !skirt {
            tools.options_mut().turn(Toggle::Skirt);
        }
        let edit = Edit::Glue { from: place(1, 0.0), to: place(2, 1.0), skirt, reversed: false };
        assert_eq!(click(&mut tools, on(2, 1.0)), [Act::Edit(edit)]);
    }
    tools.choose(ToolKind::Shape);
    tools.choose(ToolKind::Glue);
    assert!(!tools.options().skirt);
}

#[test]
fn a_tube_has_the_radius_that_suits_or_that_was_chosen() {
    let mut tools = with(ToolKind::Merge);
    for (radius, chosen) in [(0.25, None), (0.7, Some(0.7))] {
        tools.options_mut().radius = chosen;
        assert!(click(&mut tools, on(1, 0.0)).is_empty());
        assert!(refuses(&click(&mut tools, on(1, 0.0))), "it needs some length");
        assert!(refuses(&click(&mut tools, None)));
        let edit = Edit::Merge { from: place(1, 0.0), to: place(1, 4.0), radius, keep: true };
        assert_eq!(click(&mut tools, on(1, 4.0)), [Act::Edit(edit)], "a handle of one surface");
    }
    let [from, to] = [on(1, 0.0), on(2, 1.0)].map(|hit| Place::of(hit.as_ref()).unwrap());
    tools.options_mut().turn(Toggle::Keep);
    let edit = Edit::Merge { from: place(1, 0.0), to: place(2, 1.0), radius: 0.7, keep: false };
    tools.propose([from, to]);
    assert_eq!(key(&mut tools, ToolKey::Done), [Act::Edit(edit.clone())]);
    assert!(!tools.is_under_way() && key(&mut tools, ToolKey::Done).is_empty(), "once is enough");
    tools.propose([from, to]);
    assert_eq!(click(&mut tools, None), [Act::Edit(edit)], "what is shown is what a click makes");
}

#[test]
fn a_tube_that_was_proposed_is_given_up_first_and_then_the_place_that_was_picked() {
    let mut tools = with(ToolKind::Merge);
    click(&mut tools, on(1, 0.0));
    let [from, to] = [on(1, 2.0), on(2, 1.0)].map(|hit| Place::of(hit.as_ref()).unwrap());
    tools.propose([from, to]);
    assert!(tools.first_place() == Some(from) && tools.hint().contains("Enter or a click"));
    assert_eq!(key(&mut tools, ToolKey::Escape), []);
    assert_eq!((tools.proposed(), tools.first_place().map(|place| place.at)), (None, Some(Vec3::ZERO)));
    assert_eq!(key(&mut tools, ToolKey::Escape), []);
    assert!(!tools.is_under_way());
    tools.propose([from, to]);
    tools.refresh(&Scene::default());
    assert!(!tools.is_under_way(), "its surfaces are gone");
}

#[test]
fn trim_wants_two_surfaces() {
    let mut tools = with(ToolKind::Trim);
    click(&mut tools, on(1, 0.0));
    assert!(refuses(&click(&mut tools, on(1, 2.0))));
    tools.options_mut().turn(Toggle::Smooth);
    let edit = Edit::Trim { first: place(1, 0.0), second: place(2, 3.0), smooth: true, ribbon: None };
    assert_eq!(click(&mut tools, on(2, 3.0)), [Act::Edit(edit)]);
}

#[test]
fn a_sweep_takes_stretches_between_control_points() {
    let mut tools = with(ToolKind::Sweep);
    let point = |id| Some(Hit::Point { id: PointId(id), at: Vec3::ZERO });
    assert_eq!(click(&mut tools, point(3)), []);
    assert!(tools.is_under_way() && tools.stretch_from() == Some(PointId(3)));
    assert_eq!(click(&mut tools, point(2)), []);
    assert_eq!(tools.first(), Some(Pick::Stretch(CurveId(1), [PointId(3), PointId(2)])));
    assert!(refuses(&click(&mut tools, curve(1))), "a closed curve and a stretch");
    click(&mut tools, point(3));
    assert!(refuses(&click(&mut tools, point(9))), "no curve runs through both");
    assert_eq!(tools.stretch_from(), None, "the stretch begins anew");
    let stretches = [Some([PointId(3), PointId(2)]), None];
    let edit = Edit::Sweep { from: CurveId(1), to: CurveId(5), stretches, reversed: false };
    assert_eq!(click(&mut tools, curve(5)), [Act::Edit(edit)]);
    click(&mut tools, point(3));
    key(&mut tools, ToolKey::Escape);
    assert!(!tools.is_under_way());
}

#[test]
fn a_curve_is_embedded_in_the_surface_that_is_clicked_next() {
    let mut tools = with(ToolKind::Embed);
    assert!(refuses(&click(&mut tools, on(1, 0.0))));
    assert_eq!(click(&mut tools, curve(3)), []);
    assert!(refuses(&click(&mut tools, None)));
    let edit = Edit::Embed { curve: CurveId(3), surface: SurfaceId(2) };
    assert_eq!(click(&mut tools, on(2, 0.0)), [Act::Edit(edit)]);
    assert!(!tools.is_under_way());
    assert_eq!(ToolKind::of_key("i"), Some(ToolKind::Embed));
}

#[test]
fn a_trim_has_a_ribbon_with_an_angle_where_it_is_no_smooth_one() {
    let mut options = Options { angle: Some(90.0), ..Options::default() };
    assert_eq!(options.join_ribbon(), None);
    options.turn(Toggle::of_key(ToolKind::Trim, "r").unwrap());
    assert_eq!(options.join_ribbon(), Some(JoinRibbon::Angle(core::f64::consts::FRAC_PI_2)));
    options.turn(Toggle::Smooth);
    assert_eq!(options.join_ribbon(), Some(JoinRibbon::AsMet));
    assert_eq!(Toggle::of_key(ToolKind::Sweep, "r"), Some(Toggle::Reversed));
}

#[test]
fn a_size_is_taken_from_another_closed_curve_and_the_tool_is_left() {
    let mut tools = Toolbox::default();
    tools.choose_match(CurveId(1));
    for wrong in [curve(1), curve(5), None] {
        assert!(refuses(&click(&mut tools, wrong)));
    }
    let edit = Edit::Expand { curve: CurveId(1), to: Extent::Like(CurveId(3)) };
    assert_eq!(click(&mut tools, curve(3)), [Act::Edit(edit), Act::Leave]);
    for left in [ToolKey::Escape, ToolKey::Back] {
        assert_eq!(key(&mut tools, left), [Act::Leave]);
    }
}

#[test]
fn what_is_marked_is_what_a_click_would_take() {
    let (structure, _) = model();
    let takes = |kind: ToolKind, hit: Option<Hit>| kind.takes(&hit.unwrap(), &structure);
    let point = |id| Some(Hit::Point { id: PointId(id), at: Vec3::ZERO });
    assert!(takes(ToolKind::Crease, curve(2)) && !takes(ToolKind::Crease, curve(3)));
    assert!(takes(ToolKind::Sheet, curve(5)) && !takes(ToolKind::Sheet, on(1, 0.0)));
    assert!(takes(ToolKind::Match, curve(3)) && !takes(ToolKind::Match, curve(5)));
    assert!(takes(ToolKind::Draw, point(2)) && !takes(ToolKind::Draw, point(1)));
    assert!(takes(ToolKind::Burnout, on(1, 0.0)) && !takes(ToolKind::Burnout, curve(2)));
}

#[test]
fn letters_turn_the_choices_of_the_tool_in_hand_only() {
    assert_eq!(Toggle::of_key(ToolKind::Glue, "s"), Some(Toggle::Skirt));
    assert_eq!(Toggle::of_key(ToolKind::Trim, "s"), Some(Toggle::Smooth));
    assert_eq!(Toggle::of_key(ToolKind::Sweep, "s"), None, "S is the Sheet there");
    assert_eq!(Toggle::of_key(ToolKind::Merge, "k"), Some(Toggle::Keep));
    assert_eq!(Toggle::of_key(ToolKind::Shape, "r"), None);
}

#[test]
fn what_the_model_no_longer_has_is_forgotten() {
    let mut tools = with(ToolKind::Merge);
    click(&mut tools, on(1, 0.0));
    tools.refresh(&Scene::default());
    assert_eq!(tools.first(), None);
    let mut tools = with(ToolKind::Draw);
    click(&mut tools, on(1, 0.0));
    tools.refresh(&Scene::default());
    assert!(tools.corners().is_empty());
    tools.choose_match(CurveId(1));
    tools.refresh(&Scene::default());
    assert_eq!(tools.kind(), ToolKind::Shape);
}

#[test]
fn a_shadow_wants_a_region_and_then_another_surface() {
    let (structure, document) = model();
    let around = Surroundings {
        structure: &structure,
        document: &document,
        forward: -Vec3::Z,
        radius: 0.1,
        size: 1.0,
    };
    let hit = |id, x| Hit::Surface { id: SurfaceId(id), at: Vec3::X * x, normal: Vec3::Z, triangle: 0 };
    let mut tools = Toolbox::default();
    tools.choose(ToolKind::Shadow);
    let mut click = |hit: Option<&Hit>| tools.click(Aim { hit, ..Aim::default() }, around);
    assert!(matches!(&click(None)[..], [Act::Say(_)]));
    assert_eq!(click(Some(&hit(1, 0.5))), []);
    assert!(matches!(&click(Some(&hit(1, 0.7)))[..], [Act::Say(_)]), "no surface shadows itself");
    let region = On { surface: SurfaceId(1), at: DVec3::X * 0.5 };
    let edit = Edit::Shadow { region, of: Some(SurfaceId(2)), strength: 1.0, turn: None };
    assert_eq!(click(Some(&hit(2, 3.0))), [Act::Edit(edit)]);
    assert_eq!(tools.first(), None, "it begins anew");
    assert!(!ToolKind::Shadow.takes(&Hit::Curve { id: CurveId(1), at: Vec3::ZERO }, &structure));
}
