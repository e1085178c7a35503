//! What the fixed meshes of a document must satisfy. Whether their triangles form a surface is for the mesh to say.

use super::{Defect, coordinate, limit};
use crate::document::Document;
use crate::fixed_mesh::{FixedMesh, MOST_MESH_TRIANGLES, MOST_MESH_VERTICES};
use crate::id::SurfaceId;

impl Document {
    pub(super) fn validate_meshes(&self) -> Result<(), Defect> {
        let count = |of: fn(&FixedMesh) -> usize| self.meshes.values().map(of).sum();
        limit("vertices of meshes", count(|mesh| mesh.vertices.len()), MOST_MESH_VERTICES)?;
        limit("triangles of meshes", count(|mesh| mesh.triangles.len()), MOST_MESH_TRIANGLES)?;
        self.meshes.iter().try_for_each(|(id, mesh)| {
            let is_taken =
                self.surfaces.contains_key(id) || self.cages.contains_key(id) || self.fills.contains_key(id);
            if is_taken { Err(Defect::TwoKinds(*id)) } else { validate_mesh(*id, mesh) }
        })
    }
}

fn validate_mesh(id: SurfaceId, mesh: &FixedMesh) -> Result<(), Defect> {
    if mesh.triangles.is_empty() {
        return Err(Defect::EmptySurface(id));
    }
    for (vertex, at) in mesh.vertices.iter().enumerate() {
        coordinate(&format!("{id}, vertex {vertex}"), *at)?;
    }
    let mut used = vec![false; mesh.vertices.len()];
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        let refuse = |corner, why| Defect::Triangle { surface: id, triangle, corner, why };
        for corner in corners {
            *used.get_mut(*corner as usize).ok_or(refuse(*corner, "does not exist"))? = true;
        }
        let [a, b, c] = *corners;
        if a == b || b == c || c == a {
            return Err(refuse(if b == c { b } else { a }, "or another one is repeated"));
        }
    }
    let unused = used.iter().position(|is_used| !is_used);
    unused.map_or(Ok(()), |vertex| Err(Defect::UnusedVertex { surface: id, vertex }))
}
