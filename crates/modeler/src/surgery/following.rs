//! Following: a curve that is there is laid into one more surface, sample by sample (shadowing, thesis section 7.3.3).
//!
//! The way over the surface crosses edges where it will; vertices that the curve has no samples for go again, or the curve
//! gets samples for them, and where the surface has too few its edges on the way are split.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{insert, insert_there};
use crate::shadow;
use crate::shape::{EmbeddedCurve, SurfaceShape, edit};
use crate::surgery::tracing::{Crossing, Laid, MOST_HUBS, Stop, Trace, retrace, rim_near};
use ductile_mesh::VertexId;
use ductile_spec::{CurveId, PointId, SurfaceId};

/// Lays a curve into a surface, near to where it runs. The surface is carried to it as it relaxes.
///
/// Where the way crosses another curve of the surface, both get a control point in common: a place on the curve that is laid,
/// to which the other one is carried. An open curve that ends at a rim ends on it.
pub(crate) fn follow(model: &mut Model, surface: SurfaceId, id: CurveId) -> Result<(), ModelError> {
    for _ in 0..MOST_HUBS {
        let stops = stops(model, surface, id)?;
        let closed = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?.closed;
        let (trace, crossing) = retrace(model, surface, id, &stops, closed)?;
        let Some(crossing) = crossing else { return lay(model, surface, id, &trace) };
        share(model, surface, id, &stops, crossing)?;
    }
    Err(ModelError::TooManyHubs(MOST_HUBS))
}

/// Where a curve is to pass on a surface: through its own points, its ends on a rim if one is near.
fn stops(model: &Model, surface: SurfaceId, id: CurveId) -> Result<Vec<Stop>, ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let shape = model.surfaces.get(&surface).ok_or(ModelError::NoSurface(surface))?;
    let last = curve.through.len() - 1;
    let stop = |(k, point): (usize, &PointId)| {
        let at = model.point(*point)?;
        let is_end = !curve.closed && (k == 0 || k == last);
        let at = if is_end { rim_near(shape, at).unwrap_or(at) } else { at };
        Ok(Stop { at, point: Some(*point) })
    };
    curve.through.iter().enumerate().map(stop).collect()
}

/// Gives a curve and one that its way crosses a control point in common.
fn share(
    model: &mut Model,
    surface: SurfaceId,
    id: CurveId,
    stops: &[Stop],
    crossing: Crossing,
) -> Result<(), ModelError> {
    let Crossing { other, control, stop, at } = crossing;
    let is_in_the_way = |_| ModelError::CrossesCurve { curve: id, surface };
    if control.is_some() || other == id {
        return Err(is_in_the_way(()));
    }
    let point = match stop.and_then(|stop| stops[stop].point) {
        Some(point) => point,
        None => insert(model, id, at).map_err(|_| is_in_the_way(()))?,
    };
    insert_there(model, other, at, point).map_err(|_| is_in_the_way(()))
}

/// Lays a curve into a surface along a way that meets nothing but at points in common.
fn lay(model: &mut Model, surface: SurfaceId, id: CurveId, trace: &Trace) -> Result<(), ModelError> {
    let curve = model.document.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
    let (through, closed) = (curve.through.clone(), curve.closed);
    let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
    let Laid { line: laid, controls } = trace.lay(shape, surface, (id, closed), &through)?;
    let stretches = stretches(&laid, &controls, closed).ok_or(ModelError::TwiceThrough(through[0]))?;
    let mut line: Vec<VertexId> = Vec::new();
    // From the last to the first, so that samples that are inserted do not shift those still to come.
    for (rank, stretch) in stretches.into_iter().enumerate().rev() {
        let stretch = fit(model, surface, (id, rank), stretch)?;
        line.splice(0..0, stretch[..stretch.len() - 1].iter().copied());
    }
    if !closed {
        line.extend(controls.last());
    }
    // The document's points stand in order along the samples; a closed curve may begin between two.
    let first = model.curves.get(&id).and_then(|c| c.controls.first()).map_or(0, |c| c.0 as usize);
    line.rotate_right(first);
    let revision = model.next_revision();
    let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
    shape.embeddings.push(EmbeddedCurve { curve: id, vertices: line });
    shape.revision = revision;
    Ok(())
}

