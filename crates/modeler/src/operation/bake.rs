//! `bake`: what is shown of a surface becomes a fixed mesh with the same number. Its curves stay where they are, its control points
//! go, as far as nothing else uses them. What goes on from it at a rim goes on from the mesh. Two fills that join smoothly hang together,
//! by the planes on which they agree, and by the curves of both, which lie in one plane at their corners: unless the other one goes on
//! from it, none of the two is baked alone.

use super::{delete, fill, mesh};
use crate::displaced::Displacer;
use crate::error::ModelError;
use crate::model::Model;
use crate::patch;
use crate::relax::Relaxer;
use ductile_spec::{FixedMesh, SurfaceId, SurfaceKind};

/// Bakes a surface, with its displacements.
pub(super) fn bake(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    id: SurfaceId,
) -> Result<(), ModelError> {
    let is_mesh = model.document.kind_of(id).ok_or(ModelError::NoSurface(id))? == SurfaceKind::Mesh;
    let is_displaced = displacer.get(id).is_some();
    if is_mesh && !is_displaced {
        return Err(ModelError::NothingToBake(id));
    }
    if let Some((other, curve)) = patch::fill::joined(&model.document, id) {
        return Err(ModelError::JoinedSmoothly { surface: id, other, curve });
    }
    let shown = displacer.shown(model, relaxer, id).filter(|(_, triangles)| !triangles.is_empty());
    let (positions, triangles) = shown.ok_or(ModelError::NothingShown(id))?;
    let given = FixedMesh { vertices: positions.to_vec(), triangles: triangles.to_vec() };
    let baked = mesh::compact(given.without_unused());
    let before = model.clone();
    // Ribbons and sides that name it are not told: they name the mesh now.
    delete::take_out(model, id)?;
    mesh::put(model, id, baked)?;
    fill::forget_lost(model);
    patch::follow(model, Some(relaxer));
    fill::check_kept(model, &before)?;
    model.check_extents()
}
