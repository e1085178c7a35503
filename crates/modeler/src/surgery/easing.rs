//! Easing: a tube that nothing holds is creased where it begins, and may crumple before it is smooth. So what was joined
//! begins with triangles that can follow, and is relaxed a little out of sight; if the document opens to a better start, that
//! is taken.

use crate::growth::{Beginning, Ground};
use crate::maintain;
use crate::model::Model;
use crate::settle::MOST_NODES;
use crate::shape::{SurfaceShape, edit};
use ductile_spec::SurfaceId;
use std::sync::Arc;

/// What is there must be better than what its document opens to by this part: among equals the document's own is taken, on which
/// the model can be opened again.
const BETTER: f64 = 1.01;

/// Refines what was joined to its spacing: triangles from rim to rim cannot bend.
pub(crate) fn refine(model: &mut Model, id: SurfaceId) {
    let revision = model.next_revision();
    if let Some(shape) = model.surfaces.get_mut(&id).map(edit::<SurfaceShape>) {
        maintain::refine(shape, 1);
        shape.revision = revision;
    }
}

/// Lets a surface begin as it is, relaxed as far as one is grown, or as what its document opens to: whichever is the better start.
/// What cannot be relaxed, or would keep everybody waiting, is left as it is.
pub(crate) fn begin(model: &mut Model, id: SurfaceId) {
    let Some(shape) = model.surfaces.get(&id).filter(|shape| shape.mesh.vertex_count() <= MOST_NODES) else {
        return;
    };
    let mut eased = SurfaceShape::clone(shape);
    let Ok(cost) = (Ground { document: &model.document, curves: &model.curves, id }).ease(&mut eased) else {
        return;
    };
    let opened = model.grow(id, Beginning::Grown).ok();
    let ground = Ground { document: &model.document, curves: &model.curves, id };
    let is_better = |opened: &SurfaceShape| ground.cost(opened).is_ok_and(|other| other < BETTER * cost);
    let mut shape = opened.filter(is_better).unwrap_or(eased);
    shape.revision = model.next_revision();
    model.surfaces.insert(id, Arc::new(shape));
}
