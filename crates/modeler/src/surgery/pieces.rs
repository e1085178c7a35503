//! Pieces: what a surface that was cut has fallen into becomes surfaces again, with curves to follow and with all that the
//! document said of them.
//!
//! Both banks of a cut follow the same curve (they meet in a crease), or the second gets a copy with control points of its
//! own. A curve that was cut across is divided where it was: the parts share no more than a point.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::refresh_skeleton;
use crate::region;
use crate::shape::{EmbeddedCurve, Pin, SurfaceShape};
use crate::surgery::dividing::{add_curve, divide};
use crate::surgery::opening::Opening;
use crate::surgery::runs::Run;
use ductile_mesh::{
    Extracted, FaceId, Labels, Mesh, SourceTag, VertexId, components, is_orientable, propagate_orientation,
    regions,
};
use ductile_spec::{CurveId, PointId, Region, Ribbon, Surface, SurfaceId};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// What the two banks of a cut follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Banks {
    /// The same curve.
    Joint,
    /// Curves of their own.
    Apart,
}

/// A run and the curve that it follows from now on.
struct Followed {
    run: Run,
    curve: CurveId,
}

/// Makes surfaces of a surface that was opened. The largest piece keeps its name; the others are given, in order.
pub(crate) fn settle(
    model: &mut Model,
    id: SurfaceId,
    mut opening: Opening,
    banks: Banks,
) -> Result<Vec<SurfaceId>, ModelError> {
    let before = Arc::clone(model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?);
    let surface = model.document.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?.clone();
    let told = told(&before, &surface.regions);
    if banks == Banks::Joint {
        // Both ends would have to be the same control point.
        if let Some(run) = opening.runs.iter().find(|run| run.is_cut_across_once()) {
            return Err(ModelError::CutAcrossOnce(run.curve));
        }
        if let Some(run) = opening.runs.iter().find(|run| run.is_one_sided()) {
            return Err(ModelError::OneSided(run.curve));
        }
    }
    let twins = if banks == Banks::Apart { copy_points(model, &mut opening) } else { BTreeMap::new() };
    let followed = match banks {
        Banks::Joint => divide_joint(model, &opening),
        Banks::Apart => follow_apart(model, id, &opening)?,
    };
    let labels = components(&opening.mesh);
    let mut order: Vec<(usize, usize)> = labels
        .faces(&opening.mesh)
        .iter()
        .enumerate()
        .filter(|(_, faces)| faces.iter().all(|f| !opening.is_gone[f.index()]))
        .map(|(piece, faces)| (piece, faces.len()))
        .collect();
    order.sort_by_key(|(piece, faces)| (core::cmp::Reverse(*faces), *piece));
    let mut made = Vec::new();
    model.document_mut().surfaces.remove(&id);
    model.surfaces.remove(&id);
    for (rank, (piece, _)) in order.into_iter().enumerate() {
        let name = if rank == 0 { id } else { model.document.next_surface() };
        let mut part = opening.mesh.extract(|f| labels.of(f) == piece).ok_or(ModelError::Pinched(id))?;
        // A piece of a surface with one side may have two.
        if is_orientable(&part.mesh) {
            propagate_orientation(&mut part.mesh);
        }
        let shape = shape_of(model, &opening, &part, &followed, &before);
        let mut own = Surface::new(ductile_spec::Skeleton::default());
        (own.spacing, own.density, own.objective) = (surface.spacing, surface.density, surface.objective);
        tell_regions(&mut own, &shape, &told, |f| part.faces[f.index()]);
        tell_planes(&mut own, &surface, &before, &shape, &followed, &twins, &part);
        model.document_mut().surfaces.insert(name, own);
        model.surfaces.insert(name, Arc::new(shape));
        if rank > 0 {
            made.push(name);
        }
    }
    forget_curves(model, &before, &followed);
    for name in core::iter::once(id).chain(made.iter().copied()) {
        refresh_skeleton(model, name);
    }
    crate::operation::forget_unused_points(model, &before);
    crate::operation::forget_lost_planes(model);
    crate::operation::forget_lost_shadows(model);
    model.document.validate()?;
    Ok(made)
}

