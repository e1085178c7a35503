//! Finer edges where the mesh is too coarse for its shape: necks and tubes with few edges round them, in documents that ask for the
//! same density everywhere, too.
//!
//! Round a tube of radius `r` run `2 π r / h` edges. With twenty its bending is priced to 1 or 2 %; with eight the quadratics
//! miss a tenth of it, and with six half: then a neck costs less the thinner it is, and draws together to a string (recipe, section
//! 7: "require kmax h <= 0.7 and J >= 0.7 everywhere, else refine"). So `h <= c r`, where `r` is the smaller radius of curvature.
//!
//! A coarse tube looks up to a fifth more bent than it is (`1 / cos²(h / 2r)` of a ring of chords), a coarse waist less. So that
//! no mesh answers itself, a length stays as long as it lies between what would be asked for with the curvature found and with
//! [`PLAY`] times that. Where all shapes have the edges that they need, nothing is asked for.

use super::bend;
use crate::bound::BoundSurface;
use crate::model::{Model, NODE_BUDGET};
use crate::shape::{CurveShape, SurfaceShape};
use core::f64::consts::{SQRT_2, TAU};
use ductile_mesh::VertexId;
use ductile_spec::CurveId;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The curves of a model.
type Curves = BTreeMap<CurveId, Arc<CurveShape>>;

/// Edges round a tube from which on all is well, up to which it gets [`ROUND`], and those that it gets.
const ENOUGH: f64 = 9.0;
const FEW: f64 = 8.0;
const ROUND: f64 = 20.0;
/// Part by which the curvature found may change before a length is given up.
const PLAY: f64 = 1.35;
/// Shortest edges, as a part of what they would be without: not all that is thin can be shown.
const LEAST: f64 = 0.125;
/// Where a mesh is finer than that already, nothing was asked for by necks.
const NOTICED: f64 = 0.87;
/// A surface whose curves want less than this part of what it has is not left to the next batch.
const OVERDUE: f64 = 0.7;
/// Most nodes that necks may ask for: as many times those that the surface would have without.
const MOST_GROWTH: f64 = 1.5;
/// And this many in any case.
const LEAST_GROWTH: f64 = 500.0;

/// The part of its length that an edge may have which would turn by `turn` radians.
fn part(turn: f64) -> f64 {
    let (enough, few) = (TAU / ENOUGH, TAU / FEW);
    let fine = |turn: f64| TAU / ROUND / turn;
    if turn.is_nan() || turn <= enough {
        1.0
    } else if turn >= few {
        fine(turn).max(LEAST)
    } else {
        1.0 + (fine(few) - 1.0) * (turn - enough) / (few - enough)
    }
}

/// The part of `field`, what is wanted for other reasons, that bends leave of it at each vertex slot; `None` where they leave all
/// of it. While the shape is on its way (`is_steady` is not yet true) nothing new is asked for.
pub(super) fn parts(
    model: &Model,
    field: &[f64],
    shape: &SurfaceShape,
    (bound, is_steady): (Option<&BoundSurface>, bool),
) -> Option<Vec<f64>> {
    let was = |v: usize| shape.wanted.get(v).map_or(1.0, |wanted| (wanted / field[v]).min(1.0));
    let mut parts = vec![1.0; field.len()];
    shape.mesh.vertices().for_each(|v| parts[v.index()] = was(v.index()));
    if let Some(bound) = bound {
        let held = held(&model.curves, field, shape, bound);
        let is_held = held.is_some();
        // A point that holds a plate bends it without bound.
        let is_pin = |v: VertexId| shape.pins.iter().any(|pin| pin.vertex == v);
        let seen = bound.solver.curvatures().map(|curvature| curvature.largest()).map(|seen| seen * seen);
        let squared = bend::smoothed(bound, seen.collect(), is_pin);
        let most = most_nodes(field, bound);
        let may_shorten = is_steady && is_held && (shape.mesh.vertex_count() as f64) < most;
        for (v, squared) in bound.vertices().iter().map(|v| v.index()).zip(squared) {
            let turn = squared.sqrt() * field[v];
            parts[v] = parts[v].clamp(part(PLAY * turn), if may_shorten { part(turn) } else { 1.0 });
        }
        parts.iter_mut().zip(held.iter().flatten()).for_each(|(part, held)| *part = part.min(*held));
        afford(&mut parts, field, bound, most);
    }
    let least = parts.iter().copied().fold(1.0, f64::min);
    (least < NOTICED).then_some(parts)
}

/// How many nodes there would be with edges that are as long as `lengths` says. Each node stands for a square of its mean edge, which is
/// divided into so many.
fn nodes(bound: &BoundSurface, lengths: impl Fn(usize) -> f64) -> f64 {
    let edges = bound.vertices().iter().zip(bound.solver.mean_edges());
    edges.map(|(v, h)| h / lengths(v.index())).map(|times| times * times).sum()
}

