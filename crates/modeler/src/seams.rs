//! How well surfaces meet along the curves that they share: every pair of surfaces of whatever kind that end at, or run through, the
//! same stretch, compared at the samples of the curve. Where a side of one fill runs along two of others (a T-junction), each part
//! that two of them share is a seam.
//!
//! Of the rim of a surface over a cage or of a mesh that no curve follows to the bit, what is known is the tessellation: place and normal
//! of the nearest place at its rim. Curvatures are not compared there.

use crate::bank;
use crate::model::Model;
use crate::patch::fill::{self, Drawn, Side};
use crate::patch::{Led, PatchRim};
use crate::relax::Relaxer;
use ductile_patch::s_patch::Domain;
use ductile_patch::{Seam, SurfacePoint, seam};
use ductile_spec::{CurveId, CurveStretch, SeamFigures, Seams, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// A surface along a stretch.
#[derive(Clone, Copy)]
enum Bank<'a> {
    /// A fair one: which of its embeddings.
    Fair(SurfaceId, usize),
    /// A fill, by the number of its side.
    Fill(SurfaceId, usize, &'a Side),
    /// A surface over a cage whose rim leads the curve.
    Led(SurfaceId, &'a Led<'a>),
    /// An exact surface that another one goes on from there, at its rim.
    Rim(SurfaceId, &'a PatchRim<'a>),
}

impl Bank<'_> {
    fn surface(&self) -> SurfaceId {
        match self {
            Self::Fair(id, _) | Self::Fill(id, ..) | Self::Led(id, _) | Self::Rim(id, _) => *id,
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
    let of_fills: Vec<CurveStretch> = banks.keys().copied().collect();
    for (id, shape) in &model.surfaces {
        for (place, embedded) in shape.embeddings.iter().enumerate() {
            for stretch in stretches(model, &of_fills, embedded.curve) {
                banks.entry(stretch).or_default().push(Bank::Fair(*id, place));
            }
        }
    }
    let led: Vec<(CurveId, Led<'_>)> =
        model.document.curves.keys().filter_map(|id| Some((*id, Led::of(model, *id)?))).collect();
    for (curve, led) in &led {
        for stretch in stretches(model, &of_fills, *curve) {
            banks.entry(stretch).or_default().push(Bank::Led(led.surface, led));
        }
    }
    let rims: BTreeMap<SurfaceId, PatchRim<'_>> = gone_on_from(model)
        .into_iter()
        .filter_map(|(surface, _)| Some((surface, PatchRim::new(model.patches.get(&surface)?))))
        .collect();
    for (surface, curve) in gone_on_from(model) {
        let Some(rim) = rims.get(&surface) else { continue };
        for stretch in stretches(model, &of_fills, curve) {
            banks.entry(stretch).or_default().push(Bank::Rim(surface, rim));
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
    found.extend(
        parts(model, &banks)
            .iter()
            .filter_map(|&(part, one, other)| compared(model, relaxer, part, one, other)),
    );
    // In the order of the stretches, and for each in that of the surfaces above.
    found.sort_by_key(|seam| seam.stretch);
    let fills = model.document.fills.keys();
    let fills = fills.filter_map(|id| Some(fill::shape(model, *id)?.figures(*id))).collect();
    Seams { seams: found, fills }
}

/// The stretches of a curve that are compared: those of fills, and the whole curve.
fn stretches(model: &Model, of_fills: &[CurveStretch], id: CurveId) -> Vec<CurveStretch> {
    let Some(curve) = model.document.curves.get(&id) else { return Vec::new() };
    let (Some(first), Some(last)) = (curve.through.first(), curve.through.last()) else { return Vec::new() };
    let whole = CurveStretch { curve: id, from: *first, to: if curve.closed { *first } else { *last } };
    let of_fills = of_fills.iter().filter(|stretch| stretch.curve == id).copied();
    of_fills.clone().chain((!of_fills.clone().any(|stretch| stretch == whole)).then_some(whole)).collect()
}

/// The surfaces over cages and meshes from whose rims others go on, with the curves along which they do, if these are not led.
fn gone_on_from(model: &Model) -> BTreeSet<(SurfaceId, CurveId)> {
    let document = &model.document;
    let ribbons = document.surfaces.values().flat_map(|surface| &surface.ribbons);
    let of_fair = ribbons.filter_map(|(curve, ribbon)| Some((ribbon.onto?, *curve)));
    let sides = document.fills.values().flat_map(|fill| &fill.sides);
    let of_fills = sides.filter_map(|side| Some((side.planes?, side.curve)));
    of_fair
        .chain(of_fills)
        .filter(|(surface, _)| document.cages.contains_key(surface) || document.meshes.contains_key(surface))
        .filter(|(surface, curve)| {
            document.curves.get(curve).is_some_and(|curve| curve.rim != Some(*surface))
        })
        .collect()
}

/// The parts of stretches that sides of two fills share where their stretches are not the same.
fn parts<'a>(
    model: &Model,
    banks: &BTreeMap<CurveStretch, Vec<Bank<'a>>>,
) -> Vec<(CurveStretch, Bank<'a>, Bank<'a>)> {
    let of_fills = |banks: &[Bank<'a>]| -> Vec<(Bank<'a>, &'a Drawn)> {
        let side = |bank: &Bank<'a>| match *bank {
            Bank::Fill(.., side) => Some((*bank, &side.drawn)),
            _ => None,
        };
        banks.iter().filter_map(side).collect()
    };
    let mut found = Vec::new();
    for (at, (stretch, one)) in banks.iter().enumerate() {
        let Some(curve) = model.curves.get(&stretch.curve) else { continue };
        let rest = banks.iter().skip(at + 1).take_while(|(other, _)| other.curve == stretch.curve);
        for (_, other) in rest {
            for (a, own) in of_fills(one) {
                for (b, there) in of_fills(other) {
                    let shared = shared(own, there, curve.nodes.len());
                    // The surface of the lower number comes first, as it does where stretches are the same.
                    let (a, b) = if b.surface() < a.surface() { (b, a) } else { (a, b) };
                    found.extend(shared.into_iter().map(|part| (part, a, b)));
                }
            }
        }
    }
    found
}

/// What two stretches of a curve of so many samples have in common: nothing, one part, or two on a closed curve.
pub(crate) fn shared(one: &Drawn, other: &Drawn, count: usize) -> Vec<CurveStretch> {
    // How many edges are left of a stretch from a sample within it.
    let left = |of: &Drawn, sample: usize| of.edges.checked_sub((sample + count - of.first) % count);
    let part = |start: &Drawn| {
        let ends = [(left(one, start.first)?, one.stretch.to), (left(other, start.first)?, other.stretch.to)];
        let (edges, to) = if ends[1].0 < ends[0].0 { ends[1] } else { ends[0] };
        (edges > 0).then_some(CurveStretch { curve: one.stretch.curve, from: start.stretch.from, to })
    };
    let of_other = if other.first == one.first { None } else { part(other) };
    part(one).into_iter().chain(of_other).collect()
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
    let is_known_between = |bank: &Bank<'_>| matches!(bank, Bank::Fill(..) | Bank::Led(..));
    let steps = if [one, other].iter().all(is_known_between) { 4 } else { 1 };
    let places: Vec<(usize, f64)> =
        (0..=edges * steps).map(|k| (k / steps, (k % steps) as f64 / steps as f64)).collect();
    let points = |bank: Bank<'_>| -> Option<Vec<SurfacePoint>> {
        places
            .iter()
            .map(|(edge, t)| point(model, relaxer, bank, (stretch.curve, first, *edge, *t)))
            .collect()
    };
    let mut found = seam(&points(one)?, &points(other)?)?;
    if [one, other].iter().any(|bank| matches!(bank, Bank::Rim(..))) {
        (found.curvature_jump, found.without_curvature) = (0.0, places.len());
    }
    let Seam { gap, angle, curvature_jump, without_normal, without_curvature, .. } = found;
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
    (curve, first, edge, t): (CurveId, usize, usize, f64),
) -> Option<SurfacePoint> {
    match bank {
        Bank::Fair(id, place) => {
            let shape = model.surfaces.get(&id)?;
            let bound = relaxer.surface(id, shape)?;
            let vertices = &shape.embeddings.get(place)?.vertices;
            let vertex = vertices.get((first + edge) % vertices.len())?;
            let node = bound.node(*vertex) as usize;
            let mean = bound.mean_curvature(node)?;
            let sample = (first + edge) % vertices.len();
            let normal = *bank::along(model, bound, shape.embeddings.get(place)?).get(sample)?;
            Some(osculating(*shape.positions.get(vertex.index())?, normal, mean))
        }
        Bank::Fill(id, at, side) => {
            let built = fill::shape(model, id)?.built.as_ref()?;
            let Drawn { steps, edges, first: own, stretch, .. } = side.drawn;
            let count = model.curves.get(&stretch.curve)?.nodes.len();
            // The seam may begin within the side.
            let whole = (edge + (first + count - own) % count).min(edges);
            let low = side.parameter_of_sample(whole);
            let high = side.parameter_of_sample((whole + 1).min(edges));
            debug_assert!(steps > 0, "an edge is cut into steps");
            let domain = Domain::new(built.patch.sides());
            let u = side.parameter(low + (high - low) * t);
            built.patch.at(&domain, domain.on_side(at, u))
        }
        Bank::Led(_, led) => {
            let drawn = model.curves.get(&curve)?;
            Some(led.on_sampling(drawn, (first + edge) % drawn.nodes.len(), t)?.surface)
        }
        Bank::Rim(_, rim) => {
            let drawn = model.curves.get(&curve)?;
            let at = *drawn.nodes.get((first + edge) % drawn.nodes.len())?;
            Some(osculating(rim.place(at)?, rim.normal(at)?, 0.0))
        }
    }
}

/// A point of a surface of which normal and mean curvature are known: seams ask for no more.
pub(crate) fn osculating(point: DVec3, normal: DVec3, mean: f64) -> SurfacePoint {
    let dx = normal.any_orthonormal_vector();
    let bent = normal * mean;
    SurfacePoint { point, dx, dy: normal.cross(dx), dxx: bent, dxy: DVec3::ZERO, dyy: bent }
}
