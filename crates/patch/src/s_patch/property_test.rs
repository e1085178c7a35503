//! What holds for patches between any ribbons: random ones of every number of sides from 3 to 9 and every degree from 2 to 5, of
//! mixed degrees, alone and side by side.

use super::tests::{beyond, check_sides, filled, random_loop};
use super::*;
use crate::ribbon::{Ribbon, RibbonLoop};
use crate::surface_point::SurfacePoint;
use glam::{DVec2, DVec3};
use proptest::prelude::*;
use std::collections::BTreeMap;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Sides and a degree. With seven sides and more the highest degrees take a second each: those are met once each, in `tests.rs`.
fn kind() -> impl Strategy<Value = (usize, usize)> {
    (3_usize..=9, 2_usize..=5).prop_map(|(n, d)| {
        (
            n,
            if n >= 8 {
                d.min(3)
            } else if n == 7 {
                d.min(4)
            } else {
                d
            },
        )
    })
}

/// A place in the inside of a regular polygon, not nearer to its sides than a tenth.
fn inside(n: usize, turn: f64, out: f64) -> DVec2 {
    let (sin, cos) = libm::sincos(turn * core::f64::consts::TAU);
    DVec2::new(cos, sin) * (out * 0.9 * libm::cos(core::f64::consts::PI / n as f64))
}

/// Every panel is an affine image of the polygon, whichever of its sides a point was set from (the recipe's section 4 to 6).
fn check_panels(patch: &SPatch) {
    let (n, depth) = (patch.sides(), patch.depth());
    let labels = Labels::new(n, depth).unwrap();
    let turn = |k: usize| libm::sincos(core::f64::consts::TAU * k as f64 / n as f64);
    for side in 0..n {
        for j in 0..depth {
            let point = |k: usize| {
                let mut label = vec![0_u8; n];
                label[side] += u8::try_from(depth - 1 - j).unwrap();
                label[(side + 1) % n] += u8::try_from(j).unwrap();
                label[(side + n - 1 + k) % n] += 1;
                patch.points()[labels.rank(&label).unwrap()]
            };
            // The affine map that takes three corners of the polygon to the first three points takes the others to the others.
            let (a, b, c) = (point(0), point(1), point(2));
            for k in 3..n {
                let ((sin1, cos1), (sin, cos)) = (turn(1), turn(k - 1));
                let (across, along) = ((1.0 - cos) / (1.0 - cos1), sin / sin1);
                let exact = b + (a + c - 2.0 * b) * (across / 2.0) + (c - a) * (along / 2.0);
                let off = point(k).distance(exact);
                assert!(off < 1e-12, "{n} sides, depth {depth}, panel {j} of side {side}: {off:e}");
            }
        }
    }
}

/// Exact derivatives against central differences of what they are derivatives of.
fn check_derivatives(patch: &SPatch, place: DVec2) {
    let (domain, step) = (Domain::new(patch.sides()), 1e-4);
    let at = |x: f64, y: f64| patch.at(&domain, place + DVec2::new(x, y) * step).unwrap();
    let here = at(0.0, 0.0);
    let central =
        |of: fn(&SurfacePoint) -> DVec3, x: f64, y: f64| (of(&at(x, y)) - of(&at(-x, -y))) / (2.0 * step);
    for (exact, difference) in [
        (here.dx, central(|p| p.point, 1.0, 0.0)),
        (here.dy, central(|p| p.point, 0.0, 1.0)),
        (here.dxx, central(|p| p.dx, 1.0, 0.0)),
        (here.dxy, central(|p| p.dy, 1.0, 0.0)),
        (here.dyy, central(|p| p.dy, 0.0, 1.0)),
    ] {
        assert!(
            exact.distance(difference) < 2e-5,
            "{} sides at {place}: {exact} {difference}",
            patch.sides()
        );
    }
}

