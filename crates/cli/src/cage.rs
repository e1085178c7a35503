//! `ductile cage`: the smooth surface over a cage of polygons, as a mesh, and exact points of it on request.

mod samples;

use crate::input::{self, CliError};
use crate::verify::rules;
use ductile_mesh::io::{Polygons, obj, ply};
use ductile_patch::cage::{Blend, Boundary, Cage, CageSurface, Map, Settings, Split, Tessellation};
use ductile_spec::ImportFormat;
use serde::Serialize;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Options of `cage`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// OBJ or PLY file with the polygons of the cage, or - for an OBJ text on standard input
    cage: PathBuf,
    /// OBJ file to write, or - for standard output
    #[arg(short, long, value_name = "OUT.obj", required_unless_present_any = ["samples", "json"])]
    out: Option<PathBuf>,
    /// Edges along each side of a quad
    #[arg(long, default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=256))]
    resolution: u32,
    /// From the square to the surfaces of irregular vertices: rational or smooth
    #[arg(long, default_value = "smooth", value_parser = map)]
    map: Map,
    /// How the weight of a corner fades: hermite:K, bump, bump:K or erbs
    #[arg(long, default_value = "hermite:2", value_parser = blend)]
    blend: Blend,
    /// How faces become quads: none, linear, offset or catmull-clark [default: linear, none where all are quads]
    #[arg(long, value_parser = split)]
    split: Option<Split>,
    /// What completes the rings at a boundary: linear or borrow
    #[arg(long, default_value = "linear", value_parser = boundary)]
    boundary: Boundary,
    /// JSON file of places at which to print points, unit normals and principal curvatures
    #[arg(long, value_name = "FILE")]
    samples: Option<PathBuf>,
    /// Print a report, samples included, as JSON
    #[arg(long)]
    json: bool,
}

fn map(name: &str) -> Result<Map, String> {
    rules::map_named(name).ok_or_else(|| "it is rational or smooth".into())
}

fn blend(name: &str) -> Result<Blend, String> {
    rules::blend_named(name).ok_or_else(|| "it is hermite:K, bump, bump:K or erbs".into())
}

fn split(name: &str) -> Result<Split, String> {
    rules::split_named(name).ok_or_else(|| "it is none, linear, offset or catmull-clark".into())
}

fn boundary(name: &str) -> Result<Boundary, String> {
    rules::boundary_named(name).ok_or_else(|| "it is linear or borrow".into())
}

/// Largest cage or file of samples, in bytes.
const MOST_BYTES: usize = 64 << 20;
/// From this valence on pieces of the surface are squeezed (recipe, section 10).
const MANY_FACES: usize = 16;

#[derive(Serialize)]
struct Report {
    cage: About,
    quads: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<Counts>,
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<Vec<samples::Sample>>,
}

#[derive(Serialize)]
struct About {
    vertices: usize,
    faces: usize,
    closed: bool,
    euler_characteristic: i64,
    largest_valence: usize,
}

#[derive(Serialize)]
struct Counts {
    vertices: usize,
    triangles: usize,
    without_normal: usize,
}

/// Reads, evaluates, writes, prints.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    let prints = options.samples.is_some() || options.json;
    if prints && options.out.as_deref().is_some_and(|out| out.as_os_str() == "-") {
        return Err(CliError::Option(
            "the mesh and what is printed cannot both go to standard output".into(),
        ));
    }
    let file = &options.cage;
    let cage = read(file)?;
    let places = options.samples.as_deref().map(samples::read).transpose()?;
    let settings = Settings {
        map: options.map,
        blend: options.blend,
        split: options.split.unwrap_or(cage.split_needed()),
        boundary: options.boundary,
    };
    let surface = CageSurface::new(&cage, settings).map_err(|error| refused(file, &error))?;
    let samples = places.map(|places| samples::evaluate(&places, &surface)).transpose()?;
    let mesh = options.out.as_deref().map(|out| write(options, out, &surface)).transpose()?;
    let largest_valence = (0..cage.positions().len()).map(|vertex| cage.valence(vertex)).max().unwrap_or(0);
    if largest_valence > MANY_FACES {
        eprintln!("ductile: up to {largest_valence} faces meet at a vertex: the surface is squeezed there");
    }
    if options.json {
        let about = About {
            vertices: cage.positions().len(),
            faces: cage.faces().len(),
            closed: cage.is_closed(),
            euler_characteristic: cage.euler_characteristic(),
            largest_valence,
        };
        let report = Report { cage: about, quads: surface.quads().len(), mesh, samples };
        let text = serde_json::to_string_pretty(&report).map_err(|e| CliError::Option(e.to_string()))?;
        input::write("-".as_ref(), &(text + "\n"))?;
    } else if let Some(samples) = samples {
        input::write("-".as_ref(), &samples.iter().map(|sample| sample.found.line()).collect::<String>())?;
    }
    Ok(ExitCode::SUCCESS)
}

fn refused(file: &Path, reason: &dyn std::fmt::Display) -> CliError {
    CliError::Refused { file: file.to_owned(), reason: reason.to_string() }
}

fn read(file: &Path) -> Result<Cage, CliError> {
    let Polygons { positions, faces } = if input::import_format(file) == Some(ImportFormat::Ply) {
        ply::read_polygons(&input::bytes_up_to(file, MOST_BYTES)?).map_err(|error| refused(file, &error))?
    } else {
        obj::read_polygons(&input::read_up_to(file, MOST_BYTES)?).map_err(|error| refused(file, &error))?
    };
    Cage::new(positions, faces).map_err(|error| refused(file, &error))
}

fn write(options: &Options, out: &Path, surface: &CageSurface) -> Result<Counts, CliError> {
    let mesh = Tessellation::new(surface, options.resolution as usize)
        .map_err(|error| refused(&options.cage, &error))?;
    let mut text = String::new();
    // Writing to a String cannot fail, so the results are dropped.
    for p in mesh.positions() {
        let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
    }
    for n in mesh.normals() {
        let _ = writeln!(text, "vn {} {} {}", n.x, n.y, n.z);
    }
    for triangle in mesh.triangles() {
        let [a, b, c] = triangle.map(|sample| sample + 1);
        let _ = writeln!(text, "f {a}//{a} {b}//{b} {c}//{c}");
    }
    input::write(out, &text)?;
    let without_normal = mesh.normals().iter().filter(|normal| normal.length_squared() < 0.5).count();
    Ok(Counts { vertices: mesh.positions().len(), triangles: mesh.triangles().len(), without_normal })
}
