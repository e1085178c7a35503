//! Where a cage comes from: those that the program makes itself, and those that are given.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Where a cage comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum CageSource {
    /// One that the program makes.
    BuiltIn {
        /// Which.
        form: CageForm,
        /// Where its centre is.
        centre: DVec3,
        /// About its radius, in model units: half the edge of a cube, the radius of the others, half the side of a grid.
        size: f64,
    },
    /// A polygon mesh.
    Given {
        /// Where its vertices are.
        vertices: Vec<DVec3>,
        /// The corners of its faces, indices into the vertices, counter-clockwise seen from outside.
        faces: Vec<Vec<u32>>,
    },
}

/// A cage that the program makes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CageForm {
    /// Six quads.
    #[default]
    Cube,
    /// Four triangles.
    Tetrahedron,
    /// Eight triangles.
    Octahedron,
    /// Twenty triangles.
    Icosahedron,
    /// Twelve pentagons.
    Dodecahedron,
    /// Six quads around times four across.
    Torus,
    /// Three lobes with a hole through each.
    Trebol,
    /// Four times four quads, open.
    Grid,
    /// Six quads that meet in the middle, open.
    Disc,
}

impl CageForm {
    /// All of them, in the order of a menu.
    pub const ALL: [Self; 9] = [
        Self::Cube,
        Self::Tetrahedron,
        Self::Octahedron,
        Self::Icosahedron,
        Self::Dodecahedron,
        Self::Torus,
        Self::Trebol,
        Self::Grid,
        Self::Disc,
    ];

    /// Its name on the page.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Cube => "Cube",
            Self::Tetrahedron => "Tetrahedron",
            Self::Octahedron => "Octahedron",
            Self::Icosahedron => "Icosahedron",
            Self::Dodecahedron => "Dodecahedron",
            Self::Torus => "Torus",
            Self::Trebol => "Trebol",
            Self::Grid => "Grid",
            Self::Disc => "Disc",
        }
    }
}
