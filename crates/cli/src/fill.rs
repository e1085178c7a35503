//! `ductile fill`: S-patches between the ribbons of a file, as a mesh, and exact points of them on request.

mod request;
mod samples;
mod seams;
mod weld;

use crate::input::{self, CliError};
use clap::ValueEnum;
use ductile_patch::s_patch::{BuildError, Fill, Join, MaskCache, SPatch, Tessellation, TessellationError};
use ductile_patch::{NoNormal, RibbonError, RibbonLoop, made_compatible};
use glam::DVec3;
use request::Request;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use thiserror::Error;

/// Options of `fill`.
#[derive(Debug, clap::Args)]
pub(crate) struct Options {
    /// Ribbons in JSON: one patch, or a list of them; or a generalised Bézier patch, .gbp; - for standard input
    ribbons: PathBuf,
    /// OBJ file to write, or - for standard output
    #[arg(short, long, value_name = "OUT.obj", required_unless_present_any = ["samples", "json"])]
    out: Option<PathBuf>,
    /// Edges along each side of a patch
    #[arg(long, default_value_t = 16, value_parser = clap::value_parser!(u32).range(1..=1000))]
    resolution: u32,
    /// Meet the boundary curves only, not the tangent planes
    #[arg(long)]
    position_only: bool,
    /// How interior control points are placed, instead of what the file says
    #[arg(long, value_enum)]
    fill: Option<Rule>,
    /// Move twist points least where ribbons do not fit together, instead of refusing them
    #[arg(long)]
    make_compatible: bool,
    /// JSON file of parameters at which to print points, unit normals and principal curvatures
    #[arg(long, value_name = "FILE")]
    samples: Option<PathBuf>,
    /// Print a report, samples included, as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Rule {
    Biharmonic,
    Harmonic,
}

/// Largest file of ribbons or samples, in bytes.
const MOST_BYTES: usize = 64 << 20;

