//! How long edges should be, here and there: by curvature, by region, at the ends of curves, and where surfaces of different spacing
//! share a curve.
//!
//! Recipe, section 7 "Sizing". At a vertex where the largest curvature is k, an edge of `0.35 / k` bends by a third of a
//! radian; it is held between 0.35 and 1.6 of the spacing that document, surface or region say. What neighbours want may
//! differ by a quarter of their distance, which keeps triangles of similar size beside each other. Lengths change only
//! when they must change by much, so that a mesh at rest is left alone.

mod bend;
mod ends;
pub(crate) mod neck;
mod relief;
mod skeleton;

pub(crate) use skeleton::of_stretches;

use crate::bound::BoundSurface;
use crate::growth::Ground;
use crate::model::Model;
use crate::region;
use crate::shape::{CurveShape, SurfaceShape, edit};
use ductile_mesh::remesh::Sizing;
use ductile_mesh::{VertexId, regions};
use ductile_spec::{CurveId, Density, Document, Objective, Surface, SurfaceId};
use std::collections::{BTreeMap, BTreeSet};

/// Wanted lengths grow by at most this part of the way along edges.
const SLOPE: f64 = 0.25;
/// A wanted length stays until another differs by more than this part of it. (The limits of splitting and collapsing are a
/// factor of two apart, so lengths within this band undo no edit.)
const BAND: f64 = 0.15;

/// The surfaces whose edges are not to be equally long everywhere by the words of the document: those that say so, and those that
/// meet them, or one of another spacing, at a curve.
pub(crate) fn graded(model: &Model) -> BTreeSet<SurfaceId> {
    graded_and(model, |_| false)
}

/// The same with surfaces that are graded for another reason, and those that meet them.
fn graded_and(model: &Model, is_so_anyway: impl Fn(SurfaceId) -> bool) -> BTreeSet<SurfaceId> {
    let document = &model.document;
    let says_so = |id: SurfaceId, surface: &Surface| {
        document.density_of_surface(id) == Density::Curvature
            || surface.regions.iter().any(|region| region.spacing.is_some() || region.shadow.is_some())
    };
    let all = document.surfaces.iter();
    let mut graded: BTreeSet<_> =
        all.filter(|(id, surface)| says_so(**id, surface) || is_so_anyway(**id)).map(|(id, _)| *id).collect();
    loop {
        let before = graded.len();
        for curve in document.curves.keys() {
            let meeting: Vec<_> = document.surfaces_on(*curve).collect();
            let differ =
                meeting.windows(2).any(|pair| model.spacing_of(pair[0]) != model.spacing_of(pair[1]));
            if differ || meeting.iter().any(|id| graded.contains(id)) {
                graded.extend(meeting);
            }
        }
        if graded.len() == before {
            return graded;
        }
    }
}

/// Brings the wanted lengths of all surfaces up to their shapes, as far as these have come to themselves.
pub(crate) fn update(
    model: &mut Model,
    bound: &BTreeMap<SurfaceId, BoundSurface>,
    is_steady: impl Fn(SurfaceId) -> bool,
) {
    let bound =
        |id: &SurfaceId, shape: &SurfaceShape| bound.get(id).filter(|bound| bound.revision == shape.revision);
    let mut fields: BTreeMap<SurfaceId, Vec<f64>> = BTreeMap::new();
    let mut thin = BTreeSet::new();
    for (id, shape) in &model.surfaces {
        let Some(surface) = model.document.surfaces.get(id) else { continue };
        let mut field = own(shape, surface, 1.0);
        relief::shorten(&mut field, model, shape, surface);
        let around_ends = ends::longest(&field, model, shape);
        let (density, bound) = (model.document.density_of_surface(*id), bound(id, shape));
        if let (Density::Curvature, Some(bound)) = (density, bound) {
            bend::shorten(&mut field, bound);
        }
        field.iter_mut().zip(around_ends).for_each(|(h, end)| *h = h.min(end));
        if density == Density::Uniform
            && is_plate(&model.document, *id, surface)
            && let Some(parts) = neck::parts(model, &field, shape, (bound, is_steady(*id)))
        {
            field.iter_mut().zip(parts).for_each(|(h, part)| *h *= part);
            thin.insert(*id);
        }
        fields.insert(*id, field);
    }
    let ends_inside = |id| model.surfaces.get(&id).is_some_and(|shape| ends::has_any(model, shape));
    let graded = graded_and(model, |id| thin.contains(&id) || ends_inside(id));
    fields.retain(|id, _| graded.contains(id));
    for (_, shape) in
        model.surfaces.iter_mut().filter(|(id, shape)| !graded.contains(id) && !shape.wanted.is_empty())
    {
        edit(shape).wanted.clear();
    }
    // Twice: the second time a surface hears what has spread to its curves from the far side of its neighbour.
    for _ in 0..fields.len().min(2) {
        meet(model, &mut fields);
        for (id, field) in &mut fields {
            if let Some(shape) = model.surfaces.get(id) {
                spread(shape, field);
            }
        }
    }
    for (id, field) in fields {
        if let Some(shape) = model.surfaces.get_mut(&id).map(edit::<SurfaceShape>) {
            keep(&mut shape.wanted, field);
        }
    }
}

