//! Every number and every flag of every reference file, changed by a little more than its tolerance, must be found out. Lists are long,
//! so of each kind of number some are changed, first, last and between; the kinds are all there are: one without a line here fails.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use super::check;
use super::json::Json;
use std::collections::BTreeMap;
use std::path::Path;

/// Where a number stands: names of fields, and places in lists.
#[derive(Clone, Debug)]
enum Step {
    Field(usize),
    Place(usize),
}

/// How the numbers of a kind are changed, by the end of the name of the kind.
enum Change {
    /// By that much.
    By(&'static str, f64),
    /// It says how exactly others are recorded, or stands where it makes no difference.
    Leave(&'static str),
}
use Change::{By, Leave};

fn load(name: &str) -> Json {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// All numbers and flags below a value, by kind: `meshes[].vertices[][]`. The columns of a table are kinds of their own.
fn kinds(json: &Json, path: &mut Vec<Step>, name: &str, found: &mut BTreeMap<String, Vec<Vec<Step>>>) {
    match json {
        Json::Number(_) | Json::Flag(_) => found.entry(name.to_owned()).or_default().push(path.clone()),
        Json::List(list) => {
            for (at, inner) in list.iter().enumerate() {
                path.push(Step::Place(at));
                let column = if name.ends_with("rows[]") { at.to_string() } else { String::new() };
                kinds(inner, path, &format!("{name}[{column}]"), found);
                path.pop();
            }
        }
        Json::Fields(fields) => {
            for (at, (field, inner)) in fields.iter().enumerate() {
                path.push(Step::Field(at));
                // Nodes are named by numbers.
                let field = if field.parse::<u32>().is_ok() { "[]".to_owned() } else { format!(".{field}") };
                kinds(inner, path, &format!("{name}{field}"), found);
                path.pop();
            }
        }
        Json::Null | Json::Text(_) => (),
    }
}

fn at<'a>(json: &'a mut Json, path: &[Step]) -> &'a mut Json {
    path.iter().fold(json, |json, step| match (json, step) {
        (Json::List(list), Step::Place(at)) => &mut list[*at],
        (Json::Fields(fields), Step::Field(at)) => &mut fields[*at].1,
        _ => panic!("no such place"),
    })
}

/// Changes numbers of every kind, `picks` of each, one at a time.
fn mutate(file: &Json, picks: usize, changes: &[Change]) {
    let (_, report) = check(file).unwrap();
    assert!(report.holds(), "{report}");
    let mut found = BTreeMap::new();
    kinds(file, &mut Vec::new(), "", &mut found);
    let mut is_used = vec![false; changes.len()];
    for (kind, places) in &found {
        let fits = |change: &Change| match change {
            By(end, _) | Leave(end) => kind.ends_with(end),
        };
        let rule = changes.iter().position(fits);
        let rule = rule.unwrap_or_else(|| panic!("no line for {kind}"));
        is_used[rule] = true;
        let By(_, by) = changes[rule] else { continue };
        // The middles of as many equal parts of all the places.
        for pick in 0..picks.min(places.len()) {
            let path = &places[(2 * pick + 1) * places.len() / (2 * picks.min(places.len()))];
            let mut changed = file.clone();
            match at(&mut changed, path) {
                Json::Number(number) => *number += by,
                Json::Flag(flag) => *flag = !*flag,
                other => panic!("{other:?} is no number"),
            }
            // What makes no sense any more is refused with its place.
            if let Ok((_, report)) = check(&changed) {
                assert!(!report.holds(), "{kind} at {path:?} by {by:e} passes:\n{report}");
            }
        }
    }
    for (is_used, change) in is_used.iter().zip(changes) {
        let (By(end, _) | Leave(end)) = change;
        assert!(is_used, "nothing is called {end}");
    }
}

/// All values below one, by kind, those that hold others among them.
fn values(json: &Json, path: &mut Vec<Step>, name: &str, found: &mut BTreeMap<String, Vec<Step>>) {
    found.entry(name.to_owned()).or_insert_with(|| path.clone());
    match json {
        // The middle one stands for the others.
        Json::List(list) => {
            for at in [list.len() / 2].into_iter().filter(|at| *at < list.len()) {
                path.push(Step::Place(at));
                values(&list[at], path, &format!("{name}[]"), found);
                path.pop();
            }
        }
        Json::Fields(fields) => {
            for (at, (field, inner)) in fields.iter().enumerate() {
                path.push(Step::Field(at));
                values(inner, path, &format!("{name}.{field}"), found);
                path.pop();
            }
        }
        _ => (),
    }
}

/// Puts what makes no sense in the place of everything: it is told, and nothing else happens.
fn spoil(file: &Json) {
    let mut found = BTreeMap::new();
    values(file, &mut Vec::new(), "", &mut found);
    let text = |text: &str| Json::Text(text.to_owned());
    let numbers = [-1.0, 0.5, 1e300, -1e300, 1e-300, 4_294_967_295.0, 1e18].map(Json::Number);
    let nonsense =
        [Json::Null, text("NaN"), text("\u{1f600}"), Json::List(Vec::new()), Json::Fields(Vec::new())];
    for (kind, path) in &found {
        for value in &nonsense {
            let mut changed = file.clone();
            let place = at(&mut changed, path);
            // Other words may be right too, and where there is a list there may be less.
            if std::mem::discriminant(place) == std::mem::discriminant(value) {
                continue;
            }
            *place = value.clone();
            // What is said in words may be said otherwise, or not at all.
            let is_word = matches!(at(&mut file.clone(), path), Json::Text(_)) || kind == ".conventions";
            if let Ok((_, report)) = check(&changed) {
                assert!(is_word || !report.holds(), "{kind} as {value:?} passes:\n{report}");
            }
        }
        for value in &numbers {
            let mut changed = file.clone();
            *at(&mut changed, path) = value.clone();
            // That it ends is all that is asked: a parameter may be as small as that.
            let _ = check(&changed);
        }
    }
}

#[test]
fn nonsense_in_any_place_is_told() {
    for name in [
        "sphere-energy.json",
        "torus-energy.json",
        "variational-gradient.json",
        "s-patch-5-sided-cubic.json",
        "polyhedral-cube.json",
        "polyhedral-open.json",
        "param-map.json",
        "erbs.json",
        "displacement-grid.json",
    ] {
        spoil(&load(name));
    }
    let mut disc = load("disc-raise.json");
    truncate(&mut disc, "cases", 1);
    truncate(&mut disc, "finer_meshes", 0);
    spoil(&disc);
}

/// Leaves of a list in the file as many as that, from the front.
fn truncate(file: &mut Json, name: &str, count: usize) {
    let Json::Fields(fields) = file else { panic!("no object") };
    let list = fields.iter_mut().find(|(field, _)| field == name).unwrap();
    let Json::List(list) = &mut list.1 else { panic!("no list") };
    list.truncate(count);
}

#[test]
fn every_number_of_the_energies_is_checked() {
    let figures = || {
        vec![
            By("vertices[][]", 1e-4),
            By("triangles[][]", 1.0),
            By(".node_checks[].node", 1.0),
            By(".nodes", 1.0),
            By(".triangle_count", 1.0),
            By(".degree_min", 1.0),
            By(".degree_max", 1.0),
            By("convergence[].relative_error", 1.6e-7),
            By(".relative_error", 1.6e-6),
            By(".energy", 1e-6),
            By(".energy_with_3d_area", 1e-6),
            By(".area_parametric", 1.2e-6),
            By(".area_3d", 1.2e-6),
            By(".exact_integral", 1e-6),
            By(".max_condition_normalised", 2e-3),
            By(".all_nodes_full_basis", 1.0),
            By(".angle_sum", 7e-7),
            By(".area", 1.5e-7),
            By(".density", 3e-7),
            By(".mean_curvature_abs", 2e-7),
            By(".gauss_curvature", 2e-7),
            By(".normal_up_to_sign[]", 2e-7),
        ]
    };
    mutate(&load("sphere-energy.json"), 5, &figures());
    mutate(&load("torus-energy.json"), 5, &figures());
    let gradient = [
        By(".vertices[][]", 1e-4),
        By(".triangles[][]", 1.0),
        By(".energy", 4e-7),
        By(".gradient[].node", 1.0),
        By("_dE_dn", 1.2e-5),
        By("dE_dn", 1.2e-5),
        By("dE_dp[]", 1.2e-5),
        Leave(".tolerance.gradient_abs"),
    ];
    mutate(&load("variational-gradient.json"), 5, &gradient);
}

#[test]
fn every_number_of_the_raised_disc_is_checked() {
    let mut disc = load("disc-raise.json");
    truncate(&mut disc, "cases", 3);
    truncate(&mut disc, "finer_meshes", 1);
    let changes = [
        By(".vertices[][]", 1e-2),
        By(".triangles[][]", 1.0),
        By(".heights_at_radii[]", 0.05),
        By(".raise", 1e-4),
        By(".energy", 4e-6),
        By(".heights[]", 4e-4),
        By(".node_positions[][]", 4e-4),
        By(".newton_steps", 5.0),
        By(".finer_meshes[].nodes", 1.0),
        Leave("_rel"),
        Leave("_over_raise"),
        Leave("_to_finest"),
    ];
    mutate(&disc, 2, &changes);
}

#[test]
fn every_number_of_the_patches_is_checked() {
    let changes = || {
        vec![
            By(".row0[][]", 1e-7),
            By(".row1[][]", 1e-7),
            By(".ribbons[].side", 1.0),
            By(".sides", 1.0),
            By(".ribbon_degree", 1.0),
            By(".depth", 1.0),
            By("counts.control_points", 1.0),
            By("counts.boundary", 1.0),
            By("counts.panel_including_boundary", 1.0),
            By("counts.interior", 1.0),
            By("counts.distinct_panels", 1.0),
            By(".interior_mean[]", 1.1e-9),
            By(".xy[]", 1e-11),
            By(".bary[]", 2e-12),
            By("samples[].point[]", 1.1e-9),
            By("samples[].normal[]", 1.5e-8),
            By("samples[].side", 1.0),
            By("samples[].u", 2e-12),
            By("reject[].row", 1.0),
            // Any twist point is refused alike.
            Leave("reject[].side"),
            Leave("reject[].column"),
            By("reject[].add[]", 0.06),
            By("reject[].twist_residual", 1.1e-9),
            By("control_points[].label[]", 1.0),
            By("control_points[].point[]", 1.1e-9),
            Leave("_abs"),
            Leave("_rad"),
        ]
    };
    mutate(&load("s-patch-5-sided-cubic.json"), 7, &changes());
    mutate(&load("s-patch-6-sided-quintic.json"), 1, &changes());
}

#[test]
fn every_number_of_the_cages_is_checked() {
    let mut changes = vec![
        By(".cage.vertices[][]", 1e-6),
        By(".faces[][]", 1.0),
        By(".quad_mesh.vertices[][]", 1.1e-10),
        By(".quads[][]", 1.0),
        // Neighbours have points in common.
        By(".quad", 5.0),
        By(".u", 1e-6),
        By(".v", 1e-6),
        By(".point[]", 1.1e-10),
        By(".normal[]", 1.1e-9),
        Leave(".tolerance.point"),
        Leave(".tolerance.normal"),
    ];
    mutate(&load("polyhedral-cube.json"), 15, &changes);
    mutate(&load("polyhedral-torus.json"), 7, &changes);
    changes.push(By(".open", 1.0));
    mutate(&load("polyhedral-open.json"), 15, &changes);
    let maps = [
        By(".n", 1.0),
        By(".rows[][0]", 1e-6),
        By(".rows[][1]", 1e-6),
        By(".rows[][2]", 1.1e-13),
        By(".rows[][3]", 1.1e-13),
        By(".rows[][4]", 1.1e-11),
        By(".rows[][5]", 1.1e-11),
        By(".rows[][6]", 1.1e-11),
        By(".rows[][7]", 1.1e-11),
        Leave(".tolerance.value"),
        Leave(".tolerance.derivative"),
    ];
    mutate(&load("param-map.json"), 11, &maps);
}

#[test]
fn every_number_of_the_displacements_is_checked() {
    let mut blends: Vec<Change> = vec![
        By(".range_rows[][2]", 1.1e-12),
        // Beyond their ends blends stay what they are there, whatever the parameter.
        Leave("rows[][0]"),
        Leave(".range_rows[][1]"),
        Leave(".tolerance.erbs"),
        Leave(".tolerance.others"),
    ];
    let columns = [".rows[][1]", ".rows[][2]", ".rows[][3]", ".rows[][4]", ".rows[][5]", ".rows[][6]"];
    blends.extend(columns.map(|column| By(column, 1.1e-12)));
    mutate(&load("erbs.json"), 45, &blends);
    let grid = [
        By(".vertices[][]", 1e-6),
        By(".triangles[][]", 1.0),
        By(".boundary[]", -40.0),
        By(".foot", 1.0),
        By(".feet[]", 1.0),
        By(".range", 0.01),
        By(".ranges[]", 0.01),
        By(".displacements[][]", 1e-3),
        By(".harmonic_raw[]", 1.1e-10),
        By(".green[]", 1.1e-10),
        By(".conformal[]", 1.1e-10),
        By(".values[]", 1.1e-10),
        By("_offsets[][]", 1.1e-10),
        Leave(".tolerance.harmonic"),
        Leave(".tolerance.blend"),
    ];
    mutate(&load("displacement-grid.json"), 7, &grid);
}
