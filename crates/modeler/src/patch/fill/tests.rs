//! Fills in a model: loops of free curves, holes in fair surfaces, patches beside patches.

mod corners;
mod degrees;
mod lean;
mod mixed;
mod valence;

use super::*;
use crate::modeler::Modeler;
use ductile_spec::{
    CurveId, CurveStretch, Document, Edit, GrabTarget, Hole, PointId, Reply, Request, Seams, Step, Through,
};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn ask(modeler: &mut Modeler, request: Request) -> Reply {
    let reply = modeler.handle(request);
    assert_eq!(reply.refused, None);
    reply
}

fn rest(modeler: &mut Modeler) {
    for _ in 0..2000 {
        if ask(modeler, Request::Step(Step { drag: None, iterations: 50 })).frame.settled {
            return;
        }
    }
    panic!("no rest");
}

fn edit(modeler: &mut Modeler, edit: Edit) -> Reply {
    ask(modeler, Request::Edit(edit))
}

fn point(modeler: &mut Modeler, at: [f64; 3]) -> PointId {
    edit(modeler, Edit::Point { at: DVec3::from(at) });
    *modeler.model().document.points.keys().next_back().unwrap()
}

/// An open curve through points and places.
fn curve(modeler: &mut Modeler, through: Vec<Through>) -> CurveId {
    edit(modeler, Edit::Curve { through, closed: false });
    *modeler.model().document.curves.keys().next_back().unwrap()
}

/// Points on a circle, at a height that goes up and down a little.
fn ring(modeler: &mut Modeler, n: u32, radius: f64, wave: f64) -> Vec<PointId> {
    let place = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * core::f64::consts::TAU / f64::from(n));
        [radius * cos, radius * sin, if k.is_multiple_of(2) { wave } else { -wave }]
    };
    (0..n).map(|k| point(modeler, place(k))).collect()
}

/// A curve between two points, which bulges by a vector in the middle.
fn arc(modeler: &mut Modeler, from: PointId, to: PointId, bulge: DVec3) -> CurveId {
    let at = |point: PointId| modeler.model().document.points[&point];
    let middle = (at(from) + at(to)) * 0.5 + bulge;
    curve(modeler, vec![Through::Point(from), Through::Place(middle), Through::Point(to)])
}

/// A loop of five curves.
fn pentagon() -> (Modeler, Vec<PointId>, Vec<CurveId>) {
    let mut modeler = Modeler::new();
    let corners = ring(&mut modeler, 5, 1.0, 0.15);
    let curves = (0..5)
        .map(|k| arc(&mut modeler, corners[k], corners[(k + 1) % 5], DVec3::new(0.0, 0.0, 0.12)))
        .collect();
    rest(&mut modeler);
    (modeler, corners, curves)
}

fn near(curve: CurveId) -> Edit {
    Edit::Fill { hole: Hole::Near { curve, at: None }, style: FillStyle::default() }
}

fn seams(modeler: &mut Modeler) -> Seams {
    ask(modeler, Request::Seams).seams.unwrap()
}

fn mesh(modeler: &Modeler, id: u32) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let shape = &modeler.model().patches[&SurfaceId(id)];
    (shape.positions().to_vec(), shape.triangles().to_vec())
}

/// The distance of a place from the nearest vertex of a fill.
fn distance(modeler: &Modeler, id: u32, at: DVec3) -> f64 {
    mesh(modeler, id).0.iter().map(|vertex| vertex.distance(at)).fold(f64::INFINITY, f64::min)
}

