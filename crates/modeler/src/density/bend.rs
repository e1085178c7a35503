//! Edge lengths by curvature, of surfaces from the fits of their solver and of curves from their samples.

use crate::bound::BoundSurface;
use crate::shape::CurveShape;
use ductile_mesh::VertexId;

/// The angle by which the shape may turn along an edge, in radians (recipe, section 7).
const TURN: f64 = 0.35;
/// Edges are no shorter and no longer than these parts of the spacing, as long as the mesh resolves the shape.
const SHORTEST: f64 = 0.35;
const LONGEST: f64 = 1.6;
/// An edge of 1.33 times the wanted length, the longest that is not split, must not turn by more than 0.7: else the wanted
/// length goes below the shortest.
const LARGEST_TURN: f64 = 0.7 / 1.33;
/// But not below this part of the spacing: curvature grows without bound at a point that holds a plate.
const LEAST: f64 = 0.1;
/// Rounds in which the squared curvature is averaged over rings: one node's fit is a noisy witness.
const ROUNDS: usize = 2;

/// The length wanted where the shape bends by `curvature` and the spacing is `spacing`.
fn length(curvature: f64, spacing: f64) -> f64 {
    if curvature.is_nan() {
        return spacing;
    }
    let comfortable = (TURN / curvature).clamp(SHORTEST * spacing, LONGEST * spacing);
    comfortable.min(LARGEST_TURN / curvature).max(LEAST * spacing)
}

/// Replaces the spacing at each vertex by what the curvature there asks for.
pub(super) fn shorten(field: &mut [f64], bound: &BoundSurface) {
    let squared = squared_curvatures(bound);
    for (v, squared) in bound.vertices().iter().zip(squared) {
        let spacing = &mut field[v.index()];
        *spacing = length(squared.sqrt(), *spacing);
    }
}

/// The squared largest curvature of every node, smoothed.
fn squared_curvatures(bound: &BoundSurface) -> Vec<f64> {
    // A fit whose Jacobian J is below 1 sees the surface turn by about 2 √(1 - J) within its ring: that tells of bends so
    // narrow that the quadratic misses them.
    let mean_edges = bound.solver.mean_edges();
    let fits = bound.solver.curvatures().zip(bound.solver.jacobians()).zip(mean_edges);
    let squared = fits.map(|((curvature, jacobian), h)| {
        let seen = curvature.largest();
        let missed = 4.0 * (1.0 - jacobian).max(0.0) / (h * h);
        (seen * seen).max(missed)
    });
    smoothed(bound, squared.collect(), |_| false)
}

/// Squared curvatures of the nodes, averaged over rings. What is `mute` has no say in it.
pub(super) fn smoothed(
    bound: &BoundSurface,
    mut squared: Vec<f64>,
    mute: impl Fn(VertexId) -> bool,
) -> Vec<f64> {
    let rings = bound.solver.rings();
    // Rings at the boundary see one side only; what their inner neighbours see counts.
    let vertices = bound.vertices().iter().enumerate();
    let counts: Vec<bool> = vertices
        .map(|(node, v)| !rings.is_boundary(node) && squared[node].is_finite() && !mute(*v))
        .collect();
    for round in 0..ROUNDS {
        let before = squared.clone();
        for (node, squared) in squared.iter_mut().enumerate() {
            let has_say = |other: usize| round > 0 || counts[other];
            let ring = rings.ring(node).iter().map(|&other| other as usize).chain([node]);
            let (sum, count) = ring
                .filter(|&other| has_say(other))
                .fold((0.0, 0.0), |(sum, count), other| (sum + before[other], count + 1.0));
            *squared = if count > 0.0 { sum / count } else { before[node] };
        }
    }
    squared
}

/// The lengths wanted along a curve by its own curvature, with a bounded slope.
pub(super) fn of_curve(shape: &CurveShape, spacing: f64, slope: f64) -> Vec<f64> {
    let count = shape.nodes.len();
    let around = |k: usize| {
        let is_end = !shape.closed && (k == 0 || k + 1 == count);
        (!is_end).then(|| ((k + count - 1) % count, (k + 1) % count))
    };
    let squared: Vec<f64> = (0..count)
        .map(|k| {
            shape.second_derivative(around(k).map_or(if k == 0 { 1.min(count - 1) } else { k - 1 }, |_| k))
        })
        .map(|derivative| derivative.length_squared())
        .collect();
    let smooth =
        |k: usize| around(k).map_or(squared[k], |(a, b)| (squared[a] + squared[k] + squared[b]) / 3.0);
    let mut wanted: Vec<f64> = (0..count).map(|k| length(smooth(k).sqrt(), spacing)).collect();
    let edges: Vec<_> = (0..shape.edge_count()).map(|edge| shape.edge(edge)).collect();
    // Twice each way: around a closed curve the first sample hears of the last.
    for _ in 0..2 {
        for &(a, b) in edges.iter().chain(edges.iter().rev()) {
            let step = slope * shape.nodes[a].distance(shape.nodes[b]);
            wanted[a] = wanted[a].min(wanted[b] + step);
            wanted[b] = wanted[b].min(wanted[a] + step);
        }
    }
    wanted
}