/// Gives the copies of control points identities of their own; says of which old point each is a copy.
fn copy_points(model: &mut Model, opening: &mut Opening) -> BTreeMap<PointId, PointId> {
    let mut twins = BTreeMap::new();
    for (v, copy) in &opening.copies {
        let Some(SourceTag(old)) = opening.mesh.vertex_source(*v) else { continue };
        let Some(at) = model.document.points.get(&PointId(old)).copied() else { continue };
        let new = model.document.next_point();
        model.document_mut().points.insert(new, at);
        opening.mesh.set_vertex_source(*copy, Some(SourceTag(new.0)));
        twins.insert(new, PointId(old));
    }
    twins
}

/// All runs follow the curves that they are of; a curve of which some run is only a part is divided at its ends first.
fn divide_joint(model: &mut Model, opening: &Opening) -> Vec<Followed> {
    let mut followed = Vec::new();
    let curves: BTreeSet<CurveId> = opening.runs.iter().map(|run| run.curve).collect();
    for id in curves {
        let runs: Vec<&Run> = opening.runs.iter().filter(|run| run.curve == id).collect();
        if runs.iter().all(|run| run.is_whole()) {
            followed.extend(runs.into_iter().map(|run| Followed { run: run.clone(), curve: id }));
            continue;
        }
        let ends = runs.iter().filter(|run| !run.closed);
        let ends: BTreeSet<usize> =
            ends.flat_map(|run| [run.samples[0], run.samples[run.samples.len() - 1]]).collect();
        let pieces = divide(model, id, &ends);
        for run in runs {
            for (curve, first, last) in &pieces {
                followed.extend(part_of(run, *first, *last).map(|run| Followed { run, curve: *curve }));
            }
        }
    }
    followed
}

/// The part of a run from one sample to another, if it has it.
fn part_of(run: &Run, first: usize, last: usize) -> Option<Run> {
    let count = run.samples.len();
    let start = run.samples.iter().position(|sample| *sample == first)?;
    let mut part = Run { samples: Vec::new(), vertices: Vec::new(), closed: false, ..run.clone() };
    for step in 0..=count {
        let place = start + step;
        if place >= count && !run.closed {
            return None;
        }
        part.samples.push(run.samples[place % count]);
        part.vertices.push(run.vertices[place % count]);
        if step > 0 && run.samples[place % count] == last {
            return Some(part);
        }
    }
    None
}

/// The first whole run of a curve through its own points goes on following it; every other gets a curve of its own, through the points at its vertices.
fn follow_apart(model: &mut Model, id: SurfaceId, opening: &Opening) -> Result<Vec<Followed>, ModelError> {
    let mut followed: Vec<Followed> = Vec::new();
    for run in &opening.runs {
        let shape = Arc::clone(model.curves.get(&run.curve).ok_or(ModelError::NoCurve(run.curve))?);
        // A bank whose control points are copies, if only where it ends at the cut, is another curve.
        let is_own = run.vertices.iter().zip(&run.samples).all(|(v, sample)| {
            let control = shape.controls.iter().find(|(place, _)| *place as usize == *sample);
            control.is_none_or(|(_, point)| opening.mesh.vertex_source(*v) == Some(SourceTag(point.0)))
        });
        if is_own && run.is_whole() && !followed.iter().any(|other| other.curve == run.curve) {
            followed.push(Followed { run: run.clone(), curve: run.curve });
            continue;
        }
        let like = model.document.curves.get(&run.curve).ok_or(ModelError::NoCurve(run.curve))?.clone();
        let tagged = |v: &VertexId| opening.mesh.vertex_source(*v).map(|tag| PointId(tag.0));
        let points: Vec<(usize, PointId)> = run
            .vertices
            .iter()
            .zip(&run.samples)
            .enumerate()
            .filter(|(_, (_, sample))| shape.is_control(**sample))
            .filter_map(|(place, (v, _))| Some((place, tagged(v)?)))
            .collect();
        let ends = [0, run.vertices.len() - 1];
        let is_held = run.closed || ends.iter().all(|end| points.iter().any(|(place, _)| place == end));
        if !is_held {
            return Err(ModelError::TornOff { curve: run.curve, surface: id });
        }
        let old = |point: PointId| {
            let place = points.iter().find(|(_, other)| *other == point)?.0;
            shape.controls.iter().find(|(sample, _)| *sample as usize == run.samples[place]).map(|c| c.1)
        };
        let tangent = |point: PointId| like.tangents.get(&old(point)?).copied();
        // A closed curve begins at its first control.
        let first = if run.closed { points.first().map_or(0, |(place, _)| *place) } else { 0 };
        let mut run = run.clone();
        run.samples.rotate_left(first);
        run.vertices.rotate_left(first);
        let count = run.vertices.len();
        let points: Vec<_> =
            points.iter().map(|(place, point)| ((place + count - first) % count, *point)).collect();
        let curve = add_curve(model, &shape, &run.samples, (&points, run.closed), &like, &tangent);
        followed.push(Followed { run, curve });
    }
    Ok(followed)
}

