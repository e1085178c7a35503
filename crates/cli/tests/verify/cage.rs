//! `ductile verify` on reference files of cage surfaces and parameter maps: the true ones pass, every damage is found.

use crate::support::{damaged, fixture, verify};
use serde_json::{Value, json};
use std::fs;
use std::path::PathBuf;

const CAGES: [&str; 3] = ["polyhedral-cube.json", "polyhedral-torus.json", "polyhedral-open.json"];

fn at<'a>(file: &'a mut Value, pointer: &str) -> &'a mut Value {
    file.pointer_mut(pointer).unwrap()
}

fn add(file: &mut Value, pointer: &str, by: f64) {
    let value = at(file, pointer);
    *value = json!(value.as_f64().unwrap() + by);
}

#[test]
fn the_recorded_files_are_verified() {
    let names = [&CAGES[..], &["param-map.json"]].concat();
    let files: Vec<PathBuf> = names.iter().map(|name| fixture(name)).collect();
    let (status, said) = verify(&files);
    assert_eq!(status, 0, "{said}");
    assert_eq!(said.matches("\n  verified: ").count(), names.len(), "{said}");
}

/// Each kind of quantity in each case, just beyond its tolerance.
#[test]
fn a_wrong_number_anywhere_is_found() {
    for (name, cases) in CAGES.into_iter().zip([6, 2, 4]) {
        for case in 0..cases {
            let place = |rest: &str| format!("/cases/{case}/{rest}");
            let moved = |says: &str, pointer: &str, by: f64| {
                let says = format!("cases[{case}].{says}  EXCEEDED");
                damaged(name, 1, &says, |file| add(file, &place(pointer), by));
            };
            moved("samples[7].point", "samples/7/point/1", 1.5e-10);
            moved("samples[9].normal", "samples/9/normal/2", -1.5e-9);
            moved("quad_mesh.vertices[3]", "quad_mesh/vertices/3/0", 1.5e-10);
            damaged(name, 1, &format!("cases[{case}].quad_mesh.quads[1]  EXCEEDED"), |file| {
                let quad = at(file, &place("quad_mesh/quads/1")).as_array_mut().unwrap();
                quad.rotate_left(1);
            });
        }
    }
    damaged("polyhedral-open.json", 1, "cases[0].open  EXCEEDED", |file| {
        *at(file, "/cases/0/open") = json!(false)
    });
    for map in 0..6 {
        for (column, by) in
            [(2, 1.5e-13), (3, -1.5e-13), (4, 1.5e-11), (5, 1.5e-11), (6, -1.5e-11), (7, 1.5e-11)]
        {
            let says = format!("maps[{map}].rows[8][{column}]  EXCEEDED");
            damaged("param-map.json", 1, &says, |file| {
                add(file, &format!("/maps/{map}/rows/8/{column}"), by)
            });
        }
    }
}

/// An option that says something else gives other numbers.
#[test]
fn other_rules_are_other_surfaces() {
    let wrong = |name: &str, pointer: &str, value: &str| {
        damaged(name, 1, "EXCEEDED", |file| *at(file, pointer) = json!(value));
    };
    wrong("polyhedral-cube.json", "/cases/1/map", "smooth");
    wrong("polyhedral-cube.json", "/cases/1/blend", "hermite k=3");
    wrong("polyhedral-cube.json", "/cases/1/blend", "erbs");
    wrong("polyhedral-cube.json", "/cases/1/blend", "bump");
    wrong("polyhedral-cube.json", "/cases/5/split", "linear");
    wrong("polyhedral-open.json", "/cases/1/boundary_rule", "linear");
    wrong("param-map.json", "/maps/0/map", "smooth");
}

#[test]
fn what_is_left_out_is_what_the_paper_says() {
    for (name, fields) in [
        (CAGES[0], &["map", "blend", "split", "name", "quad_mesh"][..]),
        (CAGES[2], &["map", "blend", "split", "open", "boundary_rule"][..]),
    ] {
        damaged(name, 0, "verified", |file| {
            file.as_object_mut().unwrap().remove("conventions");
            let case = at(file, "/cases/0").as_object_mut().unwrap();
            fields.iter().for_each(|field| assert!(case.remove(*field).is_some()));
            case["samples"][0].as_object_mut().unwrap().remove("normal");
        });
    }
}

#[test]
fn what_is_not_known_is_never_passed_over() {
    let file = CAGES[0];
    damaged(file, 1, "cases[0].map: no map of that name", |file| {
        *at(file, "/cases/0/map") = json!("bilinear")
    });
    damaged(file, 1, "cases[0].blend: no blend of that name", |file| {
        *at(file, "/cases/0/blend") = json!("eta")
    });
    damaged(file, 1, "cases[0].blend: no blend", |file| *at(file, "/cases/0/blend") = json!("hermite k=x"));
    damaged(file, 1, "cases[0].split: no split of that name", |file| {
        *at(file, "/cases/0/split") = json!("doo-sabin")
    });
    damaged(file, 1, "conventions.indices: no such convention", |file| {
        *at(file, "/conventions/indices") = json!("1-based");
    });
    damaged(file, 1, "cases[0].samples[0].mean_curvature: no rule", |file| {
        at(file, "/cases/0/samples/0")["mean_curvature"] = json!(1.0);
    });
    damaged(file, 1, "neither a point nor a normal", |file| {
        let sample = at(file, "/cases/0/samples/0").as_object_mut().unwrap();
        assert!(sample.remove("point").is_some() && sample.remove("normal").is_some());
    });
    damaged(file, 1, "cases[1].area: no rule", |file| at(file, "/cases/1")["area"] = json!(24.0));
    let map = "param-map.json";
    damaged(map, 1, "maps[0].columns[4]: no such column", |file| {
        *at(file, "/maps/0/columns/4") = json!("jacobian")
    });
    damaged(map, 1, "maps[0].map: no map of that name", |file| *at(file, "/maps/0/map") = json!("bilinear"));
    damaged(map, 1, "there are no second derivatives at the origin", |file| {
        *at(file, "/maps/0/columns/4") = json!("d2x_du2");
    });
}

