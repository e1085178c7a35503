//! `ductile verify`: computes the figures of a reference file again, from the inputs in it, and compares.
//!
//! A file is known by its fields, not by its name; each format is one file of this module. What a format has no rule for
//! is never passed over in silence: it is told, and then the file is not verified. To add a format, write its `check` and
//! give it a line in [`FORMATS`].

mod blend;
mod cage;
mod disc;
mod displacement;
mod energy;
mod family;
mod gradient;
pub(crate) mod json;
mod mesh;
#[cfg(test)]
mod mutation_test;
mod param_map;
pub(crate) mod reader;
pub(crate) mod report;
mod rest;
pub(crate) mod rules;
mod s_patch;
mod smooth;
mod tolerances;

use crate::input::{self, CliError};
use reader::{Fields, Flaw, Item};
use report::Report;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Options of `verify`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Reference files, or - for standard input
    #[arg(required = true)]
    files: Vec<PathBuf>,
}

type Check = fn(&Fields<'_>, &mut Report) -> Result<(), Flaw>;

/// What a file is called, the fields by which it is known, and what checks it. The first that fits is taken.
const FORMATS: &[(&str, &[&str], Check)] = &[
    ("energies of meshes", &["meshes"], energy::check),
    ("gradient", &["vertices", "triangles", "gradient"], gradient::check),
    ("cage surfaces", &["cases[].cage"], cage::check),
    ("parameter maps", &["maps"], param_map::check),
    ("S-patch", &["ribbons"], s_patch::check),
    ("displacement blends", &["cases[].triangles"], displacement::check),
    ("blend functions", &["columns", "rows"], blend::check),
    ("blend functions", &["range_columns", "range_rows"], blend::check),
    ("raised disc", &["vertices", "triangles", "heights_at_radii", "cases"], disc::check),
];

/// Verifies every file: 0 when all are verified, 1 when one is not, 2 when one cannot be read.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    let mut worst = 0_u8;
    for file in &options.files {
        let status = match verify(file) {
            Ok((format, report)) => {
                input::write("-".as_ref(), &format!("{}: {format}\n{report}", file.display()))?;
                u8::from(!report.holds())
            }
            Err(error) => {
                eprintln!("ductile: {error}");
                2
            }
        };
        worst = worst.max(status);
    }
    Ok(ExitCode::from(worst))
}

fn verify(file: &Path) -> Result<(&'static str, Report), CliError> {
    let bad = |reason: String| CliError::Refused { file: file.to_owned(), reason };
    let text = input::read_up_to(file, MOST_BYTES)?;
    let json: json::Json = json::read(&text).map_err(&bad)?;
    check(&json).map_err(|flaw| bad(flaw.to_string()))
}

/// Largest reference file, in bytes.
const MOST_BYTES: usize = 64 << 20;

fn check(json: &json::Json) -> Result<(&'static str, Report), Flaw> {
    let fields = Item::root(json).fields()?;
    let mut report = Report::default();
    let fits = |known: &&[&str]| known.iter().all(|name| fields.has(name));
    let Some((format, _, check)) = FORMATS.iter().find(|(_, known, _)| fits(known)) else {
        let names: Vec<&str> = fields.names().collect();
        report.pass_over("the file", &format!("its format is not known (fields: {})", names.join(", ")));
        return Ok(("unknown", report));
    };
    check(&fields, &mut report)?;
    fields.finish(&mut report);
    Ok((*format, report))
}
