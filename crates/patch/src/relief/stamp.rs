//! A stamp: a disc and its relief, the vectors from the membrane in its rim to the disc itself.

use super::chart::Chart;
use super::disc::Disc;
use super::error::ReliefError;
use super::lookup::Lookup;
use glam::{DMat3, DVec2, DVec3};

/// An area below this part of the square of the rim is none.
const NOTHING: f64 = 1e-9;

/// A disc whose relief can be taken.
#[derive(Clone, Debug)]
pub struct Stamp {
    triangles: Vec<[u32; 3]>,
    places: Vec<DVec2>,
    lookup: Lookup,
    /// At each vertex, in the axes of the rim and in lengths of the rim.
    relief: Vec<DVec3>,
    axes: DMat3,
    length: f64,
}

impl Stamp {
    /// The relief of a disc of a mesh with these positions. `start` is the place of the anchor in its rim.
    ///
    /// # Errors
    /// [`ReliefError::Flat`] if its rim encloses no area.
    pub fn new(disc: &Disc, positions: &[DVec3], start: usize) -> Result<Self, ReliefError> {
        let own = disc.own(positions);
        let mut chart = Chart::new(disc, &own, start)?;
        let rim: Vec<DVec3> = disc.rim.iter().map(|&v| own[v as usize]).collect();
        let axes = axes(&rim, &chart.angles, chart.length)?;
        let membrane = chart.extend(disc, &rim);
        let (across, length) = (axes.transpose(), chart.length);
        let relief =
            own.iter().zip(&membrane).map(|(at, membrane)| across * (*at - *membrane) / length).collect();
        let lookup = Lookup::new(&chart.places, &disc.triangles);
        Ok(Self { triangles: disc.triangles.clone(), places: chart.places, lookup, relief, axes, length })
    }

    /// The relief at a place of the unit disc: in the axes of the rim, in lengths of the rim.
    #[must_use]
    pub fn relief_at(&self, place: DVec2) -> DVec3 {
        let found = self.lookup.find(&self.places, &self.triangles, place);
        found.map_or(DVec3::ZERO, |(corners, shares)| {
            corners.iter().zip(shares).map(|(&v, share)| self.relief[v as usize] * share).sum()
        })
    }

    /// Axes of the rim: the first toward the anchor, as nearly as the whole rim has it, the last one up.
    #[must_use]
    pub fn axes(&self) -> DMat3 {
        self.axes
    }

    /// Length of the rim.
    #[must_use]
    pub fn rim_length(&self) -> f64 {
        self.length
    }
}

/// The axes of a rim: its normal by Newell's sum, and in its plane the axes in which the rim comes nearest to the circle of
/// its angles, by least squares.
pub(super) fn axes(rim: &[DVec3], angles: &[f64], length: f64) -> Result<DMat3, ReliefError> {
    let count = rim.len();
    let (mut centre, mut area) = (DVec3::ZERO, DVec3::ZERO);
    let origin = rim.first().copied().unwrap_or_default();
    for k in 0..count {
        let (a, b) = (rim[k], rim[(k + 1) % count]);
        centre += (a + b) * (0.5 * a.distance(b));
        area += (a - origin).cross(b - origin) * 0.5;
    }
    centre /= length;
    // Written so that what is no number counts as nothing.
    let is_something = |size: f64| size > NOTHING * length * length;
    if !is_something(area.length()) {
        return Err(ReliefError::Flat);
    }
    let normal = area / area.length();
    // Σ w (r − c) e^(−iθ), with a turn by −θ about the normal for the exponential.
    let mut sum = DVec3::ZERO;
    for k in 0..count {
        let weight = rim[k].distance(rim[(k + 1) % count]) + rim[k].distance(rim[(k + count - 1) % count]);
        let flat = (rim[k] - centre) - normal * normal.dot(rim[k] - centre);
        let (sin, cos) = (libm::sin(angles[k]), libm::cos(angles[k]));
        sum += (flat * cos - normal.cross(flat) * sin) * weight;
    }
    if !is_something(sum.length()) {
        return Err(ReliefError::Flat);
    }
    let first = (sum - normal * normal.dot(sum)).try_normalize().ok_or(ReliefError::Flat)?;
    Ok(DMat3::from_cols(first, normal.cross(first), normal))
}
