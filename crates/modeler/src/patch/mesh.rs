//! A fixed mesh of the document as it is shown: its triangles, wound alike as far as they can be, and normals.
//!
//! Normals are those of the solver's fits, as fair surfaces have them, so that isophotes and curvature are as smooth as the mesh
//! allows. A mesh from elsewhere may have vertices that no fit can have: a fan of too many triangles, a spike, a fold. There the
//! normals of the triangles are averaged by their areas. At the rim, where others go on from a mesh and the solver's fits are of the first
//! order, they are those of cubics ([`rim_fit`]).

mod rim_fit;

use super::rim;
use crate::error::ModelError;
use ductile_mesh::{Mesh, propagate_orientation};
use ductile_solver::{Rings, Settings, SurfaceSolver};
use ductile_spec::{FixedMesh, SurfaceId, SurfaceSummary};
use glam::DVec3;

/// Cosine of the angle between a fitted normal and the mean of the triangles' beyond which the fit is not believed: 60°.
const BELIEVED: f64 = 0.5;

/// A fixed mesh.
#[derive(Clone, Debug)]
pub struct MeshShape {
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    /// The edges at which it ends, each with the third corner of its triangle.
    rim: Vec<[u32; 3]>,
    summary: SurfaceSummary,
    /// Names this connectivity.
    pub revision: u64,
}

impl MeshShape {
    /// The shape of a mesh of a document.
    ///
    /// # Errors
    /// [`ModelError::NotASurface`] for triangles that form no surface.
    pub(crate) fn new(id: SurfaceId, mesh: &FixedMesh, revision: u64) -> Result<Self, ModelError> {
        let refuse = |reason| ModelError::NotASurface { surface: id, reason };
        let mut built = Mesh::from_triangles(mesh.vertices.len(), &mesh.triangles).map_err(refuse)?;
        let is_two_sided = propagate_orientation(&mut built);
        let triangles = built.to_triangles();
        let normals = normals(&mesh.vertices, &triangles, is_two_sided);
        Ok(Self {
            positions: mesh.vertices.clone(),
            normals: rim_fit::with_rim(&built, &mesh.vertices, normals),
            rim: rim::edges(&triangles),
            triangles,
            summary: crate::frame::summarise(&built),
            revision,
        })
    }

    pub(super) fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    pub(super) fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    pub(super) fn rim(&self) -> &[[u32; 3]] {
        &self.rim
    }

    pub(super) fn summary(&self) -> SurfaceSummary {
        self.summary
    }

    /// Rough size in memory.
    pub(super) fn bytes(&self) -> usize {
        48 * self.positions.len() + 12 * (self.triangles.len() + self.rim.len())
    }
}

/// Unit normals at the vertices, towards the side from which the triangles look counter-clockwise; zero where nothing tells.
fn normals(positions: &[DVec3], triangles: &[[u32; 3]], is_two_sided: bool) -> Vec<DVec3> {
    let flat = averaged(positions, triangles, is_two_sided);
    let Some(fitted) = fitted(positions, triangles) else { return flat };
    let chosen = |(fitted, flat): (DVec3, DVec3)| {
        // The sense is the fit's own on a surface with one side.
        let is_believed = (fitted.length_squared() - 1.0).abs() < 1e-6 && fitted.dot(flat).abs() > BELIEVED;
        if is_believed { fitted } else { flat }
    };
    fitted.into_iter().zip(flat).map(chosen).collect()
}

fn fitted(positions: &[DVec3], triangles: &[[u32; 3]]) -> Option<Vec<DVec3>> {
    let rings = Rings::from_triangles(positions.len(), triangles).ok()?;
    let free = vec![false; positions.len()];
    let mut solver = SurfaceSolver::new(rings, free, Settings::default()).ok()?;
    solver.fit_all(positions);
    Some(solver.normals().to_vec())
}

/// The means of the triangles' normals, by area. On a surface with one side each joins in the sense in which it lengthens the sum.
fn averaged(positions: &[DVec3], triangles: &[[u32; 3]], is_two_sided: bool) -> Vec<DVec3> {
    let mut sums = vec![DVec3::ZERO; positions.len()];
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| positions[corner as usize]);
        let twice = (b - a).cross(c - a);
        for corner in corners {
            let sum = &mut sums[*corner as usize];
            *sum += if !is_two_sided && sum.dot(twice) < 0.0 { -twice } else { twice };
        }
    }
    sums.into_iter().map(DVec3::normalize_or_zero).collect()
}

#[cfg(test)]
mod tests;
