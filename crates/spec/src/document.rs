//! The document: the control specification that *is* the model. The mesh on screen is only its
//! current approximation (Welch 1995, sections 3.2 and 4.3).
//!
//! Points are placed; curves pass through points in order and are fair in between; a surface has a
//! topology, given by a *skeleton* (the "dehydrated" mesh of thesis section 5.2), and controls that it
//! must meet. All lengths are model units.

use crate::cage::Cage;
use crate::displacement::Displaced;
use crate::fill::Fill;
use crate::fixed_mesh::FixedMesh;
use crate::frame::SurfaceKind;
use crate::id::{CurveId, PointId, SurfaceId};
use crate::shadow::Shadow;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// Largest absolute value of a coordinate that a document may hold, in model units.
///
/// Beyond it the square of a length times the square of a curvature loses the digits the solver needs.
pub const MAX_COORDINATE: f64 = 1e6;

/// A whole model, as its designer specified it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// What the designer calls it.
    pub name: String,
    /// What its surfaces and curves minimise where they do not say otherwise.
    pub objective: Objective,
    /// Target edge length of the approximating mesh, in model units; `None` leaves it to the modeler.
    pub spacing: Option<f64>,
    /// How edge lengths vary over its surfaces and curves where they do not say otherwise.
    pub density: Density,
    /// The control points.
    pub points: BTreeMap<PointId, DVec3>,
    /// The control curves.
    pub curves: BTreeMap<CurveId, Curve>,
    /// The fair surfaces. They, the cages, the fills and the meshes are all surfaces: an identity is given once among the four.
    pub surfaces: BTreeMap<SurfaceId, Surface>,
    /// The surfaces over cages.
    pub cages: BTreeMap<SurfaceId, Cage>,
    /// The patches that fill loops of curves.
    pub fills: BTreeMap<SurfaceId, Fill>,
    /// The fixed meshes.
    pub meshes: BTreeMap<SurfaceId, FixedMesh>,
    /// What moves the inside of surfaces, of whatever kind.
    pub displacements: BTreeMap<SurfaceId, Displaced>,
}

/// What a fair shape minimises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Objective {
    /// The integral of the sum of squared principal curvatures, thesis eq. (4.2); of a curve, of its squared curvature.
    #[default]
    ThinPlate,
    /// The variation of curvature (third order): spheres, cylinders, circles and lines are left as they are.
    Fair,
    /// Curvature spread evenly, without an energy: the mean curvature is harmonic, a curve's curvature linear.
    Neutral,
    /// The area, or the length: a soap film, a taut string.
    Membrane,
}

impl Objective {
    /// All of them, in the order of a menu.
    pub const ALL: [Self; 4] = [Self::ThinPlate, Self::Fair, Self::Neutral, Self::Membrane];

    /// Its name on the page.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::ThinPlate => "Thin plate",
            Self::Fair => "Fair",
            Self::Neutral => "Neutral",
            Self::Membrane => "Membrane",
        }
    }
}

/// How the edge lengths of a mesh vary over a surface or along a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Density {
    /// All about as long as the spacing says.
    #[default]
    Uniform,
    /// Shorter than that where the shape bends much, longer where it is nearly flat.
    Curvature,
}

impl Density {
    /// Both, in the order of a menu.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::Curvature];

    /// Its name on the page.
    #[must_use]
    pub fn label(self) -> &'static str {
        match self {
            Self::Uniform => "Uniform",
            Self::Curvature => "By curvature",
        }
    }

    /// Whether it is what a document has that does not say.
    pub(crate) fn is_default(&self) -> bool {
        *self == Self::default()
    }
}

/// A fair curve through control points, in order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Curve {
    /// The points that it passes through: at least 2, or 3 if it is closed.
    pub through: Vec<PointId>,
    /// Whether it returns from the last point to the first.
    #[serde(default, skip_serializing_if = "core::ops::Not::not")]
    pub closed: bool,
    /// What it minimises where that differs from the document's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// The direction in which it passes through some of its points, in its own sense. Any length but zero means the same.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", deserialize_with = "crate::text::unique")]
    pub tangents: BTreeMap<PointId, DVec3>,
    /// The surface over a cage whose rim it is, from vertex to vertex of the cage: then it is no fair curve, but goes where that rim
    /// goes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rim: Option<SurfaceId>,
}

/// A fair surface under its controls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Surface {
    /// Its topology and the place of its controls in it.
    pub skeleton: Skeleton,
    /// Target edge length where it differs from the document's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// How edge lengths vary over it where that differs from the document's choice.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<Density>,
    /// What it minimises where that differs from the document's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// Regions that minimise something else than the rest of it, have another edge length, or shadow another surface.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<Region>,
    /// Normals of its tangent plane at some of its control points. Any length but zero, and either sense, mean the same.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", deserialize_with = "crate::text::unique")]
    pub normals: BTreeMap<PointId, DVec3>,
    /// How it leaves some of its curves.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", deserialize_with = "crate::text::unique")]
    pub ribbons: BTreeMap<CurveId, Ribbon>,
}

