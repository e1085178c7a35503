//! The variation of curvature: `E3 = Σ w [ 2 (H_j - H_i)² + 2 |q_j - e^{2iρ} q_i|² ]` over edges, about `∫ |∇L|² dA`.
//!
//! Source: recipe section 9. From the fits at both ends of an edge come the mean curvature `H = (L11 + L22) / 2` and
//! the deviator `q = (L11 - L22) / 2 + i L12`. The tangent planes are compared by parallel transport along the edge: with
//! `θ_ij` the scaled angle at which `i` sees `j`, `ρ = θ_ji + π - θ_ij`. A ring that turns the other way is read in a
//! mirror (`H → -H`, `q → -q̄`, `θ → -θ`). `w` is the cotangent weight, kept within [0.1, 2]. Spheres, cylinders and
//! planes cost nothing.
//!
//! The gradient is exact: what the edges ask of `L` and `θ` is handed to the nodes, whose own way back does the rest;
//! what they ask of `w` goes to the positions directly. The matrix is Gauss-Newton's, with `ρ` and `w` held fixed, and
//! is never assembled: it is a product of curvature rows and differences.

use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

use glam::DVec3;

use crate::fits::Node;
use crate::rings::Rings;

/// Between these the weight follows the cotangents.
const LEAST_WEIGHT: f64 = 0.1;
const MOST_WEIGHT: f64 = 2.0;

/// An edge whose ends are compared.
#[derive(Clone, Copy, Debug)]
struct Edge {
    nodes: [u32; 2],
    /// The spokes in which each end sees the other.
    slots: [u32; 2],
    /// The corners of both triangles opposite the edge.
    across: [u32; 2],
    /// Whether both rings turn the same way, +1 or -1.
    sense: f64,
    /// 1 inside, one half on the border of a region.
    share: f64,
}

/// The edges that count.
#[derive(Clone, Debug)]
pub(crate) struct Network(Arc<[Edge]>);

impl Network {
    /// Edges beside triangles of the region whose ends both lie inside the surface, or on its boundary with a prescribed plane: elsewhere a
    /// boundary does not know how it bends across.
    #[expect(clippy::cast_possible_truncation, reason = "nodes and spokes are counted by u32")]
    pub(crate) fn new(
        rings: &Rings,
        is_in_region: impl Fn(usize) -> bool,
        has_plane: impl Fn(usize) -> bool,
    ) -> Self {
        // Per spoke, how many triangles of the region lie beside it.
        let mut beside = vec![0_u32; rings.spokes()];
        let chosen = rings.triangles().iter().enumerate().filter(|&(index, _)| is_in_region(index));
        for (_, &[a, b, c]) in chosen {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let (near, far) = (from.min(to) as usize, from.max(to));
                if let Some(place) = rings.ring(near).iter().position(|&other| other == far) {
                    beside[rings.slots(near).start + place] += 1;
                }
            }
        }
        let mut edges = Vec::new();
        for (slot, from, to) in rings.edges() {
            let count = beside[slot];
            let is_open = |node: usize| rings.is_boundary(node) && !has_plane(node);
            if count == 0 || is_open(from) || is_open(to) {
                continue;
            }
            let ring = rings.ring(from);
            let place = slot - rings.slots(from).start;
            let last = ring.len() - 1;
            // An edge of the boundary has one triangle, which then speaks for both, at half the share.
            let across = match (rings.is_boundary(from), place) {
                (true, 0) => [ring[1]; 2],
                (true, place) if place == last => [ring[last - 1]; 2],
                _ => [ring[(place + last) % ring.len()], ring[(place + 1) % ring.len()]],
            };
            let Some(back) = rings.ring(to).iter().position(|&far| far as usize == from) else { continue };
            edges.push(Edge {
                nodes: [from as u32, to as u32],
                slots: [slot as u32, (rings.slots(to).start + back) as u32],
                across,
                sense: rings.sense(slot),
                share: 0.5 * f64::from(count.min(2)),
            });
        }
        Self(edges.into())
    }
}

