//! How far a displacement would reach that is not there yet: its blend at the vertices, and the line along which that would be
//! 1/2, on what is shown.

use super::Displacer;
use super::base::Base;
use super::footing::Spot;
use super::overlay::pinned;
use super::request::{items_of, settings};
use crate::error::ModelError;
use crate::model::Model;
use crate::relax::Relaxer;
use ductile_patch::{DisplacementError, Displacements, Domain};
use ductile_spec::{Blending, Displaced, Displacing, Reach, SurfaceId};
use glam::DVec3;

/// Where a blend counts as reached.
const HALF: f64 = 0.5;

/// The surface that was asked about last, factorised, if it is not displaced.
#[derive(Clone, Debug)]
pub(super) struct Probe {
    id: SurfaceId,
    revision: u64,
    blending: Blending,
    solver: Displacements,
}

impl Displacer {
    /// How far a displacement of a place or a curve of what is shown would reach.
    ///
    /// # Errors
    /// Why it cannot be displaced.
    pub(crate) fn reach(
        &mut self,
        (model, relaxer): (&Model, &Relaxer),
        trial: &Displacing,
    ) -> Result<Reach, ModelError> {
        let id = trial.surface;
        let base = Base::of(model, relaxer, id).ok_or(ModelError::NoSurface(id))?;
        let asked = model.document.displacements.get(&id).cloned().unwrap_or_default();
        let refuse = |reason| ModelError::Displacement { surface: id, number: asked.items.len() + 1, reason };
        let nowhere = || refuse(DisplacementError::BadPosition(0));
        let displacement = trial.displacement(self.on_base(id, trial.at), DVec3::ZERO);
        let stand = |at: &DVec3| Spot::nearest(base.positions, base.triangles, *at);
        let spots: Vec<Spot> = displacement.foot.places().iter().filter_map(stand).collect();
        let items = items_of(&displacement, &spots, &base).map_err(refuse)?;
        let (_, item) = items.into_iter().next().ok_or_else(nowhere)?;
        if let Some(overlay) = self.overlays.get_mut(&id).filter(|overlay| overlay.is_on(&base)) {
            let blend = overlay.trial(item).map_err(refuse)?;
            return Ok(reach(id, &overlay.positions()[..blend.len()], base.triangles, &blend));
        }
        let blend = self.probe(id, &asked, &base).and_then(|solver| solver.trial(item)).map_err(refuse)?;
        Ok(reach(id, base.positions, base.triangles, &blend))
    }

    fn probe(
        &mut self,
        id: SurfaceId,
        asked: &Displaced,
        base: &Base<'_>,
    ) -> Result<&mut Displacements, DisplacementError> {
        let is_known = |probe: &Probe| {
            (probe.id, probe.revision) == (id, base.revision) && probe.blending == asked.blending
        };
        let known = match self.probe.take().filter(is_known) {
            Some(probe) => probe,
            None => {
                let places: Vec<DVec3> = asked.clone().places_mut().map(|at| *at).collect();
                let feet = asked.items.iter().map(|item| item.foot.places().len()).sum();
                let stand = |at: &DVec3| Spot::nearest(base.positions, base.triangles, *at);
                let pins: Vec<Spot> =
                    places.get(feet..).unwrap_or_default().iter().filter_map(stand).collect();
                let domain = Domain::new(base.positions, base.triangles)?;
                let domain = domain.with_pins(&pinned(asked, base, &pins))?;
                let solver = Displacements::new(domain, settings(&asked.blending))?;
                Probe { id, revision: base.revision, blending: asked.blending.clone(), solver }
            }
        };
        Ok(&mut self.probe.insert(known).solver)
    }
}

fn reach(surface: SurfaceId, positions: &[DVec3], triangles: &[[u32; 3]], blend: &[f64]) -> Reach {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to what a byte holds"
    )]
    let byte = |blend: &f64| (blend.clamp(0.0, 1.0) * 255.0).round() as u8;
    Reach {
        surface,
        segments: line(positions, triangles, blend),
        influence: blend.iter().map(byte).collect(),
    }
}

/// The line where values at vertices are a half, by linear interpolation.
fn line(positions: &[DVec3], triangles: &[[u32; 3]], values: &[f64]) -> Vec<[DVec3; 2]> {
    let cut = |triangle: &[u32; 3]| {
        let sides = [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|k: usize| triangle[k] as usize));
        let mut ends = sides.into_iter().filter_map(|[a, b]| {
            let (from, to) = (values[a] - HALF, values[b] - HALF);
            ((from < 0.0) != (to < 0.0)).then(|| positions[a].lerp(positions[b], from / (from - to)))
        });
        Some([ends.next()?, ends.next()?])
    };
    triangles.iter().filter_map(cut).collect()
}
