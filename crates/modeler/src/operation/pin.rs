//! `pin`: a control point on a surface (thesis section 7.3.6, `ray-intersect-surface`).

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{kept_position, refresh_skeleton};
use crate::shape::{Pin, SurfaceShape, edit};
use ductile_mesh::{FaceId, SourceTag, VertexId};
use ductile_spec::{PointId, SurfaceId};
use glam::DVec3;

/// A vertex this near to the wanted place, as a part of the spacing, becomes the control point itself.
const NEAR: f64 = 0.75;

/// Makes a control point at the place of a surface nearest to a given one.
pub(crate) fn pin(model: &mut Model, surface: SurfaceId, at: DVec3) -> Result<PointId, ModelError> {
    let at = kept_position(model, at)?;
    let id = model.document.next_point();
    let revision = model.next_revision();
    let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
    let vertex = vertex_at(shape, at)?;
    shape.mesh.set_vertex_source(vertex, Some(SourceTag(id.0)));
    shape.pins.push(Pin { vertex, point: id });
    shape.revision = revision;
    let place = shape.positions[vertex.index()];
    let place = kept_position(model, place)?;
    model.document_mut().points.insert(id, place);
    refresh_skeleton(model, surface);
    model.document.validate()?;
    Ok(id)
}

/// The free vertex at a place: the nearest one, or a new one in the nearest face.
fn vertex_at(shape: &mut SurfaceShape, at: DVec3) -> Result<VertexId, ModelError> {
    let distance = |shape: &SurfaceShape, v: VertexId| (shape.positions[v.index()] - at).length();
    let is_free = |shape: &SurfaceShape, v: VertexId| {
        !shape.mesh.is_source_vertex(v) && !shape.mesh.is_on_source_curve(v)
    };
    let mut nearest: Option<(f64, VertexId)> = None;
    for v in shape.mesh.vertices() {
        if is_free(shape, v) && !shape.mesh.is_boundary_vertex(v) {
            let d = distance(shape, v);
            if nearest.is_none_or(|(least, _)| d < least) {
                nearest = Some((d, v));
            }
        }
    }
    if let Some((d, v)) = nearest
        && d <= NEAR * shape.spacing
    {
        return Ok(v);
    }
    let (face, place) = nearest_face(shape, at).ok_or(ModelError::Occupied)?;
    let too_near = shape.mesh.face_vertices(face).iter().any(|v| {
        shape.mesh.is_source_vertex(*v)
            && (shape.positions[v.index()] - place).length() < 0.05 * shape.spacing
    });
    if too_near {
        return Err(ModelError::Occupied);
    }
    let v = shape.mesh.split_face(face);
    shape.positions.resize(shape.mesh.vertex_slots(), place);
    shape.positions[v.index()] = place;
    Ok(v)
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
