//! Where the bending of a surface is sampled: which part of a triangle the fit of each of its corners stands for.
//!
//! The recipe (section 2) gives every triangle to its corners in equal parts. A node on a rim has half a ring, which holds three
//! numbers surely: the slopes and the bend along the rim. Its energy lacks the twist `2 L12²`, so where a shape twists
//! along its rim the energy misses a strip half an edge wide: an error of first order. A sample of the whole form a little
//! farther in is off by `O(h)`, which over a strip of width `O(h)` is of second order. So a triangle is divided among those of
//! its corners that are not on a *held rim*:
//!
//! ```text
//! other corner   1 + (1 - τ) rim / other       thirds of the triangle, with so many corners of either kind
//! on the rim     τ                             or 1, where all corners are on it
//! ```
//!
//! A node is on a held rim when it is fixed and so are its neighbours along the rim: what holds it is the curve, and no fit of
//! its own is needed for that. A rim that is free, or held by single points, is held by its own bending: sampled from inside
//! it would be soft, by ever so much more the finer the mesh (beside a single inner row the two rims of a band
//! could even wave in step, unseen). It keeps its thirds, and the first order. So do triangles with all corners on the rim, as in
//! a strip one triangle wide. A node with a prescribed tangent plane has a whole second fundamental form wherever it
//! lies (see `clamp`) and counts as inside. `τ =` [`KEPT`] only keeps the areas positive.
//!
//! All of it follows from the connectivity and from what is fixed, so that the shares are constants of the energy.

use crate::lanes::Real;
use crate::neighbourhood::{Ring, gaps};
use crate::rings::Rings;

/// Where the bending of a surface with rims is sampled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sampling {
    /// At every node alike: the energy of the recipe and of recorded figures.
    #[default]
    Everywhere,
    /// Not on rims that are held, for an error of second order where a shape twists along them.
    Inside,
}

/// What a corner on a held rim keeps of its third of a triangle that has other corners.
const KEPT: f64 = 1e-3;

/// The shares of one connectivity.
#[derive(Clone, Debug)]
pub(crate) struct Shares {
    /// Per spoke the share of its node in the triangle between it and the next spoke, in thirds.
    of_gap: Vec<f64>,
    /// Per node whether all of its shares are one third.
    is_even: Vec<bool>,
}

impl Shares {
    /// None where every share is one third. `is_whole` says of a node that its fit holds the whole second fundamental form
    /// even on the rim.
    pub(crate) fn new(
        rings: &Rings,
        fixed: &[bool],
        sampling: Sampling,
        is_whole: impl Fn(usize) -> bool,
    ) -> Option<Self> {
        if sampling == Sampling::Everywhere {
            return None;
        }
        let is_held = |node: usize| {
            let ring = rings.ring(node);
            let ends = [ring.first(), ring.last()];
            fixed[node] && ends.into_iter().all(|end| end.is_some_and(|&end| fixed[end as usize]))
        };
        let is_rim = |node: usize| rings.is_boundary(node) && is_held(node) && !is_whole(node);
        let is_rim: Vec<bool> = (0..rings.len()).map(is_rim).collect();
        if !is_rim.contains(&true) {
            return None;
        }
        let mut of_gap = vec![1.0; rings.spokes()];
        let mut is_even = vec![true; rings.len()];
        for node in 0..rings.len() {
            let ring = rings.ring(node);
            let gaps = gaps(ring.len(), rings.is_boundary(node));
            for (j, share) in of_gap[rings.slots(node)].iter_mut().enumerate().take(gaps) {
                let corners = [node, ring[j] as usize, ring[(j + 1) % ring.len()] as usize];
                let rim = corners.into_iter().filter(|&corner| is_rim[corner]).count();
                *share = match (is_rim[node], rim) {
                    (_, 3) => 1.0,
                    (true, _) => KEPT,
                    (false, _) => 1.0 + (1.0 - KEPT) * rim as f64 / (3 - rim) as f64,
                };
                is_even[node] &= *share == 1.0;
            }
        }
        Some(Self { of_gap, is_even })
    }

    /// Tells a ring, of one node per lane, its shares.
    #[inline(always)]
    pub(crate) fn load<T: Real>(&self, rings: &Rings, nodes: [u32; 2], ring: &mut Ring<T>) {
        let nodes = nodes.map(|node| node as usize);
        if nodes.iter().all(|&node| self.is_even[node]) {
            if !ring.is_even {
                ring.shares = Ring::default().shares;
                ring.is_even = true;
            }
            return;
        }
        let slots = nodes.map(|node| rings.slots(node).start);
        for (j, share) in ring.shares[..ring.degree].iter_mut().enumerate() {
            *share = T::gather(|lane| self.of_gap[slots[lane] + j]);
        }
        ring.is_even = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// What the corners of every triangle have of it together, in thirds.
    fn sums(rings: &Rings, shares: &Shares) -> Vec<f64> {
        let part = |node: u32, others: [u32; 2]| {
            let ring = rings.ring(node as usize);
            let between = |j: &usize| {
                let pair = [ring[*j], ring[(*j + 1) % ring.len()]];
                pair == others || pair == [others[1], others[0]]
            };
            let gap = (0..ring.len()).find(between).unwrap();
            shares.of_gap[rings.slots(node as usize)][gap]
        };
        let sum = |&[a, b, c]: &[u32; 3]| part(a, [b, c]) + part(b, [c, a]) + part(c, [a, b]);
        rings.triangles().iter().map(sum).collect()
    }

    #[test]
    fn corners_share_the_whole_of_every_triangle_however_rings_turn() {
        for shape in [workload::disc(4), workload::moebius(24, 4, 0.3)] {
            let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).unwrap();
            let reversed: Vec<bool> = (0..rings.len()).map(|node| node % 3 == 1).collect();
            for rings in [rings.with_reversed(&reversed), rings] {
                let shares = Shares::new(&rings, &shape.fixed, Sampling::Inside, |_| false).unwrap();
                assert!(sums(&rings, &shares).iter().all(|sum| (sum - 3.0).abs() < 1e-12));
                assert!(shares.of_gap.contains(&KEPT) && shares.of_gap.contains(&(3.0 - 2.0 * KEPT)));
            }
        }
    }

    #[test]
    fn nothing_is_shared_otherwise_without_a_rim_that_is_held() {
        let disc = workload::disc(4);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        let shares = |fixed: &[bool], sampling, is_whole| Shares::new(&rings, fixed, sampling, |_| is_whole);
        assert!(shares(&disc.fixed, Sampling::Everywhere, false).is_none());
        assert!(shares(&disc.fixed, Sampling::Inside, true).is_none());
        assert!(shares(&vec![false; rings.len()], Sampling::Inside, false).is_none());
        assert!(shares(&disc.fixed, Sampling::Inside, false).is_some());
    }
}
