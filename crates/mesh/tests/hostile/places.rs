//! Places on hostile surfaces: the nearest one, the tree that finds it, pairs of surfaces, lines common to both.

use super::*;
use ductile_mesh::{IntersectError, Place, SurfaceTree, intersections, nearest_place, refine_pair};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// The table, and sizes whose squares, or whose sums of three, are no numbers.
fn hostile_and_beyond(mesh: &Mesh, good: &[DVec3]) -> Vec<(&'static str, Vec<DVec3>)> {
    let mut all = hostile(mesh, good);
    for (name, scale) in [("squares overflow", 1e200), ("sums overflow", 1.5e308), ("squares vanish", 1e-200)]
    {
        all.push((name, good.iter().map(|p| *p * scale).collect()));
    }
    all
}

/// Points that a surface may be asked about.
fn askers(positions: &[DVec3]) -> Vec<DVec3> {
    let far = [1e150, 1e200, 1.5e308].map(|size| DVec3::new(size, -size, size));
    let near = [DVec3::ZERO, DVec3::splat(1e-200), DVec3::new(0.3, 0.2, 0.9)];
    far.into_iter().chain(near).chain(positions.iter().copied().step_by(11)).collect()
}

#[test]
fn the_nearest_place_is_one_on_the_surface_or_none_and_a_tree_finds_the_same() {
    for (base, mesh, good) in bases() {
        for (name, positions) in hostile_and_beyond(&mesh, &good) {
            let tree = SurfaceTree::new(&mesh, &positions);
            for at in askers(&positions) {
                let says = format!("{base}, {name}, {at}");
                let place = nearest_place(&mesh, &positions, at);
                let found = tree.nearest(&mesh, at);
                assert!(place.is_none_or(|place| place.is_on(&mesh)), "{says}: {place:?}");
                let there = place.and_then(|place| place.position(&mesh, &positions));
                assert!(there.is_none_or(DVec3::is_finite), "{says}: {place:?}");
                let far = |p: DVec3| p.distance_squared(at);
                if let Some((place, there)) = found {
                    assert!(place.is_on(&mesh) && there.is_finite(), "{says}: {place:?}, {there}");
                }
                // The tree leaves out only faces that are no numbers, and squares that overflow.
                match (there, found) {
                    (Some(one), Some((_, other))) => {
                        assert_eq!(far(one).to_bits(), far(other).to_bits(), "{says}: {one}, {other}");
                    }
                    (None, None) => {}
                    _ => panic!("{says}: {place:?}, {found:?}"),
                }
            }
            for nonsense in [DVec3::NAN, DVec3::INFINITY] {
                assert_eq!(nearest_place(&mesh, &positions, nonsense), None, "{base}, {name}");
                assert_eq!(tree.nearest(&mesh, nonsense), None, "{base}, {name}");
            }
            // Positions that are missing make no face.
            assert!(
                SurfaceTree::new(&mesh, &[]).is_empty() && nearest_place(&mesh, &[], DVec3::ZERO).is_none()
            );
        }
    }
}

#[test]
fn the_closest_pair_of_two_surfaces_lies_on_both() {
    for (base, mesh, good) in bases() {
        let tree = SurfaceTree::new(&mesh, &good);
        let all = hostile_and_beyond(&mesh, &good);
        for (name, positions) in &all {
            let says = format!("{base}, {name}");
            let other = SurfaceTree::new(&mesh, positions);
            for pair in [tree.closest(&other), other.closest(&tree), other.closest(&other)] {
                match pair {
                    Some(pair) => {
                        assert!(pair.one.is_on(&mesh) && pair.other.is_on(&mesh), "{says}: {pair:?}");
                        assert!(pair.positions.iter().all(|p| p.is_finite()), "{says}: {pair:?}");
                        assert!(!pair.distance.is_nan(), "{says}: {pair:?}");
                    }
                    None => assert!(other.is_empty(), "{says}: two surfaces, and no pair"),
                }
            }
            if let Some(pair) = other.closest(&other) {
                assert_eq!(pair.distance, 0.0, "{says}: a surface is apart from itself");
            }
            let ends = [0, mesh.vertex_count() - 1].map(|v| Place::Vertex(VertexId::from_index(v)));
            for reach in [0.3, 1e150, 0.0, -1.0, f64::NAN, f64::INFINITY] {
                if let Some(pair) = refine_pair(&mesh, positions, ends, reach) {
                    assert!(pair.one.is_on(&mesh) && pair.other.is_on(&mesh), "{says}: {pair:?}");
                    assert!(reach > 0.0, "{says}: reach {reach}");
                }
            }
            let nowhere = [Place::Vertex(VertexId::from_index(9999)), ends[1]];
            assert_eq!(refine_pair(&mesh, positions, nowhere, 1.0), None, "{says}");
        }
    }
}

#[test]
fn lines_common_to_a_hostile_surface_lie_on_both_or_the_reason_is_told() {
    for (base, mesh, good) in bases() {
        let shift = DVec3::new(0.31, 0.17, 0.23);
        let there: Vec<DVec3> = good.iter().map(|p| *p + shift).collect();
        for (name, positions) in hostile_and_beyond(&mesh, &good) {
            let says = format!("{base}, {name}");
            let is_good = positions.iter().all(|p| p.is_finite());
            let pairs = [(&positions, &there), (&there, &positions), (&positions, &positions)];
            for (k, (one, other)) in pairs.into_iter().enumerate() {
                match intersections((&mesh, one), (&mesh, other)) {
                    Ok(lines) => {
                        assert!(is_good, "{says}: {lines:?}");
                        for point in lines.iter().flat_map(|line| &line.points) {
                            assert!(point.places.iter().all(|place| place.is_on(&mesh)), "{says}: {point:?}");
                            assert!(point.position.is_finite(), "{says}, {k}: {point:?}");
                        }
                    }
                    Err(IntersectError::NotFinite(..)) => assert!(!is_good, "{says}"),
                    Err(IntersectError::Tangent(..) | IntersectError::Unresolved(..)) => {
                        assert!(name != "good" || k == 2, "{says}");
                    }
                }
            }
        }
    }
}
