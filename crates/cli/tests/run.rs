//! `ductile run`: scripts of acts, what they make, and where they stop.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use std::path::Path;
use std::process::{Command, Output};

/// A closed curve, its sheet, a place pulled up.
const HILL: &str = r#"[
  {"curve": {"through": [{"place": [1, 0, 0]}, {"place": [0, 1, 0]}, {"place": [-1, 0, 0]}, {"place": [0, -1, 0]}], "closed": true}},
  {"sheet": {"boundary": 1}},
  {"spacing": {"of": "document", "spacing": 0.15}},
  {"pin": {"surface": 1, "at": [0, 0, 0]}},
  {"move": {"point": 5, "to": [0, 0, 0.5]}},
  "rest"
]"#;

fn run(folder: &Path, script: &str, more: &[&str]) -> Output {
    let file = folder.join("script.json");
    std::fs::write(&file, script).unwrap();
    let arguments = ["run", file.to_str().unwrap()].into_iter().chain(more.iter().copied());
    Command::new(env!("CARGO_BIN_EXE_ductile")).args(arguments).output().unwrap()
}

fn json(output: &Output) -> serde_json::Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_script_makes_a_document_a_mesh_and_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let [spec, obj] = ["hill.ductile.json", "hill.obj"].map(|name| folder.path().join(name));
    let (spec, obj) = (spec.to_str().unwrap(), obj.to_str().unwrap());
    let done = run(folder.path(), HILL, &["-o", spec, "--obj", obj, "--json"]);
    assert!(done.status.success(), "{}", said(&done));
    let report = json(&done);
    assert_eq!(report["acts"][0]["made"], serde_json::json!({"points": [1, 2, 3, 4], "curves": [1]}));
    assert_eq!(report["acts"][1]["made"], serde_json::json!({"surfaces": [1]}));
    assert!(report["acts"][5]["steps"].as_u64().unwrap() > 0);
    assert_eq!((&report["at_rest"], &report["refused"]), (&true.into(), &serde_json::Value::Null));
    assert!(report["energy"].as_f64().unwrap() > 1.0);
    assert_eq!(report["surfaces"][0]["euler_characteristic"], 1);
    let document = ductile_spec::from_text(&std::fs::read_to_string(spec).unwrap()).unwrap();
    assert_eq!((document.points.len(), document.curves.len(), document.surfaces.len()), (5, 1, 1));
    assert!(std::fs::read_to_string(obj).unwrap().lines().any(|line| line.starts_with("f ")));

    // The document goes on where it stopped, and an act taken back leaves no trace.
    let more = r#"[{"release": {"point": 5}}, "undo", "redo", "undo"]"#;
    let again = run(folder.path(), more, &["--from", spec, "-o", "-"]);
    assert!(again.status.success(), "{}", said(&again));
    assert_eq!(ductile_spec::from_text(&String::from_utf8(again.stdout).unwrap()).unwrap(), document);
}

#[test]
fn the_first_refusal_ends_a_script_and_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let spec = folder.path().join("none.ductile.json");
    let script =
        r#"[{"point": {"at": [0, 0, 0]}}, {"sheet": {"boundary": 7}}, {"point": {"at": [1, 0, 0]}}]"#;
    let stopped = run(folder.path(), script, &["-o", spec.to_str().unwrap(), "--json"]);
    assert_eq!(stopped.status.code(), Some(1));
    assert!(said(&stopped).contains("act 2 (sheet): curve 7 does not exist"), "{}", said(&stopped));
    let report = json(&stopped);
    assert_eq!((&report["refused"], report["acts"].as_array().unwrap().len()), (&2.into(), 2));
    assert!(!spec.exists(), "nothing is written of what was not done");
}

#[test]
fn what_does_not_come_to_rest_in_time_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let stopped = run(folder.path(), HILL, &["--steps", "1"]);
    assert_eq!(stopped.status.code(), Some(1));
    assert!(said(&stopped).contains("act 6 (rest): not at rest after 1 steps"), "{}", said(&stopped));
}

