//! Drags: whatever a hand does, the shape follows, stays finite, and comes back.

use acceptance::Bench;
use ductile_spec::{CurveId, Example, GrabTarget, PointId, Request, Step, SurfaceId};
use glam::{DVec3, dvec3};
use proptest::prelude::*;

#[test]
fn a_drag_of_the_surface_makes_a_control_point_that_the_shape_follows() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let before = bench.document.clone();
    let target = GrabTarget::Surface { surface: SurfaceId(1), at: dvec3(0.02, 0.01, 0.0) };
    let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
    for step in 1..=10 {
        let reply = bench.step(Some(grabbed.at + DVec3::Z * 0.05 * f64::from(step)));
        assert_eq!(reply.frame.held, Some(grabbed.point));
        assert!(!reply.frame.settled);
    }
    assert_eq!(bench.document, before, "a drag in progress is not committed");
    let reply = bench.accept(Request::Drop);
    assert_eq!(reply.committed.unwrap().act, "Control point");
    let energy = bench.rest(300);
    // Linear plate theory: 16 pi / 3 z^2 at small heights; at half the radius the disc is softer.
    assert!((2.0..4.5).contains(&energy), "energy {energy}");
    assert!((bench.document().points[&grabbed.point].z - 0.5).abs() < 1e-3);
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
    assert!(bench.rest(300) < 1e-6);
}

/// How many triangles the first surface has.
fn triangles(bench: &Bench) -> usize {
    bench.modeler.model().surfaces[&SurfaceId(1)].mesh.face_count()
}

#[test]
fn a_mesh_that_a_moving_hand_stretches_is_refined_under_way_and_one_that_still_does_is_left_alone() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let target = GrabTarget::Surface { surface: SurfaceId(1), at: dvec3(0.02, 0.01, 0.0) };
    let grabbed = bench.accept(Request::Grab(target)).grabbed.unwrap();
    // The new control makes its own edits first, with the hand at rest.
    for _ in 0..30 {
        bench.step(None);
    }
    let before = bench.modeler.model().surfaces[&SurfaceId(1)].revision;
    let count = triangles(&bench);
    let mut height = 0.0;
    let mut rise = |bench: &mut Bench, steps: u32| {
        for _ in 0..steps {
            // Slower than a spacing for each frame, but never still.
            height += 0.02;
            bench.step(Some(grabbed.at + DVec3::Z * height));
        }
    };
    rise(&mut bench, 10);
    assert_eq!(bench.modeler.model().surfaces[&SurfaceId(1)].revision, before, "nothing is worn yet");
    rise(&mut bench, 90);
    assert!(triangles(&bench) > count + count / 10, "{count} {}", triangles(&bench));
}

#[test]
fn a_drag_of_a_curve_carries_its_surface() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let grabbed = bench
        .accept(Request::Grab(GrabTarget::Curve { curve: CurveId(1), at: dvec3(1.0, 0.0, 0.0) }))
        .grabbed
        .unwrap();
    for step in 1..=10 {
        bench.step(Some(grabbed.at + dvec3(0.03, 0.0, 0.03) * f64::from(step)));
    }
    bench.accept(Request::Drop);
    bench.rest(300);
    let model = bench.modeler.model();
    assert_eq!(model.document.curves[&CurveId(1)].through.len(), 5);
    let highest = model.surfaces[&SurfaceId(1)].positions.iter().map(|p| p.z).fold(0.0, f64::max);
    assert!(highest > 0.25, "the surface stayed at {highest}");
}

#[test]
fn cancel_puts_everything_back_to_the_bit() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(300);
    let floats = bench.modeler.floats().to_vec();
    let document = bench.document.clone();
    bench.accept(Request::Grab(GrabTarget::Surface { surface: SurfaceId(1), at: dvec3(0.1, 0.1, 0.4) }));
    for step in 0..20 {
        bench.step(Some(dvec3(0.1, 0.1, f64::from(step) * 0.1)));
    }
    bench.accept(Request::Cancel);
    assert_eq!(bench.modeler.floats(), floats);
    bench.accept(Request::Describe);
    assert_eq!(bench.document, document);
}

