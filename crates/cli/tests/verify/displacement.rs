//! `ductile verify` on reference files of blend functions and displacement blends: the true ones pass, every damage is found.

use crate::support::{damaged, fixture, verify};
use serde_json::{Value, json};

const BLENDS: &str = "erbs.json";
const GRID: &str = "displacement-grid.json";

/// One value of a reference file changed.
fn with(name: &str, status: i32, says: &str, pointer: &str, value: Value) {
    damaged(name, status, says, |file| *file.pointer_mut(pointer).expect(pointer) = value);
}

/// A number moved by so much must be found out.
fn moved(name: &str, quantity: &str, pointer: &str, by: f64) {
    let place = pointer.trim_start_matches('/').split('/').fold(String::new(), |place, step| {
        match step.parse::<usize>() {
            Ok(index) => format!("{place}[{index}]"),
            Err(_) if place.is_empty() => step.to_owned(),
            Err(_) => format!("{place}.{step}"),
        }
    });
    let place =
        if quantity.ends_with("offsets") { place.rsplit_once('[').unwrap().0.to_owned() } else { place };
    damaged(name, 1, &format!("{place}  EXCEEDED"), |file| {
        let value = file.pointer_mut(pointer).expect(pointer);
        *value = json!(value.as_f64().unwrap() + by);
    });
    damaged(name, 1, "NOT verified: 1 of 8 quantities", |file| {
        let value = file.pointer_mut(pointer).expect(pointer);
        *value = json!(value.as_f64().unwrap() - by);
    });
}

#[test]
fn the_recorded_files_are_verified() {
    for name in [BLENDS, GRID] {
        let (status, said) = verify(&[fixture(name)]);
        assert!(status == 0 && said.contains("verified: 8 quantities"), "{said}");
    }
}

#[test]
fn every_quantity_slightly_beyond_its_tolerance_is_found() {
    for (column, name) in
        ["erbs", "erbs_derivative", "bump_k1", "bump_k2", "eta_delta_0.1", "eta_delta_0"].iter().enumerate()
    {
        moved(BLENDS, name, &format!("/rows/9/{}", column + 1), 1.1e-12);
    }
    moved(BLENDS, "R", "/range_rows/13/2", 1.1e-12);
    with(BLENDS, 1, "inv_phi1  EXCEEDED", "/inv_phi1", json!("1.6571376796460222"));
    let foot = "/cases/0/feet/1";
    for name in ["green", "harmonic_raw", "conformal"] {
        moved(GRID, name, &format!("{foot}/{name}/20"), 1.1e-10);
    }
    moved(GRID, "blend_harmonic", &format!("{foot}/blend_harmonic/2/values/20"), 1.1e-10);
    moved(GRID, "blend_conformal", &format!("{foot}/blend_conformal/1/values/20"), 1.1e-10);
    for name in ["plain_sum_offsets", "cardinal_harmonic_offsets", "pairwise_conformal_offsets"] {
        moved(GRID, name, &format!("/cases/0/multi/{name}/9/2"), 1.1e-10);
    }
    moved(GRID, "harmonic_raw", "/cases/2/feet/0/harmonic_raw/7", 1.1e-10);
    // Wrong inputs show in what was recorded of them.
    with(GRID, 1, "EXCEEDED", "/cases/1/laplacian", json!("intrinsic Delaunay cotangent"));
    with(GRID, 1, "EXCEEDED", "/cases/0/vertices/3/0", json!(-0.1618));
    with(GRID, 1, "EXCEEDED", "/cases/0/feet/0/foot", json!(1));
    with(GRID, 1, "EXCEEDED", "/cases/0/feet/0/blend_harmonic/3/range", json!(0.74));
    with(GRID, 1, "EXCEEDED", "/cases/0/multi/ranges/1", json!(0.51));
    with(GRID, 1, "EXCEEDED", "/cases/0/multi/displacements/0/1", json!(0.001));
    damaged(GRID, 1, "EXCEEDED", |file| drop(file["cases"][0]["boundary"].as_array_mut().unwrap().pop()));
}

