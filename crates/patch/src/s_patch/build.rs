//! The control points that ribbons prescribe: boundary curves and boundary panels, equations (2) to (5).
//!
//! Every panel is an affine image of the domain polygon; its two boundary points and one extra point fix it. The extra
//! points are such that the derivative towards the corner before, `X`, lies in the plane of the ribbon:
//!
//! ```text
//! (*)   X(u) = 2c u T(u) + (1 + 2c u (1 - u)) W(u),      c = -cos(2 π / n)
//! ```
//!
//! `T` is the derivative of the boundary curve and `W` the cross derivative. `X` has degree `d + 2`, hence the depth.

use super::domain::Domain;
use super::label::{Labels, TooManyPoints};
use super::masks::MaskError;
use crate::bezier::elevated;
use crate::binomial;
use crate::ribbon::{Ribbon, RibbonLoop};
use glam::DVec3;
use thiserror::Error;

/// How a patch meets what lies around the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Join {
    /// With the tangent planes of the ribbons (G1), at depth `d + 3`.
    #[default]
    Tangent,
    /// With the boundary curves only, at depth `d`.
    Position,
}

impl Join {
    /// The depth of the patch for ribbons of a degree.
    #[must_use]
    pub fn depth(self, degree: usize) -> usize {
        match self {
            Self::Tangent => degree + 3,
            Self::Position => degree,
        }
    }
}

/// Why there is no patch between ribbons.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum BuildError {
    /// There would be too many control points.
    #[error(transparent)]
    TooLarge(#[from] TooManyPoints),
    /// The interior could not be solved for.
    #[error(transparent)]
    Masks(#[from] MaskError),
    /// Two panels ask for different places of one control point: the ribbons are so long or so far from fitting that
    /// rounding alone does not explain it.
    #[error(
        "side {side}: panel {panel} and another one ask for places of a shared control point {gap:e} apart"
    )]
    PanelsDisagree {
        /// The side.
        side: usize,
        /// The panel on it, from 0.
        panel: usize,
        /// How far apart, in model units.
        gap: f64,
    },
}

/// All control points, those in the interior zero.
pub(super) fn outer_points(
    ribbons: &RibbonLoop,
    join: Join,
    labels: &Labels,
) -> Result<Vec<DVec3>, BuildError> {
    let c = Domain::new(ribbons.sides()).c();
    Net { labels, places: vec![None; labels.len()], allowed: ribbons.allowed() }.built(ribbons, join, c)
}

/// Control points as they become known.
struct Net<'a> {
    labels: &'a Labels,
    places: Vec<Option<DVec3>>,
    allowed: f64,
}

impl Net<'_> {
    fn built(mut self, ribbons: &RibbonLoop, join: Join, c: f64) -> Result<Vec<DVec3>, BuildError> {
        // Boundary curves first: where panels repeat their points, the curve is exact.
        for (side, ribbon) in ribbons.ribbons().iter().enumerate() {
            let curve =
                (ribbons.degree()..self.labels.depth()).fold(ribbon.row0.clone(), |q, _| elevated(&q));
            self.put_curve(side, &curve)?;
        }
        if join == Join::Tangent {
            for (side, ribbon) in ribbons.ribbons().iter().enumerate() {
                self.put_panels(side, &legs(ribbon, c), c)?;
            }
        }
        Ok(self.places.into_iter().map(Option::unwrap_or_default).collect())
    }

    fn put(&mut self, side: usize, panel: usize, label: &[u8], place: DVec3) -> Result<(), BuildError> {
        let slot = &mut self.places[self.labels.rank_of(label)];
        match *slot {
            None => *slot = Some(place),
            Some(known) => {
                let gap = known.distance(place);
                if gap > self.allowed || gap.is_nan() {
                    return Err(BuildError::PanelsDisagree { side, panel, gap });
                }
            }
        }
        Ok(())
    }

    fn put_curve(&mut self, side: usize, curve: &[DVec3]) -> Result<(), BuildError> {
        let n = self.labels.sides();
        let mut label = vec![0; n];
        label[side] = as_entry(self.labels.depth());
        for (j, point) in curve.iter().enumerate() {
            self.put(side, j, &label, *point)?;
            if j + 1 < curve.len() {
                label[side] -= 1;
                label[(side + 1) % n] += 1;
            }
        }
        Ok(())
    }

    /// Panel `j` has the base label `(D-1-j) e_i + j e_{i+1}`; equation (5) in closed form.
    fn put_panels(&mut self, side: usize, legs: &[DVec3], c: f64) -> Result<(), BuildError> {
        let (n, depth) = (self.labels.sides(), self.labels.depth());
        let after = (side + 1) % n;
        let theta = core::f64::consts::TAU / n as f64;
        for (j, leg) in legs.iter().enumerate() {
            let mut label = vec![0; n];
            label[side] += as_entry(depth - 1 - j);
            label[after] += as_entry(j);
            let known = |net: &Self, label: &mut [u8], k: usize| {
                label[k] += 1;
                let place = net.places[net.labels.rank_of(label)].unwrap_or_default();
                label[k] -= 1;
                place
            };
            let (here, next) = (known(self, &mut label, side), known(self, &mut label, after));
            let extra = here + *leg;
            for m in 2..n {
                let k = (side + m) % n;
                let angle = m as f64 * theta;
                let a = (1.0 - libm::cos(angle)) / (1.0 + c);
                let b = libm::sin(angle) / libm::sin(theta);
                let carried = extra * (0.5 * (a - b)) + here * (1.0 - a) + next * (0.5 * (a + b));
                let place = if m + 1 == n { extra } else { carried };
                label[k] += 1;
                self.put(side, j, &label, place)?;
                label[k] -= 1;
            }
        }
        Ok(())
    }
}

