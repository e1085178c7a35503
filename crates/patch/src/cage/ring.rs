//! Rings: the points that the local surface of a vertex runs through, in the order that its formulas want.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*, section 2, counted from 0. The ring of a vertex M in quad
//! `q`, with M at position `k`, is walked counter-clockwise: `E = q[k+1]`, `C = q[k+2]`, then the quad that holds `M -> q[k+3]`. On a
//! boundary, which the paper leaves to future work, *ghosts* complete the ring; each is a fixed combination of vertices, and every
//! boundary curve depends on boundary vertices alone, so surfaces that share those meet without a gap.

use super::links::{Links, name};
use std::f64::consts::PI;

/// How the ring of a boundary vertex is completed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Boundary {
    /// Mirrored at the boundary: the ring continues straight.
    #[default]
    Linear,
    /// Where the neighbour inside has four faces its own surface is continued, which is ten times nearer; else as `Linear`.
    Borrow,
}

/// A point as a combination of vertices, in ascending order, without repetition.
pub(super) type Combination = Vec<(u32, f64)>;

/// The ring of a vertex in the order of its fan.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    /// `C[j]`, opposite in the j-th quad.
    corners: Vec<Combination>,
    /// `E[j]`, between `C[j-1]` and `C[j]`.
    edges: Vec<Combination>,
}

impl Ring {
    pub(super) fn valence(&self) -> usize {
        self.corners.len()
    }

    /// `C[0..n]`, then `E[0..n]`, as seen from the quad that is number `first` in the fan.
    pub(super) fn from(&self, first: usize) -> impl Iterator<Item = &Combination> {
        let n = self.valence();
        let around = move |j: usize| (j + first) % n;
        let corners = (0..n).map(move |j| &self.corners[around(j)]);
        corners.chain((0..n).map(move |j| &self.edges[around(j)]))
    }
}

/// The ring of every vertex that a quad uses; `links` are those of quads. The fan of a ring begins where that of the links does.
pub(super) fn rings(links: &Links, boundary: Boundary) -> Vec<Ring> {
    (0..links.vertex_count()).map(|vertex| ring(links, boundary, vertex)).collect()
}

fn ring(links: &Links, boundary: Boundary, vertex: usize) -> Ring {
    let fan: Vec<usize> = links.fan(vertex).collect();
    let at = |h: usize, steps: usize| lone(links.origin(links.after(h, steps)));
    let corners: Vec<Combination> = fan.iter().map(|&h| at(h, 2)).collect();
    let mut edges: Vec<Combination> = fan.iter().map(|&h| at(h, 1)).collect();
    let Some(&last) = fan.last().filter(|_| links.is_boundary(vertex)) else {
        return Ring { corners, edges };
    };
    edges.push(at(last, 3));
    let borrowed = match (boundary, &fan[..]) {
        (Boundary::Borrow, &[only]) => borrowed_corner(links, only),
        (Boundary::Borrow, &[first, _]) => borrowed_side(links, first),
        _ => None,
    };
    let middle = lone(vertex);
    let ghosts = borrowed.unwrap_or_else(|| match fan.len() {
        1 => mirrored_corner(&middle, &corners, &edges),
        2 => mirrored_side(&middle, &corners, &edges),
        _ => mirrored_fan(&middle, &corners, &edges),
    });
    Ring { corners: [corners, ghosts.corners].concat(), edges: [edges, ghosts.edges].concat() }
}

fn lone(vertex: usize) -> Combination {
    vec![(name(vertex), 1.0)]
}

fn sum(parts: &[(f64, &Combination)]) -> Combination {
    let mut terms: Combination = parts
        .iter()
        .flat_map(|(by, of)| of.iter().map(move |&(vertex, weight)| (vertex, by * weight)))
        .collect();
    // A stable sort keeps the order of addition, so the bits are the same everywhere.
    terms.sort_by_key(|&(vertex, _)| vertex);
    terms.dedup_by(|next, kept| {
        let is_same = next.0 == kept.0;
        if is_same {
            kept.1 += next.1;
        }
        is_same
    });
    terms.retain(|&(_, weight)| weight != 0.0);
    terms
}

