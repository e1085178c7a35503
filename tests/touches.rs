//! Curves, rims and surfaces that touch: what would be pinched there is refused with the place, and what can be joined is
//! joined. A refusal changes nothing.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::kinds::kinds;
use acceptance::round::Round;
use acceptance::{Bench, shapes};
use ductile_spec::{
    Border, CurveId, Edit, Objective, ObjectiveOf, On, PointId, Request, SpacingOf, SurfaceId, Through,
    to_compact_text,
};
use glam::{DVec3, dvec3};
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

fn on(surface: u32, at: DVec3) -> On {
    On { surface: SurfaceId(surface), at }
}

/// Four places round a centre: two axes, and the angle of the first.
fn round(centre: DVec3, [u, v]: [DVec3; 2], from: f64) -> Vec<Through> {
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(from + f64::from(k) * FRAC_PI_2);
        Through::Place(centre + u * cos + v * sin)
    };
    (0..4).map(corner).collect()
}

fn curve(bench: &mut Bench, through: Vec<Through>, closed: bool) {
    bench.edit(Edit::Curve { through, closed });
}

fn spacing(bench: &mut Bench, spacing: f64) {
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(spacing) });
}

fn sweep(from: u32, to: u32) -> Edit {
    Edit::Sweep { from: CurveId(from), to: CurveId(to), stretches: [None; 2], reversed: false }
}

fn glue(from: On, to: On, skirt: bool) -> Edit {
    Edit::Glue { from, to, skirt, reversed: false }
}

fn trim(first: On, second: On) -> Edit {
    Edit::Trim { first, second, smooth: false, ribbon: None }
}

fn refusal(bench: &mut Bench, edit: Edit) -> String {
    let before = bench.document.clone();
    let reply = bench.send(Request::Edit(edit));
    assert_eq!(bench.document, before);
    reply.refused.expect("it must be refused").reason
}

fn kinds_of(bench: &Bench) -> Vec<(i64, usize, bool)> {
    kinds(bench.modeler.model()).into_iter().map(|(_, kind)| kind).collect()
}

#[test]
fn nothing_is_swept_between_curves_that_have_a_place_in_common() {
    // A point that both run through; another one at the same place; two strips that would be pinched at both ends.
    let mut bench = Bench::new();
    curve(&mut bench, round(DVec3::ZERO, [DVec3::X, DVec3::Y], 0.0), true);
    let others = |first: Through| {
        let places = [dvec3(2.0, 1.0, 0.5), dvec3(3.0, 0.0, 0.5), dvec3(2.0, -1.0, 0.5)];
        [first].into_iter().chain(places.map(Through::Place)).collect()
    };
    curve(&mut bench, others(Through::Point(PointId(1))), true);
    let why = refusal(&mut bench, sweep(1, 2));
    assert!(why.contains("share point 1"), "{why}");
    curve(&mut bench, others(Through::Place(DVec3::X)), true);
    let why = refusal(&mut bench, sweep(1, 3));
    assert!(why.contains("[1, 0, 0] in common") && why.contains("pinched"), "{why}");
    for height in [0.2, 1.0] {
        let through = [DVec3::ZERO, dvec3(1.0, height, 0.0), DVec3::X * 2.0].map(Through::Place);
        curve(&mut bench, through.to_vec(), false);
    }
    let why = refusal(&mut bench, sweep(4, 5));
    assert!(why.contains("[0, 0, 0] in common"), "{why}");
}

#[test]
fn no_band_is_laid_between_rims_that_meet_but_they_can_be_joined_without() {
    for is_split in [false, true] {
        let mut bench = Bench::new();
        curve(&mut bench, round(DVec3::ZERO, [DVec3::X, DVec3::Y], 0.0), true);
        bench.edit(Edit::Sheet { boundary: CurveId(1) });
        let along = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|at| at * 0.5);
        bench.edit(Edit::SLoop { surface: SurfaceId(1), along: along.to_vec(), closed: true });
        let border = Border::Curve(CurveId(2));
        bench.edit(if is_split { Edit::Split { border } } else { Edit::Crease { border } });
        assert_eq!(kinds_of(&bench), [(0, 2, true), (1, 1, true)]);
        let (from, to) = (on(1, DVec3::X * 0.5), on(2, DVec3::X * 0.4));
        let why = refusal(&mut bench, glue(from, to, true));
        assert!(why.contains("rims meet at") && why.contains("without"), "{why}");
        bench.edit(glue(from, to, false));
        assert_eq!(kinds_of(&bench), [(1, 1, true)]);
        assert!(bench.rest(600) < 1e-9, "a flat disc again");
    }
    // Rims that have a single point in common.
    let mut bench = Bench::new();
    curve(&mut bench, round(DVec3::ZERO, [DVec3::X, DVec3::Y], 0.0), true);
    let rest = [dvec3(1.0, 1.0, 1.0), dvec3(1.0, 0.0, 2.0), dvec3(1.0, -1.0, 1.0)].map(Through::Place);
    curve(&mut bench, [Through::Point(PointId(1))].into_iter().chain(rest).collect(), true);
    for k in 1..3 {
        bench.edit(Edit::Sheet { boundary: CurveId(k) });
    }
    let why = refusal(&mut bench, glue(on(1, DVec3::X), on(2, DVec3::X), true));
    assert!(why.contains("rims meet at [1, 0, 0]"), "{why}");
}

