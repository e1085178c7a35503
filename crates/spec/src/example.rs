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
    /// A torus on three curves (thesis figure 3.1).
    Torus,
    /// A surface with three branches (thesis figures 2.1 and 4.11).
    PartyHat,
    /// A cylinder capped to a sphere (thesis figure 4.6).
    CappedCylinder,
    /// Two cylinders joined end to end (thesis figure 4.7).
    GluedCylinders,
    /// A torus with a handle attached at both ends (thesis figure 7.2).
    Handle,
    /// A closed surface with one side (thesis figure 7.3).
    KleinMug,
    /// A surface of genus 3: one ball, merged with itself three times.
    ThreeHandles,
    /// A surface with one side and one edge.
    MoebiusStrip,
    /// A ball and a cylinder that ends in it, trimmed against each other and joined.
    Spout,
    /// A ball and a cylinder through it, trimmed and joined to a torus; one of the two curves in which they met is widened
    /// (thesis figures 3.4 and 3.5).
    BoredBall,
    /// A surface over a cage of quads round a hole.
    TorusCage,
    /// A surface over a cage of three lobes with a hole through each.
    Trebol,
    /// A surface over an icosahedron.
    Icosahedron,
    /// A patch of six sides whose middle is lifted by a displacement.
    SixSided,
    /// Patches over half a dodecahedron: a network of curves, all loops of which are filled.
    ConnectedPatches,
    /// A torus over a cage, displaced at six places; its inner equator is pinned.
    LobedRing,
}

impl Example {
    /// The examples that are written down as they are.
    pub const PLAIN: [Self; 5] = [Self::Disc, Self::RaisedDisc, Self::Saddle, Self::Cylinder, Self::Ball];

    /// The constructions of the thesis, which a script of acts builds.
    pub const BUILT: [Self; 10] = [
        Self::Torus,
        Self::PartyHat,
        Self::CappedCylinder,
        Self::GluedCylinders,
        Self::Handle,
        Self::KleinMug,
        Self::ThreeHandles,
        Self::MoebiusStrip,
        Self::Spout,
        Self::BoredBall,
    ];

    /// Surfaces over cages.
    pub const CAGES: [Self; 3] = [Self::TorusCage, Self::Trebol, Self::Icosahedron];

    /// Fills and displaced surfaces, which a script of acts builds, too.
    pub const PATCHES: [Self; 3] = [Self::SixSided, Self::ConnectedPatches, Self::LobedRing];

    /// All examples, in the order of the menu.
    pub fn all() -> impl Iterator<Item = Self> {
        Self::PLAIN.into_iter().chain(Self::BUILT).chain(Self::CAGES).chain(Self::PATCHES)
    }

    /// What the menu calls it.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Disc => "Disc",
            Self::RaisedDisc => "Raised disc",
            Self::Saddle => "Saddle",
            Self::Cylinder => "Cylinder",
            Self::Ball => "Ball on six points",
            Self::Torus => "Torus on three curves",
            Self::PartyHat => "Party hat",
            Self::CappedCylinder => "Capped cylinder",
            Self::GluedCylinders => "Glued cylinders",
            Self::Handle => "Torus with a handle",
            Self::KleinMug => "Klein mug",
            Self::ThreeHandles => "Three handles",
            Self::MoebiusStrip => "Möbius strip",
            Self::Spout => "Ball with a spout",
            Self::BoredBall => "Ball with a bore",
            Self::TorusCage => "Torus on a cage",
            Self::Trebol => "Trebol on a cage",
            Self::Icosahedron => "Icosahedron",
            Self::SixSided => "Patch of six sides",
            Self::ConnectedPatches => "Six patches",
            Self::LobedRing => "Lobed ring",
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
            Self::Torus => "torus",
            Self::PartyHat => "party-hat",
            Self::CappedCylinder => "capped-cylinder",
            Self::GluedCylinders => "glued-cylinders",
            Self::Handle => "handle",
            Self::KleinMug => "klein-mug",
            Self::ThreeHandles => "three-handles",
            Self::MoebiusStrip => "moebius-strip",
            Self::Spout => "spout",
            Self::BoredBall => "bored-ball",
            Self::TorusCage => "torus-cage",
            Self::Trebol => "trebol",
            Self::Icosahedron => "icosahedron",
            Self::SixSided => "six-sided",
            Self::ConnectedPatches => "connected-patches",
            Self::LobedRing => "lobed-ring",
        }
    }
}
