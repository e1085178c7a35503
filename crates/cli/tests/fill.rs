//! `ductile fill`: ribbons in, a mesh and exact samples out; refusals name file, side and point.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn ductile(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_ductile")).args(arguments).output().unwrap()
}

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(name)
}

fn load(name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(fixture(name)).unwrap()).unwrap()
}

/// A folder with a file of ribbons in it.
fn with_ribbons(value: &Value) -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("ribbons.json");
    fs::write(&file, value.to_string()).unwrap();
    let name = file.to_str().unwrap().to_owned();
    (folder, name)
}

fn json_of(run: &Output) -> Value {
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    serde_json::from_slice(&run.stdout).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn distance(a: &Value, b: &Value) -> f64 {
    numbers(a).iter().zip(numbers(b)).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
}

/// The ribbons of a bicubic patch with such control points, numbered along both ways.
fn ribbons_of(at: &dyn Fn(usize, usize) -> Value) -> Value {
    let rows = |of: &dyn Fn(usize, usize) -> Value| {
        let row = |k: usize| (0..4).map(|j| of(j, k)).collect::<Vec<_>>();
        json!({ "row0": row(0), "row1": row(1) })
    };
    json!({ "ribbons": [
        rows(&|j, k| at(j, k)),
        rows(&|j, k| at(3 - k, j)),
        rows(&|j, k| at(3 - j, 3 - k)),
        rows(&|j, k| at(k, 3 - j)),
    ] })
}

/// A bicubic patch over a square with a corner at the given place, as ribbons; squares side by side share a whole side.
fn square(x: f64, y: f64) -> Value {
    let height = |x: f64, y: f64| 0.1 * x * x - 0.2 * x * y;
    let at = |u: usize, v: usize| {
        let (x, y) = (x + u as f64 / 3.0, y + v as f64 / 3.0);
        json!([x, y, height(x, y)])
    };
    ribbons_of(&at)
}

#[test]
fn samples_of_the_fixtures_are_met() {
    for name in ["s-patch-5-sided-cubic.json", "s-patch-6-sided-quintic.json"] {
        let file = fixture(name);
        let file = file.to_str().unwrap();
        let report = json_of(&ductile(&["fill", file, "--samples", file, "--json"]));
        let recorded = load(name);
        let (found, wanted) =
            (report["samples"].as_array().unwrap(), recorded["samples"].as_array().unwrap());
        assert_eq!(found.len(), wanted.len());
        for (found, wanted) in found.iter().zip(wanted) {
            assert!(distance(&found["point"], &wanted["point"]) < 1e-9);
            assert!(distance(&found["normal"], &wanted["normal"]) < 1e-8);
            assert!(distance(&found["bary"], &wanted["bary"]) < 1e-12);
            let curvatures = numbers(&found["principal_curvatures"]);
            assert!(curvatures.len() == 2 && curvatures[0] >= curvatures[1], "{found}");
        }
        assert_eq!(report["patches"][0]["control_points"], recorded["counts"]["control_points"]);
    }
}

#[test]
fn parameters_come_in_several_forms() {
    let file = fixture("s-patch-5-sided-cubic.json");
    let folder = tempfile::tempdir().unwrap();
    let places = folder.path().join("places.json");
    let recorded = load("s-patch-5-sided-cubic.json");
    let side = &recorded["samples"][3];
    let forms = json!([side["xy"], side["bary"], { "xy": side["xy"] }, { "bary": side["bary"], "patch": 0 },
        { "side": side["side"], "u": side["u"] }]);
    fs::write(&places, forms.to_string()).unwrap();
    let arguments = ["fill", file.to_str().unwrap(), "--samples", places.to_str().unwrap()];
    let run = ductile(&arguments);
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
    let text = String::from_utf8(run.stdout).unwrap();
    let lines: Vec<Vec<f64>> =
        text.lines().map(|line| line.split(' ').map(|word| word.parse().unwrap()).collect()).collect();
    assert_eq!(lines.len(), 5);
    for line in lines {
        assert_eq!(line.len(), 8);
        assert!(distance(&json!(line[..3]), &side["point"]) < 1e-12);
        assert!(distance(&json!(line[3..6]), &side["normal"]) < 1e-9);
    }
}

#[test]
fn the_mesh_is_the_surface() {
    let (folder, file) = with_ribbons(&square(0.0, 0.0));
    let out = folder.path().join("out.obj");
    let arguments = ["fill", &file, "-o", out.to_str().unwrap(), "--resolution", "8", "--json"];
    let report = json_of(&ductile(&arguments));
    let text = fs::read_to_string(&out).unwrap();
    let (mesh, positions) = ductile_mesh::io::obj::read_mesh(&text).unwrap();
    assert_eq!(mesh.faces().count(), 4 * 64);
    assert_eq!(report["mesh"]["vertices"], positions.len());
    assert_eq!(text.lines().filter(|line| line.starts_with("vn ")).count(), positions.len());
    // The sides of a quadratic saddle are its curves, to the last digits.
    let on_side = positions.iter().filter(|p| p.x.abs() < 1e-12 || p.y.abs() < 1e-12);
    let mut count = 0;
    for p in on_side {
        // Control points on the graph are not on the curve; the quadratic is met up to what the blossom takes.
        let exact = if p.x.abs() < 1e-12 { 0.0 } else { 0.1 * (p.x * p.x * 2.0 / 3.0 + p.x / 3.0) };
        assert!((p.z - exact).abs() < 1e-14, "{p}");
        count += 1;
    }
    assert_eq!(count, 17);
}

/// A generalised Bézier patch of degree 3 over a square, with twist points at some height.
fn square_of_text(height: f64) -> String {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0_f64]];
    let mut text = "4 3\n0 0 9\n".to_owned();
    for k in 0..4 {
        let ([a, b], [c, d]) = (corners[k], corners[(k + 1) % 4]);
        for t in [0.0, 1.0 / 3.0, 2.0 / 3.0] {
            text.push_str(&format!("{} {} 0\n", a + (c - a) * t, b + (d - b) * t));
        }
    }
    for [x, y] in corners {
        text.push_str(&format!("{} {} {height}\n", x / 3.0, y / 3.0));
    }
    text
}

