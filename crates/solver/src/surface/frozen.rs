//! The frozen linearisation of the thesis, for comparison with the exact gradient; no shape is made by it.
//!
//! Source: recipe section 0, after Welch 1995, sections 5.3.3 and 5.4. Normals, areas and the parameterisation are held
//! fixed when the energy is differentiated. With `Z` as in the assembly, an offset `alpha_j` along the neighbour's
//! normal bends the neighbourhood of `k` by `Σ_j Z_cj (f alpha_j - alpha_k)`; the literal scheme has `f = n_j·n_k`, the
//! neutral one `f = 1`. What dropped out does not vanish at the solution, so each comes to rest on a surface of its own.
//! There is no energy that falls on the way, hence no line search: steps are only kept short.

use glam::DVec3;

use super::{SurfaceSolver, mass};
use crate::cg::{self, Limit};
use crate::error::{SolverError, check_positions};
use crate::fit;
use crate::neighbourhood::Ring;
use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

/// What an offset of a neighbour counts in the frozen linearisation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frozen {
    /// Its part along the normal of the centre, as in the thesis: spheres shrink, cylinders pinch.
    Literal,
    /// All of it: spheres and cylinders are solutions.
    Neutral,
}

/// Longest move of a node in one step, in units of its mean edge.
const LONGEST_MOVE: f64 = 0.5;
/// Each linear system is solved to the end: the comparison is about where the scheme rests.
const LIMIT: Limit = Limit { iterations: 1000, tolerance: 1e-10 };

/// How every neighbourhood is bent, and how offsets bend it further; all times `√a`.
struct Bending<'a> {
    rings: &'a Rings,
    /// `L`, per node.
    now: Vec<[f64; 3]>,
    /// By an offset of the centre, per node.
    centre: Vec<[f64; 3]>,
    /// By an offset of a neighbour, per spoke.
    neighbour: Vec<[f64; 3]>,
}

impl<'a> Bending<'a> {
    fn new(rings: &'a Rings, positions: &[DVec3], normals: &[DVec3], kind: Frozen) -> Self {
        let mut bending = Self {
            rings,
            now: vec![[0.0; 3]; rings.len()],
            centre: vec![[0.0; 3]; rings.len()],
            neighbour: vec![[0.0; 3]; rings.spokes()],
        };
        let mut ring = Ring::<f64>::default();
        for (node, index) in (0..rings.len()).zip(0_u32..) {
            ring.load(rings, positions, [index; 2]);
            let careful = fit::fit_carefully(&mut ring);
            if !careful.is_fitted() {
                continue;
            }
            let (fit, root) = (&careful.fit, careful.fit.area.sqrt());
            bending.now[node] = fit.l.map(|l| root * l);
            for (j, slot) in rings.slots(node).enumerate() {
                let basis = ring.basis(ring.uv(j));
                let factor = match kind {
                    Frozen::Literal => normals[rings.ring(node)[j] as usize].dot(normals[node]),
                    Frozen::Neutral => rings.sense(slot),
                };
                for c in 0..3 {
                    let z: f64 = fit.inverse[c + 2].iter().zip(&basis).map(|(weight, b)| weight * b).sum();
                    let z = root * z / (ring.h * ring.h);
                    bending.centre[node][c] -= z;
                    bending.neighbour[slot][c] = factor * z;
                }
            }
        }
        bending
    }

    /// What offsets add to `L`, per node.
    fn of(&self, offsets: impl Fn(usize) -> f64) -> Vec<[f64; 3]> {
        let bend = |node: usize| {
            let mut sum = self.centre[node].map(|value| value * offsets(node));
            for (slot, &far) in self.rings.slots(node).zip(self.rings.ring(node)) {
                let offset = offsets(far as usize);
                for c in 0..3 {
                    sum[c] += self.neighbour[slot][c] * offset;
                }
            }
            sum
        };
        (0..self.rings.len()).map(bend).collect()
    }

    /// The transpose: what a price on bending is as a price on offsets.
    fn back(&self, prices: &[[f64; 3]], mut add: impl FnMut(usize, f64)) {
        let dot = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        for (node, price) in prices.iter().enumerate() {
            add(node, dot(&self.centre[node], price));
            for (slot, &far) in self.rings.slots(node).zip(self.rings.ring(node)) {
                add(far as usize, dot(&self.neighbour[slot], price));
            }
        }
    }

