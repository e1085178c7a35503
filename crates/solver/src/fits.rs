//! The fits of all nodes at one set of positions, with energy, gradient and curvature rows: one sweep makes them all.
//!
//! Fit and gradient share everything that is dear (chords, angles, the inverse), so the gradient is taken while the
//! fit is still at hand. What later work needs is kept: a short summary per node, the chord lengths, and the rows from
//! which the matrix is assembled. Two ordinary nodes go through together; a pair in which either is out of the
//! ordinary goes through one by one, with care.

mod active;
mod clamped;

pub(crate) use active::Active;

use std::sync::Arc;

use glam::DVec3;

use crate::barrier;
use crate::batch::Batch;
use crate::clamp::Clamp;
use crate::constraint::Planes;
use crate::energy::fair::Variation;
use crate::energy::thin_plate::{self, Demand};
use crate::error::{check_finite, check_positions};
use crate::fit::{self, CarefulFit, Curvature, Kind};
use crate::gradient::Backward;
use crate::lanes::{Pair, Real};
use crate::neighbourhood::Ring;
use crate::objective::Goals;
use crate::ordinary::{Ordinary, write_rows};
use crate::rings::{MAX_RING, Rings};

/// One over the area of the unit sphere.
pub(crate) const PER_SPHERE: f64 = 0.25 * std::f64::consts::FRAC_1_PI;

/// What a sweep should make.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Wanted {
    /// Fits and energy.
    #[default]
    Energy,
    /// The rows too.
    Rows,
    /// The gradient too.
    Gradient,
}

/// What is kept of a node's fit.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Node {
    pub(crate) normal: DVec3,
    /// The node's share of the parametric fan, one third where it has no part of a rim.
    pub(crate) area: f64,
    /// Mean chord.
    pub(crate) h: f64,
    /// `|s_u × s_v|`.
    pub(crate) jacobian: f64,
    /// `(L11, √2 L12, L22)`.
    pub(crate) l: [f64; 3],
}

impl Node {
    /// Mean and Gaussian curvature. The mean curvature is negative where the normal points out of a sphere.
    #[inline]
    pub(crate) fn curvature(&self) -> Curvature {
        Curvature::new(self.l)
    }
}

/// The three rows of one column of a neighbourhood's curvature, for both nodes of a batch.
pub(crate) type Row = [[f64; 2]; 3];

/// The fits of all nodes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Fits {
    pub(crate) nodes: Vec<Node>,
    /// Thin plate, as far as it counts, plus barrier, of every node; apart, because all are added up again and again.
    pub(crate) energies: Vec<f64>,
    /// Chord length per spoke.
    pub(crate) lengths: Vec<f64>,
    /// Where the fits were made.
    pub(crate) positions: Vec<DVec3>,
    /// Sum over all nodes, in index order.
    pub(crate) energy: f64,
    /// `dE/dp` of every node, if it was wanted.
    pub(crate) gradient: Vec<DVec3>,
    /// Per batch the rows `√a Z` of its neighbours; in the centre's place `√a L²`, what an offset of the node adds.
    pub(crate) rows: Vec<Row>,
    /// The variation of curvature, where it counts.
    pub(crate) variation: Option<Variation>,
    /// The fits of nodes whose tangent plane is prescribed, in the order of the planes.
    pub(crate) clamps: Vec<Clamp>,
    /// What is fitted, if some nodes are left as they are; those cannot have moved.
    pub(crate) active: Option<Arc<Active>>,
    /// What there is.
    has: Wanted,
}

/// Scratch of a sweep, and what it should make.
#[derive(Debug)]
struct Sweep<'a> {
    goals: &'a Goals,
    wanted: Wanted,
    pair: Ring<Pair>,
    pair_back: Ordinary<Pair>,
    single: Ring<f64>,
    single_back: Backward<f64>,
}

impl<'a> Sweep<'a> {
    fn new(goals: &'a Goals, wanted: Wanted) -> Self {
        Self {
            goals,
            wanted,
            pair: Ring::default(),
            pair_back: Ordinary::default(),
            single: Ring::default(),
            single_back: Backward::default(),
        }
    }
}

