//! Bending of a polygon and its exact gradient.
//!
//! The quadratic through a node and its two neighbours, parameterised by chord length, has with the unit chords `a`
//! (forward) and `b` (from behind), their lengths `r₊`, `r₋` and `S = r₊ + r₋`:
//!
//! ```text
//! c_t = (r₋ a + r₊ b) / S        c_tt = 2 (a - b) / S        ds = S / 2        E_i = |c_tt|² ds = 2 |a - b|² / S
//! ```
//!
//! It is exact on circles with even spacing and blind to folds, so the barrier of the surface acts on `J = |c_t|`.
//!
//! `∫ κ² ds` favours growth: a span pushed far enough escapes to a loop of any size, since a circle of radius R costs 2π/R.
//! A rope holds it: length beyond `L0`, a multiple of the control polygon, is priced by `W / L0 (L / L0 - 1)²`. It is
//! exactly zero on every shape that stays near its control points. (Ours; the thesis lets such curves run away.)

use glam::DVec3;

use super::Chain;
use crate::barrier;

/// Weight of the rope: ten times what a free circle gains by growing, so that it overshoots `L0` by 5 %.
const ROPE: f64 = 400.0;

/// What length costs.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Price {
    /// Per length.
    pub(super) tension: f64,
    /// Length beyond which the rope pulls; infinite for none.
    pub(super) reference: f64,
}

impl Price {
    fn excess(&self, length: f64) -> f64 {
        (length / self.reference - 1.0).max(0.0)
    }

    fn value(&self, length: f64) -> f64 {
        let excess = self.excess(length);
        let rope = if excess > 0.0 { ROPE / self.reference * excess * excess } else { 0.0 };
        self.tension * length + rope
    }

    /// Derivative with respect to the length: the pull on every edge.
    pub(super) fn slope(&self, length: f64) -> f64 {
        let excess = self.excess(length);
        let rope = if excess > 0.0 { 2.0 * ROPE / (self.reference * self.reference) * excess } else { 0.0 };
        self.tension + rope
    }

    /// Second derivative with respect to the length.
    pub(super) fn curvature(&self, length: f64) -> f64 {
        let cubed = self.reference * self.reference * self.reference;
        if self.excess(length) > 0.0 { 2.0 * ROPE / cubed } else { 0.0 }
    }
}

/// What one inner node knows.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Bend {
    /// Unit chords ahead and from behind.
    pub(super) ahead: DVec3,
    pub(super) behind: DVec3,
    pub(super) r_ahead: f64,
    pub(super) r_behind: f64,
    /// Length that belongs to the node.
    pub(super) ds: f64,
    /// `|c_t|`.
    jacobian: f64,
    /// Whether the node has two chords to bend between.
    pub(super) is_inner: bool,
}

/// The state of a curve at one set of positions.
#[derive(Clone, Debug, Default)]
pub(super) struct Bends {
    pub(super) nodes: Vec<Bend>,
    pub(super) tangents: Vec<DVec3>,
    pub(super) curvatures: Vec<DVec3>,
    pub(super) positions: Vec<DVec3>,
    pub(super) energy: f64,
    pub(super) length: f64,
    pub(super) price: Price,
}

impl Bends {
    pub(super) fn new(count: usize) -> Self {
        Self {
            nodes: vec![Bend::default(); count],
            tangents: vec![DVec3::X; count],
            curvatures: vec![DVec3::ZERO; count],
            positions: vec![DVec3::NAN; count],
            energy: f64::NAN,
            length: 0.0,
            price: Price::default(),
        }
    }

