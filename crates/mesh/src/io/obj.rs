//! Wavefront OBJ: positions, normals and faces as text.
//!
//! Read here rather than with a library: of the format's many statements a surface needs two (`v` and
//! `f`), and a reader's refusals should name the line.
//!
//! Numbers are written with as many digits as bring back the same `f64`.
//!
//! ```
//! use ductile_mesh::{io::obj, primitive};
//! let (mesh, positions) = primitive::octahedron();
//! let text = obj::write(&mesh, &positions, None);
//! let (back, points) = obj::read_mesh(&text)?;
//! assert_eq!((back.to_triangles(), points), (mesh.to_triangles(), positions));
//! # Ok::<(), obj::ObjError>(())
//! ```

use core::fmt::Write as _;

use glam::DVec3;
use thiserror::Error;

use super::Polygons;
use crate::{BuildError, Mesh};

/// What is wrong with an OBJ text. Lines are counted from 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ObjError {
    /// A coordinate is not a number, or infinite, as in `v 0 zero 0`.
    #[error("line {0}: a coordinate is not a finite number")]
    BadCoordinate(usize),
    /// A `v` line has less than three coordinates.
    #[error("line {0}: a position needs three coordinates")]
    ShortPosition(usize),
    /// A corner is not an index, as in `f 1 2 x`; or it is 0, for indices count from 1.
    #[error("line {0}: a corner is not an index")]
    BadIndex(usize),
    /// A corner names a position that the file does not have.
    #[error("line {line}: there is no position {index}; the file has {count}")]
    IndexOutOfRange {
        /// The line of the face.
        line: usize,
        /// The index as resolved, counted from 1; 0 or less if counted back past the first.
        index: i64,
        /// How many positions there are.
        count: usize,
    },
    /// A face has less than three corners.
    #[error("line {0}: a face needs three corners")]
    ShortFace(usize),
    /// More positions than 32-bit indices can name.
    #[error("the file has too many positions")]
    TooLarge,
    /// The faces do not form a surface.
    #[error("the faces form no surface: {0}")]
    NoSurface(#[from] BuildError),
}

/// The positions and triangles of an OBJ text; polygons have been cut into fans.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Soup {
    /// All positions, used or not.
    pub positions: Vec<DVec3>,
    /// The triangles, in order of the file.
    pub triangles: Vec<[u32; 3]>,
}

impl Soup {
    /// Drops the positions that no triangle uses.
    fn without_unused(mut self) -> Self {
        let mut name = vec![u32::MAX; self.positions.len()];
        for &i in self.triangles.as_flattened() {
            name[i as usize] = 0;
        }
        for (new, slot) in (0..).zip(name.iter_mut().filter(|slot| **slot == 0)) {
            *slot = new;
        }
        self.positions =
            self.positions.into_iter().zip(&name).filter(|(_, n)| **n != u32::MAX).map(|(p, _)| p).collect();
        for i in self.triangles.as_flattened_mut() {
            *i = name[*i as usize];
        }
        self
    }
}

/// Writes the living faces of `mesh` with the positions of the living vertices and, if given, their
/// normals.
#[must_use]
pub fn write(mesh: &Mesh, positions: &[DVec3], normals: Option<&[DVec3]>) -> String {
    let mut text = String::new();
    let mut name = vec![0_usize; mesh.vertex_slots()];
    // Writing to a String cannot fail, so the results are dropped.
    for (number, v) in mesh.vertices().enumerate() {
        name[v.index()] = number + 1;
        let p = positions[v.index()];
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    if let Some(normals) = normals {
        for v in mesh.vertices() {
            let n = normals[v.index()];
            let _ = writeln!(text, "vn {} {} {}", n.x, n.y, n.z);
        }
    }
    for f in mesh.faces() {
        let [a, b, c] = mesh.face_vertices(f).map(|v| name[v.index()]);
        let _ = match normals {
            Some(_) => writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}"),
            None => writeln!(text, "f {a} {b} {c}"),
        };
    }
    text
}

/// Reads positions and faces. Texture coordinates, normals, groups and materials are passed over; polygons
/// become fans from their first corner; negative indices count back from the latest position.
///
/// # Errors
/// See [`ObjError`].
pub fn read(text: &str) -> Result<Soup, ObjError> {
    let Polygons { positions, faces } = read_polygons(text)?;
    let fan = |face: &Vec<u32>| -> Vec<[u32; 3]> {
        face[1..].windows(2).map(|pair| [face[0], pair[0], pair[1]]).collect()
    };
    Ok(Soup { positions, triangles: faces.iter().flat_map(fan).collect() })
}

/// Reads positions and faces as [`read`] does, but leaves polygons whole.
///
/// # Errors
/// See [`ObjError`].
pub fn read_polygons(text: &str) -> Result<Polygons, ObjError> {
    let mut positions = Vec::new();
    let mut faces: Vec<(usize, Vec<i64>)> = Vec::new();
    for (line, statement) in statements(text) {
        let mut words = statement.split_whitespace();
        match words.next() {
            Some("v") => positions.push(position(line, words)?),
            Some("f") => {
                let corners: Vec<i64> =
                    words.map(|w| corner(line, w, positions.len())).collect::<Result<_, _>>()?;
                if corners.len() < 3 {
                    return Err(ObjError::ShortFace(line));
                }
                faces.push((line, corners));
            }
            _ => {}
        }
    }
    let count = positions.len();
    if u32::try_from(count).is_err() {
        return Err(ObjError::TooLarge);
    }
    let resolve = |(line, corners): (usize, Vec<i64>)| {
        let resolve = |index: i64| {
            let is_there = usize::try_from(index).is_ok_and(|i| (1..=count).contains(&i));
            let resolved = u32::try_from(index.saturating_sub(1)).ok().filter(|_| is_there);
            resolved.ok_or(ObjError::IndexOutOfRange { line, index, count })
        };
        corners.into_iter().map(resolve).collect()
    };
    Ok(Polygons { positions, faces: faces.into_iter().map(resolve).collect::<Result<_, _>>()? })
}

