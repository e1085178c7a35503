//! Corners that are picked along chains of curves.

use super::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn at_corners(curve: CurveId, points: &[PointId]) -> Edit {
    Edit::Fill { hole: Hole::Corners { curve, points: points.to_vec() }, style: FillStyle::default() }
}

/// Two curves that meet at two points, with sharp turns at control points inside them: the corners of a square.
fn chain() -> (Modeler, Vec<CurveId>, Vec<PointId>) {
    let mut modeler = Modeler::new();
    let places = [[0.0, 0.0, 0.0], [1.0, -0.8, 0.2], [2.0, 0.0, 0.0], [1.0, 0.8, 0.2]];
    let points: Vec<PointId> = places.into_iter().map(|at| point(&mut modeler, at)).collect();
    let through = |points: &[PointId]| points.iter().map(|point| Through::Point(*point)).collect::<Vec<_>>();
    let curves =
        [[0, 1, 2], [2, 3, 0]].map(|ends| curve(&mut modeler, through(&ends.map(|k| points[k])))).to_vec();
    rest(&mut modeler);
    (modeler, curves, points)
}

#[test]
fn a_corner_inside_a_curve_of_a_chain_is_picked_by_its_point() {
    let (mut modeler, curves, points) = chain();
    // Two curves are no patch; with one or two corners more they are.
    let refused = modeler.handle(Request::Edit(near(curves[0]))).refused.unwrap();
    assert!(refused.reason.contains("2 corners"), "{}", refused.reason);
    for direction in [DVec3::X, DVec3::NEG_X].into_iter().zip([points[1], points[3]]).zip(&curves) {
        // The curves do not turn at their points; a patch can do with a little.
        let ((direction, point), curve) = direction;
        edit(&mut modeler, Edit::Tangent { curve: *curve, point, direction: Some(direction) });
    }
    rest(&mut modeler);
    let style = FillStyle { join: FillJoin::Position, ..FillStyle::default() };
    for (picked, curve, sides) in [
        (vec![points[1]], curves[0], 3),
        (vec![points[3]], curves[0], 3),
        (vec![points[3], points[1]], curves[1], 4),
        (vec![points[3], points[1], points[0]], curves[1], 4),
    ] {
        edit(&mut modeler, Edit::Fill { hole: Hole::Corners { curve, points: picked.clone() }, style });
        let fill = modeler.model().document.fills[&SurfaceId(1)].clone();
        assert_eq!(fill.sides.len(), sides);
        for point in picked {
            assert!(fill.sides.iter().any(|side| side.from == point), "{fill:?}");
        }
        for (at, side) in fill.sides.iter().enumerate() {
            assert_eq!(side.to, fill.sides[(at + 1) % sides].from);
        }
        assert!(seams(&mut modeler).fills[0].curve_deviation < 1e-3);
        // The loop is taken, however its corners are chosen.
        let again = modeler.handle(Request::Edit(at_corners(curves[0], &[points[1]]))).refused.unwrap();
        assert!(again.reason.contains("filled already"), "{}", again.reason);
        ask(&mut modeler, Request::Undo);
    }
    // What turns by nothing at a corner has no plane there, and is told so.
    let flat = modeler.handle(Request::Edit(at_corners(curves[0], &[points[1]]))).refused.unwrap();
    assert!(flat.reason.contains("turns by 0°") && flat.reason.contains("point 2"), "{}", flat.reason);
}

#[test]
fn corners_that_lie_on_no_common_loop_are_refused() {
    let (mut modeler, curves, points) = chain();
    let far = point(&mut modeler, [5.0, 5.0, 5.0]);
    for picked in [vec![far], vec![points[1], far]] {
        let refused = modeler.handle(Request::Edit(at_corners(curves[0], &picked))).refused.unwrap();
        assert!(refused.reason.contains("passes through all"), "{}", refused.reason);
    }
    let few = modeler.handle(Request::Edit(at_corners(curves[0], &[points[0]]))).refused.unwrap();
    assert!(few.reason.contains("2 corners"), "{}", few.reason);
    let none = modeler.handle(Request::Edit(at_corners(CurveId(9), &[points[0]]))).refused.unwrap();
    assert!(none.reason.contains("curve 9"), "{}", none.reason);
}

#[test]
fn a_chain_of_rims_and_curves_gets_corners_where_they_are_picked() {
    // The rim of a hole in a fair surface is four stretches of curves; one more corner makes five sides, with the planes of the surface.
    let (mut modeler, curves) = holed();
    let inside = {
        edit(&mut modeler, Edit::Insert { curve: curves[1], at: DVec3::new(0.0, -0.6, 0.1) });
        rest(&mut modeler);
        *modeler.model().document.points.keys().next_back().unwrap()
    };
    let style = FillStyle { join: FillJoin::Position, ..FillStyle::default() };
    edit(&mut modeler, Edit::Fill { hole: Hole::Corners { curve: curves[1], points: vec![inside] }, style });
    let fill = modeler.model().document.fills.last_key_value().unwrap().1.clone();
    assert_eq!(fill.sides.len(), 5);
    assert!(fill.sides.iter().all(|side| side.planes == Some(SurfaceId(1))), "{fill:?}");
    assert!(fill.sides.iter().any(|side| side.from == inside));
}
