//! The cotangent Laplacian of the free nodes, fixed nodes removed.
//!
//! Sign: positive definite, `(L x)_i = Σ_j w_ij (x_i - x_j)` with `w` = half the sum of the cotangents of the two
//! opposite angles (Pinkall, Polthier 1993), floored at 1e-3 (recipe, section 6) so that it stays an M-matrix on any
//! mesh, and capped so that a needle cannot blow up the factor. Acting on offsets along normals it reads
//! `Σ_j w_ij (x_i - s_ij x_j)` with the senses of the spokes, the same thing wherever all rings turn one way.

use glam::DVec3;

use crate::factor::{Cholesky, FactorError};
use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

const FLOOR: f64 = 1e-3;
const CAP: f64 = 1e4;

/// Which weights an edge gets.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Weights {
    /// One per edge: shape-blind, for positions that mean nothing yet.
    Uniform,
    /// Half the cotangents: follows the shape.
    #[default]
    Cotangent,
}

/// What the Laplacian acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Acting {
    /// Offsets along the normals of their own nodes.
    OnOffsets,
    /// A scalar field.
    OnField,
}

/// The Laplacian with a fixed pattern and its factor.
#[derive(Clone, Debug)]
pub(crate) struct Laplacian {
    /// Both ends of each edge, and the place of its entry in the factor's values (`None` beside a fixed node).
    edges: Vec<Edge>,
    /// Per triangle its nodes and the edges opposite them.
    triangles: Vec<([u32; 3], [u32; 3])>,
    weights: Vec<f64>,
    /// Upper triangle by columns, diagonal last.
    values: Vec<f64>,
    diagonal: Vec<u32>,
    factor: Cholesky,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    unknowns: [u32; 2],
    place: u32,
    sense: f64,
}

impl Laplacian {
    #[expect(clippy::cast_possible_truncation, reason = "spokes and nodes are counted by u32")]
    pub(crate) fn new(rings: &Rings, unknowns: &Unknowns, acting: Acting) -> Result<Self, FactorError> {
        let mut edge_of_slot = vec![FIXED; rings.spokes()];
        let mut edges = Vec::with_capacity(rings.spokes() / 2);
        let mut starts = vec![0_u32; unknowns.len() + 1];
        for (slot, from, to) in rings.edges() {
            edge_of_slot[slot] = edges.len() as u32;
            let mut pair = [unknowns.index[from], unknowns.index[to]];
            pair.sort_unstable();
            if pair[1] != FIXED {
                starts[pair[1] as usize + 1] += 1;
            }
            let sense = if acting == Acting::OnOffsets { rings.sense(slot) } else { 1.0 };
            edges.push(Edge { unknowns: pair, place: FIXED, sense });
        }
        for column in 0..unknowns.len() {
            starts[column + 1] += starts[column] + 1;
        }
        // The diagonal comes last in its column. Before it the rows ascend: edges are in order of their lower node.
        let diagonal: Vec<u32> = starts[1..].iter().map(|&end| end - 1).collect();
        let mut rows = vec![0_u32; starts[unknowns.len()] as usize];
        for (column, &place) in (0_u32..).zip(&diagonal) {
            rows[place as usize] = column;
        }
        let mut next = starts.clone();
        for edge in edges.iter_mut().filter(|edge: &&mut Edge| edge.unknowns[1] != FIXED) {
            let place = &mut next[edge.unknowns[1] as usize];
            edge.place = *place;
            rows[*place as usize] = edge.unknowns[0];
            *place += 1;
        }
        Ok(Self {
            triangles: triangles(rings, &edge_of_slot),
            weights: vec![0.0; edges.len()],
            values: vec![0.0; rows.len()],
            factor: Cholesky::new(starts, rows)?,
            edges,
            diagonal,
        })
    }

    /// Refreshes the numbers. `shift` of an unknown and its diagonal is added to the latter.
    pub(crate) fn refresh(
        &mut self,
        positions: &[DVec3],
        weights: Weights,
        shift: impl Fn(usize, f64) -> f64,
    ) -> Result<(), FactorError> {
        match weights {
            Weights::Uniform => self.weights.fill(1.0),
            Weights::Cotangent => self.cotangents(positions),
        }
        self.values.fill(0.0);
        for (edge, &weight) in self.edges.iter().zip(&self.weights) {
            for &unknown in edge.unknowns.iter().filter(|&&unknown| unknown != FIXED) {
                self.values[self.diagonal[unknown as usize] as usize] += weight;
            }
            if edge.place != FIXED {
                self.values[edge.place as usize] = -weight * edge.sense;
            }
        }
        for (unknown, &place) in self.diagonal.iter().enumerate() {
            let value = &mut self.values[place as usize];
            *value += shift(unknown, *value);
            // A free node without edges: any positive number keeps the factor alive.
            if !(*value > 0.0) {
                *value = 1.0;
            }
        }
        self.factor.refactor(&self.values)
    }

