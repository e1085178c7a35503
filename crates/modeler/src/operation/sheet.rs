//! `sheet`: skins a closed curve, or a loop of curves that meet at control points (thesis section 7.3.2).

use crate::error::{HoleError, ModelError};
use crate::model::Model;
use crate::operation::fill::{sheet_in, sheet_loop};
use crate::skeleton::sheet_skeleton;
use crate::surgery::dividing::{Part, divide_at};
use ductile_spec::{CurveId, CurveStretch, Embedding, FillSide, PointId, Surface};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Makes a disc in a closed curve, or in the loop that a curve closes with others: a hole of a surface, if there is one.
pub(crate) fn sheet(model: &mut Model, boundary: CurveId) -> Result<(), ModelError> {
    let sides = sheet_loop(model, boundary)?;
    if !sides.is_empty() {
        return in_loop(model, boundary, &sides);
    }
    let points = closed_points(model, boundary)?;
    if let Some(surface) = sheet_in(model, &BTreeSet::from([boundary])) {
        return Err(ModelError::AlreadySkinned { curve: boundary, surface });
    }
    let along = (0..).take(points.len()).collect();
    add(model, Surface::new(sheet_skeleton(&points, vec![Embedding { curve: boundary, along }])))
}

/// Makes a disc in a loop of sides.
fn in_loop(model: &mut Model, of: CurveId, sides: &[FillSide]) -> Result<(), ModelError> {
    let mut points: Vec<(PointId, DVec3)> = Vec::new();
    let mut curves = Vec::new();
    for (curve, is_back) in whole(model, of, sides)? {
        let mut through =
            model.document.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?.through.clone();
        if is_back {
            through.reverse();
        }
        curves.push((curve, is_back, points.len(), through.len()));
        // The last point of a side is the first of the next.
        for point in &through[..through.len().saturating_sub(1)] {
            points.push((*point, model.point(*point)?));
        }
    }
    if points.len() < 3 {
        return Err(HoleError::FewPoints(of).into());
    }
    let embedding = |(curve, is_back, first, count): (CurveId, bool, usize, usize)| {
        let name = |k: usize| u32::try_from(k % points.len()).unwrap_or(u32::MAX);
        let mut along: Vec<u32> = (first..first + count).map(name).collect();
        if is_back {
            along.reverse();
        }
        Embedding { curve, along }
    };
    let curves = curves.into_iter().map(embedding).collect();
    add(model, Surface::new(sheet_skeleton(&points, curves)))
}

/// The sides of a loop as curves of which nothing is left out, and whether the loop runs against each: those of which the loop
/// takes only a part are divided.
fn whole(model: &mut Model, of: CurveId, sides: &[FillSide]) -> Result<Vec<(CurveId, bool)>, ModelError> {
    let mut stretches: Vec<(CurveStretch, bool)> = Vec::new();
    let mut ends: BTreeMap<CurveId, Vec<PointId>> = BTreeMap::new();
    for side in sides {
        let curve = model.document.curves.get(&side.curve).ok_or(ModelError::NoCurve(side.curve))?;
        let (stretch, is_back) = side.stretch(curve);
        ends.entry(side.curve).or_default().extend([stretch.from, stretch.to]);
        stretches.push((stretch, is_back));
    }
    let mut parts: BTreeMap<CurveId, Vec<Part>> = BTreeMap::new();
    for (curve, points) in ends {
        parts.insert(curve, divide_at(model, curve, &points)?);
    }
    let part = |(stretch, is_back): (CurveStretch, bool)| {
        let all = parts.get(&stretch.curve)?;
        let part = all.iter().find(|part| part.ends == [stretch.from, stretch.to])?;
        Some((part.curve, is_back))
    };
    stretches.into_iter().map(|stretch| part(stretch).ok_or_else(|| HoleError::NoRing(of).into())).collect()
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
