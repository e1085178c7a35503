//! Tracing: the way of a curve over a surface, through places that are wanted and through the curves that are in its way
//! (thesis section 4.2.3, inserting curves).
//!
//! Between its stops the curve is to run as the fair curve through them would, laid on the surface. Where it crosses another
//! curve, both get a common control point, a hub: the other curve's is made first, then it is a stop like the rest.

use crate::error::ModelError;
use crate::model::Model;
use crate::operation::{insert, kept_position};
use crate::rehydrate::build_curve;
use crate::shape::SurfaceShape;
use crate::surgery::pieces::tag;
use ductile_mesh::{EdgeId, Mesh, Path, PathError, Place, SourceTag, VertexId, nearest_place};
use ductile_spec::{Curve, CurveId, Document, PointId, SurfaceId};
use glam::DVec3;

/// Hubs that one curve may need: a path that runs beside another curve for long would make them without end.
pub(crate) const MOST_HUBS: usize = 64;

/// Nearer than this part of the spacing to a control, that control is meant.
const TAKEN: f64 = 0.25;
/// An open curve that ends nearer than this part of the spacing to another, or to a rim, is meant to end there.
const MEANT: f64 = 0.6;
/// Elsewhere a curve that comes so near meets it: there is no room for triangles between.
const BESIDE: f64 = 0.1;

/// Where a curve is to pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stop {
    pub(crate) at: DVec3,
    /// The control point that is there already.
    pub(crate) point: Option<PointId>,
}

/// A way that can be laid as it is: it meets other curves at its stops only.
#[derive(Clone, Debug)]
pub(crate) struct Trace {
    pub(crate) stops: Vec<Stop>,
    pub(crate) places: Vec<Place>,
    /// Which of the places are the stops.
    pub(crate) of_stops: Vec<usize>,
}

/// A way that was laid.
pub(crate) struct Laid {
    /// Its vertices, in order.
    pub(crate) line: Vec<VertexId>,
    /// Those at its stops.
    pub(crate) controls: Vec<VertexId>,
}

impl Trace {
    /// Lays the way into a surface as a line of a curve, whose points its stops are. Nothing that was there moves.
    pub(crate) fn lay(
        &self,
        shape: &mut SurfaceShape,
        surface: SurfaceId,
        (curve, closed): (CurveId, bool),
        points: &[PointId],
    ) -> Result<Laid, ModelError> {
        let path = shape
            .mesh
            .lay_path(&self.places, closed, &shape.positions)
            .map_err(|why| ModelError::NoWay { surface, why })?;
        if path.edges.iter().any(|e| shape.mesh.is_source_edge(*e) || shape.mesh.is_boundary_edge(*e)) {
            return Err(ModelError::AlongCurve(surface));
        }
        shape.make_room();
        for (v, at) in &path.made {
            shape.positions[v.index()] = *at;
        }
        let controls: Vec<VertexId> =
            self.of_stops.iter().map(|place| path.vertices[path.places[*place]]).collect();
        for (v, point) in controls.iter().zip(points) {
            let tag = SourceTag(point.0);
            if shape.mesh.vertex_source(*v).is_some_and(|other| other != tag) {
                return Err(ModelError::Occupied);
            }
            shape.mesh.set_vertex_source(*v, Some(tag));
            shape.pins.retain(|pin| pin.vertex != *v);
        }
        tag(&mut shape.mesh, &path.vertices, closed, curve);
        Ok(Laid { line: path.vertices, controls })
    }
}

/// Finds a way over a surface. The surface may have got other vertices by it, and its curves control points.
pub(crate) fn trace(
    model: &mut Model,
    id: SurfaceId,
    mut stops: Vec<Stop>,
    closed: bool,
) -> Result<Trace, ModelError> {
    settle_stops(model, id, &mut stops, closed)?;
    for _ in 0..MOST_HUBS {
        let spacing = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?.spacing;
        let samples = fair_samples(&stops, closed, spacing)?;
        let (trace, path) = lie(model, id, &stops, closed, &samples)?;
        let Some(stop) = next_hub(model, id, &trace, &path)? else { return Ok(trace) };
        match stop {
            Hub::At(k, stop) => stops[k] = stop,
            Hub::After(k, stop) => stops.insert(k + 1, stop),
        }
        let mut seen: Vec<PointId> = stops.iter().filter_map(|stop| stop.point).collect();
        seen.sort_unstable();
        if let Some(twice) = seen.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(ModelError::TwiceThrough(twice[0]));
        }
    }
    Err(ModelError::TooManyHubs(MOST_HUBS))
}

