//! Joining: two surfaces become one, and stretches of rim are laid on one another (thesis sections 4.2.2 and 7.3.5).

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::forget_lost_shadows;
use crate::shadow;
use crate::shape::{EmbeddedCurve, Pin, SurfaceShape, edit};
use crate::surgery::pieces::{tell_regions, told};
use ductile_mesh::{EdgeId, FaceId, GlueError, Seam, SourceTag, VertexId, propagate_orientation};
use ductile_spec::{CurveId, Region, Surface, SurfaceId};
use std::sync::Arc;

/// What was said of regions before a join, with a face of each.
pub(crate) type Told = Vec<(FaceId, Region)>;

/// What the document says of the regions of a surface.
pub(crate) fn said(model: &Model, id: SurfaceId) -> Told {
    let (Some(shape), Some(surface)) = (model.surfaces.get(&id), model.document.surfaces.get(&id)) else {
        return Vec::new();
    };
    told(shape, &surface.regions)
}

/// What came of adding one surface to another.
pub(crate) struct United {
    /// What was said of the regions of both; [`say`] says it again when they have been joined.
    pub(crate) told: Told,
    /// For every vertex slot of the second its name in the first; empty if they were one.
    pub(crate) names: Vec<Option<VertexId>>,
}

/// Makes one surface of two that have nothing to do with each other yet: the second is added to the first.
pub(crate) fn unite(model: &mut Model, id: SurfaceId, other: SurfaceId) -> Result<United, ModelError> {
    let mut all = said(model, id);
    if id == other {
        return Ok(United { told: all, names: Vec::new() });
    }
    let theirs = said(model, other);
    let added = Arc::clone(model.surfaces.get(&other).ok_or(ModelError::NoSurface(other))?);
    let surface = model.document.surfaces.get(&other).ok_or(ModelError::NoSurface(other))?.clone();
    let own = model.document.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?.clone();
    let revision = model.next_revision();
    let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
    let names = shape.mesh.append(&added.mesh);
    let name = |v: VertexId| names.vertices[v.index()].unwrap_or(v);
    let slots = shape.mesh.vertex_slots();
    shape.positions.resize(slots, glam::DVec3::ZERO);
    if !(shape.wanted.is_empty() && added.wanted.is_empty() && shape.spacing == added.spacing) {
        shape.wanted.resize(slots, shape.spacing);
    }
    for v in added.mesh.vertices() {
        shape.positions[name(v).index()] = added.positions[v.index()];
        if let Some(wanted) = shape.wanted.get_mut(name(v).index()) {
            *wanted = added.wanted_at(v);
        }
    }
    shape.embeddings.extend(added.embeddings.iter().map(|embedded| EmbeddedCurve {
        curve: embedded.curve,
        vertices: embedded.vertices.iter().map(|v| name(*v)).collect(),
    }));
    shape.pins.extend(added.pins.iter().map(|pin| Pin { vertex: name(pin.vertex), point: pin.point }));
    shape.revision = revision;
    all.extend(theirs.into_iter().filter_map(|(f, region)| Some((names.faces[f.index()]?, region))));
    // What the second has for itself becomes a region's own.
    let differs = (surface.objective, surface.spacing) != (own.objective, own.spacing);
    if differs && let Some(face) = names.faces.iter().flatten().next() {
        let (curve, from) = (CurveId(0), ductile_spec::PointId(0));
        let objective = surface.objective.or(Some(model.document.objective));
        let spacing = surface.spacing.or_else(|| Some(model.spacing()));
        let objective = objective.filter(|_| surface.objective != own.objective);
        let spacing = spacing.filter(|_| surface.spacing != own.spacing);
        all.push((
            *face,
            Region { curve, from, side: ductile_spec::Side::Left, objective, spacing, shadow: None },
        ));
    }
    model.surfaces.remove(&other);
    let document = model.document_mut();
    document.surfaces.remove(&other);
    for side in document.fills.values_mut().flat_map(|fill| &mut fill.sides) {
        if side.planes == Some(other) {
            side.planes = Some(id);
        }
    }
    forget_lost_shadows(model);
    if let Some(own) = model.document_mut().surfaces.get_mut(&id) {
        own.normals.extend(surface.normals);
        own.ribbons.extend(surface.ribbons);
    }
    Ok(United { told: all, names: names.vertices })
}

