//! Reliefs against exact cases.

use super::*;
use crate::nearest_spot;
use core::f64::consts::{FRAC_PI_2, PI};
use ductile_solver::workload;
use glam::{DAffine3, DQuat, DVec2, DVec3};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

/// A round disc of radius 1 in the plane z = 0, and the place of (1, 0, 0) in its rim.
fn round(rings: usize) -> (Vec<DVec3>, Disc, usize) {
    let workload::Workload { positions, triangles, .. } = workload::disc(rings);
    let positions: Vec<DVec3> = positions.iter().map(|at| at.with_z(0.0)).collect();
    let disc = Disc::new(positions.len(), &triangles).unwrap();
    let start = anchor(&disc, &positions, DVec3::X);
    (positions, disc, start)
}

fn anchor(disc: &Disc, positions: &[DVec3], at: DVec3) -> usize {
    let rim: Vec<u32> = disc.rim().collect();
    let far = |v: u32| positions[v as usize].distance(at);
    (0..rim.len()).min_by(|a, b| far(rim[*a]).total_cmp(&far(rim[*b]))).unwrap()
}

/// A mushroom off the axis: it leans over its own foot.
fn mushroom(at: DVec3) -> DVec3 {
    let (x, y) = (at.x, at.y);
    let rise = 1.0 - x * x - y * y;
    let rise = rise * rise;
    DVec3::new(x + 0.3 * rise, y * (1.0 + 0.4 * rise) - 0.1 * rise, 0.6 * rise + 0.2 * x * rise)
}

fn up(count: usize) -> Vec<DVec3> {
    vec![DVec3::Z; count]
}

#[test]
fn a_flat_round_region_gets_the_very_shape_of_a_round_stamp() {
    let (flat, disc, start) = round(12);
    let stamp_at: Vec<DVec3> = flat.iter().map(|at| mushroom(*at)).collect();
    let stamp = Stamp::new(&disc, &stamp_at, start).unwrap();
    let triangles: Vec<[u32; 3]> = workload::disc(12).triangles;
    // A region of other triangles, moved, turned and twice as large.
    let (ground_flat, ground_disc, ground_start) = round(9);
    let laid = DAffine3::from_scale_rotation_translation(
        DVec3::splat(2.0),
        DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -0.7, 1.1),
        DVec3::new(3.0, 1.0, -2.0),
    );
    let ground_at: Vec<DVec3> = ground_flat.iter().map(|at| laid.transform_point3(*at)).collect();
    let normals = vec![laid.transform_vector3(DVec3::Z) * 0.5; ground_at.len()];
    let ground = Ground::new(ground_disc, &ground_at, ground_start).unwrap();
    let offsets = ground.offsets(&ground.read(&stamp, 0.0), 1.0, &ground_at, &normals);
    // The rim of the coarser disc is a polygon of other length: lengths of rims compare the two.
    let ratio = ground.rim_length(&ground_at) / stamp.rim_length();
    assert!((ratio - 2.0).abs() < 0.01);
    let mut most = 0.0_f64;
    for (&v, offset) in ground.vertices().iter().zip(&offsets) {
        let plain = ground_flat[v as usize];
        if plain.length() > 0.85 {
            continue;
        }
        let shown = laid.inverse().transform_point3(ground_at[v as usize] + *offset * (2.0 / ratio));
        let (corners, shares) = nearest_spot(&stamp_at, &triangles, shown).unwrap();
        let on: DVec3 = corners.iter().zip(shares).map(|(&v, share)| stamp_at[v as usize] * share).sum();
        most = most.max(shown.distance(on));
    }
    assert!(most < 1e-12, "off the stamp by {most}");
    assert!(offsets.iter().map(|offset| offset.length()).fold(0.0, f64::max) > 1.0);
}

#[test]
fn heights_are_multiplied_and_turns_are_turns() {
    let (flat, disc, start) = round(8);
    let stamp_at: Vec<DVec3> = flat.iter().map(|at| mushroom(*at)).collect();
    let stamp = Stamp::new(&disc, &stamp_at, start).unwrap();
    let ground = Ground::new(disc, &flat, start).unwrap();
    let normals = up(flat.len());
    let plain = ground.offsets(&ground.read(&stamp, 0.0), 1.0, &flat, &normals);
    let pressed = ground.offsets(&ground.read(&stamp, 0.0), -2.0, &flat, &normals);
    for (one, other) in plain.iter().zip(&pressed) {
        assert!((one.z * -2.0 - other.z).abs() < 1e-12 && (one - other).truncate().length() < 1e-12);
    }
    // The disc of the workload has six like sectors: a turn by three of them finds the same vertices.
    let turned = ground.offsets(&ground.read(&stamp, PI), 1.0, &flat, &normals);
    for (k, at) in flat.iter().enumerate() {
        let other = flat.iter().position(|other| other.distance(DVec3::new(-at.x, -at.y, 0.0)) < 1e-9);
        let other = turned[other.unwrap()];
        assert!(DVec3::new(-other.x, -other.y, other.z).distance(plain[k]) < 1e-9);
    }
    // Normals of the other side say the same.
    let inside: Vec<DVec3> = normals.iter().map(|normal| -*normal).collect();
    assert_eq!(ground.offsets(&ground.read(&stamp, 0.0), 1.0, &flat, &inside), plain);
}

