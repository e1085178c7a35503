//! Rims: boundary loops of surfaces, found by a place, joined by a band or laid on one another (thesis section 7.3.5).

use crate::error::{ModelError, TouchError};
use crate::model::Model;
use crate::operation::delete::forget_lost_curves;
use crate::operation::{forget_lost, refresh_skeleton};
use crate::rehydrate::has_extent;
use crate::shape::{EmbeddedCurve, SurfaceShape, edit};
use crate::surgery::arching::Arch;
use crate::surgery::joining::{Told, United, say, sew, split, unite};
use crate::surgery::opening::edges_of;
use ductile_mesh::{
    Bridge, BridgeError, FaceId, Mesh, Seam, Sense, VertexId, boundary_loops, propagate_orientation,
};
use ductile_spec::{On, SurfaceId};
use glam::DVec3;
use std::sync::Arc;

/// Edges that may be split to make room.
const PATIENCE: usize = 10_000;

/// A boundary loop: its vertices in order. Where windings agree the surface lies to its left.
pub(crate) type Rim = Vec<VertexId>;

/// The rim nearest to a place.
pub(crate) fn rim_at(model: &Model, on: On) -> Result<Rim, ModelError> {
    if !on.at.is_finite() {
        return Err(ModelError::BadPosition);
    }
    let shape = model.surfaces.get(&on.surface).ok_or(ModelError::NoSurface(on.surface))?;
    let distance = |rim: &Rim| {
        let next = rim.iter().cycle().skip(1);
        let edges = rim.iter().zip(next).map(|(a, b)| [*a, *b].map(|v| shape.positions[v.index()]));
        edges.map(|[a, b]| distance_to_edge(on.at, a, b)).fold(f64::INFINITY, f64::min)
    };
    let rims = boundary_loops(&shape.mesh);
    let nearest = rims.into_iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.ok_or(ModelError::NoRim(on.surface))
}

fn distance_to_edge(at: DVec3, a: DVec3, b: DVec3) -> f64 {
    let t = (at - a).dot(b - a) / (b - a).length_squared();
    a.lerp(b, if t.is_finite() { t.clamp(0.0, 1.0) } else { 0.0 }).distance(at)
}

/// Brings two rims into one surface. Gives them as they are called there.
fn together(
    model: &mut Model,
    (one, first): (SurfaceId, Rim),
    (other, second): (SurfaceId, Rim),
) -> Result<(Told, Rim, Rim), ModelError> {
    if one == other && first.iter().any(|v| second.contains(v)) {
        return Err(ModelError::SameRim(one));
    }
    let United { told, names } = unite(model, one, other)?;
    let name = |v: VertexId| names.get(v.index()).copied().flatten().unwrap_or(v);
    let second = second.into_iter().map(name).collect();
    Ok((told, first, second))
}