#[test]
fn five_free_curves_are_filled_and_the_patch_follows_them() {
    let (mut modeler, corners, curves) = pentagon();
    let before = modeler.model().document.clone();
    let reply = edit(&mut modeler, near(curves[2]));
    let span = reply.structure.unwrap().surfaces[0];
    assert_eq!(
        (span.id, span.kind, span.summary.euler, span.summary.boundaries),
        (SurfaceId(1), ductile_spec::SurfaceKind::Fill, 1, 1)
    );
    let fill = modeler.model().document.fills[&SurfaceId(1)].clone();
    assert_eq!(fill.sides.len(), 5);
    assert!(fill.sides.iter().all(|side| side.planes.is_none()));
    let figures = seams(&mut modeler).fills.remove(0);
    assert_eq!((figures.degree, figures.control_points, figures.stuck), (7, 1001, None));
    println!("pentagon: curves deviate by {:e}", figures.curve_deviation);
    assert!(figures.curve_deviation < 1e-3, "{}", figures.curve_deviation);
    // All normals to one side: the patch does not fold.
    assert!(modeler.model().patches[&SurfaceId(1)].normals().iter().all(|n| n.z.abs() > 0.5));
    // It follows a corner in the middle of a drag, and comes back with undo.
    let filled = mesh(&modeler, 1);
    ask(&mut modeler, Request::Grab(GrabTarget::Point(corners[0])));
    let target = DVec3::new(1.4, 0.1, 0.4);
    ask(&mut modeler, Request::Step(Step { drag: Some(target), iterations: 20 }));
    for _ in 0..3 {
        ask(&mut modeler, Request::Step(Step { drag: None, iterations: 20 }));
    }
    assert!(distance(&modeler, 1, target) < 1e-12);
    ask(&mut modeler, Request::Drop);
    ask(&mut modeler, Request::Undo);
    assert!(mesh(&modeler, 1) == filled);
    ask(&mut modeler, Request::Undo);
    assert_eq!((&modeler.model().document, modeler.model().patches.len()), (&before, 0));
    ask(&mut modeler, Request::Redo);
    assert!(mesh(&modeler, 1) == filled);
    // Opened again it is the same, once the curves rest where they rested.
    let text = ductile_spec::to_text(&modeler.model().document);
    let mut again = Modeler::new();
    ask(&mut again, Request::OpenText { text });
    assert_eq!(again.model().document, modeler.model().document);
    rest(&mut again);
    let (one, other) = (mesh(&modeler, 1), mesh(&again, 1));
    assert_eq!(one.1, other.1);
    let off = one.0.iter().zip(&other.0).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(off < 1e-6, "{off:e}");
}

/// Two loops with a curve in common: a pentagon and a square beside it.
fn neighbours() -> (Modeler, Vec<CurveId>) {
    let (mut modeler, corners, mut curves) = pentagon();
    let far = [[2.2, 0.2, -0.1], [1.5, 1.9, 0.1]].map(|at| point(&mut modeler, at));
    let up = DVec3::new(0.0, 0.0, 0.1);
    curves.push(arc(&mut modeler, corners[0], far[0], up));
    curves.push(arc(&mut modeler, far[0], far[1], up));
    curves.push(arc(&mut modeler, far[1], corners[1], up));
    rest(&mut modeler);
    (modeler, curves)
}

/// Vertices of two fills that are one to the bit.
fn common(modeler: &Modeler, one: u32, other: u32) -> usize {
    let (one, other) = (mesh(modeler, one).0, mesh(modeler, other).0);
    one.iter().filter(|at| other.contains(at)).count()
}

#[test]
fn a_fill_beside_a_fill_takes_its_planes_and_shares_its_points() {
    let (mut modeler, curves) = neighbours();
    edit(&mut modeler, near(curves[2]));
    edit(&mut modeler, near(curves[6]));
    rest(&mut modeler);
    let second = modeler.model().document.fills[&SurfaceId(2)].clone();
    let shared = second.sides.iter().find(|side| side.curve == curves[0]).unwrap();
    assert_eq!(shared.planes, Some(SurfaceId(1)));
    assert_eq!(common(&modeler, 1, 2), 17);
    let found = seams(&mut modeler);
    let [seam] = found.seams[..] else { panic!("{found:?}") };
    println!("taken: {seam:?}\n{:?}", found.fills);
    assert_eq!(seam.surfaces, [SurfaceId(1), SurfaceId(2)]);
    assert!(seam.gap < 1e-12 && seam.angle < 0.2 && seam.without_normal == 0, "{seam:?}");
    // They wind alike: the common side is run through in opposite directions.
    let first = modeler.model().document.fills[&SurfaceId(1)].clone();
    let own = first.sides.iter().find(|side| side.curve == curves[0]).unwrap();
    assert_eq!((own.from, own.to), (shared.to, shared.from));
    // Without the first, the second stays, with planes of its own.
    edit(&mut modeler, Edit::DeleteSurface { surface: SurfaceId(1) });
    assert!(modeler.model().document.fills[&SurfaceId(2)].sides.iter().all(|side| side.planes.is_none()));
}

