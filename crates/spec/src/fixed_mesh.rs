//! A fixed mesh: a surface that is what its triangles say, and nothing else. What comes from elsewhere as triangles is kept like
//! this, and so is a displaced surface that was baked.

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Most vertices of all fixed meshes of a document together. With so many, each coordinate written with all its digits, the
/// spec file stays below its limit.
pub const MOST_MESH_VERTICES: usize = 30_000;
/// Most triangles of all fixed meshes of a document together.
pub const MOST_MESH_TRIANGLES: usize = 60_000;

/// A surface of given triangles.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FixedMesh {
    /// Where its vertices are, in model units. Each is a corner of some triangle.
    pub vertices: Vec<DVec3>,
    /// The corners of its triangles, counter-clockwise seen from outside. Where they disagree, the first ones count; a surface with
    /// one side has no outside.
    pub triangles: Vec<[u32; 3]>,
}

/// Where a fixed mesh comes from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum MeshSource {
    /// It is given; vertices that no triangle uses are passed over.
    Given(FixedMesh),
}

impl FixedMesh {
    /// The same without vertices that no triangle uses.
    #[must_use]
    pub fn without_unused(&self) -> Self {
        let mut names: Vec<Option<u32>> = vec![None; self.vertices.len()];
        for corner in self.triangles.as_flattened() {
            if let Some(name) = names.get_mut(*corner as usize) {
                *name = Some(0);
            }
        }
        for (name, number) in names.iter_mut().flatten().zip(0..) {
            *name = number;
        }
        let used = self.vertices.iter().zip(&names).filter_map(|(at, name)| name.map(|_| *at));
        // A corner that does not exist keeps a name that does not exist.
        let named = |corner: u32| names.get(corner as usize).copied().flatten().unwrap_or(u32::MAX);
        Self {
            vertices: used.collect(),
            triangles: self.triangles.iter().map(|corners| corners.map(named)).collect(),
        }
    }

    /// Half the diagonal of the box around it.
    #[must_use]
    pub fn radius(&self) -> f64 {
        let low = self.vertices.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = self.vertices.iter().copied().reduce(DVec3::max).unwrap_or_default();
        0.5 * high.distance(low)
    }
}
