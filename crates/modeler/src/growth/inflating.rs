//! Skins that lie in one plane though no surface of their kind can: all controls of a closed surface, or of one with a handle, may lie
//! so. Its sheets then lie on one another, and a plane is a saddle of the energy, out of which no descent leads. Such a skin is
//! inflated: each sheet is lifted to the side to which it faces.

use crate::shape::SurfaceShape;
use ductile_mesh::{measure, summary};
use glam::DVec3;

/// Part of the size of a skin up to which what it stands out of a plane is nothing.
const FLAT: f64 = 1e-6;
/// How high a vertex is lifted, as a part of its distance to the nearest vertex that a control holds.
const LIFT: f64 = 0.5;

/// Lifts the sheets of a skin that lies in a plane, if it is of a kind that cannot.
pub(super) fn inflate(shape: &mut SurfaceShape) {
    let kind = summary(&shape.mesh);
    let could_be_flat = kind.is_orientable && kind.genus == 0 && kind.boundaries > 0;
    let Some((at, up)) = plane(shape).filter(|_| !could_be_flat) else { return };
    let size = shape.mesh.vertices().map(|v| shape.positions[v.index()].distance(at)).fold(0.0, f64::max);
    let is_flat =
        shape.mesh.vertices().all(|v| (shape.positions[v.index()] - at).dot(up).abs() <= FLAT * size);
    if !is_flat {
        return;
    }
    let mut sides = vec![0.0; shape.mesh.vertex_slots()];
    for f in shape.mesh.faces() {
        let side = measure::face_normal(&shape.mesh, &shape.positions, f).dot(up);
        shape.mesh.face_vertices(f).iter().for_each(|v| sides[v.index()] += side);
    }
    let mut is_held = vec![false; shape.mesh.vertex_slots()];
    shape.controlled().for_each(|v| is_held[v.index()] = true);
    let held: Vec<DVec3> = shape.controlled().map(|v| shape.positions[v.index()]).collect();
    for v in shape.mesh.vertices().filter(|v| !is_held[v.index()]) {
        let here = shape.positions[v.index()];
        let reach = held.iter().map(|other| other.distance_squared(here)).fold(f64::INFINITY, f64::min);
        if reach.is_finite() && sides[v.index()] != 0.0 {
            shape.positions[v.index()] += up * (LIFT * reach.sqrt() * f64::signum(sides[v.index()]));
        }
    }
}

/// A place on a surface and a unit normal there, of its largest triangle.
fn plane(shape: &SurfaceShape) -> Option<(DVec3, DVec3)> {
    let normal = |f| measure::face_normal(&shape.mesh, &shape.positions, f);
    let larger = |one, other| if normal(other).length() > normal(one).length() { other } else { one };
    let largest = shape.mesh.faces().reduce(larger)?;
    let [corner, ..] = shape.mesh.face_vertices(largest);
    Some((shape.positions[corner.index()], normal(largest).try_normalize()?))
}
