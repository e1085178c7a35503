//! The linear systems of a curve: offsets in the normal planes, and scalar fields for the predictor.
//!
//! Rows of a hinge, scaled by `√ds`: `Σ_j z_j (R_ij alpha_j - alpha_i) + κ (κ·alpha_i)` with `z = 2 / (r S)`; of `fair` the
//! differences of two neighbours' rows, of `neutral` without the last term. Frames are transported along the curve
//! without twist, so that `R_ij` is the identity except where a closed curve meets itself. Five diagonals (seven for
//! `fair`) but for that corner; factorised directly. Entries grow like the fourth (sixth) power of the number of nodes
//! between two control points: beyond some thousand (some hundred, for `fair`: 1500) digits run out.

use glam::DVec3;

use super::bends::Bends;
use super::fair::{Link, links};
use super::hinge::Hinge;
use super::objective::Character;
use super::{Chain, Solved};
use crate::factor::Cholesky;
use crate::objective::Objective;
use crate::operator::{FIXED, Unknowns};

/// Relative shift of the diagonal; curves of thousands of nodes are conditioned like `n⁴`, so it has to be tiny.
const DIAGONAL_SHIFT: f64 = 1e-14;

/// Two unit vectors normal to the tangent, per node.
#[derive(Clone, Debug, Default)]
pub(super) struct Frames {
    axes: Vec<[DVec3; 2]>,
}

impl Frames {
    /// Transports the first frame along the curve without twist.
    pub(super) fn transport(&mut self, chain: Chain, bends: &Bends) {
        self.axes.clear();
        for node in 0..chain.count {
            let tangent = bends.tangents[node];
            let carried = match self.axes.last() {
                Some(&[axis, _]) => turn(axis, bends.tangents[node - 1], tangent),
                None => tangent.any_orthonormal_vector(),
            };
            // Against drift, and for a tangent that turned back on itself.
            let flat = carried - tangent * carried.dot(tangent);
            let axis = flat.try_normalize().unwrap_or_else(|| tangent.any_orthonormal_vector());
            self.axes.push([axis, tangent.cross(axis)]);
        }
    }

    /// `R`: the frame of `from` seen in that of `to`, after the smallest turn of its tangent.
    fn relation(&self, bends: &Bends, from: usize, to: usize) -> [[f64; 2]; 2] {
        let turned = self.axes[from].map(|axis| turn(axis, bends.tangents[from], bends.tangents[to]));
        self.axes[to].map(|axis| [axis.dot(turned[0]), axis.dot(turned[1])])
    }
}

/// Turns `vector` by the smallest rotation that takes the unit vector `from` to `to`.
fn turn(vector: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let sum = from + to;
    let scale = sum.length_squared();
    if scale < 1e-12 {
        return vector;
    }
    // Two reflections: in the plane normal to `from`, then in the one normal to from + to.
    let reflected = vector - from * (2.0 * vector.dot(from));
    reflected - sum * (2.0 * reflected.dot(sum) / scale)
}

/// A sparse symmetric system over the free nodes, `width` unknowns each.
#[derive(Clone, Debug)]
pub(super) struct System {
    unknowns: Unknowns,
    /// The nodes whose unknowns are not offsets but turns of their tangent (see `network`).
    turns: Vec<bool>,
    width: usize,
    /// Upper triangle by columns.
    starts: Vec<u32>,
    rows: Vec<u32>,
    values: Vec<f64>,
    cholesky: Cholesky,
    solution: Vec<f64>,
}

/// The centre of a hinge and its two neighbours, with the scalar weights of their rows. On the side of a clamp the
/// centre stands again, without weight. Where the tangent of a clamp may turn, its turn takes the place of the centre.
struct Stencil<'a> {
    hinge: &'a Hinge,
    nodes: [usize; 3],
    weights: [f64; 3],
    /// What the rows are scaled by.
    root: f64,
    is_turning: bool,
}

impl<'a> Stencil<'a> {
    /// Rows scaled by the square root of the hinge's length.
    fn new(hinge: &'a Hinge) -> Option<Self> {
        Self::scaled(hinge, hinge.ds.sqrt(), false)
    }

