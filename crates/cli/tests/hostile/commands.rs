//! Hostile meshes, ribbons and scripts at the commands that take them: finite numbers, or a reason and no output.

use super::run;
use std::fs;
use std::path::Path;

/// What must come of an input.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Expected {
    Served,
    Refused,
}
use Expected::{Refused, Served};

/// A tetrahedron whose third vertex and faces after the first three are given.
fn tetrahedron(third: &str, faces: &str) -> String {
    format!("v 0 0 0\nv 1 0 0\n{third}\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\n{faces}")
}

fn scaled(scale: &str) -> String {
    format!("v 0 0 0\nv 1{scale} 0 0\nv 0 1{scale} 0\nv 0 0 1{scale}\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n")
}

/// Name, file, and what `cage` (as `run --as cage`), `displace` and `run --as mesh` must make of it.
fn meshes() -> Vec<(&'static str, String, [Expected; 3])> {
    let last = "f 3 1 4\n";
    let no = [Refused; 3];
    let yes = [Served; 3];
    vec![
        ("good", tetrahedron("v 0 1 0", last), yes),
        ("nothing", String::new(), no),
        ("no faces", "v 0 0 0\nv 1 0 0\nv 0 1 0\n".into(), no),
        ("zero-area face", tetrahedron("v 0.5 0 0", last), yes),
        ("duplicate vertex", tetrahedron("v 1 0 0", last), yes),
        ("sliver", tetrahedron("v 0.5 1e-12 0", last), yes),
        // A point has no metric along which a displacement could fade.
        (
            "all points equal",
            "v 1 1 1\n".repeat(4) + "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
            [Served, Refused, Served],
        ),
        ("folded", tetrahedron("v 0.9 0.1 0.9", last), yes),
        ("scale 1e150", scaled("e150"), [Refused, Served, Refused]),
        ("scale 1e-150", scaled("e-150"), yes),
        ("NaN", tetrahedron("v 0 NaN 0", last), no),
        ("a number beyond numbers", tetrahedron("v 0 1e999 0", last), no),
        ("index out of range", tetrahedron("v 0 1 0", "f 3 1 9\n"), no),
        ("index beyond u32", tetrahedron("v 0 1 0", "f 3 1 99999999999\n"), no),
        ("repeated corner", tetrahedron("v 0 1 0", "f 3 3 4\n"), no),
        ("non-manifold edge", tetrahedron("v 0 1 0\nv 5 5 5", "f 3 1 4\nf 1 2 5\n"), no),
        ("duplicate face", tetrahedron("v 0 1 0", "f 3 1 4\nf 4 3 1\n"), no),
        // The sides of a cage say where its outside is; meshes are wound alike by those who need it.
        ("flipped face", tetrahedron("v 0 1 0", "f 1 3 4\n"), [Refused, Served, Served]),
    ]
}

/// All vertices of a file, which must be numbers.
fn are_numbers(says: &str, file: &Path) {
    let text = fs::read_to_string(file).unwrap();
    let lines = text.lines().filter(|line| line.starts_with("v ") || line.starts_with("vn "));
    let mut count = 0;
    for number in lines.flat_map(|line| line.split(' ').skip(1)) {
        assert!(number.parse::<f64>().is_ok_and(f64::is_finite), "{says}: {number}");
        count += 1;
    }
    assert!(count > 0, "{says}: an empty mesh");
}

/// Runs a command that writes a mesh and looks at what came of it.
fn comes_to(says: &str, expected: Expected, arguments: &[&str], out: &Path) {
    let (status, said) = run(arguments);
    match expected {
        Served => {
            assert_eq!(status, Some(0), "{says}: {said}");
            are_numbers(says, out);
            fs::remove_file(out).unwrap();
        }
        Refused => {
            assert_eq!(status, Some(2), "{says}: {said}");
            assert!(said.starts_with("ductile: "), "{says}: {said}");
            assert!(!out.exists(), "{says}: refused, and a mesh all the same");
        }
    }
}

