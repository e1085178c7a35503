//! Positions from nothing but fixed nodes: the soap film or the plate a new skin starts from.
//!
//! Sign and kind: solves `L x = 0` (membrane) or minimises `Σ |(L x)_i|² / m_i` over the inner nodes (plate) with the
//! Laplacian of [`crate::Weights`]; linear, so it needs no good start. Parts without a fixed node stay as they are.

use glam::DVec3;

use crate::cg::{self, Limit, Workspace};
use crate::component::Components;
use crate::error::{SolverError, check_length, check_positions};
use crate::laplacian::{Acting, Laplacian, Weights};
use crate::operator::{FIXED, Unknowns};
use crate::rings::Rings;

/// What spans the hole.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Fill {
    /// A membrane: exact, one factorisation, creased at fixed curves.
    #[default]
    Membrane,
    /// A plate: smooth across fixed curves; it may overshoot.
    Plate,
}

/// The plate is a start, not a result: this is enough to look smooth.
const PLATE: Limit = Limit { iterations: 100, tolerance: 1e-4 };

/// Places the free nodes between the fixed ones.
///
/// Cotangent weights are taken from the positions as they come in; use uniform ones when those mean nothing.
///
/// ```
/// use ductile_solver::{Fill, Rings, Weights, fill, workload};
/// let disc = workload::disc(3);
/// let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
/// let mut positions = disc.positions.clone();
/// positions[0].z = 1.0;
/// fill(&rings, &disc.fixed, &mut positions, Weights::Uniform, Fill::Membrane).unwrap();
/// assert!(positions[1].z > 0.0 && positions[1].z < 1.0);
/// ```
pub fn fill(
    rings: &Rings,
    fixed: &[bool],
    positions: &mut [DVec3],
    weights: Weights,
    fill: Fill,
) -> Result<(), SolverError> {
    check_positions(rings.len(), positions)?;
    check_length(rings.len(), fixed.len())?;
    let components = Components::new(rings);
    let looseness = components.looseness(positions, fixed);
    let is_free = |node: usize| !fixed[node] && looseness.of(&components, node).has_fixed;
    let unknowns = Unknowns::new((0..rings.len()).map(is_free));
    let mut laplacian = Laplacian::new(rings, &unknowns, Acting::OnField)?;
    laplacian.refresh(positions, weights, |_, _| 0.0)?;
    let inverse_mass = match weights {
        Weights::Uniform => {
            (0..rings.len()).map(|node| f64::from(u8::from(!rings.is_boundary(node)))).collect()
        }
        Weights::Cotangent => inverse_masses(rings, positions),
    };
    let mut results = [Vec::new(), Vec::new(), Vec::new()];
    for (coordinate, result) in results.iter_mut().enumerate() {
        let known: Vec<f64> = positions.iter().map(|position| position[coordinate]).collect();
        *result = vec![0.0; unknowns.len()];
        laplacian.add_fixed(rings, &unknowns, &known, result);
        laplacian.solve(result);
        if fill == Fill::Plate {
            Plate { rings, unknowns: &unknowns, inverse_mass: &inverse_mass }.solve(
                &mut laplacian,
                &known,
                result,
            );
        }
    }
    for (unknown, &node) in unknowns.nodes.iter().enumerate() {
        let filled = DVec3::new(results[0][unknown], results[1][unknown], results[2][unknown]);
        if filled.is_finite() {
            positions[node as usize] = filled;
        }
    }
    Ok(())
}

/// One over a third of the triangles around each inner node; zero on the boundary, where the plate has no row.
fn inverse_masses(rings: &Rings, positions: &[DVec3]) -> Vec<f64> {
    let area = |node: usize| {
        let (ring, centre) = (rings.ring(node), positions[node]);
        let corner = |j: usize| positions[ring[j % ring.len()] as usize] - centre;
        (0..ring.len()).map(|j| corner(j).cross(corner(j + 1)).length() / 6.0).sum::<f64>()
    };
    let areas: Vec<f64> = (0..rings.len()).map(area).collect();
    let mean = areas.iter().sum::<f64>() / areas.len().max(1) as f64;
    let inverse = |(node, area): (usize, &f64)| {
        if rings.is_boundary(node) || !(mean > 0.0) { 0.0 } else { 1.0 / area.max(1e-3 * mean) }
    };
    areas.iter().enumerate().map(inverse).collect()
}

