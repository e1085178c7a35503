//! The intrinsic Delaunay triangulation: the same vertices and the same metric, with edges flipped until no cotangent
//! weight is negative, so that harmonic functions obey the maximum principle.
//!
//! Source: the recipe, section 5; after Fisher, Springborn, Schröder and Bobenko, *An algorithm for the construction of
//! intrinsic Delaunay triangulations* (2006). Only edge lengths are kept. Two triangles may share several edges, and
//! a triangle may be glued to itself; then the edge stays.
//!
//! ```text
//!        v2                    v2
//!       /  \                  /|\
//!   s2 / T  \ s1          T' / | \ U'        side s of T is glued to side u of U;
//!     /   s  \              /  |  \          T' = (v2, v0, v3) takes s2, u1 and the new edge,
//!   v0 ------ v1    →     v0   |   v1        U' = (v3, v1, v2) takes u2, s1 and the new edge.
//!     \   u  /              \  |  /
//!   u1 \ U  / u2             \ | /
//!       \  /                  \|/
//!        v3                    v3
//! ```

use super::domain::{Domain, NONE, ends};
use super::error::DisplacementError;

/// A weight below minus this share of its cotangents is negative beyond rounding.
const NEGATIVE: f64 = 1e-12;
/// Triangles flatter than this share of the mean length get all lengths stretched by what is missing (after Sharp and
/// Crane, *A Laplacian for nonmanifold triangle meshes*, 2020): then every triangle has an area.
const SLACK: f64 = 1e-10;
/// Flips that may be made for each triangle. A good mesh needs less than one; the number ends what rounding might not.
const FLIPS: usize = 200;

/// Triangles by their lengths and how they are glued.
#[derive(Clone, Debug)]
pub(super) struct Intrinsic {
    pub(super) corners: Vec<[u32; 3]>,
    /// Of the side from each corner to the next.
    pub(super) lengths: Vec<[f64; 3]>,
    glue: Vec<u32>,
    /// Whether the side that a side is glued to runs the same way round: then one of the triangles must be turned over
    /// before both can be flipped.
    is_same_way: Vec<bool>,
}

impl Intrinsic {
    /// The triangulation of a domain as it is, with its flat triangles given a little area.
    pub(super) fn new(domain: &Domain) -> Result<Self, DisplacementError> {
        let at = |v: u32| domain.positions[v as usize];
        let lengths_of = |t: &[u32; 3]| [0, 1, 2].map(|k| (at(t[(k + 1) % 3]) - at(t[k])).length());
        let mut lengths: Vec<[f64; 3]> = domain.triangles.iter().map(lengths_of).collect();
        let mean = lengths.as_flattened().iter().sum::<f64>() / (3 * lengths.len()).max(1) as f64;
        if mean == 0.0 && !lengths.is_empty() {
            return Err(DisplacementError::FlatTriangle(0));
        }
        let slack = |&[a, b, c]: &[f64; 3]| (a + b - c).min(b + c - a).min(c + a - b);
        let missing = lengths.iter().map(|l| SLACK * mean - slack(l)).fold(0.0, f64::max);
        lengths.as_flattened_mut().iter_mut().for_each(|length| *length += missing);
        let is_same_way = |(side, &partner): (usize, &u32)| {
            partner != NONE && ends(&domain.triangles, side) == ends(&domain.triangles, partner as usize)
        };
        Ok(Self {
            corners: domain.triangles.clone(),
            lengths,
            is_same_way: domain.glue.iter().enumerate().map(is_same_way).collect(),
            glue: domain.glue.clone(),
        })
    }

    /// Flips until no weight is negative, except at edges that must stay.
    pub(super) fn make_delaunay(&mut self, keeps: impl Fn(u32, u32) -> bool) {
        let mut budget = FLIPS * (self.corners.len() + 1);
        let mut pending: Vec<usize> = (0..self.glue.len()).rev().collect();
        while let Some(side) = pending.pop() {
            let [a, b] = ends(&self.corners, side);
            if !self.is_bad(side) || keeps(a, b) {
                continue;
            }
            if budget == 0 {
                break;
            }
            if let Some(around) = self.flip(side) {
                budget -= 1;
                pending.extend(around);
            }
        }
    }

    /// The cotangents of a triangle's angles, each at the side opposite to it, and the area.
    pub(super) fn cotangents(lengths: [f64; 3]) -> ([f64; 3], f64) {
        let area = area(lengths);
        let cotangent = |k: usize| {
            let [a, b, c] = [lengths[k], lengths[(k + 1) % 3], lengths[(k + 2) % 3]];
            (b * b + c * c - a * a) / (4.0 * area)
        };
        ([0, 1, 2].map(cotangent), area)
    }

