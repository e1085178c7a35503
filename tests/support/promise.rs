//! What acts promise of the kinds of surfaces: reckoned from the shapes before the act, without doing it.

use crate::kinds::{Kind, kinds, pieces};
use ductile_mesh::{EdgeId, regions};
use ductile_modeler::{Model, SurfaceShape};
use ductile_spec::{Border, CurveId, Edit, On, SurfaceId};
use glam::DVec3;

/// The kinds that there may be after an act if it is done, each list in order; `None` if nothing is promised.
#[must_use]
pub fn promise(model: &Model, edit: &Edit) -> Option<Vec<Vec<Kind>>> {
    // Places on a displaced surface are carried back to the one below, which is not done again here.
    let is_shadowed =
        |surface: &ductile_spec::Surface| surface.regions.iter().any(|region| region.shadow.is_some());
    if !model.document.displacements.is_empty() || model.document.surfaces.values().any(is_shadowed) {
        return None;
    }
    let now = kinds(model);
    let without = |gone: &[SurfaceId]| -> Vec<Kind> {
        now.iter().filter(|(id, _)| !gone.contains(id)).map(|(_, kind)| *kind).collect()
    };
    let kind = |id: SurfaceId| now.iter().find(|(other, _)| *other == id).map(|(_, kind)| *kind);
    let instead = |gone: &[SurfaceId], new: &[Kind]| {
        let mut all = without(gone);
        all.extend_from_slice(new);
        all.sort_unstable();
        all
    };
    match edit {
        Edit::Sheet { .. } => Some(vec![instead(&[], &[(1, 1, true)])]),
        Edit::Sweep { from, stretches, .. } => {
            let closed = model.curves.get(from)?.closed && stretches.iter().all(Option::is_none);
            Some(vec![instead(&[], &[if closed { (0, 2, true) } else { (1, 1, true) }])])
        }
        Edit::Burnout { region } => {
            let (shape, is_in) = region_at(model, *region)?;
            let left = pieces(&shape.mesh, |_| false, |f| !is_in[f]);
            Some(vec![instead(&[region.surface], &left)])
        }
        Edit::Split { border } | Edit::Crease { border } => {
            let (id, left) = cut(model, *border)?;
            Some(vec![instead(&[id], &left)])
        }
        Edit::Glue { from, to, reversed, .. } => {
            let (one, other) = (kind(from.surface)?, kind(to.surface)?);
            if from.surface == to.surface {
                let made = (one.0, one.1.checked_sub(2)?, one.2 && !reversed);
                return Some(vec![instead(&[from.surface], &[made])]);
            }
            let made = (one.0 + other.0, (one.1 + other.1).checked_sub(2)?, one.2 && other.2);
            Some(vec![instead(&[from.surface, to.surface], &[made])])
        }
        Edit::MergeClosest { first, second, .. } => {
            Some(vec![instead(&[*first, *second], &[tube([*first, *second], kind)?])])
        }
        Edit::Merge { from, to, .. } => {
            let ends = [from.surface, to.surface];
            Some(vec![instead(&ends, &[tube(ends, kind)?])])
        }
        Edit::Smooth { curve } => {
            let (gone, made) = joined(model, *curve, &kind)?;
            Some(made.into_iter().map(|made| instead(&gone, &[made])).collect())
        }
        // What it leaves depends on where the surfaces meet.
        Edit::Trim { .. } => None,
        Edit::DeleteSurface { surface } | Edit::Bake { surface } => Some(vec![instead(&[*surface], &[])]),
        _ => Some(vec![instead(&[], &[])]),
    }
}

/// What a tube between two surfaces makes of them, or of one.
fn tube(ends: [SurfaceId; 2], kind: impl Fn(SurfaceId) -> Option<Kind>) -> Option<Kind> {
    let [one, other] = [kind(ends[0])?, kind(ends[1])?];
    Some(if ends[0] == ends[1] {
        (one.0 - 2, one.1, one.2)
    } else {
        (one.0 + other.0 - 2, one.1 + other.1, one.2 && other.2)
    })
}