/// A ribbon: the tangent planes of a surface along one of its curves (thesis sections 2.5.3 and 5.5).
///
/// Between two of its directions the plane turns about the curve without haste, and no more than it must; beyond the
/// last one of an open curve, or all along with a single one, it is carried on without turning about the curve.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Ribbon {
    /// The direction in which the surface leaves the curve at some of its points, at least one. What runs along the
    /// curve does not count, nor does the length. Inside a surface it is the side to the curve's left.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty", deserialize_with = "crate::text::unique")]
    pub cross: BTreeMap<PointId, DVec3>,
    /// An exact surface that ends at the curve, instead of directions: it is gone on from smoothly, wherever it is moved.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub onto: Option<SurfaceId>,
}

impl Ribbon {
    /// A ribbon with these directions.
    #[must_use]
    pub fn directed(cross: BTreeMap<PointId, DVec3>) -> Self {
        Self { cross, onto: None }
    }
}

/// A region of a surface: what lies beside a stretch of one of its curves, up to the next curves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// A curve at its border.
    pub curve: CurveId,
    /// The control point from which the stretch of that curve runs to the next.
    pub from: PointId,
    /// On which side of it.
    pub side: Side,
    /// What the region minimises, if something else than the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub objective: Option<Objective>,
    /// Its target edge length in model units, if another than the surface's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacing: Option<f64>,
    /// Whose relief it takes on, if any.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shadow: Option<Shadow>,
}

/// A side of a curve in a surface, along the curve, seen from where the triangles beside it look counter-clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Side {
    /// To its left.
    Left,
    /// To its right.
    Right,
}

/// A minimal triangulation of a surface: the least that still has its topology and all of its controls.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Skeleton {
    /// The vertices.
    pub vertices: Vec<SkeletonVertex>,
    /// Corners of the triangles, indices into `vertices`. Windings may disagree: a Möbius strip is welcome.
    pub triangles: Vec<[u32; 3]>,
    /// The control curves that lie in this surface, on its boundary or inside it.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curves: Vec<Embedding>,
}

/// A vertex of a skeleton.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SkeletonVertex {
    /// A control point that the surface must pass through.
    Control(PointId),
    /// A vertex that only the topology needs; its position is a hint where to start from.
    Free(DVec3),
}

/// A control curve in a surface: the surface follows it (shadowing, thesis section 7.3.3).
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Embedding {
    /// The curve that is followed.
    pub curve: CurveId,
    /// Where it runs in the skeleton, vertex by vertex along edges, in the curve's own sense.
    pub along: Vec<u32>,
}

impl Region {
    /// Whether nothing is said of it: then it is not kept.
    #[must_use]
    pub fn is_idle(&self) -> bool {
        self.objective.is_none() && self.spacing.is_none() && self.shadow.is_none()
    }
}

impl Curve {
    /// A curve through these points, without choices of its own.
    #[must_use]
    pub fn new(through: Vec<PointId>, closed: bool) -> Self {
        Self { through, closed, objective: None, tangents: BTreeMap::new(), rim: None }
    }
}

impl Surface {
    /// A surface with this skeleton, without choices of its own.
    #[must_use]
    pub fn new(skeleton: Skeleton) -> Self {
        Self {
            skeleton,
            spacing: None,
            density: None,
            objective: None,
            regions: Vec::new(),
            normals: BTreeMap::new(),
            ribbons: BTreeMap::new(),
        }
    }
}

impl Document {
    /// What a curve minimises.
    #[must_use]
    pub fn objective_of_curve(&self, curve: CurveId) -> Objective {
        self.curves.get(&curve).and_then(|curve| curve.objective).unwrap_or(self.objective)
    }

    /// What a surface minimises.
    #[must_use]
    pub fn objective_of_surface(&self, surface: SurfaceId) -> Objective {
        self.surfaces.get(&surface).and_then(|surface| surface.objective).unwrap_or(self.objective)
    }

    /// How edge lengths vary over a surface.
    #[must_use]
    pub fn density_of_surface(&self, surface: SurfaceId) -> Density {
        self.surfaces.get(&surface).and_then(|surface| surface.density).unwrap_or(self.density)
    }

    /// The smallest identity that lies above all points in use; if they reach the end of all identities, the smallest free one.
    #[must_use]
    pub fn next_point(&self) -> PointId {
        let last = self.points.last_key_value().map(|(id, _)| id.0);
        PointId(after(last, |id| self.points.contains_key(&PointId(id))))
    }