#[test]
fn a_generalised_bezier_patch_is_filled_as_the_same_ribbons_in_json() {
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (text, json, samples) = (place("patch.gbp"), place("ribbons.json"), place("samples.json"));
    fs::write(&text, square_of_text(0.4)).unwrap();
    let corner = |k: usize| [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]][k % 4];
    let along = |k: usize, t: f64| {
        let ([a, b], [c, d]) = (corner(k), corner(k + 1));
        [a + (c - a) * t, b + (d - b) * t, 0.0]
    };
    let twist = |k: usize| [corner(k)[0] / 3.0, corner(k)[1] / 3.0, 0.4];
    let (third, two) = (1.0 / 3.0, 2.0 / 3.0);
    let side = |k: usize| {
        let row0 = [corner3(corner(k)), along(k, third), along(k, two), corner3(corner(k + 1))];
        json!({"row0": row0, "row1": [along(k + 3, two), twist(k), twist(k + 1), along(k + 1, third)]})
    };
    fs::write(&json, json!((0..4).map(side).collect::<Vec<_>>()).to_string()).unwrap();
    fs::write(&samples, "[[0, 0], [0.3, 0.2], [-0.4, 0.1]]").unwrap();
    let found = |file: &str| {
        let run = ductile(&["fill", file, "--samples", &samples]);
        assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
        String::from_utf8(run.stdout).unwrap()
    };
    assert_eq!(found(&text), found(&json));
    let out = place("out.obj");
    let report = json_of(&ductile(&["fill", &text, "-o", &out, "--json"]));
    assert_eq!((&report["patches"][0]["sides"], &report["patches"][0]["depth"]), (&json!(4), &json!(6)));
    let (mesh, _) = ductile_mesh::io::obj::read_mesh(&fs::read_to_string(&out).unwrap()).unwrap();
    assert_eq!(mesh.faces().count(), 4 * 16 * 16);
}

