//! Editing cages: pure functions that give a new cage or say why not. Positions are in the units of the cage; vertices and faces are
//! named by index. New vertices stand after the old ones, and old vertices keep their names, also when no face uses them any more.

use super::Cage;
use super::error::CageError;
use super::links::{check_positions, name};
use glam::DVec3;
use thiserror::Error;

/// Why a cage cannot be changed like that.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum EditError {
    /// There is no such vertex.
    #[error("vertex {vertex} does not exist: there are {count}")]
    NoSuchVertex {
        /// The name.
        vertex: u32,
        /// How many there are.
        count: usize,
    },
    /// There is no such face.
    #[error("face {face} does not exist: there are {count}")]
    NoSuchFace {
        /// The name.
        face: u32,
        /// How many there are.
        count: usize,
    },
    /// No face has an edge between the two.
    #[error("no edge joins vertices {0} and {1}")]
    NoSuchEdge(u32, u32),
    /// A vertex is no corner of the face that is to be divided.
    #[error("vertex {vertex} is no corner of face {face}")]
    NoCorner {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// The two corners are the same, or an edge joins them already.
    #[error(
        "face {face} cannot be divided between the vertices {from} and {to}, which are the same or neighbours"
    )]
    Neighbours {
        /// The face.
        face: u32,
        /// A corner.
        from: u32,
        /// The other.
        to: u32,
    },
    /// The face has no area from which a direction could be read.
    #[error("face {0} has no normal to be extruded along")]
    NoNormal(u32),
    /// A place on an edge lies strictly between its ends.
    #[error("{0} is no place on an edge: it lies strictly between 0 and 1")]
    Place(f64),
    /// What would come of it is no cage.
    #[error("that would leave no cage: {0}")]
    Cage(#[from] CageError),
}

impl EditError {
    /// The same with its vertices named as whoever gave the cage names them.
    #[must_use]
    pub fn renamed(mut self, name: impl Fn(u32) -> u32) -> Self {
        match &mut self {
            Self::NoSuchVertex { vertex, .. } | Self::NoCorner { vertex, .. } => *vertex = name(*vertex),
            Self::NoSuchEdge(from, to) | Self::Neighbours { from, to, .. } => {
                (*from, *to) = (name(*from), name(*to));
            }
            Self::Cage(error) => *error = error.renamed(name),
            Self::NoSuchFace { .. } | Self::NoNormal(_) | Self::Place(_) => {}
        }
        self
    }
}

/// Moves vertices to new positions.
///
/// # Errors
/// [`EditError::NoSuchVertex`], and [`EditError::Cage`] for a position that is none.
pub fn move_vertices(cage: &Cage, moves: &[(u32, DVec3)]) -> Result<Cage, EditError> {
    let (mut positions, faces) = parts(cage);
    for &(vertex, to) in moves {
        let count = positions.len();
        *positions.get_mut(vertex as usize).ok_or(EditError::NoSuchVertex { vertex, count })? = to;
    }
    Ok(Cage::new(positions, faces)?)
}

/// Moves a face out along its normal by a distance (inwards if negative), with a wall of quads along its edges. The face keeps its name
/// and gets new vertices; the walls come last.
///
/// # Errors
/// [`EditError::NoSuchFace`], [`EditError::NoNormal`], [`EditError::Cage`].
pub fn extrude_face(cage: &Cage, face: u32, distance: f64) -> Result<Cage, EditError> {
    let corners = corners(cage, face)?.to_vec();
    let (mut positions, mut faces) = parts(cage);
    let at = |vertex: u32| cage.positions()[vertex as usize];
    // Newell's normal: that of the polygon's shadow of largest area, also where the corners lie in no plane.
    let next = |k: usize| at(corners[(k + 1) % corners.len()]) - at(corners[0]);
    let area: DVec3 = (0..corners.len()).map(|k| (at(corners[k]) - at(corners[0])).cross(next(k))).sum();
    let normal = area.try_normalize().ok_or(EditError::NoNormal(face))?;
    let first = name(positions.len());
    positions.extend(corners.iter().map(|&vertex| at(vertex) + normal * distance));
    check_positions(&positions)?;
    let count = name(corners.len());
    faces[face as usize] = (first..first + count).collect();
    for k in 0..count {
        let next = (k + 1) % count;
        faces.push(vec![corners[k as usize], corners[next as usize], first + next, first + k]);
    }
    Ok(Cage::new(positions, faces)?)
}