/// The biharmonic problem of one coordinate.
struct Plate<'a> {
    rings: &'a Rings,
    unknowns: &'a Unknowns,
    inverse_mass: &'a [f64],
}

impl Plate<'_> {
    /// Improves the membrane in `x`.
    fn solve(&self, laplacian: &mut Laplacian, known: &[f64], x: &mut [f64]) {
        let mut full = vec![0.0; self.rings.len()];
        let mut bent = vec![0.0; self.rings.len()];
        for (node, value) in full.iter_mut().enumerate() {
            *value = if self.unknowns.index[node] == FIXED { known[node] } else { 0.0 };
        }
        let mut rhs = vec![0.0; x.len()];
        self.bend(laplacian, &mut full, &mut bent, &mut rhs);
        for value in &mut rhs {
            *value = -*value;
        }
        let mut preconditioner = laplacian.clone();
        cg::solve(
            |x, y| {
                full.fill(0.0);
                for (&node, &value) in self.unknowns.nodes.iter().zip(x) {
                    full[node as usize] = value;
                }
                self.bend(laplacian, &mut full, &mut bent, y);
            },
            |r, z| {
                z.copy_from_slice(r);
                preconditioner.solve(z);
                for (&node, value) in self.unknowns.nodes.iter().zip(&mut *z) {
                    let inverse = self.inverse_mass[node as usize];
                    *value *= if inverse > 0.0 { 1.0 / inverse } else { 1.0 };
                }
                preconditioner.solve(z);
            },
            &rhs,
            x,
            PLATE,
            &mut Workspace::default(),
        );
    }

    /// `out = (L M⁻¹ L full)` at the unknowns; `full` is used up.
    fn bend(&self, laplacian: &Laplacian, full: &mut [f64], bent: &mut [f64], out: &mut [f64]) {
        laplacian.multiply_all(self.rings, full, bent);
        for (value, &inverse) in bent.iter_mut().zip(self.inverse_mass) {
            *value *= inverse;
        }
        laplacian.multiply_all(self.rings, bent, full);
        for (out, &node) in out.iter_mut().zip(&self.unknowns.nodes) {
            *out = full[node as usize];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A linear function is harmonic and biharmonic for cotangent weights on a flat disc.
    #[test]
    fn linear_functions_are_kept() {
        let disc = workload::disc(5);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        for kind in [Fill::Membrane, Fill::Plate] {
            let mut positions = disc.positions.clone();
            fill(&rings, &disc.fixed, &mut positions, Weights::Cotangent, kind).unwrap();
            let worst =
                positions.iter().zip(&disc.positions).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
            assert!(worst < 1e-9, "{kind:?}: {worst}");
        }
    }

    #[test]
    fn membrane_stays_between_its_fixed_nodes() {
        let mut disc = workload::disc(6);
        disc.positions[0].z = 2.0;
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        fill(&rings, &disc.fixed, &mut disc.positions, Weights::Uniform, Fill::Membrane).unwrap();
        assert!(disc.positions.iter().all(|p| (0.0..=2.0).contains(&p.z)));
    }

    #[test]
    fn plate_is_rounder_than_membrane_at_the_pole() {
        let mut heights = [0.0; 2];
        for (height, kind) in heights.iter_mut().zip([Fill::Membrane, Fill::Plate]) {
            let mut disc = workload::disc(8);
            disc.positions[0].z = 1.0;
            let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
            let mut flat = disc.positions.clone();
            flat[0].z = 0.0;
            let mut positions = disc.positions.clone();
            fill(&rings, &disc.fixed, &mut positions, Weights::Uniform, kind).unwrap();
            *height = positions[1].z;
        }
        assert!(heights[1] > 0.85 && heights[0] < 0.8, "{heights:?}");
    }

    #[test]
    fn parts_without_fixed_nodes_stay() {
        let disc = workload::disc(2);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        let mut positions = disc.positions.clone();
        fill(&rings, &vec![false; positions.len()], &mut positions, Weights::Uniform, Fill::Plate).unwrap();
        assert_eq!(positions, disc.positions);
    }
}
