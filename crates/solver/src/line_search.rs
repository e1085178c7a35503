//! How far to go along a direction: a mesh-independent clamp, then halving on the true discrete energy.
//!
//! Source: recipe section 4. The first scale keeps every offset below half a radius of curvature and every edge's
//! shear below one half; "half an edge length" would cost twice the steps on fine meshes, and no clamp at all can
//! land in a wrong basin. Senses enter where offsets of neighbours are compared.

use glam::DVec3;

use crate::fits::{Fits, Wanted};
use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

/// Halvings before the direction is given up.
const MAX_HALVINGS: u32 = 20;
/// Share of the linear decrease that is asked for (Armijo).
const SUFFICIENT: f64 = 1e-4;

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
    for (node, fit) in fits.nodes.iter().enumerate() {
        worst = worst.max(offset(node).abs() * fit.curvature().largest());
    }
    for (slot, from, to) in rings.edges() {
        let shear = (offset(from) - rings.sense(slot) * offset(to)).abs();
        let length = fits.lengths[slot];
        // An edge of no length would stop everything; measure it by its ring instead.
        worst = worst.max(shear / length.max(0.1 * fits.nodes[from].h).max(f64::MIN_POSITIVE));
    }
    0.5 / worst
}

/// Searches along `p + s alpha n`. On success `trial` holds the fits at the accepted positions.
///
/// `slope` is `g·alpha`, negative.
pub(crate) fn search(
    rings: &Rings,
    unknowns: &Unknowns,
    fits: &Fits,
    alpha: &[f64],
    slope: f64,
    trial_positions: &mut [DVec3],
    trial: &mut Fits,
) -> Found {
    let mut scale = first_scale(rings, fits, unknowns, alpha);
    for halvings in 0..=MAX_HALVINGS {
        trial_positions.copy_from_slice(&fits.positions);
        for (&node, &alpha) in unknowns.nodes.iter().zip(alpha) {
            trial_positions[node as usize] += fits.nodes[node as usize].normal * (scale * alpha);
        }
        // With the gradient, which the next step wants: most first trials are accepted.
        trial.refit(rings, trial_positions, Wanted::Gradient);
        if trial.energy <= fits.energy + SUFFICIENT * scale * slope {
            return Found { scale, halvings, is_accepted: true };
        }
        scale *= 0.5;
    }
    Found { scale: 0.0, halvings: MAX_HALVINGS, is_accepted: false }
}
