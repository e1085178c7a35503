//! The ground of a relief: a region that takes it on, in frames of its own surface.

use super::chart::Chart;
use super::disc::Disc;
use super::error::ReliefError;
use super::stamp::{Stamp, axes};
use core::f64::consts::TAU;
use glam::{DMat3, DQuat, DVec2, DVec3};

/// A disc that can take on reliefs. Its chart is that of the shape that it was made from; the frames follow the surface.
#[derive(Clone, Debug)]
pub struct Ground {
    disc: Disc,
    places: Vec<DVec2>,
    angles: Vec<f64>,
    is_rim: Vec<bool>,
}

/// A relief on a ground: of each vertex what the stamp has there.
#[derive(Clone, Debug)]
pub struct Impression {
    /// Turned, and in lengths of the rim.
    relief: Vec<DVec3>,
}

impl Ground {
    /// A disc of a mesh with these positions. `start` is the place of the anchor in its rim.
    ///
    /// # Errors
    /// [`ReliefError::Flat`] if the rim has no length.
    pub fn new(disc: Disc, positions: &[DVec3], start: usize) -> Result<Self, ReliefError> {
        let Chart { places, angles, .. } = Chart::new(&disc, &disc.own(positions), start)?;
        let mut is_rim = vec![false; places.len()];
        disc.rim.iter().for_each(|&v| is_rim[v as usize] = true);
        Ok(Self { disc, places, angles, is_rim })
    }

    /// Its vertices in the mesh.
    #[must_use]
    pub fn vertices(&self) -> &[u32] {
        self.disc.vertices()
    }

    /// Of each vertex its place in the unit disc.
    #[must_use]
    pub fn places(&self) -> &[DVec2] {
        &self.places
    }

    /// Reads a stamp, turned counter-clockwise by an angle in radians.
    #[must_use]
    pub fn read(&self, stamp: &Stamp, turn: f64) -> Impression {
        let turned = DVec2::new(libm::cos(turn), libm::sin(turn));
        let back = DVec2::new(turned.x, -turned.y);
        let read = |(place, is_rim): (&DVec2, &bool)| {
            // The rim stays where it is: it belongs to the surface around, too.
            if *is_rim {
                return DVec3::ZERO;
            }
            let relief = stamp.relief_at(back.rotate(*place));
            turned.rotate(relief.truncate()).extend(relief.z)
        };
        Impression { relief: self.places.iter().zip(&self.is_rim).map(read).collect() }
    }

    /// By what each of its vertices moves: the relief with its heights multiplied by `strength`, in the frames of the surface
    /// as it is now. Positions and unit normals are those of the whole mesh; which of the two sides normals show does not
    /// matter.
    #[must_use]
    pub fn offsets(
        &self,
        impression: &Impression,
        strength: f64,
        positions: &[DVec3],
        normals: &[DVec3],
    ) -> Vec<DVec3> {
        let length = self.rim_length(positions);
        let frames = self.frames(positions, normals);
        let raise = DVec3::new(1.0, 1.0, strength);
        frames
            .iter()
            .zip(&impression.relief)
            .map(|(frame, relief)| *frame * (*relief * raise) * length)
            .collect()
    }

    /// By how much a stamp must be turned to lie here as it stands in space, but for the least rotation that lays its rim
    /// along this one's; in (−π, π].
    ///
    /// # Errors
    /// [`ReliefError::Flat`] if the rim encloses no area.
    pub fn natural_turn(&self, stamp: &Stamp, positions: &[DVec3]) -> Result<f64, ReliefError> {
        let own = axes(&self.rim(positions), &self.angles, self.rim_length(positions))?;
        let theirs = stamp.axes();
        let laid = DQuat::from_rotation_arc(theirs.z_axis, own.z_axis) * theirs.x_axis;
        let turn = libm::atan2(laid.dot(own.y_axis), laid.dot(own.x_axis));
        Ok(if turn <= -0.5 * TAU { turn + TAU } else { turn })
    }

    fn rim(&self, positions: &[DVec3]) -> Vec<DVec3> {
        self.disc.rim().map(|v| positions[v as usize]).collect()
    }

    /// Length of its rim now.
    #[must_use]
    pub fn rim_length(&self, positions: &[DVec3]) -> f64 {
        let rim = self.rim(positions);
        (0..rim.len()).map(|k| rim[k].distance(rim[(k + 1) % rim.len()])).sum()
    }

    /// Frames at the vertices: along the gradient of the first coordinate, across it, and up on the side from which the
    /// triangles look counter-clockwise.
    fn frames(&self, positions: &[DVec3], normals: &[DVec3]) -> Vec<DMat3> {
        let own = self.disc.own(positions);
        let mut gradients = vec![DVec3::ZERO; own.len()];
        let mut areas = vec![DVec3::ZERO; own.len()];
        for triangle in &self.disc.triangles {
            let corners = triangle.map(|v| v as usize);
            let [a, b, c] = corners.map(|v| own[v]);
            let area = (b - a).cross(c - a);
            let Some(normal) = area.try_normalize() else { continue };
            // ∇u = Σ u_i n × e_i / (2 A), with e_i the side opposite the corner; weighted by A.
            let along: DVec3 = [c - b, a - c, b - a]
                .iter()
                .zip(corners)
                .map(|(side, v)| normal.cross(*side) * self.places[v].x)
                .sum();
            for v in corners {
                gradients[v] += along;
                areas[v] += area;
            }
        }
        let frame = |(k, &v): (usize, &u32)| {
            let given = normals[v as usize];
            let up = if given.dot(areas[k]) < 0.0 { -given } else { given };
            let up = up.try_normalize().or_else(|| areas[k].try_normalize()).unwrap_or(DVec3::Z);
            let flat = gradients[k] - up * up.dot(gradients[k]);
            let along = flat.try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
            DMat3::from_cols(along, up.cross(along), up)
        };
        self.disc.vertices().iter().enumerate().map(frame).collect()
    }
}
