//! What a document must satisfy before anything is built from it: every reference is kept, every number
//! is in range, every size is within its limit. Whether a skeleton is a manifold is for the mesh to say.

use crate::document::{Curve, Document, MAX_COORDINATE, SkeletonVertex, Surface};
use crate::frame::SurfaceKind;
use crate::id::{CurveId, PointId, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use thiserror::Error;

mod displacement;
mod exact;
mod mesh;
mod rim;
mod shadow;

/// Limits that keep hostile input from exhausting memory; each is far above what a designer makes.
const MAX_POINTS: usize = 20_000;
const MAX_CURVES: usize = 5_000;
const MAX_SURFACES: usize = 500;
const MAX_TRIANGLES: usize = 100_000;
/// Vertices of the tessellations of all surfaces over cages.
const MAX_SAMPLES: usize = 400_000;
const MAX_NAME: usize = 200;
/// Largest coordinate that a direction must have at least: below it the page shows zeros.
const LEAST_DIRECTION: f64 = 1e-9;

/// Why a document cannot be built.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Defect {
    /// There are more things of a kind than a document may hold.
    #[error("too many {what}: {count}, the limit is {limit}")]
    TooMany {
        /// Which kind.
        what: &'static str,
        /// How many there are.
        count: usize,
        /// How many there may be.
        limit: usize,
    },
    /// The name is too long.
    #[error("the name has {0} characters, the limit is {MAX_NAME}")]
    LongName(usize),
    /// A coordinate is not a number or out of range.
    #[error("{place}: a coordinate is {value}; it must be a number between -1e6 and 1e6")]
    Coordinate {
        /// Where it stands.
        place: String,
        /// The offending value.
        value: f64,
    },
    /// A spacing is not a positive number.
    #[error("{place}: the spacing is {value}; it must be a positive number up to 1e6")]
    Spacing {
        /// Where it stands.
        place: String,
        /// The offending value.
        value: f64,
    },
    /// A curve has too few points.
    #[error("{curve} passes through {count} points; it needs at least {needed}")]
    ShortCurve {
        /// Which curve.
        curve: CurveId,
        /// How many points it has.
        count: usize,
        /// How many it needs.
        needed: usize,
    },
    /// A curve passes through a point that does not exist.
    #[error("{curve} passes through {point}, which does not exist")]
    CurveWithoutPoint {
        /// Which curve.
        curve: CurveId,
        /// The missing point.
        point: PointId,
    },
    /// A curve passes through a point twice.
    #[error("{curve} passes through {point} more than once")]
    CurveMeetsItself {
        /// Which curve.
        curve: CurveId,
        /// The repeated point.
        point: PointId,
    },
    /// A tangent is prescribed where the curve does not pass, or is no direction.
    #[error("{curve}, tangent at {point}: {why}")]
    Tangent {
        /// Which curve.
        curve: CurveId,
        /// Where it is prescribed.
        point: PointId,
        /// What is wrong.
        why: &'static str,
    },
    /// A curve is no rim of the surface over a cage that it is said to be one of.
    #[error("{curve} is no rim of {surface}: {why}")]
    Rim {
        /// Which curve.
        curve: CurveId,
        /// The surface that should lead it.
        surface: SurfaceId,
        /// What is wrong.
        why: &'static str,
    },
    /// A surface names a point that does not exist, or names it twice.
    #[error("{surface}, vertex {vertex}: {point} {why}")]
    SurfacePoint {
        /// Which surface.
        surface: SurfaceId,
        /// Index of the vertex.
        vertex: usize,
        /// The point in question.
        point: PointId,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A triangle refers to a vertex that does not exist or repeats one.
    #[error("{surface}, triangle {triangle}: corner {corner} {why}")]
    Triangle {
        /// Which surface.
        surface: SurfaceId,
        /// Index of the triangle.
        triangle: usize,
        /// The offending vertex index.
        corner: u32,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A surface has no triangle.
    #[error("{0} has no triangles")]
    EmptySurface(SurfaceId),
    /// Two surfaces of different kinds have one identity.
    #[error("{0} is defined twice, as surfaces of two kinds")]
    TwoKinds(SurfaceId),
    /// A displacement has no surface.
    #[error("{0} has displacements and does not exist")]
    NothingToDisplace(SurfaceId),
    /// A displacement of a surface cannot be as it is said to be.
    #[error("{surface}, displacement {number}: {why}")]
    Displacement {
        /// Which surface.
        surface: SurfaceId,
        /// Which displacement, from 1.
        number: usize,
        /// What is wrong.
        why: &'static str,
    },
    /// What the displacements of a surface have in common cannot be so.
    #[error("{surface}, its displacements: {why}")]
    Blending {
        /// Which surface.
        surface: SurfaceId,
        /// What is wrong.
        why: &'static str,
    },
    /// A displacement has a curve as its foot, or is pinned to one, that does not lie in the surface.
    #[error("{surface}: its displacements hang on {curve}, which does not lie in it")]
    DisplacedCurve {
        /// Which surface.
        surface: SurfaceId,
        /// Which curve.
        curve: CurveId,
    },
    /// A face of a cage names a point that does not exist, or names it twice.
    #[error("{surface}, face {face}: {point} {why}")]
    CageFace {
        /// Which cage.
        surface: SurfaceId,
        /// Index of the face.
        face: usize,
        /// The point in question.
        point: PointId,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A face of a cage has too few corners.
    #[error("{surface}, face {face} has {corners} corners; it needs at least 3")]
    SmallFace {
        /// Which cage.
        surface: SurfaceId,
        /// Index of the face.
        face: usize,
        /// How many corners it has.
        corners: usize,
    },
    /// A vertex of a fixed mesh is a corner of no triangle.
    #[error("{surface}: no triangle has vertex {vertex}")]
    UnusedVertex {
        /// Which mesh.
        surface: SurfaceId,
        /// Index of the vertex.
        vertex: usize,
    },
    /// A setting of a cage is out of range.
    #[error("{surface}, {what}: {value}; it lies between 1 and {most}")]
    CageSetting {
        /// Which cage.
        surface: SurfaceId,
        /// Which setting.
        what: &'static str,
        /// Its value.
        value: u32,
        /// The largest that it may have.
        most: u32,
    },
    /// A fill has too few sides.
    #[error("{surface} has {sides} sides; a fill needs at least 3")]
    FewSides {
        /// Which fill.
        surface: SurfaceId,
        /// How many sides it has.
        sides: usize,
    },
    /// A fill cannot be as it is said to be.
    #[error("{surface}: {why}")]
    Fill {
        /// Which fill.
        surface: SurfaceId,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A ribbon has rows of a wrong length.
    #[error("{surface}, ribbon {side}: its rows must have from 2 to 16 points, both as many")]
    FillRibbon {
        /// Which fill.
        surface: SurfaceId,
        /// Index of the ribbon.
        side: usize,
    },
    /// A side of a fill is no stretch of its curve.
    #[error("{surface}, side {side}: {curve} {why}")]
    FillSide {
        /// Which fill.
        surface: SurfaceId,
        /// Index of the side.
        side: usize,
        /// The curve.
        curve: CurveId,
        /// What is wrong with it.
        why: &'static str,
    },
    /// A region of a surface is not where it is said to be.
    #[error("{surface}: the region beside {curve} from {point}: {why}")]
    Region {
        /// Which surface.
        surface: SurfaceId,
        /// The curve at its border.
        curve: CurveId,
        /// Where its stretch begins.
        point: PointId,
        /// What is wrong.
        why: &'static str,
    },
    /// A normal is prescribed where the surface has no control point, or is no direction.
    #[error("{surface}, normal at {point}: {why}")]
    Normal {
        /// Which surface.
        surface: SurfaceId,
        /// Where it is prescribed.
        point: PointId,
        /// What is wrong.
        why: &'static str,
    },
    /// A ribbon lies along a curve that is not in the surface, or says nothing.
    #[error("{surface}, ribbon along {curve}: {why}")]
    Ribbon {
        /// Which surface.
        surface: SurfaceId,
        /// Along which curve.
        curve: CurveId,
        /// What is wrong.
        why: &'static str,
    },
    /// A ribbon has a direction where its curve does not pass, or one that is none.
    #[error("{surface}, ribbon along {curve}, at {point}: {why}")]
    Cross {
        /// Which surface.
        surface: SurfaceId,
        /// Along which curve.
        curve: CurveId,
        /// At which point.
        point: PointId,
        /// What is wrong.
        why: &'static str,
    },
    /// A curve cannot lie in a surface as stated.
    #[error("{surface}: {curve} {why}")]
    Embedding {
        /// Which surface.
        surface: SurfaceId,
        /// Which curve.
        curve: CurveId,
        /// What is wrong.
        why: String,
    },
}

impl Document {
    /// Checks everything that can be checked without building the model.
    ///
    /// # Errors
    /// The first [`Defect`] found, in the order of the document.
    pub fn validate(&self) -> Result<(), Defect> {
        limit("points", self.points.len(), MAX_POINTS)?;
        limit("curves", self.curves.len(), MAX_CURVES)?;
        limit("surfaces", self.surfaces.len(), MAX_SURFACES)?;
        let triangles = self.surfaces.values().map(|s| s.skeleton.triangles.len()).sum();
        limit("triangles", triangles, MAX_TRIANGLES)?;
        let vertices = self.surfaces.values().map(|s| s.skeleton.vertices.len()).sum();
        limit("skeleton vertices", vertices, MAX_TRIANGLES)?;
        let name = self.name.chars().count();
        if name > MAX_NAME {
            return Err(Defect::LongName(name));
        }
        spacing("document", self.spacing)?;
        for (id, at) in &self.points {
            coordinate(&id.to_string(), *at)?;
        }
        for (id, curve) in &self.curves {
            validate_curve(*id, curve, &self.points)?;
        }
        for (id, surface) in &self.surfaces {
            validate_surface(*id, surface, self)?;
        }
        self.validate_exact()?;
        self.validate_rims()?;
        self.validate_meshes()?;
        self.validate_displacements()
    }
}

fn limit(what: &'static str, count: usize, limit: usize) -> Result<(), Defect> {
    if count > limit { Err(Defect::TooMany { what, count, limit }) } else { Ok(()) }
}

fn spacing(place: &str, value: Option<f64>) -> Result<(), Defect> {
    match value {
        Some(value) if !(value.is_finite() && value > 0.0 && value <= MAX_COORDINATE) => {
            Err(Defect::Spacing { place: place.to_owned(), value })
        }
        _ => Ok(()),
    }
}

fn coordinate(place: &str, at: DVec3) -> Result<(), Defect> {
    match at.to_array().into_iter().find(|x| !(x.is_finite() && x.abs() <= MAX_COORDINATE)) {
        Some(value) => Err(Defect::Coordinate { place: place.to_owned(), value }),
        None => Ok(()),
    }
}

fn validate_curve(id: CurveId, curve: &Curve, points: &BTreeMap<PointId, DVec3>) -> Result<(), Defect> {
    let needed = if curve.closed { 3 } else { 2 };
    if curve.through.len() < needed {
        return Err(Defect::ShortCurve { curve: id, count: curve.through.len(), needed });
    }
    let mut seen = BTreeSet::new();
    for point in &curve.through {
        if !points.contains_key(point) {
            return Err(Defect::CurveWithoutPoint { curve: id, point: *point });
        }
        if !seen.insert(*point) {
            return Err(Defect::CurveMeetsItself { curve: id, point: *point });
        }
    }
    for (point, direction) in &curve.tangents {
        let refuse = |why| Err(Defect::Tangent { curve: id, point: *point, why });
        if !seen.contains(point) {
            return refuse("the curve does not pass through this point");
        }
        if let Some(why) = no_direction(*direction) {
            return refuse(why);
        }
    }
    Ok(())
}

/// Why a vector is no direction.
fn no_direction(direction: DVec3) -> Option<&'static str> {
    if !direction.to_array().iter().all(|x| x.is_finite() && x.abs() <= MAX_COORDINATE) {
        return Some("its coordinates must be numbers between -1e6 and 1e6");
    }
    let is_none = direction.abs().max_element() < LEAST_DIRECTION;
    is_none.then_some("it has no direction: one coordinate must differ from zero")
}

fn validate_surface(id: SurfaceId, surface: &Surface, document: &Document) -> Result<(), Defect> {
    spacing(&id.to_string(), surface.spacing)?;
    let skeleton = &surface.skeleton;
    let on_curves: BTreeSet<u32> = skeleton.curves.iter().flat_map(|e| e.along.iter().copied()).collect();
    let mut seen = BTreeMap::new();
    for (index, vertex) in skeleton.vertices.iter().enumerate() {
        match vertex {
            SkeletonVertex::Free(at) => coordinate(&format!("{id}, vertex {index}"), *at)?,
            SkeletonVertex::Control(point) => {
                let refuse = |why| Defect::SurfacePoint { surface: id, vertex: index, point: *point, why };
                if !document.points.contains_key(point) {
                    return Err(refuse("does not exist"));
                }
                // A curve on two rims of a surface has its points on both.
                let is_on_curve =
                    |index: usize| on_curves.contains(&u32::try_from(index).unwrap_or(u32::MAX));
                if let Some(other) = seen.insert(*point, index)
                    && !(is_on_curve(index) && is_on_curve(other))
                {
                    return Err(refuse("is already another vertex"));
                }
            }
        }
    }
    if skeleton.triangles.is_empty() {
        return Err(Defect::EmptySurface(id));
    }
    for (index, corners) in skeleton.triangles.iter().enumerate() {
        let refuse = |corner, why| Defect::Triangle { surface: id, triangle: index, corner, why };
        if let Some(corner) = corners.iter().find(|c| **c as usize >= skeleton.vertices.len()) {
            return Err(refuse(*corner, "does not exist"));
        }
        if corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0] {
            return Err(refuse(corners[0], "or another one is repeated"));
        }
    }
    validate_embeddings(id, surface, document)?;
    validate_regions(id, surface, document)?;
    validate_planes(id, surface, document)
}

fn validate_planes(id: SurfaceId, surface: &Surface, document: &Document) -> Result<(), Defect> {
    let controls: BTreeSet<PointId> = surface
        .skeleton
        .vertices
        .iter()
        .filter_map(|vertex| match vertex {
            SkeletonVertex::Control(point) => Some(*point),
            SkeletonVertex::Free(_) => None,
        })
        .collect();
    for (point, normal) in &surface.normals {
        let refuse = |why| Err(Defect::Normal { surface: id, point: *point, why });
        if !controls.contains(point) {
            return refuse("the surface does not pass through this point");
        }
        if let Some(why) = no_direction(*normal) {
            return refuse(why);
        }
    }
    for (along, ribbon) in &surface.ribbons {
        let refuse = |why| Err(Defect::Ribbon { surface: id, curve: *along, why });
        let is_embedded = surface.skeleton.curves.iter().any(|embedding| embedding.curve == *along);
        let Some(curve) = document.curves.get(along).filter(|_| is_embedded) else {
            return refuse("the curve does not lie in the surface");
        };
        match ribbon.onto {
            Some(_) if !ribbon.cross.is_empty() => {
                return refuse("it has directions and another surface to go on from: only one can be met");
            }
            Some(other) if matches!(document.kind_of(other), Some(SurfaceKind::Fair) | None) => {
                return refuse("what it goes on from is no surface over a cage, no fill and no mesh");
            }
            Some(other) if takes_planes(document, other, *along, id) => {
                return refuse("what it goes on from goes on from it: one of the two must lead");
            }
            None if ribbon.cross.is_empty() => return refuse("it has no direction anywhere"),
            _ => {}
        }
        for (point, direction) in &ribbon.cross {
            let refuse = |why| Err(Defect::Cross { surface: id, curve: *along, point: *point, why });
            if !curve.through.contains(point) {
                return refuse("the curve does not pass through this point");
            }
            if let Some(why) = no_direction(*direction) {
                return refuse(why);
            }
        }
    }
    Ok(())
}

/// Whether a fill takes its tangent planes along a curve from a surface.
fn takes_planes(document: &Document, fill: SurfaceId, curve: CurveId, from: SurfaceId) -> bool {
    let sides = document.fills.get(&fill).map_or(&[][..], |fill| &fill.sides);
    sides.iter().any(|side| side.curve == curve && side.planes == Some(from))
}

fn validate_regions(id: SurfaceId, surface: &Surface, document: &Document) -> Result<(), Defect> {
    let mut seen = BTreeSet::new();
    for region in &surface.regions {
        let refuse = |why| Err(Defect::Region { surface: id, curve: region.curve, point: region.from, why });
        let curve = document.curves.get(&region.curve);
        let Some(curve) = curve.filter(|_| surface.skeleton.curves.iter().any(|e| e.curve == region.curve))
        else {
            return refuse("the curve does not lie in the surface");
        };
        let starts = if curve.closed { curve.through.len() } else { curve.through.len() - 1 };
        if !curve.through[..starts].contains(&region.from) {
            return refuse("no stretch of the curve begins at that point");
        }
        spacing(&format!("{id}, region beside {} from {}", region.curve, region.from), region.spacing)?;
        if region.is_idle() {
            return refuse("nothing is said of it: neither an objective, nor a spacing, nor a shadow");
        }
        if let Some(why) = region.shadow.and_then(|shadow| document.fault_of_shadow(id, shadow)) {
            return refuse(why);
        }
        if !seen.insert((region.curve, region.from, region.side)) {
            return refuse("it is spoken of twice");
        }
    }
    Ok(())
}

fn validate_embeddings(id: SurfaceId, surface: &Surface, document: &Document) -> Result<(), Defect> {
    let skeleton = &surface.skeleton;
    let edges: BTreeSet<[u32; 2]> = skeleton
        .triangles
        .iter()
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
        .map(sorted)
        .collect();
    let mut taken = BTreeSet::new();
    for embedding in &skeleton.curves {
        let refuse = |why: String| Defect::Embedding { surface: id, curve: embedding.curve, why };
        let Some(curve) = document.curves.get(&embedding.curve) else {
            return Err(refuse("does not exist".into()));
        };
        let along = &embedding.along;
        if let Some(vertex) = along.iter().find(|v| **v as usize >= skeleton.vertices.len()) {
            return Err(refuse(format!("runs through vertex {vertex}, which does not exist")));
        }
        if along.iter().collect::<BTreeSet<_>>().len() != along.len() {
            return Err(refuse("runs through a vertex twice".into()));
        }
        let controls: Vec<PointId> = along
            .iter()
            .filter_map(|v| match skeleton.vertices[*v as usize] {
                SkeletonVertex::Control(point) => Some(point),
                SkeletonVertex::Free(_) => None,
            })
            .collect();
        if controls != curve.through
            || along.first().map(|v| skeleton.vertices[*v as usize])
                != Some(SkeletonVertex::Control(curve.through[0]))
        {
            return Err(refuse("does not run through its own points in its own order".into()));
        }
        if !curve.closed
            && !matches!(
                along.last().map(|v| skeleton.vertices[*v as usize]),
                Some(SkeletonVertex::Control(_))
            )
        {
            return Err(refuse("does not end at its last point".into()));
        }
        let closing = curve.closed.then(|| [along[along.len() - 1], along[0]]);
        for pair in along.windows(2).map(|w| [w[0], w[1]]).chain(closing) {
            if !edges.contains(&sorted(pair)) {
                return Err(refuse(format!("has no edge from vertex {} to vertex {}", pair[0], pair[1])));
            }
            if !taken.insert(sorted(pair)) {
                return Err(refuse(format!("shares the edge from vertex {} to vertex {}", pair[0], pair[1])));
            }
        }
    }
    Ok(())
}

fn sorted(pair: [u32; 2]) -> [u32; 2] {
    [pair[0].min(pair[1]), pair[0].max(pair[1])]
}
