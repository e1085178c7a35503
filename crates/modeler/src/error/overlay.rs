//! Why what lies over surfaces cannot be: displacements and shadows.

use ductile_patch::DisplacementError;
use ductile_patch::relief::ReliefError;
use thiserror::Error;

/// Why a displacement cannot be met, in words for the designer.
pub(super) fn displaced(reason: &DisplacementError) -> String {
    let why = match reason {
        DisplacementError::Held(_) => "its foot is on the boundary or on a pin, which stay where they are",
        DisplacementError::NoBoundary(_) => {
            "the surface is closed, so that all of it would move: pin a place that stays first, with a Shift-click on the page"
        }
        DisplacementError::Touching(..) => "there is a foot at this place already; change that one",
        DisplacementError::BadPosition(_) => "there is no surface for its foot to stand on",
        DisplacementError::FlatTriangle(_) | DisplacementError::Unsolvable(_) => {
            "the triangles there are too bad; wait until the surface rests, or make the spacing smaller"
        }
        other => return other.to_string(),
    };
    why.to_owned()
}

/// Why a region cannot shadow a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ShadowError {
    /// The region is no disc.
    #[error("the region does not suit, {0}")]
    Region(ReliefError),
    /// The stamp is no disc.
    #[error("the stamp does not suit, {0}")]
    Stamp(ReliefError),
    /// There is nothing to be seen of one of them at the moment.
    #[error("one of them has no shape at the moment")]
    Lost,
}
