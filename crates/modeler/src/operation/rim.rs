//! `rim`: the rim of an open cage, or a part of it, becomes a control curve. The curve goes where the rim goes, exactly: the cage leads,
//! and what follows the curve follows the cage.

use crate::error::{ModelError, RimError};
use crate::model::Model;
use crate::operation::insert_vertex;
use crate::patch::caged;
use ductile_spec::{Cage, Curve, CurveId, Document, PointId, SurfaceId};

/// Makes a curve of the rim that has an edge: all round, or from where the rim turns to where it turns next; or of what of that lies
/// between two vertices. It has the cage on its left.
pub(super) fn rim(
    model: &mut Model,
    surface: SurfaceId,
    ends: [PointId; 2],
    between: Option<[PointId; 2]>,
) -> Result<(), ModelError> {
    let cage = caged(&model.document, surface, "A rim curve")?;
    let edge = cage.rim_edge(ends).ok_or(RimError::NoEnd { surface, ends })?;
    let (through, closed) = match between {
        None => cage.rim_stretch(edge[0]),
        Some(between) => {
            let part = cage.rim_between(edge, between);
            (part.ok_or(RimError::NotBetween { surface, between })?, false)
        }
    };
    // All round a triangle there is a closed curve; two edges that close are no rim.
    let doubled = model.document.curves.iter().find(|(_, curve)| {
        let runs_along = |[a, b]: [PointId; 2]| {
            let count = curve.through.len();
            let edges = if curve.closed { count } else { count - 1 };
            (0..edges).any(|k| {
                let (c, d) = (curve.through[k], curve.through[(k + 1) % count]);
                [a, b] == [c, d] || [a, b] == [d, c]
            })
        };
        curve.rim == Some(surface) && edges(&through, closed).any(runs_along)
    });
    if let Some((curve, _)) = doubled {
        return Err(RimError::Doubled { curve: *curve, surface }.into());
    }
    let id = model.document.next_curve();
    let curve = Curve { rim: Some(surface), ..Curve::new(through, closed) };
    model.document_mut().curves.insert(id, curve);
    model.document.validate()?;
    model.build_curve(id)
}

fn edges(through: &[PointId], closed: bool) -> impl Iterator<Item = [PointId; 2]> + '_ {
    let next = through.iter().skip(1).chain(through.first().filter(|_| closed));
    through.iter().zip(next).map(|(a, b)| [*a, *b])
}

/// Sets those curves free that are rims no more: they stay where they are, and are fair from now on.
pub(crate) fn free_lost(document: &mut Document) {
    let is_lost = |id: &CurveId| document.rim_defect(*id).is_some();
    let lost: Vec<CurveId> = document.curves.keys().copied().filter(is_lost).collect();
    for id in lost {
        if let Some(curve) = document.curves.get_mut(&id) {
            curve.rim = None;
        }
    }
}

/// Lets a rim pass through a new vertex of its cage that divides an edge at which the cage ends.
///
/// # Errors
/// When the samples of the curve leave no room for it.
pub(crate) fn split(model: &mut Model, surface: SurfaceId, vertex: PointId) -> Result<(), ModelError> {
    let Some(rim) = model.document.cages.get(&surface).map(Cage::rim) else { return Ok(()) };
    let to = rim.get(&vertex).map(|edge| edge.to);
    let from = rim.iter().find(|(_, edge)| edge.to == vertex).map(|(from, _)| *from);
    let Some((from, to)) = from.zip(to) else { return Ok(()) };
    let has_edge = |curve: &Curve| {
        curve.rim == Some(surface)
            && edges(&curve.through, curve.closed).any(|edge| edge == [from, to] || edge == [to, from])
    };
    let divided = model.document.curves.iter().find(|(_, curve)| has_edge(curve)).map(|(id, _)| *id);
    let at = model.point(vertex)?;
    divided.map_or(Ok(()), |id| insert_vertex(model, id, at, vertex))
}

/// Refuses an act on a curve that a rim leads.
pub(crate) fn check_free(document: &Document, curve: CurveId, why: &'static str) -> Result<(), ModelError> {
    match document.curves.get(&curve).and_then(|curve| curve.rim) {
        Some(surface) => Err(RimError::Leads { curve, surface, why }.into()),
        None => Ok(()),
    }
}
