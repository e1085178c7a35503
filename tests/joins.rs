//! Surfaces of different kinds that share a curve: they join smoothly there, and go on doing so while either side is dragged.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{
    CageForm, CageSource, CurveId, Edit, FillStyle, GrabTarget, Hole, Leave, PointId, Request, SeamFigures,
    SurfaceId, Through, from_text, to_text,
};
use glam::{DVec3, dvec3};

const CAGE: SurfaceId = SurfaceId(1);

/// The control point at a place.
fn point_at(bench: &Bench, at: DVec3) -> PointId {
    let document = bench.document();
    let near = document.points.iter().min_by(|a, b| a.1.distance(at).total_cmp(&b.1.distance(at)));
    *near.unwrap().0
}

fn last_curve(bench: &Bench) -> CurveId {
    *bench.document().curves.keys().next_back().unwrap()
}

/// A grid over the square from (-1, -1) to (1, 1), of four by four faces, that bulges.
fn sheet_over_a_cage() -> Bench {
    let mut bench = Bench::new();
    let form = CageSource::BuiltIn { form: CageForm::Grid, centre: DVec3::ZERO, size: 1.0 };
    bench.edit(Edit::Cage { from: form });
    for (point, at) in bench.document().points {
        let height = 0.25 * (1.0 - 0.6 * at.x * at.x) * (1.0 - 0.5 * at.y * at.y);
        bench.edit(Edit::Move { point, to: at + DVec3::Z * height });
    }
    bench
}

fn corner(bench: &Bench, x: f64, y: f64) -> PointId {
    point_at(bench, dvec3(x, y, 0.25 * (1.0 - 0.6 * x * x) * (1.0 - 0.5 * y * y)))
}

/// The rim of the sheet at x = 1, as a curve.
fn rim(bench: &mut Bench) -> CurveId {
    let ends = [corner(bench, 1.0, 0.0), corner(bench, 1.0, 0.5)];
    bench.edit(Edit::Rim { surface: CAGE, ends, between: None });
    last_curve(bench)
}

fn seams(bench: &mut Bench) -> Vec<SeamFigures> {
    bench.accept(Request::Seams).seams.unwrap().seams
}

/// The seam between two surfaces that is worst.
fn seam(bench: &mut Bench, surfaces: [SurfaceId; 2]) -> SeamFigures {
    let all = seams(bench).into_iter();
    let of_both = all.filter(|seam| surfaces.iter().all(|id| seam.surfaces.contains(id)));
    of_both.max_by(|a, b| a.angle.total_cmp(&b.angle)).expect("they share a curve")
}

/// Drags a point there and back to a target, with what is looked at after each step.
fn drag(bench: &mut Bench, point: PointId, to: DVec3, mut look: impl FnMut(&mut Bench)) {
    let at = bench.document().points[&point];
    bench.accept(Request::Grab(GrabTarget::Point(point)));
    for step in 1..=10 {
        bench.step(Some(at.lerp(to, f64::from(step) / 10.0)));
        look(bench);
    }
    bench.accept(Request::Drop);
    bench.rest(600);
}

