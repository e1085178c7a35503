//! `ductile verify` on reference files: the true ones pass, and every kind of damage makes the exit status 1 or 2.

use crate::support::{damaged, fixture, load, verify, verify_text};
use serde_json::{Value, json};
use std::fs;

/// Moves a number by that share of itself, or by as much when it is zero.
fn shift(value: &mut Value, share: f64) {
    let number = value.as_f64().unwrap();
    *value = json!(if number == 0.0 { share } else { number * (1.0 + share) });
}

#[test]
fn the_recorded_files_are_verified() {
    let names = ["sphere-energy.json", "torus-energy.json", "variational-gradient.json", "disc-raise.json"];
    let (status, said) = verify(&names.map(fixture));
    assert_eq!(status, 0, "{said}");
    assert_eq!(said.matches("\n  verified: ").count(), names.len(), "{said}");
    assert!(!said.contains("not checked"), "{said}");
}

#[test]
fn a_wrong_number_anywhere_is_found() {
    let sphere = |says: &str, pointer: &str, share: f64| {
        damaged("sphere-energy.json", 1, says, |file| shift(file.pointer_mut(pointer).unwrap(), share));
    };
    sphere("meshes[1].energy  EXCEEDED", "/meshes/1/energy", 1e-7);
    sphere("meshes[0].energy_with_3d_area  EXCEEDED", "/meshes/0/energy_with_3d_area", 1e-7);
    sphere("meshes[2].area_parametric  EXCEEDED", "/meshes/2/area_parametric", -1e-7);
    sphere("meshes[2].area_3d  EXCEEDED", "/meshes/2/area_3d", 1e-7);
    sphere("meshes[0].exact_integral  EXCEEDED", "/meshes/0/exact_integral", 1e-6);
    sphere("meshes[0].relative_error  EXCEEDED", "/meshes/0/relative_error", 1e-3);
    sphere("meshes[1].max_condition_normalised  EXCEEDED", "/meshes/1/max_condition_normalised", 1e-3);
    sphere("meshes[0].nodes  EXCEEDED", "/meshes/0/nodes", 1.0);
    sphere("meshes[0].degree_max  EXCEEDED", "/meshes/0/degree_max", 1.0);
    sphere("convergence[3].relative_error  EXCEEDED", "/convergence/3/relative_error", 1e-3);
    for name in ["angle_sum", "area", "density", "mean_curvature_abs", "gauss_curvature"] {
        let place = format!("meshes[1].node_checks[2].{name}  EXCEEDED");
        sphere(&place, &format!("/meshes/1/node_checks/2/{name}"), 1e-5);
    }
    sphere(
        "meshes[0].node_checks[0].normal_up_to_sign  EXCEEDED",
        "/meshes/0/node_checks/0/normal_up_to_sign/1",
        1e-5,
    );
    // One wrong coordinate of the mesh shows in what was recorded of it.
    sphere("EXCEEDED", "/meshes/0/vertices/7/1", 1e-4);
    damaged("torus-energy.json", 1, "all_nodes_full_basis  EXCEEDED", |file| {
        file["meshes"][1]["all_nodes_full_basis"] = json!(false);
    });
    let gradient = |says: &str, pointer: &str| {
        damaged("variational-gradient.json", 1, says, |file| shift(file.pointer_mut(pointer).unwrap(), 1e-4));
    };
    gradient("energy  EXCEEDED", "/energy");
    gradient("gradient[3].dE_dp  EXCEEDED", "/gradient/3/dE_dp/0");
    gradient("gradient[6].dE_dn  EXCEEDED", "/gradient/6/dE_dn");
    gradient("gradient[1].frozen_dE_dn  EXCEEDED", "/gradient/1/frozen_dE_dn");
    gradient("gradient[1].neutral_dE_dn  EXCEEDED", "/gradient/1/neutral_dE_dn");
}

