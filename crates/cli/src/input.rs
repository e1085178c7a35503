//! Files in and out, with errors that name the file.

use ductile_spec::{Document, ImportFormat, MAX_TEXT_BYTES, TextError, from_text};
use std::io::{Read, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a command failed.
#[derive(Debug, Error)]
pub(crate) enum CliError {
    /// A file could not be read.
    #[error("{}: {reason}", .file.display())]
    Read {
        /// Which file.
        file: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// A file could not be written.
    #[error("{}: {reason}", .file.display())]
    Write {
        /// Which file.
        file: PathBuf,
        /// What the system says.
        reason: std::io::Error,
    },
    /// A file is no document.
    #[error("{}: {reason}", .file.display())]
    Text {
        /// Which file.
        file: PathBuf,
        /// What is wrong, and where.
        reason: TextError,
    },
    /// What a file holds was refused.
    #[error("{}: {reason}", .file.display())]
    Refused {
        /// Which file.
        file: PathBuf,
        /// What is wrong.
        reason: String,
    },
    /// A link holds no document.
    #[error("{0}")]
    Link(#[from] ductile_spec::LinkError),
    /// An option has no sensible value.
    #[error("{0}")]
    Option(String),
}

/// The text of a file, or of standard input for `-`; never more than a document may have.
pub(crate) fn read(file: &Path) -> Result<String, CliError> {
    read_up_to(file, MAX_TEXT_BYTES)
}

/// The text of a file, or of standard input for `-`, of at most that many bytes.
pub(crate) fn read_up_to(file: &Path, most_bytes: usize) -> Result<String, CliError> {
    let fail = |reason| CliError::Read { file: file.to_owned(), reason };
    String::from_utf8(bytes_up_to(file, most_bytes)?)
        .map_err(|_| fail(std::io::Error::new(std::io::ErrorKind::InvalidData, "not UTF-8 text")))
}

/// What is in a file, or on standard input for `-`, at most that many bytes.
pub(crate) fn bytes_up_to(file: &Path, most_bytes: usize) -> Result<Vec<u8>, CliError> {
    let fail = |reason| CliError::Read { file: file.to_owned(), reason };
    let limit = most_bytes as u64 + 1;
    let mut bytes = Vec::new();
    if file.as_os_str() == "-" {
        std::io::stdin().lock().take(limit).read_to_end(&mut bytes).map_err(fail)?;
    } else {
        std::fs::File::open(file).and_then(|f| f.take(limit).read_to_end(&mut bytes)).map_err(fail)?;
    }
    if bytes.len() > most_bytes {
        let reason = format!("the file is longer than {most_bytes} bytes");
        return Err(CliError::Refused { file: file.to_owned(), reason });
    }
    Ok(bytes)
}

/// The format of a mesh file, by the ending of its name.
pub(crate) fn import_format(file: &Path) -> Option<ImportFormat> {
    file.to_str().and_then(ImportFormat::of_name)
}

/// The document in a file.
pub(crate) fn document(file: &Path) -> Result<(String, Document), CliError> {
    let text = read(file)?;
    match from_text(&text) {
        Ok(document) => Ok((text, document)),
        Err(reason) => Err(CliError::Text { file: file.to_owned(), reason }),
    }
}

/// Writes a file, or standard output for `-`.
pub(crate) fn write(file: &Path, text: &str) -> Result<(), CliError> {
    let fail = |reason| CliError::Write { file: file.to_owned(), reason };
    if file.as_os_str() == "-" {
        return std::io::stdout().lock().write_all(text.as_bytes()).map_err(fail);
    }
    std::fs::write(file, text).map_err(fail)
}
