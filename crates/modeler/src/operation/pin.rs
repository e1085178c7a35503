//! `pin`: a control point on a surface (thesis section 7.3.6, `ray-intersect-surface`).
//!
//! The control stands exactly where it was pointed at: the place on the facets is lifted onto the fitted surface, and
//! the nearest free vertex slides there. Where its triangles would not bear that, a new vertex is made at the place;
//! where that makes needles too, hard by another control or curve, the nearest vertex goes as far towards it as it can.

use crate::bound::BoundSurface;
use crate::error::ModelError;
use crate::model::Model;
use crate::operation::slide::{SHARP, least_angle_around, slide};
use crate::operation::{kept_position, refresh_skeleton};
use crate::relax::Relaxer;
use crate::shape::{Pin, SurfaceShape, edit};
use ductile_mesh::{FaceId, SourceTag, VertexId};
use ductile_spec::{PointId, SurfaceId};
use glam::DVec3;

/// Nearer than this to a control, as a part of the spacing, there is no room for another.
const OCCUPIED: f64 = 0.05;
/// Parts of a way that is too long, tried in this order.
const PARTS: [f64; 4] = [0.75, 0.5, 0.25, 0.125];

/// Makes a control point at the place of a surface nearest to a given one.
pub(crate) fn pin(
    model: &mut Model,
    relaxer: &Relaxer,
    surface: SurfaceId,
    at: DVec3,
) -> Result<PointId, ModelError> {
    let at = kept_position(model, at)?;
    let shape = model.surfaces.get(&surface).ok_or(ModelError::NoSurface(surface))?;
    let bound = relaxer.surface(surface, shape);
    let (face, place) = place_on(shape, bound, at).ok_or(ModelError::Occupied)?;
    let place = kept_position(model, place)?;
    let id = model.document.next_point();
    let revision = model.next_revision();
    let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
    let vertex = vertex_at(shape, bound, face, place)?;
    shape.mesh.set_vertex_source(vertex, Some(SourceTag(id.0)));
    shape.pins.push(Pin { vertex, point: id });
    shape.revision = revision;
    let place = shape.positions[vertex.index()];
    let place = kept_position(model, place)?;
    // A vertex that went only a part of the way is not yet where the document can say it is.
    let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
    shape.positions[vertex.index()] = place;
    model.document_mut().points.insert(id, place);
    refresh_skeleton(model, surface);
    model.document.validate()?;
    Ok(id)
}

/// The facet nearest to a place, and the place of the fitted surface over it: the mean of what the quadratics of
/// the facet's corners say, each by its share. The facet's own where there is no fit.
fn place_on(shape: &SurfaceShape, bound: Option<&BoundSurface>, at: DVec3) -> Option<(FaceId, DVec3)> {
    let (face, flat) = nearest_face(shape, at)?;
    let Some(bound) = bound else { return Some((face, flat)) };
    let corners = shape.mesh.face_vertices(face);
    let [a, b, c] = corners.map(|v| shape.positions[v.index()]);
    let normal = (b - a).cross(c - a);
    // Shares of the whole area; a facet without area has none, and the flat place comes out.
    let share = |p: DVec3, q: DVec3| (p - flat).cross(q - flat).dot(normal).max(0.0);
    let (mut sum, mut total) = (DVec3::ZERO, 0.0);
    for (v, share) in corners.into_iter().zip([share(b, c), share(c, a), share(a, b)]) {
        if let Some(place) = bound.near(v, flat).filter(|place| place.distance(flat) < shape.wanted_at(v)) {
            sum += place * share;
            total += share;
        }
    }
    Some((face, if total > 0.0 { sum / total } else { flat }))
}

