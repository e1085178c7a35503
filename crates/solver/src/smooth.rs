//! Tangential smoothing and new nodes: where a node sits within its own surface.
//!
//! Source: recipe section 7. A node moves within its unrolled ring and is mapped back by the fitted quadratic, not by the
//! facets: a sphere keeps its radius over hundreds of sweeps. Where to is the caller's choice ([`Aim`]).

use glam::{DVec2, DVec3};

use crate::fit::{self, CarefulFit, Fit};
use crate::lanes::{Pair, Real};
use crate::neighbourhood::Ring;
use crate::rings::Rings;

/// Moves shorter than this, in units of the local mean edge, creep on for ever and are left out.
const SMALLEST_MOVE: f64 = 0.01;
/// Moves are cut at this, in the same units, where the quadratic is still a good map.
const LARGEST_MOVE: f64 = 0.5;

/// Twice the area of a triangle that counts as flat, in the same units squared.
const FLAT: f64 = 1e-3;

/// Parameter distance, in units of the local mean edge, beyond which a quadratic says nothing.
const REACH: f64 = 1.25;
/// Gauss-Newton steps to the foot of a place: each gains about two digits on a surface that the mesh resolves.
const FOOT_STEPS: usize = 6;

/// Where smoothing leads the nodes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Aim {
    /// Towards the area centroid of the ring (the recipe's): areas even out. For a connectivity that stays as it is.
    #[default]
    Even,
    /// To where the triangles are shapeliest, by the measure that the flips of the mesh lower too. For a mesh that is split
    /// and collapsed as well, which looks after the lengths. Measured on a remeshed torus, the first percentile of the
    /// least angles rises from 41.9° to 44.7° by this.
    Shapely,
}

/// What a smoothing sweep did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SmoothReport {
    /// How many nodes moved.
    pub moved: usize,
    /// The largest move, in units of the node's mean edge.
    pub largest_relative_move: f64,
}

/// One sweep; every node moves from the old positions, so the order does not matter.
pub fn smooth(
    rings: &Rings,
    positions: &mut [DVec3],
    movable: &[bool],
    fraction: f64,
    aim: Aim,
    lengths: Option<&[f64]>,
) -> SmoothReport {
    assert_eq!(movable.len(), rings.len(), "one flag per node");
    let old = positions.to_vec();
    let mut sweep = Sweep { rings, positions, fraction, aim, lengths, report: SmoothReport::default() };
    let (mut pair, mut single) = (Ring::<Pair>::default(), Ring::<f64>::default());
    for batch in rings.batches() {
        let lanes = (0..batch.count).filter(|&lane| movable[batch.nodes[lane] as usize]);
        if lanes.clone().next().is_none() {
            continue;
        }
        if batch.is_regular() && !batch.is_boundary {
            pair.load(rings, &old, batch.nodes);
            if pair.unroll() {
                let (fit, is_ordinary) = fit::fit_ordinary::<Pair, 5>(&pair);
                if is_ordinary {
                    lanes.for_each(|lane| sweep.move_node(batch.nodes[lane], &pair, &fit, lane));
                    continue;
                }
            }
        }
        for lane in lanes {
            let careful = fit_at(rings, &old, batch.nodes[lane], &mut single);
            if careful.is_fitted() {
                sweep.move_node(batch.nodes[lane], &single, &careful.fit, 0);
            }
        }
    }
    sweep.report
}

/// A smoothing sweep on its way.
struct Sweep<'a> {
    rings: &'a Rings,
    positions: &'a mut [DVec3],
    fraction: f64,
    aim: Aim,
    lengths: Option<&'a [f64]>,
    report: SmoothReport,
}

