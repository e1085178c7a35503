//! What can be said of every node's fit, for comparing with recorded figures. Nothing here is needed for a step.
//!
//! Every node is fitted anew, with care and by itself, so this takes longer than the fit of a step.

use super::SurfaceSolver;
use crate::barrier;
use crate::dense::{self, Matrix5};
use crate::fit::{self, CarefulFit, Kind};
use crate::neighbourhood::Ring;

/// Figures of one node; zero where nothing could be fitted.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NodeFigures {
    /// Sum of the angles between neighbouring edges, in radians, before they are scaled to fill the plane.
    pub angle_sum: f64,
    /// One third of the fan in the parameter plane, in squared lengths.
    pub area: f64,
    /// `L11² + 2 L12² + L22²`, per squared length.
    pub density: f64,
    /// What the Jacobian barrier adds to the energy; 0 wherever the mesh resolves the shape.
    pub barrier: f64,
    /// Whether no direction of the fit was faded out by the spectral filter.
    pub is_full_basis: bool,
    /// Condition of the normal matrix by Frobenius norms, in the basis `u, v, u²/2, uv, v²/2` of coordinates divided by
    /// the mean chord, with the neighbour of the least index on the `u` axis; infinite when the matrix is singular.
    pub condition: f64,
}

impl SurfaceSolver {
    /// Figures of every node in the newest fit.
    pub fn figures(&self) -> Vec<NodeFigures> {
        let mut ring = Ring::<f64>::default();
        let nodes = 0..u32::try_from(self.rings.len()).unwrap_or(u32::MAX);
        nodes
            .map(|node| {
                ring.load(&self.rings, &self.fits.positions, [node; 2]);
                let careful = fit::fit_carefully(&mut ring);
                self.figures_of(node as usize, &ring, &careful)
            })
            .collect()
    }

    fn figures_of(&self, node: usize, ring: &Ring<f64>, careful: &CarefulFit) -> NodeFigures {
        if !careful.is_fitted() {
            return NodeFigures { barrier: self.fits.energies[node], ..NodeFigures::default() };
        }
        let fit = &careful.fit;
        NodeFigures {
            angle_sum: ring.total,
            area: fit.area,
            density: fit.l.iter().map(|l| l * l).sum(),
            barrier: barrier::value(fit.jacobian),
            is_full_basis: careful.kind == Kind::Plain || is_unfiltered(ring),
            condition: condition(ring, self.rings.ring(node)),
        }
    }
}

/// Number of functions in the basis.
fn size(ring: &Ring<f64>) -> usize {
    if ring.is_boundary { 3 } else { 5 }
}

/// Whether every eigenvalue lies where the filter is the plain inverse.
fn is_unfiltered(ring: &Ring<f64>) -> bool {
    let (m, _) = fit::careful_moments(ring);
    let mut values = dense::eigen(&m).values;
    values.sort_unstable_by(|a, b| b.total_cmp(a));
    values[..size(ring)].iter().all(|&value| value >= fit::FILTER)
}

fn condition(ring: &Ring<f64>, neighbours: &[u32]) -> f64 {
    let least = (0..ring.degree).min_by_key(|&j| neighbours[j]);
    // A boundary ring lies on the u axis already.
    let (cos, sin) = match least {
        Some(j) if !ring.is_boundary => (ring.spokes[j].cos, ring.spokes[j].sin),
        _ => (1.0, 0.0),
    };
    let mut m = Matrix5::<f64>::default();
    for j in 0..ring.degree {
        let (x, y) = ring.uv(j);
        let (u, v) = (x * cos + y * sin, y * cos - x * sin);
        let row = [u, v, 0.5 * u * u, u * v, 0.5 * v * v];
        for i in 0..size(ring) {
            for k in 0..size(ring) {
                m[i][k] += row[i] * row[k];
            }
        }
    }
    let norm = |m: &Matrix5<f64>| m.iter().flatten().map(|x| x * x).sum::<f64>().sqrt();
    let (inverse, is_regular) =
        if ring.is_boundary { dense::invert::<f64, 3>(&m) } else { dense::invert::<f64, 5>(&m) };
    if is_regular { norm(&m) * norm(&inverse) } else { f64::INFINITY }
}

#[cfg(test)]
mod tests {
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn figures_add_up_to_the_energy() {
        let (mut solver, positions) = workload::raised_disc(6, 0.4).unwrap();
        solver.fit_all(&positions);
        let sum: f64 = solver.figures().iter().map(|f| f.area * f.density + f.barrier).sum();
        assert!((sum / solver.energy() - 1.0).abs() < 1e-13);
    }

    #[test]
    fn a_regular_hexagon_is_well_conditioned_and_flat() {
        let disc = workload::disc(3);
        let mut solver = disc.solver().unwrap();
        solver.fit_all(&disc.positions);
        let centre = solver.figures()[0];
        assert!((centre.angle_sum - 2.0 * std::f64::consts::PI).abs() < 1e-14);
        assert!(centre.is_full_basis && centre.density < 1e-20 && centre.barrier == 0.0);
        // The unit hexagon has area 3√3/2, a third of it is the node's.
        assert!((centre.area - 0.5 * 3.0_f64.sqrt() / 9.0).abs() < 1e-14);
        // By hand: M has the eigenvalues 3, 3, 3/4, 3/4 and 3/8.
        let values =
            |inverse: bool| [3.0, 3.0, 0.75, 0.75, 0.375].map(|x: f64| if inverse { 1.0 / x } else { x });
        let norm = |inverse| values(inverse).iter().map(|x| x * x).sum::<f64>().sqrt();
        assert!((centre.condition - norm(true) * norm(false)).abs() < 1e-12, "{}", centre.condition);
    }
}
