//! The sides of a fill as curves: places along a stretch of a control curve, and the Bézier curve nearest to them. Everything is
//! reckoned in the sense of the control curve, so that two fills with one stretch get the same bits.

use super::corners::{corners, held};
use super::error::FillError;
use super::planes::COPLANAR;
use crate::model::Model;
use crate::patch::Led;
use crate::relax::Relaxer;
use crate::shape::CurveShape;
use ductile_patch::{CurveFit, fit_curve_along, plane_of_directions};
use ductile_spec::{Curve, CurveId, CurveStretch, Fill, FillSide, PointId};
use glam::DVec3;
use std::collections::BTreeMap;

/// Fewest steps along a side that a Bézier curve is fitted to.
const FEWEST_STEPS: usize = 32;

/// Places along a stretch of a control curve, in the sense of the curve.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawn {
    pub(crate) stretch: CurveStretch,
    /// Whether the side runs the other way.
    pub(crate) back: bool,
    /// The sample of the curve where the stretch begins, how many edges it has, and how many steps each is cut into.
    pub(crate) first: usize,
    pub(crate) edges: usize,
    pub(crate) steps: usize,
    pub(crate) places: Vec<DVec3>,
    /// The directions in which the curve leaves its first place and arrives at its last.
    pub(crate) directions: [DVec3; 2],
    /// The normals at the places of the surface over a cage whose rim the curve is.
    pub(crate) normals: Option<Vec<DVec3>>,
    /// Of which degree a Bézier curve is wanted.
    pub(crate) degree: usize,
}

/// A side with its Bézier curve, in the sense of the control curve.
#[derive(Clone, Debug)]
pub(crate) struct Side {
    pub(crate) drawn: Drawn,
    pub(crate) fit: CurveFit,
}

/// How a control curve ends, and with that how it bends there: what its samples do not say.
struct Bends<'a> {
    curve: &'a Curve,
    shape: &'a CurveShape,
    planes: &'a Planes,
}

/// The normals of the planes in which curves of fills have to leave some points.
pub(super) type Planes = BTreeMap<PointId, DVec3>;

impl Bends<'_> {
    fn chord(&self, a: usize, b: usize) -> DVec3 {
        self.shape.nodes[b] - self.shape.nodes[a]
    }

    fn point_at(&self, sample: usize) -> Option<PointId> {
        self.shape.controls.iter().find(|(at, _)| *at as usize == sample).map(|(_, point)| *point)
    }

    /// The direction that the document prescribes at a sample, in the sense of the curve.
    fn given(&self, sample: usize) -> Option<DVec3> {
        self.curve.tangents.get(&self.point_at(sample)?)?.try_normalize()
    }

    /// The second derivative at a sample. At the end of an open curve it is zero, unless something holds the curve there: then
    /// what a given direction asks for, or what it is beside the end, carried on.
    fn second(&self, sample: usize) -> DVec3 {
        let count = self.shape.nodes.len();
        if self.shape.closed || (sample > 0 && sample + 1 < count) || count < 3 {
            return self.shape.second_derivative(sample);
        }
        let inwards = |steps: usize| if sample == 0 { steps } else { sample - steps };
        let beside = self.shape.second_derivative(inwards(1));
        if let Some(given) = self.given(sample) {
            let outwards = if sample == 0 { given } else { -given };
            let (chord, l) = (self.chord(sample, inwards(1)), self.chord(sample, inwards(1)).length());
            return (chord / l - outwards) * (3.0 / l) - beside * 0.5;
        }
        if self.point_at(sample).is_some_and(|point| self.planes.contains_key(&point)) {
            return if count > 4 { beside * 2.0 - self.shape.second_derivative(inwards(2)) } else { beside };
        }
        DVec3::ZERO
    }

    /// The unit tangent at a sample: what is given, else that of the cubics beside it, turned into the plane of its point.
    fn tangent(&self, sample: usize) -> DVec3 {
        if let Some(given) = self.given(sample) {
            return given;
        }
        let count = self.shape.nodes.len();
        let slope = |a: usize, b: usize, here: usize| {
            let (chord, l) = (self.chord(a, b), self.chord(a, b).length());
            let bend = (self.second(a) + self.second(b) + self.second(here)) * (l / 6.0);
            (if here == a { chord / l - bend } else { chord / l + bend }).normalize_or_zero()
        };
        let mut tangent = DVec3::ZERO;
        if self.shape.closed || sample + 1 < count {
            tangent += slope(sample, (sample + 1) % count, sample);
        }
        if self.shape.closed || sample > 0 {
            tangent += slope((sample + count - 1) % count, sample, sample);
        }
        let plane = self.point_at(sample).and_then(|point| self.planes.get(&point));
        let within = plane.map_or(tangent, |normal| tangent - *normal * normal.dot(tangent));
        within.normalize_or_zero()
    }

    /// As [`CurveShape::place`], with the bends at the ends.
    fn place(&self, edge: usize, t: f64) -> DVec3 {
        let (a, b) = self.shape.edge(edge);
        let (s, squared) = (1.0 - t, self.chord(a, b).length_squared());
        let rise = self.second(a) * (1.0 + s) + self.second(b) * (1.0 + t);
        let place = self.shape.nodes[a].lerp(self.shape.nodes[b], t) - rise * (squared * s * t / 6.0);
        if place.is_finite() { place } else { self.shape.place(edge, t) }
    }
}

