//! `shadow`: a region takes on the relief of another surface (thesis section 7.3.3, region shadowing).

use super::region;
use crate::displaced::Displacer;
use crate::error::ModelError;
use crate::model::Model;
use crate::region::nearest_face;
use crate::relax::Relaxer;
use ductile_spec::{On, Region, Shadow, Surface, SurfaceId};
use std::collections::BTreeSet;

/// Decimals of an angle that a document keeps.
const ANGLE_DECIMALS: usize = 6;

/// Lets a region shadow a surface, or sets it free.
pub(super) fn shadow(
    (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
    on: On,
    of: Option<SurfaceId>,
    strength: f64,
    turn: Option<f64>,
) -> Result<(), ModelError> {
    if !on.at.is_finite() {
        return Err(ModelError::BadPosition);
    }
    let shape = model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?;
    let face = nearest_face(shape, on.at).ok_or(ModelError::NoSurface(on.surface))?;
    let Some(of) = of else {
        let mut had = false;
        region::change_around(model, on.surface, face, true, |own| had = own.shadow.take().is_some())?;
        return if had { Ok(model.document.validate()?) } else { Err(ModelError::NotShadowing(on.surface)) };
    };
    if model.document.kind_of(of).is_none() {
        return Err(ModelError::NoSurface(of));
    }
    let mut set = |model: &mut Model, turn: f64| {
        let mut told: Option<Region> = None;
        let shadow = Shadow { of, strength, turn };
        let is_named = region::change_around(model, on.surface, face, true, |own| {
            own.shadow = Some(shadow);
            told = Some(*own);
        })?;
        model.document.validate()?;
        let told = told.filter(|_| is_named).ok_or(ModelError::NoBorder(on.surface))?;
        displacer.natural_turn((model, relaxer), on.surface, &told)
    };
    let natural = set(model, turn.unwrap_or(0.0))?;
    if turn.is_none() {
        let kept: f64 = format!("{natural:.ANGLE_DECIMALS$}").parse().unwrap_or(natural);
        set(model, kept + 0.0)?;
    }
    Ok(())
}

/// Forgets the shadows of surfaces that are no more, or have become one with what shadows them.
pub(crate) fn forget_lost(model: &mut Model) {
    let document = &model.document;
    let stamps = document.surfaces.values().flat_map(|surface| &surface.regions);
    let stamps = stamps.filter_map(|region| Some(region.shadow?.of));
    let lost: BTreeSet<SurfaceId> = stamps.filter(|of| document.kind_of(*of).is_none()).collect();
    let is_lost = |id: SurfaceId, region: &Region| {
        region.shadow.is_some_and(|shadow| shadow.of == id || lost.contains(&shadow.of))
    };
    let has_lost = |(id, surface): (&SurfaceId, &Surface)| surface.regions.iter().any(|r| is_lost(*id, r));
    if !document.surfaces.iter().any(has_lost) {
        return;
    }
    for (id, surface) in &mut model.document_mut().surfaces {
        for region in &mut surface.regions {
            region.shadow = region.shadow.filter(|_| !is_lost(*id, region));
        }
        surface.regions.retain(|region| !region.is_idle());
    }
}