/// Closes the space between two rims with a band. The rims become inner lines; the second surface becomes part of the first.
/// Where control points are to meet and both have as many, it joins them. Gives a face of the band.
pub(crate) fn band(
    model: &mut Model,
    one: (SurfaceId, Rim),
    other: (SurfaceId, Rim),
    (reversed, do_meet): (bool, bool),
) -> Result<FaceId, ModelError> {
    let id = one.0;
    let is_handle = one.0 == other.0;
    let (told, mut first, mut second) = together(model, one, other)?;
    if let Some(at) =
        common_place(&model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?.positions, &first, &second)
    {
        return Err(TouchError::Rims(at).into());
    }
    for _ in 0..PATIENCE {
        let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
        let arch = Arch::between(shape, &first, &second);
        let sense = match (is_handle, reversed) {
            (true, false) => Sense::Oriented,
            (true, true) => Sense::Reversed,
            // The ends of an arch run round opposite ways.
            (false, _) if let Some(arch) = arch => {
                if arch.is_opposite == reversed {
                    second.reverse();
                }
                Sense::AsGiven
            }
            (false, false) => Sense::Shortest,
            (false, true) => longest(shape, &first, &mut second),
        };
        let on = |rim| if do_meet { controls_on(shape, rim) } else { Rim::new() };
        let nodes = [on(&first), on(&second)];
        let bridge = Bridge { one: first.clone(), other: second.clone(), nodes, is_closed: true, sense };
        let arch = arch.filter(|_| !reversed);
        let positions = arch.map(|arch| arch.unfolded(&shape.positions, &second));
        let positions = positions.unwrap_or_else(|| shape.positions.clone());
        match shape.mesh.can_bridge(&bridge, &positions) {
            Ok(()) => {
                let revision = model.next_revision();
                let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
                let before = beside(&shape.mesh, &first);
                let bridged = shape.mesh.bridge(&bridge, &positions).map_err(ModelError::NoBand)?;
                let new = beside(&shape.mesh, &first).into_iter().find(|face| !before.contains(face));
                propagate_orientation(&mut shape.mesh);
                shape.revision = revision;
                if let Some(arch) = arch {
                    arch.raise(model, id, &bridged.rungs);
                }
                refresh_skeleton(model, id);
                say(model, id, &told);
                model.document.validate()?;
                return new.ok_or(ModelError::NoRim(id));
            }
            Err(BridgeError::SecondEdge(edge)) => {
                let ends = shape.mesh.edge_vertices(edge);
                let new = split(model, id, edge)?;
                for rim in [&mut first, &mut second] {
                    insert_between(rim, ends, new);
                }
            }
            Err(why) => return Err(ModelError::NoBand(why)),
        }
    }
    Err(ModelError::NoBand(BridgeError::TooShort(first.len().min(second.len()))))
}

/// A place at which two rims have a vertex each.
fn common_place(positions: &[DVec3], first: &Rim, second: &Rim) -> Option<DVec3> {
    let at = |v: &VertexId| positions[v.index()];
    let size = first.iter().chain(second).map(|v| at(v).abs().max_element()).fold(0.0, f64::max);
    let meets = |here: &DVec3| second.iter().any(|w| !has_extent(at(w).distance(*here), size));
    first.iter().map(at).find(meets)
}

/// The faces beside the first edge of a rim.
fn beside(mesh: &Mesh, rim: &Rim) -> Vec<FaceId> {
    let edge = rim.first().zip(rim.get(1)).and_then(|(a, b)| mesh.edge_between(*a, *b));
    edge.map(|edge| mesh.edge_faces(edge)).into_iter().flat_map(|(f, g)| [Some(f), g]).flatten().collect()
}

/// Gives the second rim the sense that makes the longer band.
fn longest(shape: &SurfaceShape, first: &Rim, second: &mut Rim) -> Sense {
    let cost = |rim: &Rim| best_turn(&shape.positions, first, rim).1;
    let turned: Rim = second.iter().rev().copied().collect();
    if cost(second) < cost(&turned) {
        *second = turned;
    }
    Sense::AsGiven
}

/// A vertex that was made in the middle of an edge of a rim belongs to the rim.
fn insert_between(rim: &mut Rim, ends: [VertexId; 2], new: VertexId) {
    let count = rim.len();
    let is_there = |k: &usize| {
        let pair = [rim[*k], rim[(k + 1) % count]];
        pair == ends || pair == [ends[1], ends[0]]
    };
    if let Some(k) = (0..count).find(is_there) {
        rim.insert(k + 1, new);
    }
}

/// Where a loop must begin to lie nearest to another one, place by place along both, and the sum of squared distances. What
/// both are away from each other as wholes does not count.
fn best_turn(positions: &[DVec3], fixed: &Rim, turned: &Rim) -> (usize, f64) {
    let at = |v: &VertexId| positions[v.index()];
    let centre = |rim: &Rim| rim.iter().map(at).sum::<DVec3>() / rim.len().max(1) as f64;
    let shift = centre(fixed) - centre(turned);
    let (n, m) = (fixed.len(), turned.len());
    let cost = |start: usize| -> f64 {
        let pairs = (0..n).map(|k| (&fixed[k], &turned[(start + k * m / n) % m]));
        pairs.map(|(v, w)| (at(v) - at(w) - shift).length_squared()).sum()
    };
    let all = (0..m).map(|start| (start, cost(start)));
    all.min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, f64::INFINITY))
}

