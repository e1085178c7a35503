//! The rim of an exact surface: where it ends, and which way leads on from it within its tangent planes, so that a fair surface
//! can go on from there smoothly (thesis section 5.5, ribbons between surfaces).

use super::PatchShape;
use glam::DVec3;

/// A curve runs along a rim if its samples are no farther from it than this part of the rim's size.
const ALONG: f64 = 0.05;

/// The edges at which an exact surface ends.
#[derive(Debug)]
pub(crate) struct PatchRim<'a> {
    patch: &'a PatchShape,
    /// Both ends of each, and the third corner of its triangle.
    edges: Vec<[u32; 3]>,
}

impl<'a> PatchRim<'a> {
    pub(crate) fn new(patch: &'a PatchShape) -> Self {
        let edges = match patch {
            PatchShape::Mesh(shape) => shape.rim().to_vec(),
            _ => edges(patch.triangles()),
        };
        Self { patch, edges }
    }

    /// How many edges it has.
    pub(crate) fn edge_count(&self) -> usize {
        self.edges.len()
    }

    /// The unit vector that leads away from the surface at the place of its rim nearest to a given one; none without a rim, or
    /// where it has no tangent plane.
    pub(crate) fn away(&self, at: DVec3) -> Option<DVec3> {
        let ([a, b, inner], t, _) = self.nearest(at)?;
        let (place, normals) = (self.patch.positions(), self.patch.normals());
        let normal = normals[a as usize].lerp(normals[b as usize], t).try_normalize()?;
        let along = place[b as usize] - place[a as usize];
        let across = along.cross(normal).try_normalize()?;
        let inward = place[inner as usize] - place[a as usize];
        Some(if across.dot(inward) > 0.0 { -across } else { across })
    }

    /// The unit normal of the surface at the place of its rim nearest to a given one; none without a rim or a tangent plane.
    pub(crate) fn normal(&self, at: DVec3) -> Option<DVec3> {
        let ([a, b, _], t, _) = self.nearest(at)?;
        let normals = self.patch.normals();
        normals[a as usize].lerp(normals[b as usize], t).try_normalize()
    }

    /// The place of the rim nearest to a given one; none without a rim.
    pub(crate) fn place(&self, at: DVec3) -> Option<DVec3> {
        let ([a, b, _], t, _) = self.nearest(at)?;
        let place = self.patch.positions();
        Some(place[a as usize].lerp(place[b as usize], t))
    }

    /// Whether all these places lie on it, or nearly.
    pub(crate) fn is_at(&self, places: &[DVec3]) -> bool {
        let ends = self.edges.iter().map(|edge| self.patch.positions()[edge[0] as usize]);
        let (low, high) =
            ends.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let most = ALONG * (high - low).length();
        !self.edges.is_empty()
            && places.iter().all(|at| self.nearest(*at).is_some_and(|(.., squared)| squared <= most * most))
    }

    /// The nearest edge, how far along it, and the square of the distance.
    fn nearest(&self, at: DVec3) -> Option<([u32; 3], f64, f64)> {
        let mut best: Option<([u32; 3], f64, f64)> = None;
        for edge in &self.edges {
            let [p, q] = [edge[0], edge[1]].map(|end| self.patch.positions()[end as usize]);
            let squared = (q - p).length_squared();
            let t = if squared > 0.0 { ((at - p).dot(q - p) / squared).clamp(0.0, 1.0) } else { 0.0 };
            let distance = p.lerp(q, t).distance_squared(at);
            if best.is_none_or(|(.., least)| distance < least) {
                best = Some((*edge, t, distance));
            }
        }
        best
    }
}

/// The edges that only one triangle has, each with the third corner of that.
pub(super) fn edges(triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let sides = |&[a, b, c]: &[u32; 3]| [[a, b, c], [b, c, a], [c, a, b]];
    let key = |edge: &[u32; 3]| [edge[0].min(edge[1]), edge[0].max(edge[1])];
    let mut all: Vec<[u32; 3]> = triangles.iter().flat_map(sides).collect();
    all.sort_by_key(key);
    let alone = all.chunk_by(|a, b| key(a) == key(b)).filter(|same| same.len() == 1);
    alone.map(|same| same[0]).collect()
}
