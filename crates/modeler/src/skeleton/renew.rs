//! Skeletons are taken anew where moves led controls far through a surface.
//!
//! A handle that slides round a torus drags the triangles of its skeleton along, until they wind round the torus and through one
//! another, while the mesh shown follows by flips. What such a skeleton opens to is another shape. So when a move has ended, the skin
//! that an opening would begin with is compared with the one over what the mesh shown dehydrates to, both at the places where the
//! controls are in that mesh: it winds if it is larger by a part, and then the other skeleton is what the document keeps.
//! Plain drags, which leave both skins alike, do not change it, nor do twists of surfaces without handles, which are to leave no trace when they are undone.

use super::skeleton_of;
use crate::model::{Model, NODE_BUDGET};
use crate::rehydrate::mark_path;
use crate::shape::SurfaceShape;
use ductile_mesh::{Mesh, VertexId, measure, propagate_orientation, remesh, summary};
use ductile_spec::{Document, PointId, Skeleton, SkeletonVertex, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// How many times as large as a tight skin one is that winds. The example's handle, led round its torus, opens well with up to
/// 1.08 (135°), and to another shape with 1.16 (150°); at its beginning it has 1.03.
const WINDING: f64 = 1.1;

/// Takes the skeletons anew of surfaces in which controls that moved since `before` have led them astray. Returns whether there
/// were any. What could not be opened is not taken.
pub(crate) fn renew(before: &Document, model: &mut Model) -> bool {
    let mut is_renewed = false;
    for id in model.document.surfaces.keys().copied().collect::<Vec<_>>() {
        let Some(fresh) = tighter(before, model, id) else { continue };
        let kept = Arc::clone(&model.document);
        if let Some(surface) = model.document_mut().surfaces.get_mut(&id) {
            surface.skeleton = fresh;
        }
        if model.document.validate().is_ok() && model.check_extents().is_ok() {
            is_renewed = true;
        } else {
            model.document = kept;
        }
    }
    is_renewed
}

/// The skeleton of a surface as it is, if the document's winds where that does not.
fn tighter(before: &Document, model: &Model, id: SurfaceId) -> Option<Skeleton> {
    let shape = model.surfaces.get(&id).filter(|shape| shape.mesh.vertex_count() <= NODE_BUDGET)?;
    let old = &model.document.surfaces.get(&id)?.skeleton;
    let is_moved = |vertex: &SkeletonVertex| match vertex {
        SkeletonVertex::Control(point) => before.points.get(point) != model.document.points.get(point),
        SkeletonVertex::Free(_) => false,
    };
    if !(old.vertices.iter().any(is_moved) && can_slide(shape)) {
        return None;
    }
    let places = places(shape);
    let fresh = skeleton_of(model, shape);
    let winds = area(model, old, &places)? > WINDING * area(model, &fresh, &places)?;
    winds.then_some(fresh)
}

/// Whether there is anything to be led round that a twist back does not undo: a surface without handles or crosscaps is only wound up, and
/// what is unwound again must leave no trace.
fn can_slide(shape: &SurfaceShape) -> bool {
    summary(&shape.mesh).genus > 0
}

/// Where the controls are in a mesh, which may not have followed them yet.
fn places(shape: &SurfaceShape) -> BTreeMap<PointId, DVec3> {
    let place =
        |v: VertexId| shape.mesh.vertex_source(v).map(|tag| (PointId(tag.0), shape.positions[v.index()]));
    shape.mesh.vertices().filter_map(place).collect()
}

/// The area of the linear skin that an opening would begin with, were its controls at some places.
fn area(model: &Model, skeleton: &Skeleton, places: &BTreeMap<PointId, DVec3>) -> Option<f64> {
    let place = |vertex: &SkeletonVertex| match vertex {
        SkeletonVertex::Control(point) => places.get(point).copied(),
        SkeletonVertex::Free(at) => Some(*at),
    };
    let positions: Vec<DVec3> = skeleton.vertices.iter().map(place).collect::<Option<_>>()?;
    let mut mesh = Mesh::from_triangles(positions.len(), &skeleton.triangles).ok()?;
    propagate_orientation(&mut mesh);
    for embedding in &skeleton.curves {
        mark_path(&mut mesh, embedding, model.curves.get(&embedding.curve)?.closed);
    }
    remesh::tighten(&mut mesh, &positions);
    Some(measure::total_area(&mesh, &positions))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Modeler;
    use ductile_spec::{Edit, Example, GrabTarget, Request, Step};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn act(modeler: &mut Modeler, edit: Edit) {
        assert_eq!(modeler.handle(Request::Edit(edit)).refused, None);
    }

    fn steps(modeler: &mut Modeler, count: u32, drag: Option<DVec3>) {
        for _ in 0..count {
            modeler.handle(Request::Step(Step { drag, iterations: 20 }));
        }
    }

    /// The corners of all triangles of all skeletons.
    fn triangles(modeler: &Modeler) -> Vec<Vec<[u32; 3]>> {
        modeler.model().document.surfaces.values().map(|s| s.skeleton.triangles.clone()).collect()
    }

    #[test]
    fn plain_drags_keep_their_skeletons() {
        let all = [
            Example::RaisedDisc,
            Example::Cylinder,
            Example::Ball,
            Example::Torus,
            Example::PartyHat,
            Example::CappedCylinder,
            Example::GluedCylinders,
            Example::KleinMug,
            Example::MoebiusStrip,
            Example::Spout,
            Example::BoredBall,
            Example::ThreeHandles,
            Example::Handle,
        ];
        for example in all {
            let mut modeler = Modeler::new();
            modeler.handle(Request::OpenExample(example));
            let before = triangles(&modeler);
            let (point, at) =
                modeler.model().document.points.last_key_value().map(|(p, at)| (*p, *at)).unwrap();
            let (_, radius) = modeler.model().document.extent();
            let way = DVec3::new(0.3, 0.2, 0.4) * radius;
            modeler.handle(Request::Grab(GrabTarget::Point(point)));
            for k in 1..=10 {
                steps(&mut modeler, 1, Some(at + way * (0.1 * f64::from(k))));
            }
            let reply = modeler.handle(Request::Drop);
            assert!(reply.committed.is_some(), "{example:?}");
            assert!(triangles(&modeler) == before, "{example:?}");
            act(&mut modeler, Edit::Move { point, to: at });
            assert!(triangles(&modeler) == before, "{example:?}");
        }
    }
}
