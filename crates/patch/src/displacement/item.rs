//! What is displaced: a point of the surface or a curve on it, with how far and in which way it reaches.

use super::blend::Range;
use super::domain::{Domain, LARGEST};
use super::error::DisplacementError;
use super::laplacian::Direction;
use glam::DVec3;

/// A foot or a curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Item {
    /// All different.
    pub(super) vertices: Vec<usize>,
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
            is_closed: false,
            displacements: vec![displacement],
            range: Range::default(),
            direction: None,
        }
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
            None => Ok(Self { vertices, is_closed, displacements, range: Range::default(), direction: None }),
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

    /// The vertices that it holds.
    #[must_use]
    pub fn vertices(&self) -> &[usize] {
        &self.vertices
    }

    pub(super) fn is_curve(&self) -> bool {
        self.vertices.len() > 1
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
        let back = self.is_closed.then(|| [self.vertices[self.vertices.len() - 1], self.vertices[0]]);
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