    /// `y = (rowsᵀ rows + mass) x` over the unknowns.
    fn multiply(&self, unknowns: &Unknowns, mass: &[f64], x: &[f64], y: &mut [f64]) {
        for ((y, x), mass) in y.iter_mut().zip(x).zip(mass) {
            *y = mass * x;
        }
        let bend = self.of(|node| match unknowns.index[node] {
            FIXED => 0.0,
            index => x[index as usize],
        });
        self.back(&bend, |node, value| {
            if unknowns.index[node] != FIXED {
                y[unknowns.index[node] as usize] += value;
            }
        });
    }
}

impl SurfaceSolver {
    /// Derivative of the energy along every node's normal in the newest fit, by the frozen linearisation; energy per
    /// length. The barrier is left out.
    pub fn frozen_slopes(&self, kind: Frozen) -> Vec<f64> {
        let bending = Bending::new(&self.rings, &self.fits.positions, &self.normals, kind);
        let mut slopes = vec![0.0; self.rings.len()];
        bending.back(&bending.now, |node, value| slopes[node] += 2.0 * value);
        slopes
    }

    /// One step towards the fixed point of the frozen linearisation. Returns the largest move in units of the mean
    /// edge; below 1e-9 the shape rests.
    pub fn frozen_step(&mut self, positions: &mut [DVec3], kind: Frozen) -> Result<f64, SolverError> {
        check_positions(self.rings.len(), positions)?;
        self.fit_all(positions);
        self.prepare()?;
        let (fits, unknowns, settings) = (&self.fits, &self.unknowns, &self.settings);
        let looseness = self.components.looseness(positions, &self.fixed);
        let mass_of = |&node: &u32| mass(fits, &self.components, &looseness, settings, node as usize);
        let mass: Vec<f64> = unknowns.nodes.iter().map(mass_of).collect();
        let bending = Bending::new(&self.rings, positions, &self.normals, kind);
        let mut slopes = vec![0.0; self.rings.len()];
        bending.back(&bending.now, |node, value| slopes[node] += 2.0 * value);
        let rhs: Vec<f64> = unknowns.nodes.iter().map(|&node| -0.5 * slopes[node as usize]).collect();
        let mut alpha = vec![0.0; unknowns.len()];
        let outcome = cg::solve(
            |x, y| bending.multiply(unknowns, &mass, x, y),
            |r, z| self.preconditioner.apply(r, z),
            &rhs,
            &mut alpha,
            LIMIT,
            &mut self.workspace,
        );
        let relative = |(&node, alpha): (&u32, &f64)| alpha.abs() / fits.nodes[node as usize].h;
        let longest = unknowns.nodes.iter().zip(&alpha).map(relative).fold(0.0, f64::max);
        let scale = if longest > LONGEST_MOVE { LONGEST_MOVE / longest } else { 1.0 };
        for (&node, alpha) in unknowns.nodes.iter().zip(&alpha) {
            positions[node as usize] += self.normals[node as usize] * (scale * alpha);
        }
        self.served(outcome.iterations);
        self.stir();
        Ok(longest * scale)
    }
}

#[cfg(test)]
mod tests {
    use super::Frozen;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// On the unit sphere the literal scheme pulls inward by 4 per area; the neutral one holds still (recipe, section 0).
    #[test]
    fn a_sphere_shrinks_in_the_literal_scheme_and_rests_in_the_neutral_one() {
        let sphere = workload::sphere(3);
        let mut solver = sphere.solver().unwrap();
        solver.fit_all(&sphere.positions);
        let area: f64 = solver.figures().iter().map(|f| f.area).sum();
        let total = |kind| solver.frozen_slopes(kind).iter().sum::<f64>() / area;
        assert!((total(Frozen::Literal) - 4.0).abs() < 0.1, "{}", total(Frozen::Literal));
        assert!(total(Frozen::Neutral).abs() < 1e-12, "{}", total(Frozen::Neutral));
    }

    #[test]
    fn both_come_to_rest_on_a_raised_disc_above_the_least_energy() {
        let (mut solver, mut positions) = workload::raised_disc(8, 0.5).unwrap();
        workload::relax(&mut solver, &mut positions, 40).unwrap();
        let least = solver.energy();
        for kind in [Frozen::Neutral, Frozen::Literal] {
            let (mut solver, mut positions) = workload::raised_disc(8, 0.5).unwrap();
            let rests = (0..200).any(|_| solver.frozen_step(&mut positions, kind).unwrap() < 1e-9);
            assert!(rests, "{kind:?}");
            solver.fit_all(&positions);
            assert!(solver.energy() > least * (1.0 - 1e-6), "{kind:?}: {} below {least}", solver.energy());
        }
    }
}