/// A place where the way of a curve that is there meets another curve of the surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Crossing {
    /// The other curve.
    pub(crate) other: CurveId,
    /// Its control point there, if it has one.
    pub(crate) control: Option<PointId>,
    /// The stop of the way that lies there, if one does.
    pub(crate) stop: Option<usize>,
    /// Where.
    pub(crate) at: DVec3,
}

/// Finds the way of a curve that is there, through its own points, and the first place at which it crosses another curve of the
/// surface without a control point in common. Nothing is changed.
pub(crate) fn retrace(
    model: &Model,
    id: SurfaceId,
    curve: CurveId,
    stops: &[Stop],
    closed: bool,
) -> Result<(Trace, Option<Crossing>), ModelError> {
    let line = model.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?;
    let count = line.nodes.len();
    let inside =
        |(first, edges): (usize, usize)| (1..edges).map(|k| line.nodes[(first + k) % count]).collect();
    let samples: Vec<Vec<DVec3>> = line.stretches().into_iter().map(inside).collect();
    let (trace, path) = lie(model, id, stops, closed, &samples)?;
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let index_of: Vec<usize> = trace.of_stops.iter().map(|place| path.places[*place]).collect();
    for meeting in &path.meetings {
        let stop = index_of.iter().position(|index| *index == meeting.index);
        let control = control_at(&shape.mesh, meeting.place);
        if control.is_some() && stop.is_some_and(|stop| stops[stop].point == control) {
            continue;
        }
        let other =
            curve_at(&shape.mesh, meeting.place).ok_or(ModelError::CrossesCurve { curve, surface: id })?;
        return Ok((trace, Some(Crossing { other, control, stop, at: meeting.position })));
    }
    if pin_on(shape, stops, &path, &index_of).is_some() {
        return Err(ModelError::CrossesCurve { curve, surface: id });
    }
    match touch(shape, &trace, &path, &index_of) {
        None => Ok((trace, None)),
        Some((_, at)) => Err(ModelError::TouchesRim { curve, surface: id, at }),
    }
}

/// The control point at a place.
fn control_at(mesh: &Mesh, place: Place) -> Option<PointId> {
    match place {
        Place::Vertex(v) => mesh.vertex_source(v).map(|SourceTag(point)| PointId(point)),
        Place::Edge { .. } | Place::Face { .. } => None,
    }
}

/// A curve that runs through a place.
fn curve_at(mesh: &Mesh, place: Place) -> Option<CurveId> {
    let source = match place {
        Place::Edge { edge, .. } => mesh.edge_source(edge),
        Place::Vertex(v) => mesh.spokes(v).find_map(|e| mesh.edge_source(e)),
        Place::Face { .. } => None,
    };
    source.map(|SourceTag(curve)| CurveId(curve))
}

/// Stops lie on the surface; one at a control is that control, and one beside a line lies on the line.
fn settle_stops(model: &Model, id: SurfaceId, stops: &mut [Stop], closed: bool) -> Result<(), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let last = stops.len().saturating_sub(1);
    for (k, stop) in stops.iter_mut().enumerate().filter(|(_, stop)| stop.point.is_none()) {
        if !stop.at.is_finite() {
            return Err(ModelError::BadPosition);
        }
        let place = nearest_place(&shape.mesh, &shape.positions, stop.at).ok_or(ModelError::NoSurface(id))?;
        let mut at = place.position(&shape.mesh, &shape.positions).ok_or(ModelError::BadPosition)?;
        let near = place.support(&shape.mesh).find_map(|v| {
            let SourceTag(point) = shape.mesh.vertex_source(v)?;
            let is_near = shape.positions[v.index()].distance(at) < TAKEN * shape.wanted_at(v);
            is_near.then_some((PointId(point), shape.positions[v.index()]))
        });
        let is_end = !closed && (k == 0 || k == last);
        if let Some((point, at)) = near {
            *stop = Stop { at, point: Some(point) };
            continue;
        }
        if let Some(line) = on_line(shape, at, if is_end { MEANT } else { BESIDE }) {
            at = line;
        }
        stop.at = kept_position(model, at)?;
    }
    Ok(())
}

