//! Exact points of the surface over a cage, at places that a file gives.

use super::{CliError, MOST_BYTES};
use crate::samples::{Measured, Places};
use crate::verify::reader::{Flaw, Item};
use ductile_patch::cage::CageSurface;
use serde::Serialize;
use std::path::Path;

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

/// Where a sample is wanted.
pub(super) struct Wanted {
    of: Of,
    u: f64,
    v: f64,
}

/// What the surface is like at a point.
#[derive(Serialize)]
pub(super) struct Sample {
    quad: usize,
    u: f64,
    v: f64,
    #[serde(flatten)]
    pub(super) found: Measured,
}

/// Reads a file of samples. Each is a list `[face, u, v]`, or an object with `u`, `v` and `face`, `face` and `corner`, or `quad`.
pub(super) fn read(file: &Path) -> Result<Places<Wanted>, CliError> {
    Places::read(file, MOST_BYTES, wanted)
}

fn wanted(item: &Item<'_>) -> Result<Wanted, Flaw> {
    if item.is_list() {
        let parts: Vec<Item<'_>> = item.list()?.collect();
        let [face, u, v] = &parts[..] else { return Err(item.flaw("a list of face, u and v is expected")) };
        return Ok(Wanted { of: Of::Face(face.count()?), u: u.number()?, v: v.number()? });
    }
    let fields = item.fields()?;
    let of = match (fields.get("face"), fields.get("corner"), fields.get("quad")) {
        (Some(face), None, None) => Of::Face(face.count()?),
        (Some(face), Some(corner), None) => Of::Corner(face.count()?, corner.count()?),
        (None, None, Some(quad)) => Of::Quad(quad.count()?),
        _ => return Err(item.flaw("one of `face`, `face` with `corner`, or `quad` is expected")),
    };
    Ok(Wanted { of, u: fields.need("u")?.number()?, v: fields.need("v")?.number()? })
}

/// Evaluates all samples, or says which one cannot be.
pub(super) fn evaluate(places: &Places<Wanted>, surface: &CageSurface) -> Result<Vec<Sample>, CliError> {
    places.evaluate(|wanted| {
        let (quad, u, v) = patch(wanted, surface)?;
        let found = surface.evaluate(quad, u, v).map_err(|error| error.to_string())?;
        Ok(Sample { quad, u, v, found: Measured::new(found.point, found.normal, found.curvatures) })
    })
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
