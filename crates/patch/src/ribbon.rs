//! Bézier ribbons around a hole: boundary curves with a second row of control points, which say what plane the surface
//! leaves them in (P. Salvi, *G1 hole filling with S-patches made easy*, 2020, section 4; the recipe's section 5).
//!
//! Side `i` runs from corner `i` to corner `i + 1`, cyclic from 0. Row 0 is the boundary curve, row 1 the next row inward
//! of a tensor product patch of the same degree `d` in both directions, so that the cross derivative is `d (row1 - row0)`.
//!
//! ```text
//!        q = i - 1     row 1
//!     C_q[0][d-1] = C_i[1][0] --- C_i[1][1] = C_q[1][d-1]
//!          |                        |
//!     C_q[0][d] = C_i[0][0] ----- C_i[0][1] = C_q[1][d]       side i →
//! ```

mod compatible;
mod planes;

pub use compatible::{Adjusted, made_compatible};
pub use planes::{PlaneSample, Planed, ribbons_along, ribbons_raised};

use crate::bezier::{curve_derivative, curve_point, elevated};
use crate::surface_point::unit_normal;
use glam::DVec3;
use thiserror::Error;

/// Two rows of control points along one side, of equal length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ribbon {
    /// The boundary curve.
    pub row0: Vec<DVec3>,
    /// The next row inward.
    pub row1: Vec<DVec3>,
}

/// Most sides: beyond, the products of distances in the coordinates of the domain leave the range of numbers.
pub const MOST_SIDES: usize = 64;
/// Highest degree of a ribbon: binomials are exact up to here, three elevations included.
pub const MOST_DEGREE: usize = 50;
/// Coordinates beyond this are nonsense; squares of what is reckoned from them must stay finite.
const LARGEST_COORDINATE: f64 = 1e100;
/// How far points that must be one may lie apart, as a share of the diagonal of the bounding box.
const CLOSE: f64 = 1e-9;
/// Below this sine between curve and cross derivative the side has no normal worth the name.
const LEAST_SINE: f64 = 1e-6;
/// Places on a side that are looked at for normals: both ends and between.
const LOOKS: usize = 32;

/// Why ribbons bound no patch. Sides and columns count from 0.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum RibbonError {
    /// A patch needs three sides; give a side that is missing as a ribbon of its own.
    #[error("there are {0} sides, and a patch needs at least 3")]
    TooFewSides(usize),
    /// Split the hole by a curve across it.
    #[error("there are {0} sides, and a patch has at most {MOST_SIDES}")]
    TooManySides(usize),
    /// Linear ribbons cannot turn; raise them first.
    #[error("side {side}: its degree is {degree}, and at least {least} is needed")]
    DegreeTooLow {
        /// The side.
        side: usize,
        /// Its degree.
        degree: usize,
        /// What is needed: 2 with tangent planes, 1 without.
        least: usize,
    },
    /// Fit a curve of lower degree.
    #[error("side {side}: its degree is {degree}, and at most {MOST_DEGREE} is possible")]
    DegreeTooHigh {
        /// The side.
        side: usize,
        /// Its degree.
        degree: usize,
    },
    /// Both rows of a ribbon have the same number of points.
    #[error("side {side}: row 0 has {row0} points and row 1 has {row1}")]
    RowsDiffer {
        /// The side.
        side: usize,
        /// Points of row 0.
        row0: usize,
        /// Points of row 1.
        row1: usize,
    },
    /// A coordinate is infinite, no number or beyond 1e100.
    #[error("side {side}: point {column} of row {row} is not finite, or beyond 1e100")]
    NotFinite {
        /// The side.
        side: usize,
        /// The row of the point.
        row: usize,
        /// Its place in the row.
        column: usize,
    },
    /// All points are one: there is nothing to fill.
    #[error("all points of the ribbons coincide")]
    NoExtent,
    /// Two points that must be one lie apart; [`made_compatible`] moves all but the corners together.
    #[error(
        "side {side}: point {column} of row {row} must be point {other_column} of row {other_row} of side \
         {other_side}, and lies {residual:e} away (at most {allowed:e})"
    )]
    Incompatible {
        /// The side.
        side: usize,
        /// The row of its point.
        row: usize,
        /// The place of the point in the row.
        column: usize,
        /// The side before it.
        other_side: usize,
        /// The row of the point there.
        other_row: usize,
        /// The place of that point in its row, after degrees have been raised to the highest.
        other_column: usize,
        /// Largest difference of a coordinate, in model units.
        residual: f64,
        /// What rounding may explain.
        allowed: f64,
    },
}