/// The nearest place on a curve or rim, if one is nearer than a part of the edges there.
fn on_line(shape: &SurfaceShape, at: DVec3, reach: f64) -> Option<DVec3> {
    let mesh = &shape.mesh;
    nearest_on(shape, at, reach, |e| mesh.is_source_edge(e) || mesh.is_boundary_edge(e))
}

/// The place on a rim at which an open curve is meant to end that ends at another one.
pub(crate) fn rim_near(shape: &SurfaceShape, at: DVec3) -> Option<DVec3> {
    nearest_on(shape, at, MEANT, |e| shape.mesh.is_boundary_edge(e))
}

fn nearest_on(
    shape: &SurfaceShape,
    at: DVec3,
    reach: f64,
    is_meant: impl Fn(EdgeId) -> bool,
) -> Option<DVec3> {
    let mesh = &shape.mesh;
    let mut best: Option<(f64, DVec3)> = None;
    for edge in mesh.edges().filter(|e| is_meant(*e)) {
        let [a, b] = mesh.edge_vertices(edge);
        let (p, q) = (shape.positions[a.index()], shape.positions[b.index()]);
        let t = (at - p).dot(q - p) / (q - p).length_squared();
        let near = p.lerp(q, if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 });
        let distance = near.distance(at);
        if distance < reach * shape.wanted_at(a) && best.is_none_or(|(least, _)| distance < least) {
            best = Some((distance, near));
        }
    }
    best.map(|(_, near)| near)
}

/// Lays a curve through the stops on the surface, and through its samples after each, without changing anything.
fn lie(
    model: &Model,
    id: SurfaceId,
    stops: &[Stop],
    closed: bool,
    samples: &[Vec<DVec3>],
) -> Result<(Trace, Path), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let place = |at: DVec3| nearest_place(&shape.mesh, &shape.positions, at).ok_or(ModelError::NoSurface(id));
    let at_stop = |stop: &Stop| match stop.point {
        Some(point) => tagged(&shape.mesh, point).map_or_else(|| place(stop.at), |v| Ok(Place::Vertex(v))),
        None => place(stop.at),
    };
    let fail = |why| ModelError::NoWay { surface: id, why };
    // A curve may leave the surface so far that its shadow on it crosses itself: straight ways are the last resort.
    let mut reason = None;
    for is_fair in [true, false] {
        let (mut places, mut of_stops) = (Vec::new(), Vec::new());
        for (k, stop) in stops.iter().enumerate() {
            of_stops.push(places.len());
            places.push(at_stop(stop)?);
            if is_fair {
                for at in samples.get(k).into_iter().flatten() {
                    places.push(place(*at)?);
                }
            }
        }
        match shape.mesh.can_lay_path(&places, closed, &shape.positions) {
            Ok(path) => return Ok((Trace { stops: stops.to_vec(), places, of_stops }, path)),
            Err(why) => reason = reason.or(Some(why)),
        }
    }
    Err(fail(reason.unwrap_or(PathError::TooShort(stops.len()))))
}

/// The samples of the fair curve after each stop, the stops left out.
fn fair_samples(stops: &[Stop], closed: bool, spacing: f64) -> Result<Vec<Vec<DVec3>>, ModelError> {
    let mut document = Document::default();
    let mut through = Vec::new();
    for (id, stop) in (1..).map(PointId).zip(stops) {
        document.points.insert(id, stop.at);
        through.push(id);
    }
    let curve = CurveId(1);
    document.curves.insert(curve, Curve::new(through, closed));
    document.validate()?;
    let stretches = if closed { stops.len() } else { stops.len() - 1 };
    let shape = build_curve(&document, curve, &vec![spacing; stretches], 0)?;
    let count = shape.nodes.len();
    let samples =
        |(first, edges): (usize, usize)| (1..edges).map(|k| shape.nodes[(first + k) % count]).collect();
    Ok(shape.stretches().into_iter().map(samples).collect())
}

/// A stop that the way needs in addition.
enum Hub {
    /// In the place of one that it has.
    At(usize, Stop),
    /// Between one and the next.
    After(usize, Stop),
}

