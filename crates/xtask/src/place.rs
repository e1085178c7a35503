//! Where things are in the work tree.

use std::env;
use std::path::{Path, PathBuf};

/// The top of the repository.
pub(crate) fn root() -> &'static Path {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.ancestors().nth(2).expect("crates/xtask lies two folders below the top")
}

/// Our own copies of the command-line tools; they survive a change of `CARGO_TARGET_DIR`, not a `cargo clean`.
pub(crate) fn tools() -> PathBuf {
    root().join("target/tools")
}

/// The package of the end-to-end tests, which is also where npm installs to.
pub(crate) fn browser_tests() -> PathBuf {
    root().join("tests/browser")
}

/// The page that the end-to-end tests load; apart from `dist`, so that a running `serve` is not disturbed.
pub(crate) fn tested_page() -> PathBuf {
    root().join("dist-test")
}

/// Folders in which programs are looked up: npm's first, since the wasm-opt of some distributions breaks the page.
pub(crate) fn search_path() -> Vec<PathBuf> {
    let mut folders = vec![browser_tests().join("node_modules/.bin"), tools().join("bin")];
    folders.extend(env::split_paths(&env::var_os("PATH").unwrap_or_default()));
    folders
}

/// The first program of that name in the search path.
pub(crate) fn program(name: &str) -> Option<PathBuf> {
    let file = format!("{name}{}", env::consts::EXE_SUFFIX);
    search_path().into_iter().map(|folder| folder.join(&file)).find(|path| path.is_file())
}