/// A dome over the unit disc with its top at 0.6, and a disc of radius 1.6 at a height.
fn dome_and_disc(height: f64) -> Bench {
    let mut bench = Bench::new();
    curve(&mut bench, round(DVec3::ZERO, [DVec3::X, DVec3::Y], 0.0), true);
    bench.edit(Edit::Sheet { boundary: CurveId(1) });
    spacing(&mut bench, 0.14);
    bench.rest(600);
    bench.edit(Edit::Pin { surface: SurfaceId(1), at: DVec3::ZERO });
    bench.edit(Edit::Move { point: PointId(5), to: DVec3::Z * 0.6 });
    bench.rest(600);
    curve(&mut bench, round(DVec3::Z * height, [DVec3::X * 1.6, DVec3::Y * 1.6], FRAC_PI_4), true);
    bench.edit(Edit::Sheet { boundary: CurveId(2) });
    bench.rest(600);
    bench
}

#[test]
fn surfaces_that_touch_in_a_point_are_not_trimmed_and_a_small_hole_is_cut() {
    let parts = |height: f64| [on(1, dvec3(0.9, 0.0, 0.1)), on(2, dvec3(1.3, 0.0, height))];
    for (height, says) in
        [(0.601, "do not meet"), (0.6, "do not meet"), (0.5999, "only touch"), (0.598, "only touch")]
    {
        let [first, second] = parts(height);
        let why = refusal(&mut dome_and_disc(height), trim(first, second));
        assert!(why.contains(says), "{height}: {why}");
    }
    for height in [0.59, 0.55] {
        let mut bench = dome_and_disc(height);
        let [first, second] = parts(height);
        bench.edit(trim(first, second));
        assert_eq!(kinds_of(&bench), [(0, 2, true); 2], "{height}");
        bench.rest(600);
    }
}

#[test]
fn surfaces_that_lie_on_one_another_are_not_trimmed() {
    let mut bench = Bench::new();
    for (k, centre) in [(1, DVec3::ZERO), (2, dvec3(1.2, 0.1, 0.0))] {
        curve(&mut bench, round(centre, [DVec3::X, DVec3::Y], 0.0), true);
        bench.edit(Edit::Sheet { boundary: CurveId(k) });
    }
    let why = refusal(&mut bench, trim(on(1, DVec3::X * -0.5), on(2, DVec3::X * 1.7)));
    assert!(why.contains("touch rather than cross at ["), "{why}");
}

/// A disc with two hills, and a larger one that runs through both of them.
fn hills_through_disc() -> Bench {
    let mut bench = Bench::new();
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos(f64::from(k) * FRAC_PI_4);
        Through::Place(dvec3(2.0 * cos, 2.0 * sin, 0.0))
    };
    curve(&mut bench, (0..8).map(corner).collect(), true);
    bench.edit(Edit::Sheet { boundary: CurveId(1) });
    spacing(&mut bench, 0.16);
    bench.rest(600);
    for (k, x, height) in [(9, 0.9, 0.7), (10, 0.0, 0.0), (11, -0.9, 0.7)] {
        bench.edit(Edit::Pin { surface: SurfaceId(1), at: dvec3(x, 0.0, 0.3) });
        bench.edit(Edit::Move { point: PointId(k), to: dvec3(x, 0.0, height) });
    }
    bench.rest(600);
    curve(&mut bench, round(DVec3::Z * 0.4, [DVec3::X * 2.6, DVec3::Y * 2.6], 0.7), true);
    bench.edit(Edit::Sheet { boundary: CurveId(2) });
    bench.rest(600);
    bench
}

