//! Networks of free curves whose inner vertices have any number of curves: all their loops are filled, and every seam is reported.

use super::*;
use ductile_spec::{SeamFigures, SurfaceId};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Around an odd number of curves the planes can turn so that all twist points agree: up to what ribbons of degree 7 cannot follow, in
/// degrees (0.001° measured).
const ODD: f64 = 0.01;
/// Walls that bulge turn more (0.024°; 0.29° to 0.32° where planes lie half way at the corners, too).
const WALLS: f64 = 0.05;

fn fill_all(modeler: &mut Modeler) -> Vec<SeamFigures> {
    edit(modeler, Edit::FillNetwork { curve: None, style: FillStyle::default() });
    rest(modeler);
    seams(modeler).seams
}

/// Fails unless patches meet without a gap and, to an angle in degrees, in one plane, and tells how well they do.
fn check(name: &str, found: &[SeamFigures], count: usize, most: f64) {
    let worst = |of: fn(&SeamFigures) -> f64| found.iter().map(of).fold(0.0, f64::max);
    let (gap, angle) = (worst(|seam| seam.gap), worst(|seam| seam.angle));
    println!("{name}: {} seams, gap {gap:.1e}, angle {angle:.3}°", found.len());
    assert_eq!(found.len(), count, "{name}");
    assert!(gap < 1e-12 && angle < most, "{name}: {found:?}");
    assert!(found.iter().all(|seam| seam.without_normal == 0), "{name}: {found:?}");
}

/// Curves from a vertex in the middle of a dome to a rim of as many corners: as many patches with three sides.
pub(super) fn dome(spokes: u32) -> Modeler {
    let mut modeler = Modeler::new();
    let rim = ring(&mut modeler, spokes, 1.0, 0.05);
    let hub = point(&mut modeler, [0.05, -0.03, 0.4]);
    for k in 0..rim.len() {
        arc(&mut modeler, hub, rim[k], DVec3::new(0.0, 0.0, 0.1));
        let (one, other) = (rim[k], rim[(k + 1) % rim.len()]);
        let at = |point: PointId| modeler.model().document.points[&point];
        let out = (at(one) + at(other)) * DVec3::new(0.12, 0.12, 0.0);
        arc(&mut modeler, one, other, out);
    }
    rest(&mut modeler);
    modeler
}

/// A square whose halves are divided by curves from its lower to its upper side.
fn divided(across: impl FnOnce(&mut Modeler, [PointId; 2], PointId)) -> Modeler {
    let mut modeler = Modeler::new();
    let places = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.15],
        [2.0, 0.0, 0.1],
        [2.0, 2.0, 0.0],
        [1.0, 2.0, 0.15],
        [0.0, 2.0, 0.1],
    ];
    let p: Vec<PointId> = places.into_iter().map(|at| point(&mut modeler, at)).collect();
    let inner = point(&mut modeler, [1.1, 1.0, 0.3]);
    for k in 0..6 {
        arc(&mut modeler, p[k], p[(k + 1) % 6], DVec3::new(0.0, 0.0, 0.05));
    }
    across(&mut modeler, [p[1], p[4]], inner);
    rest(&mut modeler);
    modeler
}

#[test]
fn a_vertex_of_two_curves_is_smooth_where_one_goes_on_as_the_other() {
    let mut modeler = divided(|modeler, [from, to], inner| {
        curve(modeler, [from, inner, to].map(Through::Point).to_vec());
    });
    let found = fill_all(&mut modeler);
    assert_eq!(modeler.model().document.fills.len(), 2);
    check("2 curves", &found, 1, 0.5);
    // Two curves that end there with one direction are no corner, and no side by themselves either: that is told.
    let mut modeler = divided(|modeler, [from, to], inner| {
        for (from, to) in [(from, inner), (inner, to)] {
            let made = curve(modeler, vec![Through::Point(from), Through::Point(to)]);
            edit(modeler, Edit::Tangent { curve: made, point: inner, direction: Some(DVec3::Y) });
        }
    });
    let act = Edit::FillNetwork { curve: None, style: FillStyle::default() };
    let refused = modeler.handle(Request::Edit(act)).refused.unwrap();
    assert!(refused.reason.contains("turns by 0° at point 7"), "{}", refused.reason);
}

