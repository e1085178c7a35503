//! What a surface is like at one point: place, exact derivatives, and what follows from them.

use glam::DVec3;

/// The point of a parametrised surface with its first and second derivatives, in model units per unit of the parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SurfacePoint {
    /// The point itself.
    pub point: DVec3,
    /// First derivative by x.
    pub dx: DVec3,
    /// First derivative by y.
    pub dy: DVec3,
    /// Second derivative by x.
    pub dxx: DVec3,
    /// Mixed second derivative.
    pub dxy: DVec3,
    /// Second derivative by y.
    pub dyy: DVec3,
}

/// Below this sine of the angle between the derivatives there is no normal: their directions are rounding.
const LEAST_SINE: f64 = 1e-12;

/// The unit vector across both, unless they are parallel or one of them vanishes.
pub(crate) fn unit_normal(first: DVec3, second: DVec3) -> Option<DVec3> {
    // Scaled first, so that neither very small nor very large patches lose their normals.
    let (first, second) = (first.try_normalize()?, second.try_normalize()?);
    let across = first.cross(second);
    if across.length() > LEAST_SINE { across.try_normalize() } else { None }
}

impl SurfacePoint {
    /// The unit normal, in the direction of `dx × dy`; none where the two are parallel or vanish.
    #[must_use]
    pub fn normal(&self) -> Option<DVec3> {
        unit_normal(self.dx, self.dy)
    }

    /// The principal curvatures, the larger one first, per model unit; positive where the surface bends towards its
    /// normal (do Carmo, *Differential Geometry of Curves and Surfaces*, section 3-3). None where there is no normal.
    #[must_use]
    pub fn principal_curvatures(&self) -> Option<[f64; 2]> {
        let normal = self.normal()?;
        // dx = p e and dy = q e + r f in an orthonormal frame (e, f) of the plane; there the second form is a symmetric matrix,
        // whose eigenvalues have no cancellation at umbilics. Divided twice, since the square of a small length may vanish.
        let (p, e) = (self.dx.length(), self.dx.try_normalize()?);
        let f = normal.cross(e);
        let (q, r) = (self.dy.dot(e), self.dy.dot(f));
        let [l, m, n] = [self.dxx, self.dxy, self.dyy].map(|second| second.dot(normal));
        let ee = l / p / p;
        let ef = (m / p - q * ee) / r;
        let ff = (n / r - 2.0 * q * ef - q * q * ee / r) / r;
        let (middle, half) = (0.5 * (ee + ff), libm::hypot(0.5 * (ee - ff), ef));
        Some([middle + half, middle - half])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// The graph of `(x^2 k + y^2 l) / 2` at the origin, in skewed parameters and scaled.
    fn graph(k: f64, l: f64, size: f64) -> SurfacePoint {
        let (dx, dy) = (DVec3::new(2.0, 0.5, 0.0), DVec3::new(-1.0, 3.0, 0.0));
        let second = |a: DVec3, b: DVec3| DVec3::Z * (k * a.x * b.x + l * a.y * b.y) * size;
        SurfacePoint {
            point: DVec3::ZERO,
            dx: dx * size,
            dy: dy * size,
            dxx: second(dx, dx),
            dxy: second(dx, dy),
            dyy: second(dy, dy),
        }
    }

    #[test]
    fn curvatures_do_not_depend_on_the_parameters() {
        for size in [1e-90, 1e-30, 1.0, 1e30, 1e90] {
            let [first, second] = graph(2.0, -0.5, size).principal_curvatures().unwrap();
            let deviation = ((first * size - 2.0).abs()).max((second * size + 0.5).abs());
            assert!(deviation < 1e-14, "{first} {second}");
            let [first, second] = graph(3.0, 3.0, size).principal_curvatures().unwrap();
            assert!((first - second).abs() * size < 1e-14, "an umbilic has one curvature");
        }
    }

    #[test]
    fn there_is_no_normal_without_a_plane() {
        let mut point = graph(1.0, 1.0, 1.0);
        assert!(point.normal().unwrap().distance(DVec3::Z) < 1e-15);
        point.dy = 3.0 * point.dx;
        assert_eq!((point.normal(), point.principal_curvatures()), (None, None));
        point.dx = DVec3::ZERO;
        assert_eq!(point.normal(), None);
    }
}
