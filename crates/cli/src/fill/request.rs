//! What a file of ribbons asks for: one patch, or several.

use super::{CliError, MOST_BYTES};
use crate::input;
use crate::ribbon_file;
use crate::verify::json::{self, Json};
use crate::verify::reader::{Fields, Flaw, Item};
use crate::verify::report::Report;
use ductile_patch::Ribbon;
use ductile_patch::s_patch::{Fill, Join};
use ductile_spec::{RibbonHole, ribbon_holes};
use std::path::Path;

/// One hole.
pub(super) struct Request {
    pub(super) ribbons: Vec<Ribbon>,
    pub(super) join: Join,
    pub(super) fill: Fill,
}

/// Reads a file of text (`.gbp`), or one of JSON: an object with `ribbons`, an object with `patches`, a list of such objects, or a list of ribbons.
pub(super) fn read(file: &Path) -> Result<Vec<Request>, CliError> {
    let bad = |reason: String| CliError::Refused { file: file.to_owned(), reason };
    let text = input::read_up_to(file, MOST_BYTES)?;
    let json: Json = match json::read(&text) {
        Ok(json) => json,
        Err(reason) => {
            // No JSON: a file of text, or nothing that is known.
            let of_text = ribbon_holes(&text).ok_or_else(|| bad(reason))?;
            let holes = of_text.map_err(|reason| bad(reason.to_string()))?;
            return Ok(holes.into_iter().map(of_hole).collect());
        }
    };
    let found = requests(&Item::root(&json)).map_err(|flaw| bad(flaw.to_string()))?;
    if found.is_empty() {
        return Err(bad("there are no ribbons".into()));
    }
    Ok(found)
}

fn of_hole(hole: RibbonHole) -> Request {
    let ribbons = hole.ribbons.into_iter().map(|ribbon| Ribbon { row0: ribbon.row0, row1: ribbon.row1 });
    Request { ribbons: ribbons.collect(), join: Join::Tangent, fill: Fill::Biharmonic }
}

fn requests(root: &Item<'_>) -> Result<Vec<Request>, Flaw> {
    if root.is_list() {
        let is_ribbon = |item: Item<'_>| item.fields().is_ok_and(|fields| fields.has("row0"));
        if root.list()?.any(is_ribbon) {
            return Ok(vec![Request {
                ribbons: ribbon_file::ribbons(root, &mut Report::default())?,
                join: Join::Tangent,
                fill: Fill::Biharmonic,
            }]);
        }
        return root.list()?.map(|item| request(&item.fields()?)).collect();
    }
    let fields = root.fields()?;
    match fields.get("patches") {
        Some(list) => list.list()?.map(|item| request(&item.fields()?)).collect(),
        None => Ok(vec![request(&fields)?]),
    }
}

/// Fields that say again what the ribbons say must agree with them; results that a reference file records are not read.
fn request(fields: &Fields<'_>) -> Result<Request, Flaw> {
    let ribbons = ribbon_file::ribbons(&fields.need("ribbons")?, &mut Report::default())?;
    let degree = ribbons.iter().map(Ribbon::degree).max().unwrap_or(0);
    for (name, found) in [("sides", ribbons.len()), ("ribbon_degree", degree)] {
        if let Some(item) = fields.get(name) {
            let told = item.count()?;
            if told != found {
                return Err(item.flaw(format!("{told} is told here, and the ribbons have {found}")));
            }
        }
    }
    let mut join = Join::Tangent;
    if let Some(item) = fields.get("depth") {
        let depth = item.count()?;
        let fits = |join: &Join| join.depth(degree) == depth;
        let found = [Join::Tangent, Join::Position].into_iter().find(fits);
        join = found.ok_or_else(|| {
            let (tangent, position) = (Join::Tangent.depth(degree), degree);
            item.flaw(format!(
                "degree {degree} makes depth {tangent}, or {position} for position only, not {depth}"
            ))
        })?;
    }
    let mut fill = Fill::Biharmonic;
    if let Some(item) = fields.get("interior_fill") {
        let name = item.text()?;
        fill = ribbon_file::fill_named(name)
            .ok_or_else(|| item.flaw(format!("`{name}` is neither `biharmonic` nor `harmonic`")))?;
    }
    Ok(Request { ribbons, join, fill })
}