/// Lays the second rim on the first. The curves of the second are no longer followed there. If both have as many control
/// points, control points come to lie on control points, of which those of the first stay.
pub(crate) fn lay(
    model: &mut Model,
    one: (SurfaceId, Rim),
    other: (SurfaceId, Rim),
    reversed: bool,
) -> Result<SurfaceId, ModelError> {
    let id = one.0;
    let is_handle = one.0 == other.0;
    let before = Arc::clone(model.surfaces.get(&other.0).ok_or(ModelError::NoSurface(other.0))?);
    let (told, first, second) = together(model, one, other)?;
    let own = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let controls = [&first, &second].map(|rim| controls_on(own, rim));
    free(model, id, &second)?;
    let sense = if is_handle { Some(!reversed) } else { None };
    let (first, gone) = if controls[0].len() == controls[1].len() && !controls[0].is_empty() {
        meet(model, id, [first, second], &controls, (sense, reversed))?
    } else {
        even(model, id, [first, second], (sense, reversed))?
    };
    sew_loops(model, id, first, gone)?;
    refresh_skeleton(model, id);
    say(model, id, &told);
    forget_lost_curves(model, &before);
    forget_lost(model);
    model.document.validate()?;
    Ok(id)
}

/// The control points of a rim, in order.
fn controls_on(shape: &SurfaceShape, rim: &Rim) -> Rim {
    rim.iter().copied().filter(|v| shape.mesh.is_source_vertex(*v)).collect()
}

/// Whether the second of two rims is to be turned round, if that is known, and whether it is to lie the other way round than
/// lies nearest.
type Wanted = (Option<bool>, bool);

/// Two rims with as many vertices, whichever there are, turned as they lie nearest to each other.
fn even(
    model: &mut Model,
    id: SurfaceId,
    [mut first, mut second]: [Rim; 2],
    (sense, reversed): Wanted,
) -> Result<(Rim, Rim), ModelError> {
    while first.len() != second.len() {
        let rim = if first.len() < second.len() { &mut first } else { &mut second };
        lengthen(model, id, rim, true)?;
    }
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let (is_turned, [plain, opposite]) = nearest(shape, &first, &second, (sense, reversed));
    if is_turned {
        second.reverse();
    }
    second.rotate_left(if is_turned { opposite } else { plain });
    Ok((first, second))
}

/// Whether the second of two rims is to be turned round, and where it begins either way. Both run with the surface to their
/// left; one the other way lies along the other.
fn nearest(shape: &SurfaceShape, first: &Rim, second: &Rim, (sense, reversed): Wanted) -> (bool, [usize; 2]) {
    let turned: Rim = second.iter().rev().copied().collect();
    let [plain, opposite] = [second, &turned].map(|rim| best_turn(&shape.positions, first, rim));
    let is_turned = sense.unwrap_or((opposite.1 <= plain.1) != reversed);
    (is_turned, [plain.0, opposite.0])
}

