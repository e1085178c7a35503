//! Exact points of the surface over a cage, at places that a file gives.

use super::{CliError, MOST_BYTES};
use crate::input;
use crate::verify::json::Json;
use crate::verify::reader::{Flaw, Item};
use ductile_patch::cage::CageSurface;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Which patch is meant.
#[derive(Clone, Copy)]
enum Of {
    /// A face of the cage.
    Face(usize),
    /// The piece of a face at one of its corners.
    Corner(usize, usize),
    /// A quad after the split.
    Quad(usize),
}

/// A sample, and where in the file it is asked for.
struct Wanted {
    place: String,
    of: Of,
    u: f64,
    v: f64,
}

/// The samples of a file.
pub(super) struct Places {
    file: PathBuf,
    wanted: Vec<Wanted>,
}

/// What the surface is like at a point, to the last bit.
#[derive(Serialize)]
pub(super) struct Sample {
    quad: usize,
    u: f64,
    v: f64,
    point: [f64; 3],
    normal: Option<[f64; 3]>,
    principal_curvatures: Option<[f64; 2]>,
}

impl Sample {
    /// Point, normal and curvatures with spaces between, `-` for what does not exist.
    pub(super) fn line(&self) -> String {
        let words = |values: Option<&[f64]>, count: usize| match values {
            Some(values) => values.iter().map(|value| format!("{value}")).collect::<Vec<_>>().join(" "),
            None => vec!["-"; count].join(" "),
        };
        let [point, normal, curvatures] = [
            words(Some(&self.point), 3),
            words(self.normal.as_ref().map(<[f64; 3]>::as_slice), 3),
            words(self.principal_curvatures.as_ref().map(<[f64; 2]>::as_slice), 2),
        ];
        format!("{point} {normal} {curvatures}\n")
    }
}

/// Reads a file of samples: a list, or an object with the field `samples`. Each is a list `[face, u, v]`, or an object with `u`, `v`
/// and `face`, `face` and `corner`, or `quad`.
pub(super) fn read(file: &Path) -> Result<Places, CliError> {
    let bad = |reason: String| CliError::Refused { file: file.to_owned(), reason };
    let text = input::read_up_to(file, MOST_BYTES)?;
    let json: Json = serde_json::from_str(&text).map_err(|reason| bad(reason.to_string()))?;
    let wanted = list(&Item::root(&json)).map_err(|flaw| bad(flaw.to_string()))?;
    Ok(Places { file: file.to_owned(), wanted })
}

fn list(root: &Item<'_>) -> Result<Vec<Wanted>, Flaw> {
    let list = if root.is_list() { root.clone() } else { root.fields()?.need("samples")? };
    list.list()?.map(|item| wanted(&item)).collect()
}

fn wanted(item: &Item<'_>) -> Result<Wanted, Flaw> {
    let place = item.place.clone();
    if item.is_list() {
        let parts: Vec<Item<'_>> = item.list()?.collect();
        let [face, u, v] = &parts[..] else { return Err(item.flaw("a list of face, u and v is expected")) };
        return Ok(Wanted { place, of: Of::Face(face.count()?), u: u.number()?, v: v.number()? });
    }
    let fields = item.fields()?;
    let of = match (fields.get("face"), fields.get("corner"), fields.get("quad")) {
        (Some(face), None, None) => Of::Face(face.count()?),
        (Some(face), Some(corner), None) => Of::Corner(face.count()?, corner.count()?),
        (None, None, Some(quad)) => Of::Quad(quad.count()?),
        _ => return Err(item.flaw("one of `face`, `face` with `corner`, or `quad` is expected")),
    };
    Ok(Wanted { place, of, u: fields.need("u")?.number()?, v: fields.need("v")?.number()? })
}

/// Evaluates all samples, or says which one cannot be.
pub(super) fn evaluate(places: &Places, surface: &CageSurface) -> Result<Vec<Sample>, CliError> {
    let one = |wanted: &Wanted| {
        let bad = |what: String| CliError::Refused {
            file: places.file.clone(),
            reason: format!("{}: {what}", wanted.place),
        };
        let (quad, u, v) = patch(wanted, surface).map_err(bad)?;
        let found = surface.evaluate(quad, u, v).map_err(|error| bad(error.to_string()))?;
        Ok(Sample {
            quad,
            u,
            v,
            point: found.point.to_array(),
            normal: found.normal.map(|normal| normal.to_array()),
            principal_curvatures: found.curvatures,
        })
    };
    places.wanted.iter().map(one).collect()
}

/// The quad and the parameters in it. A face with four corners that was divided keeps its parameters: those in the unit square over the
/// whole face.
fn patch(wanted: &Wanted, surface: &CageSurface) -> Result<(usize, f64, f64), String> {
    let &Wanted { of, u, v, .. } = wanted;
    if !(0.0..=1.0).contains(&u) || !(0.0..=1.0).contains(&v) {
        return Err(format!("the parameters ({u}, {v}) lie outside [0, 1]"));
    }
    let quads = |face: usize| {
        let quads = surface.quads_of_face(face);
        let count = surface.face_count();
        if quads.is_empty() { Err(format!("there is no face {face}: there are {count}")) } else { Ok(quads) }
    };
    match of {
        Of::Quad(quad) => Ok((quad, u, v)),
        Of::Corner(face, corner) => {
            let quads = quads(face)?;
            let count = quads.len();
            if count == 1 {
                return Err(format!(
                    "face {face} was not divided: give its own parameters, without `corner`"
                ));
            }
            let quad = quads.clone().nth(corner);
            let quad =
                quad.ok_or_else(|| format!("face {face} has no corner {corner}: there are {count}"))?;
            Ok((quad, u, v))
        }
        Of::Face(face) => {
            let quads = quads(face)?;
            match quads.len() {
                1 => Ok((quads.start, u, v)),
                4 => {
                    let (corner, u, v) = quarter(u, v);
                    Ok((quads.start + corner, u, v))
                }
                count => {
                    Err(format!("face {face} has {count} corners and was divided: say which with `corner`"))
                }
            }
        }
    }
}

/// Which corner's quarter of the square holds a place, and where it is as that corner sees it.
fn quarter(u: f64, v: f64) -> (usize, f64, f64) {
    match (u > 0.5, v > 0.5) {
        (false, false) => (0, 2.0 * u, 2.0 * v),
        (true, false) => (1, 2.0 * v, 2.0 * (1.0 - u)),
        (true, true) => (2, 2.0 * (1.0 - u), 2.0 * (1.0 - v)),
        (false, true) => (3, 2.0 * (1.0 - v), 2.0 * u),
    }
}