    pub(super) fn measure(&mut self, chain: Chain, positions: &[DVec3], price: Price) {
        self.positions.copy_from_slice(positions);
        self.price = price;
        let mut energy = 0.0;
        for node in 0..chain.count {
            let Some((before, after)) = chain.neighbours(node) else {
                self.measure_end(chain, node);
                continue;
            };
            let (ahead, behind) = (positions[after] - positions[node], positions[node] - positions[before]);
            let (r_ahead, r_behind) = (ahead.length(), behind.length());
            let sum = r_ahead + r_behind;
            let is_inner = r_ahead > 0.0 && r_behind > 0.0;
            let mut bend = Bend { r_ahead, r_behind, ds: 0.5 * sum, is_inner, ..Bend::default() };
            if is_inner {
                (bend.ahead, bend.behind) = (ahead / r_ahead, behind / r_behind);
                let velocity = (bend.ahead * r_behind + bend.behind * r_ahead) / sum;
                bend.jacobian = velocity.length();
                self.tangents[node] = velocity.try_normalize().unwrap_or(bend.ahead);
                self.curvatures[node] = (bend.ahead - bend.behind) * (2.0 / sum);
                energy +=
                    2.0 * (bend.ahead - bend.behind).length_squared() / sum + barrier::value(bend.jacobian);
            } else {
                self.curvatures[node] = DVec3::ZERO;
            }
            self.nodes[node] = bend;
        }
        self.length = 0.0;
        for (from, to) in chain.edges() {
            self.length += positions[from].distance(positions[to]);
        }
        energy += price.value(self.length);
        self.energy = energy;
    }

    /// An end of an open curve has a tangent and a length but no curvature.
    fn measure_end(&mut self, chain: Chain, node: usize) {
        let (from, to) = if node == 0 { (0, 1.min(chain.count - 1)) } else { (node - 1, node) };
        let chord = self.positions[to] - self.positions[from];
        self.tangents[node] = chord.try_normalize().unwrap_or(DVec3::X);
        self.curvatures[node] = DVec3::ZERO;
        self.nodes[node] = Bend { ds: 0.5 * chord.length(), ..Bend::default() };
    }

    /// Exact `dE/dp`.
    pub(super) fn gradient(&self, chain: Chain, gradient: &mut [DVec3]) {
        gradient.fill(DVec3::ZERO);
        for (node, bend) in self.nodes.iter().enumerate().filter(|(_, bend)| bend.is_inner) {
            let Some((before, after)) = chain.neighbours(node) else { continue };
            let Bend { ahead: a, behind: b, r_ahead, r_behind, jacobian, .. } = *bend;
            let sum = r_ahead + r_behind;
            let difference = a - b;
            // E = 2 |a - b|² / S
            let mut a_bar = difference * (4.0 / sum);
            let mut b_bar = -a_bar;
            let along = -2.0 * difference.length_squared() / (sum * sum);
            let (mut ahead_bar, mut behind_bar) = (along, along);
            // phi(|c|), c = (r₋ a + r₊ b) / S
            let velocity = (a * r_behind + b * r_ahead) / sum;
            let slope = barrier::slope(jacobian);
            if slope != 0.0 {
                let c_bar = velocity * (slope / jacobian);
                a_bar += c_bar * (r_behind / sum);
                b_bar += c_bar * (r_ahead / sum);
                ahead_bar += c_bar.dot(b - velocity) / sum;
                behind_bar += c_bar.dot(a - velocity) / sum;
            }
            let to_after = (a_bar - a * a.dot(a_bar)) / r_ahead + a * ahead_bar;
            let to_here = (b_bar - b * b.dot(b_bar)) / r_behind + b * behind_bar;
            gradient[after] += to_after;
            gradient[node] += to_here - to_after;
            gradient[before] -= to_here;
        }
        let pull = self.price.slope(self.length);
        if pull != 0.0 {
            self.add_length_gradient(chain, pull, gradient);
        }
    }

    /// Adds `factor dL/dp`.
    pub(super) fn add_length_gradient(&self, chain: Chain, factor: f64, gradient: &mut [DVec3]) {
        for (from, to) in chain.edges() {
            let chord = self.positions[to] - self.positions[from];
            let pull = chord.try_normalize().unwrap_or(DVec3::ZERO) * factor;
            gradient[from] -= pull;
            gradient[to] += pull;
        }
    }
}
