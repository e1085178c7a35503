//! Frozen connectivity: for every node the ordered ring of its neighbours, in compressed rows.
//!
//! A ring runs counter-clockwise as seen from the side its node calls "outside", so that fitted normals point to
//! the side from which the triangles look counter-clockwise:
//!
//! ```text
//!        2 ---- 1            interior node: the ring closes, 0 1 2 3 4 5 (0 again)
//!       / \    / \           boundary node: the ring starts and ends on the boundary, 0 1 2 3
//!      /   \  /   \
//!     3 --- node - 0         spoke = one entry of a ring; its place in the flat arrays is its slot
//!      \   /  \   /
//!       4 ---- 5
//! ```
//!
//! The sense of each ring is local to its node. On a surface that cannot be oriented no choice of senses agrees
//! everywhere, so every spoke also says whether the ring at its far end turns the same way (`sense`, +1 or -1).
//! It is read off the shared triangle, never off the normals: a crease sharper than a right angle keeps its sign.

use std::ops::Range;

use thiserror::Error;

use crate::batch::{self, Batch};

/// Largest ring the solver accepts; mesh operations have to refuse what exceeds it.
pub const MAX_RING: usize = 24;

/// Why a set of triangles or rings is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum RingError {
    /// A triangle or ring names a node that does not exist: the indices are stale.
    #[error("node {0} does not exist")]
    UnknownNode(u32),
    /// A triangle uses one node twice: drop it before asking for rings.
    #[error("triangle {0} uses one node twice")]
    DegenerateTriangle(u32),
    /// The triangles around this node do not form one disc or half-disc: split the node.
    #[error("the triangles around node {0} do not form one disc or half-disc")]
    NotManifold(u32),
    /// The node has more neighbours than [`MAX_RING`]: flip or split edges around it.
    #[error("node {0} has more than {MAX_RING} neighbours")]
    RingTooLarge(u32),
    /// The flat arrays contradict each other (lengths, order of the offsets, or rings that do not match).
    #[error("the rings around nodes {0} and {1} contradict each other")]
    Contradiction(u32, u32),
    /// More nodes or spokes than a `u32` can count.
    #[error("too many nodes or triangles")]
    TooMany,
}

/// The frozen connectivity of one surface, over compact node indices `0..len`.
#[derive(Clone, Debug, PartialEq)]
pub struct Rings {
    offsets: Vec<u32>,
    neighbours: Vec<u32>,
    senses: Vec<f64>,
    is_boundary: Vec<bool>,
    triangles: Vec<[u32; 3]>,
    batches: Vec<Batch>,
    is_mixed: bool,
}

impl Rings {
    /// Finds the rings of `nodes` nodes from triangles alone.
    ///
    /// Triangles need not be wound alike (a Möbius strip cannot be): the first triangle at a node sets the sense of
    /// its ring. Nodes in no triangle get an empty ring; a solver leaves them where they are.
    ///
    /// ```
    /// use ductile_solver::Rings;
    /// let rings = Rings::from_triangles(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
    /// assert_eq!(rings.ring(0), &[1, 2, 3]);
    /// assert!(rings.is_boundary(0));
    /// ```
    pub fn from_triangles(nodes: usize, triangles: &[[u32; 3]]) -> Result<Self, RingError> {
        let count = u32::try_from(nodes).map_err(|_| RingError::TooMany)?;
        u32::try_from(triangles.len() * 3).map_err(|_| RingError::TooMany)?;
        let links = Links::new(count, triangles)?;
        let mut offsets = Vec::with_capacity(nodes + 1);
        let mut neighbours = Vec::with_capacity(triangles.len() * 3);
        let mut is_boundary = Vec::with_capacity(nodes);
        offsets.push(0);
        let mut ring = Vec::new();
        let mut is_wound_alike = true;
        for node in 0..count {
            let Chain { closed, is_forward } = chain(node, links.of(node), &mut ring)?;
            is_wound_alike &= is_forward;
            if ring.len() > MAX_RING {
                return Err(RingError::RingTooLarge(node));
            }
            neighbours.extend_from_slice(&ring);
            is_boundary.push(!closed);
            offsets.push(compact(neighbours.len())?);
        }
        // Where each ring runs along all of its triangles, both rings of a spoke run along the same ones.
        let senses = if is_wound_alike {
            vec![1.0; neighbours.len()]
        } else {
            senses(&offsets, &neighbours, &is_boundary)?
        };
        Ok(Self::assemble(offsets, neighbours, senses, is_boundary, triangles.to_vec()))
    }

