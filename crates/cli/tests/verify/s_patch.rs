//! `ductile verify` on reference files of S-patches: the true ones pass, every quantity perturbed fails, and files that
//! make no sense are refused with their place.

use crate::support::{damaged, fixture, load, verify, verify_text};
use serde_json::{Value, json};

const CUBIC: &str = "s-patch-5-sided-cubic.json";
const QUINTIC: &str = "s-patch-6-sided-quintic.json";

fn verify_value(value: &Value) -> (i32, String) {
    verify_text(&value.to_string())
}

fn add(value: &mut Value, by: f64) {
    *value = json!(value.as_f64().unwrap() + by);
}

fn remove(file: &mut Value, name: &str) {
    assert!(file.as_object_mut().unwrap().remove(name).is_some(), "{name}");
}

#[test]
fn the_recorded_files_are_verified() {
    let (status, said) = verify(&[fixture(CUBIC), fixture(QUINTIC)]);
    assert_eq!(status, 0, "{said}");
    assert_eq!(said.matches("\n  verified: ").count(), 2, "{said}");
    for quantity in
        ["counts", "bary", "point", "normal", "control_points", "reject", "interior_mean", "c0: normal"]
    {
        assert!(said.contains(&format!("\n  {quantity} ")), "{quantity}: {said}");
    }
}

#[test]
fn a_number_just_beyond_its_tolerance_is_found() {
    let shifted = |says: &str, pointer: &str, by: f64| {
        damaged(CUBIC, 1, &format!("{says}  EXCEEDED"), |file| add(file.pointer_mut(pointer).unwrap(), by));
    };
    shifted("samples[0].point", "/samples/0/point/1", 1.1e-9);
    shifted("samples[9].point", "/samples/9/point/2", -1.1e-9);
    shifted("samples[4].point", "/samples/4/point/0", 1.1e-9);
    // 1.1e-8 rad out of a normal that points mostly along z.
    shifted("samples[0].normal", "/samples/0/normal/0", 1.2e-8);
    shifted("samples[12].normal", "/samples/12/normal/1", 1.2e-8);
    shifted("samples[0].bary", "/samples/0/bary/3", 2e-12);
    shifted("samples[0]", "/samples/0/xy/0", 2e-12);
    shifted("samples[3]", "/samples/3/u", 2e-12);
    shifted("samples[1]", "/samples/1/xy/0", -2e-12);
    shifted("control_points[0].point", "/control_points/0/point/0", 1.1e-9);
    shifted("control_points[2].point", "/control_points/2/point/0", 1.1e-9);
    shifted("control_points[100].point", "/control_points/100/point/2", 1.1e-9);
    shifted("interior_mean", "/interior_mean/1", 1.1e-9);
    shifted("reject[0].twist_residual", "/reject/0/twist_residual", 1.1e-9);
    for name in ["control_points", "boundary", "panel_including_boundary", "interior", "distinct_panels"] {
        shifted(&format!("counts.{name}"), &format!("/counts/{name}"), 1.0);
    }
    for name in ["depth", "sides", "ribbon_degree"] {
        shifted(name, &format!("/{name}"), 1.0);
    }
    // The length of a normal counts too.
    damaged(CUBIC, 1, "samples[5].normal  EXCEEDED", |file| {
        for at in 0..3 {
            let value = file["samples"][5]["normal"][at].as_f64().unwrap();
            file["samples"][5]["normal"][at] = json!(2.0 * value);
        }
    });
    damaged(CUBIC, 1, "control_points[2].kind  EXCEEDED", |file| {
        file["control_points"][2]["kind"] = json!("interior");
    });
    damaged(CUBIC, 1, "samples[9]  EXCEEDED", |file| file["samples"][9]["kind"] = json!("centre"));
    damaged(CUBIC, 1, "samples[9]  EXCEEDED", |file| file["samples"][9]["kind"] = json!("side"));
    damaged(CUBIC, 1, "samples[9]  EXCEEDED", |file| file["samples"][9]["kind"] = json!("corner"));
    damaged(CUBIC, 1, "samples[1]  EXCEEDED", |file| file["samples"][1]["kind"] = json!("interior"));
    // One ribbon point moved by little: everything recorded is of another patch.
    damaged(CUBIC, 1, "EXCEEDED", |file| add(&mut file["ribbons"][2]["row0"][2][1], 1e-7));
    damaged(CUBIC, 1, "point  EXCEEDED", |file| file["interior_fill"] = json!("harmonic"));
    // An edit that does not break anything must not be said to be refused.
    damaged(CUBIC, 1, "reject[0]  EXCEEDED", |file| file["reject"][0]["add"] = json!([0, 0, 0]));
}

