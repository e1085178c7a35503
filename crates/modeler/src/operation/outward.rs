//! A surface that an act has closed shows its outside: whoever glues, sews or merges the last hole shut has made a body, and
//! a body's normals point out of it (thesis section 7.2.3 leaves that to the hand).
//!
//! Only what the act has closed is looked at. A surface that was closed before keeps the sense that it had, so that *reverse* holds.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::reverse::reverse;
use crate::shape::SurfaceShape;
use ductile_mesh::is_orientable;
use ductile_spec::SurfaceId;
use glam::DVec3;
use std::collections::BTreeSet;

/// Of a body thinner than this, as a part of the ball with its area, nothing can be said.
const HOLLOW: f64 = 1e-6;

/// The fair surfaces without an edge.
pub(super) fn closed(model: &Model) -> BTreeSet<SurfaceId> {
    model.surfaces.iter().filter(|(_, shape)| is_closed(shape)).map(|(id, _)| *id).collect()
}

/// Turns the surfaces that have been closed since, if they have their inside out.
pub(super) fn turn(model: &mut Model, were_closed: &BTreeSet<SurfaceId>) -> Result<(), ModelError> {
    let all = model.surfaces.iter().filter(|(id, _)| !were_closed.contains(id));
    let turned: Vec<SurfaceId> = all
        .filter(|(_, shape)| is_closed(shape) && is_orientable(&shape.mesh) && fullness(shape) < -HOLLOW)
        .map(|(id, _)| *id)
        .collect();
    turned.into_iter().try_for_each(|id| reverse(model, id))
}

fn is_closed(shape: &SurfaceShape) -> bool {
    shape.mesh.edges().all(|e| shape.mesh.edge_faces(e).1.is_some())
}

/// The volume inside, negative if the normals point inwards, as a part of that of the ball with the same area; zero where
/// there is no area.
fn fullness(shape: &SurfaceShape) -> f64 {
    let at = |v: ductile_mesh::VertexId| shape.positions[v.index()];
    // From a point of the surface: a body far from the origin loses no digits.
    let origin = shape.mesh.vertices().next().map_or(DVec3::ZERO, at);
    let (mut volume, mut area) = (0.0, 0.0);
    for f in shape.mesh.faces() {
        let [a, b, c] = shape.mesh.face_vertices(f).map(|v| at(v) - origin);
        volume += a.dot(b.cross(c)) / 6.0;
        area += 0.5 * (b - a).cross(c - a).length();
    }
    let ball = area * (area / core::f64::consts::PI).sqrt() / 6.0;
    if ball > 0.0 { volume / ball } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Modeler;
    use ductile_spec::{CurveId, Edit, Example, Request};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn act(modeler: &mut Modeler, edit: Edit) {
        let reply = modeler.handle(Request::Edit(edit));
        assert!(reply.refused.is_none(), "{:?}", reply.refused);
    }

    fn is_outward(modeler: &Modeler) -> bool {
        let shape = modeler.model().surfaces.values().next().unwrap();
        assert!(is_closed(shape));
        fullness(shape) > 0.1
    }

    /// The two caps of a ball on one curve, sewn together, have the sense of the first, whichever that is.
    #[test]
    fn what_is_closed_shows_its_outside_and_may_be_turned_inside_out() {
        for flips in [false, true] {
            let mut modeler = Modeler::new();
            let reply = modeler.handle(Request::OpenExample(Example::Cylinder));
            assert!(reply.refused.is_none());
            let id = *modeler.model().surfaces.keys().next().unwrap();
            if flips {
                act(&mut modeler, Edit::Reverse { surface: id });
            }
            for curve in [CurveId(1), CurveId(2)] {
                act(&mut modeler, Edit::Sheet { boundary: curve });
                act(&mut modeler, Edit::Smooth { curve });
            }
            assert_eq!(modeler.model().surfaces.len(), 1);
            assert!(is_outward(&modeler), "reversed first: {flips}");
            // From then on the hand has its way.
            let id = *modeler.model().surfaces.keys().next().unwrap();
            act(&mut modeler, Edit::Reverse { surface: id });
            assert!(!is_outward(&modeler));
            let shape = &modeler.model().surfaces[&id];
            let inner = shape.mesh.vertices().find(|v| !shape.mesh.is_on_source_curve(*v)).unwrap();
            let at = shape.positions[inner.index()];
            act(&mut modeler, Edit::Pin { surface: id, at });
            assert!(!is_outward(&modeler));
        }
    }
}