    /// As [`Self::next_point`], for curves.
    #[must_use]
    pub fn next_curve(&self) -> CurveId {
        let last = self.curves.last_key_value().map(|(id, _)| id.0);
        CurveId(after(last, |id| self.curves.contains_key(&CurveId(id))))
    }

    /// As [`Self::next_point`], for surfaces.
    #[must_use]
    pub fn next_surface(&self) -> SurfaceId {
        let fair = self.surfaces.last_key_value().map(|(id, _)| id.0);
        let exact =
            [self.cages.keys().next_back(), self.fills.keys().next_back(), self.meshes.keys().next_back()];
        let last = fair.max(exact.into_iter().flatten().map(|id| id.0).max());
        SurfaceId(after(last, |id| self.kind_of(SurfaceId(id)).is_some()))
    }

    /// What kind of surface has this identity, if any.
    #[must_use]
    pub fn kind_of(&self, surface: SurfaceId) -> Option<SurfaceKind> {
        if self.surfaces.contains_key(&surface) {
            Some(SurfaceKind::Fair)
        } else if self.cages.contains_key(&surface) {
            Some(SurfaceKind::Cage)
        } else if self.fills.contains_key(&surface) {
            Some(SurfaceKind::Fill)
        } else {
            self.meshes.contains_key(&surface).then_some(SurfaceKind::Mesh)
        }
    }

    /// The cages that have a point as a vertex, in order of identity.
    pub fn cages_on(&self, point: PointId) -> impl Iterator<Item = SurfaceId> + '_ {
        let has = move |cage: &Cage| cage.faces.iter().flatten().any(|corner| *corner == point);
        self.cages.iter().filter(move |(_, cage)| has(cage)).map(|(id, _)| *id)
    }

    /// The fills that have a stretch of a curve as a side, in order of identity.
    pub fn fills_on(&self, curve: CurveId) -> impl Iterator<Item = SurfaceId> + '_ {
        let has = move |fill: &Fill| fill.sides.iter().any(|side| side.curve == curve);
        self.fills.iter().filter(move |(_, fill)| has(fill)).map(|(id, _)| *id)
    }

    /// The curves that pass through a point, in order of identity.
    pub fn curves_through(&self, point: PointId) -> impl Iterator<Item = CurveId> + '_ {
        self.curves.iter().filter(move |(_, curve)| curve.through.contains(&point)).map(|(id, _)| *id)
    }

    /// The surfaces that follow a curve, in order of identity.
    pub fn surfaces_on(&self, curve: CurveId) -> impl Iterator<Item = SurfaceId> + '_ {
        self.surfaces
            .iter()
            .filter(move |(_, surface)| surface.skeleton.curves.iter().any(|e| e.curve == curve))
            .map(|(id, _)| *id)
    }

    /// The surfaces that pass through a point, in order of identity.
    pub fn surfaces_through(&self, point: PointId) -> impl Iterator<Item = SurfaceId> + '_ {
        self.surfaces
            .iter()
            .filter(move |(_, surface)| surface.skeleton.vertices.contains(&SkeletonVertex::Control(point)))
            .map(|(id, _)| *id)
    }

    /// Half the diagonal of the box around all points, free skeleton vertices, ribbons and fixed meshes, and its centre.
    ///
    /// Zero for an empty document.
    #[must_use]
    pub fn extent(&self) -> (DVec3, f64) {
        let free = self.surfaces.values().flat_map(|s| &s.skeleton.vertices).filter_map(|v| match v {
            SkeletonVertex::Free(at) => Some(at),
            SkeletonVertex::Control(_) => None,
        });
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let ribbons = self.fills.values().flat_map(|fill| &fill.ribbons);
        let rows = ribbons.flat_map(|ribbon| ribbon.row0.iter().chain(&ribbon.row1));
        let fixed = self.meshes.values().flat_map(|mesh| &mesh.vertices);
        for at in self.points.values().chain(free).chain(rows).chain(fixed) {
            low = low.min(*at);
            high = high.max(*at);
        }
        if low.x > high.x {
            return (DVec3::ZERO, 0.0);
        }
        ((low + high) * 0.5, (high - low).length() * 0.5)
    }
}

/// The number above the last one in use, or, if there is none, the smallest above zero that is not taken.
fn after(last: Option<u32>, is_taken: impl Fn(u32) -> bool) -> u32 {
    let free = || (1..u32::MAX).find(|id| !is_taken(*id)).unwrap_or(u32::MAX);
    last.map_or(1, |last| last.checked_add(1).unwrap_or_else(free))
}
