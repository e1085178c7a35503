//! `sheet`: skins a closed curve (thesis section 7.3.2).

use crate::error::ModelError;
use crate::model::Model;
use crate::skeleton::sheet_skeleton;
use ductile_spec::{CurveId, PointId, Surface};
use glam::DVec3;

/// Makes a disc in a closed curve.
pub(crate) fn sheet(model: &mut Model, boundary: CurveId) -> Result<(), ModelError> {
    let points = closed_points(model, boundary)?;
    let is_sheet_of = |surface: &Surface| {
        surface.skeleton.curves.len() == 1 && surface.skeleton.curves[0].curve == boundary
    };
    if let Some((id, _)) = model.document.surfaces.iter().find(|(_, surface)| is_sheet_of(surface)) {
        return Err(ModelError::AlreadySkinned { curve: boundary, surface: *id });
    }
    let skeleton = sheet_skeleton(boundary, &points);
    add(model, Surface::new(skeleton))
}

/// Adds a surface to the document and builds it.
pub(crate) fn add(model: &mut Model, surface: Surface) -> Result<(), ModelError> {
    let id = model.document.next_surface();
    model.document_mut().surfaces.insert(id, surface);
    model.document.validate()?;
    model.build_surface(id)
}

/// The control points of a closed curve, in order.
pub(crate) fn closed_points(model: &Model, id: CurveId) -> Result<Vec<(PointId, DVec3)>, ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    if !curve.closed {
        return Err(ModelError::OpenCurve(id));
    }
    curve.through.iter().map(|point| Ok((*point, model.point(*point)?))).collect()
}
