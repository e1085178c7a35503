//! Regions that shadow a stamp are meshed as finely as the stamp, compared by the lengths of their rims: what is finer in the
//! relief than the edges of the region would be lost. (Thesis section 7.3.3 wants node for node; here the finer of both counts.)

use crate::model::Model;
use crate::patch::PatchRim;
use crate::region;
use crate::shape::SurfaceShape;
use ductile_mesh::{EdgeId, regions};
use ductile_spec::{Surface, SurfaceId};

/// Shortest edges for the sake of a relief, as a part of what they would be without: sixteen times the triangles are enough.
const LEAST: f64 = 0.25;

/// Shortens what regions want that shadow others.
pub(super) fn shorten(field: &mut [f64], model: &Model, shape: &SurfaceShape, surface: &Surface) {
    if surface.regions.iter().all(|region| region.shadow.is_none()) {
        return;
    }
    let labels = regions(&shape.mesh);
    let bounds = labels.bounds(&shape.mesh);
    let shares = region::own(shape, &labels, &surface.regions, |region| share(model, region.shadow?.of));
    let wanted: Vec<Option<f64>> =
        shares.iter().zip(&bounds).map(|(share, bounds)| Some((*share)? * length(shape, bounds))).collect();
    let before = field.to_vec();
    for f in shape.mesh.faces() {
        let Some(wanted) = wanted[labels.of(f)] else { continue };
        for v in shape.mesh.face_vertices(f).map(|v| v.index()) {
            field[v] = field[v].min(wanted.max(LEAST * before[v]));
        }
    }
}

/// The edges of a stamp as a part of its rim.
fn share(model: &Model, of: SurfaceId) -> Option<f64> {
    let share = match (model.surfaces.get(&of), model.patches.get(&of)) {
        (Some(shape), _) => {
            let rim: Vec<EdgeId> = shape.mesh.edges().filter(|e| shape.mesh.is_boundary_edge(*e)).collect();
            shape.spacing / length(shape, &rim)
        }
        (None, Some(patch)) => 1.0 / PatchRim::new(patch).edge_count() as f64,
        (None, None) => return None,
    };
    share.is_finite().then_some(share)
}

fn length(shape: &SurfaceShape, edges: &[EdgeId]) -> f64 {
    let ends = edges.iter().map(|e| shape.mesh.edge_vertices(*e).map(|v| shape.positions[v.index()]));
    ends.map(|[a, b]| a.distance(b)).sum()
}
