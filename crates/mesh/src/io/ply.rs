//! PLY, the polygon file format (G. Turk, 1994): positions and faces, as text or as binary numbers of either order.
//!
//! Read here rather than with a library: of what a file may hold a surface needs two lists, the refusals should name the place,
//! and the libraries that are there bring a parser generator into the worker.
//!
//! ```
//! use ductile_mesh::io::ply;
//! let text = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n\
//!             element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
//! assert_eq!(ply::read_polygons(text.as_bytes())?.faces, [[0, 1, 2]]);
//! # Ok::<(), ply::PlyError>(())
//! ```

use super::Polygons;
use glam::DVec3;
use thiserror::Error;

/// What is wrong with a PLY file. Lines of the header count from 1, vertices and faces from 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PlyError {
    /// The file does not begin with `ply`, or its header does not end.
    #[error("this is no PLY file: it has no header that begins with “ply” and ends with “end_header”")]
    NoHeader,
    /// The header says something that is not known.
    #[error("line {0} of the header is not understood")]
    Header(usize),
    /// The data are in none of the three formats.
    #[error("the format is none of ascii, binary_little_endian and binary_big_endian")]
    Format,
    /// There are no vertices with coordinates x, y and z.
    #[error("the file has no vertices with x, y and z")]
    NoVertices,
    /// There is no list of corners.
    #[error("the file has no faces with a list of vertex_indices")]
    NoFaces,
    /// The data end before all that was announced has come, or hold something that is no number.
    #[error("{element} {number}: the data end early, or hold something that is no number")]
    Data {
        /// `vertex`, `face`, or `element` for what is passed over.
        element: &'static str,
        /// Which of them.
        number: usize,
    },
    /// A coordinate is not finite.
    #[error("vertex {0} has a coordinate that is not finite")]
    Coordinate(usize),
    /// A face names a vertex that does not exist.
    #[error("face {face} names a vertex that does not exist; there are {count}")]
    Corner {
        /// The face.
        face: usize,
        /// How many vertices there are.
        count: usize,
    },
    /// A face has less than three corners.
    #[error("face {0} has less than three corners")]
    ShortFace(usize),
}

/// How the data are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Ascii,
    Little,
    Big,
}

/// A type of number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Number {
    fn named(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }
}

/// A property of an element: a number, or a list with the type of its count.
struct Property {
    name: String,
    list: Option<Number>,
    number: Number,
}

struct Element {
    name: String,
    count: usize,
    properties: Vec<Property>,
}

/// Reads positions and faces; whatever else a file holds (normals, colours, edges) is passed over.
///
/// # Errors
/// See [`PlyError`].
pub fn read_polygons(bytes: &[u8]) -> Result<Polygons, PlyError> {
    let (format, elements, rest) = header(bytes)?;
    let mut data = Data { format, rest };
    let mut polygons = Polygons::default();
    let (mut has_vertices, mut has_faces) = (false, false);
    for element in &elements {
        match element.name.as_str() {
            "vertex" => {
                has_vertices = true;
                read_vertices(element, &mut data, &mut polygons.positions)?;
            }
            "face" => {
                has_faces = true;
                read_faces(element, &mut data, &mut polygons.faces)?;
            }
            // An element without properties takes no room, however many there are said to be.
            _ if element.properties.is_empty() => {}
            _ => (0..element.count).try_for_each(|number| {
                data.entry(element, |_, _| ()).ok_or(PlyError::Data { element: "element", number })
            })?,
        }
    }
    if !has_vertices {
        return Err(PlyError::NoVertices);
    }
    if !has_faces {
        return Err(PlyError::NoFaces);
    }
    let count = polygons.positions.len();
    let is_whole = |face: &Vec<u32>| face.iter().all(|&corner| (corner as usize) < count);
    match polygons.faces.iter().position(|face| !is_whole(face)) {
        Some(face) => Err(PlyError::Corner { face, count }),
        None => Ok(polygons),
    }
}

fn read_vertices(element: &Element, data: &mut Data<'_>, positions: &mut Vec<DVec3>) -> Result<(), PlyError> {
    let place = |name: &str| {
        let is_it = |property: &Property| property.name == name && property.list.is_none();
        element.properties.iter().position(is_it).ok_or(PlyError::NoVertices)
    };
    let places = [place("x")?, place("y")?, place("z")?];
    for number in 0..element.count {
        let mut at = [0.0; 3];
        let take = |property: usize, value: f64| {
            if let Some(axis) = places.iter().position(|place| *place == property) {
                at[axis] = value;
            }
        };
        data.entry(element, take).ok_or(PlyError::Data { element: "vertex", number })?;
        if !at.iter().all(|x| x.is_finite()) {
            return Err(PlyError::Coordinate(number));
        }
        positions.push(DVec3::from_array(at));
    }
    Ok(())
}

