//! Meshes to start from: sheets and cylinders for the modeler (Welch 1995, §4.2.2), closed and one-sided
//! surfaces for tests and gallery.
//!
//! Each comes with positions: `positions[v.index()]` belongs to vertex `v`. Oriented surfaces are wound
//! counter-clockwise seen from outside, or from above.

mod ball;
mod grid;
mod sheet;

pub use ball::{icosphere, octahedron, subdivided, tetrahedron};
pub use grid::{klein_bottle, moebius, plane, torus};
pub use sheet::{PrimitiveError, cylinder, natural_rings, sheet};

use glam::DVec3;

use crate::Mesh;

/// A mesh made here is a surface by construction.
fn built(triangles: &[[u32; 3]], positions: Vec<DVec3>) -> (Mesh, Vec<DVec3>) {
    let mesh = Mesh::from_triangles(positions.len(), triangles).expect("primitives are surfaces");
    (mesh, positions)
}

/// A vertex number. The largest primitive is far from 2³² vertices.
fn number(i: usize) -> u32 {
    u32::try_from(i).expect("a primitive has fewer than 2^32 vertices")
}

#[cfg(test)]
mod tests;