#[expect(clippy::cast_possible_truncation, reason = "depths of labels are at most 255")]
fn as_entry(value: usize) -> u8 {
    value as u8
}

/// Equation (2) without its first term: what the extra point of panel `j` is away from the boundary point `Q_j`, for `j`
/// from 0 to `d + 2`. The binomials vanish outside their range, which is all that equation (3) says.
fn legs(ribbon: &Ribbon, c: f64) -> Vec<DVec3> {
    let d = ribbon.degree() as i64;
    let at = |list: &[DVec3], m: i64| {
        usize::try_from(m).ok().and_then(|m| list.get(m)).copied().unwrap_or_default()
    };
    let along: Vec<DVec3> = ribbon.row0.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let across: Vec<DVec3> =
        ribbon.row1.iter().zip(&ribbon.row0).map(|(inner, outer)| *inner - *outer).collect();
    let leg = |j: i64| {
        let t = |back: i64| at(&along, j - back) * binomial(d - 1, j - back);
        let w = |back: i64| at(&across, j - back) * binomial(d, j - back);
        let turned = (t(1) + t(2) * 2.0 + t(3)) * (2.0 * c);
        let straight = w(0) + w(1) * (2.0 + 2.0 * c) + w(2);
        (turned + straight) * (d as f64 / ((d + 3) as f64 * binomial(d + 2, j)))
    };
    (0..=d + 2).map(leg).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tests::{random_loop, some_seeds};
    use super::*;
    use crate::basis;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// The build with a constant of the caller's, for what must fail.
    fn built_with(ribbons: &RibbonLoop, c: f64) -> Result<Vec<DVec3>, BuildError> {
        let labels = Labels::new(ribbons.sides(), ribbons.degree() + 3).unwrap();
        Net { labels: &labels, places: vec![None; labels.len()], allowed: ribbons.allowed() }.built(
            ribbons,
            Join::Tangent,
            c,
        )
    }

    #[test]
    fn the_legs_are_the_coefficients_of_the_identity() {
        for (n, d, seed) in some_seeds() {
            let ring = random_loop(n, d, seed);
            let c = Domain::new(n).c();
            for ribbon in ring.ribbons() {
                let legs = legs(ribbon, c);
                assert_eq!(legs.len(), d + 3);
                for u in [0.0, 0.1, 0.5, 0.77, 1.0] {
                    let x: DVec3 = legs.iter().zip(basis(d + 2, u)).map(|(leg, b)| *leg * b).sum();
                    let x = x * (d + 3) as f64;
                    let exact =
                        ribbon.tangent(u) * (2.0 * c * u) + ribbon.cross(u) * (1.0 + 2.0 * c * u * (1.0 - u));
                    assert!(x.distance(exact) < 1e-12, "{n} sides, degree {d}, {u}: {}", x.distance(exact));
                }
            }
        }
    }

    #[test]
    fn panels_are_affine_images_of_the_polygon() {
        for (n, d, seed) in some_seeds() {
            let ring = random_loop(n, d, seed);
            let points = built_with(&ring, Domain::new(n).c()).unwrap();
            let labels = Labels::new(n, d + 3).unwrap();
            let corners = Domain::new(n);
            for side in 0..n {
                for j in 0..d + 3 {
                    let mut label = vec![0; n];
                    label[side] += as_entry(d + 2 - j);
                    label[(side + 1) % n] += as_entry(j);
                    let panel: Vec<DVec3> = (0..n)
                        .map(|k| {
                            label[k] += 1;
                            let point = points[labels.rank(&label).unwrap()];
                            label[k] -= 1;
                            point
                        })
                        .collect();
                    // The best affine image: mean, and the moments with cosine and sine, which are orthogonal.
                    let mean = panel.iter().sum::<DVec3>() / n as f64;
                    let moment = |of: fn(&glam::DVec2) -> f64| {
                        panel.iter().zip(corners.corners()).map(|(p, v)| *p * of(v)).sum::<DVec3>() * 2.0
                            / n as f64
                    };
                    let (mx, my) = (moment(|v| v.x), moment(|v| v.y));
                    for (p, v) in panel.iter().zip(corners.corners()) {
                        let off = p.distance(mean + mx * v.x + my * v.y);
                        assert!(off < 1e-12, "{n} sides, degree {d}, side {side}, panel {j}: {off:e}");
                    }
                }
            }
        }
    }

    #[test]
    fn the_wrong_sign_of_the_cosine_is_found() {
        for n in [3, 5, 6, 8] {
            let ring = random_loop(n, 3, 11);
            let found = built_with(&ring, -Domain::new(n).c());
            assert!(
                matches!(found, Err(BuildError::PanelsDisagree { gap, .. }) if gap > 0.05),
                "{n}: {found:?}"
            );
        }
    }

    #[test]
    fn twists_that_disagree_are_not_overwritten() {
        let good = random_loop(5, 3, 4);
        let mut ribbons = good.ribbons().to_vec();
        ribbons[0].row1[1] += DVec3::Z * 0.05;
        let found = RibbonLoop::new(&ribbons);
        let Err(crate::RibbonError::Incompatible {
            side: 0, row: 1, column: 1, other_side: 4, residual, ..
        }) = found
        else {
            panic!("{found:?}")
        };
        assert!((residual - 0.05).abs() < 1e-12);
        // Even if nobody had looked at the ribbons, the shared control point would tell.
        let unchecked = crate::ribbon::unchecked_loop(&ribbons);
        assert!(matches!(
            built_with(&unchecked, Domain::new(5).c()),
            Err(BuildError::PanelsDisagree { gap, .. }) if gap > 1e-3
        ));
    }
}