/// Two rims whose control points correspond: those belong together which lie nearest to each other in order, and each stretch
/// between two of them gets as many vertices as the longer one has (thesis section 4.2.2).
fn meet(
    model: &mut Model,
    id: SurfaceId,
    [first, mut second]: [Rim; 2],
    [own, theirs]: &[Rim; 2],
    wanted: Wanted,
) -> Result<(Rim, Rim), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    // One or two points run both ways.
    let (one, other) = if own.len() < 3 { (&first, &second) } else { (own, theirs) };
    let (is_turned, _) = nearest(shape, one, other, wanted);
    let mut theirs = theirs.clone();
    if is_turned {
        second.reverse();
        theirs.reverse();
    }
    let (start, _) = best_turn(&shape.positions, own, &theirs);
    theirs.rotate_left(start);
    let seam = Seam { kept: first, gone: second, is_closed: true };
    let stretches = seam.stretches([own, &theirs]).map_err(ModelError::Unjoinable)?;
    let (mut kept, mut gone) = (Rim::new(), Rim::new());
    for [mut one, mut other] in stretches {
        while one.len() != other.len() {
            let shorter = if one.len() < other.len() { &mut one } else { &mut other };
            lengthen(model, id, shorter, false)?;
        }
        // The last vertex of a stretch is the first of the next.
        kept.extend(one.iter().take(one.len() - 1));
        gone.extend(other.iter().take(other.len() - 1));
    }
    Ok((kept, gone))
}

/// Sews two loops vertex by vertex. Room is made by splits away from both, or of both alike.
fn sew_loops(model: &mut Model, id: SurfaceId, kept: Rim, gone: Rim) -> Result<(), ModelError> {
    sew(model, id, |_: &SurfaceShape| Some(Seam { kept: kept.clone(), gone: gone.clone(), is_closed: true }))
}

/// Lets a rim of a surface go from its curves; refuses if a curve of the inside ends there.
fn free(model: &mut Model, id: SurfaceId, rim: &Rim) -> Result<(), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let is_on = |v: &VertexId| rim.contains(v);
    // A curve of a single edge may have both ends on the rim and yet lead through the inside.
    let lies_along = |e: &EmbeddedCurve| {
        let closed = model.curves.get(&e.curve).is_some_and(|curve| curve.closed);
        let edges = edges_of(&shape.mesh, &e.vertices, closed).unwrap_or_default();
        e.vertices.iter().all(is_on) && edges.iter().all(|edge| shape.mesh.is_boundary_edge(*edge))
    };
    let ends_there = |e: &&EmbeddedCurve| e.vertices.iter().any(is_on) && !lies_along(e);
    if let Some(embedded) = shape.embeddings.iter().find(ends_there) {
        return Err(ModelError::EndsAtRim { curve: embedded.curve, surface: id });
    }
    let shape = edit(model.surfaces.get_mut(&id).ok_or(ModelError::NoSurface(id))?);
    shape.embeddings.retain(|e| !e.vertices.iter().any(is_on));
    shape.pins.retain(|pin| !is_on(&pin.vertex));
    for v in rim {
        shape.mesh.set_vertex_source(*v, None);
    }
    for e in edges_of_rim(&shape.mesh, rim) {
        shape.mesh.set_edge_source(e, None);
    }
    Ok(())
}

fn edges_of_rim(mesh: &Mesh, rim: &Rim) -> Vec<ductile_mesh::EdgeId> {
    edges_of(mesh, rim, true).unwrap_or_default()
}

/// Splits the longest edge of a rim, or of a stretch of one.
fn lengthen(model: &mut Model, id: SurfaceId, rim: &mut Rim, is_closed: bool) -> Result<(), ModelError> {
    let shape = model.surfaces.get(&id).ok_or(ModelError::NoSurface(id))?;
    let at = |v: VertexId| shape.positions[v.index()];
    let length = |k: usize| at(rim[k]).distance(at(rim[(k + 1) % rim.len()]));
    let edges = if is_closed { rim.len() } else { rim.len().saturating_sub(1) };
    let longest = (0..edges).fold(0, |best, k| if length(k) > length(best) { k } else { best });
    let ends = [rim[longest], rim[(longest + 1) % rim.len()]];
    let edge = shape.mesh.edge_between(ends[0], ends[1]).ok_or(ModelError::NoRim(id))?;
    let new = split(model, id, edge)?;
    rim.insert(longest + 1, new);
    Ok(())
}
