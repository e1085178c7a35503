//! What is selected, and what can be done with it whatever tool is in hand.

use super::entry;
use crate::Hit;
use ductile_spec::{CurveId, Document, Edit, PointId, PointRole, Structure, SurfaceId};

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
    /// An edge of a cage.
    Edge {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Its ends.
        ends: [PointId; 2],
    },
    /// A face of a cage.
    Face {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Which face, in the order of the document.
        face: u32,
    },
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
            Some(Hit::Edge { surface, ends, .. }) => Self::Edge { surface: *surface, ends: *ends },
            Some(Hit::Face { surface, face, .. }) => Self::Face { surface: *surface, face: *face },
        }
    }

    /// The same if the model still has it, else nothing.
    #[must_use]
    pub fn still_in(self, structure: &Structure) -> Self {
        let exists = match self {
            Self::None => true,
            Self::Point(id) => structure.points.iter().any(|point| point.id == id),
            Self::Curve(id) => structure.curves.iter().any(|curve| curve.id == id),
            Self::Surface(id) | Self::Edge { surface: id, .. } | Self::Face { surface: id, .. } => {
                structure.surfaces.iter().any(|surface| surface.id == id)
            }
        };
        if exists { self } else { Self::None }
    }

    /// The same after an act, if it is still what it was: faces of cages are numbered anew when one is deleted. One that was
    /// extruded has new corners and is the same all the same.
    #[must_use]
    pub fn still_meant(self, before: &Document, after: &Document) -> Self {
        let is_meant = match self {
            Self::Edge { surface, mut ends } => {
                ends.sort_unstable();
                after.cages.get(&surface).is_some_and(|cage| cage.edges().contains(&ends))
            }
            Self::Face { surface, face } => {
                let [old, new] = [before, after].map(|document| document.cages.get(&surface));
                let corners = |cage: &ductile_spec::Cage| cage.faces.get(face as usize).cloned();
                match old.zip(new) {
                    Some((old, new)) => {
                        let [was, is] = [old, new].map(corners);
                        let is_extruded = old.faces.len() != new.faces.len()
                            && was.as_ref().map(Vec::len) == is.as_ref().map(Vec::len)
                            && others_stay(&old.faces, &new.faces, face as usize);
                        is.is_some() && (was == is || is_extruded)
                    }
                    None => false,
                }
            }
            _ => true,
        };
        if is_meant { self } else { Self::None }
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
            Self::Face { surface, face } => Some(Edit::DeleteFace { surface, face }),
            Self::Edge { .. } => None,
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

/// Whether all faces but one are the same in two lists, as far as the shorter one goes.
fn others_stay(old: &[Vec<PointId>], new: &[Vec<PointId>], but: usize) -> bool {
    old.iter().zip(new).enumerate().all(|(number, (old, new))| number == but || old == new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::Cage;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn document(faces: &[&[u32]]) -> Document {
        let faces = faces.iter().map(|face| face.iter().copied().map(PointId).collect()).collect();
        let mut document = Document::default();
        document.cages.insert(SurfaceId(1), Cage::new(faces));
        document
    }

    #[test]
    fn a_face_stays_selected_as_long_as_its_number_means_it() {
        let surface = SurfaceId(1);
        let before = document(&[&[1, 2, 3], &[1, 3, 4], &[1, 4, 5]]);
        let face = |face| Selection::Face { surface, face };
        let extruded = document(&[&[1, 2, 3], &[6, 7, 8], &[1, 4, 5], &[1, 3, 7, 6]]);
        assert_eq!(face(1).still_meant(&before, &extruded), face(1));
        assert_eq!(face(1).still_meant(&extruded, &before), face(1), "taken back");
        assert_eq!(face(2).still_meant(&before, &extruded), face(2));
        let deleted = document(&[&[1, 3, 4], &[1, 4, 5]]);
        for number in 0..3 {
            assert_eq!(face(number).still_meant(&before, &deleted), Selection::None);
        }
        assert_eq!(face(1).still_meant(&before, &Document::default()), Selection::None);
        let edge = |a, b| Selection::Edge { surface, ends: [PointId(a), PointId(b)] };
        assert_eq!(edge(5, 1).still_meant(&before, &deleted), edge(5, 1));
        assert_eq!(edge(2, 1).still_meant(&before, &deleted), Selection::None);
        assert_eq!(Selection::Point(PointId(9)).still_meant(&before, &deleted), Selection::Point(PointId(9)));
    }

    #[test]
    fn a_face_can_be_removed_and_an_edge_cannot() {
        let (surface, structure) = (SurfaceId(1), Structure::default());
        let face = Selection::Face { surface, face: 2 };
        assert_eq!(face.removal(&structure), Some(Edit::DeleteFace { surface, face: 2 }));
        assert_eq!(Selection::Edge { surface, ends: [PointId(1), PointId(2)] }.removal(&structure), None);
    }
}