    /// Takes rings that the caller already has: node `i` owns `neighbours[offsets[i]..offsets[i + 1]]`.
    ///
    /// Everything is checked: a ring in which two neighbours do not know each other is refused.
    pub fn from_parts(
        offsets: Vec<u32>,
        neighbours: Vec<u32>,
        is_boundary: Vec<bool>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, RingError> {
        let count = compact(is_boundary.len())?;
        compact(neighbours.len())?;
        let ends_match = offsets.first() == Some(&0)
            && offsets.len() == is_boundary.len() + 1
            && offsets.last().map(|&last| last as usize) == Some(neighbours.len());
        if !ends_match {
            return Err(RingError::Contradiction(0, count));
        }
        for (node, pair) in (0..count).zip(offsets.windows(2)) {
            if pair[1] < pair[0] {
                return Err(RingError::Contradiction(node, node));
            }
            if (pair[1] - pair[0]) as usize > MAX_RING {
                return Err(RingError::RingTooLarge(node));
            }
        }
        let named = neighbours.iter().chain(triangles.iter().flatten());
        if let Some(&node) = named.clone().find(|&&node| node >= count) {
            return Err(RingError::UnknownNode(node));
        }
        let senses = senses(&offsets, &neighbours, &is_boundary)?;
        Ok(Self::assemble(offsets, neighbours, senses, is_boundary, triangles))
    }

    fn assemble(
        offsets: Vec<u32>,
        neighbours: Vec<u32>,
        senses: Vec<f64>,
        is_boundary: Vec<bool>,
        triangles: Vec<[u32; 3]>,
    ) -> Self {
        let degrees = offsets.windows(2).map(|pair| (pair[1] - pair[0]) as usize);
        let batches = batch::pair(degrees.zip(is_boundary.iter().copied()));
        let is_mixed = senses.iter().any(|&sense| sense < 0.0);
        Self { offsets, neighbours, senses, is_boundary, triangles, batches, is_mixed }
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.is_boundary.len()
    }

    /// Whether there are no nodes at all.
    pub fn is_empty(&self) -> bool {
        self.is_boundary.is_empty()
    }

    /// The neighbours of `node` in order.
    pub fn ring(&self, node: usize) -> &[u32] {
        &self.neighbours[self.slots(node)]
    }

    /// Whether `node` lies on the boundary (its ring is open). Nodes without triangles count as boundary.
    pub fn is_boundary(&self, node: usize) -> bool {
        self.is_boundary[node]
    }

    /// The triangles the rings came from.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// Every edge once, as `(slot, from, to)` with `from < to`, in a fixed order.
    pub(crate) fn edges(&self) -> impl Iterator<Item = (usize, usize, usize)> {
        (0..self.len()).flat_map(move |node| self.edges_from(node).map(move |(slot, far)| (slot, node, far)))
    }

    /// The edges of a node to larger ones, as `(slot, to)`.
    #[inline]
    pub(crate) fn edges_from(&self, node: usize) -> impl Iterator<Item = (usize, usize)> {
        self.slots(node).filter_map(move |slot| {
            let far = self.neighbours[slot] as usize;
            (node < far).then_some((slot, far))
        })
    }

    /// Where the spokes of `node` lie in the flat arrays.
    pub(crate) fn slots(&self, node: usize) -> Range<usize> {
        self.offsets[node] as usize..self.offsets[node + 1] as usize
    }

    /// Number of spokes of all nodes together.
    pub(crate) fn spokes(&self) -> usize {
        self.neighbours.len()
    }

    /// The nodes, by twos of the same kind.
    pub(crate) fn batches(&self) -> &[Batch] {
        &self.batches
    }

    /// Per spoke of `node`: +1 when the ring at the far end turns the same way, -1 when it turns the other way.
    pub(crate) fn senses(&self, node: usize) -> &[f64] {
        &self.senses[self.slots(node)]
    }

    /// Whether any spoke joins rings of different senses.
    pub(crate) fn is_mixed(&self) -> bool {
        self.is_mixed
    }

    /// The sense of one spoke.
    pub(crate) fn sense(&self, slot: usize) -> f64 {
        self.senses[slot]
    }

    /// The same connectivity with the rings of some nodes turned round, for tests of independence of the sense.
    #[cfg(test)]
    pub(crate) fn with_reversed(&self, reversed: &[bool]) -> Self {
        let mut neighbours = self.neighbours.clone();
        for node in (0..self.len()).filter(|&node| reversed[node]) {
            let range = self.slots(node);
            // A closed ring keeps its first neighbour; an open one swaps its two ends.
            let first = usize::from(!self.is_boundary[node]).min(range.len());
            neighbours[range][first..].reverse();
        }
        let (offsets, is_boundary) = (self.offsets.clone(), self.is_boundary.clone());
        Self::from_parts(offsets, neighbours, is_boundary, self.triangles.clone()).unwrap()
    }
}

/// The edges opposite each node, one per triangle, oriented as the triangle is wound.
struct Links {
    offsets: Vec<u32>,
    edges: Vec<[u32; 2]>,
}

impl Links {
    fn new(nodes: u32, triangles: &[[u32; 3]]) -> Result<Self, RingError> {
        let mut offsets = vec![0_u32; nodes as usize + 1];
        for (index, &[a, b, c]) in (0_u32..).zip(triangles) {
            if let Some(&node) = [a, b, c].iter().find(|&&node| node >= nodes) {
                return Err(RingError::UnknownNode(node));
            }
            if a == b || b == c || c == a {
                return Err(RingError::DegenerateTriangle(index));
            }
            for node in [a, b, c] {
                offsets[node as usize + 1] += 1;
            }
        }
        for node in 0..nodes as usize {
            offsets[node + 1] += offsets[node];
        }
        let mut next = offsets.clone();
        let mut edges = vec![[0_u32; 2]; triangles.len() * 3];
        for &[a, b, c] in triangles {
            for (node, edge) in [(a, [b, c]), (b, [c, a]), (c, [a, b])] {
                edges[next[node as usize] as usize] = edge;
                next[node as usize] += 1;
            }
        }
        Ok(Self { offsets, edges })
    }

