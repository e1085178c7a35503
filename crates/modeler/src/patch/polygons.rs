//! The cage of a document as the mathematics has it, and back: vertices are control points here and indices there.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{drop_unused, kept_position, rim};
use ductile_patch::cage::edit::EditError;
use ductile_patch::cage::{self, CageError};
use ductile_spec::{Document, PointId, SurfaceId, SurfaceKind};
use glam::DVec3;

/// A cage and the control points that are its vertices.
#[derive(Clone, Debug)]
pub(crate) struct Polygons {
    /// The vertices, in order of identity.
    pub(crate) points: Vec<PointId>,
    pub(crate) cage: cage::Cage,
    surface: SurfaceId,
}

impl Polygons {
    /// The cage of a surface of a document.
    ///
    /// # Errors
    /// [`ModelError::NoPoint`] for a corner that is none, [`ModelError::Cage`] for what is no surface.
    pub(crate) fn of(
        surface: SurfaceId,
        cage: &ductile_spec::Cage,
        document: &Document,
    ) -> Result<Self, ModelError> {
        let points: Vec<PointId> = cage.points().into_iter().collect();
        let place = |point: &PointId| document.points.get(point).copied().ok_or(ModelError::NoPoint(*point));
        let places = points.iter().map(place).collect::<Result<Vec<DVec3>, _>>()?;
        let index = |point: &PointId| index_of(&points, *point).ok_or(ModelError::NoPoint(*point));
        let corners = |face: &Vec<PointId>| face.iter().map(index).collect::<Result<Vec<u32>, ModelError>>();
        let faces = cage.faces.iter().map(corners).collect::<Result<Vec<_>, _>>()?;
        let cage = cage::Cage::new(places, faces).map_err(|reason| refused(surface, &points, reason))?;
        Ok(Self { points, cage, surface })
    }

    /// The index of a control point among the vertices.
    ///
    /// # Errors
    /// [`ModelError::NoVertex`] for a point that is none of them.
    pub(crate) fn index(&self, point: PointId) -> Result<u32, ModelError> {
        index_of(&self.points, point).ok_or(ModelError::NoVertex { surface: self.surface, point })
    }

    /// A refusal of the mathematics, with its vertices named as the control points that they are.
    pub(crate) fn refused(&self, reason: CageError) -> ModelError {
        refused(self.surface, &self.points, reason)
    }
}

fn index_of(points: &[PointId], point: PointId) -> Option<u32> {
    points.binary_search(&point).ok().and_then(|found| u32::try_from(found).ok())
}

fn refused(surface: SurfaceId, points: &[PointId], reason: CageError) -> ModelError {
    ModelError::Cage { surface, reason: reason.renamed(|vertex| name(points, vertex)) }
}

/// The number of the control point that a vertex is, or will be.
fn name(points: &[PointId], vertex: u32) -> u32 {
    points.get(vertex as usize).map_or(vertex, |point| point.0)
}

/// Changes the cage of a surface. Its old vertices stay the points that they were, new ones become new points, and points
/// that nothing uses any more go.
///
/// # Errors
/// [`ModelError::NoSurface`] and [`ModelError::OnlyCages`] where there is no cage, [`ModelError::CageEdit`] for what cannot be done to it.
pub(crate) fn change(
    model: &mut Model,
    surface: SurfaceId,
    act: &'static str,
    with: impl FnOnce(&Polygons) -> Result<Result<cage::Cage, EditError>, ModelError>,
) -> Result<(), ModelError> {
    let before = Polygons::of(surface, caged(&model.document, surface, act)?, &model.document)?;
    let after = with(&before)?.map_err(|reason| {
        // Those that are not there yet get the next identities, in order.
        let mut points = before.points.clone();
        let next = model.document.next_point().0;
        points.extend((next..next.saturating_add(256)).map(PointId));
        ModelError::CageEdit { surface, reason: reason.renamed(|vertex| name(&points, vertex)) }
    })?;
    let mut points = before.points.clone();
    for place in &after.positions()[points.len()..] {
        let place = kept_position(model, *place)?;
        let point = model.document.next_point();
        model.document_mut().points.insert(point, place);
        points.push(point);
    }
    let corners = |face: &Vec<u32>| face.iter().map(|&vertex| points[vertex as usize]).collect();
    let faces = after.faces().iter().map(corners).collect();
    if let Some(cage) = model.document_mut().cages.get_mut(&surface) {
        cage.faces = faces;
    }
    for vertex in &points[before.points.len()..] {
        rim::split(model, surface, *vertex)?;
    }
    rim::free_lost(model.document_mut());
    drop_unused(model, before.points);
    model.document.validate()?;
    model.build_patch(surface)
}

/// The cage of a surface of a document.
///
/// # Errors
/// [`ModelError::NoSurface`]; [`ModelError::OnlyCages`] for a surface of another kind.
pub(crate) fn caged<'a>(
    document: &'a Document,
    surface: SurfaceId,
    act: &'static str,
) -> Result<&'a ductile_spec::Cage, ModelError> {
    document.cages.get(&surface).ok_or(match document.kind_of(surface) {
        Some(SurfaceKind::Fair) => ModelError::OnlyCages { surface, kind: "a fair surface", act },
        Some(SurfaceKind::Fill) => ModelError::OnlyCages { surface, kind: "a patch that fills a loop", act },
        Some(SurfaceKind::Mesh) => ModelError::OnlyCages { surface, kind: "a fixed mesh", act },
        Some(SurfaceKind::Cage) | None => ModelError::NoSurface(surface),
    })
}
