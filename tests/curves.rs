//! Control curves through the one door: what they minimise, and where they are told to point.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    CurveId, Edit, Example, GrabTarget, Handle, Objective, ObjectiveOf, PointId, Request, Through, to_text,
};
use glam::DVec3;

const CURVE: CurveId = CurveId(1);

/// The samples of the first curve.
fn nodes(bench: &Bench) -> Vec<DVec3> {
    bench.modeler.model().curves[&CURVE].nodes.clone()
}

/// The largest distance of samples from a circle of radius 1 in the plane.
fn off_circle(bench: &Bench) -> f64 {
    nodes(bench).iter().map(|p| (p.truncate().length() - 1.0).abs().max(p.z.abs())).fold(0.0, f64::max)
}

#[test]
fn an_objective_makes_the_same_curve_by_an_act_as_from_a_file() {
    // Four points of a circle: what they hold is known for every objective.
    for (objective, low, high) in [
        (Objective::ThinPlate, 9.0e-3, 1.05e-2),
        (Objective::Fair, 0.0, 1e-4),
        (Objective::Neutral, 0.0, 5e-4),
        (Objective::Membrane, 0.28, 0.30),
    ] {
        let mut bench = Bench::with(Example::Disc);
        bench.rest(300);
        bench.edit(Edit::Objective { of: ObjectiveOf::Curve(CURVE), objective: Some(objective) });
        bench.rest(300);
        let off = off_circle(&bench);
        assert!((low..=high).contains(&off), "{objective:?}: {off}");
        let mut opened = Bench::new();
        opened.accept(Request::OpenText { text: bench.document.clone() });
        opened.rest(300);
        let again = off_circle(&opened);
        assert!((low..=high).contains(&again), "{objective:?}, opened: {again}");
        bench.accept(Request::Undo);
        bench.rest(300);
        assert!((9.0e-3..=1.05e-2).contains(&off_circle(&bench)), "{objective:?}, undone");
    }
}

/// The direction in which the samples leave a control point, of second order in their spacing.
fn leaving(bench: &Bench, point: PointId) -> DVec3 {
    let curve = &bench.modeler.model().curves[&CURVE];
    let sample = curve.sample_of(point).unwrap();
    let at = |k: usize| curve.nodes[(sample + k) % curve.nodes.len()] - curve.nodes[sample];
    let (short, long) = (at(1), at(2));
    (short * 4.0 - long).try_normalize().unwrap()
}

#[test]
fn a_tangent_is_met_survives_the_file_and_can_be_undone_and_freed() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let (point, flat) = (PointId(1), leaving(&bench, PointId(1)));
    let wanted = DVec3::new(-1.0, 1.0, 1.0);
    bench.edit(Edit::Tangent { curve: CURVE, point, direction: Some(wanted) });
    bench.rest(300);
    assert!(leaving(&bench, point).angle_between(wanted) < 0.02, "{}", leaving(&bench, point));
    // The surface follows its boundary out of the plane.
    assert!(nodes(&bench).iter().any(|p| p.z > 0.05));
    let mut opened = Bench::new();
    opened.accept(Request::OpenText { text: bench.document.clone() });
    opened.rest(300);
    assert!(leaving(&opened, point).angle_between(wanted) < 0.02);
    bench.edit(Edit::Tangent { curve: CURVE, point, direction: None });
    bench.rest(300);
    assert!(leaving(&bench, point).angle_between(flat) < 1e-3);
    bench.accept(Request::Undo);
    bench.rest(300);
    assert!(leaving(&bench, point).angle_between(wanted) < 0.02);
}

#[test]
fn an_open_curve_takes_end_tangents_and_forgets_them_with_their_point() {
    let mut bench = Bench::new();
    let places = [-1.0, 0.0, 1.0].map(|x| Through::Place(DVec3::X * x));
    bench.edit(Edit::Curve { through: places.to_vec(), closed: false });
    bench.edit(Edit::Tangent { curve: CURVE, point: PointId(1), direction: Some(DVec3::Y) });
    bench.edit(Edit::Tangent { curve: CURVE, point: PointId(2), direction: Some(DVec3::X) });
    bench.rest(300);
    assert!(leaving(&bench, PointId(1)).angle_between(DVec3::Y) < 0.05);
    bench.edit(Edit::Release { point: PointId(2) });
    bench.rest(300);
    let tangents = bench.document().curves[&CURVE].tangents.clone();
    assert_eq!(tangents.into_iter().collect::<Vec<_>>(), [(PointId(1), DVec3::Y)]);
}

