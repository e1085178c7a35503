//! Normals and ribbons as a designer prescribes them: through the text, the acts, the drags and the mesh's upkeep.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    Cage, CurveId, Document, Edit, Example, GrabTarget, Handle, Leave, Objective, ObjectiveOf, PointId,
    Request, Ribbon, SpacingOf, SurfaceId, from_text, to_text,
};
use glam::{DVec3, dvec3};
use std::collections::BTreeSet;
use std::f64::consts::{FRAC_PI_4, PI};

const SURFACE: SurfaceId = SurfaceId(1);
const RIM: CurveId = CurveId(1);

fn ribbon(bench: &mut Bench, curve: CurveId, degrees: f64) {
    let leave = Some(Leave::Angle(degrees.to_radians()));
    bench.edit(Edit::Ribbon { surface: SURFACE, curve, leave });
}

/// Where the vertices are.
fn places(bench: &Bench) -> Vec<DVec3> {
    let shape = &bench.modeler.model().surfaces[&SURFACE];
    shape.mesh.vertices().map(|v| shape.positions[v.index()]).collect()
}

/// Largest distance from the cap over the unit circle that leans by an angle.
fn off_cap(bench: &Bench, angle: f64) -> f64 {
    let radius = 1.0 / libm::sin(angle);
    let centre = DVec3::Z * (-radius * libm::cos(angle));
    places(bench).iter().map(|p| (p.distance(centre) - radius).abs()).fold(0.0, f64::max)
}

fn fair_disc() -> Bench {
    let mut bench = Bench::with(Example::Disc);
    // Fair curves keep the rim a circle.
    bench.edit(Edit::Objective { of: ObjectiveOf::Document, objective: Some(Objective::Fair) });
    bench.rest(600);
    bench
}

#[test]
fn a_rim_left_at_45_degrees_bounds_a_sphere_cap_and_undo_takes_it_back() {
    let mut bench = fair_disc();
    let before = bench.document.clone();
    ribbon(&mut bench, RIM, 45.0);
    bench.rest(600);
    let off = off_cap(&bench, FRAC_PI_4);
    println!("fair: off by {off:e}");
    assert!(off < 2e-4, "{off}");
    // The same from the text alone.
    let document = bench.document();
    assert_eq!(document.surfaces[&SURFACE].ribbons[&RIM].cross.len(), document.curves[&RIM].through.len());
    let mut other = Bench::new();
    other.accept(Request::OpenText { text: to_text(&document) });
    other.rest(600);
    let off = off_cap(&other, FRAC_PI_4);
    println!("opened: off by {off:e}");
    assert!(off < 2e-4, "{off}");
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
    bench.rest(600);
    assert!(places(&bench).iter().all(|p| p.z.abs() < 1e-3), "flat again");
}

#[test]
fn a_single_direction_is_carried_round_the_rim() {
    let mut bench = fair_disc();
    let point = bench.document().curves[&RIM].through[1];
    let at = bench.document().points[&point];
    let cross = [(point, (-at + DVec3::Z * at.length()) * 5.0)].into();
    bench.edit(Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Cross(cross)) });
    bench.rest(600);
    let off = off_cap(&bench, FRAC_PI_4);
    assert!(off < 2e-4, "{off}");
}

#[test]
fn ribbons_are_kept_through_a_drag_and_at_other_densities() {
    let heights = [0.12, 0.06].map(|spacing| {
        let mut bench = Bench::with(Example::Disc);
        bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(spacing) });
        ribbon(&mut bench, RIM, 60.0);
        bench.rest(600);
        let before = places(&bench).iter().map(|p| p.z).fold(0.0, f64::max);
        // A point of the rim out, up, and home.
        let point = bench.document().curves[&RIM].through[0];
        let at = bench.document().points[&point];
        bench.accept(Request::Grab(GrabTarget::Point(point)));
        for share in [0.1, 0.2, 0.4, 0.6, 0.4, 0.2, 0.0] {
            let reply = bench.step(Some(at * (1.0 + share) + DVec3::Z * share));
            assert!(reply.frame.figures.energy.is_finite());
        }
        bench.accept(Request::Drop);
        bench.rest(600);
        let after = places(&bench).iter().map(|p| p.z).fold(0.0, f64::max);
        println!("spacing {spacing}: {before} before the drag, {after} after it");
        assert!((before - after).abs() < 5e-3, "{before} and {after}");
        after
    });
    // A cap that leans by 60 degrees is this high.
    let exact = libm::tan(PI / 6.0);
    assert!(
        (heights[0] - exact).abs() < 0.02 && (heights[1] - exact).abs() < 0.01,
        "{heights:?} for {exact}"
    );
}

