//! Dividing: one curve becomes several that end at common control points, in the document and in every surface that follows it.
//!
//! Parts share a point and no tangent. Where a curve is divided without being cut, its parts are told the directions that it
//! has there: a fair curve held to its own direction at a control point stays what it is on either side.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{kept_direction, refresh_skeleton};
use crate::plane::tangents;
use crate::shape::{CurveShape, EmbeddedCurve};
use crate::surgery::pieces::tag;
use ductile_mesh::VertexId;
use ductile_spec::{Curve, CurveId, PointId, SurfaceId};
use std::collections::BTreeSet;
use std::sync::Arc;

/// A part of a curve, and the control points at which it begins and ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Part {
    pub(crate) curve: CurveId,
    pub(crate) ends: [PointId; 2],
}

/// Divides a curve at some of its control points; its shape stays.
pub(crate) fn divide_at(model: &mut Model, id: CurveId, points: &[PointId]) -> Result<Vec<Part>, ModelError> {
    let shape = Arc::clone(model.curves.get(&id).ok_or(ModelError::NoCurve(id))?);
    let sample =
        |point: &PointId| shape.sample_of(*point).ok_or(ModelError::NotOnCurve { curve: id, point: *point });
    let ends = points.iter().map(sample).collect::<Result<BTreeSet<usize>, ModelError>>()?;
    let is_own_end = |sample: usize| !shape.closed && (sample == 0 || sample + 1 == shape.nodes.len());
    let point_at =
        |sample: usize| shape.controls.iter().find(|(own, _)| *own as usize == sample).map(|own| own.1);
    if ends.iter().all(|sample| is_own_end(*sample)) {
        let whole = point_at(0).zip(point_at(shape.nodes.len() - 1));
        return Ok(whole.map(|(first, last)| Part { curve: id, ends: [first, last] }).into_iter().collect());
    }
    let directions = tangents(&model.document, id, &shape);
    if let Some(curve) = model.document_mut().curves.get_mut(&id) {
        for (sample, point) in ends.iter().filter_map(|sample| Some((*sample, point_at(*sample)?))) {
            if !is_own_end(sample) {
                curve.tangents.entry(point).or_insert_with(|| kept_direction(directions[sample]));
            }
        }
    }
    let parts = divide(model, id, &ends).into_iter();
    let parts = parts
        .filter_map(|(curve, first, last)| Some(Part { curve, ends: [point_at(first)?, point_at(last)?] }));
    Ok(parts.collect())
}

/// Divides a curve at some of its samples, which are controls, in the document and in every surface that follows it. Gives
/// the pieces with their first and last samples. The surface that is being cut is left to the caller.
pub(crate) fn divide(model: &mut Model, id: CurveId, ends: &BTreeSet<usize>) -> Vec<(CurveId, usize, usize)> {
    let (Some(shape), Some(curve)) =
        (model.curves.get(&id).map(Arc::clone), model.document.curves.get(&id).cloned())
    else {
        return Vec::new();
    };
    let mut ends = ends.clone();
    if !shape.closed {
        ends.extend([0, shape.nodes.len() - 1]);
    } else if ends.len() == 1 {
        // From a point to itself is no open curve: it is divided opposite, too.
        let controls: Vec<usize> = shape.controls.iter().map(|(sample, _)| *sample as usize).collect();
        let here = controls.iter().position(|sample| ends.contains(sample)).unwrap_or(0);
        ends.insert(controls[(here + controls.len() / 2) % controls.len()]);
    }
    let places: Vec<usize> = ends.into_iter().collect();
    let spans = places.windows(2).map(|pair| (pair[0], pair[1]));
    let closing = shape.closed.then(|| (places[places.len() - 1], places[0]));
    let mut pieces = Vec::new();
    for (first, last) in spans.chain(closing) {
        let samples = between(&shape, first, last);
        pieces.push((part_of_curve(model, &shape, &curve, &samples), first, last));
    }
    for surface in model.document.surfaces_on(id).collect::<Vec<_>>() {
        let revision = model.next_revision();
        let Some(followed) = model.surfaces.get_mut(&surface).map(crate::shape::edit) else { continue };
        let mut embeddings = Vec::new();
        for embedded in core::mem::take(&mut followed.embeddings) {
            if embedded.curve != id {
                embeddings.push(embedded);
                continue;
            }
            for (curve, first, last) in &pieces {
                let vertices: Vec<VertexId> =
                    between(&shape, *first, *last).iter().map(|sample| embedded.vertices[*sample]).collect();
                tag(&mut followed.mesh, &vertices, false, *curve);
                embeddings.push(EmbeddedCurve { curve: *curve, vertices });
            }
        }
        followed.embeddings = embeddings;
        followed.revision = revision;
        rename(model, surface, id, &pieces, &shape);
        refresh_skeleton(model, surface);
    }
    model.document_mut().curves.remove(&id);
    model.curves.remove(&id);
    pieces
}

