//! Curves that are led by the rim of a surface over a cage: where each of their samples is, exactly, and what the surface is like
//! there.
//!
//! Between two vertices of the cage that follow one another on the curve the samples are spread evenly over the parameter of the
//! edge, so that their number says where each one is.

use super::PatchShape;
use super::cage::exact;
use crate::error::ModelError;
use crate::model::Model;
use crate::seams::osculating;
use crate::shape::CurveShape;
use ductile_patch::SurfacePoint;
use ductile_patch::cage::CageSurface;
use ductile_spec::{Cage, Curve, CurveId, Document, PointId, SurfaceId};
use glam::DVec3;

/// An edge of the cage: the face and its corner where it begins, and whether the curve runs the other way.
#[derive(Clone, Copy, Debug)]
struct Edge {
    face: usize,
    corner: usize,
    back: bool,
}

/// A curve that is a rim.
#[derive(Clone, Debug)]
pub(crate) struct Led<'a> {
    /// The surface over the cage that leads it.
    pub(crate) surface: SurfaceId,
    exact: &'a CageSurface,
    edges: Vec<Edge>,
}

/// A place on a rim.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OnRim {
    /// The surface there, as far as its curvature goes.
    pub(crate) surface: SurfacePoint,
    /// The unit tangent of the curve, in its own sense.
    pub(crate) along: DVec3,
    /// The unit normal of the surface.
    pub(crate) normal: DVec3,
    /// The unit vector that leads away from the surface, across the curve and within the tangent plane.
    pub(crate) away: DVec3,
}

impl<'a> Led<'a> {
    /// A curve of a model, if a rim leads it.
    pub(crate) fn of(model: &'a Model, id: CurveId) -> Option<Self> {
        let curve = model.document.curves.get(&id)?;
        let surface = curve.rim?;
        let PatchShape::Cage(shape) = &**model.patches.get(&surface)? else { return None };
        Self::along(surface, model.document.cages.get(&surface)?, curve, &shape.surface)
    }

    fn along(surface: SurfaceId, cage: &Cage, curve: &Curve, exact: &'a CageSurface) -> Option<Self> {
        let rim = cage.rim();
        let count = curve.through.len();
        let edge = |k: usize| {
            let (from, to) = (curve.through[k], curve.through[(k + 1) % count]);
            let begins = |from: PointId, to: PointId| rim.get(&from).filter(|edge| edge.to == to);
            let forth = begins(from, to).map(|edge| (edge, false));
            let (edge, back) = forth.or_else(|| begins(to, from).map(|edge| (edge, true)))?;
            Some(Edge { face: edge.face, corner: edge.corner, back })
        };
        let edges =
            (0..if curve.closed { count } else { count.checked_sub(1)? }).map(edge).collect::<Option<_>>()?;
        Some(Self { surface, exact, edges })
    }

    /// A place part of the way along an edge of the cage, by number in the curve's sense.
    fn at(&self, stretch: usize, t: f64) -> Option<OnRim> {
        let Edge { face, corner, back } = *self.edges.get(stretch)?;
        let (point, along) = self.exact.on_edge(face, corner, if back { 1.0 - t } else { t }).ok()?;
        let (along, normal) = (along.try_normalize()?, point.normal?);
        // The cage is on the left of its own edges.
        let away = along.cross(normal);
        let mean = point.curvatures.map_or(0.0, |[k, l]| 0.5 * (k + l));
        let surface = osculating(point.point, normal, mean);
        Some(OnRim { surface, along: if back { -along } else { along }, normal, away })
    }

    /// A place part of the way along an edge of the curve's sampling.
    pub(crate) fn on_sampling(&self, shape: &CurveShape, edge: usize, t: f64) -> Option<OnRim> {
        let stretches = shape.stretches();
        let last = stretches.len().checked_sub(1)?;
        let count = shape.nodes.len();
        let within = |(first, edges): (usize, usize)| {
            let steps = if shape.closed { (edge + count - first) % count } else { edge.checked_sub(first)? };
            (steps < edges).then_some((steps, edges))
        };
        let found = stretches.iter().enumerate().find_map(|(k, stretch)| Some((k, within(*stretch)?)));
        match found {
            Some((stretch, (steps, edges))) => self.at(stretch, (steps as f64 + t) / edges as f64),
            // The last sample of an open curve begins no edge.
            None => self.at(last, 1.0),
        }
    }

    /// Where the samples of the curve are now; those on vertices of the cage are where the document has these.
    pub(crate) fn nodes(&self, document: &Document, shape: &CurveShape) -> Option<Vec<DVec3>> {
        let place = |sample: usize| Some(self.on_sampling(shape, sample, 0.0)?.surface.point);
        let mut nodes = (0..shape.nodes.len()).map(place).collect::<Option<Vec<_>>>()?;
        for (sample, point) in &shape.controls {
            nodes[*sample as usize] = *document.points.get(point)?;
        }
        Some(nodes)
    }
}

/// Where the samples of a curve of a document are that a rim leads; nothing for another curve.
///
/// # Errors
/// What is wrong with the cage.
pub(crate) fn led_nodes(
    document: &Document,
    id: CurveId,
    shape: &CurveShape,
) -> Result<Option<Vec<DVec3>>, ModelError> {
    let Some(curve) = document.curves.get(&id) else { return Ok(None) };
    let Some((surface, cage)) = curve.rim.and_then(|on| Some((on, document.cages.get(&on)?))) else {
        return Ok(None);
    };
    let (_, exact) = exact(surface, cage, document)?;
    let led = Led::along(surface, cage, curve, &exact);
    Ok(led.and_then(|led| led.nodes(document, shape)))
}