/// How many nodes a surface may have.
fn most_nodes(field: &[f64], bound: &BoundSurface) -> f64 {
    let plain = nodes(bound, |v| field[v]);
    (MOST_GROWTH * plain).max(plain + LEAST_GROWTH).min(NODE_BUDGET as f64)
}

/// Raises the shortest lengths until the nodes that they need are not too many.
fn afford(parts: &mut [f64], field: &[f64], bound: &BoundSurface, most: f64) {
    let mut floor = LEAST;
    while floor < 1.0 && nodes(bound, |v| parts[v].max(floor) * field[v]) > most {
        floor *= SQRT_2;
    }
    parts.iter_mut().for_each(|part| *part = part.max(floor.min(1.0)));
}

/// The part of `field` that the curves inside a surface leave by themselves, if that is noticeably less. They are at rest long before the
/// surface is, and a waist that is held by one must have its edges early, or it draws together.
pub(super) fn held(
    curves: &Curves,
    field: &[f64],
    shape: &SurfaceShape,
    bound: &BoundSurface,
) -> Option<Vec<f64>> {
    let mut parts = vec![1.0_f64; field.len()];
    along_curves(curves, shape, bound, |v, curvature| {
        parts[v] = parts[v].min(part(curvature * field[v]));
    });
    parts.iter().any(|part| *part < NOTICED).then_some(parts)
}

/// Whether the curves inside a surface ask for edges much shorter than are wanted now.
pub(super) fn is_overdue(curves: &Curves, shape: &SurfaceShape, bound: &BoundSurface) -> bool {
    let mut is_overdue = false;
    along_curves(curves, shape, bound, |v, curvature| {
        let wanted = shape.wanted.get(v).copied().unwrap_or(shape.spacing);
        is_overdue |= part(curvature * shape.spacing) * shape.spacing < OVERDUE * wanted;
    });
    is_overdue
}

/// Visits the vertices on curves inside a surface with the normal curvature of their curve there, which is the surface's in that
/// direction. (How a curve turns within the surface bends nothing.)
fn along_curves(
    curves: &Curves,
    shape: &SurfaceShape,
    bound: &BoundSurface,
    mut visit: impl FnMut(usize, f64),
) {
    for embedded in &shape.embeddings {
        let Some(curve) = curves.get(&embedded.curve) else { continue };
        let squared: Vec<f64> = (0..curve.nodes.len())
            .zip(&embedded.vertices)
            .map(|(k, v)| curve.second_derivative(k).dot(bound.normals()[bound.node(*v) as usize]))
            .map(|curvature| curvature * curvature)
            .collect();
        let count = squared.len();
        for (k, v) in embedded.vertices.iter().enumerate().take(count) {
            let is_end = !curve.closed && (k == 0 || k + 1 == count);
            if !is_end && !shape.mesh.is_boundary_vertex(*v) {
                let around = squared[(k + count - 1) % count] + squared[k] + squared[(k + 1) % count];
                visit(v.index(), (around / 3.0).sqrt());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn parts_leave_what_is_fine_alone_and_give_twenty_edges_to_what_is_not() {
        for edges in [9.0, 12.0, 100.0, f64::INFINITY] {
            assert_eq!(part(TAU / edges * 0.999), 1.0, "{edges} round");
        }
        assert_eq!(part(f64::NAN), 1.0);
        for edges in [7.0, 5.0, 3.0] {
            assert!((edges / part(TAU / edges) - 20.0).abs() < 1e-9, "{edges} round");
        }
        // What is thinner than a dozenth of an edge is not shown.
        assert_eq!(part(TAU), LEAST);
        assert_eq!(part(f64::INFINITY), LEAST);
    }

    #[test]
    fn parts_fall_without_a_jump() {
        let (mut turn, mut before) = (0.0, part(0.0));
        while turn < 10.0 {
            turn += 1e-4;
            let now = part(turn);
            assert!(now <= before && before - now < 1e-3, "{before} and {now} at {turn}");
            before = now;
        }
    }

    /// The turn that a ring of chords round a tube shows, by how many they are (`1 / cos²` of half of it too much), answers no length
    /// with another one: what it gets by looking coarse it keeps when it looks fine.
    #[test]
    fn a_tube_keeps_what_it_was_given() {
        for true_turn in (50..400).map(|turn| f64::from(turn) * 0.01) {
            let seen = |part: f64| {
                let cos = libm::cos(0.5 * (true_turn * part).min(2.0));
                true_turn / (cos * cos).max(0.75)
            };
            let mut given = 1.0_f64;
            let mut changes = 0;
            for _ in 0..20 {
                let turn = seen(given);
                let next = given.clamp(part(PLAY * turn), part(turn));
                changes += usize::from((next / given - 1.0).abs() > 1e-9);
                given = next;
            }
            assert!(changes <= 2, "{true_turn}: {changes} changes");
        }
    }
}
