//! Trims whose join has a ribbon, and trims along lines that end at rims (thesis section 3.4.1). After every act the document
//! can be opened again, and gives surfaces of the same kinds; undo restores it to the letter.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use acceptance::kinds::kinds;
use ductile_modeler::Model;
use ductile_spec::{
    CurveId, Edit, JoinRibbon, Objective, ObjectiveOf, On, Request, SpacingOf, SurfaceId, Through, from_text,
};
use glam::{DVec3, dvec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

const BOTH: [SurfaceId; 2] = [SurfaceId(1), SurfaceId(2)];

fn on(surface: u32, at: DVec3) -> On {
    On { surface: SurfaceId(surface), at }
}

fn trim(first: On, second: On, smooth: bool, ribbon: Option<JoinRibbon>) -> Edit {
    Edit::Trim { first, second, smooth, ribbon }
}

/// A disc through four points: its centre, two axes of its plane, and the angle of its first point.
fn disc(bench: &mut Bench, centre: DVec3, [u, v]: [DVec3; 2], from: f64) {
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(from + f64::from(k) * FRAC_PI_2);
        Through::Place(centre + u * cos + v * sin)
    };
    let before = bench.modeler.model().curves.keys().max().map_or(0, |id| id.0);
    bench.edit(Edit::Curve { through: (0..4).map(corner).collect(), closed: true });
    bench.edit(Edit::Sheet { boundary: CurveId(before + 1) });
}

/// Acts; the kinds of the surfaces are those of the document, too.
fn act(bench: &mut Bench, edit: &Edit) -> Vec<(i64, usize, bool)> {
    let before = bench.document.clone();
    bench.edit(edit.clone());
    let after = bench.document.clone();
    let now: Vec<_> = kinds(bench.modeler.model()).into_iter().map(|(_, kind)| kind).collect();
    let again = Model::from_document(from_text(&after).unwrap()).unwrap();
    assert_eq!(kinds(&again), kinds(bench.modeler.model()), "{edit:?}: {after}");
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
    bench.accept(Request::Redo);
    assert_eq!(bench.document, after);
    now
}

fn refusal(bench: &mut Bench, edit: Edit) -> String {
    let before = bench.document.clone();
    let reply = bench.send(Request::Edit(edit));
    assert_eq!(bench.document, before);
    reply.refused.expect("it must be refused").reason
}

/// A dome over the unit disc, as high as wide, and a disc of radius 1.5 through it at a quarter of its height.
fn dome_through_disc() -> Bench {
    let mut bench = Bench::new();
    disc(&mut bench, DVec3::ZERO, [DVec3::X, DVec3::Y], 0.0);
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.14) });
    bench.edit(Edit::Objective { of: ObjectiveOf::Document, objective: Some(Objective::Fair) });
    bench.rest(600);
    // A hemisphere: it leaves the plane of its rim at a right angle.
    let leave = Some(ductile_spec::Leave::Angle(FRAC_PI_2));
    bench.edit(Edit::Ribbon { surface: SurfaceId(1), curve: CurveId(1), leave });
    bench.rest(900);
    disc(&mut bench, DVec3::Z * 0.25, [DVec3::X * 1.5, DVec3::Y * 1.5], FRAC_PI_4);
    bench.rest(600);
    bench
}

/// Angles between the directions in which both surfaces are told to leave a curve, in degrees.
fn told_angles(bench: &Bench, curve: CurveId) -> Vec<f64> {
    let document = bench.document();
    let [one, other] = BOTH.map(|id| document.surfaces[&id].ribbons[&curve].cross.clone());
    assert!(one.len() == document.curves[&curve].through.len() && one.keys().eq(other.keys()));
    one.iter().map(|(point, a)| a.angle_between(other[point]).to_degrees()).collect()
}

/// The fitted normals of a surface along a curve.
fn normals_along(bench: &Bench, id: SurfaceId, curve: CurveId) -> Vec<DVec3> {
    let shape = &bench.modeler.model().surfaces[&id];
    let bound = bench.modeler.relaxer().surface(id, shape).unwrap();
    let embedded = shape.embeddings.iter().find(|e| e.curve == curve).unwrap();
    let node = |v| bound.vertices().iter().position(|other| *other == v).unwrap();
    embedded.vertices.iter().map(|v| bound.normals()[node(*v)]).collect()
}