#[test]
fn quantities_of_position_only_patches_are_checked_too() {
    let shifted = |says: &str, pointer: &str, by: f64| {
        damaged(QUINTIC, 1, &format!("{says}  EXCEEDED"), |file| {
            remove(file, "control_points");
            add(file.pointer_mut(pointer).unwrap(), by);
        });
    };
    shifted("c0_patches[0].samples[8].point", "/c0_patches/0/samples/8/point/0", 1.1e-9);
    shifted("c0_patches[1].samples[0].normal", "/c0_patches/1/samples/0/normal/0", 1.2e-8);
    shifted("c0_patches[1].counts.interior", "/c0_patches/1/counts/interior", 1.0);
    shifted("c0_patches[0].depth", "/c0_patches/0/depth", 1.0);
    damaged(QUINTIC, 1, "c0_patches[0].samples[7].point  EXCEEDED", |file| {
        file["c0_patches"][0]["interior_fill"] = json!("biharmonic");
    });
    damaged(QUINTIC, 1, "not checked: c0_patches[1].genus", |file| file["c0_patches"][1]["genus"] = json!(0));
    // The same patch as a file of its own, without second rows.
    let mut file = load(QUINTIC);
    let patch = file["c0_patches"][1].clone();
    for ribbon in file["ribbons"].as_array_mut().unwrap() {
        remove(ribbon, "row1");
    }
    for name in ["control_points", "interior_mean", "reject", "c0_patches"] {
        remove(&mut file, name);
    }
    for name in ["depth", "interior_fill", "counts", "samples"] {
        file[name] = patch[name].clone();
    }
    let (status, said) = verify_value(&file);
    assert_eq!(status, 0, "{said}");
}

#[test]
fn other_files_of_the_format_are_verified() {
    // Without what is optional, and with ribbons in another order.
    let mut file = load(CUBIC);
    for name in
        ["schema", "title", "conventions", "sides", "ribbon_degree", "depth", "interior_fill", "counts"]
    {
        remove(&mut file, name);
    }
    file["ribbons"].as_array_mut().unwrap().reverse();
    for sample in file["samples"].as_array_mut().unwrap() {
        remove(sample, "bary");
    }
    remove(&mut file["samples"][9], "kind");
    remove(&mut file["samples"][10], "normal");
    remove(&mut file["samples"][3], "xy");
    file["control_points"].as_array_mut().unwrap().truncate(50);
    let (status, said) = verify_value(&file);
    assert_eq!(status, 0, "{said}");
    // By barycentric coordinates alone.
    let mut file = load(CUBIC);
    for sample in file["samples"].as_array_mut().unwrap() {
        remove(sample, "xy");
    }
    let (status, said) = verify_value(&file);
    assert_eq!(status, 0, "{said}");
    // Sides of different degrees: one is raised by the rule for two rows, and must be lowered again by nobody.
    let mut file = load(CUBIC);
    remove(&mut file, "tolerances");
    let (status, said) = verify_value(&file);
    assert_eq!(status, 0, "{said}");
}

#[test]
fn what_no_rule_covers_is_told() {
    damaged(CUBIC, 1, "not checked: area: no rule", |file| file["area"] = json!(9.5));
    damaged(CUBIC, 1, "not checked: samples[3].curvature: no rule", |file| {
        file["samples"][3]["curvature"] = json!([0.1, 0.2]);
    });
    damaged(CUBIC, 1, "not checked: control_points[7].weight", |file| {
        file["control_points"][7]["weight"] = json!(1)
    });
    damaged(CUBIC, 1, "not checked: counts.corners", |file| file["counts"]["corners"] = json!(5));
    damaged(CUBIC, 1, "not checked: ribbons[1].row2", |file| file["ribbons"][1]["row2"] = json!([]));
    damaged(CUBIC, 1, "not checked: tolerances.area", |file| file["tolerances"]["area"] = json!(1e-9));
    damaged(CUBIC, 1, "not checked: conventions.turns", |file| file["conventions"]["turns"] = json!(1));
    damaged(CUBIC, 1, "not checked: reject[0].factor", |file| file["reject"][0]["factor"] = json!(2));
    damaged(CUBIC, 1, "no fill of that name", |file| file["interior_fill"] = json!("triharmonic"));
    damaged(CUBIC, 1, "no kind of sample", |file| file["samples"][9]["kind"] = json!("focus"));
    damaged(CUBIC, 1, "no kind of that name", |file| file["control_points"][9]["kind"] = json!("focus"));
    damaged(CUBIC, 1, "no such kind of file", |file| file["schema"] = json!("t-patch-1"));
    damaged(CUBIC, 1, "neither a point nor a normal", |file| {
        remove(&mut file["samples"][9], "point");
        remove(&mut file["samples"][9], "normal");
    });
    damaged(CUBIC, 1, "outside of the domain", |file| file["samples"][9]["xy"] = json!([1.5, 0]));
    damaged(CUBIC, 1, "fit of the ribbons", |file| add(&mut file["ribbons"][0]["row1"][1][2], 0.05));
    damaged(CUBIC, 1, "EXCEEDED", |file| file["tolerances"]["point_abs"] = json!(1e-18));
    damaged(CUBIC, 1, "EXCEEDED", |file| file["tolerances"]["side_point_vs_ribbon_abs"] = json!(1e-20));
    damaged(CUBIC, 1, "EXCEEDED", |file| file["tolerances"]["side_normal_vs_ribbon_rad"] = json!(1e-20));
}

