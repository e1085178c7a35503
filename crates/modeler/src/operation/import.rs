//! `import`: the polygons of a file become a cage with a surface over it, or a fixed mesh.

use super::{cage, mesh};
use crate::error::ModelError;
use crate::model::Model;
use ductile_mesh::io::{Polygons, obj, ply};
use ductile_spec::{FixedMesh, ImportAs, ImportFormat};

/// Makes a surface of the polygons of a file; without a word what suits them.
pub(crate) fn import(
    model: &mut Model,
    (format, bytes): (ImportFormat, &[u8]),
    into: Option<ImportAs>,
) -> Result<(), ModelError> {
    let Polygons { positions, faces } = match format {
        ImportFormat::Obj => {
            let text = std::str::from_utf8(bytes).map_err(|_| ModelError::NoText)?;
            obj::read_polygons(text).map_err(ModelError::Obj)?
        }
        ImportFormat::Ply => ply::read_polygons(bytes).map_err(ModelError::Ply)?,
    };
    match into.unwrap_or_else(|| ImportAs::suited(&faces)) {
        ImportAs::Cage => cage::lay(model, &positions, &faces)?,
        ImportAs::Mesh => {
            let fan = |face: &Vec<u32>| -> Vec<[u32; 3]> {
                face.windows(2).skip(1).map(|pair| [face[0], pair[0], pair[1]]).collect()
            };
            let given = FixedMesh { vertices: positions, triangles: faces.iter().flat_map(fan).collect() };
            mesh::add(model, &mesh::compact(given.without_unused()))?;
        }
    }
    model.check_extents()
}
