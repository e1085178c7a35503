//! The core's own tests in a headless Chromium: once in the page, once in a dedicated worker.
//!
//! They are the functions that run natively too: in the browser `#[test]` stands for `wasm_bindgen_test`, by one `use`
//! in every module of tests. The runner is told by its environment where to run them, so one build serves both places.
//! What the compiler drops without a word is looked for here: a module without that `use`, a program without tests,
//! a program that the browser never ran.

use crate::place;
use crate::project::{self, Package};
use crate::shell::Run;
use crate::sizes;
use crate::tally::Tally;
use crate::test::{broken, counted};
use crate::tools;
use std::fs;

/// What a member depends on when its tests run in the browser.
const RUNNER: &str = "wasm-bindgen-test";
/// The `use` of such a module of tests, and the mark of a file of tests that stays native.
const HEARD: &str = "use wasm_bindgen_test::wasm_bindgen_test as test;";
const NATIVE: &str = "#![cfg(not(target_arch = \"wasm32\"))]";

/// Where the tests run, with the variable that tells the runner so.
const PLACES: [(&str, &str); 2] =
    [("the page", "WASM_BINDGEN_USE_BROWSER"), ("a worker", "WASM_BINDGEN_USE_DEDICATED_WORKER")];

/// Seconds that the tests of one program may take: Chromium on a busy machine is slow.
const PROGRAM_LIMIT: &str = "300";

/// Run them all in both places.
pub(crate) fn tests() -> Tally {
    let packages = match project::packages() {
        Ok(packages) => packages.into_iter().filter(runs_here).collect::<Vec<_>>(),
        Err(message) => return broken("the tests for the browser cannot be listed", &message),
    };
    let mut tally = Tally::default();
    match deaf_files(&packages) {
        Ok(files) => {
            let message = format!("has tests but not `{HEARD}`, so the browser would pass over them");
            files.iter().for_each(|file| tally += broken(file, &message));
        }
        Err(message) => tally += broken("the tests for the browser cannot be read", &message),
    }
    let [page, worker] = PLACES.map(|place| run_in(place, &packages));
    if page.passed + page.failed != worker.passed + worker.failed {
        tally += broken("tests in the browser", &format!("{page} in the page, but {worker} in a worker"));
    }
    tally += page;
    tally += worker;
    tally
}

fn runs_here(package: &Package) -> bool {
    package.dependencies.iter().any(|dependency| dependency.is_dev && dependency.name == RUNNER)
}

fn run_in((place, variable): (&str, &str), packages: &[Package]) -> Tally {
    let title = format!("tests in {place}");
    let mut roll = Roll::default();
    let mut tally = counted(
        &title,
        |line| roll.hear(line),
        || {
            let (settings, driver) = tools::webdriver()?;
            // Not the examples in the documentation: they run natively.
            let how = ["test", "--target", "wasm32-unknown-unknown", "--locked", "--no-fail-fast", "--tests"];
            Ok(Run::cargo()
                .args(how)
                .args(packages.iter().flat_map(|package| ["-p", package.name.as_str()]))
                .env("CARGO_TERM_COLOR", "never")
                .env("CHROMEDRIVER", driver)
                .env("WASM_BINDGEN_TEST_WEBDRIVER_JSON", settings)
                .env("WASM_BINDGEN_TEST_TIMEOUT", PROGRAM_LIMIT)
                .env(variable, "1"))
        },
    );
    for complaint in roll.close() {
        tally += broken(&title, &complaint);
    }
    tally
}

/// Compares the programs that cargo announces with the results that are heard.
#[derive(Debug, Default)]
struct Roll {
    /// The program that runs now, as long as no result was heard.
    silent: Option<String>,
    complaints: Vec<String>,
}

impl Roll {
    fn hear(&mut self, line: &str) {
        let line = line.trim();
        if let Some(program) = line.strip_prefix("Running ").filter(|rest| rest.ends_with(".wasm)")) {
            self.miss();
            self.silent = Some(program.to_owned());
        } else if line.starts_with("test result:") {
            let heard = Tally::of_line(line);
            let Some(program) = self.silent.take() else {
                return self.complaints.push(format!("a result of no announced program: {line}"));
            };
            if heard.passed + heard.failed == 0 {
                self.complaints.push(format!("no test ran in {program}"));
            }
        }
    }

    fn miss(&mut self) {
        self.complaints.extend(self.silent.take().map(|program| format!("no result of {program}")));
    }

    /// What was missed.
    fn close(mut self) -> Vec<String> {
        self.miss();
        self.complaints
    }
}

/// The files of these members whose tests the browser would pass over.
fn deaf_files(packages: &[Package]) -> Result<Vec<String>, String> {
    let mut deaf = Vec::new();
    for file in sizes::rust_files()? {
        if packages.iter().any(|package| file.starts_with(&package.folder)) {
            let text = fs::read_to_string(place::root().join(&file)).map_err(|error| error.to_string())?;
            deaf.extend(is_deaf(&text).then(|| file.display().to_string()));
        }
    }
    Ok(deaf)
}

fn is_deaf(text: &str) -> bool {
    let has = |wanted: &str| text.lines().any(|line| line.trim() == wanted);
    has("#[test]") && !has(HEARD) && !has(NATIVE)
}

#[cfg(test)]
mod tests {
    use super::{Roll, is_deaf};

    fn complaints(output: &str) -> Vec<String> {
        let mut roll = Roll::default();
        output.lines().for_each(|line| roll.hear(line));
        roll.close()
    }

    #[test]
    fn every_program_must_report_a_test() {
        let good = "     Running unittests src/lib.rs (target/debug/deps/mesh-1.wasm)\n\
            Running headless tests in Chrome on `http://127.0.0.1:39001/`\nrunning 3 tests\n\
            test result: ok. 3 passed; 0 failed; 0 ignored; 0 filtered out\n\
            \x20    Running tests/bits.rs (target/debug/deps/bits-1.wasm)\n\
            test result: FAILED. 0 passed; 1 failed; 0 ignored; 0 filtered out\n";
        assert!(complaints(good).is_empty());
        let empty = "     Running tests/bits.rs (target/debug/deps/bits-1.wasm)\nno tests to run!\n";
        assert_eq!(complaints(empty), ["no result of tests/bits.rs (target/debug/deps/bits-1.wasm)"]);
        assert_eq!(complaints(&format!("{empty}{good}{empty}")).len(), 2);
        let ignored = "     Running tests/bits.rs (target/debug/deps/bits-1.wasm)\n\
            test result: ok. 0 passed; 0 failed; 1 ignored; 0 filtered out\n";
        assert_eq!(complaints(ignored), ["no test ran in tests/bits.rs (target/debug/deps/bits-1.wasm)"]);
        assert_eq!(complaints("test result: ok. 3 passed; 0 failed\n").len(), 1);
    }

    #[test]
    fn a_module_of_tests_that_the_browser_would_pass_over_is_found() {
        let import =
            "#[cfg(target_arch = \"wasm32\")]\n    use wasm_bindgen_test::wasm_bindgen_test as test;\n";
        assert!(is_deaf("mod tests {\n    #[test]\n    fn f() {}\n}\n"));
        assert!(!is_deaf(&format!("mod tests {{\n    {import}\n    #[test]\n    fn f() {{}}\n}}\n")));
        assert!(!is_deaf("#![cfg(not(target_arch = \"wasm32\"))]\n#[test]\nfn f() {}\n"));
        assert!(!is_deaf("//! Tests are marked #[test].\nfn f() {}\n"));
    }
}
