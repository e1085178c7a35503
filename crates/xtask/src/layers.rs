//! Who may depend on whom. The compiler keeps a crate from using what it does not declare; this check keeps it from
//! declaring what it must not use.

use crate::place;
use crate::project::{self, Package};
use crate::sizes;
use std::fs;
use std::path::Path;

/// Each member with the other members it may use. Absent from this table: an error, so that a new crate is a decision.
const MEMBERS: &[(&str, &[&str])] = &[
    ("ductile-spec", &[]),
    ("ductile-mesh", &[]),
    ("ductile-solver", &["ductile-mesh"]),
    ("ductile-patch", &["ductile-mesh", "ductile-solver"]),
    ("ductile-modeler", &["ductile-spec", "ductile-mesh", "ductile-solver", "ductile-patch"]),
    ("ductile-worker", &["ductile-spec", "ductile-modeler"]),
    ("ductile-viewer", &["ductile-spec"]),
    // `verify` compares the solver and the patches themselves with recorded figures, below the modeler; `fill`, `cage` and
    // `displace` turn files into files without a document between them.
    ("ductile-cli", &["ductile-spec", "ductile-modeler", "ductile-patch", "ductile-solver", "ductile-mesh"]),
    ("xtask", &[]),
];

/// The tests of the whole may use everything, and their cases run once more in the browser by the tests of the worker.
const ACCEPTANCE: &str = "acceptance";
const ACCEPTANCE_IN_BROWSER: &str = "ductile-worker";

/// Libraries from outside that every member may use.
const ANYWHERE: &[&str] = &["glam", "libm", "thiserror"];

/// Libraries from outside with the members that may use them.
const HOMES: &[(&str, &[&str])] = &[
    ("serde", &["ductile-spec", "ductile-worker", "ductile-viewer", "ductile-cli", "xtask"]),
    ("serde_json", &["ductile-spec", "ductile-worker", "ductile-viewer", "ductile-cli", "xtask"]),
    ("bytemuck", &["ductile-spec", "ductile-worker", "ductile-viewer"]),
    ("miniz_oxide", &["ductile-spec"]),
    ("base64", &["ductile-spec"]),
    ("faer", &["ductile-solver"]),
    ("wide", &["ductile-solver", "ductile-patch"]),
    ("robust", &["ductile-mesh"]),
    ("clap", &["ductile-cli"]),
    ("wasm-bindgen", &["ductile-worker", "ductile-viewer"]),
    ("wasm-bindgen-futures", &["ductile-worker", "ductile-viewer"]),
    ("js-sys", &["ductile-worker", "ductile-viewer"]),
    ("web-sys", &["ductile-worker", "ductile-viewer"]),
    ("serde-wasm-bindgen", &["ductile-worker", "ductile-viewer"]),
    ("console_error_panic_hook", &["ductile-worker", "ductile-viewer"]),
    ("wgpu", &["ductile-viewer"]),
];

/// Where code may ask whether it runs in the browser. The canvas exists there only, so its constructor has to ask.
const BROWSER_CODE: &[&str] =
    &["crates/worker/", "crates/viewer/src/gpu.rs", "crates/viewer/src/web/", "crates/viewer/src/web.rs"];

/// Check the declared dependencies and the sources; print what is wrong.
pub(crate) fn run() -> Result<(), String> {
    let mut complaints: Vec<String> = project::packages()?.iter().flat_map(trespasses).collect();
    for file in sizes::rust_files()? {
        let text = fs::read_to_string(place::root().join(&file)).map_err(|error| error.to_string())?;
        complaints.extend(browser_questions(&file, &text));
    }
    if complaints.is_empty() {
        println!("layers: every dependency points the right way");
        return Ok(());
    }
    complaints.iter().for_each(|complaint| println!("layers: {complaint}"));
    Err(format!("{} breaches of the layers (the tables are in crates/xtask/src/layers.rs)", complaints.len()))
}

fn is_member(name: &str) -> bool {
    name == ACCEPTANCE || MEMBERS.iter().any(|(member, _)| *member == name)
}

/// The declared dependencies of a member that its layer does not allow.
fn trespasses(package: &Package) -> Vec<String> {
    if package.name == ACCEPTANCE {
        return Vec::new();
    }
    let Some((_, may_use)) = MEMBERS.iter().find(|(member, _)| *member == package.name) else {
        return vec![format!("{} is new: give it a row in the table", package.name)];
    };
    let mut complaints = Vec::new();
    for dependency in &package.dependencies {
        let name = dependency.name.as_str();
        // The tests of a member may use any library, but of the other members only what the member itself may.
        let trespass = if name == ACCEPTANCE && dependency.is_dev && package.name == ACCEPTANCE_IN_BROWSER {
            None
        } else if is_member(name) {
            (name != package.name && !may_use.contains(&name)).then_some("lies in a layer it must not see")
        } else if dependency.is_dev || ANYWHERE.contains(&name) {
            None
        } else {
            match HOMES.iter().find(|(library, _)| *library == name) {
                Some((_, homes)) if homes.contains(&package.name.as_str()) => None,
                Some(_) => Some("is at home elsewhere"),
                None => Some("has no home yet, or is for tests only"),
            }
        };
        complaints.extend(trespass.map(|why| format!("{} uses {name}, which {why}", package.name)));
    }
    complaints
}