#[test]
fn tangents_that_are_none_are_refused_and_change_nothing() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let (before, places) = (bench.document.clone(), nodes(&bench));
    for (curve, point, direction) in [
        (CURVE, PointId(1), DVec3::ZERO),
        (CURVE, PointId(1), DVec3::NAN),
        (CURVE, PointId(77), DVec3::X),
        (CurveId(9), PointId(1), DVec3::X),
    ] {
        let reply = bench.send(Request::Edit(Edit::Tangent { curve, point, direction: Some(direction) }));
        assert!(reply.refused.is_some(), "{curve} {point} {direction}");
    }
    assert_eq!(bench.document, before);
    assert_eq!(nodes(&bench), places);
}

#[test]
fn a_handle_turns_a_tangent_in_one_act_and_is_put_back_by_cancel() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let point = PointId(1);
    bench.edit(Edit::Tangent { curve: CURVE, point, direction: Some(DVec3::new(-1.0, 1.0, 0.2)) });
    bench.rest(300);
    let (before, places) = (bench.document.clone(), nodes(&bench));
    let at = bench.document().points[&point];
    let target = GrabTarget::Handle(Handle::Tangent { curve: CURVE, point });
    let turn = |bench: &mut Bench, steps: u32| {
        let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
        assert_eq!((grabbed.point, grabbed.at), (point, at));
        for step in 1..=steps {
            bench.step(Some(at + DVec3::new(-1.0, 1.0, 0.2 + 0.1 * f64::from(step)) * 0.3));
        }
        // What says no direction is passed over.
        for nothing in [DVec3::NAN, at, at + DVec3::X * 1e-12] {
            bench.step(Some(nothing));
        }
    };
    turn(&mut bench, 12);
    let wanted = DVec3::new(-1.0, 1.0, 1.4);
    for _ in 0..30 {
        bench.step(None);
    }
    assert!(leaving(&bench, point).angle_between(wanted) < 0.02, "the curve follows the hand");
    assert_eq!(bench.document, before, "a drag in progress is not committed");
    bench.accept(Request::Cancel);
    assert_eq!((bench.modeler.model().document.as_ref(), nodes(&bench)), (&bench.document(), places.clone()));
    turn(&mut bench, 12);
    let committed = bench.accept(Request::Drop).committed.unwrap();
    assert_eq!(committed.act, "Tangent");
    bench.rest(300);
    let kept = bench.document().curves[&CURVE].tangents[&point];
    assert!(kept.angle_between(wanted) < 1e-3 && (kept.length() - 1.0).abs() < 1e-3, "{kept}");
    assert!(leaving(&bench, point).angle_between(wanted) < 0.02);
    // The whole drag is one act.
    bench.accept(Request::Undo);
    assert_eq!((bench.document.clone(), nodes(&bench)), (before.clone(), places));
    // A press without a turn is none.
    turn(&mut bench, 0);
    assert!(bench.accept(Request::Drop).committed.is_none());
    assert_eq!(bench.document, before);
    for handle in [(CurveId(7), point), (CURVE, PointId(77))] {
        let target = GrabTarget::Handle(Handle::Tangent { curve: handle.0, point: handle.1 });
        assert!(bench.send(Request::Grab(target)).refused.is_some());
    }
}

/// Largest distance of a curve's samples from those of a finer one.
fn off_curve(bench: &Bench, fine: &Bench) -> f64 {
    let fine = nodes(fine);
    let distance = |p: DVec3, a: DVec3, b: DVec3| {
        let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        p.distance(a.lerp(b, along))
    };
    let nearest = |p: DVec3| {
        (0..fine.len())
            .map(|i| distance(p, fine[i], fine[(i + 1) % fine.len()]))
            .fold(f64::INFINITY, f64::min)
    };
    nodes(bench).into_iter().map(nearest).fold(0.0, f64::max)
}

/// The thesis's figures 2.7 and 8.1: a control point made near another and dragged leaves the curve fair, at any sampling.
#[test]
fn a_control_beside_another_leaves_the_curve_fair() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let home = bench.document().points[&PointId(1)];
    let beside = nodes(&bench).into_iter().find(|p| (0.12..0.3).contains(&p.distance(home))).unwrap();
    bench.edit(Edit::Insert { curve: CURVE, at: beside });
    let point = *bench.document().points.keys().last().unwrap();
    let start = bench.document().points[&point];
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    for step in 1..=12 {
        bench.step(Some(start * (1.0 + 0.01 * f64::from(step))));
    }
    bench.accept(Request::Drop);
    bench.rest(600);
    let at = |spacing: f64| {
        let mut document = bench.document();
        document.spacing = Some(spacing);
        document.surfaces.clear();
        let mut other = Bench::new();
        other.accept(Request::OpenText { text: to_text(&document) });
        other.rest(600);
        other
    };
    let fine = at(0.005);
    let (here, coarse, half) =
        (off_curve(&bench, &fine), off_curve(&at(0.08), &fine), off_curve(&at(0.04), &fine));
    assert!(here < 2e-3, "{here}");
    assert!(coarse / half > 2.8, "{coarse} {half}");
}
