//! The length of source files, tests left out: past 400 lines a file has usually come to hold two ideas.

use crate::place;
use std::fs;
use std::path::{Path, PathBuf};

const LONG: usize = 400;
const TOO_LONG: usize = 600;

/// Warn of long files, fail on too long ones.
pub(crate) fn run() -> Result<(), String> {
    let mut too_long = 0;
    let mut files = 0;
    for file in rust_files()?.into_iter().chain(shader_files()?) {
        files += 1;
        if is_test_file(&file) {
            continue;
        }
        let text = fs::read_to_string(place::root().join(&file)).map_err(|error| error.to_string())?;
        let lines = lines_without_tests(&text);
        if lines > LONG {
            let remark = if lines > TOO_LONG { "too long" } else { "long" };
            println!("sizes: {} is {remark}: {lines} lines without tests", file.display());
        }
        too_long += usize::from(lines > TOO_LONG);
    }
    if too_long > 0 {
        return Err(format!("{too_long} files are longer than {TOO_LONG} lines; split them by idea"));
    }
    println!("sizes: none of {files} files is longer than {TOO_LONG} lines");
    Ok(())
}

/// Lines before the unit tests, which sit at the end of a file.
pub(crate) fn lines_without_tests(text: &str) -> usize {
    text.lines().take_while(|line| *line != "#[cfg(test)]").count()
}

/// Whether the file holds nothing but tests or benches.
pub(crate) fn is_test_file(file: &Path) -> bool {
    let in_test_folder =
        file.components().any(|part| part.as_os_str() == "tests" || part.as_os_str() == "benches");
    in_test_folder
        || file
            .file_stem()
            .and_then(|stem| stem.to_str())
            .is_some_and(|stem| stem == "tests" || stem.ends_with("_test"))
}

/// The Rust sources of all members, relative to the top, sorted.
pub(crate) fn rust_files() -> Result<Vec<PathBuf>, String> {
    files_with_extension(&["crates", "tests"], "rs")
}

fn shader_files() -> Result<Vec<PathBuf>, String> {
    files_with_extension(&["shaders"], "wgsl")
}

fn files_with_extension(folders: &[&str], extension: &str) -> Result<Vec<PathBuf>, String> {
    let mut found = Vec::new();
    let mut left: Vec<PathBuf> = folders.iter().map(PathBuf::from).collect();
    while let Some(folder) = left.pop() {
        let Ok(entries) = fs::read_dir(place::root().join(&folder)) else {
            continue;
        };
        for entry in entries {
            let entry = entry.map_err(|error| error.to_string())?;
            let path = folder.join(entry.file_name());
            let kind = entry.file_type().map_err(|error| error.to_string())?;
            if kind.is_dir() && entry.file_name() != "node_modules" && entry.file_name() != "target" {
                left.push(path);
            } else if kind.is_file() && path.extension().is_some_and(|found| found == extension) {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::{is_test_file, lines_without_tests};
    use std::path::Path;

    #[test]
    fn tests_at_the_end_do_not_count() {
        assert_eq!(lines_without_tests("fn f() {}\n\n#[cfg(test)]\nmod tests {\n}\n"), 2);
        assert_eq!(lines_without_tests("fn f() {}\nfn g() {}\n"), 2);
        assert_eq!(lines_without_tests(""), 0);
    }

    #[test]
    fn test_files_are_known_by_their_place() {
        assert!(is_test_file(Path::new("crates/mesh/src/topology/tests.rs")));
        assert!(is_test_file(Path::new("crates/worker/tests/core_in_browser.rs")));
        assert!(is_test_file(Path::new("crates/solver/benches/step.rs")));
        assert!(!is_test_file(Path::new("crates/xtask/src/test.rs")));
    }
}