/// Why a hole of the file is not filled.
#[derive(Debug, Error)]
enum FillError {
    #[error(transparent)]
    Ribbons(#[from] RibbonError),
    #[error(transparent)]
    Build(#[from] BuildError),
    #[error(transparent)]
    Grid(#[from] TessellationError),
}

/// A patch of the file, and what is worth telling of it.
pub(crate) struct Patch {
    patch: SPatch,
    /// Control points of its boundary curves.
    rows: Vec<Vec<DVec3>>,
    about: About,
}

#[derive(Serialize)]
struct About {
    sides: usize,
    ribbon_degree: usize,
    depth: usize,
    /// `tangent` or `position`.
    join: &'static str,
    interior_fill: &'static str,
    control_points: usize,
    /// How far the farthest twist point was moved, when asked to make ribbons compatible.
    #[serde(skip_serializing_if = "Option::is_none")]
    moved: Option<Moved>,
    without_normal: Vec<Place>,
}

#[derive(Serialize)]
struct Moved {
    largest_shift: f64,
    side: usize,
    column: usize,
}

#[derive(Serialize)]
struct Place {
    side: usize,
    u: f64,
    sine: f64,
}

#[derive(Serialize)]
struct Report {
    patches: Vec<About>,
    #[serde(skip_serializing_if = "Option::is_none")]
    mesh: Option<weld::Counts>,
    /// How well patches meet where their sides run along one another.
    seams: Vec<seams::SeamReport>,
    #[serde(skip_serializing_if = "Option::is_none")]
    samples: Option<Vec<samples::Sample>>,
}

/// Fills, writes, prints.
pub(crate) fn run(options: &Options) -> Result<ExitCode, CliError> {
    let prints = options.samples.is_some() || options.json;
    if prints && options.out.as_deref().is_some_and(|out| out.as_os_str() == "-") {
        return Err(CliError::Option(
            "the mesh and what is printed cannot both go to standard output".into(),
        ));
    }
    let requests = request::read(&options.ribbons)?;
    let places = options.samples.as_deref().map(samples::read).transpose()?;
    let several = requests.len() > 1;
    let mut cache = MaskCache::new();
    let mut patches = Vec::with_capacity(requests.len());
    for (at, request) in requests.iter().enumerate() {
        let patch = filled(options, request, &mut cache)
            .map_err(|error| refusal(&options.ribbons, several.then_some(at), &error))?;
        warn(several.then_some(at), &patch.about);
        patches.push(patch);
    }
    let samples = places.map(|places| samples::evaluate(&places, &patches)).transpose()?;
    let mut counts = None;
    if let Some(out) = &options.out {
        let mesh = mesh(options, &patches)?;
        input::write(out, &mesh.to_obj())?;
        counts = Some(mesh.counts());
    }
    if options.json {
        let seams = seams::seams(&patches);
        let patches = patches.into_iter().map(|patch| patch.about).collect();
        let report = Report { patches, mesh: counts, seams, samples };
        let text = serde_json::to_string_pretty(&report).map_err(|e| CliError::Option(e.to_string()))?;
        input::write("-".as_ref(), &(text + "\n"))?;
    } else if let Some(samples) = samples {
        input::write("-".as_ref(), &samples.iter().map(|sample| sample.found.line()).collect::<String>())?;
    }
    Ok(ExitCode::SUCCESS)
}

fn refusal(file: &Path, patch: Option<usize>, error: &dyn std::fmt::Display) -> CliError {
    let which = patch.map(|at| format!("patch {at}: ")).unwrap_or_default();
    CliError::Refused { file: file.to_owned(), reason: format!("{which}{error}") }
}

/// The normals that there are not are no error: the patch is built all the same.
fn warn(patch: Option<usize>, about: &About) {
    let which = patch.map(|at| format!("patch {at}: ")).unwrap_or_default();
    let mut told = None;
    for Place { side, u, .. } in &about.without_normal {
        if told != Some(side) {
            eprintln!(
                "ductile: {which}side {side} has no normal at {u}: the rows of its ribbon are parallel there"
            );
        }
        told = Some(side);
    }
}

fn filled(options: &Options, request: &Request, cache: &mut MaskCache) -> Result<Patch, FillError> {
    let join = if options.position_only { Join::Position } else { request.join };
    let fill = match options.fill {
        None => request.fill,
        Some(Rule::Biharmonic) => Fill::Biharmonic,
        Some(Rule::Harmonic) => Fill::Harmonic,
    };
    let mut moved = None;
    let ring = match join {
        Join::Tangent if options.make_compatible => {
            let adjusted = made_compatible(&request.ribbons)?;
            let (side, column) = (adjusted.side, adjusted.column);
            moved = Some(Moved { largest_shift: adjusted.largest_shift, side, column });
            adjusted.ribbons
        }
        Join::Tangent => RibbonLoop::new(&request.ribbons)?,
        Join::Position => {
            let curves: Vec<_> = request.ribbons.iter().map(|ribbon| ribbon.row0.clone()).collect();
            RibbonLoop::of_curves(&curves)?
        }
    };
    let patch = SPatch::filling(&ring, join, fill, cache)?;
    let place = |NoNormal { side, u, sine }| Place { side, u, sine };
    let without_normal = match join {
        Join::Tangent => ring.without_normal().into_iter().map(place).collect(),
        Join::Position => Vec::new(),
    };
    let about = About {
        sides: ring.sides(),
        ribbon_degree: ring.degree(),
        depth: patch.depth(),
        join: if join == Join::Tangent { "tangent" } else { "position" },
        interior_fill: if fill == Fill::Biharmonic { "biharmonic" } else { "harmonic" },
        control_points: patch.points().len(),
        moved,
        without_normal,
    };
    let rows = ring.ribbons().iter().map(|ribbon| ribbon.row0.clone()).collect();
    Ok(Patch { patch, rows, about })
}

/// The mesh of all patches, sewn where they share a side.
fn mesh(options: &Options, patches: &[Patch]) -> Result<weld::Welded, CliError> {
    let mut grids: Vec<Tessellation> = Vec::new();
    let mut pieces = Vec::with_capacity(patches.len());
    for Patch { patch, .. } in patches {
        let is_it = |grid: &Tessellation| (grid.sides(), grid.depth()) == (patch.sides(), patch.depth());
        let at = match grids.iter().position(is_it) {
            Some(at) => at,
            None => {
                let grid = Tessellation::new(patch.sides(), patch.depth(), options.resolution as usize);
                grids.push(grid.map_err(|error| refusal(&options.ribbons, None, &FillError::from(error)))?);
                grids.len() - 1
            }
        };
        let Some(found) = grids[at].evaluate(patch) else { continue };
        pieces.push(weld::Piece::new(&grids[at], patch.sides(), found));
    }
    Ok(weld::weld(pieces))
}
