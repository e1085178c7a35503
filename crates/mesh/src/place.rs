//! Places on a surface: at a vertex, on an edge, or inside a face.
//!
//! A [`Place`] says where something lies on the mesh without saying where the mesh lies in space, so that it survives any
//! motion of the vertices. It is only good for the mesh that it was made for: every edit may make it name a dead element.
//!
//! ```
//! use ductile_mesh::{Place, nearest_place, primitive};
//! use glam::DVec3;
//! let (mesh, positions) = primitive::plane(2, 2, 1.0);
//! let place = nearest_place(&mesh, &positions, DVec3::new(0.3, 0.6, 5.0)).expect("there are faces");
//! assert!(matches!(place, Place::Face { .. }));
//! let on_plane = place.position(&mesh, &positions);
//! assert!(on_plane.is_some_and(|p| p.distance(DVec3::new(0.3, 0.6, 0.0)) < 1e-12));
//! ```

use glam::DVec3;

use crate::{EdgeId, FaceId, HalfedgeId, Mesh, VertexId};

/// A point of the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// At a vertex.
    Vertex(VertexId),
    /// On an edge.
    Edge {
        /// The edge.
        edge: EdgeId,
        /// How far from the first to the second of [`Mesh::edge_vertices`], in [0, 1].
        at: f64,
    },
    /// In a face.
    Face {
        /// The face.
        face: FaceId,
        /// How much each corner weighs, in the order of [`Mesh::face_vertices`]; each in [0, 1], together 1.
        weights: [f64; 3],
    },
}

impl Place {
    /// Whether the place is one on this mesh: its element lives, and its numbers are in range.
    #[must_use]
    pub fn is_on(&self, mesh: &Mesh) -> bool {
        match *self {
            Self::Vertex(v) => mesh.has_vertex(v),
            Self::Edge { edge, at } => mesh.has_edge(edge) && (0.0..=1.0).contains(&at),
            Self::Face { face, weights } => {
                // Weights come from divisions; a thousand roundings are no reason to refuse them.
                let is_share = |w: &f64| (-1e-12..=1.0 + 1e-12).contains(w);
                let total: f64 = weights.iter().sum();
                mesh.has_face(face) && weights.iter().all(is_share) && (total - 1.0).abs() < 1e-9
            }
        }
    }

    /// Where the place lies in space; `None` if it is not [on](Self::is_on) the mesh or a position is missing.
    #[must_use]
    pub fn position(&self, mesh: &Mesh, positions: &[DVec3]) -> Option<DVec3> {
        if !self.is_on(mesh) {
            return None;
        }
        let at = |v: VertexId| positions.get(v.index()).copied();
        match *self {
            Self::Vertex(v) => at(v),
            Self::Edge { edge, at: share } => {
                let [a, b] = mesh.edge_vertices(edge).map(at);
                Some(a?.lerp(b?, share))
            }
            Self::Face { face, weights } => {
                let [a, b, c] = mesh.face_vertices(face).map(at);
                Some(a? * weights[0] + b? * weights[1] + c? * weights[2])
            }
        }
    }

    /// The vertices that the place lies between: one, two or three.
    pub fn support(&self, mesh: &Mesh) -> impl Iterator<Item = VertexId> + use<> {
        let [a, b, c] = match *self {
            Self::Vertex(v) => [Some(v), None, None],
            Self::Edge { edge, .. } => {
                let [a, b] = mesh.edge_vertices(edge);
                [Some(a), Some(b), None]
            }
            Self::Face { face, .. } => mesh.face_vertices(face).map(Some),
        };
        [a, b, c].into_iter().flatten()
    }

    /// A face that the place lies in or at the border of.
    #[must_use]
    pub fn face(&self, mesh: &Mesh) -> FaceId {
        match *self {
            Self::Vertex(v) => mesh.anchor(v).face(),
            Self::Edge { edge, .. } => mesh.halfedge_of(edge).face(),
            Self::Face { face, .. } => face,
        }
    }

