//! `insert`: a control point on a curve (thesis section 7.3.6, `ray-intersect-curve`). It stands exactly where it was
//! pointed at: the nearest free sample slides there along the curve.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::slide::slide;
use crate::operation::{kept_position, refresh_skeleton, rim};
use crate::shadow;
use crate::shape::{CurveShape, SurfaceShape, edit};
use ductile_mesh::SourceTag;
use ductile_spec::{CurveId, PointId};
use glam::DVec3;

/// Part of an edge that a new control keeps from a control at the end: nearer, every triangle between would be a needle.
const ROOM: f64 = 0.25;

/// Makes a control point at the place of a curve nearest to a given one. The shape does not change by it.
pub(crate) fn insert(model: &mut Model, id: CurveId, at: DVec3) -> Result<PointId, ModelError> {
    check_free(model, id)?;
    let (sample, place) = make_room(model, id, at)?;
    let point = model.document.next_point();
    model.document_mut().points.insert(point, place);
    tie(model, id, (sample, place), point)?;
    Ok(point)
}

/// Lets a curve pass through a control point that is there already, beside the curve at a given place. The curve is carried to
/// it as it relaxes.
pub(crate) fn insert_there(
    model: &mut Model,
    id: CurveId,
    at: DVec3,
    point: PointId,
) -> Result<(), ModelError> {
    if model.document.curves.get(&id).is_some_and(|curve| curve.through.contains(&point)) {
        return Err(ModelError::TwiceThrough(point));
    }
    check_free(model, id)?;
    insert_vertex(model, id, at, point)
}

/// The same for a curve that a rim leads, and a vertex of its cage.
pub(crate) fn insert_vertex(
    model: &mut Model,
    id: CurveId,
    at: DVec3,
    point: PointId,
) -> Result<(), ModelError> {
    let room = make_room(model, id, at)?;
    tie(model, id, room, point)
}

fn check_free(model: &Model, id: CurveId) -> Result<(), ModelError> {
    rim::check_free(&model.document, id, "its points are vertices of the cage; split an edge of that")
}

/// A sample of a curve that is no control yet, for one at a place, and where exactly.
fn make_room(model: &mut Model, id: CurveId, at: DVec3) -> Result<(usize, DVec3), ModelError> {
    let at = kept_position(model, at)?;
    let shape = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let (edge, t) = shape.nearest(at).ok_or(ModelError::NoCurve(id))?;
    let roomy = with_room(shape, edge, t);
    let place = kept_position(model, shape.place(edge, roomy))?;
    let sample = free_sample(model, id, edge, t)?;
    if (ROOM..=1.0 - ROOM).contains(&roomy) && !can_slide_all(model, id, sample, place) {
        // A vertex that stayed far behind would lead astray whatever is drawn through the point.
        if let Ok(new) = shadow::insert_sample(model, id, edge, place) {
            let place = put_on_edges(model, id, new, at).unwrap_or(place);
            return Ok((new, kept_position(model, place)?));
        }
    }
    Ok((sample, place))
}

/// Whether the vertices at a sample can go to a place, in every surface that follows the curve.
fn can_slide_all(model: &Model, id: CurveId, sample: usize, to: DVec3) -> bool {
    model.document.surfaces_on(id).all(|surface| {
        let Some(shape) = model.surfaces.get(&surface) else { return true };
        let mut shape = SurfaceShape::clone(shape);
        let vertices = shape.embeddings.iter().filter(|e| e.curve == id).map(|e| e.vertices[sample]);
        vertices.collect::<Vec<_>>().into_iter().all(|vertex| slide(&mut shape, vertex, to))
    })
}

/// Puts the vertices at a new sample where the edges that it divides are nearest to a place, away from their ends: there no triangle
/// turns over. Gives the first such place. A curve that was just drawn is not yet what its surface has of it.
fn put_on_edges(model: &mut Model, id: CurveId, sample: usize, at: DVec3) -> Option<DVec3> {
    let mut first = None;
    for surface in model.document.surfaces_on(id).collect::<Vec<_>>() {
        let Some(shape) = model.surfaces.get_mut(&surface).map(edit::<SurfaceShape>) else { continue };
        for k in 0..shape.embeddings.len() {
            if shape.embeddings[k].curve != id {
                continue;
            }
            let vertices = &shape.embeddings[k].vertices;
            let count = vertices.len();
            let (v, ends) = (vertices[sample], [vertices[sample - 1], vertices[(sample + 1) % count]]);
            let [from, to] = ends.map(|end| shape.positions[end.index()]);
            let t = (at - from).dot(to - from) / (to - from).length_squared();
            let place = from.lerp(to, if t.is_finite() { t.clamp(ROOM, 1.0 - ROOM) } else { 0.5 });
            shape.positions[v.index()] = place;
            first = first.or(Some(place));
        }
    }
    first
}

/// Makes a sample of a curve a control, and the vertices of all surfaces that follow it there.
fn tie(
    model: &mut Model,
    id: CurveId,
    (sample, place): (usize, DVec3),
    point: PointId,
) -> Result<(), ModelError> {
    let revision = model.next_revision();
    let shape = edit(model.curves.get_mut(&id).ok_or(ModelError::NoCurve(id))?);
    shape.nodes[sample] = place;
    let rank = rank_of(shape, sample);
    shape.controls.push((u32::try_from(sample).unwrap_or(u32::MAX), point));
    shape.controls.sort_unstable();
    shape.revision = revision;
    if let Some(curve) = model.document_mut().curves.get_mut(&id) {
        curve.through.insert(rank, point);
    }
    for surface in model.document.surfaces_on(id).collect::<Vec<_>>() {
        if let Some(shape) = model.surfaces.get_mut(&surface).map(edit) {
            let on_curve = shape.embeddings.iter().filter(|e| e.curve == id);
            for vertex in on_curve.map(|e| e.vertices[sample]).collect::<Vec<_>>() {
                shape.mesh.set_vertex_source(vertex, Some(SourceTag(point.0)));
                // Where its triangles do not bear that, the relaxer carries it, and all that is around, by and by.
                let _ = slide(shape, vertex, place);
            }
        }
        refresh_skeleton(model, surface);
    }
    Ok(model.document.validate()?)
}

/// Where a new control at a sample stands among the points of the curve.
fn rank_of(shape: &CurveShape, sample: usize) -> usize {
    shape.controls.iter().filter(|(index, _)| (*index as usize) < sample).count()
}

/// The parameter on an edge, moved away from an end that is a control.
fn with_room(shape: &CurveShape, edge: usize, t: f64) -> f64 {
    let (a, b) = shape.edge(edge);
    let low = if shape.is_control(a) { ROOM } else { 0.0 };
    let high = if shape.is_control(b) { 1.0 - ROOM } else { 1.0 };
    t.clamp(low, high)
}

/// The sample nearest to a place on an edge that is no control yet; the edge is split if both ends are.
fn free_sample(model: &mut Model, id: CurveId, edge: usize, t: f64) -> Result<usize, ModelError> {
    let shape = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let (a, b) = shape.edge(edge);
    let (near, far) = if t < 0.5 { (a, b) } else { (b, a) };
    if !shape.is_control(near) {
        return Ok(near);
    }
    if !(0.1..=0.9).contains(&t) {
        return Err(ModelError::Occupied);
    }
    if !shape.is_control(far) {
        return Ok(far);
    }
    let place = shape.nodes[a].lerp(shape.nodes[b], t);
    shadow::insert_sample(model, id, edge, place)
}
