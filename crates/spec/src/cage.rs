//! A cage surface: an exact surface through the vertices of a polygon mesh, its *cage* (P. Salvi, *Polyhedral design with
//! blended n-sided interpolants*). The vertices of the cage are control points of the document.

use crate::id::PointId;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;

/// A surface over a cage.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cage {
    /// The corners of its faces, at least three each, counter-clockwise seen from outside.
    pub faces: Vec<Vec<PointId>>,
}

impl Cage {
    /// A cage with these faces.
    #[must_use]
    pub fn new(faces: Vec<Vec<PointId>>) -> Self {
        Self { faces }
    }

    /// Its vertices, each once, in order of identity.
    #[must_use]
    pub fn points(&self) -> BTreeSet<PointId> {
        self.faces.iter().flatten().copied().collect()
    }
}
