//! The surface on which displacements live: its triangles, how they are glued, and which vertices stay where they are.
//!
//! Source: the project's recipe for P. Salvi's displacement blends, section 2. Lengths are in units of the caller. The
//! surface may have one side: nothing here asks for an orientation.

use super::error::DisplacementError;
use glam::DVec3;

/// In place of an index: nothing there.
pub(super) const NONE: u32 = u32::MAX;
/// Squares of coordinates must stay finite.
pub(super) const LARGEST: f64 = 1e150;

/// A triangle mesh with the vertices that are held. An edge may have one or two triangles.
#[derive(Clone, Debug)]
pub struct Domain {
    /// Scaled by a power of two to an extent of about 1: every product of lengths stays finite, and no digit changes.
    pub(super) positions: Vec<DVec3>,
    pub(super) triangles: Vec<[u32; 3]>,
    /// Per side, `3 t + k` from corner `k` of triangle `t` to the next: the side it is glued to.
    pub(super) glue: Vec<u32>,
    pub(super) on_boundary: Vec<bool>,
    pub(super) held: Vec<bool>,
    pub(super) keeps_pinned_edges: bool,
}

impl Domain {
    /// Takes a mesh of which the boundary is held. Vertices that no triangle uses are left alone.
    ///
    /// # Errors
    /// Indices that do not exist, corners used twice, positions beyond 1e150, edges with three triangles or more.
    pub fn new(positions: &[DVec3], triangles: &[[u32; 3]]) -> Result<Self, DisplacementError> {
        let count = positions.len();
        if u32::try_from(count).is_err() || u32::try_from(3 * triangles.len()).is_err() {
            return Err(DisplacementError::TooLarge);
        }
        let is_bad = |p: &DVec3| !p.is_finite() || p.abs().max_element() > LARGEST;
        if let Some(vertex) = positions.iter().position(is_bad) {
            return Err(DisplacementError::BadPosition(vertex));
        }
        for (index, &[a, b, c]) in triangles.iter().enumerate() {
            if let Some(vertex) = [a, b, c].iter().map(|&v| v as usize).find(|&v| v >= count) {
                return Err(DisplacementError::NoVertex { vertex, count });
            }
            if a == b || b == c || c == a {
                return Err(DisplacementError::RepeatedCorner(index));
            }
        }
        let glue = glue(triangles)?;
        let mut on_boundary = vec![false; count];
        for (side, _) in glue.iter().enumerate().filter(|(_, partner)| **partner == NONE) {
            let [from, to] = ends(triangles, side);
            on_boundary[from as usize] = true;
            on_boundary[to as usize] = true;
        }
        Ok(Self {
            positions: scaled(positions),
            triangles: triangles.to_vec(),
            glue,
            held: on_boundary.clone(),
            on_boundary,
            keeps_pinned_edges: true,
        })
    }

    /// Holds these vertices too. A closed ring of edges between pins is a border that nothing passes.
    ///
    /// # Errors
    /// [`DisplacementError::NoVertex`].
    pub fn with_pins(mut self, pins: &[usize]) -> Result<Self, DisplacementError> {
        let count = self.held.len();
        for &vertex in pins {
            *self.held.get_mut(vertex).ok_or(DisplacementError::NoVertex { vertex, count })? = true;
        }
        Ok(self)
    }

    /// Holds these vertices and no others, not even the boundary; edges between held vertices may be flipped. So do
    /// the reference files of the method.
    ///
    /// # Errors
    /// [`DisplacementError::NoVertex`].
    pub fn with_only(mut self, held: &[usize]) -> Result<Self, DisplacementError> {
        self.held.fill(false);
        self.keeps_pinned_edges = false;
        self.with_pins(held)
    }

    /// Number of vertices.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no vertices.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Which vertices stay where they are.
    #[must_use]
    pub fn held(&self) -> &[bool] {
        &self.held
    }

    /// The free vertices that share an edge with a held one.
    #[must_use]
    pub fn beside_held(&self) -> Vec<bool> {
        let mut beside = vec![false; self.len()];
        for triangle in &self.triangles {
            if triangle.iter().any(|&v| self.held[v as usize]) {
                triangle.iter().for_each(|&v| beside[v as usize] = !self.held[v as usize]);
            }
        }
        beside
    }

