//! What is selected, and what can be done with it whatever tool is in hand.

use super::entry;
use crate::Hit;
use ductile_spec::{CurveId, Edit, PointId, PointRole, Structure, SurfaceId};

/// What is selected.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// Nothing.
    #[default]
    None,
    /// A control point.
    Point(PointId),
    /// A curve.
    Curve(CurveId),
    /// A surface.
    Surface(SurfaceId),
}

impl Selection {
    /// What a click on something selects.
    #[must_use]
    pub fn of(hit: Option<&Hit>) -> Self {
        match hit {
            None => Self::None,
            Some(Hit::Point { id, .. }) => Self::Point(*id),
            Some(Hit::Curve { id, .. }) => Self::Curve(*id),
            Some(Hit::Surface { id, .. }) => Self::Surface(*id),
        }
    }

    /// The same if the model still has it, else nothing.
    #[must_use]
    pub fn still_in(self, structure: &Structure) -> Self {
        let exists = match self {
            Self::None => true,
            Self::Point(id) => structure.points.iter().any(|point| point.id == id),
            Self::Curve(id) => structure.curves.iter().any(|curve| curve.id == id),
            Self::Surface(id) => structure.surfaces.iter().any(|surface| surface.id == id),
        };
        if exists { self } else { Self::None }
    }

    /// The edit that removes it: a control that something hangs on is released, and its shape relaxes.
    #[must_use]
    pub fn removal(self, structure: &Structure) -> Option<Edit> {
        match self {
            Self::None => None,
            Self::Point(point) => match entry(structure, point)?.role {
                PointRole::Free => Some(Edit::DeletePoint { point }),
                PointRole::Curve | PointRole::Surface => Some(Edit::Release { point }),
            },
            Self::Curve(curve) => Some(Edit::DeleteCurve { curve }),
            Self::Surface(surface) => Some(Edit::DeleteSurface { surface }),
        }
    }

    /// The next control point after the selected one, or before it, round and round.
    #[must_use]
    pub fn walk(self, structure: &Structure, backwards: bool) -> Self {
        let points = &structure.points;
        if points.is_empty() {
            return Self::None;
        }
        let here = match self {
            Self::Point(id) => points.iter().position(|point| point.id == id),
            _ => None,
        };
        let next = match (here, backwards) {
            (None, false) => 0,
            (None, true) => points.len() - 1,
            (Some(index), false) => (index + 1) % points.len(),
            (Some(index), true) => (index + points.len() - 1) % points.len(),
        };
        Self::Point(points[next].id)
    }
}