impl Fits {
    /// Room for one connectivity.
    pub(crate) fn new(rings: &Rings, goals: &Goals) -> Self {
        let rows = rings.batches().last().map_or(0, |batch| batch.rows().end);
        Self {
            nodes: vec![Node::default(); rings.len()],
            energies: vec![0.0; rings.len()],
            lengths: vec![0.0; rings.spokes()],
            positions: vec![DVec3::NAN; rings.len()],
            energy: f64::NAN,
            gradient: vec![DVec3::ZERO; rings.len()],
            rows: vec![Row::default(); rows],
            variation: goals.network.as_ref().map(|network| Variation::new(rings, network)),
            clamps: vec![Clamp::default(); goals.planes.as_ref().map_or(0, |planes| planes.list().len())],
            active: None,
            has: Wanted::Energy,
        }
    }

    /// Whether the newest fits are of these positions.
    pub(crate) fn are_at(&self, positions: &[DVec3]) -> bool {
        self.positions == positions
    }

    /// Fits every node, unless the last call did so at these positions.
    pub(crate) fn refit(&mut self, rings: &Rings, goals: &Goals, positions: &[DVec3], wanted: Wanted) {
        if self.are_at(positions) && wanted <= self.has {
            return;
        }
        self.has = wanted;
        let makes_gradient = wanted == Wanted::Gradient;
        self.begin(positions, makes_gradient);
        let mut others = 0.0;
        // What edges ask of the nodes at their ends is known when all nodes are fitted: that takes two sweeps.
        if self.variation.is_some() {
            let first = if makes_gradient { Wanted::Energy } else { wanted };
            self.sweep(rings, &mut Sweep::new(goals, first));
        }
        if let (Some(variation), Some(skin)) = (&mut self.variation, &goals.skin) {
            variation.measure(&self.positions, &self.nodes, skin.area(&self.positions) * PER_SPHERE);
            // A tilt against a prescribed plane is a change of curvature within one neighbourhood.
            for (plane, clamp) in goals.planes.iter().flat_map(Planes::list).zip(&self.clamps) {
                variation.energy += goals.price(plane.node as usize).variation * clamp.variation();
            }
            others += variation.energy * variation.scale;
            if makes_gradient {
                variation.differentiate(&self.positions, &self.nodes, &mut self.gradient);
                skin.add_gradient(&self.positions, variation.energy * PER_SPHERE, &mut self.gradient);
            }
        }
        if self.variation.is_none() || makes_gradient {
            self.sweep(rings, &mut Sweep::new(goals, wanted));
        }
        if let Some(film) = &goals.film {
            let price = 1.0 / (goals.radius * goals.radius);
            others += film.area(&self.positions) * price;
            if makes_gradient {
                film.add_gradient(&self.positions, price, &mut self.gradient);
            }
        }
        self.energy = self.energies.iter().sum::<f64>() + others;
        // A ring without sense counts for nothing; that must not pass for a shape without energy.
        let is_sane = match &self.active {
            Some(active) => {
                active.nodes.iter().all(|&node| check_finite(node, positions[node as usize]).is_ok())
            }
            None => check_positions(rings.len(), positions).is_ok(),
        };
        if !is_sane {
            self.energy = f64::NAN;
        }
    }

    /// Takes over the positions, and clears the gradient if it is wanted.
    fn begin(&mut self, positions: &[DVec3], makes_gradient: bool) {
        match self.active.clone() {
            Some(active) => {
                for &node in &active.nodes {
                    self.positions[node as usize] = positions[node as usize];
                }
                for &node in active.felt.iter().filter(|_| makes_gradient) {
                    self.gradient[node as usize] = DVec3::ZERO;
                }
            }
            None => {
                self.positions.copy_from_slice(positions);
                if makes_gradient {
                    self.gradient.fill(DVec3::ZERO);
                }
            }
        }
    }

    /// Fits from now on only what is active; all nodes are fitted as they stand.
    pub(crate) fn take_active(&mut self, active: Arc<Active>) {
        // What was not fitted of late may lack rows and gradient.
        if self.active.is_some() {
            self.has = Wanted::Energy;
        }
        self.active = Some(active);
    }

