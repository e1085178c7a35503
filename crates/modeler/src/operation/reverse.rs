//! `reverse`: a surface is turned inside out (thesis section 7.2.3). Neighbouring triangles always agree where they can.
//! A fixed mesh is turned in the document.

use crate::error::ModelError;
use crate::model::Model;
use crate::shape::edit;
use ductile_spec::{CurveId, Side, SurfaceId};

/// Turns every triangle around. What lay to the left of a curve lies to its right then, and is called so.
pub(super) fn reverse(model: &mut Model, id: SurfaceId) -> Result<(), ModelError> {
    if let Some(mesh) = model.document_mut().meshes.get_mut(&id) {
        mesh.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        return model.build_patch(id);
    }
    let revision = model.next_revision();
    let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
    ductile_mesh::reverse(&mut shape.mesh);
    shape.revision = revision;
    let inner: Vec<CurveId> = shape
        .embeddings
        .iter()
        .filter(|e| e.vertices.iter().any(|v| !shape.mesh.is_boundary_vertex(*v)))
        .map(|e| e.curve)
        .collect();
    if let Some(surface) = model.document_mut().surfaces.get_mut(&id) {
        // The skeleton is the same one, turned: dehydrating the turned mesh would give another.
        surface.skeleton.triangles.iter_mut().for_each(|corners| corners.swap(0, 1));
        for region in &mut surface.regions {
            region.side = if region.side == Side::Left { Side::Right } else { Side::Left };
        }
        for (_, ribbon) in surface.ribbons.iter_mut().filter(|(curve, _)| inner.contains(curve)) {
            ribbon.cross.values_mut().for_each(|cross| *cross = -*cross);
        }
    }
    Ok(model.document.validate()?)
}
