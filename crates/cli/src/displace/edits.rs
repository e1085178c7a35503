//! The file of edits: what is displaced, and how. The format is described in docs/displacements.md.

use ductile_patch as patch;
use glam::DVec3;
use serde::Deserialize;

/// Everything that a file can say.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub(crate) struct Edits {
    laplacian: Laplacian,
    profile: Profile,
    combination: Combination,
    blend: Blend,
    /// Vertices that stay where they are, beside the boundary.
    pub(crate) pins: Vec<usize>,
    /// Whether feet at points get vertices of their own.
    pub(crate) split: bool,
    pub(crate) feet: Vec<Foot>,
    pub(crate) curves: Vec<Curve>,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
enum Laplacian {
    #[default]
    #[serde(rename = "intrinsic-delaunay")]
    IntrinsicDelaunay,
    #[serde(rename = "cotangent")]
    Cotangent,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Profile {
    #[default]
    Conformal,
    Harmonic,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Combination {
    #[default]
    Pairwise,
    Plain,
    Gram,
    Cardinal,
}

#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Blend {
    #[default]
    Erbs,
    Bump(f64),
    Eta(f64),
}

/// A foot: `vertex` or `point`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Foot {
    pub(crate) vertex: Option<usize>,
    pub(crate) point: Option<[f64; 3]>,
    #[serde(default)]
    displacement: [f64; 3],
    range: Option<f64>,
    size: Option<f64>,
    direction: Option<Direction>,
}

/// A curve along edges.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Curve {
    vertices: Vec<usize>,
    #[serde(default)]
    closed: bool,
    displacement: Option<[f64; 3]>,
    displacements: Option<Vec<[f64; 3]>>,
    range: Option<f64>,
    size: Option<f64>,
    direction: Option<Direction>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Direction {
    along: [f64; 3],
    stretch: f64,
}

/// Reads the text of a file.
pub(crate) fn read(text: &str) -> Result<Edits, String> {
    // A list and an object are told apart before they are read: so an error has its place.
    if text.trim_start().starts_with('[') {
        let feet = serde_json::from_str(text).map_err(|reason| reason.to_string())?;
        return Ok(Edits { feet, ..Edits::default() });
    }
    serde_json::from_str(text).map_err(|reason| reason.to_string())
}

impl Edits {
    pub(crate) fn settings(&self) -> patch::Settings {
        patch::Settings {
            laplacian: match self.laplacian {
                Laplacian::IntrinsicDelaunay => patch::Laplacian::IntrinsicDelaunay,
                Laplacian::Cotangent => patch::Laplacian::Cotangent,
            },
            profile: match self.profile {
                Profile::Conformal => patch::Profile::Conformal,
                Profile::Harmonic => patch::Profile::Harmonic,
            },
            combination: match self.combination {
                Combination::Pairwise => patch::Combination::Pairwise,
                Combination::Plain => patch::Combination::Plain,
                Combination::Gram => patch::Combination::Gram,
                Combination::Cardinal => patch::Combination::Cardinal,
            },
            blend: match self.blend {
                Blend::Erbs => patch::Blend::Erbs,
                Blend::Bump(k) => patch::Blend::Bump(k),
                Blend::Eta(delta) => patch::Blend::Eta(delta),
            },
        }
    }
}

impl Foot {
    /// The item at the vertex where the foot was put.
    pub(crate) fn item(&self, vertex: usize) -> Result<patch::Item, String> {
        let item = patch::Item::foot(vertex, DVec3::from(self.displacement));
        reaching(item, self.range, self.size, self.direction)
    }
}

impl Curve {
    pub(crate) fn item(&self) -> Result<patch::Item, String> {
        let displacements = match (self.displacement, &self.displacements) {
            (Some(_), Some(_)) => return Err("either `displacement` or `displacements`, not both".into()),
            (_, Some(list)) => list.iter().copied().map(DVec3::from).collect(),
            (one, None) => vec![DVec3::from(one.unwrap_or_default())],
        };
        let item = patch::Item::curve(self.vertices.clone(), self.closed, displacements);
        reaching(item.map_err(|reason| reason.to_string())?, self.range, self.size, self.direction)
    }
}

fn reaching(
    mut item: patch::Item,
    range: Option<f64>,
    size: Option<f64>,
    direction: Option<Direction>,
) -> Result<patch::Item, String> {
    let range = match (range, size) {
        (Some(_), Some(_)) => return Err("either `range` or `size`, not both".into()),
        (Some(range), None) => patch::Range::new(range),
        (None, Some(size)) => patch::Range::of_size(size),
        (None, None) => Ok(patch::Range::default()),
    };
    item = item.with_range(range.map_err(|reason| reason.to_string())?);
    if let Some(Direction { along, stretch }) = direction {
        let direction = patch::Direction::new(DVec3::from(along), stretch);
        item = item.with_direction(direction.map_err(|reason| reason.to_string())?);
    }
    Ok(item)
}