/// A chain, cut at its controls: each part begins and ends at one.
fn stretches(line: &[VertexId], controls: &[VertexId], closed: bool) -> Option<Vec<Vec<VertexId>>> {
    let count = line.len();
    let at = |v: &VertexId| line.iter().position(|other| other == v);
    let places = controls.iter().map(at).collect::<Option<Vec<_>>>()?;
    let mut parts = Vec::new();
    let ends = places.windows(2).map(|pair| (pair[0], pair[1]));
    let closing = closed.then(|| (places[places.len() - 1], places[0]));
    for (from, to) in ends.chain(closing) {
        let steps = if to > from { to - from } else { to + count - from };
        parts.push((0..=steps).map(|step| line[(from + step) % count]).collect());
    }
    let total: usize = parts.iter().map(|part: &Vec<VertexId>| part.len() - 1).sum();
    (total == if closed { count } else { count - 1 }).then_some(parts)
}

/// Makes a stretch of the chain as long as the curve's own, by taking vertices out or putting some in, or by giving the
/// curve samples.
fn fit(
    model: &mut Model,
    surface: SurfaceId,
    (id, rank): (CurveId, usize),
    mut stretch: Vec<VertexId>,
) -> Result<Vec<VertexId>, ModelError> {
    loop {
        let curve = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
        let (first, wanted) = curve.stretches().get(rank).copied().ok_or(ModelError::NoCurve(id))?;
        let edges = stretch.len() - 1;
        if edges == wanted {
            return Ok(stretch);
        }
        let nodes = curve.nodes.len();
        let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
        let length = |shape: &SurfaceShape, k: usize| {
            shape.positions[stretch[k].index()].distance(shape.positions[stretch[k + 1].index()])
        };
        if edges < wanted {
            let longest =
                (0..edges).fold(0, |best, k| if length(shape, k) > length(shape, best) { k } else { best });
            let (a, b) = (stretch[longest], stretch[longest + 1]);
            let torn = ModelError::TornOff { curve: id, surface };
            let edge = shape.mesh.edge_between(a, b).ok_or(torn)?;
            let middle = shape.positions[a.index()].midpoint(shape.positions[b.index()]);
            let v = shape.mesh.split_edge(edge);
            shape.make_room();
            shape.positions[v.index()] = middle;
            stretch.insert(longest + 1, v);
            continue;
        }
        if !shorten(shape, &mut stretch) {
            // None can go: the curve gets a sample instead, where it has the longest edge.
            let curve = model.curves.get(&id).ok_or(ModelError::NoCurve(id))?;
            let at = |k: usize| curve.nodes[(first + k) % nodes];
            let span = |k: usize| at(k).distance(at(k + 1));
            let longest = (0..wanted).fold(0, |best, k| if span(k) > span(best) { k } else { best });
            let middle = at(longest).midpoint(at(longest + 1));
            shadow::insert_sample(model, id, (first + longest) % nodes, middle)?;
        }
    }
}

/// Takes out the inner vertex of a stretch that stands nearest to its neighbour, if one can go.
fn shorten(shape: &mut SurfaceShape, stretch: &mut Vec<VertexId>) -> bool {
    let at = |v: VertexId| shape.positions[v.index()];
    let mut ways: Vec<(f64, usize, VertexId)> = Vec::new();
    for k in 1..stretch.len() - 1 {
        for to in [stretch[k - 1], stretch[k + 1]] {
            ways.push((at(stretch[k]).distance(at(to)), k, to));
        }
    }
    ways.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (_, k, to) in ways {
        if shape.mesh.can_collapse(stretch[k], to).is_ok() {
            shape.mesh.collapse(stretch[k], to);
            stretch.remove(k);
            return true;
        }
    }
    false
}