    /// Takes over what others know of every node, to go on with what is active. Rows and gradient are theirs alone.
    pub(crate) fn follow(&mut self, other: &Self, active: Arc<Active>) {
        if other.variation.is_some() {
            self.clone_from(other);
        } else {
            self.nodes.copy_from_slice(&other.nodes);
            self.energies.copy_from_slice(&other.energies);
            self.lengths.copy_from_slice(&other.lengths);
            self.positions.copy_from_slice(&other.positions);
            self.clamps.clone_from(&other.clamps);
            self.energy = other.energy;
        }
        self.has = Wanted::Energy;
        self.active = Some(active);
    }

    /// Takes these positions over into an array that knows those of the nodes that are not fitted.
    pub(crate) fn copy_positions(&self, into: &mut [DVec3]) {
        match &self.active {
            Some(_) => self.each(|node| into[node] = self.positions[node]),
            None => into.copy_from_slice(&self.positions),
        }
    }

    /// Calls `work` for every node that is fitted, in index order.
    #[inline]
    pub(crate) fn each(&self, mut work: impl FnMut(usize)) {
        match &self.active {
            Some(active) => active.nodes.iter().for_each(|&node| work(node as usize)),
            None => (0..self.nodes.len()).for_each(work),
        }
    }

    /// The batches in which anything can move.
    pub(crate) fn active_batches<'a>(&'a self, rings: &'a Rings) -> impl Iterator<Item = &'a Batch> {
        let batches = rings.batches();
        let active = self.active.as_ref().map(|active| &active.batches);
        let count = active.map_or(batches.len(), Vec::len);
        (0..count).map(move |place| &batches[active.map_or(place, |active| active[place])])
    }

    /// Forgets the positions, so that the next call fits whatever they are.
    pub(crate) fn forget(&mut self) {
        self.positions.fill(DVec3::NAN);
    }

    fn sweep(&mut self, rings: &Rings, sweep: &mut Sweep<'_>) {
        let active = self.active.clone();
        let active = active.as_ref().map(|active| &active.batches);
        let batches = rings.batches();
        let count = active.map_or(batches.len(), Vec::len);
        for place in 0..count {
            let batch = &batches[active.map_or(place, |active| active[place])];
            let is_done = match (batch.is_regular(), batch.is_boundary) {
                (false, _) => false,
                _ if sweep.goals.planes.is_some() && clamped::has_plane(sweep.goals, batch) => false,
                (true, false) => self.fit_pair::<5>(rings, batch, sweep),
                (true, true) => self.fit_pair::<3>(rings, batch, sweep),
            };
            if !is_done {
                for lane in 0..batch.count {
                    self.fit_single(rings, batch, lane, sweep);
                }
            }
        }
    }

    /// Both nodes of a batch at once; false, and nothing written, when either is out of the ordinary.
    #[inline(always)]
    fn fit_pair<const N: usize>(&mut self, rings: &Rings, batch: &Batch, sweep: &mut Sweep<'_>) -> bool {
        let ring = &mut sweep.pair;
        ring.load(rings, &self.positions, batch.nodes);
        sweep.goals.share(rings, batch.nodes, ring);
        if !ring.unroll() {
            return false;
        }
        let (fit, is_ordinary) = fit::fit_ordinary::<Pair, N>(ring);
        if !is_ordinary {
            return false;
        }
        let one = Pair::splat(1.0);
        let (weight, shown) =
            if sweep.goals.is_plate() { (one, one) } else { prices(sweep.goals, batch.nodes) };
        let energy = thin_plate::value(&fit) * shown;
        for lane in 0..batch.count {
            let node = batch.nodes[lane] as usize;
            self.nodes[node] = Node {
                normal: fit.normal.lane(lane),
                area: fit.area.lane(lane),
                h: ring.h.lane(lane),
                jacobian: fit.jacobian.lane(lane),
                l: fit.l.map(|l| l.lane(lane)),
            };
            self.energies[node] = energy.lane(lane);
            self.keep(rings, node, lane, ring, true);
        }
        if sweep.wanted >= Wanted::Rows {
            let rows = &mut self.rows[batch.rows()];
            write_rows::<Pair, N>(ring, &fit, |j, c, value| rows[j][c] = value.to_array());
        }
        if sweep.wanted >= Wanted::Gradient {
            let bending = self.bending::<Pair>(batch.nodes);
            let adjoint = thin_plate::normal_adjoint(&fit, ring.h, weight, bending);
            let turning = self.turning::<Pair>(rings, batch.nodes);
            sweep.pair_back.run::<N>(ring, &fit, &adjoint, turning.as_ref());
            for lane in 0..batch.count {
                let chords = sweep.pair_back.ends.iter().map(|end| end.chord.lane(lane));
                scatter(
                    &mut self.gradient,
                    rings.ring(batch.nodes[lane] as usize),
                    batch.nodes[lane],
                    chords,
                );
            }
        }
        true
    }

