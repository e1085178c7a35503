//! What the displacements of a document must satisfy. Whether a foot lies where something can move is for the modeler to say.

use super::{Defect, coordinate, limit, no_direction};
use crate::displacement::{Blend, Displaced, Foot, Hold, LEAST_RANGE, MOST_FEET, MOST_RANGE};
use crate::document::{Document, MAX_COORDINATE};
use crate::id::SurfaceId;

/// Most feet and pins of all surfaces together.
const MAX_FEET: usize = 256;
/// How many times further than across a displacement may reach.
const STRETCHES: core::ops::RangeInclusive<f64> = 1.0 / 64.0..=64.0;

impl Document {
    pub(super) fn validate_displacements(&self) -> Result<(), Defect> {
        let feet =
            |displaced: &Displaced| displaced.items.iter().map(|item| item.foot.places().len().max(1)).sum();
        let all = self.displacements.values();
        let counts: Vec<usize> = all.clone().map(feet).collect();
        counts.iter().try_for_each(|&count| limit("feet of displacements of a surface", count, MOST_FEET))?;
        let pins: usize = all.map(|displaced| displaced.blending.pins.len()).sum();
        limit("feet and pins of displacements", counts.iter().sum::<usize>() + pins, MAX_FEET)?;
        self.displacements.iter().try_for_each(|(id, displaced)| self.validate_displaced(*id, displaced))
    }

    fn validate_displaced(&self, id: SurfaceId, displaced: &Displaced) -> Result<(), Defect> {
        if self.kind_of(id).is_none() {
            return Err(Defect::NothingToDisplace(id));
        }
        let embedded = self.surfaces.get(&id).map_or(&[][..], |surface| &surface.skeleton.curves);
        if let Some(curve) = displaced.curves().find(|curve| embedded.iter().all(|e| e.curve != *curve)) {
            return Err(Defect::DisplacedCurve { surface: id, curve });
        }
        for (item, number) in displaced.items.iter().zip(1..) {
            let refuse = |why| Err(Defect::Displacement { surface: id, number, why });
            for at in item.foot.places() {
                coordinate(&format!("{id}, foot of displacement {number}"), *at)?;
            }
            coordinate(&format!("{id}, displacement {number}"), item.by)?;
            if item.foot == Foot::All(Vec::new()) {
                return refuse("it has no foot");
            }
            if !(LEAST_RANGE..=MOST_RANGE).contains(&item.range) {
                return refuse("its range must be a number between -20 and 0.99");
            }
            if let Some(stretch) = item.direction {
                if let Some(why) = no_direction(stretch.along) {
                    return refuse(why);
                }
                if !STRETCHES.contains(&stretch.times) {
                    return refuse("it must reach between 1/64 and 64 times as far along its direction");
                }
            }
        }
        validate_blending(id, displaced)
    }
}

fn validate_blending(id: SurfaceId, displaced: &Displaced) -> Result<(), Defect> {
    let refuse = |why| Err(Defect::Blending { surface: id, why });
    match displaced.blending.blend {
        Blend::Bump(k) if !(k > 0.0 && k <= 100.0) => {
            return refuse("the exponent of a bump must be above 0 and at most 100");
        }
        Blend::Eta(delta) if !(0.0..0.5).contains(&delta) => {
            return refuse("the margin of an eta blend must be in [0, 1/2)");
        }
        Blend::Erbs | Blend::Bump(_) | Blend::Eta(_) => {}
    }
    for pin in &displaced.blending.pins {
        let Hold::Around { at, radius } = pin else { continue };
        coordinate(&format!("{id}, pin of displacements"), *at)?;
        if !(0.0..=MAX_COORDINATE).contains(radius) {
            return refuse("the radius of a pin must be a number from 0 to 1e6");
        }
    }
    Ok(())
}
