//! `smooth`: two rims on the same curve become one surface that runs smoothly through it (thesis section 7.3.2): the inverse
//! of a crease.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::refresh_skeleton;
use crate::shape::{SurfaceShape, edit};
use crate::surgery::joining::{say, sew, unite};
use ductile_mesh::{Seam, VertexId};
use ductile_spec::{CurveId, SurfaceId};

/// Joins the two rims that follow a curve, of two surfaces or of one.
pub(super) fn smooth(model: &mut Model, curve: CurveId) -> Result<(), ModelError> {
    let closed = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?.closed;
    let rims = rims(model, curve);
    let [one, other] = match rims[..] {
        [one, other] => [one, other],
        [] | [_] => return Err(ModelError::NoCrease(curve)),
        _ => return Err(ModelError::ManyRims { curve, count: rims.len() }),
    };
    let told = unite(model, one, other)?.told;
    let seam = |shape: &SurfaceShape| {
        let mut lines = shape.embeddings.iter().filter(|e| e.curve == curve).map(|e| e.vertices.clone());
        Some(Seam { kept: lines.next()?, gone: lines.next()?, is_closed: closed })
    };
    sew(model, one, seam)?;
    if let Some(shape) = model.surfaces.get_mut(&one).map(edit) {
        let mut is_first = true;
        shape.embeddings.retain(|e| e.curve != curve || core::mem::replace(&mut is_first, false));
    }
    if let Some(surface) = model.document_mut().surfaces.get_mut(&one) {
        // How the rims left the curve is for nobody to say any more.
        surface.ribbons.remove(&curve);
    }
    refresh_skeleton(model, one);
    say(model, one, &told);
    Ok(model.document.validate()?)
}

/// The surfaces of the rims along a curve, one entry for each rim.
fn rims(model: &Model, curve: CurveId) -> Vec<SurfaceId> {
    let mut rims = Vec::new();
    for (id, shape) in &model.surfaces {
        for embedded in shape.embeddings.iter().filter(|e| e.curve == curve) {
            let ends = embedded.vertices.iter().zip(embedded.vertices.iter().skip(1));
            let is_rim = |(a, b): (&VertexId, &VertexId)| {
                shape.mesh.edge_between(*a, *b).is_some_and(|e| shape.mesh.is_boundary_edge(e))
            };
            if ends.into_iter().all(is_rim) {
                rims.push(*id);
            }
        }
    }
    rims
}
