//! The surface over a cage: one patch for each quad, blended from the local surfaces of its four corners.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*, equations (3)-(8). It runs through every vertex of the quads;
//! neighbours share tangent planes, and with [`Map::Smooth`] curvatures too. Quad `[a,b,c,d]` has `S(0,0) = a`, `S(1,0) = b`,
//! `S(1,1) = c`, `S(0,1) = d`; normals have the direction of `S_u x S_v`, outward where faces run counter-clockwise.

use super::Cage;
use super::blend::{Blend, Blender};
use super::error::CageError;
use super::interpolant::weights;
use super::kite::{self, Map};
use super::links::{Links, check_positions, name};
use super::ring::{Boundary, Ring, rings};
use super::split::{self, Split};
use crate::jet::Jet;
use crate::surface_point::{self, unit_normal};
use glam::DVec3;
use std::sync::Arc;

/// How the surface is built over its cage.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Settings {
    /// From the square to the local surfaces of irregular vertices.
    pub map: Map,
    /// How the weight of a corner fades.
    pub blend: Blend,
    /// How faces become quads.
    pub split: Split,
    /// How rings at the boundary are completed.
    pub boundary: Boundary,
}

/// A point of the surface and what it is like there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The place.
    pub point: DVec3,
    /// First derivatives by `u` and `v`; at a corner those along the two edges.
    pub first: [DVec3; 2],
    /// Second derivatives by `uu`, `uv` and `vv`; none at an irregular vertex, where they depend on the direction although the
    /// curvature does not.
    pub second: Option<[DVec3; 3]>,
    /// Unit normal; none where the derivatives span no plane.
    pub normal: Option<DVec3>,
    /// Principal curvatures, the larger first, in one over length: positive where the surface bends towards its normal. A
    /// sphere of radius r with its normals outward has `[-1/r, -1/r]`. None without a normal.
    pub curvatures: Option<[f64; 2]>,
}

/// A surface over a cage. Its cage may be moved; another connectivity needs a new surface. Clones share the connectivity.
#[derive(Clone, Debug)]
pub struct CageSurface {
    settings: Settings,
    cage: Arc<Links>,
    /// Connectivity of the quads; half-edge `4q + i` is corner `i` of quad `q`.
    pub(super) links: Arc<Links>,
    quads: Arc<[[u32; 4]]>,
    first_quad: Vec<u32>,
    positions: Vec<DVec3>,
    rings: Arc<[Ring]>,
    /// Which quad of its vertex's fan each half-edge is in.
    place_in_fan: Vec<u32>,
    blender: Blender,
}

/// Closer to an irregular vertex than this its local surface stands for the blend in curvatures: what is lost is of this order
/// relative to the curvature, where second derivatives that grow as one over the distance would lose as much to rounding.
const AT_VERTEX: f64 = 1e-8;

impl CageSurface {
    /// The surface over a cage.
    ///
    /// # Errors
    /// [`CageError::NotQuads`] without a split over other faces, and orders of the blend that make no sense; what else can be
    /// wrong with a cage was said when it was made.
    pub fn new(cage: &Cage, settings: Settings) -> Result<Self, CageError> {
        let blender = Blender::new(settings.blend)?;
        let own = cage.links();
        let (quads, first_quad) = if settings.split == Split::None {
            let quads: Result<Vec<[u32; 4]>, CageError> = (0_u32..)
                .zip(cage.faces())
                .map(|(face, corners)| {
                    let count = corners.len();
                    corners[..].try_into().map_err(|_| CageError::NotQuads { face, corners: count })
                })
                .collect();
            let quads = quads?;
            let first = (0..=name(quads.len())).collect();
            (quads, first)
        } else {
            let split::Quads { corners, first } = split::quads(own, &split::number_edges(own));
            (corners, first)
        };
        let positions = quad_positions(own, settings.split, cage.positions());
        let links = Links::new(positions.len(), &quads)?;
        let mut place_in_fan = vec![0; links.half_edge_count()];
        for vertex in 0..links.vertex_count() {
            for (place, h) in (0..).zip(links.fan(vertex)) {
                place_in_fan[h] = place;
            }
        }
        let rings = rings(&links, settings.boundary).into();
        let (cage, links, quads) = (Arc::new(own.clone()), Arc::new(links), quads.into());
        Ok(Self { settings, cage, links, quads, first_quad, positions, rings, place_in_fan, blender })
    }

