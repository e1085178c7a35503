//! What can be wrong with a cage, and with what is asked of the surface over it.

use thiserror::Error;

/// Largest number of faces round a vertex, and of corners of a face. Beyond 64 the pieces of a surface that meet there are
/// squeezed to slivers (recipe, section 10); the limit keeps hostile input from costing more than it can show.
pub const MOST_VALENCE: usize = 256;

/// Largest coordinate of a cage: products of three must stay finite by a wide margin.
pub const LARGEST_COORDINATE: f64 = 1e60;

/// Why there is no surface over a cage, or no point of it.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum CageError {
    /// The cage has no face at all.
    #[error("the cage has no faces")]
    NoFaces,
    /// More vertices or corners than 32-bit indices can name.
    #[error("the cage has too many vertices or corners")]
    TooMany,
    /// A coordinate is not finite, or larger than [`LARGEST_COORDINATE`].
    #[error("vertex {vertex} has a coordinate that is not finite or exceeds 1e60")]
    Position {
        /// The vertex.
        vertex: u32,
    },
    /// A new set of positions has another length than the cage.
    #[error("{found} positions are given for {vertices} vertices")]
    PositionCount {
        /// How many were given.
        found: usize,
        /// How many are needed.
        vertices: usize,
    },
    /// A face has less than three corners.
    #[error("face {face} has {corners} corners and needs 3 at least")]
    TooFewCorners {
        /// The face.
        face: u32,
        /// How many it has.
        corners: usize,
    },
    /// A face has more than [`MOST_VALENCE`] corners: divide it.
    #[error("face {face} has {corners} corners and may have {MOST_VALENCE} at most")]
    TooManyCorners {
        /// The face.
        face: u32,
        /// How many it has.
        corners: usize,
    },
    /// A face names a vertex that does not exist. Vertices count from 0.
    #[error("face {face} names vertex {vertex}, and there are {count}")]
    NoSuchVertex {
        /// The face.
        face: u32,
        /// The name.
        vertex: u32,
        /// How many vertices there are.
        count: usize,
    },
    /// A face has the same vertex at two corners.
    #[error("face {face} has vertex {vertex} at two corners")]
    RepeatedVertex {
        /// The face.
        face: u32,
        /// The vertex.
        vertex: u32,
    },
    /// More than two faces meet at an edge.
    #[error("{faces} faces meet at the edge {from}-{to}; two at most may")]
    ManyFacesAtEdge {
        /// The smaller end of the edge.
        from: u32,
        /// The larger end.
        to: u32,
        /// How many meet there.
        faces: usize,
    },
    /// Two neighbours run along their edge in the same direction: turn one of them round.
    #[error("faces {first} and {second} run in the same direction along the edge {from}-{to}")]
    Winding {
        /// A face.
        first: u32,
        /// Its neighbour.
        second: u32,
        /// Where both begin.
        from: u32,
        /// Where both end.
        to: u32,
    },
    /// The faces at a vertex do not form one fan: give each fan a vertex of its own.
    #[error("the faces at vertex {vertex} form more than one fan")]
    TwoFans {
        /// The vertex.
        vertex: u32,
    },
    /// Less than three faces meet at a vertex inside, and there is no such construction.
    #[error("only {valence} faces meet at the inner vertex {vertex}; 3 at least must")]
    TooFewFaces {
        /// The vertex.
        vertex: u32,
        /// How many faces meet there.
        valence: usize,
    },
    /// More than [`MOST_VALENCE`] faces meet at a vertex (half as many on the boundary).
    #[error(
        "{valence} faces meet at vertex {vertex}, and {MOST_VALENCE} at most may, or half as many on a boundary"
    )]
    TooManyFaces {
        /// The vertex.
        vertex: u32,
        /// How many faces meet there.
        valence: usize,
    },
    /// Without a split every face must be a quad: choose a rule for the split.
    #[error("face {face} has {corners} corners: without a split every face needs 4")]
    NotQuads {
        /// The face.
        face: u32,
        /// How many corners it has.
        corners: usize,
    },
    /// The order of a Hermite blend makes no sense.
    #[error("a Hermite blend of order {0}: the order lies between 1 and 24")]
    HermiteOrder(u32),
    /// The exponent of a bump makes no sense.
    #[error("a bump with the exponent {0}: it lies between 1 and 8")]
    BumpExponent(u32),
    /// There is no quad of that number.
    #[error("quad {quad} does not exist: there are {count}")]
    NoSuchQuad {
        /// The number.
        quad: usize,
        /// How many there are.
        count: usize,
    },
    /// A parameter lies outside [0, 1].
    #[error("the parameters ({u}, {v}) lie outside [0, 1]")]
    Parameter {
        /// The first parameter.
        u: f64,
        /// The second.
        v: f64,
    },
    /// A quad can be divided into 1 to 256 steps.
    #[error("a resolution of {0}: it lies between 1 and 256")]
    Resolution(usize),
    /// Cage and resolution ask for more than memory should hold: choose a lower resolution.
    #[error("the tessellation would need {0} numbers: choose a lower resolution")]
    TooLarge(usize),
}

impl CageError {
    /// The same with its vertices named as whoever gave the cage names them.
    #[must_use]
    pub fn renamed(mut self, name: impl Fn(u32) -> u32) -> Self {
        match &mut self {
            Self::Position { vertex }
            | Self::NoSuchVertex { vertex, .. }
            | Self::RepeatedVertex { vertex, .. }
            | Self::TwoFans { vertex }
            | Self::TooFewFaces { vertex, .. }
            | Self::TooManyFaces { vertex, .. } => *vertex = name(*vertex),
            Self::ManyFacesAtEdge { from, to, .. } | Self::Winding { from, to, .. } => {
                (*from, *to) = (name(*from), name(*to));
            }
            _ => {}
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn vertices_are_named_as_their_owner_names_them() {
        let name = |vertex: u32| 10 * vertex;
        let winding = CageError::Winding { first: 1, second: 2, from: 3, to: 4 };
        let says = "faces 1 and 2 run in the same direction along the edge 30-40";
        assert_eq!(winding.renamed(name).to_string(), says);
        let fans = CageError::TwoFans { vertex: 7 };
        assert_eq!(fans.renamed(name), CageError::TwoFans { vertex: 70 });
        assert_eq!(CageError::Resolution(7).renamed(name), CageError::Resolution(7));
    }
}