/// Reads a surface; positions that no face uses are dropped.
///
/// # Errors
/// As [`read`], and [`ObjError::NoSurface`] when the faces do not fit together.
pub fn read_mesh(text: &str) -> Result<(Mesh, Vec<DVec3>), ObjError> {
    let soup = read(text)?.without_unused();
    let mesh = Mesh::from_triangles(soup.positions.len(), &soup.triangles)?;
    Ok((mesh, soup.positions))
}

/// Statements with the line each starts on: comments cut off, lines ending in `\` joined to the next.
fn statements(text: &str) -> impl Iterator<Item = (usize, String)> + '_ {
    // Some editors begin a text with a mark of its byte order.
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    core::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let mut statement = line.split('#').next().unwrap_or_default().trim_end().to_owned();
        while statement.ends_with('\\') {
            statement.pop();
            let Some((_, more)) = lines.next() else { break };
            statement.push(' ');
            statement.push_str(more.split('#').next().unwrap_or_default().trim_end());
        }
        Some((number + 1, statement))
    })
}

fn position<'a>(line: usize, mut words: impl Iterator<Item = &'a str>) -> Result<DVec3, ObjError> {
    let mut coordinate = || -> Result<f64, ObjError> {
        let word = words.next().ok_or(ObjError::ShortPosition(line))?;
        word.parse::<f64>().ok().filter(|x| x.is_finite()).ok_or(ObjError::BadCoordinate(line))
    };
    Ok(DVec3::new(coordinate()?, coordinate()?, coordinate()?))
}

/// The position index of a corner like `7`, `7/1`, `7//3` or `-2`, counted from 1.
fn corner(line: usize, word: &str, so_far: usize) -> Result<i64, ObjError> {
    let index: i64 = word.split('/').next().and_then(|i| i.parse().ok()).ok_or(ObjError::BadIndex(line))?;
    match index {
        0 => Err(ObjError::BadIndex(line)),
        back if back < 0 => {
            Ok(i64::try_from(so_far).unwrap_or(i64::MAX).saturating_add(back).saturating_add(1))
        }
        index => Ok(index),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{VertexId, primitive};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn every_bit_comes_back() {
        let (mut mesh, mut positions) = primitive::moebius(7, 2, 1.0 / 3.0, 1e-7);
        positions[3] = DVec3::new(f64::MIN_POSITIVE, -0.1, 1e17 / 3.0);
        mesh.collapse(VertexId::from_index(4), VertexId::from_index(1));
        let text = write(&mesh, &positions, Some(&positions));
        let (back, points) = read_mesh(&text).unwrap();
        let (dense, name) = mesh.compacted();
        assert_eq!(back.to_triangles(), dense.to_triangles());
        for v in mesh.vertices() {
            assert_eq!(points[name[v.index()].unwrap().index()], positions[v.index()]);
        }
    }

    #[test]
    fn polygons_become_fans_and_forms_of_corners_are_read() {
        let text = "\u{feff}v 0 0 0 1\n# a square\nmtllib x.mtl\nv 1 0 0\nv 1 1 0 # far\nv 0 1 0\nv 9 9 9\nvt 0 0\n\
                    f 1/1 2/1/1 \\\n 3//1 -2\n";
        let soup = read(text).unwrap();
        assert_eq!(soup.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(soup.positions.len(), 5);
        let whole = read_polygons(text).unwrap();
        assert_eq!((whole.faces, whole.positions), (vec![vec![0, 1, 2, 3]], soup.positions));
        assert_eq!(read_mesh(text).unwrap().1.len(), 4, "the stray position is dropped");
    }

    #[test]
    fn refusals_name_the_line() {
        let refusal = |text| read_mesh(text).unwrap_err();
        assert_eq!(refusal("v 0 0 0\nv 1 x 0"), ObjError::BadCoordinate(2));
        assert_eq!(refusal("v 0 0 inf"), ObjError::BadCoordinate(1));
        assert_eq!(refusal("\nv 0 0"), ObjError::ShortPosition(2));
        assert_eq!(refusal("v 0 0 0\nf 1 1"), ObjError::ShortFace(2));
        assert_eq!(refusal("v 0 0 0\nf 1 b 1"), ObjError::BadIndex(2));
        assert_eq!(refusal("v 0 0 0\nf 0 1 1"), ObjError::BadIndex(2));
        let missing = |index| ObjError::IndexOutOfRange { line: 2, index, count: 1 };
        assert_eq!(refusal("v 0 0 0\nf 1 2 3"), missing(2));
        assert_eq!(refusal("v 0 0 0\nf 1 -2 1"), missing(0));
        assert!(matches!(refusal("v 0 0 0\nv 1 0 0\nf 1 2 2"), ObjError::NoSurface(_)));
    }

    #[test]
    fn an_empty_text_is_an_empty_surface() {
        assert_eq!(read_mesh("").unwrap().0.face_count(), 0);
        assert_eq!(write(&Mesh::default(), &[], None), "");
    }
}