/// The raised disc without its finer meshes, which would take the time of all the other tests together.
fn damaged_disc(status: i32, says: &str, change: impl FnOnce(&mut Value)) {
    damaged("disc-raise.json", status, says, |file| {
        let fields = file.as_object_mut().unwrap();
        fields.remove("finer_meshes");
        fields.remove("linear_theory");
        change(file);
    });
}

#[test]
fn a_wrong_number_of_the_disc_is_found() {
    damaged_disc(0, "verified: 12 quantities", |_| ());
    for (at, word) in [(0, "exact"), (4, "frozen"), (8, "neutral")] {
        let place = format!("cases[{at}].energy  EXCEEDED");
        damaged_disc(1, &place, |file| shift(&mut file["cases"][at]["energy"], 1e-3));
        let place = format!("cases[{at}].heights[1]  EXCEEDED");
        damaged_disc(1, &place, |file| shift(&mut file["cases"][at]["heights"][1], 0.03));
        let place = format!("cases[{at}].newton_steps  EXCEEDED");
        damaged_disc(1, &place, |file| file["cases"][at]["newton_steps"] = json!(40));
        let place = format!("{word}: node_positions");
        damaged_disc(1, &place, |file| {
            shift(&mut file["cases"][at]["node_positions"]["60"][2], 0.1);
        });
    }
    // The schemes rest in different places: a wrong name is found.
    damaged_disc(1, "EXCEEDED", |file| file["cases"][7]["scheme"] = file["cases"][6]["scheme"].clone());
    damaged_disc(1, "EXCEEDED", |file| file["cases"][3]["raise"] = json!(0.49));
    damaged_disc(1, "cases[2]: no scheme of that name", |file| file["cases"][2]["scheme"] = json!("magic"));
}

#[test]
fn a_wrong_finer_mesh_or_theory_is_found() {
    let fewer = |file: &mut Value| {
        file["cases"].as_array_mut().unwrap().truncate(1);
        file["finer_meshes"].as_array_mut().unwrap().truncate(1);
    };
    let fine = |status, says: &str, change: &dyn Fn(&mut Value)| {
        damaged("disc-raise.json", status, says, |file| {
            fewer(file);
            change(file);
        });
    };
    fine(0, "linear profile", &|_| ());
    fine(1, "finer_meshes[0].energy  EXCEEDED", &|file| shift(&mut file["finer_meshes"][0]["energy"], 1e-3));
    fine(1, "finer_meshes[0]: no mesh is known", &|file| file["finer_meshes"][0]["nodes"] = json!(1800));
    fine(1, "no such formula", &|file| file["linear_theory"]["energy"] = json!("(17 pi/3) raise^2"));
    fine(1, "no mesh is known", &|file| shift(&mut file["vertices"][30][0], 1e-4));
}

