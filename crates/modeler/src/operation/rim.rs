//! `rim`: the rim of an open cage, or a part of it, becomes a control curve. The curve goes where the rim goes, exactly: the cage leads,
//! and what follows the curve follows the cage.

use crate::error::{ModelError, RimError};
use crate::model::Model;
use crate::operation::insert_vertex;
use crate::patch::caged;
use ductile_spec::{Cage, Curve, CurveId, Document, PointId, RimEdge, SurfaceId};
use std::collections::BTreeMap;

/// Makes a curve of the rim that has an edge: all round, or from where the rim turns to where it turns next; or of what of that lies
/// between two vertices. It has the cage on its left.
pub(super) fn rim(
    model: &mut Model,
    surface: SurfaceId,
    ends: [PointId; 2],
    between: Option<[PointId; 2]>,
) -> Result<(), ModelError> {
    let rim = caged(&model.document, surface, "A rim curve")?.rim();
    let is_edge = |[from, to]: &[PointId; 2]| rim.get(from).is_some_and(|edge| edge.to == *to);
    let start = [ends, [ends[1], ends[0]]].into_iter().find(is_edge);
    let [from, to] = start.ok_or(RimError::NoEnd { surface, ends })?;
    let (through, closed) = match between {
        None => whole(&rim, from),
        Some(between) => {
            let (all, closed) = whole(&rim, from);
            let part = part(&all, closed, [from, to], between);
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

/// The vertices of the stretch that has the edge which begins at one, and whether it closes.
fn whole(rim: &BTreeMap<PointId, RimEdge>, from: PointId) -> (Vec<PointId>, bool) {
    let before: BTreeMap<PointId, PointId> = rim.iter().map(|(from, edge)| (edge.to, *from)).collect();
    let turns = |point: PointId| rim.get(&point).is_none_or(|edge| edge.turns);
    let mut first = from;
    for _ in 0..rim.len() {
        match before.get(&first) {
            Some(point) if *point != from && !turns(first) => first = *point,
            _ => break,
        }
    }
    let closes = !turns(first);
    if closes {
        first = from;
    }
    let (mut through, mut at) = (vec![first], first);
    while let Some(edge) = rim.get(&at) {
        at = edge.to;
        if closes && at == first {
            break;
        }
        through.push(at);
        if turns(at) || through.len() > rim.len() {
            break;
        }
    }
    (through, closes)
}

/// What of a stretch lies between two of its vertices and has an edge.
fn part(
    all: &[PointId],
    closed: bool,
    [from, to]: [PointId; 2],
    between: [PointId; 2],
) -> Option<Vec<PointId>> {
    let count = all.len();
    let place = |point: PointId| all.iter().position(|other| *other == point);
    let [a, b] = [place(between[0])?, place(between[1])?];
    let run = |first: usize, last: usize| -> Option<Vec<PointId>> {
        let steps = if last > first {
            last - first
        } else if closed && first != last {
            last + count - first
        } else {
            return None;
        };
        let run: Vec<PointId> = (0..=steps).map(|step| all[(first + step) % count]).collect();
        run.windows(2).any(|pair| pair == [from, to]).then_some(run)
    };
    run(a, b).or_else(|| run(b, a))
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
