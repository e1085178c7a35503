//! What is displaced: a point of the surface or a curve on it, with how far and in which way it reaches.
//!
//! A foot may lie between the vertices of a triangle: then the triangles stay as they are, and with them the factor of
//! their Laplacian, which a new vertex at each foot would cost. Its Green's function is that of a unit load spread over
//! the corners by the barycentric coordinates, which is what linear finite elements make of a point load.

use super::blend::Range;
use super::domain::{Domain, LARGEST};
use super::error::DisplacementError;
use super::laplacian::Direction;
use glam::DVec3;

/// A foot or a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// All different; of a spot the corners of its triangle.
    pub(super) vertices: Vec<usize>,
    /// Barycentric coordinates of a foot between vertices.
    pub(super) shares: Option<[f64; 3]>,
    pub(super) is_closed: bool,
    /// One for all, or one per vertex.
    pub(super) displacements: Vec<DVec3>,
    pub(super) range: Range,
    pub(super) direction: Option<Direction>,
}

impl Item {
    /// A foot: this vertex moves by `displacement`, in units of the surface. With zero it is a fixed point.
    #[must_use]
    pub fn foot(vertex: usize, displacement: DVec3) -> Self {
        Self {
            vertices: vec![vertex],
            shares: None,
            is_closed: false,
            displacements: vec![displacement],
            range: Range::default(),
            direction: None,
        }
    }

    /// A foot between the corners of a triangle, by its barycentric coordinates: the place there moves by `displacement`.
    /// Only the pairwise combination and the plain sum take it.
    ///
    /// # Errors
    /// [`DisplacementError::BadShares`] unless the coordinates lie in [0, 1] and sum to 1;
    /// [`DisplacementError::CurveCrosses`] for corners that are not different.
    pub fn spot(corners: [u32; 3], shares: [f64; 3], displacement: DVec3) -> Result<Self, DisplacementError> {
        let is_share = |share: &f64| (0.0..=1.0).contains(share);
        let is_whole = (shares.iter().sum::<f64>() - 1.0).abs() < 1e-9;
        if !shares.iter().all(is_share) || !is_whole {
            return Err(DisplacementError::BadShares(shares));
        }
        let [a, b, c] = corners.map(|corner| corner as usize);
        if a == b || b == c || c == a {
            return Err(DisplacementError::CurveCrosses(if b == c { b } else { a }));
        }
        Ok(Self { vertices: vec![a, b, c], shares: Some(shares), ..Self::foot(a, displacement) })
    }

    /// A curve along edges through these vertices, closed or with two ends; one displacement for all of it, or one per
    /// vertex.
    ///
    /// # Errors
    /// [`DisplacementError::ShortCurve`], [`DisplacementError::CurveCrosses`], [`DisplacementError::Length`].
    pub fn curve(
        vertices: Vec<usize>,
        is_closed: bool,
        displacements: Vec<DVec3>,
    ) -> Result<Self, DisplacementError> {
        check_displacements(&displacements, vertices.len())?;
        if vertices.len() < if is_closed { 3 } else { 2 } {
            return Err(DisplacementError::ShortCurve);
        }
        let mut sorted = vertices.clone();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(twice) => Err(DisplacementError::CurveCrosses(twice[0])),
            None => Ok(Self {
                vertices,
                shares: None,
                is_closed,
                displacements,
                range: Range::default(),
                direction: None,
            }),
        }
    }

    /// The same with another range.
    #[must_use]
    pub fn with_range(mut self, range: Range) -> Self {
        self.range = range;
        self
    }

    /// The same with a direction along which it reaches further.
    #[must_use]
    pub fn with_direction(mut self, direction: Direction) -> Self {
        self.direction = Some(direction);
        self
    }

    /// The vertices that it holds; of a foot between vertices the corners around it.
    #[must_use]
    pub fn vertices(&self) -> &[usize] {
        &self.vertices
    }

    pub(super) fn is_curve(&self) -> bool {
        self.shares.is_none() && self.vertices.len() > 1
    }

    /// The vertices that move exactly as asked.
    pub(super) fn met(&self) -> &[usize] {
        if self.shares.is_none() { &self.vertices } else { &[] }
    }

    /// How many vertices could have a displacement of their own.
    pub(super) fn room(&self) -> usize {
        if self.shares.is_none() { self.vertices.len() } else { 1 }
    }

    /// The vertices of a foot and what each has of it.
    pub(super) fn load(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let share = |rank: usize| self.shares.map_or(1.0, |shares| shares[rank]);
        self.vertices.iter().enumerate().map(move |(rank, &vertex)| (vertex, share(rank)))
    }

    /// The mean over the corners of a foot, by their shares.
    pub(super) fn at_foot(&self, values: &[f64]) -> f64 {
        self.load().map(|(vertex, share)| values[vertex] * share).sum()
    }

    /// The displacement that all of it has, if it has one.
    pub(super) fn common(&self) -> Option<DVec3> {
        let first = *self.displacements.first()?;
        self.displacements.iter().all(|&other| other == first).then_some(first)
    }

    /// Whether its displacements are numbers and its vertices follow edges; `index` is what it will be called.
    pub(super) fn check(&self, index: usize, domain: &Domain) -> Result<(), DisplacementError> {
        check_finite(index, &self.displacements)?;
        let count = domain.len();
        if let Some(&vertex) = self.vertices.iter().find(|&&vertex| vertex >= count) {
            return Err(DisplacementError::NoVertex { vertex, count });
        }
        let back = (self.is_closed || self.shares.is_some())
            .then(|| [self.vertices[self.vertices.len() - 1], self.vertices[0]]);
        for [a, b] in self.vertices.windows(2).map(|pair| [pair[0], pair[1]]).chain(back) {
            if !domain.joins(a, b) {
                return Err(DisplacementError::NoEdge(a, b));
            }
        }
        Ok(())
    }
}

pub(super) fn check_finite(index: usize, displacements: &[DVec3]) -> Result<(), DisplacementError> {
    let is_good = |d: &DVec3| d.is_finite() && d.abs().max_element() <= LARGEST;
    if displacements.iter().all(is_good) { Ok(()) } else { Err(DisplacementError::BadDisplacement(index)) }
}

/// One displacement, or one per vertex.
pub(super) fn check_displacements(displacements: &[DVec3], vertices: usize) -> Result<(), DisplacementError> {
    if displacements.len() == 1 || displacements.len() == vertices {
        return Ok(());
    }
    let of_what = "vertices of an item (one displacement for all would do)";
    Err(DisplacementError::Length { of_what, expected: vertices, found: displacements.len() })
}
