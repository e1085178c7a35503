//! Prescribed tangent planes of a surface: taking them over and turning them. What they are: `constraint`, `clamp`.

use glam::DVec3;

use super::SurfaceSolver;
use crate::constraint::Planes;
use crate::error::SolverError;
use crate::fits::{Fits, Wanted};
use crate::objective::Goals;
use crate::quadrature::Sampling;

impl SurfaceSolver {
    /// Prescribes the tangent plane at fixed nodes, by its normal in the sense of [`SurfaceSolver::normals`]; any length but zero
    /// means the same. What was prescribed before and is not named is free. A node named twice has the last.
    ///
    /// A plane begins where the surface has it and turns by a quarter of a radian a step; no step claims rest before all are where
    /// they should be. Then the surface's quadratic at the node has that plane exactly. A membrane takes no notice: it
    /// has no bending by which a plane could hold it. Returns whether anything noticeable changed.
    ///
    /// # Errors
    /// [`SolverError`] when a node does not exist or is not fixed, or a normal is no number or has no direction; then nothing
    /// is changed.
    pub fn set_normals(&mut self, normals: &[(u32, DVec3)]) -> Result<bool, SolverError> {
        let mut planes = Planes::new(&self.rings, &self.fixed, normals)?;
        match (&mut planes, &mut self.goals.planes) {
            (None, None) => Ok(false),
            (Some(new), Some(old)) if new.is_like(old) => {
                let is_new = old.retarget(new);
                if is_new {
                    self.wake();
                    self.stir();
                }
                Ok(is_new)
            }
            (new, old) => {
                if let (Some(new), Some(old)) = (new, old) {
                    new.go_on_from(old);
                }
                self.wake();
                self.set_goals(planes);
                Ok(true)
            }
        }
    }

    /// The largest angle, in radians, by which a tangent plane is not yet where it was prescribed.
    pub fn turning(&self) -> f64 {
        self.goals.planes.as_ref().map_or(0.0, Planes::left)
    }

    /// Takes it that all planes are where they were prescribed: the positions that come next had been brought there before.
    pub fn arrive(&mut self) {
        if let Some(planes) = &mut self.goals.planes {
            planes.arrive();
            self.fits.forget();
            self.trial.forget();
        }
    }

    /// Sets up for what is minimised now, with these planes.
    pub(super) fn set_goals(&mut self, planes: Option<Planes>) {
        self.goals = Goals::new((&self.rings, &self.fixed), &self.objectives, self.settings.sampling, planes);
        self.fits = Fits::new(&self.rings, &self.goals);
        self.trial = Fits::new(&self.rings, &self.goals);
        self.damping = 1.0;
        self.stir();
    }

    /// Lets planes begin where the surface has them.
    pub(super) fn begin_planes(&mut self, positions: &[DVec3]) {
        if self.goals.planes.as_ref().is_none_or(Planes::is_begun) {
            return;
        }
        let goals = Goals::default();
        let mut fits = Fits::new(&self.rings, &goals);
        fits.refit(&self.rings, &goals, positions, Wanted::Energy);
        self.goals.planes.iter_mut().for_each(|planes| planes.begin(&fits));
        self.fits.forget();
        self.trial.forget();
    }

    /// Turns the planes of a fitted surface as far as one step may; returns whether any turned, and it must be fitted again.
    pub(super) fn turn_planes(&mut self) -> bool {
        let clamps = &self.fits.clamps;
        let has_turned = self.goals.planes.as_mut().is_some_and(|planes| planes.turn(clamps));
        if has_turned {
            self.wake();
            self.fits.forget();
            self.trial.forget();
            self.stir();
        }
        has_turned
    }

    /// Other nodes are fixed: drops the planes if a node of theirs is not, and says anew whose triangles are whose.
    pub(super) fn heed_fixed(&mut self) {
        let planes = self.goals.planes.iter().flat_map(Planes::list);
        let is_lost = planes.into_iter().any(|plane| !self.fixed[plane.node as usize]);
        if is_lost || self.settings.sampling == Sampling::Inside {
            let planes = self.goals.planes.take().filter(|_| !is_lost);
            self.set_goals(planes);
        }
    }
}
