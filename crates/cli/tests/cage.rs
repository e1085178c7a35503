//! `ductile cage`: polygons in, a mesh and exact samples out; refusals name file, line, face and place.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use serde_json::{Value, json};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

const CUBE: &str = "# a cube with texture coordinates\nvt 0 0\nv -1 -1 -1\nv 1 -1 -1\nv -1 1 -1\nv 1 1 -1\nv -1 -1 1\nv 1 -1 1\n\
                    v -1 1 1\nv 1 1 1\nv 9 9 9\nf 1/1 3/1 4/1 2/1\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";

/// A folder with files in it; `{}/name` names one.
struct Folder(tempfile::TempDir);

impl Folder {
    fn with(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        files.iter().for_each(|(name, text)| fs::write(folder.path().join(name), text).unwrap());
        Self(folder)
    }

    /// Runs `ductile cage` in the folder.
    fn cage(&self, arguments: &[&str]) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_ductile"));
        command.current_dir(self.0.path()).arg("cage").args(arguments).output().unwrap()
    }

    fn json(&self, arguments: &[&str]) -> Value {
        let run = self.cage(arguments);
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        serde_json::from_slice(&run.stdout).unwrap()
    }

    fn refused(&self, says: &str, arguments: &[&str]) {
        let run = self.cage(arguments);
        let said = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(says), "{arguments:?} should say `{says}`: {said}");
    }
}

