//! Deleting a vertex: its faces go and the hole is filled without it.
//!
//! Welch 1995, §4.2.3 flips edges away from the vertex until three remain (two on the boundary) and then
//! takes it out. Every such sequence ends in some triangulation of the polygon of its neighbours, and
//! every triangulation whose diagonals are new edges comes from such a sequence. So the triangulation is
//! chosen directly, by the classic recursion over sub-polygons, which finds a filling whenever there is
//! one and the cheapest under a cost per triangle: flips in an unlucky order can get stuck or fold.
//!
//! A vertex inside a control curve leaves its two curve neighbours joined by an edge, which takes the
//! curve on. A vertex on the boundary is snipped off together with its corner.

use super::{Blocked, Track};
use crate::topology::Outside;
use crate::{HalfedgeId, Mesh, VertexId, Wedge};

/// How a vertex will be replaced: positions in its ring stand for vertices.
struct Filling {
    ring: Vec<VertexId>,
    triangles: Vec<[usize; 3]>,
    /// The two ring positions to be joined by the control curve that ran through the vertex.
    line: Option<(usize, usize)>,
}

impl Mesh {
    /// Whether `v` can be deleted.
    ///
    /// # Errors
    /// Control points and ends of control curves stay; a closed curve or boundary loop keeps three
    /// vertices; and some filling of the hole must use new edges only.
    pub fn can_delete(&self, v: VertexId) -> Result<(), Blocked> {
        self.filling(v, &mut |_| 0.0).map(|_| ())
    }

    /// Deletes `v`, choosing the filling that spreads the new edges most evenly over its neighbours.
    pub fn delete_vertex(&mut self, v: VertexId) {
        debug_assert_eq!(self.can_delete(v), Ok(()));
        let valences: Vec<_> = self.neighbours(v).map(|w| (w, self.valence(w))).collect();
        let valence = |w| valences.iter().find(|(x, _)| *x == w).map_or(0, |(_, n)| *n);
        let cost =
            |t: [VertexId; 3]| t.map(|w| f64::from(u32::try_from(valence(w)).unwrap_or(0))).iter().sum();
        let done = self.delete_vertex_by(v, cost);
        debug_assert_eq!(done, Ok(()));
    }

    /// Deletes `v`, filling the hole with the triangles of least total `cost`; an infinite cost forbids a
    /// triangle. The corners come in ring order.
    ///
    /// # Errors
    /// As [`Mesh::can_delete`]; the mesh is then untouched.
    pub fn delete_vertex_by(
        &mut self,
        v: VertexId,
        mut cost: impl FnMut([VertexId; 3]) -> f64,
    ) -> Result<(), Blocked> {
        let filling = self.filling(v, &mut cost)?;
        let tag = filling.line.and_then(|_| self.spokes(v).find_map(|e| self.edge_source(e)));
        let around: Vec<Wedge> = self.wedges(v).collect();
        let spokes: Vec<_> = self.spokes(v).collect();
        let n = filling.ring.len();
        let mut sides: Vec<(usize, usize, Outside)> = around
            .iter()
            .enumerate()
            .map(|(i, w)| (i.min((i + 1) % n), i.max((i + 1) % n), self.outside(w.corner.next())))
            .collect();
        around.iter().for_each(|w| self.free_face(w.face()));
        spokes.into_iter().for_each(|e| self.free_edge(e));
        self.free_vertex(v);
        if filling.triangles.is_empty() {
            self.snip(&filling.ring, sides[0].2);
        }
        for t in filling.triangles {
            self.fill(t, &filling.ring, &mut sides);
        }
        if let Some((i, j)) = filling.line
            && let Some(&(_, _, outside)) = sides.iter().find(|s| (s.0, s.1) == (i.min(j), i.max(j)))
        {
            self.edge_source[outside.edge.index()] = tag;
        }
        Ok(())
    }

    /// Opens the edge beyond a corner that was cut off.
    fn snip(&mut self, ring: &[VertexId], beyond: Outside) {
        self.bare(beyond);
        if let Some(side) = beyond.twin {
            ring.iter().for_each(|&w| self.anchor_at(side, w));
        }
    }

    /// Adds one triangle of a filling; `sides` holds what is known of the edges between ring positions.
    fn fill(&mut self, t: [usize; 3], ring: &[VertexId], sides: &mut Vec<(usize, usize, Outside)>) {
        let f = self.add_face();
        let outside = [(0, 1), (1, 2), (2, 0)].map(|(a, b)| {
            let ends = (t[a].min(t[b]), t[a].max(t[b]));
            let known = sides.iter_mut().find(|s| (s.0, s.1) == ends);
            let beside: HalfedgeId = f.halfedge(a);
            if let Some(side) = known {
                return side.2;
            }
            let edge = self.add_edge(None);
            sides.push((ends.0, ends.1, Outside { edge, twin: Some(beside) }));
            Self::open(edge)
        });
        self.place(f, t.map(|i| ring[i]), outside);
    }

