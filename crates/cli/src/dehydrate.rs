//! `ductile dehydrate`: the least mesh with the topology, the control points and the curves of every fair surface (thesis
//! section 5.2), as OBJ or as a document; with `--to` what it grows to again at an edge length.

use crate::input::{self, CliError};
use ductile_mesh::{Mesh, Summary, summary};
use ductile_modeler::{Modeler, SurfaceShape};
use ductile_spec::{Document, ExportFormat, Reply, Request, Skeleton, SkeletonVertex, Step, to_text};
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::process::ExitCode;

/// Options of `dehydrate`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Spec file, or - for standard input
    spec: PathBuf,
    /// OBJ file to write, or - for standard output; a name that ends in .json gets the document
    #[arg(short, long, value_name = "OUT")]
    out: PathBuf,
    /// Grow the least meshes again to this edge length, relax them, and write that
    #[arg(long, value_name = "LENGTH")]
    to: Option<f64>,
    /// Print the figures to standard output as JSON
    #[arg(long)]
    json: bool,
    /// Most steps before giving up
    #[arg(long, default_value_t = 2000)]
    steps: u32,
}

/// Conjugate-gradient iterations of a step.
const ITERATIONS: u32 = 20;

/// What became of a surface.
#[derive(Serialize)]
struct Figures {
    surface: u32,
    before: Count,
    least: Count,
    #[serde(skip_serializing_if = "Option::is_none")]
    grown: Option<Count>,
    control_points: usize,
    curves: usize,
    euler_characteristic: i64,
    boundaries: usize,
    orientable: bool,
    same_topology: bool,
}

/// How large a mesh is.
#[derive(Clone, Copy, Serialize)]
struct Count {
    vertices: usize,
    triangles: usize,
}

impl Count {
    fn of(mesh: &Mesh) -> Self {
        Self { vertices: mesh.vertex_count(), triangles: mesh.face_count() }
    }
}

/// Relaxes, dehydrates, grows again if that is asked for, writes and reports.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    if options.json && options.out.as_os_str() == "-" {
        return Err(CliError::Option("the mesh and the figures cannot both go to standard output".into()));
    }
    if options.to.is_some_and(|length| !(length.is_finite() && length > 0.0)) {
        return Err(CliError::Option("an edge length is above 0".into()));
    }
    let (text, _) = input::document(&options.spec)?;
    let mut modeler = Modeler::new();
    let mut settled = open(options, &mut modeler, text)?;
    let mut least = modeler.model().dehydrated();
    let shapes: Vec<_> = modeler.model().surfaces.iter().map(|(id, shape)| (*id, shape.clone())).collect();
    if let Some(length) = options.to {
        least.spacing = Some(length);
        for surface in least.surfaces.values_mut() {
            (surface.spacing, surface.density) = (None, None);
            surface.regions.iter_mut().for_each(|region| region.spacing = None);
            surface.regions.retain(|region| region.objective.is_some() || region.shadow.is_some());
        }
        settled &= open(options, &mut modeler, to_text(&least))?;
    }
    let grown = options.to.map(|_| modeler.model());
    let mut figures = Vec::new();
    for (id, shape) in &shapes {
        let Some(surface) = least.surfaces.get(id) else { continue };
        let mesh = mesh_of(&surface.skeleton).map_err(|reason| refused(options, reason))?;
        let grown = grown.and_then(|model| model.surfaces.get(id));
        figures.push(figures_of(
            id.0,
            shape,
            &mesh,
            grown.map(|shape| &**shape),
            surface.skeleton.curves.len(),
        ));
    }
    let is_document = options.out.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json"));
    let text = match (is_document, options.to) {
        (true, _) => to_text(&least),
        (false, None) => obj(&least),
        (false, Some(_)) => {
            let reply = accepted(options, modeler.handle(Request::Export(ExportFormat::Obj)))?;
            reply.exported.map(|exported| exported.text).unwrap_or_default()
        }
    };
    input::write(&options.out, &text)?;
    let text = if options.json {
        serde_json::to_string_pretty(&figures).map_err(|e| CliError::Option(e.to_string()))? + "\n"
    } else {
        figures.iter().map(line).collect()
    };
    if options.out.as_os_str() == "-" {
        eprint!("{text}");
    } else {
        input::write("-".as_ref(), &text)?;
    }
    if !settled {
        eprintln!("ductile: not at rest after {} steps", options.steps);
        return Ok(ExitCode::from(1));
    }
    Ok(ExitCode::SUCCESS)
}

