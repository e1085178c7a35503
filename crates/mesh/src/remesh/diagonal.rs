//! The two ways to cut a quadrilateral in space, and whether changing from one to the other is safe.
//!
//! ```text
//!        c                 c
//!      ╱   ╲             ╱ │ ╲
//!    a ───── b    or   a   │   b
//!      ╲   ╱             ╲ │ ╱
//!        d                 d
//! ```

use glam::DVec3;

use crate::measure::angle_between;
use crate::{EdgeId, Mesh, VertexId};

/// Cosine of the angle up to which triangles count as lying in one plane when a flip unfolds them, some 26°.
const FLAT: f64 = 0.9;

/// An inner edge `ab` with its opposite vertices `c` and `d`, face `abc` wound as in the mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Diagonal {
    pub(super) ends: [VertexId; 2],
    pub(super) opposite: [VertexId; 2],
    edge: EdgeId,
}

impl Diagonal {
    pub(super) fn of(mesh: &Mesh, e: EdgeId) -> Option<Self> {
        let h = mesh.halfedge_of(e);
        let t = mesh.twin(h)?;
        Some(Self { ends: [mesh.origin(h), mesh.target(h)], opposite: [mesh.apex(h), mesh.apex(t)], edge: e })
    }

    /// Vertices beyond the sides bc, ca, ad, db; `None` on the boundary.
    fn beyond(&self, mesh: &Mesh) -> [Option<VertexId>; 4] {
        let h = mesh.halfedge_of(self.edge);
        let Some(t) = mesh.twin(h) else { return [None; 4] };
        let (at_a, at_b) =
            if mesh.origin(t) == mesh.target(h) { (t.next(), t.prev()) } else { (t.prev(), t.next()) };
        [h.next(), h.prev(), at_a, at_b].map(|h| mesh.twin(h).map(|t| mesh.apex(t)))
    }

    pub(super) fn points(&self, positions: &[DVec3]) -> [DVec3; 4] {
        let ([a, b], [c, d]) = (self.ends, self.opposite);
        [a, b, c, d].map(|v| positions[v.index()])
    }

    /// The smallest angle of the two triangles.
    pub(super) fn corner_now(&self, positions: &[DVec3]) -> f64 {
        let [a, b, c, d] = self.points(positions);
        least_corner(a, b, c, d)
    }

    /// The smallest angle of the two triangles that a flip would make.
    pub(super) fn corner_flipped(&self, positions: &[DVec3]) -> f64 {
        let [a, b, c, d] = self.points(positions);
        least_corner(c, d, a, b)
    }

    /// Whether the surface is flat enough here for the flip to make sense: no dihedral angle of more than
    /// 90° across either diagonal, none made across the sides (or made worse), and the new triangles not
    /// turned over in the plane of the old ones. Or else the two lie on one another
    /// at a rim, and the flip unfolds them.
    pub(super) fn is_flat_enough(&self, mesh: &Mesh, positions: &[DVec3]) -> bool {
        let [a, b, c, d] = self.points(positions);
        let area = |p: DVec3, q: DVec3, r: DVec3| (q - p).cross(r - p);
        let normal = |p: DVec3, q: DVec3, r: DVec3| area(p, q, r).normalize_or_zero();
        let (old_c, old_d) = (normal(a, b, c), normal(b, a, d));
        let (new_a, new_b) = (normal(c, a, d), normal(d, b, c));
        let is_fold = old_c.dot(old_d) < 0.0;
        let is_larger = area(a, b, c).length_squared() > area(b, a, d).length_squared();
        // Of two triangles that lie on one another, the smaller one is the one that was turned over.
        let upright = match (is_fold, is_larger) {
            (false, _) => old_c + old_d,
            (true, true) => old_c,
            (true, false) => old_d,
        };
        if new_a.dot(new_b) < 0.0 || !is_convex([a, b, c, d], upright) {
            return false;
        }
        let beyond = self.beyond(mesh);
        if is_fold {
            // Only beside a rim whose vertices have moved; elsewhere two sheets may well lie close to one another.
            let is_at_rim = (if is_larger { &beyond[2..] } else { &beyond[..2] }).contains(&None);
            let is_flat =
                old_c.dot(old_d) <= -FLAT && new_a.dot(upright) >= FLAT && new_b.dot(upright) >= FLAT;
            if !is_at_rim || !is_flat {
                return false;
            }
        }
        let sides = [(b, c, old_c, new_b), (c, a, old_c, new_a), (a, d, old_d, new_a), (d, b, old_d, new_b)];
        sides.into_iter().zip(beyond).all(|((p, q, before, after), beyond)| {
            beyond.is_none_or(|v| {
                let outside = normal(q, p, positions[v.index()]);
                let bend = outside.dot(after);
                // A neighbour that was turned over, too, is unfolded in its turn.
                bend >= 0.0 || bend >= outside.dot(before) || (is_fold && outside.dot(upright) < -FLAT)
            })
        })
    }
}

/// Whether the diagonals `ab` and `cd` of a quadrilateral cross when seen along `normal`, so that neither pair of
/// triangles overlaps.
///
/// The sign of an area decides, which may be as small as the rounding errors of computing it; an exact predicate gives
/// it for the four projected points, and gives opposite answers for the two ways round.
fn is_convex([a, b, c, d]: [DVec3; 4], normal: DVec3) -> bool {
    let normal = normal.normalize_or_zero();
    let along = (b - a).reject_from_normalized(normal).normalize_or_zero();
    let across = normal.cross(along);
    let project = |p: DVec3| robust::Coord { x: along.dot(p - a), y: across.dot(p - a) };
    let (a, b, c, d) = (project(a), project(b), project(c), project(d));
    robust::orient2d(d, c, a) > 0.0 && robust::orient2d(c, d, b) > 0.0
}

/// The corners between the segment `pq` and the sides of the quadrilateral `p r q s`, as pairs of legs.
fn corners_at_diagonal(p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> [(DVec3, DVec3); 4] {
    let pq = q - p;
    [(pq, r - p), (pq, s - p), (-pq, r - q), (-pq, s - q)]
}

/// The smallest angle between the segment `pq` and the sides of the quadrilateral `p r q s`.
pub(super) fn angle_at_diagonal(p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> f64 {
    let (_, (a, b)) = sharpest(corners_at_diagonal(p, q, r, s));
    angle_between(a, b)
}

/// The corner with the smallest angle and its cosine: the cosine finds it without arcs. A corner without
/// legs counts as sharp.
fn sharpest(corners: [(DVec3, DVec3); 4]) -> (f64, (DVec3, DVec3)) {
    let cosine = |(a, b): (DVec3, DVec3)| {
        let scale = (a.length_squared() * b.length_squared()).sqrt();
        if scale > 0.0 { a.dot(b) / scale } else { 1.0 }
    };
    let [first, rest @ ..] = corners;
    rest.into_iter().fold((cosine(first), first), |best, corner| {
        let cosine = cosine(corner);
        if cosine > best.0 { (cosine, corner) } else { best }
    })
}

/// The smallest angle of the triangles `p q r` and `p q s`.
fn least_corner(p: DVec3, q: DVec3, r: DVec3, s: DVec3) -> f64 {
    let opposite = angle_between(p - r, q - r).min(angle_between(p - s, q - s));
    opposite.min(angle_at_diagonal(p, q, r, s))
}