/// What a node's fit tells its edges: `H`, and the real and imaginary part of `q`.
fn split(l: [f64; 3]) -> [f64; 3] {
    [0.5 * (l[0] + l[2]), 0.5 * (l[0] - l[2]), FRAC_1_SQRT_2 * l[1]]
}

/// The transpose: a price on these as a price on `(L11, √2 L12, L22)`.
fn join(split: [f64; 3]) -> [f64; 3] {
    [0.5 * (split[0] + split[1]), FRAC_1_SQRT_2 * split[2], 0.5 * (split[0] - split[1])]
}

/// Product of two complex numbers, the first conjugated where asked.
fn turned(by: [f64; 2], q: [f64; 2], is_back: bool) -> [f64; 2] {
    let sin = if is_back { -by[1] } else { by[1] };
    [by[0] * q[0] - sin * q[1], by[0] * q[1] + sin * q[0]]
}

/// How an edge stands at some positions.
#[derive(Clone, Copy, Debug, Default)]
struct State {
    /// `e^{2iρ}`
    turn: [f64; 2],
    /// Twice the weight times the share; zero where an end has no fit.
    weight: f64,
    is_clamped: bool,
}

impl State {
    /// The difference over the edge: far end minus the transported near end.
    fn difference(&self, edge: &Edge, near: [f64; 3], far: [f64; 3]) -> [f64; 3] {
        let carried = turned(self.turn, [near[1], near[2]], false);
        [edge.sense * far[0] - near[0], edge.sense * far[1] - carried[0], far[2] - carried[1]]
    }

    /// Its transpose: what a price on the difference asks of both ends.
    fn ends(&self, edge: &Edge, price: [f64; 3]) -> ([f64; 3], [f64; 3]) {
        let back = turned(self.turn, [price[1], price[2]], true);
        ([-price[0], -back[0], -back[1]], [edge.sense * price[0], edge.sense * price[1], price[2]])
    }
}

/// The variation of curvature at one set of positions.
#[derive(Clone, Debug)]
pub(crate) struct Variation {
    edges: Arc<[Edge]>,
    states: Vec<State>,
    /// Cosine and sine of the scaled angle, per spoke; the sweep of the fits writes them.
    pub(crate) directions: Vec<[f64; 2]>,
    /// Whether a node has a quadratic with a normal; the sweep writes it.
    pub(crate) is_fitted: Vec<bool>,
    /// Derivative with respect to `(L11, √2 L12, L22)`, per node.
    pub(crate) bending: Vec<[f64; 3]>,
    /// Derivative with respect to the scaled angle, per spoke.
    pub(crate) turning: Vec<f64>,
    /// `E3` itself.
    pub(crate) energy: f64,
    /// What it is multiplied with.
    pub(crate) scale: f64,
}

impl Variation {
    pub(crate) fn new(rings: &Rings, network: &Network) -> Self {
        Self {
            states: vec![State::default(); network.0.len()],
            edges: Arc::clone(&network.0),
            directions: vec![[1.0, 0.0]; rings.spokes()],
            is_fitted: vec![false; rings.len()],
            bending: vec![[0.0; 3]; rings.len()],
            turning: vec![0.0; rings.spokes()],
            energy: 0.0,
            scale: 1.0,
        }
    }

    /// `E3` from fits and directions that are up to date; `scale` is its price for what follows.
    pub(crate) fn measure(&mut self, positions: &[DVec3], nodes: &[Node], scale: f64) {
        (self.energy, self.scale) = (0.0, scale);
        for (edge, state) in self.edges.iter().zip(&mut self.states) {
            let [i, j] = edge.nodes.map(|node| node as usize);
            let [there, back] = edge.slots.map(|slot| self.directions[slot as usize]);
            // e^{iρ} = -e^{i s θ_ji} e^{-i θ_ij}; the sign goes in squaring.
            let rho = turned(there, [back[0], edge.sense * back[1]], true);
            let (weight, is_clamped) = weight(positions, edge);
            let has_both = self.is_fitted[i] && self.is_fitted[j];
            *state = State {
                turn: turned(rho, rho, false),
                weight: if has_both { 2.0 * weight * edge.share } else { 0.0 },
                is_clamped,
            };
            let [a, b, c] = state.difference(edge, split(nodes[i].l), split(nodes[j].l));
            self.energy += state.weight * (a * a + b * b + c * c);
        }
    }

