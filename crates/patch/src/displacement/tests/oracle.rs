//! What is known exactly: Green's function of the disc, linear functions, level sets; and what must converge.

use super::plain;
use crate::displacement::dense;
use crate::displacement::extension::Extension;
use crate::displacement::laplacian::Stiffness;
use crate::{
    Combination, Direction, DisplacementError, Displacements, Domain, Item, Laplacian, Profile, Range,
    Settings,
};
use ductile_solver::workload;
use glam::{DVec2, DVec3};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// The unit disc; ring `k` of it has `6 k` vertices, beginning on the positive x axis.
fn disc(rings: usize) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let disc = workload::disc(rings);
    (disc.positions, disc.triangles)
}

/// The vertex at a share of the ring's turn.
fn on_ring(ring: usize, step: usize) -> usize {
    if ring == 0 { 0 } else { 1 + 3 * ring * (ring - 1) + step }
}

/// The same points, turned about the centre by more the farther inside: triangles become obtuse and thin.
fn twisted(rings: usize, turn: f64) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let (mut positions, triangles) = disc(rings);
    for position in &mut positions {
        let (sin, cos) = libm::sincos(turn * (1.0 - position.length()));
        *position = DVec3::new(cos * position.x - sin * position.y, sin * position.x + cos * position.y, 0.0);
    }
    (positions, triangles)
}

fn with_foot(
    (positions, triangles): (Vec<DVec3>, Vec<[u32; 3]>),
    foot: usize,
    settings: Settings,
) -> Displacements {
    let domain = Domain::new(&positions, &triangles).unwrap();
    let mut surface = Displacements::new(domain, settings).unwrap();
    surface.add(Item::foot(foot, DVec3::Z)).unwrap();
    surface
}

/// `|(z - a) / (1 - conj(a) z)|` for a real `a`.
fn exact_radius(z: DVec3, a: f64) -> f64 {
    let over = DVec2::new(z.x - a, z.y).length();
    over / DVec2::new(1.0 - a * z.x, a * z.y).length()
}

fn radius_error(shape: (Vec<DVec3>, Vec<[u32; 3]>), foot: usize, settings: Settings) -> f64 {
    let positions = shape.0.clone();
    let surface = with_foot(shape, foot, settings);
    let a = positions[foot].length();
    let logarithm = surface.logarithm(0).unwrap();
    let (sin, cos) = libm::sincos(libm::atan2(positions[foot].y, positions[foot].x));
    let turned = |p: DVec3| DVec3::new(cos * p.x + sin * p.y, cos * p.y - sin * p.x, 0.0);
    let error = |(p, l): (&DVec3, &f64)| (libm::exp(*l) - exact_radius(turned(*p), a)).abs();
    positions.iter().zip(logarithm).map(error).fold(0.0, f64::max)
}

#[test]
fn the_conformal_radius_of_the_disc_is_met() {
    let conformal = Settings { laplacian: Laplacian::Cotangent, ..Settings::default() };
    let centre = radius_error(disc(8), 0, conformal);
    assert!(centre < 1.65e-3, "{centre:e}");
    for (rings, known) in [(32, 2.5e-3), (64, 1.2e-3), (128, 6.5e-4)] {
        let error = radius_error(disc(rings), on_ring(rings / 2, 0), conformal);
        assert!(error < 1.05 * known, "{rings} rings: {error:e}");
    }
}

#[test]
fn the_conformal_profile_converges_and_the_harmonic_one_does_not() {
    let height = |rings: usize, profile| {
        let surface = with_foot(disc(rings), 0, Settings { profile, ..plain() });
        -libm::expm1(surface.logarithm(0).unwrap()[on_ring(rings / 4, 0)])
    };
    let errors = [16, 32, 64].map(|rings| (height(rings, Profile::Conformal) - 0.75).abs());
    assert!(errors[2] < 1e-3 && errors[0] > 3.5 * errors[1] && errors[1] > 3.5 * errors[2], "{errors:?}");
    // The recipe's figures; a foot of a single vertex has no capacity in the plane.
    for (rings, known) in [(8, 0.358), (16, 0.303), (32, 0.263), (64, 0.232), (128, 0.208)] {
        let found = height(rings, Profile::Harmonic);
        assert!((found - known).abs() < 6e-4, "{rings} rings: {found}");
    }
}