/// What a hand holds is not committed, so undo must not lead there.
#[test]
fn undo_after_opening_in_the_middle_of_a_drag_leads_to_where_the_drag_began() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let before = bench.document.clone();
    bench.accept(Request::Grab(GrabTarget::Point(PointId(1))));
    for step in 1..=5 {
        bench.step(Some(dvec3(1.0, 0.0, 0.1 * f64::from(step))));
    }
    bench.accept(Request::OpenExample(Example::Ball));
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
}

#[test]
fn a_click_without_a_drag_changes_nothing() {
    let mut bench = Bench::with(Example::Saddle);
    let document = bench.document.clone();
    bench.accept(Request::Grab(GrabTarget::Surface { surface: SurfaceId(1), at: DVec3::ZERO }));
    let reply = bench.accept(Request::Drop);
    assert_eq!(reply.committed, None);
    bench.accept(Request::Describe);
    assert_eq!(bench.document, document);
}

#[test]
fn a_wild_drag_returns_to_the_undisturbed_shape() {
    let mut bench = Bench::with(Example::RaisedDisc);
    let undisturbed = bench.rest(300);
    let point = PointId(5);
    let home = bench.document().points[&point];
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    for to in [
        dvec3(1e9, 0.0, 0.0),
        dvec3(f64::NAN, 0.0, 0.0),
        dvec3(-3.0, 2.0, -4.0),
        dvec3(0.0, f64::INFINITY, 0.0),
        dvec3(0.5, 0.5, 2.0),
    ] {
        for _ in 0..6 {
            bench.step(Some(to));
        }
    }
    for _ in 0..60 {
        bench.step(Some(home));
    }
    let held = bench.step(Some(home)).frame.figures.energy;
    assert!((held / undisturbed - 1.0).abs() < 1e-6, "{undisturbed} before, {held} with the hand at home");
    // Where nothing was moved in the end, there is no act.
    assert_eq!(bench.accept(Request::Drop).committed, None);
    let energy = bench.rest(600);
    assert!((energy / undisturbed - 1.0).abs() < 1e-6, "{undisturbed} before, {energy} after");
}

#[test]
fn a_document_that_could_not_be_opened_again_is_never_committed() {
    let mut bench = Bench::with(Example::RaisedDisc);
    let document = bench.document();
    let [here, there] = [PointId(1), PointId(2)];
    // Two neighbours on a curve at one place: the stretch between them has no length.
    let to = document.points[&there];
    let reply = bench.send(Request::Edit(ductile_spec::Edit::Move { point: here, to }));
    assert!(reply.refused.is_some_and(|refusal| refusal.reason.contains("no extent")));
    bench.accept(Request::Grab(GrabTarget::Point(here)));
    for _ in 0..5 {
        bench.step(Some(to));
    }
    // Who asks in the middle is told the document before: the drag is no act yet.
    let described = bench.accept(Request::Describe).committed.unwrap();
    assert_eq!(ductile_spec::from_text(&described.document).unwrap(), document);
    assert!(bench.send(Request::Drop).refused.is_some_and(|refusal| refusal.reason.contains("no extent")));
    bench.accept(Request::Describe);
    assert_eq!(bench.document(), document);
    // So far that the surface would need more nodes than there may be.
    bench.edit(ductile_spec::Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(0.015) });
    let document = bench.document();
    let reply = bench.send(Request::Edit(ductile_spec::Edit::Move { point: there, to: DVec3::splat(9.0) }));
    assert!(reply.refused.is_some_and(|refusal| refusal.reason.contains("nodes")));
    bench.accept(Request::Describe);
    assert_eq!(bench.document(), document);
}

