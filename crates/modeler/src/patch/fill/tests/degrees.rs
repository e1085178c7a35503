//! Patches with many sides, whose ribbons have few points to follow planes with, beside others.

use super::*;
use ductile_spec::Seams;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// What polynomials leave, in degrees.
const JOINED: f64 = 0.01;
const HALF_WAY: f64 = 0.02;

/// Walls that bulge between two polygons with so many sides.
fn prism(sides: usize) -> Modeler {
    let mut modeler = Modeler::new();
    let floor = ring(&mut modeler, u32::try_from(sides).unwrap(), 1.0, 0.05);
    let at = |k: usize| {
        let (sin, cos) = libm::sincos((k as f64) * core::f64::consts::TAU / sides as f64);
        [cos, sin, 0.9 + 0.1 * cos]
    };
    let roof: Vec<PointId> = (0..sides).map(|k| point(&mut modeler, at(k))).collect();
    let centre = DVec3::new(0.0, 0.0, 0.45);
    for k in 0..sides {
        let next = (k + 1) % sides;
        for [from, to] in [[floor[k], roof[k]], [floor[k], floor[next]], [roof[k], roof[next]]] {
            let places = &modeler.model().document.points;
            let out = ((places[&from] + places[&to]) * 0.5 - centre) * (1.2 / sides as f64);
            arc(&mut modeler, from, to, out);
        }
    }
    rest(&mut modeler);
    modeler
}

fn filled(modeler: &mut Modeler, degree: Option<u8>) -> Seams {
    let style = FillStyle { degree, ..FillStyle::default() };
    edit(modeler, Edit::FillNetwork { curve: None, style });
    rest(modeler);
    seams(modeler)
}

/// The largest angle at a seam and the largest to planes that were asked for, in degrees.
fn told(name: &str, found: &Seams) -> [f64; 2] {
    let degrees: BTreeSet<_> =
        found.fills.iter().map(|fill| (fill.sides, fill.degree, fill.control_points)).collect();
    let angle = found.seams.iter().map(|seam| seam.angle).fold(0.0, f64::max);
    let asked = found.fills.iter().map(|fill| fill.plane_deviation).fold(0.0, f64::max);
    println!("{name}: {angle:.5}°, asked {asked:.5}°, {degrees:?}");
    assert!(found.seams.iter().all(|seam| seam.gap < 1e-12 && seam.without_normal == 0), "{name}");
    assert!(found.fills.iter().all(|fill| fill.stuck.is_none()), "{name}");
    [angle, asked]
}

#[test]
fn patches_with_any_number_of_sides_and_of_any_degree_join_their_neighbours() {
    // With nine sides the corners of such a prism hardly turn, and have no patches; see the pairs below.
    for sides in 3..=8 {
        for degree in [None, Some(3), Some(4), Some(5)] {
            let found = filled(&mut prism(sides), degree);
            let [angle, asked] = told(&format!("prism of {sides}, {degree:?}"), &found);
            assert_eq!(found.seams.len(), 3 * sides);
            // Walls and polygons of degree 7 along curves of degree 7 meet half way, in planes that are no polynomials (0.012° measured).
            let most = if degree.is_none() && sides < 6 { HALF_WAY } else { JOINED };
            assert!(angle < most && asked < most, "{sides} {degree:?}: {angle} {asked}");
        }
    }
}

/// Two polygons with an edge in common.
fn pair(sides: usize) -> Modeler {
    let mut modeler = Modeler::new();
    let at = |x: f64, k: usize| {
        let (sin, cos) = libm::sincos((k as f64 + 0.5) * core::f64::consts::TAU / sides as f64);
        let (x, y) = (x + cos, sin);
        [x, y, 0.15 * x * x - 0.1 * y * y + 0.1 * x * y]
    };
    let one: Vec<PointId> = (0..sides).map(|k| point(&mut modeler, at(0.0, k))).collect();
    let apart = 2.0 * libm::cos(core::f64::consts::PI / sides as f64);
    // The mirror image: it begins and ends at the common edge.
    let mut other: Vec<PointId> = vec![one[0]];
    for k in 1..sides - 1 {
        let [x, y, _] = at(0.0, k);
        let x = apart - x;
        other.push(point(&mut modeler, [x, y, 0.15 * x * x - 0.1 * y * y + 0.1 * x * y]));
    }
    other.push(one[sides - 1]);
    for (ring, skipped) in [(one, None), (other, Some(sides - 1))] {
        for k in (0..sides).filter(|k| Some(*k) != skipped) {
            arc(&mut modeler, ring[k], ring[(k + 1) % sides], DVec3::new(0.02, 0.01, 0.03));
        }
    }
    rest(&mut modeler);
    modeler
}

#[test]
fn two_patches_with_many_sides_and_of_any_degree_join() {
    for sides in 3..=9 {
        for degree in [None, Some(3), Some(4), Some(5)] {
            // These have more control points than follow a hand.
            if sides == 9 && degree == Some(5) {
                continue;
            }
            let found = filled(&mut pair(sides), degree);
            let [angle, asked] = told(&format!("two of {sides}, {degree:?}"), &found);
            assert_eq!(found.seams.len(), 1);
            assert!(angle < JOINED && asked < JOINED, "{sides} {degree:?}: {angle} {asked}");
        }
    }
}
