//! Why triangles have no relief, or cannot take one.

use thiserror::Error;

/// Why triangles have no relief, or cannot take one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ReliefError {
    /// There are no triangles, or one names a vertex that does not exist.
    #[error("it has no triangles")]
    Empty,
    /// The triangles meet like no surface does: three at an edge, or two fans at a vertex.
    #[error("it is pinched: more than two of its triangles meet at an edge, or its rim meets itself")]
    Pinched,
    /// They are in several pieces.
    #[error("it is in {0} pieces; only a disc can be stamped or be a stamp")]
    Pieces(usize),
    /// They have one side.
    #[error("it has one side; only a disc can be stamped or be a stamp")]
    OneSided,
    /// They are closed.
    #[error("it is closed and has no rim; only a disc can be stamped or be a stamp")]
    Closed,
    /// They have several rims, or handles.
    #[error("it has {rims} rims and {handles} handles; only a disc can be stamped or be a stamp")]
    NoDisc {
        /// How many rims.
        rims: usize,
        /// How many handles.
        handles: usize,
    },
    /// The rim encloses nothing, or triangles have no area.
    #[error("its rim encloses no area")]
    Flat,
}
