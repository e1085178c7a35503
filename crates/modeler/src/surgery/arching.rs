//! Bands between rims that lie beside one another in one plane: a flat band would be folded onto what it joins, and a plane is a
//! saddle of the energy, out of which no descent leads. Such a band begins as an arch, half a turn from the one rim to the other.

use crate::model::Model;
use crate::shape::{SurfaceShape, edit};
use crate::surgery::rims::Rim;
use ductile_mesh::{EdgeId, VertexId, measure};
use ductile_spec::SurfaceId;
use glam::DVec3;

/// Part of the size of two rims up to which what they stand out of a plane is nothing.
const FLAT: f64 = 0.02;
/// Slope of what lies beside a rim from which on it leads away from the plane.
const STEEP: f64 = 0.1;

/// Two rims beside one another in a plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arch {
    /// Unit vector from one rim to the other.
    way: DVec3,
    centre: DVec3,
    /// Unit normal of the plane, on the side of the surface's.
    up: DVec3,
    /// Whether the rims run round opposite ways in the plane, as the ends of an arch do.
    pub(crate) is_opposite: bool,
}

impl Arch {
    /// What to know of an arch between two rims of a surface, if they lie so, and what they bound lies in their plane, too.
    pub(crate) fn between(shape: &SurfaceShape, first: &Rim, second: &Rim) -> Option<Self> {
        let at = |v: &VertexId| shape.positions[v.index()];
        let centre = |rim: &Rim| rim.iter().map(at).sum::<DVec3>() / rim.len().max(1) as f64;
        let (start, end) = (centre(first), centre(second));
        let area = |rim: &Rim, centre: DVec3| -> DVec3 {
            let next = rim.iter().cycle().skip(1);
            rim.iter().zip(next).map(|(v, w)| (at(v) - centre).cross(at(w) - centre)).sum()
        };
        let (one, other) = (area(first, start), area(second, end));
        let normal = one.try_normalize()?;
        let radius =
            |rim: &Rim, centre: DVec3| rim.iter().map(|v| at(v).distance(centre)).fold(0.0, f64::max);
        let size = radius(first, start).max(radius(second, end));
        let is_flat = |v: &VertexId| (at(v) - start).dot(normal).abs() <= FLAT * size;
        let is_beside = start.distance(end) > size;
        if !(is_beside && first.iter().chain(second).all(is_flat)) {
            return None;
        }
        let way = (end - start).reject_from_normalized(normal).try_normalize()?;
        let up = facing(shape, first.iter().chain(second), normal)?;
        Some(Self { way, centre: end, up, is_opposite: one.dot(other) < 0.0 })
    }

    /// Positions in which the second rim has been turned over, so that what is nearest belongs together along the arch.
    pub(crate) fn unfolded(&self, positions: &[DVec3], second: &Rim) -> Vec<DVec3> {
        let mut positions = positions.to_vec();
        for v in second {
            let at = &mut positions[v.index()];
            *at -= self.way * (2.0 * (*at - self.centre).dot(self.way));
        }
        positions
    }

    /// Lifts a band by its rungs, whose middles come to lie on half a turn.
    pub(crate) fn raise(&self, model: &mut Model, id: SurfaceId, rungs: &[EdgeId]) {
        let Some(shape) = model.surfaces.get_mut(&id).map(edit::<SurfaceShape>) else { return };
        for rung in rungs {
            let [a, b] = shape.mesh.edge_vertices(*rung);
            let [from, to] = [a, b].map(|v| shape.positions[v.index()]);
            let wanted = f64::midpoint(shape.wanted_at(a), shape.wanted_at(b));
            let v = shape.mesh.split_edge(*rung);
            shape.make_room();
            shape.positions[v.index()] = from.midpoint(to) + self.up * (0.5 * from.distance(to));
            if let Some(own) = shape.wanted.get_mut(v.index()) {
                *own = wanted;
            }
        }
    }
}

/// The side of a plane to which the surface beside some vertices of rims faces, if it stays in the plane there.
fn facing<'a>(shape: &SurfaceShape, rim: impl Iterator<Item = &'a VertexId>, normal: DVec3) -> Option<DVec3> {
    let (mesh, positions) = (&shape.mesh, &shape.positions);
    let (mut depth, mut length, mut facing) = (0.0, 0.0, 0.0);
    for v in rim {
        for w in mesh.neighbours(*v) {
            let side = positions[w.index()] - positions[v.index()];
            depth += side.dot(normal).abs();
            length += side.length();
        }
        let edges = mesh.neighbours(*v).filter_map(|w| mesh.edge_between(*v, w));
        let faces = edges.map(|e| mesh.edge_faces(e).0);
        facing += faces.map(|f| measure::face_normal(mesh, positions, f).dot(normal)).sum::<f64>();
    }
    (depth <= STEEP * length).then_some(if facing < 0.0 { -normal } else { normal })
}
