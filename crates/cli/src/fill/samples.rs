//! Exact points of patches at parameters that a file gives.

use super::{CliError, MOST_BYTES, Patch};
use crate::input;
use crate::verify::json::Json;
use crate::verify::reader::{Flaw, Item};
use ductile_patch::s_patch::Domain;
use glam::DVec2;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Where a sample is wanted.
enum At {
    Domain(DVec2),
    Coordinates(Vec<f64>),
    Side(usize, f64),
}

/// A sample, and where in the file it is asked for.
struct Wanted {
    place: String,
    patch: usize,
    at: At,
}

/// The samples of a file.
pub(super) struct Places {
    file: PathBuf,
    wanted: Vec<Wanted>,
}

/// What a patch is like at a point, to the last bit.
#[derive(Serialize)]
pub(super) struct Sample {
    patch: usize,
    xy: [f64; 2],
    bary: Vec<f64>,
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

/// Reads a file of samples: a list, or an object with the field `samples`. Each is a list of two numbers (a point of the
/// domain), a list of as many numbers as the patch has sides (barycentric coordinates), or an object with `xy`, `bary`, or
/// `side` and `u`, and with `patch` where the file of ribbons has several.
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
    let coordinates =
        |item: &Item<'_>| item.list()?.map(|value| value.number()).collect::<Result<Vec<_>, _>>();
    if item.is_list() {
        let numbers = coordinates(item)?;
        let at = match numbers[..] {
            [x, y] => At::Domain(DVec2::new(x, y)),
            _ => At::Coordinates(numbers),
        };
        return Ok(Wanted { place: item.place.clone(), patch: 0, at });
    }
    let fields = item.fields()?;
    let patch = fields.get("patch").map_or(Ok(0), |patch| patch.count())?;
    let at = if let Some(xy) = fields.get("xy") {
        At::Domain(DVec2::from_array(xy.numbers()?))
    } else if let Some(bary) = fields.get("bary") {
        At::Coordinates(coordinates(&bary)?)
    } else if let Some(side) = fields.get("side") {
        At::Side(side.count()?, fields.need("u")?.number()?)
    } else {
        return Err(item.flaw("one of `xy`, `bary`, or `side` with `u` is expected"));
    };
    Ok(Wanted { place: item.place.clone(), patch, at })
}

/// Evaluates all samples, or says which one cannot be.
pub(super) fn evaluate(places: &Places, patches: &[Patch]) -> Result<Vec<Sample>, CliError> {
    let domains: Vec<Domain> = patches.iter().map(|patch| Domain::new(patch.patch.sides())).collect();
    let one = |wanted: &Wanted| {
        let bad = |what: String| CliError::Refused {
            file: places.file.clone(),
            reason: format!("{}: {what}", wanted.place),
        };
        let at = wanted.patch;
        let Some((Patch { patch, .. }, domain)) = patches.get(at).zip(domains.get(at)) else {
            return Err(bad(format!("there is no patch {at}: there are {}", patches.len())));
        };
        let xy = match &wanted.at {
            At::Domain(xy) => *xy,
            At::Side(side, u) if *side < domain.sides() => domain.on_side(*side, *u),
            At::Side(side, _) => {
                return Err(bad(format!("there is no side {side}: there are {}", domain.sides())));
            }
            At::Coordinates(values) if values.len() != domain.sides() => {
                return Err(bad(format!("{} coordinates for {} corners", values.len(), domain.sides())));
            }
            At::Coordinates(values) => domain.point_with(values).ok_or_else(|| {
                bad("these are the Wachspress coordinates of no point of the domain".to_owned())
            })?,
        };
        let found = patch
            .at(domain, xy)
            .ok_or_else(|| bad(format!("({}, {}) lies outside of the domain", xy.x, xy.y)))?;
        Ok(Sample {
            patch: at,
            xy: xy.to_array(),
            bary: domain.coordinates(xy),
            point: found.point.to_array(),
            normal: found.normal().map(|normal| normal.to_array()),
            principal_curvatures: found.principal_curvatures(),
        })
    };
    places.wanted.iter().map(one).collect()
}
