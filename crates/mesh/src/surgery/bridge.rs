//! The bridge: a band of triangles closes the space between two boundary loops, or between two stretches of boundary.
//!
//! Source: Fuchs, Kedem, Uselton 1977 (triangulating between contours): a band is a way through the grid of pairs (i, j), one
//! step for each triangle, and the way with the least sum of squared rungs is found by dynamic programming. The two may
//! have any numbers of vertices and lie in one piece or in two. Two loops bridged lower the Euler characteristic by nothing and
//! the number of boundaries by two; two pieces become one, or one piece gets a handle, or, joined the other way, two
//! crosscaps.

use glam::DVec3;
use thiserror::Error;

use crate::topology::Outside;
use crate::{EdgeId, FaceId, Mesh, VertexId};

/// Why two boundaries cannot be bridged.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum BridgeError {
    /// A stretch has at least two vertices, a loop at least three.
    #[error("a boundary of {0} vertices is too short to be bridged")]
    TooShort(usize),
    /// The two do not follow one another on the boundary.
    #[error("{0:?} and {1:?} do not follow one another on the boundary")]
    NotOnBoundary(VertexId, VertexId),
    /// Both boundaries have the vertex, or one has it twice.
    #[error("{0:?} would be bridged to itself")]
    Repeated(VertexId),
    /// Every band would join the ends of this edge a second time. Split it: see [`Mesh::make_room_to_bridge`].
    #[error("{0:?} is in the way of the bridge")]
    SecondEdge(EdgeId),
}

/// How the boundaries run along one another.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sense {
    /// So that the band is wound with the faces at the first edges of both: orientable surfaces stay so.
    Oriented,
    /// The other way round. One orientable piece becomes a one-sided one; of two pieces one must be turned around.
    Reversed,
    /// As they are given: the second in its order along the first in its order.
    AsGiven,
    /// Whichever makes the shorter band.
    Shortest,
}

/// Two boundaries and how they are to be joined.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bridge {
    /// Vertices of the one, in order along the boundary.
    pub one: Vec<VertexId>,
    /// Vertices of the other.
    pub other: Vec<VertexId>,
    /// Source nodes of both. Where loops have as many, three or more, each is joined to one of the other if that can be: in order,
    /// so that they lie nearest to each other.
    pub nodes: [Vec<VertexId>; 2],
    /// Whether both are whole loops. The band of open ones begins and ends at their ends; that of loops anywhere.
    pub is_closed: bool,
    /// Which way.
    pub sense: Sense,
}

/// The band that was made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Bridged {
    /// Its faces in order, wound alike, and with the face at the first edge of the first boundary.
    pub faces: Vec<FaceId>,
    /// The edges across it in order, each from the first boundary to the second. On a closed band the last leads to the first.
    pub rungs: Vec<EdgeId>,
}

/// The rungs as places on both boundaries.
type Way = Vec<(usize, usize)>;

impl Mesh {
    /// Whether the boundaries can be bridged as they are.
    ///
    /// # Errors
    /// See [`BridgeError`].
    pub fn can_bridge(&self, bridge: &Bridge, positions: &[DVec3]) -> Result<(), BridgeError> {
        self.band(bridge, positions).map(|_| ())
    }