fn read_faces(element: &Element, data: &mut Data<'_>, faces: &mut Vec<Vec<u32>>) -> Result<(), PlyError> {
    let is_list = |property: &Property| {
        property.list.is_some() && matches!(property.name.as_str(), "vertex_indices" | "vertex_index")
    };
    let corners = element.properties.iter().position(is_list).ok_or(PlyError::NoFaces)?;
    for number in 0..element.count {
        let mut face = Vec::new();
        // What is no index becomes one that cannot exist.
        let take = |property: usize, value: f64| {
            if property == corners {
                face.push(index(value));
            }
        };
        data.entry(element, take).ok_or(PlyError::Data { element: "face", number })?;
        if face.len() < 3 {
            return Err(PlyError::ShortFace(number));
        }
        faces.push(face);
    }
    Ok(())
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "the value is a whole u32")]
fn index(value: f64) -> u32 {
    let is_whole = (0.0..f64::from(u32::MAX)).contains(&value) && value.trunc().to_bits() == value.to_bits();
    if is_whole { value as u32 } else { u32::MAX }
}

/// The format, the elements in order, and what follows the header.
fn header(bytes: &[u8]) -> Result<(Format, Vec<Element>, &[u8]), PlyError> {
    let (mut format, mut elements, mut rest) = (None, Vec::<Element>::new(), bytes);
    for line in 1.. {
        let end = rest.iter().position(|byte| *byte == b'\n').ok_or(PlyError::NoHeader)?;
        let text = std::str::from_utf8(&rest[..end]).unwrap_or("?").trim();
        rest = &rest[end + 1..];
        let mut words = text.split_whitespace();
        let mut word = || words.next().unwrap_or_default();
        let unknown = PlyError::Header(line);
        match (line, word()) {
            (1, "ply") => {}
            (1, _) => return Err(PlyError::NoHeader),
            (_, "comment" | "obj_info" | "") => {}
            (_, "format") => {
                format = Some(match word() {
                    "ascii" => Format::Ascii,
                    "binary_little_endian" => Format::Little,
                    "binary_big_endian" => Format::Big,
                    _ => return Err(PlyError::Format),
                });
            }
            (_, "element") => {
                let (name, count) = (word().to_owned(), word().parse().map_err(|_| unknown)?);
                elements.push(Element { name, count, properties: Vec::new() });
            }
            (_, "property") => {
                let first = word();
                let list = if first == "list" { Some(Number::named(word()).ok_or(unknown)?) } else { None };
                let number = if list.is_some() { word() } else { first };
                let number = Number::named(number).ok_or(unknown)?;
                let name = word().to_owned();
                elements.last_mut().ok_or(unknown)?.properties.push(Property { name, list, number });
            }
            (_, "end_header") => break,
            _ => return Err(unknown),
        }
    }
    Ok((format.ok_or(PlyError::Format)?, elements, rest))
}

/// What has not been read yet.
struct Data<'a> {
    format: Format,
    rest: &'a [u8],
}