#[test]
fn the_rim_stays_and_a_flat_stamp_does_nothing() {
    let (flat, disc, start) = round(6);
    let stamp = Stamp::new(&disc, &flat, start).unwrap();
    let bent: Vec<DVec3> = flat.iter().map(|at| at.with_z(0.3 * at.x * at.y)).collect();
    let rim: Vec<u32> = disc.rim().collect();
    let ground = Ground::new(disc.clone(), &bent, start).unwrap();
    let offsets = ground.offsets(&ground.read(&stamp, 0.3), 5.0, &bent, &up(bent.len()));
    assert!(offsets.iter().all(|offset| offset.length() < 1e-12));
    let high: Vec<DVec3> = flat.iter().map(|at| mushroom(*at)).collect();
    let stamp = Stamp::new(&disc, &high, start).unwrap();
    let offsets = ground.offsets(&ground.read(&stamp, 0.3), 1.0, &bent, &up(bent.len()));
    assert!(rim.iter().all(|v| offsets[*v as usize] == DVec3::ZERO));
}

#[test]
fn the_natural_turn_is_that_between_the_anchors() {
    let (flat, disc, start) = round(10);
    let stamp = Stamp::new(&disc, &flat, start).unwrap();
    for angle in [0.0, 1.0, FRAC_PI_2, -2.0, 3.0] {
        let elsewhere = anchor(&disc, &flat, DVec3::new(libm::cos(angle), libm::sin(angle), 0.0));
        let place = flat[disc.rim().nth(elsewhere).unwrap() as usize];
        let exact = -libm::atan2(place.y, place.x);
        let ground = Ground::new(disc.clone(), &flat, elsewhere).unwrap();
        assert!((ground.natural_turn(&stamp, &flat).unwrap() - exact).abs() < 1e-12);
        // Tipped over, it is the same.
        let tipped: Vec<DVec3> = flat.iter().map(|at| DQuat::from_rotation_x(1.0) * *at).collect();
        let turn = ground.natural_turn(&stamp, &tipped).unwrap();
        assert!((turn - exact).abs() < 1e-12, "{turn} for {exact}");
    }
}

#[test]
fn a_chart_covers_the_disc_once() {
    let (flat, disc, start) = round(10);
    let wild: Vec<DVec3> = flat.iter().map(|at| mushroom(*at) * DVec3::new(1.0, 3.0, 2.0)).collect();
    let ground = Ground::new(disc.clone(), &wild, start).unwrap();
    let places: Vec<DVec2> = ground.places().to_vec();
    let area = |t: &[u32; 3]| {
        let [a, b, c] = t.map(|v| places[v as usize]);
        0.5 * (b - a).perp_dot(c - a)
    };
    let areas: Vec<f64> = disc.triangles.iter().map(area).collect();
    assert!(areas.iter().all(|area| *area > 0.0), "no triangle is turned over");
    assert!((areas.iter().sum::<f64>() - PI).abs() < 0.02);
}

#[test]
fn what_is_no_disc_is_refused_by_name() {
    let refused = |count, triangles: &[[u32; 3]]| Disc::new(count, triangles).unwrap_err();
    assert_eq!(refused(3, &[]), ReliefError::Empty);
    assert_eq!(refused(2, &[[0, 1, 2]]), ReliefError::Empty);
    assert_eq!(refused(6, &[[0, 1, 2], [3, 4, 5]]), ReliefError::Pieces(2));
    assert_eq!(refused(5, &[[0, 1, 2], [1, 0, 3], [0, 1, 4]]), ReliefError::Pinched);
    let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    assert_eq!(refused(4, &tetrahedron), ReliefError::Closed);
    let around = |k: u32| [[k, (k + 1) % 3, k + 3], [(k + 1) % 3, (k + 1) % 3 + 3, k + 3]];
    let tube: Vec<[u32; 3]> = (0..3).flat_map(around).collect();
    assert_eq!(refused(6, &tube), ReliefError::NoDisc { rims: 2, handles: 0 });
    // Five triangles round a Möbius strip.
    let strip: Vec<[u32; 3]> = (0..5).map(|k| [k, (k + 1) % 5, (k + 2) % 5]).collect();
    assert_eq!(refused(5, &strip), ReliefError::OneSided);
    // Windings that disagree are no harm.
    let disc = Disc::new(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    let other = Disc::new(4, &[[0, 1, 2], [0, 3, 2]]).unwrap();
    assert_eq!(disc.rim().collect::<Vec<_>>(), other.rim().collect::<Vec<_>>());
    // A rim that runs to and fro encloses nothing.
    let line = [DVec3::ZERO, DVec3::X, DVec3::X * 2.0, DVec3::X * 3.0];
    assert_eq!(Stamp::new(&disc, &line, 0).unwrap_err(), ReliefError::Flat);
}
