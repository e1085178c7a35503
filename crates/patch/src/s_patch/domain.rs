//! The domain of a patch: a regular polygon with Wachspress's coordinates, exact to second derivatives.
//!
//! E. Wachspress, *A rational finite element basis* (1975). Each weight is the product of the distances from all sides
//! but the two at its corner. The usual form divides by distances and fails on the boundary; the factor by which it
//! differs is the same for all corners of a regular polygon. (Mean value coordinates are not differentiable at corners.)

use crate::jet::Jet;
use glam::DVec2;
use std::f64::consts::{PI, TAU};

/// A regular polygon with corners `(cos 2πk/n, sin 2πk/n)`, counter-clockwise; side `i` runs from corner `i` to `i + 1`.
#[derive(Clone, Debug, PartialEq)]
pub struct Domain {
    corners: Vec<DVec2>,
    /// Inward, of unit length.
    normals: Vec<DVec2>,
}

/// How far outside a point may lie and still count as on the boundary: some rounding of whoever wrote it down.
const SLACK: f64 = 1e-9;
/// How far given coordinates may be from those of the point that they name.
const ROUNDING: f64 = 1e-6;

impl Domain {
    /// The polygon with that many corners, at least 3.
    #[must_use]
    pub fn new(sides: usize) -> Self {
        let at = |turns: f64| DVec2::new(libm::cos(TAU * turns), libm::sin(TAU * turns));
        let n = sides.max(3);
        Self {
            corners: (0..n).map(|k| at(k as f64 / n as f64)).collect(),
            normals: (0..n).map(|k| -at((k as f64 + 0.5) / n as f64)).collect(),
        }
    }

    /// How many sides and corners.
    #[must_use]
    pub fn sides(&self) -> usize {
        self.corners.len()
    }

    /// The corners in order.
    #[must_use]
    pub fn corners(&self) -> &[DVec2] {
        &self.corners
    }

    /// The point at `u` in [0, 1] on a side; sides count cyclically.
    #[must_use]
    pub fn on_side(&self, side: usize, u: f64) -> DVec2 {
        let n = self.sides();
        self.corners[side % n] * (1.0 - u) + self.corners[(side + 1) % n] * u
    }

    /// The minus cosine of the angle between two corners: the `c` of equation (2).
    pub(super) fn c(&self) -> f64 {
        -libm::cos(2.0 * PI / self.sides() as f64)
    }

    /// Whether a point lies on the closed polygon, or beside it by no more than rounding.
    #[must_use]
    pub fn contains(&self, point: DVec2) -> bool {
        // A comparison with no number is false, so such points are outside.
        self.corners.iter().zip(&self.normals).all(|(corner, normal)| normal.dot(point - *corner) >= -SLACK)
    }

    /// The coordinates of a point: one number for each corner, all non-negative on the polygon, with sum 1.
    #[must_use]
    pub fn coordinates(&self, point: DVec2) -> Vec<f64> {
        self.jets(point).into_iter().map(|jet| jet.value).collect()
    }

    /// The point that has these coordinates; none if no point of the polygon has, up to rounding to six digits. Most lists of
    /// positive numbers with sum 1 are coordinates of no point when there are more than three corners.
    #[must_use]
    pub fn point_with(&self, coordinates: &[f64]) -> Option<DVec2> {
        if coordinates.len() != self.sides() {
            return None;
        }
        let point: DVec2 = self.corners.iter().zip(coordinates).map(|(corner, share)| *corner * *share).sum();
        let own = self.contains(point).then(|| self.coordinates(point))?;
        let is_same = own.iter().zip(coordinates).all(|(own, given)| (own - given).abs() <= ROUNDING);
        is_same.then_some(point)
    }

