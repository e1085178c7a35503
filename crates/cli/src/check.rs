//! `ductile check`: whether a file is a specification that can be built, and what it specifies.

use crate::input::{self, CliError};
use ductile_modeler::Modeler;
use ductile_spec::{Request, to_fragment};
use std::path::Path;

/// Checks and prints a summary.
pub(crate) fn run(file: &Path) -> Result<(), CliError> {
    let (text, document) = input::document(file)?;
    let reply = Modeler::new().handle(Request::OpenText { text });
    if let Some(refusal) = reply.refused {
        return Err(CliError::Refused { file: file.to_owned(), reason: refusal.reason });
    }
    let mut out = format!(
        "{}: {} points, {} curves, {} surfaces; link of {} characters\n",
        if document.name.is_empty() { "unnamed" } else { &document.name },
        document.points.len(),
        document.curves.len(),
        document.surfaces.len(),
        to_fragment(&document).len()
    );
    for span in reply.structure.iter().flat_map(|s| &s.surfaces) {
        let summary = span.summary;
        let sides = if summary.orientable { "orientable" } else { "not orientable" };
        out.push_str(&format!(
            "{}: Euler characteristic {}, {} boundaries, genus {}, {sides}; {} nodes at the stated spacing\n",
            span.id, summary.euler, summary.boundaries, summary.genus, span.vertex_count
        ));
    }
    input::write("-".as_ref(), &out)
}