/// Opens a document and relaxes it; says whether it came to rest.
fn open(options: &Options, modeler: &mut Modeler, text: String) -> Result<bool, CliError> {
    let mut settled = accepted(options, modeler.handle(Request::OpenText { text }))?.frame.settled;
    for _ in 0..options.steps {
        if settled {
            break;
        }
        settled = modeler.handle(Request::Step(Step { drag: None, iterations: ITERATIONS })).frame.settled;
    }
    Ok(settled)
}

fn accepted(options: &Options, reply: Reply) -> Result<Reply, CliError> {
    match reply.refused {
        Some(refusal) => Err(refused(options, refusal.reason)),
        None => Ok(reply),
    }
}

fn refused(options: &Options, reason: String) -> CliError {
    CliError::Refused { file: options.spec.clone(), reason }
}

fn mesh_of(skeleton: &Skeleton) -> Result<Mesh, String> {
    Mesh::from_triangles(skeleton.vertices.len(), &skeleton.triangles).map_err(|reason| reason.to_string())
}

fn figures_of(
    surface: u32,
    shape: &SurfaceShape,
    least: &Mesh,
    grown: Option<&SurfaceShape>,
    curves: usize,
) -> Figures {
    let kind = |all: &Summary| (all.euler, all.boundaries, all.components, all.is_orientable);
    let (was, is) = (summary(&shape.mesh), summary(least));
    let again = grown.is_none_or(|grown| kind(&summary(&grown.mesh)) == kind(&was));
    Figures {
        surface,
        before: Count::of(&shape.mesh),
        least: Count::of(least),
        grown: grown.map(|grown| Count::of(&grown.mesh)),
        control_points: shape.mesh.vertices().filter(|v| shape.mesh.is_source_vertex(*v)).count(),
        curves,
        euler_characteristic: was.euler,
        boundaries: was.boundaries,
        orientable: was.is_orientable,
        same_topology: again && kind(&was) == kind(&is),
    }
}

fn line(figures: &Figures) -> String {
    let Figures { surface, before, least, grown, control_points, curves, .. } = figures;
    let mut line = format!(
        "surface {surface}: {} vertices and {} triangles of {} and {}; {control_points} control points, {curves} curves",
        least.vertices, least.triangles, before.vertices, before.triangles
    );
    if let Some(grown) = grown {
        // Writing to a String cannot fail, so the result is dropped.
        let _ = write!(line, "; grown to {} and {}", grown.vertices, grown.triangles);
    }
    line + "\n"
}

/// All skeletons as objects of one OBJ file; the chains of edges along curves are its lines.
fn obj(document: &Document) -> String {
    let (mut text, mut first) = (String::new(), 1);
    for (id, surface) in &document.surfaces {
        let Skeleton { vertices, triangles, curves } = &surface.skeleton;
        // Writing to a String cannot fail, here and below.
        let _ = writeln!(text, "o surface-{}", id.0);
        for vertex in vertices {
            let at = match vertex {
                SkeletonVertex::Control(point) => document.points.get(point).copied().unwrap_or(DVec3::ZERO),
                SkeletonVertex::Free(at) => *at,
            };
            let _ = writeln!(text, "v {} {} {}", at.x, at.y, at.z);
        }
        for [a, b, c] in triangles {
            let _ = writeln!(text, "f {} {} {}", first + a, first + b, first + c);
        }
        for embedded in curves {
            let closed = document.curves.get(&embedded.curve).is_some_and(|curve| curve.closed);
            let ends = embedded.along.iter().chain(embedded.along.first().filter(|_| closed));
            let names: Vec<String> = ends.map(|v| (first + v).to_string()).collect();
            let _ = writeln!(text, "l {}", names.join(" "));
        }
        first += u32::try_from(vertices.len()).unwrap_or(u32::MAX);
    }
    text
}
