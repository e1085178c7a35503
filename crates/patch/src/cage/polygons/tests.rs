//! What is no cage is refused by name.

use super::*;
use crate::cage::primitive;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn refusal(vertices: usize, faces: &[&[u32]]) -> CageError {
    let positions = (0..vertices).map(|i| DVec3::new(i as f64, (i * i) as f64, 0.0)).collect();
    Cage::new(positions, faces.iter().map(|face| face.to_vec()).collect()).unwrap_err()
}

#[test]
fn faces_that_form_no_surface_are_refused_by_name() {
    assert_eq!(refusal(3, &[]), CageError::NoFaces);
    assert_eq!(refusal(3, &[&[0, 1, 2], &[0, 1]]), CageError::TooFewCorners { face: 1, corners: 2 });
    assert_eq!(refusal(3, &[&[0, 1, 3]]), CageError::NoSuchVertex { face: 0, vertex: 3, count: 3 });
    assert_eq!(refusal(4, &[&[0, 1, 2, 1]]), CageError::RepeatedVertex { face: 0, vertex: 1 });
    let around: Vec<u32> = (0..300).collect();
    assert_eq!(refusal(300, &[&around]), CageError::TooManyCorners { face: 0, corners: 300 });
    assert_eq!(
        refusal(5, &[&[0, 1, 2], &[1, 0, 3], &[0, 1, 4]]),
        CageError::ManyFacesAtEdge { from: 0, to: 1, faces: 3 }
    );
    assert_eq!(
        refusal(4, &[&[0, 1, 2], &[0, 1, 3]]),
        CageError::Winding { first: 0, second: 1, from: 0, to: 1 }
    );
    assert_eq!(
        refusal(4, &[&[2, 1, 0], &[3, 1, 0]]),
        CageError::Winding { first: 0, second: 1, from: 1, to: 0 }
    );
    assert_eq!(refusal(5, &[&[0, 1, 2], &[0, 3, 4]]), CageError::TwoFans { vertex: 0 });
    assert_eq!(refusal(4, &[&[0, 1, 2, 3], &[3, 2, 1, 0]]), CageError::TooFewFaces { vertex: 0, valence: 2 });
}

/// Two closed fans at one vertex: two tetrahedra that touch.
#[test]
fn solids_that_touch_in_a_vertex_are_refused() {
    let solid = primitive::tetrahedron(1.0).unwrap();
    let mut positions = solid.positions().to_vec();
    positions.extend(solid.positions()[1..].iter().map(|p| *p * 2.0 + DVec3::X));
    let mut faces = solid.faces().to_vec();
    let other = |v: u32| if v == 0 { 0 } else { v + 3 };
    faces.extend(solid.faces().iter().map(|face| face.iter().map(|&v| other(v)).collect()));
    assert_eq!(Cage::new(positions, faces).unwrap_err(), CageError::TwoFans { vertex: 0 });
}

#[test]
fn a_wheel_with_too_many_spokes_is_refused() {
    let spokes = 200_u32;
    let positions = vec![DVec3::ZERO; spokes as usize + 1];
    let spoke = |k: u32| vec![0, 1 + k, 1 + (k + 1) % spokes];
    assert!(Cage::new(positions.clone(), (0..spokes).map(spoke).collect()).is_ok());
    // The same without one sector: the hub is on the boundary, and completing its ring doubles it.
    let open = Cage::new(positions, (1..spokes).map(spoke).collect());
    assert_eq!(open.unwrap_err(), CageError::TooManyFaces { vertex: 0, valence: 199 });
}

#[test]
fn positions_that_are_none_are_refused() {
    for bad in [f64::NAN, f64::INFINITY, 1e61] {
        let mut positions = vec![DVec3::ZERO; 4];
        positions[2].y = bad;
        // Also of a vertex that no face uses.
        let cage = Cage::new(positions, vec![vec![0, 1, 3]]);
        assert_eq!(cage.unwrap_err(), CageError::Position { vertex: 2 });
    }
}

#[test]
fn vertices_that_no_face_uses_are_allowed() {
    let cage = Cage::new(vec![DVec3::ZERO; 9], vec![vec![0, 4, 8]]).unwrap();
    assert_eq!((cage.valence(1), cage.valence(4), cage.valence(99)), (0, 1, 0));
    assert_eq!(cage.euler_characteristic(), 1);
    assert!(cage.is_boundary(8) && !cage.is_boundary(1));
}
