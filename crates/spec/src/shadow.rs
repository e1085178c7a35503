//! Region shadowing: a region takes on the relief of another surface, as a sheet of metal takes that of an embossing stamp
//! (Welch 1995, section 7.3.3).

use crate::id::SurfaceId;
use core::f64::consts::TAU;
use serde::{Deserialize, Serialize};

/// Most that heights may be multiplied by.
pub const MOST_STRENGTH: f64 = 100.0;

/// What a region shadows, and how.
///
/// Stamp and region are discs, and each is spread over the unit disc by harmonic functions that turn the length along its rim
/// into angle, from an anchor on. The relief is how the stamp departs from the membrane in its rim; it is as large as the
/// region is, compared by the lengths of the rims.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shadow {
    /// The stamp: any other surface that is a disc.
    pub of: SurfaceId,
    /// What its heights are multiplied by; below 0 they are pressed in.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub strength: f64,
    /// By how much the relief is turned from anchor on anchor, counter-clockwise seen from outside, in radians.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub turn: f64,
}

impl Shadow {
    /// What is wrong with its numbers, if anything is.
    #[must_use]
    pub fn fault(&self) -> Option<&'static str> {
        if !(-MOST_STRENGTH..=MOST_STRENGTH).contains(&self.strength) {
            return Some("its strength must be a number between -100 and 100");
        }
        (!(-TAU..=TAU).contains(&self.turn)).then_some("its turn must be an angle of at most a full turn")
    }
}

pub(crate) fn one() -> f64 {
    1.0
}

fn is_one(value: &f64) -> bool {
    *value == 1.0
}

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
