//! The smooth surface that the nodes of a mesh lie on, where it can be told from the mesh, and its exact energy.

use super::mesh::Mesh;
use glam::{DMat4, DVec3, DVec4};
use std::f64::consts::PI;

/// How far a node may lie off the surface, in units of its size: recorded positions are rounded.
const OFF: f64 = 1e-6;

/// A surface whose integral of `k1² + k2²` is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Smooth {
    /// Any sphere.
    Sphere,
    /// A torus around the z axis with the radius of its circle of centres and the radius of its tube.
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

/// Linear least squares for `R` and `R² - r²`: `ρ² + z² = 2 R ρ - (R² - r²)`, with `ρ` the distance from the z axis.
fn torus(positions: &[DVec3]) -> Option<Smooth> {
    let count = positions.len() as f64;
    let samples = || positions.iter().map(|p| (p.truncate().length(), p.length_squared()));
    let (sum_x, sum_y) = samples().fold((0.0, 0.0), |(x, y), (rho, square)| (x + rho, y + square));
    let (mean_x, mean_y) = (sum_x / count, sum_y / count);
    let (xx, xy) = samples().fold((0.0, 0.0), |(xx, xy), (rho, square)| {
        (xx + (rho - mean_x) * (rho - mean_x), xy + (rho - mean_x) * (square - mean_y))
    });
    let major = 0.5 * xy / xx;
    let minor = (major * major - (2.0 * major * mean_x - mean_y)).sqrt();
    let off = |p: &DVec3| ((p.truncate().length() - major).hypot(p.z) - minor).abs();
    let fits = minor > 0.0 && major > minor && positions.iter().all(|p| off(p) <= OFF * minor);
    fits.then_some(Smooth::Torus { major, minor })
}
