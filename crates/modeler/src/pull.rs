//! A drag that displaces: a place of a surface, or the foot of a displacement, follows the hand. A whole drag is one act.

use crate::displaced::Displacer;
use crate::error::ModelError;
use crate::model::Model;
use crate::operation::kept_position;
use crate::relax::Relaxer;
use ductile_spec::{Combination, Displacing, MAX_COORDINATE, SurfaceId};
use glam::DVec3;

/// How far one drag can reach, in radii of the model at its beginning.
const REACH: f64 = 5.0;

/// A drag of a foot in progress.
#[derive(Clone, Debug)]
pub(crate) struct Pull {
    pub(crate) surface: SurfaceId,
    /// Index of the displacement.
    pub(crate) index: usize,
    /// Whether the drag made it.
    is_new: bool,
    /// Whether the hand has moved it yet.
    pub(crate) has_moved: bool,
    /// The model before.
    pub(crate) before: Model,
    reach: f64,
}

impl Pull {
    /// Makes a displacement of a place or a curve of what is shown. The surface stays as it is until the hand moves.
    pub(crate) fn begin(
        (model, relaxer, displacer): (&mut Model, &Relaxer, &mut Displacer),
        begun: &Displacing,
    ) -> Result<Self, ModelError> {
        let (before, surface) = (model.clone(), begun.surface);
        model.document.kind_of(surface).ok_or(ModelError::NoSurface(surface))?;
        let shown = kept_position(model, begun.at)?;
        let below = kept_position(model, displacer.on_base(surface, shown))?;
        let displaced = model.document_mut().displacements.entry(surface).or_default();
        // Where others have moved the place, it is held there; in a sum they go on moving it.
        let is_plain = displaced.blending.combination == Combination::Plain;
        let by = if is_plain { DVec3::ZERO } else { shown - below };
        displaced.items.push(begun.displacement(below, by));
        let index = displaced.items.len() - 1;
        model.document.validate()?;
        displacer.check(model, relaxer, surface)?;
        Ok(Self::of(before, surface, index, true))
    }

    /// Takes hold of the foot of a displacement.
    pub(crate) fn take(model: &Model, surface: SurfaceId, number: usize) -> Result<Self, ModelError> {
        let none = ModelError::NoDisplacement { surface, number };
        let index = number.checked_sub(1).ok_or(none.clone())?;
        model
            .document
            .displacements
            .get(&surface)
            .and_then(|displaced| displaced.items.get(index))
            .ok_or(none)?;
        Ok(Self::of(model.clone(), surface, index, false))
    }

    fn of(before: Model, surface: SurfaceId, index: usize, is_new: bool) -> Self {
        let (_, radius) = before.document.extent();
        let reach = REACH * if radius > 0.0 { radius } else { 1.0 };
        Self { surface, index, is_new, has_moved: false, before, reach }
    }

    /// Where the foot is shown.
    pub(crate) fn at(&self, model: &Model, displacer: &Displacer) -> Option<DVec3> {
        let (below, others) = displacer.get(self.surface)?.foot(self.index)?;
        let item = model.document.displacements.get(&self.surface)?.items.get(self.index)?;
        Some(below + others + item.by)
    }

    /// Follows the hand. Nothing for what is not a position.
    pub(crate) fn follow(&mut self, model: &mut Model, displacer: &Displacer, to: DVec3) -> Option<()> {
        let (below, others) = displacer.get(self.surface)?.foot(self.index).filter(|_| to.is_finite())?;
        let most = self.reach.min(MAX_COORDINATE);
        let by = (to - below - others).clamp(DVec3::splat(-most), DVec3::splat(most));
        let displaced = model.document_mut().displacements.get_mut(&self.surface)?;
        let item = displaced.items.get_mut(self.index)?;
        self.has_moved |= item.by != by;
        item.by = by;
        Some(())
    }

    /// Lets go: the displacement becomes one that a document keeps. Returns the name of the act.
    pub(crate) fn finish(&self, model: &mut Model) -> Result<&'static str, ModelError> {
        let none = ModelError::NoDisplacement { surface: self.surface, number: self.index + 1 };
        let item =
            |model: &Model| model.document.displacements.get(&self.surface)?.items.get(self.index).cloned();
        let by = kept_position(model, item(model).ok_or(none.clone())?.by)?;
        let displaced = model.document_mut().displacements.get_mut(&self.surface);
        displaced.and_then(|displaced| displaced.items.get_mut(self.index)).ok_or(none)?.by = by;
        model.document.validate()?;
        Ok(if self.is_new { "Displace" } else { "Change displacement" })
    }
}
