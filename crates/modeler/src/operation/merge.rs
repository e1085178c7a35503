//! `merge`: a tube between two places of two surfaces, or of one (thesis section 7.4.3). Both are pierced: a loop is drawn
//! round each place, its inside is burnt out, and a band closes the space between the loops.

use crate::error::{ModelError, TouchError};
use crate::model::{Model, round_to_digits};
use crate::operation::s_loop::draw;
use crate::operation::{burnout, delete, region};
use crate::shape::{SurfaceShape, edit};
use crate::surgery::easing;
use crate::surgery::opening::{edges_around, region_at};
use crate::surgery::rims::{Rim, band};
use crate::surgery::tracing::Stop;
use crate::{density, maintain};
use ductile_mesh::{FaceId, SourceTag, SurfaceTree, measure, nearest_place, summary};
use ductile_spec::{CurveId, MAX_COORDINATE, Objective, On, SurfaceId};
use glam::DVec3;

/// Control points of the loop round a hole.
const CORNERS: u32 = 4;
/// Longest edges of a tube, as a part of its radius: twelve triangles go round it.
const TUBE_SPACING: f64 = 0.5;

/// Radii from a place to the nearest rim or control where there is room for the hole: its loop bulges between its corners.
const ROOM: f64 = 1.25;

/// Part of the radius up to which surfaces that come so near meet.
const TOUCHING: f64 = 1e-6;

/// Sine of the angle between way and normal up to which the way leads straight up: a facet leans by less.
const STRAIGHT: f64 = 0.2;

/// Makes a tube between two places.
pub(super) fn merge(model: &mut Model, from: On, to: On, radius: f64, keep: bool) -> Result<(), ModelError> {
    if !(radius > 0.0 && radius <= MAX_COORDINATE) {
        return Err(ModelError::BadRadius);
    }
    let is_near = from.surface == to.surface && from.at.distance(to.at) < 2.0 * radius;
    if is_near {
        return Err(ModelError::HolesMeet);
    }
    let [first, second] = frames(model, from, to)?;
    let one = pierce(model, from, first, radius)?;
    let other = pierce(model, to, second, radius)?;
    let rims =
        [(from.surface, rim_of(model, from.surface, one)?), (to.surface, rim_of(model, to.surface, other)?)];
    let [first, second] = rims;
    let face = band(model, first, second, (false, false))?;
    if keep {
        return stay_a_tube(model, (from.surface, face), radius);
    }
    // A handle that nothing holds has no size of its own: there is no better start to look for.
    let is_handle = from.surface == to.surface;
    if !is_handle {
        easing::refine(model, from.surface);
    }
    delete::curve(model, one)?;
    delete::curve(model, other)?;
    if !is_handle {
        easing::begin(model, from.surface);
    }
    Ok(())
}

/// The same between the places at which two surfaces come closest, among those around which there is room for the hole.
pub(super) fn merge_closest(
    model: &mut Model,
    [first, second]: [SurfaceId; 2],
    radius: f64,
    keep: bool,
) -> Result<(), ModelError> {
    if first == second {
        return Err(TouchError::ClosestToItself(first).into());
    }
    if !(radius > 0.0 && radius <= MAX_COORDINATE) {
        return Err(ModelError::BadRadius);
    }
    let (one, other) = (roomy(model, first, radius)?, roomy(model, second, radius)?);
    let pair = one.closest(&other).ok_or(ModelError::NoRoom(first))?;
    if pair.distance <= TOUCHING * radius {
        return Err(TouchError::Meeting(first, second).into());
    }
    let [from, to] = pair.positions;
    merge(model, On { surface: first, at: from }, On { surface: second, at: to }, radius, keep)
}

/// The faces of a surface around which there is room for a hole: no rim and no control is as near as its corners.
fn roomy(model: &Model, id: SurfaceId, radius: f64) -> Result<SurfaceTree, ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let mesh = &shape.mesh;
    let mut is_held = vec![false; mesh.vertex_slots()];
    shape.controlled().for_each(|v| is_held[v.index()] = true);
    let held: Vec<DVec3> = mesh
        .vertices()
        .filter(|v| is_held[v.index()] || mesh.is_boundary_vertex(*v))
        .map(|v| shape.positions[v.index()])
        .collect();
    let least = ROOM * radius;
    let is_free = |at: DVec3| held.iter().all(|p| p.distance_squared(at) >= least * least);
    let mut has_room = vec![false; mesh.vertex_slots()];
    for v in mesh.vertices() {
        has_room[v.index()] = is_free(shape.positions[v.index()]);
    }
    let tree = SurfaceTree::of_faces(mesh, &shape.positions, |f| {
        mesh.face_vertices(f).iter().all(|v| has_room[v.index()])
    });
    if tree.is_empty() { Err(ModelError::NoRoom(id)) } else { Ok(tree) }
}

