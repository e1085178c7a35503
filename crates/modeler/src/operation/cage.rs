//! `cage`: a surface over a cage, one that the program makes or one that is given (P. Salvi, *Polyhedral design with blended
//! n-sided interpolants*). Its vertices become control points.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::kept_position;
use ductile_patch::cage::{Cage, CageError, primitive};
use ductile_spec::{CageForm, CageSource, MAX_COORDINATE, PointId};
use glam::DVec3;

/// Radii of the centre circle and of the tube of a torus, as parts of its size.
const RING: f64 = 0.7;
const TUBE: f64 = 0.3;

/// Lays a surface over a cage.
pub(crate) fn cage(model: &mut Model, from: &CageSource) -> Result<(), ModelError> {
    match from {
        CageSource::BuiltIn { form, centre, size } => {
            if !(size.is_finite() && *size > 0.0 && *size <= MAX_COORDINATE) {
                return Err(ModelError::BadSize);
            }
            let cage = built_in(*form, *size).map_err(ModelError::NoCage)?;
            let place = |at: &DVec3| kept_position(model, *centre + *at);
            let places = cage.positions().iter().map(place).collect::<Result<Vec<DVec3>, _>>()?;
            lay(model, &places, cage.faces())
        }
        CageSource::Given { vertices, faces } => lay(model, vertices, faces),
    }
}

/// A cage of that form about the origin. Those that turn about an axis turn about z.
pub(crate) fn built_in(form: CageForm, size: f64) -> Result<Cage, CageError> {
    match form {
        CageForm::Cube => primitive::cube(size),
        CageForm::Tetrahedron => primitive::tetrahedron(size),
        CageForm::Octahedron => primitive::octahedron(size),
        CageForm::Icosahedron => primitive::icosahedron(size),
        CageForm::Dodecahedron => primitive::dodecahedron(size),
        CageForm::Torus => primitive::torus(RING * size, TUBE * size, 6, 4),
        CageForm::Trebol => primitive::trebol(size),
        CageForm::Grid => primitive::grid(size / 2.0, 4, 4),
        CageForm::Disc => primitive::disc(size, 6),
    }
}

/// Takes a cage into the document; vertices that no face uses stay behind.
pub(super) fn lay(model: &mut Model, vertices: &[DVec3], faces: &[Vec<u32>]) -> Result<(), ModelError> {
    // What is wrong is said in the names that were given; afterwards they are those of points.
    Cage::new(vertices.to_vec(), faces.to_vec()).map_err(ModelError::NoCage)?;
    let mut names: Vec<Option<PointId>> = vec![None; vertices.len()];
    faces.iter().flatten().for_each(|&vertex| names[vertex as usize] = Some(PointId(0)));
    let mut next = model.document.next_point();
    let surface = model.document.next_surface();
    let document = model.document_mut();
    for (name, at) in names.iter_mut().zip(vertices).filter(|(name, _)| name.is_some()) {
        document.points.insert(next, *at);
        *name = Some(next);
        next = PointId(next.0.saturating_add(1));
    }
    let corners = |face: &Vec<u32>| face.iter().filter_map(|&vertex| names[vertex as usize]).collect();
    let faces = faces.iter().map(corners).collect();
    document.cages.insert(surface, ductile_spec::Cage::new(faces));
    model.document.validate()?;
    model.build_patch(surface)
}