impl Data<'_> {
    /// Reads an entry of an element and gives each number of it away, with the place of its property. None when it is cut off.
    fn entry(&mut self, element: &Element, mut take: impl FnMut(usize, f64)) -> Option<()> {
        for (place, property) in element.properties.iter().enumerate() {
            let count = match property.list {
                None => 1,
                Some(counted) => Some(index(self.number(counted)?)).filter(|&count| count != u32::MAX)?,
            };
            for _ in 0..count {
                take(place, self.number(property.number)?);
            }
        }
        Some(())
    }

    fn number(&mut self, number: Number) -> Option<f64> {
        if self.format == Format::Ascii {
            return self.word()?.parse().ok();
        }
        Some(match number {
            Number::I8 => i8::from_le_bytes(self.bytes()?).into(),
            Number::U8 => u8::from_le_bytes(self.bytes()?).into(),
            Number::I16 => i16::from_le_bytes(self.bytes()?).into(),
            Number::U16 => u16::from_le_bytes(self.bytes()?).into(),
            Number::I32 => i32::from_le_bytes(self.bytes()?).into(),
            Number::U32 => u32::from_le_bytes(self.bytes()?).into(),
            Number::F32 => f32::from_le_bytes(self.bytes()?).into(),
            Number::F64 => f64::from_le_bytes(self.bytes()?),
        })
    }

    /// The next word of a text.
    fn word(&mut self) -> Option<&str> {
        let begin = self.rest.iter().position(|byte| !byte.is_ascii_whitespace())?;
        let text = &self.rest[begin..];
        let end = text.iter().position(u8::is_ascii_whitespace).unwrap_or(text.len());
        self.rest = &text[end..];
        std::str::from_utf8(&text[..end]).ok()
    }

    /// The next bytes, the lowest first.
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.rest.split_first_chunk::<N>()?;
        self.rest = rest;
        let mut bytes = *first;
        if self.format == Format::Big {
            bytes.reverse();
        }
        Some(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A square and a triangle, with what does not matter between.
    const HEADER: &str = "element vertex 5\r\nproperty float32 x\nproperty double y\nproperty uchar red\nproperty float z\n\
        comment edges first\nelement edge 1\nproperty short from\nproperty list uchar ushort all\nelement nothing 4000000000\n\
        element face 2\nproperty list uchar int vertex_indices\nproperty int8 flag\nend_header\n";
    const PLACES: [[f32; 3]; 5] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0], [2.0, 2.0, -1.0]];
    const FACES: [&[i32]; 2] = [&[0, 1, 2, 3], &[1, 4, 2]];

    fn ascii() -> Vec<u8> {
        let mut text = format!("ply\nformat ascii 1.0\n{HEADER}");
        for [x, y, z] in PLACES {
            text += &format!("{x} {y} 255 {z}\n");
        }
        text += "-7 2 1 2\n";
        for face in FACES {
            text += &format!("{}", face.len());
            face.iter().for_each(|corner| text += &format!(" {corner}"));
            text += " -1\n";
        }
        text.into_bytes()
    }

    fn binary(is_big: bool) -> Vec<u8> {
        let order = if is_big { "big" } else { "little" };
        let mut bytes = format!("ply\nformat binary_{order}_endian 1.0\n{HEADER}").into_bytes();
        let mut push = |own: &[u8]| {
            let mut own = own.to_vec();
            if is_big {
                own.reverse();
            }
            bytes.extend(own);
        };
        for [x, y, z] in PLACES {
            push(&x.to_le_bytes());
            push(&f64::from(y).to_le_bytes());
            push(&[255]);
            push(&z.to_le_bytes());
        }
        push(&(-7_i16).to_le_bytes());
        push(&[2]);
        push(&1_u16.to_le_bytes());
        push(&2_u16.to_le_bytes());
        for face in FACES {
            push(&[u8::try_from(face.len()).unwrap()]);
            face.iter().for_each(|corner| push(&corner.to_le_bytes()));
            push(&[255]);
        }
        bytes
    }

    #[test]
    fn the_three_formats_hold_the_same() {
        let read = read_polygons(&ascii()).unwrap();
        assert_eq!(
            read.faces,
            FACES.map(|face| face.iter().map(|&c| u32::try_from(c).unwrap()).collect::<Vec<_>>())
        );
        assert_eq!(read.positions, PLACES.map(|place| DVec3::from(place.map(f64::from))));
        assert_eq!(read_polygons(&binary(false)).unwrap(), read);
        assert_eq!(read_polygons(&binary(true)).unwrap(), read);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let with = |from: &str, to: &str| {
            let text = String::from_utf8(ascii()).unwrap();
            assert!(text.contains(from), "{from}");
            read_polygons(text.replacen(from, to, 1).as_bytes()).unwrap_err()
        };
        assert_eq!(read_polygons(b""), Err(PlyError::NoHeader));
        assert_eq!(read_polygons(b"v 0 0 0\n"), Err(PlyError::NoHeader));
        assert_eq!(with("end_header", "comment"), PlyError::Header(17));
        assert_eq!(with("format ascii", "format utf8"), PlyError::Format);
        assert_eq!(with("format ascii 1.0", "comment"), PlyError::Format);
        assert_eq!(with("property double", "property triple"), PlyError::Header(5));
        assert_eq!(with("element vertex 5", "element vertex some"), PlyError::Header(3));
        assert_eq!(with("property float z", "property float w"), PlyError::NoVertices);
        assert_eq!(with("element vertex", "element vortex"), PlyError::NoVertices);
        assert_eq!(with("vertex_indices", "corners"), PlyError::NoFaces);
        assert_eq!(with("element face", "element fact"), PlyError::NoFaces);
        assert_eq!(with("1 1 255", "1 one 255"), PlyError::Data { element: "vertex", number: 2 });
        assert_eq!(with("1 1 255", "1 inf 255"), PlyError::Coordinate(2));
        assert_eq!(with("4 0 1 2 3", "4 0 1 2 5"), PlyError::Corner { face: 0, count: 5 });
        assert_eq!(with("4 0 1 2 3", "4 0 1 2 -1"), PlyError::Corner { face: 0, count: 5 });
        assert_eq!(with("3 1 4 2", "2 1 4"), PlyError::ShortFace(1));
        assert_eq!(with("3 1 4 2", "-3 1 4 2"), PlyError::Data { element: "face", number: 1 });
        assert_eq!(with("-7 2", "-7 9999999"), PlyError::Data { element: "element", number: 0 });
        let cut = &binary(true)[..binary(true).len() - 2];
        assert_eq!(read_polygons(cut), Err(PlyError::Data { element: "face", number: 1 }));
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: if cfg!(target_arch = "wasm32") { 40 } else { 400 }, ..Default::default() })]

        /// A damaged file is refused, or read as another one that is whole.
        #[test]
        fn any_bytes_are_refused_or_whole(places in prop::collection::vec((0_usize..900, any::<u8>()), 1..6), big in any::<bool>()) {
            let mut bytes = binary(big);
            for (place, byte) in places {
                let count = bytes.len();
                bytes[place % count] = byte;
            }
            if let Ok(read) = read_polygons(&bytes) {
                prop_assert!(read.positions.iter().all(|p| p.is_finite()));
                prop_assert!(read.faces.iter().flatten().all(|&c| (c as usize) < read.positions.len()));
            }
        }
    }
}
