//! `ductile displace`: feet are met to the bit, borders stay, and what is wrong is named.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use serde_json::{Value, json};
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// A square of eight by eight cells; vertex `9 j + i` lies at `(i / 8, j / 8)`.
fn square() -> String {
    let mut text = String::from("# a square, and a vertex that nothing uses\n");
    for j in 0..9 {
        for i in 0..9 {
            text += &format!("v {} {} 0.1\n", f64::from(i) / 8.0, f64::from(j) / 8.0);
        }
    }
    for j in 0..8 {
        for i in 0..8 {
            let at = |i: i32, j: i32| 9 * j + i + 1;
            text += &format!("f {} {} {} {}\n", at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
    }
    text + "v 7 7 7\n"
}

fn tetrahedron() -> String {
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n".into()
}

struct Done {
    status: i32,
    said: String,
    folder: TempDir,
}

impl Done {
    fn out(&self) -> Vec<[f64; 3]> {
        let text = fs::read_to_string(self.folder.path().join("out.obj")).unwrap();
        let vertices = text.lines().filter_map(|line| line.strip_prefix("v "));
        vertices
            .map(|line| {
                let numbers: Vec<f64> = line.split(' ').map(|x| x.parse().unwrap()).collect();
                numbers.try_into().unwrap()
            })
            .collect()
    }

    fn report(&self) -> Value {
        serde_json::from_str(self.said.split("ductile:").next().unwrap()).expect(&self.said)
    }
}

fn run_text(mesh: &str, edits: &str) -> Done {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    fs::write(file("mesh.obj"), mesh).unwrap();
    fs::write(file("edits.json"), edits).unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_ductile"));
    command.current_dir(&folder).args(["displace", "mesh.obj", "edits.json", "-o", "out.obj", "--json"]);
    let output = command.output().unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    Done { status: output.status.code().unwrap(), said, folder }
}

fn run(mesh: &str, edits: &Value) -> Done {
    run_text(mesh, &edits.to_string())
}

#[test]
fn feet_are_met_and_the_border_stays() {
    let edits = json!({"feet": [
        {"vertex": 40, "displacement": [0.1, 0.2, 0.3], "range": 0.3},
        {"vertex": 24, "size": 0.2},
        {"point": [0.76, 0.12, 0.0], "displacement": [0, 0, -0.125]},
    ]});
    let done = run(&square(), &edits);
    assert_eq!(done.status, 0, "{}", done.said);
    let (out, report) = (done.out(), done.report());
    assert_eq!((out.len(), report["triangles"].as_u64(), report["held"].as_u64()), (82, Some(128), Some(32)));
    assert_eq!(out[40], [0.5 + 0.1, 0.5 + 0.2, 0.1 + 0.3]);
    assert_eq!(out[24], [0.75, 0.25, 0.1], "a fixed point");
    assert_eq!(report["items"][2]["vertices"], json!([15]), "{}", done.said);
    assert_eq!(out[15], [0.75, 0.125, 0.1 - 0.125]);
    for (vertex, place) in out.iter().enumerate().take(81) {
        let (i, j) = (vertex % 9, vertex / 9);
        let is_border = i % 8 == 0 || j % 8 == 0;
        assert!(!is_border || *place == [i as f64 / 8.0, j as f64 / 8.0, 0.1], "{vertex}");
    }
    assert_eq!(out[81], [7.0, 7.0, 7.0]);
    let item = &report["items"][0];
    assert_eq!(item["offset"], json!([0.1, 0.2, 0.3]));
    assert_eq!(item["largest_blend"], json!(1.0));
    assert!(item["blend_beside_boundary"].as_f64().unwrap() > 1e-3);
    assert!(item["warnings"][0].as_str().unwrap().contains("beside the boundary"));
    assert!(done.said.contains("ductile: item 0: the blend is"), "{}", done.said);
}

#[test]
fn a_point_can_have_a_vertex_of_its_own() {
    let edits = json!({"split": true, "feet": [{"point": [0.55, 0.52, 3.0], "displacement": [0, 0, 1]}]});
    let done = run(&square(), &edits);
    assert_eq!(done.status, 0, "{}", done.said);
    let out = done.out();
    assert_eq!(out.len(), 83);
    let report = done.report();
    assert_eq!((&report["items"][0]["vertices"], &report["triangles"]), (&json!([82]), &json!(130)));
    let off = out[82].iter().zip([0.55, 0.52, 1.1]).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max);
    assert!(off < 1e-15, "{:?}", out[82]);
    assert!((report["items"][0]["distance_to_point"].as_f64().unwrap() - 2.9).abs() < 1e-14);
}

#[test]
fn all_that_the_format_says_is_obeyed() {
    let curve = json!({"curves": [{"vertices": [38, 39, 40, 41], "displacements": [[0, 0, 1], [0, 0, 2], [0, 0, 3], [0, 0, 4]]}]});
    let done = run(&square(), &curve);
    assert_eq!(done.status, 0, "{}", done.said);
    let heights: Vec<f64> = (38..42).map(|v| done.out()[v][2]).collect();
    assert_eq!(heights, [1.1, 2.1, 3.1, 4.1]);
    let ring = json!({"curves": [{"vertices": [30, 31, 32, 41, 50, 49, 48, 39], "closed": true, "displacement": [0, 0, 1]}]});
    let done = run(&square(), &ring);
    assert!(done.status == 0 && done.out()[40][2] == 1.1, "a plateau within: {}", done.said);

    // Each choice changes the surface, and none of them the foot.
    let base = json!({"feet": [
        {"vertex": 40, "displacement": [0, 0, 1]},
        {"vertex": 21, "displacement": [0, 0, 0.5]},
    ]});
    let plain = run(&square(), &base).out();
    for (field, value) in [
        ("profile", json!("harmonic")),
        ("combination", json!("plain")),
        ("combination", json!("gram")),
        ("combination", json!("cardinal")),
        ("blend", json!({"bump": 2})),
        ("blend", json!({"eta": 0.1})),
        ("pins", json!([60, 61, 62])),
        ("laplacian", json!("cotangent")),
    ] {
        let mut edits = base.clone();
        edits[field] = value.clone();
        let done = run(&square(), &edits);
        assert_eq!(done.status, 0, "{value}: {}", done.said);
        let far = |(a, b): (&[f64; 3], &[f64; 3])| (a[2] - b[2]).abs();
        let difference = done.out().iter().zip(&plain).map(far).fold(0.0, f64::max);
        // On right angles both Laplacians are the same but for rounding.
        assert!(
            (difference > 1e-3) == (field != "laplacian") && (difference < 1e-12 || field != "laplacian"),
            "{value}"
        );
        assert!(value == "plain" || (done.out()[40][2] - 1.1).abs() < 1e-13, "{value}");
    }
    let list = run(&square(), &base["feet"]);
    assert_eq!(list.out(), plain, "a list is a list of feet");
    let along =
        json!([{"vertex": 40, "displacement": [0, 0, 1], "direction": {"along": [1, 0, 0], "stretch": 3}}]);
    let out = run(&square(), &along).out();
    assert!(out[42][2] > out[58][2] + 0.1, "{} and {}", out[42][2], out[58][2]);
    let closed =
        run(&tetrahedron(), &json!({"pins": [0], "feet": [{"vertex": 3, "displacement": [1, 1, 1]}]}));
    assert_eq!((closed.out()[3], closed.out()[0]), ([1.0, 1.0, 2.0], [0.0; 3]));
    assert_eq!(run(&square(), &json!([])).out()[40], [0.5, 0.5, 0.1]);
}

#[test]
fn what_is_wrong_with_the_edits_is_named() {
    let foot = |foot: Value| json!({"feet": [foot]});
    let refusals = [
        (foot(json!({"vertex": 82})), "feet[0]: there is no vertex 82: there are 82"),
        (foot(json!({"vertex": 3})), "feet[0]: vertex 3 is held"),
        (foot(json!({"vertex": 81})), "feet[0]: vertex 81 is held in its place, or no triangle uses it"),
        (foot(json!({})), "feet[0]: either `vertex` or `point`"),
        (foot(json!({"vertex": 40, "point": [0, 0, 0]})), "feet[0]: either `vertex` or `point`"),
        (foot(json!({"vertex": 40, "range": 1.0})), "feet[0]: the range 1 is not"),
        (foot(json!({"vertex": 40, "size": 1.5})), "feet[0]: the size 1.5 is not"),
        (foot(json!({"vertex": 40, "size": 0.5, "range": 0.5})), "not both"),
        (foot(json!({"vertex": 40, "displacement": [1e200, 0, 0]})), "feet[0]: a displacement of item 0"),
        (foot(json!({"vertex": 40, "displacement": [1, 0]})), "edits.json: invalid length 2"),
        (foot(json!({"vertex": -1})), "edits.json: invalid value: integer `-1`"),
        (foot(json!({"vertex": 40, "radius": 1})), "edits.json: unknown field `radius`"),
        (foot(json!({"point": [1e200, 0, 0]})), "feet[0]"),
        (foot(json!({"vertex": 40, "direction": {"along": [0, 0, 0], "stretch": 2}})), "must have a length"),
        (
            foot(json!({"vertex": 40, "direction": {"along": [1, 0, 0], "stretch": 1e9}})),
            "the stretch 1000000000",
        ),
        (json!([{"vertex": 40}, {"vertex": 40}]), "feet[1]: items 0 and 1 touch at vertex 40"),
        (json!({"blend": {"eta": 0.5}}), "the margin 0.5 of an eta blend"),
        (json!({"blend": {"bump": 0}}), "the exponent 0 of a bump"),
        (json!({"blend": "smooth"}), "unknown variant `smooth`"),
        (json!({"pins": [99]}), "there is no vertex 99"),
        (json!({"curves": [{"vertices": [38, 41]}]}), "curves[0]: no edge joins the vertices 38 and 41"),
        (json!({"curves": [{"vertices": [38]}]}), "curves[0]: a curve needs two vertices"),
        (
            json!({"curves": [{"vertices": [38, 39, 38]}]}),
            "curves[0]: the curve goes through vertex 38 twice",
        ),
        (json!({"combination": "gram", "curves": [{"vertices": [38, 39]}]}), "curves[0]: item 0 is a curve"),
        (json!("feet"), "edits.json: invalid type"),
    ];
    for (edits, says) in refusals {
        let done = run(&square(), &edits);
        assert!(done.status == 2 && done.said.contains(says), "{edits}: {}", done.said);
        assert!(!done.folder.path().join("out.obj").exists(), "{edits}: something was written");
    }
    let text = run_text(&square(), "{\"feet\": [{\"vertex\": 40, \"range\": NaN}]}");
    assert!(
        text.status == 2 && text.said.contains("edits.json: ") && text.said.contains("line 1"),
        "{}",
        text.said
    );
}

#[test]
fn what_is_wrong_with_the_mesh_is_named() {
    let closed = run(&tetrahedron(), &json!([{"vertex": 3}]));
    assert!(closed.status == 2 && closed.said.contains("neither boundary nor pin"), "{}", closed.said);
    for (mesh, says) in [
        ("v 0 0 0\nf 1 2 3\n", "mesh.obj: line 2: there is no position 2"),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", "mesh.obj: triangle 0 uses one vertex twice"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 2 3\nf 1 2 4\nf 1 2 5\n",
            "mesh.obj: more than two triangles",
        ),
        ("v 0 0 nan\n", "mesh.obj: line 1"),
        ("v 1e300 0 0\n", "mesh.obj: vertex 0 has a coordinate"),
        ("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "triangle 0 has no area"),
    ] {
        let done = run(mesh, &json!([]));
        assert!(done.status == 2 && done.said.contains(says), "{mesh}: {}", done.said);
    }
    let done = run("", &json!([]));
    assert_eq!(done.status, 0, "no mesh is an empty mesh: {}", done.said);
    let both =
        Command::new(env!("CARGO_BIN_EXE_ductile")).args(["displace", "-", "-", "-o", "x"]).output().unwrap();
    assert_eq!(both.status.code(), Some(2));
    assert!(!Path::new("x").exists());
}
