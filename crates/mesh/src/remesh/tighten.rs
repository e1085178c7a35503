//! Tightening a coarse skin: edges over which it bends sharply are flipped as long as it bends less afterwards.
//!
//! Source: Alboul and van Damme (1996), "Polyhedral metrics in surface reconstruction: tight triangulations". The measure is the total absolute
//! mean curvature of a polyhedron, Σ length × angle between the normals. A few large triangles between the points of a tube may run
//! through its inside and back; what is refined from such a skin has folds that no smoothing opens. Skins that bend
//! nowhere by more than 135° stay what they are.

use glam::DVec3;

use crate::measure::{angle_between, face_normal};
use crate::{EdgeId, Mesh};

/// From this angle between the normals on an edge is sharp: 135°. Where three flat faces go round a tube they bend by 120°, and that is no fold.
const SHARP: f64 = 2.356;
/// Flips in one run, for each edge.
const FLIPS: usize = 4;
/// A flip must lower the measure by this part of what the five edges have.
const LEAST_GAIN: f64 = 1e-6;

/// Flips inner edges without a tag over which the surface bends by more than 135°, and those around them, while
/// that makes the total of length times angle less. Returns the number of flips, which is bounded.
pub fn tighten(mesh: &mut Mesh, positions: &[DVec3]) -> usize {
    let mut stack: Vec<EdgeId> = mesh.edges().filter(|&e| is_sharp(mesh, positions, e)).collect();
    stack.reverse();
    let mut left = FLIPS * mesh.edge_count();
    let mut flips = 0;
    while let Some(e) = stack.pop() {
        if left == 0 || mesh.can_flip(e).is_err() {
            continue;
        }
        left -= 1;
        let before = bend_around(mesh, positions, e);
        mesh.flip(e);
        if bend_around(mesh, positions, e) < (1.0 - LEAST_GAIN) * before {
            flips += 1;
            stack.extend(around(mesh, e));
        } else {
            mesh.flip(e);
        }
    }
    flips
}

/// The angle between the normals on both sides, 0 to π; a triangle without area stands across everything.
fn angle(mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> f64 {
    let (f, Some(g)) = mesh.edge_faces(e) else { return 0.0 };
    let [one, other] = [f, g].map(|f| face_normal(mesh, positions, f).normalize_or_zero());
    if one == DVec3::ZERO || other == DVec3::ZERO {
        return core::f64::consts::FRAC_PI_2;
    }
    angle_between(one, if mesh.is_wound_alike(e) { other } else { -other })
}

fn is_sharp(mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> bool {
    angle(mesh, positions, e) > SHARP
}

/// An edge and the four around it.
fn around(mesh: &Mesh, e: EdgeId) -> Vec<EdgeId> {
    let (f, g) = mesh.edge_faces(e);
    let sides = [Some(f), g].into_iter().flatten().flat_map(|f| f.halfedges()).map(|h| mesh.edge_of(h));
    let mut edges: Vec<EdgeId> = sides.collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}

fn bend_around(mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> f64 {
    let bend = |e: EdgeId| {
        let [a, b] = mesh.edge_vertices(e).map(|v| positions[v.index()]);
        a.distance(b) * angle(mesh, positions, e)
    };
    // Where a curve runs a surface may well turn, as a plate does into a tube: that is not to be traded for a fold beside it.
    around(mesh, e).into_iter().filter(|&e| !mesh.is_source_edge(e)).map(bend).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{SourceTag, VertexId, primitive, summary, validate};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn total(mesh: &Mesh, positions: &[DVec3]) -> f64 {
        mesh.edges()
            .map(|e| {
                let [a, b] = mesh.edge_vertices(e).map(|v| positions[v.index()]);
                a.distance(b) * angle(mesh, positions, e)
            })
            .sum()
    }

    /// A square tube, some of whose edges were turned so that it runs through its own inside there.
    #[test]
    fn a_tube_through_its_own_inside_is_put_round_it() {
        let at = |k: u32| {
            let t = core::f64::consts::FRAC_PI_2 * f64::from(k % 4);
            DVec3::new(libm::cos(t), libm::sin(t), 0.6 * f64::from(k / 4))
        };
        let positions: Vec<_> = (0..16).map(at).collect();
        let next = |k: u32| k - k % 4 + (k + 1) % 4;
        let sides = (0..12).flat_map(|k| [[k, next(k), k + 4], [next(k), next(k + 4), k + 4]]);
        let straight = Mesh::from_triangles(16, &sides.collect::<Vec<_>>()).unwrap();
        let wanted = total(&straight, &positions);
        let mut mesh = straight;
        for (low, high) in [(4, 8), (6, 10)] {
            let e = mesh.edge_between(VertexId::from_index(low), VertexId::from_index(high)).unwrap();
            mesh.flip(e);
        }
        let before = total(&mesh, &positions);
        assert!(before > 1.3 * wanted, "{before}, {wanted}");
        assert_eq!(tighten(&mut mesh, &positions), 2);
        let after = total(&mesh, &positions);
        assert!((after / wanted - 1.0).abs() < 1e-12, "{after}, {wanted}");
        assert_eq!(validate(&mesh), Ok(()));
    }

    #[test]
    fn what_bends_little_and_what_carries_a_curve_stays() {
        let (mut mesh, positions) = primitive::icosphere(1);
        let before = mesh.to_triangles();
        assert_eq!(tighten(&mut mesh, &positions), 0);
        assert_eq!(mesh.to_triangles(), before);
        // A square folded over its diagonal, which is a curve.
        let positions = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::new(0.9, 0.1, 0.1)];
        let mut mesh = Mesh::from_triangles(4, &[[0, 1, 2], [0, 2, 3]]).unwrap();
        let diagonal = mesh.edges().find(|&e| !mesh.is_boundary_edge(e)).unwrap();
        mesh.set_edge_source(diagonal, Some(SourceTag(1)));
        assert!(is_sharp(&mesh, &positions, diagonal));
        assert_eq!(tighten(&mut mesh, &positions), 0);
        mesh.set_edge_source(diagonal, None);
        assert_eq!(tighten(&mut mesh, &positions), 1);
    }

    #[test]
    fn a_one_sided_surface_keeps_its_kind() {
        let (mut mesh, mut positions) = primitive::klein_bottle(7, 5, 1.0, 0.4);
        let count = positions.len();
        for k in 0..count {
            positions.swap(k, (11 * k + 3) % count);
        }
        let before = summary(&mesh).kind();
        tighten(&mut mesh, &positions);
        assert_eq!(validate(&mesh), Ok(()));
        assert_eq!(summary(&mesh).kind(), before);
    }
}
