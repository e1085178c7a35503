//! Exact points of a patch at places that a file gives: what `fill` and `cage` have in common.

use crate::input::{self, CliError};
use crate::verify::json::{self, Json};
use crate::verify::reader::{Flaw, Item};
use glam::DVec3;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What a surface is like at a point, to the last bit.
#[derive(Debug, Serialize)]
pub(crate) struct Measured {
    point: [f64; 3],
    normal: Option<[f64; 3]>,
    principal_curvatures: Option<[f64; 2]>,
}

impl Measured {
    /// The normal and the curvatures are those that exist.
    pub(crate) fn new(point: DVec3, normal: Option<DVec3>, principal_curvatures: Option<[f64; 2]>) -> Self {
        let normal = normal.map(|normal| normal.to_array());
        Self { point: point.to_array(), normal, principal_curvatures }
    }

    /// Point, normal and curvatures with spaces between, `-` for what does not exist.
    pub(crate) fn line(&self) -> String {
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

/// The places of a file, each as that command understands it.
pub(crate) struct Places<Wanted> {
    file: PathBuf,
    wanted: Vec<(String, Wanted)>,
}

impl<Wanted> Places<Wanted> {
    /// Reads a file of samples: a list, or an object with the field `samples`.
    pub(crate) fn read(
        file: &Path,
        most_bytes: usize,
        wanted: impl Fn(&Item<'_>) -> Result<Wanted, Flaw>,
    ) -> Result<Self, CliError> {
        let bad = |reason: String| CliError::Refused { file: file.to_owned(), reason };
        let text = input::read_up_to(file, most_bytes)?;
        let json: Json = json::read(&text).map_err(&bad)?;
        let all = || -> Result<Vec<_>, Flaw> {
            let root = Item::root(&json);
            let list = if root.is_list() { root } else { root.fields()?.need("samples")? };
            list.list()?.map(|item| Ok((item.place.clone(), wanted(&item)?))).collect()
        };
        let wanted = all().map_err(|flaw| bad(flaw.to_string()))?;
        Ok(Self { file: file.to_owned(), wanted })
    }

    /// Evaluates all of them, or says which one cannot be.
    pub(crate) fn evaluate<Sample>(
        &self,
        one: impl Fn(&Wanted) -> Result<Sample, String>,
    ) -> Result<Vec<Sample>, CliError> {
        let bad = |(place, what): (&String, String)| CliError::Refused {
            file: self.file.clone(),
            reason: format!("{place}: {what}"),
        };
        self.wanted.iter().map(|(place, wanted)| one(wanted).map_err(|what| bad((place, what)))).collect()
    }
}