/// One quad at the vertex: all four quads are parts of one bilinear patch.
fn mirrored_corner(m: &Combination, c: &[Combination], e: &[Combination]) -> Ring {
    let far = sum(&[(4.0, m), (-2.0, &e[0]), (-2.0, &e[1]), (1.0, &c[0])]);
    Ring {
        corners: vec![sum(&[(2.0, &e[1]), (-1.0, &c[0])]), far, sum(&[(2.0, &e[0]), (-1.0, &c[0])])],
        edges: vec![sum(&[(2.0, m), (-1.0, &e[0])]), sum(&[(2.0, m), (-1.0, &e[1])])],
    }
}

/// Two quads: the others are their mirror images in the points of the boundary.
fn mirrored_side(m: &Combination, c: &[Combination], e: &[Combination]) -> Ring {
    let mirror = |at: &Combination, of: &Combination| sum(&[(2.0, at), (-1.0, of)]);
    Ring { corners: vec![mirror(&e[2], &c[1]), mirror(&e[0], &c[0])], edges: vec![mirror(m, &e[1])] }
}

/// Three quads and more fill a half-plane: mirror images in the points of the boundary parabola through `E[k]`, M and `E[0]`.
fn mirrored_fan(m: &Combination, c: &[Combination], e: &[Combination]) -> Ring {
    let quads = c.len();
    let half = libm::cos(PI / (2 * quads) as f64);
    let mirror = |x: f64, of: &Combination| {
        let [right, left] = [x * (x + half), x * (x - half)].map(|part| part / (2.0 * half * half));
        let middle = 1.0 - x * x / (half * half);
        sum(&[(2.0 * middle, m), (2.0 * right, &e[0]), (2.0 * left, &e[quads]), (-1.0, of)])
    };
    let angle = |j: f64| libm::cos(j * PI / quads as f64);
    Ring {
        corners: (0..quads).rev().map(|j| mirror(angle(j as f64 + 0.5), &c[j])).collect(),
        edges: (1..quads).rev().map(|j| mirror(half * angle(j as f64), &e[j])).collect(),
    }
}

/// The 3 x 3 block of the inner vertex at which `half_edge` begins, if it has four faces, row by row: the row of
/// `half_edge`'s end is the first, and along it the block runs clockwise seen from the inner vertex.
fn block(links: &Links, half_edge: usize) -> Option<[[Combination; 3]; 3]> {
    let centre = links.origin(half_edge);
    if links.is_boundary(centre) || links.valence(centre) != 4 {
        return None;
    }
    let mut fan = [half_edge; 4];
    for j in 1..4 {
        fan[j] = links.turn(fan[j - 1])?;
    }
    let e = fan.map(|h| lone(links.origin(links.after(h, 1))));
    let c = fan.map(|h| lone(links.origin(links.after(h, 2))));
    let ([e0, e1, e2, e3], [c0, c1, c2, c3]) = (e, c);
    Some([[c3, e0, c0], [e3, lone(centre), e1], [c2, e2, c1]])
}

/// A quadratic continued by one step: from its values at 0, 1 and 2 to that at -1.
fn continued(values: [&Combination; 3]) -> Combination {
    sum(&[(3.0, values[0]), (-3.0, values[1]), (1.0, values[2])])
}

/// Ghosts of a boundary vertex with two quads that continue the surface of the vertex inside.
fn borrowed_side(links: &Links, first: usize) -> Option<Ring> {
    // In the first quad `E[1]` is the corner before M: its half-edge runs to M.
    let [boundary, inner, top] = block(links, links.before(first))?;
    let [left, middle, right] = [0, 1, 2].map(|k| continued([&boundary[k], &inner[k], &top[k]]));
    Some(Ring { corners: vec![left, right], edges: vec![middle] })
}

/// Ghosts of a boundary vertex with one quad that continue the surface of the opposite vertex in both directions.
fn borrowed_corner(links: &Links, only: usize) -> Option<Ring> {
    // From `C[0]` the half-edge runs to `E[1]`. With M at (0,0), `E[0]` at (1,0) and `C[0]` at (1,1), row `a` of the block
    // holds the points (a,2), (a,1), (a,0).
    let rows = block(links, links.after(only, 2))?;
    let outward = |b: usize| continued([0, 1, 2].map(|a| &rows[a][2 - b]));
    let downward = |a: usize| continued([2, 1, 0].map(|k| &rows[a][k]));
    let left = [outward(0), outward(1), outward(2)];
    let far = continued([&left[0], &left[1], &left[2]]);
    let [beside, above, _] = left;
    Some(Ring { corners: vec![above, far, downward(1)], edges: vec![beside, downward(0)] })
}
