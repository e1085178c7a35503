//! A shape brought to rest by one of the schemes that reference files compare.

use ductile_solver::workload::Workload;
use ductile_solver::{Budget, Frozen, Rings, Settings, SurfaceSolver};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Move below which a shape rests, in units of the mean edge.
const REST: f64 = 1e-9;
/// Steps before giving up.
const MOST_STEPS: u32 = 300;
/// Each linear system is solved to the end, as the schemes are compared by where they rest.
const BUDGET: Budget = Budget { iterations: 1000 };
const TOLERANCE: f64 = 1e-10;
/// Directions over which a height is averaged.
const DIRECTIONS: u32 = 24;

/// How the derivative of the energy is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Scheme {
    /// Exactly: comes to rest on the minimiser.
    Exact,
    /// With something held fixed, for comparison.
    Frozen(Frozen),
}

impl Scheme {
    /// The scheme that a reference file calls so.
    pub(crate) fn named(name: &str) -> Option<Self> {
        let starts = |with| name.starts_with(with);
        if starts("exact-gradient") {
            Some(Self::Exact)
        } else if starts("frozen linearisation") {
            Some(Self::Frozen(Frozen::Literal))
        } else if starts("curvature-neutral") {
            Some(Self::Frozen(Frozen::Neutral))
        } else {
            None
        }
    }

    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Exact => "exact",
            Self::Frozen(Frozen::Literal) => "frozen",
            Self::Frozen(Frozen::Neutral) => "neutral",
        }
    }
}

/// A shape at rest.
#[derive(Debug)]
pub(crate) struct Rested {
    pub(crate) shape: Workload,
    pub(crate) energy: f64,
    pub(crate) steps: u32,
}

/// Lifts one fixed node along z, at once, and steps until nothing moves.
pub(crate) fn rest(shape: &Workload, raised: u32, raise: f64, scheme: Scheme) -> Result<Rested, String> {
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles);
    let mut settings = Settings::default();
    settings.strain_limit = f64::INFINITY;
    settings.predictor_tolerance = TOLERANCE;
    settings.predictor_iterations = BUDGET.iterations;
    settings.step_tolerance = TOLERANCE;
    let rings = rings.map_err(|reason| reason.to_string())?;
    let mut shape = shape.clone();
    let solver = SurfaceSolver::new(rings, shape.fixed.clone(), settings);
    let mut solver = solver.map_err(|reason| reason.to_string())?;
    solver
        .predict(&mut shape.positions, &[(raised, DVec3::Z * raise)])
        .map_err(|reason| reason.to_string())?;
    for steps in 1..=MOST_STEPS {
        let moved = match scheme {
            Scheme::Exact => {
                solver.step(&mut shape.positions, BUDGET).map(|report| report.largest_relative_move)
            }
            Scheme::Frozen(kind) => solver.frozen_step(&mut shape.positions, kind),
        };
        if moved.map_err(|reason| reason.to_string())? < REST {
            solver.fit_all(&shape.positions);
            return Ok(Rested { energy: solver.energy(), shape, steps });
        }
    }
    Err(format!("the shape did not come to rest in {MOST_STEPS} steps"))
}

impl Rested {
    /// Mean height over 24 directions of the polyhedral surface over the circle of that radius around the z axis;
    /// none when it has a direction without a triangle.
    pub(crate) fn mean_height(&self, radius: f64) -> Option<f64> {
        let mut sum = 0.0;
        for direction in 0..DIRECTIONS {
            let (sin, cos) = libm::sincos(TAU * f64::from(direction) / f64::from(DIRECTIONS));
            sum += self.height(DVec2::new(radius * cos, radius * sin))?;
        }
        Some(sum / f64::from(DIRECTIONS))
    }

    /// Height of the first triangle above or below a point of the plane.
    fn height(&self, point: DVec2) -> Option<f64> {
        self.shape.triangles.iter().find_map(|triangle| {
            let [a, b, c] = triangle.map(|node| self.shape.positions[node as usize]);
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            let towards_b = (point - a.truncate()).perp_dot((c - a).truncate()) / area;
            let towards_c = (b - a).truncate().perp_dot(point - a.truncate()) / area;
            let inside = towards_b >= -1e-9 && towards_c >= -1e-9 && towards_b + towards_c <= 1.0 + 1e-9;
            inside.then_some(a.z + towards_b * (b.z - a.z) + towards_c * (c.z - a.z))
        })
    }
}