    /// What it was built with.
    #[must_use]
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// Corners of all quads, after the split.
    #[must_use]
    pub fn quads(&self) -> &[[u32; 4]] {
        &self.quads
    }

    /// Vertices of the quads: those of the cage, then edge points, then face points.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// The quads of a face of the cage: the face itself, or one for each corner of it. Empty for a face that does not exist.
    #[must_use]
    pub fn quads_of_face(&self, face: usize) -> std::ops::Range<usize> {
        match (self.first_quad.get(face), self.first_quad.get(face + 1)) {
            (Some(&from), Some(&to)) => from as usize..to as usize,
            _ => 0..0,
        }
    }

    /// Whether it has no boundary.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.links.is_closed()
    }

    /// Number of faces of the cage.
    #[must_use]
    pub fn face_count(&self) -> usize {
        self.first_quad.len() - 1
    }

    /// Moves the cage to new positions of its vertices and says which vertices of the quads moved.
    ///
    /// # Errors
    /// When there are not as many as the cage has vertices, or a coordinate is none; nothing has moved then.
    pub fn move_to(&mut self, cage: &[DVec3]) -> Result<Vec<u32>, CageError> {
        let vertices = self.cage.vertex_count();
        if cage.len() != vertices {
            return Err(CageError::PositionCount { found: cage.len(), vertices });
        }
        check_positions(cage)?;
        let old = std::mem::take(&mut self.positions);
        self.positions = quad_positions(&self.cage, self.settings.split, cage);
        let pairs = (0..).zip(old.iter().zip(&self.positions));
        Ok(pairs.filter(|(_, (old, new))| old != new).map(|(vertex, _)| vertex).collect())
    }

    /// The point at `(u, v)` in [0, 1]² of a quad.
    ///
    /// # Errors
    /// [`CageError::NoSuchQuad`] and [`CageError::Parameter`].
    pub fn evaluate(&self, quad: usize, u: f64, v: f64) -> Result<SurfacePoint, CageError> {
        let Some(corners) = self.quads.get(quad) else {
            return Err(CageError::NoSuchQuad { quad, count: self.quads.len() });
        };
        if !(0.0..=1.0).contains(&u) || !(0.0..=1.0).contains(&v) {
            return Err(CageError::Parameter { u, v });
        }
        let mut sum = [DVec3::ZERO; 6];
        let mut at_vertex = None;
        for (corner, vertex) in corners.iter().enumerate() {
            let (a, b) = local(corner, u, v);
            let ring = self.ring(quad, corner);
            let n = ring.valence();
            for (weight, point) in self.corner_weights(n, a, b).iter().zip(self.ring_points(quad, corner)) {
                add(&mut sum, weight.turned(corner), point);
            }
            if n != 4 && a.max(b) < AT_VERTEX {
                at_vertex = Some((corner, *vertex, kite::is_origin(a, b)));
            }
        }
        let [point, du, dv, duu, duv, dvv] = sum;
        let normal = unit_normal(du, dv);
        let second = at_vertex.is_none_or(|(.., is_exact)| !is_exact).then_some([duu, duv, dvv]);
        let curvatures = match at_vertex {
            Some((corner, ..)) => {
                let (a, b) = local(corner, u, v);
                principal(point, self.local_surface(quad, corner, a, b))
            }
            None => principal(point, [du, dv, duu, duv, dvv]),
        };
        Ok(SurfacePoint { point, first: [du, dv], second, normal, curvatures })
    }

    /// The point on an edge of a face of the cage, from its corner `corner` (at `t` = 0) to the next (at 1), and the direction of the edge
    /// there: the derivative by `t`.
    ///
    /// # Errors
    /// [`CageError::NoSuchQuad`] for a corner that does not exist, and [`CageError::Parameter`].
    pub fn on_edge(&self, face: usize, corner: usize, t: f64) -> Result<(SurfacePoint, DVec3), CageError> {
        let quads = self.quads_of_face(face);
        let corners = if self.settings.split == Split::None { 4 } else { quads.len() };
        if quads.is_empty() || corner >= corners {
            return Err(CageError::NoSuchQuad { quad: corner, count: corners });
        }
        if self.settings.split != Split::None {
            // The quads at both corners have half of it each: the one from its corner 0 to 1, the other from 3 to 0.
            if t <= 0.5 {
                let point = self.evaluate(quads.start + corner, 2.0 * t, 0.0)?;
                return Ok((point, point.first[0] * 2.0));
            }
            let point = self.evaluate(quads.start + (corner + 1) % corners, 0.0, 2.0 - 2.0 * t)?;
            return Ok((point, point.first[1] * -2.0));
        }
        let (u, v) = [(t, 0.0), (1.0, t), (1.0 - t, 1.0), (0.0, 1.0 - t)][corner];
        let point = self.evaluate(quads.start, u, v)?;
        let [du, dv] = point.first;
        Ok((point, [du, dv, -du, -dv][corner]))
    }

    /// Weights of the vertex and its ring in a quad, at parameters as seen from that corner.
    pub(super) fn corner_weights(&self, n: usize, u: f64, v: f64) -> Vec<Jet> {
        corner_weights(n, self.settings.map, &self.blender, u, v)
    }

    /// The ring of a corner, as seen from a quad, and the place of the quad in it.
    pub(super) fn ring(&self, quad: usize, corner: usize) -> &Ring {
        &self.rings[self.quads[quad][corner] as usize]
    }

    /// Which quad of the fan at that corner this one is.
    pub(super) fn place_in_fan(&self, quad: usize, corner: usize) -> usize {
        self.place_in_fan[4 * quad + corner] as usize
    }

    fn ring_points(&self, quad: usize, corner: usize) -> impl Iterator<Item = DVec3> + '_ {
        let own = self.positions[self.quads[quad][corner] as usize];
        let ring = self.ring(quad, corner).from(self.place_in_fan(quad, corner));
        let point = |terms: &Vec<(u32, f64)>| {
            terms.iter().map(|&(vertex, by)| self.positions[vertex as usize] * by).sum::<DVec3>()
        };
        std::iter::once(own).chain(ring.map(point))
    }

    /// Derivatives of the local surface of a corner by the coordinates of its polygon.
    fn local_surface(&self, quad: usize, corner: usize, u: f64, v: f64) -> [DVec3; 5] {
        let n = self.ring(quad, corner).valence();
        let [x, y] = kite::jets(self.settings.map, n, u, v);
        let mut sum = [DVec3::ZERO; 6];
        let weights = weights(n, Jet::first(x.value), Jet::second(y.value));
        weights.iter().zip(self.ring_points(quad, corner)).for_each(|(&w, p)| add(&mut sum, w, p));
        let [_, rest @ ..] = sum;
        rest
    }
}

