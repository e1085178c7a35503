//! Cages to begin with, made here: regular solids, a torus, a three-lobed solid, an open grid and an open disc.
//!
//! A size that is no number, or too many faces, are refused as in any other cage.

use super::{Cage, CageError};
use glam::DVec3;
use std::f64::consts::PI;

/// The golden ratio.
const PHI: f64 = 1.618_033_988_749_895;

/// Most quads of a torus or grid.
const MOST_QUADS: u64 = 1 << 22;

fn check_count(quads: u64) -> Result<(), CageError> {
    if quads > MOST_QUADS { Err(CageError::TooMany) } else { Ok(()) }
}

fn fixed<const N: usize>(size: f64, positions: &[[f64; 3]], faces: &[[u32; N]]) -> Result<Cage, CageError> {
    let positions = positions.iter().map(|&p| DVec3::from(p) * size).collect();
    Cage::new(positions, faces.iter().map(|face| face.to_vec()).collect())
}

/// The cube with corners at `±size` in each coordinate: all vertices have three faces.
pub fn cube(size: f64) -> Result<Cage, CageError> {
    let corners: [[f64; 3]; 8] =
        std::array::from_fn(|i| [1, 2, 4].map(|bit| if i & bit == 0 { -1.0 } else { 1.0 }));
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    fixed(size, &corners, &faces)
}