/// Whether the curves inside of surfaces ask for edges so much shorter than those that there are that the next batch would come too late.
pub(crate) fn is_overdue(model: &Model, bound: &BTreeMap<SurfaceId, BoundSurface>) -> bool {
    let has_own = |id: SurfaceId, surface: &Surface| {
        model.document.density_of_surface(id) == Density::Uniform && is_plate(&model.document, id, surface)
    };
    model.surfaces.iter().any(|(id, shape)| {
        let surface = model.document.surfaces.get(id).filter(|surface| has_own(*id, surface));
        let bound = bound.get(id).filter(|bound| bound.revision == shape.revision);
        surface.and(bound).is_some_and(|bound| neck::is_overdue(&model.curves, shape, bound))
    })
}

/// Brings the wanted lengths of a surface that is not yet in a model up to the necks that its curves hold. Its solver is fitted.
pub(crate) fn begin_necks(ground: &Ground<'_>, shape: &mut SurfaceShape, bound: &BoundSurface) {
    let (document, id) = (ground.document, ground.id);
    let has_own = |surface: &&Surface| {
        document.density_of_surface(id) == Density::Uniform && is_plate(document, id, surface)
    };
    let Some(surface) = document.surfaces.get(&id).filter(has_own) else { return };
    let mut field = own(shape, surface, 1.0);
    let Some(parts) = neck::held(ground.curves, &field, shape, bound) else { return };
    field.iter_mut().zip(parts).for_each(|(h, part)| *h *= part);
    spread(shape, &mut field);
    keep(&mut shape.wanted, field);
}

/// Whether it is bending alone that a surface minimises, everywhere. A film bends without bound at a point that holds it, however fine
/// its mesh, and what is `fair` does not draw together.
fn is_plate(document: &Document, id: SurfaceId, surface: &Surface) -> bool {
    let is_bending = |objective| matches!(objective, Objective::ThinPlate | Objective::Neutral);
    let mut objectives = surface.regions.iter().filter_map(|region| region.objective);
    is_bending(document.objective_of_surface(id)) && objectives.all(is_bending)
}

/// What a surface wants before it is bound: its own lengths and those of the edges of its curves, `coarseness` times as long
/// while its curves are being laid.
pub(crate) fn begin(shape: &mut SurfaceShape, surface: &Surface, coarseness: usize) {
    let mut field = own(shape, surface, coarseness as f64);
    for e in shape.mesh.edges().filter(|&e| shape.mesh.is_source_edge(e)) {
        let [a, b] = shape.mesh.edge_vertices(e);
        let length = shape.positions[a.index()].distance(shape.positions[b.index()]);
        for v in [a, b] {
            field[v.index()] = field[v.index()].min(length);
        }
    }
    spread(shape, &mut field);
    shape.wanted = field;
}

/// What is wanted along a curve.
pub(crate) enum Along {
    /// The same everywhere.
    Even(f64),
    /// A length for each sample.
    Graded(Vec<f64>),
}

impl Along {
    /// The length wanted of an edge of the curve.
    pub(crate) fn edge(&self, shape: &CurveShape, edge: usize) -> f64 {
        match self {
            Self::Even(spacing) => *spacing,
            Self::Graded(wanted) => {
                let (a, b) = shape.edge(edge);
                wanted[a].midpoint(wanted[b])
            }
        }
    }
}

