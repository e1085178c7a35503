//! The Laplacian of a surface as a list of weights: by cotangents, on the intrinsic Delaunay triangulation, or with a
//! direction along which things reach further.
//!
//! Kind and sign: `L_kl = -w_kl`, `L_kk = Σ w_kl`, symmetric and positive semidefinite, with rows that sum to 0. Source:
//! P. Salvi, *Editing the interior of arbitrary surfaces*, eq. (4), and the recipe, sections 3, 5 and 11. Where the
//! paper says that at the boundary the missing angle is zero, the missing cotangent is.

use super::domain::Domain;
use super::error::DisplacementError;
use super::intrinsic::Intrinsic;
use glam::{DVec2, DVec3};

/// On which triangles the cotangents are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Laplacian {
    /// On the intrinsic Delaunay triangulation: no weight is negative, harmonic functions stay within their bounds.
    #[default]
    IntrinsicDelaunay,
    /// On the triangles as they are: obtuse ones can have negative weights, and triangles without area are refused.
    Cotangent,
}

/// A direction along which a displacement reaches further than across.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction {
    along: DVec3,
    stretch: f64,
}

impl Direction {
    /// Near the foot, a level set is `stretch` times as long as wide, in [1/64, 64]; up to 4 is unproblematic on
    /// reasonable meshes. On a curved surface `along` is projected into each triangle.
    ///
    /// # Errors
    /// [`DisplacementError::BadDirection`], [`DisplacementError::BadStretch`].
    pub fn new(along: DVec3, stretch: f64) -> Result<Self, DisplacementError> {
        let along = along.try_normalize().ok_or(DisplacementError::BadDirection)?;
        if (1.0 / 64.0..=64.0).contains(&stretch) {
            Ok(Self { along, stretch })
        } else {
            Err(DisplacementError::BadStretch(stretch))
        }
    }
}

/// Weights between vertices; a pair may come several times, and its weights are summed.
#[derive(Clone, Debug)]
pub(super) struct Stiffness {
    pub(super) weights: Vec<(u32, u32, f64)>,
    /// A third of the triangles at each vertex.
    pub(super) areas: Vec<f64>,
}

impl Stiffness {
    /// The Laplacian of a domain, with a direction or without.
    pub(super) fn new(
        domain: &Domain,
        laplacian: Laplacian,
        direction: Option<Direction>,
    ) -> Result<Self, DisplacementError> {
        let Some(direction) = direction else {
            return match laplacian {
                Laplacian::Cotangent => Self::by_corners(domain, |edges| edges),
                Laplacian::IntrinsicDelaunay => Self::intrinsic(domain),
            };
        };
        if laplacian == Laplacian::IntrinsicDelaunay
            && let Some(mapped) = mapped_plane(domain, direction)
        {
            return Self::intrinsic(&mapped);
        }
        Self::by_corners(domain, |edges| squeezed(edges, direction))
    }

    fn intrinsic(domain: &Domain) -> Result<Self, DisplacementError> {
        let mut intrinsic = Intrinsic::new(domain)?;
        intrinsic.make_delaunay(|a, b| domain.keeps_edge(a, b));
        let mut stiffness = Self { weights: Vec::new(), areas: vec![0.0; domain.len()] };
        for (&corners, &lengths) in intrinsic.corners.iter().zip(&intrinsic.lengths) {
            let (cotangents, area) = Intrinsic::cotangents(lengths);
            // Side k runs from corner k to the next.
            stiffness.add(corners, cotangents, area);
        }
        Ok(stiffness)
    }

    /// From the edge vectors of each triangle, after a change of its metric.
    fn by_corners(
        domain: &Domain,
        change: impl Fn([DVec3; 2]) -> [DVec3; 2],
    ) -> Result<Self, DisplacementError> {
        let mut stiffness = Self { weights: Vec::new(), areas: vec![0.0; domain.len()] };
        for (index, &corners) in domain.triangles.iter().enumerate() {
            let [a, b, c] = corners.map(|v| domain.positions[v as usize]);
            let [ab, ac] = change([b - a, c - a]);
            let bc = ac - ab;
            let double_area = ab.cross(ac).length();
            // The angle opposite to the side from corner k to the next.
            let cotangents = [bc.dot(ac), ab.dot(ac), -bc.dot(ab)].map(|dot| dot / double_area);
            if !(double_area > 0.0 && cotangents.iter().all(|c| c.is_finite())) {
                return Err(DisplacementError::FlatTriangle(index));
            }
            stiffness.add(corners, cotangents, 0.5 * double_area);
        }
        Ok(stiffness)
    }

    fn add(&mut self, corners: [u32; 3], cotangents: [f64; 3], area: f64) {
        for k in 0..3 {
            let (from, to) = (corners[k], corners[(k + 1) % 3]);
            // An edge from a vertex to itself asks nothing of it.
            if from != to {
                self.weights.push((from, to, 0.5 * cotangents[k]));
            }
            self.areas[from as usize] += area / 3.0;
        }
    }

    /// `L x`.
    #[cfg(test)]
    pub(super) fn apply(&self, x: &[f64]) -> Vec<f64> {
        let mut result = vec![0.0; x.len()];
        for &(a, b, weight) in &self.weights {
            let flow = weight * (x[a as usize] - x[b as usize]);
            result[a as usize] += flow;
            result[b as usize] -= flow;
        }
        result
    }
}

/// Two edges of a triangle in the metric `T⁻¹` of section 11, `T = k t tᵀ + (1/k) n nᵀ`: with it cotangents are the
/// entries of the stiffness of `div (T grad h)`, since `det T = 1`. Where the direction stands upright the triangle is
/// left as it is.
fn squeezed(edges: [DVec3; 2], direction: Direction) -> [DVec3; 2] {
    let Some(normal) = edges[0].cross(edges[1]).try_normalize() else { return edges };
    let Some([along, across]) = frame(normal, direction.along) else { return edges };
    let root = libm::sqrt(direction.stretch);
    edges.map(|edge| DVec3::new(edge.dot(along) / root, edge.dot(across) * root, 0.0))
}

/// The direction within a plane, and across.
fn frame(normal: DVec3, along: DVec3) -> Option<[DVec3; 2]> {
    let within = along - normal * normal.dot(along);
    // Below this nothing but rounding is left of it.
    let along = if within.length() > 1e-9 { within.try_normalize()? } else { return None };
    Some([along, normal.cross(along)])
}

/// A plane domain squeezed as a whole: then one metric serves all triangles, and edges can be flipped in it.
fn mapped_plane(domain: &Domain, direction: Direction) -> Option<Domain> {
    let corner = |v: u32| domain.positions[v as usize];
    let widest = domain
        .triangles
        .iter()
        .map(|&[a, b, c]| (corner(b) - corner(a)).cross(corner(c) - corner(a)))
        .reduce(|x, y| if y.length_squared() > x.length_squared() { y } else { x })?;
    let normal = widest.try_normalize()?;
    let origin = corner(domain.triangles[0][0]);
    let is_flat = |&v: &u32| normal.dot(corner(v) - origin).abs() < 1e-9;
    if !domain.triangles.as_flattened().iter().all(is_flat) {
        return None;
    }
    let [along, across] = frame(normal, direction.along)?;
    let root = libm::sqrt(direction.stretch);
    let mut mapped = domain.clone();
    for position in &mut mapped.positions {
        let within = DVec2::new(position.dot(along), position.dot(across));
        *position = DVec3::new(within.x / root, within.y * root, 0.0);
    }
    Some(mapped)
}
