//! A surface over a cage whose vertices are control points of the document.

use super::polygons::Polygons;
use crate::error::ModelError;
use ductile_patch::cage::{Blend, Boundary, CageSurface, Map, Settings, Split, Tessellation};
use ductile_spec::{CageBlend, CageBoundary, CageMap, CageSplit, Document, PointId, SurfaceId};
use glam::DVec3;

/// The tessellation of a surface over a cage.
#[derive(Clone, Debug)]
pub struct CageShape {
    /// The control points that are its vertices, in order of identity.
    points: Vec<PointId>,
    places: Vec<DVec3>,
    edges: Vec<[u32; 2]>,
    pub(super) surface: CageSurface,
    tessellation: Tessellation,
    /// Vertices that were evaluated when it last followed its cage.
    evaluated: usize,
    /// Names this connectivity.
    pub revision: u64,
}

impl CageShape {
    /// The surface over a cage of a document.
    ///
    /// # Errors
    /// [`ModelError::NoPoint`] for a corner that is none, [`ModelError::Cage`] for what is no surface, or cannot be made as it
    /// should be.
    pub(crate) fn new(
        id: SurfaceId,
        cage: &ductile_spec::Cage,
        document: &Document,
        revision: u64,
    ) -> Result<Self, ModelError> {
        let (polygons, surface) = exact(id, cage, document)?;
        let resolution = cage.resolution() as usize;
        let tessellation = Tessellation::new(&surface, resolution).map_err(|e| polygons.refused(e))?;
        let edge = |ends: [PointId; 2]| -> Result<[u32; 2], ModelError> {
            Ok([polygons.index(ends[0])?, polygons.index(ends[1])?])
        };
        let edges = cage.edges().into_iter().map(edge).collect::<Result<_, _>>()?;
        let (places, evaluated) = (polygons.cage.positions().to_vec(), tessellation.positions().len());
        Ok(Self { points: polygons.points, places, edges, surface, tessellation, evaluated, revision })
    }

    /// Vertices that were evaluated when it last followed its cage: those that the moved ones enter.
    #[must_use]
    pub fn evaluated(&self) -> usize {
        self.evaluated
    }

    /// Rough size in memory of what it does not share with its clones, in bytes.
    pub(super) fn bytes(&self) -> usize {
        let (_, own) = self.tessellation.bytes();
        own + 24 * self.surface.positions().len() + 40 * self.points.len()
    }

    pub(super) fn positions(&self) -> &[DVec3] {
        self.tessellation.positions()
    }

    pub(super) fn normals(&self) -> &[DVec3] {
        self.tessellation.normals()
    }

    pub(super) fn triangles(&self) -> &[[u32; 3]] {
        self.tessellation.triangles()
    }

    pub(super) fn net(&self) -> super::NetLines<'_> {
        (&self.places, &self.edges)
    }

    /// Whether a vertex of the cage is not where the document has it.
    pub(super) fn is_behind(&self, document: &Document) -> bool {
        self.points.iter().zip(&self.places).any(|(point, at)| document.points.get(point) != Some(at))
    }

    /// Follows the vertices of the cage; only what they enter is evaluated again.
    pub(super) fn follow(&mut self, document: &Document) {
        let place = |point: &PointId| document.points.get(point).copied();
        let Some(places) = self.points.iter().map(place).collect::<Option<Vec<DVec3>>>() else { return };
        if let Ok(moved) = self.surface.move_to(&places) {
            self.evaluated = self.tessellation.update(self.surface.positions(), &moved);
            self.places = places;
        }
    }
}

/// The surface over a cage of a document, with the cage.
///
/// # Errors
/// As [`CageShape::new`].
pub(super) fn exact(
    id: SurfaceId,
    cage: &ductile_spec::Cage,
    document: &Document,
) -> Result<(Polygons, CageSurface), ModelError> {
    let polygons = Polygons::of(id, cage, document)?;
    let surface = CageSurface::new(&polygons.cage, settings(cage)).map_err(|e| polygons.refused(e))?;
    Ok((polygons, surface))
}

/// What a document says of a cage, in the words of the mathematics.
fn settings(cage: &ductile_spec::Cage) -> Settings {
    let said = &cage.settings;
    Settings {
        split: match cage.split() {
            CageSplit::None => Split::None,
            CageSplit::Linear => Split::Linear,
            CageSplit::Offset => Split::Offset,
            CageSplit::CatmullClark => Split::CatmullClark,
        },
        map: match said.map {
            CageMap::Smooth => Map::Smooth,
            CageMap::Rational => Map::Rational,
        },
        blend: match said.blend {
            CageBlend::Hermite(order) => Blend::Hermite(order),
            CageBlend::Bump(exponent) => Blend::Bump(exponent),
            CageBlend::Erbs => Blend::Erbs,
        },
        boundary: match said.boundary {
            CageBoundary::Linear => Boundary::Linear,
            CageBoundary::Borrow => Boundary::Borrow,
        },
    }
}

#[cfg(test)]
mod tests;