/// The vertex that becomes the control at a place of the surface: it is there, or as near as the triangles allow.
fn vertex_at(
    shape: &mut SurfaceShape,
    bound: Option<&BoundSurface>,
    face: FaceId,
    place: DVec3,
) -> Result<VertexId, ModelError> {
    let corners = shape.mesh.face_vertices(face);
    let distance = |shape: &SurfaceShape, v: VertexId| shape.positions[v.index()].distance(place);
    let is_taken = |v: &VertexId| {
        shape.mesh.is_source_vertex(*v) && distance(shape, *v) < OCCUPIED * shape.wanted_at(*v)
    };
    if corners.iter().any(is_taken) {
        return Err(ModelError::Occupied);
    }
    let is_free = |v: &VertexId| {
        let mesh = &shape.mesh;
        !mesh.is_source_vertex(*v) && !mesh.is_on_source_curve(*v) && !mesh.is_boundary_vertex(*v)
    };
    let mut free: Vec<VertexId> = corners.into_iter().filter(is_free).collect();
    free.sort_by(|a, b| distance(shape, *a).total_cmp(&distance(shape, *b)));
    if let Some(v) = free.iter().find(|v| slide(shape, **v, place)) {
        return Ok(*v);
    }
    let (mut split, mut new) = with_new_vertex(shape, face, place);
    let Some(nearest) = free.first() else {
        // Every corner is held: inwards there is most room.
        let middle = corners.iter().map(|v| shape.positions[v.index()]).sum::<DVec3>() / 3.0;
        for part in PARTS.into_iter().chain([0.0]) {
            if least_angle_around(&split, new) >= SHARP {
                break;
            }
            (split, new) = with_new_vertex(shape, face, middle.lerp(place, part));
        }
        *shape = split;
        return Ok(new);
    };
    if least_angle_around(&split, new) >= SHARP {
        *shape = split;
        return Ok(new);
    }
    approach(shape, bound, *nearest, place);
    Ok(*nearest)
}

/// Moves a vertex towards a place of the surface, as far as its triangles allow.
fn approach(shape: &mut SurfaceShape, bound: Option<&BoundSurface>, v: VertexId, place: DVec3) {
    let from = shape.positions[v.index()];
    for part in PARTS {
        let part = from.lerp(place, part);
        let to = bound.and_then(|bound| bound.near(v, part)).unwrap_or(part);
        if slide(shape, v, to) {
            return;
        }
    }
}

/// The shape with a new vertex at a place of a face: on its nearest edge if that makes the better triangles.
fn with_new_vertex(shape: &SurfaceShape, face: FaceId, place: DVec3) -> (SurfaceShape, VertexId) {
    let put = |split: &dyn Fn(&mut SurfaceShape) -> VertexId| {
        let mut shape = shape.clone();
        let v = split(&mut shape);
        shape.positions.resize(shape.mesh.vertex_slots(), place);
        shape.positions[v.index()] = place;
        (least_angle_around(&shape, v), shape, v)
    };
    let (mut best, mut split, mut vertex) = put(&|shape| shape.mesh.split_face(face));
    for edge in shape.mesh.face_edges(face) {
        if shape.mesh.is_boundary_edge(edge) || shape.mesh.edge_source(edge).is_some() {
            continue;
        }
        let (angle, other, v) = put(&|shape| shape.mesh.split_edge(edge));
        if angle > best {
            (best, split, vertex) = (angle, other, v);
        }
    }
    (split, vertex)
}

fn nearest_face(shape: &SurfaceShape, at: DVec3) -> Option<(FaceId, DVec3)> {
    let mut best: Option<(f64, FaceId, DVec3)> = None;
    for face in shape.mesh.faces() {
        let corners = shape.mesh.face_vertices(face).map(|v| shape.positions[v.index()]);
        let place = nearest_in_triangle(corners, at);
        let distance = (place - at).length_squared();
        if best.is_none_or(|(least, ..)| distance < least) {
            best = Some((distance, face, place));
        }
    }
    best.map(|(_, face, place)| (face, place))
}

/// The point of a triangle nearest to a given one (Ericson 2005, section 5.1.5).
fn nearest_in_triangle([a, b, c]: [DVec3; 3], p: DVec3) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (ab.dot(p - a), ac.dot(p - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return a;
    }
    let (d3, d4) = (ab.dot(p - b), ac.dot(p - b));
    if d3 >= 0.0 && d4 <= d3 {
        return b;
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        return a + ab * (d1 / (d1 - d3));
    }
    let (d5, d6) = (ab.dot(p - c), ac.dot(p - c));
    if d6 >= 0.0 && d5 <= d6 {
        return c;
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        return a + ac * (d2 / (d2 - d6));
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
    }
    let sum = va + vb + vc;
    if sum > 0.0 { a + ab * (vb / sum) + ac * (vc / sum) } else { a }
}
