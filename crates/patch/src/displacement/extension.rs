//! Displacements that vary along a curve, carried smoothly off it.
//!
//! Source: the recipe, section 10. The harmonic extension has a kink across the curve; the biharmonic one, which
//! minimises `Σ (L x)_i² / M_i` with the values of the curve fixed and `M` the areas at the vertices, has none. On the
//! border nothing is asked of it: the blend vanishes there.

use super::error::DisplacementError;
use super::green::Numbering;
use super::laplacian::Stiffness;
use ductile_solver::SymmetricFactor;
use glam::DVec3;

/// The factor of `L M⁻¹ L` off a curve, and what ties it to the curve.
#[derive(Clone, Debug)]
pub(super) struct Extension {
    numbering: Numbering,
    factor: SymmetricFactor,
    /// Unknown, place in the curve, entry.
    ties: Vec<(usize, usize, f64)>,
}

impl Extension {
    /// Factorises for a curve; vertices that no edges join to it get nothing.
    pub(super) fn new(stiffness: &Stiffness, curve: &[usize]) -> Result<Self, DisplacementError> {
        let count = stiffness.areas.len();
        let rows = rows(stiffness);
        let is_reached = reached(&rows, curve);
        let mut place = vec![None; count];
        for (at, &vertex) in curve.iter().enumerate() {
            place[vertex] = Some(at);
        }
        let numbering = Numbering::new((0..count).map(|v| is_reached[v] && place[v].is_none()));
        let (mut entries, mut ties) = (Vec::new(), Vec::new());
        for row in (0..count).filter(|&row| is_reached[row]) {
            let inverse_area = 1.0 / stiffness.areas[row];
            for (at, &(a, x)) in rows[row].iter().enumerate() {
                for &(b, y) in &rows[row][at..] {
                    let value = x * y * inverse_area;
                    match (numbering.get(a), numbering.get(b)) {
                        (Some(a), Some(b)) => entries.push((a, b, value)),
                        (Some(n), None) => ties.extend(place[b].map(|p| (n, p, value))),
                        (None, Some(n)) => ties.extend(place[a].map(|p| (n, p, value))),
                        (None, None) => {}
                    }
                }
            }
        }
        let first = curve.first().copied().unwrap_or(0);
        let factor = SymmetricFactor::new(numbering.count, &entries)
            .map_err(|_| DisplacementError::Unsolvable(first))?;
        Ok(Self { numbering, factor, ties })
    }

    /// Carries one displacement per vertex of the curve to all vertices.
    pub(super) fn spread(
        &mut self,
        curve: &[usize],
        displacements: &[DVec3],
    ) -> Result<Vec<DVec3>, DisplacementError> {
        let mut field = vec![DVec3::ZERO; self.numbering.of.len()];
        for axis in 0..3 {
            let mut values = vec![0.0; self.numbering.count];
            for &(unknown, at, entry) in &self.ties {
                values[unknown] -= entry * displacements[at][axis];
            }
            self.factor.solve(&mut values);
            for (vertex, value) in self.numbering.spread(&values, 0.0).into_iter().enumerate() {
                if !value.is_finite() {
                    return Err(DisplacementError::Unsolvable(vertex));
                }
                field[vertex][axis] = value;
            }
        }
        for (&vertex, &displacement) in curve.iter().zip(displacements) {
            field[vertex] = displacement;
        }
        Ok(field)
    }
}

/// The rows of the Laplacian, entries of one place summed.
fn rows(stiffness: &Stiffness) -> Vec<Vec<(usize, f64)>> {
    let mut rows: Vec<Vec<(usize, f64)>> = vec![Vec::new(); stiffness.areas.len()];
    let mut add = |row: usize, column: usize, value: f64| match rows[row].iter_mut().find(|e| e.0 == column) {
        Some(entry) => entry.1 += value,
        None => rows[row].push((column, value)),
    };
    for &(a, b, weight) in &stiffness.weights {
        for [a, b] in [[a, b], [b, a]].map(|pair| pair.map(|v| v as usize)) {
            add(a, a, weight);
            add(a, b, -weight);
        }
    }
    rows
}

/// What edges join to the curve.
fn reached(rows: &[Vec<(usize, f64)>], curve: &[usize]) -> Vec<bool> {
    let mut is_reached = vec![false; rows.len()];
    let mut pending = curve.to_vec();
    while let Some(vertex) = pending.pop() {
        if !core::mem::replace(&mut is_reached[vertex], true) {
            pending.extend(rows[vertex].iter().map(|&(other, _)| other));
        }
    }
    is_reached
}
