//! Everything about a patch that does not depend on where its ribbons are: masks, factored, and a tessellation. Patches of
//! one kind share it, however often they are filled.

use super::build::{self, BuildError, Join};
use super::label::Labels;
use super::masks::{Fill, Masks};
use super::patch::SPatch;
use super::tessellation::{Tessellated, Tessellation, TessellationError};
use crate::ribbon::RibbonLoop;
use glam::DVec3;

/// What patches have in common that have as many sides, the same degree, join and rule, and the same resolution.
#[derive(Debug)]
pub struct PatchKind {
    masks: Masks,
    grid: Tessellation,
    degree: usize,
    join: Join,
    fill: Fill,
    triangles: Vec<[u32; 3]>,
}

impl PatchKind {
    /// The kind for so many ribbons of a degree. Triangles are counter-clockwise in the domain.
    ///
    /// # Errors
    /// A patch of this kind, or its tessellation, would be too large.
    #[expect(clippy::cast_possible_truncation, reason = "a tessellation has at most two million vertices")]
    pub fn new(
        sides: usize,
        degree: usize,
        join: Join,
        fill: Fill,
        resolution: usize,
    ) -> Result<Self, KindError> {
        let mut masks = Masks::new(sides, join.depth(degree), join, fill)?;
        masks.weigh().map_err(BuildError::from)?;
        let grid = Tessellation::new(sides, join.depth(degree), resolution)?;
        let triangles = grid.triangles().into_iter().map(|corners| corners.map(|corner| corner as u32));
        Ok(Self { triangles: triangles.collect(), masks, grid, degree, join, fill })
    }

    /// Whether it is the kind that [`Self::new`] makes of the same.
    #[must_use]
    pub fn is_for(&self, sides: usize, degree: usize, join: Join, fill: Fill, resolution: usize) -> bool {
        (self.grid.sides(), self.degree, self.join, self.fill, self.grid.resolution())
            == (sides, degree, join, fill, resolution)
    }

    /// How many control points a patch would have, as a number that cannot overflow.
    #[must_use]
    pub fn control_points(sides: usize, degree: usize, join: Join) -> f64 {
        Labels::count(sides, join.depth(degree))
    }

    /// How its patches meet what lies around them.
    #[must_use]
    pub fn join(&self) -> Join {
        self.join
    }

    /// The labels of its control points, in their order.
    #[must_use]
    pub fn labels(&self) -> &Labels {
        self.masks.labels()
    }

    /// The tessellation.
    #[must_use]
    pub fn grid(&self) -> &Tessellation {
        &self.grid
    }

    /// Its triangles.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The patch between ribbons; none of another number or degree.
    ///
    /// # Errors
    /// See [`BuildError`].
    pub fn filling(&self, ribbons: &RibbonLoop) -> Result<Option<SPatch>, BuildError> {
        if (ribbons.sides(), ribbons.degree()) != (self.grid.sides(), self.degree) {
            return Ok(None);
        }
        let mut points = build::outer_points(ribbons, self.join, self.masks.labels())?;
        self.masks.fill_shared(&mut points)?;
        Ok(SPatch::with_points(self.masks.labels(), points))
    }

    /// The mesh of a patch. A vertex without a normal takes that of the triangles around it, so that it can be lit.
    #[must_use]
    pub fn evaluate(&self, patch: &SPatch) -> Option<Tessellated> {
        let mut found = self.grid.evaluate(patch)?;
        if found.normals.contains(&DVec3::ZERO) {
            let mut around = vec![DVec3::ZERO; found.normals.len()];
            for corners in &self.triangles {
                let [a, b, c] = corners.map(|corner| found.positions[corner as usize]);
                let area = (b - a).cross(c - a);
                corners.iter().for_each(|corner| around[*corner as usize] += area);
            }
            for (normal, around) in found.normals.iter_mut().zip(around) {
                if *normal == DVec3::ZERO {
                    *normal = around.try_normalize().unwrap_or_default();
                }
            }
        }
        Some(found)
    }
}

/// Why there is no such kind.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum KindError {
    /// The patch itself.
    #[error(transparent)]
    Patch(#[from] BuildError),
    /// Its tessellation.
    #[error(transparent)]
    Tessellation(#[from] TessellationError),
}

#[cfg(test)]
mod tests {
    use super::super::tests::{filled, random_loop};
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_kind_fills_as_a_cache_does() {
        for (n, d, join) in [(3, 3, Join::Tangent), (5, 3, Join::Tangent), (6, 3, Join::Position)] {
            let ring = random_loop(n, d, 5);
            let kind = PatchKind::new(n, d, join, Fill::Biharmonic, 4).unwrap();
            let patch = kind.filling(&ring).unwrap().unwrap();
            assert_eq!(patch, filled(&ring, join, Fill::Biharmonic));
            let mesh = kind.evaluate(&patch).unwrap();
            assert_eq!(mesh.positions.len(), kind.grid().vertex_count());
            assert!(kind.is_for(n, d, join, Fill::Biharmonic, 4));
            assert!(!kind.is_for(n, d, join, Fill::Harmonic, 4));
            assert_eq!(kind.filling(&random_loop(n + 1, d, 5)), Ok(None));
        }
        assert!(matches!(
            PatchKind::new(64, 5, Join::Tangent, Fill::Biharmonic, 4),
            Err(KindError::Patch(BuildError::TooLarge(_)))
        ));
    }

    #[test]
    fn a_straight_corner_is_lit_as_what_lies_around_it() {
        // A flat square of which one corner is straight: a triangle with a point on a side.
        let corners = [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [1.0, 2.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let curves: Vec<Vec<DVec3>> = (0..4).map(|k| vec![corners[k], corners[(k + 1) % 4]]).collect();
        let ribbons = crate::ribbons_along(&curves, &[]).unwrap().ribbons;
        let kind = PatchKind::new(4, 3, Join::Tangent, Fill::Biharmonic, 6).unwrap();
        let patch = kind.filling(&ribbons).unwrap().unwrap();
        let mesh = kind.evaluate(&patch).unwrap();
        assert!(mesh.normals[kind.grid().on_side(1, 0)].distance(DVec3::Z) < 1e-9);
    }
}