/// The regular tetrahedron in the cube with corners at `±size`.
pub fn tetrahedron(size: f64) -> Result<Cage, CageError> {
    let corners = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    fixed(size, &corners, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
}

/// The regular octahedron with corners at the distance `size`.
pub fn octahedron(size: f64) -> Result<Cage, CageError> {
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let minus = |p: [f64; 3]| p.map(|c: f64| -c);
    let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
    fixed(size, &[x, y, z, minus(x), minus(y), minus(z)], &faces)
}

const ICOSAHEDRON: [[f64; 3]; 12] = [
    [0.0, 1.0, PHI],
    [0.0, -1.0, PHI],
    [0.0, 1.0, -PHI],
    [0.0, -1.0, -PHI],
    [1.0, PHI, 0.0],
    [-1.0, PHI, 0.0],
    [1.0, -PHI, 0.0],
    [-1.0, -PHI, 0.0],
    [PHI, 0.0, 1.0],
    [PHI, 0.0, -1.0],
    [-PHI, 0.0, 1.0],
    [-PHI, 0.0, -1.0],
];
const ICOSAHEDRON_FACES: [[u32; 3]; 20] = [
    [0, 1, 8],
    [0, 8, 4],
    [0, 4, 5],
    [0, 5, 10],
    [0, 10, 1],
    [1, 6, 8],
    [8, 6, 9],
    [8, 9, 4],
    [4, 9, 2],
    [4, 2, 5],
    [5, 2, 11],
    [5, 11, 10],
    [10, 11, 7],
    [10, 7, 1],
    [1, 7, 6],
    [3, 9, 6],
    [3, 2, 9],
    [3, 11, 2],
    [3, 7, 11],
    [3, 6, 7],
];

/// The regular icosahedron with corners at the distance `size`.
pub fn icosahedron(size: f64) -> Result<Cage, CageError> {
    fixed(size / libm::sqrt(1.0 + PHI * PHI), &ICOSAHEDRON, &ICOSAHEDRON_FACES)
}

/// The regular dodecahedron with corners at the distance `size`: the dual of the icosahedron.
pub fn dodecahedron(size: f64) -> Result<Cage, CageError> {
    let icosahedron = icosahedron(1.0)?;
    let centre = |face: &Vec<u32>| face.iter().map(|&v| icosahedron.positions()[v as usize]).sum::<DVec3>();
    let corners: Vec<DVec3> =
        icosahedron.faces().iter().map(|face| centre(face).normalize_or_zero() * size).collect();
    let links = icosahedron.links();
    let face = |vertex: usize| links.fan(vertex).map(|h| super::links::name(links.face(h))).collect();
    Cage::new(corners, (0..icosahedron.positions().len()).map(face).collect())
}

/// A torus about the z axis of `around` times `across` quads (3 at least each): all vertices have four faces. Radii of the centre circle and of
/// the tube.
pub fn torus(radius: f64, tube: f64, around: u32, across: u32) -> Result<Cage, CageError> {
    let (around, across) = (around.max(3), across.max(3));
    check_count(u64::from(around) * u64::from(across))?;
    let circle = |step: u32, of: u32| libm::sincos(2.0 * PI * f64::from(step) / f64::from(of));
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for i in 0..around {
        for j in 0..across {
            let ((si, ci), (sj, cj)) = (circle(i, around), circle(j, across));
            let out = radius + tube * cj;
            positions.push(DVec3::new(out * ci, out * si, tube * sj));
            let (next_i, next_j) = ((i + 1) % around, (j + 1) % across);
            faces.push(vec![
                i * across + j,
                next_i * across + j,
                next_i * across + next_j,
                i * across + next_j,
            ]);
        }
    }
    Cage::new(positions, faces)
}

/// A three-lobed solid of quads with a hole through each lobe (genus 3), after the paper's figure 4: vertices have three to six
/// faces. `size` is about its radius; it lies in the xy plane.
pub fn trebol(size: f64) -> Result<Cage, CageError> {
    // Seen from above: six rays meet in the centre O; a lobe has the outline O, notch before, shoulder, tip, shoulder, notch
    // after, and a hexagonal hole; between two lobes a web hangs in the notch.
    let place = |turn: u32, x: f64, radius: f64, degrees: f64| {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let (turn_sin, turn_cos) = libm::sincos(2.0 * PI * f64::from(turn) / 3.0);
        let (x, y) = (x + radius * cos, radius * sin);
        DVec3::new(x * turn_cos - y * turn_sin, x * turn_sin + y * turn_cos, 0.0)
    };
    let hole = [180.0, -125.0, -45.0, 0.0, 45.0, 125.0].map(|angle| (0.78, 0.2, angle));
    let outline =
        [(0.5, 60.0), (1.0, -38.0), (1.3, 0.0), (1.0, 38.0), (0.95, 60.0)].map(|(r, angle)| (0.0, r, angle));
    let name = |turn: u32, index: u32| 1 + (turn % 3) * 11 + index;
    let mut plane = vec![DVec3::ZERO];
    let mut faces: Vec<Vec<u32>> = Vec::new();
    for turn in 0..3 {
        plane.extend(hole.iter().chain(&outline).map(|&(x, radius, angle)| place(turn, x, radius, angle)));
        let own = |index| name(turn, index);
        let rim = [0, name(turn + 2, 6), own(7), own(8), own(9), own(6)];
        faces.extend((0..6).map(|k| {
            let next = (k + 1) % 6;
            vec![rim[k as usize], rim[next as usize], own(next), own(k)]
        }));
        faces.push(vec![own(6), own(9), own(10), name(turn + 1, 7)]);
    }
    thickened(&plane, faces, size)
}

/// The solid between a planar mesh moved up and its mirror image moved down, with walls along the boundary.
fn thickened(plane: &[DVec3], top: Vec<Vec<u32>>, size: f64) -> Result<Cage, CageError> {
    let height = 0.28;
    let count = super::links::name(plane.len());
    let flat = Cage::new(plane.to_vec(), top.clone())?;
    let links = flat.links();
    let up = plane.iter().map(|p| (*p + DVec3::Z * height) * size);
    let down = plane.iter().map(|p| (*p - DVec3::Z * height) * size);
    let mut faces = top.clone();
    faces.extend(top.into_iter().map(|face| face.into_iter().rev().map(|v| v + count).collect()));
    for h in links.edges().filter(|&h| links.twin(h).is_none()) {
        let [a, b] = [links.origin(h), links.origin(links.after(h, 1))].map(super::links::name);
        faces.push(vec![b, a, a + count, b + count]);
    }
    Cage::new(up.chain(down).collect(), faces)
}

/// An open grid of `columns` times `rows` quads (1 at least each) of side `size`, centred in the xy plane, its normal up.
pub fn grid(size: f64, columns: u32, rows: u32) -> Result<Cage, CageError> {
    let (columns, rows) = (columns.max(1), rows.max(1));
    check_count(u64::from(columns) * u64::from(rows))?;
    let (mut positions, mut faces) = (Vec::new(), Vec::new());
    for j in 0..=rows {
        for i in 0..=columns {
            let centred = |k: u32, of: u32| (f64::from(k) - f64::from(of) / 2.0) * size;
            positions.push(DVec3::new(centred(i, columns), centred(j, rows), 0.0));
            if i < columns && j < rows {
                let own = j * (columns + 1) + i;
                faces.push(vec![own, own + 1, own + columns + 2, own + columns + 1]);
            }
        }
    }
    Cage::new(positions, faces)
}

/// An open disc of `sectors` quads (3 at least) that meet in its centre, in the xy plane, its normal up.
pub fn disc(radius: f64, sectors: u32) -> Result<Cage, CageError> {
    let sectors = sectors.max(3);
    check_count(u64::from(sectors))?;
    let around = 2 * sectors;
    let rim = (0..around).map(|k| {
        let (sin, cos) = libm::sincos(PI * f64::from(k) / f64::from(sectors));
        DVec3::new(radius * cos, radius * sin, 0.0)
    });
    let face = |k: u32| vec![0, 1 + (2 * k + around - 1) % around, 1 + 2 * k, 2 + 2 * k];
    Cage::new(std::iter::once(DVec3::ZERO).chain(rim).collect(), (0..sectors).map(face).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Six times the volume inside, by the divergence theorem over fans.
    fn volume(cage: &Cage) -> f64 {
        let at = |v: u32| cage.positions()[v as usize];
        let fans = cage.faces().iter().flat_map(|f| f[1..].windows(2).map(|w| (f[0], w[0], w[1])));
        fans.map(|(a, b, c)| at(a).dot(at(b).cross(at(c)))).sum()
    }

    #[test]
    fn solids_are_closed_and_face_outward() {
        let solids = [
            (cube(1.0).unwrap(), 2, 4),
            (tetrahedron(1.0).unwrap(), 2, 3),
            (octahedron(1.0).unwrap(), 2, 3),
            (icosahedron(1.0).unwrap(), 2, 3),
            (dodecahedron(1.0).unwrap(), 2, 5),
            (torus(3.0, 1.0, 8, 4).unwrap(), 0, 4),
            (torus(3.0, 1.0, 0, 0).unwrap(), 0, 4),
        ];
        for (solid, euler, sides) in solids {
            assert!(solid.is_closed());
            assert_eq!(solid.euler_characteristic(), euler);
            assert!(solid.faces().iter().all(|face| face.len() == sides));
            assert!(volume(&solid) > 0.0);
        }
        assert!((volume(&cube(1.0).unwrap()) - 48.0).abs() < 1e-12);
    }

    #[test]
    fn the_trebol_has_three_holes_and_vertices_of_many_kinds() {
        let solid = trebol(2.0).unwrap();
        assert!(solid.is_closed() && volume(&solid) > 0.0);
        assert_eq!(solid.euler_characteristic(), 2 - 2 * 3);
        let mut valences: Vec<usize> = (0..solid.positions().len()).map(|v| solid.valence(v)).collect();
        valences.sort_unstable();
        valences.dedup();
        assert_eq!(valences, [3, 4, 5, 6]);
    }

    #[test]
    fn what_is_no_cage_is_refused() {
        for bad in [cube(f64::NAN), trebol(f64::INFINITY), dodecahedron(1e70), torus(f64::NAN, 1.0, 8, 4)] {
            assert!(matches!(bad, Err(CageError::Position { .. })), "{bad:?}");
        }
        let many = u32::MAX;
        for bad in [torus(3.0, 1.0, many, many), grid(1.0, many, 2), disc(1.0, many)] {
            assert_eq!(bad.err(), Some(CageError::TooMany));
        }
        assert!(matches!(disc(1.0, 300), Err(CageError::TooManyFaces { .. })), "{:?}", disc(1.0, 300));
    }

    #[test]
    fn open_cages_have_one_boundary() {
        for (cage, euler) in [
            (grid(1.0, 3, 2).unwrap(), 1),
            (grid(1.0, 0, 0).unwrap(), 1),
            (disc(1.0, 5).unwrap(), 1),
            (disc(1.0, 0).unwrap(), 1),
        ] {
            assert!(!cage.is_closed());
            assert_eq!(cage.euler_characteristic(), euler);
            assert!(cage.faces().iter().all(|face| face.len() == 4));
        }
        assert_eq!(disc(1.0, 5).unwrap().valence(0), 5);
    }
}
