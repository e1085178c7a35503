//! Displaced surfaces: what is shown of a surface whose inside is moved (P. Salvi, *Editing the interior of arbitrary surfaces
//! using C∞ displacement blends*; the mathematics is `ductile-patch`'s).
//!
//! Below a displaced surface lies the surface as it is without displacements, its *base*: fair ones go on relaxing there,
//! exact ones follow their controls, and neither knows of what lies over it. What is shown, picked and exported is the base
//! with offsets added. While the base moves, the blends stay as they are and only the sums are made anew; they are reckoned
//! from the shape when it has come to rest, or when its connectivity changed. Shadows lie over that in the same way. Like the solvers of the relaxer, all this is made
//! from the model and never part of it.

mod back;
mod base;
mod footing;
mod normal;
mod overlay;
mod places;
mod reach;
mod request;
#[cfg(test)]
mod shadow_test;
mod shadowed;
#[cfg(test)]
mod tests;
mod view;

use crate::error::ModelError;
use crate::model::Model;
use crate::relax::Relaxer;
use base::Base;
use ductile_spec::{Displaced, SurfaceId};
use glam::DVec3;
use shadowed::Shadowed;
use std::collections::BTreeMap;

pub(crate) use overlay::Overlay;
pub(crate) use places::{Footprints, give_back};

/// The displaced surfaces of a model.
#[derive(Clone, Debug, Default)]
pub(crate) struct Displacer {
    overlays: BTreeMap<SurfaceId, Overlay>,
    shadowed: BTreeMap<SurfaceId, Shadowed>,
    revisions: u64,
    probe: Option<reach::Probe>,
}

impl Displacer {
    /// What is shown of a surface, if it is displaced.
    pub(crate) fn get(&self, id: SurfaceId) -> Option<&Overlay> {
        self.overlays.get(&id)
    }

    /// All of them, in order of identity.
    pub(crate) fn overlays(&self) -> impl Iterator<Item = (SurfaceId, &Overlay)> + '_ {
        self.overlays.iter().map(|(id, overlay)| (*id, overlay))
    }

    /// Forgets everything: the model is another one.
    pub(crate) fn forget(&mut self) {
        self.overlays.clear();
        self.shadowed.clear();
        self.probe = None;
    }

    /// Brings everything up to the model. At rest, and only then, blends are reckoned from the shapes as they are.
    pub(crate) fn refresh(&mut self, model: &Model, relaxer: &Relaxer, is_at_rest: bool) {
        let asked = &model.document.displacements;
        self.overlays.retain(|id, _| asked.get(id).is_some_and(|displaced| !displaced.items.is_empty()));
        for (id, displaced) in asked.iter().filter(|(_, displaced)| !displaced.items.is_empty()) {
            match Base::of(model, relaxer, *id) {
                Some(base) => self.refresh_one(*id, displaced, &base, is_at_rest),
                None => drop(self.overlays.remove(id)),
            }
        }
        self.refresh_shadows(model, relaxer, is_at_rest);
    }

    fn refresh_one(&mut self, id: SurfaceId, asked: &Displaced, base: &Base<'_>, is_at_rest: bool) {
        let mut next = || {
            self.revisions += 1;
            self.revisions
        };
        if let Some(overlay) = self.overlays.get_mut(&id) {
            let is_same_mesh = overlay.is_on(base);
            if is_same_mesh
                && !(is_at_rest && overlay.is_outdated(asked, base))
                && overlay.adjust(asked, base, &mut next)
            {
                return;
            }
            // What stood on the mesh before is where it was carried, until all is at rest.
            let places = (!is_same_mesh && !is_at_rest).then(|| overlay.carried(asked)).flatten();
            let built = Overlay::new(asked, base, places.as_deref(), next());
            match built {
                Ok(built) => *overlay = built,
                // Nothing can be reckoned on triangles like these: what was reckoned before stays, if it fits.
                Err(_) if is_same_mesh => overlay.show(base),
                Err(_) => drop(self.overlays.remove(&id)),
            }
            return;
        }
        // Triangles on which nothing can be reckoned are shown as they are.
        if let Ok(overlay) = Overlay::new(asked, base, None, next()) {
            self.overlays.insert(id, overlay);
        }
    }

    /// Why the displacements of a surface, as the document has them, cannot all be met.
    ///
    /// # Errors
    /// The first reason.
    pub(crate) fn check(
        &mut self,
        model: &Model,
        relaxer: &Relaxer,
        id: SurfaceId,
    ) -> Result<(), ModelError> {
        self.refresh(model, relaxer, false);
        let Some(asked) = model.document.displacements.get(&id).filter(|asked| !asked.items.is_empty())
        else {
            return Ok(());
        };
        let refuse = |number, reason| Err(ModelError::Displacement { surface: id, number, reason });
        if let Some(overlay) = self.overlays.get(&id) {
            return match overlay.failures().first() {
                Some(&(index, reason)) => refuse(index + 1, reason),
                None => Ok(()),
            };
        }
        let base = Base::of(model, relaxer, id).ok_or(ModelError::NoSurface(id))?;
        match Overlay::new(asked, &base, None, 0) {
            Ok(_) => Ok(()),
            Err(reason) => refuse(1, reason),
        }
    }

    /// What is shown of a surface: where its vertices are, and its triangles; nothing while nothing is shown.
    pub(crate) fn shown<'a>(
        &'a self,
        model: &'a Model,
        relaxer: &'a Relaxer,
        id: SurfaceId,
    ) -> Option<(&'a [DVec3], &'a [[u32; 3]])> {
        self.view(model, relaxer, id).map(|view| (view.positions, view.triangles))
    }

    /// The place of the base under a place of what is shown.
    pub(crate) fn on_base(&self, id: SurfaceId, at: DVec3) -> DVec3 {
        let at = self.below_shadow(id, at);
        self.overlays.get(&id).map_or(at, |overlay| overlay.on_base(at))
    }
}
