//! Meshes that a reference file names instead of listing: each is fixed by its family and its number of nodes.

use super::smooth::Smooth;
use ductile_solver::workload::{self, Workload};

/// Most nodes that are made on the word of a file.
const MOST_NODES: usize = 200_000;

/// A family of ever finer meshes of one surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Family {
    /// The icosahedron, divided again and again, on the unit sphere.
    Ico,
    /// The staggered grid, twice as many nodes around as across, on the torus of the file's own meshes.
    Staggered { major: f64, minor: f64 },
}

impl Family {
    /// The family of that name, for a file whose meshes lie on that surface.
    pub(crate) fn named(name: &str, smooth: Option<Smooth>) -> Option<Self> {
        match (name, smooth) {
            ("ico", Some(Smooth::Sphere)) => Some(Self::Ico),
            ("staggered", Some(Smooth::Torus { major, minor })) => Some(Self::Staggered { major, minor }),
            _ => None,
        }
    }

    /// The mesh with that many nodes, if there is one, and the energy of the smooth surface.
    pub(crate) fn member(self, nodes: usize) -> Option<(Workload, f64)> {
        if nodes > MOST_NODES {
            return None;
        }
        match self {
            Self::Ico => {
                let levels = (0..8).find(|level| 10 * 4_usize.pow(*level) + 2 == nodes)?;
                Some((workload::sphere(levels), Smooth::Sphere.energy()))
            }
            Self::Staggered { major, minor } => {
                let across = (3..400).find(|across| 2 * across * across == nodes)?;
                let across = u32::try_from(across).ok()?;
                let exact = Smooth::Torus { major, minor }.energy();
                Some((workload::torus(2 * across, across, major, minor), exact))
            }
        }
    }
}

/// The disc of concentric rings with that many nodes, if there is one: `1 + 3 n (n + 1)`.
pub(crate) fn disc(nodes: usize) -> Option<Workload> {
    let rings = (1..256).find(|n| 1 + 3 * n * (n + 1) == nodes)?;
    Some(workload::disc(rings))
}