/// Equation (5): the parameters as corner `corner` sees them.
fn local(corner: usize, u: f64, v: f64) -> (f64, f64) {
    match corner {
        0 => (u, v),
        1 => (v, 1.0 - u),
        2 => (1.0 - u, 1.0 - v),
        _ => (1.0 - v, u),
    }
}

fn principal(point: DVec3, [dx, dy, dxx, dxy, dyy]: [DVec3; 5]) -> Option<[f64; 2]> {
    surface_point::SurfacePoint { point, dx, dy, dxx, dxy, dyy }.principal_curvatures()
}

fn add(sum: &mut [DVec3; 6], weight: Jet, point: DVec3) {
    let Jet { value, a, b, aa, ab, bb } = weight;
    for (sum, weight) in sum.iter_mut().zip([value, a, b, aa, ab, bb]) {
        *sum += point * weight;
    }
}

/// One term of equation (4): the weights of M, `C[0..n]` and `E[0..n]`, times those of the blend.
fn corner_weights(n: usize, map: Map, blender: &Blender, u: f64, v: f64) -> Vec<Jet> {
    let phi = Jet::first(u).through(blender.at(u)) * Jet::second(v).through(blender.at(v));
    let [x, y] = if n == 4 { [Jet::first(u), Jet::second(v)] } else { kite::jets(map, n, u, v) };
    weights(n, x, y).into_iter().map(|weight| weight * phi).collect()
}

fn quad_positions(cage: &Links, rule: Split, positions: &[DVec3]) -> Vec<DVec3> {
    if rule == Split::None { positions.to_vec() } else { split::positions(cage, rule, positions) }
}

#[cfg(test)]
mod property_test;
#[cfg(test)]
mod tests;