    /// Whether an edge of the mesh joins two vertices.
    pub(super) fn joins(&self, a: usize, b: usize) -> bool {
        self.triangles
            .iter()
            .any(|t| t.iter().any(|&v| v as usize == a) && t.iter().any(|&v| v as usize == b))
    }

    /// Whether the edge between two vertices must stay: a border of pins would leak if it were flipped. Where both ends
    /// are on the boundary the edge divides nothing.
    pub(super) fn keeps_edge(&self, a: u32, b: u32) -> bool {
        let [a, b] = [a as usize, b as usize];
        self.keeps_pinned_edges
            && self.held[a]
            && self.held[b]
            && !(self.on_boundary[a] && self.on_boundary[b])
    }
}

/// The vertices at the beginning and the end of a side.
pub(super) fn ends(triangles: &[[u32; 3]], side: usize) -> [u32; 2] {
    let triangle = triangles[side / 3];
    [triangle[side % 3], triangle[(side + 1) % 3]]
}

/// Sides that join the same two vertices are glued.
fn glue(triangles: &[[u32; 3]]) -> Result<Vec<u32>, DisplacementError> {
    let mut sides: Vec<(u32, u32, u32)> = (0_u32..)
        .zip((0..3 * triangles.len()).map(|side| ends(triangles, side)))
        .map(|(side, [a, b])| (a.min(b), a.max(b), side))
        .collect();
    sides.sort_unstable();
    let mut glue = vec![NONE; sides.len()];
    for same in sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        match *same {
            [_] => {}
            [(_, _, one), (_, _, other)] => {
                glue[one as usize] = other;
                glue[other as usize] = one;
            }
            _ => return Err(DisplacementError::CrowdedEdge(same[0].0, same[0].1)),
        }
    }
    Ok(glue)
}

fn scaled(positions: &[DVec3]) -> Vec<DVec3> {
    let least = positions.iter().copied().reduce(DVec3::min).unwrap_or_default();
    let most = positions.iter().copied().reduce(DVec3::max).unwrap_or_default();
    let (_, exponent) = libm::frexp((most - least).max_element());
    let scale = libm::ldexp(1.0, (-exponent).min(1000));
    positions.iter().map(|&p| p * scale).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn the_boundary_is_held_and_pins_are_added() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y, DVec3::new(0.5, 0.5, 0.0)];
        let fan = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]];
        let domain = Domain::new(&square, &fan).unwrap();
        assert_eq!(domain.held(), [true, true, true, true, false]);
        assert_eq!(domain.beside_held(), [false, false, false, false, true]);
        let tetrahedron = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
        let closed = Domain::new(&square[..4], &tetrahedron).unwrap();
        assert_eq!(closed.held(), [false; 4]);
        assert_eq!(closed.with_pins(&[2]).unwrap().held(), [false, false, true, false]);
        assert_eq!(domain.with_only(&[3]).unwrap().held(), [false, false, false, true, false]);
    }

    #[test]
    fn what_is_no_surface_is_refused() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z, DVec3::ONE];
        let refusal = |points: &[DVec3], triangles: &[[u32; 3]]| Domain::new(points, triangles).unwrap_err();
        assert_eq!(refusal(&points, &[[0, 1, 5]]), DisplacementError::NoVertex { vertex: 5, count: 5 });
        assert_eq!(refusal(&points, &[[0, 1, 2], [1, 3, 1]]), DisplacementError::RepeatedCorner(1));
        assert_eq!(
            refusal(&points, &[[0, 1, 2], [1, 0, 3], [4, 1, 0]]),
            DisplacementError::CrowdedEdge(0, 1)
        );
        for bad in [f64::NAN, f64::INFINITY, 1e151] {
            let points = [DVec3::ZERO, DVec3::X, DVec3::new(0.0, bad, 0.0)];
            assert_eq!(refusal(&points, &[[0, 1, 2]]), DisplacementError::BadPosition(2));
        }
        let pinned = Domain::new(&points, &[[0, 1, 2]]).unwrap().with_pins(&[9]);
        assert_eq!(pinned.unwrap_err(), DisplacementError::NoVertex { vertex: 9, count: 5 });
    }
}
