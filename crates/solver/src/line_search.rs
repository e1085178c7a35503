//! How far to go along a direction: a mesh-independent clamp, then halving on the true discrete energy.
//!
//! Source: recipe section 4. The first scale keeps every offset below half a radius of curvature and every edge's
//! shear below one half; "half an edge length" would cost twice the steps on fine meshes, and no clamp at all can
//! land in a wrong basin. Senses enter where offsets of neighbours are compared.

use glam::DVec3;

use crate::fits::{Fits, Wanted};
use crate::objective::Goals;
use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

/// Halvings before the direction is given up.
const MAX_HALVINGS: u32 = 20;
/// Share of the linear decrease that is asked for (Armijo).
const SUFFICIENT: f64 = 1e-4;

/// Largest factor by which the thin plate's energy may rise in a step that does not seek to lower it.
const RISE: f64 = 2.0;

/// The result of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Found {
    pub(crate) scale: f64,
    pub(crate) halvings: u32,
    pub(crate) is_accepted: bool,
}

/// The largest scale the clamp allows.
pub(crate) fn first_scale(rings: &Rings, fits: &Fits, unknowns: &Unknowns, alpha: &[f64]) -> f64 {
    let offset = |node: usize| match unknowns.index[node] {
        FIXED => 0.0,
        index => alpha[index as usize],
    };
    let mut worst = 0.5_f64;
    // What is not fitted does not move, nor do its edges to what is not fitted either.
    fits.each(|node| worst = worst.max(offset(node).abs() * fits.nodes[node].curvature().largest()));
    fits.each(|from| {
        for (slot, to) in rings.edges_from(from) {
            let shear = (offset(from) - rings.sense(slot) * offset(to)).abs();
            let length = fits.lengths[slot];
            // An edge of no length would stop everything; measure it by its ring instead.
            worst = worst.max(shear / length.max(0.1 * fits.nodes[from].h).max(f64::MIN_POSITIVE));
        }
    });
    0.5 / worst
}

/// A direction and where it starts.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Search<'a> {
    pub(crate) goals: &'a Goals,
    pub(crate) rings: &'a Rings,
    pub(crate) unknowns: &'a Unknowns,
    pub(crate) fits: &'a Fits,
    /// Offset along the normal, per unknown.
    pub(crate) alpha: &'a [f64],
    /// `g·alpha`, negative.
    pub(crate) slope: f64,
    /// What will be asked of the accepted fits.
    pub(crate) wanted: Wanted,
}

impl Search<'_> {
    /// Searches along `p + s alpha n` for a lower energy. On success `trial` holds the fits at the accepted positions.
    pub(crate) fn by_energy(&self, positions: &mut [DVec3], trial: &mut Fits) -> Found {
        self.halve(positions, trial, |trial, scale| {
            trial.energy <= self.fits.energy + SUFFICIENT * scale * self.slope
        })
    }

    /// The same where no energy falls: the slope along the direction has to become less, on either side of zero.
    ///
    /// The thin plate's energy may rise on the way, but not far: that would be a fold.
    pub(crate) fn by_slope(
        &self,
        positions: &mut [DVec3],
        trial: &mut Fits,
        mut slope_of: impl FnMut(&Fits) -> f64,
    ) -> Found {
        self.halve(positions, trial, |trial, scale| {
            trial.energy <= RISE * self.fits.energy + 1.0
                && slope_of(trial).abs() <= (1.0 - SUFFICIENT * scale) * self.slope.abs()
        })
    }

    fn halve(
        &self,
        positions: &mut [DVec3],
        trial: &mut Fits,
        mut is_good: impl FnMut(&Fits, f64) -> bool,
    ) -> Found {
        let mut scale = first_scale(self.rings, self.fits, self.unknowns, self.alpha);
        for halvings in 0..=MAX_HALVINGS {
            self.fits.copy_positions(positions);
            for (&node, &alpha) in self.unknowns.nodes.iter().zip(self.alpha) {
                positions[node as usize] += self.fits.nodes[node as usize].normal * (scale * alpha);
            }
            // With what comes next in mind: most first trials are accepted.
            trial.refit(self.rings, self.goals, positions, self.wanted);
            if is_good(trial, scale) {
                return Found { scale, halvings, is_accepted: true };
            }
            scale *= 0.5;
        }
        Found { scale: 0.0, halvings: MAX_HALVINGS, is_accepted: false }
    }
}