#[test]
fn other_blends_and_combinations_are_known() {
    // Without what may be missing, and with other names for the same.
    damaged(BLENDS, 0, "verified: 2 quantities", |file| {
        let fields = file.as_object_mut().unwrap();
        for name in ["range_rows", "range_columns", "inv_phi1", "tolerance"] {
            fields.remove(name);
        }
        fields["columns"] = json!(["bump_k3", "t", "bump_k3_derivative"]);
        // By hand: 1 / (1 + exp(64 - (4/3)³)), and its slope with the exponent's.
        fields["rows"] = json!([[0.0, 0.0, 0.0], [0.5, 0.5, 24.0], [1.0, 1.0, 0.0], [1.0, 1.5, 0.0]]);
    });
    damaged(BLENDS, 0, "verified: 1 quantities", |file| {
        *file =
            json!({"range_columns": ["R", "s", "t"], "range_rows": [[0.5, 0.25, 0.75], [0.75, 0.5, 0.75]]});
    });
    damaged(GRID, 0, "verified: 2 quantities", |file| {
        let case = &mut file["cases"][0];
        let rho: Vec<f64> = case["feet"][0]["conformal"]
            .as_array()
            .unwrap()
            .iter()
            .map(|x| 1.0 - x.as_f64().unwrap())
            .collect();
        case["feet"] = json!([{"foot": 0, "rho": rho}]);
        case.as_object_mut().unwrap().remove("boundary");
        case.as_object_mut().unwrap().remove("laplacian");
        // One foot: every combination is the plain sum.
        let offsets = json!(vec![[0.0, 0.0, 0.0]; rho.len()]);
        case["multi"] =
            json!([{"feet": [3], "displacements": [[0, 0, 0]], "gram_conformal_offsets": offsets}]);
        file["cases"].as_array_mut().unwrap().truncate(1);
    });
    // In space instead of the plane, and with a size for a range.
    damaged(GRID, 0, "verified: 8 quantities", |file| {
        for vertex in file["cases"][0]["vertices"].as_array_mut().unwrap() {
            let (x, y) = (vertex[0].as_f64().unwrap(), vertex[1].as_f64().unwrap());
            *vertex = json!([0.6 * x + 3.0, y, 0.8 * x - 2.0]);
        }
        file["cases"][0]["feet"][0]["blend_conformal"][1]["size"] = json!(0.5_f64.sqrt());
        file["cases"][0]["feet"][0]["blend_conformal"][1].as_object_mut().unwrap().remove("range");
    });
}

#[test]
fn what_no_rule_covers_is_told() {
    with(BLENDS, 1, "columns[3]: no blend function is called `hump`", "/columns/3", json!("hump"));
    with(BLENDS, 1, "columns[3]: no blend function", "/columns/3", json!("bump_k-1"));
    with(BLENDS, 1, "columns[5]: no blend function", "/columns/5", json!("eta_delta_0.7"));
    with(BLENDS, 1, "range_columns[2]: no function of ranges", "/range_columns/2", json!("Q"));
    damaged(BLENDS, 1, "not checked: moments: no rule", |file| file["moments"] = json!([0.5]));
    with(GRID, 1, "cases[0].laplacian: no Laplacian", "/cases/0/laplacian", json!("clamped cotangent"));
    damaged(GRID, 1, "cases[0].feet[0].curvature: no rule", |file| {
        file["cases"][0]["feet"][0]["curvature"] = json!([1.0]);
    });
    damaged(GRID, 1, "cases[0].multi.cardinal_conformal_offsets: no rule", |file| {
        file["cases"][0]["multi"]["cardinal_conformal_offsets"] = json!([]);
    });
    damaged(GRID, 1, "cases[0].multi.gram_conformal_offsets: the feet lie too deep", |file| {
        let multi = &mut file["cases"][0]["multi"];
        multi["gram_conformal_offsets"] = multi["plain_sum_offsets"].clone();
        multi["ranges"] = json!([0.98, 0.98, 0.98]);
    });
    damaged(GRID, 1, "blend_harmonic[0].blend: no blend", |file| {
        file["cases"][0]["feet"][0]["blend_harmonic"][0]["blend"] = json!("smoothstep");
    });
    with(GRID, 1, "nothing was compared", "/cases", json!([{"vertices": [], "triangles": []}]));
}