    /// The coordinates with their derivatives by x and y.
    pub(super) fn jets(&self, point: DVec2) -> Vec<Jet> {
        let n = self.sides();
        let distance = |j: usize| {
            let normal = self.normals[j];
            Jet::linear(normal.dot(point - self.corners[j]), normal.x, normal.y)
        };
        // Products of the first and of the last distances; corner k leaves out the sides k - 1 and k.
        let (mut first, mut last) = (vec![Jet::ONE; n + 1], vec![Jet::ONE; n + 1]);
        for j in 0..n {
            first[j + 1] = first[j] * distance(j);
            last[n - 1 - j] = last[n - j] * distance(n - 1 - j);
        }
        let inner = (1..n - 1).fold(Jet::ONE, |product, j| product * distance(j));
        let weight = |k: usize| if k == 0 { inner } else { first[k - 1] * last[k + 1] };
        let weights: Vec<Jet> = (0..n).map(weight).collect();
        let sum = weights.iter().fold(Jet::ZERO, |sum, weight| sum + *weight);
        weights.into_iter().map(|weight| weight / sum).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn places(domain: &Domain) -> Vec<DVec2> {
        let inside = [(0.0, 0.0), (0.2, 0.1), (-0.1, 0.3), (0.05, -0.4)].map(|(x, y)| DVec2::new(x, y));
        let sides = (0..domain.sides()).flat_map(|i| [0.0, 0.125, 0.5, 0.75].map(|u| (i, u)));
        inside.into_iter().chain(sides.map(|(i, u)| domain.on_side(i, u))).collect()
    }

    #[test]
    fn coordinates_are_what_they_should_be() {
        for n in 3..=12 {
            let domain = Domain::new(n);
            for place in places(&domain) {
                let values = domain.coordinates(place);
                assert!((values.iter().sum::<f64>() - 1.0).abs() < 1e-15 * n as f64);
                assert!(values.iter().all(|&value| value >= -1e-15));
                let back: DVec2 =
                    values.iter().zip(&domain.corners).map(|(value, corner)| *corner * *value).sum();
                assert!(back.distance(place) < 1e-14, "{n} sides at {place}: {back}");
            }
            for i in 0..n {
                let values = domain.coordinates(domain.on_side(i, 0.3));
                let exact = |k: usize| {
                    if k == i {
                        0.7
                    } else if k == (i + 1) % n {
                        0.3
                    } else {
                        0.0
                    }
                };
                assert!(
                    (0..n).all(|k| (values[k] - exact(k)).abs() < 1e-14),
                    "{n} sides, side {i}: {values:?}"
                );
            }
        }
    }

    #[test]
    fn derivatives_agree_with_differences() {
        let step = 1e-5;
        for n in 3..=9 {
            let domain = Domain::new(n);
            for place in [DVec2::new(0.11, 0.23), domain.on_side(1, 0.4), domain.corners[2]] {
                let at = |x: f64, y: f64| domain.jets(place + DVec2::new(x, y) * step);
                let (here, right, left, up, down) =
                    (at(0., 0.), at(1., 0.), at(-1., 0.), at(0., 1.), at(0., -1.));
                for k in 0..n {
                    let half = 0.5 / step;
                    let jet = here[k];
                    let pairs = [
                        (jet.a, (right[k].value - left[k].value) * half),
                        (jet.b, (up[k].value - down[k].value) * half),
                        (jet.aa, (right[k].a - left[k].a) * half),
                        (jet.ab, (up[k].a - down[k].a) * half),
                        (jet.ab, (right[k].b - left[k].b) * half),
                        (jet.bb, (up[k].b - down[k].b) * half),
                    ];
                    for (exact, difference) in pairs {
                        assert!(
                            (exact - difference).abs() < 1e-7 * (1.0 + exact.abs()),
                            "{n} sides, {k} at {place}: {exact} {difference}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn points_and_coordinates_name_each_other() {
        let domain = Domain::new(5);
        for place in places(&domain) {
            let rounded: Vec<f64> =
                domain.coordinates(place).iter().map(|value| (value * 1e7).round() * 1e-7).collect();
            assert!(domain.point_with(&rounded).unwrap().distance(place) < 1e-6);
        }
        assert_eq!(domain.point_with(&[0.5, 0.0, 0.5, 0.0, 0.0]), None, "no point of the polygon");
        assert_eq!(domain.point_with(&[0.5, 0.5]), None);
        assert_eq!(domain.point_with(&[f64::NAN, 0.5, 0.5, 0.0, 0.0]), None);
        assert_eq!(domain.point_with(&[2.0, -1.0, 0.0, 0.0, 0.0]), None);
        assert!(domain.contains(DVec2::new(-0.8090169943749474, 0.5877852522924732)));
        assert!(!domain.contains(DVec2::new(0.9, 0.3)) && !domain.contains(DVec2::new(f64::NAN, 0.0)));
    }
}
