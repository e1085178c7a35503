//! Where nothing may move, what is refused, and what a drag leaves alone.

use super::{fixture, mesh, plain};
use crate::displacement::laplacian::Stiffness;
use crate::{
    Blend, Combination, Direction, DisplacementError, Displacements, Domain, Item, Laplacian, Profile, Range,
    Settings,
};
use ductile_solver::workload;
use glam::DVec3;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn disc(rings: usize) -> Displacements {
    let disc = workload::disc(rings);
    Displacements::new(Domain::new(&disc.positions, &disc.triangles).unwrap(), Settings::default()).unwrap()
}

#[test]
fn obtuse_triangles_break_the_bounds_but_nothing_else() {
    let fixture = fixture();
    let case = &fixture["cases"][1];
    let mut surface = Displacements::new(mesh(case), plain()).unwrap();
    surface.add(Item::foot(4, DVec3::Z)).unwrap();
    let green = surface.solution(0).unwrap();
    let most = green.iter().map(|g| g / green[4]).fold(0.0, f64::max);
    assert!((most - 1.536).abs() < 5e-4, "{most}");
    for profile in [Profile::Harmonic, Profile::Conformal] {
        for r in [-1.0, 0.0, 0.5, 0.95] {
            surface.set_settings(Settings { profile, ..plain() }).unwrap();
            surface.set_range(0, Range::new(r).unwrap()).unwrap();
            assert!(surface.blend(0).unwrap().iter().all(|b| (0.0..=1.0).contains(b)));
        }
    }
    let mut intrinsic =
        Displacements::new(mesh(case), Settings { laplacian: Laplacian::IntrinsicDelaunay, ..plain() })
            .unwrap();
    intrinsic.add(Item::foot(4, DVec3::Z)).unwrap();
    let green = intrinsic.solution(0).unwrap();
    assert!(green.iter().all(|&g| g >= 0.0 && g <= green[4]));
}

#[test]
fn closed_surfaces_need_a_pin() {
    let sphere = workload::sphere(2);
    let domain = Domain::new(&sphere.positions, &sphere.triangles).unwrap();
    let mut closed = Displacements::new(domain.clone(), Settings::default()).unwrap();
    assert_eq!(closed.add(Item::foot(9, DVec3::Z)).unwrap_err(), DisplacementError::NoBoundary(0));
    let mut pinned = Displacements::new(domain.with_pins(&[0, 1]).unwrap(), Settings::default()).unwrap();
    assert_eq!(pinned.add(Item::foot(1, DVec3::Z)).unwrap_err(), DisplacementError::Held(1));
    pinned.add(Item::foot(9, DVec3::Z)).unwrap();
    let offsets = pinned.offsets().unwrap();
    assert_eq!([0, 1, 9].map(|v| offsets[v]), [DVec3::ZERO, DVec3::ZERO, DVec3::Z]);
}

#[test]
fn nothing_passes_a_ring_of_pins() {
    // Triangles so thin that their edges would be flipped across the ring.
    let disc = workload::disc(8);
    let positions: Vec<DVec3> = disc.positions.iter().map(|p| DVec3::new(p.x, 0.05 * p.y, 0.0)).collect();
    let ring: Vec<usize> = (0..24).map(|step| 1 + 3 * 4 * 3 + step).collect();
    let domain = Domain::new(&positions, &disc.triangles).unwrap();
    let inside = |v: usize| v < 1 + 3 * 4 * 3;
    let mut open = Displacements::new(domain.clone(), Settings::default()).unwrap();
    open.add(Item::foot(0, DVec3::Z)).unwrap();
    assert!(open.offsets().unwrap().iter().enumerate().any(|(v, d)| !inside(v) && d.z > 0.01));
    let mut shut = Displacements::new(domain.with_pins(&ring).unwrap(), Settings::default()).unwrap();
    shut.add(Item::foot(0, DVec3::Z)).unwrap();
    let offsets = shut.offsets().unwrap();
    assert!(offsets.iter().enumerate().all(|(v, d)| inside(v) || *d == DVec3::ZERO));
    // Feet on both sides of the ring do not see each other.
    let before = offsets;
    shut.add(Item::foot(150, DVec3::X)).unwrap();
    let both = shut.offsets().unwrap();
    assert!((0..both.len()).filter(|&v| inside(v)).all(|v| both[v] == before[v]));
    assert_eq!(both[150], DVec3::X);
}