/// Says again what was said of regions.
pub(crate) fn say(model: &mut Model, id: SurfaceId, told: &Told) {
    let Some(shape) = model.surfaces.get(&id).map(Arc::clone) else { return };
    let is_there = |f: FaceId| shape.mesh.has_face(f).then_some(f);
    if let Some(surface) = model.document_mut().surfaces.get_mut(&id) {
        let mut own = Surface { regions: Vec::new(), ..surface.clone() };
        tell_regions(&mut own, &shape, told, is_there);
        *surface = own;
    }
}

/// Lays one stretch of the rim of a surface on another, given anew each time, since room may have to be made for it by
/// splitting edges. Everything that followed the second follows the first.
pub(crate) fn sew(
    model: &mut Model,
    id: SurfaceId,
    seam: impl Fn(&SurfaceShape) -> Option<Seam>,
) -> Result<(), ModelError> {
    let mut patience = 10_000;
    loop {
        let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
        let seam = seam(shape).ok_or(ModelError::NoSurface(id))?;
        patience -= 1;
        match shape.mesh.can_glue(&seam) {
            Ok(()) => return lay(model, id, &seam),
            Err(GlueError::SecondEdge(_, edge) | GlueError::LoopEdge(edge)) if patience > 0 => {
                split(model, id, edge)?;
            }
            Err(GlueError::SecondFace(_, face)) if patience > 0 => {
                let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
                let corners = shape.mesh.face_vertices(face);
                let v = shape.mesh.split_face(face);
                place(shape, v, &corners);
            }
            Err(why) => return Err(ModelError::Unjoinable(why)),
        }
    }
}

/// Splits an edge in its middle; if a curve runs along it, the curve gets a sample.
pub(crate) fn split(model: &mut Model, id: SurfaceId, edge: EdgeId) -> Result<VertexId, ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let ends = shape.mesh.edge_vertices(edge);
    if let Some(SourceTag(curve)) = shape.mesh.edge_source(edge) {
        let curve = CurveId(curve);
        let torn = ModelError::TornOff { curve, surface: id };
        let samples = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
        let found = shape.embeddings.iter().filter(|e| e.curve == curve).find_map(|embedded| {
            let lies = |k: &usize| {
                let (a, b) = samples.edge(*k);
                let pair = [embedded.vertices[a], embedded.vertices[b]];
                pair == ends || pair == [ends[1], ends[0]]
            };
            (0..samples.edge_count()).find(lies)
        });
        let k = found.ok_or_else(|| torn.clone())?;
        let (a, b) = samples.edge(k);
        let middle = samples.nodes[a].midpoint(samples.nodes[b]);
        let sample = shadow::insert_sample(model, curve, k, middle)?;
        let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
        let joins = |v: &VertexId| ends.iter().all(|end| shape.mesh.are_neighbours(*v, *end));
        let new = shape.embeddings.iter().filter(|e| e.curve == curve).map(|e| e.vertices[sample]);
        return new.into_iter().find(joins).ok_or(torn);
    }
    let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
    let v = shape.mesh.split_edge(edge);
    place(shape, v, &ends);
    Ok(v)
}

/// Puts a new vertex in the middle of others.
fn place(shape: &mut SurfaceShape, v: VertexId, among: &[VertexId]) {
    let count = among.len() as f64;
    let middle = among.iter().map(|w| shape.positions[w.index()]).sum::<glam::DVec3>() / count;
    let wanted = among.iter().map(|w| shape.wanted_at(*w)).sum::<f64>() / count;
    shape.positions.resize(shape.mesh.vertex_slots(), middle);
    shape.positions[v.index()] = middle;
    if !shape.wanted.is_empty() {
        shape.wanted.resize(shape.mesh.vertex_slots(), wanted);
        shape.wanted[v.index()] = wanted;
    }
}

fn lay(model: &mut Model, id: SurfaceId, seam: &Seam) -> Result<(), ModelError> {
    let revision = model.next_revision();
    let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
    shape.mesh.glue(seam);
    let mut stays: Vec<VertexId> = (0..shape.mesh.vertex_slots()).map(VertexId::from_index).collect();
    for (kept, gone) in seam.kept.iter().zip(&seam.gone) {
        stays[gone.index()] = *kept;
    }
    let name = |v: &mut VertexId| *v = stays[v.index()];
    shape.embeddings.iter_mut().flat_map(|e| &mut e.vertices).for_each(name);
    shape.pins.iter_mut().for_each(|pin| name(&mut pin.vertex));
    propagate_orientation(&mut shape.mesh);
    shape.revision = revision;
    Ok(())
}
