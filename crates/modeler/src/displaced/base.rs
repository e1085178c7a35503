//! The surface below displacements, of whatever kind, as flat arrays.

use super::view::View;
use crate::bound::BoundSurface;
use crate::model::Model;
use crate::region;
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use ductile_spec::{CurveId, PointId, Region, SurfaceId};
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

    /// The triangles of a region, as they are shown below a shadow.
    pub(super) fn region(&self, region: &Region, below: View<'_>) -> Option<Vec<[u32; 3]>> {
        let (_, shape, _) = self.fair?;
        let labels = ductile_mesh::regions(&shape.mesh);
        let face = region::face_beside(shape, region.curve, region.from, region.side)?;
        let is_own: Vec<bool> = shape.mesh.faces().map(|f| labels.of(f) == labels.of(face)).collect();
        let parent = |k: usize| below.parents.map_or(k, |parents| parents[k] as usize);
        let own = below.triangles.iter().enumerate().filter(|(k, _)| is_own.get(parent(*k)) == Some(&true));
        Some(own.map(|(_, corners)| *corners).collect())
    }

    /// The vertices that stand for a control point; on a curve that is followed on two rims there are two.
    pub(super) fn nodes_of(&self, point: PointId) -> Vec<u32> {
        let Some((_, shape, bound)) = self.fair else { return Vec::new() };
        let is_there =
            |v: &ductile_mesh::VertexId| shape.mesh.vertex_source(*v).is_some_and(|tag| tag.0 == point.0);
        shape.mesh.vertices().filter(is_there).map(|v| bound.node(v)).collect()
    }

    /// Half the diagonal of the box around it.
    pub(super) fn radius(&self) -> f64 {
        let low = self.positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
        let high = self.positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
        0.5 * high.distance(low)
    }
}
