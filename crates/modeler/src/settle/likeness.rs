//! Whether two meshes are of one shape, and which is the better one.

use super::slide::{Slide, Way};
use crate::model::Model;
use crate::relax::Relaxer;
use crate::shape::SurfaceShape;
use ductile_mesh::SurfaceTree;
use glam::DVec3;

/// Farthest that two meshes of one shape lie apart, as a part of its radius. At a few hundred nodes the same shape on two meshes
/// differs by some thousandths; other valleys lie a tenth and more away.
const NEAR: f64 = 0.02;
/// Part by which the energies of a shape on two meshes differ (recipe, section 7: an irregular mesh of 1000 nodes is
/// 1 to 1.5 % off).
const ALIKE: f64 = 0.02;
/// The same where edges differ in length for the sake of necks, of which twelve or sixteen run round one.
const ALIKE_GRADED: f64 = 0.05;
/// Part by which a shape without folds may cost more than a folded one. What a mesh folds it does not resolve, and what it does
/// not resolve costs too little: a neck with a few triangles round it is priced 6 % below the smooth one of the same document.
const UNFOLDED: f64 = 0.25;
/// Energies below this are flat, whichever is the larger.
pub(crate) const FLAT: f64 = 1e-6;
/// Part of the energy of a shape below which another one is no neighbour of it but what was to come of the act. Shapes that somebody
/// could mean, a band twisted once more than it had to be or a tube with a dent, are nearer to one another than that.
const MUCH_CHEAPER: f64 = 0.5;
/// Least angle of good triangles, in radians.
const GOOD_ANGLE: f64 = 0.3;

/// Whether shapes out of sight cost no more than those shown, which are folded if they `unfold`, and have no worse triangles, surface
/// by surface.
pub(super) fn is_no_worse(hidden: (&Model, &Relaxer), shown: (&Model, &Relaxer), unfold: bool) -> bool {
    hidden.0.surfaces.iter().all(|(id, shape)| {
        let Some(old) = shown.0.surfaces.get(id) else { return false };
        let alike = match shape.wanted.is_empty() {
            _ if unfold => UNFOLDED,
            true => ALIKE,
            false => ALIKE_GRADED,
        };
        let energies = hidden.1.surface(*id, shape).zip(shown.1.surface(*id, old));
        let is_cheap = energies.is_some_and(|(new, old)| new.energy() <= old.energy() * (1.0 + alike) + FLAT);
        is_cheap && least_angle(shape) >= least_angle(old).min(GOOD_ANGLE)
    })
}

/// Whether of the shapes out of sight none costs more than the one shown, and one costs hardly any of what that does. Then nobody asks
/// which has the better triangles.
pub(super) fn is_much_cheaper(hidden: (&Model, &Relaxer), shown: (&Model, &Relaxer)) -> bool {
    let mut least = 1.0_f64;
    for (id, shape) in &hidden.0.surfaces {
        let old = shown.0.surfaces.get(id).and_then(|old| shown.1.surface(*id, old));
        let Some((new, old)) = hidden.1.surface(*id, shape).zip(old) else { return false };
        let (new, old) = (new.energy() + FLAT, old.energy() + FLAT);
        // What is no number is no cheaper.
        let is_no_dearer = new <= old * (1.0 + ALIKE);
        if !is_no_dearer {
            return false;
        }
        least = least.min(new / old);
    }
    least < MUCH_CHEAPER
}

/// Whether the way is short for every curve and surface.
pub(super) fn is_near(slide: &Slide, shown: &Model) -> bool {
    let curves = slide.curves.values().all(|way| {
        let reach = NEAR * radius(&way.to.nodes);
        way.from.iter().zip(&way.to.nodes).all(|(from, to)| from.distance(*to) <= reach)
    });
    curves
        && slide
            .surfaces
            .iter()
            .all(|(id, way)| shown.surfaces.get(id).is_some_and(|shown| is_short(way) && covers(way, shown)))
}

/// Whether no vertex goes far.
fn is_short(way: &Way<SurfaceShape>) -> bool {
    let reach = NEAR * way.to.radius();
    way.to.mesh.vertices().all(|v| way.from[v.index()].distance(way.to.positions[v.index()]) <= reach)
}

/// Whether no vertex shown is far from the shape to arrive at.
fn covers(way: &Way<SurfaceShape>, shown: &SurfaceShape) -> bool {
    let (reach, to) = (NEAR * way.to.radius(), &way.to);
    let tree = SurfaceTree::new(&to.mesh, &to.positions);
    shown.mesh.vertices().all(|v| {
        let at = shown.positions[v.index()];
        tree.nearest(&to.mesh, at).is_some_and(|(_, near)| near.distance(at) <= reach)
    })
}

/// Largest distance from the centre of their box.
fn radius(nodes: &[DVec3]) -> f64 {
    let low = nodes.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = nodes.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    if low.x > high.x { 0.0 } else { low.distance(high) * 0.5 }
}

/// Smallest angle of any triangle, in radians; 0 for triangles that have none.
fn least_angle(shape: &SurfaceShape) -> f64 {
    let mut least = core::f64::consts::PI;
    for face in shape.mesh.faces() {
        let corners = shape.mesh.face_vertices(face).map(|v| shape.positions[v.index()]);
        for k in 0..3 {
            let (one, other) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
            let angle = libm::atan2(one.cross(other).length(), one.dot(other));
            // Written so that an angle that is none counts as none.
            least = if angle >= least { least } else { angle.max(0.0) };
        }
    }
    least
}
