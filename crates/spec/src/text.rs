//! The document as text: the spec file. JSON, versioned, strict, exact.
//!
//! `docs/spec-format.md` describes the format for people. Numbers are written with the fewest digits that
//! read back to the same bits, so a round trip is exact. Unknown fields, repeated keys and newer versions
//! are refused with their place: silently dropping what one does not understand would lose work.

use crate::cage::Cage;
use crate::displacement::Displaced;
use crate::document::{Curve, Density, Document, Objective, Surface};
use crate::fill::Fill;
use crate::fixed_mesh::FixedMesh;
use crate::id::{CurveId, PointId, SurfaceId};
use crate::validate::Defect;
use glam::DVec3;
use serde::de::{Error as _, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::marker::PhantomData;
use thiserror::Error;

/// The version that this program writes, and the newest that it reads.
pub const FORMAT_VERSION: u64 = 1;

/// Largest spec file that is read, in bytes.
pub const MAX_TEXT_BYTES: usize = 4 << 20;

/// Why a text is not a document.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TextError {
    /// The text is longer than any document.
    #[error("the file has {0} bytes; the limit is {MAX_TEXT_BYTES}")]
    TooLong(usize),
    /// It is not JSON, or not of the form of a document. The message names line and column.
    #[error("not a Ductile document: {0}")]
    Form(String),
    /// It was written by a newer program.
    #[error(
        "this document has version {found}; this program reads up to version {FORMAT_VERSION}. Open it with a newer Ductile"
    )]
    Newer {
        /// The version that it states.
        found: u64,
    },
    /// It has the right form, but what it says cannot be built.
    #[error("this document cannot be built: {0}")]
    Defect(#[from] Defect),
}

#[derive(Deserialize)]
struct Probe {
    ductile: u64,
}

#[derive(Serialize)]
struct Written<'a> {
    ductile: u64,
    #[serde(skip_serializing_if = "str::is_empty")]
    name: &'a str,
    objective: Objective,
    #[serde(skip_serializing_if = "Option::is_none")]
    spacing: Option<f64>,
    #[serde(skip_serializing_if = "Density::is_default")]
    density: Density,
    points: &'a BTreeMap<PointId, DVec3>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    curves: &'a BTreeMap<CurveId, Curve>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    surfaces: &'a BTreeMap<SurfaceId, Surface>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    cages: &'a BTreeMap<SurfaceId, Cage>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    fills: &'a BTreeMap<SurfaceId, Fill>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    meshes: &'a BTreeMap<SurfaceId, FixedMesh>,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    displacements: &'a BTreeMap<SurfaceId, Displaced>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Read {
    #[serde(rename = "ductile")]
    _version: u64,
    #[serde(default)]
    name: String,
    #[serde(default)]
    objective: Objective,
    #[serde(default)]
    spacing: Option<f64>,
    #[serde(default)]
    density: Density,
    #[serde(default, deserialize_with = "unique")]
    points: BTreeMap<PointId, DVec3>,
    #[serde(default, deserialize_with = "unique")]
    curves: BTreeMap<CurveId, Curve>,
    #[serde(default, deserialize_with = "unique")]
    surfaces: BTreeMap<SurfaceId, Surface>,
    #[serde(default, deserialize_with = "unique")]
    cages: BTreeMap<SurfaceId, Cage>,
    #[serde(default, deserialize_with = "unique")]
    fills: BTreeMap<SurfaceId, Fill>,
    #[serde(default, deserialize_with = "unique")]
    meshes: BTreeMap<SurfaceId, FixedMesh>,
    #[serde(default, deserialize_with = "unique")]
    displacements: BTreeMap<SurfaceId, Displaced>,
}

/// The document as readable text: a line for each point, curve and surface part.
#[must_use]
pub fn to_text(document: &Document) -> String {
    let compact: serde_json::Value = serde_json::from_str(&to_compact_text(document)).unwrap_or_default();
    let mut out = String::new();
    layout(&compact, 0, &mut out);
    out.push('\n');
    out
}

