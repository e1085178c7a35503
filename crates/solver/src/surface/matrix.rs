//! Gauss-Newton's matrix and right-hand side for whatever is minimised: the assembled plate, and what is added to it
//! without being assembled.

use crate::bending::Bending;
use crate::constraint::Planes;
use crate::fits::{Fits, PER_SPHERE};
use crate::objective::Goals;
use crate::operator::{FIXED, SymmetricMatrix, Unknowns};
use crate::precondition::Preconditioner;
use crate::rings::Rings;

/// Arrays over the nodes, kept between products.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    bends: Vec<[f64; 3]>,
    prices: Vec<[f64; 3]>,
}

impl Scratch {
    fn resize(&mut self, nodes: usize) {
        self.bends.resize(nodes, [0.0; 3]);
        self.prices.resize(nodes, [0.0; 3]);
    }
}

/// The matrix at the newest fit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matrix<'a> {
    pub(super) goals: &'a Goals,
    pub(super) rings: &'a Rings,
    pub(super) fits: &'a Fits,
    pub(super) unknowns: &'a Unknowns,
    pub(super) plate: &'a SymmetricMatrix,
}

impl Matrix<'_> {
    /// `y = A x`
    pub(super) fn multiply(&self, x: &[f64], y: &mut [f64], scratch: &mut Scratch) {
        self.plate.multiply(x, y);
        if let Some(variation) = &self.fits.variation {
            scratch.resize(self.rings.len());
            let rows = bending(self.rings, self.fits, self.unknowns, true);
            rows.apply(x, &mut scratch.bends);
            // The rows carry the root of the area, curvature does not.
            self.take_roots(&mut scratch.bends);
            variation.differences(&scratch.bends, &mut scratch.prices);
            self.take_roots(&mut scratch.prices);
            rows.add_transpose(&scratch.prices, y);
            if let Some(skin) = &self.goals.skin {
                let tension = variation.energy * PER_SPHERE;
                skin.add_product(&self.fits.positions, self.unknowns, tension, x, y);
            }
        }
        if let Some(film) = &self.goals.film {
            let factor = 1.0 / (self.goals.radius * self.goals.radius);
            film.add_product(&self.fits.positions, self.unknowns, factor, x, y);
        }
    }

    /// `z = P⁻¹ r`
    pub(super) fn precondition(&self, preconditioner: &mut Preconditioner, r: &[f64], z: &mut [f64]) {
        if self.goals.is_plate() {
            return preconditioner.apply(r, z);
        }
        preconditioner.apply_by_order(r, z, |unknown| {
            let price = self.goals.price(self.unknowns.nodes[unknown] as usize);
            (price.order, 1.0 / self.scale(price.order))
        });
    }

    /// About what the matrix is, in units of the Laplacian solves that stand for it.
    fn scale(&self, order: u8) -> f64 {
        match (order, &self.fits.variation) {
            (1, _) => 0.5 / (self.goals.radius * self.goals.radius),
            (3, Some(variation)) => variation.scale.max(f64::MIN_POSITIVE),
            _ => 1.0,
        }
    }

    fn take_roots(&self, values: &mut [[f64; 3]]) {
        for (value, node) in values.iter_mut().zip(&self.fits.nodes) {
            let inverse = if node.area > 0.0 { 1.0 / node.area.sqrt() } else { 0.0 };
            *value = value.map(|value| value * inverse);
        }
    }
}

/// Right-hand side `-g/2` per unknown: the exact gradient along the normals, and the frozen one of neutral nodes.
pub(super) fn slopes(
    goals: &Goals,
    rings: &Rings,
    fits: &Fits,
    unknowns: &Unknowns,
    rhs: &mut Vec<f64>,
    scratch: &mut Scratch,
) {
    rhs.clear();
    let slope = |&node: &u32| -0.5 * fits.gradient[node as usize].dot(fits.nodes[node as usize].normal);
    rhs.extend(unknowns.nodes.iter().map(slope));
    if goals.has_neutral {
        scratch.resize(rings.len());
        for (node, price) in scratch.prices.iter_mut().enumerate() {
            let fit = &fits.nodes[node];
            let factor = -goals.price(node).neutral * fit.area.sqrt();
            *price = fit.l.map(|l| factor * l);
        }
        bending(rings, fits, unknowns, false).add_transpose(&scratch.prices, rhs);
        for (plane, clamp) in goals.planes.iter().flat_map(Planes::list).zip(&fits.clamps) {
            let node = plane.node as usize;
            let weight = goals.price(node).neutral;
            if weight > 0.0 {
                clamp.pull(weight, rings.senses(node), |place, value| {
                    let at = if place == 0 { plane.node } else { rings.ring(node)[place - 1] };
                    if unknowns.index[at as usize] != FIXED {
                        rhs[unknowns.index[at as usize] as usize] += value;
                    }
                });
            }
        }
    }
}

fn bending<'a>(rings: &'a Rings, fits: &'a Fits, unknowns: &'a Unknowns, has_squares: bool) -> Bending<'a> {
    Bending { rings, fits, unknowns, has_squares }
}
