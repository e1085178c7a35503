//! The tools that come by rustup and cargo.

use super::{State, Tool, installer, version_number};
use crate::place;
use crate::project;
use crate::shell::Run;
use std::fs;
use std::path::Path;

const TARGET: &str = "wasm32-unknown-unknown";

/// The last Trunk that this compiler builds.
const TRUNK_VERSION: &str = "0.21.14";

pub(super) const TARGET_ADVICE: &str = "Fix: rustup target add wasm32-unknown-unknown \
    (a compiler that did not come by rustup has its own package for it).";

pub(super) fn target_state() -> State {
    let library = Run::new("rustc").args(["--print", "target-libdir", "--target", TARGET]).answer();
    match library {
        Some(folder) if Path::new(&folder).is_dir() => State::Ready(TARGET.to_owned()),
        Some(_) => State::Missing(format!("the compiler has no standard library for {TARGET}")),
        None => State::Missing("rustc does not answer".to_owned()),
    }
}

pub(super) fn install_target() -> Result<(), String> {
    installer(Tool::WasmTarget, Run::new("rustup").args(["target", "add", TARGET]))
}

pub(super) fn bindgen_state() -> State {
    let Some(wanted) = project::locked_version("wasm-bindgen") else {
        return State::Missing("Cargo.lock names no version of it".to_owned());
    };
    // The test runner is a program of its own and some packages leave it out.
    if place::program("wasm-bindgen").is_some() && place::program("wasm-bindgen-test-runner").is_none() {
        return State::Missing("found without wasm-bindgen-test-runner".to_owned());
    }
    exact_version("wasm-bindgen", &wanted)
}

pub(super) fn bindgen_advice() -> String {
    let version = project::locked_version("wasm-bindgen").unwrap_or_default();
    format!("Fix: cargo install wasm-bindgen-cli --version {version}")
}

pub(super) fn trunk_state() -> State {
    exact_version("trunk", TRUNK_VERSION)
}

pub(super) fn trunk_advice() -> String {
    format!("Fix: cargo install trunk --locked --version {TRUNK_VERSION}")
}

fn exact_version(program: &str, wanted: &str) -> State {
    match Run::new(program).args(["--version"]).answer().as_deref().and_then(version_number) {
        Some(found) if found == wanted => State::Ready(found.to_owned()),
        Some(found) => State::Missing(format!("version {found} found, {wanted} needed")),
        None => State::Missing(format!("not found, version {wanted} needed")),
    }
}

/// Not with its own lock file, which asks for packages that are too new for some mirrors of the registry.
/// Without its default feature it has no TLS: it talks to nothing but the browser's driver on this machine.
pub(super) fn install_bindgen() -> Result<(), String> {
    let version = project::locked_version("wasm-bindgen").ok_or("Cargo.lock names no version of it")?;
    let programs = ["--bin", "wasm-bindgen", "--bin", "wasm-bindgen-test-runner"];
    cargo_install(
        Tool::WasmBindgen,
        ["wasm-bindgen-cli", "--version", &version, "--no-default-features"].into_iter().chain(programs),
        &["walrus", "wasmparser", "wasm-bindgen-cli-support"],
    )
}

/// Without its default features it neither looks for updates nor downloads tools: we bring them.
pub(super) fn install_trunk() -> Result<(), String> {
    let what = ["trunk", "--version", TRUNK_VERSION, "--locked", "--no-default-features"];
    cargo_install(Tool::Trunk, what, &[])
}

/// Built fast rather than fast to run: the profiles these programs ship with take two to three times as long to
/// compile, and what they do here takes a moment either way. Packages that would be felt are optimised a little.
fn cargo_install<'a>(
    tool: Tool,
    what: impl IntoIterator<Item = &'a str>,
    optimised: &[&str],
) -> Result<(), String> {
    let build = place::tools().join("build").join(tool.name());
    let profiles = optimised
        .iter()
        .flat_map(|name| ["--config".to_owned(), format!("profile.release.package.{name}.opt-level=1")]);
    // Trunk takes longest and ends in a row of packages that cannot be built side by side: everything else fills the gaps.
    let cargo = if tool == Tool::Trunk { Run::cargo() } else { Run::patient_cargo() };
    let run = cargo
        .args(["install", "--root"])
        .args([place::tools()])
        .args(what)
        .args(profiles)
        .env("CARGO_TARGET_DIR", &build)
        .env("CARGO_PROFILE_RELEASE_OPT_LEVEL", "0")
        .env("CARGO_PROFILE_RELEASE_LTO", "off")
        .env("CARGO_PROFILE_RELEASE_CODEGEN_UNITS", "16")
        .env("CARGO_PROFILE_RELEASE_DEBUG", "false");
    installer(tool, run)?;
    // Kept until now so that an interrupted installation goes on where it was.
    fs::remove_dir_all(&build).map_err(|error| format!("cannot remove {}: {error}", build.display()))
}