/// The document as the shortest text, for a link or a journal.
#[must_use]
pub fn to_compact_text(document: &Document) -> String {
    let Document { name, objective, spacing, density, points, curves, surfaces, .. } = document;
    let Document { cages, fills, meshes, displacements, .. } = document;
    let written = Written {
        ductile: FORMAT_VERSION,
        name,
        objective: *objective,
        spacing: *spacing,
        density: *density,
        points,
        curves,
        surfaces,
        cages,
        fills,
        meshes,
        displacements,
    };
    serde_json::to_string(&written).unwrap_or_default()
}

/// Reads a document and checks it.
///
/// # Errors
/// [`TextError`] says what is wrong and where.
pub fn from_text(text: &str) -> Result<Document, TextError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(TextError::TooLong(text.len()));
    }
    let text = text.trim_start_matches('\u{feff}');
    let probe: Probe = serde_json::from_str(text).map_err(|e| TextError::Form(e.to_string()))?;
    if probe.ductile > FORMAT_VERSION {
        return Err(TextError::Newer { found: probe.ductile });
    }
    if probe.ductile == 0 {
        return Err(TextError::Form("version 0 does not exist".into()));
    }
    let read: Read = serde_json::from_str(text).map_err(|e| TextError::Form(e.to_string()))?;
    let Read { name, objective, spacing, density, points, curves, surfaces, .. } = read;
    let Read { cages, fills, meshes, displacements, .. } = read;
    let surfaces_of_kinds = Document { surfaces, cages, fills, meshes, ..Document::default() };
    let document =
        Document { name, objective, spacing, density, points, curves, displacements, ..surfaces_of_kinds };
    document.validate()?;
    Ok(document)
}

/// JSON with small arrays and leaf objects on one line, so that a person can read and compare it.
fn layout(value: &serde_json::Value, depth: usize, out: &mut String) {
    use serde_json::Value::{Array, Object};
    let is_leaf = |v: &serde_json::Value| match v {
        Array(items) => items.len() <= 3 && items.iter().all(|i| !i.is_array() && !i.is_object()),
        Object(_) => false,
        _ => true,
    };
    let indent = |depth: usize, out: &mut String| out.extend(std::iter::repeat_n("  ", depth));
    match value {
        Array(items) if items.iter().all(|i| !i.is_array() && !i.is_object()) => {
            out.push_str(&value.to_string())
        }
        Array(items) => {
            out.push_str("[\n");
            for (k, item) in items.iter().enumerate() {
                indent(depth + 1, out);
                if is_leaf(item) {
                    out.push_str(&item.to_string())
                } else {
                    layout(item, depth + 1, out)
                }
                out.push_str(if k + 1 < items.len() { ",\n" } else { "\n" });
            }
            indent(depth, out);
            out.push(']');
        }
        Object(fields) if !fields.is_empty() => {
            out.push_str("{\n");
            for (k, (key, item)) in fields.iter().enumerate() {
                indent(depth + 1, out);
                out.push_str(&serde_json::Value::from(key.as_str()).to_string());
                out.push_str(": ");
                layout(item, depth + 1, out);
                out.push_str(if k + 1 < fields.len() { ",\n" } else { "\n" });
            }
            indent(depth, out);
            out.push('}');
        }
        _ => out.push_str(&value.to_string()),
    }
}

/// A map whose keys may not repeat.
pub(crate) fn unique<'de, D, K, V>(deserializer: D) -> Result<BTreeMap<K, V>, D::Error>
where
    D: Deserializer<'de>,
    K: Deserialize<'de> + Ord + fmt::Display + Copy,
    V: Deserialize<'de>,
{
    struct Unique<K, V>(PhantomData<(K, V)>);
    impl<'de, K, V> Visitor<'de> for Unique<K, V>
    where
        K: Deserialize<'de> + Ord + fmt::Display + Copy,
        V: Deserialize<'de>,
    {
        type Value = BTreeMap<K, V>;

        fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
            f.write_str("an object whose keys are whole numbers")
        }

        fn visit_map<A: MapAccess<'de>>(self, mut access: A) -> Result<Self::Value, A::Error> {
            let mut map = BTreeMap::new();
            while let Some(key) = access.next_key::<K>()? {
                let value = access.next_value()?;
                if map.insert(key, value).is_some() {
                    return Err(A::Error::custom(format_args!("{key} is defined twice")));
                }
            }
            Ok(map)
        }
    }
    deserializer.deserialize_map(Unique(PhantomData))
}
