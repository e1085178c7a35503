//! The acts of a designer. One word = one variant = one file in the modeler's `operation/` = one word of
//! the command line = one label on the page.

use crate::cage::CageSettings;
use crate::cage_source::CageSource;
use crate::displacement::{Blending, Displacement};
use crate::document::{Density, Objective};
use crate::fill::{FillStyle, Hole};
use crate::fixed_mesh::MeshSource;
use crate::id::{CurveId, PointId, SurfaceId};
use crate::surgery::{Border, Extent, JoinRibbon, On};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// An act that changes the document. Each is one step of undo; a refused one changes nothing.
///
/// Its name in a script is its word in lower case with hyphens: `{"s-loop": {"surface": 1, "along": [...]}}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", deny_unknown_fields)]
pub enum Edit {
    /// Places a control point in space.
    Point {
        /// Where.
        at: DVec3,
    },
    /// Moves a control point, and everything that hangs on it.
    Move {
        /// Which point.
        point: PointId,
        /// Where to.
        to: DVec3,
    },
    /// Makes a fair curve through points, in order. Points that it wants in new places are made with it.
    Curve {
        /// The points, old and new: at least 2, or 3 for a closed curve.
        through: Vec<Through>,
        /// Whether it closes.
        closed: bool,
    },
    /// Skins a closed curve, or a loop of curves that meet at control points (thesis section 7.3.2, `sheet`).
    Sheet {
        /// The closed curve, or one of the loop. Of loops along an open curve the shortest is taken, rather one that is a hole; and
        /// so it is along a closed one that has a surface on both sides somewhere and bounds a hole with others. Curves of
        /// which the loop takes only a part are divided.
        boundary: CurveId,
    },
    /// Skins the space between two closed curves, a cylinder, or between two open ones or stretches, a strip (thesis section
    /// 7.3.2, `sweep`).
    Sweep {
        /// One end.
        from: CurveId,
        /// The other end.
        to: CurveId,
        /// Of either only the stretch between two of its control points: on a closed curve from the first to the second, in
        /// the curve's own sense. The curve is divided there; its parts keep their directions. `None` takes all of it.
        #[serde(default)]
        stretches: [Option<[PointId; 2]>; 2],
        /// Whether the second is run through the other way than lies nearest: a twist, or a surface with one side.
        #[serde(default)]
        reversed: bool,
    },
    /// Draws a control curve on a surface (thesis section 7.3.2, `s-loop`).
    SLoop {
        /// Which surface.
        surface: SurfaceId,
        /// Places on it, in order: at least 2, or 3 for a closed curve. They become control points.
        along: Vec<DVec3>,
        /// Whether it closes.
        closed: bool,
    },
    /// Makes a curve that lies near a surface a control curve of it: the curve stays, the surface moves to it (thesis
    /// sections 4.2.3 and 7.3.3).
    Embed {
        /// Which curve.
        curve: CurveId,
        /// Which surface.
        surface: SurfaceId,
    },
    /// Destroys a region; the curves around it stay, as rims (thesis section 7.3.2, `burnout`).
    Burnout {
        /// A place in it.
        region: On,
    },
    /// Cuts a surface; the curves along the cut are doubled, so that both sides are free (thesis section 7.3.2, `split`).
    Split {
        /// Where.
        border: Border,
    },
    /// Cuts a surface, but leaves both sides on the same curves: they meet in a crease (thesis section 7.3.2, `crease`).
    Crease {
        /// Where.
        border: Border,
    },
    /// The inverse: the two surfaces at a curve become one that runs smoothly through it (thesis section 7.3.2, `smooth`).
    Smooth {
        /// The curve on the rims of both.
        curve: CurveId,
    },
    /// Joins two rims: laid on one another, or with a band between (thesis section 7.3.5).
    Glue {
        /// A place on the one; it stays where it is.
        from: On,
        /// A place on the other.
        to: On,
        /// Whether a band is made between them, instead of laying the second on the first.
        skirt: bool,
        /// Whether they are joined the other way round than lies nearest, which may make a surface with one side.
        #[serde(default)]
        reversed: bool,
    },
    /// Makes a tube between two places, of two surfaces or of one: a hole in each, and a band between (thesis section 7.4.3).
    Merge {
        /// One place.
        from: On,
        /// The other.
        to: On,
        /// Radius of the holes, in model units.
        radius: f64,
        /// Whether their rims stay as control curves, or are freed.
        keep: bool,
    },
    /// The same where two surfaces come closest to each other and have room for the holes (thesis section 7.4.3, `auto-merge`).
    MergeClosest {
        /// The one surface; the tube becomes part of it.
        first: SurfaceId,
        /// The other.
        second: SurfaceId,
        /// Radius of the holes, in model units.
        radius: f64,
        /// Whether their rims stay as control curves, or are freed.
        keep: bool,
    },
    /// Fills a loop of curves, of rims or of both with an exact patch (Salvi 2020).
    Fill {
        /// Which loop.
        hole: Hole,
        /// How it is filled.
        #[serde(default)]
        style: FillStyle,
    },
    /// Fills all loops of a network of curves, so that the patches meet in common tangent planes.
    FillNetwork {
        /// A curve of the network; without one all curves count.
        #[serde(default)]
        curve: Option<CurveId>,
        /// How they are filled.
        #[serde(default)]
        style: FillStyle,
    },
    /// Chooses anew how a fill is filled.
    Refill {
        /// Which fill.
        surface: SurfaceId,
        /// How.
        style: FillStyle,
    },
    /// Turns a fill about one of its sides, and makes it leave that side more or less strongly.
    Lean {
        /// Which fill.
        surface: SurfaceId,
        /// Which of its sides, from 1.
        side: usize,
        /// By how much its fair planes are turned in the middle of the side, in radians from -π/2 to π/2; positive lifts the patch
        /// inside to the side of its normal.
        #[serde(default)]
        turn: f64,
        /// By what the derivative across the side is multiplied in its middle, 0.1 to 5.
        #[serde(default = "one")]
        strength: f64,
    },
    /// Cuts two surfaces along their intersection and joins them there (thesis section 3.4.1). One that the intersection
    /// does not divide is not cut: what is cut of the other stands on it.
    Trim {
        /// A place on the part of the first that stays.
        first: On,
        /// A place on the part of the second that stays.
        second: On,
        /// Whether they join smoothly there, instead of in a crease.
        smooth: bool,
        /// Whether, and how, both are held to directions in which they leave the curve at which they are joined.
        #[serde(default)]
        ribbon: Option<JoinRibbon>,
    },
    /// Grows or shrinks the loop of a closed curve about its centre.
    Expand {
        /// Which curve.
        curve: CurveId,
        /// To what size.
        to: Extent,
    },
    /// Turns a surface inside out: its outside becomes its inside.
    Reverse {
        /// Which surface.
        surface: SurfaceId,
    },
    /// Turns the surfaces that meet this one at curves, and those that meet them, so that they have their outside where this
    /// one has it.
    Propagate {
        /// The surface that stays as it is.
        surface: SurfaceId,
    },
    /// Makes a control point on a surface, at the place nearest to a given one.
    Pin {
        /// Which surface.
        surface: SurfaceId,
        /// Where, roughly.
        at: DVec3,
    },
    /// Makes a control point on a curve, at the place nearest to a given one.
    Insert {
        /// Which curve.
        curve: CurveId,
        /// Where, roughly.
        at: DVec3,
    },
    /// Lets a control point go: the shape relaxes, the topology stays.
    Release {
        /// Which point.
        point: PointId,
    },
    /// Deletes a point that nothing hangs on.
    DeletePoint {
        /// Which point.
        point: PointId,
    },
    /// Deletes a curve that no surface is bounded by, and the points that only it used.
    DeleteCurve {
        /// Which curve.
        curve: CurveId,
    },
    /// Deletes a surface and the points that only it used; its curves stay.
    DeleteSurface {
        /// Which surface.
        surface: SurfaceId,
    },
    /// Sets the target edge length of the approximation; `None` leaves it to the modeler.
    Spacing {
        /// Whose edge length it is.
        of: SpacingOf,
        /// In model units; `None` follows what the surface or the document says.
        spacing: Option<f64>,
    },
    /// Chooses how edge lengths vary.
    Density {
        /// Which surface's choice it is; `None` for the document's.
        of: Option<SurfaceId>,
        /// The choice; `None` follows the document (and for the document means the default).
        density: Option<Density>,
    },
    /// Chooses what shapes minimise.
    Objective {
        /// Whose choice it is.
        of: ObjectiveOf,
        /// The choice; `None` follows the document (and for the document means the default).
        objective: Option<Objective>,
    },
    /// Lets a region take on the relief of another surface, or sets it free (thesis section 7.3.3, region shadowing).
    Shadow {
        /// A place in the region.
        region: On,
        /// The stamp: another surface that is a disc. `None` sets the region free.
        of: Option<SurfaceId>,
        /// What its heights are multiplied by; below 0 they are pressed in.
        #[serde(default = "crate::shadow::one")]
        strength: f64,
        /// By how much it is turned from anchor on anchor, in radians; `None` turns it as little as it can be from how it
        /// stands in space.
        #[serde(default)]
        turn: Option<f64>,
    },
    /// Prescribes the direction of a curve at one of its control points, or sets it free.
    Tangent {
        /// Which curve.
        curve: CurveId,
        /// At which of its points.
        point: PointId,
        /// In the curve's own sense; any length but zero. `None` sets it free.
        direction: Option<DVec3>,
    },
    /// Prescribes the tangent plane of a surface at one of its control points, or sets it free.
    Normal {
        /// Which surface.
        surface: SurfaceId,
        /// At which of its points.
        point: PointId,
        /// Its normal, in either sense; any length but zero. `None` sets it free.
        normal: Option<DVec3>,
    },
    /// Prescribes how a surface leaves one of its curves, or sets it free.
    Ribbon {
        /// Which surface.
        surface: SurfaceId,
        /// Which of its curves.
        curve: CurveId,
        /// How; `None` sets it free.
        leave: Option<Leave>,
    },
    /// Displaces the inside of a surface around a foot.
    Displace {
        /// Which surface.
        surface: SurfaceId,
        /// What moves, and by what. Its places lie on the surface as it is without displacements.
        displacement: Displacement,
    },
    /// Puts another displacement in the place of one.
    ChangeDisplacement {
        /// Which surface.
        surface: SurfaceId,
        /// Which of its displacements, from 1.
        number: usize,
        /// The new one.
        to: Displacement,
    },
    /// Lets one more place of a surface move with a displacement.
    AddFoot {
        /// Which surface.
        surface: SurfaceId,
        /// Which of its displacements, from 1.
        number: usize,
        /// The place, on the surface as it is shown.
        at: DVec3,
    },
    /// Takes a displacement away; those after it get lower numbers.
    EraseDisplacement {
        /// Which surface.
        surface: SurfaceId,
        /// Which of its displacements, from 1.
        number: usize,
    },
    /// Takes all displacements of a surface away, and its pins.
    DropDisplacements {
        /// Which surface.
        surface: SurfaceId,
    },
    /// Chooses what the displacements of a surface have in common, its pins too.
    Blending {
        /// Which surface.
        surface: SurfaceId,
        /// The choice.
        blending: Blending,
    },
    /// Makes a fixed mesh.
    Mesh {
        /// Which mesh.
        from: MeshSource,
    },
    /// Makes a fixed mesh of what is shown of a surface, with its displacements. It keeps its number; the curves that it followed
    /// stay, and what takes tangent planes from the inside of a fair surface is freed.
    Bake {
        /// Which surface.
        surface: SurfaceId,
    },
    /// Lays a surface over a cage. The vertices of the cage become control points.
    Cage {
        /// Which cage.
        from: CageSource,
    },
    /// Chooses how a surface over a cage is made.
    CageSettings {
        /// Which surface.
        surface: SurfaceId,
        /// How.
        settings: CageSettings,
    },
    /// Moves a face of a cage out along its normal, with a wall of quads around it.
    Extrude {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Which face of the cage, from 0; it keeps its number.
        face: u32,
        /// How far, in model units; negative is inwards.
        distance: f64,
    },
    /// Makes a control curve of the rim of an open cage, which goes where the rim goes: all round, or as far as it does not turn.
    Rim {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The ends of an edge at which the cage ends.
        ends: [PointId; 2],
        /// Of that stretch only what lies between these two vertices, the edge within it; `None` takes all of it.
        #[serde(default)]
        between: Option<[PointId; 2]>,
    },
    /// Takes a face out of a cage, which leaves a hole. Later faces move up by one.
    DeleteFace {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Which face of the cage, from 0.
        face: u32,
    },
    /// Puts a new vertex on an edge of a cage and joins it, in each face there, to the corner farthest along the face.
    SplitEdge {
        /// The surface over the cage.
        surface: SurfaceId,
        /// The ends of the edge.
        ends: [PointId; 2],
        /// Where between them, from 0 at the first to 1 at the second.
        #[serde(default = "middle")]
        at: f64,
    },
    /// Divides a face of a cage: between two of its corners, or into triangles round its centre.
    SplitFace {
        /// The surface over the cage.
        surface: SurfaceId,
        /// Which face of the cage, from 0.
        face: u32,
        /// Two corners that are no neighbours; `None` for the centre.
        #[serde(default)]
        between: Option<[PointId; 2]>,
    },
    /// Moves several control points by the same way, and everything that hangs on them.
    Shift {
        /// Which points.
        points: Vec<PointId>,
        /// By how much.
        by: DVec3,
    },
    /// Renames the document.
    Rename {
        /// The new name, at most 200 characters.
        name: String,
    },
}

