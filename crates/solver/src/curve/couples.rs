//! The couples that keep the tangents of a hub in one plane: what the curves of a network do for each other.
//!
//! Without its hub every curve has its own Gauss-Newton system `A x = b`. With it the turns along the normal `n` must come
//! from one tilt `m` of the plane, `n·δt_s = -m·t_s`, and a couple `λ_s` at each spoke sees to that:
//!
//! ```text
//! x = A⁻¹ (b - Σ λ_s e_s)      W λ + V m = ν      Vᵀ λ = 0
//! ```
//!
//! with `W` the turns that couples of size one bring about, `V` those of the tilts, and `ν` what the curves want when each
//! is alone. `A` is positive definite, so this is the least of the quadratic model on what the hubs allow, and a descent
//! direction.

use glam::DVec3;

use super::hub::{Hub, Rib};
use super::network::{Strand, target};
use super::{CurveSolver, Solved};
use crate::factor::FactorError;
use crate::objective::Objective;

/// A pivot below this part of the largest diagonal entry belongs to a tilt that no spoke feels.
const NO_PIVOT: f64 = 1e-12;

/// Adds to the solutions of the curves the couples that keep their tangents in the planes. Returns the tilts.
pub(super) fn bind(
    hubs: &[Hub],
    strands: &mut [Strand<'_>],
    objective: Option<Objective>,
) -> Solved<Vec<DVec3>> {
    let free: Vec<(usize, Rib)> = (0..hubs.len())
        .flat_map(|hub| hubs[hub].ribs.iter().map(move |rib| (hub, *rib)))
        .filter(|(_, rib)| !rib.is_given)
        .collect();
    let axes: Vec<(usize, DVec3)> =
        (0..hubs.len()).flat_map(|hub| hubs[hub].tilts().into_iter().map(move |axis| (hub, axis))).collect();
    let count = free.len();
    let mut answers = Vec::with_capacity(count);
    let mut wanted = Vec::with_capacity(count);
    for (hub, rib) in &free {
        let (strand, normal) = (&mut strands[rib.curve], hubs[*hub].normal);
        let character = strand.solver.character(strand.positions, target(strand.solver, objective));
        let CurveSolver { chain, bends, frames, offsets, .. } = &mut *strand.solver;
        wanted.push(offsets.turn_of(offsets.solution(), frames, rib.node, normal));
        answers.push(offsets.answer((*chain, bends, frames, character), rib.node, normal));
    }
    let mut compliance = vec![0.0; count * count];
    for (row, (hub, rib)) in free.iter().enumerate() {
        let solver = &strands[rib.curve].solver;
        for column in (0..count).filter(|&column| free[column].1.curve == rib.curve) {
            compliance[row * count + column] =
                solver.offsets.turn_of(&answers[column], &solver.frames, rib.node, hubs[*hub].normal);
        }
    }
    // First column what the curves want, then what the tilts bring about: V = -m·t.
    let mut columns = vec![wanted];
    for (hub, axis) in &axes {
        let along = |(own, rib): &(usize, Rib)| if own == hub { -axis.dot(rib.tangent) } else { 0.0 };
        columns.push(free.iter().map(along).collect());
    }
    let tilted = columns[1..].to_vec();
    solve_dense(&mut compliance, count, &mut columns)?;
    let inner = |a: &[f64], b: &[f64]| crate::cg::dot(a, b);
    let mut reduced: Vec<f64> =
        tilted.iter().flat_map(|v| columns[1..].iter().map(|y| inner(v, y)).collect::<Vec<_>>()).collect();
    let mut tilt = vec![tilted.iter().map(|v| inner(v, &columns[0])).collect::<Vec<f64>>()];
    solve_dense(&mut reduced, axes.len(), &mut tilt)?;
    for (spoke, ((_, rib), answer)) in free.iter().zip(&answers).enumerate() {
        let shared: f64 = columns[1..].iter().zip(&tilt[0]).map(|(y, m)| y[spoke] * m).sum();
        strands[rib.curve].solver.offsets.add_answer(answer, shared - columns[0][spoke]);
    }
    let mut tilts = vec![DVec3::ZERO; hubs.len()];
    for ((hub, axis), amount) in axes.iter().zip(&tilt[0]) {
        tilts[*hub] += *axis * *amount;
    }
    Ok(tilts)
}

/// Solves a small dense symmetric system by `L Lᵀ`, in place, for several right-hand sides. What has no pivot is left alone.
fn solve_dense(a: &mut [f64], size: usize, columns: &mut [Vec<f64>]) -> Solved<()> {
    let largest = (0..size).fold(0.0_f64, |largest, i| largest.max(a[i * size + i]));
    for i in 0..size {
        for j in 0..=i {
            let sum: f64 = (0..j).map(|k| a[i * size + k] * a[j * size + k]).sum();
            let rest = a[i * size + j] - sum;
            if i > j {
                a[i * size + j] = rest / a[j * size + j];
            } else if rest.is_finite() {
                a[i * size + i] = if rest > NO_PIVOT * largest { rest } else { largest.max(1.0) }.sqrt();
            } else {
                return Err(FactorError);
            }
        }
    }
    for x in columns {
        for i in 0..size {
            let sum: f64 = (0..i).map(|k| a[i * size + k] * x[k]).sum();
            x[i] = (x[i] - sum) / a[i * size + i];
        }
        for i in (0..size).rev() {
            let sum: f64 = (i + 1..size).map(|k| a[k * size + i] * x[k]).sum();
            x[i] = (x[i] - sum) / a[i * size + i];
        }
    }
    Ok(())
}