    fn cotangents(&mut self, positions: &[DVec3]) {
        self.weights.fill(0.0);
        for (nodes, opposite) in &self.triangles {
            let [a, b, c] = nodes.map(|node| positions[node as usize]);
            let sides = [c - b, a - c, b - a];
            let double_area = sides[0].cross(sides[1]).length();
            for corner in 0..3 {
                let cosine = -sides[(corner + 1) % 3].dot(sides[(corner + 2) % 3]);
                #[expect(
                    clippy::manual_clamp,
                    reason = "max and min also turn NaN into a number, clamp does not"
                )]
                let cotangent = (cosine / double_area).max(-CAP).min(CAP);
                self.weights[opposite[corner] as usize] += 0.5 * cotangent;
            }
        }
        for weight in &mut self.weights {
            *weight = weight.max(FLOOR);
        }
    }

    /// Adds `Σ_j w_ij known_j` over the fixed neighbours to every unknown: the right-hand side of a boundary value problem.
    pub(crate) fn add_fixed(&self, rings: &Rings, unknowns: &Unknowns, known: &[f64], rhs: &mut [f64]) {
        for ((_, from, to), &weight) in rings.edges().zip(&self.weights) {
            for (here, there) in [(from, to), (to, from)] {
                if unknowns.index[here] != FIXED && unknowns.index[there] == FIXED {
                    rhs[unknowns.index[here] as usize] += weight * known[there];
                }
            }
        }
    }

    /// `out = L x` over all nodes, fixed ones included.
    pub(crate) fn multiply_all(&self, rings: &Rings, x: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        for ((_, from, to), &weight) in rings.edges().zip(&self.weights) {
            let flow = weight * (x[from] - x[to]);
            out[from] += flow;
            out[to] -= flow;
        }
    }

    /// `z = L⁻¹ M L⁻¹ r` with a diagonal `M` in the factor's order.
    pub(crate) fn solve_around(&mut self, diagonal: &[f64], r: &[f64], z: &mut [f64]) {
        self.factor.solve_around(diagonal, r, z);
    }

    /// Overwrites `x` with `L⁻¹ M x` for a diagonal `M` in the factor's order.
    pub(crate) fn solve_after(&mut self, diagonal: &[f64], x: &mut [f64]) {
        self.factor.solve_after(diagonal, x);
    }

    /// One number per unknown, brought into the factor's order.
    pub(crate) fn ordered(&self, x: &[f64]) -> Vec<f64> {
        self.factor.ordered(x)
    }

    /// Overwrites `x` with `L⁻¹ x`.
    pub(crate) fn solve(&mut self, x: &mut [f64]) {
        self.factor.solve(x);
    }
}

/// Each triangle once, from its smallest node, with the edges opposite its corners.
fn triangles(rings: &Rings, edge_of_slot: &[u32]) -> Vec<([u32; 3], [u32; 3])> {
    let edge = |a: u32, b: u32| {
        let (from, to) = (a.min(b) as usize, a.max(b));
        let place = rings.ring(from).iter().position(|&far| far == to);
        place.map_or(0, |place| edge_of_slot[rings.slots(from).start + place])
    };
    let of_spoke = |node: usize, place: usize| edge_of_slot[rings.slots(node).start + place];
    let mut triangles = Vec::with_capacity(rings.triangles().len());
    for (node, index) in (0..rings.len()).zip(0_u32..) {
        let ring = rings.ring(node);
        let gaps = crate::neighbourhood::gaps(ring.len(), rings.is_boundary(node));
        for place in 0..gaps {
            let next = if place + 1 == ring.len() { 0 } else { place + 1 };
            let (b, c) = (ring[place], ring[next]);
            if index < b && index < c {
                let opposite = [edge(b, c), of_spoke(node, next), of_spoke(node, place)];
                triangles.push(([index, b, c], opposite));
            }
        }
    }
    triangles
}
