//! Normals of a displaced surface: those of the base, turned by the gradient of the offsets.
//!
//! With tangents `s`, `t` of the base and the offsets `D`, the displaced surface has the tangents `s + ∂D/∂s` and
//! `t + ∂D/∂t`. The gradient at a vertex is the linear function that fits the differences along its edges best, by the
//! inverse squares of their lengths. So normals stay as good as the base's, which triangles could not tell, and where nothing
//! is displaced they are the same bits.

use glam::{DMat2, DVec2, DVec3};

/// Sums of a least-squares fit at a vertex.
#[derive(Clone, Copy, Debug, Default)]
struct Fit {
    /// `Σ w u uᵀ` over the tangential parts `u` of edges: xx, xy, yy.
    squares: [f64; 3],
    /// `Σ w u d`.
    along: [DVec3; 2],
}

/// Turns the normals of a surface by what its offsets do.
pub(super) fn turned(
    positions: &[DVec3],
    normals: &[DVec3],
    offsets: &[DVec3],
    triangles: &[[u32; 3]],
) -> Vec<DVec3> {
    let frames: Vec<[DVec3; 2]> = normals.iter().map(|&normal| tangents(normal)).collect();
    let mut fits = vec![Fit::default(); positions.len()];
    for triangle in triangles {
        let corners = triangle.map(|v| v as usize);
        if corners.iter().all(|&v| offsets[v] == DVec3::ZERO) {
            continue;
        }
        for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|k: usize| corners[k])) {
            let (edge, rise) = (positions[b] - positions[a], offsets[b] - offsets[a]);
            let weight = 1.0 / edge.length_squared();
            if weight.is_finite() {
                fits[a].add(frames[a], edge, rise, weight);
                fits[b].add(frames[b], -edge, -rise, weight);
            }
        }
    }
    let turn = |(fit, (&normal, &[s, t])): (&Fit, (&DVec3, &[DVec3; 2]))| {
        let Some([by_s, by_t]) = fit.gradient() else { return normal };
        (s + by_s).cross(t + by_t).try_normalize().unwrap_or(normal)
    };
    fits.iter().zip(normals.iter().zip(&frames)).map(turn).collect()
}

impl Fit {
    fn add(&mut self, [s, t]: [DVec3; 2], edge: DVec3, rise: DVec3, weight: f64) {
        let u = DVec2::new(edge.dot(s), edge.dot(t));
        for (sum, product) in self.squares.iter_mut().zip([u.x * u.x, u.x * u.y, u.y * u.y]) {
            *sum += weight * product;
        }
        self.along[0] += rise * (weight * u.x);
        self.along[1] += rise * (weight * u.y);
    }

    /// How the offsets grow along both tangents; nothing where they do not change or too few edges tell.
    fn gradient(&self) -> Option<[DVec3; 2]> {
        let [xx, xy, yy] = self.squares;
        if self.along == [DVec3::ZERO; 2] {
            return None;
        }
        let squares = DMat2::from_cols(DVec2::new(xx, xy), DVec2::new(xy, yy));
        // Edges that all run the same way leave the other way open.
        if squares.determinant() <= 1e-9 * (xx + yy) * (xx + yy) {
            return None;
        }
        let inverse = squares.inverse();
        let row = |k: usize| self.along[0] * inverse.col(0)[k] + self.along[1] * inverse.col(1)[k];
        Some([row(0), row(1)])
    }
}

/// Two unit tangents `s`, `t` with `s × t` the normal; zero where there is none.
fn tangents(normal: DVec3) -> [DVec3; 2] {
    // The axis that is farthest from the normal.
    let [x, y, z] = normal.abs().to_array();
    let axis = if x <= y && x <= z {
        DVec3::X
    } else if y <= z {
        DVec3::Y
    } else {
        DVec3::Z
    };
    let t = normal.cross(axis).normalize_or_zero();
    [t.cross(normal), t]
}