    fn of(&self, node: u32) -> &[[u32; 2]] {
        &self.edges[self.offsets[node as usize] as usize..self.offsets[node as usize + 1] as usize]
    }
}

/// What was found on the way round a node.
struct Chain {
    /// Whether the ring closes.
    closed: bool,
    /// Whether it runs along every triangle in the sense in which that is wound.
    is_forward: bool,
}

/// Chains the link edges of a node into `ring`. The first edge sets the sense.
fn chain(node: u32, link: &[[u32; 2]], ring: &mut Vec<u32>) -> Result<Chain, RingError> {
    ring.clear();
    let Some(&[first, second]) = link.first() else {
        return Ok(Chain { closed: false, is_forward: true });
    };
    let mut is_forward = true;
    if link.len() > MAX_RING {
        return Err(RingError::RingTooLarge(node));
    }
    let mut used = 1_u32;
    ring.extend([first, second]);
    let mut closed = false;
    // Forwards from the second node, then backwards from the first; a closed ring never needs the latter.
    while let Some((far, side)) = take_next(link, &mut used, ring[ring.len() - 1]) {
        is_forward &= side == 0;
        if far == first {
            closed = true;
            break;
        }
        ring.push(far);
    }
    if !closed {
        let mut before = Vec::new();
        while let Some((far, side)) = take_next(link, &mut used, before.last().copied().unwrap_or(first)) {
            is_forward &= side == 1;
            before.push(far);
        }
        before.reverse();
        ring.splice(0..0, before);
    }
    let is_whole = used.count_ones() as usize == link.len();
    let is_simple = (1..ring.len()).all(|i| !ring[..i].contains(&ring[i]));
    if !is_whole || !is_simple || (closed && ring.len() < 3) {
        return Err(RingError::NotManifold(node));
    }
    Ok(Chain { closed, is_forward })
}

/// The far end of an unused link edge at `from`, which it marks as used, and whether `from` is its first or second end.
fn take_next(link: &[[u32; 2]], used: &mut u32, from: u32) -> Option<(u32, u8)> {
    let index = (0..link.len()).find(|&i| *used & (1 << i) == 0 && link[i].contains(&from))?;
    *used |= 1 << index;
    let [a, b] = link[index];
    Some(if a == from { (b, 0) } else { (a, 1) })
}

/// Compares the rings at both ends of every spoke over a triangle they share.
fn senses(offsets: &[u32], neighbours: &[u32], is_boundary: &[bool]) -> Result<Vec<f64>, RingError> {
    let ring_of =
        |node: u32| &neighbours[offsets[node as usize] as usize..offsets[node as usize + 1] as usize];
    let mut senses = Vec::with_capacity(neighbours.len());
    for node in 0..compact(is_boundary.len())? {
        let ring = ring_of(node);
        for (place, &far) in ring.iter().enumerate() {
            // In this ring the pair (left, right) encloses a triangle with `node`, and `far` is one of the two.
            let is_last = place + 1 == ring.len();
            let (left, right) = match (is_last, is_boundary[node as usize]) {
                (false, _) => (far, ring[place + 1]),
                (true, false) => (far, ring[0]),
                (true, true) if place > 0 => (ring[place - 1], far),
                (true, true) => return Err(RingError::NotManifold(node)),
            };
            let third = if left == far { right } else { left };
            let follows = |a: u32, b: u32| {
                let other = ring_of(far);
                let wraps =
                    !is_boundary[far as usize] && other.last() == Some(&a) && other.first() == Some(&b);
                wraps || other.windows(2).any(|pair| pair == [a, b])
            };
            // Same sense: around `far`, the triangle (node, left, right) is crossed right -> node or node -> left.
            let (same, opposite) = if left == far {
                (follows(third, node), follows(node, third))
            } else {
                (follows(node, third), follows(third, node))
            };
            match (same, opposite) {
                (true, false) => senses.push(1.0),
                (false, true) => senses.push(-1.0),
                _ => return Err(RingError::Contradiction(node, far)),
            }
        }
    }
    Ok(senses)
}

fn compact(count: usize) -> Result<u32, RingError> {
    u32::try_from(count).map_err(|_| RingError::TooMany)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn interior_ring_runs_counter_clockwise() {
        let disc = workload::disc(2);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        assert!(!rings.is_boundary(0));
        let ring = rings.ring(0);
        for (place, &far) in ring.iter().enumerate() {
            let next = ring[(place + 1) % ring.len()];
            let (a, b) = (disc.positions[far as usize], disc.positions[next as usize]);
            assert!(a.cross(b).z > 0.0);
        }
        assert!((0..rings.spokes()).all(|slot| rings.sense(slot) == 1.0));
    }

    #[test]
    fn boundary_ring_starts_and_ends_on_the_boundary() {
        let disc = workload::disc(3);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        for node in (0..rings.len()).filter(|&node| rings.is_boundary(node)) {
            let ring = rings.ring(node);
            assert!(rings.is_boundary(ring[0] as usize) && rings.is_boundary(ring[ring.len() - 1] as usize));
        }
    }

    #[test]
    fn triangles_wound_unlike_have_the_senses_that_a_second_look_finds() {
        let disc = workload::disc(3);
        let mut triangles = disc.triangles.clone();
        let alike = Rings::from_triangles(disc.positions.len(), &triangles).unwrap();
        let looked = senses(&alike.offsets, &alike.neighbours, &alike.is_boundary).unwrap();
        assert_eq!(alike.senses, looked);
        // A triangle turned round: some of its corners take their sense from it.
        triangles[0].swap(1, 2);
        let unlike = Rings::from_triangles(disc.positions.len(), &triangles).unwrap();
        assert!(unlike.is_mixed() && !alike.is_mixed());
    }

    #[test]
    fn moebius_strip_has_senses_of_both_kinds_whose_product_is_fixed() {
        let strip = workload::moebius(12, 2, 0.3);
        let rings = Rings::from_triangles(strip.positions.len(), &strip.triangles).unwrap();
        assert!((0..rings.spokes()).any(|slot| rings.sense(slot) < 0.0));
        // Once around the core the senses multiply to -1, however the rings are turned.
        let around = |rings: &Rings| -> f64 {
            let core = |i: usize| (i % 12) * 3 + 1;
            let sense = |i: usize| {
                let far = u32::try_from(core(i + 1)).unwrap();
                let place = rings.ring(core(i)).iter().position(|&other| other == far).unwrap();
                rings.senses(core(i))[place]
            };
            (0..12).map(sense).product()
        };
        assert_eq!(around(&rings), -1.0);
        let reversed: Vec<bool> = (0..rings.len()).map(|node| node % 3 == 1).collect();
        assert_eq!(around(&rings.with_reversed(&reversed)), -1.0);
    }

    #[test]
    fn parts_that_came_from_triangles_are_taken_back() {
        let strip = workload::moebius(9, 2, 0.3);
        let rings = Rings::from_triangles(strip.positions.len(), &strip.triangles).unwrap();
        assert_eq!(rings, rings.with_reversed(&vec![false; rings.len()]));
    }

    #[test]
    fn broken_meshes_are_refused() {
        let from = Rings::from_triangles;
        assert_eq!(from(2, &[[0, 1, 2]]), Err(RingError::UnknownNode(2)));
        assert_eq!(from(3, &[[0, 1, 1]]), Err(RingError::DegenerateTriangle(0)));
        // Three triangles on one edge; two fans on one node; the same triangle twice.
        assert!(matches!(from(5, &[[0, 1, 2], [0, 1, 3], [0, 1, 4]]), Err(RingError::NotManifold(_))));
        assert_eq!(from(5, &[[0, 1, 2], [0, 3, 4]]), Err(RingError::NotManifold(0)));
        assert!(matches!(from(3, &[[0, 1, 2], [0, 2, 1]]), Err(RingError::NotManifold(_))));
        let fan: Vec<[u32; 3]> = (1..26).map(|i| [0, i, i % 25 + 1]).collect();
        assert_eq!(from(26, &fan), Err(RingError::RingTooLarge(0)));
        let parts = Rings::from_parts(vec![0, 2, 4, 6], vec![1, 2, 2, 0, 0, 0], vec![true; 3], vec![]);
        assert!(matches!(parts, Err(RingError::Contradiction(..))));
        assert!(Rings::from_parts(vec![0, 9], vec![], vec![true], vec![]).is_err());
    }
}
