//! Removing vertices that have no room.

use glam::DVec3;

use super::diagonal::angle_at_diagonal;
use super::flip_pass::LEAST_GAIN;
use super::split_long::LONG;
use super::{Edits, Limits, Sizing};
use crate::surgery::Track;
use crate::{Mesh, VertexId};

/// A vertex is crowded when its edges are shorter than this multiple of the target.
const CROWDED: f64 = 0.72;

/// cos 84°: a collapse may turn no triangle further than this.
const COS_OF_LARGEST_TURN: f64 = 0.104_528_463_267_653_47;

/// Collapses each vertex whose every ring edge is shorter than 0.72 of the target into the nearest
/// neighbour that will have it. A vertex inside a boundary loop (or a curve, where that is allowed) needs
/// only its two edges along the line to be short, and goes along the line.
///
/// A neighbour will have it if [`Mesh::can_collapse`], no triangle turns by more than 84°, the neighbour's
/// ring does not grow past the limit, and the next batch would not undo it.
pub fn collapse_crowded(mesh: &mut Mesh, positions: &[DVec3], sizing: &Sizing, limits: &Limits<'_>) -> Edits {
    let mut edits = Edits::default();
    let mut ring = Vec::new();
    for slot in 0..mesh.vertex_slots() {
        let v = VertexId::from_index(slot);
        if !mesh.has_vertex(v) || (limits.is_pinned)(v) || !is_crowded(mesh, positions, sizing, v) {
            continue;
        }
        let Ok(track) = mesh.track(v) else { continue };
        if let Track::Along(first, second) = track
            && !(limits.may_edit(mesh, first) && limits.may_edit(mesh, second))
        {
            continue;
        }
        mesh.ring(v, &mut ring);
        if collapse_into_nearest(mesh, positions, sizing, &ring, v, limits) {
            edits.collapses += 1;
            edits.touched.extend_from_slice(&ring);
        }
    }
    edits.settle(mesh);
    edits
}

/// Whether the edges that matter at `v` are short.
fn is_crowded(mesh: &Mesh, positions: &[DVec3], sizing: &Sizing, v: VertexId) -> bool {
    let on_line = |e| mesh.is_source_edge(e) || mesh.is_boundary_edge(e);
    let has_line = mesh.spokes(v).any(on_line);
    mesh.spokes(v).filter(|&e| !has_line || on_line(e)).all(|e| {
        let ratio = sizing.ratio(mesh, positions, e);
        ratio < CROWDED
    })
}

/// Collapses `v` into the nearest vertex of its `ring` that passes all tests, and tells whether it did.
pub(super) fn collapse_into_nearest(
    mesh: &mut Mesh,
    positions: &[DVec3],
    sizing: &Sizing,
    ring: &[VertexId],
    v: VertexId,
    limits: &Limits<'_>,
) -> bool {
    let here = positions[v.index()];
    let distance = |w: VertexId| here.distance_squared(positions[w.index()]);
    let mut candidates = ring.to_vec();
    candidates.sort_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
    let room = limits.most_neighbours + 3;
    let found = candidates.into_iter().find(|&w| {
        mesh.can_collapse(v, w).is_ok()
            && ring.len() + mesh.valence(w) <= room
            && lasts(mesh, positions, sizing, ring, w)
            && keeps_normals(mesh, positions, v, w)
    });
    if let Some(w) = found {
        mesh.collapse(v, w);
    }
    found.is_some()
}

/// Whether collapsing a vertex with this ring into `w` will not be undone by the next batch: it makes no
/// edge so long that it is split, and no diagonal so bad that it is flipped to such an edge.
///
/// Halves of an edge of 1.36 h are shorter than 0.72 h. Without this test their common vertex may count as
/// crowded at once, or as poor in neighbours, and be split and collapsed in every batch for ever.
fn lasts(mesh: &Mesh, positions: &[DVec3], sizing: &Sizing, ring: &[VertexId], w: VertexId) -> bool {
    let is_short = ring
        .iter()
        .filter(|&&x| x != w && !mesh.are_neighbours(x, w))
        .all(|&x| sizing.ratio_between(positions, x, w) <= LONG);
    let Ok([a, b, c, d]) = <[VertexId; 4]>::try_from(ring) else { return is_short };
    let ([p, q], [r, s]) = if w == a || w == c { ([a, c], [b, d]) } else { ([b, d], [a, c]) };
    let [p, q, r, s] = [p, q, r, s].map(|v| positions[v.index()]);
    is_short && angle_at_diagonal(p, q, r, s) + LEAST_GAIN >= angle_at_diagonal(r, s, p, q)
}

/// Whether moving `v` onto `w` turns no surviving triangle by more than 84° and flattens none to nothing.
fn keeps_normals(mesh: &Mesh, positions: &[DVec3], v: VertexId, w: VertexId) -> bool {
    let (old, new) = (positions[v.index()], positions[w.index()]);
    mesh.wedges(v).all(|wedge| {
        let (p, q) = (mesh.target(wedge.corner), mesh.apex(wedge.corner));
        if p == w || q == w {
            return true;
        }
        let (p, q) = (positions[p.index()], positions[q.index()]);
        let (before, after) = ((p - old).cross(q - old), (p - new).cross(q - new));
        let scale = before.length() * after.length();
        after.length_squared() > 0.0 && before.dot(after) >= COS_OF_LARGEST_TURN * scale
    })
}