/// Lines that ask for the target outside the crates that are about the browser, tests excepted.
fn browser_questions(file: &Path, text: &str) -> Vec<String> {
    let path = file.to_string_lossy().replace('\\', "/");
    if BROWSER_CODE.iter().any(|prefix| path.starts_with(prefix)) || sizes::is_test_file(file) {
        return Vec::new();
    }
    let code = text.lines().take(sizes::lines_without_tests(text)).enumerate();
    let asks = |line: &str| line.contains("target_arch = \"wasm32\"") && !line.trim_start().starts_with("//");
    code.filter(|(_, line)| asks(line))
        .map(|(index, _)| format!("{path}:{} asks whether it runs in the browser", index + 1))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{browser_questions, trespasses};
    use crate::project::parse_metadata;
    use std::path::Path;

    fn complaints_about(package: &str, dependencies: &[(&str, Option<&str>)]) -> Vec<String> {
        let entries: Vec<String> = dependencies
            .iter()
            .map(|(name, kind)| {
                format!(
                    r#"{{ "name": "{name}", "kind": {} }}"#,
                    kind.map_or("null".into(), |k| format!("{k:?}"))
                )
            })
            .collect();
        let json = format!(
            r#"{{ "packages": [ {{ "name": "{package}", "dependencies": [ {} ], "targets": [] }} ] }}"#,
            entries.join(",")
        );
        parse_metadata(&json).unwrap().iter().flat_map(trespasses).collect()
    }

    #[test]
    fn arrows_that_point_down_are_fine() {
        assert!(
            complaints_about(
                "ductile-solver",
                &[("ductile-mesh", None), ("glam", None), ("proptest", Some("dev"))]
            )
            .is_empty()
        );
        assert!(
            complaints_about("ductile-viewer", &[("ductile-spec", None), ("wgpu", None), ("web-sys", None)])
                .is_empty()
        );
        assert!(complaints_about("acceptance", &[("ductile-viewer", None), ("wgpu", None)]).is_empty());
        assert!(complaints_about("ductile-worker", &[("acceptance", Some("dev"))]).is_empty());
    }

    #[test]
    fn arrows_that_point_up_are_not() {
        for (package, above) in [
            ("ductile-mesh", "ductile-solver"),
            ("ductile-viewer", "ductile-modeler"),
            ("ductile-solver", "ductile-spec"),
            ("ductile-spec", "acceptance"),
            ("ductile-solver", "acceptance"),
        ] {
            assert_eq!(complaints_about(package, &[(above, None)]).len(), 1, "{package} -> {above}");
            assert_eq!(
                complaints_about(package, &[(above, Some("dev"))]).len(),
                1,
                "{package} -> {above} in tests"
            );
        }
    }

    #[test]
    fn libraries_stay_at_home() {
        for (package, library) in [
            ("ductile-modeler", "wgpu"),
            ("ductile-solver", "serde"),
            ("ductile-cli", "wasm-bindgen"),
            ("ductile-mesh", "proptest"),
            ("ductile-mesh", "getrandom"),
        ] {
            assert_eq!(complaints_about(package, &[(library, None)]).len(), 1, "{package} -> {library}");
        }
        assert!(complaints_about("ductile-solver", &[("serde_json", Some("dev"))]).is_empty());
    }

    #[test]
    fn a_new_crate_needs_a_row() {
        assert_eq!(complaints_about("ductile-novel", &[]).len(), 1);
    }

    #[test]
    fn only_browser_code_asks_for_the_browser() {
        let text = "fn f() {}\n#[cfg(target_arch = \"wasm32\")]\nfn g() {}\n";
        let complaints = browser_questions(Path::new("crates/solver/src/cg.rs"), text);
        assert_eq!(complaints, ["crates/solver/src/cg.rs:2 asks whether it runs in the browser"]);
        assert!(browser_questions(Path::new("crates/worker/src/main.rs"), text).is_empty());
        assert!(browser_questions(Path::new("crates/viewer/src/web/canvas.rs"), text).is_empty());
        assert!(browser_questions(Path::new("crates/mesh/tests/core.rs"), text).is_empty());
        let only_in_tests =
            "fn f() {}\n\n#[cfg(test)]\nmod tests {\n    #[cfg_attr(target_arch = \"wasm32\", x)]\n}\n";
        assert!(browser_questions(Path::new("crates/mesh/src/flip.rs"), only_in_tests).is_empty());
    }
}
