//! Everything that must hold before a change lands.

use crate::layers;
use crate::place;
use crate::shell::{Run, step};
use crate::sizes;
use crate::tally::Tally;
use crate::test;
use crate::tools;
use crate::web;

/// Run all checks and all tests, even after one has failed; the last line is the total, where a failed check counts
/// like a failed test.
pub(crate) fn run() -> Result<(), String> {
    let mut tally = Tally::default();
    tally += check("tools", || tools::ensure(tools::ALL));
    tally += check("format", || Run::cargo().args(["fmt", "--all", "--check"]).attached());
    tally += check("layers", layers::run);
    tally += check("sizes", sizes::run);
    tally += check("lints", || {
        let arguments = ["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"];
        Run::cargo().args(arguments).attached()
    });
    tally += check("lints for the browser", || {
        let what = ["clippy", "--target", "wasm32-unknown-unknown"];
        let members = ["spec", "mesh", "solver", "patch", "modeler", "worker", "viewer"];
        let members = members.map(|member| format!("--package=ductile-{member}"));
        let how = ["--all-targets", "--locked", "--", "-D", "warnings"];
        Run::cargo().args(what).args(members).args(how).attached()
    });
    tally += check("documentation", || {
        let arguments = ["doc", "--workspace", "--no-deps", "--locked"];
        Run::cargo().args(arguments).env("RUSTDOCFLAGS", "-D warnings").attached()
    });
    tally +=
        optional("licences and bans", "cargo-deny", &["--config", ".deny.toml", "check", "bans", "licenses"]);
    tally += optional("spelling", "typos", &["--config", ".typos.toml"]);
    tally += test::suites(test::ALL);
    tally += check("size of the page", || web::report_size(&place::tested_page()));
    test::conclude(tally)
}

fn check(title: &str, work: impl FnOnce() -> Result<(), String>) -> Tally {
    match step(title, work) {
        Ok(()) => Tally::default(),
        Err(message) => test::broken(title, &message),
    }
}

/// A check by a program that takes longer to build than all the others together: only where it is installed.
fn optional(title: &str, program: &str, arguments: &[&str]) -> Tally {
    if place::program(program).is_none() {
        println!("\n== {title}: left out, {program} is not installed");
        return Tally::default();
    }
    check(title, || Run::new(program).args(arguments).attached())
}
