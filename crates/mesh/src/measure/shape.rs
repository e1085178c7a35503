//! Lengths, angles, areas; how good the triangles are.

use glam::DVec3;

use crate::{EdgeId, FaceId, HalfedgeId, Mesh};

/// The distance between the ends of an edge.
#[inline]
#[must_use]
pub fn edge_length(mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> f64 {
    let [a, b] = mesh.edge_vertices(e);
    positions[a.index()].distance(positions[b.index()])
}

/// The mean length of all edges; 0 for an empty mesh.
#[must_use]
pub fn mean_edge_length(mesh: &Mesh, positions: &[DVec3]) -> f64 {
    let total: f64 = mesh.edges().map(|e| edge_length(mesh, positions, e)).sum();
    total / f64::from(u32::try_from(mesh.edge_count().max(1)).unwrap_or(u32::MAX))
}

/// The normal of a face by its local order, as long as twice its area.
#[inline]
#[must_use]
pub fn face_normal(mesh: &Mesh, positions: &[DVec3], f: FaceId) -> DVec3 {
    let [a, b, c] = mesh.face_vertices(f).map(|v| positions[v.index()]);
    (b - a).cross(c - a)
}

/// The area of a face.
#[inline]
#[must_use]
pub fn face_area(mesh: &Mesh, positions: &[DVec3], f: FaceId) -> f64 {
    0.5 * length(face_normal(mesh, positions, f))
}

/// The length of a vector whose square may leave the range of numbers, as that of a cross product of lengths of 1e150
/// or of 1e-150 does.
#[inline]
fn length(v: DVec3) -> f64 {
    let squared = v.length_squared();
    if (1e-280..1e300).contains(&squared) {
        return squared.sqrt();
    }
    let largest = v.abs().max_element();
    if largest > 0.0 && largest.is_finite() { largest * (v / largest).length() } else { squared.sqrt() }
}

/// The area of all faces.
#[must_use]
pub fn total_area(mesh: &Mesh, positions: &[DVec3]) -> f64 {
    mesh.faces().map(|f| face_area(mesh, positions, f)).sum()
}

/// The lowest and highest coordinates of the living vertices; `None` for an empty mesh.
#[must_use]
pub fn bounding_box(mesh: &Mesh, positions: &[DVec3]) -> Option<(DVec3, DVec3)> {
    mesh.vertices().map(|v| positions[v.index()]).fold(None, |sofar, p| {
        Some(sofar.map_or((p, p), |(low, high): (DVec3, DVec3)| (low.min(p), high.max(p))))
    })
}

/// The angle between two vectors in [0, π], exact near 0 and π alike.
#[inline]
pub(crate) fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(length(a.cross(b)), a.dot(b))
}

/// The angle of a face at the corner from which `h` starts.
#[inline]
#[must_use]
pub fn corner_angle(mesh: &Mesh, positions: &[DVec3], h: HalfedgeId) -> f64 {
    let [p, q, r] = [h, h.next(), h.prev()].map(|h| positions[mesh.origin(h).index()]);
    angle_between(q - p, r - p)
}

/// How well shaped the triangles of a mesh are.
#[derive(Clone, Debug, PartialEq)]
pub struct Quality {
    /// The smallest angle of any face.
    pub least_angle: f64,
    /// The mean over the faces of each face's smallest angle; π/3 at best.
    pub mean_least_angle: f64,
    /// The shortest edge.
    pub shortest_edge: f64,
    /// The longest edge.
    pub longest_edge: f64,
    /// `inner_valences[n]`: how many inner vertices have `n` neighbours. Six is regular.
    pub inner_valences: Vec<usize>,
    /// `boundary_valences[n]`: how many boundary vertices have `n` neighbours. Four is regular.
    pub boundary_valences: Vec<usize>,
}

/// Measures the triangles of a mesh. Angles and edges of an empty mesh are 0.
#[must_use]
pub fn quality(mesh: &Mesh, positions: &[DVec3]) -> Quality {
    let mut least = f64::INFINITY;
    let mut total = 0.0;
    for f in mesh.faces() {
        let angles = f.halfedges().map(|h| corner_angle(mesh, positions, h));
        let smallest = angles.into_iter().fold(f64::INFINITY, f64::min);
        least = least.min(smallest);
        total += smallest;
    }
    let (mut shortest, mut longest) = (f64::INFINITY, 0.0_f64);
    for e in mesh.edges() {
        let length = edge_length(mesh, positions, e);
        shortest = shortest.min(length);
        longest = longest.max(length);
    }
    let (mut inner, mut boundary) = (Vec::new(), Vec::new());
    for v in mesh.vertices() {
        let histogram = if mesh.is_boundary_vertex(v) { &mut boundary } else { &mut inner };
        let n = mesh.valence(v);
        if histogram.len() <= n {
            histogram.resize(n + 1, 0);
        }
        histogram[n] += 1;
    }
    let finite = |x: f64| if x.is_finite() { x } else { 0.0 };
    Quality {
        least_angle: finite(least),
        mean_least_angle: total / f64::from(u32::try_from(mesh.face_count().max(1)).unwrap_or(u32::MAX)),
        shortest_edge: finite(shortest),
        longest_edge: longest,
        inner_valences: inner,
        boundary_valences: boundary,
    }
}
