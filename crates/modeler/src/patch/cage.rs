//! A surface over a cage whose vertices are control points of the document.

use crate::error::ModelError;
use ductile_patch::cage::{Cage, CageSurface, Settings, Split, Tessellation};
use ductile_spec::{Document, PointId, SurfaceId};
use glam::DVec3;
use std::collections::BTreeSet;

/// Steps along every edge of a quad of the split cage.
const RESOLUTION: usize = 8;

/// The tessellation of a surface over a cage.
#[derive(Clone, Debug)]
pub struct CageShape {
    /// The control points that are its vertices, in order of identity.
    points: Vec<PointId>,
    places: Vec<DVec3>,
    edges: Vec<[u32; 2]>,
    surface: CageSurface,
    tessellation: Tessellation,
    /// Names this connectivity.
    pub revision: u64,
}

impl CageShape {
    /// The surface over a cage of a document.
    ///
    /// # Errors
    /// [`ModelError::NoPoint`] for a corner that is none, [`ModelError::Cage`] for what is no surface.
    pub(crate) fn new(
        id: SurfaceId,
        cage: &ductile_spec::Cage,
        document: &Document,
        revision: u64,
    ) -> Result<Self, ModelError> {
        let points: Vec<PointId> = cage.points().into_iter().collect();
        let place = |point: &PointId| document.points.get(point).copied().ok_or(ModelError::NoPoint(*point));
        let places = points.iter().map(place).collect::<Result<Vec<DVec3>, _>>()?;
        let index = |point: &PointId| {
            let found = points.binary_search(point).map_err(|_| ModelError::NoPoint(*point))?;
            Ok(u32::try_from(found).unwrap_or(u32::MAX))
        };
        let corners = |face: &Vec<PointId>| face.iter().map(index).collect::<Result<Vec<u32>, ModelError>>();
        let faces = cage.faces.iter().map(corners).collect::<Result<Vec<_>, _>>()?;
        let edges = edges(&faces);
        let refuse = |reason| ModelError::Cage { surface: id, reason };
        let cage = Cage::new(places.clone(), faces).map_err(refuse)?;
        let settings = Settings { split: Split::Offset, ..Settings::default() };
        let surface = CageSurface::new(&cage, settings).map_err(refuse)?;
        let tessellation = Tessellation::new(&surface, RESOLUTION).map_err(refuse)?;
        Ok(Self { points, places, edges, surface, tessellation, revision })
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
            self.tessellation.update(self.surface.positions(), &moved);
            self.places = places;
        }
    }
}

/// The edges of faces, each once.
fn edges(faces: &[Vec<u32>]) -> Vec<[u32; 2]> {
    let of_face = |face: &Vec<u32>| {
        let next = face.iter().cycle().skip(1);
        face.iter().zip(next).map(|(a, b)| [*a.min(b), *a.max(b)]).collect::<Vec<_>>()
    };
    faces.iter().flat_map(of_face).collect::<BTreeSet<_>>().into_iter().collect()
}