    /// The place that this one is meant to be: a face's edge if the opposite corner weighs less than `within`, an edge's
    /// vertex if it is nearer than that share of the edge. `within` below 1/3; a place that is not on the mesh stays.
    #[must_use]
    pub fn snapped(self, mesh: &Mesh, within: f64) -> Self {
        if !self.is_on(mesh) {
            return self;
        }
        match self {
            Self::Vertex(_) => self,
            Self::Edge { edge, at } => {
                let [a, b] = mesh.edge_vertices(edge);
                if at < within {
                    Self::Vertex(a)
                } else if at > 1.0 - within {
                    Self::Vertex(b)
                } else {
                    self
                }
            }
            Self::Face { face, weights } => {
                let Some(k) = (0..3).min_by(|&i, &j| weights[i].total_cmp(&weights[j])) else { return self };
                if weights[k] >= within {
                    return self;
                }
                let opposite = face.halfedge(k + 1);
                let [from, to] = [weights[(k + 1) % 3], weights[(k + 2) % 3]];
                Self::along(mesh, opposite, to / (from + to)).snapped(mesh, within)
            }
        }
    }

    /// The place on the edge of side `h`, `share` of the way along that side.
    pub(crate) fn along(mesh: &Mesh, h: HalfedgeId, share: f64) -> Self {
        let edge = mesh.edge_of(h);
        let share = if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.5 };
        let is_forward = mesh.origin(mesh.halfedge_of(edge)) == mesh.origin(h);
        Self::Edge { edge, at: if is_forward { share } else { 1.0 - share } }
    }

    /// The place in face `f` with these weights, on the lowest element that holds it: zero weights make it one of an edge or
    /// of a vertex.
    pub(crate) fn inside(mesh: &Mesh, f: FaceId, weights: [f64; 3]) -> Self {
        let heavy = |k: &usize| weights[*k] > 0.0;
        match (0..3).filter(heavy).collect::<Vec<_>>()[..] {
            [k] => Self::Vertex(mesh.origin(f.halfedge(k))),
            [i, j] => {
                let side = if (i + 1) % 3 == j { i } else { j };
                let (from, to) = (weights[side], weights[(side + 1) % 3]);
                Self::along(mesh, f.halfedge(side), to / (from + to))
            }
            _ => Self::Face { face: f, weights },
        }
    }
}

/// The place of the surface that is nearest to a point; among equals that of the lowest face. `None` where no face has finite
/// positions (and a finite sum of them), the point is not finite, or the squares of all distances are no numbers.
///
/// It looks at every face. Who asks often builds a [`SurfaceTree`](crate::SurfaceTree).
#[must_use]
pub fn nearest_place(mesh: &Mesh, positions: &[DVec3], at: DVec3) -> Option<Place> {
    let mut best: Option<(f64, FaceId, [f64; 3])> = None;
    for f in mesh.faces() {
        let [Some(&a), Some(&b), Some(&c)] = mesh.face_vertices(f).map(|v| positions.get(v.index())) else {
            continue;
        };
        // As a tree has it: what overflows is no place.
        if !(a + b + c).is_finite() {
            continue;
        }
        let weights = nearest_weights(at, [a, b, c]);
        let distance = (a * weights[0] + b * weights[1] + c * weights[2]).distance_squared(at);
        if distance.is_finite() && best.is_none_or(|(least, ..)| distance < least) {
            best = Some((distance, f, weights));
        }
    }
    best.map(|(_, f, weights)| Place::inside(mesh, f, weights))
}

