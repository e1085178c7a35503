//! What the length of a curve costs: tension, and a rope that is slack on ordinary shapes.
//!
//! `∫ κ² ds` favours growth: a span pushed far enough escapes to a loop of any size, since a circle of radius R costs 2π/R;
//! `∫ (κ')² ds` favours it still more. A rope holds them: length beyond `L0`, a multiple of the control polygon, is
//! priced by `w (L / L0 - 1)²`. It is exactly zero on every shape that stays near its control points. (Ours; the thesis
//! lets such curves run away.)

use crate::objective::Objective;

/// Weight of the rope: ten times what a free circle gains by growing, so that it overshoots `L0` by 5 %.
const ROPE: f64 = 400.0;
/// The same for `∫ (κ')² ds`, of which a loop that waves once round, κ = (2π/L)(1 + cos), has `(2π)⁴ / 2L³`.
const FAIR_ROPE: f64 = 24_000.0;

/// What length costs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Price {
    /// Per length.
    pub(super) tension: f64,
    /// Length beyond which the rope pulls; infinite for none.
    pub(super) reference: f64,
    /// Weight of the rope.
    rope: f64,
}

impl Price {
    /// The price under an objective: its rope scales as its energy does.
    pub(super) fn new(objective: Objective, tension: f64, reference: f64) -> Self {
        match objective {
            Objective::ThinPlate | Objective::Neutral => Self { tension, reference, rope: ROPE / reference },
            Objective::Fair => {
                Self { tension, reference, rope: FAIR_ROPE / (reference * reference * reference) }
            }
            // Its whole energy, and nothing that grows.
            Objective::Membrane => Self { tension: tension + 1.0, reference: f64::INFINITY, rope: 0.0 },
        }
    }

    fn excess(&self, length: f64) -> f64 {
        (length / self.reference - 1.0).max(0.0)
    }

    /// The price of a length.
    pub(super) fn value(&self, length: f64) -> f64 {
        let excess = self.excess(length);
        let rope = if excess > 0.0 { self.rope * excess * excess } else { 0.0 };
        self.tension * length + rope
    }

    /// Derivative with respect to the length: the pull on every edge.
    pub(super) fn slope(&self, length: f64) -> f64 {
        let excess = self.excess(length);
        let rope = if excess > 0.0 { 2.0 * self.rope / self.reference * excess } else { 0.0 };
        self.tension + rope
    }

    /// Second derivative with respect to the length.
    pub(super) fn curvature(&self, length: f64) -> f64 {
        if self.excess(length) > 0.0 { 2.0 * self.rope / (self.reference * self.reference) } else { 0.0 }
    }
}