impl Sweep<'_> {
    fn move_node<T: Real>(&mut self, node: u32, ring: &Ring<T>, fit: &Fit<T>, lane: usize) {
        let (u, v) = if ring.is_boundary {
            // Along the boundary only: its two neighbours lie on the u axis.
            let ends = ring.spokes[0].r.lane(lane) - ring.spokes[ring.degree - 1].r.lane(lane);
            (0.5 * ends / ring.h.lane(lane), 0.0)
        } else {
            // A folded ring has no best place; the centroid leads it out of the fold.
            let best = if self.aim == Aim::Shapely { shapeliest(ring, lane) } else { None };
            best.unwrap_or_else(|| self.centroid(node, ring, lane))
        };
        let (u, v) = (self.fraction * u, self.fraction * v);
        let distance = (u * u + v * v).sqrt();
        // Written so that NaN stays put.
        if !(distance >= SMALLEST_MOVE) {
            return;
        }
        let cut = if distance > LARGEST_MOVE { LARGEST_MOVE / distance } else { 1.0 };
        let position = &mut self.positions[node as usize];
        let moved = *position + fit.quadratic(lane).evaluate(u * cut, v * cut, 1.0);
        if moved.is_finite() {
            *position = moved;
            self.report.moved += 1;
            self.report.largest_relative_move = self.report.largest_relative_move.max(distance * cut);
        }
    }

    /// Area centroid of the fan in normalised coordinates, triangles weighed by `area / h*²` if lengths are given.
    fn centroid<T: Real>(&self, node: u32, unrolled: &Ring<T>, lane: usize) -> (f64, f64) {
        let ring = self.rings.ring(node as usize);
        let h = unrolled.h.lane(lane);
        let spoke = |j: usize| {
            let r = unrolled.spokes[j].r.lane(lane);
            (r * unrolled.spokes[j].cos.lane(lane), r * unrolled.spokes[j].sin.lane(lane))
        };
        let (mut sum_u, mut sum_v, mut sum) = (0.0, 0.0, 0.0);
        for j in 0..unrolled.gaps() {
            let next = unrolled.next(j);
            let (near, far) = (spoke(j), spoke(next));
            let area = near.0 * far.1 - near.1 * far.0;
            let weight = self.lengths.map_or(1.0, |lengths| {
                let corners = [node, ring[j], ring[next]].map(|node| lengths[node as usize]);
                let wanted = (corners[0] + corners[1] + corners[2]) / 3.0;
                1.0 / (wanted * wanted)
            });
            let mass = area.max(0.0) * weight;
            sum += mass;
            sum_u += mass * (near.0 + far.0);
            sum_v += mass * (near.1 + far.1);
        }
        if sum > 0.0 { (sum_u / (3.0 * sum * h), sum_v / (3.0 * sum * h)) } else { (0.0, 0.0) }
    }
}

/// Where a node makes the triangles of its unrolled ring shapeliest, to first order, in normalised coordinates: one Newton
/// step to the least sum of their cotangents. `None` where a triangle is turned over or has no area.
///
/// For a triangle with sides a, b at the node and c across, the cotangents add up to `N / D` with `N = a² + b² + c²` and
/// `D = 2 |a × b|`. `D` is linear in the node's place and `N` quadratic, so each term is convex and so is the sum.
fn shapeliest<T: Real>(ring: &Ring<T>, lane: usize) -> Option<(f64, f64)> {
    let h = ring.h.lane(lane);
    let spoke = |j: usize| {
        let r = ring.spokes[j].r.lane(lane) / h;
        DVec2::new(r * ring.spokes[j].cos.lane(lane), r * ring.spokes[j].sin.lane(lane))
    };
    let mut slope = DVec2::ZERO;
    // Second derivatives by uu, uv, vv.
    let mut bend = [0.0; 3];
    for j in 0..ring.gaps() {
        let (a, b) = (spoke(j), spoke(ring.next(j)));
        let d = 2.0 * a.perp_dot(b);
        // Written so that NaN is refused.
        if !(d > FLAT) {
            return None;
        }
        let c = a - b;
        let n = a.length_squared() + b.length_squared() + c.length_squared();
        let (dn, dd) = (-2.0 * (a + b), 2.0 * DVec2::new(c.y, -c.x));
        let ratio = n / d;
        slope += (dn - ratio * dd) / d;
        let mixed = |p: f64, q: f64, r: f64, s: f64| (2.0 * ratio * r * s - p * s - q * r) / (d * d);
        bend[0] += 4.0 / d + mixed(dn.x, dn.x, dd.x, dd.x);
        bend[1] += mixed(dn.x, dn.y, dd.x, dd.y);
        bend[2] += 4.0 / d + mixed(dn.y, dn.y, dd.y, dd.y);
    }
    let [uu, uv, vv] = bend;
    let determinant = uu * vv - uv * uv;
    let (u, v) = ((uv * slope.y - vv * slope.x) / determinant, (uv * slope.x - uu * slope.y) / determinant);
    (u.is_finite() && v.is_finite()).then_some((u, v))
}

/// The fit of one node, and its ring unrolled.
fn fit_at(rings: &Rings, positions: &[DVec3], node: u32, ring: &mut Ring<f64>) -> CarefulFit {
    ring.load(rings, positions, [node; 2]);
    fit::fit_carefully(ring)
}

