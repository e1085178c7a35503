//! Ribbons in JSON, as the reference files have them: a list of sides with `row0` and, for tangent planes, `row1`.

use crate::verify::reader::{Flaw, Item};
use crate::verify::report::Report;
use ductile_patch::Ribbon;
use ductile_patch::s_patch::Fill;
use glam::DVec3;

/// The ribbons of a list, in the order of their sides: that of the list, or that of the fields `side`. A ribbon without
/// `row1` has an empty one. Fields that are not known are told to the report.
pub(crate) fn ribbons(list: &Item<'_>, report: &mut Report) -> Result<Vec<Ribbon>, Flaw> {
    let items = list.list()?;
    let count = items.len();
    let mut sides: Vec<Option<Ribbon>> = vec![None; count];
    for (at, item) in items.enumerate() {
        let fields = item.fields()?;
        let named = fields.get("side");
        let side = named.as_ref().map_or(Ok(at), |item| item.index(count, "side"))?;
        let row0 = row(&fields.need("row0")?)?;
        let row1 = fields.get("row1").map_or(Ok(Vec::new()), |item| row(&item))?;
        if sides[side].replace(Ribbon { row0, row1 }).is_some() {
            return Err(item.flaw(format!("side {side} is given twice")));
        }
        fields.finish(report);
    }
    // As many different sides as ribbons: none is missing.
    Ok(sides.into_iter().flatten().collect())
}

fn row(item: &Item<'_>) -> Result<Vec<DVec3>, Flaw> {
    item.list()?.map(|point| point.vector()).collect()
}

/// The rule for interior points of that name.
pub(crate) fn fill_named(name: &str) -> Option<Fill> {
    match name {
        "biharmonic" => Some(Fill::Biharmonic),
        "harmonic" => Some(Fill::Harmonic),
        _ => None,
    }
}