impl Edit {
    /// What the act is called on the page, for the undo list.
    #[must_use]
    pub fn label(&self) -> &'static str {
        match self {
            Self::Point { .. } => "Point",
            Self::Move { .. } | Self::Shift { .. } => "Move",
            Self::Curve { .. } => "Curve",
            Self::Sheet { .. } => "Sheet",
            Self::Sweep { .. } => "Sweep",
            Self::SLoop { .. } => "Draw",
            Self::Embed { .. } => "Embed",
            Self::Burnout { .. } => "Burn out",
            Self::Split { .. } => "Split",
            Self::Crease { .. } => "Crease",
            Self::Smooth { .. } => "Smooth",
            Self::Glue { .. } => "Glue",
            Self::Merge { .. } | Self::MergeClosest { .. } => "Merge",
            Self::Trim { .. } => "Trim",
            Self::Fill { .. } => "Fill",
            Self::FillNetwork { .. } => "Fill all",
            Self::Refill { .. } => "Refill",
            Self::Lean { .. } => "Lean",
            Self::Expand { .. } => "Expand",
            Self::Reverse { .. } => "Reverse",
            Self::Propagate { .. } => "Propagate",
            Self::Pin { .. } | Self::Insert { .. } => "Control point",
            Self::Release { .. } => "Release",
            Self::DeletePoint { .. } | Self::DeleteCurve { .. } | Self::DeleteSurface { .. } => "Delete",
            Self::Spacing { .. } => "Resolution",
            Self::Density { .. } => "Density",
            Self::Objective { .. } => "Objective",
            Self::Shadow { .. } => "Shadow",
            Self::Tangent { .. } => "Tangent",
            Self::Normal { .. } => "Normal",
            Self::Ribbon { .. } => "Ribbon",
            Self::Displace { .. } => "Displace",
            Self::ChangeDisplacement { .. } => "Change displacement",
            Self::AddFoot { .. } => "Add foot",
            Self::EraseDisplacement { .. } => "Erase displacement",
            Self::DropDisplacements { .. } => "Drop displacements",
            Self::Blending { .. } => "Blending",
            Self::Mesh { .. } => "Mesh",
            Self::Bake { .. } => "Bake",
            Self::Cage { .. } => "Cage",
            Self::CageSettings { .. } => "Cage settings",
            Self::Extrude { .. } => "Extrude",
            Self::Rim { .. } => "Rim curve",
            Self::DeleteFace { .. } => "Delete face",
            Self::SplitEdge { .. } => "Split edge",
            Self::SplitFace { .. } => "Split face",
            Self::Rename { .. } => "Rename",
        }
    }
}

