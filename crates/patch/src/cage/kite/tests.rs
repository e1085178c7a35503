//! The sanity values of the recipe, differences, and the facts that the construction rests on.

use super::*;
use proptest::prelude::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const MAPS: [Map; 2] = [Map::Rational, Map::Smooth];

fn at(map: Map, n: usize, u: f64, v: f64) -> KitePoint {
    kite(map, n, u, v).unwrap()
}

fn close(found: [f64; 2], expected: [f64; 2], within: f64) {
    let off = (found[0] - expected[0]).abs().max((found[1] - expected[1]).abs());
    assert!(off <= within, "{found:?} and {expected:?} differ by {off:e}");
}

#[test]
fn the_table_of_the_recipe() {
    let table = [
        (Map::Rational, 3, [0.320_275_102_19, 0.0], [0.275_360_954_53, -0.200_840_155_05]),
        (Map::Rational, 5, [0.526_205_860_24, 0.0], [0.539_728_685_92, -0.241_103_244_96]),
        (Map::Rational, 6, [0.576_986_776_10, 0.0], [0.606_807_617_76, -0.224_746_507_25]),
        (Map::Smooth, 3, [0.5, 0.0], [0.327_397_735_05, -0.275_610_942_33]),
        (Map::Smooth, 5, [0.5, 0.0], [0.555_521_769_84, -0.247_971_916_05]),
        (Map::Smooth, 6, [0.5, 0.0], [0.602_762_826_98, -0.219_932_609_44]),
    ];
    for (map, n, middle, other) in table {
        close(at(map, n, 0.5, 0.5).point, middle, 1e-11);
        close(at(map, n, 0.75, 0.2).point, other, 1e-11);
    }
}

#[test]
fn corners_go_to_the_corners_of_the_kite() {
    for (map, n) in MAPS.into_iter().flat_map(|map| (3..=32).map(move |n| (map, n))) {
        let angle = PI / n as f64;
        let (x, y) = (libm::cos(angle) * libm::cos(angle), libm::cos(angle) * libm::sin(angle));
        close(at(map, n, 0.0, 0.0).point, [0.0, 0.0], 0.0);
        close(at(map, n, 1.0, 0.0).point, [x, -y], 4e-16);
        close(at(map, n, 0.0, 1.0).point, [x, y], 4e-16);
        close(at(map, n, 1.0, 1.0).point, [1.0, 0.0], 4e-16);
    }
}

#[test]
fn the_rational_map_is_straight_on_the_far_sides() {
    for n in 3..=12 {
        let angle = PI / n as f64;
        let (x, y) = (libm::cos(angle) * libm::cos(angle), libm::cos(angle) * libm::sin(angle));
        for t in [0.1, 0.35, 0.8] {
            close(at(Map::Rational, n, 1.0, t).point, [x + t * (1.0 - x), (t - 1.0) * y], 5e-16);
        }
    }
}

/// Far beyond where the paper's formulas have any digits left: homogeneous of degree 1 near the origin.
#[test]
fn near_the_origin_the_map_grows_in_proportion() {
    for (map, n) in MAPS.into_iter().flat_map(|map| [3, 5, 6, 8, 32].map(|n| (map, n))) {
        for (u, v) in [(1e-14, 2e-14), (1e-14, 0.0), (3e-14, 1e-14), (1e-40, 1e-41), (1e-99, 1e-99)] {
            let (near, nearer) = (at(map, n, u, v), at(map, n, u / 8.0, v / 8.0));
            close(near.point.map(|x| x / u), nearer.point.map(|x| 8.0 * x / u), 1e-12);
            close(near.du, nearer.du, 1e-12);
            assert!(near.second.unwrap().as_flattened().iter().all(|d| d.is_finite()));
        }
        assert!(at(map, n, 0.0, 0.0).second.is_none());
        let (axis, close_by) = (at(map, n, 0.0, 0.0), at(map, n, 1e-12, 0.0));
        close(axis.du, close_by.du, 1e-11);
    }
}

