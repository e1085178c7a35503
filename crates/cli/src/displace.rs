//! `ductile displace`: moves points and curves of a mesh by exactly what is asked, and the surface around them smoothly.

mod edits;

use crate::input::{self, CliError};
use ductile_mesh::io::obj;
use ductile_patch::{Displacements, Domain, ItemReport, place};
use edits::Edits;
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Options of `displace`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// OBJ file, or - for standard input
    mesh: PathBuf,
    /// File of edits, or - for standard input; docs/displacements.md describes it
    edits: PathBuf,
    /// OBJ file to write, or - for standard output
    #[arg(short, long, value_name = "OUT.obj")]
    out: PathBuf,
    /// Print a report to standard output
    #[arg(long)]
    json: bool,
}

/// Largest mesh and largest file of edits, in bytes.
const MOST_BYTES: usize = 256 << 20;

#[derive(Serialize)]
struct Report {
    vertices: usize,
    triangles: usize,
    held: usize,
    items: Vec<Item>,
}

#[derive(Serialize)]
struct Item {
    kind: &'static str,
    vertices: Vec<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    distance_to_point: Option<f64>,
    offset: [f64; 3],
    least_blend: f64,
    largest_blend: f64,
    blend_beside_boundary: f64,
    warnings: Vec<String>,
}

/// A mesh as it was read, with what was added for feet at points.
struct Mesh {
    positions: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
}

/// Reads, displaces, writes, reports.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    let is_dash = |file: &Path| file.as_os_str() == "-";
    if options.json && is_dash(&options.out) {
        return Err(CliError::Option("the mesh and the report cannot both go to standard output".into()));
    }
    if is_dash(&options.mesh) && is_dash(&options.edits) {
        return Err(CliError::Option("the mesh and the edits cannot both come from standard input".into()));
    }
    let refused = |file: &Path, reason: String| CliError::Refused { file: file.to_owned(), reason };
    let text = input::read_up_to(&options.mesh, MOST_BYTES)?;
    let soup = obj::read(&text).map_err(|reason| refused(&options.mesh, reason.to_string()))?;
    let mut mesh = Mesh { positions: soup.positions, triangles: soup.triangles };
    // Flaws of the mesh are told as such before the edits change it.
    Domain::new(&mesh.positions, &mesh.triangles)
        .map_err(|reason| refused(&options.mesh, reason.to_string()))?;
    let text = input::read_up_to(&options.edits, MOST_BYTES)?;
    let edits = edits::read(&text).map_err(|reason| refused(&options.edits, reason))?;
    let report = displace(&mut mesh, &edits).map_err(|reason| refused(&options.edits, reason))?;
    input::write(&options.out, &mesh.to_obj())?;
    for (index, item) in report.items.iter().enumerate() {
        item.warnings.iter().for_each(|warning| eprintln!("ductile: item {index}: {warning}"));
    }
    if options.json {
        let text = serde_json::to_string_pretty(&report).map_err(|e| CliError::Option(e.to_string()))?;
        input::write("-".as_ref(), &(text + "\n"))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Displaces the mesh; an error names the foot or the curve.
fn displace(mesh: &mut Mesh, edits: &Edits) -> Result<Report, String> {
    let mut items = Vec::new();
    for (index, foot) in edits.feet.iter().enumerate() {
        let (vertex, distance) =
            mesh.foot(foot, edits.split).map_err(|what| format!("feet[{index}]: {what}"))?;
        let item = foot.item(vertex).map_err(|what| format!("feet[{index}]: {what}"))?;
        items.push((format!("feet[{index}]"), item, distance));
    }
    for (index, curve) in edits.curves.iter().enumerate() {
        let item = curve.item().map_err(|what| format!("curves[{index}]: {what}"))?;
        items.push((format!("curves[{index}]"), item, None));
    }
    let said = |reason: ductile_patch::DisplacementError| reason.to_string();
    let domain = Domain::new(&mesh.positions, &mesh.triangles).and_then(|d| d.with_pins(&edits.pins));
    let mut surface = Displacements::new(domain.map_err(said)?, edits.settings()).map_err(said)?;
    for (name, item, _) in &items {
        surface.add(item.clone()).map_err(|reason| format!("{name}: {reason}"))?;
    }
    let offsets = surface.offsets().map_err(said)?;
    let reports = surface.reports(&offsets);
    for (vertex, (position, offset)) in mesh.positions.iter_mut().zip(&offsets).enumerate() {
        *position += *offset;
        if !position.is_finite() {
            return Err(format!("vertex {vertex} would be moved beyond all numbers"));
        }
    }
    let items = items.into_iter().zip(surface.items()).zip(&reports);
    Ok(Report {
        vertices: mesh.positions.len(),
        triangles: mesh.triangles.len(),
        held: surface.domain().held().iter().filter(|held| **held).count(),
        items: items.map(|(((_, _, distance), item), report)| told(item, distance, report)).collect(),
    })
}

fn told(item: &ductile_patch::Item, distance_to_point: Option<f64>, report: &ItemReport) -> Item {
    let mut warnings = Vec::new();
    if report.is_cut_off() {
        warnings.push(format!(
            "the blend is {:.1e} beside the boundary, where it should be below {:.0e}: the join to what lies beyond will \
             show it; use a smaller range or a finer mesh",
            report.beside_held,
            ItemReport::SENSIBLE_BESIDE_HELD
        ));
    }
    Item {
        kind: if item.vertices().len() > 1 { "curve" } else { "foot" },
        vertices: item.vertices().to_vec(),
        distance_to_point,
        offset: report.offset.to_array(),
        least_blend: report.least,
        largest_blend: report.largest,
        blend_beside_boundary: report.beside_held,
        warnings,
    }
}

impl Mesh {
    /// The vertex of a foot, and its distance from the point where one was given.
    fn foot(&mut self, foot: &edits::Foot, splits: bool) -> Result<(usize, Option<f64>), String> {
        match (foot.vertex, foot.point) {
            (Some(vertex), None) => Ok((vertex, None)),
            (None, Some(point)) => {
                let placed = place(&mut self.positions, &mut self.triangles, DVec3::from(point), splits);
                let placed = placed.map_err(|reason| reason.to_string())?;
                Ok((placed.vertex, Some(placed.distance)))
            }
            _ => Err("either `vertex` or `point` is needed".into()),
        }
    }

    /// With as many digits as bring back the same numbers.
    fn to_obj(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail, so the results are dropped.
        for p in &self.positions {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for &[a, b, c] in &self.triangles {
            let _ = writeln!(text, "f {} {} {}", u64::from(a) + 1, u64::from(b) + 1, u64::from(c) + 1);
        }
        text
    }
}
