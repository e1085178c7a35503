//! Shadows: regions that take on the relief of another surface (thesis section 7.3.3; the mathematics is `ductile-patch`'s).
//!
//! A shadow lies over what is shown of its surface otherwise, as displacements lie over the base. Correspondence and relief
//! are reckoned from the shapes at rest, or when triangles change; while anything moves, the relief is that of the stamp as it
//! is shown at the moment, raised in the frames of the surface as it is at the moment.

use super::Displacer;
use super::base::Base;
use super::footing::Spot;
use super::normal;
use super::view::View;
use crate::error::{ModelError, ShadowError};
use crate::model::Model;
use crate::relax::Relaxer;
use ductile_patch::relief::{Disc, Ground, Impression, Stamp};
use ductile_spec::{Document, FailedShadow, PointId, Region, Shadow, SkeletonVertex, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// A surface with regions that shadow others.
#[derive(Clone, Debug)]
pub(super) struct Shadowed {
    asked: Vec<Region>,
    revision: [u64; 2],
    reckoned_on: Vec<DVec3>,
    /// One for each region that shadows, in order.
    parts: Vec<Result<Part, ShadowError>>,
    below: Vec<DVec3>,
    triangles: Vec<[u32; 3]>,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
}

/// A region that shadows.
#[derive(Clone, Debug)]
struct Part {
    shadow: Shadow,
    ground: Ground,
    source: Source,
}

/// A stamp, and the shape from which its relief was taken.
#[derive(Clone, Debug)]
struct Source {
    revision: [u64; 2],
    positions: Vec<DVec3>,
    stamp: Stamp,
    impression: Impression,
}

impl Displacer {
    /// Brings all shadows up to the model, those of stamps first.
    pub(super) fn refresh_shadows(&mut self, model: &Model, relaxer: &Relaxer, is_at_rest: bool) {
        let mut kept = std::mem::take(&mut self.shadowed);
        for id in in_order(&model.document) {
            let old = kept.remove(&id);
            let Some(base) = Base::of(model, relaxer, id) else { continue };
            let below = self.below_shadows(&base, id);
            let stamp = |of| self.view(model, relaxer, of).map(|view| (view, anchor(&model.document, of)));
            let asked = shadows(&model.document, id);
            let shadowed = Shadowed::brought(old, asked, &base, below, is_at_rest, &stamp);
            self.shadowed.insert(id, shadowed);
        }
    }

    /// Why a region of a surface cannot shadow what the document says, or the turn with which the stamp would lie there as it
    /// stands in space.
    ///
    /// # Errors
    /// The reason.
    pub(crate) fn natural_turn(
        &mut self,
        (model, relaxer): (&Model, &Relaxer),
        id: SurfaceId,
        region: &Region,
    ) -> Result<f64, ModelError> {
        self.refresh(model, relaxer, false);
        let Some(shadow) = region.shadow else { return Ok(0.0) };
        let refuse = |reason| ModelError::Shadow { surface: id, of: shadow.of, reason };
        let shadowed = self.shadowed.get(&id).ok_or(ModelError::NoSurface(id))?;
        let index = shadowed.asked.iter().position(|other| other == region);
        let part = index.and_then(|index| shadowed.parts.get(index)).ok_or(refuse(ShadowError::Lost))?;
        let part = part.as_ref().map_err(|reason| refuse(*reason))?;
        let turn = part.ground.natural_turn(&part.source.stamp, &shadowed.below);
        turn.map_err(|reason| refuse(ShadowError::Region(reason)))
    }

    /// The shadows that do not show, and why not.
    pub(crate) fn failed_shadows(&self) -> Vec<FailedShadow> {
        let of_one = |(id, shadowed): (&SurfaceId, &Shadowed)| -> Vec<FailedShadow> {
            let told = shadowed.asked.iter().zip(&shadowed.parts);
            let failed = told.filter_map(|(region, part)| Some((region.shadow?, part.as_ref().err()?)));
            failed.map(|(shadow, why)| FailedShadow { surface: *id, shadow, why: why.to_string() }).collect()
        };
        self.shadowed.iter().flat_map(of_one).collect()
    }

    /// The place below a shadow under a place of what is shown.
    pub(super) fn below_shadow(&self, id: SurfaceId, at: DVec3) -> DVec3 {
        let Some(shadowed) = self.shadowed.get(&id) else { return at };
        let spot = Spot::nearest(&shadowed.positions, &shadowed.triangles, at);
        spot.map_or(at, |spot| at - (spot.of(&shadowed.positions) - spot.of(&shadowed.below)))
    }
}

impl Shadowed {
    /// What is shown now, from what was shown before.
    fn brought<'a>(
        old: Option<Self>,
        asked: Vec<Region>,
        base: &Base<'_>,
        below: View<'_>,
        is_at_rest: bool,
        stamp: &impl Fn(SurfaceId) -> Option<(View<'a>, Option<DVec3>)>,
    ) -> Self {
        let is_outdated = |old: &Self| {
            old.asked != asked
                || old.revision != below.revision
                || is_at_rest && old.reckoned_on != below.positions
        };
        let mut now = match old {
            Some(old) if !is_outdated(&old) => old,
            _ => Self::new(asked, base, below, stamp),
        };
        let mut is_new = now.below != below.positions || now.positions.is_empty();
        for part in now.parts.iter_mut() {
            let asked = match part {
                Ok(part) => part.shadow,
                Err(_) => continue,
            };
            let Some((view, anchor)) = stamp(asked.of) else { continue };
            if let Ok(known) = part
                && (known.source.revision != view.revision || known.source.positions != view.positions)
            {
                is_new = true;
                match Source::new(&known.ground, asked, view, anchor) {
                    Ok(source) => known.source = source,
                    Err(reason) => *part = Err(reason),
                }
            }
        }
        // A stamp that was none may be one now.
        if is_at_rest && now.parts.iter().any(Result::is_err) {
            now.parts = parts(&now.asked, base, below, stamp);
            is_new = true;
        }
        if is_new {
            now.show(below);
        }
        now
    }

    fn new<'a>(
        asked: Vec<Region>,
        base: &Base<'_>,
        below: View<'_>,
        stamp: &impl Fn(SurfaceId) -> Option<(View<'a>, Option<DVec3>)>,
    ) -> Self {
        let parts = parts(&asked, base, below, stamp);
        Self {
            asked,
            revision: below.revision,
            reckoned_on: below.positions.to_vec(),
            parts,
            below: Vec::new(),
            triangles: below.triangles.to_vec(),
            positions: Vec::new(),
            normals: Vec::new(),
        }
    }

    /// Raises the reliefs over the surface as it is now.
    fn show(&mut self, below: View<'_>) {
        let mut offsets = vec![DVec3::ZERO; below.positions.len()];
        for part in self.parts.iter().flatten() {
            let Part { shadow, ground, source } = part;
            let own = ground.offsets(&source.impression, shadow.strength, below.positions, below.normals);
            for (&v, offset) in ground.vertices().iter().zip(own) {
                offsets[v as usize] += offset;
            }
        }
        self.normals = normal::turned(below.positions, below.normals, &offsets, below.triangles);
        self.positions = below.positions.iter().zip(&offsets).map(|(at, offset)| *at + *offset).collect();
        self.below = below.positions.to_vec();
    }

    pub(super) fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    pub(super) fn normals(&self) -> &[DVec3] {
        &self.normals
    }
}

fn parts<'a>(
    asked: &[Region],
    base: &Base<'_>,
    below: View<'_>,
    stamp: &impl Fn(SurfaceId) -> Option<(View<'a>, Option<DVec3>)>,
) -> Vec<Result<Part, ShadowError>> {
    let part = |region: &Region| {
        let shadow = region.shadow.ok_or(ShadowError::Lost)?;
        let (view, anchor) = stamp(shadow.of).ok_or(ShadowError::Lost)?;
        let triangles = base.region(region, below).ok_or(ShadowError::Lost)?;
        let disc = Disc::new(below.positions.len(), &triangles).map_err(ShadowError::Region)?;
        let anchors = base.nodes_of(region.from);
        let start = disc.rim().position(|v| anchors.contains(&v)).ok_or(ShadowError::Lost)?;
        let ground = Ground::new(disc, below.positions, start).map_err(ShadowError::Region)?;
        let source = Source::new(&ground, shadow, view, anchor)?;
        Ok(Part { shadow, ground, source })
    };
    asked.iter().map(part).collect()
}

impl Source {
    fn new(
        ground: &Ground,
        shadow: Shadow,
        view: View<'_>,
        anchor: Option<DVec3>,
    ) -> Result<Self, ShadowError> {
        let disc = Disc::new(view.positions.len(), view.triangles).map_err(ShadowError::Stamp)?;
        let far = |v: u32| {
            let at = view.positions[v as usize];
            anchor.map_or(-at.x, |anchor| at.distance_squared(anchor))
        };
        let mut start = (f64::INFINITY, 0);
        for (k, v) in disc.rim().enumerate() {
            if far(v) < start.0 {
                start = (far(v), k);
            }
        }
        let stamp = Stamp::new(&disc, view.positions, start.1).map_err(ShadowError::Stamp)?;
        let impression = ground.read(&stamp, shadow.turn);
        Ok(Self { revision: view.revision, positions: view.positions.to_vec(), stamp, impression })
    }
}

/// The regions of a surface that shadow another.
fn shadows(document: &Document, id: SurfaceId) -> Vec<Region> {
    let regions = document.surfaces.get(&id).map_or(&[][..], |surface| &surface.regions);
    regions.iter().filter(|region| region.shadow.is_some()).copied().collect()
}

/// The surfaces that shadow others, each after those that it shadows.
fn in_order(document: &Document) -> Vec<SurfaceId> {
    let of: BTreeMap<SurfaceId, Vec<SurfaceId>> = document
        .surfaces
        .keys()
        .map(|id| (*id, shadows(document, *id)))
        .filter(|(_, regions)| !regions.is_empty())
        .map(|(id, regions)| (id, regions.iter().filter_map(|region| Some(region.shadow?.of)).collect()))
        .collect();
    let mut done = Vec::new();
    let mut open: BTreeSet<SurfaceId> = of.keys().copied().collect();
    while let Some(next) = open.iter().find(|id| of[*id].iter().all(|other| !open.contains(other))) {
        let next = *next;
        open.remove(&next);
        done.push(next);
    }
    // Nothing is left open: a valid document has no circles.
    done
}

/// Where the rim of a stamp begins: near the control point of lowest identity at which it ends, if one is known.
fn anchor(document: &Document, id: SurfaceId) -> Option<DVec3> {
    let point = if let Some(surface) = document.surfaces.get(&id) {
        let skeleton = &surface.skeleton;
        rim_corners(skeleton.triangles.iter().map(|corners| &corners[..]))
            .filter_map(|corner| match skeleton.vertices.get(corner as usize) {
                Some(SkeletonVertex::Control(point)) => Some(*point),
                _ => None,
            })
            .min()
    } else if let Some(cage) = document.cages.get(&id) {
        let faces: Vec<Vec<u32>> =
            cage.faces.iter().map(|face| face.iter().map(|point| point.0).collect()).collect();
        rim_corners(faces.iter().map(|face| &face[..])).map(PointId).min()
    } else {
        let fill = document.fills.get(&id)?;
        if let Some(ribbon) = fill.ribbons.first() {
            return ribbon.row0.first().copied();
        }
        fill.sides.iter().map(|side| side.from).min()
    };
    document.points.get(&point?).copied()
}

/// The corners of faces at edges that only one of them has.
fn rim_corners<'a>(faces: impl Iterator<Item = &'a [u32]>) -> impl Iterator<Item = u32> {
    let mut edges: Vec<[u32; 2]> = faces
        .flat_map(|face| {
            let next = |k: usize| face[(k + 1) % face.len()];
            (0..face.len()).map(move |k| [face[k].min(next(k)), face[k].max(next(k))])
        })
        .collect();
    edges.sort_unstable();
    let alone: Vec<u32> =
        edges.chunk_by(|a, b| a == b).filter(|same| same.len() == 1).flat_map(|same| same[0]).collect();
    alone.into_iter()
}