#[test]
fn results_that_cannot_be_read_are_told_beside_the_others() {
    let told = |says: &str, pointer: &str, value: Value| {
        damaged(CUBIC, 1, &format!("not checked: {says}"), |file| {
            *file.pointer_mut(pointer).unwrap() = value.clone();
        });
        damaged(CUBIC, 1, "control_points[100].point  EXCEEDED", |file| {
            *file.pointer_mut(pointer).unwrap() = value;
            add(file.pointer_mut("/control_points/100/point/0").unwrap(), 1e-6);
        });
    };
    told("depth: -1 is no count", "/depth", json!(-1));
    told("counts.interior: a finite number", "/counts/interior", json!("115"));
    told("interior_mean: a list", "/interior_mean", json!(0));
    told("samples[3].point[1]: a finite number", "/samples/3/point/1", json!(null));
    told("samples[3].normal: 3 numbers", "/samples/3/normal", json!([0, 1]));
    told("control_points[9].point[0]: a finite number", "/control_points/9/point/0", json!("NaN"));
    told("reject[0].twist_residual: a finite", "/reject/0/twist_residual", json!("0.05"));
}

#[test]
fn what_cannot_be_read_names_its_place() {
    let bad = |says: &str, change: &dyn Fn(&mut Value)| {
        damaged(CUBIC, 2, &format!("some.json: {says}"), change);
    };
    bad("ribbons[2].row0: this field is missing", &|file| remove(&mut file["ribbons"][2], "row0"));
    bad("ribbons: side 2: row 0 has 4 points and row 1 has 0", &|file| {
        remove(&mut file["ribbons"][2], "row1")
    });
    bad("ribbons: side 2: row 0 has 4 points and row 1 has 3", &|file| {
        file["ribbons"][2]["row1"].as_array_mut().unwrap().pop();
    });
    bad("ribbons[1]: side 0 is given twice", &|file| file["ribbons"][1]["side"] = json!(0));
    bad("ribbons[1].side: side 5 does not exist", &|file| file["ribbons"][1]["side"] = json!(5));
    bad("ribbons[1].row0[0]: 3 numbers", &|file| file["ribbons"][1]["row0"][0] = json!([1, 2]));
    bad("ribbons[1].row0[0][1]: a finite number", &|file| file["ribbons"][1]["row0"][0][1] = json!(null));
    bad("ribbons[1].row0[0]: no coordinate may exceed", &|file| {
        file["ribbons"][1]["row0"][0][1] = json!(1e300)
    });
    bad("ribbons: there are 2 sides", &|file| file["ribbons"].as_array_mut().unwrap().truncate(2));
    bad("ribbons: a list is expected", &|file| file["ribbons"] = json!("none"));
    bad("ribbons: there are 0 sides", &|file| file["ribbons"] = json!([]));
    bad("samples[0].bary: 4 coordinates for 5 corners", &|file| {
        file["samples"][0]["bary"].as_array_mut().unwrap().pop();
    });
    bad("samples[3].side: side 17 does not exist", &|file| file["samples"][3]["side"] = json!(17));
    bad("samples[9]: it says by no coordinates", &|file| {
        remove(&mut file["samples"][9], "xy");
        remove(&mut file["samples"][9], "bary");
    });
    bad("control_points[3].label: a label has 5 entries with sum 6", &|file| {
        file["control_points"][3]["label"] = json!([6, 1, 0, 0, 0]);
    });
    bad("control_points[3].label: this label is given twice", &|file| {
        file["control_points"][3]["label"] = json!([6, 0, 0, 0, 0]);
    });
    bad("control_points[3].label[0]: entry 300 does not exist", &|file| {
        file["control_points"][3]["label"] = json!([300, 0, 0, 0, 0]);
    });
    bad("reject[0].column: point 4 does not exist", &|file| file["reject"][0]["column"] = json!(4));
    bad("reject[0].add: this field is missing", &|file| remove(&mut file["reject"][0], "add"));
    bad("tolerances.point_abs: 1 is no sensible tolerance", &|file| {
        file["tolerances"]["point_abs"] = json!(1.0)
    });
    // As many control points as would fill the memory.
    bad("ribbons: 40 sides and depth 23 make", &|file| {
        let row: Vec<[f64; 3]> = (0..21).map(|j| [f64::from(j) * 1e-12, 0.0, 0.0]).collect();
        let ribbons: Vec<Value> = (0..40).map(|_| json!({"row0": row, "row1": row})).collect();
        *file = json!({"ribbons": ribbons});
        file["ribbons"][7]["row0"][5] = json!([1, 1, 1]);
    });
}
