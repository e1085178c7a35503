//! `split-edge`: a new vertex on an edge of a cage, joined to the far corner of each face there: inside a cage at least three
//! faces must meet at a vertex.

use crate::error::ModelError;
use crate::model::Model;
use crate::patch::change;
use ductile_patch::cage::edit;
use ductile_spec::{PointId, SurfaceId};

/// Splits an edge, a share `at` of the way from the first end to the second.
pub(crate) fn split_edge(
    model: &mut Model,
    surface: SurfaceId,
    ends: [PointId; 2],
    at: f64,
) -> Result<(), ModelError> {
    change(model, surface, "Split edge", |polygons| {
        let [from, to] = [polygons.index(ends[0])?, polygons.index(ends[1])?];
        Ok(edit::split_edge_and_faces(&polygons.cage, from, to, at))
    })
}
