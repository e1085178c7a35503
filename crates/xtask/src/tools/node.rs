//! The packages of `tests/browser`: Binaryen's `wasm-opt` and the library that drives Chromium.

use super::{State, Tool, installer, version_number};
use crate::place;
use crate::shell::Run;
use std::fs;
use std::path::PathBuf;

pub(super) const ADVICE: &str =
    "Fix: install node (20 or later) with npm, then run `npm ci` in tests/browser.";

/// Binaryen before this writes modules that die at the start of the page (Debian 12 has 108).
const OLDEST_WASM_OPT: u32 = 116;
const OLDEST_NODE: u32 = 20;

pub(super) fn state() -> State {
    if let Err(reason) = check_node() {
        return State::Missing(reason);
    }
    if fs::read(lock()).ok() != fs::read(stamp()).ok() {
        return State::Missing("tests/browser/node_modules is not up to date".to_owned());
    }
    let said = Run::new("wasm-opt").args(["--version"]).answer();
    match said.as_deref().and_then(version_number).and_then(|version| version.parse::<u32>().ok()) {
        Some(found) if found >= OLDEST_WASM_OPT => State::Ready(format!("up to date, wasm-opt {found}")),
        Some(found) => {
            State::Missing(format!("wasm-opt {found} breaks the page, {OLDEST_WASM_OPT} or later needed"))
        }
        None => State::Missing("wasm-opt not found".to_owned()),
    }
}

fn check_node() -> Result<(), String> {
    let version = Run::new("node").args(["--version"]).answer().ok_or("node not found")?;
    let major = version.trim_start_matches('v').split('.').next().and_then(|major| major.parse::<u32>().ok());
    match major {
        Some(major) if major >= OLDEST_NODE => Ok(()),
        _ => Err(format!("node {version} is too old, {OLDEST_NODE} needed")),
    }
}

pub(super) fn install() -> Result<(), String> {
    check_node()?;
    let run = Run::new("npm").args(["ci", "--no-audit", "--no-fund"]).within(&place::browser_tests());
    installer(Tool::NodePackages, run)?;
    fs::copy(lock(), stamp()).map(drop).map_err(|error| error.to_string())
}

fn lock() -> PathBuf {
    place::browser_tests().join("package-lock.json")
}

/// A copy of the lock file that `node_modules` was made from.
fn stamp() -> PathBuf {
    place::browser_tests().join("node_modules/.made-from.json")
}