#[test]
fn a_network_is_filled_at_once_and_its_patches_agree() {
    let (mut modeler, curves) = neighbours();
    edit(&mut modeler, Edit::FillNetwork { curve: Some(curves[0]), style: FillStyle::default() });
    rest(&mut modeler);
    assert_eq!(modeler.model().document.fills.len(), 2);
    assert_eq!(common(&modeler, 1, 2), 17);
    let found = seams(&mut modeler);
    let [seam] = found.seams[..] else { panic!("{found:?}") };
    println!("agreed: {seam:?}\n{:?}", found.fills);
    assert!(seam.gap < 1e-12 && seam.angle < 0.2, "{seam:?}");
    let again = Request::Edit(Edit::FillNetwork { curve: None, style: FillStyle::default() });
    let refused = modeler.handle(again).refused.unwrap();
    assert!(refused.reason.contains("no loop"), "{refused:?}");
}

#[test]
fn what_a_fill_hangs_on_stays_and_what_cannot_be_filled_is_named() {
    let (mut modeler, corners, curves) = pentagon();
    edit(&mut modeler, near(curves[0]));
    let before = modeler.model().document.clone();
    for act in [Edit::DeleteCurve { curve: curves[1] }, Edit::Release { point: corners[2] }, near(curves[0])]
    {
        let refused = modeler.handle(Request::Edit(act)).refused;
        assert!(refused.is_some());
        assert_eq!(modeler.model().document, before);
    }
    // A closed curve is round: a patch in it would have no planes at its corners.
    let places = [[4.0, 0.0, 0.0], [5.0, 1.0, 0.0], [4.0, 2.0, 0.0], [3.0, 1.0, 0.0]];
    let through = places.map(|at| Through::Place(DVec3::from(at))).to_vec();
    edit(&mut modeler, Edit::Curve { through, closed: true });
    rest(&mut modeler);
    let (circle, round) =
        modeler.model().document.curves.last_key_value().map(|(id, c)| (*id, c.through.clone())).unwrap();
    let refused = modeler.handle(Request::Edit(near(circle))).refused.unwrap();
    assert!(refused.reason.contains("0 corners"), "{refused:?}");
    let corners = Edit::Fill {
        hole: Hole::Corners { curve: circle, points: round.clone() },
        style: FillStyle::default(),
    };
    let refused = modeler.handle(Request::Edit(corners)).refused.unwrap();
    assert!(
        refused.reason.contains(&round[0].to_string()) && refused.reason.contains("turns by 0°"),
        "{refused:?}"
    );
    // Up to its curves only it can be filled all the same.
    let style = FillStyle { join: FillJoin::Position, ..FillStyle::default() };
    edit(&mut modeler, Edit::Fill { hole: Hole::Corners { curve: circle, points: round }, style });
    assert_eq!(modeler.model().document.fills.len(), 2);
    assert_eq!(seams(&mut modeler).fills[1].degree, 7);
}

#[test]
fn ribbons_of_a_document_are_filled_and_bad_ones_are_refused() {
    let corners =
        [[0.0, 0.0], [1.0, 0.0], [1.2, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.1 * x * y));
    let rows: Vec<Vec<DVec3>> = (0..4)
        .map(|k| (0..=3).map(|j| corners[k].lerp(corners[(k + 1) % 4], f64::from(j) / 3.0)).collect())
        .collect();
    let ring = ribbons_along(&rows, &[]).unwrap().ribbons;
    let ribbons = ring
        .ribbons()
        .iter()
        .map(|r| ductile_spec::FillRibbon { row0: r.row0.clone(), row1: r.row1.clone() });
    let mut ribbons: Vec<_> = ribbons.collect();
    let mut modeler = Modeler::new();
    edit(&mut modeler, Edit::Fill { hole: Hole::Ribbons(ribbons.clone()), style: FillStyle::default() });
    assert!(distance(&modeler, 1, corners[2]) < 1e-12);
    let text = ductile_spec::to_text(&modeler.model().document);
    let mut again = Modeler::new();
    ask(&mut again, Request::OpenText { text });
    assert_eq!(mesh(&again, 1), mesh(&modeler, 1));
    ribbons[1].row1[1].z += 0.5;
    let act = Edit::Fill { hole: Hole::Ribbons(ribbons.clone()), style: FillStyle::default() };
    let refused = modeler.handle(Request::Edit(act)).refused.unwrap();
    assert!(refused.reason.contains("side 1: point 1 of row 1"), "{refused:?}");
    // What is offered instead moves the twist points half way and the curves not at all.
    let mut mended = Modeler::new();
    edit(&mut mended, refused.remedy.unwrap());
    let made = mended.model().document.fills[&SurfaceId(1)].ribbons.clone();
    let before = ring.ribbons();
    assert!((0..4).all(|k| made[k].row0 == before[k].row0));
    assert!((made[1].row1[1].z - before[1].row1[1].z - 0.25).abs() < 1e-12);
    let mut apart = ribbons.clone();
    apart[2].row0[0].x += 0.5;
    let act = Edit::Fill { hole: Hole::Ribbons(apart), style: FillStyle::default() };
    let refused = modeler.handle(Request::Edit(act)).refused.unwrap();
    assert_eq!(refused.remedy, None, "corners that lie apart bound no hole: {}", refused.reason);
    let mut document = Document::default();
    document.fills.insert(SurfaceId(3), Fill { ribbons, ..Fill::default() });
    let text = ductile_spec::to_text(&document);
    let refused = Modeler::new().handle(Request::OpenText { text }).refused.unwrap();
    assert!(refused.reason.contains("surface 3: side 1"), "{refused:?}");
}