#[test]
fn surfaces_with_one_side_and_flat_triangles_are_taken() {
    let band = workload::moebius(20, 4, 0.4);
    // Shear the band along itself: all diagonals become bad.
    let mut positions = band.positions.clone();
    for position in &mut positions {
        let (sin, cos) = libm::sincos(1.5 * position.z);
        *position =
            DVec3::new(cos * position.x - sin * position.y, sin * position.x + cos * position.y, position.z);
    }
    let domain = Domain::new(&positions, &band.triangles).unwrap();
    let foot = (0..domain.len()).find(|&v| !domain.held()[v] && !domain.beside_held()[v]).unwrap();
    let mut surface = Displacements::new(domain, Settings::default()).unwrap();
    surface.add(Item::foot(foot, DVec3::Z)).unwrap();
    let green = surface.solution(0).unwrap();
    assert!(green.iter().all(|&g| g >= -1e-15 && g <= green[foot]));

    let mut disc = workload::disc(3);
    disc.positions[3] = 0.5 * (disc.positions[2] + disc.positions[4]);
    disc.positions[1] = disc.positions[2];
    let domain = Domain::new(&disc.positions, &disc.triangles).unwrap();
    let refused = Displacements::new(domain.clone(), plain()).unwrap_err();
    assert!(matches!(refused, DisplacementError::FlatTriangle(_)), "{refused}");
    let mut surface = Displacements::new(domain, Settings::default()).unwrap();
    surface.add(Item::foot(0, DVec3::Z)).unwrap();
    assert!(surface.blend(0).unwrap().iter().all(|b| (0.0..=1.0).contains(b)));
    let nothing = Domain::new(&[DVec3::ONE; 3], &[[0, 1, 2]]).unwrap();
    let refused = Displacements::new(nothing, Settings::default()).unwrap_err();
    assert_eq!(refused, DisplacementError::FlatTriangle(0));
    assert!(Displacements::new(Domain::new(&[], &[]).unwrap(), Settings::default()).is_ok());
}

#[test]
fn scale_and_place_do_not_matter() {
    let disc = workload::disc(6);
    let blend = |change: &dyn Fn(DVec3) -> DVec3| {
        let positions: Vec<DVec3> = disc.positions.iter().map(|&p| change(p)).collect();
        let domain = Domain::new(&positions, &disc.triangles).unwrap();
        let mut surface = Displacements::new(domain, Settings::default()).unwrap();
        surface.add(Item::foot(10, DVec3::Z)).unwrap();
        surface.blend(0).unwrap().to_vec()
    };
    let near = blend(&|p| p);
    for scale in [1e-140, 1e-3, 1e140] {
        assert!(blend(&|p| p * scale).iter().zip(&near).all(|(x, y)| (x - y).abs() < 1e-11), "{scale}");
    }
    assert!(blend(&|p| p + 1000.0).iter().zip(&near).all(|(x, y)| (x - y).abs() < 1e-8));
}

#[test]
fn a_drag_or_a_range_changes_only_what_it_must() {
    let mut surface = disc(8);
    surface.add(Item::foot(0, DVec3::Z)).unwrap();
    surface.add(Item::foot(60, DVec3::ZERO)).unwrap();
    let (solution, other) = (surface.solution(0).unwrap().to_vec(), surface.blend(1).unwrap().to_vec());
    surface.set_displacement(0, &[DVec3::new(3.0, 2.0, 1.0)]).unwrap();
    surface.set_range(0, Range::new(0.6).unwrap()).unwrap();
    let mut anew = disc(8);
    anew.add(Item::foot(60, DVec3::ZERO)).unwrap();
    anew.add(Item::foot(0, DVec3::new(3.0, 2.0, 1.0)).with_range(Range::new(0.6).unwrap())).unwrap();
    let close = |x: &[DVec3], y: &[DVec3]| x.iter().zip(y).all(|(x, y)| x.distance(*y) < 1e-14);
    let offsets = surface.offsets().unwrap();
    assert!(close(&offsets, &anew.offsets().unwrap()), "the order of the feet or the way to them matters");
    assert_eq!(surface.solution(0).unwrap(), solution);
    assert_eq!(surface.blend(1).unwrap(), other);
    let report = surface.reports(&offsets)[0];
    assert_eq!((report.offset, report.largest), (DVec3::new(3.0, 2.0, 1.0), 1.0));
    surface.remove(1).unwrap();
    surface.set(0, Item::foot(5, DVec3::Y)).unwrap();
    let mut single = disc(8);
    single.add(Item::foot(5, DVec3::Y)).unwrap();
    assert_eq!(surface.offsets().unwrap(), single.offsets().unwrap());
    assert_eq!(surface.items().len(), 1);
}

#[test]
fn settings_change_as_if_they_had_been_so_from_the_beginning() {
    let feet = [(0, 0.5), (60, 0.2), (100, -0.5)];
    let build = |settings| {
        let disc = workload::disc(8);
        let domain = Domain::new(&disc.positions, &disc.triangles).unwrap();
        let mut surface = Displacements::new(domain, settings).unwrap();
        for (foot, r) in feet {
            surface.add(Item::foot(foot, DVec3::ONE).with_range(Range::new(r).unwrap())).unwrap();
        }
        surface
    };
    let mut surface = build(Settings::default());
    for combination in [Combination::Cardinal, Combination::Gram, Combination::Plain, Combination::Pairwise] {
        for profile in [Profile::Harmonic, Profile::Conformal] {
            for (laplacian, blend) in
                [(Laplacian::Cotangent, Blend::Bump(2.0)), (Laplacian::IntrinsicDelaunay, Blend::Eta(0.1))]
            {
                let settings = Settings { laplacian, profile, combination, blend };
                surface.set_settings(settings).unwrap();
                assert_eq!(surface.offsets().unwrap(), build(settings).offsets().unwrap(), "{settings:?}");
            }
        }
    }
}