#[test]
fn derivatives_agree_with_differences() {
    let h = 1e-4;
    for (map, n) in MAPS.into_iter().flat_map(|map| [3, 4, 5, 7, 12].map(|n| (map, n))) {
        for (u, v) in [(0.4, 0.3), (0.2, 0.7), (0.9, 0.85)] {
            let exact = at(map, n, u, v);
            let p = |i: f64, j: f64| at(map, n, u + i * h, v + j * h).point;
            let combine = |parts: &[(f64, [f64; 2])], by: f64| {
                [0, 1].map(|k| parts.iter().map(|(w, p)| w * p[k]).sum::<f64>() / by)
            };
            close(exact.du, combine(&[(1.0, p(1.0, 0.0)), (-1.0, p(-1.0, 0.0))], 2.0 * h), 1e-6);
            close(exact.dv, combine(&[(1.0, p(0.0, 1.0)), (-1.0, p(0.0, -1.0))], 2.0 * h), 1e-6);
            let [uu, uv, vv] = exact.second.unwrap();
            let straight =
                |ahead, behind| combine(&[(1.0, ahead), (-2.0, exact.point), (1.0, behind)], h * h);
            close(uu, straight(p(1.0, 0.0), p(-1.0, 0.0)), 1e-5);
            close(vv, straight(p(0.0, 1.0), p(0.0, -1.0)), 1e-5);
            let corners =
                [(1.0, p(1.0, 1.0)), (-1.0, p(1.0, -1.0)), (-1.0, p(-1.0, 1.0)), (1.0, p(-1.0, -1.0))];
            close(uv, combine(&corners, 4.0 * h * h), 1e-5);
        }
    }
}

/// The recipe's correction to the paper: across a spoke the bend of the rational map jumps, that of the smooth one does not.
#[test]
fn only_the_smooth_map_bends_evenly_across_spokes() {
    let across = |map, n: usize| {
        let [_, _, vv] = at(map, n, 0.5, 0.0).second.unwrap();
        // The part across the spoke at the angle -π/n.
        let angle = -PI / n as f64;
        -vv[0] * libm::sin(angle) + vv[1] * libm::cos(angle)
    };
    for (n, jump) in [(3, -0.557), (5, -0.609), (6, -0.436)] {
        assert!((across(Map::Rational, n) - jump).abs() < 6e-4, "{n}: {}", across(Map::Rational, n));
        assert!(across(Map::Smooth, n).abs() < 1e-12);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: if cfg!(target_arch = "wasm32") { 60 } else { 600 }, ..Default::default() })]

    #[test]
    fn exchanging_the_parameters_mirrors_the_place(n in 3_usize..=16, u in 0.0..=1.0, v in 0.0..=1.0) {
        for map in MAPS {
            let ([x, y], [a, b]) = (at(map, n, u, v).point, at(map, n, v, u).point);
            prop_assert!((x - a).abs() < 2e-15 && (y + b).abs() < 2e-15, "{map:?} {x} {y} {a} {b}");
        }
    }

    /// No fold: the Jacobian stays positive.
    #[test]
    fn the_map_never_folds(n in 3_usize..=16, u in 0.0..=1.0, v in 0.0..=1.0) {
        for map in MAPS {
            let KitePoint { du, dv, .. } = at(map, n, u, v);
            prop_assert!(du[0] * dv[1] - du[1] * dv[0] > 0.01);
        }
    }

    /// The two literal rational curves (14)-(16) of the paper run through the place: a point with barycentric coordinates
    /// `b` in the control triangle lies on the conic with weights `w` where `b1² w0 w2 = 4 w1² b0 b2`.
    #[test]
    fn the_place_lies_on_both_curves(n in 3_usize..=16, u in 0.01..=1.0, v in 0.01..=1.0) {
        let a = PI / n as f64;
        let point = at(Map::Rational, n, u, v).point;
        let corner = |k: f64, r: f64| [r * libm::cos(k * a), r * libm::sin(k * a)];
        let c = libm::cos(a);
        for (t, sign) in [(u, 1.0), (v, -1.0)] {
            let mix = |p: [f64; 2], q: [f64; 2]| [0, 1].map(|k| p[k] * (1.0 - t) + q[k] * t);
            let near = mix(corner(-3.0 * sign, c), corner(-2.0 * sign, 1.0));
            let middle = corner(-sign, c).map(|x| x * t * libm::exp(t * t - t));
            let far = mix(corner(sign, c), [1.0, 0.0]);
            let area = |p: [f64; 2], q: [f64; 2], r: [f64; 2]| (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
            // Not divided by the whole area, which vanishes for t = 1: the condition is homogeneous.
            let b = [area(point, middle, far), area(near, point, far), area(near, middle, point)];
            let whole = area(near, middle, far);
            // Of the ends of the curve the half beyond the middle is meant.
            prop_assert!(b[2] * whole >= b[0] * whole - 1e-14);
            let off = b[1] * b[1] * t * t - 4.0 * b[0] * b[2];
            prop_assert!(off.abs() < 1e-14, "{off:e}");
        }
    }
}