    fn scaled(hinge: &'a Hinge, root: f64, is_turning: bool) -> Option<Self> {
        if !hinge.is_sound {
            return None;
        }
        let scale = root / hinge.ds;
        let weight = |side: Option<usize>, r: f64| if side.is_some() { scale / r } else { 0.0 };
        let behind = weight(hinge.before, hinge.r_behind);
        let ahead = weight(hinge.after, hinge.r_ahead);
        let nodes = [hinge.node, hinge.before.unwrap_or(hinge.node), hinge.after.unwrap_or(hinge.node)];
        let centre = match (is_turning, hinge.before) {
            (false, _) => -(behind + ahead),
            // κ = (a - t) / ds or (t - b) / ds, and t is what changes.
            (true, None) => -scale,
            (true, Some(_)) => scale,
        };
        Some(Self { hinge, nodes, weights: [centre, behind, ahead], root, is_turning })
    }
}

impl System {
    /// For `width` unknowns at each free node, whose rows reach so many nodes to either side. The tangents of the fixed
    /// nodes `turning`, which must be clamps, are unknowns too.
    #[expect(clippy::cast_possible_truncation, reason = "seven blocks per node of a curve")]
    pub(super) fn new(
        chain: Chain,
        fixed: &[bool],
        turning: &[usize],
        width: usize,
        reach: usize,
    ) -> Solved<Self> {
        let mut turns = vec![false; fixed.len()];
        for &node in turning {
            turns[node] = true;
        }
        let unknowns = Unknowns::new(fixed.iter().zip(&turns).map(|(fixed, turns)| !fixed || *turns));
        let (mut starts, mut rows) = (vec![0_u32], Vec::new());
        let mut near = Vec::new();
        for &node in &unknowns.nodes {
            near.clear();
            near.push(node as usize);
            for _ in 0..reach {
                for i in 0..near.len() {
                    let node = near[i];
                    let ends = chain.neighbours(node).or_else(|| end_neighbour(chain, node));
                    near.extend(ends.into_iter().flat_map(|(a, b)| [a, b]));
                }
                near.sort_unstable();
                near.dedup();
            }
            let mut columns: Vec<u32> =
                near.iter().map(|&node| unknowns.index[node]).filter(|&index| index != FIXED).collect();
            columns.sort_unstable();
            let column = unknowns.index[node as usize];
            for inner in 0..width as u32 {
                let scalar = column * width as u32 + inner;
                let entries = columns
                    .iter()
                    .flat_map(|&other| (0..width as u32).map(move |i| other * width as u32 + i));
                rows.extend(entries.filter(|&row| row <= scalar));
                starts.push(rows.len() as u32);
            }
        }
        let cholesky = Cholesky::new(starts.clone(), rows.clone())?;
        let values = vec![0.0; rows.len()];
        let solution = vec![0.0; unknowns.len() * width];
        Ok(Self { unknowns, turns, width, starts, rows, values, cholesky, solution })
    }

    /// Solves `A alpha = -g/2` and returns the slope `g·alpha`.
    pub(super) fn newton(
        &mut self,
        chain: Chain,
        bends: &Bends,
        frames: &Frames,
        character: Character,
        gradient: &[DVec3],
        mass: f64,
    ) -> Solved<f64> {
        self.values.fill(0.0);
        match character.objective {
            Objective::ThinPlate => self.bend(bends, frames, 1.0, true),
            Objective::Neutral => self.bend(bends, frames, 1.0, false),
            Objective::Fair => {
                self.bend(bends, frames, character.share, true);
                self.vary(chain, bends, frames);
            }
            Objective::Membrane => {}
        }
        let price = character.price;
        let pull = price.slope(bends.length);
        if pull > 0.0 {
            self.stretch(chain, bends, frames, pull);
        }
        self.finish(|node| mass * bends.ds[node])?;
        let rhs = self.project(frames, gradient, -0.5);
        let mut solution = std::mem::take(&mut self.solution);
        solution.copy_from_slice(&rhs);
        self.solve(chain, bends, frames, character, &mut solution);
        self.solution = solution;
        Ok(-2.0 * crate::cg::dot(&rhs, &self.solution))
    }

    /// `A⁻¹ x` for the matrix of the last [`Self::newton`], rope and all.
    fn solve(&mut self, chain: Chain, bends: &Bends, frames: &Frames, character: Character, x: &mut [f64]) {
        self.cholesky.solve(x);
        let stiffness = 0.5 * character.price.curvature(bends.length);
        if stiffness > 0.0 {
            self.correct_for_rope(chain, bends, frames, stiffness, x);
        }
    }

