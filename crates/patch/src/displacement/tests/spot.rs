//! Feet between vertices: the triangles stay, and what is known of the disc still holds.

use crate::{Combination, DisplacementError, Displacements, Domain, Item, Settings};
use ductile_solver::workload;
use glam::{DVec2, DVec3};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const SHARES: [f64; 3] = [0.5, 0.3, 0.2];

fn disc(rings: usize, settings: Settings) -> (Displacements, Vec<DVec3>, Vec<[u32; 3]>) {
    let disc = workload::disc(rings);
    let domain = Domain::new(&disc.positions, &disc.triangles).unwrap();
    (Displacements::new(domain, settings).unwrap(), disc.positions, disc.triangles)
}

fn place(positions: &[DVec3], corners: [u32; 3], shares: [f64; 3]) -> DVec3 {
    corners.iter().zip(shares).map(|(&corner, share)| positions[corner as usize] * share).sum()
}

/// `|(z - a) / (1 - conj(a) z)|`.
fn exact_radius(z: DVec3, a: DVec3) -> f64 {
    let product = DVec2::new(a.x * z.x + a.y * z.y, a.x * z.y - a.y * z.x);
    (z - a).length() / (DVec2::X - product).length()
}

/// Largest error of ρ beyond a distance from a foot that lies in the triangle around (0.4, 0.1).
fn error(rings: usize, beyond: f64) -> f64 {
    let (mut surface, positions, triangles) = disc(rings, Settings::default());
    let middle = |t: &[u32; 3]| place(&positions, *t, [1.0 / 3.0; 3]).distance(DVec3::new(0.4, 0.1, 0.0));
    let corners = triangles.iter().copied().min_by(|a, b| middle(a).total_cmp(&middle(b))).unwrap();
    let foot = place(&positions, corners, SHARES);
    surface.add(Item::spot(corners, SHARES, DVec3::Z).unwrap()).unwrap();
    let found = surface.logarithm(0).unwrap().iter().map(|&x| libm::exp(x));
    let far = positions.iter().zip(found).filter(|(p, _)| p.distance(foot) > beyond);
    far.map(|(p, rho)| (rho - exact_radius(*p, foot)).abs()).fold(0.0, f64::max)
}

#[test]
fn a_foot_between_vertices_has_the_level_sets_of_the_conformal_map() {
    let [coarse, fine] = [16, 32].map(|rings| error(rings, 0.15));
    assert!(coarse < 6e-3 && fine < 0.4 * coarse, "{coarse} and {fine}");
    // Beside the foot, where a level set is no larger than a triangle, the error is a part of the distance.
    assert!(error(32, 0.0) < 0.01, "{}", error(32, 0.0));
}

#[test]
fn all_at_a_corner_is_a_foot_at_that_vertex() {
    let (mut surface, _, triangles) = disc(8, Settings::default());
    let corners = triangles[100];
    surface.add(Item::spot(corners, [0.0, 1.0, 0.0], DVec3::Z).unwrap()).unwrap();
    let spot = surface.solution(0).unwrap().to_vec();
    surface.set(0, Item::foot(corners[1] as usize, DVec3::Z)).unwrap();
    assert_eq!(surface.solution(0).unwrap(), spot);
}

#[test]
fn feet_between_vertices_move_by_what_is_asked_and_drag_one_another_only_in_a_plain_sum() {
    for combination in [Combination::Pairwise, Combination::Plain] {
        let (mut surface, _, triangles) = disc(12, Settings { combination, ..Settings::default() });
        surface.add(Item::spot(triangles[40], SHARES, DVec3::Z).unwrap()).unwrap();
        surface.add(Item::spot(triangles[90], SHARES, DVec3::X).unwrap()).unwrap();
        surface.add(Item::foot(triangles[200][0] as usize, DVec3::Y)).unwrap();
        let offsets = surface.offsets().unwrap();
        let feet = [0, 1, 2].map(|index| surface.foot_offset(index, &offsets).unwrap());
        if combination == Combination::Pairwise {
            assert_eq!(feet, [DVec3::Z, DVec3::X, DVec3::Y]);
            continue;
        }
        assert!(feet[0].z == 1.0 && feet[0].x > 0.01 && feet[0].y > 0.0, "{feet:?}");
        assert!(feet[1].x == 1.0 && feet[1].z > 0.01, "{feet:?}");
        // What the foot is said to do is what the vertices around it do.
        let around = place(&offsets, triangles[40], SHARES);
        assert!(around.distance(feet[0]) < 0.03, "{around} and {}", feet[0]);
    }
}

#[test]
fn a_foot_beside_the_boundary_moves_and_the_boundary_does_not() {
    let (mut surface, _, triangles) = disc(6, Settings::default());
    let held = surface.domain().held().to_vec();
    let beside = triangles.iter().find(|t| t.iter().filter(|v| held[**v as usize]).count() == 2).unwrap();
    surface.add(Item::spot(*beside, [1.0 / 3.0; 3], DVec3::Z).unwrap()).unwrap();
    let offsets = surface.offsets().unwrap();
    assert!(offsets.iter().zip(&held).all(|(offset, held)| !held || *offset == DVec3::ZERO));
    assert_eq!(surface.foot_offset(0, &offsets), Ok(DVec3::Z));
    // All of it on a side of the boundary: nothing can move there.
    let on_boundary = beside.map(|v| if held[v as usize] { 0.5 } else { 0.0 });
    let refused = surface.add(Item::spot(*beside, on_boundary, DVec3::Z).unwrap()).unwrap_err();
    assert!(matches!(refused, DisplacementError::Held(_)), "{refused}");
}

#[test]
fn what_is_no_place_or_taken_is_refused() {
    for shares in [[0.5, 0.5, 0.5], [1.5, -0.5, 0.0], [f64::NAN, 0.5, 0.5]] {
        assert!(matches!(Item::spot([0, 1, 2], shares, DVec3::Z), Err(DisplacementError::BadShares(_))));
    }
    assert_eq!(Item::spot([4, 7, 7], SHARES, DVec3::Z), Err(DisplacementError::CurveCrosses(7)));
    let (mut surface, _, triangles) = disc(6, Settings::default());
    let item = Item::spot(triangles[9], SHARES, DVec3::Z).unwrap();
    assert_eq!(surface.add(item.clone()), Ok(0));
    assert!(matches!(surface.add(item), Err(DisplacementError::Touching(0, 1, _))));
    let apart = [triangles[0][0], triangles[0][1], triangles[150][0]];
    assert!(matches!(
        surface.add(Item::spot(apart, SHARES, DVec3::Z).unwrap()),
        Err(DisplacementError::NoEdge(..))
    ));
    let (mut gram, ..) = disc(6, Settings { combination: Combination::Gram, ..Settings::default() });
    let refused = gram.add(Item::spot(triangles[9], SHARES, DVec3::Z).unwrap());
    assert_eq!(refused, Err(DisplacementError::SpotNotCombined(0)));
}