#[test]
fn results_that_cannot_be_read_are_told_beside_the_others() {
    let told = |name: &str, says: &str, pointer: &str, value: Value| {
        with(name, 1, &format!("not checked: {says}"), pointer, value);
    };
    told(BLENDS, "rows[4]: 1 numbers for 7 columns", "/rows/4", json!([0.5]));
    told(BLENDS, "rows[4][2]: a finite number", "/rows/4/2", json!(null));
    told(BLENDS, "range_rows[4][2]: a finite number", "/range_rows/4/2", json!("NaN"));
    told(BLENDS, "inv_phi1: a finite number", "/inv_phi1", json!("about 1.66"));
    let foot = "cases[0].feet[0]";
    told(GRID, &format!("{foot}.green: 3 numbers for 76"), "/cases/0/feet/0/green", json!([1, 2, 3]));
    told(GRID, &format!("{foot}.harmonic_raw[4]: a finite"), "/cases/0/feet/0/harmonic_raw/4", json!(null));
    let offsets = "/cases/0/multi/plain_sum_offsets";
    told(GRID, "cases[0].multi.plain_sum_offsets: 0 offsets for 76", offsets, json!([]));
    told(GRID, "cases[0].multi.plain_sum_offsets[3]: 3 num", &format!("{offsets}/3"), json!([1]));
}

#[test]
fn what_cannot_be_read_names_its_place() {
    let blends = |says: &str, pointer: &str, value: Value| with(BLENDS, 2, says, pointer, value);
    blends("rows[4][0]: a finite number", "/rows/4/0", json!(null));
    blends("columns: no column is called `t`", "/columns/0", json!("u"));
    blends("columns[2]: there are two columns `erbs`", "/columns/2", json!("erbs"));
    blends("range_rows[5][0]: the range 1 is not", "/range_rows/5/0", json!(1.0));
    blends("tolerance.erbs: 1 is no sensible tolerance", "/tolerance/erbs", json!(1.0));
    let grid = |says: &str, pointer: &str, value: Value| with(GRID, 2, says, pointer, value);
    grid("cases[0].vertices[3]: 3 numbers are expected", "/cases/0/vertices/3", json!([1]));
    grid("cases[0].vertices[3]: no coordinate may exceed", "/cases/0/vertices/3", json!([1e300, 0, 0]));
    grid("cases[0].vertices[3][0]: a finite number", "/cases/0/vertices/3/0", json!("x"));
    grid("cases[0].triangles[7][1]: vertex 76 does not exist", "/cases/0/triangles/7/1", json!(76));
    grid("cases[0].triangles[7][1]: -1 is no vertex", "/cases/0/triangles/7/1", json!(-1));
    grid("triangle 7 uses one vertex twice", "/cases/0/triangles/7", json!([1, 1, 2]));
    grid("a triangle has 3 corners", "/cases/0/triangles/7", json!([1, 2]));
    grid("cases[0].boundary[2]: vertex 99 does not exist", "/cases/0/boundary/2", json!(99));
    grid("cases[0].feet[0].foot: vertex 0 is held", "/cases/0/boundary/2", json!(0));
    grid("neither boundary nor pin", "/cases/0/boundary", json!([]));
    grid("cases[0].feet[0].foot: 0.5 is no vertex", "/cases/0/feet/0/foot", json!(0.5));
    grid("the range 1 is not", "/cases/0/feet/0/blend_harmonic/0/range", json!(1));
    grid("cases[0].multi.ranges: 2 ranges for 3 feet", "/cases/0/multi/ranges", json!([0, 0]));
    grid(
        "cases[0].multi.displacements[1]: no coordinate",
        "/cases/0/multi/displacements/1",
        json!([1e200, 0, 0]),
    );
    grid("cases[0].multi.displacements[1]: 3 numbers", "/cases/0/multi/displacements/1", json!([0, 0]));
    grid("cases[0]: triangle 0 has no area", "/cases/0/vertices", json!(vec![[0, 0]; 76]));
    damaged(GRID, 2, "more than two triangles meet", |file| {
        let again = file["cases"][0]["triangles"][0].clone();
        let triangles = file["cases"][0]["triangles"].as_array_mut().unwrap();
        triangles.extend([again.clone(), again]);
    });
    damaged(GRID, 2, "cases[1].triangles: this field is missing", |file| {
        file["cases"][1].as_object_mut().unwrap().remove("triangles");
    });
}
