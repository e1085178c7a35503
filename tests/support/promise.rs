//! What acts promise of the kinds of surfaces: reckoned from the shapes before the act, without doing it.

use crate::kinds::{Kind, kinds, pieces, sewn};
use ductile_mesh::{EdgeId, VertexId, regions};
use ductile_modeler::{Model, SurfaceShape};
use ductile_spec::{Border, CurveId, Edit, Meeting, On, SurfaceId};
use glam::DVec3;

/// The kinds that there may be after an act if it is done, each list in order; `None` if nothing is promised. Of a trim there
/// is to be told along what lines the surfaces meet.
#[must_use]
pub fn promise(model: &Model, edit: &Edit, met: Option<&Meeting>) -> Option<Vec<Vec<Kind>>> {
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
        Edit::MergeClosest { first: a, second: b, .. }
        | Edit::Merge { from: On { surface: a, .. }, to: On { surface: b, .. }, .. } => {
            let ends = [*a, *b];
            Some(vec![instead(&ends, &[tube(ends, kind)?])])
        }
        Edit::Smooth { curve } => {
            let (gone, made) = joined(model, *curve)?;
            Some(vec![instead(&gone, &made)])
        }
        Edit::Trim { first, second, smooth, .. } => {
            let ends = [first.surface, second.surface];
            let lines = &met?.lines;
            let closed = lines.iter().filter(|line| line.closed).count();
            let all = trimmed([kind(ends[0])?, kind(ends[1])?], (closed, lines.len()), *smooth);
            Some(all.iter().map(|made| instead(&ends, made)).collect())
        }
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

/// The surfaces at a crease, and what becomes of them when its two rims are laid on one another.
fn joined(model: &Model, curve: CurveId) -> Option<(Vec<SurfaceId>, Vec<Kind>)> {
    let closed = model.curves.get(&curve)?.closed;
    let mut rims = Vec::new();
    for (id, shape) in &model.surfaces {
        for embedded in shape.embeddings.iter().filter(|e| e.curve == curve) {
            let edge = shape.mesh.edge_between(embedded.vertices[0], embedded.vertices[1])?;
            if shape.mesh.is_boundary_edge(edge) {
                rims.push((*id, embedded.vertices.clone()));
            }
        }
    }
    let [(one, first), (other, second)] = &mut rims[..] else { return None };
    let mut mesh = model.surfaces[one].mesh.clone();
    if one != other {
        let names = mesh.append(&model.surfaces[other].mesh).vertices;
        for v in second.iter_mut() {
            *v = names[v.index()]?;
        }
    }
    let count = first.len();
    let ends = |line: &[VertexId], k: usize| [line[k], line[(k + 1) % count]];
    let last = if closed { count } else { count - 1 };
    let seam: Vec<_> = (0..last).map(|k| [ends(first, k), ends(second, k)]).collect();
    Some((vec![*one, *other], sewn(&mesh, &seam)))
}

/// What two surfaces may become that are trimmed along so many lines, of which so many close: a part of each, or the whole of
/// one that is not divided, and where it is smooth one surface of both parts.
fn trimmed(kinds: [Kind; 2], (closed, all): (usize, usize), is_smooth: bool) -> Vec<Vec<Kind>> {
    let [one, other] = kinds.map(|kind| parts(kind, all));
    let pairs = one.iter().flat_map(|a| other.iter().map(move |b| [*a, *b]));
    if !is_smooth {
        let stands = parts(kinds[0], all).into_iter().map(|part| [part, kinds[1]]);
        let under = parts(kinds[1], all).into_iter().map(|part| [kinds[0], part]);
        return pairs.chain(stands).chain(under).map(|pair| pair.to_vec()).collect();
    }
    let mut made = Vec::new();
    for [a, b] in pairs {
        for seams in 1..=closed {
            let Some(rims) = (a.1 + b.1).checked_sub(2 * seams).filter(|_| seams <= a.1.min(b.1)) else {
                continue;
            };
            // Along one seam sides can be matched, along several they may clash.
            made.push(vec![(a.0 + b.0, rims, a.2 && b.2)]);
            if seams > 1 {
                made.push(vec![(a.0 + b.0, rims, false)]);
            }
        }
    }
    made
}

/// What parts of a surface may be that so many lines bound: no part has more handles or crosscaps than the whole.
fn parts((euler, rims, is_two_sided): Kind, lines: usize) -> Vec<Kind> {
    let count = |n: usize| i64::try_from(n).expect("surfaces have few rims");
    let most = 2 - euler - count(rims);
    let mut all = Vec::new();
    for own in 1..=rims + lines {
        for crosscaps in 0..=most {
            let kind = |is_two_sided| (2 - crosscaps - count(own), own, is_two_sided);
            // Two crosscaps may be a handle.
            all.extend((crosscaps % 2 == 0).then(|| kind(true)));
            all.extend((!is_two_sided && crosscaps > 0).then(|| kind(false)));
        }
    }
    all
}
