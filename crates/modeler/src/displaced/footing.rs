//! Where feet and pins stand on a mesh, and the triangles that are shown: those of the base, cut where a foot stands between
//! its vertices.

use super::base::Base;
use ductile_patch::{nearest_spot, place};
use glam::DVec3;

/// A place of a mesh: corners of a triangle and barycentric coordinates, which survive any motion of the vertices.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Spot {
    pub(super) corners: [u32; 3],
    pub(super) shares: [f64; 3],
}

/// A foot nearer to a corner than this share of the triangle stands at the corner.
const AT_CORNER: f64 = 1e-9;

impl Spot {
    /// The place of a surface nearest to a point; nothing on a surface without triangles.
    pub(super) fn nearest(positions: &[DVec3], triangles: &[[u32; 3]], at: DVec3) -> Option<Self> {
        let (corners, shares) = nearest_spot(positions, triangles, at).ok()?;
        Some(Self { corners, shares })
    }

    /// A mean of what the corners have.
    pub(super) fn of(&self, values: &[DVec3]) -> DVec3 {
        self.corners.iter().zip(self.shares).map(|(&v, share)| values[v as usize] * share).sum()
    }

    /// The corner that it stands at, if it does.
    pub(super) fn corner(&self) -> Option<usize> {
        let most = (0..3).find(|&k| self.shares[k] >= 1.0 - AT_CORNER)?;
        Some(self.corners[most] as usize)
    }

    /// The corner that weighs most.
    pub(super) fn nearest_corner(&self) -> usize {
        let most = (0..3).fold(0, |a, b| if self.shares[b] > self.shares[a] { b } else { a });
        self.corners[most] as usize
    }
}

/// The triangles that are shown.
#[derive(Clone, Debug, Default)]
pub(super) struct Cut {
    pub(super) triangles: Vec<[u32; 3]>,
    /// Of each the triangle of the base in which it lies.
    pub(super) parents: Vec<u32>,
    /// The vertex at each spot.
    pub(super) at: Vec<u32>,
    /// Places of the vertices that were made, which come after those of the base.
    pub(super) made: Vec<Spot>,
}

impl Cut {
    /// How many triangles there were before.
    pub(super) fn base_triangles(&self) -> usize {
        self.parents.iter().max().map_or(0, |most| *most as usize + 1)
    }

    /// Cuts the triangles of a base at spots.
    pub(super) fn new(base: &Base<'_>, spots: &[Option<Spot>]) -> Self {
        let mut positions = base.positions.to_vec();
        let mut cut = Self {
            triangles: base.triangles.to_vec(),
            parents: (0_u32..).take(base.triangles.len()).collect(),
            ..Self::default()
        };
        for spot in spots {
            let vertex = spot.map_or(0, |spot| cut.insert(&mut positions, &spot));
            cut.at.push(u32::try_from(vertex).unwrap_or(0));
        }
        cut
    }

    fn insert(&mut self, positions: &mut Vec<DVec3>, spot: &Spot) -> usize {
        let before = self.triangles.clone();
        let at = spot.of(positions);
        let Ok(placed) = place(positions, &mut self.triangles, at, true) else {
            return spot.nearest_corner();
        };
        if placed.is_new {
            self.made.push(*spot);
        }
        // Pieces of a triangle that was cut are appended, as many for each, in the order of the triangles.
        let changed: Vec<usize> = (0..before.len()).filter(|&t| before[t] != self.triangles[t]).collect();
        let more = self.triangles.len() - before.len();
        for &old in &changed {
            let parent = self.parents[old];
            self.parents.extend(core::iter::repeat_n(parent, more / changed.len()));
        }
        placed.vertex
    }
}
