//! The objectives of a curve behind one interface: what a state costs, and which way its nodes are pulled.
//!
//! Sources: recipe sections 9 and 10. Every energy has its exact derivative; `neutral` has a pull but no energy.
//!
//! | objective | least | costs nothing | degree under scaling |
//! | --- | --- | --- | --- |
//! | thin plate | `∫ κ² ds` | lines | -1 |
//! | fair | `∫ |κ'|² ds + l⁻² ∫ κ² ds` | lines; circles all but nothing | -3 and -1 |
//! | neutral | no energy: `κ'' = 0`, clothoids between the control points | lines, circles | - |
//! | membrane | length | - | 1 |
//!
//! `κ'` is the change of the curvature vector against a frame without twist, `κ'² + κ² τ²` in the letters of Frenet.

use glam::DVec3;

use super::bends::Bends;
use super::hinge::{Answer, Hinge};
use super::price::Price;
use super::{Chain, fair, neutral};
use crate::barrier;
use crate::objective::Objective;

/// Length `l` that weighs the thin plate within `fair`, in radii of the controls (recipe, section 9).
const FAIR_LENGTH: f64 = 30.0;

/// An objective with its numbers for one curve.
#[derive(Clone, Copy, Debug)]
pub(super) struct Character {
    pub(super) objective: Objective,
    pub(super) price: Price,
    /// Weight of `∫ κ² ds`.
    pub(super) share: f64,
    /// Weight of the barrier against folds.
    pub(super) fold: f64,
}

impl Default for Character {
    fn default() -> Self {
        Self { objective: Objective::ThinPlate, price: Price::default(), share: 1.0, fold: 1.0 }
    }
}

impl Character {
    /// For a curve whose controls have this radius and whose nodes would have this spacing on their polygon.
    pub(super) fn new(objective: Objective, price: Price, radius: f64, spacing: f64) -> Self {
        let (share, fold) = match objective {
            Objective::ThinPlate | Objective::Neutral => (1.0, 1.0),
            Objective::Fair if radius > 0.0 && spacing > 0.0 => {
                // The barrier is a number; the energy of one folded node is some inverse cubes of the spacing.
                let fold = 1.0 / (spacing * spacing * spacing);
                (1.0 / (FAIR_LENGTH * FAIR_LENGTH * radius * radius), fold)
            }
            Objective::Fair => (1.0, 1.0),
            // A taut string may turn at a control point as sharply as it likes.
            Objective::Membrane => (0.0, 0.0),
        };
        Self { objective, price, share, fold }
    }

    /// Mass that damps a step, for `mu` of it and a curve of this radius: scaled like the second derivative per length.
    pub(super) fn mass(&self, mu: f64, radius: f64) -> f64 {
        let squared = radius * radius;
        let scale = match self.objective {
            Objective::ThinPlate | Objective::Neutral => radius * radius * radius * radius,
            Objective::Fair => squared * squared * squared,
            Objective::Membrane => squared,
        };
        if radius > 0.0 { mu / scale } else { 0.0 }
    }
}

impl Bends {
    /// The energy of the state; of `neutral`, which has none, that of the thin plate for the figures.
    pub(super) fn value(&self, chain: Chain) -> f64 {
        let Character { share, fold, objective, price } = self.character;
        let mut energy = 0.0;
        if objective != Objective::Membrane {
            for hinge in self.hinges.iter().filter(|hinge| hinge.is_sound) {
                energy += share * hinge.bending() + fold * barrier::value(hinge.jacobian);
            }
        }
        if objective == Objective::Fair {
            energy += fair::value(chain, &self.hinges);
        }
        energy + price.value(self.length)
    }

    /// Exact `dE/dp` under an objective; of `neutral`, what it wants to vanish.
    pub(super) fn gradient(&self, chain: Chain, character: Character, gradient: &mut [DVec3]) {
        gradient.fill(DVec3::ZERO);
        if character.objective == Objective::Neutral {
            neutral::add_forces(chain, &self.hinges, gradient);
        }
        self.each_answer(chain, character, |hinge, answer| hinge.scatter(answer, gradient));
        let pull = character.price.slope(self.length);
        if pull != 0.0 {
            self.add_length_gradient(chain, pull, gradient);
        }
    }

    /// Exact `dE/dt` by the tangents of clamps: written over the entries of their nodes.
    pub(super) fn pull_on_tangents(
        &self,
        chain: Chain,
        character: Character,
        nodes: &[usize],
        pulls: &mut [DVec3],
    ) {
        nodes.iter().for_each(|&node| pulls[node] = DVec3::ZERO);
        self.each_answer(chain, character, |hinge, answer| {
            if hinge.is_clamp() && nodes.binary_search(&hinge.node).is_ok() {
                pulls[hinge.node] += if hinge.before.is_none() { answer.behind } else { answer.ahead };
            }
        });
    }

    /// What the energy feels at every hinge.
    fn each_answer(&self, chain: Chain, character: Character, mut take: impl FnMut(&Hinge, &Answer)) {
        let Character { share, fold, objective, .. } = character;
        match objective {
            Objective::ThinPlate => {
                for hinge in self.hinges.iter().filter(|hinge| hinge.is_sound) {
                    take(hinge, &hinge.bending_answer(share, fold));
                }
            }
            Objective::Fair => {
                let bars = fair::slopes(chain, &self.hinges);
                for (hinge, (binormal, mut lengths)) in self.hinges.iter().zip(bars) {
                    if hinge.is_sound {
                        lengths += hinge.bending_answer(share, fold);
                        hinge.add_binormal_answer(binormal, &mut lengths);
                        take(hinge, &lengths);
                    }
                }
            }
            Objective::Neutral => {
                for hinge in
                    self.hinges.iter().filter(|hinge| hinge.is_sound && hinge.jacobian < barrier::START)
                {
                    take(hinge, &hinge.bending_answer(0.0, fold));
                }
            }
            Objective::Membrane => {}
        }
    }
}

#[cfg(test)]
mod tests;
