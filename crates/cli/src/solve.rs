//! `ductile solve`: runs a specification to rest and writes the mesh, and the numbers on request.

use crate::input::{self, CliError};
use ductile_modeler::Modeler;
use ductile_spec::{ExportFormat, Figures, Reply, Request, Step, Structure};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Options of `solve`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Spec file, or - for standard input
    spec: PathBuf,
    /// OBJ file to write, or - for standard output
    #[arg(short, long, value_name = "OUT.obj")]
    out: PathBuf,
    /// Print a report to standard output
    #[arg(long, value_name = "FORMAT", value_parser = ["json"])]
    report: Option<String>,
    /// Most steps before giving up
    #[arg(long, default_value_t = 2000)]
    steps: u32,
    /// Conjugate-gradient iterations that a step may spend
    #[arg(long, default_value_t = 20, value_parser = clap::value_parser!(u32).range(1..=10_000))]
    iterations: u32,
}

#[derive(Serialize)]
struct Report<'a> {
    name: &'a str,
    at_rest: bool,
    nodes: u32,
    energy: f64,
    residual: f64,
    steps: u32,
    rescues: u32,
    seconds: f64,
    surfaces: Vec<SurfaceReport>,
}

/// The mesh and the topology of a surface.
#[derive(Serialize)]
pub(crate) struct SurfaceReport {
    id: u32,
    vertices: u32,
    triangles: u32,
    euler_characteristic: i32,
    boundaries: u32,
    components: u32,
    orientable: bool,
    genus: u32,
}

/// Solves, writes, reports.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    if options.report.is_some() && options.out.as_os_str() == "-" {
        return Err(CliError::Option("the mesh and the report cannot both go to standard output".into()));
    }
    let (text, document) = input::document(&options.spec)?;
    #[expect(clippy::disallowed_methods, reason = "the command line is an edge: it may look at the clock")]
    let begin = std::time::Instant::now();
    let mut modeler = Modeler::new();
    let opened = accepted(options, modeler.handle(Request::OpenText { text }))?;
    let mut structure = opened.structure.unwrap_or_default();
    let mut frame = opened.frame;
    while !frame.settled && frame.figures.steps < options.steps {
        let reply = modeler.handle(Request::Step(Step { drag: None, iterations: options.iterations }));
        frame = reply.frame;
        structure = reply.structure.unwrap_or(structure);
    }
    let seconds = begin.elapsed().as_secs_f64();
    let exported = accepted(options, modeler.handle(Request::Export(ExportFormat::Obj)))?.exported;
    input::write(
        &options.out,
        &exported.unwrap_or_else(|| unreachable!("an accepted export has a file")).text,
    )?;
    if options.report.is_some() {
        let report = report(&document.name, frame.settled, &frame.figures, seconds, &structure);
        let text = serde_json::to_string_pretty(&report).map_err(|e| CliError::Option(e.to_string()))?;
        input::write("-".as_ref(), &(text + "\n"))?;
    }
    if !frame.settled {
        eprintln!(
            "ductile: not at rest after {} steps (residual {:.2e})",
            frame.figures.steps, frame.figures.residual
        );
        return Ok(ExitCode::from(1));
    }
    Ok(ExitCode::SUCCESS)
}

fn accepted(options: &Options, reply: Reply) -> Result<Reply, CliError> {
    match reply.refused {
        Some(refusal) => Err(CliError::Refused { file: options.spec.clone(), reason: refusal.reason }),
        None => Ok(reply),
    }
}

fn report<'a>(
    name: &'a str,
    at_rest: bool,
    figures: &Figures,
    seconds: f64,
    structure: &Structure,
) -> Report<'a> {
    let surfaces = surface_reports(structure);
    let Figures { nodes, energy, residual, steps, rescues, .. } = *figures;
    Report { name, at_rest, nodes, energy, residual, steps, rescues, seconds, surfaces }
}

/// Mesh and topology of every surface.
pub(crate) fn surface_reports(structure: &Structure) -> Vec<SurfaceReport> {
    structure
        .surfaces
        .iter()
        .map(|span| SurfaceReport {
            id: span.id.0,
            vertices: span.vertex_count,
            triangles: span.index_count / 3,
            euler_characteristic: span.summary.euler,
            boundaries: span.summary.boundaries,
            components: span.summary.components,
            orientable: span.summary.orientable,
            genus: span.summary.genus,
        })
        .collect()
}