/// The planes of points where fills join smoothly: those in which their curves leave, as nearly as they do; and of points where a
/// surface beside a fill gives the plane.
pub(super) fn planes(model: &Model, relaxer: Option<&Relaxer>) -> Planes {
    let mut planes = Planes::new();
    for (point, curves) in corners(&model.document).into_iter().filter(|(_, curves)| curves.len() > 2) {
        let none = [(point, DVec3::ZERO)].into();
        let tangent = |id: &CurveId| {
            let (curve, shape) = (model.document.curves.get(id)?, model.curves.get(id)?);
            Some(Bends { curve, shape, planes: &none }.tangent(shape.sample_of(point)?))
        };
        let tangents: Vec<DVec3> = curves.iter().filter_map(tangent).collect();
        if let Some((normal, _)) = plane_of_directions(&tangents).filter(|(_, off)| *off < COPLANAR) {
            planes.insert(point, normal);
        }
    }
    planes.extend(held(model, relaxer).into_iter().map(|(point, lead)| (point, lead.normal)));
    planes
}

/// The places along a side, as its curve is now.
pub(super) fn drawn(model: &Model, planes: &Planes, side: &FillSide, degree: usize) -> Option<Drawn> {
    let (curve, shape) = (model.document.curves.get(&side.curve)?, model.curves.get(&side.curve)?);
    let (stretch, back) = side.stretch(curve);
    let (first, last) = (shape.sample_of(stretch.from)?, shape.sample_of(stretch.to)?);
    let count = shape.nodes.len();
    let edges = if shape.closed { (last + count - first) % count } else { last.checked_sub(first)? };
    if edges == 0 {
        return None;
    }
    let bends = Bends { curve, shape, planes };
    let steps = FEWEST_STEPS.div_ceil(edges);
    let led = Led::of(model, side.curve);
    let mut places = Vec::with_capacity(edges * steps + 1);
    let mut on_rim = Vec::new();
    for edge in 0..edges {
        let edge = (first + edge) % count;
        if let Some(led) = &led {
            let all = (0..steps).map(|step| led.on_sampling(shape, edge, step as f64 / steps as f64));
            on_rim.extend(all.collect::<Option<Vec<_>>>()?);
            continue;
        }
        places.push(shape.nodes[edge]);
        places.extend((1..steps).map(|step| bends.place(edge, step as f64 / steps as f64)));
    }
    let mut directions = [bends.tangent(first), bends.tangent(last)];
    if let Some(led) = &led {
        on_rim.push(led.on_sampling(shape, last, 0.0)?);
        places.extend(on_rim.iter().map(|at| at.surface.point));
        directions = [on_rim[0].along, on_rim[on_rim.len() - 1].along];
    } else {
        places.push(shape.nodes[last]);
    }
    let normals = led.is_some().then(|| on_rim.iter().map(|at| at.normal).collect());
    // The corners are where the document has them, though in a fast drag a curve may not have come there yet: so sides always meet.
    let corner = |point| model.document.points.get(&point).copied();
    (places[0], places[edges * steps]) = (corner(stretch.from)?, corner(stretch.to)?);
    Some(Drawn { stretch, back, first, edges, steps, places, directions, normals, degree })
}

/// The unit tangents of a control curve at its samples, as fills take them.
pub(crate) fn tangents(model: &Model, id: CurveId) -> Vec<DVec3> {
    let (Some(curve), Some(shape)) = (model.document.curves.get(&id), model.curves.get(&id)) else {
        return Vec::new();
    };
    let (planes, led) = (Planes::new(), Led::of(model, id));
    let bends = Bends { curve, shape, planes: &planes };
    let exact = |sample| Some(led.as_ref()?.on_sampling(shape, sample, 0.0)?.along);
    (0..shape.nodes.len()).map(|sample| exact(sample).unwrap_or_else(|| bends.tangent(sample))).collect()
}

/// Places along a side, in its own direction, for it to be shown.
pub(crate) fn places(model: &Model, side: &FillSide) -> Option<Vec<DVec3>> {
    let mut drawn = drawn(model, &Planes::new(), side, 3)?;
    if drawn.back {
        drawn.places.reverse();
    }
    Some(drawn.places)
}

/// All sides of a fill as they are now.
pub(crate) fn all_drawn(
    model: &Model,
    planes: &Planes,
    fill: &Fill,
    degree: impl Fn(&CurveStretch) -> usize,
) -> Result<Vec<Drawn>, FillError> {
    let one = |side: &FillSide| {
        let lost = FillError::NoStretch(side.curve);
        let curve = model.document.curves.get(&side.curve).ok_or(lost)?;
        drawn(model, planes, side, degree(&side.stretch(curve).0)).ok_or(lost)
    };
    fill.sides.iter().map(one).collect()
}

impl Side {
    pub(crate) fn new(drawn: Drawn) -> Result<Self, FillError> {
        let curve = drawn.stretch.curve;
        let fit = fit_curve_along(&drawn.places, drawn.degree, drawn.directions)
            .map_err(|reason| FillError::Fit { curve, reason })?;
        Ok(Self { drawn, fit })
    }

    /// The control points of its Bézier curve in its own direction.
    pub(crate) fn row(&self) -> Vec<DVec3> {
        let mut row = self.fit.points.clone();
        if self.drawn.back {
            row.reverse();
        }
        row
    }

    /// Its own parameter where that of the control curve's sense is `u`, and the other way round.
    pub(crate) fn parameter(&self, u: f64) -> f64 {
        if self.drawn.back { 1.0 - u } else { u }
    }

    /// The parameter, in the sense of the control curve, of the sample so many edges from its beginning.
    pub(crate) fn parameter_of_sample(&self, edge: usize) -> f64 {
        self.fit.parameters.get(edge * self.drawn.steps).copied().unwrap_or(1.0)
    }
}