/// The first place where the way meets a curve without stopping there. That curve gets a control there if it has none.
fn next_hub(model: &mut Model, id: SurfaceId, trace: &Trace, path: &Path) -> Result<Option<Hub>, ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let index_of: Vec<usize> = trace.of_stops.iter().map(|place| path.places[*place]).collect();
    for meeting in &path.meetings {
        let stop = index_of.iter().position(|index| *index == meeting.index);
        let control = control_at(&shape.mesh, meeting.place);
        if control.is_some() && stop.is_some_and(|stop| trace.stops[stop].point == control) {
            continue;
        }
        let point = match control {
            Some(point) => point,
            None => hub_on(model, id, meeting.place, meeting.position)?,
        };
        let at = model.point(point)?;
        let at = Stop { at, point: Some(point) };
        return Ok(Some(match stop {
            Some(stop) => Hub::At(stop, at),
            None => {
                let before = index_of.iter().rposition(|index| *index <= meeting.index).unwrap_or(0);
                Hub::After(before, at)
            }
        }));
    }
    if let Some((index, point)) = pin_on(shape, &trace.stops, path, &index_of) {
        let at = Stop { at: model.point(point)?, point: Some(point) };
        let before = index_of.iter().rposition(|stop| *stop <= index).unwrap_or(0);
        let stop = index_of.iter().position(|stop| *stop == index);
        return Ok(Some(stop.map_or(Hub::After(before, at), |stop| Hub::At(stop, at))));
    }
    let Some((index, at)) = touch(shape, trace, path, &index_of) else { return Ok(None) };
    let before = index_of.iter().rposition(|stop| *stop <= index).unwrap_or(0);
    Ok(Some(Hub::After(before, Stop { at: kept_position(model, at)?, point: None })))
}

/// The first control point that stands alone on the way, which is none of its stops.
fn pin_on(shape: &SurfaceShape, stops: &[Stop], path: &Path, index_of: &[usize]) -> Option<(usize, PointId)> {
    let is_old = |v: VertexId| path.made.iter().all(|(made, _)| *made != v);
    let alone = path.vertices.iter().enumerate().filter(|(_, v)| is_old(**v));
    let mut pins = alone.filter_map(|(index, v)| Some((index, PointId(shape.mesh.vertex_source(*v)?.0))));
    let is_stop = |index: usize, point: PointId| {
        let stop = index_of.iter().position(|stop| *stop == index);
        stop.is_some_and(|stop| stops[stop].point == Some(point))
    };
    pins.find(|(index, point)| !is_stop(*index, *point))
}

/// The first place where the way touches a rim without stopping there: a cut along it would end there.
fn touch(shape: &SurfaceShape, trace: &Trace, path: &Path, index_of: &[usize]) -> Option<(usize, DVec3)> {
    let mesh = &shape.mesh;
    let of_places = trace.places.iter().zip(&path.places).map(|(place, index)| (*index, *place));
    let is_old = |v: &VertexId| path.made.iter().all(|(made, _)| made != v);
    let of_vertices = path.vertices.iter().enumerate().filter(|(_, v)| is_old(v));
    let of_vertices = of_vertices.map(|(index, v)| (index, Place::Vertex(*v)));
    let is_on_rim = |place: &Place| match *place {
        Place::Vertex(v) => mesh.is_boundary_vertex(v),
        Place::Edge { edge, .. } => mesh.is_boundary_edge(edge),
        Place::Face { .. } => false,
    };
    let touching =
        of_places.chain(of_vertices).filter(|(index, place)| is_on_rim(place) && !index_of.contains(index));
    let (index, place) = touching.min_by_key(|(index, _)| *index)?;
    Some((index, place.position(mesh, &shape.positions)?))
}

/// Makes a control point on the curve at a place; one that is so near that there is no room for another will do.
fn hub_on(model: &mut Model, id: SurfaceId, place: Place, at: DVec3) -> Result<PointId, ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let curve = curve_at(&shape.mesh, place).ok_or(ModelError::NoSurface(id))?;
    match insert(model, curve, at) {
        Err(ModelError::Occupied) => {
            let through = &model.document.curves.get(&curve).ok_or(ModelError::NoCurve(curve))?.through;
            let distance = |point: &PointId| {
                model.document.points.get(point).map_or(f64::INFINITY, |place| place.distance(at))
            };
            let nearest = through.iter().copied().min_by(|a, b| distance(a).total_cmp(&distance(b)));
            nearest.ok_or(ModelError::Occupied)
        }
        outcome => outcome,
    }
}

/// The vertex that is a control point.
fn tagged(mesh: &Mesh, point: PointId) -> Option<VertexId> {
    mesh.vertices().find(|v| mesh.vertex_source(*v) == Some(SourceTag(point.0)))
}