    /// Derivatives of the priced `E3` with respect to fits and directions; those of the weights go to `gradient`.
    pub(crate) fn differentiate(&mut self, positions: &[DVec3], nodes: &[Node], gradient: &mut [DVec3]) {
        let scale = self.scale;
        self.bending.fill([0.0; 3]);
        self.turning.fill(0.0);
        for (edge, state) in self.edges.iter().zip(&self.states).filter(|(_, state)| state.weight > 0.0) {
            let [i, j] = edge.nodes.map(|node| node as usize);
            let (near, far) = (split(nodes[i].l), split(nodes[j].l));
            let difference = state.difference(edge, near, far);
            let price = difference.map(|value| 2.0 * scale * state.weight * value);
            let (at_near, at_far) = state.ends(edge, price);
            for c in 0..3 {
                self.bending[i][c] += at_near[c];
                self.bending[j][c] += at_far[c];
            }
            // d(e^{2iρ} q)/dρ = 2i e^{2iρ} q, and the difference has it with a minus.
            let carried = turned(state.turn, [near[1], near[2]], false);
            let turning = 2.0 * (price[1] * carried[1] - price[2] * carried[0]);
            self.turning[edge.slots[0] as usize] -= turning;
            self.turning[edge.slots[1] as usize] += edge.sense * turning;
            if !state.is_clamped {
                let squares: f64 = difference.iter().map(|value| value * value).sum();
                add_weight_gradient(positions, edge, 2.0 * edge.share * scale * squares, gradient);
            }
        }
        for bending in &mut self.bending {
            *bending = join(*bending);
        }
    }

    /// `prices = Dᵀ D bends` for bends and prices of `(L11, √2 L12, L22)`, per node.
    pub(crate) fn differences(&self, bends: &[[f64; 3]], prices: &mut [[f64; 3]]) {
        prices.fill([0.0; 3]);
        for (edge, state) in self.edges.iter().zip(&self.states) {
            let [i, j] = edge.nodes.map(|node| node as usize);
            let difference = state.difference(edge, split(bends[i]), split(bends[j]));
            let (at_near, at_far) =
                state.ends(edge, difference.map(|value| self.scale * state.weight * value));
            let (at_near, at_far) = (join(at_near), join(at_far));
            for c in 0..3 {
                prices[i][c] += at_near[c];
                prices[j][c] += at_far[c];
            }
        }
    }
}

/// Half the sum of the cotangents opposite an edge, kept within bounds; and whether the bounds had to act.
fn weight(positions: &[DVec3], edge: &Edge) -> (f64, bool) {
    let [i, j] = edge.nodes.map(|node| positions[node as usize]);
    let mut sum = 0.0;
    for corner in edge.across.map(|node| positions[node as usize]) {
        let (a, b) = (i - corner, j - corner);
        sum += 0.5 * a.dot(b) / a.cross(b).length();
    }
    if sum > LEAST_WEIGHT && sum < MOST_WEIGHT {
        (sum, false)
    } else if sum <= LEAST_WEIGHT {
        (LEAST_WEIGHT, true)
    } else {
        // Too large, or a triangle without area.
        (MOST_WEIGHT, true)
    }
}

/// Adds `factor dw/dp`: with `c = a·b` and `s = |a × b|`, the cotangent `c / s` of a corner.
fn add_weight_gradient(positions: &[DVec3], edge: &Edge, factor: f64, gradient: &mut [DVec3]) {
    let [i, j] = edge.nodes.map(|node| node as usize);
    for corner in edge.across.map(|node| node as usize) {
        let (a, b) = (positions[i] - positions[corner], positions[j] - positions[corner]);
        let cross = a.cross(b);
        let s = cross.length();
        let (unit, slope) = (cross / s, a.dot(b) / (s * s));
        let at_a = (b / s - b.cross(unit) * slope) * (0.5 * factor);
        let at_b = (a / s - unit.cross(a) * slope) * (0.5 * factor);
        gradient[i] += at_a;
        gradient[j] += at_b;
        gradient[corner] -= at_a + at_b;
    }
}
