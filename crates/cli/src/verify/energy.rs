//! Reference files of energies: meshes, their discrete energy, and figures of some nodes (recipe, sections 1, 2 and 12).

use super::family::Family;
use super::mesh::Mesh;
use super::reader::{Fields, Flaw, Item, recorded};
use super::report::{Report, Tolerance};
use super::smooth::Smooth;
use ductile_solver::{Curvature, NodeFigures, Settings, SurfaceSolver};
use glam::DVec3;

/// The formula, on the same mesh.
const ENERGY: Tolerance = Tolerance { relative: 1e-8, absolute: 1e-10 };
const AREA: Tolerance = Tolerance { relative: 1e-8, absolute: 1e-10 };
/// Of one node; recorded with nine digits after the point.
const NODE: Tolerance = Tolerance { relative: 1e-7, absolute: 2e-9 };
const NORMAL: f64 = 1e-7;
/// Recorded with three digits after the point.
const CONDITION: Tolerance = Tolerance { relative: 1e-6, absolute: 1e-3 };
/// Recorded with six digits after the point, and with seven in a table of convergence.
const RELATIVE_ERROR: Tolerance = Tolerance::absolute(1e-6);
const CONVERGENCE: Tolerance = Tolerance::absolute(1e-7);

/// Checks a whole file.
pub(crate) fn check(file: &Fields<'_>, report: &mut Report) -> Result<(), Flaw> {
    let mut smooth = None;
    for item in file.need("meshes")?.list()? {
        let fields = item.fields()?;
        let found = check_mesh(&fields, report)?;
        fields.finish(report);
        smooth = smooth.or(found);
    }
    if let Some(table) = file.get("convergence") {
        for item in table.list()? {
            let fields = item.fields()?;
            check_convergence(&fields, smooth, report)?;
            fields.finish(report);
        }
    }
    Ok(())
}

/// A mesh with its sums; says which smooth surface it lies on.
fn check_mesh(fields: &Fields<'_>, report: &mut Report) -> Result<Option<Smooth>, Flaw> {
    let mesh = Mesh::read(fields)?;
    mesh.check_counts(fields, report);
    let solver = mesh.solver(vec![false; mesh.positions.len()], Settings::default());
    let solver = solver.map_err(|reason| fields.flaw(reason))?;
    let figures = solver.figures();
    let areas = mesh.areas();
    let with_3d_area = figures.iter().zip(&areas).map(|(node, area)| node.density * area).sum::<f64>();
    let sums = [
        ("energy", solver.energy(), ENERGY),
        ("energy_with_3d_area", with_3d_area, ENERGY),
        ("area_parametric", figures.iter().map(|node| node.area).sum(), AREA),
        ("area_3d", areas.iter().sum(), AREA),
        (
            "max_condition_normalised",
            figures.iter().map(|node| node.condition).fold(0.0, f64::max),
            CONDITION,
        ),
    ];
    for (name, found, tolerance) in sums {
        let Some(item) = fields.get(name) else { continue };
        if let Some(number) = recorded(item.number(), report) {
            report.compare(name, &item.place, number, found, tolerance);
        }
    }
    if let Some(item) = fields.get("all_nodes_full_basis")
        && let Some(flag) = recorded(item.flag(), report)
    {
        let is_wrong = flag != figures.iter().all(|node| node.is_full_basis);
        report.judge("all_nodes_full_basis", &item.place, f64::from(u8::from(is_wrong)), 0.0);
    }
    let smooth = Smooth::of(&mesh);
    check_against_smooth(fields, smooth, solver.energy(), report)?;
    if let Some(checks) = fields.get("node_checks") {
        check_nodes(&checks, &solver, &figures, report)?;
    }
    Ok(smooth)
}

fn check_against_smooth(
    fields: &Fields<'_>,
    smooth: Option<Smooth>,
    energy: f64,
    report: &mut Report,
) -> Result<(), Flaw> {
    for name in ["exact_integral", "relative_error"] {
        let Some(item) = fields.get(name) else { continue };
        let Some(number) = recorded(item.number(), report) else { continue };
        match smooth.map(Smooth::energy) {
            None => report.pass_over(&item.place, "the nodes lie on no sphere and on no torus"),
            Some(exact) if name == "exact_integral" => {
                report.compare(name, &item.place, number, exact, ENERGY);
            }
            Some(exact) => report.compare(name, &item.place, number, energy / exact - 1.0, RELATIVE_ERROR),
        }
    }
    Ok(())
}

fn check_nodes(
    checks: &Item<'_>,
    solver: &SurfaceSolver,
    figures: &[NodeFigures],
    report: &mut Report,
) -> Result<(), Flaw> {
    let curvatures: Vec<Curvature> = solver.curvatures().collect();
    for check in checks.list()? {
        let fields = check.fields()?;
        let node = fields.need("node")?.index(figures.len(), "node")?;
        let (figures, curvature) = (figures[node], curvatures[node]);
        let values = [
            ("angle_sum", figures.angle_sum),
            ("area", figures.area),
            ("density", figures.density),
            ("mean_curvature_abs", curvature.mean.abs()),
            ("gauss_curvature", curvature.gauss),
        ];
        for (name, found) in values {
            let Some(item) = fields.get(name) else { continue };
            if let Some(number) = recorded(item.number(), report) {
                report.compare(&format!("node {name}"), &item.place, number, found, NODE);
            }
        }
        if let Some(item) = fields.get("normal_up_to_sign")
            && let Some(normal) = recorded(item.vector(), report)
        {
            let found: DVec3 = solver.normals()[node];
            let deviation = normal.distance(found).min(normal.distance(-found));
            report.judge("node normal_up_to_sign", &item.place, deviation, NORMAL);
        }
        fields.finish(report);
    }
    Ok(())
}

/// One line of a table: the error of a mesh that its family and its number of nodes define.
fn check_convergence(fields: &Fields<'_>, smooth: Option<Smooth>, report: &mut Report) -> Result<(), Flaw> {
    let (name, nodes) = (fields.need("family")?, fields.need("nodes")?);
    let item = fields.need("relative_error")?;
    let Some(number) = recorded(item.number(), report) else { return Ok(()) };
    let family = Family::named(name.text()?, smooth);
    let Some((shape, exact)) = family.and_then(|family| family.member(nodes.count().ok()?)) else {
        nodes.count()?;
        report.pass_over(&item.place, "no mesh is known of this family and number of nodes");
        return Ok(());
    };
    let mut solver = shape.solver().map_err(|reason| name.flaw(reason.to_string()))?;
    solver.fit_all(&shape.positions);
    let found = solver.energy() / exact - 1.0;
    report.compare("convergence", &item.place, number, found, CONVERGENCE);
    Ok(())
}
