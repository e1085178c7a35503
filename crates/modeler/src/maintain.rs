//! Mesh improvement (thesis chapter 6, recipe section 7): curves keep an even sampling at the wanted
//! density, surfaces keep well-shaped triangles. Curve edges of a surface are left to their curve.

use crate::bound::BoundSurface;
use crate::density::{self, Along};
use crate::error::ModelError;
use crate::model::{MOST_NODES, Model, NODE_BUDGET};
use crate::rehydrate::NODES_FOR_A_SQUARE;
use crate::shadow;
use crate::shape::{CurveShape, SurfaceShape, edit};

use ductile_mesh::remesh::{self, Ledger, Limits, Sizing};
use ductile_mesh::{EdgeId, Mesh, measure};
use ductile_solver::{respace, respace_graded};
use ductile_spec::{CurveId, SurfaceId};
use glam::DVec3;
use std::sync::Arc;

/// A stretch of a curve gets another sample when its edges are longer than this part of the spacing, and
/// loses one when they are shorter than the second. Their quotient keeps the two from alternating.
const LONG: f64 = 1.35;
const SHORT: f64 = 0.72;
/// Fewest edges between two control points of a curve.
pub(crate) const FEWEST_EDGES: usize = 2;
/// Part of the way to its ideal place that a vertex is smoothed in one round (recipe: 0.5 to 0.7).
pub(crate) const SMOOTHING: f64 = 0.6;
/// Rounds that refining a skeleton may take; each can double the number of vertices.
const REFINEMENTS: usize = 40;
/// Samples are spread again when their spacing differs by more than this part.
const UNEVEN: f64 = 0.05;
const UNEVEN_GRADED: f64 = 0.2;

/// Improves the sampling of a curve and of all surfaces that follow it. Returns whether anything changed.
pub(crate) fn curve(model: &mut Model, id: CurveId) -> bool {
    let mut changed = false;
    // From the last stretch to the first, so that indices of those still to come stay right.
    let stretches = model.curves.get(&id).map(|shape| shape.stretches()).unwrap_or_default();
    for (rank, (_, count)) in stretches.iter().enumerate().rev() {
        // Where lengths differ, a new shape may want several times as many samples.
        let most = if matches!(density::along(model, id), Along::Graded(_)) { 1 + count / 8 } else { 1 };
        changed |= (0..most).take_while(|_| resample_stretch(model, id, rank)).count() > 0;
    }
    if model.document.curves.get(&id).is_some_and(|curve| curve.rim.is_some()) {
        // Its samples are spread by the parameter of the rim, and go to their places in the next step.
        return changed;
    }
    let along = density::along(model, id);
    if let Some(shape) = model.curves.get_mut(&id)
        && is_uneven(shape, &along)
    {
        spread(edit(shape), &along);
        changed = true;
    }
    changed
}

/// Adds or takes at most one sample in a stretch.
fn resample_stretch(model: &mut Model, id: CurveId, rank: usize) -> bool {
    let along = density::along(model, id);
    let Some(shape) = model.curves.get(&id) else { return false };
    let Some((first, count)) = shape.stretches().get(rank).copied() else { return false };
    let nodes = shape.nodes.len();
    let at = |k: usize| shape.nodes[(first + k) % nodes];
    let lengths = relative_lengths(shape, &along, (first, count));
    let mean = lengths.iter().sum::<f64>() / count.max(1) as f64;
    if mean > LONG && nodes < NODE_BUDGET / 4 {
        let longest = (0..count).fold(0, |best, k| if lengths[k] > lengths[best] { k } else { best });
        let place = at(longest).midpoint(at(longest + 1));
        return shadow::insert_sample(model, id, (first + longest) % nodes, place).is_ok();
    }
    if mean < SHORT && count > FEWEST_EDGES {
        let shortest = (1..count).fold(1, |best, k| {
            let around = |k: usize| lengths[k - 1] + lengths[k];
            if around(k) < around(best) { k } else { best }
        });
        return shadow::remove_sample(model, id, (first + shortest) % nodes);
    }
    false
}

/// The edges of a stretch in units of what is wanted of them.
fn relative_lengths(shape: &CurveShape, along: &Along, (first, count): (usize, usize)) -> Vec<f64> {
    let of_edge = |k: usize| {
        let (a, b) = shape.edge((first + k) % shape.nodes.len());
        (shape.nodes[b] - shape.nodes[a]).length() / along.edge(shape, a)
    };
    (0..count).map(of_edge).collect()
}

fn is_uneven(shape: &CurveShape, along: &Along) -> bool {
    // Wanted lengths that change along a curve are met less exactly.
    let tolerance = if matches!(along, Along::Even(_)) { UNEVEN } else { UNEVEN_GRADED };
    shape.stretches().into_iter().any(|stretch| {
        let lengths = relative_lengths(shape, along, stretch).into_iter();
        let (low, high) = lengths.fold((f64::INFINITY, 0.0_f64), |(low, high), l| (low.min(l), high.max(l)));
        high > low * (1.0 + tolerance)
    })
}

/// Spreads the samples of each stretch as they are wanted.
pub(crate) fn spread(shape: &mut CurveShape, along: &Along) {
    let mut is_control = vec![false; shape.nodes.len()];
    for (sample, _) in &shape.controls {
        is_control[*sample as usize] = true;
    }
    // Refused only for positions that are no numbers; then the samples stay where they are.
    let _ = match along {
        Along::Even(_) => respace(&mut shape.nodes, shape.closed, &is_control),
        Along::Graded(wanted) => respace_graded(&mut shape.nodes, shape.closed, &is_control, wanted),
    };
}

