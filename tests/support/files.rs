//! Bytes as what people hand to the modeler from outside: documents, links, files of ribbons, meshes. Whatever they hold, each
//! reader says why it refuses them, or what it has read means the same when it is written and read again.

use crate::round::Round;
use ductile_mesh::io::{obj, ply};
use ductile_modeler::example;
use ductile_spec::{
    Document, Example, ImportAs, ImportFormat, PointId, Request, Resume, Step, from_fragment, from_text,
    ribbon_holes, to_compact_text, to_fragment, to_text,
};
use glam::DVec3;

/// A model with more nodes than this is opened and looked at, but not relaxed: it takes too long to be worth more.
const ENOUGH: usize = 4000;
/// A mesh of one triangle in a text.
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0.5\nf 1 2 3\n";

/// Reads the bytes as a spec file, as a link and as a file of ribbons; opens and relaxes what they hold.
///
/// # Panics
/// When a promise is broken: that is a fault of the reader or of the modeler.
pub fn documents(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes).into_owned();
    match from_text(&text) {
        Ok(document) => comes_round(&document),
        Err(why) => says(&why.to_string()),
    }
    match from_fragment(&text) {
        Ok(document) => comes_round(&document),
        Err(why) => says(&why.to_string()),
    }
    if let Some(Err(why)) = ribbon_holes(&text) {
        says(&why.to_string());
    }
    let mut round = bare();
    ask(&mut round, &Request::OpenText { text: text.clone() });
    ask(&mut round, &Request::OpenLink { link: text });
    let is_there = round.bench.modeler.model().node_count() > 0;
    if is_there {
        round.opens();
        ask(&mut round, &Request::Undo);
        ask(&mut round, &Request::Resume(Resume::default()));
    }
}

/// Reads the bytes as each format of meshes, and makes of them all that can be made.
///
/// # Panics
/// When a promise is broken.
pub fn mesh_files(bytes: &[u8]) {
    let text = String::from_utf8_lossy(bytes);
    match obj::read_mesh(&text) {
        Ok((mesh, positions)) => {
            assert_eq!(ductile_mesh::validate(&mesh), Ok(()), "what was read is no mesh");
            let (again, same) = obj::read_mesh(&obj::write(&mesh, &positions, None))
                .unwrap_or_else(|why| panic!("what was written cannot be read: {why}"));
            assert_eq!((again.face_count(), same), (mesh.face_count(), positions), "written and read");
        }
        Err(why) => says(&why.to_string()),
    }
    if let Err(why) = ply::read_polygons(bytes) {
        says(&why.to_string());
    }
    for format in [ImportFormat::Obj, ImportFormat::Ply] {
        for into in [None, Some(ImportAs::Cage), Some(ImportAs::Mesh)] {
            let mut round = bare();
            ask(&mut round, &Request::Import { format, bytes: bytes.to_vec(), into });
            if round.bench.modeler.model().node_count() == 0 {
                // What cannot be read in one way cannot be read in another.
                continue;
            }
            round.opens();
        }
    }
}

/// Inputs to begin with: a folder of the corpus, a name, the bytes.
#[must_use]
pub fn seeds() -> Vec<(&'static str, String, Vec<u8>)> {
    let mut seeds = Vec::new();
    let shown = [Example::Disc, Example::Ball, Example::Cylinder, Example::TorusCage, Example::SixSided];
    for shown in shown {
        let document = example(shown);
        seeds.push(("documents", format!("{shown:?}.json"), to_compact_text(&document).into_bytes()));
        seeds.push(("documents", format!("{shown:?}.link"), to_fragment(&document).into_bytes()));
    }
    let quad = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
                element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0.5\n0 1 0\n4 0 1 2 3\n";
    let mut binary = quad
        .replace("ascii", "binary_little_endian")
        .split_inclusive("end_header\n")
        .next()
        .unwrap_or_default()
        .to_owned()
        .into_bytes();
    for coordinate in [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.5, 0.0, 1.0, 0.0] {
        binary.extend(coordinate.to_le_bytes());
    }
    binary.push(4);
    (0..4_i32).for_each(|corner| binary.extend(corner.to_le_bytes()));
    let tetrahedron =
        "v 1 1 1\nv -1 -1 1\nv -1 1 -1\nv 1 -1 -1\nf 1 3 2\nf -4 2/7 4//1 \\\n# no more\nf 1 4 3\nf 2 3 4\n";
    let meshes: [(&str, &[u8]); 5] = [
        ("triangle.obj", TRIANGLE.as_bytes()),
        ("quad.obj", b"v 0 0 0\nv 1 0 0\nv 1 1 .5\nv 0 1 0\nf 1 2 3 4\n"),
        ("tetrahedron.obj", tetrahedron.as_bytes()),
        ("quad.ply", quad.as_bytes()),
        ("binary.ply", &binary),
    ];
    seeds.extend(meshes.map(|(name, bytes)| ("mesh_files", name.to_owned(), bytes.to_vec())));
    seeds
}

/// A modeler with nothing in it but a point: undo does not go back to nothing at all.
fn bare() -> Round {
    let points = [(PointId(1), DVec3::ZERO)].into();
    Round::new(&to_compact_text(&Document { points, ..Document::default() }))
}

/// Asks, and lets what comes of it move a little.
fn ask(round: &mut Round, request: &Request) {
    match round.ask(request) {
        Some(why) => says(&why),
        None if round.bench.modeler.model().node_count() < ENOUGH => {
            for _ in 0..3 {
                round.ask(&Request::Step(Step { drag: None, iterations: 20 }));
            }
        }
        None => {}
    }
}

/// A reason is more than a word.
fn says(why: &str) {
    assert!(why.len() > 10, "{why:?} says nothing");
}

/// A document written is the one that is read, in each way of writing.
fn comes_round(document: &Document) {
    let texts = [to_text(document), to_compact_text(document)];
    for text in texts {
        assert_eq!(from_text(&text).as_ref(), Ok(document), "{text}");
    }
    let link = to_fragment(document);
    if let Ok(same) = from_fragment(&link) {
        assert_eq!(same, *document, "{link}");
    }
}