    /// Joins the boundaries by a band of triangles, as many as both have edges; the boundaries become inner edges and keep
    /// their tags, the rungs bear none. Positions only choose among the bands.
    ///
    /// ```
    /// use ductile_mesh::{Bridge, Sense, boundary_loops, primitive, summary};
    /// let (mut mesh, positions) = primitive::icosphere(1);
    /// let poles = [2, 40].map(|f| ductile_mesh::FaceId::from_index(f));
    /// mesh.remove_faces(|f| poles.contains(&f));
    /// let [one, other] = boundary_loops(&mesh).try_into().expect("two holes");
    /// mesh.bridge(&Bridge { one, other, nodes: Default::default(), is_closed: true, sense: Sense::Oriented }, &positions)?;
    /// assert_eq!((summary(&mesh).genus, summary(&mesh).is_orientable), (1, true));
    /// # Ok::<(), ductile_mesh::BridgeError>(())
    /// ```
    ///
    /// # Errors
    /// See [`BridgeError`]; the mesh is then untouched.
    pub fn bridge(&mut self, bridge: &Bridge, positions: &[DVec3]) -> Result<Bridged, BridgeError> {
        let (other, way) = self.band(bridge, positions)?;
        let (n, m) = (bridge.one.len(), other.len());
        let at = |(i, j): (usize, usize)| (bridge.one[i % n], other[j % m]);
        let side =
            |v, w| self.edge_between(v, w).map(|e| Outside { edge: e, twin: Some(self.halfedge_of(e)) });
        // What lies beyond each triangle, before any is laid.
        let mut beyond = Vec::with_capacity(way.len());
        for pair in way.windows(2) {
            let ((a, b), (next_a, next_b)) = (at(pair[0]), at(pair[1]));
            let (v, w) = if a == next_a { (b, next_b) } else { (a, next_a) };
            beyond.push(side(v, w).ok_or(BridgeError::NotOnBoundary(v, w))?);
        }
        let is_forward = self.runs_with_face(bridge.one[0], bridge.one[1]);
        let mut bridged = Bridged::default();
        let first = self.add_edge(None);
        bridged.rungs.push(first);
        let mut last = Self::open(first);
        let mut first_side = None;
        for (k, (pair, beyond)) in way.windows(2).zip(beyond).enumerate() {
            let is_end = bridge.is_closed && k + 2 == way.len();
            let rung = if is_end { first } else { self.add_edge(None) };
            let ahead = if is_end { Outside { edge: first, twin: first_side } } else { Self::open(rung) };
            let f = self.add_face();
            let ((a, b), (next_a, next_b)) = (at(pair[0]), at(pair[1]));
            // Against the face at the first boundary: from a vertex over the rung to the other boundary and on along it.
            let (corners, outside, [behind, before]) = if next_a == a {
                ([a, b, next_b], [last, beyond, ahead], [0, 2])
            } else {
                ([next_a, a, b], [beyond, last, ahead], [1, 2])
            };
            if is_forward {
                self.place(f, corners, outside);
            } else {
                // The same triangle the other way round: its sides in reverse order.
                let ([p, q, r], [pq, qr, rp]) = (corners, outside);
                self.place(f, [r, q, p], [qr, pq, rp]);
            }
            let turned = |k: usize| f.halfedge(if is_forward { k } else { [1, 0, 2][k] });
            first_side = first_side.or(Some(turned(behind)));
            last = Outside { edge: rung, twin: Some(turned(before)) };
            bridged.faces.push(f);
            if !is_end {
                bridged.rungs.push(rung);
            }
        }
        Ok(bridged)
    }

    /// Splits the edges that hinder a bridge until none does; gives every new vertex with the ends of the edge in whose
    /// middle it lies.
    ///
    /// # Errors
    /// What no split can mend. The mesh is as it was then.
    pub fn make_room_to_bridge(
        &mut self,
        bridge: &Bridge,
        positions: &[DVec3],
    ) -> Result<Vec<(VertexId, [VertexId; 2])>, BridgeError> {
        let mut trial = self.clone();
        let made = trial.split_for_bridge(bridge, positions)?;
        if !made.is_empty() {
            *self = trial;
        }
        Ok(made)
    }

    fn split_for_bridge(
        &mut self,
        bridge: &Bridge,
        positions: &[DVec3],
    ) -> Result<Vec<(VertexId, [VertexId; 2])>, BridgeError> {
        let mut positions = positions.to_vec();
        positions.resize(self.vertex_slots(), DVec3::ZERO);
        let mut made = Vec::new();
        loop {
            match self.can_bridge(bridge, &positions) {
                // Each split parts two vertices of the boundaries for good, so there is an end.
                Err(BridgeError::SecondEdge(edge)) => {
                    let [a, b] = self.edge_vertices(edge);
                    let v = self.split_edge(edge);
                    positions.resize(self.vertex_slots(), DVec3::ZERO);
                    positions[v.index()] = positions[a.index()].midpoint(positions[b.index()]);
                    made.push((v, [a, b]));
                }
                outcome => return outcome.map(|()| made),
            }
        }
    }

    /// Whether the edge from `v` to `w` runs with the winding of its face.
    fn runs_with_face(&self, v: VertexId, w: VertexId) -> bool {
        self.edge_between(v, w).is_some_and(|e| self.origin(self.halfedge_of(e)) == v)
    }

