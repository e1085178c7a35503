//! The membrane: the area of the triangles, like a soap film.
//!
//! Source: Pinkall and Polthier 1993. The gradient of the area is exact; its matrix along the normals is half the
//! cotangent Laplacian, `area(p + α n) ≈ area + g·α + αᵀ (L / 2) α`, which leaves out the curvature term and is positive
//! semi-definite with floored weights. A film can be held by curves, not by single points: those it leaves on spikes of
//! no area, as a soap film would.

use std::sync::Arc;

use glam::DVec3;

use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

/// Cotangents are kept within these, so that a needle can neither turn the matrix over nor blow it up.
const FLOOR: f64 = 1e-3;
const CAP: f64 = 1e4;

/// The triangles of a film.
#[derive(Clone, Debug)]
pub(crate) struct Film {
    triangles: Arc<[[u32; 3]]>,
    /// Per triangle the senses of its corners against the first one's.
    senses: Arc<[[f64; 3]]>,
}

impl Film {
    pub(crate) fn new(rings: &Rings, is_film: impl Fn(usize) -> bool) -> Self {
        let chosen = rings.triangles().iter().enumerate().filter(|&(index, _)| is_film(index));
        let triangles: Arc<[[u32; 3]]> = chosen.map(|(_, nodes)| *nodes).collect();
        let sense = |from: u32, to: u32| {
            let place = rings.ring(from as usize).iter().position(|&far| far == to);
            place.map_or(1.0, |place| rings.senses(from as usize)[place])
        };
        let senses = triangles.iter().map(|&[a, b, c]| [1.0, sense(a, b), sense(a, c)]).collect();
        Self { triangles, senses }
    }

    /// The area.
    pub(crate) fn area(&self, positions: &[DVec3]) -> f64 {
        let area = |nodes: &[u32; 3]| {
            let [a, b, c] = nodes.map(|node| positions[node as usize]);
            0.5 * (b - a).cross(c - a).length()
        };
        self.triangles.iter().map(area).sum()
    }

    /// Adds `factor` times the derivative of the area.
    pub(crate) fn add_gradient(&self, positions: &[DVec3], factor: f64, gradient: &mut [DVec3]) {
        for nodes in &*self.triangles {
            let corners = nodes.map(|node| positions[node as usize]);
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let Some(unit) = normal.try_normalize() else { continue };
            for corner in 0..3 {
                let opposite = corners[(corner + 2) % 3] - corners[(corner + 1) % 3];
                gradient[nodes[corner] as usize] += unit.cross(opposite) * (0.5 * factor);
            }
        }
    }

    /// `y += factor (L / 2) x` over the unknowns.
    pub(crate) fn add_product(
        &self,
        positions: &[DVec3],
        unknowns: &Unknowns,
        factor: f64,
        x: &[f64],
        y: &mut [f64],
    ) {
        for (nodes, senses) in self.triangles.iter().zip(&*self.senses) {
            let corners = nodes.map(|node| positions[node as usize]);
            let index = nodes.map(|node| unknowns.index[node as usize]);
            let double_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).length();
            let value = |corner: usize| match index[corner] {
                FIXED => 0.0,
                unknown => senses[corner] * x[unknown as usize],
            };
            for corner in 0..3 {
                let (b, c) = ((corner + 1) % 3, (corner + 2) % 3);
                let cosine = (corners[b] - corners[corner]).dot(corners[c] - corners[corner]);
                #[expect(
                    clippy::manual_clamp,
                    reason = "max and min also turn NaN into a number, clamp does not"
                )]
                let cotangent = (cosine / double_area).max(FLOOR).min(CAP);
                let flow = 0.25 * factor * cotangent * (value(b) - value(c));
                for (corner, flow) in [(b, flow), (c, -flow)] {
                    if index[corner] != FIXED {
                        y[index[corner] as usize] += senses[corner] * flow;
                    }
                }
            }
        }
    }
}
