//! Rims with control points that are glued point on point (thesis section 4.2.2), and sheets in loops of several curves (section
//! 7.3.2). Every act is checked as the storm checks its own: kinds, what follows what, undo and redo to the letter.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::kinds::{Kind, kinds};
use acceptance::round::Round;
use ductile_modeler::Model;
use ductile_spec::{
    Border, CurveId, Document, Edit, On, PointId, Request, SurfaceId, Through, to_compact_text,
};
use glam::{DVec3, dvec3};

fn empty(spacing: f64) -> Round {
    Round::new(&to_compact_text(&Document { spacing: Some(spacing), ..Document::default() }))
}

fn act(round: &mut Round, edit: Edit) {
    assert_eq!(round.ask(&Request::Edit(edit)), None);
}

fn refusal(round: &mut Round, edit: Edit) -> String {
    round.ask(&Request::Edit(edit)).expect("it must be refused")
}

fn all_kinds(round: &Round) -> Vec<Kind> {
    kinds(round.bench.modeler.model()).into_iter().map(|(_, kind)| kind).collect()
}

fn curve(round: &mut Round, through: Vec<Through>, closed: bool) -> CurveId {
    act(round, Edit::Curve { through, closed });
    *round.bench.document().curves.keys().next_back().unwrap()
}

/// Places on a circle about an upright axis, at angles in degrees.
fn circle(radius: f64, z: f64, angles: &[f64]) -> Vec<DVec3> {
    let at = |angle: &f64| {
        let (sin, cos) = libm::sincos(angle.to_radians());
        dvec3(radius * cos, radius * sin, z)
    };
    angles.iter().map(at).collect()
}

fn places(at: &[DVec3]) -> Vec<Through> {
    at.iter().copied().map(Through::Place).collect()
}

/// Edges of a closed curve from each of its control points to the next.
fn stretches(model: &Model, id: CurveId) -> Vec<usize> {
    let shape = &model.curves[&id];
    let at: Vec<usize> = shape.controls.iter().map(|(sample, _)| *sample as usize).collect();
    let count = shape.nodes.len();
    (0..at.len()).map(|k| (at[(k + 1) % at.len()] + count - at[k] - 1) % count + 1).collect()
}

/// Two discs over one another, with control points at these angles.
fn two_discs(low: &[f64], high: &[f64]) -> Round {
    let mut round = empty(0.2);
    for (z, angles) in [(0.0, low), (1.2, high)] {
        let boundary = curve(&mut round, places(&circle(1.0, z, angles)), true);
        act(&mut round, Edit::Sheet { boundary });
    }
    round.bench.rest(600);
    round
}

fn glue(reversed: bool) -> Edit {
    let on = |surface, at| On { surface: SurfaceId(surface), at };
    Edit::Glue { from: on(1, dvec3(1.0, 0.1, 0.0)), to: on(2, dvec3(-1.0, 0.0, 1.2)), skirt: false, reversed }
}

#[test]
fn glued_rims_with_as_many_control_points_meet_point_on_point() {
    // The second begins elsewhere and runs the other way round: 20° meets 0°, 50° meets 90°, 200° and 290° the others.
    let (low, high) = ([0.0, 90.0, 180.0, 270.0], [50.0, 20.0, 290.0, 200.0]);
    let mut round = two_discs(&low, &high);
    let model = round.bench.modeler.model();
    let own = stretches(model, CurveId(1));
    let theirs = stretches(model, CurveId(2));
    let [a, b, c, d] = theirs[..] else { panic!("{theirs:?}") };
    // From 20° to 50° and on: the second's stretches backwards.
    let met: Vec<usize> = own.iter().zip([a, d, c, b]).map(|(own, other)| *own.max(&other)).collect();
    assert!(d > own[1] && a < own[0], "{own:?} {theirs:?}: each has a stretch with more edges");
    act(&mut round, glue(false));
    let model = round.bench.modeler.model();
    assert_eq!(stretches(model, CurveId(1)), met, "each stretch has as many edges as the longer of the two");
    assert_eq!(all_kinds(&round), [(2, 0, true)]);
    // Of each pair the first's point stays, where it was.
    let document = round.bench.document();
    assert_eq!((document.curves.len(), document.points.len()), (1, 4));
    for (point, at) in document.curves[&CurveId(1)].through.iter().zip(circle(1.0, 0.0, &low)) {
        assert!(document.points[point].distance(at) < 1e-5, "{point}");
    }
    assert!(round.bench.rest(900).is_finite());
}

