//! The acts of a designer, one file each. An act changes document and shapes together; when it fails the
//! caller throws the changed model away and keeps the one before.

mod bake;
mod burnout;
pub(crate) mod cage;
mod cage_settings;
mod crease;
mod curve;
pub(crate) mod delete;
mod delete_face;
mod density;
mod displace;
mod embed;
mod expand;
mod extrude;
mod fill;
mod glue;
mod import;
mod insert;
mod lean;
mod merge;
mod mesh;
mod normal;
mod objective;
mod outward;
mod pin;
mod point;
mod propagate;
mod region;
mod release;
mod reverse;
mod ribbon;
pub(crate) mod rim;
mod s_loop;
mod shadow;
mod sheet;
mod shift;
mod slide;
mod smooth;
mod spacing;
mod split;
mod split_edge;
mod split_face;
mod sweep;
mod tangent;
mod trim;

use crate::bound::BoundSurface;
use crate::displaced::Displacer;
use crate::error::ModelError;
use crate::maintain;
use crate::model::Model;
use crate::patch;
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use crate::skeleton::carry_free;
use ductile_spec::{Document, Edit, MAX_COORDINATE, PointId, SurfaceId};
use glam::DVec3;
use std::sync::Arc;

pub(crate) use delete::drop_unused;
pub(crate) use fill::{forget_lost as forget_lost_planes, found_loop, mended};
pub(crate) use import::import;
pub(crate) use insert::{insert, insert_there, insert_vertex};
pub(crate) use pin::pin;
pub(crate) use ribbon::{forget_lost, kept_direction};
pub(crate) use shadow::forget_lost as forget_lost_shadows;
pub(crate) use trim::meeting;

/// Digits of a position that a document keeps, counted from the leading digit of the model's radius.
/// A millionth of the model is finer than a pixel and keeps links short.
const POSITION_DIGITS: i32 = 6;

/// Does an act. The relaxer knows the fitted surface between the vertices.
///
/// # Errors
/// [`ModelError`] says why it cannot be done; the model may then be half changed and must be dropped.
pub(crate) fn apply(
    model: &mut Model,
    relaxer: &Relaxer,
    displacer: &mut Displacer,
    edit: &Edit,
) -> Result<(), ModelError> {
    if let Some(outcome) = displacing((model, relaxer, displacer), edit) {
        return outcome;
    }
    let before = (!model.document.fills.is_empty()).then(|| model.clone());
    let were_closed = outward::closed(model);
    let was = Arc::clone(&model.document);
    act(model, relaxer, edit)?;
    if was.points != model.document.points {
        carry_free(&was, model.document_mut());
    }
    outward::turn(model, &were_closed)?;
    shadow::forget_lost(model);
    if model.document.surfaces.values().flat_map(|surface| &surface.regions).any(|r| r.shadow.is_some()) {
        model.document.validate()?;
    }
    if let Some(before) = before {
        forget_lost_planes(model);
        patch::follow(model, Some(relaxer));
        fill::check_kept(model, &before)?;
    }
    for id in model.surfaces.keys().copied().collect::<Vec<_>>() {
        let is_new = model.surfaces.get(&id).is_some_and(|shape| relaxer.surface(id, shape).is_none());
        if is_new {
            maintain::thin_out(model, id)?;
        }
        // What was cut or joined on a crumpled surface may be no surface that can be solved for.
        if let Some(shape) = model.surfaces.get(&id).filter(|_| is_new) {
            BoundSurface::new(id, shape)?;
        }
    }
    model.check_extents()
}

/// Whether an act is about displacements, which lie over the shapes, and has to find them in the document. All but `bake` change none
/// of the shapes.
pub(crate) fn displaces(edit: &Edit) -> bool {
    matches!(
        edit,
        Edit::Displace { .. }
            | Edit::ChangeDisplacement { .. }
            | Edit::AddFoot { .. }
            | Edit::EraseDisplacement { .. }
            | Edit::DropDisplacements { .. }
            | Edit::Blending { .. }
            | Edit::Bake { .. }
    )
}

