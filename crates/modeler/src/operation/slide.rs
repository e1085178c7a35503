//! Sliding: a vertex goes to another place of its own surface, as long as the triangles around it bear it.

use crate::shape::SurfaceShape;
use ductile_mesh::measure::{corner_angle, face_normal};
use ductile_mesh::{FaceId, Mesh, VertexId};
use glam::DVec3;

/// Corners sharper than this make a needle, whose fit is filtered: the mesh improvement's own limit (15°).
pub(crate) const SHARP: f64 = core::f64::consts::PI / 12.0;
/// A triangle whose normal turns by more than this (its cosine, 60°) has turned over, or is about to.
const TURNED: f64 = 0.5;

/// Moves a vertex if no triangle around it turns over or becomes a needle. A corner that was sharp before may
/// stay so, but no sharper. Returns whether it was moved; if not, nothing has changed.
pub(crate) fn slide(shape: &mut SurfaceShape, vertex: VertexId, to: DVec3) -> bool {
    let mut ring = Vec::new();
    shape.mesh.ring_faces(vertex, &mut ring);
    let before: Vec<_> = ring
        .iter()
        .map(|f| {
            (face_normal(&shape.mesh, &shape.positions, *f), least_angle(&shape.mesh, &shape.positions, *f))
        })
        .collect();
    let from = core::mem::replace(&mut shape.positions[vertex.index()], to);
    let is_sound = ring.iter().zip(&before).all(|(face, (normal, angle))| {
        let now = face_normal(&shape.mesh, &shape.positions, *face);
        // Written so that what is not a number is refused.
        now.dot(*normal) >= TURNED * now.length() * normal.length()
            && least_angle(&shape.mesh, &shape.positions, *face) >= SHARP.min(*angle)
    });
    if !is_sound {
        shape.positions[vertex.index()] = from;
    }
    is_sound
}

/// The sharpest corner of the triangles around a vertex.
pub(crate) fn least_angle_around(shape: &SurfaceShape, vertex: VertexId) -> f64 {
    let mut ring = Vec::new();
    shape.mesh.ring_faces(vertex, &mut ring);
    let angles = ring.iter().map(|face| least_angle(&shape.mesh, &shape.positions, *face));
    angles.fold(f64::INFINITY, f64::min)
}

/// The sharpest corner of a triangle.
fn least_angle(mesh: &Mesh, positions: &[DVec3], face: FaceId) -> f64 {
    face.halfedges().map(|h| corner_angle(mesh, positions, h)).into_iter().fold(f64::INFINITY, f64::min)
}
