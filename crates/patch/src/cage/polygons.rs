//! The cage itself: any oriented polygon mesh, closed or with boundary, of any genus and in any number of pieces.

use super::error::CageError;
use super::links::{Links, check_positions};
use super::split::Split;
use glam::DVec3;

/// A polygon mesh that is known to be an oriented surface with sound positions.
///
/// ```
/// use ductile_patch::cage::{Cage, CageError};
/// use glam::DVec3;
/// let corners = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
/// let square = Cage::new(corners.to_vec(), vec![vec![0, 1, 2, 3]])?;
/// assert!(!square.is_closed());
/// let wrong = Cage::new(corners.to_vec(), vec![vec![0, 1, 9]]);
/// assert_eq!(wrong.unwrap_err(), CageError::NoSuchVertex { face: 0, vertex: 9, count: 4 });
/// # Ok::<(), CageError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Cage {
    positions: Vec<DVec3>,
    faces: Vec<Vec<u32>>,
    links: Links,
}

impl Cage {
    /// A cage of faces counter-clockwise seen from outside, by indices from 0. Vertices that no face uses are allowed.
    ///
    /// # Errors
    /// Whatever keeps the faces from being an oriented surface, with the face or vertex; see [`CageError`].
    pub fn new(positions: Vec<DVec3>, faces: Vec<Vec<u32>>) -> Result<Self, CageError> {
        check_positions(&positions)?;
        let links = Links::new(positions.len(), &faces)?;
        Ok(Self { positions, faces, links })
    }

    /// Positions of all vertices, used or not.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Corners of all faces.
    #[must_use]
    pub fn faces(&self) -> &[Vec<u32>] {
        &self.faces
    }

    /// Whether it has no boundary.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.links.is_closed()
    }

    /// Whether a vertex lies on the boundary; false for one that does not exist or that no face uses.
    #[must_use]
    pub fn is_boundary(&self, vertex: usize) -> bool {
        vertex < self.positions.len() && self.links.is_boundary(vertex)
    }

    /// How many faces meet at a vertex; 0 for one that does not exist.
    #[must_use]
    pub fn valence(&self, vertex: usize) -> usize {
        if vertex < self.positions.len() { self.links.valence(vertex) } else { 0 }
    }

    /// The split that it needs: none when every face is a quad.
    #[must_use]
    pub fn split_needed(&self) -> Split {
        if self.faces.iter().all(|face| face.len() == 4) { Split::None } else { Split::Linear }
    }

    /// Vertices used, minus edges, plus faces.
    #[must_use]
    pub fn euler_characteristic(&self) -> i64 {
        let used = (0..self.positions.len()).filter(|&vertex| self.links.valence(vertex) > 0).count();
        let count = |n: usize| i64::try_from(n).unwrap_or(i64::MAX);
        count(used) - count(self.links.edges().count()) + count(self.faces.len())
    }

    pub(super) fn links(&self) -> &Links {
        &self.links
    }
}

#[cfg(test)]
mod tests;
