//! Where feet and pins go when an act changes the surface below them.
//!
//! An act that moves controls carries them along: on an exact surface with the triangle in which they stand, on a fair one
//! that has not moved yet by what the nearest controls do (inverse fourth powers of distances), after a drag with the mesh.
//! An act of surgery leaves them in their places, on the surface that lies there afterwards; what stood on a part that is
//! gone is gone with it.

use super::Displacer;
use super::base::Base;
use crate::error::ModelError;
use crate::model::Model;
use crate::operation::kept_position;
use crate::relax::Relaxer;
use ductile_mesh::nearest_place;
use ductile_spec::{CurveId, Displaced, Document, Foot, Hold, PointId, SkeletonVertex, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Where feet and pins stand on the surfaces below, by surface.
pub(crate) type Footprints = BTreeMap<SurfaceId, Vec<DVec3>>;

impl Displacer {
    /// Where everything stands now.
    pub(crate) fn footprints(&self) -> Footprints {
        self.overlays().map(|(id, overlay)| (id, overlay.footprints())).collect()
    }

    /// A drag is over: the places that the document has move by as much as what stands there was carried.
    pub(crate) fn carry(&mut self, model: &mut Model, before: &Footprints) -> Result<(), ModelError> {
        let now = self.footprints();
        for (id, now) in &now {
            let Some(before) = before.get(id).filter(|before| before.len() == now.len() && *before != now)
            else {
                continue;
            };
            let moves: Vec<DVec3> = now.iter().zip(before).map(|(now, before)| *now - *before).collect();
            self.move_places(model, *id, &moves)?;
        }
        Ok(())
    }

    /// An act is over: exact surfaces have followed their controls, and their feet with them.
    pub(crate) fn carry_exact(
        &mut self,
        model: &mut Model,
        relaxer: &Relaxer,
        before: &Footprints,
    ) -> Result<(), ModelError> {
        for (id, before) in before {
            let Some(overlay) = self.get(*id).filter(|_| model.patches.contains_key(id)) else { continue };
            let Some(base) = Base::of(model, relaxer, *id).filter(|base| overlay.is_on(base)) else {
                continue;
            };
            let now = overlay.footprints_on(base.positions);
            let is_moved = now != *before && now.len() == before.len();
            if is_moved && model.document.displacements.contains_key(id) {
                let moves: Vec<DVec3> = now.iter().zip(before).map(|(now, before)| *now - *before).collect();
                self.move_places(model, *id, &moves)?;
            }
        }
        Ok(())
    }

    /// An act has carried places of the document along: what stands there goes on where the surface carries it, until
    /// that is at rest.
    pub(crate) fn adopt(&mut self, model: &Model) {
        for (id, displaced) in &model.document.displacements {
            if let Some(overlay) = self.overlays.get_mut(id)
                && overlay.is_alike(displaced)
            {
                overlay.adopt(displaced);
            }
        }
    }

    fn move_places(&mut self, model: &mut Model, id: SurfaceId, moves: &[DVec3]) -> Result<(), ModelError> {
        let Some(mut displaced) = model.document.displacements.get(&id).cloned() else { return Ok(()) };
        for (at, by) in displaced.places_mut().zip(moves) {
            *at = if *by == DVec3::ZERO { *at } else { kept_position(model, *at + *by)? };
        }
        if let Some(overlay) = self.overlays.get_mut(&id) {
            overlay.adopt(&displaced);
        }
        model.document_mut().displacements.insert(id, displaced);
        Ok(())
    }
}

/// Gives displacements that were taken out of a document before an act back to it, where they belong after it.
pub(crate) fn give_back(
    model: &mut Model,
    before: &Model,
    taken: BTreeMap<SurfaceId, Displaced>,
) -> Result<(), ModelError> {
    let is_changed = |(id, shape): (&SurfaceId, &std::sync::Arc<crate::shape::SurfaceShape>)| {
        let is_same = before.surfaces.get(id).is_some_and(|other| other.revision == shape.revision);
        (!is_same).then_some(*id)
    };
    let changed: BTreeSet<SurfaceId> = model.surfaces.iter().filter_map(is_changed).collect();
    let mut given: BTreeMap<SurfaceId, Displaced> = BTreeMap::new();
    for (id, mut displaced) in taken {
        let exists = model.document.kind_of(id).is_some();
        carry_fair(&mut displaced, id, model, &before.document)?;
        if exists && !changed.contains(&id) {
            given.insert(id, displaced);
            continue;
        }
        for (surface, part) in divide(model, id, displaced, &changed)? {
            let whole = given.entry(surface).or_default();
            if whole.items.is_empty() && whole.blending.pins.is_empty() {
                whole.blending = part.blending;
            } else {
                whole.blending.pins.extend(part.blending.pins);
            }
            whole.items.extend(part.items);
        }
    }
    given.retain(|_, displaced| !displaced.is_idle());
    model.document_mut().displacements.append(&mut given);
    Ok(model.document.validate()?)
}

/// Says of each displacement and pin of a surface that was changed on which surface it stands now.
fn divide(
    model: &Model,
    id: SurfaceId,
    displaced: Displaced,
    changed: &BTreeSet<SurfaceId>,
) -> Result<BTreeMap<SurfaceId, Displaced>, ModelError> {
    let mut parts: BTreeMap<SurfaceId, Displaced> = BTreeMap::new();
    let mut blending = displaced.blending;
    let pins = std::mem::take(&mut blending.pins);
    let fresh = || Displaced { blending: blending.clone(), items: Vec::new() };
    for pin in pins {
        let home = match pin {
            Hold::Around { at, .. } => home_of(model, at, changed),
            Hold::Curve(curve) => Some(home_of_curve(model, id, curve)?),
        };
        if let Some(home) = home {
            parts.entry(home).or_insert_with(fresh).blending.pins.push(pin);
        }
    }
    for item in displaced.items {
        let home = match &item.foot {
            Foot::Along(curve) => Some(home_of_curve(model, id, *curve)?),
            places => places.places().first().and_then(|at| home_of(model, *at, changed)),
        };
        if let Some(home) = home {
            parts.entry(home).or_insert_with(fresh).items.push(item);
        }
    }
    Ok(parts)
}

/// The surface of some on which a place lies, to within the edges of its mesh.
fn home_of(model: &Model, at: DVec3, among: &BTreeSet<SurfaceId>) -> Option<SurfaceId> {
    let distance = |id: &SurfaceId| {
        let shape = model.surfaces.get(id)?;
        let place = nearest_place(&shape.mesh, &shape.positions, at)?;
        let distance = place.position(&shape.mesh, &shape.positions)?.distance(at);
        (distance <= shape.longest_wanted()).then_some((distance, *id))
    };
    among.iter().filter_map(distance).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, id)| id)
}

