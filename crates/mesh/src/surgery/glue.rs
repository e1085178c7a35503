//! The glue: two stretches of boundary become one inner curve.
//!
//! Source: Welch 1995, §4.2.2 (mesh surgery). The stretches correspond vertex for vertex; [`Mesh::correspond`] makes them so,
//! and [`Mesh::make_room`] splits edges that would come to join the same two vertices. Closed loops are glued whole; open
//! stretches may have common ends, which sews up a slit. Nothing is asked of orientation. With `n` edges the Euler
//! characteristic grows by `n` less the number of vertices that vanish.

use thiserror::Error;

use crate::{EdgeId, FaceId, Mesh, SourceTag, VertexId};

/// Why two stretches of boundary cannot be glued; what [`Mesh::make_room`] mends comes last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum GlueError {
    /// They do not correspond vertex for vertex. Even them out first.
    #[error("one boundary has {0} vertices here and the other {1}")]
    Unlike(usize, usize),
    /// A stretch has at least two vertices, a loop at least three.
    #[error("a stretch of {0} vertices is too short to be glued")]
    TooShort(usize),
    /// Source nodes belong together one to one.
    #[error("{0} nodes of one boundary cannot belong to {1} of the other")]
    UnlikeNodes(usize, usize),
    /// A node that belongs to one of the other boundary must lie on its own.
    #[error("{0:?} does not lie on the boundary that is to be glued")]
    NotOnRim(VertexId),
    /// Nodes follow one another as they do on their boundary. Turn the boundary round if they run the other way.
    #[error("{0:?} does not follow the node before it in the order of the boundary")]
    OutOfOrder(VertexId),
    /// The two do not follow one another on the boundary.
    #[error("{0:?} and {1:?} do not follow one another on the boundary")]
    NotOnBoundary(VertexId, VertexId),
    /// A vertex can be glued to one other only; open stretches may have their ends in common.
    #[error("{0:?} would be glued twice")]
    Repeated(VertexId),
    /// The two edges would join the same two vertices. Make room first.
    #[error("{0:?} and {1:?} would join the same two vertices")]
    SecondEdge(EdgeId, EdgeId),
    /// The edge would join a vertex with itself. Make room first.
    #[error("{0:?} would begin and end at the same vertex")]
    LoopEdge(EdgeId),
    /// Two triangles would have the same corners. Make room first.
    #[error("{0:?} and {1:?} would lie on one another")]
    SecondFace(FaceId, FaceId),
}

/// Two stretches of boundary that correspond, vertex for vertex in order.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Seam {
    /// The vertices that stay.
    pub kept: Vec<VertexId>,
    /// Those that are laid on them and vanish.
    pub gone: Vec<VertexId>,
    /// Whether both are whole loops.
    pub is_closed: bool,
}

impl Seam {
    /// Pairs of neighbours along the seam, by place.
    fn steps(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (count, is_closed) = (self.kept.len(), self.is_closed);
        let last = if is_closed { count } else { count.saturating_sub(1) };
        (0..last).map(move |place| (place, (place + 1) % count))
    }
}

/// Edges of both stretches, in the order of the seam.
type Pairs = Vec<(EdgeId, EdgeId)>;

impl Mesh {
    /// Whether the stretches can be glued as they are.
    ///
    /// # Errors
    /// See [`GlueError`].
    pub fn can_glue(&self, seam: &Seam) -> Result<(), GlueError> {
        self.pairs(seam).and_then(|pairs| self.find_clash(seam, &pairs))
    }

    /// Lays `gone` on `kept`. Edges and vertices of `kept` stay; where they bear no tag they take over the other's.
    pub fn glue(&mut self, seam: &Seam) {
        debug_assert_eq!(self.can_glue(seam), Ok(()));
        let Ok(pairs) = self.pairs(seam) else { return };
        for (&kept, &gone) in seam.kept.iter().zip(&seam.gone).filter(|(kept, gone)| kept != gone) {
            let corners: Vec<_> = self.wedges(gone).map(|wedge| wedge.corner).collect();
            for corner in corners {
                self.corner[corner.index()] = kept.0;
            }
            self.inherit_point(kept, self.vertex_source(gone));
            self.free_vertex(gone);
        }
        for (kept, gone) in pairs {
            let (side, beyond) = (self.halfedge_of(kept), self.halfedge_of(gone));
            let tag = self.edge_source(kept).or(self.edge_source(gone));
            self.free_edge(gone);
            self.join(side, crate::topology::Outside { edge: kept, twin: Some(beyond) });
            self.edge_source[kept.index()] = tag;
        }
    }

    fn inherit_point(&mut self, v: VertexId, tag: Option<SourceTag>) {
        let own = &mut self.vertex_source[v.index()];
        *own = own.or(tag);
    }

    /// Splits edges and faces until none of them hinders the glue; gives every new vertex with those in whose middle it lies.
    ///
    /// # Errors
    /// What no split can mend. The mesh is as it was then.
    pub fn make_room(&mut self, seam: &Seam) -> Result<Vec<(VertexId, Vec<VertexId>)>, GlueError> {
        if self.can_glue(seam) == Ok(()) {
            return Ok(Vec::new());
        }
        let mut trial = self.clone();
        let made = trial.split_for_glue(seam)?;
        *self = trial;
        Ok(made)
    }