#[test]
fn a_ribbon_holds_the_angle_at_which_surfaces_meet_or_the_one_that_is_asked_for() {
    // On the unit sphere at a quarter of the radius the way up turns from the upright by that sine.
    let met = 90.0 + libm::asin(0.25).to_degrees();
    for (ribbon, wanted, within) in [
        (JoinRibbon::AsMet, met, 2.0),
        (JoinRibbon::Angle(120_f64.to_radians()), 120.0, 1e-5),
        (JoinRibbon::Angle(180_f64.to_radians()), 180.0, 1e-5),
    ] {
        let mut bench = dome_through_disc();
        let (first, second) = (on(1, DVec3::Z), on(2, dvec3(1.3, 0.0, 0.25)));
        let kinds = act(&mut bench, &trim(first, second, false, Some(ribbon)));
        assert_eq!(kinds, [(1, 1, true), (0, 2, true)]);
        let seam = CurveId(3);
        for angle in told_angles(&bench, seam) {
            assert!((angle - wanted).abs() < within, "told {angle}, wanted {wanted}");
        }
        bench.rest(900);
        let [one, other] = BOTH.map(|id| normals_along(&bench, id, seam));
        for (a, b) in one.iter().zip(&other) {
            let between = a.angle_between(*b).to_degrees();
            let off = (between - wanted).abs().min((180.0 - between - wanted).abs());
            assert!(off < within + 3.0, "{between} between normals, {wanted} wanted");
        }
    }
}

#[test]
fn a_smooth_join_is_held_to_the_plane_half_way_between() {
    let mut bench = dome_through_disc();
    let (first, second) = (on(1, DVec3::Z), on(2, dvec3(1.3, 0.0, 0.25)));
    let edit = trim(first, second, true, Some(JoinRibbon::AsMet));
    assert_eq!(act(&mut bench, &edit), [(1, 1, true)]);
    let (seam, document) = (CurveId(3), bench.document());
    assert!(!document.surfaces[&SurfaceId(1)].ribbons[&seam].cross.is_empty());
    bench.rest(900);
    for (normal, at) in
        normals_along(&bench, SurfaceId(1), seam).iter().zip(&bench.modeler.model().curves[&seam].nodes)
    {
        // Half of the way from upright to lying, which is what the disc and the dome make of it.
        let out = at.with_z(0.0).try_normalize().unwrap();
        let slope = libm::atan2(normal.dot(out).abs(), normal.z.abs()).to_degrees();
        assert!((slope - 0.5 * (90.0 - libm::asin(0.25).to_degrees())).abs() < 3.0, "{slope}");
    }
    let why = refusal(&mut dome_through_disc(), trim(first, second, true, Some(JoinRibbon::Angle(1.0))));
    assert!(why.contains("smooth join"), "{why}");
    for angle in [0.0, -1.0, 4.0, f64::NAN] {
        let why =
            refusal(&mut dome_through_disc(), trim(first, second, false, Some(JoinRibbon::Angle(angle))));
        assert!(why.contains("180"), "{why}");
    }
}

/// A large disc in the plane, and a small one upright through it, whose rim the line of both runs across.
fn fin() -> Bench {
    let mut bench = Bench::new();
    disc(&mut bench, DVec3::ZERO, [DVec3::X * 1.5, DVec3::Y * 1.5], 0.0);
    disc(&mut bench, DVec3::Z * 0.2, [DVec3::X * 0.5, DVec3::Z * 0.5], FRAC_PI_4);
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.12) });
    bench.rest(600);
    bench
}

