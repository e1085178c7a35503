//! What a solver minimises: the choices, and how several of them share one surface.
//!
//! Sources: thesis eq. (4.2) for the thin plate; recipe section 9 for the others. All are made dimensionless, so that
//! regions with different choices can meet; `R` is the radius of the controls.
//!
//! ```text
//! thin plate   E = ∫ (κ₁² + κ₂²) dA
//! fair         area / 4π · ∫ |∇L|² dA + E / 30²
//! neutral      no energy: the gradient of E with geometry frozen
//! membrane     area / R²
//! ```
//!
//! `∫ |∇L|²` falls when a shape grows, and a tube between curves that are not quite circles would swell without bound; its
//! product with the area does not (the scale-invariant functional of Moreton and Séquin, 1992). The small share of plate is
//! there because every sphere and every cylinder is a zero of the first term.
//! A choice is made per triangle. A node on the border of two regions bends at the mean price of its triangles; an edge
//! or a triangle belongs to the region it lies in.

use crate::constraint::Planes;
use crate::energy::fair::Network;
use crate::energy::membrane::Film;
use crate::lanes::Real;
use crate::neighbourhood::Ring;
use crate::quadrature::{Sampling, Shares};
use crate::rings::Rings;

/// Share of the thin plate in `fair`: one over the square of 30 radii (recipe, section 9).
pub(crate) const PLATE_SHARE: f64 = 1.0 / 900.0;

/// What a fair shape minimises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Objective {
    /// `∫ (κ₁² + κ₂²) dA`; of a curve, `∫ κ² ds`.
    #[default]
    ThinPlate,
    /// The variation of curvature, `∫ |∇L|² dA`; of a curve, `∫ κ'² ds`. Spheres, cylinders, circles and lines cost nothing.
    Fair,
    /// `Δ H = 0`, of a curve `κ'' = 0`: the frozen first-order condition of the thin plate. No energy falls on the way.
    Neutral,
    /// The area; of a curve, the length.
    Membrane,
}

/// What every part of a surface minimises.
#[derive(Clone, Debug, PartialEq)]
pub struct Objectives {
    choice: Choice,
    radius: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Choice {
    Uniform(Objective),
    ByTriangle(Vec<Objective>),
}

impl Default for Objectives {
    fn default() -> Self {
        Self::uniform(Objective::ThinPlate, 1.0)
    }
}

impl Objectives {
    /// One for all. `radius` is half the diagonal of the box around the controls; a number that is not positive and
    /// finite counts as 1.
    pub fn uniform(objective: Objective, radius: f64) -> Self {
        // Only the membrane looks at the radius: leave it out of comparisons elsewhere.
        let radius = if objective == Objective::Membrane { checked(radius) } else { 1.0 };
        Self { choice: Choice::Uniform(objective), radius }
    }

    /// One for each triangle of the rings.
    pub fn by_triangle(objectives: Vec<Objective>, radius: f64) -> Self {
        match objectives.first() {
            Some(&first) if objectives.iter().all(|&objective| objective == first) => {
                Self::uniform(first, radius)
            }
            None => Self::default(),
            Some(_) => {
                let radius = if objectives.contains(&Objective::Membrane) { checked(radius) } else { 1.0 };
                Self { choice: Choice::ByTriangle(objectives), radius }
            }
        }
    }

    /// Number of triangles spoken of, if each has its own.
    pub(crate) fn triangles(&self) -> Option<usize> {
        match &self.choice {
            Choice::Uniform(_) => None,
            Choice::ByTriangle(objectives) => Some(objectives.len()),
        }
    }

    /// The radius, where all else is as in `other`.
    pub(crate) fn only_radius(&self, other: &Self) -> Option<f64> {
        (self.choice == other.choice && *self != Self::default()).then_some(self.radius)
    }

    fn of(&self, triangle: usize) -> Objective {
        match &self.choice {
            Choice::Uniform(objective) => *objective,
            Choice::ByTriangle(objectives) => objectives[triangle],
        }
    }
}

fn checked(radius: f64) -> f64 {
    if radius > 0.0 && radius.is_finite() { radius } else { 1.0 }
}

/// What bending costs at a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Price {
    /// Weight of its thin-plate energy.
    pub(crate) plate: f64,
    /// Weight of the frozen gradient.
    pub(crate) neutral: f64,
    /// Weight of the variation of curvature.
    pub(crate) variation: f64,
    /// Laplacian solves that stand for its part of the matrix: 1, 2 or 3.
    pub(crate) order: u8,
}

impl Price {
    pub(crate) const PLATE: Self = Self { plate: 1.0, neutral: 0.0, variation: 0.0, order: 2 };

    /// Weight of its rows in the matrix.
    pub(crate) fn rows(&self) -> f64 {
        self.plate + self.neutral
    }
}

/// The objectives worked out for one connectivity.
#[derive(Clone, Debug)]
pub(crate) struct Goals {
    /// Per node; none where all of it is thin plate.
    prices: Option<Vec<Price>>,
    /// Whose triangles are whose; nothing where every corner has one third.
    shares: Option<Shares>,
    /// Where curvature variation counts: the edges, and the triangles between them.
    pub(crate) network: Option<Network>,
    pub(crate) skin: Option<Film>,
    pub(crate) film: Option<Film>,
    /// Whether any node is neutral, so that no energy falls.
    pub(crate) has_neutral: bool,
    pub(crate) radius: f64,
    /// Tangent planes that are prescribed.
    pub(crate) planes: Option<Planes>,
}