/// A place on a side where the ribbon has no normal: the patch is built all the same, but has none there either.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoNormal {
    /// The side.
    pub side: usize,
    /// The parameter on it, in [0, 1].
    pub u: f64,
    /// Sine of the angle between curve and cross derivative; 0 where one of them vanishes.
    pub sine: f64,
}

/// The four pairs at the corner where side `i` begins: (row, column) of side `i`, then of the side before, whose columns
/// count back from its end.
const PAIRS: [[(usize, usize); 2]; 4] =
    [[(0, 0), (0, 0)], [(1, 0), (0, 1)], [(0, 1), (1, 0)], [(1, 1), (1, 1)]];

impl Ribbon {
    /// The degree along the side.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.row0.len().saturating_sub(1)
    }

    fn row(&self, row: usize) -> &[DVec3] {
        if row == 0 { &self.row0 } else { &self.row1 }
    }

    /// The point of the boundary curve at `u`.
    #[must_use]
    pub fn point(&self, u: f64) -> DVec3 {
        curve_point(&self.row0, u)
    }

    /// The derivative of the boundary curve, in model units.
    #[must_use]
    pub fn tangent(&self, u: f64) -> DVec3 {
        curve_derivative(&self.row0, u)
    }

    /// The derivative across the boundary, inward, in model units.
    #[must_use]
    pub fn cross(&self, u: f64) -> DVec3 {
        let legs: Vec<DVec3> =
            self.row1.iter().zip(&self.row0).map(|(inner, outer)| *inner - *outer).collect();
        curve_point(&legs, u) * self.degree() as f64
    }

    /// The unit normal that a surface has along this side; none where curve and cross derivative are parallel.
    #[must_use]
    pub fn normal(&self, u: f64) -> Option<DVec3> {
        unit_normal(self.tangent(u), self.cross(u))
    }

    /// The ribbon of a neighbour across this side: the same curve the other way, and legs that go on straight. A patch with
    /// it meets a patch with this one in the same tangent planes.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let across = self.row0.iter().zip(&self.row1).map(|(outer, inner)| *outer * 2.0 - *inner);
        Self { row0: self.row0.iter().rev().copied().collect(), row1: across.rev().collect() }
    }

    /// The same boundary and the same cross derivative, one degree higher. Elevating row 1 alone would not keep the cross
    /// derivative, since it is scaled by the degree.
    #[must_use]
    pub fn elevated(&self) -> Self {
        let degree = self.degree() as f64;
        let row0 = elevated(&self.row0);
        let row1 = elevated(&self.row1);
        let row1 =
            row0.iter().zip(row1).map(|(outer, inner)| (*outer + inner * degree) / (degree + 1.0)).collect();
        Self { row0, row1 }
    }
}

/// Ribbons that fit together around a hole, all of one degree.
#[derive(Clone, Debug, PartialEq)]
pub struct RibbonLoop {
    ribbons: Vec<Ribbon>,
    diagonal: f64,
}

impl RibbonLoop {
    /// Checks the ribbons and raises all of them to the highest degree among them.
    ///
    /// # Errors
    /// See [`RibbonError`]; what does not fit is named by side and point.
    pub fn new(ribbons: &[Ribbon]) -> Result<Self, RibbonError> {
        let ring = Self::raised(ribbons, 2)?;
        ring.check_pairs(&PAIRS)?;
        Ok(ring)
    }

    /// The same for a patch that meets only the boundary curves: rows 1 play no part, and straight sides are allowed.
    ///
    /// # Errors
    /// See [`RibbonError`].
    pub fn of_curves(curves: &[Vec<DVec3>]) -> Result<Self, RibbonError> {
        let bare = |curve: &Vec<DVec3>| Ribbon { row0: curve.clone(), row1: curve.clone() };
        let ring = Self::raised(&curves.iter().map(bare).collect::<Vec<_>>(), 1)?;
        ring.check_pairs(&PAIRS[..1])?;
        Ok(ring)
    }