#[test]
fn coarse_meshes_are_told() {
    let mut surface = disc(6);
    surface.add(Item::foot(0, DVec3::Z).with_range(Range::new(-2.0).unwrap())).unwrap();
    let offsets = surface.offsets().unwrap();
    assert!(!surface.reports(&offsets)[0].is_cut_off());
    surface.set_range(0, Range::new(0.9).unwrap()).unwrap();
    let report = surface.reports(&offsets)[0];
    assert!(report.is_cut_off() && report.beside_held > 0.1 && report.least > 0.1);
}

#[test]
fn what_cannot_be_displaced_is_refused_and_leaves_no_trace() {
    let mut surface = disc(4);
    surface.add(Item::foot(7, DVec3::Z)).unwrap();
    let before = surface.offsets().unwrap();
    let curve = |vertices: &[usize]| Item::curve(vertices.to_vec(), false, vec![DVec3::Z]);
    let refusals = [
        (Item::foot(61, DVec3::Z), DisplacementError::NoVertex { vertex: 61, count: 61 }),
        (Item::foot(60, DVec3::Z), DisplacementError::Held(60)),
        (Item::foot(7, DVec3::Z), DisplacementError::Touching(0, 1, 7)),
        (Item::foot(3, DVec3::NAN), DisplacementError::BadDisplacement(1)),
        (Item::foot(3, DVec3::X * 1e151), DisplacementError::BadDisplacement(1)),
        (curve(&[0, 20]).unwrap(), DisplacementError::NoEdge(0, 20)),
        (curve(&[0, 1, 7]).unwrap(), DisplacementError::Touching(0, 1, 7)),
        (curve(&[0, 99]).unwrap(), DisplacementError::NoVertex { vertex: 99, count: 61 }),
        (curve(&[19, 37]).unwrap(), DisplacementError::Held(37)),
    ];
    for (item, refusal) in refusals {
        assert_eq!(surface.add(item).unwrap_err(), refusal);
        assert_eq!(surface.offsets().unwrap(), before);
    }
    assert_eq!(curve(&[1]).unwrap_err(), DisplacementError::ShortCurve);
    assert_eq!(curve(&[1, 2, 1]).unwrap_err(), DisplacementError::CurveCrosses(1));
    let two = Item::curve(vec![1, 2, 3], false, vec![DVec3::Z; 2]);
    assert!(matches!(two, Err(DisplacementError::Length { expected: 3, found: 2, .. })));
    assert_eq!(surface.remove(1).unwrap_err(), DisplacementError::NoItem(1));
    assert_eq!(surface.set_range(3, Range::default()).unwrap_err(), DisplacementError::NoItem(3));
    assert!(surface.set_displacement(0, &[]).is_err());
    for stretch in [0.0, 65.0, f64::NAN, -2.0] {
        assert!(matches!(Direction::new(DVec3::X, stretch), Err(DisplacementError::BadStretch(_))));
    }
    assert_eq!(Direction::new(DVec3::ZERO, 2.0), Err(DisplacementError::BadDirection));
    surface.add(curve(&[0, 1]).unwrap()).unwrap();
    for combination in [Combination::Gram, Combination::Cardinal] {
        let settings = Settings { combination, ..Settings::default() };
        assert_eq!(surface.set_settings(settings).unwrap_err(), DisplacementError::CurveNotCombined(1));
    }
    surface.remove(1).unwrap();
    let along = Direction::new(DVec3::X, 2.0).unwrap();
    surface.add(Item::foot(2, DVec3::Z).with_direction(along)).unwrap();
    let cardinal = Settings { combination: Combination::Cardinal, ..Settings::default() };
    assert_eq!(surface.set_settings(cardinal).unwrap_err(), DisplacementError::MixedDirections(1));
    let flat = Settings { blend: Blend::Eta(0.7), ..Settings::default() };
    assert!(matches!(surface.set_settings(flat), Err(DisplacementError::Blend(_))));
    assert_eq!(surface.offsets().unwrap()[2], DVec3::Z);
}

#[test]
fn masses_are_areas() {
    let disc = workload::disc(5);
    let domain = Domain::new(&disc.positions, &disc.triangles).unwrap();
    let stiffness = Stiffness::new(&domain, Laplacian::IntrinsicDelaunay, None).unwrap();
    assert!(stiffness.areas.iter().all(|&area| area > 0.0));
}
