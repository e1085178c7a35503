//! `s-loop`: a control curve is drawn on a surface (thesis sections 7.3.2 and 7.3.3). It lies where it was drawn, then it
//! is fair like every curve, and the surface follows it.

use crate::error::ModelError;
use crate::maintain::FEWEST_EDGES;
use crate::model::Model;
use crate::operation::{kept_position, refresh_skeleton};
use crate::shape::{CurveShape, EmbeddedCurve, SurfaceShape, edit};
use crate::surgery::joining::{said, say};
use crate::surgery::tracing::{Laid, Stop, Trace, trace};
use ductile_mesh::{SourceTag, VertexId};
use ductile_spec::{Curve, CurveId, PointId, SurfaceId};
use glam::DVec3;
use std::sync::Arc;

/// Samples nearer to each other than this part of the spacing are not needed for the curve's shape.
const CROWDED: f64 = 0.6;

/// Draws a curve through places of a surface.
pub(super) fn s_loop(
    model: &mut Model,
    surface: SurfaceId,
    along: &[DVec3],
    closed: bool,
) -> Result<(), ModelError> {
    let id = model.document.next_curve();
    let needed = if closed { 3 } else { 2 };
    if along.len() < needed {
        let defect = ductile_spec::Defect::ShortCurve { curve: id, count: along.len(), needed };
        return Err(defect.into());
    }
    let stops = along.iter().map(|at| Stop { at: *at, point: None }).collect();
    draw(model, surface, stops, closed).map(drop)
}

/// Draws a curve through stops on a surface; those that are no controls become controls.
pub(crate) fn draw(
    model: &mut Model,
    surface: SurfaceId,
    stops: Vec<Stop>,
    closed: bool,
) -> Result<CurveId, ModelError> {
    let trace = trace(model, surface, stops, closed)?;
    let told = said(model, surface);
    let curve = lay(model, surface, &trace, closed)?;
    refresh_skeleton(model, surface);
    say(model, surface, &told);
    model.document.validate()?;
    Ok(curve)
}

/// Lays a curve on a surface along a way that meets nothing but at its stops.
fn lay(model: &mut Model, surface: SurfaceId, trace: &Trace, closed: bool) -> Result<CurveId, ModelError> {
    let id = model.document.next_curve();
    let (of_curve, of_surface) = (model.next_revision(), model.next_revision());
    let mut points = Vec::new();
    for stop in &trace.stops {
        points.push(match stop.point {
            Some(point) => point,
            None => {
                let point = model.document.next_point();
                let at = kept_position(model, stop.at)?;
                model.document_mut().points.insert(point, at);
                point
            }
        });
    }
    let places: Vec<DVec3> = points.iter().map(|point| model.point(*point)).collect::<Result<_, _>>()?;
    let shape = edit(model.surfaces.get_mut(&surface).ok_or(ModelError::NoSurface(surface))?);
    let Laid { mut line, controls } = trace.lay(shape, surface, (id, closed), &points)?;
    for (v, at) in controls.iter().zip(&places) {
        shape.positions[v.index()] = *at;
    }
    thin(shape, &mut line, closed);
    fill(shape, &mut line, closed, id);
    let nodes = line.iter().map(|v| shape.positions[v.index()]).collect();
    let rank = |v: &VertexId| controls.iter().position(|control| control == v);
    let own: Vec<(u32, PointId)> =
        (0..).zip(&line).filter_map(|(sample, v)| Some((sample, points[rank(v)?]))).collect();
    if own.iter().map(|(_, point)| *point).ne(points.iter().copied()) {
        return Err(ModelError::TwiceThrough(points[0]));
    }
    shape.embeddings.push(EmbeddedCurve { curve: id, vertices: line });
    shape.revision = of_surface;
    let curve = CurveShape { nodes, closed, controls: own, revision: of_curve };
    model.curves.insert(id, Arc::new(curve));
    model.document_mut().curves.insert(id, Curve::new(points, closed));
    Ok(id)
}

/// Takes out vertices of a tagged chain that stand closer than the curve needs them.
fn thin(shape: &mut SurfaceShape, line: &mut Vec<VertexId>, closed: bool) {
    let mut k = 0;
    while k < line.len() && line.len() > 4 {
        let (v, count) = (line[k], line.len());
        let is_end = !closed && (k == 0 || k + 1 == count);
        if is_end || shape.mesh.is_source_vertex(v) {
            k += 1;
            continue;
        }
        let (before, after) = (line[(k + count - 1) % count], line[(k + 1) % count]);
        let distance = |w: VertexId| shape.positions[v.index()].distance(shape.positions[w.index()]);
        let mut ways = [before, after];
        ways.sort_by(|a, b| distance(*a).total_cmp(&distance(*b)));
        let is_crowded = distance(ways[0]) < CROWDED * shape.wanted_at(v);
        // A stretch between controls keeps a sample.
        let is_last = [before, after].iter().all(|w| shape.mesh.is_source_vertex(*w));
        let way = ways.into_iter().find(|w| shape.mesh.can_collapse(v, *w).is_ok());
        match way.filter(|_| is_crowded && !is_last) {
            Some(way) => {
                shape.mesh.collapse(v, way);
                line.remove(k);
            }
            None => k += 1,
        }
    }
}

/// Splits edges of a tagged chain so that every stretch between controls has the edges that a curve needs.
fn fill(shape: &mut SurfaceShape, line: &mut Vec<VertexId>, closed: bool, id: CurveId) {
    const { assert!(FEWEST_EDGES == 2, "one split makes two edges of one") };
    let mut k = 0;
    while k < line.len() {
        let next = (k + 1) % line.len();
        let is_edge = closed || k + 1 < line.len();
        let are_controls = [k, next].iter().all(|k| shape.mesh.is_source_vertex(line[*k]));
        if is_edge
            && are_controls
            && let Some(edge) = shape.mesh.edge_between(line[k], line[next])
        {
            let middle = shape.positions[line[k].index()].midpoint(shape.positions[line[next].index()]);
            let wanted = shape.wanted_at(line[k]);
            let v = shape.mesh.split_edge(edge);
            shape.positions.resize(shape.mesh.vertex_slots(), middle);
            shape.positions[v.index()] = middle;
            if !shape.wanted.is_empty() {
                shape.wanted.resize(shape.mesh.vertex_slots(), wanted);
                shape.wanted[v.index()] = wanted;
            }
            debug_assert!(shape.mesh.spokes(v).any(|e| shape.mesh.edge_source(e) == Some(SourceTag(id.0))));
            line.insert(k + 1, v);
            k += 1;
        }
        k += 1;
    }
}