/// What the maintenance of one surface remembers from batch to batch: where it has nothing to do.
#[derive(Clone, Debug, Default)]
pub(crate) struct Upkeep {
    /// The connectivity that the ledger is about.
    revision: u64,
    ledger: Ledger,
}

/// Improves the mesh of a surface where it changed; returns whether its connectivity changed.
///
/// `slack` is the part of the spacing by which a vertex may have crept since it was looked at last. With 0, nothing is
/// overlooked: a batch that changes nothing proves that the whole mesh wants no edit.
pub(crate) fn surface(
    model: &mut Model,
    id: SurfaceId,
    bound: &BoundSurface,
    upkeep: &mut Upkeep,
    (slack, may_collapse): (f64, bool),
) -> bool {
    let most_vertices = model.most_nodes();
    let Some(shape) = model.surfaces.get_mut(&id).map(edit::<SurfaceShape>) else { return false };
    if upkeep.revision != shape.revision {
        *upkeep = Upkeep { revision: shape.revision, ledger: Ledger::default() };
    }
    let mut place = on_fit(bound);
    let mut sizing = take_sizing(shape, 1);
    let limits = Limits { most_vertices, may_collapse, ..Limits::default() };
    let (mesh, positions) = (&mut shape.mesh, &mut shape.positions);
    let ledger = (&mut upkeep.ledger, slack);
    let edits = remesh::improve_changed(mesh, positions, &mut sizing, ledger, &limits, &mut place);
    if let Sizing::PerVertex(wanted) = sizing {
        shape.wanted = wanted;
    }
    if edits.count() == 0 {
        return false;
    }
    upkeep.revision = model.next_revision();
    if let Some(shape) = model.surfaces.get_mut(&id) {
        edit(shape).revision = upkeep.revision;
    }
    true
}

/// The place of a new vertex in the middle of an edge: on the fitted surface, where that is known.
fn on_fit(bound: &BoundSurface) -> impl FnMut(&Mesh, &[DVec3], EdgeId) -> DVec3 {
    let mut places = bound.edge_places();
    move |mesh, positions, e| {
        let [a, b] = mesh.edge_vertices(e);
        bound.between(&mut places, a, b).unwrap_or_else(|| remesh::midpoint(mesh, positions, e))
    }
}

/// Moves vertices towards even spacing within the surface; returns whether any moved noticeably.
pub(crate) fn smooth(shape: &mut Arc<SurfaceShape>, bound: &mut BoundSurface) -> bool {
    let moved = bound.smooth(SMOOTHING);
    if moved {
        bound.write(edit(shape));
    }
    moved
}

/// The lengths that a shape wants; those of a graded one (of which the coarseness is a part) must be given back.
fn take_sizing(shape: &mut SurfaceShape, coarseness: usize) -> Sizing {
    if shape.wanted.is_empty() {
        Sizing::Uniform(shape.spacing * coarseness as f64)
    } else {
        Sizing::PerVertex(core::mem::take(&mut shape.wanted))
    }
}

/// Improves a mesh at once if a vertex of it has more neighbours than the solver can hold: a curve that is laid through
/// many triangles may leave one so.
///
/// # Errors
/// [`ModelError::Unsolvable`] if it has afterwards as well.
pub(crate) fn thin_out(model: &mut Model, id: SurfaceId) -> Result<(), ModelError> {
    let Some(shape) = model.surfaces.get_mut(&id) else { return Ok(()) };
    let most = Limits::default().most_neighbours;
    let is_crowded = |mesh: &Mesh| mesh.vertices().any(|v| mesh.valence(v) > most);
    if !is_crowded(&shape.mesh) {
        return Ok(());
    }
    refine(edit::<SurfaceShape>(shape), 1);
    BoundSurface::new(id, shape).map(drop)
}

/// Most vertices of a mesh that was found to be affordable: with some room for what its area and spacing ask for.
fn room(shape: &SurfaceShape) -> usize {
    let area = measure::total_area(&shape.mesh, &shape.positions);
    let asked = 1.25 * NODES_FOR_A_SQUARE * area / (shape.spacing * shape.spacing);
    if asked.is_nan() || asked <= NODE_BUDGET as f64 {
        return NODE_BUDGET;
    }
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "positive, and saturates")]
    let asked = asked as usize;
    asked.min(MOST_NODES)
}

/// Refines a skeleton to a multiple of the spacing.
pub(crate) fn refine(shape: &mut SurfaceShape, coarseness: usize) {
    let limits = Limits { most_vertices: room(shape), growth: 1.0, ..Limits::default() };
    let mut sizing = take_sizing(shape, coarseness);
    for _ in 0..REFINEMENTS {
        let edits = remesh::improve(
            &mut shape.mesh,
            &mut shape.positions,
            &mut sizing,
            &limits,
            &mut remesh::midpoint,
        );
        if edits.count() == 0 {
            break;
        }
    }
    if let Sizing::PerVertex(wanted) = sizing {
        shape.wanted = wanted;
    }
}

/// Improves a mesh that is refined to a multiple of the spacing, once; new vertices lie on the fitted surface.
pub(crate) fn tend(shape: &mut SurfaceShape, bound: &BoundSurface, coarseness: usize) {
    let limits = Limits { most_vertices: room(shape), ..Limits::default() };
    let mut sizing = take_sizing(shape, coarseness);
    let mut place = on_fit(bound);
    remesh::improve(&mut shape.mesh, &mut shape.positions, &mut sizing, &limits, &mut place);
    if let Sizing::PerVertex(wanted) = sizing {
        shape.wanted = wanted;
    }
}
