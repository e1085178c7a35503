//! Ribbons in a file of JSON: an object with `ribbons`, a list of such objects or of ribbons, or an object with `patches`. Each ribbon
//! has `row0`, mostly `row1`, and perhaps its number as `side`. Other fields are not read. Or in one of text, `.gbp`.

mod gbp;

use crate::fill::{FillInterior, FillJoin, FillRibbon};
use glam::DVec3;
use serde::Deserialize;
use serde_json::Value;
use thiserror::Error;

/// A hole that a file of ribbons describes.
#[derive(Clone, Debug, PartialEq)]
pub struct RibbonHole {
    /// The ribbons around it, in the order of their sides.
    pub ribbons: Vec<FillRibbon>,
    /// How its inside is to be placed.
    pub interior: FillInterior,
    /// How it is to meet its ribbons.
    pub join: FillJoin,
}

/// Why a file of ribbons cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum RibbonFileError {
    /// A field is missing or is something else than it should be: its patch, from 0, and what the reader says.
    #[error("the ribbons of patch {patch} cannot be read: {reason}")]
    Malformed {
        /// Which patch of the file, from 0.
        patch: usize,
        /// What the reader says.
        reason: String,
    },
    /// Sides that are numbered have each number once, from 0.
    #[error("patch {patch} has {count} ribbons, but they are not numbered from 0 to {}", .count.saturating_sub(1))]
    Sides {
        /// Which patch of the file, from 0.
        patch: usize,
        /// How many ribbons it has.
        count: usize,
    },
    /// A line of a file of text is not what it should be.
    #[error("line {line}: {reason}")]
    Line {
        /// Which line, from 1.
        line: usize,
        /// What is wrong with it.
        reason: String,
    },
    /// The file names no patch.
    #[error("there are no ribbons in the file")]
    Empty,
}

/// A ribbon as files have it.
#[derive(Deserialize)]
struct Sided {
    side: Option<usize>,
    row0: Vec<DVec3>,
    #[serde(default)]
    row1: Vec<DVec3>,
}

/// A patch as files have it.
#[derive(Deserialize)]
struct Patch {
    ribbons: Vec<Sided>,
    depth: Option<usize>,
    #[serde(default)]
    interior_fill: FillInterior,
}

/// Reads a text. None if it is no file of ribbons at all, but something else.
#[must_use]
pub fn ribbon_holes(text: &str) -> Option<Result<Vec<RibbonHole>, RibbonFileError>> {
    let Ok(root) = serde_json::from_str::<Value>(text) else {
        return gbp::hole(text).map(|hole| Ok(vec![hole?]));
    };
    let is_ribbon = |value: &Value| value.get("row0").is_some();
    let is_patch = |value: &Value| value.get("ribbons").is_some();
    let patches = match root {
        Value::Array(list) if list.iter().any(is_ribbon) => {
            vec![Value::Object([("ribbons".to_owned(), Value::Array(list))].into_iter().collect())]
        }
        Value::Array(list) if list.iter().any(is_patch) => list,
        Value::Object(mut fields) if fields.get("patches").is_some_and(Value::is_array) => {
            match fields.remove("patches") {
                Some(Value::Array(list)) => list,
                _ => Vec::new(),
            }
        }
        value if is_patch(&value) => vec![value],
        _ => return None,
    };
    if patches.is_empty() {
        return Some(Err(RibbonFileError::Empty));
    }
    Some(patches.into_iter().enumerate().map(|(patch, value)| hole(patch, value)).collect())
}

fn hole(patch: usize, value: Value) -> Result<RibbonHole, RibbonFileError> {
    let read: Patch = serde_json::from_value(value)
        .map_err(|reason| RibbonFileError::Malformed { patch, reason: reason.to_string() })?;
    let count = read.ribbons.len();
    let degree = read.ribbons.iter().map(|ribbon| ribbon.row0.len().saturating_sub(1)).max().unwrap_or(0);
    let mut sides: Vec<Option<FillRibbon>> = vec![None; count];
    for (at, ribbon) in read.ribbons.into_iter().enumerate() {
        let place = sides.get_mut(ribbon.side.unwrap_or(at)).filter(|place| place.is_none());
        let place = place.ok_or(RibbonFileError::Sides { patch, count })?;
        *place = Some(FillRibbon { row0: ribbon.row0, row1: ribbon.row1 });
    }
    // A patch that meets positions only has the depth of its curves; one in tangent planes is three deeper.
    let join = if read.depth == Some(degree) { FillJoin::Position } else { FillJoin::Tangent };
    Ok(RibbonHole { ribbons: sides.into_iter().flatten().collect(), interior: read.interior_fill, join })
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const RIBBON: &str = r#"{"row0": [[0,0,0],[1,0,0]], "row1": [[0,1,0],[1,1,0]]}"#;

    fn holes(text: &str) -> Result<Vec<RibbonHole>, RibbonFileError> {
        ribbon_holes(text).unwrap()
    }

    #[test]
    fn patches_are_read_in_every_form_and_sides_in_their_order() {
        let list = format!("[{RIBBON}, {RIBBON}, {RIBBON}]");
        let one = holes(&list).unwrap();
        assert_eq!((one.len(), one[0].ribbons.len(), one[0].join), (1, 3, FillJoin::Tangent));
        assert_eq!(one[0].ribbons[0].row1[1], DVec3::new(1.0, 1.0, 0.0));
        let object =
            format!(r#"{{"paper": "?", "depth": 1, "interior_fill": "harmonic", "ribbons": {list}}}"#);
        let same = holes(&object).unwrap();
        assert_eq!(same[0].ribbons, one[0].ribbons);
        assert_eq!((same[0].interior, same[0].join), (FillInterior::Harmonic, FillJoin::Position));
        for several in [format!("[{object}, {object}]"), format!(r#"{{"patches": [{object}, {object}]}}"#)] {
            assert_eq!(holes(&several).unwrap().len(), 2);
        }
        let numbered = r#"[{"side": 1, "row0": [[1,0,0]]}, {"side": 0, "row0": [[0,0,0]]}]"#;
        assert_eq!(holes(numbered).unwrap()[0].ribbons[0].row0, [DVec3::ZERO]);
    }

    #[test]
    fn other_files_are_left_to_others_and_bad_ones_are_refused_by_their_patch() {
        for other in ["", "{", "[]", "7", r#"{"ductile": 1}"#, "[1, 2]"] {
            assert_eq!(ribbon_holes(other), None, "{other}");
        }
        let twice = r#"[{"side": 0, "row0": []}, {"side": 0, "row0": []}]"#;
        assert_eq!(holes(twice), Err(RibbonFileError::Sides { patch: 0, count: 2 }));
        assert!(holes(twice).unwrap_err().to_string().contains("from 0 to 1"));
        assert_eq!(holes(r#"{"patches": []}"#), Err(RibbonFileError::Empty));
        let bad = format!(r#"[{{"ribbons": [{RIBBON}]}}, {{"ribbons": [{{"row0": [[0, 0]]}}]}}]"#);
        assert!(matches!(holes(&bad), Err(RibbonFileError::Malformed { patch: 1, .. })));
    }
}
