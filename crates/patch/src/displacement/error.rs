//! Why a displacement is refused, with the vertex, triangle or item at fault. Indices count from 0.

use super::blend::BlendError;
use thiserror::Error;

/// What is wrong with a mesh or with what should be displaced on it.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum DisplacementError {
    /// A list with a number per vertex has another length.
    #[error("{found} entries are given for {expected} {of_what}")]
    Length {
        /// What each entry belongs to.
        of_what: &'static str,
        /// How many there are.
        expected: usize,
        /// How many entries came.
        found: usize,
    },
    /// A vertex that does not exist.
    #[error("there is no vertex {vertex}: there are {count}")]
    NoVertex {
        /// The index.
        vertex: usize,
        /// The number of vertices.
        count: usize,
    },
    /// A triangle names one vertex twice.
    #[error("triangle {0} uses one vertex twice")]
    RepeatedCorner(usize),
    /// A coordinate is not a number, infinite, or beyond 1e150.
    #[error("vertex {0} has a coordinate that is not a number of at most 1e150")]
    BadPosition(usize),
    /// More vertices or triangles than 32-bit indices can name.
    #[error("the mesh is too large")]
    TooLarge,
    /// More than two triangles share an edge: split the surface there.
    #[error("more than two triangles meet at the edge from vertex {0} to vertex {1}")]
    CrowdedEdge(u32, u32),
    /// A triangle without area has no cotangents; the intrinsic Laplacian takes it unless the whole mesh is a point.
    #[error("triangle {0} has no area")]
    FlatTriangle(usize),
    /// A foot lies where nothing may move, on the boundary or on a pin, or on no triangle.
    #[error("vertex {0} is held in its place, or no triangle uses it")]
    Held(usize),
    /// A part of a closed surface needs a pin somewhere: without one, its harmonic functions are constant.
    #[error("the part of the surface with vertex {0} has neither boundary nor pin: pin a vertex of it")]
    NoBoundary(usize),
    /// The triangles are so bad that the equations cannot be solved.
    #[error("the equations of the surface cannot be solved around vertex {0}: its triangles are too bad")]
    Unsolvable(usize),
    /// Two items share a vertex, or a curve and another item are neighbours: they cannot both be met.
    #[error("items {0} and {1} touch at vertex {2}")]
    Touching(usize, usize, usize),
    /// There is no item of this index.
    #[error("there is no item {0}")]
    NoItem(usize),
    /// A displacement has a coordinate that is not a number of at most 1e150.
    #[error("a displacement of item {0} is not finite")]
    BadDisplacement(usize),
    /// A curve has fewer than two vertices.
    #[error("a curve needs two vertices")]
    ShortCurve,
    /// A curve names a vertex twice, other than to close.
    #[error("the curve goes through vertex {0} twice")]
    CurveCrosses(usize),
    /// Barycentric coordinates lie in [0, 1] and sum to 1.
    #[error("{0:?} are no barycentric coordinates")]
    BadShares([f64; 3]),
    /// A curve must follow edges.
    #[error("no edge joins the vertices {0} and {1} of the curve")]
    NoEdge(usize, usize),
    /// A stretch is outside of [1/64, 64].
    #[error("the stretch {0} is not between 1/64 and 64")]
    BadStretch(f64),
    /// A direction has no length or is not finite.
    #[error("a direction must have a length")]
    BadDirection,
    /// Feet inside each other's plateau cannot be met by `gram`: make ranges smaller or combine them pairwise.
    #[error("the feet lie too deep in each other's range: condition {condition:.1e}, at most {most:.0e}")]
    IllConditioned {
        /// In the 1-norm.
        condition: f64,
        /// What is allowed.
        most: f64,
    },
    /// `gram` and `cardinal` are for feet.
    #[error("item {0} is a curve: only the pairwise combination and the plain sum take curves")]
    CurveNotCombined(usize),
    /// `gram` and `cardinal` are for feet at vertices.
    #[error("item {0} lies between vertices: only the pairwise combination and the plain sum take it")]
    SpotNotCombined(usize),
    /// `cardinal` has one set of equations for all feet.
    #[error("items 0 and {0} have different directions: the cardinal combination needs them alike")]
    MixedDirections(usize),
    /// More items than the weights of the pairwise combination can tell apart.
    #[error("there are more than {0} items")]
    TooMany(usize),
    /// A parameter of a blend or a range.
    #[error(transparent)]
    Blend(#[from] BlendError),
}
