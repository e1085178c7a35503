//! `embed`: a curve that lies near a surface becomes a control curve of it (thesis sections 4.2.3 and 7.3.3). Its projection is
//! laid into the surface; then it is the curve that stays where it is, and the surface that moves to it.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::refresh_skeleton;
use crate::shape::{CurveShape, SurfaceShape};
use crate::surgery::following::follow;
use crate::surgery::joining::{said, say};
use crate::surgery::tracing::rim_near;
use ductile_mesh::{SurfaceTree, measure};
use ductile_spec::{CurveId, SurfaceId};
use glam::DVec3;

/// Cosine of the angle to the normal up to which a place beyond a rim still lies over the surface: 30°.
const UPRIGHT: f64 = 0.866;
/// How much farther apart the projections of two samples may be than the samples, before an edge length is added. Where
/// the surface bends away from the curve, a projection on it is drawn out; on its other sheet it jumps.
const STRETCH: f64 = 3.0;

/// Makes a curve a control curve of a surface.
pub(super) fn embed(model: &mut Model, curve: CurveId, surface: SurfaceId) -> Result<(), ModelError> {
    let line = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
    let shape = model.surfaces.get(&surface).ok_or(ModelError::NoSurface(surface))?;
    if shape.embeddings.iter().any(|embedded| embedded.curve == curve) {
        return Err(ModelError::LiesThere { curve, surface });
    }
    if let Some(at) = astray(shape, line) {
        return Err(ModelError::NotOver { curve, surface, at });
    }
    let told = said(model, surface);
    follow(model, surface, curve)?;
    refresh_skeleton(model, surface);
    say(model, surface, &told);
    Ok(model.document.validate()?)
}

/// The first place of a curve that does not lie over a surface: it is beyond a rim, or what is below it is not what is below
/// the place before.
fn astray(shape: &SurfaceShape, line: &CurveShape) -> Option<DVec3> {
    let SurfaceShape { mesh, positions, .. } = shape;
    let tree = SurfaceTree::new(mesh, positions);
    let below = |at: DVec3| -> Option<DVec3> {
        let (place, _) = tree.nearest(mesh, at)?;
        let on = place.position(mesh, positions)?;
        let is_at_rim = place.support(mesh).all(|v| mesh.is_boundary_vertex(v));
        let normal = measure::face_normal(mesh, positions, place.face(mesh)).normalize_or_zero();
        let away = at - on;
        let is_over = normal.dot(away).abs() >= UPRIGHT * away.length();
        (!is_at_rim || is_over || rim_near(shape, at).is_some()).then_some(on)
    };
    let mut feet = Vec::with_capacity(line.nodes.len());
    for at in &line.nodes {
        match below(*at) {
            Some(on) => feet.push(on),
            None => return Some(*at),
        }
    }
    let jumps = |k: &usize| {
        let (a, b) = line.edge(*k);
        feet[a].distance(feet[b]) > STRETCH * line.nodes[a].distance(line.nodes[b]) + shape.longest_wanted()
    };
    (0..line.edge_count()).find(jumps).map(|k| line.nodes[line.edge(k).1])
}
