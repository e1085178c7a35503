//! How well two surfaces meet along a curve: gap, angle between normals, jump of curvature. Whatever the surfaces are, they
//! come as points of theirs at the same places along the seam.
//!
//! Beside a corner at which a surface has no tangent plane nothing bounds its curvature, so a difference of curvatures there says
//! nothing of the join. Such places show by the area that a surface has per unit of its parameters: where that is less than
//! [`SQUEEZED`] of its mean along the seam, curvatures are not compared, and these places are counted.

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
    /// At how many pairs curvatures are not compared: those without a normal, and those where a surface is squeezed.
    pub without_curvature: usize,
}

/// Part of the mean area per unit of the parameters below which a surface counts as squeezed.
const SQUEEZED: f64 = 0.1;

/// Below this area a point of a surface is squeezed.
fn least_area(points: &[SurfacePoint]) -> f64 {
    let mean = points.iter().map(area).sum::<f64>() / points.len() as f64;
    // An area that is no number squeezes nothing.
    if mean.is_finite() { SQUEEZED * mean } else { 0.0 }
}

fn area(point: &SurfacePoint) -> f64 {
    point.dx.cross(point.dy).length()
}

/// Compares two surfaces along a seam, point by point; none if the numbers of points differ or there are none.
#[must_use]
pub fn seam(one: &[SurfacePoint], other: &[SurfacePoint]) -> Option<Seam> {
    if one.len() != other.len() || one.is_empty() {
        return None;
    }
    let mut worst = Seam::default();
    let (least_of_one, least_of_other) = (least_area(one), least_area(other));
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
            worst.without_curvature += 1;
            continue;
        };
        let angle = libm::atan2(m.cross(n).length(), m.dot(n).abs());
        keep(angle, at, &mut worst.angle, &mut worst.angle_at);
        if area(a) < least_of_one || area(b) < least_of_other {
            worst.without_curvature += 1;
            continue;
        }
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

    /// The cone `z = |xy|` along its axis, from the apex, where it has no plane and beside which its curvature grows without bound, in
    /// polar parameters.
    fn cone() -> Vec<SurfacePoint> {
        let at = |r: f64| SurfacePoint {
            point: DVec3::new(r, 0.0, r),
            dx: DVec3::new(1.0, 0.0, 1.0),
            dy: DVec3::Y * r,
            dxy: DVec3::Y,
            dyy: DVec3::NEG_X * r,
            ..SurfacePoint::default()
        };
        (0..=64).map(|k| at(f64::from(k) / 64.0)).collect()
    }

    #[test]
    fn curvature_beside_a_corner_without_a_plane_is_left_out_and_counted() {
        let plane =
            |cone: &SurfacePoint| SurfacePoint { dxy: DVec3::ZERO, dyy: DVec3::ZERO, dy: DVec3::Y, ..*cone };
        let (cone, plane): (Vec<_>, Vec<_>) = cone().iter().map(|at| (*at, plane(at))).unzip();
        let found = seam(&cone, &plane).unwrap();
        // The mean area is half the largest one, so what is nearer to the apex than a twentieth of the seam is left out.
        assert_eq!((found.without_normal, found.without_curvature), (1, 4));
        // There the mean curvature is 1 / (2 √2 r).
        let exact = 64.0 / 4.0 / (2.0 * core::f64::consts::SQRT_2);
        assert!((found.curvature_jump - exact).abs() < 1e-12 && found.curvature_at == 4, "{found:?}");
        assert!(found.angle < 1e-15, "{found:?}");
    }

    #[test]
    fn how_large_a_surface_is_does_not_matter() {
        let small: Vec<SurfacePoint> = strip(2.0, 0.0, false)
            .iter()
            .map(|at| SurfacePoint { dx: at.dx * 1e-9, dxx: at.dxx * 1e-18, ..*at })
            .collect();
        let found = seam(&strip(0.0, 0.0, false), &small).unwrap();
        assert!((found.curvature_jump - 1.0).abs() < 1e-9 && found.without_curvature == 0, "{found:?}");
    }

    #[test]
    fn lists_that_do_not_match_are_no_seam() {
        let flat = strip(0.0, 0.0, false);
        assert_eq!(seam(&flat, &flat[1..]), None);
        assert_eq!(seam(&[], &[]), None);
    }
}