#[test]
fn distorted_triangles_spoil_the_cotangents_but_not_the_intrinsic_ones() {
    for turn in [2.5, 4.0, 5.0] {
        let error =
            |laplacian| radius_error(twisted(16, turn), 0, Settings { laplacian, ..Settings::default() });
        let (intrinsic, cotangent) = (error(Laplacian::IntrinsicDelaunay), error(Laplacian::Cotangent));
        assert!(intrinsic < 0.02, "turn {turn}: {intrinsic}");
        assert!(cotangent > 2.0 * intrinsic, "turn {turn}: {cotangent} and {intrinsic}");
    }
}

#[test]
fn linear_functions_are_harmonic_in_the_plane() {
    for (positions, triangles) in [disc(6), twisted(9, 1.5), twisted(12, 4.0)] {
        let domain = Domain::new(&positions, &triangles).unwrap();
        for laplacian in [Laplacian::Cotangent, Laplacian::IntrinsicDelaunay] {
            let stiffness = Stiffness::new(&domain, laplacian, None).unwrap();
            let linear: Vec<f64> = positions.iter().map(|p| 3.0 * p.x - 2.0 * p.y + 1.0).collect();
            let largest = stiffness.weights.iter().map(|w| w.2.abs()).fold(1.0, f64::max);
            for (vertex, value) in stiffness.apply(&linear).into_iter().enumerate() {
                assert!(domain.held()[vertex] || value.abs() < 1e-12 * largest, "{laplacian:?}: {value:e}");
            }
            let area: f64 = stiffness.areas.iter().sum();
            let is_area = |area: f64| {
                let exact: f64 = triangles
                    .iter()
                    .map(|t| t.map(|v| domain.positions[v as usize]))
                    .map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length())
                    .sum();
                (area - exact).abs() < 1e-9 * exact
            };
            // Flips keep the metric, unless the twist turned a triangle over.
            assert!(is_area(area), "{laplacian:?}");
        }
    }
}

#[test]
fn flips_leave_no_negative_weight() {
    for (rings, turn) in [(6, 0.0), (9, 1.5), (12, 4.0)] {
        let (positions, triangles) = twisted(rings, turn);
        let domain = Domain::new(&positions, &triangles).unwrap();
        let least = |laplacian| {
            let stiffness = Stiffness::new(&domain, laplacian, None).unwrap();
            let mut sides = stiffness.weights;
            sides.iter_mut().for_each(|w| (w.0, w.1) = (w.0.min(w.1), w.0.max(w.1)));
            sides.sort_by_key(|w| (w.0, w.1));
            let sum = |same: &[(u32, u32, f64)]| same.iter().map(|w| w.2).sum::<f64>();
            let is_inner = |same: &&[(u32, u32, f64)]| {
                !(domain.held()[same[0].0 as usize] && domain.held()[same[0].1 as usize])
            };
            sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)).filter(is_inner).map(sum).fold(0.0, f64::min)
        };
        assert!(least(Laplacian::IntrinsicDelaunay) > -1e-9);
        assert!(turn == 0.0 || least(Laplacian::Cotangent) < -0.01, "the mesh is not bad at all");
    }
}

#[test]
fn the_reduced_solution_is_that_of_the_multipliers() {
    let (positions, triangles) = disc(3);
    let domain = Domain::new(&positions, &triangles).unwrap();
    let stiffness = Stiffness::new(&domain, Laplacian::Cotangent, None).unwrap();
    let count = domain.len();
    let foot = on_ring(1, 2);
    let fixed: Vec<usize> = (0..count).filter(|&v| domain.held()[v] || v == foot).collect();
    let size = count + fixed.len();
    let mut matrix = vec![vec![0.0; size]; size];
    for &(a, b, weight) in &stiffness.weights {
        let (a, b) = (a as usize, b as usize);
        matrix[a][a] += weight;
        matrix[b][b] += weight;
        matrix[a][b] -= weight;
        matrix[b][a] -= weight;
    }
    for (row, &vertex) in fixed.iter().enumerate() {
        matrix[count + row][vertex] = 1.0;
        matrix[vertex][count + row] = 1.0;
    }
    let inverse = dense::inverse(&matrix).unwrap();
    let column = count + fixed.iter().position(|&v| v == foot).unwrap();
    let surface = with_foot(disc(3), foot, plain());
    let green = surface.solution(0).unwrap();
    for vertex in 0..count {
        assert!((inverse[vertex][column] - green[vertex] / green[foot]).abs() < 1e-14, "{vertex}");
    }
}

/// How far from the centre the function has fallen to a level, along a ray of vertices.
fn reach(heights: &[f64], ray: impl Fn(usize) -> usize, rings: usize, level: f64) -> f64 {
    let outside = (1..=rings).find(|&ring| heights[ray(ring)] < level).unwrap();
    let (above, below) = (heights[ray(outside - 1)], heights[ray(outside)]);
    (outside as f64 - (below - level) / (below - above)) / rings as f64
}

