//! The state of a curve at one set of positions: its hinges, tangents, length and energy.

use glam::DVec3;

use super::Chain;
use super::hinge::{self, Hinge};
use super::objective::Character;

/// What was measured.
#[derive(Clone, Debug, Default)]
pub(super) struct Bends {
    pub(super) hinges: Vec<Hinge>,
    /// Per node: length that belongs to it, unit tangent, curvature vector (zero where it bends nowhere).
    pub(super) ds: Vec<f64>,
    pub(super) tangents: Vec<DVec3>,
    pub(super) curvatures: Vec<DVec3>,
    pub(super) positions: Vec<DVec3>,
    pub(super) energy: f64,
    pub(super) length: f64,
    pub(super) character: Character,
}

impl Bends {
    /// A curve with the tangents prescribed at some nodes, in ascending order.
    pub(super) fn new(chain: Chain, tangents: &[(usize, DVec3)]) -> Self {
        Self {
            hinges: hinge::hinges(chain, tangents),
            ds: vec![0.0; chain.count],
            tangents: vec![DVec3::X; chain.count],
            curvatures: vec![DVec3::ZERO; chain.count],
            positions: vec![DVec3::NAN; chain.count],
            energy: f64::NAN,
            length: 0.0,
            character: Character::default(),
        }
    }

    /// Gives the clamps of a node another tangent; what was measured there is out of date then.
    pub(super) fn aim(&mut self, node: usize, tangent: DVec3) {
        for hinge in self.hinges.iter_mut().filter(|hinge| hinge.node == node && hinge.is_clamp()) {
            if hinge.before.is_none() {
                hinge.behind = tangent;
            } else {
                hinge.ahead = tangent;
            }
        }
    }

    /// The hinges, with a plain one for the two at each of some clamps.
    pub(super) fn without_clamps(&self, nodes: &[usize]) -> Vec<Hinge> {
        let mut hinges: Vec<Hinge> = Vec::with_capacity(self.hinges.len());
        for hinge in &self.hinges {
            if nodes.binary_search(&hinge.node).is_err() {
                hinges.push(*hinge);
            } else if let (Some(last), Some(after)) =
                (hinges.last_mut().filter(|last| last.node == hinge.node), hinge.after)
            {
                last.after = Some(after);
                last.measure(&self.positions);
            } else {
                hinges.push(*hinge);
            }
        }
        // The end of an open curve is no hinge.
        hinges.retain(|hinge| !hinge.is_clamp() || nodes.binary_search(&hinge.node).is_err());
        hinges
    }

    /// Measures the curve and prices it.
    pub(super) fn measure(&mut self, chain: Chain, positions: &[DVec3], character: Character) {
        self.positions.copy_from_slice(positions);
        self.character = character;
        self.measure_chords(chain);
        let mut last = None;
        for hinge in &mut self.hinges {
            hinge.measure(positions);
            let node = hinge.node;
            // Both hinges of a clamp share its node.
            let is_second = last.replace(node) == Some(node);
            self.ds[node] = if is_second { self.ds[node] + hinge.ds } else { hinge.ds };
            let before = if is_second { self.curvatures[node] } else { DVec3::ZERO };
            let share = if is_second { 0.5 } else { 1.0 };
            self.curvatures[node] = (before + hinge.curvature) * share;
            if hinge.is_sound {
                self.tangents[node] = hinge.tangent();
            }
        }
        self.length = 0.0;
        for (from, to) in chain.edges() {
            self.length += positions[from].distance(positions[to]);
        }
        self.energy = self.value(chain);
    }

    /// An end of an open curve has a tangent and a length even where it is no hinge.
    fn measure_chords(&mut self, chain: Chain) {
        let ends = [0, chain.count.saturating_sub(1)];
        for node in ends.into_iter().filter(|&node| node < chain.count && chain.neighbours(node).is_none()) {
            let (from, to) = if node == 0 { (0, 1.min(chain.count - 1)) } else { (node - 1, node) };
            let chord = self.positions[to] - self.positions[from];
            self.tangents[node] = chord.try_normalize().unwrap_or(DVec3::X);
            self.curvatures[node] = DVec3::ZERO;
            self.ds[node] = 0.5 * chord.length();
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