    /// How the unknowns of the last [`Self::newton`] answer to a couple that turns the tangent of a node towards `along`.
    pub(super) fn answer(
        &mut self,
        (chain, bends, frames, character): (Chain, &Bends, &Frames, Character),
        node: usize,
        along: DVec3,
    ) -> Vec<f64> {
        let mut x = vec![0.0; self.solution.len()];
        let place = self.unknowns.index[node] as usize * self.width;
        for (value, axis) in x[place..].iter_mut().zip(frames.axes[node]) {
            *value = axis.dot(along);
        }
        self.solve(chain, bends, frames, character, &mut x);
        x
    }

    /// How far an answer turns the tangent of a node towards `along`.
    pub(super) fn turn_of(&self, answer: &[f64], frames: &Frames, node: usize, along: DVec3) -> f64 {
        let place = self.unknowns.index[node] as usize * self.width;
        answer[place..].iter().zip(frames.axes[node]).map(|(value, axis)| value * axis.dot(along)).sum()
    }

    /// The unknowns of the last solve.
    pub(super) fn solution(&self) -> &[f64] {
        &self.solution
    }

    /// Adds a multiple of an answer to the last solution.
    pub(super) fn add_answer(&mut self, answer: &[f64], factor: f64) {
        for (x, answer) in self.solution.iter_mut().zip(answer) {
            *x += factor * answer;
        }
    }

    /// Where the offset of a node stands among the unknowns.
    fn place(&self, node: usize) -> u32 {
        if self.turns[node] { FIXED } else { self.unknowns.index[node] }
    }

    /// Where what a stencil acts on stands among the unknowns.
    fn places(&self, stencil: &Stencil<'_>) -> [u32; 3] {
        let [centre, before, after] = stencil.nodes;
        let own = if stencil.is_turning { self.unknowns.index[centre] } else { self.place(centre) };
        [own, self.place(before), self.place(after)]
    }

    /// The rows of `∫ κ² ds`, each squared `share` times, with or without the answer of the curvature at the centre itself.
    fn bend(&mut self, bends: &Bends, frames: &Frames, share: f64, is_whole: bool) {
        for hinge in &bends.hinges {
            let root = if share == 1.0 { hinge.ds.sqrt() } else { (share * hinge.ds).sqrt() };
            let Some(stencil) = Stencil::scaled(hinge, root, self.turns[hinge.node]) else { continue };
            let blocks = offset_blocks(bends, frames, &stencil, is_whole);
            self.add_products(&self.places(&stencil), &blocks);
        }
    }

    /// The rows of `∫ |κ'|² ds`: what the second of two neighbours changes by, less what the first does.
    fn vary(&mut self, chain: Chain, bends: &Bends, frames: &Frames) {
        for Link { first, second, ds, .. } in links(chain, &bends.hinges) {
            let root = 1.0 / ds.sqrt();
            let rows = |hinge: usize| {
                let hinge = &bends.hinges[hinge];
                let stencil = Stencil::scaled(hinge, root, self.turns[hinge.node])?;
                let blocks = offset_blocks(bends, frames, &stencil, true);
                Some((hinge.node, self.places(&stencil), blocks))
            };
            let (Some((here, from, from_blocks)), Some((there, to, to_blocks))) = (rows(first), rows(second))
            else {
                continue;
            };
            let carry = frames.relation(bends, here, there);
            let carried = from_blocks.map(|block| negated_product(carry, block));
            let places = [from[0], from[1], from[2], to[0], to[1], to[2]];
            let [a, b, c] = carried;
            let [d, e, f] = to_blocks;
            self.add_products(&places, &[a, b, c, d, e, f]);
        }
    }

    /// A vector field seen in the frames of the free nodes.
    fn project(&self, frames: &Frames, field: &[DVec3], factor: f64) -> Vec<f64> {
        let nodes = self.unknowns.nodes.iter().map(|&node| node as usize);
        nodes.flat_map(|node| frames.axes[node].map(|axis| factor * field[node].dot(axis))).collect()
    }