    fn is_bad(&self, side: usize) -> bool {
        let partner = self.glue[side];
        if partner == NONE || partner as usize / 3 == side / 3 {
            return false;
        }
        let opposite = |side: usize| Self::cotangents(self.lengths[side / 3]).0[side % 3];
        let (one, other) = (opposite(side), opposite(partner as usize));
        one + other < -NEGATIVE * (1.0 + one.abs() + other.abs())
    }

    /// Flips an edge between two triangles and gives the four sides around; `None`, and nothing done, when a new triangle
    /// would have no area.
    fn flip(&mut self, side: usize) -> Option<[usize; 4]> {
        if self.is_same_way[side] {
            self.turn_over(self.glue[side] as usize / 3);
        }
        let partner = self.glue[side] as usize;
        let (t, u) = (side / 3, partner / 3);
        let next = |side: usize| 3 * (side / 3) + (side + 1) % 3;
        let (s1, u1) = (next(side), next(partner));
        let (s2, u2) = (next(s1), next(u1));
        let length = |side: usize| self.lengths[side / 3][side % 3];
        let [l01, l12, l20, l03, l31] = [side, s1, s2, u1, u2].map(length);
        // The cosine rule at v0, with the cosine of a sum of angles from products of sides and areas.
        let dot = |out: f64, across: f64| 0.5 * (l01 * l01 + out * out - across * across);
        let areas = 4.0 * area(self.lengths[t]) * area(self.lengths[u]);
        let cosine = (dot(l20, l12) * dot(l03, l31) - areas) / (l01 * l01);
        let new = libm::sqrt(l20 * l20 + l03 * l03 - 2.0 * cosine);
        let (left, right) = ([l20, l03, new], [l31, l12, new]);
        if !(area(left) > 0.0 && area(right) > 0.0) {
            return None;
        }
        let [v0, v1, v2, v3] = [side, s1, s2, u2].map(|side| ends(&self.corners, side)[0]);
        let moved = [(s2, 3 * t), (u1, 3 * t + 1), (u2, 3 * u), (s1, 3 * u + 1)];
        self.move_sides(&moved);
        (self.corners[t], self.corners[u]) = ([v2, v0, v3], [v3, v1, v2]);
        (self.lengths[t], self.lengths[u]) = (left, right);
        for (here, there) in [(3 * t + 2, 3 * u + 2), (3 * u + 2, 3 * t + 2)] {
            self.glue[here] = index(there);
            self.is_same_way[here] = false;
        }
        Some(moved.map(|(_, new)| new))
    }

    /// Reads a triangle the other way round.
    fn turn_over(&mut self, triangle: usize) {
        let [a, b, c] = self.corners[triangle];
        let [ab, bc, ca] = self.lengths[triangle];
        let first = 3 * triangle;
        self.move_sides(&[(first, first + 2), (first + 1, first + 1), (first + 2, first)]);
        self.corners[triangle] = [a, c, b];
        self.lengths[triangle] = [ca, bc, ab];
        for side in first..first + 3 {
            let partner = self.glue[side];
            // A side glued to the same triangle turns with its partner.
            if partner != NONE && partner as usize / 3 != triangle {
                self.is_same_way[side] = !self.is_same_way[side];
                self.is_same_way[partner as usize] = self.is_same_way[side];
            }
        }
    }

    /// Gives sides new places with what they are glued to; some of them may be glued to one another.
    fn move_sides(&mut self, moved: &[(usize, usize)]) {
        let place = |side: u32| {
            moved.iter().find(|(old, _)| *old == side as usize).map_or(side, |&(_, new)| index(new))
        };
        let taken: Vec<(usize, u32, bool)> =
            moved.iter().map(|&(old, new)| (new, place(self.glue[old]), self.is_same_way[old])).collect();
        for (new, partner, is_same_way) in taken {
            self.glue[new] = partner;
            self.is_same_way[new] = is_same_way;
            if partner != NONE {
                self.glue[partner as usize] = index(new);
                self.is_same_way[partner as usize] = is_same_way;
            }
        }
    }
}

fn index(side: usize) -> u32 {
    u32::try_from(side).expect("a domain counts its sides in 32 bits")
}

/// The area by Kahan's form of Heron's formula; 0 when the lengths make no triangle, or are not numbers.
fn area(lengths: [f64; 3]) -> f64 {
    let mut sorted = lengths;
    sorted.sort_by(|x, y| y.total_cmp(x));
    let [a, b, c] = sorted;
    let product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    if product > 0.0 && product.is_finite() { 0.25 * libm::sqrt(product) } else { 0.0 }
}