#[test]
fn directions_stretch_level_sets() {
    let rings = 64;
    for (stretch, near, middle) in [(2.0, 2.0, 1.76), (4.0, 4.1, 3.4), (8.0, 8.2, 6.8)] {
        let (positions, triangles) = disc(rings);
        let mut surface =
            Displacements::new(Domain::new(&positions, &triangles).unwrap(), Settings::default()).unwrap();
        let direction = Direction::new(DVec3::new(0.0, 2.0, 0.0), stretch).unwrap();
        surface.add(Item::foot(0, DVec3::Z).with_direction(direction)).unwrap();
        let heights: Vec<f64> = surface.logarithm(0).unwrap().iter().map(|&l| -libm::expm1(l)).collect();
        // No ring but every second has a vertex on the y axis: the x axis for across, 90 degrees for along.
        let along = |level| {
            let even = |half: usize| on_ring(2 * half, 3 * half);
            reach(&heights, even, rings / 2, level)
        };
        let across = |level| reach(&heights, |ring| on_ring(ring, 0), rings, level);
        let aspect = |level| along(level) / across(level);
        assert!((aspect(0.8) - near).abs() < 0.06 * near, "{stretch}: {}", aspect(0.8));
        assert!((aspect(0.5) - middle).abs() < 0.03 * middle, "{stretch}: {}", aspect(0.5));
    }
}

#[test]
fn without_stretch_a_direction_changes_nothing() {
    let torus = workload::torus(12, 7, 2.0, 0.8);
    let domain = Domain::new(&torus.positions, &torus.triangles).unwrap();
    let plain = Stiffness::new(&domain, Laplacian::Cotangent, None).unwrap();
    let direction = Direction::new(DVec3::new(1.0, 2.0, 3.0), 1.0).unwrap();
    let directed = Stiffness::new(&domain, Laplacian::Cotangent, Some(direction)).unwrap();
    for (x, y) in plain.weights.iter().zip(&directed.weights) {
        assert!((x.0, x.1) == (y.0, y.1) && (x.2 - y.2).abs() < 1e-13);
    }
}

#[test]
fn a_direction_in_the_plane_is_a_change_of_metric() {
    // T⁻¹ᐟ² with the direction at 30 degrees, written out.
    let (positions, triangles) = twisted(10, 1.0);
    let (sin, cos) = libm::sincos(core::f64::consts::FRAC_PI_6);
    let along = DVec3::new(cos, sin, 0.0);
    let across = DVec3::new(-sin, cos, 0.0);
    let squeeze =
        |p: &DVec3| along * (p.dot(along) / libm::sqrt(3.0)) + across * (p.dot(across) * libm::sqrt(3.0));
    let squeezed: Vec<DVec3> = positions.iter().map(squeeze).collect();
    let weights = |positions: &[DVec3], laplacian, direction| {
        let domain = Domain::new(positions, &triangles).unwrap();
        Stiffness::new(&domain, laplacian, direction).unwrap()
    };
    let direction = Some(Direction::new(along + 7.0 * DVec3::Z, 3.0).unwrap());
    for laplacian in [Laplacian::Cotangent, Laplacian::IntrinsicDelaunay] {
        let (one, other) = (weights(&positions, laplacian, direction), weights(&squeezed, laplacian, None));
        let field: Vec<f64> = positions.iter().map(|p| p.x * p.x - 3.0 * p.x * p.y).collect();
        for (x, y) in one.apply(&field).iter().zip(other.apply(&field)) {
            assert!((x - y).abs() < 1e-11, "{laplacian:?}: {x} and {y}");
        }
    }
}

#[test]
fn pairwise_converges_under_refinement_and_meets_every_foot() {
    let found = [16, 32, 64].map(|rings| {
        let (positions, triangles) = disc(rings);
        let domain = Domain::new(&positions, &triangles).unwrap();
        let mut surface = Displacements::new(domain, Settings::default()).unwrap();
        let feet = [on_ring(rings / 4, 0), on_ring(rings / 2, rings), on_ring(rings / 2, 2 * rings)];
        let asked = [DVec3::new(0.0, 0.0, 0.1), DVec3::ZERO, DVec3::new(0.1, 0.2, 0.3)];
        for (foot, d) in feet.into_iter().zip(asked) {
            surface.add(Item::foot(foot, d).with_range(Range::new(0.5).unwrap())).unwrap();
        }
        let offsets = surface.offsets().unwrap();
        assert!(feet.iter().zip(asked).all(|(&foot, d)| offsets[foot] == d));
        offsets[on_ring(rings / 4, rings / 2)].z
    });
    let steps = [found[1] - found[0], found[2] - found[1]].map(f64::abs);
    assert!(steps[1] < 0.35 * steps[0] && steps[1] < 1e-4 && found[2] > 0.01, "{found:?}");
}

