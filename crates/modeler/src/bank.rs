//! The tangent planes of fair surfaces along the curves that they share with fills.
//!
//! Such a surface follows the curve at every sample, so its tangent plane there has the curve's tangent in it. That is known from the
//! curve to fourth order in the spacing; the fit of the surface around a node knows it to second order only, and at a
//! boundary with neighbours on one side. So of a fitted normal only what is across the curve is taken.

use crate::bound::BoundSurface;
use crate::model::Model;
use crate::patch::fill;
use crate::shape::{EmbeddedCurve, SurfaceShape};
use ductile_spec::{FillJoin, SurfaceId};
use glam::DVec3;
use std::borrow::Cow;

/// Sine of the least angle between two tangents that have a plane: 5°, as at the corners of fills.
const APART: f64 = 0.087;

/// The unit normals of a surface at the samples of a curve that it follows.
pub(crate) fn along(model: &Model, bound: &BoundSurface, embedded: &EmbeddedCurve) -> Vec<DVec3> {
    let tangents = fill::tangents(model, embedded.curve);
    let normals = embedded.vertices.iter().map(|v| bound.normals().get(bound.node(*v) as usize).copied());
    let across = |(normal, tangent): (Option<DVec3>, DVec3)| {
        let normal = normal.unwrap_or_default();
        (normal - tangent * tangent.dot(normal)).try_normalize().unwrap_or(normal)
    };
    normals.zip(tangents).map(across).collect()
}

/// The unit normals of a surface by node, as they are shown: those of its fits, but along the sides of fills as [`along`].
pub(crate) fn shown<'a>(model: &Model, bound: &'a BoundSurface, shape: &SurfaceShape) -> Cow<'a, [DVec3]> {
    let is_side = |embedded: &&EmbeddedCurve| model.document.fills_on(embedded.curve).next().is_some();
    let mut normals = Cow::Borrowed(bound.normals());
    for embedded in shape.embeddings.iter().filter(is_side) {
        for (v, normal) in embedded.vertices.iter().zip(along(model, bound, embedded)) {
            if let Some(own) = normals.to_mut().get_mut(bound.node(*v) as usize) {
                *own = normal;
            }
        }
    }
    normals
}

/// Whether a fill takes tangent planes from a surface.
pub(crate) fn is_taken_from(model: &Model, surface: SurfaceId) -> bool {
    let sides = model.document.fills.values().flat_map(|fill| &fill.sides);
    sides.into_iter().any(|side| side.planes == Some(surface))
}

/// The corners of fills at which both curves lie in a surface from which planes are taken: by vertex, with the normal of the plane
/// of both tangents, in either sense.
pub(crate) fn corners(
    model: &Model,
    surface: SurfaceId,
    shape: &SurfaceShape,
) -> Vec<(ductile_mesh::VertexId, DVec3)> {
    let mut corners = Vec::new();
    for fill in model.document.fills.values().filter(|fill| fill.style.join == FillJoin::Tangent) {
        let before = fill.sides.iter().cycle().skip(fill.sides.len().saturating_sub(1));
        for (side, before) in fill.sides.iter().zip(before) {
            if ![side.planes, before.planes].contains(&Some(surface)) {
                continue;
            }
            let tangent = |curve| {
                let embedded = shape.embeddings.iter().find(|embedded| embedded.curve == curve)?;
                let sample = model.curves.get(&curve)?.sample_of(side.from)?;
                let tangent = fill::tangents(model, curve).get(sample).copied()?;
                Some((*embedded.vertices.get(sample)?, tangent))
            };
            let (Some((v, one)), Some((w, other))) = (tangent(side.curve), tangent(before.curve)) else {
                continue;
            };
            let normal = one.cross(other);
            if v == w && normal.length() > APART && !corners.iter().any(|(known, _)| *known == v) {
                corners.push((v, normal));
            }
        }
    }
    corners
}
