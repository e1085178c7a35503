//! The cut: a surface is opened along edges, which become boundary on both sides.
//!
//! Source: Welch 1995, §4.2.2 (mesh surgery). Along a closed curve every vertex is doubled, along an open one only those
//! in its middle, which leaves a slit; where a curve reaches the boundary, or curves cross, a vertex falls into as many
//! copies as there are fans between the cuts. Nothing is asked of orientation: the core of a Möbius strip can be cut.
//! With `n` edges the Euler characteristic grows by the number of copies less `n`.

use thiserror::Error;

use crate::{EdgeId, HalfedgeId, Mesh, VertexId, Wedge};

/// Why a surface cannot be opened along some edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CutError {
    /// There is no such edge.
    #[error("{0:?} is no edge of the surface")]
    NoEdge(EdgeId),
    /// There is nothing beyond it to be cut from.
    #[error("{0:?} lies on the boundary already")]
    OnBoundary(EdgeId),
    /// Both its ends lie inside and are ends of the cut: two edges would join them. Split it first.
    #[error("{0:?} cannot be opened alone: a slit takes two edges")]
    LoneEdge(EdgeId),
}

/// What a cut made.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    /// Vertices, and their copies beyond the cut. One that falls into more than two parts occurs more than once.
    pub vertices: Vec<(VertexId, VertexId)>,
    /// Edges, and their copies beyond the cut.
    pub edges: Vec<(EdgeId, EdgeId)>,
}

/// The faces around a vertex between two cuts: the corners at it.
type Fan = Vec<HalfedgeId>;

/// A vertex on the cut.
struct Place {
    vertex: VertexId,
    fans: Vec<Fan>,
    /// The fan that keeps the vertex.
    kept: Option<usize>,
}

impl Mesh {
    /// Whether the surface can be opened along these edges, all at once. Edges named twice count once.
    ///
    /// # Errors
    /// No such edge; one on the boundary; one whose ends would both be ends of a slit.
    pub fn can_cut(&self, edges: &[EdgeId]) -> Result<(), CutError> {
        let is_cut = self.marked(edges)?;
        let stays = |v: VertexId| {
            let cuts = self.edges_at(v).filter(|e| is_cut[e.index()]).count();
            cuts == 1 && !self.is_boundary_vertex(v)
        };
        let lone = edges.iter().find(|&&e| self.edge_vertices(e).into_iter().all(stays));
        lone.map_or(Ok(()), |&e| Err(CutError::LoneEdge(e)))
    }

    /// Opens the surface along these edges. Tags are copied with what bears them.
    ///
    /// Along a two-sided curve the originals all stay on one side, that of the first edge's own face. Anchors of the
    /// vertices may change.
    pub fn cut(&mut self, edges: &[EdgeId]) -> Cut {
        debug_assert_eq!(self.can_cut(edges), Ok(()));
        let Ok(is_cut) = self.marked(edges) else { return Cut::default() };
        let mut places = self.places(edges, &is_cut);
        let sides = self.kept_sides(edges, &is_cut, &mut places);
        let mut cut = Cut::default();
        for (e, kept) in sides {
            let Some(gone) = self.twin(kept) else { continue };
            let copy = self.add_edge(self.edge_source(e));
            self.join(kept, Self::open(e));
            self.join(gone, Self::open(copy));
            cut.edges.push((e, copy));
        }
        for place in places {
            let kept = place.kept.unwrap_or(0);
            for (index, fan) in place.fans.iter().enumerate() {
                let vertex = if index == kept {
                    place.vertex
                } else {
                    let copy = self.add_vertex();
                    self.vertex_source[copy.index()] = self.vertex_source(place.vertex);
                    cut.vertices.push((place.vertex, copy));
                    copy
                };
                for corner in fan {
                    self.corner[corner.index()] = vertex.0;
                    self.anchor[vertex.index()] = corner.0;
                }
            }
        }
        cut
    }

    /// Which edges are cut, by index.
    fn marked(&self, edges: &[EdgeId]) -> Result<Vec<bool>, CutError> {
        let mut is_cut = vec![false; self.edge_slots()];
        for &e in edges {
            if !self.has_edge(e) {
                return Err(CutError::NoEdge(e));
            }
            if self.is_boundary_edge(e) {
                return Err(CutError::OnBoundary(e));
            }
            is_cut[e.index()] = true;
        }
        Ok(is_cut)
    }

    /// The vertices on the cut, in order of first mention, with the fans between the cuts.
    fn places(&self, edges: &[EdgeId], is_cut: &[bool]) -> Vec<Place> {
        let mut seen = vec![false; self.vertex_slots()];
        let mut places = Vec::new();
        for vertex in edges.iter().flat_map(|&e| self.edge_vertices(e)) {
            if !core::mem::replace(&mut seen[vertex.index()], true) {
                places.push(Place { vertex, fans: self.fans(vertex, is_cut), kept: None });
            }
        }
        places
    }

    fn fans(&self, v: VertexId, is_cut: &[bool]) -> Vec<Fan> {
        let mut wedges: Vec<Wedge> = self.wedges(v).collect();
        let begins = |w: &Wedge| is_cut[self.edge_of(w.entry()).index()];
        if !self.is_boundary_vertex(v) {
            let first = wedges.iter().position(begins).unwrap_or(0);
            wedges.rotate_left(first);
        }
        let mut fans: Vec<Fan> = Vec::new();
        for wedge in &wedges {
            match fans.last_mut().filter(|_| !begins(wedge)) {
                Some(fan) => fan.push(wedge.corner),
                None => fans.push(vec![wedge.corner]),
            }
        }
        fans
    }

    /// The side of every edge that stays with it; says which fans keep their vertex.
    ///
    /// From an edge the choice is handed on over its ends to the next edges, so that a curve keeps to one side.
    fn kept_sides(
        &self,
        edges: &[EdgeId],
        is_cut: &[bool],
        places: &mut [Place],
    ) -> Vec<(EdgeId, HalfedgeId)> {
        let mut place_of = vec![usize::MAX; self.vertex_slots()];
        for (index, place) in places.iter().enumerate() {
            place_of[place.vertex.index()] = index;
        }
        let mut is_settled = vec![false; self.edge_slots()];
        let mut sides = Vec::new();
        for &first in edges {
            let mut ahead = vec![(first, self.halfedge_of(first))];
            while let Some((e, side)) = ahead.pop() {
                if core::mem::replace(&mut is_settled[e.index()], true) {
                    continue;
                }
                sides.push((e, side));
                for v in self.edge_vertices(e) {
                    let place = &mut places[place_of[v.index()]];
                    let holds = |fan: &Fan, side: HalfedgeId| fan.iter().any(|c| c.face() == side.face());
                    if place.kept.is_some() {
                        continue;
                    }
                    let Some(kept) = place.fans.iter().position(|fan| holds(fan, side)) else { continue };
                    place.kept = Some(kept);
                    for next in self.edges_at(v).filter(|next| is_cut[next.index()]) {
                        let h = self.halfedge_of(next);
                        let own = [Some(h), self.twin(h)].into_iter().flatten();
                        let side = own.clone().find(|&side| holds(&place.fans[kept], side)).unwrap_or(h);
                        ahead.push((next, side));
                    }
                }
            }
        }
        sides
    }
}