fn corner3([x, y]: [f64; 2]) -> [f64; 3] {
    [x, y, 0.0]
}

#[test]
fn a_bad_line_of_a_file_of_text_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("bad.gbp");
    let good = square_of_text(0.4);
    for (text, wanted) in [
        (good.replacen("4 3", "2 3", 1), "line 1"),
        (good.replacen("0 0 9", "0 0", 1), "line 2"),
        (good.clone() + "1 1 1\n", "line 19"),
        (good.lines().take(9).collect::<Vec<_>>().join("\n"), "line 9"),
        ("something else".to_owned(), "expected value"),
    ] {
        fs::write(&file, text).unwrap();
        let run = ductile(&["fill", file.to_str().unwrap(), "-o", "-"]);
        let said = String::from_utf8(run.stderr).unwrap();
        assert_eq!(run.status.code(), Some(2), "{said}");
        assert!(said.contains(wanted) && said.contains("bad.gbp"), "{said}");
    }
}

#[test]
fn patches_that_share_sides_are_sewn() {
    let patches = json!([square(0.0, 0.0), square(1.0, 0.0), square(0.0, 1.0), square(1.0, 1.0)]);
    let (folder, file) = with_ribbons(&patches);
    let out = folder.path().join("out.obj");
    let arguments = ["fill", &file, "-o", out.to_str().unwrap(), "--resolution", "4", "--json"];
    let report = json_of(&ductile(&arguments));
    assert_eq!(report["mesh"]["sewn_sides"], 4);
    // The squares are parts of one graph of control points: smooth across where its legs go on straight.
    let seams = report["seams"].as_array().unwrap();
    let named = |name: &str| seams.iter().map(|seam| seam[name].as_u64().unwrap()).collect::<Vec<_>>();
    assert_eq!([named("patch"), named("other_patch")], [vec![0, 0, 1, 2], vec![1, 2, 3, 3]]);
    assert_eq!([named("side"), named("other_side")], [vec![1, 2, 2, 1], vec![3, 0, 0, 3]]);
    for seam in seams {
        assert!(seam["gap"].as_f64().unwrap() < 1e-13, "{seam}");
        assert!((0.0..0.1).contains(&seam["angle"].as_f64().unwrap()), "{seam}");
    }
    let text = fs::read_to_string(&out).unwrap();
    let (mesh, positions) = ductile_mesh::io::obj::read_mesh(&text).unwrap();
    // One disc: no vertex is there twice.
    let (vertices, faces) = (positions.len(), mesh.faces().count());
    assert_eq!((vertices, faces), (4 * 41 - 4 * 5 + 1, 4 * 64));
    let named = json!({ "patches": patches });
    let (_folder, file) = with_ribbons(&named);
    assert_eq!(
        json_of(&ductile(&["fill", &file, "-o", out.to_str().unwrap(), "--json"]))["mesh"]["sewn_sides"],
        4
    );
}

/// A bicubic patch over a rectangle whose curves and planes are those of a saddle exactly; the inner control points beside its sides 0
/// and 2 can be lifted out of the planes.
fn saddle([x0, x1]: [f64; 2], [y0, y1]: [f64; 2], lift: f64) -> Value {
    let at = |u: usize, v: usize| {
        let (i, j) = (u as f64 / 3.0, v as f64 / 3.0);
        let (x, y) = (x0 + (x1 - x0) * i, y0 + (y1 - y0) * j);
        // The blossom of the square: as many arguments at the far end as the number of the control point.
        let ends: Vec<f64> = (0..3).map(|k| if k < u { x1 } else { x0 }).collect();
        let square = (ends[0] * ends[1] + ends[1] * ends[2] + ends[2] * ends[0]) / 3.0;
        let is_inner = (1..3).contains(&u) && (1..3).contains(&v);
        json!([x, y, 0.1 * square - 0.2 * x * y + if is_inner { lift } else { 0.0 }])
    };
    ribbons_of(&at)
}