    /// One node of a batch, with care.
    #[inline(never)]
    fn fit_single(&mut self, rings: &Rings, batch: &Batch, lane: usize, sweep: &mut Sweep<'_>) {
        let index = batch.nodes[lane];
        let node = index as usize;
        let ring = &mut sweep.single;
        ring.load(rings, &self.positions, [index; 2]);
        sweep.goals.share(rings, [index; 2], ring);
        let careful = fit::fit_carefully(ring);
        let fit = &careful.fit;
        let price = sweep.goals.price(node);
        self.nodes[node] = Node {
            normal: fit.normal.lane(0),
            area: fit.area,
            h: if ring.degree < 2 { 0.0 } else { ring.h },
            jacobian: fit.jacobian,
            l: fit.l,
        };
        self.energies[node] = energy_of(&careful, price.rows());
        if let Some(place) = sweep.goals.plane(node).filter(|_| careful.kind != Kind::Flat) {
            self.fit_clamped(rings, batch, lane, &careful, place, sweep);
            return;
        }
        self.keep(rings, node, 0, ring, careful.is_fitted());
        if sweep.wanted < Wanted::Rows {
            return;
        }
        let rows = &mut self.rows[batch.rows()];
        for row in rows.iter_mut() {
            for value in row {
                value[lane] = 0.0;
            }
        }
        if careful.is_fitted() {
            write_rows::<f64, 5>(ring, fit, |j, c, value| rows[j][c][lane] = value);
        }
        if careful.is_fitted() && sweep.wanted >= Wanted::Gradient {
            let bending = self.bending::<f64>([index; 2]).unwrap_or_default();
            let demand = Demand { weight: price.plate, bending, slope: barrier::slope(fit.jacobian) };
            let adjoint = thin_plate::adjoint(fit, ring.h, &demand);
            let turning = self.turning::<f64>(rings, [index; 2]);
            sweep.single_back.run_carefully(ring, &careful, &adjoint, turning.as_ref());
            let chords = sweep.single_back.chords.iter().map(|bar| bar.lane(0));
            scatter(&mut self.gradient, rings.ring(node), index, chords);
        }
    }

    /// Keeps what later work wants of a ring.
    #[inline(always)]
    fn keep<T: Real>(&mut self, rings: &Rings, node: usize, lane: usize, ring: &Ring<T>, is_fitted: bool) {
        let slots = rings.slots(node);
        for (length, spoke) in self.lengths[slots.clone()].iter_mut().zip(&ring.spokes) {
            *length = spoke.r.lane(lane);
        }
        if let Some(variation) = &mut self.variation {
            variation.is_fitted[node] = is_fitted;
            for (direction, spoke) in variation.directions[slots].iter_mut().zip(&ring.spokes) {
                *direction = [spoke.cos.lane(lane), spoke.sin.lane(lane)];
            }
        }
    }

    /// What edges ask of the curvature of one node per lane.
    #[inline(always)]
    fn bending<T: Real>(&self, nodes: [u32; 2]) -> Option<[T; 3]> {
        let variation = self.variation.as_ref()?;
        Some(std::array::from_fn(|c| T::gather(|lane| variation.bending[nodes[lane] as usize][c])))
    }

    /// What edges ask of the angles around one node per lane.
    #[inline(always)]
    fn turning<T: Real>(&self, rings: &Rings, nodes: [u32; 2]) -> Option<[T; MAX_RING]> {
        let variation = self.variation.as_ref()?;
        let mut turning = [T::splat(0.0); MAX_RING];
        let slots = nodes.map(|node| rings.slots(node as usize));
        for (j, turning) in turning.iter_mut().enumerate().take(slots[0].len()) {
            *turning = T::gather(|lane| variation.turning[slots[lane].start + j]);
        }
        Some(turning)
    }
}

