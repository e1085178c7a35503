//! A patch: its control points, and what can be done to them without looking at ribbons.

use super::build::{self, BuildError, Join};
use super::label::{Labels, TooManyPoints};
use super::masks::{Fill, MaskCache};
use crate::ribbon::RibbonLoop;
use glam::DVec3;

/// Control points of an S-patch in the order of its labels.
#[derive(Clone, Debug, PartialEq)]
pub struct SPatch {
    sides: usize,
    depth: usize,
    points: Vec<DVec3>,
}

impl SPatch {
    /// The patch that fills a ring of ribbons: with their tangent planes at depth `d + 3`, or with their boundary curves
    /// only at depth `d`. Interior control points are filled in by masks, which are kept in the cache for other patches
    /// of this kind.
    ///
    /// # Errors
    /// See [`BuildError`].
    pub fn filling(
        ribbons: &RibbonLoop,
        join: Join,
        fill: Fill,
        cache: &mut MaskCache,
    ) -> Result<Self, BuildError> {
        let masks = cache.masks(ribbons.sides(), join.depth(ribbons.degree()), join, fill)?;
        let mut points = build::outer_points(ribbons, join, masks.labels())?;
        masks.fill(&mut points)?;
        Ok(Self { sides: ribbons.sides(), depth: join.depth(ribbons.degree()), points })
    }

    /// A patch with these control points; none if their number is not that of the labels.
    #[must_use]
    pub fn with_points(labels: &Labels, points: Vec<DVec3>) -> Option<Self> {
        (points.len() == labels.len()).then(|| Self { sides: labels.sides(), depth: labels.depth(), points })
    }

    /// How many sides.
    #[must_use]
    pub fn sides(&self) -> usize {
        self.sides
    }

    /// The depth, which the source calls degree.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.depth
    }

    /// The control points in the order of [`Labels`].
    #[must_use]
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    /// The same surface, one depth deeper.
    ///
    /// # Errors
    /// It would have too many control points.
    pub fn elevated(&self) -> Result<Self, TooManyPoints> {
        let labels = Labels::new(self.sides, self.depth)?;
        let deeper = Labels::new(self.sides, self.depth + 1)?;
        let mut points = Vec::with_capacity(deeper.len());
        for label in deeper.iter() {
            let (mut below, mut sum) = (label.to_vec(), DVec3::ZERO);
            for (k, &entry) in label.iter().enumerate().filter(|(_, entry)| **entry > 0) {
                below[k] -= 1;
                sum += self.points[labels.rank_of(&below)] * f64::from(entry);
                below[k] += 1;
            }
            points.push(sum / deeper.depth() as f64);
        }
        Ok(Self { sides: self.sides, depth: deeper.depth(), points })
    }
}