/// How far the samples of a curve lie from the nearest vertices of the cage's surface, with edges in between.
fn off_rim(bench: &Bench, curve: CurveId) -> f64 {
    let model = bench.modeler.model();
    let patch = &model.patches[&CAGE];
    let places = patch.positions();
    let edges: Vec<[u32; 2]> =
        patch.triangles().iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let to_edge = |at: DVec3, [a, b]: [u32; 2]| {
        let (a, b) = (places[a as usize], places[b as usize]);
        let t = ((at - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        a.lerp(b, t).distance(at)
    };
    let nearest = |at: &DVec3| edges.iter().map(|edge| to_edge(*at, *edge)).fold(f64::INFINITY, f64::min);
    model.curves[&curve].nodes.iter().map(nearest).fold(0.0, f64::max)
}

#[test]
fn a_rim_becomes_a_curve_that_goes_where_its_cage_goes() {
    let mut bench = sheet_over_a_cage();
    bench.edit(Edit::Spacing { of: ductile_spec::SpacingOf::Document, spacing: Some(0.07) });
    let before = bench.document.clone();
    let curve = rim(&mut bench);
    bench.rest(100);
    let led = bench.document().curves[&curve].clone();
    assert_eq!((led.rim, led.closed, led.through.len()), (Some(CAGE), false, 5), "from corner to corner");
    // Chords of the tessellation lie below the rim.
    assert!(off_rim(&bench, curve) < 1e-3, "{}", off_rim(&bench, curve));
    let middle = corner(&bench, 1.0, 0.0);
    let to = bench.document().points[&middle] + dvec3(0.3, 0.1, 0.4);
    drag(&mut bench, middle, to, |bench| {
        assert!(off_rim(bench, curve) < 4e-3, "in the same step: {}", off_rim(bench, curve));
        let model = bench.modeler.model();
        let shape = &model.curves[&curve];
        assert_eq!(shape.nodes[shape.sample_of(middle).unwrap()], model.document.points[&middle]);
    });
    // What it is does not hang on how it came there.
    let text = to_text(&bench.document());
    assert_eq!(from_text(&text).unwrap(), bench.document());
    let mut other = Bench::new();
    other.accept(Request::OpenText { text });
    other.rest(100);
    assert!(off_rim(&other, curve) < 4e-3);
    for _ in 0..2 {
        bench.accept(Request::Undo);
    }
    assert_eq!(bench.document, before);
}

#[test]
fn a_rim_is_chosen_by_an_edge_and_what_is_none_is_refused() {
    let mut bench = sheet_over_a_cage();
    let at = |bench: &Bench, x: f64, y: f64| corner(bench, x, y);
    let [a, b, c, d] = [-0.5, 0.0, 0.5, 1.0].map(|y| at(&bench, 1.0, y));
    let inner = at(&bench, 0.5, 0.0);
    let rim = |ends, between| Edit::Rim { surface: CAGE, ends, between };
    for (edit, reason) in [
        (rim([b, inner], None), "does not end at an edge"),
        (rim([b, d], None), "does not end at an edge"),
        (rim([b, c], Some([c, d])), "does not lie between"),
        (rim([b, c], Some([inner, d])), "does not lie between"),
        (Edit::Rim { surface: SurfaceId(9), ends: [b, c], between: None }, "does not exist"),
    ] {
        let before = bench.document.clone();
        let refused = bench.send(Request::Edit(edit.clone())).refused.map(|refusal| refusal.reason);
        assert!(refused.as_ref().is_some_and(|text| text.contains(reason)), "{edit:?}: {refused:?}");
        assert_eq!(bench.document, before);
    }
    bench.edit(rim([b, c], Some([a, c])));
    let curve = last_curve(&bench);
    let mut through = bench.document().curves[&curve].through.clone();
    through.sort();
    let mut wanted = vec![a, b, c];
    wanted.sort();
    assert_eq!(through, wanted);
    let text = |bench: &mut Bench, edit: Edit| bench.send(Request::Edit(edit)).refused.unwrap().reason;
    assert!(text(&mut bench, rim([b, c], None)).contains("already"));
    let place = bench.modeler.model().curves[&curve].nodes[1];
    assert!(text(&mut bench, Edit::Insert { curve, at: place }).contains("split an edge"));
    let tangent = Edit::Tangent { curve, point: b, direction: Some(DVec3::X) };
    assert!(text(&mut bench, tangent).contains("move the cage"));
    let objective = ductile_spec::ObjectiveOf::Curve(curve);
    let objective = Edit::Objective { of: objective, objective: Some(ductile_spec::Objective::Fair) };
    assert!(text(&mut bench, objective).contains("minimises nothing"));
    // A vertex on an edge of it is one of the curve; without its cage it is a fair curve where it was.
    bench.edit(Edit::SplitEdge { surface: CAGE, ends: [b, c], at: 0.5 });
    let led = bench.document().curves[&curve].clone();
    assert_eq!((led.rim, led.through.len()), (Some(CAGE), 4));
    bench.rest(100);
    bench.edit(Edit::DeleteSurface { surface: CAGE });
    bench.rest(300);
    let free = bench.document().curves[&curve].clone();
    assert_eq!((free.rim, free.through.len()), (None, 4));
    bench.accept(Request::Undo);
    let settings = ductile_spec::CageSettings {
        split: Some(ductile_spec::CageSplit::CatmullClark),
        ..ductile_spec::CageSettings::default()
    };
    bench.edit(Edit::CageSettings { surface: CAGE, settings });
    assert_eq!(bench.document().curves[&curve].rim, None);
}

/// A collar of two rows of faces, that widens downwards from a circle of radius 1.
fn collar() -> Bench {
    const SECTORS: u32 = 24;
    let place = |row: u32, k: u32| {
        let angle = f64::from(k) * std::f64::consts::TAU / f64::from(SECTORS);
        let radius = 1.0 + 0.5 * f64::from(row);
        dvec3(radius * libm::cos(angle), radius * libm::sin(angle), 1.0 - radius)
    };
    let vertices = (0..3).flat_map(|row| (0..SECTORS).map(move |k| place(row, k))).collect();
    let name = |row: u32, k: u32| row * SECTORS + k % SECTORS;
    let face =
        |row: u32, k: u32| vec![name(row, k), name(row + 1, k), name(row + 1, k + 1), name(row, k + 1)];
    let faces = (0..2).flat_map(|row| (0..SECTORS).map(move |k| face(row, k))).collect();
    let mut bench = Bench::new();
    bench.edit(Edit::Cage { from: CageSource::Given { vertices, faces } });
    bench
}

#[test]
fn a_fair_surface_within_the_closed_rim_of_a_cage_goes_on_from_it_while_it_is_dragged() {
    let mut bench = collar();
    let cage = bench.document().cages[&CAGE].clone();
    let from = point_at(&bench, DVec3::X);
    let to = cage.rim()[&from].to;
    bench.edit(Edit::Rim { surface: CAGE, ends: [to, from], between: None });
    let (rim, curve) = bench.document().curves.last_key_value().map(|(id, c)| (*id, c.clone())).unwrap();
    assert!(curve.closed && curve.through.len() == 24, "{curve:?}");
    bench.edit(Edit::Sheet { boundary: rim });
    let lid = SurfaceId(2);
    bench.edit(Edit::Ribbon { surface: lid, curve: rim, leave: Some(Leave::Onto(CAGE)) });
    bench.rest(600);
    let found = seam(&mut bench, [CAGE, lid]);
    println!("lid, at rest: {found:?}");
    assert!(found.gap < 1e-9 && found.angle < 0.5, "{found:?}");
    // A vertex of the rim itself.
    let at = bench.document().points[&from];
    drag(&mut bench, from, at + dvec3(0.1, 0.0, 0.1), |bench| {
        assert!(seam(bench, [CAGE, lid]).gap < 1e-9, "it follows in the same step");
    });
    let found = seam(&mut bench, [CAGE, lid]);
    println!("lid, dragged: {found:?}");
    assert!(found.gap < 1e-9 && found.angle < 3.0, "{found:?}");
}

/// The sheet over a cage, with a fill at its rim whose other sides are three free curves.
fn fill_beside_a_cage() -> (Bench, Vec<CurveId>) {
    let mut bench = sheet_over_a_cage();
    let rim = rim(&mut bench);
    let ends = [-1.0, 1.0].map(|y| corner(&bench, 1.0, y));
    let mut curves = vec![rim];
    let free = |bench: &mut Bench, through: Vec<Through>| {
        bench.edit(Edit::Curve { through, closed: false });
        last_curve(bench)
    };
    let far = [dvec3(2.4, -1.2, -0.3), dvec3(2.3, 1.1, 0.1)];
    let mut corners = Vec::new();
    for (end, far) in ends.into_iter().zip(far) {
        let middle = bench.document().points[&end].lerp(far, 0.5) + DVec3::Z * 0.2;
        curves.push(free(&mut bench, vec![Through::Point(end), Through::Place(middle), Through::Place(far)]));
        corners.push(point_at(&bench, far));
    }
    let outer =
        vec![Through::Point(corners[0]), Through::Place(dvec3(2.6, 0.0, 0.2)), Through::Point(corners[1])];
    curves.push(free(&mut bench, outer));
    bench.rest(300);
    (bench, curves)
}

#[test]
fn a_fill_takes_its_planes_from_a_cage_and_stays_smooth_while_either_is_dragged() {
    let (mut bench, curves) = fill_beside_a_cage();
    let hole = Hole::Near { curve: curves[0], at: None };
    bench.edit(Edit::Fill { hole, style: FillStyle { degree: Some(7), ..FillStyle::default() } });
    bench.rest(300);
    let (fill, sides) =
        bench.document().fills.last_key_value().map(|(id, f)| (*id, f.sides.clone())).unwrap();
    let of_rim = sides.iter().find(|side| side.curve == curves[0]).unwrap();
    assert_eq!(of_rim.planes, Some(CAGE));
    assert_eq!(sides.iter().filter(|side| side.planes.is_some()).count(), 1);
    let found = seam(&mut bench, [CAGE, fill]);
    println!("cage and fill, at rest: {found:?}");
    assert!(found.gap < 1e-3 && found.angle < 0.5, "{found:?}");
    // The end of a curve that leaves the rim, and a point within another one: both go on leaving it in its planes.
    for (point, by) in [
        (point_at(&bench, dvec3(2.4, -1.2, -0.3)), dvec3(0.2, 0.1, 0.5)),
        (bench.document().curves[&curves[2]].through[1], dvec3(0.0, 0.2, 0.3)),
    ] {
        let to = bench.document().points[&point] + by;
        let mut worst = 0.0_f64;
        drag(&mut bench, point, to, |bench| worst = worst.max(seam(bench, [CAGE, fill]).angle));
        let found = seam(&mut bench, [CAGE, fill]);
        println!("cage and fill, {point} dragged by {by}: {found:?}, on the way {worst}");
        assert!(found.gap < 1e-3 && found.angle < 0.5 && worst < 1.0, "{found:?}, {worst}");
    }
    let text = to_text(&bench.document());
    let mut other = Bench::new();
    other.accept(Request::OpenText { text });
    other.rest(300);
    let found = seam(&mut other, [CAGE, fill]);
    assert!(found.gap < 1e-3 && found.angle < 0.5, "opened: {found:?}");
}

/// A vertex of the rim pulled out by a third of an edge. A polynomial side cannot bend as often as four edges may, so what is left is
/// told for what it is: as far as the seam's own figures, which look at the surfaces themselves, say.
#[test]
fn a_side_that_winds_along_a_rim_has_a_high_degree_and_tells_what_it_misses() {
    for (by, most) in [(dvec3(0.17, 0.0, 0.0), 1.0), (dvec3(0.0, 0.0, 0.17), 4.5)] {
        let (mut bench, curves) = fill_beside_a_cage();
        bench.edit(Edit::Fill {
            hole: Hole::Near { curve: curves[0], at: None },
            style: FillStyle::default(),
        });
        let fill = *bench.document().fills.last_key_value().unwrap().0;
        let point = corner(&bench, 1.0, 0.0);
        let at = bench.document().points[&point];
        drag(&mut bench, point, at + by, |_| {});
        let found = seam(&mut bench, [CAGE, fill]);
        let figures = bench.accept(Request::Seams).seams.unwrap().fills.remove(0);
        println!("{by}: {found:?}, {figures:?}");
        assert_eq!(figures.degree, 10);
        assert!(found.gap < 5e-3 && found.angle < most, "{found:?}");
        assert!(figures.plane_deviation > 0.8 * found.angle, "{figures:?} {found:?}");
        assert!(figures.curve_deviation > 0.8 * found.gap, "{figures:?} {found:?}");
    }
}
