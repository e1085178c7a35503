//! The surface below displacements, of whatever kind, as flat arrays.

use crate::bound::BoundSurface;
use crate::model::Model;
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use ductile_spec::{CurveId, SurfaceId};
use glam::DVec3;

/// The surface below displacements.
#[derive(Clone, Copy, Debug)]
pub(super) struct Base<'a> {
    /// Names its connectivity.
    pub(super) revision: u64,
    pub(super) positions: &'a [DVec3],
    /// Unit normals; zero where there is no tangent plane.
    pub(super) normals: &'a [DVec3],
    pub(super) triangles: &'a [[u32; 3]],
    fair: Option<(&'a Model, &'a SurfaceShape, &'a BoundSurface)>,
}

impl<'a> Base<'a> {
    /// The surface as it is now, if the relaxer knows it or it is exact.
    pub(super) fn of(model: &'a Model, relaxer: &'a Relaxer, id: SurfaceId) -> Option<Self> {
        if let Some(shape) = model.surfaces.get(&id) {
            let bound = relaxer.surface(id, shape)?;
            let (positions, normals) = (&bound.positions[..], bound.normals());
            let fair = Some((model, &**shape, bound));
            return Some(Self {
                revision: shape.revision,
                positions,
                normals,
                triangles: bound.triangles(),
                fair,
            });
        }
        let shape = model.patches.get(&id)?;
        Some(Self {
            revision: shape.revision(),
            positions: shape.positions(),
            normals: shape.normals(),
            triangles: shape.triangles(),
            fair: None,
        })
    }

    /// The vertices along a curve inside it, in order, and whether the curve closes.
    pub(super) fn along(&self, curve: CurveId) -> Option<(Vec<usize>, bool)> {
        let (model, shape, bound) = self.fair?;
        let embedded = shape.embeddings.iter().find(|embedded| embedded.curve == curve)?;
        let nodes = embedded.vertices.iter().map(|v| bound.node(*v) as usize).collect();
        Some((nodes, model.curves.get(&curve)?.closed))
    }

    /// Half the diagonal of the box around it.
    pub(super) fn radius(&self) -> f64 {
        let low = self.positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = self.positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
        0.5 * high.distance(low)
    }
}