/// What a surface says of a curve that was divided, it says of the pieces.
fn rename(
    model: &mut Model,
    surface: SurfaceId,
    id: CurveId,
    pieces: &[(CurveId, usize, usize)],
    shape: &CurveShape,
) {
    let begins = |from: PointId| {
        let sample = shape.sample_of(from)?;
        let holds = |piece: &&(CurveId, usize, usize)| {
            let samples = between(shape, piece.1, piece.2);
            samples[..samples.len() - 1].contains(&sample)
        };
        pieces.iter().find(holds).map(|piece| piece.0)
    };
    let through: Vec<(CurveId, Vec<PointId>)> = pieces
        .iter()
        .filter_map(|(curve, ..)| Some((*curve, model.document.curves.get(curve)?.through.clone())))
        .collect();
    let Some(surface) = model.document_mut().surfaces.get_mut(&surface) else { return };
    for region in surface.regions.iter_mut().filter(|region| region.curve == id) {
        region.curve = begins(region.from).unwrap_or(id);
    }
    if let Some(ribbon) = surface.ribbons.remove(&id) {
        for (curve, points) in through {
            let mut own = ribbon.clone();
            own.cross.retain(|point, _| points.contains(point));
            if !own.cross.is_empty() || own.onto.is_some() {
                surface.ribbons.insert(curve, own);
            }
        }
    }
}

/// The samples from one to another, round a closed curve if need be.
fn between(shape: &CurveShape, first: usize, last: usize) -> Vec<usize> {
    let count = shape.nodes.len();
    let steps = if last > first { last - first } else { last + count - first };
    (0..=steps).map(|step| (first + step) % count).collect()
}

/// A new open curve over some samples of another one.
fn part_of_curve(model: &mut Model, shape: &CurveShape, curve: &Curve, samples: &[usize]) -> CurveId {
    let points: Vec<(usize, PointId)> = samples
        .iter()
        .enumerate()
        .filter_map(|(place, sample)| {
            let control = shape.controls.iter().find(|(index, _)| *index as usize == *sample)?;
            Some((place, control.1))
        })
        .collect();
    let tangents = |point: PointId| curve.tangents.get(&point).copied();
    add_curve(model, shape, samples, (&points, false), curve, &tangents)
}

/// Adds a curve through the given samples of another, which are its own points at the given places.
pub(crate) fn add_curve(
    model: &mut Model,
    shape: &CurveShape,
    samples: &[usize],
    (points, closed): (&[(usize, PointId)], bool),
    like: &Curve,
    tangent: &dyn Fn(PointId) -> Option<glam::DVec3>,
) -> CurveId {
    let id = model.document.next_curve();
    let mut curve = Curve::new(points.iter().map(|(_, point)| *point).collect(), closed);
    curve.objective = like.objective;
    // A part of a rim is one; a copy elsewhere is not.
    curve.rim = like.rim.filter(|_| curve.through.iter().all(|point| like.through.contains(point)));
    curve.tangents = points.iter().filter_map(|(_, point)| Some((*point, tangent(*point)?))).collect();
    let revision = model.next_revision();
    let nodes = samples.iter().map(|sample| shape.nodes[*sample]).collect();
    let controls =
        points.iter().map(|(place, point)| (u32::try_from(*place).unwrap_or(u32::MAX), *point)).collect();
    model.document_mut().curves.insert(id, curve);
    model.curves.insert(id, Arc::new(CurveShape { nodes, closed, controls, revision }));
    id
}
