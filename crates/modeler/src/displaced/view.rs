//! What is shown of a surface, whatever lies over it.

use super::Displacer;
use super::base::Base;
use crate::model::Model;
use crate::relax::Relaxer;
use ductile_spec::SurfaceId;
use glam::DVec3;

/// A surface as it is shown, or what of it lies below a shadow.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    /// Names the connectivity of the base, and that of what is displaced over it.
    pub(super) revision: [u64; 2],
    pub(super) positions: &'a [DVec3],
    pub(super) normals: &'a [DVec3],
    pub(super) triangles: &'a [[u32; 3]],
    /// Of each triangle the one of the base in which it lies, if they are not the same.
    pub(super) parents: Option<&'a [u32]>,
}

impl Displacer {
    /// A surface with its displacements, without shadows.
    pub(super) fn below_shadows<'a>(&'a self, base: &Base<'a>, id: SurfaceId) -> View<'a> {
        match self.get(id) {
            Some(overlay) => View {
                revision: [base.revision, overlay.revision],
                positions: overlay.positions(),
                normals: overlay.normals(),
                triangles: overlay.triangles(),
                parents: Some(overlay.parents()),
            },
            None => View {
                revision: [base.revision, 0],
                positions: base.positions,
                normals: base.normals,
                triangles: base.triangles,
                parents: None,
            },
        }
    }

    /// A surface as it is shown.
    pub(super) fn view<'a>(
        &'a self,
        model: &'a Model,
        relaxer: &'a Relaxer,
        id: SurfaceId,
    ) -> Option<View<'a>> {
        let below = self.below_shadows(&Base::of(model, relaxer, id)?, id);
        let shadowed = self.shadowed.get(&id);
        Some(shadowed.map_or(below, |shadowed| View {
            positions: shadowed.positions(),
            normals: shadowed.normals(),
            ..below
        }))
    }

    /// Positions and normals of what is shown of a surface over which something lies.
    pub(crate) fn vertices(&self, id: SurfaceId) -> Option<(&[DVec3], &[DVec3])> {
        if let Some(shadowed) = self.shadowed.get(&id) {
            return Some((shadowed.positions(), shadowed.normals()));
        }
        self.get(id).map(|overlay| (overlay.positions(), overlay.normals()))
    }
}