#[test]
fn rims_with_other_numbers_of_control_points_are_glued_as_they_lie() {
    let mut round = two_discs(&[0.0, 90.0, 180.0, 270.0], &[20.0, 50.0, 200.0]);
    let model = round.bench.modeler.model();
    let longer = model.curves[&CurveId(1)].nodes.len().max(model.curves[&CurveId(2)].nodes.len());
    act(&mut round, glue(false));
    assert_eq!(round.bench.modeler.model().curves[&CurveId(1)].nodes.len(), longer);
    assert_eq!(all_kinds(&round), [(2, 0, true)]);
}

#[test]
fn a_sheet_fills_a_loop_of_free_curves_whichever_is_named_and_however_they_run() {
    for named in 0..2 {
        let mut round = empty(0.25);
        let at = circle(1.0, 0.0, &[0.0, 60.0, 120.0, 180.0, 270.0]);
        let first = curve(&mut round, places(&at[..4]), false);
        let [from, to] = [PointId(1), PointId(4)].map(Through::Point);
        let second = curve(&mut round, vec![from, Through::Place(at[4]), to], false);
        act(&mut round, Edit::Sheet { boundary: [first, second][named] });
        assert_eq!(all_kinds(&round), [(1, 1, true)]);
        assert_eq!(round.bench.document().curves.len(), 2);
        round.bench.rest(600);
        // Two fair curves that meet in corners: no more than the disc, and most of it.
        let shape = &round.bench.modeler.model().surfaces[&SurfaceId(1)];
        let area: f64 = shape
            .mesh
            .faces()
            .map(|f| {
                let [p, q, r] = shape.mesh.face_vertices(f).map(|v| shape.positions[v.index()]);
                (q - p).cross(r - p).length() / 2.0
            })
            .sum();
        assert!((2.5..3.3).contains(&area), "{area}");
        for boundary in [first, second] {
            let why = refusal(&mut round, Edit::Sheet { boundary });
            assert!(why.contains("already bounds"), "{why}");
        }
    }
}

#[test]
fn a_frame_of_three_curves_is_skinned_and_a_chain_that_does_not_close_is_refused() {
    let mut round = empty(0.25);
    let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    let along = |k: usize, bend: f64| Through::Place((corners[k] + corners[(k + 1) % 3]) * bend);
    let first =
        curve(&mut round, vec![Through::Place(corners[0]), along(0, 0.6), Through::Place(corners[1])], false);
    let (x, y) = (PointId(1), PointId(3));
    curve(&mut round, vec![Through::Point(y), along(1, 0.6), Through::Place(corners[2])], false);
    let why = refusal(&mut round, Edit::Sheet { boundary: first });
    assert!(why.contains("is open") && why.contains("loop of curves"), "{why}");
    let z = *round.bench.document().points.keys().next_back().unwrap();
    curve(&mut round, vec![Through::Point(x), along(2, 0.6), Through::Point(z)], false);
    act(&mut round, Edit::Sheet { boundary: first });
    assert_eq!(all_kinds(&round), [(1, 1, true)]);
    round.bench.rest(600);
    // Two straight curves between the same points enclose nothing.
    let mut round = empty(0.25);
    let first = curve(&mut round, places(&[DVec3::X, DVec3::Y]), false);
    curve(&mut round, [1, 2].map(|k| Through::Point(PointId(k))).to_vec(), false);
    let why = refusal(&mut round, Edit::Sheet { boundary: first });
    assert!(why.contains("insert"), "{why}");
}

/// A disc with two loops drawn on it that cross; what lies in both is burned out.
fn lens() -> Round {
    let mut round = empty(0.15);
    let boundary = curve(&mut round, places(&circle(1.0, 0.0, &[0.0, 90.0, 180.0, 270.0])), true);
    act(&mut round, Edit::Sheet { boundary });
    for x in [-0.2, 0.2] {
        let along = circle(0.45, 0.0, &[45.0, 135.0, 225.0, 315.0]).into_iter().map(|at| at + DVec3::X * x);
        act(&mut round, Edit::SLoop { surface: SurfaceId(1), along: along.collect(), closed: true });
    }
    act(&mut round, Edit::Burnout { region: On { surface: SurfaceId(1), at: DVec3::ZERO } });
    round.bench.rest(600);
    round
}

