//! The smooth surface that the nodes of a mesh lie on, where it can be told from the mesh, and its exact energy.

use super::mesh::Mesh;
use glam::{DMat3, DMat4, DVec3, DVec4};
use std::f64::consts::PI;

/// How far a node may lie off the surface, in units of its size: recorded positions are rounded.
const OFF: f64 = 1e-6;

/// A surface whose integral of `k1² + k2²` is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Smooth {
    /// Any sphere.
    Sphere,
    /// Any torus, with the radius of its circle of centres and the radius of its tube.
    Torus { major: f64, minor: f64 },
}

impl Smooth {
    /// Of a closed mesh of the right genus all of whose nodes lie on such a surface.
    pub(crate) fn of(mesh: &Mesh) -> Option<Self> {
        if !mesh.is_closed() {
            return None;
        }
        match mesh.euler_characteristic() {
            2 => is_sphere(&mesh.positions).then_some(Self::Sphere),
            0 => torus(&mesh.positions),
            _ => None,
        }
    }

    /// The integral of `k1² + k2²`: 8π, or `4π² R² / (r √(R² - r²))`.
    pub(crate) fn energy(self) -> f64 {
        match self {
            Self::Sphere => 8.0 * PI,
            Self::Torus { major, minor } => {
                4.0 * PI * PI * major * major / (minor * (major * major - minor * minor).sqrt())
            }
        }
    }
}

/// Linear least squares for the centre `c`: `|p|² = 2 c·p + (r² - |c|²)`, about the mean of the nodes.
fn is_sphere(positions: &[DVec3]) -> bool {
    let count = positions.len() as f64;
    let mean = positions.iter().sum::<DVec3>() / count;
    let size = positions.iter().map(|p| p.distance(mean)).fold(0.0, f64::max);
    if size == 0.0 {
        return false;
    }
    let mut normal = DMat4::ZERO;
    let mut right = DVec4::ZERO;
    for p in positions {
        let p = (*p - mean) / size;
        let row = p.extend(1.0);
        normal += DMat4::from_cols(row * row.x, row * row.y, row * row.z, row * row.w);
        right += row * p.length_squared();
    }
    let solution = normal.inverse() * right;
    let centre = 0.5 * solution.truncate();
    let radius = (solution.w + centre.length_squared()).sqrt();
    positions.iter().all(|p| (((*p - mean) / size).distance(centre) - radius).abs() <= OFF * radius)
}

/// Least squares by Gauss and Newton's steps, from the axis in which the nodes lie flattest.
fn torus(positions: &[DVec3]) -> Option<Smooth> {
    let count = positions.len() as f64;
    let mean = positions.iter().sum::<DVec3>() / count;
    let size = positions.iter().map(|p| p.distance(mean)).fold(0.0, f64::max);
    let points: Vec<DVec3> = positions.iter().map(|p| (*p - mean) / size).collect();
    let spread =
        points.iter().fold(DMat3::ZERO, |sum, p| sum + DMat3::from_cols(*p * p.x, *p * p.y, *p * p.z));
    // Inverse iteration; a torus is never so flat that its spread has no inverse.
    let inverse = spread.inverse();
    let axis =
        (0..AXIS_STEPS).fold(DVec3::new(0.48, 0.6, 0.64), |axis, _| (inverse * axis).normalize_or_zero());
    let mut guess = Torus { centre: DVec3::ZERO, axis, major: 0.0, minor: 0.0 };
    guess.major = points.iter().map(|p| guess.seen(*p).0).sum::<f64>() / count;
    guess.minor = points.iter().map(|p| guess.off(*p)).sum::<f64>() / count;
    for _ in 0..FIT_STEPS {
        guess = guess.nearer(&points)?;
    }
    let Torus { major, minor, .. } = guess;
    let fits = minor > 0.0 && major > minor && points.iter().all(|p| guess.off(*p).abs() <= OFF * minor);
    fits.then_some(Smooth::Torus { major: major * size, minor: minor * size })
}

/// Steps towards the flattest direction, and of the fit.
const AXIS_STEPS: usize = 60;
const FIT_STEPS: usize = 30;

/// A torus anywhere.
#[derive(Clone, Copy)]
struct Torus {
    centre: DVec3,
    axis: DVec3,
    major: f64,
    minor: f64,
}

impl Torus {
    /// Distance from the axis, the direction of it, and the height along the axis.
    fn seen(&self, p: DVec3) -> (f64, DVec3, f64) {
        let from = p - self.centre;
        let height = from.dot(self.axis);
        let out = from - self.axis * height;
        (out.length(), out.normalize_or_zero(), height)
    }

