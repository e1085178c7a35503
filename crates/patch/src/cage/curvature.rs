//! Normal and principal curvatures of a parametric surface from its derivatives (do Carmo, *Differential Geometry of Curves and
//! Surfaces*, section 3-3), by way of an orthonormal frame: no difference of nearly equal products decides.

use glam::DVec3;

/// The unit normal `a x b`; none when the two span no plane.
pub(super) fn normal(a: DVec3, b: DVec3) -> Option<DVec3> {
    // Directions first: the product of two short vectors would vanish.
    let cross = a.try_normalize()?.cross(b.try_normalize()?);
    // Below this the plane is rounding.
    if cross.length() > 1e-14 { cross.try_normalize() } else { None }
}

/// Principal curvatures, the larger first, positive where the surface bends towards its normal.
pub(super) fn principal([a, b]: [DVec3; 2], [aa, ab, bb]: [DVec3; 3]) -> Option<[f64; 2]> {
    let normal = normal(a, b)?;
    // a = p e, b = q e + r f in the orthonormal frame (e, f).
    let (p, e) = (a.length(), a.try_normalize()?);
    let f = normal.cross(e);
    let (q, r) = (b.dot(e), b.dot(f));
    let [l, m, n] = [aa, ab, bb].map(|second| second.dot(normal));
    let ee = l / p / p;
    let ef = (m / p - q * ee) / r;
    let ff = (n / r - 2.0 * q * ef - q * q * ee / r) / r;
    let (mean, half) = ((ee + ff) / 2.0, (ee - ff) / 2.0);
    let spread = libm::hypot(half, ef);
    Some([mean + spread, mean - spread])
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_graph_in_any_parameters_has_its_curvatures() {
        // z = (3 x^2 - y^2)/2 at the origin, with x = u + 2v, y = 3v.
        let (a, b) = (DVec3::X, DVec3::new(2.0, 3.0, 0.0));
        let (aa, ab, bb) = (3.0, 6.0, 12.0 - 9.0);
        let slide = DVec3::new(0.7, -1.3, 0.0);
        let [k1, k2] = principal([a, b], [aa, ab, bb].map(|z| slide + DVec3::Z * z)).unwrap();
        assert!((k1 - 3.0).abs() < 1e-14 && (k2 + 1.0).abs() < 1e-14, "{k1} {k2}");
        let tiny = principal([a * 1e-90, b * 1e-90], [aa, ab, bb].map(|z| DVec3::Z * (z * 1e-90))).unwrap();
        assert!((tiny[0] * 1e-90 - 3.0).abs() < 1e-13);
    }

    #[test]
    fn no_plane_has_no_normal() {
        assert_eq!(normal(DVec3::X, DVec3::X * 2.0), None);
        assert_eq!(normal(DVec3::ZERO, DVec3::X), None);
        assert_eq!(principal([DVec3::X, DVec3::ZERO], [DVec3::Z; 3]), None);
    }
}