#[test]
fn the_two_rims_of_a_cylinder_left_straight_keep_a_fair_one_straight() {
    let mut bench = Bench::with(Example::Cylinder);
    bench.edit(Edit::Objective { of: ObjectiveOf::Document, objective: Some(Objective::Fair) });
    let curves: Vec<CurveId> = bench.document().curves.keys().copied().collect();
    for (curve, up) in curves.iter().zip([1.0, -1.0]) {
        let through = bench.document().curves[curve].through.clone();
        let leave = Some(Leave::Cross([(through[0], DVec3::Z * up)].into()));
        bench.edit(Edit::Ribbon { surface: SURFACE, curve: *curve, leave });
    }
    bench.rest(600);
    let radii = places(&bench).into_iter().map(|p| p.truncate().length()).collect::<Vec<_>>();
    let (least, most) = radii.iter().fold((f64::INFINITY, 0.0_f64), |(l, m), r| (l.min(*r), m.max(*r)));
    println!("radii {least} to {most}");
    assert!(most - least < 2e-3, "{least} to {most}");
}

#[test]
fn a_normal_tilts_the_top_of_a_raised_disc_and_can_be_set_free() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let (calm, document) = (places(&bench), bench.document.clone());
    let point = *bench.document().points.keys().next_back().unwrap();
    let normal = Some(dvec3(0.5, 0.0, 1.0));
    bench.edit(Edit::Normal { surface: SURFACE, point, normal });
    bench.rest(600);
    let moved = places(&bench).iter().zip(&calm).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(moved > 0.01, "{moved}");
    let text = to_text(&bench.document());
    assert_eq!(from_text(&text).unwrap(), bench.document());
    // Either sense and any length are the same plane.
    let energy = bench.rest(1);
    bench.edit(Edit::Normal { surface: SURFACE, point, normal: Some(dvec3(-2.0, 0.0, -4.0)) });
    let same = bench.rest(600);
    assert!((energy / same - 1.0).abs() < 1e-4, "{energy} and {same}");
    bench.edit(Edit::Normal { surface: SURFACE, point, normal: None });
    bench.rest(600);
    assert_eq!(bench.document().surfaces, document_of(&document).surfaces);
    // The control goes, and what was prescribed at it.
    bench.edit(Edit::Normal { surface: SURFACE, point, normal });
    bench.edit(Edit::Release { point });
    assert!(bench.document().surfaces[&SURFACE].normals.is_empty());
}

fn document_of(text: &str) -> Document {
    from_text(text).unwrap()
}

/// Largest distance of vertices from where they were.
fn moved(bench: &Bench, before: &[DVec3]) -> f64 {
    places(bench).iter().zip(before).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

#[test]
fn a_ribbon_as_the_surface_leaves_its_rim_now_keeps_the_shape_and_what_is_given() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let (before, calm) = (bench.document.clone(), places(&bench));
    let now = Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Now) };
    bench.edit(now.clone());
    bench.rest(600);
    let document = bench.document();
    let cross = document.surfaces[&SURFACE].ribbons[&RIM].cross.clone();
    assert!(cross.keys().copied().eq(document.curves[&RIM].through.iter().copied().collect::<BTreeSet<_>>()));
    for (point, direction) in &cross {
        let inwards = -document.points[point].normalize_or_zero();
        assert!(direction.dot(inwards) > 0.5 && (direction.length() - 1.0).abs() < 1e-6, "{direction}");
    }
    // Between the points the plane is carried, not kept.
    println!("moved by {}", moved(&bench, &calm));
    assert!(moved(&bench, &calm) < 0.02, "{}", moved(&bench, &calm));
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
    // A direction that is given stays; the others come beside it.
    let (point, given) = (*cross.keys().next_back().unwrap(), DVec3::Z);
    let leave = Some(Leave::Cross([(point, given)].into()));
    bench.edit(Edit::Ribbon { surface: SURFACE, curve: RIM, leave });
    bench.edit(now);
    let ribbon = &bench.document().surfaces[&SURFACE].ribbons[&RIM];
    assert_eq!((ribbon.cross.len(), ribbon.cross[&point]), (cross.len(), given));
}