/// One long side meets two short ones; no mesh is asked for.
#[test]
fn sides_that_meet_in_part_are_seams_too() {
    let report = |lift: f64| {
        let patches = json!([
            saddle([0.0, 2.0], [0.0, 1.0], 0.0),
            saddle([0.0, 1.0], [-1.0, 0.0], 0.0),
            saddle([1.0, 2.0], [-1.0, 0.0], lift),
        ]);
        let (_folder, file) = with_ribbons(&patches);
        json_of(&ductile(&["fill", &file, "--json"]))
    };
    let even = report(0.0);
    assert!(even.get("mesh").is_none() && even.get("samples").is_none(), "{even}");
    let seams = even["seams"].as_array().unwrap();
    let sides = |seam: &Value| {
        ["patch", "side", "other_patch", "other_side"].map(|name| seam[name].as_u64().unwrap())
    };
    assert_eq!(seams.iter().map(sides).collect::<Vec<_>>(), [[0, 0, 1, 2], [0, 0, 2, 2], [1, 1, 2, 3]]);
    for (seam, [along, other_along]) in
        seams.iter().zip([[[0.0, 0.5], [1.0, 0.0]], [[0.5, 1.0], [1.0, 0.0]], [[0.0, 1.0], [1.0, 0.0]]])
    {
        assert!(distance(&seam["along"], &json!(along)) < 1e-12, "{seam}");
        assert!(distance(&seam["other_along"], &json!(other_along)) < 1e-12, "{seam}");
        assert!(seam["gap"].as_f64().unwrap() < 1e-14 && seam["angle"].as_f64().unwrap() < 1e-12, "{seam}");
        assert_eq!(seam["without_normal"], 0);
    }
    let lifted = report(0.1);
    let angle = |at: usize| lifted["seams"][at]["angle"].as_f64().unwrap();
    assert!(angle(0) < 1e-12 && (0.1..0.6).contains(&angle(1)) && (0.1..0.6).contains(&angle(2)), "{lifted}");
    // Patches a little apart have a gap; farther apart, no seam.
    let apart = |by: f64| {
        let patches = json!([saddle([0.0, 2.0], [0.0, 1.0], 0.0), saddle([0.0, 1.0], [-1.0, -by], 0.0)]);
        let (_folder, file) = with_ribbons(&patches);
        json_of(&ductile(&["fill", &file, "--json"]))["seams"].clone()
    };
    let gap = apart(1e-5)[0]["gap"].as_f64().unwrap();
    assert!((gap - 1e-5).abs() < 1e-6, "{gap:e}");
    assert_eq!(apart(0.01), json!([]));
}

#[test]
fn options_choose_the_patch() {
    let file = fixture("s-patch-6-sided-quintic.json");
    let file = file.to_str().unwrap();
    let recorded = load("s-patch-6-sided-quintic.json");
    let folder = tempfile::tempdir().unwrap();
    let places = folder.path().join("places.json");
    for (at, rule) in [(0, "harmonic"), (1, "biharmonic")] {
        let samples = &recorded["c0_patches"][at]["samples"];
        fs::write(&places, json!({ "samples": samples }).to_string()).unwrap();
        let places = places.to_str().unwrap();
        let report = json_of(&ductile(&[
            "fill",
            file,
            "--samples",
            places,
            "--json",
            "--position-only",
            "--fill",
            rule,
        ]));
        assert_eq!(report["patches"][0]["depth"], 5);
        assert_eq!(report["patches"][0]["interior_fill"], rule);
        for (found, wanted) in report["samples"].as_array().unwrap().iter().zip(samples.as_array().unwrap()) {
            assert!(distance(&found["point"], &wanted["point"]) < 1e-9, "{rule}");
        }
    }
}

