//! The displacement blends against the recorded file; the rest against what is known exactly, and on random meshes.

mod held;
mod oracle;
mod property;
mod spot;

use super::*;
use glam::DVec3;
use serde_json::Value;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

fn plain() -> Settings {
    Settings {
        laplacian: Laplacian::Cotangent,
        profile: Profile::Harmonic,
        combination: Combination::Plain,
        ..Settings::default()
    }
}

fn fixture() -> Value {
    serde_json::from_str(include_str!("../../../../tests/fixtures/displacement-grid.json")).unwrap()
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect()
}

fn indices(value: &Value) -> Vec<usize> {
    value.as_array().unwrap().iter().map(|x| usize::try_from(x.as_u64().unwrap()).unwrap()).collect()
}

fn vector(value: &Value) -> DVec3 {
    let x = numbers(value);
    DVec3::new(x[0], x[1], x.get(2).copied().unwrap_or(0.0))
}

fn mesh(case: &Value) -> Domain {
    let positions: Vec<DVec3> = case["vertices"].as_array().unwrap().iter().map(vector).collect();
    let triangles: Vec<[u32; 3]> = case["triangles"]
        .as_array()
        .unwrap()
        .iter()
        .map(|t| {
            indices(t).into_iter().map(|v| u32::try_from(v).unwrap()).collect::<Vec<_>>().try_into().unwrap()
        })
        .collect();
    Domain::new(&positions, &triangles).unwrap().with_only(&indices(&case["boundary"])).unwrap()
}

fn close(found: &[f64], recorded: &[f64], by: f64, what: &str) {
    assert_eq!(found.len(), recorded.len(), "{what}");
    for (vertex, (x, y)) in found.iter().zip(recorded).enumerate() {
        assert!((x - y).abs() <= by, "{what}, vertex {vertex}: {x} for {y}");
    }
}

#[test]
fn the_recorded_blends_are_met() {
    for case in fixture()["cases"].as_array().unwrap() {
        let name = case["name"].as_str().unwrap();
        let laplacian = match case["laplacian"].as_str().unwrap() {
            "cotangent" => Laplacian::Cotangent,
            _ => Laplacian::IntrinsicDelaunay,
        };
        for foot in case["feet"].as_array().unwrap() {
            let vertex = usize::try_from(foot["foot"].as_u64().unwrap()).unwrap();
            let mut surface = Displacements::new(mesh(case), Settings { laplacian, ..plain() }).unwrap();
            surface.add(Item::foot(vertex, DVec3::Z)).unwrap();
            let green = surface.solution(0).unwrap();
            close(green, &numbers(&foot["green"]), 1e-12, name);
            let raw: Vec<f64> = green.iter().map(|g| g / green[vertex]).collect();
            close(&raw, &numbers(&foot["harmonic_raw"]), 1e-12, name);
            for (profile, field) in
                [(Profile::Harmonic, "blend_harmonic"), (Profile::Conformal, "blend_conformal")]
            {
                surface.set_settings(Settings { laplacian, profile, ..plain() }).unwrap();
                for blend in foot[field].as_array().unwrap() {
                    surface.set_range(0, Range::new(blend["range"].as_f64().unwrap()).unwrap()).unwrap();
                    close(surface.blend(0).unwrap(), &numbers(&blend["values"]), 1e-11, name);
                }
            }
        }
    }
}

#[test]
fn the_recorded_combinations_are_met() {
    let case = &fixture()["cases"][0];
    let multi = &case["multi"];
    let feet = indices(&multi["feet"]);
    let ranges = numbers(&multi["ranges"]);
    let asked: Vec<DVec3> = multi["displacements"].as_array().unwrap().iter().map(vector).collect();
    let mut surface = Displacements::new(mesh(case), plain()).unwrap();
    for ((&foot, &d), &r) in feet.iter().zip(&asked).zip(&ranges) {
        surface.add(Item::foot(foot, d).with_range(Range::new(r).unwrap())).unwrap();
    }
    for (combination, profile, field) in [
        (Combination::Plain, Profile::Harmonic, "plain_sum_offsets"),
        (Combination::Cardinal, Profile::Harmonic, "cardinal_harmonic_offsets"),
        (Combination::Pairwise, Profile::Conformal, "pairwise_conformal_offsets"),
    ] {
        surface.set_settings(Settings { combination, profile, ..plain() }).unwrap();
        let offsets = surface.offsets().unwrap();
        for (vertex, recorded) in multi[field].as_array().unwrap().iter().enumerate() {
            let by = offsets[vertex].distance(vector(recorded));
            assert!(by < 1e-11, "{field}, vertex {vertex}: {by:e}");
        }
        if combination != Combination::Plain {
            assert!(feet.iter().zip(&asked).all(|(&foot, &d)| offsets[foot] == d), "{field}");
        }
    }
}

/// One more item costs its own pairs alone: what comes of that is, to the bit, what comes of all at once.
#[test]
fn items_that_come_one_by_one_are_combined_as_all_at_once() {
    let domain = mesh(&fixture()["cases"][0]);
    let free: Vec<usize> = (0..domain.len()).filter(|&v| !domain.held()[v]).collect();
    let settings = Settings { combination: Combination::Pairwise, ..Settings::default() };
    let bits = |surface: &mut Displacements| -> Vec<[u64; 3]> {
        let offsets = surface.offsets().unwrap();
        offsets.iter().map(|offset| offset.to_array().map(f64::to_bits)).collect()
    };
    let mut surface = Displacements::new(domain, settings).unwrap();
    for (k, &foot) in free.iter().step_by(7).enumerate() {
        let item = Item::foot(foot, DVec3::new(0.1, -0.2, k as f64));
        surface.add(item.with_range(Range::new(0.05 * k as f64).unwrap())).unwrap();
        let one_by_one = bits(&mut surface);
        // Two items at one vertex are refused, and nothing has changed.
        assert!(surface.add(Item::foot(foot, DVec3::X)).is_err());
        assert!(surface.set(k, Item::foot(usize::MAX, DVec3::X)).is_err());
        surface.set_range(0, Range::new(0.0).unwrap()).unwrap();
        assert_eq!(bits(&mut surface), one_by_one, "{k}");
        // This combines all of them anew.
        surface.set_settings(settings).unwrap();
        assert_eq!(bits(&mut surface), one_by_one, "{k}");
    }
    assert!(surface.items().len() > 5, "there is something to combine");
    let before = bits(&mut surface);
    let last = surface.items().last().unwrap().clone();
    let count = surface.items().len();
    surface.remove(count - 1).unwrap();
    surface.add(last).unwrap();
    assert_eq!(bits(&mut surface), before);
}
