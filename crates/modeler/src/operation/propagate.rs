//! `propagate`: the sense of a surface is carried over the curves at which others meet it (thesis section 7.2.3).
//!
//! Two surfaces that end at a curve agree if their triangles run along it in opposite directions, as two neighbouring triangles
//! of one surface do. A curve inside a surface, or at two of its rims, tells nothing: there the surface runs along it
//! both ways.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::reverse::reverse;
use crate::shape::SurfaceShape;
use ductile_mesh::is_orientable;
use ductile_spec::{CurveId, SurfaceId};
use std::collections::{BTreeMap, VecDeque};

/// Turns the surfaces that meet this one, and those that meet them, where they do not agree with it.
pub(super) fn propagate(model: &mut Model, id: SurfaceId) -> Result<(), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    if !is_orientable(&shape.mesh) {
        return Err(ModelError::NoCommonSide(id));
    }
    let mut meetings: BTreeMap<CurveId, Vec<(SurfaceId, bool)>> = BTreeMap::new();
    for (surface, shape) in model.surfaces.iter().filter(|(_, shape)| is_orientable(&shape.mesh)) {
        for (curve, runs_along) in rims(shape) {
            meetings.entry(curve).or_default().push((*surface, runs_along));
        }
    }
    // At a curve where more than two meet, inside and outside part: it leads nowhere.
    let meetings: Vec<_> = meetings.into_values().filter(|meeting| meeting.len() == 2).collect();
    let mut must_turn = BTreeMap::from([(id, false)]);
    let mut queue = VecDeque::from([id]);
    while let Some(one) = queue.pop_front() {
        let turns = must_turn[&one];
        for meeting in &meetings {
            let Some(k) = meeting.iter().position(|(surface, _)| *surface == one) else { continue };
            let ((_, along), (other, other_along)) = (meeting[k], meeting[1 - k]);
            let needed = turns ^ (along == other_along);
            match must_turn.get(&other) {
                None => {
                    must_turn.insert(other, needed);
                    queue.push_back(other);
                }
                Some(known) if *known != needed => return Err(ModelError::NoCommonSide(id)),
                Some(_) => {}
            }
        }
    }
    let turned: Vec<SurfaceId> =
        must_turn.into_iter().filter_map(|(id, turns)| turns.then_some(id)).collect();
    if turned.is_empty() {
        return Err(ModelError::AlreadyAgree(id));
    }
    turned.into_iter().try_for_each(|id| reverse(model, id))
}

/// The curves at which a surface ends, each with whether the triangles there run along it. One that it also has inside, or
/// at another rim, is none of them.
fn rims(shape: &SurfaceShape) -> BTreeMap<CurveId, bool> {
    let mut rims = BTreeMap::new();
    for embedded in &shape.embeddings {
        let count = shape.embeddings.iter().filter(|other| other.curve == embedded.curve).count();
        let edge = embedded.vertices.first().zip(embedded.vertices.get(1)).and_then(|(a, b)| {
            let (face, beyond) = shape.mesh.edge_faces(shape.mesh.edge_between(*a, *b)?);
            let [i, j, k] = shape.mesh.face_vertices(face);
            let runs_along = [(i, j), (j, k), (k, i)].contains(&(*a, *b));
            beyond.is_none().then_some(runs_along)
        });
        if let (1, Some(runs_along)) = (count, edge) {
            rims.insert(embedded.curve, runs_along);
        }
    }
    rims
}
