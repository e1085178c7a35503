//! `ductile link` and `ductile unlink`: between a spec file and a share link.

use crate::input::{self, CliError};
use ductile_spec::{from_fragment, to_fragment, to_text};
use std::path::Path;

/// Prints the link of a document.
pub(crate) fn link(spec: &Path, base: &str) -> Result<(), CliError> {
    let (_, document) = input::document(spec)?;
    input::write("-".as_ref(), &format!("{base}#{}\n", to_fragment(&document)))
}

/// Prints the document of a link.
pub(crate) fn unlink(link: &str) -> Result<(), CliError> {
    let link = if link == "-" { input::read("-".as_ref())? } else { link.to_owned() };
    input::write("-".as_ref(), &to_text(&from_fragment(&link)?))
}
