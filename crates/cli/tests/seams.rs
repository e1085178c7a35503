//! `ductile seams`, and the acts that fill loops of curves from a script.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use std::path::Path;
use std::process::{Command, Output};

/// Two squares of arcs with one arc in common.
const LADDER: &str = r#"[
  {"curve": {"through": [{"place": [0, 0, 0]}, {"place": [0.5, 0, 0.1]}, {"place": [1, 0, 0]}], "closed": false}},
  {"curve": {"through": [{"point": 3}, {"place": [1, 0.5, 0.2]}, {"place": [1, 1, 0.1]}], "closed": false}},
  {"curve": {"through": [{"point": 5}, {"place": [0.5, 1, 0.2]}, {"place": [0, 1, 0]}], "closed": false}},
  {"curve": {"through": [{"point": 7}, {"place": [0, 0.5, 0.1]}, {"point": 1}], "closed": false}},
  {"curve": {"through": [{"point": 3}, {"place": [1.5, -0.1, 0.1]}, {"place": [2, 0, -0.2]}], "closed": false}},
  {"curve": {"through": [{"point": 10}, {"place": [2.1, 0.5, -0.1]}, {"place": [2, 1, -0.1]}], "closed": false}},
  {"curve": {"through": [{"point": 12}, {"place": [1.5, 1.1, 0.1]}, {"point": 5}], "closed": false}},
  FILL, "rest"
]"#;

fn ductile(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ductile")).args(arguments).output().unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// Runs the script with these acts; returns its report, and the seams of what it made.
fn filled(folder: &Path, acts: &str) -> (serde_json::Value, serde_json::Value) {
    let [script, spec] = ["script.json", "spec.ductile.json"].map(|name| folder.join(name));
    std::fs::write(&script, LADDER.replace("FILL", acts)).unwrap();
    let [script, spec] = [script.to_str().unwrap(), spec.to_str().unwrap()];
    let run = ductile(&["run", script, "-o", spec, "--json"]);
    assert!(run.status.success(), "{}", said(&run));
    let seams = ductile(&["seams", spec, "--json"]);
    assert!(seams.status.success(), "{}", said(&seams));
    let lines = ductile(&["seams", spec]);
    assert!(String::from_utf8_lossy(&lines.stdout).contains("along curve 2 from point 3 to point 5"));
    let read = |output: &Output| serde_json::from_slice(&output.stdout).unwrap();
    (read(&run), read(&seams))
}

#[test]
fn a_network_is_filled_and_its_seam_is_smooth_and_tight() {
    let folder = tempfile::tempdir().unwrap();
    let (run, seams) = filled(folder.path(), r#"{"fill-network": {}}"#);
    assert_eq!(run["acts"][7]["made"], serde_json::json!({"surfaces": [1, 2]}));
    let [seam] = &seams["seams"].as_array().unwrap()[..] else { panic!("{seams}") };
    assert_eq!((&seam["curve"], &seam["surfaces"]), (&2.into(), &serde_json::json!([1, 2])));
    let figure = |name: &str| seam[name].as_f64().unwrap();
    assert!(figure("gap") < 1e-12 && figure("angle") < 0.01, "{seam}");
    assert_eq!(seams["fills"].as_array().unwrap().len(), 2);
}

#[test]
fn the_second_of_two_fills_takes_the_planes_of_the_first() {
    let folder = tempfile::tempdir().unwrap();
    let acts = r#"{"fill": {"hole": {"near": {"curve": 1}}}}, "rest",
                  {"fill": {"hole": {"near": {"curve": 6}}}}"#;
    let (_, seams) = filled(folder.path(), acts);
    let seam = &seams["seams"][0];
    assert!(seam["gap"].as_f64().unwrap() < 1e-12 && seam["angle"].as_f64().unwrap() < 0.01, "{seam}");
    // Side by side and up to the curves only, nothing makes them agree.
    let acts = r#"{"fill": {"hole": {"near": {"curve": 1}}, "style": {"join": "position"}}},
                  {"fill": {"hole": {"near": {"curve": 6}}, "style": {"join": "position"}}}"#;
    let (_, seams) = filled(folder.path(), acts);
    let seam = &seams["seams"][0];
    assert!(seam["gap"].as_f64().unwrap() < 1e-12 && seam["angle"].as_f64().unwrap() > 0.5, "{seam}");
}