/// A thin plate between two rims does not stay a tube: some radii long, it swells to a ball, which bends less; a shorter
/// one draws together to a neck that the mesh cannot show. What minimises the change of curvature stays a tube, if its
/// triangles are small enough to show how it bends.
fn stay_a_tube(model: &mut Model, (id, face): (SurfaceId, FaceId), radius: f64) -> Result<(), ModelError> {
    let wanted = round_to_digits(radius * TUBE_SPACING, 2);
    let is_coarse = model.spacing_of(id) > wanted;
    region::change_around(model, id, face, false, |region| {
        region.objective = Some(Objective::Fair);
        region.spacing = is_coarse.then_some(wanted);
    })?;
    model.document.validate()?;
    // It begins as a straight tube: long triangles from rim to rim say nothing of a change of curvature.
    let surface = model.document.surfaces.get(&id).cloned().ok_or(ModelError::NoSurface(id))?;
    let revision = model.next_revision();
    let shape = edit::<SurfaceShape>(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
    if is_coarse {
        density::begin(shape, &surface, 1);
    }
    maintain::refine(shape, 1);
    shape.revision = revision;
    Ok(())
}

/// A place on a surface as a hole is drawn there: its centre, and unit vectors along the normal and across it, toward the
/// middle between two corners.
#[derive(Clone, Copy, Debug)]
struct Frame {
    centre: DVec3,
    normal: DVec3,
    across: DVec3,
}

/// Frames at both ends of a tube, the second turned into the first along the way without twist (double reflection, Wang et
/// al. 2008), so that corner faces corner. At the first, a side of the hole lies across the way; where the way leads straight
/// up, which every facet of the mesh decides otherwise, any direction does.
fn frames(model: &Model, from: On, to: On) -> Result<[Frame; 2], ModelError> {
    let [(start, normal), (end, other)] = [upright(model, from)?, upright(model, to)?];
    let way = end - start;
    let along = |normal: DVec3| if normal.dot(way) < 0.0 { -normal } else { normal };
    let side = way.normalize_or_zero().cross(normal);
    let across =
        if side.length() > STRAIGHT { side.normalize_or_zero() } else { normal.any_orthonormal_vector() };
    let reflect = |v: DVec3, by: DVec3| {
        let size = by.length_squared();
        if size > 1e-12 { v - by * (2.0 * by.dot(v) / size) } else { v }
    };
    let by = way.normalize_or_zero();
    let (turned, ahead) = (reflect(across, by), reflect(along(normal), by));
    let there = reflect(turned, along(other) - ahead).reject_from_normalized(other);
    let there = there.try_normalize().unwrap_or_else(|| other.any_orthonormal_vector());
    Ok([Frame { centre: start, normal, across }, Frame { centre: end, normal: other, across: there }])
}

/// The nearest place on a surface, and the unit normal there.
fn upright(model: &Model, on: On) -> Result<(DVec3, DVec3), ModelError> {
    let id = on.surface;
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    if !on.at.is_finite() {
        return Err(ModelError::BadPosition);
    }
    let place = nearest_place(&shape.mesh, &shape.positions, on.at).ok_or(ModelError::NoSurface(id))?;
    let centre = place.position(&shape.mesh, &shape.positions).ok_or(ModelError::BadPosition)?;
    let normal = measure::face_normal(&shape.mesh, &shape.positions, place.face(&shape.mesh));
    Ok((centre, normal.try_normalize().ok_or(ModelError::NoRoom(id))?))
}

/// Makes a hole round a place; gives the curve on its rim.
fn pierce(model: &mut Model, on: On, frame: Frame, radius: f64) -> Result<CurveId, ModelError> {
    let id = on.surface;
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let Frame { centre, normal, across: u } = frame;
    let v = normal.cross(u);
    let corner = |k: u32| {
        let (sin, cos) = libm::sincos((f64::from(k) + 0.5) * core::f64::consts::TAU / f64::from(CORNERS));
        centre + (u * cos + v * sin) * radius
    };
    let corners: Vec<DVec3> = (0..CORNERS).map(corner).collect();
    let nearest = |at: DVec3| {
        let place = nearest_place(&shape.mesh, &shape.positions, at)?;
        place.position(&shape.mesh, &shape.positions)
    };
    // Beyond a rim, or where the surface turns away too fast, there is nothing to draw the loop on.
    let is_there = |at: &DVec3| nearest(*at).is_some_and(|on| on.distance(*at) < 0.5 * radius);
    if !corners.iter().all(is_there) {
        return Err(ModelError::NoRoom(id));
    }
    let stops = corners.into_iter().map(|at| Stop { at, point: None }).collect();
    let before = model.document.next_point();
    let curve = draw(model, id, stops, true)?;
    let through = &model.document.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?.through;
    let region = On { surface: id, at: centre };
    let is_in = region_at(model, region)?;
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let around = edges_around(&shape.mesh, &is_in);
    let is_own = around.iter().all(|e| shape.mesh.edge_source(*e) == Some(SourceTag(curve.0)));
    let is_free = through.len() == CORNERS as usize && through.iter().all(|point| *point >= before);
    // What is given up is a disc: no rim and no handle lies in it.
    let inside = shape.mesh.extract(|f| is_in[f.index()]).map(|part| summary(&part.mesh));
    let is_disc = inside.is_some_and(|inside| (inside.euler, inside.boundaries) == (1, 1));
    if !(is_disc
        && is_own
        && is_free
        && around.len() == model.curves.get(&curve).map_or(0, |c| c.nodes.len()))
    {
        return Err(ModelError::NoRoom(id));
    }
    burnout::burnout(model, region)?;
    Ok(curve)
}

/// The rim that follows a curve.
fn rim_of(model: &Model, id: SurfaceId, curve: CurveId) -> Result<Rim, ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let embedded = shape.embeddings.iter().find(|e| e.curve == curve);
    embedded.map(|e| e.vertices.clone()).ok_or(ModelError::NotInSurface { surface: id, curve })
}
