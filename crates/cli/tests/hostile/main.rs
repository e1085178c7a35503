//! Hostile files at every command that takes one: exit status 2 and a reason on standard error, or 1 where a reference
//! file is not verified; never a crash (which would be 101 or a signal), never a mesh.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

mod commands;

use std::process::Command;

const DISC: &str = r#"{ "ductile": 1, "spacing": 0.3,
  "points": { "1": [1, 0, 0], "2": [-0.5, 0.866, 0], "3": [-0.5, -0.866, 0], "4": [0, 0, 0.5] },
  "curves": { "1": { "through": [1, 2, 3], "closed": true } },
  "surfaces": { "1": { "skeleton": { "vertices": [1, 2, 3, 4], "triangles": [[0, 1, 3], [1, 2, 3], [2, 0, 3]],
    "curves": [{ "curve": 1, "along": [0, 1, 2] }] } } } }"#;

const SPHERE: &str = r#"{ "meshes": [{ "name": "m", "vertices": [[1,0,0],[0,1,0],[-1,0,0],[0,-1,0],[0,0,1],[0,0,-1]],
  "triangles": [[0,1,4],[1,2,4],[2,3,4],[3,0,4],[1,0,5],[2,1,5],[3,2,5],[0,3,5]], "energy": 25.0, "node_checks": [] }] }"#;

/// Exit status and what was said of it.
fn run(arguments: &[&str]) -> (Option<i32>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_ductile")).args(arguments).output().unwrap();
    (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn hostile_specifications_are_refused_by_all_that_take_one() {
    let folder = tempfile::tempdir().unwrap();
    let [spec, out, script] = ["spec.json", "out.obj", "script.json"].map(|name| folder.path().join(name));
    let (spec_name, out_name) = (spec.to_str().unwrap(), out.to_str().unwrap());
    std::fs::write(&script, "[\"rest\"]").unwrap();
    let script_name = script.to_str().unwrap();
    let change = |from: &str, to: &str| {
        assert!(DISC.contains(from), "{from}");
        DISC.replace(from, to)
    };
    for (name, text) in [
        ("nothing", String::new()),
        ("no document", "[[[[".repeat(100_000)),
        ("not a number", change("[0, 0, 0.5]", "[0, NaN, 0.5]")),
        ("a number beyond numbers", change("[0, 0, 0.5]", "[0, 1e999, 0.5]")),
        ("scale 1e150", change("[0, 0, 0.5]", "[0, 1e150, 0.5]")),
        (
            "all points equal",
            change("[-0.5, 0.866, 0]", "[1, 0, 0]").replace("[-0.5, -0.866, 0]", "[1, 0, 0]"),
        ),
        ("duplicate point", change("[-0.5, 0.866, 0]", "[1, 0, 0]")),
        ("index out of range", change("[2, 0, 3]", "[2, 0, 4294967295]")),
        ("index beyond u32", change("[2, 0, 3]", "[2, 0, 99999999999]")),
        ("negative index", change("[2, 0, 3]", "[2, 0, -1]")),
        ("repeated corner", change("[2, 0, 3]", "[2, 2, 3]")),
        ("duplicate face", change("[2, 0, 3]", "[2, 0, 3], [0, 2, 3]")),
        (
            "non-manifold edge",
            change("[2, 0, 3]", "[2, 0, 3], [0, 3, 4]")
                .replace("[1, 2, 3, 4], \"tri", "[1, 2, 3, 4, [2, 2, 2]], \"tri"),
        ),
        ("a spacing far too fine", change("0.3", "1e-12")),
    ] {
        std::fs::write(&spec, &text).unwrap();
        for arguments in [
            vec!["check", spec_name],
            vec!["solve", spec_name, "-o", out_name],
            vec!["seams", spec_name],
            vec!["dehydrate", spec_name, "-o", out_name],
            vec!["run", script_name, "--from", spec_name, "--obj", out_name],
        ] {
            let (status, said) = run(&arguments);
            assert_eq!(status, Some(2), "{name}, {arguments:?}: {said}");
            assert!(said.starts_with("ductile: ") && said.contains("spec.json"), "{name}: {said}");
            assert!(!out.exists(), "{name}");
        }
    }
    // A flipped face is none of this.
    std::fs::write(&spec, change("[2, 0, 3]", "[0, 2, 3]")).unwrap();
    assert_eq!(run(&["solve", spec_name, "-o", out_name]).0, Some(0));
}

#[test]
fn hostile_reference_files_are_never_verified() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("reference.json");
    let change = |from: &str, to: &str| {
        assert!(SPHERE.contains(from), "{from}");
        SPHERE.replacen(from, to, 1)
    };
    for (name, text) in [
        ("nothing", String::new()),
        ("no format known", "{}".into()),
        ("not the energy of this mesh", SPHERE.into()),
        ("index out of range", change("[0,1,4]", "[0,1,7]")),
        ("repeated corner", change("[0,1,4]", "[0,1,1]")),
        ("non-manifold edge", change("[0,1,4]", "[0,1,4],[0,1,2]")),
        ("a number beyond numbers", change("[1,0,0]", "[1e999,0,0]")),
        ("scale 1e150", change("[1,0,0]", "[1e150,0,0]")),
        (
            "all points equal",
            change("[0,1,0]", "[1,0,0]")
                .replace("[-1,0,0]", "[1,0,0]")
                .replace("[0,-1,0]", "[1,0,0]")
                .replace("[0,0,1]", "[1,0,0]")
                .replace("[0,0,-1]", "[1,0,0]"),
        ),
        ("an energy that is none", change("25.0", "null")),
    ] {
        std::fs::write(&file, text).unwrap();
        let (status, said) = run(&["verify", file.to_str().unwrap()]);
        assert!(matches!(status, Some(1 | 2)), "{name}: {status:?} {said}");
    }
}
