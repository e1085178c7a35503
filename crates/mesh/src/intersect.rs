//! Where two surfaces run through one another: closed or open lines of places on both.
//!
//! Every point of such a line is one where an edge of the one surface runs through a face of the other; two faces that meet
//! have two such points or none. Both facts are read off signs of volumes, which are exact (Shewchuk 1997), once no four
//! points lie in a plane. To have it so, every vertex is shifted by a length of 2⁻³³ of the surfaces' size in a direction
//! that only its number decides, for the decision, not in the result (controlled perturbation, Halperin 2010; a poor man's
//! simulation of simplicity). So corners that touch, edges that lie on edges and faces that share a plane without lying on
//! one another need no cases of their own, and lines never branch: they close, or end at a boundary.

use std::collections::BTreeMap;

use glam::DVec3;
use robust::Coord3D;
use thiserror::Error;

use crate::{EdgeId, FaceId, Mesh, Place, SurfaceTree, VertexId};

/// Why the intersection of two surfaces cannot be told. Faces are those of the first and the second surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum IntersectError {
    /// A vertex of the first (0) or the second (1) surface has no finite position.
    #[error("{1:?} of surface {0} has no finite position")]
    NotFinite(usize, VertexId),
    /// The two faces lie on one another: the surfaces touch in an area, not in a line. Move one of them a little.
    #[error("{0:?} and {1:?} lie on one another")]
    Tangent(FaceId, FaceId),
    /// The two faces meet in no clear way, however their corners are shifted. Move one of the surfaces a little.
    #[error("how {0:?} and {1:?} meet cannot be told")]
    Unresolved(FaceId, FaceId),
}

/// A point common to two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CommonPoint {
    /// Where it lies on the first surface and on the second: on an edge of one and in a face of the other.
    pub places: [Place; 2],
    /// Where it lies in space, up to 10⁻⁹ of the surfaces' size.
    pub position: DVec3,
}

/// A line common to two surfaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CommonLine {
    /// Its points in order: neighbours lie in one face of either surface.
    pub points: Vec<CommonPoint>,
    /// Whether the last point is followed by the first. An open line ends at a boundary of one of the surfaces.
    pub is_closed: bool,
}

impl CommonLine {
    /// The line as a sequence of places on the first surface (0) or the second (1), such as [`Mesh::lay_path`] takes.
    #[must_use]
    pub fn places_on(&self, surface: usize) -> Vec<Place> {
        self.points.iter().map(|point| point.places[surface.min(1)]).collect()
    }
}

/// A surface: its mesh and where its vertices lie.
pub type Placed<'a> = (&'a Mesh, &'a [DVec3]);

/// All lines in which two surfaces meet, each once; none if they do not meet. Those of a surface with itself are not looked
/// for. Order and beginnings depend on the meshes' numbers alone.
///
/// ```
/// use ductile_mesh::{intersections, primitive};
/// use glam::DVec3;
/// let (ball, round) = primitive::icosphere(3);
/// let there: Vec<_> = round.iter().map(|p| *p + DVec3::new(1.0, 0.0, 0.0)).collect();
/// let lines = intersections((&ball, &round), (&ball, &there))?;
/// assert!(lines.len() == 1 && lines[0].is_closed);
/// assert!(lines[0].points.iter().all(|p| (p.position.x - 0.5).abs() < 0.02));
/// # Ok::<(), ductile_mesh::IntersectError>(())
/// ```
///
/// # Errors
/// See [`IntersectError`].
pub fn intersections(one: Placed<'_>, other: Placed<'_>) -> Result<Vec<CommonLine>, IntersectError> {
    let surfaces = [one, other];
    for (k, (mesh, positions)) in surfaces.iter().enumerate() {
        let is_lost = |v: &VertexId| !positions.get(v.index()).is_some_and(|p| p.is_finite());
        if let Some(v) = mesh.vertices().find(is_lost) {
            return Err(IntersectError::NotFinite(k, v));
        }
    }
    let mut outcome = Ok(Vec::new());
    // A shift that leaves four points in a plane is as good as impossible; another is tried all the same.
    for attempt in 0..4 {
        outcome = Meeting::new(surfaces, attempt).lines();
        if !matches!(outcome, Err(IntersectError::Unresolved(..))) {
            break;
        }
    }
    outcome
}

