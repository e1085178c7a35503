//! Ribbons: what is refused, what is raised, what is moved.

use super::*;
use crate::s_patch::tests::random_loop;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn raising_keeps_curve_and_cross_derivative() {
    for d in 2..=5 {
        let ring = random_loop(5, d, 3);
        for ribbon in ring.ribbons() {
            let raised = ribbon.elevated().elevated();
            for u in [0.0, 0.25, 0.6, 1.0] {
                assert!(raised.point(u).distance(ribbon.point(u)) < 1e-14);
                assert!(raised.tangent(u).distance(ribbon.tangent(u)) < 1e-13);
                assert!(raised.cross(u).distance(ribbon.cross(u)) < 1e-13);
            }
        }
    }
}

#[test]
fn mixed_degrees_are_raised_and_still_fit() {
    // Sides of a loop raised by 0, 1 or 2 are the same loop.
    let even = random_loop(6, 3, 9);
    let mixed: Vec<Ribbon> = even
        .ribbons()
        .iter()
        .enumerate()
        .map(|(side, ribbon)| (0..side % 3).fold(ribbon.clone(), |ribbon, _| ribbon.elevated()))
        .collect();
    let ring = RibbonLoop::new(&mixed).unwrap();
    assert_eq!(ring.degree(), 5);
    for (raised, asked) in ring.ribbons().iter().zip(even.ribbons()) {
        assert!(raised.point(0.3).distance(asked.point(0.3)) < 1e-14);
        assert!(raised.cross(0.3).distance(asked.cross(0.3)) < 1e-13);
    }
}

#[test]
fn what_is_wrong_is_named_by_side_and_point() {
    let good = random_loop(5, 3, 1);
    let spoilt = |change: &dyn Fn(&mut Vec<Ribbon>)| {
        let mut ribbons = good.ribbons().to_vec();
        change(&mut ribbons);
        RibbonLoop::new(&ribbons).unwrap_err()
    };
    assert_eq!(spoilt(&|r| r.truncate(2)), RibbonError::TooFewSides(2));
    assert_eq!(spoilt(&|r| *r = vec![r[0].clone(); 65]), RibbonError::TooManySides(65));
    assert_eq!(spoilt(&|r| r[2].row0.push(DVec3::X)), RibbonError::RowsDiffer { side: 2, row0: 5, row1: 4 });
    let shorten = |r: &mut Vec<Ribbon>| {
        r[4].row0.truncate(2);
        r[4].row1.truncate(2);
    };
    assert_eq!(spoilt(&shorten), RibbonError::DegreeTooLow { side: 4, degree: 1, least: 2 });
    let lengthen = |r: &mut Vec<Ribbon>| r[1] = Ribbon { row0: vec![DVec3::X; 60], row1: vec![DVec3::Y; 60] };
    assert_eq!(spoilt(&lengthen), RibbonError::DegreeTooHigh { side: 1, degree: 59 });
    assert_eq!(
        spoilt(&|r| r[0] = Ribbon::default()),
        RibbonError::DegreeTooLow { side: 0, degree: 0, least: 2 }
    );
    for bad in [f64::NAN, f64::INFINITY, 1e101] {
        let error = spoilt(&|r| r[3].row1[2].y = bad);
        assert_eq!(error, RibbonError::NotFinite { side: 3, row: 1, column: 2 });
    }
    let flat = |r: &mut Vec<Ribbon>| {
        r.iter_mut().flat_map(|r| r.row0.iter_mut().chain(&mut r.row1)).for_each(|p| *p = DVec3::ONE);
    };
    assert_eq!(spoilt(&flat), RibbonError::NoExtent);
    // The point, and the point of the side before it that it must be.
    for (row, column, other_row, other_column) in [(0, 0, 0, 3), (1, 0, 0, 2), (0, 1, 1, 3), (1, 1, 1, 2)] {
        let error = spoilt(&|r| {
            let ribbon = &mut r[2];
            let list = if row == 0 { &mut ribbon.row0 } else { &mut ribbon.row1 };
            list[column].z += 0.25;
        });
        let RibbonError::Incompatible { residual, allowed, .. } = error else { panic!("{error}") };
        assert!((residual - 0.25).abs() < 1e-12 && allowed < 1e-8, "{error}");
        let named = RibbonError::Incompatible {
            side: 2,
            row,
            column,
            other_side: 1,
            other_row,
            other_column,
            residual,
            allowed,
        };
        assert_eq!(error, named);
    }
}