/// A sheet in a square, with a square cut out along curves that cross in it.
fn holed() -> (Modeler, Vec<CurveId>) {
    let mut modeler = Modeler::new();
    let places = [
        [2.0, 0.0, 0.0],
        [1.4, 1.4, 0.2],
        [0.0, 2.0, 0.0],
        [-1.4, 1.4, 0.2],
        [-2.0, 0.0, 0.0],
        [-1.4, -1.4, 0.2],
        [0.0, -2.0, 0.0],
        [1.4, -1.4, 0.2],
    ];
    let through = places.map(|at| Through::Place(DVec3::from(at))).to_vec();
    edit(&mut modeler, Edit::Curve { through, closed: true });
    edit(&mut modeler, Edit::Sheet { boundary: CurveId(1) });
    rest(&mut modeler);
    let surface = SurfaceId(1);
    for along in [
        [[-1.1, -0.6, 0.1], [1.1, -0.6, 0.1]],
        [[-1.1, 0.6, 0.1], [1.1, 0.6, 0.1]],
        [[-0.6, -1.1, 0.1], [-0.6, 1.1, 0.1]],
        [[0.6, -1.1, 0.1], [0.6, 1.1, 0.1]],
    ] {
        let along = along.map(DVec3::from).to_vec();
        edit(&mut modeler, Edit::SLoop { surface, along, closed: false });
        rest(&mut modeler);
    }
    let region = ductile_spec::On { surface, at: DVec3::new(0.0, 0.0, 0.1) };
    edit(&mut modeler, Edit::Burnout { region });
    rest(&mut modeler);
    let curves = modeler.model().document.curves.keys().copied().collect();
    (modeler, curves)
}

#[test]
fn a_hole_in_a_fair_surface_is_filled_in_its_planes() {
    let (mut modeler, curves) = holed();
    edit(
        &mut modeler,
        Edit::Fill {
            hole: Hole::Near { curve: curves[1], at: Some(DVec3::new(0.0, -0.6, 0.1)) },
            style: FillStyle::default(),
        },
    );
    rest(&mut modeler);
    let fill = modeler.model().document.fills.last_key_value().unwrap().1.clone();
    assert_eq!(fill.sides.len(), 4);
    assert!(fill.sides.iter().all(|side| side.planes == Some(SurfaceId(1))), "{fill:?}");
    let found = seams(&mut modeler);
    assert_eq!(found.seams.len(), 4);
    for seam in &found.seams {
        assert!(seam.gap < 1e-4 && seam.angle < 0.5 && seam.curvature_jump < 0.5, "{seam:?}");
    }
}

/// Lifts a corner of the hole by so much, and tells the worst of all seams at rest.
fn lifted(modeler: &mut Modeler, id: SurfaceId, by: f64) -> (f64, f64, f64) {
    let corner = modeler.model().document.fills[&id].sides[0].from;
    let at = modeler.model().document.points[&corner];
    ask(modeler, Request::Grab(GrabTarget::Point(corner)));
    for k in 1..=10 {
        let target = at + DVec3::Z * (by * f64::from(k) / 10.0);
        ask(modeler, Request::Step(Step { drag: Some(target), iterations: 50 }));
    }
    ask(modeler, Request::Drop);
    rest(modeler);
    let found = seams(modeler).seams;
    let most = |of: fn(&ductile_spec::SeamFigures) -> f64| found.iter().map(of).fold(0.0, f64::max);
    (most(|seam| seam.gap), most(|seam| seam.angle), most(|seam| seam.curvature_jump))
}