/// The shape of a piece.
fn shape_of(
    model: &mut Model,
    opening: &Opening,
    part: &Extracted,
    followed: &[Followed],
    before: &SurfaceShape,
) -> SurfaceShape {
    let pick = |v: VertexId| part.vertices[v.index()];
    let mut mesh = part.mesh.clone();
    let carry = |from: &[f64]| -> Vec<f64> {
        from.iter().zip(&part.vertices).filter_map(|(x, new)| new.map(|_| *x)).collect()
    };
    let positions =
        opening.positions.iter().zip(&part.vertices).filter_map(|(x, new)| new.map(|_| *x)).collect();
    for e in mesh.edges().collect::<Vec<_>>() {
        mesh.set_edge_source(e, None);
    }
    let mut embeddings = Vec::new();
    for Followed { run, curve } in followed {
        let Some(vertices) = run.vertices.iter().map(|v| pick(*v)).collect::<Option<Vec<_>>>() else {
            continue;
        };
        tag(&mut mesh, &vertices, run.closed, *curve);
        let mut vertices = vertices;
        if run.closed && *curve == run.curve {
            // A whole run begins anywhere; its curve's samples count from 0.
            let first = run.samples.iter().position(|sample| *sample == 0).unwrap_or(0);
            vertices.rotate_left(first);
        }
        embeddings.push(EmbeddedCurve { curve: *curve, vertices });
    }
    let pins = before
        .pins
        .iter()
        .filter_map(|pin| Some(Pin { vertex: pick(pin.vertex)?, point: pin.point }))
        .collect();
    let wanted = if opening.wanted.is_empty() { Vec::new() } else { carry(&opening.wanted) };
    let revision = model.next_revision();
    let (spacing, age) = (before.spacing, before.age);
    SurfaceShape { mesh, positions, embeddings, pins, spacing, wanted, age, revision }
}

/// Marks the edges along a chain.
pub(crate) fn tag(mesh: &mut Mesh, vertices: &[VertexId], closed: bool, curve: CurveId) {
    for edge in crate::surgery::opening::edges_of(mesh, vertices, closed).unwrap_or_default() {
        mesh.set_edge_source(edge, Some(SourceTag(curve.0)));
    }
}

/// What was said of regions, for every face of theirs: a curve may divide them yet.
pub(crate) fn told(shape: &SurfaceShape, said: &[Region]) -> Vec<(FaceId, Region)> {
    if said.is_empty() {
        return Vec::new();
    }
    let labels = regions(&shape.mesh);
    let of_pieces = region::own(shape, &labels, said, |region| Some(*region));
    shape.mesh.faces().filter_map(|f| Some((f, of_pieces[labels.of(f)]?))).collect()
}

