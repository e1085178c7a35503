//! `ductile dehydrate`: the least mesh of a model, and what it grows to again.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use std::process::{Command, Output};

/// A disc with a closed curve inside, which is raised.
const HAT: &str = r#"{"ductile":1,"spacing":0.2,
"points":{"1":[1,1,0],"2":[-1,1,0],"3":[-1,-1,0],"4":[1,-1,0],
          "5":[0.5,0.5,0.3],"6":[-0.5,0.5,0.3],"7":[-0.5,-0.5,0.3],"8":[0.5,-0.5,0.3]},
"curves":{"1":{"through":[1,2,3,4],"closed":true},"2":{"through":[5,6,7,8],"closed":true}},
"surfaces":{"1":{"skeleton":{"vertices":[1,2,3,4,5,6,7,8],
 "triangles":[[0,1,5],[0,5,4],[1,2,6],[1,6,5],[2,3,7],[2,7,6],[3,0,4],[3,4,7],[4,5,6],[4,6,7]],
 "curves":[{"curve":1,"along":[0,1,2,3]},{"curve":2,"along":[4,5,6,7]}]}}}}"#;

fn ductile(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ductile")).args(arguments).output().unwrap()
}

fn count(text: &str, kind: &str) -> usize {
    text.lines().filter(|line| line.split(' ').next() == Some(kind)).count()
}

#[test]
fn what_is_left_are_the_control_points_and_it_grows_again() {
    let folder = tempfile::tempdir().unwrap();
    let [spec, obj, grown, json] =
        ["hat.ductile.json", "least.obj", "grown.obj", "least.json"].map(|name| folder.path().join(name));
    std::fs::write(&spec, HAT).unwrap();
    let [spec, obj, grown, json] = [&spec, &obj, &grown, &json].map(|path| path.to_str().unwrap());
    let output = ductile(&["dehydrate", spec, "-o", obj, "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let figures: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let figures = &figures[0];
    assert_eq!(figures["least"], serde_json::json!({"vertices": 8, "triangles": 10}));
    assert_eq!((&figures["control_points"], &figures["curves"]), (&8.into(), &2.into()));
    assert_eq!((&figures["euler_characteristic"], &figures["same_topology"]), (&1.into(), &true.into()));
    assert!(figures["before"]["vertices"].as_u64().unwrap() > 100);
    let text = std::fs::read_to_string(obj).unwrap();
    assert_eq!(["v", "f", "l"].map(|kind| count(&text, kind)), [8, 10, 2]);
    assert!(text.contains("v 0.5 0.5 0.3\n"));

    // The document of the least mesh grows to the same shape; at half the edge length to about four times the triangles.
    let output = ductile(&["dehydrate", spec, "-o", json]);
    assert!(output.status.success());
    assert!(
        String::from_utf8_lossy(&output.stdout).starts_with("surface 1: 8 vertices and 10 triangles of ")
    );
    let output = ductile(&["dehydrate", json, "--to", "0.1", "-o", grown, "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let again: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let triangles = |count: &serde_json::Value| count["triangles"].as_f64().unwrap();
    let growth = triangles(&again[0]["grown"]) / triangles(&figures["before"]);
    assert!((3.0..5.5).contains(&growth), "{growth}");
    assert_eq!(again[0]["same_topology"], true);
    assert!(count(&std::fs::read_to_string(grown).unwrap(), "f") > 1000);
}

#[test]
fn what_cannot_be_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let spec = folder.path().join("hat.ductile.json");
    std::fs::write(&spec, HAT).unwrap();
    let spec = spec.to_str().unwrap();
    for (more, why) in [
        (&["-o", "-", "--json"][..], "both"),
        (&["-o", "-", "--to", "0"], "above 0"),
        (&["-o", "-", "--to", "NaN"], "above 0"),
    ] {
        let arguments: Vec<&str> = ["dehydrate", spec].iter().chain(more).copied().collect();
        let output = ductile(&arguments);
        assert_eq!(output.status.code(), Some(2));
        assert!(String::from_utf8_lossy(&output.stderr).contains(why));
    }
    assert_eq!(ductile(&["dehydrate", "nowhere.json", "-o", "-"]).status.code(), Some(2));
}