/// Takes a face out, which leaves a hole or widens one. Later faces move up by one.
///
/// # Errors
/// [`EditError::NoSuchFace`]; [`EditError::Cage`] for the last face, or where two fans would be left at a vertex.
pub fn delete_face(cage: &Cage, face: u32) -> Result<Cage, EditError> {
    corners(cage, face)?;
    let (positions, mut faces) = parts(cage);
    faces.remove(face as usize);
    Ok(Cage::new(positions, faces)?)
}

/// Puts a new vertex on an edge, at a share `at` of the way from one end to the other; both faces there get one corner more.
///
/// # Errors
/// [`EditError::NoSuchEdge`] and [`EditError::Place`]; [`EditError::Cage`] where two faces meet at the new vertex alone, as they do inside
/// a cage without boundary: divide one of the faces there at once with [`split_edge_and_faces`].
pub fn split_edge(cage: &Cage, from: u32, to: u32, at: f64) -> Result<Cage, EditError> {
    let (positions, faces, _) = with_edge_split(cage, from, to, at)?;
    Ok(Cage::new(positions, faces)?)
}

/// Puts a new vertex on an edge and joins it, in each face there, to the corner farthest along the face from it: inside a cage at least
/// three faces must meet at a vertex.
///
/// # Errors
/// As [`split_edge`].
pub fn split_edge_and_faces(cage: &Cage, from: u32, to: u32, at: f64) -> Result<Cage, EditError> {
    let (positions, mut faces, new) = with_edge_split(cage, from, to, at)?;
    for face in 0..faces.len() {
        let Some(place) = faces[face].iter().position(|&vertex| vertex == new) else { continue };
        let corners = faces[face].len();
        let (kept, other) = divided(&faces[face], place, (place + corners / 2) % corners);
        faces[face] = kept;
        faces.push(other);
    }
    Ok(Cage::new(positions, faces)?)
}

/// Divides a face between two of its corners that are no neighbours. The part that begins with `from` keeps the name, the other comes last.
///
/// # Errors
/// [`EditError::NoSuchFace`], [`EditError::NoCorner`], [`EditError::Neighbours`]; [`EditError::Cage`] when the new edge is one already.
pub fn split_face(cage: &Cage, face: u32, from: u32, to: u32) -> Result<Cage, EditError> {
    let corners = corners(cage, face)?;
    let place = |vertex: u32| {
        corners.iter().position(|&corner| corner == vertex).ok_or(EditError::NoCorner { face, vertex })
    };
    let (first, second) = (place(from)?, place(to)?);
    let apart = (second + corners.len() - first) % corners.len();
    if apart < 2 || apart + 1 >= corners.len() {
        return Err(EditError::Neighbours { face, from, to });
    }
    let (kept, other) = divided(corners, first, second);
    let (positions, mut faces) = parts(cage);
    faces[face as usize] = kept;
    faces.push(other);
    Ok(Cage::new(positions, faces)?)
}

/// Divides a face into triangles round a new vertex at its centre. The triangle at its first edge keeps the name, the others
/// come last.
///
/// # Errors
/// [`EditError::NoSuchFace`]; [`EditError::Cage`] for a corner that would have too many faces.
pub fn split_face_at_centre(cage: &Cage, face: u32) -> Result<Cage, EditError> {
    let corners = corners(cage, face)?;
    let (mut positions, mut faces) = parts(cage);
    let sum: DVec3 = corners.iter().map(|&vertex| positions[vertex as usize]).sum();
    let centre = name(positions.len());
    positions.push(sum / corners.len() as f64);
    let nexts = corners.iter().cycle().skip(1);
    let mut triangles = corners.iter().zip(nexts).map(|(a, b)| vec![*a, *b, centre]);
    let own = triangles.next();
    faces.extend(triangles);
    faces.splice(face as usize..=face as usize, own);
    Ok(Cage::new(positions, faces)?)
}

fn parts(cage: &Cage) -> (Vec<DVec3>, Vec<Vec<u32>>) {
    (cage.positions().to_vec(), cage.faces().to_vec())
}