impl Default for Goals {
    /// Thin plate everywhere.
    fn default() -> Self {
        Self {
            prices: None,
            shares: None,
            network: None,
            skin: None,
            film: None,
            has_neutral: false,
            radius: 1.0,
            planes: None,
        }
    }
}

impl Goals {
    /// The objectives name as many triangles as there are; `fixed` has an entry for each node.
    pub(crate) fn new(
        (rings, fixed): (&Rings, &[bool]),
        objectives: &Objectives,
        sampling: Sampling,
        planes: Option<Planes>,
    ) -> Self {
        let has_plane = |node: usize| planes.as_ref().is_some_and(|planes| planes.has(node));
        let shares = Shares::new(rings, fixed, sampling, has_plane);
        if *objectives == Objectives::default() {
            return Self { shares, planes, ..Self::default() };
        }
        let triangles = rings.triangles();
        let mut counts = vec![[0_u32; 4]; rings.len()];
        let mut present = [false; 4];
        for (triangle, nodes) in triangles.iter().enumerate() {
            let kind = objectives.of(triangle) as usize;
            present[kind] = true;
            nodes.iter().for_each(|&node| counts[node as usize][kind] += 1);
        }
        let is = |triangle: usize, objective: Objective| objectives.of(triangle) == objective;
        let fair = present[Objective::Fair as usize];
        let membrane = present[Objective::Membrane as usize];
        Self {
            prices: Some(counts.into_iter().map(price).collect()),
            shares,
            network: fair.then(|| Network::new(rings, |t| is(t, Objective::Fair), has_plane)),
            skin: fair.then(|| Film::new(rings, |t| is(t, Objective::Fair))),
            film: membrane.then(|| Film::new(rings, |t| is(t, Objective::Membrane))),
            has_neutral: present[Objective::Neutral as usize],
            radius: objectives.radius,
            planes,
        }
    }

    /// What bending costs at a node.
    #[inline(always)]
    pub(crate) fn price(&self, node: usize) -> Price {
        self.prices.as_ref().map_or(Price::PLATE, |prices| prices[node])
    }

    /// Tells a ring which parts of its triangles are its node's.
    #[inline(always)]
    pub(crate) fn share<T: Real>(&self, rings: &Rings, nodes: [u32; 2], ring: &mut Ring<T>) {
        if let Some(shares) = &self.shares {
            shares.load(rings, nodes, ring);
        }
    }

    /// The place of a node's prescribed plane, if it has one.
    #[inline]
    pub(crate) fn plane(&self, node: usize) -> Option<usize> {
        self.planes.as_ref().and_then(|planes| planes.place(node))
    }

    /// Whether every node is plain thin plate.
    #[inline(always)]
    pub(crate) fn is_plate(&self) -> bool {
        self.prices.is_none()
    }
}

/// The price of a node from the numbers of its triangles of each kind.
fn price(counts: [u32; 4]) -> Price {
    let total = f64::from(counts.iter().sum::<u32>().max(1));
    let share = |objective: Objective| f64::from(counts[objective as usize]) / total;
    let (fair, membrane) = (share(Objective::Fair), share(Objective::Membrane));
    // Free nodes lie within one region, so their order is that of the region.
    let order = match (fair > 0.0, membrane > 0.0) {
        (true, _) => 3,
        (false, true) => 1,
        (false, false) => 2,
    };
    Price {
        plate: share(Objective::ThinPlate) + PLATE_SHARE * fair,
        neutral: share(Objective::Neutral),
        variation: fair,
        order,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn one_choice_for_all_is_not_told_from_the_same_choice_for_each() {
        let each = Objectives::by_triangle(vec![Objective::Fair; 7], 2.0);
        assert_eq!(each, Objectives::uniform(Objective::Fair, 3.0));
        assert_eq!(Objectives::uniform(Objective::ThinPlate, 5.0), Objectives::default());
        assert_eq!(
            Objectives::uniform(Objective::Membrane, f64::NAN),
            Objectives::uniform(Objective::Membrane, 1.0)
        );
    }

    #[test]
    fn nodes_between_regions_pay_the_mean_price() {
        let disc = workload::disc(2);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        let left = |t: &[u32; 3]| t.iter().map(|&node| disc.positions[node as usize].x).sum::<f64>() < 0.0;
        let choice = |t| if left(t) { Objective::Neutral } else { Objective::ThinPlate };
        let goals = Goals::new(
            (&rings, &disc.fixed),
            &Objectives::by_triangle(disc.triangles.iter().map(choice).collect(), 1.0),
            Sampling::Everywhere,
            None,
        );
        let centre = goals.price(0);
        assert_eq!((centre.plate, centre.neutral, centre.rows()), (0.5, 0.5, 1.0));
        assert!(goals.has_neutral && !goals.is_plate() && goals.network.is_none());
    }
}
