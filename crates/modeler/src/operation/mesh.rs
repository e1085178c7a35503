//! `mesh`: a surface that is what its triangles say.

use crate::error::ModelError;
use crate::model::Model;
use ductile_spec::{FixedMesh, MeshSource, SurfaceId};
use glam::DVec3;

/// Digits that are kept of coordinates which nobody wrote by hand, counted from the leading digit of the mesh's radius: a tenth of
/// what an `f32` keeps, and finer than anything that is drawn.
const DIGITS: i32 = 7;

/// Makes a mesh that is given.
pub(super) fn mesh(model: &mut Model, from: &MeshSource) -> Result<(), ModelError> {
    let MeshSource::Given(given) = from;
    add(model, &given.without_unused())
}

/// Takes a mesh into the document.
pub(super) fn add(model: &mut Model, mesh: &FixedMesh) -> Result<(), ModelError> {
    let surface = model.document.next_surface();
    put(model, surface, mesh.clone())
}

/// Takes a mesh into the document under an identity that is free.
pub(super) fn put(model: &mut Model, surface: SurfaceId, mesh: FixedMesh) -> Result<(), ModelError> {
    model.document_mut().meshes.insert(surface, mesh);
    model.document.validate()?;
    model.build_patch(surface)
}

/// The same mesh with coordinates that are short as text.
pub(super) fn compact(mut mesh: FixedMesh) -> FixedMesh {
    let radius = mesh.radius();
    let exponent = format!("{radius:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let decimals = usize::try_from((DIGITS - 1 - exponent).clamp(0, 15)).unwrap_or(0);
    // Through the decimal text: exact on every machine. Adding zero turns -0 into 0.
    let keep = |x: f64| format!("{x:.decimals$}").parse::<f64>().unwrap_or(x) + 0.0;
    for at in &mut mesh.vertices {
        *at = DVec3::from_array(at.to_array().map(keep));
    }
    mesh
}