fn corners(cage: &Cage, face: u32) -> Result<&[u32], EditError> {
    let count = cage.faces().len();
    cage.faces().get(face as usize).map(Vec::as_slice).ok_or(EditError::NoSuchFace { face, count })
}

/// The two polygons on both sides of a diagonal, each beginning at it.
fn divided(corners: &[u32], first: usize, second: usize) -> (Vec<u32>, Vec<u32>) {
    let around = |from: usize, to: usize| {
        let count = (to + corners.len() - from) % corners.len();
        (0..=count).map(|k| corners[(from + k) % corners.len()]).collect()
    };
    (around(first, second), around(second, first))
}

type Split = (Vec<DVec3>, Vec<Vec<u32>>, u32);

fn with_edge_split(cage: &Cage, from: u32, to: u32, at: f64) -> Result<Split, EditError> {
    if !(at > 0.0 && at < 1.0) {
        return Err(EditError::Place(at));
    }
    let (mut positions, mut faces) = parts(cage);
    let new = name(positions.len());
    let mut is_there = false;
    for face in &mut faces {
        let corners = face.len();
        let is_edge = |&k: &usize| {
            let ends = (face[k], face[(k + 1) % corners]);
            ends == (from, to) || ends == (to, from)
        };
        if let Some(place) = (0..corners).find(is_edge) {
            face.insert(place + 1, new);
            is_there = true;
        }
    }
    if !is_there {
        return Err(EditError::NoSuchEdge(from, to));
    }
    let [a, b] = [from, to].map(|vertex| positions[vertex as usize]);
    positions.push(a + (b - a) * at);
    Ok((positions, faces, new))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cage::{CageSurface, Settings, primitive};
    use proptest::prelude::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn edits_do_what_they_say() {
        let cube = primitive::cube(1.0).unwrap();
        let moved = move_vertices(&cube, &[(7, DVec3::splat(2.0))]).unwrap();
        assert_eq!(moved.positions()[7], DVec3::splat(2.0));
        assert_eq!(moved.faces(), cube.faces());

        let tower = extrude_face(&cube, 1, 2.0).unwrap();
        assert_eq!((tower.positions().len(), tower.faces().len()), (12, 10));
        assert_eq!(tower.faces()[1], [8, 9, 10, 11]);
        assert!(tower.is_closed());
        assert!(tower.positions()[8..].iter().all(|p| (p.z - 3.0).abs() < 1e-15));

        let open = delete_face(&cube, 0).unwrap();
        assert!(!open.is_closed() && open.euler_characteristic() == 1);

        let longer = split_edge(&primitive::grid(1.0, 1, 1).unwrap(), 0, 1, 0.25).unwrap();
        assert_eq!(longer.faces()[0], [0, 4, 1, 3, 2]);
        assert_eq!(longer.positions()[4], DVec3::new(-0.25, -0.5, 0.0));

        let halved = split_edge_and_faces(&cube, 0, 2, 0.5).unwrap();
        assert_eq!((halved.positions().len(), halved.faces().len()), (9, 8));
        assert_eq!((halved.valence(8), halved.euler_characteristic()), (4, 2));

        let cut = split_face(&cube, 0, 0, 3).unwrap();
        assert_eq!((cut.faces()[0].clone(), cut.faces()[6].clone()), (vec![0, 2, 3], vec![3, 1, 0]));

        let pyramid = split_face_at_centre(&cube, 0).unwrap();
        assert_eq!((pyramid.faces().len(), pyramid.valence(8)), (9, 4));
        assert_eq!(pyramid.positions()[8], DVec3::new(0.0, 0.0, -1.0));
    }

    #[test]
    fn what_cannot_be_done_is_refused_by_name() {
        let cube = primitive::cube(1.0).unwrap();
        let count = 6;
        let is = |done: Result<Cage, EditError>, error: EditError| assert_eq!(done.unwrap_err(), error);
        is(move_vertices(&cube, &[(8, DVec3::ZERO)]), EditError::NoSuchVertex { vertex: 8, count: 8 });
        is(move_vertices(&cube, &[(1, DVec3::NAN)]), CageError::Position { vertex: 1 }.into());
        is(extrude_face(&cube, 6, 1.0), EditError::NoSuchFace { face: 6, count });
        is(extrude_face(&cube, 0, f64::INFINITY), CageError::Position { vertex: 8 }.into());
        let flat = move_vertices(&cube, &[0, 1, 2, 3].map(|v| (v, DVec3::ZERO))).unwrap();
        is(extrude_face(&flat, 0, 1.0), EditError::NoNormal(0));
        is(delete_face(&cube, 9), EditError::NoSuchFace { face: 9, count });
        is(delete_face(&primitive::grid(1.0, 1, 1).unwrap(), 0), CageError::NoFaces.into());
        // The faces at two opposite corners of a square of four quads touch in its centre only.
        let three = delete_face(&primitive::grid(1.0, 2, 2).unwrap(), 0).unwrap();
        is(delete_face(&three, 2), CageError::TwoFans { vertex: 4 }.into());
        is(split_edge(&cube, 0, 7, 0.5), EditError::NoSuchEdge(0, 7));
        is(split_edge(&cube, 0, 99, 0.5), EditError::NoSuchEdge(0, 99));
        is(split_edge(&cube, 0, 1, 1.0), EditError::Place(1.0));
        is(split_edge(&cube, 0, 1, 0.5), CageError::TooFewFaces { vertex: 8, valence: 2 }.into());
        is(split_face(&cube, 0, 0, 7), EditError::NoCorner { face: 0, vertex: 7 });
        is(split_face(&cube, 0, 0, 2), EditError::Neighbours { face: 0, from: 0, to: 2 });
        is(split_face(&cube, 0, 1, 1), EditError::Neighbours { face: 0, from: 1, to: 1 });
        is(split_face(&cube, 7, 1, 1), EditError::NoSuchFace { face: 7, count });
        is(split_face_at_centre(&cube, 6), EditError::NoSuchFace { face: 6, count });
        // A diagonal that is an edge already would be shared by four faces.
        let tetrahedron = primitive::tetrahedron(1.0).unwrap();
        let opened = delete_face(&tetrahedron, 3).unwrap();
        assert!(split_face(&opened, 0, 0, 1).is_err());
    }

    #[derive(Clone, Debug)]
    enum Edit {
        Move(u32, [f64; 3]),
        Extrude(u32, f64),
        Delete(u32),
        Edge(u32, u32),
        Face(u32, u32, u32),
        Centre(u32),
    }

    fn edit() -> impl Strategy<Value = Edit> {
        let (vertex, face) = (0_u32..16, 0_u32..16);
        prop_oneof![
            (vertex.clone(), prop::array::uniform3(-2.0..2.0)).prop_map(|(v, p)| Edit::Move(v, p)),
            (face.clone(), -1.0..1.0).prop_map(|(f, by)| Edit::Extrude(f, by)),
            face.clone().prop_map(Edit::Delete),
            (vertex.clone(), vertex.clone()).prop_map(|(a, b)| Edit::Edge(a, b)),
            (face.clone(), vertex.clone(), vertex).prop_map(|(f, a, b)| Edit::Face(f, a, b)),
            face.prop_map(Edit::Centre),
        ]
    }

    fn done(cage: &Cage, edit: &Edit) -> Result<Cage, EditError> {
        match *edit {
            Edit::Move(vertex, to) => move_vertices(cage, &[(vertex, to.into())]),
            Edit::Extrude(face, by) => extrude_face(cage, face, by),
            Edit::Delete(face) => delete_face(cage, face),
            Edit::Edge(from, to) => split_edge_and_faces(cage, from, to, 0.4),
            Edit::Face(face, from, to) => split_face(cage, face, from, to),
            Edit::Centre(face) => split_face_at_centre(cage, face),
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: if cfg!(target_arch = "wasm32") { 10 } else { 100 }, ..Default::default() })]

        /// Whatever is done or refused: a cage stays a cage, over which there is a surface through its vertices.
        #[test]
        fn edits_at_random_leave_a_cage(edits in prop::collection::vec(edit(), 1..25)) {
            let mut cage = primitive::cube(1.0).unwrap();
            for edit in &edits {
                if let Ok(next) = done(&cage, edit) {
                    cage = next;
                }
            }
            let surface = CageSurface::new(&cage, Settings::default()).unwrap();
            for (quad, corners) in surface.quads().iter().enumerate() {
                let met = surface.evaluate(quad, 0.0, 0.0).unwrap().point;
                prop_assert!(met.distance(cage.positions()[corners[0] as usize]) < 1e-12);
            }
        }
    }
}