/// The weights of the point of a triangle that is nearest to `p`.
///
/// Source: Ericson, Real-Time Collision Detection (2005), §5.1.5: the Voronoi regions of corners and sides, one after another.
pub(crate) fn nearest_weights(p: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac) = (b - a, c - a);
    let ap = p - a;
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return if v.is_finite() { [1.0 - v, v, 0.0] } else { [1.0, 0.0, 0.0] };
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return if w.is_finite() { [1.0 - w, 0.0, w] } else { [1.0, 0.0, 0.0] };
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return if w.is_finite() { [0.0, 1.0 - w, w] } else { [0.0, 1.0, 0.0] };
    }
    let (v, w) = (vb / (va + vb + vc), vc / (va + vb + vc));
    if v.is_finite() && w.is_finite() { [1.0 - v - w, v, w] } else { [1.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::primitive;
    use crate::property_test::cases;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    proptest! {
        #![proptest_config(cases(256, 64))]

        #[test]
        fn no_other_point_is_nearer(x in -3.0..3.0, y in -3.0..3.0, z in -3.0..3.0, seed in any::<u32>()) {
            let (mesh, positions) = primitive::torus(9, 7, 2.0, 0.8);
            let p = DVec3::new(x, y, z);
            let place = nearest_place(&mesh, &positions, p).unwrap();
            prop_assert!(place.is_on(&mesh));
            let least = place.position(&mesh, &positions).unwrap().distance(p);
            for f in mesh.faces() {
                let mix = |k: u32| 0.5 + 0.5 * libm::sin(f64::from(seed ^ k) + 3.1 * f.index() as f64);
                let (u, v) = (mix(1), mix(2));
                let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
                let other = Place::Face { face: f, weights: [1.0 - u - v, u, v] };
                prop_assert!(other.position(&mesh, &positions).unwrap().distance(p) >= least - 1e-12);
            }
        }

        #[test]
        fn a_place_is_found_again(pick in any::<u32>(), u in 0.0..1.0, v in 0.0..1.0) {
            let (mesh, positions) = primitive::icosphere(1);
            let face = mesh.faces().nth(pick as usize % mesh.face_count()).unwrap();
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let place = Place::Face { face, weights: [1.0 - u - v, u, v] };
            let p = place.position(&mesh, &positions).unwrap();
            let found = nearest_place(&mesh, &positions, p).unwrap().position(&mesh, &positions).unwrap();
            prop_assert!(found.distance(p) < 1e-12);
            let snapped = place.snapped(&mesh, 0.1);
            prop_assert!(snapped.is_on(&mesh));
            // A corner that weighs less than a tenth is no further than that from the others.
            prop_assert!(snapped.position(&mesh, &positions).unwrap().distance(p) < 0.2);
        }
    }

    #[test]
    fn corners_and_sides_are_named() {
        let (mesh, positions) = primitive::plane(2, 1, 1.0);
        let corner = nearest_place(&mesh, &positions, DVec3::new(-1.0, -1.0, 0.3)).unwrap();
        assert_eq!(corner, Place::Vertex(VertexId::from_index(0)));
        let Some(Place::Edge { edge, at }) = nearest_place(&mesh, &positions, DVec3::new(0.25, -2.0, 0.0))
        else {
            panic!("the rim is an edge")
        };
        let [a, b] = mesh.edge_vertices(edge).map(|v| positions[v.index()]);
        assert_eq!(a.lerp(b, at), DVec3::new(0.25, 0.0, 0.0));
    }

    #[test]
    fn snapping_takes_the_lowest_element_within_reach() {
        let (mesh, _) = primitive::plane(1, 1, 1.0);
        let face = FaceId::from_index(0);
        let [a, b, _] = mesh.face_vertices(face);
        let snapped = |weights| Place::Face { face, weights }.snapped(&mesh, 0.1);
        assert_eq!(snapped([0.95, 0.03, 0.02]), Place::Vertex(a));
        assert_eq!(snapped([0.3, 0.3, 0.4]), Place::Face { face, weights: [0.3, 0.3, 0.4] });
        let Place::Edge { edge, at } = snapped([0.72, 0.24, 0.04]) else { panic!("near the first side") };
        let share_of_b = if mesh.edge_vertices(edge) == [a, b] { at } else { 1.0 - at };
        assert!((share_of_b - 0.25).abs() < 1e-12);
    }

    #[test]
    fn what_is_not_on_the_mesh_is_known() {
        let (mesh, positions) = primitive::plane(1, 1, 1.0);
        let (edge, face) = (EdgeId::from_index(0), FaceId::from_index(0));
        for place in [
            Place::Vertex(VertexId::from_index(4)),
            Place::Edge { edge, at: f64::NAN },
            Place::Edge { edge, at: -0.1 },
            Place::Edge { edge: EdgeId::from_index(99), at: 0.5 },
            Place::Face { face, weights: [0.5, 0.6, 0.5] },
            Place::Face { face, weights: [f64::NAN; 3] },
            Place::Face { face: FaceId::from_index(2), weights: [1.0, 0.0, 0.0] },
        ] {
            assert!(!place.is_on(&mesh), "{place:?}");
            assert_eq!(place.position(&mesh, &positions), None);
            assert_eq!(format!("{:?}", place.snapped(&mesh, 0.1)), format!("{place:?}"));
        }
        assert_eq!(nearest_place(&mesh, &positions, DVec3::NAN), None);
        assert_eq!(nearest_place(&mesh, &[DVec3::NAN; 4], DVec3::ZERO), None);
        assert_eq!(nearest_place(&mesh, &[], DVec3::ZERO), None);
    }
}