/// The middle of an edge plus the mean of what both quadratics rise above their chord there.
pub fn place_on_edge(rings: &Rings, positions: &[DVec3], a: u32, b: u32) -> DVec3 {
    let mut ring = Ring::default();
    let mut rise = |node: u32, far: u32| {
        let place = rings.ring(node as usize).iter().position(|&other| other == far)?;
        let careful = fit_at(rings, positions, node, &mut ring);
        rise(&careful, &ring, place)
    };
    let rises = [rise(a, b), rise(b, a)];
    above_middle(positions, [a, b], rises)
}

/// The same for many edges of one shape: every node is fitted once, when one of its edges is first asked for.
#[derive(Debug)]
pub struct EdgePlaces<'a> {
    rings: &'a Rings,
    positions: &'a [DVec3],
    /// Where the rises of a node's spokes begin, if it has been fitted.
    first: Vec<u32>,
    rises: Vec<Option<DVec3>>,
    ring: Ring<f64>,
}

const NOT_FITTED: u32 = u32::MAX;

impl<'a> EdgePlaces<'a> {
    /// For a shape as it is now.
    ///
    /// # Panics
    /// When there is not one position per node.
    #[must_use]
    pub fn new(rings: &'a Rings, positions: &'a [DVec3]) -> Self {
        assert_eq!(positions.len(), rings.len(), "one position per node");
        let first = vec![NOT_FITTED; rings.len()];
        Self { rings, positions, first, rises: Vec::new(), ring: Ring::default() }
    }

    /// As [`place_on_edge`], to the bit.
    ///
    /// # Panics
    /// When there is no such node.
    pub fn at(&mut self, a: u32, b: u32) -> DVec3 {
        let rises = [self.rise(a, b), self.rise(b, a)];
        above_middle(self.positions, [a, b], rises)
    }

    fn rise(&mut self, node: u32, far: u32) -> Option<DVec3> {
        let spokes = self.rings.ring(node as usize);
        let place = spokes.iter().position(|&other| other == far)?;
        if self.first[node as usize] == NOT_FITTED {
            self.first[node as usize] = u32::try_from(self.rises.len()).unwrap_or(NOT_FITTED);
            let careful = fit_at(self.rings, self.positions, node, &mut self.ring);
            self.rises.extend((0..spokes.len()).map(|place| rise(&careful, &self.ring, place)));
        }
        self.rises.get(self.first[node as usize] as usize + place).copied().flatten()
    }
}

/// How far a node's quadratic lies above its chord to a neighbour, in the middle between them; none where it has no fit.
fn rise(careful: &CarefulFit, ring: &Ring<f64>, place: usize) -> Option<DVec3> {
    let (u, v) = ring.uv(place);
    // q(t) = second(t): q(1/2) - q(1)/2 = -second/4, whatever the linear part.
    let rise = careful.fit.quadratic(0).evaluate(u, v, 0.0) * -0.25;
    (careful.is_fitted() && rise.is_finite()).then_some(rise)
}

fn above_middle(positions: &[DVec3], ends: [u32; 2], rises: [Option<DVec3>; 2]) -> DVec3 {
    let middle = 0.5 * (positions[ends[0] as usize] + positions[ends[1] as usize]);
    match rises {
        [Some(one), Some(other)] => middle + 0.5 * (one + other),
        [Some(one), None] | [None, Some(one)] => middle + one,
        [None, None] => middle,
    }
}

/// The place of a node's fitted quadratic nearest to a given one: slid along the surface and lifted onto it.
///
/// None on the boundary, whose fit knows nothing across it, and where there is no fit or the place is out of its reach.
pub(crate) fn place_near(rings: &Rings, positions: &[DVec3], node: u32, at: DVec3) -> Option<DVec3> {
    let centre = positions[node as usize];
    let careful = fit_at(rings, positions, node, &mut Ring::default());
    if rings.is_boundary(node as usize) || !careful.is_fitted() {
        return None;
    }
    let fit = careful.fit.quadratic(0);
    let (mut u, mut v) = (0.0, 0.0);
    for _ in 0..FOOT_STEPS {
        let [along_u, along_v] = fit.tangents(u, v);
        let rest = at - centre - fit.evaluate(u, v, 1.0);
        // Normal equations of the tangent plane at (u, v); singular only for a fold, which ends as NaN below.
        let (a, b, c) = (along_u.length_squared(), along_u.dot(along_v), along_v.length_squared());
        let (p, q) = (along_u.dot(rest), along_v.dot(rest));
        let determinant = a * c - b * b;
        u += (c * p - b * q) / determinant;
        v += (a * q - b * p) / determinant;
    }
    let place = centre + fit.evaluate(u, v, 1.0);
    (u * u + v * v <= REACH * REACH && place.is_finite()).then_some(place)
}