    fn filling(&self, v: VertexId, cost: &mut dyn FnMut([VertexId; 3]) -> f64) -> Result<Filling, Blocked> {
        let track = self.track(v)?;
        let mut ring = Vec::new();
        let closed = self.ring(v, &mut ring);
        let n = ring.len();
        let spokes: Vec<_> = self.spokes(v).collect();
        let place = |e| spokes.iter().position(|&s| s == e).unwrap_or(0);
        let bridge = match track {
            Track::Free => None,
            Track::Along(a, b) => Some((place(a).min(place(b)), place(a).max(place(b)))),
        };
        let line = bridge.filter(|&(i, _)| self.is_source_edge(spokes[i]));
        if let Some((i, j)) = bridge {
            self.check_bridge(v, &ring, closed, (i, j))?;
        }
        if closed && n == 3 && self.face_between(ring[0], ring[1], ring[2]).is_some() {
            return Err(Blocked::SmallestPiece(v));
        }
        let polygons = match bridge {
            Some((i, j)) if closed && j - i > 1 && (i, j) != (0, n - 1) => {
                vec![(i..=j).collect(), (j..n).chain(0..=i).collect()]
            }
            _ => vec![(0..n).collect::<Vec<_>>()],
        };
        let taken = self.joined(&ring);
        let mut triangles = Vec::new();
        for polygon in polygons {
            let mut price = |t: [usize; 3]| cost(t.map(|i| ring[i]));
            cheapest(&polygon, &|i, j| !taken[i * n + j], &mut price, &mut triangles)
                .ok_or(Blocked::NoFilling(v))?;
        }
        Ok(Filling { ring, triangles, line })
    }

    /// Whether the neighbours `i` and `j` of `v` may be joined by the line that ran through `v`.
    fn check_bridge(
        &self,
        v: VertexId,
        ring: &[VertexId],
        closed: bool,
        (i, j): (usize, usize),
    ) -> Result<(), Blocked> {
        let n = ring.len();
        let Some(old) = self.edge_between(ring[i], ring[j]) else { return Ok(()) };
        let beside = j - i == 1 || (closed && (i, j) == (0, n - 1));
        if !closed && n == 2 && self.is_boundary_edge(old) {
            return Err(Blocked::SmallestPiece(v));
        }
        if self.is_source_edge(old) || self.is_boundary_edge(old) {
            return Err(Blocked::SmallestLoop(v));
        }
        if beside { Ok(()) } else { Err(Blocked::SecondEdge(ring[i], ring[j])) }
    }

    /// For every two ring positions, whether their vertices are neighbours.
    fn joined(&self, ring: &[VertexId]) -> Vec<bool> {
        let n = ring.len();
        let mut place: Vec<_> = ring.iter().copied().zip(0..).collect();
        place.sort_unstable();
        let mut joined = vec![false; n * n];
        for (i, &w) in ring.iter().enumerate() {
            for x in self.neighbours_of(w) {
                if let Ok(k) = place.binary_search_by_key(&x, |&(v, _)| v) {
                    joined[i * n + place[k].1] = true;
                }
            }
        }
        joined
    }
}

/// Appends the triangulation of `polygon` with the least total price, using allowed diagonals only.
fn cheapest(
    polygon: &[usize],
    is_allowed: &dyn Fn(usize, usize) -> bool,
    price: &mut dyn FnMut([usize; 3]) -> f64,
    triangles: &mut Vec<[usize; 3]>,
) -> Option<()> {
    let m = polygon.len();
    // best[i m + j]: least price of the sub-polygon i..=j, and the corner that spans its base.
    let mut best = vec![(f64::INFINITY, 0); m * m];
    for width in 1..m {
        for i in 0..m - width {
            let j = i + width;
            let is_side = width == 1 || width == m - 1;
            if !is_side && !is_allowed(polygon[i], polygon[j]) {
                continue;
            }
            best[i * m + j] = if width == 1 { (0.0, i) } else { (f64::INFINITY, i) };
            for k in i + 1..j {
                let rest = best[i * m + k].0 + best[k * m + j].0;
                if rest < best[i * m + j].0 {
                    let total = rest + price([polygon[i], polygon[k], polygon[j]]);
                    if total < best[i * m + j].0 {
                        best[i * m + j] = (total, k);
                    }
                }
            }
        }
    }
    if m > 2 && best[m - 1].0 == f64::INFINITY {
        return None;
    }
    let mut open = vec![(0, m - 1)];
    while let Some((i, j)) = open.pop() {
        if j - i > 1 {
            let k = best[i * m + j].1;
            triangles.push([polygon[i], polygon[k], polygon[j]]);
            open.extend([(i, k), (k, j)]);
        }
    }
    Some(())
}

#[cfg(test)]
mod tests;
