//! The names of the examples that the page and the command line offer; the modeler builds them.

use serde::{Deserialize, Serialize};

/// An example.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Example {
    /// A flat disc.
    Disc,
    /// A disc with three raised control points: what the page opens with.
    RaisedDisc,
    /// A sheet over a boundary that rises and falls.
    Saddle,
    /// A cylinder between two closed curves.
    Cylinder,
    /// A closed surface of genus 0 held by six points.
    Ball,
}

impl Example {
    /// All examples, in the order of the menu.
    pub const ALL: [Self; 5] = [Self::Disc, Self::RaisedDisc, Self::Saddle, Self::Cylinder, Self::Ball];

    /// What the menu calls it.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Disc => "Disc",
            Self::RaisedDisc => "Raised disc",
            Self::Saddle => "Saddle",
            Self::Cylinder => "Cylinder",
            Self::Ball => "Ball on six points",
        }
    }

    /// The word for it on the command line.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Disc => "disc",
            Self::RaisedDisc => "raised-disc",
            Self::Saddle => "saddle",
            Self::Cylinder => "cylinder",
            Self::Ball => "ball",
        }
    }
}
