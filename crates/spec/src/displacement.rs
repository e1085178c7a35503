//! Displacements: what moves the interior of a finished surface (P. Salvi, *Editing the interior of arbitrary surfaces using
//! C∞ displacement blends*).

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The displacements of a surface.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displaced {
    /// In the order in which they were made, at least one.
    pub items: Vec<Displacement>,
}

/// A displacement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Displacement {
    /// The place of the surface that it moves.
    pub foot: DVec3,
    /// By what it moves it, in model units.
    pub by: DVec3,
}