    /// Everything that can be said of the ribbons one by one.
    fn raised(ribbons: &[Ribbon], least: usize) -> Result<Self, RibbonError> {
        if ribbons.len() < 3 {
            return Err(RibbonError::TooFewSides(ribbons.len()));
        }
        if ribbons.len() > MOST_SIDES {
            return Err(RibbonError::TooManySides(ribbons.len()));
        }
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for (side, ribbon) in ribbons.iter().enumerate() {
            let (row0, row1, degree) = (ribbon.row0.len(), ribbon.row1.len(), ribbon.degree());
            if row0 != row1 {
                return Err(RibbonError::RowsDiffer { side, row0, row1 });
            }
            if degree < least {
                return Err(RibbonError::DegreeTooLow { side, degree, least });
            }
            if degree > MOST_DEGREE {
                return Err(RibbonError::DegreeTooHigh { side, degree });
            }
            for row in 0..2 {
                for (column, point) in ribbon.row(row).iter().enumerate() {
                    if !point.to_array().iter().all(|x| x.abs() <= LARGEST_COORDINATE) {
                        return Err(RibbonError::NotFinite { side, row, column });
                    }
                    (low, high) = (low.min(*point), high.max(*point));
                }
            }
        }
        let diagonal = (high - low).length();
        if diagonal <= f64::EPSILON * low.abs().max(high.abs()).max_element() {
            return Err(RibbonError::NoExtent);
        }
        let degree = ribbons.iter().map(Ribbon::degree).max().unwrap_or(least);
        let raise =
            |ribbon: &Ribbon| (ribbon.degree()..degree).fold(ribbon.clone(), |ribbon, _| ribbon.elevated());
        Ok(Self { ribbons: ribbons.iter().map(raise).collect(), diagonal })
    }

    /// Where two points that must be one lie apart, the worst is told.
    fn check_pairs(&self, pairs: &[[(usize, usize); 2]]) -> Result<(), RibbonError> {
        let allowed = self.allowed();
        let mut worst = (allowed, None);
        for side in 0..self.sides() {
            let other_side = self.before(side);
            for &[(row, column), (other_row, from_end)] in pairs {
                let other_column = self.degree() - from_end;
                let here = self.ribbons[side].row(row)[column];
                let there = self.ribbons[other_side].row(other_row)[other_column];
                let residual = (here - there).abs().max_element();
                if residual > worst.0 {
                    let error = RibbonError::Incompatible {
                        side,
                        row,
                        column,
                        other_side,
                        other_row,
                        other_column,
                        residual,
                        allowed,
                    };
                    worst = (residual, Some(error));
                }
            }
        }
        worst.1.map_or(Ok(()), Err)
    }

    fn before(&self, side: usize) -> usize {
        (side + self.sides() - 1) % self.sides()
    }

    /// How many sides, at least 3.
    #[must_use]
    pub fn sides(&self) -> usize {
        self.ribbons.len()
    }

    /// The degree of all sides.
    #[must_use]
    pub fn degree(&self) -> usize {
        self.ribbons[0].degree()
    }

    /// The ribbons, raised to that degree.
    #[must_use]
    pub fn ribbons(&self) -> &[Ribbon] {
        &self.ribbons
    }

    /// Diagonal of the box around all points, in model units.
    #[must_use]
    pub fn diagonal(&self) -> f64 {
        self.diagonal
    }

    /// How far two points may lie apart that must be one, in model units.
    #[must_use]
    pub fn allowed(&self) -> f64 {
        CLOSE * self.diagonal
    }

    /// Where the ribbons have no normal, at 33 places of each side.
    #[must_use]
    pub fn without_normal(&self) -> Vec<NoNormal> {
        let mut places = Vec::new();
        for (side, ribbon) in self.ribbons.iter().enumerate() {
            for look in 0..=LOOKS {
                let u = look as f64 / LOOKS as f64;
                // A derivative that vanishes up to rounding has no direction.
                let unit = |v: DVec3| {
                    if v.length() > self.allowed() {
                        v.try_normalize().unwrap_or_default()
                    } else {
                        DVec3::ZERO
                    }
                };
                let sine = unit(ribbon.tangent(u)).cross(unit(ribbon.cross(u))).length();
                if sine < LEAST_SINE {
                    places.push(NoNormal { side, u, sine });
                }
            }
        }
        places
    }
}

/// A loop that nobody has checked, for what must fail later.
#[cfg(test)]
pub(crate) fn unchecked_loop(ribbons: &[Ribbon]) -> RibbonLoop {
    RibbonLoop { ribbons: ribbons.to_vec(), diagonal: 4.0 }
}

#[cfg(test)]
mod tests;