/// Drags a handle so many steps towards a direction; the hand sometimes says nothing.
fn turn(bench: &mut Bench, handle: Handle, foot: DVec3, from: DVec3, to: DVec3, steps: u32) {
    bench.accept(Request::Grab(GrabTarget::Handle(handle)));
    for step in 1..=steps {
        bench.step(Some(foot + from.lerp(to, f64::from(step) / f64::from(steps)) * 0.4));
        for nothing in [DVec3::NAN, foot, foot + DVec3::X * 1e-12] {
            bench.step(Some(nothing));
        }
    }
}

#[test]
fn handles_turn_a_ribbon_and_a_normal_in_one_act_and_cancel_puts_them_back() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let (top, rim) = (PointId(5), bench.document().curves[&RIM].through[0]);
    bench.edit(Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Now) });
    bench.edit(Edit::Normal { surface: SURFACE, point: top, normal: Some(DVec3::Z) });
    bench.rest(600);
    let points = bench.document().points.clone();
    let ribbon = Handle::Ribbon { surface: SURFACE, curve: RIM, point: rim };
    let normal = Handle::Normal { surface: SURFACE, point: top };
    let along = dvec3(-points[&rim].y, points[&rim].x, 0.0).normalize_or_zero();
    for (handle, point, act, to) in [
        // What of the hand's direction runs along the rim does not count.
        (ribbon, rim, "Ribbon", DVec3::Z - points[&rim] * 0.3 + along * 0.4),
        (normal, top, "Normal", dvec3(0.6, 0.1, 1.0)),
    ] {
        let prescribed = |bench: &Bench| {
            let surface = bench.document().surfaces[&SURFACE].clone();
            if handle == ribbon { surface.ribbons[&RIM].cross[&point] } else { surface.normals[&point] }
        };
        let (before, shape, from) = (bench.document.clone(), places(&bench), prescribed(&bench));
        turn(&mut bench, handle, points[&point], from, to, 12);
        assert_eq!(bench.document, before, "a drag in progress is not committed");
        assert!(moved(&bench, &shape) > 1e-3, "{act}: the surface follows the hand");
        bench.accept(Request::Cancel);
        assert_eq!(
            (bench.modeler.model().document.as_ref(), places(&bench)),
            (&bench.document(), shape.clone())
        );
        turn(&mut bench, handle, points[&point], from, to, 12);
        assert_eq!(bench.accept(Request::Drop).committed.unwrap().act, act);
        bench.rest(600);
        let wanted = if handle == ribbon { to - along * to.dot(along) } else { to };
        let kept = prescribed(&bench);
        assert!(kept.angle_between(wanted) < 0.02, "{act}: {kept} for {wanted}");
        assert!((kept.length() - 1.0).abs() < 1e-3);
        assert_eq!(from_text(&to_text(&bench.document())).unwrap(), bench.document());
        // The surface has that plane there.
        let model = bench.modeler.model();
        let bound = bench.modeler.relaxer().surface(SURFACE, &model.surfaces[&SURFACE]).unwrap();
        let positions = &model.surfaces[&SURFACE].positions;
        let near = bound.vertices().iter().zip(bound.normals());
        let (_, plane) = near
            .min_by(|a, b| {
                let off = |v: ductile_mesh::VertexId| positions[v.index()].distance(points[&point]);
                off(*a.0).total_cmp(&off(*b.0))
            })
            .unwrap();
        let angle = if handle == ribbon { plane.dot(kept) } else { plane.cross(kept).length() };
        assert!(angle.abs() < 1e-3, "{act}: {plane} and {kept}");
        // What undo and redo bring back is at rest as it was.
        let energy = bench.rest(1);
        bench.accept(Request::Undo);
        bench.accept(Request::Redo);
        let again = bench.rest(1);
        assert!((again / energy - 1.0).abs() < 1e-12, "{act}: {again} for {energy}");
        // The whole drag is one act, and a press without a turn is none.
        bench.accept(Request::Undo);
        assert_eq!((bench.document.clone(), places(&bench)), (before.clone(), shape));
        turn(&mut bench, handle, points[&point], from, to, 0);
        assert!(bench.accept(Request::Drop).committed.is_none());
        assert_eq!(bench.document, before);
    }
}

