//! Insertion of edges and curves: two vertices are joined, by flips or by splits.
//!
//! Source: Welch 1995, §4.2.3 (edge insertion, inserting curves). By flips the curve has exactly the given vertices, and
//! no curve may be in its way. By splits every edge in its way gets a vertex: nothing folds, and where the curve crosses
//! another the two share a vertex.

use glam::DVec3;
use thiserror::Error;

use super::channel::{Crossing, Line, channel};
use crate::{EdgeId, Mesh, SourceTag, VertexId};

/// Why two vertices cannot be joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum InsertError {
    /// There is no such vertex.
    #[error("{0:?} is no vertex of the surface")]
    NoVertex(VertexId),
    /// A curve needs two different vertices.
    #[error("{0:?} cannot be joined with itself")]
    Same(VertexId),
    /// They lie in different pieces, or, by flips, a curve lies between them.
    #[error("no way leads from {0:?} to {1:?} that may be taken")]
    NoWay(VertexId, VertexId),
    /// An edge in the way cannot be flipped, since its vertices opposite are joined elsewhere. Splits always work.
    #[error("{0:?} is in the way and cannot be flipped")]
    Stuck(EdgeId),
    /// A curve has two vertices, a closed one three.
    #[error("a curve cannot have only {0} vertices")]
    TooShort(usize),
    /// A curve that is inserted passes every vertex once.
    #[error("the curve passes {0:?} twice")]
    Repeated(VertexId),
    /// Two vertices that follow one another are joined by an edge of a curve already.
    #[error("{0:?} belongs to another curve")]
    Taken(EdgeId),
}

/// A vertex that a curve made where it crosses an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CrossingVertex {
    /// The new vertex.
    pub vertex: VertexId,
    /// The ends of the edge that it halves.
    pub ends: [VertexId; 2],
    /// Its place between them, in (0, 1).
    pub place: f64,
}

/// Triangles at an edge fold the surface when the angle between them is less than a right one: see `fold_after`.
const FOLDED: f64 = 1.0;

/// The vertices along both sides of a channel.
#[derive(Debug, Default)]
struct Banks {
    left: Vec<VertexId>,
    right: Vec<VertexId>,
}

impl Mesh {
    /// Joins two vertices by an edge, flipping what is in the way, and gives that edge. Neighbours have theirs already.
    ///
    /// Of the edges in the way the one goes next whose flip leaves the flattest pair of triangles; where all of them would
    /// fold the surface, others are flipped first (Sloan 1993). Positions guide, and decide nothing else. Refused, it
    /// changes nothing.
    ///
    /// # Errors
    /// See [`InsertError`].
    pub fn insert_edge(
        &mut self,
        from: VertexId,
        to: VertexId,
        positions: &[DVec3],
    ) -> Result<EdgeId, InsertError> {
        let mut across = self.way(from, to, positions, Crossing::FreeEdges)?;
        let banks = self.banks(&across);
        let mut trial = self.clone();
        // Flips that leave an edge in the way prepare others; in the plane fewer than this many are ever needed.
        let mut preparations = across.len() * across.len();
        while !across.is_empty() {
            let fold = |e: EdgeId| trial.fold_after(e, positions);
            let leaving = across.iter().copied().filter(|&e| trial.can_leave(e, &banks));
            let Some(flattest) = leaving.min_by(|&a, &b| fold(a).total_cmp(&fold(b))) else {
                return Err(InsertError::Stuck(across[0]));
            };
            let is_free = |e: &EdgeId| fold(*e) < FOLDED && trial.can_flip(*e).is_ok();
            let index = |e: EdgeId| across.iter().position(|&other| other == e).unwrap_or(0);
            match across.iter().copied().find(is_free) {
                Some(other) if fold(flattest) >= FOLDED && preparations > 0 => {
                    preparations -= 1;
                    let place = index(other);
                    trial.flip(other);
                    // The others first, before this one is flipped back.
                    across[place..].rotate_left(1);
                }
                _ => {
                    let place = index(flattest);
                    trial.flip(flattest);
                    across.remove(place);
                }
            }
        }
        let edge = trial.edge_between(from, to).ok_or(InsertError::NoWay(from, to))?;
        *self = trial;
        Ok(edge)
    }

