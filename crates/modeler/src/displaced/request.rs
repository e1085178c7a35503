//! What a document says of displacements, in the words of the mathematics.

use super::base::Base;
use super::footing::Spot;
use ductile_patch as patch;
use ductile_patch::DisplacementError;
use ductile_spec::{Blend, Blending, Combination, Displacement, Foot, Profile};

/// What all displacements of a surface have in common.
pub(super) fn settings(blending: &Blending) -> patch::Settings {
    patch::Settings {
        laplacian: patch::Laplacian::default(),
        profile: match blending.profile {
            Profile::Conformal => patch::Profile::Conformal,
            Profile::Harmonic => patch::Profile::Harmonic,
        },
        combination: match blending.combination {
            Combination::Pairwise => patch::Combination::Pairwise,
            Combination::Plain => patch::Combination::Plain,
        },
        blend: match blending.blend {
            Blend::Erbs => patch::Blend::Erbs,
            Blend::Bump(k) => patch::Blend::Bump(k),
            Blend::Eta(delta) => patch::Blend::Eta(delta),
        },
    }
}

/// The items of a displacement, each with where it stands: a foot for each of its places, or a curve.
pub(super) fn items_of(
    displacement: &Displacement,
    spots: &[Spot],
    base: &Base<'_>,
) -> Result<Vec<(Option<Spot>, patch::Item)>, DisplacementError> {
    let Foot::Along(curve) = displacement.foot else {
        return spots.iter().map(|spot| Ok((Some(*spot), item_at(displacement, spot)?))).collect();
    };
    let (vertices, is_closed) = base.along(curve).ok_or(DisplacementError::ShortCurve)?;
    let item = patch::Item::curve(vertices, is_closed, vec![displacement.by])?;
    Ok(vec![(None, reaching(item, displacement)?)])
}

/// A foot of a displacement at a place.
fn item_at(displacement: &Displacement, spot: &Spot) -> Result<patch::Item, DisplacementError> {
    let item = match spot.corner() {
        Some(vertex) => patch::Item::foot(vertex, displacement.by),
        None => patch::Item::spot(spot.corners, spot.shares, displacement.by)?,
    };
    reaching(item, displacement)
}

fn reaching(item: patch::Item, displacement: &Displacement) -> Result<patch::Item, DisplacementError> {
    let item = item.with_range(patch::Range::new(displacement.range)?);
    match displacement.direction {
        Some(stretch) => Ok(item.with_direction(patch::Direction::new(stretch.along, stretch.times)?)),
        None => Ok(item),
    }
}
