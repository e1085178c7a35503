//! What the workshop needs beyond rustup's stable toolchain, and how each thing is had.

mod browser;
mod node;
mod rust;

pub(crate) use browser::{chromium, webdriver};

use crate::shell::Run;
use std::thread;
use std::time::Instant;

/// Something that must be on the machine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    /// The standard library for `wasm32-unknown-unknown`.
    WasmTarget,
    /// `wasm-bindgen` and its test runner, in exactly the version of Cargo.lock.
    WasmBindgen,
    /// Builds the page and serves it.
    Trunk,
    /// `wasm-opt`, which makes the release build small, and the library that drives the browser.
    NodePackages,
    /// Chromium and its driver, for the tests.
    Browser,
}

/// Everything.
pub(crate) const ALL: &[Tool] =
    &[Tool::WasmTarget, Tool::WasmBindgen, Tool::Trunk, Tool::NodePackages, Tool::Browser];
/// For a debug build of the page.
pub(crate) const PAGE: &[Tool] = &[Tool::WasmTarget, Tool::WasmBindgen, Tool::Trunk];
/// For a release build of the page.
pub(crate) const RELEASE_PAGE: &[Tool] =
    &[Tool::WasmTarget, Tool::WasmBindgen, Tool::Trunk, Tool::NodePackages];

/// Whether a tool can be used as it is.
#[derive(Debug)]
pub(crate) enum State {
    /// Present; which version, or where.
    Ready(String),
    /// Absent or not usable; why.
    Missing(String),
}

impl Tool {
    fn name(self) -> &'static str {
        match self {
            Self::WasmTarget => "wasm32 target",
            Self::WasmBindgen => "wasm-bindgen",
            Self::Trunk => "trunk",
            Self::NodePackages => "npm packages",
            Self::Browser => "chromium",
        }
    }

    fn state(self) -> State {
        match self {
            Self::WasmTarget => rust::target_state(),
            Self::WasmBindgen => rust::bindgen_state(),
            Self::Trunk => rust::trunk_state(),
            Self::NodePackages => node::state(),
            Self::Browser => browser::state(),
        }
    }

    fn install(self) -> Result<(), String> {
        match self {
            Self::WasmTarget => rust::install_target(),
            Self::WasmBindgen => rust::install_bindgen(),
            Self::Trunk => rust::install_trunk(),
            Self::NodePackages => node::install(),
            Self::Browser => browser::install(),
        }
    }

    /// What a person can do when we cannot.
    fn advice(self) -> String {
        match self {
            Self::WasmTarget => rust::TARGET_ADVICE.to_owned(),
            Self::WasmBindgen => rust::bindgen_advice(),
            Self::Trunk => rust::trunk_advice(),
            Self::NodePackages => node::ADVICE.to_owned(),
            Self::Browser => browser::ADVICE.to_owned(),
        }
    }
}

/// Install what is missing of these, all at once, since each leaves the machine idle for a part of its time.
pub(crate) fn ensure(tools: &[Tool]) -> Result<(), String> {
    let missing: Vec<(Tool, String)> = tools.iter().filter_map(|&tool| lack(tool)).collect();
    if missing.is_empty() {
        return Ok(());
    }
    for (tool, reason) in &missing {
        println!("{}: {reason}", tool.name());
    }
    println!("Installing, once; on two cores this takes a few minutes.");
    let start = Instant::now();
    let failures: Vec<String> = thread::scope(|scope| {
        let jobs: Vec<_> = missing.iter().map(|&(tool, _)| scope.spawn(move || install(tool))).collect();
        jobs.into_iter()
            .filter_map(|job| job.join().unwrap_or_else(|_| Err("an installer panicked".into())).err())
            .collect()
    });
    if failures.is_empty() {
        println!("Installed everything that was missing in {} s.", start.elapsed().as_secs());
        Ok(())
    } else {
        Err(failures.join("\n"))
    }
}

/// Whether none of these is missing.
pub(crate) fn are_ready(tools: &[Tool]) -> bool {
    tools.iter().all(|&tool| lack(tool).is_none())
}

fn lack(tool: Tool) -> Option<(Tool, String)> {
    match tool.state() {
        State::Ready(_) => None,
        State::Missing(reason) => Some((tool, reason)),
    }
}

fn install(tool: Tool) -> Result<(), String> {
    let trouble = match tool.install() {
        Err(message) => message,
        Ok(()) => match tool.state() {
            State::Ready(_) => return Ok(()),
            State::Missing(reason) => reason,
        },
    };
    Err(format!("{} could not be installed: {trouble}.\n  {}", tool.name(), tool.advice()))
}

/// Report on every tool; an error when one is missing.
pub(crate) fn doctor() -> Result<(), String> {
    let mut missing = 0;
    for &tool in ALL {
        match tool.state() {
            State::Ready(what) => println!("ok       {}: {what}", tool.name()),
            State::Missing(reason) => {
                missing += 1;
                println!("MISSING  {}: {reason}\n         {}", tool.name(), tool.advice());
            }
        }
    }
    if missing == 0 {
        return Ok(());
    }
    println!("\n`cargo xtask tools` installs what is missing, as far as it can.");
    Err(String::new())
}

/// Run an installer and pass on what it says, marked with the name of the tool.
fn installer(tool: Tool, run: Run) -> Result<(), String> {
    run.lines(|line| {
        if !line.is_empty() {
            println!("{:>13} | {line}", tool.name());
        }
    })
}

/// The dotted number in a line such as `trunk 0.21.14` or `wasm-opt version 132 (version_132)`.
fn version_number(line: &str) -> Option<&str> {
    line.split_whitespace().find(|word| word.starts_with(|c: char| c.is_ascii_digit()))
}

#[cfg(test)]
mod tests {
    use super::version_number;

    #[test]
    fn versions_are_found_in_what_tools_say() {
        assert_eq!(version_number("trunk 0.21.14"), Some("0.21.14"));
        assert_eq!(version_number("wasm-opt version 132 (version_132)"), Some("132"));
        assert_eq!(
            version_number("Chromium 156.0.8078.79 built on Debian GNU/Linux 12"),
            Some("156.0.8078.79")
        );
        assert_eq!(version_number("v20.20.2"), None);
    }
}