#[test]
fn surfaces_that_meet_in_two_loops_are_cut_along_those_around_what_stays() {
    let (below, hill) = (on(1, dvec3(0.0, 1.5, 0.0)), on(1, dvec3(0.9, 0.0, 0.7)));
    let (outside, inside) = (on(2, dvec3(2.3, 0.0, 0.4)), on(2, dvec3(0.9, 0.0, 0.4)));
    let mut bench = hills_through_disc();
    for (first, second, wanted) in [
        (below, outside, [(-1, 3, true), (-1, 3, true)]),
        (hill, outside, [(1, 1, true), (0, 2, true)]),
        (hill, inside, [(1, 1, true), (1, 1, true)]),
        (below, inside, [(0, 2, true), (1, 1, true)]),
    ] {
        bench.edit(trim(first, second));
        assert_eq!(kinds_of(&bench), wanted, "{first:?} {second:?}");
        bench.rest(600);
        bench.accept(Request::Undo);
    }
    bench.edit(Edit::Trim { first: below, second: outside, smooth: true, ribbon: None });
    assert_eq!(kinds_of(&bench), [(-2, 2, true)], "two discs joined by two holes: a ring with a handle");
    bench.rest(900);
}

#[test]
fn cylinders_of_one_size_that_touch_where_they_cross_are_trimmed_all_the_same() {
    // Their lines of intersection would cross twice; on the meshes they are two lines that close.
    let mut bench = Bench::new();
    for (axes, along) in [([DVec3::X, DVec3::Y], DVec3::Z), ([DVec3::Y, DVec3::Z], DVec3::X)] {
        for end in [-1.6, 1.6] {
            let from = if along == DVec3::Z { 0.0 } else { 0.3 };
            curve(&mut bench, round(along * end, axes.map(|axis| axis * 0.8), from), true);
        }
    }
    bench.edit(sweep(1, 2));
    bench.edit(sweep(3, 4));
    bench.edit(Edit::Objective { of: ObjectiveOf::Document, objective: Some(Objective::Fair) });
    spacing(&mut bench, 0.2);
    bench.rest(600);
    bench.edit(trim(on(1, dvec3(0.0, 0.8, 1.5)), on(2, dvec3(1.5, 0.0, 0.8))));
    bench.rest(900);
    let left = kinds_of(&bench);
    assert!(left.len() == 2 && left.iter().all(|(_, rims, two_sided)| *rims >= 2 && *two_sided), "{left:?}");
}

/// Found by the storm: a piece so small that the curve which ran across it is a single edge from rim to rim.
#[test]
fn a_rim_that_a_curve_of_a_single_edge_ends_at_is_not_laid_on_another() {
    let moebius = shapes::for_surgery().into_iter().nth(3).unwrap();
    let mut round = Round::new(&to_compact_text(&moebius));
    let along = [
        dvec3(-0.9082774045718183, 1.5412405038868795, -0.001098031692393731),
        dvec3(-0.9864440154469574, 1.7035561426687784, -0.00019422718802447576),
        dvec3(-1.162084821244612, 1.7436438193975785, 0.0005043604594831095),
        dvec3(-1.3029387127796483, 1.6313166958569127, 0.00047168050296478016),
        dvec3(-1.302939836830417, 1.4511593871286503, -0.00026765838377153516),
        dvec3(-1.1620873469637625, 1.338834021224542, -0.0011569189392485698),
        dvec3(-0.9864460409164543, 1.37892388969028, -0.0015264698275825818),
    ];
    let edit = Edit::SLoop { surface: SurfaceId(1), along: along.to_vec(), closed: true };
    assert_eq!(round.ask(&Request::Edit(edit)), None);
    let border = Border::Region(on(1, dvec3(-1.35, 2.37, 0.0)));
    assert_eq!(round.ask(&Request::Edit(Edit::Crease { border })), None);
    assert_eq!(kinds_of(&round.bench), [(-1, 2, false), (1, 1, true)]);
    let (from, to) = (on(1, dvec3(0.0, -0.04, 0.0)), on(2, dvec3(-0.92, 1.66, 0.0)));
    let why = round.ask(&Request::Edit(Edit::Glue { from, to, skirt: false, reversed: true })).unwrap();
    assert!(why.contains("curve 3 ends at the rim of surface"), "{why}");
}