    /// How far outside a point lies.
    fn off(&self, p: DVec3) -> f64 {
        let (rho, _, height) = self.seen(p);
        (rho - self.major).hypot(height) - self.minor
    }

    /// One step of the fit; none where it is not determined.
    fn nearer(&self, points: &[DVec3]) -> Option<Self> {
        let (across, along) = self.axis.any_orthonormal_pair();
        let mut system = [[0.0; 8]; 7];
        for p in points {
            let (rho, out, height) = self.seen(*p);
            let round = (rho - self.major).hypot(height);
            let (flat, up) = ((rho - self.major) / round, height / round);
            let gradient = out * flat + self.axis * up;
            // When the axis tilts towards a direction, the height grows by the part of the point in it, and the distance falls.
            let tilt = |to: DVec3| (up * rho - flat * height) * out.dot(to);
            let row = [-gradient.x, -gradient.y, -gradient.z, tilt(across), tilt(along), -flat, -1.0];
            for (equation, i) in system.iter_mut().zip(row) {
                for (entry, j) in equation.iter_mut().zip(row.into_iter().chain([self.minor - round])) {
                    *entry += i * j;
                }
            }
        }
        let [x, y, z, a, b, major, minor] = solved(system)?;
        let step = Self {
            centre: self.centre + DVec3::new(x, y, z),
            axis: (self.axis + across * a + along * b).normalize_or_zero(),
            major: self.major + major,
            minor: self.minor + minor,
        };
        (step.centre.is_finite() && step.major.is_finite() && step.minor.is_finite()).then_some(step)
    }
}

/// Gaussian elimination with the largest pivots; none for a singular system. The last column is the right side.
fn solved(mut system: [[f64; 8]; 7]) -> Option<[f64; 7]> {
    for k in 0..7 {
        let pivot = (k..7).max_by(|&i, &j| system[i][k].abs().total_cmp(&system[j][k].abs()))?;
        system.swap(k, pivot);
        let own = system[k];
        if own[k] == 0.0 || !own[k].is_finite() {
            return None;
        }
        for (_, row) in system.iter_mut().enumerate().filter(|(i, _)| *i != k) {
            let share = row[k] / own[k];
            row.iter_mut().zip(own).for_each(|(entry, own)| *entry -= share * own);
        }
    }
    Some(std::array::from_fn(|k| system[k][7] / system[k][k]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    /// Points all over a torus, denser on one side of it.
    fn points(major: f64, minor: f64) -> Vec<DVec3> {
        let place = |k: u32| {
            let t = f64::from(k) / 300.0;
            let ((b, a), (d, c)) = (libm::sincos(6.5 * t * t), libm::sincos(131.0 * t));
            DVec3::new((major + minor * c) * a, (major + minor * c) * b, minor * d)
        };
        (0..300).map(place).collect()
    }

    #[test]
    fn a_torus_is_known_wherever_it_lies() {
        for (major, minor) in [(2.0, 1.0), (3.0, 0.2), (1.1, 1.0), (200.0, 90.0)] {
            for turn in [DQuat::IDENTITY, DQuat::from_xyzw(0.1, 0.7, -0.5, 0.5).normalize()] {
                for shift in [DVec3::ZERO, DVec3::new(5.0, -3.0, 0.7)] {
                    let moved: Vec<DVec3> = points(major, minor).iter().map(|p| turn * *p + shift).collect();
                    let Some(Smooth::Torus { major: found, minor: tube }) = torus(&moved) else {
                        panic!("{major} {minor} is no torus")
                    };
                    assert!((found / major - 1.0).abs() < 1e-12, "{major} {minor}: {found}");
                    assert!((tube / minor - 1.0).abs() < 1e-12, "{major} {minor}: {tube}");
                }
            }
        }
    }

    #[test]
    fn what_is_nearly_a_torus_is_none() {
        let bent: Vec<DVec3> = points(2.0, 1.0).iter().map(|p| *p + DVec3::Z * (1e-4 * p.x * p.x)).collect();
        assert_eq!(torus(&bent), None);
        let long: Vec<DVec3> = points(2.0, 1.0).iter().map(|p| *p * DVec3::new(1.01, 1.0, 1.0)).collect();
        assert_eq!(torus(&long), None);
        assert_eq!(torus(&[DVec3::ZERO; 20]), None);
        let flat: Vec<DVec3> = points(2.0, 1.0).iter().map(|p| p.with_z(0.0)).collect();
        assert_eq!(torus(&flat), None);
    }
}
