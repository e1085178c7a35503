//! Exact points of patches at parameters that a file gives.

use super::{CliError, MOST_BYTES, Patch};
use crate::samples::{Measured, Places};
use crate::verify::reader::{Flaw, Item};
use ductile_patch::s_patch::Domain;
use glam::DVec2;
use serde::Serialize;
use std::path::Path;

/// Where a sample is wanted.
enum At {
    Domain(DVec2),
    Coordinates(Vec<f64>),
    Side(usize, f64),
}

/// A sample that is wanted of a patch.
pub(super) struct Wanted {
    patch: usize,
    at: At,
}

/// What a patch is like at a point.
#[derive(Serialize)]
pub(super) struct Sample {
    patch: usize,
    xy: [f64; 2],
    bary: Vec<f64>,
    #[serde(flatten)]
    pub(super) found: Measured,
}

/// Reads a file of samples. Each is a list of two numbers (a point of the domain), a list of as many numbers as the patch has
/// sides (barycentric coordinates), or an object with `xy`, `bary`, or `side` and `u`, and with `patch` where the file of ribbons
/// has several.
pub(super) fn read(file: &Path) -> Result<Places<Wanted>, CliError> {
    Places::read(file, MOST_BYTES, wanted)
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
        return Ok(Wanted { patch: 0, at });
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
    Ok(Wanted { patch, at })
}

/// Evaluates all samples, or says which one cannot be.
pub(super) fn evaluate(places: &Places<Wanted>, patches: &[Patch]) -> Result<Vec<Sample>, CliError> {
    let domains: Vec<Domain> = patches.iter().map(|patch| Domain::new(patch.patch.sides())).collect();
    places.evaluate(|wanted| {
        let at = wanted.patch;
        let Some((Patch { patch, .. }, domain)) = patches.get(at).zip(domains.get(at)) else {
            return Err(format!("there is no patch {at}: there are {}", patches.len()));
        };
        let xy = match &wanted.at {
            At::Domain(xy) => *xy,
            At::Side(side, u) if *side < domain.sides() => domain.on_side(*side, *u),
            At::Side(side, _) => {
                return Err(format!("there is no side {side}: there are {}", domain.sides()));
            }
            At::Coordinates(values) if values.len() != domain.sides() => {
                return Err(format!("{} coordinates for {} corners", values.len(), domain.sides()));
            }
            At::Coordinates(values) => domain
                .point_with(values)
                .ok_or_else(|| "these are the Wachspress coordinates of no point of the domain".to_owned())?,
        };
        let found =
            patch.at(domain, xy).ok_or_else(|| format!("({}, {}) lies outside of the domain", xy.x, xy.y))?;
        Ok(Sample {
            patch: at,
            xy: xy.to_array(),
            bary: domain.coordinates(xy),
            found: Measured::new(found.point, found.normal(), found.principal_curvatures()),
        })
    })
}
