//! Reference files of gradients: the exact one, and for contrast the frozen ones (recipe, sections 0 and 3).

use super::mesh::Mesh;
use super::reader::{Fields, Flaw, recorded};
use super::report::{Report, Tolerance};
use super::tolerances::{self, Stated};
use ductile_solver::{Frozen, Settings};
use glam::DVec3;

const ENERGY: Tolerance = Tolerance { relative: 1e-8, absolute: 1e-10 };
const GRADIENT: Stated = Stated { name: "gradient_abs", default: 1e-5, most: 1e-3 };
/// Of the identities, relative to the sum of what cancels in them.
const IDENTITY: f64 = 1e-10;

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let mesh = Mesh::read(file)?;
    mesh.check_counts(file, report);
    let [tolerance] = tolerances::read(file, [GRADIENT], report)?;
    let solver = mesh.solver(vec![false; mesh.positions.len()], Settings::default());
    let mut solver = solver.map_err(|reason| file.flaw(reason))?;
    if let Some(item) = file.get("energy")
        && let Some(number) = recorded(item.number(), report)
    {
        report.compare("energy", &item.place, number, solver.energy(), ENERGY);
    }
    let gradient = solver.gradient().to_vec();
    let frozen = [Frozen::Literal, Frozen::Neutral].map(|kind| solver.frozen_slopes(kind));
    for item in file.need("gradient")?.list()? {
        let fields = item.fields()?;
        let node = fields.need("node")?.index(gradient.len(), "node")?;
        if let Some(item) = fields.get("dE_dp")
            && let Some(slope) = recorded(item.vector(), report)
        {
            let deviation = (slope - gradient[node]).abs().max_element();
            report.judge("dE_dp", &item.place, deviation, tolerance);
        }
        let slopes = [
            ("dE_dn", gradient[node].dot(solver.normals()[node])),
            ("frozen_dE_dn", frozen[0][node]),
            ("neutral_dE_dn", frozen[1][node]),
        ];
        for (name, found) in slopes {
            let Some(item) = fields.get(name) else { continue };
            if let Some(slope) = recorded(item.number(), report) {
                report.compare(name, &item.place, slope, found, Tolerance::absolute(tolerance));
            }
        }
        fields.finish(report);
    }
    check_identities(file, &mesh.positions, &gradient, report)
}

/// Each identity is prose; the word in brackets says which one is meant.
fn check_identities(
    file: &Fields<'_>,
    positions: &[DVec3],
    gradient: &[DVec3],
    report: &mut Report,
) -> Result<(), Flaw> {
    let Some(list) = file.get("identities") else { return Ok(()) };
    let pairs = || positions.iter().zip(gradient);
    let size: f64 = gradient.iter().map(|g| g.length()).sum();
    let moment: f64 = pairs().map(|(p, g)| p.length() * g.length()).sum();
    for item in list.list()? {
        let text = item.text()?;
        let (name, sum, size) = if text.contains("(translation)") {
            ("identity: translation", gradient.iter().sum::<DVec3>().length(), size)
        } else if text.contains("(rotation)") {
            ("identity: rotation", pairs().map(|(p, g)| p.cross(*g)).sum::<DVec3>().length(), moment)
        } else if text.contains("(scale invariance)") {
            ("identity: scale", pairs().map(|(p, g)| p.dot(*g)).sum::<f64>().abs(), moment)
        } else {
            report.pass_over(&item.place, "no identity that is known");
            continue;
        };
        report.judge(name, &item.place, sum, IDENTITY * size);
    }
    Ok(())
}
