//! Mesh surgery. Splits, flips, collapses and deletions cannot change the surface's kind; cuts and glue do, as they say.
//!
//! The former are Alexander moves and their compositions (Welch 1995, §4.2.3). Whatever their order, the Euler
//! characteristic, the number of boundary loops and orientability stay the same, control points stay
//! alive, and control curves stay connected. Nothing here looks at positions.
//!
//! Check and act are a pair: `can_x` says whether and why not; `x` asserts in debug that it may.
//! Elements that survive keep their handles. New faces are wound like the ones they replace.

mod bridge;
mod channel;
mod collapse;
mod correspond;
mod cut;
mod delete;
mod flip;
mod glue;
mod insert;
mod path;
mod remove;
mod sites;
mod split;

pub use bridge::{Bridge, BridgeError, Bridged, Sense};
pub use correspond::OnEdge;
pub use cut::{Cut, CutError};
pub use glue::{GlueError, Seam};
pub use insert::{CrossingVertex, InsertError};
pub use path::{Meeting, Path, PathError};
pub use remove::Removed;

use thiserror::Error;

use crate::{EdgeId, Mesh, VertexId};

/// Why a move on the mesh is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum Blocked {
    /// A boundary edge has no second face to flip into. Split it instead.
    #[error("{0:?} lies on the boundary")]
    BoundaryEdge(EdgeId),
    /// The edge carries a control curve. Change the curve, or clear its tag first.
    #[error("{0:?} belongs to a control curve")]
    SourceEdge(EdgeId),
    /// The vertex is a control point. Clear its tag first.
    #[error("{0:?} is a control point")]
    SourceVertex(VertexId),
    /// The move would join these two a second time. Split the edge between them first.
    #[error("{0:?} and {1:?} would be joined by a second edge")]
    SecondEdge(VertexId, VertexId),
    /// The two are not joined by an edge.
    #[error("{0:?} and {1:?} are not neighbours")]
    NotNeighbours(VertexId, VertexId),
    /// The link condition fails: both are joined to the third without spanning a face with it, so that
    /// the collapse would pinch the surface there.
    #[error("{0:?} and {1:?} are both joined to {2:?} without a face between")]
    CommonNeighbour(VertexId, VertexId, VertexId),
    /// The piece of surface around the vertex has no face to spare: it is a tetrahedron, or a triangle.
    #[error("the piece around {0:?} is as small as it can be")]
    SmallestPiece(VertexId),
    /// A boundary vertex may only go along the boundary, towards a boundary neighbour.
    #[error("{0:?} would leave the boundary")]
    LeavesBoundary(VertexId),
    /// A vertex inside a control curve may only go along the curve.
    #[error("{0:?} would leave its control curve")]
    LeavesCurve(VertexId),
    /// A control curve ends, forks, changes its tag or leaves the boundary here.
    #[error("a control curve ends or forks at {0:?}")]
    CurveEnd(VertexId),
    /// The closed curve or boundary loop through the vertex has three vertices and can spare none.
    #[error("the loop through {0:?} has only three vertices")]
    SmallestLoop(VertexId),
    /// Every way to fill the hole that the vertex would leave uses an edge that is already elsewhere.
    #[error("the hole left by {0:?} cannot be filled")]
    NoFilling(VertexId),
}

/// How the source curves and the boundary run through a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Track {
    /// Neither curve nor boundary: the vertex is free to go anywhere.
    Free,
    /// Exactly one line passes through, along these two edges.
    Along(EdgeId, EdgeId),
}

impl Mesh {
    /// How lines pass through `v`, or why `v` may not be removed at all.
    pub(crate) fn track(&self, v: VertexId) -> Result<Track, Blocked> {
        if self.is_source_vertex(v) {
            return Err(Blocked::SourceVertex(v));
        }
        let mut tagged = 0;
        let mut source: Option<(EdgeId, EdgeId)> = None;
        let mut rim: Option<(EdgeId, EdgeId)> = None;
        let add = |pair: &mut Option<(EdgeId, EdgeId)>, e| *pair = Some(pair.map_or((e, e), |(a, _)| (a, e)));
        for e in self.edges_at(v) {
            if self.is_source_edge(e) {
                tagged += 1;
                add(&mut source, e);
            }
            if self.is_boundary_edge(e) {
                add(&mut rim, e);
            }
        }
        match (source, rim) {
            (None, None) => Ok(Track::Free),
            (None, Some((a, b))) => Ok(Track::Along(a, b)),
            (Some((a, b)), None) if tagged == 2 && self.edge_source(a) == self.edge_source(b) => {
                Ok(Track::Along(a, b))
            }
            (Some(curve), Some(loop_))
                if tagged == 2
                    && curve == loop_
                    && self.edge_source(curve.0) == self.edge_source(curve.1) =>
            {
                Ok(Track::Along(curve.0, curve.1))
            }
            _ => Err(Blocked::CurveEnd(v)),
        }
    }
}

#[cfg(test)]
mod tests;