    fn split_for_glue(&mut self, seam: &Seam) -> Result<Vec<(VertexId, Vec<VertexId>)>, GlueError> {
        let mut made = Vec::new();
        // A clash takes two or three splits, and there are at most so many as edges at the seam.
        let around = self.pairs(seam)?.len() + 1;
        for _ in 0..100 * around {
            match self.can_glue(seam) {
                Err(GlueError::SecondEdge(_, edge) | GlueError::LoopEdge(edge)) => {
                    let ends = self.edge_vertices(edge).to_vec();
                    made.push((self.split_edge(edge), ends));
                }
                Err(GlueError::SecondFace(_, face)) => {
                    let corners = self.face_vertices(face).to_vec();
                    made.push((self.split_face(face), corners));
                }
                outcome => return outcome.map(|()| made),
            }
        }
        self.can_glue(seam).map(|()| made)
    }

    /// Splits edges of a stretch of boundary, evenly, until it has `count` vertices; gives every new vertex with the ends
    /// of the edge it lies on and its place between them. The stretch holds them afterwards.
    ///
    /// A stretch that has as many already is left alone.
    pub fn even_out(
        &mut self,
        stretch: &mut Vec<VertexId>,
        count: usize,
    ) -> Vec<(VertexId, [VertexId; 2], f64)> {
        let edges = stretch.len().saturating_sub(1);
        let wanted = count.saturating_sub(1);
        if edges == 0 || wanted <= edges {
            return Vec::new();
        }
        let mut made = Vec::new();
        let old = core::mem::take(stretch);
        for (place, ends) in old.windows(2).enumerate() {
            // As many parts as whole numbers fall into this edge's share.
            let parts = (place + 1) * wanted / edges - place * wanted / edges;
            stretch.push(ends[0]);
            let mut from = ends[0];
            for part in 1..parts {
                let Some(edge) = self.edge_between(from, ends[1]) else { break };
                from = self.split_edge(edge);
                made.push((from, [ends[0], ends[1]], part as f64 / parts as f64));
                stretch.push(from);
            }
        }
        stretch.extend(old.last());
        made
    }

    /// Whether two rims of as many vertices can be laid on one another, but for what [`Mesh::make_room`] mends.
    pub(super) fn check_rims(&self, seam: &Seam) -> Result<(), GlueError> {
        self.pairs(seam).map(drop)
    }

    /// The edge between two vertices that follow one another on the boundary.
    pub(super) fn rim_edge(&self, a: VertexId, b: VertexId) -> Result<EdgeId, GlueError> {
        let are_there = self.has_vertex(a) && self.has_vertex(b);
        let edge = are_there.then(|| self.edge_between(a, b)).flatten();
        edge.filter(|&e| self.is_boundary_edge(e)).ok_or(GlueError::NotOnBoundary(a, b))
    }

    /// The edges that are laid on one another.
    fn pairs(&self, seam: &Seam) -> Result<Pairs, GlueError> {
        let (kept, gone) = (&seam.kept, &seam.gone);
        if kept.len() != gone.len() {
            return Err(GlueError::Unlike(kept.len(), gone.len()));
        }
        if kept.len() < if seam.is_closed { 3 } else { 2 } {
            return Err(GlueError::TooShort(kept.len()));
        }
        let mut seen = vec![false; self.vertex_slots()];
        let last = kept.len() - 1;
        for (place, (&k, &g)) in kept.iter().zip(gone).enumerate() {
            let may_meet = !seam.is_closed && (place == 0 || place == last);
            let both = if k == g && may_meet { vec![k] } else { vec![k, g] };
            for v in both {
                if !self.has_vertex(v) {
                    return Err(GlueError::NotOnBoundary(v, v));
                }
                if core::mem::replace(&mut seen[v.index()], true) {
                    return Err(GlueError::Repeated(v));
                }
            }
        }
        let pair = |(from, to): (usize, usize)| {
            let (one, other) = (self.rim_edge(kept[from], kept[to])?, self.rim_edge(gone[from], gone[to])?);
            // Two common ends and nothing between: an edge cannot be laid on itself.
            if one == other { Err(GlueError::Repeated(kept[from])) } else { Ok((one, other)) }
        };
        seam.steps().map(pair).collect()
    }

    /// The first edge that could not stay if the seam were glued; the second one of a clash can be split.
    fn find_clash(&self, seam: &Seam, pairs: &Pairs) -> Result<(), GlueError> {
        let mut laid = vec![None; self.vertex_slots()];
        for (&kept, &gone) in seam.kept.iter().zip(&seam.gone) {
            laid[gone.index()] = Some(kept);
        }
        let image = |v: VertexId| laid[v.index()].unwrap_or(v);
        let mut is_seam = vec![false; self.edge_slots()];
        pairs.iter().for_each(|&(kept, gone)| (is_seam[kept.index()], is_seam[gone.index()]) = (true, true));
        for (&kept, &gone) in seam.kept.iter().zip(&seam.gone) {
            let mut ends = Vec::new();
            let bundles = if kept == gone { vec![kept] } else { vec![kept, gone] };
            for v in bundles {
                for e in self.edges_at(v) {
                    let far = image(self.other_end(e, v));
                    if far == kept {
                        return Err(GlueError::LoopEdge(e));
                    }
                    ends.push((far, !is_seam[e.index()], e));
                }
            }
            ends.sort_unstable();
            for two in ends.windows(2) {
                // The edges of a pair are meant to meet; in a clash with one of them the other is split.
                if two[0].0 == two[1].0 && two[1].1 {
                    return Err(GlueError::SecondEdge(two[0].2, two[1].2));
                }
            }
        }
        // Faces with the same corners have all their edges in common, at least one of them by the seam.
        let beside = |e: EdgeId| (self.halfedge_of(e).face(), image(self.apex(self.halfedge_of(e))));
        for &(kept, gone) in pairs {
            let ((one, apex), (other, opposite)) = (beside(kept), beside(gone));
            if apex == opposite {
                return Err(GlueError::SecondFace(one, other));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
