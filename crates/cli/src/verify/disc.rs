//! Reference files of a raised disc: where each scheme comes to rest (recipe, sections 0, 5 and 12).
//!
//! Every case starts from the mesh of the file, lifts its one fixed inner node at once by a smooth field, and goes on until nothing
//! moves. Finer meshes are not in the file: they are made where the file's own mesh is one of the same family.

use super::family;
use super::mesh::Mesh;
use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::rest::{Rested, Scheme, rest};
use super::tolerances::{self, Stated};
use ductile_solver::workload::Workload;
use glam::DVec3;
use std::f64::consts::PI;

const STATED: [Stated; 4] = [
    Stated { name: "same_mesh_same_path_energy_rel", default: 1e-4, most: 1e-3 },
    Stated { name: "height_abs_over_raise", default: 0.01, most: 0.02 },
    // Of other paths and of other meshes: read, so that they are within reason, but this file holds neither.
    Stated { name: "same_mesh_other_path_energy_rel", default: 0.01, most: 0.05 },
    Stated { name: "remeshed_about_1000_nodes_energy_rel_to_finest", default: 0.02, most: 0.1 },
];
/// Energies are recorded with six digits after the point at least.
const ROUNDING: f64 = 5e-7;
/// Whether the last step counts is decided by rounding, and each program has its own test of rest.
const STEPS: f64 = 2.0;
/// The linear theory holds below this raise, in radii, and this well on a mesh of some thousand nodes.
const SMALL_RAISE: f64 = 0.05;
const LINEAR: f64 = 0.03;

/// What all cases have in common.
struct Disc {
    shape: Workload,
    raised: u32,
    radii: Vec<f64>,
    energy: Tolerance,
    /// In units of the raise.
    height: f64,
}

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let [relative, height, ..] = tolerances::read(file, STATED, report)?;
    let mesh = Mesh::read(file)?;
    mesh.check_counts(file, report);
    let (fixed, raised) = constraints(&file.need("fixed")?, &mesh)?;
    let radii = file.need("heights_at_radii")?.list()?.map(|radius| radius.number());
    let disc = Disc {
        shape: Workload { positions: mesh.positions, triangles: mesh.triangles, fixed },
        raised,
        radii: radii.collect::<Result<_, _>>()?,
        energy: Tolerance { relative, absolute: ROUNDING },
        height,
    };
    // The finest mesh at a small raise, for the linear theory.
    let mut small: Option<(f64, Rested)> = None;
    let mut keep = |raise: f64, scheme, rested: Rested| {
        let is_finer =
            small.as_ref().is_none_or(|(_, best)| best.shape.positions.len() <= rested.shape.positions.len());
        if scheme == Scheme::Exact && raise > 0.0 && raise <= SMALL_RAISE && is_finer {
            small = Some((raise, rested));
        }
    };
    for case in file.need("cases")?.list()? {
        let fields = case.fields()?;
        if let Some((raise, scheme, rested)) = check_case(&disc, &fields, report)? {
            keep(raise, scheme, rested);
        }
        fields.finish(report);
    }
    if let Some(list) = file.get("finer_meshes") {
        for case in list.list()? {
            let fields = case.fields()?;
            if let Some((raise, rested)) = check_finer(&disc, &fields, report)? {
                keep(raise, Scheme::Exact, rested);
            }
            fields.finish(report);
        }
    }
    check_linear_theory(&disc, file, small, report)
}

/// Which nodes are fixed, and the one among them that does not lie on the boundary.
fn constraints(item: &Item<'_>, mesh: &Mesh) -> Result<(Vec<bool>, u32), Flaw> {
    let count = mesh.positions.len();
    let mut fixed = vec![false; count];
    if item.is_text() {
        let inner = item.text()?.strip_prefix("all boundary nodes and node ");
        let inner = inner.and_then(|inner| inner.parse::<usize>().ok()).filter(|&inner| inner < count);
        let inner =
            inner.ok_or_else(|| item.flaw("neither a list of nodes nor `all boundary nodes and node N`"))?;
        fixed = (0..count).map(|node| mesh.rings.is_boundary(node)).collect();
        fixed[inner] = true;
    } else {
        for node in item.list()? {
            fixed[node.index(count, "node")?] = true;
        }
    }
    let inner: Vec<usize> = (0..count).filter(|&node| fixed[node] && !mesh.rings.is_boundary(node)).collect();
    match inner[..] {
        [raised] => {
            let raised = u32::try_from(raised).map_err(|_| item.flaw("there are too many nodes"))?;
            Ok((fixed, raised))
        }
        _ => Err(item.flaw(format!("one fixed node must lie inside, to be raised, and {} do", inner.len()))),
    }
}

