//! The ribbon of a trim: the directions in which two surfaces leave the line in which they meet, taken when they are cut, and
//! held from then on (thesis section 3.4.1).
//!
//! On either surface a direction lies in its fitted tangent plane, across the line, and leads into the part that stays. To
//! give both an angle, each is turned about the line by half of what is missing.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::ribbon::{check_bends, kept_direction};
use crate::plane::{check_cross, tangents};
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use ductile_mesh::{FaceId, Place, VertexId, measure, nearest_place};
use ductile_spec::{CurveId, JoinRibbon, PointId, Ribbon, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Unit directions by control point.
type Cross = BTreeMap<PointId, DVec3>;

/// A surface as it was before anything was drawn on it, with its fitted unit normals by vertex slot.
pub(super) struct Fitted {
    shape: Arc<SurfaceShape>,
    normals: Vec<DVec3>,
}

impl Fitted {
    pub(super) fn new(model: &Model, relaxer: &Relaxer, id: SurfaceId) -> Result<Self, ModelError> {
        let shape = Arc::clone(model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?);
        let bound = relaxer.surface(id, &shape).ok_or(ModelError::NoSurface(id))?;
        let mut normals = vec![DVec3::ZERO; shape.mesh.vertex_slots()];
        for (v, normal) in bound.vertices().iter().zip(bound.normals()) {
            normals[v.index()] = *normal;
        }
        Ok(Self { shape, normals })
    }

    /// The unit normal at the nearest place.
    fn normal(&self, at: DVec3) -> Option<DVec3> {
        let SurfaceShape { mesh, positions, .. } = &*self.shape;
        let place = nearest_place(mesh, positions, at)?;
        let flat = measure::face_normal(mesh, positions, place.face(mesh)).try_normalize()?;
        let parts = match place {
            Place::Vertex(v) => vec![(v, 1.0)],
            Place::Edge { edge, at } => mesh.edge_vertices(edge).into_iter().zip([1.0 - at, at]).collect(),
            Place::Face { face, weights } => mesh.face_vertices(face).into_iter().zip(weights).collect(),
        };
        // The normals of a surface with one side agree with its faces in no sense.
        let sense = |normal: DVec3| if normal.dot(flat) < 0.0 { -normal } else { normal };
        let sum: DVec3 = parts.into_iter().map(|(v, weight)| sense(self.normals[v.index()]) * weight).sum();
        sum.try_normalize().or(Some(flat))
    }

    /// The directions in which the part of the surface that stays leaves a curve that was drawn on it.
    ///
    /// `shape` is the surface with the curve in it; `is_in` says by face slot what stays.
    pub(super) fn leaving(
        &self,
        model: &Model,
        (shape, is_in): (&SurfaceShape, &[bool]),
        id: CurveId,
    ) -> Result<Cross, ModelError> {
        let curve = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
        let tangents = tangents(&model.document, id, curve);
        let mut cross = Cross::new();
        for embedded in shape.embeddings.iter().filter(|embedded| embedded.curve == id) {
            let line = &embedded.vertices;
            for (sample, point) in &curve.controls {
                let sample = *sample as usize;
                let Some(normal) = self.normal(curve.nodes[sample]) else { continue };
                let Some(across) = normal.cross(tangents[sample]).try_normalize() else { continue };
                let ends = [sample + line.len() - 1, sample + 1].map(|k| line[k % line.len()]);
                let kept = ends.into_iter().flat_map(|end| sides(shape, line[sample], end));
                let inwards: DVec3 = kept.filter(|(f, _)| is_in[f.index()]).map(|(_, way)| way).sum();
                cross.insert(*point, if inwards.dot(across) < 0.0 { -across } else { across });
            }
        }
        Ok(cross)
    }
}

/// The faces at the edge between two vertices, if there is one, each with the way from the edge to its third corner: it
/// leads to its side however the edge bends with its curve.
fn sides(shape: &SurfaceShape, a: VertexId, b: VertexId) -> Vec<(FaceId, DVec3)> {
    let at = |v: VertexId| shape.positions[v.index()];
    let edge = shape.mesh.edge_between(a, b).map(|edge| shape.mesh.edge_faces(edge));
    let faces = edge.into_iter().flat_map(|(f, g)| [Some(f), g]).flatten();
    let way = |face: FaceId| {
        let third = shape.mesh.face_vertices(face).into_iter().find(|v| *v != a && *v != b)?;
        let along = (at(b) - at(a)).normalize_or_zero();
        Some((face, (at(third) - at(a)).reject_from_normalized(along)))
    };
    faces.filter_map(way).collect()
}

/// The directions of both surfaces, with the angle between them that is asked for.
pub(super) fn at_angle(
    model: &Model,
    id: CurveId,
    ribbon: JoinRibbon,
    [one, other]: [Cross; 2],
) -> Result<[Cross; 2], ModelError> {
    let JoinRibbon::Angle(angle) = ribbon else { return Ok([one, other]) };
    let curve = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let tangents = tangents(&model.document, id, curve);
    let tangent = |point: PointId| curve.sample_of(point).map(|sample| tangents[sample]);
    let pairs = one.iter().filter_map(|(p, a)| Some((*p, tangent(*p)?, *a, *other.get(p)?)));
    let pairs: Vec<(PointId, DVec3, DVec3, DVec3)> = pairs.collect();
    // From the one to the other about the curve; on which side the smaller angle lies, the whole curve decides.
    let turn = |(_, tangent, a, b): &(PointId, DVec3, DVec3, DVec3)| {
        libm::atan2(tangent.dot(a.cross(*b)), a.dot(*b))
    };
    let side = if pairs.iter().map(|pair| libm::sin(turn(pair))).sum::<f64>() < 0.0 { -1.0 } else { 1.0 };
    let mut turned = [Cross::new(), Cross::new()];
    for pair in &pairs {
        let (point, tangent, a, b) = *pair;
        let now = (turn(pair) * side).rem_euclid(core::f64::consts::TAU);
        let half = side * (now - angle) / 2.0;
        turned[0].insert(point, about(tangent, half, a));
        turned[1].insert(point, about(tangent, -half, b));
    }
    Ok(turned)
}

/// A direction across a unit axis, turned about it.
fn about(axis: DVec3, angle: f64, direction: DVec3) -> DVec3 {
    let (sin, cos) = libm::sincos(angle);
    direction * cos + axis.cross(direction) * sin
}

/// Holds a surface to directions at one of its curves.
pub(super) fn hold(model: &mut Model, id: SurfaceId, curve: CurveId, cross: Cross) -> Result<(), ModelError> {
    let cross: Cross = cross.into_iter().map(|(point, at)| (point, kept_direction(at))).collect();
    let ribbon = Ribbon::directed(cross);
    if ribbon.cross.is_empty() {
        return Ok(());
    }
    let surface = model.document_mut().surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?;
    surface.ribbons.insert(curve, ribbon.clone());
    model.document.validate()?;
    check_bends(model, id)?;
    check_cross(model, id, curve, &ribbon)
}

/// Holds the surface that two have become to the planes half way between theirs at the curve inside it.
pub(super) fn hold_between(
    model: &mut Model,
    curve: CurveId,
    [one, other]: &[Cross; 2],
) -> Result<(), ModelError> {
    let inside = |shape: &&Arc<SurfaceShape>| shape.embeddings.iter().any(|e| e.curve == curve);
    let (id, shape) =
        model.surfaces.iter().find(|(_, shape)| inside(shape)).ok_or(ModelError::NoCurve(curve))?;
    let (id, shape) = (*id, Arc::clone(shape));
    let line = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
    let embedded = shape.embeddings.iter().find(|e| e.curve == curve).ok_or(ModelError::NoCurve(curve))?;
    let mut cross = Cross::new();
    // Inside a surface a ribbon leads to the left of its curve.
    let mut to_left = 0.0;
    for (point, a) in one {
        let (Some(b), Some(sample)) = (other.get(point), line.sample_of(*point)) else { continue };
        let Some(mean) = (*a - *b).try_normalize() else { continue };
        cross.insert(*point, mean);
        let (v, next) =
            (embedded.vertices[sample], embedded.vertices[(sample + 1) % embedded.vertices.len()]);
        for (face, way) in sides(&shape, v, next) {
            let [p, q, r] = shape.mesh.face_vertices(face);
            let is_left = [(p, q), (q, r), (r, p)].contains(&(v, next));
            to_left += if is_left { way.dot(mean) } else { -way.dot(mean) };
        }
    }
    if to_left < 0.0 {
        cross.values_mut().for_each(|at| *at = -*at);
    }
    hold(model, id, curve, cross)
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Two directions at so many degrees about the x axis are brought to another angle, on the side on which they meet.
    #[test]
    fn both_turn_by_half_of_what_is_missing() {
        let mut model = Model::from_document(crate::example::example(ductile_spec::Example::Disc)).unwrap();
        let id = CurveId(1);
        let through = model.document.curves[&id].through.clone();
        let curve = crate::shape::edit(model.curves.get_mut(&id).unwrap());
        curve.closed = false;
        curve.nodes = (0..curve.nodes.len()).map(|k| DVec3::X * k as f64).collect();
        let at = |degrees: f64| {
            let (sin, cos) = libm::sincos(degrees.to_radians());
            DVec3::new(0.0, cos, sin)
        };
        for (a, b, wanted) in
            [(10.0, 100.0, 60.0), (100.0, 10.0, 60.0), (-20.0, 150.0, 180.0), (0.0, 90.0, 90.0)]
        {
            let both = [a, b].map(|angle| through.iter().map(|p| (*p, at(angle))).collect::<Cross>());
            let made = at_angle(&model, id, JoinRibbon::Angle(f64::to_radians(wanted)), both).unwrap();
            let half = if b > a { 0.5 } else { -0.5 } * wanted;
            let middle = 0.5 * (a + b);
            for (point, first) in &made[0] {
                assert!(first.distance(at(middle - half)) < 1e-12, "{a} {b} {wanted}: {first}");
                assert!(made[1][point].distance(at(middle + half)) < 1e-12);
            }
        }
    }
}
