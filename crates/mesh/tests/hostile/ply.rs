//! PLY files that mean harm: what was written is read, anything else is refused with its place.

use super::*;
use ductile_mesh::io::ply::{PlyError, read_polygons};
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

const HEADS: [&str; 3] = ["ascii", "binary_little_endian", "binary_big_endian"];

/// A file of a mesh in one of the three formats.
fn written(format: &str, mesh: &Mesh, positions: &[DVec3]) -> Vec<u8> {
    let triangles = mesh.to_triangles();
    let mut bytes = format!(
        "ply\nformat {format} 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
        positions.len(),
        triangles.len()
    )
    .into_bytes();
    for at in positions {
        match format {
            "ascii" => bytes.extend(format!("{:?} {:?} {:?}\n", at.x, at.y, at.z).into_bytes()),
            "binary_little_endian" => at.to_array().iter().for_each(|x| bytes.extend(x.to_le_bytes())),
            _ => at.to_array().iter().for_each(|x| bytes.extend(x.to_be_bytes())),
        }
    }
    for face in triangles {
        match format {
            "ascii" => bytes.extend(format!("3 {} {} {}\n", face[0], face[1], face[2]).into_bytes()),
            _ => {
                bytes.push(3);
                let is_little = format == "binary_little_endian";
                let corner = |v: &u32| if is_little { v.to_le_bytes() } else { v.to_be_bytes() };
                face.iter().for_each(|v| bytes.extend(corner(v)));
            }
        }
    }
    bytes
}

#[test]
fn every_format_brings_back_hostile_positions_or_names_the_vertex() {
    for (base, mesh, good) in bases() {
        for (name, positions) in hostile(&mesh, &good) {
            for format in HEADS {
                let says = format!("{base}, {name}, {format}");
                match read_polygons(&written(format, &mesh, &positions)) {
                    Ok(polygons) => {
                        assert_eq!(polygons.positions, positions, "{says}");
                        let faces: Vec<Vec<u32>> = mesh.to_triangles().iter().map(|f| f.to_vec()).collect();
                        assert_eq!(polygons.faces, faces, "{says}");
                    }
                    Err(error) => {
                        let bad = positions.iter().position(|p| !p.is_finite());
                        let is_it = |e: &PlyError| matches!(e, PlyError::Coordinate(k) if Some(*k) == bad);
                        assert!(bad.is_some() && is_it(&error), "{says}: {error}");
                    }
                }
            }
        }
    }
}

#[test]
fn no_prefix_and_no_changed_byte_crashes_the_reader() {
    let (mesh, positions) = primitive::icosphere(0);
    for format in HEADS {
        let whole = written(format, &mesh, &positions);
        for end in 0..whole.len() {
            // Only the last line of a text may do without its end.
            let read = read_polygons(&whole[..end]);
            assert!(read.is_err() || format == "ascii" && end + 2 >= whole.len(), "{format}, {end}");
        }
        for at in 0..whole.len() {
            for byte in [0, b' ', b'\n', b'-', b'9', 0x7f, 0x80, 0xff] {
                let mut changed = whole.clone();
                changed[at] = byte;
                if let Ok(polygons) = read_polygons(&changed) {
                    let count = polygons.positions.len();
                    assert!(polygons.positions.iter().all(|p| p.is_finite()), "{format}, {at}, {byte}");
                    let is_in = |v: &u32| (*v as usize) < count;
                    assert!(polygons.faces.iter().flatten().all(is_in), "{format}, {at}, {byte}");
                }
            }
        }
    }
}

#[test]
fn counts_beyond_all_bounds_end_with_the_data() {
    let head = |counts: [&str; 2], list: &str| {
        format!(
            "ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float y\nproperty float z\n\
             element face {}\nproperty list {list} vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n",
            counts[0], counts[1]
        )
    };
    let most = "18446744073709551615";
    for (counts, list, rest) in [
        ([most, "1"], "uchar int", "3 0 1 2\n"),
        (["3", most], "uchar int", "3 0 1 2\n"),
        (["3", "1"], "uint int", "4294967294 0 1 2\n"),
        (["3", "1"], "int int", "-3 0 1 2\n"),
        (["3", "1"], "double int", "1e300 0 1 2\n"),
        (["3", "1"], "uchar double", "3 0 1 nan\n"),
        (["3", "1"], "uchar double", "3 0 1 0.5\n"),
        (["3", "1"], "uchar int", "3 0 1 3\n"),
        (["3", "1"], "uchar int", "2 0 1\n"),
        (["-1", "1"], "uchar int", "3 0 1 2\n"),
        (["99999999999999999999", "1"], "uchar int", "3 0 1 2\n"),
    ] {
        let text = head(counts, list) + rest;
        let read = read_polygons(text.as_bytes());
        assert!(read.is_err(), "{counts:?}, {list}, {rest}: {read:?}");
    }
    // Faces that are no surface are read as they stand, and refused where a surface is wanted.
    let text = head(["3", "2"], "uchar int") + "3 0 1 1\n3 0 1 2\n";
    let polygons = read_polygons(text.as_bytes()).unwrap();
    let triangles: Vec<[u32; 3]> = polygons.faces.iter().map(|f| [f[0], f[1], f[2]]).collect();
    let refused = Mesh::from_triangles(3, &triangles).unwrap_err();
    assert!(matches!(refused, BuildError::RepeatedVertex { .. }), "{refused}");
}