/// An edge of the surface `of` (0 or 1) that runs through a face of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Piercing {
    of: usize,
    edge: EdgeId,
    face: FaceId,
}

/// Two surfaces with their vertices shifted.
struct Meeting<'a> {
    surfaces: [Placed<'a>; 2],
    shifted: [Vec<DVec3>; 2],
}

impl<'a> Meeting<'a> {
    fn new(surfaces: [Placed<'a>; 2], attempt: u64) -> Self {
        let size = surfaces
            .iter()
            .filter_map(|(mesh, positions)| crate::measure::bounding_box(mesh, positions))
            .map(|(low, high)| low.abs().max(high.abs()).max_element())
            .fold(0.0, f64::max);
        // 2⁻³³: far below what the eye or the solver tells apart, far above the rounding of positions.
        let length = size / 8_589_934_592.0;
        let shifted = [0, 1].map(|k| {
            let seed = attempt * 2 + k as u64;
            let positions = surfaces[k].1.iter().zip(0..);
            positions.map(|(p, v)| *p + direction(seed, v) * length).collect()
        });
        Self { surfaces, shifted }
    }

    fn lines(&self) -> Result<Vec<CommonLine>, IntersectError> {
        let mut beside: BTreeMap<Piercing, Vec<Piercing>> = BTreeMap::new();
        let trees = [0, 1].map(|k| SurfaceTree::new(self.surfaces[k].0, &self.shifted[k]));
        for (f, g) in overlapping(&trees) {
            if let Some([p, q]) = self.common_segment(f, g)? {
                beside.entry(p).or_default().push(q);
                beside.entry(q).or_default().push(p);
            }
        }
        Ok(self.trace(&beside))
    }

    /// The two points at which the line common to two faces begins and ends.
    fn common_segment(&self, f: FaceId, g: FaceId) -> Result<Option<[Piercing; 2]>, IntersectError> {
        let unclear = IntersectError::Unresolved(f, g);
        let mut found = Vec::with_capacity(2);
        for (of, own, face) in [(0, f, g), (1, g, f)] {
            for edge in self.surfaces[of].0.face_edges(own) {
                if self.pierces(of, edge, face).ok_or(unclear)? {
                    found.push(Piercing { of, edge, face });
                }
            }
        }
        match found[..] {
            [] => Ok(None),
            [p, q] if self.is_flat(f, g) => {
                debug_assert!(p != q, "the edges of both faces are different");
                Err(IntersectError::Tangent(f, g))
            }
            [p, q] => Ok(Some([p, q])),
            _ => Err(unclear),
        }
    }

    /// Whether two faces that meet are so nearly parallel that the shift may have decided it.
    fn is_flat(&self, f: FaceId, g: FaceId) -> bool {
        let [n, m] = [(0, f), (1, g)].map(|(k, face)| {
            let (mesh, positions) = self.surfaces[k];
            crate::measure::face_normal(mesh, positions, face).normalize_or_zero()
        });
        // A millionth of a radian; the shift turns a face of a thousandth of the surfaces' size by a tenth of that.
        n != DVec3::ZERO && m != DVec3::ZERO && n.cross(m).length() < 1e-6
    }

    /// Whether an edge of surface `of` runs through a face of the other; `None` where four points lie in a plane.
    fn pierces(&self, of: usize, edge: EdgeId, face: FaceId) -> Option<bool> {
        let there = 1 - of;
        let [p, q] = self.surfaces[of].0.edge_vertices(edge).map(|v| self.shifted[of][v.index()]);
        let [a, b, c] = self.surfaces[there].0.face_vertices(face).map(|v| self.shifted[there][v.index()]);
        if is_above(a, b, c, p)? == is_above(a, b, c, q)? {
            return Some(false);
        }
        let [ab, bc, ca] = [is_above(p, q, a, b)?, is_above(p, q, b, c)?, is_above(p, q, c, a)?];
        Some(ab == bc && bc == ca)
    }

    /// Follows the points from face to face: first the open lines, from their ends, then the closed ones.
    fn trace(&self, beside: &BTreeMap<Piercing, Vec<Piercing>>) -> Vec<CommonLine> {
        let mut is_done: BTreeMap<Piercing, bool> = beside.keys().map(|p| (*p, false)).collect();
        let ends = beside.iter().filter(|(_, next)| next.len() == 1).map(|(p, _)| (*p, false));
        let mut lines = Vec::new();
        for (start, is_closed) in ends.chain(beside.keys().map(|p| (*p, true))) {
            if is_done.get(&start) != Some(&false) {
                continue;
            }
            let mut line = CommonLine { points: Vec::new(), is_closed };
            let mut here = Some(start);
            while let Some(p) = here {
                is_done.insert(p, true);
                line.points.push(self.point(p));
                here = beside[&p].iter().copied().find(|next| is_done.get(next) == Some(&false));
            }
            lines.push(line);
        }
        lines
    }

    fn point(&self, piercing: Piercing) -> CommonPoint {
        let Piercing { of, edge, face } = piercing;
        let there = 1 - of;
        let ((mesh, positions), (facing, _)) = (self.surfaces[of], self.surfaces[there]);
        let ends = mesh.edge_vertices(edge);
        let [p, q] = ends.map(|v| self.shifted[of][v.index()]);
        let [a, b, c] = facing.face_vertices(face).map(|v| self.shifted[there][v.index()]);
        let normal = (b - a).cross(c - a);
        let (above, below) = (normal.dot(p - a), normal.dot(q - a));
        let share = above / (above - below);
        let at = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        let [from, to] = ends.map(|v| positions[v.index()]);
        let weights = crate::place::nearest_weights(p.lerp(q, at), [a, b, c]);
        let mut places = [Place::Edge { edge, at }; 2];
        places[there] = Place::Face { face, weights };
        CommonPoint { places, position: from.lerp(to, at) }
    }
}

/// Whether `d` lies above the plane of `a`, `b` and `c`; `None` if in it.
fn is_above(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> Option<bool> {
    let [a, b, c, d] = [a, b, c, d].map(|p| Coord3D { x: p.x, y: p.y, z: p.z });
    let volume = robust::orient3d(a, b, c, d);
    if volume == 0.0 || volume.is_nan() { None } else { Some(volume < 0.0) }
}

/// A vector in the cube of side 2 that looks like chance and depends on two numbers only.
fn direction(seed: u64, number: u64) -> DVec3 {
    // SplitMix64 (Steele, Lea, Flood 2014).
    let mut state = (seed << 40) ^ number.wrapping_mul(3);
    let mut next = || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        let top = u32::try_from((z ^ (z >> 31)) >> 32).unwrap_or(0);
        f64::from(top) / 2_147_483_648.0 - 1.0
    };
    DVec3::new(next(), next(), next())
}

/// Pairs of faces whose boxes overlap, each once, in an order that the trees decide.
fn overlapping(trees: &[SurfaceTree; 2]) -> Vec<(FaceId, FaceId)> {
    let [one, other] = trees;
    let mut pairs = Vec::new();
    if one.is_empty() || other.is_empty() {
        return pairs;
    }
    let do_meet =
        |low: DVec3, high: DVec3, there: DVec3, end: DVec3| low.cmple(end).all() && there.cmple(high).all();
    let around = |corners: [DVec3; 3]| {
        let [a, b, c] = corners;
        (a.min(b).min(c), a.max(b).max(c))
    };
    let mut ahead = vec![(0, 0)];
    while let Some((a, b)) = ahead.pop() {
        let (node, there) = (one.nodes[a], other.nodes[b]);
        if !do_meet(node.low, node.high, there.low, there.high) {
            continue;
        }
        if node.second == 0 && there.second == 0 {
            for (k, l) in (node.from..node.to).flat_map(|k| (there.from..there.to).map(move |l| (k, l))) {
                let ((low, high), (start, end)) = (around(one.corners[k]), around(other.corners[l]));
                if do_meet(low, high, start, end) {
                    pairs.push((one.order[k], other.order[l]));
                }
            }
            continue;
        }
        let size = |low: DVec3, high: DVec3| (high - low).length_squared();
        let is_larger = size(node.low, node.high) >= size(there.low, there.high);
        if there.second == 0 || (node.second != 0 && is_larger) {
            ahead.extend([(a + 1, b), (node.second, b)]);
        } else {
            ahead.extend([(a, b + 1), (a, there.second)]);
        }
    }
    pairs
}

#[cfg(test)]
mod tests;
