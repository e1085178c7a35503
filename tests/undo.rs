//! Every act there is, each done on a model that suits it, undone and done again: the documents are the same to the letter, and
//! so are the shapes that undo gives back. `Round` checks that after each act; at the end all of a sequence is
//! taken back and done again.
//!
//! A new kind of act neither compiles without a name below nor passes without a sequence that has it.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::round::Round;
use acceptance::shapes;
use ductile_spec::{
    Blending, Border, CageForm, CageSettings, CageSource, CurveId, Density, Displacement, Document, Edit,
    Extent, FillStyle, FixedMesh, Hold, Hole, Leave, MeshSource, Objective, ObjectiveOf, On, PointId,
    Request, SpacingOf, SurfaceId, Through, to_compact_text,
};
use glam::{DVec3, dvec3};
use std::collections::BTreeSet;

/// The word of an act in a script. No arm stands for the rest.
fn word(edit: &Edit) -> &'static str {
    match edit {
        Edit::Point { .. } => "point",
        Edit::Move { .. } => "move",
        Edit::Curve { .. } => "curve",
        Edit::Sheet { .. } => "sheet",
        Edit::Sweep { .. } => "sweep",
        Edit::SLoop { .. } => "s-loop",
        Edit::Embed { .. } => "embed",
        Edit::Burnout { .. } => "burnout",
        Edit::Split { .. } => "split",
        Edit::Crease { .. } => "crease",
        Edit::Smooth { .. } => "smooth",
        Edit::Glue { .. } => "glue",
        Edit::Merge { .. } => "merge",
        Edit::MergeClosest { .. } => "merge-closest",
        Edit::Fill { .. } => "fill",
        Edit::FillNetwork { .. } => "fill-network",
        Edit::Refill { .. } => "refill",
        Edit::Lean { .. } => "lean",
        Edit::Trim { .. } => "trim",
        Edit::Expand { .. } => "expand",
        Edit::Reverse { .. } => "reverse",
        Edit::Propagate { .. } => "propagate",
        Edit::Pin { .. } => "pin",
        Edit::Insert { .. } => "insert",
        Edit::Release { .. } => "release",
        Edit::DeletePoint { .. } => "delete-point",
        Edit::DeleteCurve { .. } => "delete-curve",
        Edit::DeleteSurface { .. } => "delete-surface",
        Edit::Spacing { .. } => "spacing",
        Edit::Density { .. } => "density",
        Edit::Objective { .. } => "objective",
        Edit::Shadow { .. } => "shadow",
        Edit::Tangent { .. } => "tangent",
        Edit::Normal { .. } => "normal",
        Edit::Ribbon { .. } => "ribbon",
        Edit::Displace { .. } => "displace",
        Edit::ChangeDisplacement { .. } => "change-displacement",
        Edit::AddFoot { .. } => "add-foot",
        Edit::EraseDisplacement { .. } => "erase-displacement",
        Edit::DropDisplacements { .. } => "drop-displacements",
        Edit::Blending { .. } => "blending",
        Edit::Mesh { .. } => "mesh",
        Edit::Bake { .. } => "bake",
        Edit::Cage { .. } => "cage",
        Edit::CageSettings { .. } => "cage-settings",
        Edit::Extrude { .. } => "extrude",
        Edit::Rim { .. } => "rim",
        Edit::DeleteFace { .. } => "delete-face",
        Edit::SplitEdge { .. } => "split-edge",
        Edit::SplitFace { .. } => "split-face",
        Edit::Shift { .. } => "shift",
        Edit::Rename { .. } => "rename",
    }
}

