//! The channel: the triangles that a curve between two vertices would run through, and the edges across it.
//!
//! Source: Welch 1995, §4.2.3 (edge insertion). The channel has no vertex inside; positions only guide the search, which takes
//! the shortest way over places on the edges that a [`Line`] names; what lies aside of the line counts as a way, too.
//! Where curves may not be crossed it goes round them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::DVec3;

use crate::{EdgeId, HalfedgeId, Mesh, VertexId};

/// What a channel may cross.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Crossing {
    /// Edges of no curve.
    FreeEdges,
    /// Curves too.
    Curves,
}

/// Crossings nearer to an end of an edge than this would leave a needle.
const MARGIN: f64 = 0.05;

/// Total order of lengths: NaN comes last.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Length(f64);

impl Eq for Length {}

impl Ord for Length {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        self.0.total_cmp(&other.0)
    }
}

impl PartialOrd for Length {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

/// The straight line between two vertices, and which place on an edge it is to cross.
#[derive(Clone, Copy, Debug)]
pub(super) struct Line {
    from: DVec3,
    to: DVec3,
    /// The normal of the plane that the line follows over the surface; zero where it is on its own.
    across: DVec3,
}

impl Line {
    /// The line that crosses edges where it comes nearest to them.
    pub(super) const fn straight(from: DVec3, to: DVec3) -> Self {
        Self { from, to, across: DVec3::ZERO }
    }

    /// The line that crosses edges in the plane through it which stands on the surface: over a sphere the great circle.
    ///
    /// Of the normals at its ends only the directions count. The sum or the difference stands on the surface between them,
    /// whichever is more upright on the line.
    pub(super) fn upright(from: DVec3, to: DVec3, normals: [DVec3; 2]) -> Self {
        let way = to - from;
        let [sum, difference] = [normals[0] + normals[1], normals[0] - normals[1]].map(|n| way.cross(n));
        let across = if difference.length_squared() > sum.length_squared() { difference } else { sum };
        // Where line and normals run alike, no plane stands out.
        let is_plane = across.length_squared() > 1e-4 * way.length_squared();
        Self { from, to, across: if is_plane { across } else { DVec3::ZERO } }
    }

    /// Where the line crosses that through `a` and `b`, as a share of the way from `a` to `b`; one half where that is no
    /// number.
    pub(super) fn share(&self, a: DVec3, b: DVec3) -> f64 {
        let share = if self.across == DVec3::ZERO {
            let (line, edge, between) = (self.to - self.from, b - a, a - self.from);
            let (l, m, e) = (line.length_squared(), line.dot(edge), edge.length_squared());
            (line.dot(between) * m - edge.dot(between) * l) / (l * e - m * m)
        } else {
            self.across.dot(self.from - a) / self.across.dot(b - a)
        };
        if share.is_finite() { share } else { 0.5 }
    }

    /// How far a place is off the plane that the line follows; zero where it is on its own.
    fn aside(&self, at: DVec3) -> f64 {
        let off = self.across.dot(at - self.from) / self.across.length();
        if off.is_finite() { off.abs() } else { 0.0 }
    }

    /// [`Line::share`] within the margins.
    pub(super) fn crossing(&self, a: DVec3, b: DVec3) -> f64 {
        self.share(a, b).clamp(MARGIN, 1.0 - MARGIN)
    }
}

/// How a side was entered: the way so far, and the side before it.
#[derive(Clone, Copy, Debug)]
struct Entered {
    length: f64,
    after: Option<HalfedgeId>,
}

/// The edges across the channel from `from` to `to`, in order; `None` where there is no way. Empty for neighbours.
pub(super) fn channel(
    mesh: &Mesh,
    positions: &[DVec3],
    from: VertexId,
    to: VertexId,
    line: Line,
    crossing: Crossing,
) -> Option<Vec<EdgeId>> {
    if mesh.are_neighbours(from, to) {
        return Some(Vec::new());
    }
    let place = |v: VertexId| positions.get(v.index()).copied().unwrap_or(DVec3::ZERO);
    let gate = |e: EdgeId| {
        let [a, b] = mesh.edge_vertices(e).map(place);
        a.lerp(b, line.crossing(a, b))
    };
    // The side beyond a side, if one may go there; over edges at either end one would only go round it.
    let beyond = |h: HalfedgeId| {
        let edge = mesh.edge_of(h);
        let is_open = !mesh.edge_vertices(edge).iter().any(|&v| v == from || v == to)
            && (crossing == Crossing::Curves || !mesh.is_source_edge(edge));
        mesh.twin(h).filter(|_| is_open)
    };
    let mut entered: Vec<Option<Entered>> = vec![None; 3 * mesh.face_slots()];
    let mut ahead = BinaryHeap::new();
    let mut enter =
        |side: HalfedgeId, after: Option<HalfedgeId>, at: DVec3, before: f64, ahead: &mut BinaryHeap<_>| {
            let here = gate(mesh.edge_of(side));
            // A gate that the plane does not cross would be a short cut on the wrong side of a vertex.
            let mut length = before + at.distance(here) + line.aside(here);
            if mesh.apex(side) == to {
                length += here.distance(place(to));
            }
            let old = &mut entered[side.index()];
            if old.is_none_or(|old| length.total_cmp(&old.length).is_lt()) {
                *old = Some(Entered { length, after });
                ahead.push(Reverse((Length(length), side)));
            }
        };
    for wedge in mesh.wedges(from) {
        if let Some(side) = beyond(wedge.corner.next()) {
            enter(side, None, place(from), 0.0, &mut ahead);
        }
    }
    while let Some(Reverse((Length(length), side))) = ahead.pop() {
        if mesh.apex(side) == to {
            return Some(trace(mesh, &entered, side));
        }
        let at = gate(mesh.edge_of(side));
        for next in [side.next(), side.prev()] {
            if let Some(far) = beyond(next) {
                enter(far, Some(side), at, length, &mut ahead);
            }
        }
    }
    None
}

/// The edges by which a side was reached, its own at the end.
fn trace(mesh: &Mesh, entered: &[Option<Entered>], last: HalfedgeId) -> Vec<EdgeId> {
    let mut edges = Vec::new();
    let mut side = Some(last);
    while let Some(here) = side {
        edges.push(mesh.edge_of(here));
        side = entered[here.index()].and_then(|entered| entered.after);
    }
    edges.reverse();
    edges
}