    /// Second-order growth of the length under a pull: `pull |alpha_i - alpha_j|² / 2 r` per edge.
    fn stretch(&mut self, chain: Chain, bends: &Bends, frames: &Frames, pull: f64) {
        for (from, to) in chain.edges() {
            let length = bends.positions[from].distance(bends.positions[to]);
            if !(length > 0.0) {
                continue;
            }
            let root = (0.5 * pull / length).sqrt();
            let far = frames.relation(bends, to, from).map(|row| row.map(|x| x * root));
            let places = [from, to].map(|node| self.place(node));
            self.add_products(&places, &[[[-root, 0.0], [0.0, -root]], far]);
        }
    }

    /// The rope's own stiffness `s c cᵀ` with `c = dL/dalpha`, dense but of rank one (Sherman, Morrison 1950).
    fn correct_for_rope(
        &mut self,
        chain: Chain,
        bends: &Bends,
        frames: &Frames,
        stiffness: f64,
        solution: &mut [f64],
    ) {
        let mut gradient = vec![DVec3::ZERO; chain.count];
        bends.add_length_gradient(chain, 1.0, &mut gradient);
        // A turn changes no length.
        for (pull, _) in gradient.iter_mut().zip(&self.turns).filter(|(_, turns)| **turns) {
            *pull = DVec3::ZERO;
        }
        let c = self.project(frames, &gradient, 1.0);
        let mut z = c.clone();
        self.cholesky.solve(&mut z);
        let along = stiffness * crate::cg::dot(&c, solution) / (1.0 + stiffness * crate::cg::dot(&c, &z));
        for (x, z) in solution.iter_mut().zip(z) {
            *x -= along * z;
        }
    }

    /// The offsets of the last solve as vectors, per node; at a turning node how its tangent changes.
    pub(super) fn displacements(&self, frames: &Frames, count: usize) -> Vec<DVec3> {
        let mut moves = vec![DVec3::ZERO; count];
        for (alpha, &node) in self.solution.chunks_exact(2).zip(&self.unknowns.nodes) {
            let [one, other] = frames.axes[node as usize];
            moves[node as usize] = one * alpha[0] + other * alpha[1];
        }
        moves
    }

    /// Moves that make the curve taut: every edge a spring `|Δ|² / 2r + r / 2`, which is nowhere less than its length and
    /// equal to it now, so that the full step never makes the curve longer (majorise and minimise).
    pub(super) fn tighten(
        &mut self,
        chain: Chain,
        bends: &Bends,
        gradient: &[DVec3],
        mass: f64,
    ) -> Solved<Vec<DVec3>> {
        self.values.fill(0.0);
        // An edge without length would be a spring without end.
        let floor = 1e-6 * bends.length / chain.count.max(1) as f64;
        for (from, to) in chain.edges() {
            let length = bends.positions[from].distance(bends.positions[to]).max(floor);
            if length > 0.0 {
                let root = (0.5 / length).sqrt();
                let places = [from, to].map(|node| self.place(node));
                self.add_products(&places, &[[[-root, 0.0], [0.0, 0.0]], [[root, 0.0], [0.0, 0.0]]]);
            }
        }
        self.finish(|node| mass * bends.ds[node])?;
        let free = self.unknowns.len();
        let mut rhs = vec![0.0; 3 * free];
        for (unknown, &node) in self.unknowns.nodes.iter().enumerate() {
            for coordinate in 0..3 {
                rhs[coordinate * free + unknown] = -0.5 * gradient[node as usize][coordinate];
            }
        }
        self.cholesky.solve(&mut rhs);
        let mut moves = vec![DVec3::ZERO; chain.count];
        for (unknown, &node) in self.unknowns.nodes.iter().enumerate() {
            moves[node as usize] = DVec3::new(rhs[unknown], rhs[free + unknown], rhs[2 * free + unknown]);
        }
        Ok(moves)
    }