    /// The other boundary, turned as it is to lie along the first, and the rungs.
    fn band(&self, bridge: &Bridge, positions: &[DVec3]) -> Result<(Vec<VertexId>, Way), BridgeError> {
        let Bridge { one, other, nodes, is_closed, sense } = bridge;
        self.check_boundaries(bridge)?;
        let turned = || other.iter().rev().copied().collect::<Vec<_>>();
        // Two boundaries that both run with their faces lie against one another in opposite order.
        let is_against = self.runs_with_face(one[0], one[1]) == self.runs_with_face(other[0], other[1]);
        let candidates = match sense {
            Sense::AsGiven => vec![other.clone()],
            Sense::Oriented if is_against => vec![turned()],
            Sense::Oriented => vec![other.clone()],
            Sense::Reversed if is_against => vec![other.clone()],
            Sense::Reversed => vec![turned()],
            Sense::Shortest => vec![other.clone(), turned()],
        };
        let mut best: Option<(f64, Vec<VertexId>, Way)> = None;
        let mut blocked = None;
        for other in candidates {
            let pairs = if *is_closed { pair_up([one, &other], nodes, positions) } else { Vec::new() };
            let met = if pairs.is_empty() {
                None
            } else {
                self.shortest(one, &other, *is_closed, (positions, &pairs)).ok()
            };
            match met.map_or_else(|| self.shortest(one, &other, *is_closed, (positions, &[])), Ok) {
                Ok(band) if best.as_ref().is_none_or(|best| band.0 < best.0) => best = Some(band),
                Ok(_) => {}
                Err(error) => blocked = blocked.or(Some(error)),
            }
        }
        best.map(|(_, other, way)| (other, way))
            .ok_or_else(|| blocked.unwrap_or(BridgeError::TooShort(one.len())))
    }

    fn check_boundaries(&self, bridge: &Bridge) -> Result<(), BridgeError> {
        let mut seen = vec![false; self.vertex_slots()];
        for boundary in [&bridge.one, &bridge.other] {
            if boundary.len() < if bridge.is_closed { 3 } else { 2 } {
                return Err(BridgeError::TooShort(boundary.len()));
            }
            for &v in boundary {
                if !self.has_vertex(v) {
                    return Err(BridgeError::NotOnBoundary(v, v));
                }
                if core::mem::replace(&mut seen[v.index()], true) {
                    return Err(BridgeError::Repeated(v));
                }
            }
            let count = boundary.len();
            for k in 0..if bridge.is_closed { count } else { count - 1 } {
                let (v, w) = (boundary[k], boundary[(k + 1) % count]);
                let is_rim = self.edge_between(v, w).is_some_and(|e| self.is_boundary_edge(e));
                if !is_rim {
                    return Err(BridgeError::NotOnBoundary(v, w));
                }
            }
        }
        Ok(())
    }

    /// The shortest band along two boundaries whose orders match; the second may be turned on, if it is a loop.
    fn shortest(
        &self,
        one: &[VertexId],
        other: &[VertexId],
        is_closed: bool,
        guide: Guide<'_>,
    ) -> Result<(f64, Vec<VertexId>, Way), BridgeError> {
        let mut other = other.to_vec();
        let prices = Prices::new(self, one, &other, guide);
        if is_closed {
            other.rotate_left(prices.best_start()?);
        }
        let prices = if is_closed { Prices::new(self, one, &other, guide) } else { prices };
        let (cost, way) = prices.cheapest_way(is_closed)?;
        Ok((cost, other, way))
    }
}

/// Positions, and vertices of the first boundary with those of the second to which they are to be joined.
type Guide<'a> = (&'a [DVec3], &'a [(VertexId, VertexId)]);

/// The nodes of two loops that belong together; none if they have not as many, or less than three.
fn pair_up(
    loops: [&[VertexId]; 2],
    nodes: &[Vec<VertexId>; 2],
    positions: &[DVec3],
) -> Vec<(VertexId, VertexId)> {
    let on =
        |k: usize| -> Vec<VertexId> { loops[k].iter().copied().filter(|v| nodes[k].contains(v)).collect() };
    let (own, theirs) = (on(0), on(1));
    let count = own.len();
    if count < 3 || theirs.len() != count {
        return Vec::new();
    }
    let at = |v: VertexId| positions.get(v.index()).copied().filter(|p| p.is_finite()).unwrap_or(DVec3::ZERO);
    let turned = |by: usize| own.iter().copied().zip(theirs.iter().copied().cycle().skip(by));
    let cost = |by: usize| turned(by).map(|(v, w)| at(v).distance_squared(at(w))).sum::<f64>();
    let best = (0..count).map(|by| (cost(by), by)).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    best.map(|(_, by)| turned(by).collect()).unwrap_or_default()
}

/// What each rung would cost.
struct Prices {
    n: usize,
    m: usize,
    price: Vec<f64>,
    /// The edge that is there already, for the first rung that cannot be.
    blocked: Option<EdgeId>,
}