#[test]
fn handles_of_what_is_not_prescribed_are_refused() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.rest(600);
    let (top, rim) = (PointId(5), bench.document().curves[&RIM].through[0]);
    bench.edit(Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Now) });
    for (handle, reason) in [
        (Handle::Normal { surface: SURFACE, point: top }, "no direction is prescribed"),
        (Handle::Normal { surface: SurfaceId(9), point: top }, "does not exist"),
        (Handle::Ribbon { surface: SURFACE, curve: CurveId(7), point: rim }, "no direction is prescribed"),
        (Handle::Ribbon { surface: SURFACE, curve: RIM, point: top }, "no direction is prescribed"),
    ] {
        let refused = bench.send(Request::Grab(GrabTarget::Handle(handle))).refused.unwrap();
        assert!(refused.reason.contains(reason), "{}", refused.reason);
    }
}

#[test]
fn what_cannot_be_is_refused_and_changes_nothing() {
    let mut bench = Bench::with(Example::Disc);
    bench.rest(300);
    let rim = bench.document().curves[&RIM].through.clone();
    let at = bench.document().points[&rim[0]];
    let along = dvec3(-at.y, at.x, 0.0);
    let normal = |point, normal| Edit::Normal { surface: SURFACE, point, normal: Some(normal) };
    let cross = |point, cross| {
        let leave = Some(Leave::Cross([(point, cross)].into()));
        Edit::Ribbon { surface: SURFACE, curve: RIM, leave }
    };
    let angle = |angle| Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Angle(angle)) };
    let nothing = Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Cross([].into())) };
    for (edit, reason) in [
        (normal(rim[0], along), "runs along"),
        (normal(rim[0], DVec3::ZERO), "no direction"),
        (normal(rim[0], DVec3::NAN), "must be numbers"),
        (normal(PointId(99), DVec3::Z), "does not exist"),
        (cross(rim[0], along), "runs along"),
        (cross(rim[0], DVec3::ZERO), "no direction"),
        (cross(rim[0], DVec3::X * f64::INFINITY), "must be numbers"),
        (cross(PointId(99), DVec3::Z), "does not pass"),
        (nothing, "no direction anywhere"),
        (angle(f64::NAN), "between -180"),
        (angle(4.0), "between -180"),
        (
            Edit::Ribbon { surface: SurfaceId(7), curve: RIM, leave: Some(Leave::Angle(0.0)) },
            "does not exist",
        ),
        (
            Edit::Ribbon { surface: SURFACE, curve: CurveId(7), leave: Some(Leave::Angle(0.0)) },
            "does not lie",
        ),
    ] {
        let before = bench.document.clone();
        let refused = bench.send(Request::Edit(edit.clone())).refused;
        let text = refused.map(|refusal| refusal.reason).unwrap_or_default();
        assert!(text.contains(reason), "{edit:?}: {text}");
        assert_eq!(bench.document, before);
    }
    bench.edit(Edit::Objective { of: ObjectiveOf::Document, objective: Some(Objective::Membrane) });
    let refused = bench.send(Request::Edit(angle(0.5))).refused.unwrap();
    assert!(refused.reason.contains("membrane"), "{}", refused.reason);
}

#[test]
fn documents_with_planes_without_sense_open_and_come_to_rest() {
    let mut document = ductile_modeler::example(Example::RaisedDisc);
    let rim = document.curves[&RIM].through.clone();
    let at = |point: &PointId| document.points[point];
    let along = |point: &PointId| dvec3(-at(point).y, at(point).x, 0.0);
    let cross =
        [(rim[0], along(&rim[0])), (rim[1], DVec3::Z), (rim[2], at(&rim[2])), (rim[3], -at(&rim[3]))].into();
    let normals =
        [(rim[0], along(&rim[0]) * 1e6), (PointId(5), DVec3::X * 1e-9), (PointId(6), -DVec3::Z)].into();
    let surface = document.surfaces.get_mut(&SURFACE).unwrap();
    (surface.ribbons, surface.normals) = ([(RIM, Ribbon::directed(cross))].into(), normals);
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    let energy = bench.rest(600);
    assert!(energy.is_finite());
    assert!(places(&bench).iter().all(|p| p.is_finite() && p.length() < 20.0));
}

const COLLAR: SurfaceId = SurfaceId(2);
const SECTORS: u32 = 24;

