//! Reference files of surfaces over cages: cases with a cage, the rules to build with, the quads after the split, and samples.
//!
//! What a case does not say is what the paper says: rational map, Hermite blend of order 2, a linear split where one is needed, and
//! the linear rule at a boundary.

use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::rules::{blend_named, boundary_named, map_named, split_named};
use super::tolerances::{self, Stated};
use ductile_patch::cage::{Blend, Boundary, Cage, CageSurface, Map, Settings};
use glam::DVec3;

const STATED: [Stated; 2] = [
    Stated { name: "point", default: 1e-10, most: 1e-6 },
    Stated { name: "normal", default: 1e-9, most: 1e-5 },
];

/// Conventions that could be others. The rest of them is prose about the construction.
const CONVENTIONS: [(&str, &str); 1] = [("indices", "0-based")];

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let mut tolerance = tolerances::read(file, STATED, report)?;
    if let Some(item) = file.get("conventions").filter(|item| !item.is_text()) {
        let fields = item.fields()?;
        for (name, known) in CONVENTIONS {
            if let Some(item) = fields.get(name).filter(|item| item.text().ok() != Some(known)) {
                report.pass_over(&item.place, "no such convention is known");
            }
        }
        if fields.has("tolerance") {
            tolerance = tolerances::read(&fields, STATED, report)?;
        }
        fields.finish(report);
    }
    for item in file.need("cases")?.list()? {
        let fields = item.fields()?;
        let name = fields.get("name").map(|name| name.text()).transpose()?;
        check_case(&fields, name.unwrap_or("case"), tolerance, report)?;
        fields.finish(report);
    }
    Ok(())
}

fn check_case(fields: &Fields<'_>, name: &str, tolerance: [f64; 2], report: &mut Report) -> Result<(), Flaw> {
    let item = fields.need("cage")?;
    let cage = read_cage(&item, report)?;
    if let Some(open) = fields.get("open")
        && let Some(flag) = recorded(open.flag(), report)
    {
        let [flag, found] = [flag, !cage.is_closed()].map(|is_open| f64::from(u8::from(is_open)));
        report.compare("open", &open.place, flag, found, Tolerance::EXACT);
    }
    let Some(settings) = settings(fields, &cage, report)? else {
        // What was computed by a rule that is not known cannot be compared; the rule was told.
        let _ = (fields.get("quad_mesh"), fields.get("samples"));
        return Ok(());
    };
    let surface = CageSurface::new(&cage, settings).map_err(|reason| item.flaw(reason.to_string()))?;
    if let Some(item) = fields.get("quad_mesh") {
        check_quads(&item, &surface, name, tolerance[0], report)?;
    }
    let Some(samples) = fields.get("samples") else { return Ok(()) };
    for item in samples.list()? {
        let sample = item.fields()?;
        check_sample(&sample, &surface, name, tolerance, report)?;
        sample.finish(report);
    }
    Ok(())
}

fn vectors(item: &Item<'_>) -> Result<Vec<DVec3>, Flaw> {
    item.list()?.map(|vertex| vertex.vector()).collect()
}

fn indices(item: &Item<'_>, limit: usize) -> Result<Vec<u32>, Flaw> {
    let index = |corner: Item<'_>| {
        let index = corner.index(limit, "vertex")?;
        u32::try_from(index).map_err(|_| corner.flaw("there are too many vertices"))
    };
    item.list()?.map(index).collect()
}

fn read_cage(item: &Item<'_>, report: &mut Report) -> Result<Cage, Flaw> {
    let fields = item.fields()?;
    let positions = vectors(&fields.need("vertices")?)?;
    let count = positions.len();
    let faces = fields.need("faces")?.list()?.map(|face| indices(&face, count)).collect::<Result<_, _>>()?;
    fields.finish(report);
    Cage::new(positions, faces).map_err(|reason| item.flaw(reason.to_string()))
}

/// The rules of a case; none when one is not known, which is then told.
fn settings(fields: &Fields<'_>, cage: &Cage, report: &mut Report) -> Result<Option<Settings>, Flaw> {
    let blend = choice(fields, "blend", Blend::Hermite(2), &blend_named, report)?;
    let map = choice(fields, "map", Map::Rational, &map_named, report)?;
    let split = choice(fields, "split", cage.split_needed(), &split_named, report)?;
    let boundary = choice(fields, "boundary_rule", Boundary::Linear, &boundary_named, report)?;
    Ok((|| Some(Settings { map: map?, blend: blend?, split: split?, boundary: boundary? }))())
}

fn choice<T>(
    fields: &Fields<'_>,
    name: &str,
    default: T,
    named: &dyn Fn(&str) -> Option<T>,
    report: &mut Report,
) -> Result<Option<T>, Flaw> {
    let Some(item) = fields.get(name) else { return Ok(Some(default)) };
    let found = named(item.text()?);
    if found.is_none() {
        report.pass_over(&item.place, &format!("no {name} of that name is known"));
    }
    Ok(found)
}

fn check_quads(
    item: &Item<'_>,
    surface: &CageSurface,
    name: &str,
    tolerance: f64,
    report: &mut Report,
) -> Result<(), Flaw> {
    let fields = item.fields()?;
    let count = surface.positions().len();
    if let Some(item) = fields.get("vertices")
        && let Some(list) = recorded(item.list_of(count, "vertices", "of the split"), report)
    {
        for (vertex, found) in list.zip(surface.positions()) {
            let Some(place) = recorded(vertex.vector(), report) else { continue };
            let deviation = place.distance(*found);
            report.judge(&format!("{name}: quad_mesh.vertices"), &vertex.place, deviation, tolerance);
        }
    }
    if let Some(item) = fields.get("quads")
        && let Some(list) = recorded(item.list_of(surface.quads().len(), "quads", "of the split"), report)
    {
        for (quad, found) in list.zip(surface.quads()) {
            let Some(corners) = recorded(indices(&quad, count), report) else { continue };
            let deviation = f64::from(u8::from(corners != *found));
            report.judge(&format!("{name}: quad_mesh.quads"), &quad.place, deviation, 0.0);
        }
    }
    fields.finish(report);
    Ok(())
}

fn check_sample(
    sample: &Fields<'_>,
    surface: &CageSurface,
    name: &str,
    [point_by, normal_by]: [f64; 2],
    report: &mut Report,
) -> Result<(), Flaw> {
    let item = sample.need("quad")?;
    let quad = item.index(surface.quads().len(), "quad")?;
    let (u, v) = (sample.need("u")?.number()?, sample.need("v")?.number()?);
    let found = surface.evaluate(quad, u, v).map_err(|reason| item.flaw(reason.to_string()))?;
    let mut compared = false;
    if let Some(item) = sample.get("point") {
        compared = true;
        if let Some(point) = recorded(item.vector(), report) {
            report.judge(&format!("{name}: point"), &item.place, point.distance(found.point), point_by);
        }
    }
    if let Some(item) = sample.get("normal") {
        compared = true;
        if let Some(told) = recorded(item.vector(), report) {
            let deviation = found.normal.map_or(f64::NAN, |normal| normal.distance(told));
            report.judge(&format!("{name}: normal"), &item.place, deviation, normal_by);
        }
    }
    if !compared {
        report.pass_over(&sample.place, "neither a point nor a normal to compare");
    }
    Ok(())
}