#[test]
fn a_sheet_fills_a_hole_between_curves_that_cross() {
    let hole = lens();
    assert_eq!(all_kinds(&hole), [(0, 2, true)]);
    for boundary in hole.bench.document().curves.keys().copied().filter(|id| *id != CurveId(1)) {
        let mut round = lens();
        act(&mut round, Edit::Sheet { boundary });
        assert_eq!(all_kinds(&round), [(0, 2, true), (1, 1, true)], "{boundary}");
        let model = round.bench.modeler.model();
        let sheet = &model.surfaces[&SurfaceId(2)];
        let rim: Vec<CurveId> = sheet.embeddings.iter().map(|embedded| embedded.curve).collect();
        // They meet it in a crease all round: each curve of its rim is one of the hole's.
        assert_eq!(rim.len(), 2, "{rim:?}");
        for id in &rim {
            assert_eq!(model.document.surfaces_on(*id).count(), 2, "{id}");
            assert!(!model.document.curves[id].closed, "{id}");
        }
        round.bench.rest(900);
        // Both sides of a crease can be smoothed: the disc is whole again.
        act(&mut round, Edit::Smooth { curve: rim[0] });
        act(&mut round, Edit::Smooth { curve: rim[1] });
        assert_eq!(all_kinds(&round), [(1, 1, true)]);
        round.opens();
    }
}

#[test]
fn a_closed_curve_without_a_hole_is_skinned_by_itself_though_others_cross_it() {
    let mut round = empty(0.2);
    let boundary = curve(&mut round, places(&circle(1.0, 0.0, &[0.0, 90.0, 180.0, 270.0])), true);
    let across = [Through::Point(PointId(1)), Through::Place(DVec3::Z * 0.5), Through::Point(PointId(3))];
    let arc = curve(&mut round, across.to_vec(), false);
    act(&mut round, Edit::Sheet { boundary });
    let followed = |round: &Round, id: u32| {
        let shape = &round.bench.modeler.model().surfaces[&SurfaceId(id)];
        shape.embeddings.iter().map(|embedded| embedded.curve).collect::<Vec<_>>()
    };
    assert_eq!(followed(&round, 1), [boundary]);
    // The arc closes a loop with half of it, which is divided.
    act(&mut round, Edit::Sheet { boundary: arc });
    assert_eq!(all_kinds(&round), [(1, 1, true); 2]);
    assert_eq!((followed(&round, 1).len(), followed(&round, 2).len()), (2, 2));
    assert!(followed(&round, 2).contains(&arc));
}

#[test]
fn a_cylinder_slit_from_rim_to_rim_is_closed_by_a_sheet() {
    let mut round = empty(0.25);
    let angles = [0.0, 90.0, 180.0, 270.0];
    let [from, to] = [0.0, 1.0].map(|z| curve(&mut round, places(&circle(0.7, z, &angles)), true));
    act(&mut round, Edit::Sweep { from, to, stretches: [None; 2], reversed: false });
    let along = [0.0, 0.5, 1.0].map(|z| circle(0.7, z, &[45.0])[0]).to_vec();
    act(&mut round, Edit::SLoop { surface: SurfaceId(1), along, closed: false });
    let slit = *round.bench.document().curves.keys().next_back().unwrap();
    act(&mut round, Edit::Split { border: Border::Curve(slit) });
    assert_eq!(all_kinds(&round), [(1, 1, true)]);
    // The banks are drawn apart.
    let doubled: Vec<(PointId, DVec3)> = round.bench.document().points.into_iter().collect();
    for (k, (point, at)) in doubled.iter().enumerate() {
        if doubled[..k].iter().any(|(_, other)| other.distance(*at) < 1e-9) {
            act(&mut round, Edit::Move { point: *point, to: *at + dvec3(0.25, -0.25, 0.0) });
        }
    }
    round.bench.rest(900);
    let boundary = *round.bench.document().curves.keys().next_back().unwrap();
    act(&mut round, Edit::Sheet { boundary });
    assert_eq!(all_kinds(&round), [(1, 1, true); 2]);
    round.bench.rest(900);
    round.opens();
}
