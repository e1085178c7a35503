//! What flips make smaller, and why they come to an end.
//!
//! The potential of a triangulation is
//!
//! ```text
//!     F = Σ over triangles Σ of the cotangents of its angles  +  Σ over vertices (neighbours - wanted)²
//! ```
//!
//! The cotangents of a triangle add up to (a² + b² + c²) / (4 · area): √3 for an equilateral one, more for any other,
//! without bound for a needle. In the plane this first sum alone is least for the Delaunay triangulation, and every
//! flip towards it lowers the sum (Musin 1997, "harmonic index"). The second sum wants six neighbours, or four on the
//! boundary. Lone vertices of five and seven neighbours are what bends a triangulation out of shape where no flip of
//! the Delaunay kind can mend it; with the sum they move together and vanish in pairs.
//!
//! **Flips end.** A flip changes two triangles and the neighbours of four vertices, nothing else, so F changes by what
//! is computed from these, in space as in the plane. A pass flips only if F falls by more than [`LEAST_FALL`]. F is
//! never below √3 times the number of triangles, which flips do not change. So no pass makes more than
//! (F − √3 · triangles) / 0.1 flips, whatever their order. A triangle's share is cut off at [`WORST`], so that the
//! rounding error of a fall (at most about 1e-14 · 1e6 · 4) is nothing beside 0.1: a computed fall is a true one.
//! The smoothing of the solver lowers the same sum of cotangents, so that flips and smoothing do not fight either.

use glam::DVec3;

use super::diagonal::Diagonal;
use crate::{Mesh, VertexId};

/// A flip must lower the potential by more than this. It keeps edges of nearly square quadrilaterals from turning
/// to and fro while their corners jitter.
pub(super) const LEAST_FALL: f64 = 0.1;

/// No triangle counts for more: one with a corner of a millionth of a radian, which no flip should look behind.
const WORST: f64 = 1e6;

/// Neighbours that an inner vertex wants, and one on the boundary.
const REGULAR: [f64; 2] = [6.0, 4.0];

/// By how much flipping this diagonal would lower the potential.
pub(super) fn fall(mesh: &Mesh, degrees: &mut Degrees, positions: &[DVec3], diagonal: &Diagonal) -> f64 {
    let ([a, b], [c, d]) = (diagonal.ends, diagonal.opposite);
    let mut surplus = |v| surplus(degrees.of(mesh, v));
    // (x - 1)² - x² = 1 - 2x for the ends, (x + 1)² - x² = 1 + 2x for the opposite vertices.
    let rise_of_squares = 4.0 + 2.0 * (surplus(c) + surplus(d) - surplus(a) - surplus(b));
    fall_of_cotangents(diagonal.points(positions)) - rise_of_squares
}

/// The part of the fall that the triangles make: from diagonal `ab` to diagonal `cd`.
pub(super) fn fall_of_cotangents([a, b, c, d]: [DVec3; 4]) -> f64 {
    cotangents(a, b, c) + cotangents(b, a, d) - cotangents(c, a, d) - cotangents(d, b, c)
}

/// The potential itself. Flips need only its falls.
#[cfg(test)]
pub(super) fn total(mesh: &Mesh, positions: &[DVec3]) -> f64 {
    let of_face = |f| {
        let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()]);
        cotangents(a, b, c)
    };
    let triangles: f64 = mesh.faces().map(of_face).sum();
    triangles + mesh.vertices().map(|v| surplus(mesh.degree(v))).map(|x| x * x).sum::<f64>()
}

/// By how many a vertex has more neighbours than it wants, given their number and whether they close around it.
fn surplus((valence, is_closed): (usize, bool)) -> f64 {
    let wanted = REGULAR[usize::from(!is_closed)];
    f64::from(u32::try_from(valence).unwrap_or(u32::MAX)) - wanted
}

/// Numbers of neighbours: counted when they are first asked for, since each is asked for at every edge around, and kept
/// right from flip to flip.
pub(super) struct Degrees {
    /// By vertex slot; no neighbours for those not counted yet.
    counted: Vec<(usize, bool)>,
}

impl Degrees {
    pub(super) fn new(mesh: &Mesh) -> Self {
        Self { counted: vec![(0, false); mesh.vertex_slots()] }
    }

    /// How many neighbours a vertex has, and whether they close around it.
    pub(super) fn of(&mut self, mesh: &Mesh, v: VertexId) -> (usize, bool) {
        let counted = &mut self.counted[v.index()];
        if counted.0 == 0 {
            *counted = mesh.degree(v);
        }
        *counted
    }

    /// A flip was made. Its four vertices have been counted, or will be.
    pub(super) fn flipped(&mut self, diagonal: &Diagonal) {
        for v in diagonal.ends.into_iter().chain(diagonal.opposite) {
            self.counted[v.index()].0 = 0;
        }
    }
}

/// The sum of a triangle's cotangents, at most [`WORST`].
fn cotangents(p: DVec3, q: DVec3, r: DVec3) -> f64 {
    let (a, b, c) = (q - p, r - q, p - r);
    let sides = a.length_squared() + b.length_squared() + c.length_squared();
    // NaN, of a triangle without size, becomes the worst too.
    (sides / (2.0 * a.cross(b).length())).min(WORST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::property_test::cases;
    use proptest::prelude::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn an_equilateral_triangle_is_best_and_a_point_is_worst() {
        let third = DVec3::new(0.5, 0.75_f64.sqrt(), 0.0);
        assert!((cotangents(DVec3::ZERO, DVec3::X, third) - 3.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(cotangents(DVec3::ONE, DVec3::ONE, DVec3::ONE), WORST);
        assert_eq!(cotangents(DVec3::ZERO, DVec3::X, DVec3::X * 2.0), WORST);
    }

    proptest! {
        #![proptest_config(cases(256, 64))]

        /// In the plane, for convex quadrilaterals, the sum falls exactly when the edge is not Delaunay.
        #[test]
        fn falling_cotangents_are_the_delaunay_test(
            c in (-2.0..2.0_f64, 0.05..2.0_f64),
            d in (-2.0..2.0_f64, -2.0..-0.05_f64),
        ) {
            let (a, b) = ([0.0, 0.0], [1.0, 0.0]);
            let (c, d) = ([c.0, c.1], [d.0, d.1]);
            let coord = |[x, y]: [f64; 2]| robust::Coord { x, y };
            let left = robust::orient2d(coord(d), coord(c), coord(a));
            let right = robust::orient2d(coord(d), coord(c), coord(b));
            prop_assume!(left * right < 0.0);
            let inside = robust::incircle(coord(a), coord(b), coord(c), coord(d));
            prop_assume!(inside.abs() > 1e-9);
            let fall = fall_of_cotangents([a, b, c, d].map(|[x, y]| DVec3::new(x, y, 0.0)));
            prop_assert_eq!(fall > 0.0, inside > 0.0, "{} {}", fall, inside);
        }
    }
}
