//! Exact surfaces: those that are computed from their controls at once and need no relaxation. They follow their controls
//! in every frame, in the middle of a drag too, and never keep a model from resting. Fixed meshes, which have no controls, are
//! among them.

mod cage;
pub(crate) mod fill;
mod led;
mod mesh;
mod polygons;
mod rim;
#[cfg(test)]
mod tests;

use crate::error::ModelError;
use crate::frame::summarise;
use crate::model::Model;
use crate::relax::Relaxer;
use crate::shape::edit;
use ductile_mesh::Mesh;
use ductile_spec::{SurfaceId, SurfaceKind, SurfaceSummary};
use glam::DVec3;

pub use cage::CageShape;
pub use fill::{FillError, FillShape};
pub(crate) use led::{Led, led_nodes};
pub use mesh::MeshShape;
pub(crate) use polygons::{caged, change};
pub(crate) use rim::PatchRim;

/// The tessellation of an exact surface, as its controls were when it last followed them.
#[derive(Clone, Debug)]
pub enum PatchShape {
    /// A surface over a cage.
    Cage(CageShape),
    /// A patch in a loop of curves.
    Fill(FillShape),
    /// A fixed mesh.
    Mesh(MeshShape),
}

/// A control net: places and the edges between them.
pub type NetLines<'a> = (&'a [DVec3], &'a [[u32; 2]]);

impl PatchShape {
    /// What kind of surface it is.
    #[must_use]
    pub fn kind(&self) -> SurfaceKind {
        match self {
            Self::Cage(_) => SurfaceKind::Cage,
            Self::Fill(_) => SurfaceKind::Fill,
            Self::Mesh(_) => SurfaceKind::Mesh,
        }
    }

    /// Where its vertices are.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        match self {
            Self::Cage(shape) => shape.positions(),
            Self::Fill(shape) => shape.positions(),
            Self::Mesh(shape) => shape.positions(),
        }
    }

    /// Unit normals at its vertices; zero where it has no tangent plane.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        match self {
            Self::Cage(shape) => shape.normals(),
            Self::Fill(shape) => shape.normals(),
            Self::Mesh(shape) => shape.normals(),
        }
    }

    /// Corners of its triangles.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        match self {
            Self::Cage(shape) => shape.triangles(),
            Self::Fill(shape) => shape.triangles(),
            Self::Mesh(shape) => shape.triangles(),
        }
    }

    /// Its control net: places, and the edges between them.
    #[must_use]
    pub fn net(&self) -> NetLines<'_> {
        match self {
            Self::Cage(shape) => shape.net(),
            Self::Fill(shape) => shape.net(),
            Self::Mesh(_) => (&[], &[]),
        }
    }

    /// Its topology.
    pub(crate) fn summary(&self) -> SurfaceSummary {
        if let Self::Mesh(shape) = self {
            return shape.summary();
        }
        Mesh::from_triangles(self.positions().len(), self.triangles())
            .map_or_else(|_| SurfaceSummary::default(), |mesh| summarise(&mesh))
    }

    /// Names its connectivity.
    #[must_use]
    pub fn revision(&self) -> u64 {
        match self {
            Self::Cage(shape) => shape.revision,
            Self::Fill(shape) => shape.revision,
            Self::Mesh(shape) => shape.revision,
        }
    }

    /// Names its connectivity anew.
    pub(crate) fn set_revision(&mut self, revision: u64) {
        match self {
            Self::Cage(shape) => shape.revision = revision,
            Self::Fill(shape) => shape.revision = revision,
            Self::Mesh(shape) => shape.revision = revision,
        }
    }

    /// Rough size in memory.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match self {
            Self::Cage(shape) => shape.bytes(),
            // The tables of its kind are shared with others of it.
            Self::Fill(shape) => 48 * shape.positions().len(),
            Self::Mesh(shape) => shape.bytes(),
        }
    }

    /// Whether its controls have moved since it last followed them.
    fn is_behind(&self, model: &Model) -> bool {
        match self {
            Self::Cage(shape) => shape.is_behind(&model.document),
            // They look at one another: see `fill::follow`.
            Self::Fill(_) | Self::Mesh(_) => false,
        }
    }

    /// Follows its controls, as far as it can.
    fn follow(&mut self, model: &Model) {
        match self {
            Self::Cage(shape) => shape.follow(&model.document),
            Self::Fill(_) | Self::Mesh(_) => {}
        }
    }
}

/// The shape of an exact surface of the document. A fill has nothing to show yet: [`follow`] builds it.
///
/// # Errors
/// What is wrong with its controls.
pub(crate) fn build(model: &Model, id: SurfaceId, revision: u64) -> Result<PatchShape, ModelError> {
    if let Some(fill) = model.document.fills.get(&id) {
        return Ok(PatchShape::Fill(FillShape::new(fill.style, revision)));
    }
    if let Some(mesh) = model.document.meshes.get(&id) {
        return MeshShape::new(id, mesh, revision).map(PatchShape::Mesh);
    }
    let Some(cage) = model.document.cages.get(&id) else { return Err(ModelError::NoSurface(id)) };
    CageShape::new(id, cage, &model.document, revision).map(PatchShape::Cage)
}

/// Brings every exact surface up to date with its controls, and with the fair surfaces beside it, of which the relaxer knows the
/// planes. One that cannot follow stays as it was.
pub(crate) fn follow(model: &mut Model, relaxer: Option<&Relaxer>) {
    for id in model.patches.keys().copied().collect::<Vec<_>>() {
        // Taken out while it looks at the model, so that nobody else holds it and it need not be copied.
        let Some(mut shape) = model.patches.remove(&id) else { continue };
        if shape.is_behind(model) {
            edit(&mut shape).follow(model);
        }
        model.patches.insert(id, shape);
    }
    fill::follow(model, relaxer);
}