#[test]
fn a_fill_in_a_fair_surface_stays_smooth_when_a_corner_of_the_hole_is_dragged() {
    // A tenth and a fifth of the model; how near a fill comes to curves that bend so much is for its degree to say.
    for (degree, most) in [(None, [0.1, 0.3]), (Some(5), [0.5, 0.7])] {
        let (mut modeler, curves) = holed();
        let hole = Hole::Near { curve: curves[1], at: Some(DVec3::new(0.0, -0.6, 0.1)) };
        edit(&mut modeler, Edit::Fill { hole, style: FillStyle { degree, ..FillStyle::default() } });
        rest(&mut modeler);
        let id = *modeler.model().document.fills.last_key_value().unwrap().0;
        for (by, most) in [0.3, 0.3].into_iter().zip(most) {
            let (gap, angle, jump) = lifted(&mut modeler, id, by);
            println!("degree {degree:?}: gap {gap:e}, {angle}°, jump {jump}");
            assert!(gap < 1.5e-3 && angle < most && jump < 6.0, "{degree:?}: {gap:e} {angle} {jump}");
        }
        // The fair surface has the plane of both curves at every corner, not only in the report.
        let model = modeler.model();
        let shape = &model.surfaces[&SurfaceId(1)];
        let bound = modeler.relaxer().surface(SurfaceId(1), shape).unwrap();
        let corners = crate::bank::corners(model, SurfaceId(1), shape);
        assert_eq!(corners.len(), 4);
        for (v, wanted) in corners {
            let own = bound.normals()[bound.node(v) as usize];
            assert!(own.cross(wanted.normalize_or_zero()).length() < 1e-4, "{own} {wanted}");
        }
    }
}

#[test]
fn one_of_two_fills_that_join_smoothly_is_not_baked_alone() {
    let (mut modeler, curves) = neighbours();
    edit(&mut modeler, Edit::FillNetwork { curve: Some(curves[0]), style: FillStyle::default() });
    rest(&mut modeler);
    let before = (mesh(&modeler, 1), mesh(&modeler, 2));
    let refused = modeler.handle(Request::Edit(Edit::Bake { surface: SurfaceId(1) })).refused.unwrap();
    assert!(refused.reason.contains("joins surface 1 smoothly along curve 1"), "{}", refused.reason);
    assert!(before == (mesh(&modeler, 1), mesh(&modeler, 2)));
    // Joined by position, the other one stays what it is.
    let style = FillStyle { join: FillJoin::Position, ..FillStyle::default() };
    edit(&mut modeler, Edit::Refill { surface: SurfaceId(2), style });
    rest(&mut modeler);
    let other = mesh(&modeler, 2).0;
    edit(&mut modeler, Edit::Bake { surface: SurfaceId(1) });
    rest(&mut modeler);
    let moved = mesh(&modeler, 2).0.iter().zip(&other).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    // Curves that rested rest a little better.
    assert!(moved < 1e-6, "{moved:e}");
}

/// A square over the whole of a curve, and two below its halves.
#[test]
fn a_long_side_meets_two_short_ones() {
    let mut modeler = Modeler::new();
    let place = |x: f64, y: f64| [x, y, 0.1 * x * (2.0 - x) - 0.2 * y * x];
    let [a, b, c] = [0.0, 1.0, 2.0].map(|x| point(&mut modeler, place(x, 0.0)));
    let [d, e, f] = [0.0, 1.0, 2.0].map(|x| point(&mut modeler, place(x, -1.0)));
    let [g, h] = [0.0, 2.0].map(|x| point(&mut modeler, place(x, 1.5)));
    let long = curve(&mut modeler, [a, b, c].map(Through::Point).to_vec());
    let bulge = DVec3::new(0.0, 0.0, 0.1);
    let arcs: Vec<CurveId> = [(a, d), (d, e), (b, e), (e, f), (f, c), (c, h), (h, g), (g, a)]
        .map(|(from, to)| arc(&mut modeler, from, to, bulge))
        .to_vec();
    rest(&mut modeler);
    for near_to in [arcs[1], arcs[3], arcs[6]] {
        edit(&mut modeler, near(near_to));
    }
    rest(&mut modeler);
    let found = seams(&mut modeler);
    assert!(modeler.model().document.fills.values().all(|fill| fill.sides.len() == 4));
    let along: Vec<_> = found
        .seams
        .iter()
        .filter(|seam| seam.stretch.curve == long)
        .map(|seam| ((seam.stretch.from, seam.stretch.to), seam.surfaces.map(|id| id.0)))
        .collect();
    assert_eq!(along, [((a, b), [1, 3]), ((b, c), [2, 3])]);
    for seam in found.seams.iter().filter(|seam| seam.stretch.curve == long) {
        // The sides are fitted each by itself, so they are near and not one; and they were given no common planes.
        println!("{seam:?}");
        assert!(seam.gap > 0.0 && seam.gap < 1e-2 && seam.angle > 0.0 && seam.angle < 45.0, "{seam:?}");
        assert!(seam.places > 8 && seam.without_normal == 0, "{seam:?}");
    }
}