#[test]
fn a_text_that_is_no_script_is_bad_input() {
    let folder = tempfile::tempdir().unwrap();
    for (script, says) in
        [("{", "not JSON"), ("[\"hurry\"]", "act 1 is none"), ("[{\"sheet\": 1}]", "act 1 is none")]
    {
        let refused = run(folder.path(), script, &[]);
        assert_eq!(refused.status.code(), Some(2));
        assert!(
            said(&refused).contains("script.json: ") && said(&refused).contains(says),
            "{}",
            said(&refused)
        );
    }
    let both = run(folder.path(), "[]", &["--json", "-o", "-"]);
    assert_eq!(both.status.code(), Some(2));
}

/// The acts that a text shows between backquotes.
fn acts_in(text: &str) -> Vec<&str> {
    text.split('`').filter(|part| part.starts_with("{\"") && !part.contains("\"at\": [x")).collect()
}

#[test]
fn every_act_of_the_user_guide_is_understood() {
    let guide = include_str!("../../../docs/user-guide.md");
    let mut acts = acts_in(guide);
    // Parts of acts, which the guide shows as well.
    acts.retain(|act| {
        !["curve\": 1}", "surface\": 1}", "region\": {\"surf", "cross"]
            .iter()
            .any(|part| act[2..].starts_with(part))
    });
    assert!(acts.len() > 25, "{}", acts.len());
    for act in acts {
        let read: Result<ductile_spec::Edit, _> = serde_json::from_str(act);
        assert!(read.is_ok(), "{act}: {}", read.unwrap_err());
    }
}

