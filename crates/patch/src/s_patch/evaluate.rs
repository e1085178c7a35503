//! The surface at a point of its domain, equation (1), with exact first and second derivatives.
//!
//! The basis is walked as a tree: labels that begin alike share the product of those factors. Every factor is a jet, so
//! the derivatives are those of the formula itself, with non-negative terms only where the formula has no other.

use super::domain::Domain;
use super::patch::SPatch;
use crate::binomial;
use crate::jet::Jet;
use crate::surface_point::SurfacePoint;
use glam::DVec2;

/// The basis functions of a depth as functions of x and y, in the order of the labels.
pub(super) fn for_each_basis(domain: &Domain, depth: usize, at: DVec2, found: impl FnMut(usize, &Jet)) {
    let coordinates = domain.jets(at);
    let mut powers = Vec::with_capacity(coordinates.len() * (depth + 1));
    for coordinate in coordinates {
        let mut power = Jet::ONE;
        for _ in 0..=depth {
            powers.push(power);
            power = power * coordinate;
        }
    }
    let choices =
        (0..=depth as i64).flat_map(|left| (0..=depth as i64).map(move |s| binomial(left, s))).collect();
    let mut walk = Walk { sides: domain.sides(), depth, powers, choices, rank: 0, found };
    walk.down(0, depth, Jet::ONE);
}

struct Walk<F> {
    sides: usize,
    depth: usize,
    /// Power `s` of coordinate `k` at `k * (depth + 1) + s`.
    powers: Vec<Jet>,
    /// `b(left, s)` at `left * (depth + 1) + s`; their product along a label is the multinomial.
    choices: Vec<f64>,
    rank: usize,
    found: F,
}

impl<F: FnMut(usize, &Jet)> Walk<F> {
    fn down(&mut self, k: usize, left: usize, product: Jet) {
        let wide = self.depth + 1;
        if k + 1 == self.sides {
            (self.found)(self.rank, &(product * self.powers[k * wide + left]));
            self.rank += 1;
            return;
        }
        for s in (0..=left).rev() {
            let factor = self.powers[k * wide + s] * self.choices[left * wide + s];
            self.down(k + 1, left - s, product * factor);
        }
    }
}

impl SPatch {
    /// The surface at a point of the domain, with exact derivatives by x and y; none outside.
    #[must_use]
    pub fn at(&self, domain: &Domain, point: DVec2) -> Option<SurfacePoint> {
        if domain.sides() != self.sides() || !domain.contains(point) {
            return None;
        }
        let mut sum = SurfacePoint::default();
        for_each_basis(domain, self.depth(), point, |rank, basis| {
            let control = self.points()[rank];
            sum.point += control * basis.value;
            sum.dx += control * basis.a;
            sum.dy += control * basis.b;
            sum.dxx += control * basis.aa;
            sum.dxy += control * basis.ab;
            sum.dyy += control * basis.bb;
        });
        Some(sum)
    }

    /// The surface at `steps + 1` even parameters of a side, ends included, in the direction of the side; empty if the
    /// domain is another one.
    #[must_use]
    pub fn along_side(&self, domain: &Domain, side: usize, steps: usize) -> Vec<SurfacePoint> {
        let steps = steps.max(1);
        let places = (0..=steps).map(|step| domain.on_side(side, step as f64 / steps as f64));
        places.filter_map(|place| self.at(domain, place)).collect()
    }
}
