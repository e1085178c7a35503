//! The tree finds what looking at everything finds.

use proptest::prelude::*;

use super::*;
use crate::property_test::cases;
use crate::{nearest_place, primitive};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn moved(positions: &[DVec3], turn: DVec3, shift: DVec3) -> Vec<DVec3> {
    let [x, y, z] = [turn.x, turn.y, turn.z].map(|t| [libm::cos(t), libm::sin(t)]);
    let about_x = |p: DVec3| DVec3::new(p.x, x[0] * p.y - x[1] * p.z, x[1] * p.y + x[0] * p.z);
    let about_y = |p: DVec3| DVec3::new(y[0] * p.x + y[1] * p.z, p.y, y[0] * p.z - y[1] * p.x);
    let about_z = |p: DVec3| DVec3::new(z[0] * p.x - z[1] * p.y, z[1] * p.x + z[0] * p.y, p.z);
    positions.iter().map(|&p| about_z(about_y(about_x(p))) + shift).collect()
}

proptest! {
    #![proptest_config(cases(96, 24))]

    #[test]
    fn the_nearest_place_is_that_of_the_plain_search(x in -4.0..4.0, y in -4.0..4.0, z in -2.0..2.0) {
        let (mesh, positions) = primitive::torus(17, 9, 2.0, 0.8);
        let tree = SurfaceTree::new(&mesh, &positions);
        let at = DVec3::new(x, y, z);
        let (place, there) = tree.nearest(&mesh, at).unwrap();
        let plain = nearest_place(&mesh, &positions, at).unwrap();
        prop_assert_eq!(place, plain);
        prop_assert!(plain.position(&mesh, &positions).unwrap().distance(there) < 1e-12);
    }

    #[test]
    fn the_closest_pair_is_that_of_all_pairs(
        turn in (-3.0..3.0, -3.0..3.0, -3.0..3.0),
        shift in (-4.0..4.0, -4.0..4.0, -4.0..4.0),
    ) {
        let (torus, ring) = primitive::torus(7, 5, 2.0, 0.6);
        let (box_, sides) = primitive::octahedron();
        let sides = moved(&sides, DVec3::from(turn), DVec3::from(shift));
        let (one, other) = (SurfaceTree::new(&torus, &ring), SurfaceTree::new(&box_, &sides));
        let pair = one.closest(&other).unwrap();
        let [p, q] = pair.positions;
        prop_assert!((p.distance(q) - pair.distance).abs() < 1e-12);
        prop_assert!(pair.one.position(&torus, &ring).unwrap().distance(p) < 1e-12);
        prop_assert!(pair.other.position(&box_, &sides).unwrap().distance(q) < 1e-12);
        let mut least = f64::INFINITY;
        for (k, l) in (0..one.corners.len()).flat_map(|k| (0..other.corners.len()).map(move |l| (k, l))) {
            least = least.min(Touch::of(one.corners[k], other.corners[l], (k, l)).squared);
        }
        prop_assert_eq!(pair.distance, least.sqrt());
        // Whatever is nearest to one of the two is no nearer than the other.
        let (_, back) = other.nearest(&box_, p).unwrap();
        prop_assert!(back.distance(p) >= pair.distance - 1e-9 && back.distance(p) <= pair.distance + 1e-9);
    }

    #[test]
    fn two_triangles_are_as_far_apart_as_their_samples(
        spots in prop::collection::vec((-1.0..1.0, -1.0..1.0, -1.0..1.0), 6),
    ) {
        let at: Vec<DVec3> = spots.into_iter().map(DVec3::from).collect();
        let [one, two] = [[at[0], at[1], at[2]], [at[3], at[4], at[5]]];
        let touch = Touch::of(one, two, (0, 0));
        let mut least = f64::INFINITY;
        let shares = || (0..=12).flat_map(|i| (0..=12 - i).map(move |j| (f64::from(i) / 12.0, f64::from(j) / 12.0)));
        for (u, v) in shares() {
            let p = mix(one, [u, v, 1.0 - u - v]);
            least = least.min(mix(two, nearest_weights(p, two)).distance(p));
        }
        let found = touch.squared.sqrt();
        // Samples lie a twelfth of a side apart, and no side is longer than 3.5.
        prop_assert!(found <= least + 1e-12 && least <= found + 3.5 / 12.0, "{} {}", found, least);
    }
}