/// Adds what a node's chords feel to their ends.
#[inline(always)]
fn scatter(gradient: &mut [DVec3], ring: &[u32], node: u32, chords: impl Iterator<Item = DVec3>) {
    let mut sum = DVec3::ZERO;
    for (&far, bar) in ring.iter().zip(chords) {
        gradient[far as usize] += bar;
        sum += bar;
    }
    gradient[node as usize] -= sum;
}

/// How much the plate of two nodes weighs, in the gradient and in the figure that is shown.
fn prices(goals: &Goals, nodes: [u32; 2]) -> (Pair, Pair) {
    let prices = nodes.map(|node| goals.price(node as usize));
    (Pair::new(prices.map(|price| price.plate)), Pair::new(prices.map(|price| price.rows())))
}

/// Thin plate and barrier of a fit made with care.
fn energy_of(careful: &CarefulFit, weight: f64) -> f64 {
    match careful.kind {
        Kind::Flat => 0.0,
        Kind::Folded => barrier::value(careful.fit.jacobian),
        Kind::Plain | Kind::Filtered => {
            weight * thin_plate::value(&careful.fit) + barrier::value(careful.fit.jacobian)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload::{self, Stream};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A shape with ordinary, filtered, folded and boundary nodes.
    fn rough() -> (Rings, Vec<DVec3>) {
        let disc = workload::disc(6);
        let mut stream = Stream::new(3);
        let positions = disc.positions.iter().map(|p| *p + 0.12 * stream.vector()).collect();
        (Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap(), positions)
    }

    #[test]
    fn pairs_and_single_nodes_agree() {
        let (rings, positions) = rough();
        let goals = Goals::default();
        let mut together = Fits::new(&rings, &goals);
        together.refit(&rings, &goals, &positions, Wanted::Gradient);
        let mut alone = Fits::new(&rings, &goals);
        alone.positions.copy_from_slice(&positions);
        let mut sweep = Sweep::new(&goals, Wanted::Gradient);
        for batch in rings.batches() {
            for lane in 0..batch.count {
                alone.fit_single(&rings, batch, lane, &mut sweep);
            }
        }
        for (a, b) in together.energies.iter().zip(&alone.energies) {
            assert!((a - b).abs() <= 1e-12 * b.max(1.0));
        }
        for (a, b) in together.nodes.iter().zip(&alone.nodes) {
            assert!(a.normal.distance(b.normal) < 1e-13);
        }
        let scale = alone.gradient.iter().map(|g| g.length()).fold(0.0, f64::max);
        for (a, b) in together.gradient.iter().zip(&alone.gradient) {
            assert!(a.distance(*b) <= 1e-12 * scale);
        }
        for (a, b) in together.rows.iter().flatten().zip(alone.rows.iter().flatten()) {
            assert!((a[0] - b[0]).abs() <= 1e-11 * b[0].abs().max(1.0));
        }
        assert!(together.nodes.iter().any(|node| node.jacobian < barrier::START), "some need care");
    }

    #[test]
    fn a_sweep_without_gradient_is_not_mistaken_for_one_with() {
        let (rings, positions) = rough();
        let goals = Goals::default();
        let mut fits = Fits::new(&rings, &goals);
        fits.refit(&rings, &goals, &positions, Wanted::Energy);
        assert!(fits.gradient.iter().all(|g| *g == DVec3::ZERO));
        let energy = fits.energy;
        fits.refit(&rings, &goals, &positions, Wanted::Gradient);
        assert!(fits.gradient.iter().any(|g| *g != DVec3::ZERO));
        assert_eq!(fits.energy.to_bits(), energy.to_bits());
    }

    #[test]
    fn rows_are_the_same_with_and_without_the_gradient() {
        let (rings, positions) = rough();
        let goals = Goals::default();
        let (mut plain, mut full) = (Fits::new(&rings, &goals), Fits::new(&rings, &goals));
        plain.refit(&rings, &goals, &positions, Wanted::Rows);
        full.refit(&rings, &goals, &positions, Wanted::Gradient);
        assert_eq!(plain.rows, full.rows);
        assert!(plain.gradient.iter().all(|g| *g == DVec3::ZERO));
        // Asked for later at the same positions, the gradient is made up for.
        plain.refit(&rings, &goals, &positions, Wanted::Gradient);
        assert_eq!(plain.gradient, full.gradient);
    }
}