    /// Makes a curve that has exactly these vertices, in order, flipping what is in the way, and gives its edges, tagged.
    ///
    /// Each leg is laid as [`Mesh::insert_edge`] lays one; the curves that are there, and the legs that are laid already, are
    /// not crossed. A closed curve joins the last vertex with the first. Refused, it changes nothing.
    ///
    /// # Errors
    /// See [`InsertError`].
    pub fn insert_curve(
        &mut self,
        vertices: &[VertexId],
        is_closed: bool,
        positions: &[DVec3],
        tag: SourceTag,
    ) -> Result<Vec<EdgeId>, InsertError> {
        if vertices.len() < if is_closed { 3 } else { 2 } {
            return Err(InsertError::TooShort(vertices.len()));
        }
        let mut is_passed = vec![false; self.vertex_slots()];
        for &v in vertices {
            if !self.has_vertex(v) {
                return Err(InsertError::NoVertex(v));
            }
            if core::mem::replace(&mut is_passed[v.index()], true) {
                return Err(InsertError::Repeated(v));
            }
        }
        let mut trial = self.clone();
        let mut edges = Vec::with_capacity(vertices.len());
        let next = vertices.iter().skip(1).chain(is_closed.then_some(&vertices[0]));
        for (&from, &to) in vertices.iter().zip(next) {
            let edge = trial.insert_edge(from, to, positions)?;
            if trial.edge_source(edge).is_some() {
                return Err(InsertError::Taken(edge));
            }
            trial.set_edge_source(edge, Some(tag));
            edges.push(edge);
        }
        *self = trial;
        Ok(edges)
    }

    /// Joins two vertices by a chain of edges, splitting what is in the way; gives the vertices made, in order.
    ///
    /// The chain is `from`, the new vertices, `to`. Split edges of curves pass their tags on, so a crossing belongs to
    /// both curves.
    ///
    /// # Errors
    /// See [`InsertError`].
    pub fn insert_chain(
        &mut self,
        from: VertexId,
        to: VertexId,
        positions: &[DVec3],
    ) -> Result<Vec<CrossingVertex>, InsertError> {
        let across = self.way(from, to, positions, Crossing::Curves)?;
        let at = |v: VertexId| positions.get(v.index()).copied().unwrap_or(DVec3::ZERO);
        let line = Line::straight(at(from), at(to));
        let mut made = Vec::with_capacity(across.len());
        for edge in across {
            let ends = self.edge_vertices(edge);
            let place = line.crossing(at(ends[0]), at(ends[1]));
            made.push(CrossingVertex { vertex: self.split_edge(edge), ends, place });
        }
        Ok(made)
    }

    fn way(
        &self,
        from: VertexId,
        to: VertexId,
        positions: &[DVec3],
        crossing: Crossing,
    ) -> Result<Vec<EdgeId>, InsertError> {
        if let Some(&nobody) = [from, to].iter().find(|&&v| !self.has_vertex(v)) {
            return Err(InsertError::NoVertex(nobody));
        }
        if from == to {
            return Err(InsertError::Same(from));
        }
        let at = |v: VertexId| positions.get(v.index()).copied().unwrap_or(DVec3::ZERO);
        let line = Line::straight(at(from), at(to));
        channel(self, positions, from, to, line, crossing).ok_or(InsertError::NoWay(from, to))
    }

    /// The vertices on either bank of a channel.
    fn banks(&self, across: &[EdgeId]) -> Banks {
        let mut banks = Banks::default();
        let mut before: Option<[VertexId; 2]> = None;
        for &edge in across {
            let [a, b] = self.edge_vertices(edge);
            // Neighbouring edges share the vertex of one bank; the other vertex is new on the other bank.
            let is_turned = before.is_some_and(|[left, right]| a == right || b == left);
            let [left, right] = if is_turned { [b, a] } else { [a, b] };
            banks.left.push(left);
            banks.right.push(right);
            before = Some([left, right]);
        }
        banks
    }

    /// Whether `e` can be flipped to an edge that does not cross the channel.
    fn can_leave(&self, e: EdgeId, banks: &Banks) -> bool {
        let (c, Some(d)) = self.edge_opposites(e) else { return false };
        let crosses = |c, d| banks.left.contains(&c) && banks.right.contains(&d);
        !crosses(c, d) && !crosses(d, c) && self.can_flip(e).is_ok()
    }

    /// How far the two triangles at `e` would be from lying in one plane once it is flipped, in [0, 2].
    fn fold_after(&self, e: EdgeId, positions: &[DVec3]) -> f64 {
        let (c, Some(d)) = self.edge_opposites(e) else { return 2.0 };
        let at = |v: VertexId| positions.get(v.index()).copied().unwrap_or(DVec3::ZERO);
        let [a, b] = self.edge_vertices(e);
        let normal = |p: VertexId, q: VertexId, r: VertexId| {
            (at(q) - at(p)).cross(at(r) - at(p)).try_normalize().unwrap_or(DVec3::ZERO)
        };
        1.0 - normal(c, a, d).dot(normal(d, b, c))
    }
}

#[cfg(test)]
mod tests;
