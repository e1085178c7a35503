//! How well surfaces meet along the curves that they share: every pair of surfaces of whatever kind that end at, or run through, the
//! same stretch, compared at the samples of the curve.

use crate::model::Model;
use crate::patch::fill::{self, Drawn, Side};
use crate::relax::Relaxer;
use ductile_patch::s_patch::Domain;
use ductile_patch::{Seam, SurfacePoint, seam};
use ductile_spec::{CurveStretch, SeamFigures, Seams, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;

/// A surface along a stretch.
#[derive(Clone, Copy)]
enum Bank<'a> {
    /// A fair one: which of its embeddings.
    Fair(SurfaceId, usize),
    /// A fill, by the number of its side.
    Fill(SurfaceId, usize, &'a Side),
}

impl Bank<'_> {
    fn surface(&self) -> SurfaceId {
        match self {
            Self::Fair(id, _) | Self::Fill(id, ..) => *id,
        }
    }
}

/// All seams, and how well fills follow.
pub(crate) fn seams(model: &Model, relaxer: &Relaxer) -> Seams {
    let mut banks: BTreeMap<CurveStretch, Vec<Bank<'_>>> = BTreeMap::new();
    for id in model.document.fills.keys() {
        for (at, side) in fill::shape(model, *id).into_iter().flat_map(|s| s.sides.iter().enumerate()) {
            banks.entry(side.drawn.stretch).or_default().push(Bank::Fill(*id, at, side));
        }
    }
    let stretches: Vec<CurveStretch> = banks.keys().copied().collect();
    for (id, shape) in &model.surfaces {
        for (place, embedded) in shape.embeddings.iter().enumerate() {
            let Some(curve) = model.document.curves.get(&embedded.curve) else { continue };
            let (Some(first), Some(last)) = (curve.through.first(), curve.through.last()) else { continue };
            let to = if curve.closed { *first } else { *last };
            let whole = CurveStretch { curve: embedded.curve, from: *first, to };
            let of_fills = stretches.iter().filter(|stretch| stretch.curve == embedded.curve);
            for stretch in of_fills.copied().chain((!stretches.contains(&whole)).then_some(whole)) {
                banks.entry(stretch).or_default().push(Bank::Fair(*id, place));
            }
        }
    }
    let mut found = Vec::new();
    for (stretch, banks) in &banks {
        for (at, one) in banks.iter().enumerate() {
            for other in &banks[at + 1..] {
                found.extend(compared(model, relaxer, *stretch, *one, *other));
            }
        }
    }
    let fills = model.document.fills.keys();
    let fills = fills.filter_map(|id| Some(fill::shape(model, *id)?.figures(*id))).collect();
    Seams { seams: found, fills }
}

fn compared(
    model: &Model,
    relaxer: &Relaxer,
    stretch: CurveStretch,
    one: Bank<'_>,
    other: Bank<'_>,
) -> Option<SeamFigures> {
    let curve = model.curves.get(&stretch.curve)?;
    let count = curve.nodes.len();
    let (first, last) = (curve.sample_of(stretch.from)?, curve.sample_of(stretch.to)?);
    let edges = match (curve.closed, stretch.from == stretch.to) {
        (true, true) => count,
        (true, false) => (last + count - first) % count,
        (false, _) => last.checked_sub(first)?,
    };
    // A long edge of a curve has more to say than its two ends.
    let steps = if matches!((one, other), (Bank::Fill(..), Bank::Fill(..))) { 4 } else { 1 };
    let places: Vec<(usize, f64)> =
        (0..=edges * steps).map(|k| (k / steps, (k % steps) as f64 / steps as f64)).collect();
    let points = |bank: Bank<'_>| -> Option<Vec<SurfacePoint>> {
        places.iter().map(|(edge, t)| point(model, relaxer, bank, (first, *edge, *t))).collect()
    };
    let Seam { gap, angle, curvature_jump, without_normal, without_curvature, .. } =
        seam(&points(one)?, &points(other)?)?;
    Some(SeamFigures {
        stretch,
        surfaces: [one.surface(), other.surface()],
        gap,
        angle: angle.to_degrees(),
        curvature_jump,
        places: u32::try_from(places.len()).unwrap_or(u32::MAX),
        without_normal: u32::try_from(without_normal).unwrap_or(u32::MAX),
        without_curvature: u32::try_from(without_curvature).unwrap_or(u32::MAX),
    })
}

/// A surface at a place of its curve: so many edges from the first sample of the stretch, and a part of one more.
fn point(
    model: &Model,
    relaxer: &Relaxer,
    bank: Bank<'_>,
    (first, edge, t): (usize, usize, f64),
) -> Option<SurfacePoint> {
    match bank {
        Bank::Fair(id, place) => {
            let shape = model.surfaces.get(&id)?;
            let bound = relaxer.surface(id, shape)?;
            let vertices = &shape.embeddings.get(place)?.vertices;
            let vertex = vertices.get((first + edge) % vertices.len())?;
            let node = bound.node(*vertex) as usize;
            let (normal, mean) = (*bound.normals().get(node)?, bound.mean_curvature(node)?);
            Some(osculating(*shape.positions.get(vertex.index())?, normal, mean))
        }
        Bank::Fill(id, at, side) => {
            let built = fill::shape(model, id)?.built.as_ref()?;
            let Drawn { steps, edges, .. } = side.drawn;
            let whole = edge.min(edges);
            let low = side.parameter_of_sample(whole);
            let high = side.parameter_of_sample((whole + 1).min(edges));
            debug_assert!(steps > 0, "an edge is cut into steps");
            let domain = Domain::new(built.patch.sides());
            let u = side.parameter(low + (high - low) * t);
            built.patch.at(&domain, domain.on_side(at, u))
        }
    }
}

/// A point of a surface of which normal and mean curvature are known: seams ask for no more.
fn osculating(point: DVec3, normal: DVec3, mean: f64) -> SurfacePoint {
    let dx = normal.any_orthonormal_vector();
    let bent = normal * mean;
    SurfacePoint { point, dx, dy: normal.cross(dx), dxx: bent, dxy: DVec3::ZERO, dyy: bent }
}