impl Prices {
    fn new(mesh: &Mesh, one: &[VertexId], other: &[VertexId], (positions, pairs): Guide<'_>) -> Self {
        let (n, m) = (one.len(), other.len());
        let at =
            |v: VertexId| positions.get(v.index()).copied().filter(|p| p.is_finite()).unwrap_or(DVec3::ZERO);
        let distances = one.iter().flat_map(|&a| other.iter().map(move |&b| at(a).distance_squared(at(b))));
        let mut price: Vec<f64> = distances.map(|d| d.min(1e300)).collect();
        // Among equals the band that advances evenly on both.
        let mean = (price.iter().sum::<f64>() / (n * m) as f64).clamp(1e-280, 1e290);
        for (k, price) in price.iter_mut().enumerate() {
            let uneven = (k / m) as f64 / n as f64 - (k % m) as f64 / m as f64;
            *price += 1e-9 * mean * uneven * uneven;
        }
        let places: Vec<_> = pairs
            .iter()
            .filter_map(|(v, w)| Some((one.iter().position(|a| a == v)?, other.iter().position(|b| b == w)?)))
            .collect();
        if !places.is_empty() {
            // Rungs stay between pairs: so the band comes to each of them.
            for (k, price) in price.iter_mut().enumerate() {
                let stretches = places.iter().zip(places.iter().cycle().skip(1));
                let is_between = |k: usize, a: usize, b: usize, n: usize| (k + n - a) % n <= (b + n - a) % n;
                let mut within = stretches.map(|(from, to)| {
                    is_between(k / m, from.0, to.0, n) && is_between(k % m, from.1, to.1, m)
                });
                if !within.any(|is| is) {
                    *price = f64::INFINITY;
                }
            }
        }
        let mut blocked = None;
        let mut place: Vec<_> = other.iter().copied().zip(0..).collect();
        place.sort_unstable();
        for (i, &a) in one.iter().enumerate() {
            for b in mesh.neighbours(a) {
                if let Ok(k) = place.binary_search_by_key(&b, |&(v, _)| v) {
                    price[i * m + place[k].1] = f64::INFINITY;
                    blocked = blocked.or_else(|| mesh.edge_between(a, b));
                }
            }
        }
        Self { n, m, price, blocked }
    }

    fn refusal(&self) -> BridgeError {
        self.blocked.map_or(BridgeError::TooShort(self.n.min(self.m)), BridgeError::SecondEdge)
    }

    /// By how much the second loop is turned on when it lies best along the first.
    fn best_start(&self) -> Result<usize, BridgeError> {
        let samples = self.n.max(self.m);
        let cost = |start: usize| {
            let at = |k: usize| (k * self.n / samples) * self.m + (k * self.m / samples + start) % self.m;
            // A rung that is taken makes a start bad, not impossible: the band may avoid it.
            let worst = 1e3 * self.price.iter().filter(|p| p.is_finite()).fold(0.0, |a, &b| f64::max(a, b));
            (0..samples).map(|k| self.price[at(k)].min(worst)).sum::<f64>()
        };
        let open = (0..self.m).filter(|&start| self.price[start].is_finite());
        open.map(|start| (cost(start), start))
            .min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)))
            .map(|(_, start)| start)
            .ok_or_else(|| self.refusal())
    }

    /// The way through the grid with the least sum of prices, from the first rung to the last.
    ///
    /// On closed bands the last rung is the first again, and no other may occur twice. The first one is the first of its
    /// vertex, so that nothing but it lies in the last column; and around the vertex where the second loop begins half the
    /// first loop comes at the beginning, the other half at the end.
    fn cheapest_way(&self, is_closed: bool) -> Result<(f64, Way), BridgeError> {
        let (n, m) = (self.n, self.m);
        let (last_i, last_j) = if is_closed { (n, m) } else { (n - 1, m - 1) };
        let width = last_j + 1;
        let price = |i: usize, j: usize| {
            let is_twice = (i == n && j < m) || (j == 0 && 2 * i > n) || (j == m && 2 * i <= n);
            if is_closed && is_twice { f64::INFINITY } else { self.price[(i % n) * m + j % m] }
        };
        let mut best = vec![f64::INFINITY; (last_i + 1) * width];
        for i in 0..=last_i {
            for j in 0..=last_j {
                let before = match (i, j) {
                    (0, 0) => 0.0,
                    (0, _) => best[j - 1],
                    (_, 0) => best[(i - 1) * width],
                    _ => best[(i - 1) * width + j].min(best[i * width + j - 1]),
                };
                best[i * width + j] = before + price(i, j);
            }
        }
        let total = best[last_i * width + last_j];
        if !total.is_finite() {
            return Err(self.refusal());
        }
        let (mut i, mut j) = (last_i, last_j);
        let mut way = vec![(i, j)];
        while (i, j) != (0, 0) {
            let by_i = if i > 0 { best[(i - 1) * width + j] } else { f64::INFINITY };
            let by_j = if j > 0 { best[i * width + j - 1] } else { f64::INFINITY };
            if by_i <= by_j {
                i -= 1
            } else {
                j -= 1
            }
            way.push((i, j));
        }
        way.reverse();
        Ok((total, way))
    }
}

#[cfg(test)]
mod tests;
