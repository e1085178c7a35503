//! Patches between random ribbons: the recipe's sections 5, 6, 9, 10 and 12 at its limits.

use super::*;
use crate::ribbon::{Ribbon, RibbonLoop};
use crate::surface_point::SurfacePoint;
use crate::{basis, binomial};
use glam::{DVec2, DVec3};
use proptest::prelude::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Numbers in [-1, 1] that depend on nothing but the seed.
struct Noise(u64);

impl Noise {
    fn number(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    fn vector(&mut self, size: f64) -> DVec3 {
        DVec3::new(self.number(), self.number(), self.number()) * size
    }
}

/// Twist-compatible ribbons round a hole of a size of about 4: every point that is free is random, the others follow.
pub(crate) fn random_loop(n: usize, d: usize, seed: u64) -> RibbonLoop {
    let mut noise = Noise(seed.wrapping_mul(77).wrapping_add((n * 100 + d) as u64));
    // Neighbouring seeds begin alike.
    for _ in 0..8 {
        let _ = noise.number();
    }
    let corner = |k: usize, out: f64| {
        let angle = core::f64::consts::TAU * k as f64 / n as f64;
        DVec3::new(libm::cos(angle), libm::sin(angle), 0.0) * out
    };
    let wiggle = 0.4 / d as f64;
    let mut ribbons: Vec<Ribbon> = (0..n)
        .map(|i| {
            let line = |j: usize, out| corner(i, out).lerp(corner(i + 1, out), j as f64 / d as f64);
            let inside = 2.0 * (1.0 - 0.8 / d as f64);
            let row0 = (0..=d).map(|j| line(j, 2.0) + noise.vector(wiggle)).collect();
            let row1 = (0..=d).map(|j| line(j, inside) + noise.vector(wiggle)).collect();
            Ribbon { row0, row1 }
        })
        .collect();
    for i in 0..n {
        let q = (i + n - 1) % n;
        ribbons[q].row0[d] = ribbons[i].row0[0];
        ribbons[q].row1[d - 1] = ribbons[i].row1[1];
    }
    let shared = ribbons[0].row1[1];
    for i in 0..n {
        let q = (i + n - 1) % n;
        if d == 2 {
            ribbons[i].row1[1] = shared;
        }
        ribbons[i].row1[0] = ribbons[q].row0[d - 1];
        ribbons[q].row1[d] = ribbons[i].row0[1];
    }
    RibbonLoop::new(&ribbons).unwrap()
}

/// All degrees with few sides, and some with more.
pub(crate) fn some_seeds() -> impl Iterator<Item = (usize, usize, u64)> {
    (3..=9_usize).flat_map(|n| (2..=5_usize).map(move |d| (n, d, (n + d) as u64)))
}

pub(crate) fn filled(ring: &RibbonLoop, join: Join, fill: Fill) -> SPatch {
    SPatch::filling(ring, join, fill, &mut MaskCache::new()).unwrap()
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Boundary and normals of a patch against its ribbons.
pub(super) fn check_sides(ring: &RibbonLoop, patch: &SPatch, places: usize) {
    let domain = Domain::new(ring.sides());
    for (side, ribbon) in ring.ribbons().iter().enumerate() {
        for place in 0..=places {
            let u = place as f64 / places as f64;
            let found = patch.at(&domain, domain.on_side(side, u)).unwrap();
            let off = found.point.distance(ribbon.point(u));
            assert!(off < 1e-12, "{} sides, side {side} at {u}: {off:e}", ring.sides());
            let turn = angle(found.normal().unwrap(), ribbon.normal(u).unwrap());
            assert!(turn < 1e-9, "{} sides, side {side} at {u}: {turn:e} rad", ring.sides());
        }
    }
}

proptest! {
    #![proptest_config(crate::property_test::cases(48, 6))]
    #[test]
    fn patches_meet_their_ribbons(n in 3_usize..=9, d in 2_usize..=5, seed in any::<u64>(), harmonic in any::<bool>()) {
        // The largest kinds take a second each and are met once, below.
        let d = if n >= 8 { d.min(3) } else if n == 7 { d.min(4) } else { d };
        let ring = random_loop(n, d, seed);
        let fill = if harmonic { Fill::Harmonic } else { Fill::Biharmonic };
        check_sides(&ring, &filled(&ring, Join::Tangent, fill), 10);
    }
}

#[test]
fn the_largest_kinds_meet_their_ribbons_and_their_masks() {
    for (n, d) in [(7, 5), (8, 4), (8, 5), (9, 4), (9, 5)] {
        let ring = random_loop(n, d, 5);
        let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
        check_sides(&ring, &patch, 4);
        check_masks(&patch, Join::Tangent, Fill::Biharmonic);
    }
}

/// Every free point obeys its mask.
fn check_masks(patch: &SPatch, join: Join, fill: Fill) {
    let labels = Labels::new(patch.sides(), patch.depth()).unwrap();
    let around = |values: &[DVec3]| {
        let mut sums = vec![DVec3::ZERO; labels.len()];
        for [a, b] in labels.edges() {
            sums[a] += values[b] - values[a];
            sums[b] += values[a] - values[b];
        }
        sums
    };
    let mut mask = around(patch.points());
    if fill == Fill::Biharmonic {
        mask = around(&mask);
    }
    for (rank, value) in mask.iter().enumerate() {
        let kind = labels.kind(rank);
        if kind == LabelKind::Interior || (join == Join::Position && kind == LabelKind::Panel) {
            assert!(value.length() < 1e-10, "{:?}: {:e}", labels.get(rank), value.length());
        }
    }
}

#[test]
fn interior_points_obey_their_masks() {
    for (n, d) in [(3, 2), (3, 4), (4, 3), (5, 5), (6, 3), (7, 2)] {
        for fill in [Fill::Biharmonic, Fill::Harmonic] {
            for join in [Join::Tangent, Join::Position] {
                check_masks(&filled(&random_loop(n, d, 1), join, fill), join, fill);
            }
        }
    }
}

#[test]
fn factor_and_steps_agree() {
    // 8-sided cubic: small enough for both.
    let ring = random_loop(8, 3, 2);
    let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
    let mut cache = MaskCache::new();
    let masks = cache.masks(8, 6, Join::Tangent, Fill::Biharmonic).unwrap();
    masks.forget_factor();
    let mut points = patch.points().to_vec();
    masks.fill(&mut points).unwrap();
    for (stepped, factored) in points.iter().zip(patch.points()) {
        assert!(stepped.distance(*factored) < 1e-11, "{:e}", stepped.distance(*factored));
    }
}

#[test]
fn position_only_patches_meet_the_curves() {
    for (n, d) in [(3, 3), (5, 2), (6, 5)] {
        let ring = random_loop(n, d, 8);
        let patch = filled(&ring, Join::Position, Fill::Harmonic);
        assert_eq!(patch.depth(), d);
        let domain = Domain::new(n);
        for (side, ribbon) in ring.ribbons().iter().enumerate() {
            for u in [0.0, 0.3, 0.5, 0.9, 1.0] {
                let found = patch.at(&domain, domain.on_side(side, u)).unwrap();
                assert!(found.point.distance(ribbon.point(u)) < 1e-13);
            }
        }
    }
}

/// Values and derivatives by de Casteljau's algorithm over labels, which shares nothing with the walk over the basis.
fn de_casteljau(patch: &SPatch, domain: &Domain, at: DVec2) -> DVec3 {
    let n = patch.sides();
    let coordinates = domain.coordinates(at);
    let mut points = patch.points().to_vec();
    for depth in (1..=patch.depth()).rev() {
        let labels = Labels::new(n, depth).unwrap();
        let lift = |base: &[u8]| {
            let mut label = base.to_vec();
            (0..n)
                .map(|k| {
                    label[k] += 1;
                    let point = points[labels.rank(&label).unwrap()];
                    label[k] -= 1;
                    point * coordinates[k]
                })
                .sum::<DVec3>()
        };
        points = if depth == 1 {
            vec![lift(&vec![0; n])]
        } else {
            Labels::new(n, depth - 1).unwrap().iter().map(lift).collect()
        };
    }
    points[0]
}

#[test]
fn evaluation_agrees_with_de_casteljau_and_derivatives_with_differences() {
    let step = 1e-4;
    for (n, d) in [(3, 3), (4, 2), (5, 3), (6, 2)] {
        let patch = filled(&random_loop(n, d, 12), Join::Tangent, Fill::Biharmonic);
        let domain = Domain::new(n);
        for place in [DVec2::ZERO, DVec2::new(0.2, -0.13), DVec2::new(-0.3, 0.2)] {
            let at = |x: f64, y: f64| patch.at(&domain, place + DVec2::new(x, y) * step).unwrap();
            let here = at(0.0, 0.0);
            assert!(here.point.distance(de_casteljau(&patch, &domain, place)) < 1e-13);
            let central = |of: fn(&SurfacePoint) -> DVec3, x: f64, y: f64| {
                (of(&at(x, y)) - of(&at(-x, -y))) / (2.0 * step)
            };
            let pairs = [
                (here.dx, central(|p| p.point, 1.0, 0.0)),
                (here.dy, central(|p| p.point, 0.0, 1.0)),
                (here.dxx, central(|p| p.dx, 1.0, 0.0)),
                (here.dxy, central(|p| p.dx, 0.0, 1.0)),
                (here.dxy, central(|p| p.dy, 1.0, 0.0)),
                (here.dyy, central(|p| p.dy, 0.0, 1.0)),
            ];
            for (exact, difference) in pairs {
                assert!(exact.distance(difference) < 2e-6, "{n} sides: {exact} {difference}");
            }
        }
        assert_eq!(patch.at(&domain, DVec2::new(1.1, 0.0)), None);
        assert_eq!(patch.at(&domain, DVec2::new(f64::NAN, 0.0)), None);
        assert_eq!(patch.at(&Domain::new(n + 1), DVec2::ZERO), None);
    }
}

#[test]
fn a_triangle_is_a_bezier_triangle() {
    let patch = filled(&random_loop(3, 4, 3), Join::Tangent, Fill::Biharmonic);
    let (domain, labels) = (Domain::new(3), Labels::new(3, 7).unwrap());
    for place in [DVec2::new(0.1, 0.2), DVec2::new(-0.3, -0.1)] {
        let [a, b, c] = domain.coordinates(place)[..] else { panic!() };
        let power = |base: f64, times: u8| (0..times).fold(1.0, |p, _| p * base);
        let mut sum = DVec3::ZERO;
        for (label, point) in labels.iter().zip(patch.points()) {
            let [i, j, k] = label[..] else { panic!() };
            let multinomial = binomial(7, i64::from(i)) * binomial(i64::from(j + k), i64::from(j));
            sum += *point * (multinomial * power(a, i) * power(b, j) * power(c, k));
        }
        assert!(sum.distance(patch.at(&domain, place).unwrap().point) < 2e-15 * 4.0);
    }
}

#[test]
fn a_square_is_a_tensor_product() {
    let ring = random_loop(4, 3, 3);
    let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
    let (domain, labels, depth) = (Domain::new(4), Labels::new(4, 6).unwrap(), 6_i64);
    let mut net = vec![DVec3::ZERO; 49];
    for (label, point) in labels.iter().zip(patch.points()) {
        let s: Vec<i64> = label.iter().map(|&entry| i64::from(entry)).collect();
        let (a, b) = (s[1] + s[2], s[2] + s[3]);
        let at = usize::from(label[1] + label[2]) * 7 + usize::from(label[2] + label[3]);
        let multinomial = binomial(depth, s[0]) * binomial(depth - s[0], s[1]) * binomial(s[2] + s[3], s[2]);
        net[at] += *point * (multinomial / (binomial(depth, a) * binomial(depth, b)));
    }
    for (u, v) in [(0.0, 0.0), (0.3, 0.6), (1.0, 0.2), (0.5, 0.5)] {
        let corners = domain.corners();
        let place = corners[0] + (corners[1] - corners[0]) * u + (corners[3] - corners[0]) * v;
        let (across, along) = (basis(6, u), basis(6, v));
        let sum: DVec3 = (0..49).map(|at| net[at] * (across[at / 7] * along[at % 7])).sum();
        assert!(sum.distance(patch.at(&domain, place).unwrap().point) < 1e-14);
    }
    // With four sides the join is smooth in the parameters too: the derivative across the side is W itself.
    let inward = domain.corners()[3] - domain.corners()[0];
    for u in [0.0, 0.4, 0.9] {
        let found = patch.at(&domain, domain.on_side(0, u)).unwrap();
        let across = found.dx * inward.x + found.dy * inward.y;
        assert!(across.distance(ring.ribbons()[0].cross(u)) < 1e-12);
    }
}

#[test]
fn elevation_keeps_the_surface_and_the_panels() {
    for (n, d) in [(3, 2), (4, 3), (5, 3), (6, 2)] {
        let ring = random_loop(n, d, 14);
        let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
        let deeper = patch.elevated().unwrap();
        let domain = Domain::new(n);
        for place in [DVec2::ZERO, DVec2::new(0.2, 0.1), domain.on_side(1, 0.3), domain.corners()[0]] {
            let (one, other) = (patch.at(&domain, place).unwrap(), deeper.at(&domain, place).unwrap());
            assert!(one.point.distance(other.point) < 3e-15 * 4.0);
            assert!(one.dxx.distance(other.dxx) < 1e-11);
        }
        // Raising the ribbons first prescribes the same panels.
        let raised: Vec<Ribbon> = ring.ribbons().iter().map(Ribbon::elevated).collect();
        let raised = filled(&RibbonLoop::new(&raised).unwrap(), Join::Tangent, Fill::Biharmonic);
        let labels = Labels::new(n, d + 4).unwrap();
        for (rank, (one, other)) in raised.points().iter().zip(deeper.points()).enumerate() {
            if labels.kind(rank) != LabelKind::Interior {
                assert!(one.distance(*other) < 1e-13, "{:?}", labels.get(rank));
            }
        }
    }
}

#[test]
fn turning_and_mapping_the_ribbons_turns_and_maps_the_net() {
    let ring = random_loop(5, 3, 21);
    let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
    let labels = Labels::new(5, 6).unwrap();
    let mut turned = ring.ribbons().to_vec();
    turned.rotate_left(1);
    let map = |p: &DVec3| DVec3::new(2.0 * p.x - p.y + 100.0, p.y + 0.5 * p.z, p.z - 0.25 * p.x);
    for ribbon in &mut turned {
        ribbon.row0.iter_mut().chain(&mut ribbon.row1).for_each(|p| *p = map(p));
    }
    let other = filled(&RibbonLoop::new(&turned).unwrap(), Join::Tangent, Fill::Biharmonic);
    for (label, point) in labels.iter().zip(patch.points()) {
        let mut label = label.to_vec();
        label.rotate_left(1);
        let there = other.points()[labels.rank(&label).unwrap()];
        assert!(there.distance(map(point)) < 1e-12, "{label:?}: {:e}", there.distance(map(point)));
    }
}

#[test]
fn flat_ribbons_make_flat_patches_without_folds() {
    for n in 3..=7 {
        let corner = |k: usize| {
            let angle = core::f64::consts::TAU * k as f64 / n as f64;
            DVec3::new(libm::cos(angle), libm::sin(angle), 0.0)
        };
        let ribbons: Vec<Ribbon> = (0..n)
            .map(|i| {
                let at = |j: usize| corner(i).lerp(corner(i + 1), j as f64 / 3.0);
                let row0: Vec<DVec3> = (0..4).map(at).collect();
                // Legs blend from the side before to the side after.
                let (first, last) =
                    ((corner(i + n - 1) - corner(i)) / 3.0, (corner(i + 2) - corner(i + 1)) / 3.0);
                let row1 = (0..4).map(|j| row0[j] + first.lerp(last, j as f64 / 3.0)).collect();
                Ribbon { row0, row1 }
            })
            .collect();
        let ring = crate::made_compatible(&ribbons).unwrap().ribbons;
        let patch = filled(&ring, Join::Tangent, Fill::Biharmonic);
        let domain = Domain::new(n);
        let grid = Tessellation::new(n, 6, 8).unwrap();
        for place in grid.places() {
            let found = patch.at(&domain, place).unwrap();
            assert!(found.point.z.abs() < 1e-14 && found.dxx.z.abs() < 1e-12);
            let jacobian = found.dx.truncate().perp_dot(found.dy.truncate());
            assert!((0.7..1.25).contains(&jacobian), "{n} sides at {place}: {jacobian}");
        }
    }
}

#[test]
fn hostile_sizes_end_in_errors() {
    let points = |count: usize| (0..count).map(|j| DVec3::new(j as f64, 0.0, 0.0)).collect::<Vec<_>>();
    let ribbons = vec![Ribbon { row0: points(40), row1: points(40) }; 30];
    let ring = crate::ribbon::unchecked_loop(&ribbons);
    let found = SPatch::filling(&ring, Join::Tangent, Fill::Biharmonic, &mut MaskCache::new());
    assert!(
        matches!(found, Err(BuildError::TooLarge(TooManyPoints { sides: 30, depth: 42, .. }))),
        "{found:?}"
    );
    let labels = Labels::new(5, 3).unwrap();
    assert_eq!(SPatch::with_points(&labels, points(34)), None);
    assert_eq!(SPatch::with_points(&labels, points(35)).unwrap().points().len(), 35);
}

#[test]
fn size_and_place_do_not_matter() {
    for (size, offset) in [(1e-8, 0.0), (1e8, 0.0), (1.0, 1e6), (1e60, 0.0)] {
        let ring = random_loop(5, 3, 33);
        let own = filled(&ring, Join::Tangent, Fill::Biharmonic);
        let mut ribbons = ring.ribbons().to_vec();
        for ribbon in &mut ribbons {
            ribbon.row0.iter_mut().chain(&mut ribbon.row1).for_each(|p| *p = (*p + offset) * size);
        }
        let patch = filled(&RibbonLoop::new(&ribbons).unwrap(), Join::Tangent, Fill::Biharmonic);
        let domain = Domain::new(5);
        for place in [DVec2::ZERO, DVec2::new(0.4, 0.3), domain.on_side(2, 0.5)] {
            let (one, other) = (own.at(&domain, place).unwrap(), patch.at(&domain, place).unwrap());
            let off = (other.point / size - offset).distance(one.point);
            assert!(off < 1e-14 * (4.0 + offset), "{size} {offset}: {off:e}");
            let turn = angle(one.normal().unwrap(), other.normal().unwrap());
            assert!(turn < 1e-12 + 1e-15 * offset * 10.0, "{size} {offset}: {turn:e}");
        }
    }
}

/// Ribbons beyond side 0 of a loop: that side mirrored, and a random way round with so many sides in all.
pub(super) fn beyond(ring: &RibbonLoop, n: usize, seed: u64) -> RibbonLoop {
    let d = ring.degree();
    let shared = ring.ribbons()[0].mirrored();
    let mut ribbons = random_loop(n, d, seed).ribbons().to_vec();
    for ribbon in &mut ribbons {
        ribbon.row0.iter_mut().chain(&mut ribbon.row1).for_each(|p| p.x += 4.0);
    }
    ribbons[0] = shared.clone();
    // The neighbours begin and end as the mirrored side asks.
    let (after, before) = (1, n - 1);
    (ribbons[after].row0[0], ribbons[after].row0[1]) = (shared.row0[d], shared.row1[d]);
    (ribbons[after].row1[0], ribbons[after].row1[1]) = (shared.row0[d - 1], shared.row1[d - 1]);
    (ribbons[before].row0[d], ribbons[before].row0[d - 1]) = (shared.row0[0], shared.row1[0]);
    (ribbons[before].row1[d], ribbons[before].row1[d - 1]) = (shared.row0[1], shared.row1[1]);
    if d == 2 {
        // All twist points are one.
        ribbons.iter_mut().for_each(|ribbon| ribbon.row1[1] = shared.row1[1]);
    }
    crate::made_compatible(&ribbons).unwrap().ribbons
}

#[test]
fn neighbours_with_mirrored_ribbons_join_smoothly() {
    for (n, d) in [(3, 4), (5, 3), (6, 5)] {
        let ring = random_loop(n, d, 41);
        let other = beyond(&ring, n, 42);
        let [here, there] = [&ring, &other].map(|ring| filled(ring, Join::Tangent, Fill::Biharmonic));
        let domain = Domain::new(n);
        let mut far = there.along_side(&domain, 0, 20);
        far.reverse();
        let found = crate::seam(&here.along_side(&domain, 0, 20), &far).unwrap();
        assert!(found.gap < 1e-13 && found.angle < 1e-11, "{n} sides, degree {d}: {found:?}");
        // Meeting curves only, they do not.
        let [here, there] = [&ring, &other].map(|ring| filled(ring, Join::Position, Fill::Harmonic));
        let mut far = there.along_side(&domain, 0, 20);
        far.reverse();
        let found = crate::seam(&here.along_side(&domain, 0, 20), &far).unwrap();
        assert!(found.gap < 1e-13 && found.angle > 1e-2, "{n} sides, degree {d}: {found:?}");
    }
}