/// A fair disc on a circle of radius 1, and under its rim a collar over a cage, which widens to twice that by a unit of height.
fn disc_on_a_collar() -> Bench {
    let mut document = fair_disc().document();
    let ring = |radius: f64, height: f64| {
        move |k: u32| {
            let angle = f64::from(k) * std::f64::consts::TAU / f64::from(SECTORS);
            dvec3(radius * libm::cos(angle), radius * libm::sin(angle), height)
        }
    };
    let point = |row: u32, k: u32| PointId(100 + row * SECTORS + k % SECTORS);
    for row in 0..3 {
        let height = 0.5 * f64::from(row);
        let place = ring(1.0 + height, -height);
        document.points.extend((0..SECTORS).map(|k| (point(row, k), place(k))));
    }
    let quad = |(row, k): (u32, u32)| {
        vec![point(row, k), point(row + 1, k), point(row + 1, k + 1), point(row, k + 1)]
    };
    let faces = (0..2).flat_map(|row| (0..SECTORS).map(move |k| (row, k))).map(quad);
    document.cages.insert(COLLAR, Cage::new(faces.collect()));
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    bench.rest(600);
    bench
}

/// The largest angle, in degrees, between the tangent planes of disc and collar at the vertices of the disc's rim.
fn seam(bench: &Bench) -> f64 {
    let model = bench.modeler.model();
    let (shape, patch) = (&model.surfaces[&SURFACE], &model.patches[&COLLAR]);
    let bound = bench.modeler.relaxer().surface(SURFACE, shape).unwrap();
    let angles = bound.vertices().iter().zip(bound.normals()).filter_map(|(v, normal)| {
        let at = shape.positions[v.index()];
        let near = patch.positions().iter().zip(patch.normals());
        let (_, other) = near.min_by(|a, b| a.0.distance(at).total_cmp(&b.0.distance(at)))?;
        let angle = libm::acos(normal.dot(*other).abs().min(1.0)).to_degrees();
        shape.mesh.is_boundary_vertex(*v).then_some(angle)
    });
    angles.fold(0.0, f64::max)
}

#[test]
fn a_fair_surface_goes_on_smoothly_from_an_exact_one_and_follows_it() {
    let mut bench = disc_on_a_collar();
    let before = bench.document.clone();
    assert!((seam(&bench) - 45.0).abs() < 1.0, "a flat lid on a cone: {}", seam(&bench));
    let onto = |surface| Edit::Ribbon { surface: SURFACE, curve: RIM, leave: Some(Leave::Onto(surface)) };
    bench.edit(onto(COLLAR));
    bench.rest(600);
    println!("joined: {}", seam(&bench));
    assert!(seam(&bench) < 0.5, "{}", seam(&bench));
    assert!(off_cap(&bench, FRAC_PI_4) < 0.02, "it rises to a cap: {}", off_cap(&bench, FRAC_PI_4));

    // The rim of the collar stays, its skirt is pulled up on one side: the cap leans.
    let skirt = PointId(100 + SECTORS);
    let at = bench.document().points[&skirt];
    bench.accept(Request::Grab(GrabTarget::Point(skirt)));
    for step in 1..=10 {
        bench.step(Some(at + DVec3::Z * 0.03 * f64::from(step)));
    }
    bench.accept(Request::Drop);
    bench.rest(600);
    println!("dragged: {}", seam(&bench));
    assert!(seam(&bench) < 1.5, "{}", seam(&bench));
    assert!(off_cap(&bench, FRAC_PI_4) > 0.02, "it followed");

    // The same from the text; without the collar it is free; undo leads all the way back.
    let mut other = Bench::new();
    other.accept(Request::OpenText { text: to_text(&bench.document()) });
    other.rest(600);
    assert!(seam(&other) < 1.5, "{}", seam(&other));
    bench.edit(Edit::DeleteSurface { surface: COLLAR });
    assert!(bench.document().surfaces[&SURFACE].ribbons.is_empty());
    for _ in 0..3 {
        bench.accept(Request::Undo);
    }
    assert_eq!(bench.document, before);

    // Not from itself, not from what is not there, not from what does not reach the curve.
    for (edit, reason) in [(onto(SURFACE), "no fill"), (onto(SurfaceId(9)), "no fill")] {
        let text = bench.send(Request::Edit(edit)).refused.unwrap().reason;
        assert!(text.contains(reason), "{text}");
    }
    let far = bench.document().points[&PointId(100)] + DVec3::X * 3.0;
    bench.edit(Edit::Move { point: PointId(100), to: far });
    for k in 1..SECTORS {
        let to = bench.document().points[&PointId(100 + k)] * 4.0;
        bench.edit(Edit::Move { point: PointId(100 + k), to });
    }
    let text = bench.send(Request::Edit(onto(COLLAR))).refused.unwrap().reason;
    assert!(text.contains("rim"), "{text}");
}