fn vector(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// Every sample of the recorded files, asked for on the command line with the same rules, is the recorded one.
#[test]
fn samples_are_those_of_the_reference_files() {
    for name in ["polyhedral-cube.json", "polyhedral-torus.json", "polyhedral-open.json"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(name);
        let file: Value = serde_json::from_str(&fs::read_to_string(path).unwrap()).unwrap();
        for case in file["cases"].as_array().unwrap() {
            let mut obj = String::new();
            for p in case["cage"]["vertices"].as_array().unwrap() {
                writeln!(obj, "v {} {} {}", p[0], p[1], p[2]).unwrap();
            }
            for face in case["cage"]["faces"].as_array().unwrap() {
                let corners = face.as_array().unwrap().iter().map(|v| (v.as_u64().unwrap() + 1).to_string());
                writeln!(obj, "f {}", corners.collect::<Vec<_>>().join(" ")).unwrap();
            }
            let folder = Folder::with(&[("cage.obj", &obj), ("samples.json", &case.to_string())]);
            let rule = |name: &str| case.get(name).and_then(Value::as_str).unwrap_or("linear").to_owned();
            let report = folder.json(&[
                "cage.obj",
                "--samples",
                "samples.json",
                "--json",
                "--blend",
                "hermite:2",
                "--map",
                &rule("map"),
                "--split",
                &rule("split"),
                "--boundary",
                &rule("boundary_rule"),
            ]);
            let recorded = case["samples"].as_array().unwrap();
            let found = report["samples"].as_array().unwrap();
            assert_eq!(found.len(), recorded.len());
            for (found, recorded) in found.iter().zip(recorded) {
                assert!(distance(&vector(&found["point"]), &vector(&recorded["point"])) < 1e-12);
                assert!(distance(&vector(&found["normal"]), &vector(&recorded["normal"])) < 1e-11);
            }
        }
    }
}

#[test]
fn a_mesh_is_written_with_every_bit() {
    let folder = Folder::with(&[("cube.obj", CUBE)]);
    let report = folder.json(&["cube.obj", "-o", "out.obj", "--resolution", "4", "--json"]);
    assert_eq!(
        report["mesh"],
        json!({"vertices": 8 + 12 * 3 + 6 * 9, "triangles": 6 * 32, "without_normal": 0})
    );
    let about =
        json!({"vertices": 9, "faces": 6, "closed": true, "euler_characteristic": 2, "largest_valence": 3});
    assert_eq!((&report["cage"], &report["quads"]), (&about, &json!(6)));
    let text = fs::read_to_string(folder.0.path().join("out.obj")).unwrap();
    let lines = |kind: &str| -> Vec<Vec<f64>> {
        let of_kind = text.lines().filter_map(|line| line.strip_prefix(kind));
        of_kind.map(|line| line.split_whitespace().map(|word| word.parse().unwrap()).collect()).collect()
    };
    let (positions, normals) = (lines("v "), lines("vn "));
    assert_eq!((positions.len(), normals.len(), text.matches("\nf ").count()), (98, 98, 192));
    // The corners of the cube come first, and are met.
    for (position, corner) in positions.iter().zip(CUBE.lines().filter_map(|line| line.strip_prefix("v "))) {
        let corner: Vec<f64> = corner.split(' ').map(|word| word.parse().unwrap()).collect();
        if corner[0] < 2.0 {
            assert!(distance(position, &corner) < 1e-14);
        }
    }
    assert!(normals.iter().all(|n| (distance(n, &[0.0; 3]) - 1.0).abs() < 1e-14));
}

/// A face that was divided keeps its parameters when it has four corners; the pieces of others are asked for by corner.
#[test]
fn faces_keep_their_names_when_they_are_divided() {
    let mixed = "v 0 0 0\nv 1 0 0\nv 1 1 0.1\nv 0 1 0\nv 2 0.5 0.3\nf 1 2 3 4\nf 2 5 3\n";
    let samples = json!([
        [0, 1, 1], [0, 0, 1], [0, 0.25, 0], [0, 0.75, 0.75], [0, 0.5, 0.5],
        {"face": 1, "corner": 1, "u": 0, "v": 0}, {"quad": 2, "u": 0.5, "v": 0.5},
    ]);
    let folder = Folder::with(&[("mixed.obj", mixed), ("samples.json", &samples.to_string())]);
    let report = folder.json(&["mixed.obj", "--samples", "samples.json", "--json"]);
    let point = |k: usize| vector(&report["samples"][k]["point"]);
    assert!(distance(&point(0), &[1.0, 1.0, 0.1]) < 1e-14);
    assert!(distance(&point(1), &[0.0, 1.0, 0.0]) < 1e-14);
    assert!(distance(&point(4), &[0.5, 0.5, 0.025]) < 1e-14, "the face point");
    assert!(distance(&point(5), &[2.0, 0.5, 0.3]) < 1e-14);
    assert!(distance(&point(3), &point(6)) < 1e-15, "the middle of the quarter at corner 2");
    assert!((point(2)[0] - 0.25).abs() < 0.1 && point(2)[1].abs() < 0.1);
    let run = folder.cage(&["mixed.obj", "--samples", "samples.json"]);
    let text = String::from_utf8(run.stdout).unwrap();
    assert_eq!(text.lines().count(), 7);
    let first: Vec<f64> = text.lines().next().unwrap().split(' ').map(|word| word.parse().unwrap()).collect();
    assert_eq!(first[..3], point(0), "the same bits in both forms");
    assert_eq!(first.len(), 8);
}

#[test]
fn every_rule_can_be_chosen() {
    let folder = Folder::with(&[("cube.obj", CUBE), ("samples.json", "[[0, 0.3, 0.2]]")]);
    let point = |rule: &[&str]| {
        let report = folder.json(&[&["cube.obj", "--samples", "samples.json", "--json"], rule].concat());
        vector(&report["samples"][0]["point"])
    };
    let plain = point(&[]);
    assert_eq!(
        point(&["--map", "smooth", "--blend", "hermite:2", "--split", "none", "--boundary", "borrow"]),
        plain
    );
    for other in [
        ["--map", "rational"],
        ["--blend", "hermite:3"],
        ["--blend", "bump"],
        ["--blend", "bump:2"],
        ["--blend", "erbs"],
        ["--split", "linear"],
        ["--split", "offset"],
        ["--split", "catmull-clark"],
    ] {
        assert!(distance(&point(&other), &plain) > 1e-6, "{other:?}");
    }
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let pair = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let folder = Folder::with(&[
        ("cube.obj", CUBE),
        ("empty.obj", ""),
        ("index.obj", "v 0 0 0\nf 1 2 3\n"),
        ("huge.obj", "v 1e99 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
        ("nan.obj", "v nan 0 0\n"),
        ("turned.obj", &format!("{pair}f 1 2 3\nf 1 2 4\n")),
        ("fans.obj", &format!("{pair}v 5 5 5\nf 1 2 3\nf 1 4 5\n")),
        ("triangle.obj", &format!("{pair}f 1 2 3\n")),
        ("ok.json", "[[0, 0.5, 0.5]]"),
        ("face.json", "[[6, 0.5, 0.5]]"),
        ("outside.json", "[[0, 0.5, 0.5], [0, 1.5, 0.5]]"),
        ("short.json", "[[0, 0.5]]"),
        ("both.json", r#"[{"face": 0, "quad": 0, "u": 0, "v": 0}]"#),
        ("corner.json", r#"{"samples": [{"face": 0, "corner": 3, "u": 0, "v": 0}]}"#),
        ("quad.json", r#"[{"quad": 99, "u": 0, "v": 0}]"#),
        ("torn.json", "[[0, 0.5"),
    ]);
    let refused = |says: &str, arguments: &[&str]| folder.refused(says, arguments);
    refused("empty.obj: the cage has no faces", &["empty.obj", "-o", "x.obj"]);
    refused("index.obj: line 2: there is no position 2", &["index.obj", "-o", "x.obj"]);
    refused("huge.obj: vertex 0 has a coordinate", &["huge.obj", "-o", "x.obj"]);
    refused("nan.obj: line 1", &["nan.obj", "-o", "x.obj"]);
    refused("turned.obj: faces 0 and 1 run in the same direction", &["turned.obj", "-o", "x.obj"]);
    refused("fans.obj: the faces at vertex 0 form more than one fan", &["fans.obj", "-o", "x.obj"]);
    refused("face 0 has 3 corners: without a split", &["triangle.obj", "-o", "x.obj", "--split", "none"]);
    refused("missing.obj", &["missing.obj", "-o", "x.obj"]);
    refused("cannot both go to standard output", &["cube.obj", "-o", "-", "--json"]);
    refused("a Hermite blend of order 0", &["cube.obj", "-o", "x.obj", "--blend", "hermite:0"]);
    refused("it is hermite:K, bump, bump:K or erbs", &["cube.obj", "-o", "x.obj", "--blend", "eta"]);
    refused("it is rational or smooth", &["cube.obj", "-o", "x.obj", "--map", "bilinear"]);
    refused("resolution", &["cube.obj", "-o", "x.obj", "--resolution", "0"]);
    refused("--out", &["cube.obj"]);
    let samples = |says: &str, file: &str| refused(says, &["cube.obj", "--samples", file]);
    samples("face.json: [0]: there is no face 6: there are 6", "face.json");
    samples("outside.json: [1]: the parameters (1.5, 0.5) lie outside", "outside.json");
    samples("[0]: a list of face, u and v is expected", "short.json");
    samples("[0]: one of `face`, `face` with `corner`, or `quad`", "both.json");
    samples("samples[0]: face 0 was not divided", "corner.json");
    samples("[0]: quad 99 does not exist: there are 6", "quad.json");
    samples("torn.json: EOF", "torn.json");
    refused("face 0 has no corner 3", &["triangle.obj", "--samples", "corner.json"]);
    refused("face 0 has 3 corners and was divided", &["triangle.obj", "--samples", "ok.json"]);
}