#[test]
fn gram_meets_every_foot_or_says_why_not() {
    let rings = 16;
    let surface = |settings, range: f64| {
        let (positions, triangles) = disc(rings);
        let mut surface = Displacements::new(Domain::new(&positions, &triangles).unwrap(), settings).unwrap();
        for (step, height) in [(0, 0.1), (16, 0.2), (32, -0.3)] {
            let item = Item::foot(on_ring(8, step), DVec3::new(0.0, height, 1.0));
            surface.add(item.with_range(Range::new(range).unwrap())).unwrap();
        }
        surface
    };
    let gram = Settings { combination: Combination::Gram, ..plain() };
    let mut small = surface(gram, 0.5);
    let offsets = small.offsets().unwrap();
    for (step, height) in [(0, 0.1), (16, 0.2), (32, -0.3)] {
        assert!(offsets[on_ring(8, step)].distance(DVec3::new(0.0, height, 1.0)) < 1e-14);
    }
    let mut wide = surface(Settings { profile: Profile::Conformal, ..gram }, 0.95);
    let refusal = wide.offsets().unwrap_err();
    assert!(
        matches!(refusal, DisplacementError::IllConditioned { condition, .. } if condition > 1e6),
        "{refusal}"
    );
    wide.set_range(1, Range::new(-2.0).unwrap()).unwrap();
    wide.set_range(0, Range::new(-2.0).unwrap()).unwrap();
    assert!(wide.offsets().is_ok());
}

/// The middle half of the diameter on the x axis.
fn diameter(rings: usize) -> Vec<usize> {
    let left = (1..=rings / 2).rev().map(|ring| on_ring(ring, 3 * ring));
    left.chain([0]).chain((1..=rings / 2).map(|ring| on_ring(ring, 0))).collect()
}

#[test]
fn curves_have_a_capacity() {
    let heights = [8, 16, 32].map(|rings| {
        let (positions, triangles) = disc(rings);
        let domain = Domain::new(&positions, &triangles).unwrap();
        let mut surface = Displacements::new(domain, Settings::default()).unwrap();
        let curve = Item::curve(diameter(rings), false, vec![DVec3::Z]).unwrap();
        surface.add(curve).unwrap();
        let offsets = surface.offsets().unwrap();
        assert!(diameter(rings).iter().all(|&vertex| offsets[vertex] == DVec3::Z));
        surface.solution(0).unwrap()[on_ring(rings / 2, 3 * rings / 4)]
    });
    let steps = [heights[1] - heights[0], heights[2] - heights[1]].map(f64::abs);
    assert!(steps[1] < 0.7 * steps[0] && steps[1] < 0.01, "{heights:?}");
}

#[test]
fn what_varies_along_a_curve_leaves_it_without_a_kink() {
    // The slopes at both sides of the curve, across it, differ by a share of the edge length and not by a fixed amount.
    let jumps = [16, 32, 64].map(|rings| {
        let (positions, triangles) = disc(rings);
        let domain = Domain::new(&positions, &triangles).unwrap();
        let stiffness = Stiffness::new(&domain, Laplacian::IntrinsicDelaunay, None).unwrap();
        let curve = diameter(rings);
        let values: Vec<DVec3> = curve.iter().map(|&v| DVec3::Z * libm::cos(6.0 * positions[v].x)).collect();
        let field = Extension::new(&stiffness, &curve).unwrap().spread(&curve, &values).unwrap();
        let ring = rings / 4;
        let [on, above, below] = [on_ring(ring, 0), on_ring(ring, 1), on_ring(ring, 6 * ring - 1)];
        let height = positions[above].y;
        (field[above].z + field[below].z - 2.0 * field[on].z).abs() / height
    });
    assert!(jumps[1] < 0.65 * jumps[0] && jumps[2] < 0.65 * jumps[1] && jumps[2] < 0.7, "{jumps:?}");
    let constant = Item::curve(diameter(8), false, vec![DVec3::Z; 9]).unwrap();
    assert_eq!(constant.common(), Some(DVec3::Z));
}
