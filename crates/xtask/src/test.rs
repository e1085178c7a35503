//! Running every test and adding up.

use crate::place;
use crate::shell::{Run, step};
use crate::tally::Tally;
use crate::tools;
use crate::wasm;
use crate::web;
use std::fs;

/// One of the three kinds of tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Suite {
    /// Unit, property, fixture and documentation tests.
    Native,
    /// The tests of the core once more, in the page and in a worker of a headless Chromium.
    Wasm,
    /// The release build of the page, driven by the end-to-end tests.
    Page,
}

/// Every test.
pub(crate) const ALL: &[Suite] = &[Suite::Native, Suite::Wasm, Suite::Page];

/// What one end-to-end test may take: a software rasteriser on a busy machine is slow.
const PAGE_TEST_LIMIT: &str = "--test-timeout=180000";

/// `cargo xtask test`: the last line is the total.
pub(crate) fn run(arguments: &[&str]) -> Result<(), String> {
    conclude(suites(&choose(arguments)?))
}

fn choose(arguments: &[&str]) -> Result<Vec<Suite>, String> {
    let suite = |argument: &&str| match *argument {
        "native" | "--quick" => Ok(Suite::Native),
        "wasm" => Ok(Suite::Wasm),
        "page" => Ok(Suite::Page),
        _ => Err(format!("test does not know `{argument}`: --quick, or one or more of native, wasm, page")),
    };
    if arguments.is_empty() { Ok(ALL.to_vec()) } else { arguments.iter().map(suite).collect() }
}

/// Print the total, alone on the last line. The error is empty, since nothing may follow that line.
pub(crate) fn conclude(tally: Tally) -> Result<(), String> {
    println!("\n{tally}");
    if tally.failed == 0 { Ok(()) } else { Err(String::new()) }
}

/// Run the suites one after the other, all of them even when one fails.
pub(crate) fn suites(chosen: &[Suite]) -> Tally {
    let mut tally = Tally::default();
    if chosen.contains(&Suite::Native) {
        tally += native();
    }
    if chosen.iter().all(|suite| *suite == Suite::Native) {
        return tally;
    }
    if let Err(message) = tools::ensure(tools::ALL) {
        tally += broken("the tests in the browser cannot run", &message);
        return tally;
    }
    if chosen.contains(&Suite::Wasm) {
        tally += wasm::tests();
    }
    if chosen.contains(&Suite::Page) {
        tally += page();
    }
    tally
}

fn native() -> Tally {
    counted(
        "native tests",
        |_| (),
        || Ok(Run::cargo().args(["test", "--workspace", "--locked", "--no-fail-fast"])),
    )
}

fn page() -> Tally {
    let page = place::tested_page();
    if let Err(message) = web::build(&page) {
        return broken("the page cannot be built", &message);
    }
    counted(
        "end-to-end tests",
        |_| (),
        || {
            let mut files: Vec<String> = fs::read_dir(place::browser_tests())
                .map_err(|error| error.to_string())?
                .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
                .filter(|name| name.ends_with(".test.mjs"))
                .collect();
            files.sort();
            let browser = tools::chromium().ok_or("no Chromium found")?;
            // One file at a time: the software rasteriser takes a whole core and more.
            Ok(Run::new("node")
                .args(["--test", "--test-reporter=spec", "--test-concurrency=1", PAGE_TEST_LIMIT])
                .args(files)
                .within(&place::browser_tests())
                .env("CHROME", browser)
                .env("DUCTILE_PAGE", page))
        },
    )
}

/// Run a test runner, show what it says, and count. One that fails without naming a failed test counts as one failure.
pub(crate) fn counted(
    title: &str,
    mut listen: impl FnMut(&str),
    prepare: impl FnOnce() -> Result<Run, String>,
) -> Tally {
    step(title, || {
        let mut tally = Tally::default();
        let outcome = prepare().and_then(|run| {
            run.lines(|line| {
                println!("{line}");
                tally += Tally::of_line(line);
                listen(line);
            })
        });
        match outcome {
            Err(message) if tally.failed == 0 => tally += broken(title, &message),
            Ok(()) if tally.passed == 0 => tally += broken(title, "no test ran"),
            _ => (),
        }
        tally
    })
}

/// A failure that is not a test's own.
pub(crate) fn broken(title: &str, message: &str) -> Tally {
    println!("FAILED: {title}: {message}");
    Tally { passed: 0, failed: 1 }
}

#[cfg(test)]
mod tests {
    use super::{ALL, Suite, choose};

    #[test]
    fn suites_are_chosen_by_name() {
        assert_eq!(choose(&[]).unwrap(), ALL);
        assert_eq!(choose(&["--quick"]).unwrap(), [Suite::Native]);
        assert_eq!(choose(&["wasm", "page"]).unwrap(), [Suite::Wasm, Suite::Page]);
        assert!(choose(&["--fast"]).is_err());
    }
}
