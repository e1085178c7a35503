//! What the exact surfaces of a document must satisfy. Whether the faces of a cage form a surface is
//! for the patches to say.

use super::{Defect, MAX_SAMPLES, MAX_SURFACES, MAX_TRIANGLES, coordinate, limit};
use crate::cage::{Cage, CageBlend, MAX_BUMP, MAX_CAGE_RESOLUTION, MAX_HERMITE};
use crate::document::Document;
use crate::fill::{Fill, FillRibbon, FillStyle, LEAST_LEAN, MOST_LEAN, MOST_TURN};
use crate::id::{PointId, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// Most sides of a fill: what a patch can have.
const MAX_SIDES: usize = 64;
/// Most control points of a row of a ribbon.
const MAX_ROW: usize = 16;

impl Document {
    /// Cages and fills: every reference is kept, every number is in range.
    pub(super) fn validate_exact(&self) -> Result<(), Defect> {
        let count = self.surfaces.len() + self.cages.len() + self.fills.len() + self.meshes.len();
        limit("surfaces", count, MAX_SURFACES)?;
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
            validate_fill(*id, fill, self)?;
        }
        validate_sources(&self.fills)?;
        self.validate_turns()?;
        Ok(())
    }

    /// Two fills that agree on the planes along a curve are turned about it together: by no more than one alone could be.
    fn validate_turns(&self) -> Result<(), Defect> {
        for (id, fill) in &self.fills {
            for (side, now) in fill.sides.iter().enumerate() {
                if self.turn_along(*id, now).abs() > MOST_TURN {
                    let why = "is turned about by more than 90° by the two patches that join smoothly there";
                    return Err(Defect::FillSide { surface: *id, side, curve: now.curve, why });
                }
            }
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

fn validate_fill(id: SurfaceId, fill: &Fill, document: &Document) -> Result<(), Defect> {
    let count = fill.sides.len().max(fill.ribbons.len());
    if count < 3 {
        return Err(Defect::FewSides { surface: id, sides: count });
    }
    limit("sides of a fill", count, MAX_SIDES)?;
    let refuse = |why| Err(Defect::Fill { surface: id, why });
    let FillStyle { degree, resolution, .. } = fill.style;
    if degree.is_some_and(|degree| !(3..=10).contains(&degree)) {
        return refuse("its degree must be from 3 to 10");
    }
    if resolution.is_some_and(|resolution| !(1..=64).contains(&resolution)) {
        return refuse("its resolution must be from 1 to 64");
    }
    if !fill.ribbons.is_empty() {
        if !fill.sides.is_empty() {
            return refuse("it has both sides and ribbons");
        }
        return validate_ribbons(id, &fill.ribbons);
    }
    let mut seen = BTreeSet::new();
    for (side, now) in fill.sides.iter().enumerate() {
        let refuse = |why| Err(Defect::FillSide { surface: id, side, curve: now.curve, why });
        let Some(curve) = document.curves.get(&now.curve) else {
            return refuse("does not exist");
        };
        if !curve.through.contains(&now.from) || !curve.through.contains(&now.to) {
            return refuse("does not pass through both ends of the side");
        }
        if now.from == now.to {
            return refuse("is not used from one point to another one");
        }
        if now.back && !curve.closed {
            return refuse("is open, so that its points say in which direction the side runs");
        }
        if now.to != fill.sides[(side + 1) % count].from {
            return refuse("does not end where the next side begins");
        }
        if !seen.insert(now.from) {
            return refuse("begins where another side begins");
        }
        if !(-MOST_TURN..=MOST_TURN).contains(&now.turn) {
            return refuse("is left with a turn that is no angle from -90° to 90°");
        }
        if !(LEAST_LEAN..=MOST_LEAN).contains(&now.strength) {
            return refuse("is left with a strength that is no number from 0.1 to 5");
        }
        if now.turn != 0.0 && now.planes.is_some() {
            return refuse("cannot be turned about, since the planes along it come from another surface");
        }
        if let Some(beside) = now.planes
            && (beside == id || document.kind_of(beside).is_none())
        {
            return refuse("is said to take its planes from a surface that does not exist, or from itself");
        }
    }
    Ok(())
}

/// Fills whose planes come from one another, round about, come from nowhere.
fn validate_sources(fills: &BTreeMap<SurfaceId, Fill>) -> Result<(), Defect> {
    let mut done: BTreeSet<SurfaceId> = BTreeSet::new();
    while done.len() < fills.len() {
        let waits = |fill: &Fill| {
            fill.sides
                .iter()
                .filter_map(|side| side.planes)
                .any(|on| fills.contains_key(&on) && !done.contains(&on))
        };
        let ready: Vec<SurfaceId> =
            fills.iter().filter(|(id, fill)| !done.contains(id) && !waits(fill)).map(|(id, _)| *id).collect();
        if ready.is_empty()
            && let Some(surface) = fills.keys().find(|id| !done.contains(id))
        {
            let why = "its planes come, round about, from itself";
            return Err(Defect::Fill { surface: *surface, why });
        }
        done.extend(ready);
    }
    Ok(())
}

fn validate_ribbons(id: SurfaceId, ribbons: &[FillRibbon]) -> Result<(), Defect> {
    for (side, ribbon) in ribbons.iter().enumerate() {
        let points = ribbon.row0.len();
        if !(2..=MAX_ROW).contains(&points) || !(ribbon.row1.is_empty() || ribbon.row1.len() == points) {
            return Err(Defect::FillRibbon { surface: id, side });
        }
        for (row, list) in [&ribbon.row0, &ribbon.row1].into_iter().enumerate() {
            for (column, at) in list.iter().enumerate() {
                coordinate(&format!("{id}, ribbon {side}, point {column} of row {row}"), *at)?;
            }
        }
    }
    Ok(())
}
