//! A disc spread over the unit disc: harmonic coordinates, the rim by its length on the circle.
//!
//! Kind and sign: solves `Σ w (f_j − f_i) = 0` at the inner vertices with the cotangent weights `w = cot α + cot β`, none of
//! them below [`LEAST`]: with positive weights and a convex border every triangle of the chart has positive area (Tutte 1963;
//! Floater 2003). On meshes of Delaunay triangles nothing is cut off, and linear functions are harmonic.

use super::disc::Disc;
use super::error::ReliefError;
use core::f64::consts::TAU;
use ductile_solver::SymmetricFactor;
use glam::{DVec2, DVec3};

/// Smallest weight of an edge; an edge between two right angles has weight 0.
const LEAST: f64 = 1e-2;
/// Largest cotangent of an angle: about half a degree.
const MOST: f64 = 1e2;
/// No unknown.
const FIXED: usize = usize::MAX;

/// Harmonic functions on a disc.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    /// Of each vertex its place in the unit disc.
    pub(super) places: Vec<DVec2>,
    /// Length of the rim, and of each of its vertices the angle on the circle.
    pub(super) length: f64,
    pub(super) angles: Vec<f64>,
    harmonic: Harmonic,
}

impl Chart {
    /// Spreads a disc; `start` is the place in its rim that comes to lie at (1, 0).
    pub(super) fn new(disc: &Disc, positions: &[DVec3], start: usize) -> Result<Self, ReliefError> {
        let (angles, length) = angles(disc, positions, start)?;
        let mut harmonic = Harmonic::new(disc, positions)?;
        let on_circle: Vec<DVec3> =
            angles.iter().map(|&angle| DVec3::new(libm::cos(angle), libm::sin(angle), 0.0)).collect();
        let places = harmonic.extend(disc, &on_circle).iter().map(|place| place.truncate()).collect();
        Ok(Self { places, length, angles, harmonic })
    }

    /// The harmonic function with given values along the rim.
    pub(super) fn extend(&mut self, disc: &Disc, along: &[DVec3]) -> Vec<DVec3> {
        self.harmonic.extend(disc, along)
    }
}

/// The angle of each vertex of a rim, and the length of the rim.
fn angles(disc: &Disc, positions: &[DVec3], start: usize) -> Result<(Vec<f64>, f64), ReliefError> {
    let count = disc.rim.len();
    let at = |k: usize| positions[disc.rim[(start + k) % count] as usize];
    let mut lengths = vec![0.0; count];
    let mut length = 0.0;
    for k in 0..count {
        lengths[(start + k) % count] = length;
        length += at(k).distance(at(k + 1));
    }
    if !(length.is_finite() && length > 0.0) {
        return Err(ReliefError::Flat);
    }
    Ok((lengths.into_iter().map(|along| TAU * along / length).collect(), length))
}

/// The Laplacian of a disc, factorised.
#[derive(Clone, Debug)]
struct Harmonic {
    /// Of each vertex its unknown.
    unknown: Vec<usize>,
    /// Edges to the rim: unknown, vertex of the rim, weight.
    to_rim: Vec<(usize, usize, f64)>,
    factor: Option<SymmetricFactor>,
    count: usize,
}

impl Harmonic {
    fn new(disc: &Disc, positions: &[DVec3]) -> Result<Self, ReliefError> {
        let mut unknown = vec![0; positions.len()];
        disc.rim.iter().for_each(|&v| unknown[v as usize] = FIXED);
        let mut count = 0;
        for unknown in unknown.iter_mut().filter(|unknown| **unknown != FIXED) {
            *unknown = count;
            count += 1;
        }
        let (mut entries, mut to_rim) = (Vec::new(), Vec::new());
        for ([a, b], weight) in weights(disc, positions) {
            match (unknown[a], unknown[b]) {
                (FIXED, FIXED) => {}
                (FIXED, own) => {
                    entries.push((own, own, weight));
                    to_rim.push((own, a, weight));
                }
                (own, FIXED) => {
                    entries.push((own, own, weight));
                    to_rim.push((own, b, weight));
                }
                (one, other) => {
                    entries.extend([(one, one, weight), (other, other, weight), (one, other, -weight)]);
                }
            }
        }
        let factor = (count > 0).then(|| SymmetricFactor::new(count, &entries)).transpose();
        Ok(Self { unknown, to_rim, factor: factor.map_err(|_| ReliefError::Flat)?, count })
    }

    fn extend(&mut self, disc: &Disc, along: &[DVec3]) -> Vec<DVec3> {
        let mut values = vec![DVec3::ZERO; self.unknown.len()];
        for (&v, &value) in disc.rim.iter().zip(along) {
            values[v as usize] = value;
        }
        let Some(factor) = &mut self.factor else { return values };
        let mut x = vec![0.0; 3 * self.count];
        for &(own, rim, weight) in &self.to_rim {
            for axis in 0..3 {
                x[axis * self.count + own] += weight * values[rim][axis];
            }
        }
        factor.solve(&mut x);
        for (value, &own) in values.iter_mut().zip(&self.unknown).filter(|(_, own)| **own != FIXED) {
            *value = DVec3::new(x[own], x[self.count + own], x[2 * self.count + own]);
        }
        values
    }
}

/// The weight of each edge.
fn weights(disc: &Disc, positions: &[DVec3]) -> Vec<([usize; 2], f64)> {
    let mut halves = Vec::with_capacity(3 * disc.triangles.len());
    for triangle in &disc.triangles {
        let corners = triangle.map(|v| v as usize);
        for k in 0..3 {
            let (apex, a, b) = (corners[k], corners[(k + 1) % 3], corners[(k + 2) % 3]);
            let (u, v) = (positions[a] - positions[apex], positions[b] - positions[apex]);
            let cotangent = u.dot(v) / u.cross(v).length();
            let cotangent = if cotangent.is_finite() { cotangent.clamp(-MOST, MOST) } else { 0.0 };
            halves.push(([a.min(b), a.max(b)], cotangent));
        }
    }
    halves.sort_by_key(|(edge, _)| *edge);
    let mut whole: Vec<([usize; 2], f64)> = Vec::new();
    for (edge, half) in halves {
        match whole.last_mut() {
            Some((last, sum)) if *last == edge => *sum += half,
            _ => whole.push((edge, half)),
        }
    }
    whole.iter_mut().for_each(|(_, weight)| *weight = weight.max(LEAST));
    whole
}