#[test]
fn results_that_cannot_be_read_are_told_beside_the_others() {
    let told = |name: &str, says: &str, pointer: &str, value: Value| {
        damaged(name, 1, &format!("not checked: {says}"), |file| *at(file, pointer) = value);
    };
    let cube = CAGES[0];
    let few = json!([[0, 0, 0], [1, 1, 1]]);
    told(cube, "cases[0].quad_mesh.vertices: 2 vertices for 8", "/cases/0/quad_mesh/vertices", few);
    told(cube, "cases[0].quad_mesh.quads: 1 quads for 6", "/cases/0/quad_mesh/quads", json!([[0, 1, 2, 3]]));
    told(cube, "cases[0].quad_mesh.quads[0][3]: vertex 8", "/cases/0/quad_mesh/quads/0/3", json!(8));
    told(cube, "cases[0].samples[2].point[0]: a finite", "/cases/0/samples/2/point/0", json!("NaN"));
    told(cube, "cases[0].samples[2].normal: a list", "/cases/0/samples/2/normal", json!(null));
    told("polyhedral-open.json", "cases[0].open: true or false", "/cases/0/open", json!("yes"));
    let map = "param-map.json";
    told(map, "maps[0].rows[0]: 7 numbers for 8 columns", "/maps/0/rows/0", json!([0, 0, 0, 0, 0, 0, 0]));
    told(map, "maps[0].rows[3][5]: a finite number", "/maps/0/rows/3/5", json!(null));
}

#[test]
fn flaws_of_the_file_are_told_with_their_place() {
    let bad = |name: &str, says: &str, pointer: &str, value: Value| {
        damaged(name, 2, says, |file| *at(file, pointer) = value);
    };
    let cube = CAGES[0];
    bad(cube, "cases[0].cage.faces[0][1]: vertex 8 does not exist", "/cases/0/cage/faces/0/1", json!(8));
    bad(cube, "cases[0].cage.faces[0][1]: -1 is no vertex", "/cases/0/cage/faces/0/1", json!(-1));
    bad(cube, "face 0 has 2 corners", "/cases/0/cage/faces/0", json!([0, 1]));
    bad(cube, "run in the same direction", "/cases/0/cage/faces/0", json!([0, 1, 3, 2]));
    bad(cube, "cases[0].cage.vertices[0]: no coordinate", "/cases/0/cage/vertices/0", json!([1e300, 0, 0]));
    bad(cube, "cases[0].samples[0].quad: quad 6 does not exist", "/cases/0/samples/0/quad", json!(6));
    bad(cube, "lie outside [0, 1]", "/cases/0/samples/0/u", json!(1.5));
    bad(cube, "a finite number is expected", "/cases/0/samples/0/v", json!("0.5"));
    bad(cube, "a list is expected", "/cases/0/samples", json!(4));
    bad(cube, "a text is expected", "/cases/0/map", json!(4));
    bad(cube, "no sensible tolerance", "/conventions/tolerance/point", json!(1.0));
    bad(cube, "a Hermite blend of order 0", "/cases/0/blend", json!("hermite k=0"));
    bad(cube, "a Hermite blend of order 4000000000", "/cases/0/blend", json!("hermite k=4000000000"));
    let map = "param-map.json";
    bad(map, "a polygon has 3 sides", "/maps/0/n", json!(2));
    bad(map, "number of sides 100000 does not exist", "/maps/0/n", json!(100_000));
    bad(map, "columns `u` and `v` are needed", "/maps/0/columns/0", json!("w"));
    bad(map, "given twice", "/maps/0/columns/0", json!("v"));
    bad(map, "lie outside", "/maps/0/rows/0/0", json!(-0.1));
    // A case without its cage among cases that have one.
    damaged(cube, 2, "cases[0].cage: this field is missing", |file| {
        at(file, "/cases/0").as_object_mut().unwrap().remove("cage");
    });
}

/// A file with other sizes and every option is recomputed from its inputs alone.
#[test]
fn a_file_of_another_size_is_checked_too() {
    let file = json!({
        "cases": [{
            "map": "smooth", "blend": "hermite k=1", "split": "none", "boundary_rule": "borrow",
            "cage": {"vertices": [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [7, 7, 7]], "faces": [[0, 1, 2, 3]]},
            "samples": [{"quad": 0, "u": 0.25, "v": 0.75, "point": [0.25, 0.75, 0], "normal": [0, 0, 1]}],
        }],
    });
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("some.json");
    fs::write(&place, file.to_string()).unwrap();
    let (status, said) = verify(&[place]);
    assert_eq!(status, 0, "{said}");
}
