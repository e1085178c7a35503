//! The preconditioner `P⁻¹ = Lc⁻¹ Ma Lc⁻¹`: two Laplacian solves stand in for one of fourth order.
//!
//! Source: recipe section 6. `Lc` is the cotangent Laplacian of the free nodes, `Ma` their lumped areas: a thin plate
//! is about `Lc Ma⁻¹ Lc`, so conjugate gradients need 5 to 10 iterations at any size of mesh. Numbers are refreshed
//! when they served badly (more than 10 iterations) or when edges changed by more than 20 %; the ordering is made once.

use crate::factor::FactorError;
use crate::fits::Fits;
use crate::laplacian::{Acting, Laplacian, Weights};
use crate::operator::Unknowns;
use crate::rings::Rings;

/// Relative change of an edge that makes the factor stale.
const STALE_STRETCH: f64 = 0.2;
/// Relative change of an edge that makes a refresh worth trying when iterations grow.
const WORTH_STRETCH: f64 = 0.02;
/// Iterations above which the factor is suspected.
const SUSPECT_ITERATIONS: u32 = 10;

/// The preconditioner of one set of unknowns.
#[derive(Clone, Debug)]
pub(crate) struct Preconditioner {
    laplacian: Laplacian,
    /// Lumped areas, in the order of the Laplacian's factor.
    mass: Vec<f64>,
    /// Chord lengths at the last refresh; empty before the first.
    lengths: Vec<f64>,
    served_badly: bool,
    scratch: Vec<f64>,
}

impl Preconditioner {
    pub(crate) fn new(rings: &Rings, unknowns: &Unknowns, acting: Acting) -> Result<Self, FactorError> {
        let laplacian = Laplacian::new(rings, unknowns, acting)?;
        Ok(Self {
            laplacian,
            mass: Vec::new(),
            lengths: Vec::new(),
            served_badly: false,
            scratch: Vec::new(),
        })
    }

    /// Brings the factor up to date if it is stale. `shift` per unknown keeps parts without fixed nodes regular. Edges that
    /// are not fitted are as they were when the unknowns were chosen.
    pub(crate) fn prepare(
        &mut self,
        rings: &Rings,
        fits: &Fits,
        unknowns: &Unknowns,
        shift: impl Fn(usize, f64) -> f64,
    ) -> Result<(), FactorError> {
        let limit = if self.served_badly { WORTH_STRETCH } else { STALE_STRETCH };
        let is_near = |new: f64, old: f64| (new - old).abs() <= limit * old;
        let is_fresh = self.lengths.len() == fits.lengths.len()
            && !self.lengths.is_empty()
            && match &fits.active {
                Some(active) => {
                    let mut slots = active.nodes.iter().flat_map(|&node| rings.slots(node as usize));
                    slots.all(|slot| is_near(fits.lengths[slot], self.lengths[slot]))
                }
                None => fits.lengths.iter().zip(&self.lengths).all(|(&new, &old)| is_near(new, old)),
            };
        if is_fresh {
            return Ok(());
        }
        self.laplacian.refresh(&fits.positions, Weights::Cotangent, shift)?;
        self.lengths.clear();
        self.lengths.extend_from_slice(&fits.lengths);
        let mut mass: Vec<f64> = unknowns.nodes.iter().map(|&node| fits.nodes[node as usize].area).collect();
        let mean = mass.iter().sum::<f64>() / mass.len().max(1) as f64;
        // A node whose fan has no area still needs a place in the preconditioner.
        for mass in &mut mass {
            *mass = mass.max(1e-3 * mean);
        }
        self.mass = self.laplacian.ordered(&mass);
        self.served_badly = false;
        Ok(())
    }

    /// Reports how many iterations a solve to its tolerance took.
    pub(crate) fn served(&mut self, iterations: u32) {
        self.served_badly = iterations > SUSPECT_ITERATIONS;
    }

    /// `z = P⁻¹ r` where the parts between fixed nodes have equations of different orders.
    ///
    /// `order_of` gives the number of Laplacian solves and a factor for each unknown. No edge joins two free nodes of
    /// different orders, so that the solves of one part do not reach into the other.
    pub(crate) fn apply_by_order(&mut self, r: &[f64], z: &mut [f64], order_of: impl Fn(usize) -> (u8, f64)) {
        let mut now = std::mem::take(&mut self.scratch);
        now.clear();
        now.extend_from_slice(r);
        for order in 1..=3 {
            if order > 1 {
                self.laplacian.solve_after(&self.mass, &mut now);
            } else {
                self.laplacian.solve(&mut now);
            }
            let mut is_last = true;
            for (unknown, (z, &now)) in z.iter_mut().zip(&now).enumerate() {
                let (wanted, factor) = order_of(unknown);
                if wanted == order {
                    *z = now * factor;
                }
                is_last &= wanted <= order;
            }
            if is_last {
                break;
            }
        }
        self.scratch = now;
    }

    /// `z = P⁻¹ r`
    pub(crate) fn apply(&mut self, r: &[f64], z: &mut [f64]) {
        self.laplacian.solve_around(&self.mass, r, z);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fits::Wanted;
    use crate::objective::Goals;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Whether a stretch of all edges makes the numbers stale, after a solve of so many iterations.
    fn is_refreshed(stretch: f64, iterations: u32) -> bool {
        let disc = workload::disc(4);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        let goals = Goals::default();
        let unknowns = Unknowns::new(disc.fixed.iter().map(|fixed| !fixed));
        let mut preconditioner = Preconditioner::new(&rings, &unknowns, Acting::OnOffsets).unwrap();
        let mut fits = Fits::new(&rings, &goals);
        fits.refit(&rings, &goals, &disc.positions, Wanted::Energy);
        preconditioner.prepare(&rings, &fits, &unknowns, |_, _| 0.0).unwrap();
        preconditioner.served(iterations);
        let before = preconditioner.lengths.clone();
        let stretched: Vec<_> = disc.positions.iter().map(|&p| p * stretch).collect();
        fits.refit(&rings, &goals, &stretched, Wanted::Energy);
        preconditioner.prepare(&rings, &fits, &unknowns, |_, _| 0.0).unwrap();
        preconditioner.lengths != before
    }

    #[test]
    fn numbers_are_refreshed_when_edges_changed_or_when_they_served_badly() {
        assert!(!is_refreshed(1.1, 10), "it served well, and a tenth is not much");
        assert!(is_refreshed(1.1, 11), "it served badly");
        assert!(!is_refreshed(1.01, 11), "hardly anything changed: it was not the numbers' fault");
        assert!(is_refreshed(1.25, 3), "a quarter is too much");
    }
}