/// The surface in which a curve lies, that of before if it still does.
fn home_of_curve(model: &Model, id: SurfaceId, curve: CurveId) -> Result<SurfaceId, ModelError> {
    let surfaces: Vec<SurfaceId> = model.document.surfaces_on(curve).collect();
    let home = surfaces.iter().find(|other| **other == id).or(surfaces.first());
    home.copied().ok_or(ModelError::NeededByDisplacement { surface: id, curve })
}

/// Carries the places of a fair surface along with its controls, which an act has moved and the surface will follow.
fn carry_fair(
    displaced: &mut Displaced,
    id: SurfaceId,
    model: &Model,
    before: &Document,
) -> Result<(), ModelError> {
    let controls = controls(before, id);
    let by = |point: &PointId| {
        let (was, is) = (before.points.get(point)?, model.document.points.get(point)?);
        Some((*was, *is - *was))
    };
    let moves: Vec<(DVec3, DVec3)> = controls.iter().filter_map(by).collect();
    if moves.iter().all(|(_, by)| *by == DVec3::ZERO) {
        return Ok(());
    }
    for at in displaced.places_mut() {
        if let Some((_, by)) = moves.iter().find(|(was, _)| was == at) {
            *at = kept_position(model, *at + *by)?;
            continue;
        }
        let (mut sum, mut total) = (DVec3::ZERO, 0.0);
        for (was, by) in &moves {
            let squared = was.distance_squared(*at);
            let weight = 1.0 / (squared * squared);
            sum += *by * weight;
            total += weight;
        }
        let by = sum / total;
        if by.is_finite() && by != DVec3::ZERO {
            *at = kept_position(model, *at + by)?;
        }
    }
    Ok(())
}

/// The control points of a fair surface, its own and those of its curves.
fn controls(document: &Document, id: SurfaceId) -> BTreeSet<PointId> {
    let Some(surface) = document.surfaces.get(&id) else { return BTreeSet::new() };
    let own = surface.skeleton.vertices.iter().filter_map(|vertex| match vertex {
        SkeletonVertex::Control(point) => Some(*point),
        SkeletonVertex::Free(_) => None,
    });
    let curves = surface.skeleton.curves.iter().filter_map(|e| document.curves.get(&e.curve));
    own.chain(curves.flat_map(|curve| curve.through.iter().copied())).collect()
}