#[test]
fn sides_of_different_degrees_are_raised() {
    let mut file = square(0.0, 0.0);
    // A straight quadratic side with straight legs, in the middle of the cubic ones.
    let flat = |x: usize, y: usize| json!([x as f64, y as f64, 0.0]);
    let cubic = |p: [[f64; 3]; 4]| json!(p);
    file["ribbons"] = json!([
        { "row0": [[0,0,0],[1.5,0,0],[3,0,0]], "row1": [[0,1.5,0],[1.5,1.5,0],[3,1.5,0]] },
        { "row0": cubic([[3.,0.,0.],[3.,1.,0.],[3.,2.,0.],[3.,3.,0.]]), "row1": cubic([[2.,0.,0.],[2.,1.,0.],[2.,2.,0.],[2.,3.,0.]]) },
        { "row0": cubic([[3.,3.,0.],[2.,3.,0.],[1.,3.,0.],[0.,3.,0.]]), "row1": cubic([[3.,2.,0.],[2.,2.,0.],[1.,2.,0.],[0.,2.,0.]]) },
        { "row0": [flat(0,3),flat(0,2),flat(0,1),flat(0,0)], "row1": [flat(1,3),flat(1,2),flat(1,1),flat(1,0)] },
    ]);
    let (folder, name) = with_ribbons(&file);
    let places = folder.path().join("places.json");
    fs::write(&places, "[[0, 0], [0.2, 0.3]]").unwrap();
    let report = json_of(&ductile(&["fill", &name, "--samples", places.to_str().unwrap(), "--json"]));
    assert_eq!(report["patches"][0]["ribbon_degree"], 3);
    assert!(distance(&report["samples"][0]["point"], &json!([1.5, 1.5, 0.0])) < 1e-12, "{report}");
    assert!(distance(&report["samples"][1]["normal"], &json!([0.0, 0.0, 1.0])) < 1e-12, "{report}");
}

#[test]
fn twists_are_mended_on_request() {
    let mut file = load("s-patch-5-sided-cubic.json");
    let z = file["ribbons"][0]["row1"][1][2].as_f64().unwrap();
    file["ribbons"][0]["row1"][1][2] = json!(z + 0.1);
    let (_folder, name) = with_ribbons(&file);
    let run = ductile(&["fill", &name, "-o", "-"]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(2));
    assert!(
        said.contains("ribbons.json: side 0: point 1 of row 1 must be point 2 of row 1 of side 4"),
        "{said}"
    );
    assert!(run.stdout.is_empty());
    let report = json_of(&ductile(&["fill", &name, "--samples", &name, "--json", "--make-compatible"]));
    let moved = &report["patches"][0]["moved"];
    assert!((moved["largest_shift"].as_f64().unwrap() - 0.05).abs() < 1e-12, "{moved}");
}

#[test]
fn places_without_a_normal_are_told_and_filled() {
    let mut file = square(0.0, 0.0);
    // The cross derivative in the middle of side 0 vanishes nowhere, but is along the curve at u = 1/2 when its inner
    // points lie on the line of the curve.
    let rows = json!([[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0]]);
    let away = |x: f64| json!([[x, 0., 0.], [x, 1., 0.], [x, 2., 0.], [x, 3., 0.], [x, 4., 0.]]);
    let back = |v: Value| {
        let mut list = v.as_array().unwrap().clone();
        list.reverse();
        json!(list)
    };
    let up = |y: f64| json!([[4., y, 0.], [3., y, 0.], [2., y, 0.], [1., y, 0.], [0., y, 0.]]);
    file["ribbons"] = json!([
        { "row0": rows, "row1": [[0, 1, 0], [1, 1, 0], [2, -1, 0], [3, 1, 0], [4, 1, 0]] },
        { "row0": away(4.0), "row1": away(3.0) },
        { "row0": up(4.0), "row1": up(3.0) },
        { "row0": back(away(0.0)), "row1": back(away(1.0)) },
    ]);
    file["ribbons"][0]["row1"][2] = json!([2, -5.0 / 3.0, 0]);
    let (folder, name) = with_ribbons(&file);
    let out = folder.path().join("out.obj");
    let run = ductile(&["fill", &name, "-o", out.to_str().unwrap()]);
    let said = String::from_utf8_lossy(&run.stderr).into_owned();
    assert_eq!(run.status.code(), Some(0), "{said}");
    assert!(said.contains("side 0 has no normal at 0.5"), "{said}");
    assert!(!fs::read_to_string(out).unwrap().contains("NaN"));
}

