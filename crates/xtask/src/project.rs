//! What cargo knows about the workspace.

use crate::place;
use crate::shell::Run;
use serde_json::Value;
use std::fs;
use std::path::PathBuf;

/// A member of the workspace.
#[derive(Debug)]
pub(crate) struct Package {
    pub(crate) name: String,
    /// Where it lies, relative to the top.
    pub(crate) folder: PathBuf,
    pub(crate) dependencies: Vec<Dependency>,
}

/// A declared dependency of a member, on another member or on a library from outside.
#[derive(Debug)]
pub(crate) struct Dependency {
    pub(crate) name: String,
    pub(crate) is_dev: bool,
}

/// All members, by `cargo metadata`.
pub(crate) fn packages() -> Result<Vec<Package>, String> {
    let json = Run::cargo()
        .args(["metadata", "--no-deps", "--format-version", "1"])
        .answer()
        .ok_or("`cargo metadata` failed: is Cargo.toml in order?")?;
    parse_metadata(&json)
}

pub(crate) fn parse_metadata(json: &str) -> Result<Vec<Package>, String> {
    let metadata: Value = serde_json::from_str(json).map_err(|error| error.to_string())?;
    let packages = metadata["packages"].as_array().ok_or("cargo metadata lists no packages")?;
    Ok(packages.iter().map(parse_package).collect())
}

fn parse_package(package: &Value) -> Package {
    let list = |key: &str| package[key].as_array().into_iter().flatten();
    let dependencies = list("dependencies")
        .map(|entry| Dependency { name: text(&entry["name"]), is_dev: entry["kind"] == "dev" })
        .collect();
    let manifest = PathBuf::from(text(&package["manifest_path"]));
    let folder = manifest.parent().unwrap_or(&manifest);
    let folder = folder.strip_prefix(place::root()).unwrap_or(folder).to_owned();
    Package { name: text(&package["name"]), folder, dependencies }
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

/// The version of a package in Cargo.lock.
pub(crate) fn locked_version(package: &str) -> Option<String> {
    version_in_lock(&fs::read_to_string(place::root().join("Cargo.lock")).ok()?, package)
}

fn version_in_lock(lock: &str, package: &str) -> Option<String> {
    let entry = format!("name = \"{package}\"");
    let version = lock.lines().skip_while(|line| *line != entry).nth(1)?;
    Some(version.strip_prefix("version = \"")?.strip_suffix('"')?.to_owned())
}

#[cfg(test)]
mod tests {
    use super::{parse_metadata, version_in_lock};
    use crate::place;
    use std::path::Path;

    #[test]
    fn metadata_gives_place_and_dependencies() {
        let manifest = place::root().join("crates/worker/Cargo.toml");
        let json = r#"{ "packages": [ { "name": "worker", "manifest_path": MANIFEST,
            "dependencies": [ { "name": "spec", "kind": null }, { "name": "proptest", "kind": "dev" } ] } ] }"#;
        let json = json.replace("MANIFEST", &serde_json::to_string(&manifest).unwrap());
        let packages = parse_metadata(&json).unwrap();
        let worker = &packages[0];
        assert_eq!(worker.name, "worker");
        assert_eq!(worker.folder, Path::new("crates/worker"));
        let kinds: Vec<_> = worker.dependencies.iter().map(|d| (d.name.as_str(), d.is_dev)).collect();
        assert_eq!(kinds, [("spec", false), ("proptest", true)]);
    }

    #[test]
    fn what_is_not_metadata_is_refused() {
        assert!(parse_metadata("{}").is_err());
        assert!(parse_metadata("error: no such file").is_err());
    }

    #[test]
    fn the_lock_names_one_version() {
        let lock =
            "[[package]]\nname = \"wasm-bindgen\"\nversion = \"0.2.130\"\n\n[[package]]\nname = \"wgpu\"\n";
        assert_eq!(version_in_lock(lock, "wasm-bindgen").as_deref(), Some("0.2.130"));
        assert_eq!(version_in_lock(lock, "wasm"), None);
        assert_eq!(version_in_lock(lock, "wgpu"), None);
    }
}
