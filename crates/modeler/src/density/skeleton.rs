//! Edge lengths along a curve before there is a mesh: read off the skeletons of the surfaces that follow it.

use crate::error::ModelError;
use crate::model::Model;
use crate::region;
use crate::shape::{EmbeddedCurve, SurfaceShape};
use ductile_mesh::{Mesh, SourceTag, VertexId, regions};
use ductile_spec::{CurveId, PointId, Side, SkeletonVertex, Surface};
use glam::DVec3;

/// The spacing of each stretch of a curve: the least of what the surfaces or regions beside it have; of a free curve, the
/// document's.
///
/// # Errors
/// [`ModelError::NoCurve`] when there is no such curve.
pub(crate) fn of_stretches(model: &Model, id: CurveId) -> Result<Vec<f64>, ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let starts = if curve.closed { curve.through.len() } else { curve.through.len().saturating_sub(1) };
    let mut spacings: Vec<Option<f64>> = vec![None; starts];
    for surface_id in model.document.surfaces_on(id) {
        let Some(surface) = model.document.surfaces.get(&surface_id) else { continue };
        let spacing = model.spacing_of(surface_id);
        let beside = beside(surface, id, &curve.through[..starts], spacing);
        for (k, least) in spacings.iter_mut().enumerate() {
            let own = beside.as_ref().map_or(spacing, |beside| beside[k]);
            *least = Some(least.map_or(own, |least| least.min(own)));
        }
    }
    Ok(spacings.into_iter().map(|own| own.unwrap_or_else(|| model.spacing())).collect())
}

/// The least spacing of the regions on both sides of each stretch; `None` where no region has its own, or the skeleton is no
/// surface (which whoever builds it will say).
fn beside(surface: &Surface, id: CurveId, starts: &[PointId], spacing: f64) -> Option<Vec<f64>> {
    surface.regions.iter().find(|region| region.spacing.is_some())?;
    let shape = bare(surface, spacing)?;
    let labels = regions(&shape.mesh);
    let own = region::own(&shape, &labels, &surface.regions, |region| region.spacing);
    let of_side = |from: PointId, side: Side| {
        let face = region::face_beside(&shape, id, from, side)?;
        Some(own[labels.of(face)].unwrap_or(spacing))
    };
    let least = |from: &PointId| {
        let sides = [Side::Left, Side::Right].into_iter().filter_map(|side| of_side(*from, side));
        sides.reduce(f64::min).unwrap_or(spacing)
    };
    Some(starts.iter().map(least).collect())
}

/// The skeleton itself as a shape without places, its curves marked.
fn bare(surface: &Surface, spacing: f64) -> Option<SurfaceShape> {
    let skeleton = &surface.skeleton;
    let mut mesh = Mesh::from_triangles(skeleton.vertices.len(), &skeleton.triangles).ok()?;
    for (index, vertex) in skeleton.vertices.iter().enumerate() {
        if let SkeletonVertex::Control(point) = vertex {
            mesh.set_vertex_source(VertexId::from_index(index), Some(SourceTag(point.0)));
        }
    }
    let mut embeddings = Vec::new();
    for embedding in &skeleton.curves {
        let vertices: Vec<_> = embedding.along.iter().map(|v| VertexId::from_index(*v as usize)).collect();
        for (a, b) in vertices.iter().zip(vertices.iter().cycle().skip(1)) {
            if let Some(e) = mesh.edge_between(*a, *b) {
                mesh.set_edge_source(e, Some(SourceTag(embedding.curve.0)));
            }
        }
        embeddings.push(EmbeddedCurve { curve: embedding.curve, vertices });
    }
    let positions = vec![DVec3::ZERO; mesh.vertex_slots()];
    Some(SurfaceShape {
        mesh,
        positions,
        embeddings,
        pins: Vec::new(),
        spacing,
        wanted: Vec::new(),
        age: 0,
        revision: 0,
    })
}