fn check_case(
    disc: &Disc,
    fields: &Fields<'_>,
    report: &mut Report,
) -> Result<Option<(f64, Scheme, Rested)>, Flaw> {
    let (raise, scheme) = (fields.need("raise")?.number()?, fields.need("scheme")?);
    let Some(scheme) = Scheme::named(scheme.text()?) else {
        report.pass_over(&fields.place, "no scheme of that name is known");
        return Ok(None);
    };
    let rested = match rest(&disc.shape, disc.raised, raise, scheme) {
        Ok(rested) => rested,
        Err(reason) => {
            report.pass_over(&fields.place, &reason);
            return Ok(None);
        }
    };
    let word = scheme.word();
    check_energy(disc, fields, &rested, word, report);
    check_heights(disc, fields, raise, &rested, word, report)?;
    if let Some(nodes) = fields.get("node_positions") {
        check_positions(disc, &nodes, raise, &rested, word, report)?;
    }
    if let Some(steps) = fields.get("newton_steps")
        && let Some(number) = recorded(steps.number(), report)
    {
        let quantity = format!("{word}: newton_steps");
        let by = Tolerance::absolute(STEPS);
        report.compare(&quantity, &steps.place, number, f64::from(rested.steps), by);
    }
    Ok(Some((raise, scheme, rested)))
}

fn check_energy(disc: &Disc, fields: &Fields<'_>, rested: &Rested, word: &str, report: &mut Report) {
    if let Some(item) = fields.get("energy")
        && let Some(number) = recorded(item.number(), report)
    {
        report.compare(&format!("{word}: energy"), &item.place, number, rested.energy, disc.energy);
    }
}

fn check_finer(disc: &Disc, fields: &Fields<'_>, report: &mut Report) -> Result<Option<(f64, Rested)>, Flaw> {
    let (nodes, raise) = (fields.need("nodes")?.count()?, fields.need("raise")?.number()?);
    let is_family = |shape: &Workload, like: &Workload| {
        let close = |(a, b): (&DVec3, &DVec3)| a.distance(*b) < 1e-6;
        shape.triangles.len() == like.triangles.len()
            && shape.fixed == like.fixed
            && shape.positions.iter().zip(&like.positions).all(close)
    };
    let own = family::disc(disc.shape.positions.len()).filter(|own| is_family(own, &disc.shape));
    let Some(shape) = own.and_then(|_| family::disc(nodes)) else {
        report.pass_over(&fields.place, "no mesh is known with that number of nodes");
        return Ok(None);
    };
    let rested = match rest(&shape, 0, raise, Scheme::Exact) {
        Ok(rested) => rested,
        Err(reason) => {
            report.pass_over(&fields.place, &reason);
            return Ok(None);
        }
    };
    check_energy(disc, fields, &rested, "finer", report);
    check_heights(disc, fields, raise, &rested, "finer", report)?;
    Ok(Some((raise, rested)))
}

fn check_heights(
    disc: &Disc,
    fields: &Fields<'_>,
    raise: f64,
    rested: &Rested,
    word: &str,
    report: &mut Report,
) -> Result<(), Flaw> {
    let Some(heights) = fields.get("heights") else { return Ok(()) };
    let Some(list) = recorded(heights.list_of(disc.radii.len(), "heights", "radii"), report) else {
        return Ok(());
    };
    let by = Tolerance::absolute(disc.height * raise.abs());
    for (item, &radius) in list.zip(&disc.radii) {
        let Some(found) = rested.mean_height(radius) else {
            return Err(item.flaw(format!("the surface has no height at the radius {radius}")));
        };
        if let Some(height) = recorded(item.number(), report) {
            report.compare(&format!("{word}: heights"), &item.place, height, found, by);
        }
    }
    Ok(())
}

fn check_positions(
    disc: &Disc,
    nodes: &Item<'_>,
    raise: f64,
    rested: &Rested,
    word: &str,
    report: &mut Report,
) -> Result<(), Flaw> {
    let fields = nodes.fields()?;
    for (name, item) in fields.entries() {
        let node = name.parse::<usize>().ok().and_then(|node| rested.shape.positions.get(node));
        let found = node.ok_or_else(|| item.flaw(format!("node {name} does not exist")))?;
        let Some(position) = recorded(item.vector(), report) else { continue };
        let deviation = found.distance(position);
        report.judge(&format!("{word}: node_positions"), &item.place, deviation, disc.height * raise.abs());
    }
    Ok(())
}

/// The formulas stand in the file as prose; these two are known.
fn check_linear_theory(
    disc: &Disc,
    file: &Fields<'_>,
    small: Option<(f64, Rested)>,
    report: &mut Report,
) -> Result<(), Flaw> {
    let Some(item) = file.get("linear_theory") else { return Ok(()) };
    let fields = item.fields()?;
    for (name, known) in [("energy", "(16 pi/3) raise^2"), ("profile", "w(r)=raise*(3(1-r^2)+2 r^2 ln r)/3")]
    {
        let Some(item) = fields.get(name) else { continue };
        if item.text()? != known {
            report.pass_over(&item.place, "no such formula is known");
            continue;
        }
        let Some((raise, rested)) = &small else {
            report.pass_over(&item.place, "no case has a small enough raise");
            continue;
        };
        if name == "energy" {
            let formula = 16.0 * PI / 3.0 * raise * raise;
            let by = Tolerance { relative: LINEAR, absolute: 0.0 };
            report.compare("linear energy", &item.place, formula, rested.energy, by);
            continue;
        }
        for &radius in &disc.radii {
            let formula =
                raise * (3.0 * (1.0 - radius * radius) + 2.0 * radius * radius * libm::log(radius)) / 3.0;
            let found = rested.mean_height(radius).unwrap_or(f64::NAN);
            report.compare(
                "linear profile",
                &item.place,
                formula,
                found,
                Tolerance::absolute(LINEAR * raise),
            );
        }
    }
    fields.finish(report);
    Ok(())
}