    /// Fills the free entries of `field` from its fixed ones.
    pub(super) fn carry(&mut self, hinges: &[Hinge], field: &mut [DVec3]) -> Solved<()> {
        self.values.fill(0.0);
        let free = self.unknowns.len();
        let mut rhs = vec![0.0; 3 * free];
        for hinge in hinges {
            let Some(stencil) = Stencil::new(hinge) else { continue };
            let blocks = stencil.weights.map(|weight| [[weight, 0.0], [0.0, 0.0]]);
            self.add_products(&self.places(&stencil), &blocks);
            let known = stencil.nodes.iter().zip(stencil.weights);
            let bend: DVec3 = known
                .filter(|&(&node, _)| self.unknowns.index[node] == FIXED)
                .map(|(&node, weight)| field[node] * weight)
                .sum();
            for (&node, weight) in stencil.nodes.iter().zip(stencil.weights) {
                let index = self.unknowns.index[node];
                if index != FIXED {
                    for coordinate in 0..3 {
                        rhs[coordinate * free + index as usize] -= weight * bend[coordinate];
                    }
                }
            }
        }
        self.finish(|_| 0.0)?;
        self.cholesky.solve(&mut rhs);
        for (unknown, &node) in self.unknowns.nodes.iter().enumerate() {
            field[node as usize] = DVec3::new(rhs[unknown], rhs[free + unknown], rhs[2 * free + unknown]);
        }
        Ok(())
    }

    /// Adds `rowsᵀ rows` of one stencil, whose rows act on each of these unknowns through a 2 × 2 block.
    fn add_products(&mut self, places: &[u32], blocks: &[[[f64; 2]; 2]]) {
        for (&a, block_a) in places.iter().zip(blocks) {
            for (&b, block_b) in places.iter().zip(blocks) {
                if a == FIXED || b == FIXED {
                    continue;
                }
                for i in 0..self.width {
                    for j in 0..self.width {
                        let (row, column) = (a as usize * self.width + i, b as usize * self.width + j);
                        let product = block_a[0][i] * block_b[0][j] + block_a[1][i] * block_b[1][j];
                        self.add(row, column, product);
                    }
                }
            }
        }
    }

    /// Adds to the upper triangle; what lies below it comes a second time from above.
    fn add(&mut self, row: usize, column: usize, value: f64) {
        if row > column {
            return;
        }
        let range = self.starts[column] as usize..self.starts[column + 1] as usize;
        if let Some(place) = self.rows[range.clone()].iter().position(|&other| other as usize == row) {
            self.values[range.start + place] += value;
        }
    }

    /// Shifts the diagonal, adds the mass and factorises.
    fn finish(&mut self, mass: impl Fn(usize) -> f64) -> Solved<()> {
        for (scalar, &end) in self.starts[1..].iter().enumerate() {
            // Rows are sorted, so the diagonal is the last of its column.
            let value = &mut self.values[end as usize - 1];
            let node = self.unknowns.nodes[scalar / self.width] as usize;
            // A turn is bounded by its own clamp.
            let mass = if self.turns[node] { 0.0 } else { mass(node) };
            *value = *value * (1.0 + DIAGONAL_SHIFT) + mass;
            if !(*value > 0.0) {
                *value = 1.0;
            }
        }
        self.cholesky.refactor(&self.values)
    }
}

/// At the end of an open curve the one neighbour, twice.
fn end_neighbour(chain: Chain, node: usize) -> Option<(usize, usize)> {
    let other = if node > 0 { node - 1 } else { 1 };
    (other < chain.count).then_some((other, other))
}

/// The 2 × 2 blocks of a stencil: transported neighbours, and the centre with its `κ κᵀ` if that is wanted.
fn offset_blocks(
    bends: &Bends,
    frames: &Frames,
    stencil: &Stencil<'_>,
    is_whole: bool,
) -> [[[f64; 2]; 2]; 3] {
    let [centre, before, after] = stencil.nodes;
    let scaled =
        |from: usize, weight: f64| frames.relation(bends, from, centre).map(|row| row.map(|x| x * weight));
    let mut own = [[stencil.weights[0], 0.0], [0.0, stencil.weights[0]]];
    if is_whole && !stencil.is_turning {
        let kappa = frames.axes[centre].map(|axis| axis.dot(stencil.hinge.curvature));
        for i in 0..2 {
            for j in 0..2 {
                own[i][j] += stencil.root * kappa[i] * kappa[j];
            }
        }
    }
    [own, scaled(before, stencil.weights[1]), scaled(after, stencil.weights[2])]
}

/// `-A B`.
fn negated_product(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    a.map(|row| [0, 1].map(|j| -(row[0] * b[0][j] + row[1] * b[1][j])))
}