/// The mesh of two patches that share side 0 has no gap there: its vertices are one in twos.
fn check_watertight(one: &SPatch, other: &SPatch) {
    let meshes = [one, other].map(|patch| {
        let grid = Tessellation::new(patch.sides(), patch.depth(), 4).unwrap();
        let found = grid.evaluate(patch).unwrap();
        // Within one patch each edge belongs to two triangles, or lies on the rim.
        let mut uses: BTreeMap<(usize, usize), i32> = BTreeMap::new();
        for [a, b, c] in grid.triangles() {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                *uses.entry((from.min(to), from.max(to))).or_default() += if from < to { 1 } else { -1 };
            }
        }
        assert_eq!(uses.values().filter(|uses| **uses != 0).count(), 4 * patch.sides());
        (0..=4)
            .map(|step| grid.on_side(0, step))
            .map(|v| (found.positions[v], found.normals[v]))
            .collect::<Vec<_>>()
    });
    for ((p, n), (q, m)) in meshes[0].iter().zip(meshes[1].iter().rev()) {
        assert!(p.distance(*q) < 1e-12 && n.cross(*m).length() < 1e-10, "{p} {q}, {n} {m}");
    }
}

proptest! {
    #![proptest_config(crate::property_test::cases(40, 4))]

    #[test]
    fn panels_are_affine_and_derivatives_exact(
        (n, d) in kind(), seed in any::<u64>(), turn in 0.0..1.0, out in 0.0..1.0, harmonic in any::<bool>(),
    ) {
        let fill = if harmonic { Fill::Harmonic } else { Fill::Biharmonic };
        let patch = filled(&random_loop(n, d, seed), Join::Tangent, fill);
        check_panels(&patch);
        check_derivatives(&patch, inside(n, turn, out));
    }

    #[test]
    fn a_deeper_patch_is_the_same_surface(
        (n, d) in kind(), seed in any::<u64>(), turn in 0.0..1.0, out in 0.0..1.0, position in any::<bool>(),
    ) {
        let join = if position { Join::Position } else { Join::Tangent };
        let patch = filled(&random_loop(n, d.min(4), seed), join, Fill::Biharmonic);
        let deeper = patch.elevated().unwrap();
        prop_assert_eq!(deeper.depth(), patch.depth() + 1);
        let domain = Domain::new(n);
        for place in [inside(n, turn, out), domain.on_side(n - 1, turn), domain.corners()[n / 2]] {
            let (one, other) = (patch.at(&domain, place).unwrap(), deeper.at(&domain, place).unwrap());
            prop_assert!(one.point.distance(other.point) < 2e-14, "{:e}", one.point.distance(other.point));
            prop_assert!(one.dx.distance(other.dx) < 1e-12 && one.dyy.distance(other.dyy) < 1e-10);
        }
    }

    /// Sides of a loop that are given one or two degrees higher are the same sides, so the patch must meet what was given at first.
    #[test]
    fn ribbons_of_mixed_degrees_are_met((n, d) in kind(), seed in any::<u64>(), raises in 1_u64..) {
        let d = d.min(3);
        let even = random_loop(n, d, seed);
        let raise = |side: usize| (raises >> (2 * side)) % 3;
        let mixed: Vec<Ribbon> = even
            .ribbons()
            .iter()
            .enumerate()
            .map(|(side, ribbon)| (0..raise(side)).fold(ribbon.clone(), |ribbon, _| ribbon.elevated()))
            .collect();
        let ring = RibbonLoop::new(&mixed).unwrap();
        let most = (0..n).map(raise).max().unwrap_or(0);
        prop_assert_eq!(ring.degree() as u64, d as u64 + most);
        let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
        check_panels(&patch);
        check_sides(&even, &patch, 6);
    }

    #[test]
    fn patches_of_any_kinds_side_by_side_join(
        (n, d) in kind(), m in 3_usize..=7, seed in any::<u64>(), far in any::<u64>(),
    ) {
        let ring = random_loop(n, d, seed);
        let other = beyond(&ring, m, far);
        check_watertight(
            &filled(&ring, Join::Tangent, Fill::Biharmonic),
            &filled(&other, Join::Tangent, Fill::Biharmonic),
        );
    }
}