#[test]
fn parts_of_a_curve_that_two_stretches_share() {
    let (mut modeler, _, curves) = pentagon();
    edit(&mut modeler, near(curves[0]));
    let drawn = |first: usize, edges: usize, from: u32, to: u32| {
        let side = &*modeler.model().patches[&SurfaceId(1)];
        let PatchShape::Fill(shape) = side else { panic!("no fill") };
        let mut drawn = shape.sides[0].drawn.clone();
        drawn.stretch = CurveStretch { curve: CurveId(9), from: PointId(from), to: PointId(to) };
        (drawn.first, drawn.edges) = (first, edges);
        drawn
    };
    let shared = |one, other| {
        let parts = crate::seams::shared(&one, &other, 20);
        parts.iter().map(|part| (part.from.0, part.to.0)).collect::<Vec<_>>()
    };
    let whole = || drawn(0, 19, 1, 5);
    assert_eq!(shared(whole(), drawn(0, 8, 1, 3)), [(1, 3)]);
    assert_eq!(shared(drawn(8, 11, 3, 5), whole()), [(3, 5)]);
    assert_eq!(shared(whole(), drawn(4, 8, 2, 4)), [(2, 4)]);
    assert_eq!(shared(drawn(0, 12, 1, 4), drawn(4, 15, 2, 5)), [(2, 4)]);
    // What only touches shares nothing.
    assert_eq!(shared(drawn(0, 8, 1, 3), drawn(8, 11, 3, 5)), []);
    assert_eq!(shared(drawn(8, 11, 3, 5), drawn(0, 8, 1, 3)), []);
    // Round a closed curve of twenty samples two arcs meet twice.
    assert_eq!(shared(drawn(0, 12, 1, 4), drawn(8, 16, 3, 2)), [(1, 2), (3, 4)]);
    assert_eq!(shared(drawn(15, 10, 7, 2), drawn(0, 8, 1, 3)), [(1, 2)]);
}

#[test]
fn the_whole_net_is_shown_when_asked_for_and_follows_a_hand() {
    let (mut modeler, corners, curves) = pentagon();
    let first = edit(&mut modeler, near(curves[0])).structure.unwrap();
    // Five ribbons of degree 7: two rows of eight with legs between them.
    let counts = |net: &ductile_spec::Net| (net.count, net.edges.len());
    assert_eq!(counts(&first.nets[0]), (80, 5 * (7 + 7 + 8)));
    let filled = mesh(&modeler, 1);
    let style = FillStyle { net: FillNet::Whole, ..FillStyle::default() };
    let whole = edit(&mut modeler, Edit::Refill { surface: SurfaceId(1), style }).structure.unwrap();
    // 1,001 points of depth 10 and five edges around each of the 715 panels of depth 9.
    assert_eq!(counts(&whole.nets[0]), (1001, 5 * 715));
    assert!(mesh(&modeler, 1) == filled, "showing a net changes no shape");
    let corner = modeler.model().document.points[&corners[0]];
    let is_there = |modeler: &Modeler, at: DVec3| {
        modeler.model().patches[&SurfaceId(1)].net().0.iter().any(|place| place.distance(at) < 1e-12)
    };
    assert!(is_there(&modeler, corner));
    let target = DVec3::new(1.4, 0.1, 0.4);
    ask(&mut modeler, Request::Grab(GrabTarget::Point(corners[0])));
    ask(&mut modeler, Request::Step(Step { drag: Some(target), iterations: 20 }));
    ask(&mut modeler, Request::Drop);
    assert!(is_there(&modeler, target) && !is_there(&modeler, corner));
}