#[test]
fn curves_alone_need_only_meet() {
    let good = random_loop(4, 3, 1);
    let mut curves: Vec<Vec<DVec3>> = good.ribbons().iter().map(|ribbon| ribbon.row0.clone()).collect();
    curves[0] = vec![curves[0][0], curves[0][3]];
    assert_eq!(RibbonLoop::of_curves(&curves).unwrap().degree(), 3);
    curves[2][0].x += 1e-3;
    assert!(matches!(
        RibbonLoop::of_curves(&curves),
        Err(RibbonError::Incompatible { side: 2, row: 0, column: 0, other_side: 1, .. })
    ));
}

#[test]
fn places_without_a_normal_are_told() {
    let good = random_loop(5, 4, 2);
    assert!(good.without_normal().is_empty());
    let mut ribbons = good.ribbons().to_vec();
    // Rows that run along the curve have no plane anywhere on the side but near its ends.
    for j in 2..3 {
        ribbons[1].row1[j] = ribbons[1].row0[j];
    }
    ribbons[3].row1 = ribbons[3].row0.clone();
    let found = unchecked_loop(&ribbons).without_normal();
    assert_eq!(found.iter().filter(|place| place.side == 3).count(), 33);
    assert!(found.iter().all(|place| place.side == 3 && place.sine == 0.0));
}

#[test]
fn twists_are_moved_to_their_mean_and_nothing_else_is() {
    for d in [2, 3, 5] {
        let good = random_loop(5, d, 6);
        let mut ribbons = good.ribbons().to_vec();
        let untouched = made_compatible(&ribbons).unwrap();
        assert!(untouched.largest_shift < 1e-14);
        ribbons[2].row1[1] += DVec3::new(0.0, 0.0, 0.4);
        let found = made_compatible(&ribbons).unwrap();
        RibbonLoop::new(found.ribbons.ribbons()).unwrap();
        assert!(
            (0..5).all(|side| found.ribbons.ribbons()[side].row0 == untouched.ribbons.ribbons()[side].row0)
        );
        // At degree 2 one point belongs to all five.
        let exact = if d == 2 { 0.4 * 0.8 } else { 0.2 };
        assert!((found.largest_shift - exact).abs() < 1e-13, "{d}: {}", found.largest_shift);
        let wanted = good.ribbons()[2].row1[1] + DVec3::Z * (0.4 - exact);
        assert!(found.ribbons.ribbons()[2].row1[1].distance(wanted) < 1e-13);
        // Ends of a row 1 lie on the neighbours' curves, whatever was asked.
        ribbons[4].row1[0] += DVec3::X;
        let found = made_compatible(&ribbons).unwrap();
        assert_eq!((found.side, found.column), (4, 0));
        ribbons[0].row0[0].x += 1e-3;
        assert!(matches!(
            made_compatible(&ribbons),
            Err(RibbonError::Incompatible { row: 0, column: 0, .. })
        ));
    }
}

#[test]
fn errors_say_what_is_wrong() {
    let error = RibbonError::Incompatible {
        side: 2,
        row: 1,
        column: 1,
        other_side: 1,
        other_row: 1,
        other_column: 2,
        residual: 0.05,
        allowed: 4e-9,
    };
    let said = error.to_string();
    assert!(said.starts_with("side 2: point 1 of row 1 must be point 2 of row 1 of side 1"), "{said}");
    assert!(said.contains("5e-2") && said.contains("4e-9"), "{said}");
}