/// The words of all acts: those that a reader of scripts would have expected in place of one that is none.
fn words() -> BTreeSet<String> {
    let why = serde_json::from_str::<Edit>(r#"{"no-such-act": {}}"#).unwrap_err().to_string();
    let (_, all) = why.split_once("expected one of").unwrap();
    let words = all.split('`').skip(1).step_by(2);
    words.map(str::to_owned).collect()
}

const ONE: SurfaceId = SurfaceId(1);
const TWO: SurfaceId = SurfaceId(2);

fn on(surface: SurfaceId, at: DVec3) -> On {
    On { surface, at }
}

fn square(radius: f64, z: f64) -> [DVec3; 4] {
    [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|side| side * radius + DVec3::Z * z)
}

fn curve(through: impl IntoIterator<Item = DVec3>, closed: bool) -> Edit {
    Edit::Curve { through: through.into_iter().map(Through::Place).collect(), closed }
}

/// A disc over the unit circle and all that can be done to it.
fn on_a_disc() -> Vec<Edit> {
    let ring = square(0.5, 0.0).to_vec();
    vec![
        Edit::Point { at: dvec3(3.0, 0.0, 0.0) },
        curve(square(1.0, 0.0), true),
        Edit::Sheet { boundary: CurveId(1) },
        Edit::Pin { surface: ONE, at: dvec3(0.1, 0.1, 0.0) },
        Edit::Move { point: PointId(6), to: dvec3(0.1, 0.1, 0.2) },
        Edit::Shift { points: vec![PointId(2), PointId(6)], by: dvec3(0.05, 0.0, 0.1) },
        Edit::Insert { curve: CurveId(1), at: dvec3(0.7, 0.7, 0.0) },
        Edit::Tangent { curve: CurveId(1), point: PointId(2), direction: Some(dvec3(0.2, 1.0, 0.3)) },
        Edit::Normal { surface: ONE, point: PointId(6), normal: Some(dvec3(0.3, 0.0, 1.0)) },
        Edit::Ribbon { surface: ONE, curve: CurveId(1), leave: Some(Leave::Angle(0.4)) },
        Edit::Spacing { of: SpacingOf::Surface(ONE), spacing: Some(0.28) },
        Edit::Density { of: Some(ONE), density: Some(Density::Curvature) },
        Edit::Objective { of: ObjectiveOf::Document, objective: Some(Objective::Fair) },
        Edit::Release { point: PointId(6) },
        Edit::SLoop { surface: ONE, along: ring, closed: true },
        Edit::Expand { curve: CurveId(2), to: Extent::Radius(0.4) },
        Edit::Crease { border: Border::Curve(CurveId(2)) },
        Edit::Reverse { surface: TWO },
        Edit::Propagate { surface: ONE },
        Edit::Smooth { curve: CurveId(2) },
        Edit::Split { border: Border::Curve(CurveId(2)) },
        Edit::DeleteSurface { surface: TWO },
        Edit::DeleteCurve { curve: CurveId(3) },
        Edit::Sheet { boundary: CurveId(2) },
        Edit::Smooth { curve: CurveId(2) },
        Edit::Burnout { region: on(ONE, DVec3::ZERO) },
        Edit::DeletePoint { point: PointId(1) },
        Edit::Rename { name: "Hat".to_owned() },
    ]
}

/// A disc with a curve beside it that it takes up, and displacements.
fn displaced() -> Vec<Edit> {
    let lift = Displacement::new(dvec3(0.2, 0.0, 0.0), DVec3::Z * 0.3);
    vec![
        curve(square(1.0, 0.0), true),
        Edit::Sheet { boundary: CurveId(1) },
        curve([dvec3(-0.4, -0.3, 0.05), dvec3(0.0, -0.4, 0.05), dvec3(0.4, -0.3, 0.05)], false),
        Edit::Embed { curve: CurveId(2), surface: ONE },
        Edit::Displace { surface: ONE, displacement: lift.clone() },
        Edit::ChangeDisplacement {
            surface: ONE,
            number: 1,
            to: Displacement { by: DVec3::Z * 0.2, ..lift.clone() },
        },
        Edit::AddFoot { surface: ONE, number: 1, at: dvec3(-0.3, 0.2, 0.0) },
        Edit::Blending {
            surface: ONE,
            blending: Blending {
                pins: vec![Hold::Around { at: dvec3(0.0, 0.6, 0.0), radius: 0.1 }],
                ..Blending::default()
            },
        },
        Edit::EraseDisplacement { surface: ONE, number: 1 },
        Edit::Displace { surface: ONE, displacement: lift.clone() },
        Edit::DropDisplacements { surface: ONE },
        Edit::Displace { surface: ONE, displacement: lift },
        Edit::Bake { surface: ONE },
    ]
}

/// Three curves with common ends, filled; and a frame of several loops.
fn filled() -> Vec<Edit> {
    let [a, b, c] = [1, 3, 5].map(|id| Through::Point(PointId(id)));
    let place = |x, y, z| Through::Place(dvec3(x, y, z));
    let style = FillStyle { resolution: Some(6), ..FillStyle::default() };
    vec![
        curve([dvec3(0.0, 0.0, 0.0), dvec3(0.5, -0.2, 0.1), dvec3(1.0, 0.0, 0.0)], false),
        Edit::Curve { through: vec![b, place(0.8, 0.5, 0.1), place(0.4, 0.9, 0.2)], closed: false },
        Edit::Curve { through: vec![c, place(0.1, 0.5, 0.2), a], closed: false },
        Edit::Fill { hole: Hole::Near { curve: CurveId(1), at: None }, style },
        Edit::Refill { surface: ONE, style: FillStyle { degree: Some(5), ..style } },
        Edit::Lean { surface: ONE, side: 1, turn: 0.3, strength: 1.5 },
        // Beside it another corner, so that there is one more loop.
        Edit::Curve { through: vec![b, place(1.4, 0.5, 0.0), place(1.2, 1.1, 0.0)], closed: false },
        Edit::Curve { through: vec![Through::Point(PointId(8)), place(0.8, 1.2, 0.1), c], closed: false },
        Edit::FillNetwork { curve: None, style },
    ]
}

/// A cage with a rim.
fn caged() -> Vec<Edit> {
    let vertices = (0..16_u32).map(|k| dvec3(f64::from(k % 4), f64::from(k / 4), 0.0)).collect();
    let face = |k: u32| {
        let corner = k / 3 * 4 + k % 3;
        vec![corner, corner + 1, corner + 5, corner + 4]
    };
    let settings = CageSettings { resolution: Some(3), ..CageSettings::default() };
    let [a, b] = [1, 2].map(PointId);
    vec![
        Edit::Cage { from: CageSource::Given { vertices, faces: (0..9).map(face).collect() } },
        Edit::CageSettings { surface: ONE, settings },
        Edit::Rim { surface: ONE, ends: [a, b], between: None },
        Edit::Extrude { surface: ONE, face: 4, distance: 0.5 },
        Edit::SplitEdge { surface: ONE, ends: [PointId(3), PointId(4)], at: 0.4 },
        Edit::SplitFace { surface: ONE, face: 4, between: None },
        Edit::DeleteFace { surface: ONE, face: 6 },
        Edit::Cage { from: CageSource::BuiltIn { form: CageForm::Torus, centre: DVec3::Z * 4.0, size: 1.0 } },
        Edit::Mesh {
            from: MeshSource::Given(FixedMesh {
                vertices: vec![DVec3::X, DVec3::Y, DVec3::Z, DVec3::ZERO],
                triangles: vec![[0, 1, 2], [0, 2, 3]],
            }),
        },
    ]
}

/// A disc, and another one that stands across it.
fn crossed() -> Vec<Edit> {
    let upright = square(1.5, 0.0).map(|at| dvec3(at.x, 0.05, at.y));
    vec![
        curve(square(1.0, 0.0), true),
        Edit::Sheet { boundary: CurveId(1) },
        curve(upright, true),
        Edit::Sheet { boundary: CurveId(2) },
        Edit::Trim {
            first: on(ONE, dvec3(0.0, 0.6, 0.0)),
            second: on(TWO, dvec3(0.0, 0.05, 1.2)),
            smooth: false,
            ribbon: None,
        },
    ]
}

/// Sequences of acts, each on a document of its own.
fn sequences() -> Vec<(Document, Vec<Edit>)> {
    let empty = || Document { spacing: Some(0.3), ..Document::default() };
    let discs = || Document { spacing: Some(0.3), ..shapes::two_discs() };
    let (low, high) = (on(ONE, DVec3::ZERO), on(TWO, DVec3::Z * 1.2));
    let (rim, other) = (on(ONE, DVec3::X), on(TWO, dvec3(1.0, 0.0, 1.2)));
    let shadow = Edit::Shadow { region: low, of: Some(TWO), strength: 0.5, turn: None };
    vec![
        (empty(), on_a_disc()),
        (empty(), displaced()),
        (empty(), filled()),
        (empty(), caged()),
        (empty(), crossed()),
        (discs(), vec![Edit::Merge { from: low, to: high, radius: 0.3, keep: true }]),
        (discs(), vec![Edit::MergeClosest { first: ONE, second: TWO, radius: 0.3, keep: false }]),
        (discs(), vec![Edit::Glue { from: rim, to: other, skirt: false, reversed: false }]),
        (discs(), vec![Edit::Glue { from: rim, to: other, skirt: true, reversed: false }]),
        (
            discs(),
            vec![
                shadow,
                Edit::Sweep { from: CurveId(1), to: CurveId(2), stretches: [None; 2], reversed: false },
            ],
        ),
    ]
}

#[test]
fn every_act_is_undone_and_done_again_to_the_letter() {
    let mut done = BTreeSet::new();
    for (document, acts) in sequences() {
        let mut round = Round::new(&to_compact_text(&document));
        for edit in &acts {
            let name = word(edit);
            let request = Request::Edit(edit.clone());
            assert_eq!(round.ask(&request), None, "{name}: {edit:?}");
            done.insert(name.to_owned());
            for _ in 0..3 {
                round.bench.step(None);
            }
        }
        round.opens();
        for request in [Request::Undo, Request::Redo] {
            for edit in &acts {
                assert_eq!(round.ask(&request), None, "{request:?} {edit:?}");
            }
            // There is nothing more of it.
            assert!(round.ask(&request).is_some());
        }
    }
    let missing: Vec<String> = words().difference(&done).cloned().collect();
    assert!(missing.is_empty(), "no sequence has {missing:?}");
    assert!(words().len() >= 52 && done.is_subset(&words()), "{:?}", words());
}
