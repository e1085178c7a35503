//! `displace` and what undoes or changes it: displacements of the inside of a surface, of whatever kind (P. Salvi, *Editing
//! the interior of arbitrary surfaces using C∞ displacement blends*).

use crate::displaced::Displacer;
use crate::error::ModelError;
use crate::model::Model;
use crate::operation::kept_position;
use crate::relax::Relaxer;
use ductile_spec::{Blending, Displaced, Displacement, Foot, SurfaceId};
use glam::DVec3;

/// Displaces a surface once more.
pub(super) fn displace(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    id: SurfaceId,
    displacement: &Displacement,
) -> Result<(), ModelError> {
    let kept = kept(model, displacement)?;
    displaced(model, id)?.items.push(kept);
    agree(model, relaxer, displacer, id)
}

/// Puts another displacement in the place of one.
pub(super) fn change(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    id: SurfaceId,
    number: usize,
    to: &Displacement,
) -> Result<(), ModelError> {
    let kept = kept(model, to)?;
    *item(model, id, number)? = kept;
    agree(model, relaxer, displacer, id)
}

/// Lets one more place of what is shown move with a displacement.
pub(super) fn add_foot(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    id: SurfaceId,
    number: usize,
    at: DVec3,
) -> Result<(), ModelError> {
    let shown = kept_position(model, at)?;
    let below = kept_position(model, displacer.on_base(id, shown))?;
    let foot = &mut item(model, id, number)?.foot;
    match foot {
        Foot::At(first) => *foot = Foot::All(vec![*first, below]),
        Foot::All(places) => places.push(below),
        Foot::Along(curve) => {
            return Err(ModelError::CurveIsFoot { surface: id, number, curve: *curve });
        }
    }
    agree(model, relaxer, displacer, id)
}

/// Takes a displacement away.
pub(super) fn erase(model: &mut Model, id: SurfaceId, number: usize) -> Result<(), ModelError> {
    item(model, id, number)?;
    displaced(model, id)?.items.remove(number - 1);
    model.document_mut().displacements.retain(|_, displaced| !displaced.is_idle());
    Ok(model.document.validate()?)
}

/// Takes all of them away, and what was said of them.
pub(super) fn drop_all(model: &mut Model, id: SurfaceId) -> Result<(), ModelError> {
    displaced(model, id)?;
    let had = model.document_mut().displacements.remove(&id).is_some_and(|displaced| !displaced.is_idle());
    if had { Ok(()) } else { Err(ModelError::NotDisplaced(id)) }
}

/// Chooses what the displacements of a surface have in common.
pub(super) fn blend(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    id: SurfaceId,
    blending: &Blending,
) -> Result<(), ModelError> {
    displaced(model, id)?.blending = blending.clone();
    model.document_mut().displacements.retain(|_, displaced| !displaced.is_idle());
    agree(model, relaxer, displacer, id)
}

/// The displacements of a surface that exists.
fn displaced(model: &mut Model, id: SurfaceId) -> Result<&mut Displaced, ModelError> {
    model.document.kind_of(id).ok_or(ModelError::NoSurface(id))?;
    Ok(model.document_mut().displacements.entry(id).or_default())
}

fn item(model: &mut Model, id: SurfaceId, number: usize) -> Result<&mut Displacement, ModelError> {
    let none = ModelError::NoDisplacement { surface: id, number };
    number.checked_sub(1).and_then(|index| displaced(model, id).ok()?.items.get_mut(index)).ok_or(none)
}

/// What the document keeps of a displacement.
fn kept(model: &Model, displacement: &Displacement) -> Result<Displacement, ModelError> {
    let mut kept = displacement.clone();
    for at in kept.foot.places_mut() {
        *at = kept_position(model, *at)?;
    }
    kept.by = kept_position(model, kept.by)?;
    Ok(kept)
}

/// Refuses what the document cannot say or the surface cannot do.
fn agree(
    model: &Model,
    relaxer: &Relaxer,
    displacer: &mut Displacer,
    id: SurfaceId,
) -> Result<(), ModelError> {
    model.document.validate()?;
    displacer.check(model, relaxer, id)
}