/// The shape at a place, and by face slot what belongs to the region there.
fn region_at(model: &Model, on: On) -> Option<(&SurfaceShape, Vec<bool>)> {
    let shape: &SurfaceShape = model.surfaces.get(&on.surface)?;
    let middle =
        |f| shape.mesh.face_vertices(f).map(|v| shape.positions[v.index()]).iter().sum::<DVec3>() / 3.0;
    let nearest = shape
        .mesh
        .faces()
        .min_by(|f, g| middle(*f).distance_squared(on.at).total_cmp(&middle(*g).distance_squared(on.at)))?;
    let labels = regions(&shape.mesh);
    let mut is_in = vec![false; shape.mesh.face_slots()];
    for f in shape.mesh.faces() {
        is_in[f.index()] = labels.of(f) == labels.of(nearest);
    }
    Some((shape, is_in))
}

/// What a surface falls into that is cut along a border.
fn cut(model: &Model, border: Border) -> Option<(SurfaceId, Vec<Kind>)> {
    match border {
        Border::Region(on) => {
            let (shape, is_in) = region_at(model, on)?;
            let parts = |e: EdgeId| match shape.mesh.edge_faces(e) {
                (f, Some(g)) => is_in[f.index()] != is_in[g.index()],
                _ => false,
            };
            Some((on.surface, pieces(&shape.mesh, parts, |_| true)))
        }
        Border::Curve(curve) => {
            let lies = |e: EdgeId, shape: &SurfaceShape| {
                shape.mesh.edge_source(e).is_some_and(|tag| tag.0 == curve.0)
                    && !shape.mesh.is_boundary_edge(e)
            };
            let (id, shape) =
                model.surfaces.iter().find(|(_, shape)| shape.mesh.edges().any(|e| lies(e, shape)))?;
            Some((*id, pieces(&shape.mesh, |e| lies(e, shape), |_| true)))
        }
    }
}

/// The surfaces at a crease, and what they may become: along an open curve it depends on how its ends lie how many rims there are,
/// and whether a surface that meets itself gets one side depends on its sense.
fn joined(
    model: &Model,
    curve: CurveId,
    kind: &dyn Fn(SurfaceId) -> Option<Kind>,
) -> Option<(Vec<SurfaceId>, Vec<Kind>)> {
    let closed = model.curves.get(&curve)?.closed;
    let mut rims = Vec::new();
    for (id, shape) in &model.surfaces {
        for embedded in shape.embeddings.iter().filter(|e| e.curve == curve) {
            let edge = shape.mesh.edge_between(embedded.vertices[0], embedded.vertices[1])?;
            if shape.mesh.is_boundary_edge(edge) {
                rims.push((*id, &embedded.vertices));
            }
        }
    }
    let [(one, first), (other, second)] = rims[..] else { return None };
    let (a, b) = (kind(one)?, kind(other)?);
    let shared = if one == other { first.iter().filter(|v| second.contains(v)).count() } else { 0 };
    let shared = i64::try_from(shared).ok()?;
    // Of what was twice there is one less: as many vertices as edges round a closed curve.
    let less = shared - i64::from(!closed);
    let (euler, rims, is_two_sided) =
        if one == other { (a.0, a.1, a.2) } else { (a.0 + b.0, a.1 + b.1, a.2 && b.2) };
    let mut made = Vec::new();
    let is_plain = closed && shared == 0;
    for change in if is_plain { vec![2] } else { vec![0, 1, 2] } {
        // An open seam leaves one rim more than there was at most.
        let Some(left) = (rims + usize::from(!is_plain)).checked_sub(change) else { continue };
        made.push((euler + less, left, is_two_sided));
        if one == other && is_two_sided {
            made.push((euler + less, left, false));
        }
    }
    Some((vec![one, other], made))
}