/// Does an act on displacements or shadows; nothing if it is another one.
fn displacing(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    edit: &Edit,
) -> Option<Result<(), ModelError>> {
    let all = (&mut *model, relaxer, displacer);
    Some(match edit {
        Edit::Displace { surface, displacement } => displace::displace(all, *surface, displacement),
        Edit::ChangeDisplacement { surface, number, to } => displace::change(all, *surface, *number, to),
        Edit::AddFoot { surface, number, at } => displace::add_foot(all, *surface, *number, *at),
        Edit::EraseDisplacement { surface, number } => displace::erase(model, *surface, *number),
        Edit::DropDisplacements { surface } => displace::drop_all(model, *surface),
        Edit::Blending { surface, blending } => displace::blend(all, *surface, blending),
        Edit::Bake { surface } => bake::bake(all, *surface),
        Edit::Shadow { region, of, strength, turn } => shadow::shadow(all, *region, *of, *strength, *turn),
        _ => return None,
    })
}

fn act(model: &mut Model, relaxer: &Relaxer, edit: &Edit) -> Result<(), ModelError> {
    match edit {
        Edit::Point { at } => point::place(model, *at).map(drop),
        Edit::Move { point, to } => point::shift(model, *point, *to),
        Edit::Curve { through, closed } => curve::curve(model, through, *closed),
        Edit::Sheet { boundary } => sheet::sheet(model, *boundary),
        Edit::Sweep { from, to, stretches: [one, other], reversed } => {
            sweep::sweep(model, [(*from, *one), (*to, *other)], *reversed)
        }
        Edit::Embed { curve, surface } => embed::embed(model, *curve, *surface),
        Edit::Burnout { region } => burnout::burnout(model, *region),
        Edit::Split { border } => split::split(model, *border),
        Edit::Crease { border } => crease::crease(model, *border),
        Edit::Smooth { curve } => smooth::smooth(model, *curve),
        Edit::Expand { curve, to } => expand::expand(model, *curve, *to),
        Edit::Reverse { surface } => reverse::reverse(model, *surface),
        Edit::Propagate { surface } => propagate::propagate(model, *surface),
        Edit::SLoop { surface, along, closed } => s_loop::s_loop(model, *surface, along, *closed),
        Edit::Glue { from, to, skirt, reversed } => glue::glue(model, *from, *to, *skirt, *reversed),
        Edit::Merge { .. } | Edit::MergeClosest { .. } => act_by_tube(model, edit),
        Edit::Fill { .. } | Edit::FillNetwork { .. } | Edit::Refill { .. } | Edit::Lean { .. } => {
            act_on_fill(model, relaxer, edit)
        }
        Edit::Trim { first, second, smooth, ribbon } => {
            trim::trim((model, relaxer), [*first, *second], *smooth, *ribbon)
        }
        Edit::Pin { surface, at } => pin(model, relaxer, *surface, *at).map(drop),
        Edit::Insert { curve, at } => insert(model, *curve, *at).map(drop),
        Edit::Release { point } => release::release(model, *point),
        Edit::DeletePoint { point } => delete::point(model, *point),
        Edit::DeleteCurve { curve } => delete::curve(model, *curve),
        Edit::DeleteSurface { surface } => delete::surface(model, *surface),
        Edit::Spacing { of, spacing } => spacing::respace(model, *of, *spacing),
        Edit::Density { of, density } => density::choose(model, *of, *density),
        Edit::Objective { of, objective } => objective::choose(model, *of, *objective),
        Edit::Tangent { curve, point, direction } => tangent::tangent(model, *curve, *point, *direction),
        Edit::Normal { surface, point, normal } => normal::normal(model, *surface, *point, *normal),
        Edit::Ribbon { surface, curve, leave } => {
            ribbon::ribbon(model, relaxer, *surface, *curve, leave.as_ref())
        }
        Edit::Shift { points, by } => shift::shift(model, points, *by),
        Edit::Mesh { from } => mesh::mesh(model, from),
        Edit::Cage { .. }
        | Edit::CageSettings { .. }
        | Edit::Extrude { .. }
        | Edit::DeleteFace { .. }
        | Edit::SplitEdge { .. }
        | Edit::SplitFace { .. }
        | Edit::Rim { .. } => act_on_cage(model, edit),
        Edit::Rename { name } => rename(model, name),
        // Done by `displacing`.
        Edit::Displace { .. }
        | Edit::ChangeDisplacement { .. }
        | Edit::AddFoot { .. }
        | Edit::EraseDisplacement { .. }
        | Edit::DropDisplacements { .. }
        | Edit::Blending { .. }
        | Edit::Bake { .. }
        | Edit::Shadow { .. } => Ok(()),
    }
}