/// On one side of two curves that meet at an angle the hole turns outwards, and no patch with four sides can follow.
#[test]
fn a_patch_that_folds_where_its_hole_turns_outwards_is_told() {
    let mut modeler = divided(|modeler, [from, to], inner| {
        for (from, to) in [(from, inner), (inner, to)] {
            arc(modeler, from, to, DVec3::new(0.25, 0.0, 0.0));
        }
    });
    fill_all(&mut modeler);
    let turned: Vec<_> =
        seams(&mut modeler).fills.iter().map(|fill| (fill.surface, fill.turned_out)).collect();
    let [(SurfaceId(1), Some(side)), (SurfaceId(2), None)] = turned[..] else { panic!("{turned:?}") };
    let begins = modeler.model().document.fills[&SurfaceId(1)].sides[side as usize - 1].from;
    assert_eq!(begins, PointId(7));
    // The normal turns over there.
    let patch = &modeler.model().patches[&SurfaceId(1)];
    let is_down = |normal: &&DVec3| normal.z < -0.5;
    assert!(patch.normals().iter().filter(is_down).count() > 3);
    // Divided from there, the hole has no such corner.
    for spokes in [3, 5, 7] {
        let mut modeler = dome(spokes);
        fill_all(&mut modeler);
        assert!(seams(&mut modeler).fills.iter().all(|fill| fill.turned_out.is_none()), "{spokes}");
    }
}

#[test]
fn a_vertex_of_three_curves_joins_smoothly() {
    check("3 curves", &fill_all(&mut dome(3)), 3, ODD);
}

#[test]
fn a_vertex_of_four_curves_joins_smoothly() {
    check("4 curves", &fill_all(&mut dome(4)), 4, 0.05);
}

#[test]
fn a_vertex_of_five_curves_joins_smoothly() {
    check("5 curves", &fill_all(&mut dome(5)), 5, ODD);
}

#[test]
fn a_vertex_of_six_curves_joins_smoothly() {
    check("6 curves", &fill_all(&mut dome(6)), 6, 0.5);
}

#[test]
fn a_vertex_of_seven_curves_joins_smoothly() {
    check("7 curves", &fill_all(&mut dome(7)), 7, ODD);
}

/// Five walls between two pentagons: corners with three curves, patches with four and five sides.
#[test]
fn the_patches_of_a_prism_join_smoothly_and_stay_so_in_a_drag() {
    let mut modeler = Modeler::new();
    let floor = ring(&mut modeler, 5, 1.0, 0.1);
    let at = |k: usize| {
        let (sin, cos) = libm::sincos((k as f64) * core::f64::consts::TAU / 5.0);
        [cos, sin, 1.2]
    };
    let roof: Vec<PointId> = (0..5).map(|k| point(&mut modeler, at(k))).collect();
    let centre = DVec3::new(0.0, 0.0, 0.6);
    for k in 0..5 {
        for [from, to] in [[floor[k], roof[k]], [floor[k], floor[(k + 1) % 5]], [roof[k], roof[(k + 1) % 5]]]
        {
            let places = &modeler.model().document.points;
            let out = ((places[&from] + places[&to]) * 0.5 - centre) * 0.3;
            arc(&mut modeler, from, to, out);
        }
    }
    rest(&mut modeler);
    check("prism", &fill_all(&mut modeler), 15, WALLS);
    ask(&mut modeler, Request::Grab(GrabTarget::Point(roof[0])));
    let mut drag = |step: u32| {
        let to = DVec3::from(at(0)) + DVec3::new(0.04, 0.02, 0.06) * f64::from(step);
        ask(&mut modeler, Request::Step(Step { drag: Some(to), iterations: 20 }));
        let refused = (1..=7).filter(|id| modeler.model().check_fill(SurfaceId(*id)).is_err()).count();
        (seams(&mut modeler).seams, refused)
    };
    for step in 1..=4 {
        let (found, refused) = drag(step);
        check("dragged", &found, 15, WALLS);
        assert_eq!(refused, 0);
    }
    // Farther on the curves of the roof run straight on through the corner that is dragged: it can have no patch there.
    assert_eq!(drag(5).1, 1);
}