#[test]
fn what_no_rule_covers_is_told() {
    for name in ["sphere-energy.json", "variational-gradient.json"] {
        damaged(name, 1, "not checked: volume: no rule", |file| file["volume"] = json!(4.18));
        damaged(name, 1, "not checked: volume: no rule", |file| file["volume"] = json!("4.18"));
        damaged(name, 1, "not checked: checked: no rule", |file| file["checked"] = json!(null));
    }
    damaged("sphere-energy.json", 1, "meshes[0].node_checks[1].torsion: no rule", |file| {
        file["meshes"][0]["node_checks"][1]["torsion"] = json!(0.0);
    });
    damaged("sphere-energy.json", 1, "no mesh is known of this family", |file| {
        file["convergence"][1]["family"] = json!("octa");
    });
    damaged("variational-gradient.json", 1, "identities[1]: no identity", |file| {
        file["identities"][1] = json!("sum of everything = 1 (magic)");
    });
    // An ellipsoid has no exact integral that is known here.
    damaged("sphere-energy.json", 1, "lie on no sphere", |file| {
        for vertex in file["meshes"][0]["vertices"].as_array_mut().unwrap() {
            shift(&mut vertex[2], 0.1);
        }
    });
    for (text, says) in [
        (r#"{"control_net": [[0, 0, 0]], "samples": []}"#, "its format is not known"),
        (r#"{}"#, "its format is not known"),
        (r#"{"meshes": []}"#, "nothing was compared"),
    ] {
        let (status, said) = verify_text(text);
        assert!(status == 1 && said.contains(says), "{status}: {said}");
    }
}

/// A result that cannot be read could not be checked, and the others are.
#[test]
fn results_that_cannot_be_read_are_told_beside_the_others() {
    let sphere = |says: &str, field: &str, value: Value| {
        damaged("sphere-energy.json", 1, &format!("not checked: {says}"), |file| {
            file["meshes"][0][field] = value.clone();
            shift(&mut file["meshes"][1]["area_3d"], 1e-4);
        });
        damaged("sphere-energy.json", 1, "meshes[1].area_3d  EXCEEDED", |file| {
            file["meshes"][0][field] = value;
            shift(&mut file["meshes"][1]["area_3d"], 1e-4);
        });
    };
    sphere("meshes[0].energy: a finite number", "energy", json!("24.8"));
    sphere("meshes[0].energy: a finite number", "energy", json!("NaN"));
    sphere("meshes[0].energy: a finite number", "energy", json!(null));
    sphere("meshes[0].degree_min: -5 is no count", "degree_min", json!(-5));
    sphere("meshes[0].all_nodes_full_basis: true or false", "all_nodes_full_basis", json!(1));
    damaged("sphere-energy.json", 1, "not checked: meshes[0].node_checks[0].normal_up_to_sign: 3", |file| {
        file["meshes"][0]["node_checks"][0]["normal_up_to_sign"] = json!([0, 1]);
    });
    damaged("variational-gradient.json", 1, "not checked: gradient[2].dE_dp[1]: a finite", |file| {
        file["gradient"][2]["dE_dp"][1] = json!("inf");
    });
    damaged_disc(1, "not checked: cases[0].heights: 3 heights for 4 radii", |file| {
        file["cases"][0]["heights"].as_array_mut().unwrap().pop();
    });
    damaged_disc(1, "not checked: cases[0].node_positions.60: 3 numbers", |file| {
        file["cases"][0]["node_positions"]["60"] = json!([0, 0]);
    });
    // What is optional may be missing, each for itself.
    damaged("sphere-energy.json", 0, "verified", |file| {
        let mesh = file["meshes"][0].as_object_mut().unwrap();
        mesh.retain(|name, _| name == "vertices" || name == "triangles" || name == "area_3d");
    });
}

#[test]
fn what_cannot_be_read_names_file_and_place() {
    let sphere = |says: &str, change: &dyn Fn(&mut Value)| {
        damaged("sphere-energy.json", 2, &format!("some.json: {says}"), |file| {
            change(&mut file["meshes"][0])
        });
    };
    sphere("meshes[0].vertices[3]: 3 numbers are expected", &|mesh| mesh["vertices"][3] = json!([0, 1]));
    sphere("meshes[0].vertices[3][1]: a finite number", &|mesh| mesh["vertices"][3][1] = json!(null));
    sphere("meshes[0].vertices[3]: no coordinate may exceed", &|mesh| mesh["vertices"][3][1] = json!(1e200));
    sphere("meshes[0].triangles[5][2]: node 162 does not exist", &|mesh| {
        mesh["triangles"][5][2] = json!(162)
    });
    sphere("meshes[0].triangles[5][2]: -1 is no node", &|mesh| mesh["triangles"][5][2] = json!(-1));
    sphere("meshes[0].triangles[5][2]: 1.5 is no node", &|mesh| mesh["triangles"][5][2] = json!(1.5));
    sphere("meshes[0].triangles[5]: a triangle has 3 corners", &|mesh| mesh["triangles"][5] = json!([1, 2]));
    sphere("meshes[0].triangles: there are no triangles", &|mesh| mesh["triangles"] = json!([]));
    sphere("meshes[0].triangles: triangle 5 uses one node twice", &|mesh| {
        mesh["triangles"][5] = json!([1, 1, 2]);
    });
    sphere("meshes[0].triangles: the triangles around node", &|mesh| {
        let again = mesh["triangles"][0].clone();
        mesh["triangles"].as_array_mut().unwrap().push(again);
    });
    sphere("meshes[0].node_checks[0].node: node 162 does not exist", &|mesh| {
        mesh["node_checks"][0]["node"] = json!(162);
    });

    damaged_disc(2, "node 469 does not exist", |file| {
        file["cases"][0]["node_positions"]["469"] = json!([0, 0, 0]);
    });
    damaged_disc(2, "fixed: one fixed node must lie inside", |file| file["fixed"] = json!([0, 1]));
    damaged_disc(2, "fixed: neither a list", |file| file["fixed"] = json!("some nodes"));
    damaged_disc(2, "no height at the radius 1.5", |file| file["heights_at_radii"][3] = json!(1.5));
}

#[test]
fn absurd_tolerances_are_refused() {
    for absurd in [json!(1e9), json!(0.1), json!(0), json!(-1e-5), json!("wide")] {
        damaged("variational-gradient.json", 2, "tolerance.gradient_abs: ", |file| {
            file["tolerance"]["gradient_abs"] = absurd;
        });
    }
    damaged_disc(2, "tolerance.height_abs_over_raise: 5 is no sensible tolerance", |file| {
        file["tolerance"]["height_abs_over_raise"] = json!(5.0);
    });
    damaged("variational-gradient.json", 1, "EXCEEDED", |file| {
        file["tolerance"]["gradient_abs"] = json!(1e-12);
    });
    damaged("variational-gradient.json", 1, "tolerance.energy_rel: no rule", |file| {
        file["tolerance"]["energy_rel"] = json!(1.0);
    });
}

#[test]
fn what_is_no_json_is_refused_with_its_place() {
    let text = fs::read_to_string(fixture("variational-gradient.json")).unwrap();
    let with_nan = text.replacen("28.9547954393", "NaN", 1);
    let twice = text.replacen("\"energy\":", "\"energy\": 1.0, \"energy\":", 1);
    assert!(with_nan != text && twice != text, "the damage was none");
    for (text, says) in [
        (with_nan.as_str(), "energy: a finite number is expected"),
        (&text[..text.len() / 2], "EOF while parsing"),
        (&twice, "field `energy` is given twice"),
        ("[1, 2]", "the file: an object is expected"),
        ("", "EOF while parsing"),
    ] {
        let (status, said) = verify_text(text);
        assert!(status == 2 && said.contains("some.json: ") && said.contains(says), "{status}: {said}");
    }
    let (status, said) = verify(&[fixture("absent.json")]);
    assert!(status == 2 && said.contains("absent.json: "), "{said}");
    // One bad file does not hide the others, nor they it.
    let (status, said) = verify(&[fixture("absent.json"), fixture("torus-energy.json")]);
    assert!(status == 2 && said.contains("verified: 19 quantities"), "{said}");
    let folder = tempfile::tempdir().unwrap();
    let binary = folder.path().join("binary.json");
    fs::write(&binary, [0xff, 0xfe, 0x00]).unwrap();
    let (status, said) = verify(&[binary]);
    assert!(status == 2 && said.contains("not UTF-8"), "{said}");
}

#[test]
fn other_meshes_are_verified_too() {
    // Twice as large, moved, and named otherwise: the energy stays, the areas do not, and the sphere is still known.
    let mut file = load("sphere-energy.json");
    let mesh = &mut file["meshes"][0];
    for vertex in mesh["vertices"].as_array_mut().unwrap() {
        for (value, by) in vertex.as_array_mut().unwrap().iter_mut().zip([5.0, -3.0, 0.5]) {
            *value = json!(2.0 * value.as_f64().unwrap() + by);
        }
    }
    for name in ["area_parametric", "area_3d"] {
        mesh[name] = json!(4.0 * mesh[name].as_f64().unwrap());
    }
    mesh["name"] = json!("moved");
    mesh.as_object_mut().unwrap().remove("node_checks");
    let (status, said) = verify_text(&file.to_string());
    assert_eq!(status, 0, "{said}");
}