fn one() -> f64 {
    1.0
}

fn middle() -> f64 {
    0.5
}

/// How a surface leaves a curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Leave {
    /// At an angle in radians from the plane in which the curve lies (as nearly as it lies in one): 0 goes on inside
    /// the curve, in that plane, a positive one rises to the side of the surface's normal. Between -π and π.
    Angle(f64),
    /// As it does at the moment, at each of the curve's points that has no direction yet.
    Now,
    /// In these directions, by control point.
    Cross(BTreeMap<PointId, DVec3>),
    /// So that it goes on smoothly from an exact surface that ends at the curve.
    Onto(SurfaceId),
}

/// What an objective is chosen for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum ObjectiveOf {
    /// Everything that has no choice of its own.
    Document,
    /// A curve.
    Curve(CurveId),
    /// A surface.
    Surface(SurfaceId),
    /// The region of a surface, between its curves, nearest to a place.
    Region {
        /// Which surface.
        surface: SurfaceId,
        /// Where, roughly.
        at: DVec3,
    },
}

/// What an edge length is set for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SpacingOf {
    /// Everything that has none of its own.
    Document,
    /// A surface.
    Surface(SurfaceId),
    /// The region of a surface, between its curves, nearest to a place.
    Region {
        /// Which surface.
        surface: SurfaceId,
        /// Where, roughly.
        at: DVec3,
    },
}

/// What a new curve passes through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Through {
    /// A control point that is there.
    Point(PointId),
    /// A place, which becomes a control point.
    Place(DVec3),
}