#[test]
fn bad_input_is_refused_with_its_place() {
    let good = load("s-patch-5-sided-cubic.json");
    let refused = |says: &str, change: &dyn Fn(&mut Value)| {
        let mut file = good.clone();
        change(&mut file);
        let (folder, name) = with_ribbons(&file);
        let out = folder.path().join("out.obj");
        let run = ductile(&["fill", &name, "-o", out.to_str().unwrap()]);
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{says}: {said}");
        assert!(said.contains(says) && said.contains("ribbons.json: "), "{says}: {said}");
        assert!(!out.exists());
    };
    refused("ribbons: this field is missing", &|file| *file = json!({}));
    refused("there are no ribbons", &|file| *file = json!([]));
    refused("an object is expected", &|file| *file = json!([1, 2]));
    refused("an object is expected", &|file| *file = json!("x"));
    refused("there are 2 sides", &|file| {
        file["ribbons"].as_array_mut().unwrap().truncate(2);
        file["sides"] = json!(2);
    });
    refused("sides: 5 is told here", &|file| file["ribbons"].as_array_mut().unwrap().truncate(4));
    refused("depth: degree 3 makes depth 6", &|file| file["depth"] = json!(7));
    refused("interior_fill: `magic`", &|file| file["interior_fill"] = json!("magic"));
    refused("ribbons[0].row0[2][1]: a finite number", &|file| {
        file["ribbons"][0]["row0"][2][1] = json!("far")
    });
    refused("ribbons[0].row0[2]: no coordinate", &|file| file["ribbons"][0]["row0"][2][1] = json!(1e200));
    refused("side 1: point 0 of row 0 must be point 3 of row 0 of side 0", &|file| {
        file["ribbons"][0]["row0"][3] = json!([9, 9, 9]);
    });
    refused("patch 1: side 0", &|file| {
        let mut other = file.clone();
        other["ribbons"][0]["row1"][1] = json!([9, 9, 9]);
        *file = json!([file.clone(), other]);
    });
}

#[test]
fn bad_samples_and_options_are_refused() {
    let file = fixture("s-patch-5-sided-cubic.json");
    let file = file.to_str().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let places = folder.path().join("places.json");
    let name = places.to_str().unwrap();
    for (text, says) in [
        ("[[0.9, 0.5]]", "places.json: [0]: (0.9, 0.5) lies outside"),
        ("[[0, 0], [0.5, 0, 0.5, 0, 0]]", "[1]: these are the Wachspress coordinates of no point"),
        ("[[0.5, 0.5, 0]]", "3 coordinates for 5 corners"),
        ("[{\"side\": 5, \"u\": 0}]", "there is no side 5"),
        ("[{\"side\": 1, \"u\": 7}]", "outside of the domain"),
        ("[{\"side\": 1}]", "[0].u: this field is missing"),
        ("[{\"patch\": 1, \"xy\": [0, 0]}]", "there is no patch 1"),
        ("[{\"patch\": -1, \"xy\": [0, 0]}]", "-1 is no count"),
        ("[{\"u\": 0}]", "one of `xy`, `bary`"),
        ("[7]", "[0]: an object is expected"),
        ("{}", "samples: this field is missing"),
        ("[[0, 1e999]]", "places.json: [0][1]: a finite number is expected"),
        ("", "EOF"),
    ] {
        fs::write(&places, text).unwrap();
        let run = ductile(&["fill", file, "--samples", name]);
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{text}: {said}");
        assert!(said.contains(says), "{text}: {said}");
        assert!(run.stdout.is_empty());
    }
    for (arguments, says) in [
        (vec!["fill", file], "--out"),
        (vec!["fill", file, "-o", "-", "--json"], "cannot both go to standard output"),
        (vec!["fill", file, "-o", "x.obj", "--resolution", "0"], "--resolution"),
        (vec!["fill", file, "-o", "x.obj", "--resolution", "9999"], "--resolution"),
        (vec!["fill", "absent.json", "-o", "x.obj"], "absent.json"),
    ] {
        let run = ductile(&arguments);
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {said}");
        assert!(said.contains(says), "{arguments:?}: {said}");
    }
}
