//! What the exact surfaces of a document must satisfy. Whether the faces of a cage form a surface is
//! for the patches to say.

use super::{Defect, MAX_SAMPLES, MAX_SURFACES, MAX_TRIANGLES, limit};
use crate::cage::{Cage, CageBlend, MAX_BUMP, MAX_CAGE_RESOLUTION, MAX_HERMITE};
use crate::document::{Curve, Document};
use crate::fill::Fill;
use crate::id::{CurveId, PointId, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

impl Document {
    /// Cages and fills: every reference is kept, every number is in range.
    pub(super) fn validate_exact(&self) -> Result<(), Defect> {
        limit("surfaces", self.surfaces.len() + self.cages.len() + self.fills.len(), MAX_SURFACES)?;
        let corners = self.cages.values().flat_map(|cage| &cage.faces).map(Vec::len).sum();
        limit("corners of cages", corners, MAX_TRIANGLES)?;
        for (id, cage) in &self.cages {
            if self.surfaces.contains_key(id) {
                return Err(Defect::TwoKinds(*id));
            }
            validate_cage(*id, cage, &self.points)?;
        }
        let samples = self.cages.values().map(Cage::samples).fold(0, usize::saturating_add);
        limit("vertices of tessellated cages", samples, MAX_SAMPLES)?;
        for (id, fill) in &self.fills {
            if self.surfaces.contains_key(id) || self.cages.contains_key(id) {
                return Err(Defect::TwoKinds(*id));
            }
            validate_fill(*id, fill, &self.curves)?;
        }
        Ok(())
    }
}

fn validate_cage(id: SurfaceId, cage: &Cage, points: &BTreeMap<PointId, DVec3>) -> Result<(), Defect> {
    if cage.faces.is_empty() {
        return Err(Defect::EmptySurface(id));
    }
    for (face, corners) in cage.faces.iter().enumerate() {
        let mut seen = BTreeSet::new();
        for point in corners {
            let refuse = |why| Defect::CageFace { surface: id, face, point: *point, why };
            if !points.contains_key(point) {
                return Err(refuse("does not exist"));
            }
            if !seen.insert(point) {
                return Err(refuse("is a corner twice"));
            }
        }
        if corners.len() < 3 {
            return Err(Defect::SmallFace { surface: id, face, corners: corners.len() });
        }
    }
    let within = |what, value, most| {
        let is_within = (1..=most).contains(&value);
        if is_within { Ok(()) } else { Err(Defect::CageSetting { surface: id, what, value, most }) }
    };
    match cage.settings.blend {
        CageBlend::Hermite(order) => within("order of the Hermite blend", order, MAX_HERMITE)?,
        CageBlend::Bump(exponent) => within("exponent of the bump", exponent, MAX_BUMP)?,
        CageBlend::Erbs => {}
    }
    within("resolution", cage.settings.resolution.unwrap_or(1), MAX_CAGE_RESOLUTION)
}

fn validate_fill(id: SurfaceId, fill: &Fill, curves: &BTreeMap<CurveId, Curve>) -> Result<(), Defect> {
    let count = fill.sides.len();
    if count < 3 {
        return Err(Defect::FewSides { surface: id, sides: count });
    }
    for (side, now) in fill.sides.iter().enumerate() {
        let refuse = |why| Err(Defect::FillSide { surface: id, side, curve: now.curve, why });
        let Some(curve) = curves.get(&now.curve) else {
            return refuse("does not exist");
        };
        if !curve.through.contains(&now.from) || !curve.through.contains(&now.to) {
            return refuse("does not pass through both ends of the side");
        }
        if now.from == now.to {
            return refuse("is not used from one point to another one");
        }
        if now.to != fill.sides[(side + 1) % count].from {
            return refuse("does not end where the next side begins");
        }
    }
    Ok(())
}
