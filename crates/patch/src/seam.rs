//! How well two surfaces meet along a curve: gap, angle between normals, jump of curvature. Whatever the surfaces are, they
//! come as points of theirs at the same places along the seam.

use crate::surface_point::SurfacePoint;

/// The worst of a seam, with the place of each: the number of the pair of points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seam {
    /// Largest distance between the two surfaces, in model units.
    pub gap: f64,
    /// Where that is.
    pub gap_at: usize,
    /// Largest angle between the tangent planes, in radians from 0 to π/2: surfaces may face different ways.
    pub angle: f64,
    /// Where that is.
    pub angle_at: usize,
    /// Largest difference of the mean curvatures, per model unit, as seen from one side.
    pub curvature_jump: f64,
    /// Where that is.
    pub curvature_at: usize,
    /// At how many pairs one of the surfaces has no normal, so that neither angle nor curvatures are compared.
    pub without_normal: usize,
}

/// Compares two surfaces along a seam, point by point; none if the numbers of points differ or there are none.
#[must_use]
pub fn seam(one: &[SurfacePoint], other: &[SurfacePoint]) -> Option<Seam> {
    if one.len() != other.len() || one.is_empty() {
        return None;
    }
    let mut worst = Seam::default();
    let keep = |value: f64, at: usize, most: &mut f64, most_at: &mut usize| {
        // Not a number is the worst, and stays.
        if value > *most || value.is_nan() {
            (*most, *most_at) = (value, at);
        }
    };
    for (at, (a, b)) in one.iter().zip(other).enumerate() {
        keep(a.point.distance(b.point), at, &mut worst.gap, &mut worst.gap_at);
        let (Some(m), Some(n)) = (a.normal(), b.normal()) else {
            worst.without_normal += 1;
            continue;
        };
        let angle = libm::atan2(m.cross(n).length(), m.dot(n).abs());
        keep(angle, at, &mut worst.angle, &mut worst.angle_at);
        let side = if m.dot(n) < 0.0 { -1.0 } else { 1.0 };
        let mean = |point: &SurfacePoint| point.principal_curvatures().map(|[k, l]| 0.5 * (k + l));
        if let (Some(first), Some(second)) = (mean(a), mean(b)) {
            let jump = (first - side * second).abs();
            keep(jump, at, &mut worst.curvature_jump, &mut worst.curvature_at);
        }
    }
    Some(worst)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// The graph of `k x^2 / 2`, tilted about the y axis, at points of that axis.
    fn strip(k: f64, tilt: f64, is_turned: bool) -> Vec<SurfacePoint> {
        let (out, up) = (libm::cos(tilt), libm::sin(tilt));
        let across = DVec3::new(out, 0.0, up);
        let bend = DVec3::new(-up, 0.0, out) * k;
        (0..5)
            .map(|j| {
                let point = SurfacePoint {
                    point: DVec3::Y * f64::from(j),
                    dx: across,
                    dy: DVec3::Y,
                    dxx: bend,
                    ..SurfacePoint::default()
                };
                if is_turned { SurfacePoint { dx: -point.dx, ..point } } else { point }
            })
            .collect()
    }

    #[test]
    fn what_differs_is_measured() {
        let flat = strip(0.0, 0.0, false);
        assert_eq!(seam(&flat, &flat), Some(Seam::default()));
        for is_turned in [false, true] {
            let found = seam(&flat, &strip(0.0, 1e-9, is_turned)).unwrap();
            assert!((found.angle - 1e-9).abs() < 1e-15, "{found:?}");
            let found = seam(&strip(2.0, 0.0, false), &strip(0.5, 0.0, is_turned)).unwrap();
            assert!((found.curvature_jump - 0.75).abs() < 1e-14 && found.angle == 0.0, "{found:?}");
        }
        let mut lifted = strip(0.0, 0.0, false);
        lifted[3].point.z = 0.25;
        lifted[1].dx = DVec3::Y;
        let found = seam(&flat, &lifted).unwrap();
        assert_eq!((found.gap, found.gap_at, found.without_normal), (0.25, 3, 1));
        lifted[2].point.x = f64::NAN;
        assert!(seam(&flat, &lifted).unwrap().gap.is_nan());
    }

    #[test]
    fn lists_that_do_not_match_are_no_seam() {
        let flat = strip(0.0, 0.0, false);
        assert_eq!(seam(&flat, &flat[1..]), None);
        assert_eq!(seam(&[], &[]), None);
    }
}
