//! The command line: files in, files out, exit status 2 and the place for bad input.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use std::process::{Command, Output};

fn ductile(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ductile")).args(arguments).output().unwrap()
}

const DISC: &str = r#"{ "ductile": 1, "name": "Raised disc", "spacing": 0.1,
  "points": { "1": [1, 0, 0], "2": [-0.5, 0.866, 0], "3": [-0.5, -0.866, 0], "4": [0, 0, 0.5] },
  "curves": { "1": { "through": [1, 2, 3], "closed": true } },
  "surfaces": { "1": { "skeleton": { "vertices": [1, 2, 3, 4], "triangles": [[0, 1, 3], [1, 2, 3], [2, 0, 3]],
    "curves": [{ "curve": 1, "along": [0, 1, 2] }] } } } }"#;

#[test]
fn solve_writes_the_mesh_and_reports_its_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let [spec, out] = ["disc.ductile.json", "disc.obj"].map(|name| folder.path().join(name));
    std::fs::write(&spec, DISC).unwrap();
    let run = ductile(&["solve", spec.to_str().unwrap(), "-o", out.to_str().unwrap(), "--report", "json"]);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let report: serde_json::Value = serde_json::from_slice(&run.stdout).unwrap();
    assert_eq!(report["at_rest"], true);
    assert_eq!(report["surfaces"][0]["euler_characteristic"], 1);
    assert_eq!(report["surfaces"][0]["boundaries"], 1);
    assert_eq!(report["surfaces"][0]["orientable"], true);
    assert!((3.0..3.8).contains(&report["energy"].as_f64().unwrap()), "{report}");
    let obj = std::fs::read_to_string(out).unwrap();
    let count = |prefix: &str| obj.lines().filter(|line| line.starts_with(prefix)).count();
    assert_eq!(count("v "), usize::try_from(report["surfaces"][0]["vertices"].as_u64().unwrap()).unwrap());
    assert_eq!(count("f "), usize::try_from(report["surfaces"][0]["triangles"].as_u64().unwrap()).unwrap());
    assert_eq!(count("v "), count("vn "));
}

#[test]
fn link_and_unlink_are_inverse() {
    let folder = tempfile::tempdir().unwrap();
    let spec = folder.path().join("disc.json");
    std::fs::write(&spec, DISC).unwrap();
    let link = ductile(&["link", spec.to_str().unwrap(), "--base", "https://example.org/"]);
    assert!(link.status.success());
    let link = String::from_utf8(link.stdout).unwrap();
    assert!(link.starts_with("https://example.org/#d1="), "{link}");
    let text = ductile(&["unlink", link.trim()]);
    assert!(text.status.success());
    let text = String::from_utf8(text.stdout).unwrap();
    assert_eq!(ductile_spec::from_text(&text).unwrap(), ductile_spec::from_text(DISC).unwrap());
}

#[test]
fn bad_input_names_file_and_place_and_exits_with_2() {
    let folder = tempfile::tempdir().unwrap();
    let bad = folder.path().join("bad.json");
    std::fs::write(&bad, "{\"ductile\": 1,\n \"points\": {\"1\": [0, 0]}}").unwrap();
    let missing = folder.path().join("missing.json");
    for (arguments, says) in [
        (vec!["check", bad.to_str().unwrap()], "bad.json: not a Ductile document: invalid length 2"),
        (vec!["check", bad.to_str().unwrap()], "line 2"),
        (vec!["solve", missing.to_str().unwrap(), "-o", "x.obj"], "missing.json"),
        (vec!["unlink", "https://example.org/#d1=AAAA"], "damaged"),
        (vec!["frobnicate"], "unrecognized subcommand"),
    ] {
        let run = ductile(&arguments);
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(says), "{arguments:?}: {said}");
    }
}

#[test]
fn check_describes_what_a_document_specifies() {
    let folder = tempfile::tempdir().unwrap();
    let spec = folder.path().join("disc.json");
    std::fs::write(&spec, DISC).unwrap();
    let run = ductile(&["check", spec.to_str().unwrap()]);
    let said = String::from_utf8(run.stdout).unwrap();
    assert!(said.contains("Raised disc: 4 points, 1 curves, 1 surfaces"), "{said}");
    assert!(said.contains("Euler characteristic 1, 1 boundaries, genus 0, orientable"), "{said}");
}