#[test]
fn what_a_line_from_rim_to_rim_cuts_off_stands_on_the_surface_that_it_does_not_divide() {
    for is_second in [false, true] {
        let mut bench = fin();
        let (large, small) = (on(1, dvec3(0.0, -1.0, 0.0)), on(2, dvec3(0.0, 0.0, 0.6)));
        let [first, second] = if is_second { [large, small] } else { [small, large] };
        let kinds = act(&mut bench, &trim(first, second, false, Some(JoinRibbon::AsMet)));
        assert_eq!(kinds, [(1, 1, true), (1, 1, true)]);
        bench.rest(600);
        let model = bench.modeler.model();
        let lowest =
            model.surfaces[&SurfaceId(2)].positions.iter().map(|p| p.z).fold(f64::INFINITY, f64::min);
        assert!(lowest > -0.01, "the part below is gone: {lowest}");
        let [on_large, on_small] = BOTH.map(|id| {
            let shape = &model.surfaces[&id];
            let curves: Vec<CurveId> = shape.embeddings.iter().map(|e| e.curve).collect();
            curves
        });
        let seam: Vec<_> = on_small.iter().filter(|curve| on_large.contains(curve)).collect();
        assert_eq!(seam.len(), 1, "{on_large:?} {on_small:?}");
        let ribbons = |id| bench.document().surfaces[&id].ribbons.len();
        assert_eq!(BOTH.map(ribbons), [0, 1], "the disc runs on through the line");
        // The line is a control curve of both: moved, both follow.
        let through = bench.document().curves[seam[0]].through.clone();
        let to = bench.document().points[&through[1]] + DVec3::Y * 0.2;
        bench.edit(Edit::Move { point: through[1], to });
        bench.rest(600);
        for id in BOTH {
            let shape = &bench.modeler.model().surfaces[&id];
            let off = shape.positions.iter().map(|p| p.distance(to)).fold(f64::INFINITY, f64::min);
            assert!(off < 1e-9, "{id} is off by {off}");
        }
    }
    for (smooth, ribbon) in [(true, None), (false, Some(JoinRibbon::Angle(1.0)))] {
        let (large, small) = (on(1, dvec3(0.0, -1.0, 0.0)), on(2, dvec3(0.0, 0.0, 0.6)));
        let why = refusal(&mut fin(), trim(large, small, smooth, ribbon));
        assert!(why.contains("does not divide surface 1"), "{why}");
    }
}

#[test]
fn a_line_from_rim_to_rim_of_both_cuts_both() {
    for smooth in [false, true] {
        let mut bench = Bench::new();
        disc(&mut bench, DVec3::ZERO, [DVec3::X, DVec3::Y], FRAC_PI_4);
        disc(&mut bench, DVec3::ZERO, [DVec3::X, DVec3::Z], FRAC_PI_4);
        bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.15) });
        bench.rest(600);
        let (first, second) = (on(1, dvec3(0.0, 0.6, 0.0)), on(2, dvec3(0.0, 0.0, 0.6)));
        let kinds = act(&mut bench, &trim(first, second, smooth, None));
        assert_eq!(kinds, if smooth { vec![(1, 1, true)] } else { vec![(1, 1, true); 2] });
        bench.rest(900);
        for shape in bench.modeler.model().surfaces.values() {
            assert!(shape.mesh.vertices().all(|v| shape.positions[v.index()].min_element() > -1.2));
            assert!(shape.mesh.vertices().all(|v| {
                let at = shape.positions[v.index()];
                at.y > -0.2 && at.z > -0.2
            }));
        }
    }
}

#[test]
fn a_line_that_ends_inside_both_is_refused_with_its_place() {
    let mut bench = Bench::new();
    disc(&mut bench, DVec3::ZERO, [DVec3::X, DVec3::Y], FRAC_PI_4);
    disc(&mut bench, DVec3::X, [DVec3::X * 0.6, DVec3::Z * 0.6], 0.0);
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.15) });
    bench.rest(600);
    let (first, second) = (on(1, dvec3(-0.5, 0.0, 0.0)), on(2, dvec3(1.0, 0.0, 0.4)));
    let why = refusal(&mut bench, trim(first, second, false, None));
    assert!(why.contains("divides neither") && why.contains("[0.4"), "{why}");
}

#[test]
fn curves_that_the_line_crosses_get_a_point_in_common_with_it() {
    let mut bench = dome_through_disc();
    let along = vec![dvec3(0.5, 0.0, 0.25), dvec3(1.3, 0.0, 0.25)];
    bench.edit(Edit::SLoop { surface: SurfaceId(2), along, closed: false });
    bench.rest(600);
    let (first, second) = (on(1, DVec3::Z), on(2, dvec3(-1.3, 0.0, 0.25)));
    let kinds = act(&mut bench, &trim(first, second, false, None));
    assert_eq!(kinds, [(1, 1, true), (0, 2, true)]);
    bench.rest(900);
    // What is left of the curve begins at the line.
    let document = bench.document();
    let seam = document.curves.values().find(|curve| curve.closed && curve.through.len() >= 6).unwrap();
    let open: Vec<_> = document.curves.values().filter(|curve| !curve.closed).collect();
    assert_eq!(open.len(), 1);
    assert_eq!(open[0].through.iter().filter(|point| seam.through.contains(point)).count(), 1);
}