#[test]
fn hostile_meshes_become_surfaces_of_numbers_or_are_refused_by_cage_and_displace() {
    let folder = tempfile::tempdir().unwrap();
    let [mesh, edits, out] = ["mesh.obj", "edits.json", "out.obj"].map(|name| folder.path().join(name));
    let [mesh_name, edits_name, out_name] = [&mesh, &edits, &out].map(|path| path.to_str().unwrap());
    fs::write(&edits, r#"{"feet": [{"vertex": 0, "displacement": [0, 0, 0.1]}], "pins": [3]}"#).unwrap();
    for (name, text, [cage, displace, _]) in meshes() {
        fs::write(&mesh, text).unwrap();
        for map in ["rational", "smooth"] {
            let arguments = ["cage", mesh_name, "-o", out_name, "--resolution", "3", "--map", map];
            comes_to(&format!("cage, {map}, {name}"), cage, &arguments, &out);
        }
        let arguments = ["displace", mesh_name, edits_name, "-o", out_name];
        comes_to(&format!("displace, {name}"), displace, &arguments, &out);
    }
}

#[test]
fn hostile_edits_are_refused_by_displace() {
    let folder = tempfile::tempdir().unwrap();
    let [mesh, edits, out] = ["mesh.obj", "edits.json", "out.obj"].map(|name| folder.path().join(name));
    let [mesh_name, edits_name, out_name] = [&mesh, &edits, &out].map(|path| path.to_str().unwrap());
    fs::write(&mesh, tetrahedron("v 0 1 0", "f 3 1 4\n")).unwrap();
    fs::write(&edits, r#"{"feet": [{"vertex": 0, "displacement": [0, 0, 0.1]}], "pins": [3]}"#).unwrap();
    comes_to("good", Served, &["displace", mesh_name, edits_name, "-o", out_name], &out);
    fs::write(&edits, r#"{"feet": [{"vertex": 0, "displacement": [0, 0, 1e150]}], "pins": [3]}"#).unwrap();
    comes_to("a long way", Served, &["displace", mesh_name, edits_name, "-o", out_name], &out);
    for (name, text) in [
        ("nothing", String::new()),
        ("no edits", "[[[[".repeat(100_000)),
        (
            "a vertex out of range",
            r#"{"feet": [{"vertex": 4, "displacement": [0, 0, 1]}], "pins": [3]}"#.into(),
        ),
        (
            "a vertex beyond all",
            r#"{"feet": [{"vertex": 99999999999999999999, "displacement": [0, 0, 1]}], "pins": [3]}"#.into(),
        ),
        (
            "a way beyond numbers",
            r#"{"feet": [{"vertex": 0, "displacement": [0, 0, 1e999]}], "pins": [3]}"#.into(),
        ),
        (
            "a range of everything",
            r#"{"feet": [{"vertex": 0, "displacement": [0, 0, 1], "range": 1}], "pins": [3]}"#.into(),
        ),
        ("not a number", r#"{"feet": [{"vertex": 0, "displacement": [0, 0, NaN]}], "pins": [3]}"#.into()),
    ] {
        fs::write(&edits, text).unwrap();
        comes_to(name, Refused, &["displace", mesh_name, edits_name, "-o", out_name], &out);
    }
}

/// A flat patch of four cubic sides, with one corner of its first ribbon given.
fn ribbons(corner: &str) -> String {
    let at = |i: f64, j: f64| if i == 0.0 && j == 0.0 { corner.to_owned() } else { format!("[{i},{j},0]") };
    let rows = |of: &dyn Fn(f64, f64) -> String| {
        let row = |k: f64| [0.0, 1.0, 2.0, 3.0].map(|j| of(j, k)).join(",");
        format!(r#"{{"row0":[{}],"row1":[{}]}}"#, row(0.0), row(1.0))
    };
    let sides = [
        rows(&|j, k| at(j, k)),
        rows(&|j, k| at(3.0 - k, j)),
        rows(&|j, k| at(3.0 - j, 3.0 - k)),
        rows(&|j, k| at(k, 3.0 - j)),
    ];
    format!(r#"{{"ribbons":[{}]}}"#, sides.join(","))
}

#[test]
fn hostile_ribbons_are_filled_with_numbers_or_refused() {
    let folder = tempfile::tempdir().unwrap();
    let [file, out] = ["ribbons.json", "out.obj"].map(|name| folder.path().join(name));
    let [name_of, out_name] = [&file, &out].map(|path| path.to_str().unwrap());
    let good = ribbons("[0,0,0]");
    let equal = {
        let point = ["[1,1,1]"; 4].join(",");
        let side = format!(r#"{{"row0":[{point}],"row1":[{point}]}}"#);
        format!(r#"{{"ribbons":[{}]}}"#, [side.as_str(); 4].join(","))
    };
    for (name, expected, text) in [
        ("good", Served, good.clone()),
        ("nothing", Refused, String::new()),
        ("no ribbons", Refused, r#"{"ribbons":[]}"#.into()),
        ("nested without end", Refused, "[[[[".repeat(100_000)),
        ("all points equal", Refused, equal),
        ("not a number", Refused, ribbons("[0,NaN,0]")),
        ("a number beyond numbers", Refused, ribbons("[0,1e999,0]")),
        ("scale 1e150", Refused, ribbons("[0,1e150,0]")),
        ("two coordinates", Refused, ribbons("[0,0]")),
        ("ends that do not meet", Refused, good.replacen("[3,0,0]", "[3,9,0]", 1)),
    ] {
        fs::write(&file, text).unwrap();
        comes_to(
            &format!("fill, {name}"),
            expected,
            &["fill", name_of, "-o", out_name, "--resolution", "4"],
            &out,
        );
    }
}

#[test]
fn hostile_scripts_stop_at_the_act_that_makes_no_sense() {
    let folder = tempfile::tempdir().unwrap();
    let [script, out] = ["script.json", "out.obj"].map(|name| folder.path().join(name));
    let [script_name, out_name] = [&script, &out].map(|path| path.to_str().unwrap());
    let ring = r#"{"curve": {"through": [{"place": [1, 0, 0]}, {"place": [0, 1, 0]}, {"place": [-1, 0, 0]}], "closed": true}}"#;
    // 2: no script at all; 1: an act of it was refused.
    for (name, status, text) in [
        ("nothing", 2, String::new()),
        ("nested without end", 2, "[[[[".repeat(100_000)),
        ("no act", 2, r#"[{"melt": {"surface": 1}}]"#.into()),
        ("not a number", 2, r#"[{"point": {"at": [0, NaN, 0]}}]"#.into()),
        ("a number beyond numbers", 2, r#"[{"point": {"at": [0, 1e999, 0]}}]"#.into()),
        ("scale 1e150", 1, r#"[{"point": {"at": [0, 1e150, 0]}}]"#.into()),
        ("a curve that does not exist", 1, r#"[{"sheet": {"boundary": 4294967295}}]"#.into()),
        (
            "a curve of one place",
            1,
            r#"[{"curve": {"through": [{"place": [0,0,0]}, {"place": [0,0,0]}], "closed": false}}]"#.into(),
        ),
        (
            "a spacing of nothing",
            1,
            format!(r#"[{ring}, {{"spacing": {{"of": "document", "spacing": 0}}}}]"#),
        ),
        (
            "a spacing far too fine",
            1,
            format!(
                r#"[{ring}, {{"sheet": {{"boundary": 1}}}}, {{"spacing": {{"of": "document", "spacing": 1e-12}}}}]"#
            ),
        ),
        (
            "a merge without a radius",
            1,
            format!(
                r#"[{ring}, {{"sheet": {{"boundary": 1}}}}, {{"merge": {{"from": {{"surface": 1, "at": [0,0,0]}}, "to": {{"surface": 1, "at": [0,0,0]}}, "radius": 0, "keep": true}}}}]"#
            ),
        ),
    ] {
        fs::write(&script, text).unwrap();
        let (found, said) = run(&["run", script_name, "--obj", out_name]);
        assert_eq!(found, Some(status), "{name}: {said}");
        assert!(said.starts_with("ductile: "), "{name}: {said}");
        if out.exists() {
            are_numbers(name, &out);
            fs::remove_file(&out).unwrap();
        }
    }
    // Polygons to begin with: the same table as for a cage, and as a fixed mesh.
    let mesh = folder.path().join("mesh.obj");
    let mesh_name = mesh.to_str().unwrap();
    fs::write(&script, "[]").unwrap();
    for (name, text, [cage, _, fixed]) in meshes() {
        fs::write(&mesh, text).unwrap();
        for (kind, expected) in [("cage", cage), ("mesh", fixed)] {
            let arguments = ["run", script_name, "--from", mesh_name, "--as", kind, "--obj", out_name];
            comes_to(&format!("run --as {kind}, {name}"), expected, &arguments, &out);
        }
    }
}
