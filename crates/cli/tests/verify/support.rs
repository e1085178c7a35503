//! `ductile verify` as a person calls it, and the reference files that it is tried with.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Exit status, and everything said on both streams.
pub(crate) fn verify(files: &[PathBuf]) -> (i32, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_ductile")).arg("verify").args(files).output().unwrap();
    let said = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap()).concat();
    (output.status.code().unwrap(), said)
}

/// Verifies a text under a name that says nothing.
pub(crate) fn verify_text(text: &str) -> (i32, String) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("some.json");
    fs::write(&file, text).unwrap();
    verify(&[file])
}

/// Where a reference file is.
pub(crate) fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/fixtures").join(name)
}

/// What a reference file holds.
pub(crate) fn load(name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(fixture(name)).unwrap()).unwrap()
}

/// A changed copy of a reference file must end with that status and say that.
pub(crate) fn damaged(name: &str, status: i32, says: &str, change: impl FnOnce(&mut Value)) {
    let before = load(name);
    let mut file = before.clone();
    change(&mut file);
    assert!(file != before, "the damage was none");
    let (found, said) = verify_text(&file.to_string());
    assert_eq!(found, status, "{name}, which should say `{says}`: {said}");
    assert!(said.contains(says), "{name} should say `{says}`: {said}");
}
