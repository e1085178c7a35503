//! Ribbons that do not quite fit, made to fit by moving them least.
//!
//! The boundary curves are what was asked for and stay, corners excepted, where the two ends become their mean. The ends
//! of a row 1 lie on the neighbours' curves by definition. What is left to choose are the twist points, each shared by
//! two ribbons (by all of them at degree 2): the sum of squared shifts is least when all become their mean.

use super::{PAIRS, Ribbon, RibbonError, RibbonLoop};
use glam::DVec3;

/// Ribbons that fit, and how far their points were moved.
#[derive(Clone, Debug, PartialEq)]
pub struct Adjusted {
    /// The ribbons, raised to one degree.
    pub ribbons: RibbonLoop,
    /// The longest way that a point of row 1 was moved, in model units.
    pub largest_shift: f64,
    /// The side of that point.
    pub side: usize,
    /// Its place in row 1.
    pub column: usize,
}

/// Moves the twist points of ribbons least, in the sense of least squares, so that they fit together.
///
/// # Errors
/// As [`RibbonLoop::new`], corners that lie apart included: curves that do not meet bound no hole.
pub fn made_compatible(ribbons: &[Ribbon]) -> Result<Adjusted, RibbonError> {
    let mut ring = RibbonLoop::raised(ribbons, 2)?;
    ring.check_pairs(&PAIRS[..1])?;
    let asked = ring.ribbons.clone();
    let (sides, d) = (ring.sides(), ring.degree());
    for side in 0..sides {
        let before = ring.before(side);
        let corner = (asked[side].row0[0] + asked[before].row0[d]) * 0.5;
        ring.ribbons[side].row0[0] = corner;
        ring.ribbons[before].row0[d] = corner;
        if d > 2 {
            let twist = (asked[side].row1[1] + asked[before].row1[d - 1]) * 0.5;
            ring.ribbons[side].row1[1] = twist;
            ring.ribbons[before].row1[d - 1] = twist;
        }
    }
    if d == 2 {
        let mean = asked.iter().map(|ribbon| ribbon.row1[1]).sum::<DVec3>() / sides as f64;
        ring.ribbons.iter_mut().for_each(|ribbon| ribbon.row1[1] = mean);
    }
    for side in 0..sides {
        let before = ring.before(side);
        ring.ribbons[side].row1[0] = ring.ribbons[before].row0[d - 1];
        ring.ribbons[before].row1[d] = ring.ribbons[side].row0[1];
    }
    let mut adjusted = Adjusted { ribbons: ring, largest_shift: 0.0, side: 0, column: 0 };
    for (side, (before, after)) in asked.iter().zip(&adjusted.ribbons.ribbons).enumerate() {
        for (column, (from, to)) in before.row1.iter().zip(&after.row1).enumerate() {
            let shift = from.distance(*to);
            if shift > adjusted.largest_shift {
                (adjusted.largest_shift, adjusted.side, adjusted.column) = (shift, side, column);
            }
        }
    }
    Ok(adjusted)
}