#[test]
fn two_balls_are_closest_between_their_centres() {
    let (mesh, positions) = primitive::icosphere(4);
    let there = moved(&positions, DVec3::new(0.3, 0.8, -0.4), DVec3::new(1.0, 2.0, 2.0));
    let (one, other) = (SurfaceTree::new(&mesh, &positions), SurfaceTree::new(&mesh, &there));
    let pair = one.closest(&other).unwrap();
    // Facets lie at most 0.2 % inside the ball.
    assert!((1.0..1.01).contains(&pair.distance), "{}", pair.distance);
    let [p, q] = pair.positions;
    let between = DVec3::new(1.0, 2.0, 2.0) / 3.0;
    assert!(p.distance(between) < 0.1 && q.distance(between * 2.0) < 0.1);
    assert!(one.closest(&one).unwrap().distance == 0.0);
}

#[test]
fn a_pair_on_one_surface_is_refined_where_it_is() {
    // A ball with a dent from above and from below, which are nearest to each other on its axis.
    let (mesh, round) = primitive::icosphere(4);
    let dented = |p: &DVec3| DVec3::new(p.x, p.y, p.z * (0.3 + 0.7 * (p.x * p.x + p.y * p.y)));
    let positions: Vec<DVec3> = round.iter().map(dented).collect();
    let place = |x: f64, z: f64| nearest_place(&mesh, &positions, DVec3::new(x, 0.1, z)).unwrap();
    for reach in [0.4, 0.6] {
        let pair = refine_pair(&mesh, &positions, [place(0.3, 0.4), place(-0.2, -0.4)], reach).unwrap();
        let [p, q] = pair.positions;
        assert!((0.59..0.61).contains(&pair.distance), "{pair:?}");
        assert!(
            p.truncate().length() < 0.1 && q.truncate().length() < 0.1 && p.z > 0.0 && q.z < 0.0,
            "{pair:?}"
        );
    }
    // Patches that would run into one another are made smaller: else the pair would be one of neighbours at the rim.
    let wide = refine_pair(&mesh, &positions, [place(0.3, 0.4), place(-0.2, -0.4)], 3.0).unwrap();
    assert!(wide.distance > 0.4, "{wide:?}");
    assert_eq!(refine_pair(&mesh, &positions, [place(0.3, 0.4), place(0.3, 0.4)], 0.5), None);
    assert_eq!(refine_pair(&mesh, &positions, [place(0.3, 0.4), place(0.3, -0.4)], f64::NAN), None);
}

#[test]
fn faces_that_lie_on_one_another_and_nothing_at_all() {
    let (mesh, positions) = primitive::icosphere(3);
    let flat = vec![DVec3::ONE; positions.len()];
    let tree = SurfaceTree::new(&mesh, &flat);
    assert_eq!(tree.nearest(&mesh, DVec3::ZERO).unwrap().1, DVec3::ONE);
    assert_eq!(tree.closest(&tree).unwrap().distance, 0.0);
    let empty = SurfaceTree::new(&mesh, &[]);
    assert!(empty.is_empty() && empty.nearest(&mesh, DVec3::ZERO).is_none());
    assert!(tree.closest(&empty).is_none() && empty.closest(&tree).is_none());
    let mut hurt = positions.clone();
    hurt[3] = DVec3::NAN;
    let tree = SurfaceTree::new(&mesh, &hurt);
    assert!(tree.nearest(&mesh, positions[3]).unwrap().1.distance(positions[3]) > 0.01);
    assert!(tree.nearest(&mesh, DVec3::NAN).is_none());
}

#[test]
fn large_surfaces_look_at_few_faces() {
    let (mesh, positions) = primitive::icosphere(5);
    let tree = SurfaceTree::new(&mesh, &positions);
    assert_eq!(mesh.face_count(), 20480);
    // Halves of equal count: 20480 / 4 needs thirteen halvings.
    let mut depth = vec![0; tree.nodes.len()];
    for (k, node) in tree.nodes.iter().enumerate().filter(|(_, node)| node.second > 0) {
        (depth[k + 1], depth[node.second]) = (depth[k] + 1, depth[k] + 1);
    }
    assert_eq!(depth.iter().max(), Some(&13));
}