/// What is wanted along a curve: the least that any surface wants there; of a free curve, what suits itself.
pub(crate) fn along(model: &Model, id: CurveId) -> Along {
    let followers: Vec<_> = model.document.surfaces_on(id).filter_map(|s| model.surfaces.get(&s)).collect();
    let least =
        followers.iter().map(|shape| shape.spacing).reduce(f64::min).unwrap_or_else(|| model.spacing());
    let Some(curve) = model.curves.get(&id) else { return Along::Even(least) };
    if followers.iter().any(|shape| !shape.wanted.is_empty()) {
        let mut wanted = vec![f64::INFINITY; curve.nodes.len()];
        for shape in followers {
            for embedded in shape.embeddings.iter().filter(|e| e.curve == id) {
                for (sample, v) in wanted.iter_mut().zip(&embedded.vertices) {
                    *sample = sample.min(shape.wanted_at(*v));
                }
            }
        }
        // A sample that no surface follows (there is none) would want nothing.
        wanted.iter_mut().filter(|h| !h.is_finite()).for_each(|h| *h = least);
        return Along::Graded(wanted);
    }
    if followers.is_empty() && model.document.density == Density::Curvature {
        return Along::Graded(bend::of_curve(curve, least, SLOPE));
    }
    Along::Even(least)
}

/// What a surface wants by the words of the document: its spacing, or that of its regions. Where regions meet, the finer.
fn own(shape: &SurfaceShape, surface: &Surface, coarseness: f64) -> Vec<f64> {
    let mut field = vec![shape.spacing * coarseness; shape.mesh.vertex_slots()];
    if surface.regions.iter().all(|region| region.spacing.is_none()) {
        return field;
    }
    let labels = regions(&shape.mesh);
    let spacings = region::own(shape, &labels, &surface.regions, |region| region.spacing);
    field.fill(f64::INFINITY);
    for f in shape.mesh.faces() {
        let wanted = spacings[labels.of(f)].unwrap_or(shape.spacing) * coarseness;
        for v in shape.mesh.face_vertices(f) {
            field[v.index()] = field[v.index()].min(wanted);
        }
    }
    field
}

/// Lets every sample of a curve want the least that any surface wants there, or that the curve's own bends want.
fn meet(model: &Model, fields: &mut BTreeMap<SurfaceId, Vec<f64>>) {
    for (id, curve) in &model.curves {
        let followers: Vec<_> = model.document.surfaces_on(*id).filter(|s| fields.contains_key(s)).collect();
        let by_curvature =
            followers.iter().any(|s| model.document.density_of_surface(*s) == Density::Curvature);
        let spacing = followers.iter().map(|s| model.spacing_of(*s)).fold(f64::INFINITY, f64::min);
        let mut least = if by_curvature {
            bend::of_curve(curve, spacing, SLOPE)
        } else {
            vec![f64::INFINITY; curve.nodes.len()]
        };
        let on_curve = |s: &SurfaceId| -> Vec<VertexId> {
            let embeddings = model.surfaces.get(s).map_or(&[][..], |shape| &shape.embeddings);
            embeddings.iter().filter(|e| e.curve == *id).flat_map(|e| e.vertices.iter().copied()).collect()
        };
        for s in &followers {
            for (least, v) in least.iter_mut().zip(on_curve(s)) {
                *least = least.min(fields[s][v.index()]);
            }
        }
        for s in &followers {
            let vertices = on_curve(s);
            if let Some(field) = fields.get_mut(s) {
                vertices.iter().zip(&least).for_each(|(v, least)| field[v.index()] = *least);
            }
        }
    }
}

/// Bounds the slope of a field along the edges of its surface.
fn spread(shape: &SurfaceShape, field: &mut Vec<f64>) {
    let seeds: Vec<_> = shape.mesh.vertices().map(|v| (v, field[v.index()])).collect();
    let most = seeds.iter().map(|(_, h)| *h).fold(0.0, f64::max);
    if let Sizing::PerVertex(all) = Sizing::spread(&shape.mesh, &shape.positions, &seeds, SLOPE, most) {
        *field = all;
    }
}

/// Takes over the lengths that differ by much.
fn keep(wanted: &mut Vec<f64>, field: Vec<f64>) {
    wanted.resize(field.len(), f64::INFINITY);
    for (kept, new) in wanted.iter_mut().zip(field) {
        // Written so that a length that is none is replaced.
        if !((new - *kept).abs() <= BAND * *kept && kept.is_finite()) {
            *kept = new;
        }
    }
}