/// Says it again of a shape, under the names that the regions have there. What is in one piece has it for itself.
pub(crate) fn tell_regions(
    surface: &mut Surface,
    shape: &SurfaceShape,
    told: &[(FaceId, Region)],
    face: impl Fn(FaceId) -> Option<FaceId>,
) {
    let labels: Labels = regions(&shape.mesh);
    let mut seen = BTreeSet::new();
    for (old, region) in told {
        let Some(piece) = face(*old).map(|f| labels.of(f)) else { continue };
        if !seen.insert(piece) {
            continue;
        }
        let is_named = labels.count() > 1 || region.shadow.is_some();
        let name = if is_named { region::name_of(shape, &labels, piece) } else { None };
        match name {
            // In one piece it has the rest for itself.
            Some((curve, from, side)) if labels.count() == 1 => {
                surface.objective = region.objective.or(surface.objective);
                surface.spacing = region.spacing.or(surface.spacing);
                let (objective, spacing) = (None, None);
                surface.regions.push(Region { curve, from, side, objective, spacing, ..*region });
            }
            Some((curve, from, side)) => surface.regions.push(Region { curve, from, side, ..*region }),
            None if labels.count() == 1 => {
                surface.objective = region.objective.or(surface.objective);
                surface.spacing = region.spacing.or(surface.spacing);
            }
            None => {}
        }
    }
}

/// Says again what was said of normals and ribbons. What led to the left of a curve leads backwards from a rim on its right.
fn tell_planes(
    own: &mut Surface,
    surface: &Surface,
    before: &SurfaceShape,
    shape: &SurfaceShape,
    followed: &[Followed],
    twins: &BTreeMap<PointId, PointId>,
    part: &Extracted,
) {
    let old = |point: PointId| twins.get(&point).copied().unwrap_or(point);
    for v in shape.mesh.vertices() {
        let Some(point) = shape.mesh.vertex_source(v).map(|tag| PointId(tag.0)) else { continue };
        if let Some(normal) = surface.normals.get(&old(point)) {
            own.normals.insert(point, *normal);
        }
    }
    for Followed { run, curve } in followed {
        let Some(ribbon) = surface.ribbons.get(&run.curve) else { continue };
        let Some(vertices) =
            run.vertices.iter().map(|v| part.vertices[v.index()]).collect::<Option<Vec<_>>>()
        else {
            continue;
        };
        let was_inner = before
            .embeddings
            .iter()
            .any(|e| e.curve == run.curve && e.vertices.iter().any(|v| !before.mesh.is_boundary_vertex(*v)));
        let turn = if was_inner && is_right_of(&shape.mesh, &vertices) { -1.0 } else { 1.0 };
        let points = vertices.iter().filter_map(|v| shape.mesh.vertex_source(*v)).map(|tag| PointId(tag.0));
        let cross = points.filter_map(|point| Some((point, *ribbon.cross.get(&old(point))? * turn)));
        let ribbon = Ribbon { cross: cross.collect(), onto: ribbon.onto };
        if !ribbon.cross.is_empty() || ribbon.onto.is_some() {
            own.ribbons.insert(*curve, ribbon);
        }
    }
}

/// Whether a chain runs along a rim and has its faces to its right.
fn is_right_of(mesh: &Mesh, vertices: &[VertexId]) -> bool {
    let Some(edge) = mesh.edge_between(vertices[0], vertices[1]) else { return false };
    let (face, other) = mesh.edge_faces(edge);
    let [a, b, c] = mesh.face_vertices(face);
    other.is_none() && ![(a, b), (b, c), (c, a)].contains(&(vertices[0], vertices[1]))
}

/// Curves that lay wholly in what was given up go with it; those around it stay, and so do those that others follow.
fn forget_curves(model: &mut Model, before: &SurfaceShape, followed: &[Followed]) {
    for embedded in &before.embeddings {
        let id = embedded.curve;
        let stays = followed.iter().any(|other| other.curve == id)
            || model.document.surfaces_on(id).next().is_some()
            || !followed.iter().any(|other| other.run.curve == id) && bounds(before, embedded);
        if !stays {
            model.document_mut().curves.remove(&id);
            model.curves.remove(&id);
        }
    }
}

/// Whether a curve lay on a rim.
fn bounds(shape: &SurfaceShape, embedded: &EmbeddedCurve) -> bool {
    embedded.vertices.iter().all(|v| shape.mesh.is_boundary_vertex(*v))
}