fn rename(model: &mut Model, name: &str) -> Result<(), ModelError> {
    name.clone_into(&mut model.document_mut().name);
    Ok(model.document.validate()?)
}

/// The acts that make a tube.
fn act_by_tube(model: &mut Model, edit: &Edit) -> Result<(), ModelError> {
    match edit {
        Edit::Merge { from, to, radius, keep } => merge::merge(model, *from, *to, *radius, *keep),
        Edit::MergeClosest { first, second, radius, keep } => {
            merge::merge_closest(model, [*first, *second], *radius, *keep)
        }
        _ => Ok(()),
    }
}

/// The acts on fills.
fn act_on_fill(model: &mut Model, relaxer: &Relaxer, edit: &Edit) -> Result<(), ModelError> {
    match edit {
        Edit::Fill { hole, style } => fill::fill(model, relaxer, hole, *style),
        Edit::FillNetwork { curve, style } => fill::fill_network(model, relaxer, *curve, *style),
        Edit::Refill { surface, style } => fill::refill(model, relaxer, *surface, *style),
        Edit::Lean { surface, side, turn, strength } => {
            lean::lean(model, relaxer, *surface, *side, (*turn, *strength))
        }
        _ => Ok(()),
    }
}

/// The acts on cages.
fn act_on_cage(model: &mut Model, edit: &Edit) -> Result<(), ModelError> {
    match edit {
        Edit::Cage { from } => cage::cage(model, from),
        Edit::CageSettings { surface, settings } => cage_settings::choose(model, *surface, *settings),
        Edit::Extrude { surface, face, distance } => extrude::extrude(model, *surface, *face, *distance),
        Edit::DeleteFace { surface, face } => delete_face::delete_face(model, *surface, *face),
        Edit::SplitEdge { surface, ends, at } => split_edge::split_edge(model, *surface, *ends, *at),
        Edit::SplitFace { surface, face, between } => {
            split_face::split_face(model, *surface, *face, *between)
        }
        Edit::Rim { surface, ends, between } => rim::rim(model, *surface, *ends, *between),
        _ => Ok(()),
    }
}

/// The position that a document keeps for one that was pointed at.
pub(crate) fn kept_position(model: &Model, at: DVec3) -> Result<DVec3, ModelError> {
    kept_in(&model.document, at)
}

/// As [`kept_position`].
pub(crate) fn kept_in(document: &Document, at: DVec3) -> Result<DVec3, ModelError> {
    if !at.to_array().iter().all(|x| x.is_finite() && x.abs() <= MAX_COORDINATE) {
        return Err(ModelError::BadPosition);
    }
    let (_, radius) = document.extent();
    let radius = if radius > 0.0 { radius } else { 1.0 };
    let exponent: i32 = format!("{radius:e}").split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    let decimals = usize::try_from((POSITION_DIGITS - exponent).clamp(0, 15)).unwrap_or(0);
    // Through the decimal text: exact on every machine. Adding zero turns -0 into 0.
    let keep = |x: f64| format!("{x:.decimals$}").parse::<f64>().unwrap_or(x) + 0.0;
    Ok(DVec3::from_array(at.to_array().map(keep)))
}

/// Writes the skeleton of a surface that was changed on its mesh back into the document.
pub(crate) fn refresh_skeleton(model: &mut Model, id: SurfaceId) {
    let Some(shape) = model.surfaces.get(&id).map(Arc::clone) else { return };
    let skeleton = crate::skeleton::skeleton_of(model, &shape);
    if let Some(surface) = model.document_mut().surfaces.get_mut(&id) {
        surface.skeleton = skeleton;
    }
}

/// Removes the control points of a surface as it was that nothing uses any more.
pub(crate) fn forget_unused_points(model: &mut Model, before: &SurfaceShape) {
    let points = before.mesh.vertices().filter_map(|v| before.mesh.vertex_source(v));
    for point in points.map(|tag| PointId(tag.0)).collect::<Vec<_>>() {
        if is_unused(model, point) {
            model.document_mut().points.remove(&point);
        }
    }
}

/// Whether nothing in the document uses a point.
pub(crate) fn is_unused(model: &Model, point: PointId) -> bool {
    model.document.curves_through(point).next().is_none()
        && model.document.surfaces_through(point).next().is_none()
        && model.document.cages_on(point).next().is_none()
}