/// The names of all variants of a type, as its reader lists them when it does not know one.
fn names_of<T: serde::de::DeserializeOwned>() -> Vec<String> {
    let Err(unknown) = serde_json::from_str::<T>(r#"{"no-such-name": {}}"#) else { panic!("a name is free") };
    let text = unknown.to_string();
    let (_, names) = text.split_once("expected").unwrap();
    names.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn the_user_guide_shows_every_act_and_every_way_to_name_a_hole() {
    let guide = include_str!("../../../docs/user-guide.md");
    let (acts, holes) = (names_of::<ductile_spec::Edit>(), names_of::<ductile_spec::Hole>());
    assert!(acts.len() > 45 && holes.len() > 4, "{acts:?} {holes:?}");
    for name in acts
        .iter()
        .map(|name| format!("{{\"{name}\":"))
        .chain(holes.iter().map(|name| format!("\"{name}\":")))
    {
        assert!(guide.contains(&name), "{name} is in no example of the user guide");
    }
}

#[test]
fn a_surface_is_displaced_and_the_document_says_how() {
    let folder = tempfile::tempdir().unwrap();
    let [spec, plain, pulled] =
        ["hill.ductile.json", "plain.obj", "pulled.obj"].map(|name| folder.path().join(name));
    let [spec, plain, pulled] = [&spec, &plain, &pulled].map(|file| file.to_str().unwrap());
    let done = run(folder.path(), HILL, &["-o", spec, "--obj", plain]);
    assert!(done.status.success(), "{}", said(&done));
    let script = r#"[
      {"displace": {"surface": 1, "displacement": {"foot": {"at": [0.4, 0.1, 0.3]}, "by": [0, 0, 0.5], "range": 0.3}}},
      {"displace": {"surface": 1, "displacement": {"foot": {"at": [-0.4, 0.1, 0.3]}, "by": [0, 0, 9]}}},
      {"change-displacement": {"surface": 1, "number": 2, "to": {"foot": {"at": [-0.4, 0.1, 0.3]}, "by": [0.25, 0, 0]}}},
      {"blending": {"surface": 1, "blending": {"blend": {"bump": 1}}}},
      {"erase-displacement": {"surface": 1, "number": 2}},
      "rest"
    ]"#;
    let done = run(folder.path(), script, &["--from", spec, "-o", spec, "--obj", pulled]);
    assert!(done.status.success(), "{}", said(&done));
    let document = ductile_spec::from_text(&std::fs::read_to_string(spec).unwrap()).unwrap();
    let displaced = &document.displacements[&ductile_spec::SurfaceId(1)];
    assert_eq!((displaced.items.len(), displaced.blending.blend), (1, ductile_spec::Blend::Bump(1.0)));
    let highest = |file: &str| {
        let text = std::fs::read_to_string(file).unwrap();
        let heights =
            text.lines().filter_map(|line| line.strip_prefix("v ")?.split(' ').nth(2)?.parse::<f64>().ok());
        heights.fold(0.0, f64::max)
    };
    assert!(highest(pulled) > highest(plain) + 0.2, "{} over {}", highest(pulled), highest(plain));
    let more = r#"[{"drop-displacements": {"surface": 1}}, {"drop-displacements": {"surface": 1}}]"#;
    let refused = run(folder.path(), more, &["--from", spec]);
    assert!(
        said(&refused).contains("act 2 (drop-displacements): surface 1 has no displacements"),
        "{}",
        said(&refused)
    );
}

#[test]
fn a_cage_is_laid_changed_and_written_by_a_script() {
    let folder = tempfile::tempdir().unwrap();
    let script = r#"[
      {"cage": {"from": {"built-in": {"form": "cube", "centre": [0, 0, 0], "size": 1}}}},
      {"extrude": {"surface": 1, "face": 1, "distance": 1.5}},
      {"split-edge": {"surface": 1, "ends": [1, 2]}},
      {"split-face": {"surface": 1, "face": 0}},
      {"cage-settings": {"surface": 1, "settings": {"split": "offset", "blend": {"hermite": 3}, "resolution": 4}}},
      {"shift": {"points": [9, 10], "by": [0, 0, 0.25]}},
      "rest"
    ]"#;
    let spec = folder.path().join("tower.ductile.json");
    let done = run(folder.path(), script, &["-o", spec.to_str().unwrap(), "--json"]);
    assert!(done.status.success(), "{}", said(&done));
    let report = json(&done);
    assert_eq!(report["acts"][0]["made"]["surfaces"], serde_json::json!([1]));
    assert_eq!(report["acts"][1]["made"], serde_json::json!({"points": [9, 10, 11, 12]}));
    assert_eq!(
        (&report["at_rest"], &report["surfaces"][0]["euler_characteristic"]),
        (&true.into(), &2.into())
    );
    let document = ductile_spec::from_text(&std::fs::read_to_string(&spec).unwrap()).unwrap();
    let cage = &document.cages[&ductile_spec::SurfaceId(1)];
    assert_eq!(
        (cage.settings.resolution, cage.settings.split),
        (Some(4), Some(ductile_spec::CageSplit::Offset))
    );
}

#[test]
fn files_of_polygons_are_begun_with_as_cages() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0.5\nf 1 2 3 4\n";
    let ply = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
               element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n";
    let made = [("square.obj", obj), ("square.PLY", ply)].map(|(name, text)| {
        let file = folder.path().join(name);
        std::fs::write(&file, text).unwrap();
        let done = run(folder.path(), "[]", &["--from", file.to_str().unwrap(), "-o", "-"]);
        assert!(done.status.success(), "{}", said(&done));
        ductile_spec::from_text(&String::from_utf8(done.stdout).unwrap()).unwrap()
    });
    assert_eq!((made[0].cages.len(), made[0].points.len()), (1, 4));
    assert_eq!(made[0], made[1]);
    let file = folder.path().join("bad.ply");
    std::fs::write(&file, "solid\n").unwrap();
    let refused = run(folder.path(), "[]", &["--from", file.to_str().unwrap(), "-o", "-"]);
    assert!(
        !refused.status.success() && said(&refused).contains("this is no PLY file"),
        "{}",
        said(&refused)
    );
}