#[test]
fn requests_that_make_no_sense_are_refused_with_a_reason() {
    let mut bench = Bench::with(Example::Disc);
    let document = bench.document.clone();
    use ductile_spec::{Edit, Through};
    let refused = [
        Request::Drop,
        Request::Cancel,
        Request::Redo,
        Request::Grab(GrabTarget::Point(PointId(99))),
        Request::Grab(GrabTarget::Surface { surface: SurfaceId(9), at: DVec3::ZERO }),
        Request::Grab(GrabTarget::Curve { curve: CurveId(1), at: DVec3::NAN }),
        Request::Edit(Edit::Point { at: DVec3::INFINITY }),
        Request::Edit(Edit::Move { point: PointId(1), to: DVec3::splat(1e7) }),
        Request::Edit(Edit::Curve { through: vec![Through::Point(PointId(1))], closed: false }),
        Request::Edit(Edit::Curve { through: vec![Through::Point(PointId(1)); 2], closed: false }),
        // A place that is none, after one that is: the first must not stay.
        Request::Edit(Edit::Curve {
            through: [DVec3::ZERO, DVec3::NAN].map(Through::Place).to_vec(),
            closed: false,
        }),
        Request::Edit(Edit::Curve { through: vec![Through::Place(DVec3::ZERO); 2], closed: false }),
        Request::Edit(Edit::Sheet { boundary: CurveId(1) }),
        Request::Edit(Edit::Sweep {
            from: CurveId(1),
            to: CurveId(1),
            stretches: [None; 2],
            reversed: false,
        }),
        Request::Edit(Edit::DeleteCurve { curve: CurveId(1) }),
        Request::Edit(Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(f64::NAN) }),
        Request::Edit(Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(1e-9) }),
        Request::Edit(Edit::Rename { name: "x".repeat(1000) }),
    ];
    for request in refused {
        let asked = format!("{request:?}");
        let reply = bench.send(request);
        assert!(reply.refused.is_some(), "{asked} was accepted");
        bench.accept(Request::Describe);
        assert_eq!(bench.document, document, "{asked} changed the document");
    }
}

fn anything() -> impl Strategy<Value = DVec3> {
    let number = prop_oneof![
        6 => -1.5..1.5_f64,
        1 => prop::num::f64::ANY,
        1 => prop_oneof![Just(0.0), Just(1e9), Just(-1e300), Just(f64::NAN)],
    ];
    [number.clone(), number.clone(), number].prop_map(DVec3::from_array)
}

fn request() -> impl Strategy<Value = Request> {
    use ductile_spec::Edit;
    let id = 0..9_u32;
    prop_oneof![
        8 => (anything(), 0..30_u32).prop_map(|(to, iterations)| Request::Step(Step { drag: Some(to), iterations })),
        2 => Just(Request::Step(Step { drag: None, iterations: 12 })),
        2 => anything().prop_map(|at| Request::Grab(GrabTarget::Surface { surface: SurfaceId(1), at })),
        2 => anything().prop_map(|at| Request::Grab(GrabTarget::Curve { curve: CurveId(1), at })),
        2 => id.clone().prop_map(|p| Request::Grab(GrabTarget::Point(PointId(p)))),
        3 => Just(Request::Drop),
        1 => Just(Request::Cancel),
        2 => Just(Request::Undo),
        1 => Just(Request::Redo),
        1 => id.clone().prop_map(|p| Request::Edit(Edit::Release { point: PointId(p) })),
        1 => id.clone().prop_map(|p| Request::Edit(Edit::DeletePoint { point: PointId(p) })),
        1 => (id, anything()).prop_map(|(p, to)| Request::Edit(Edit::Move { point: PointId(p), to })),
        1 => anything().prop_map(|at| Request::Edit(Edit::Pin { surface: SurfaceId(1), at })),
        1 => anything().prop_map(|at| Request::Edit(Edit::Insert { curve: CurveId(1), at })),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, max_shrink_iters: 200, ..ProptestConfig::default() })]

    /// The bench checks every invariant after every request.
    #[test]
    fn no_sequence_of_requests_breaks_the_model(requests in prop::collection::vec(request(), 1..40)) {
        let mut bench = Bench::with(Example::Disc);
        bench.edit(ductile_spec::Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(0.2) });
        for request in requests {
            bench.send(request);
        }
        bench.send(Request::Cancel);
        while bench.send(Request::Undo).refused.is_none() {}
    }
}
