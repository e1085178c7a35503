//! A hub: a point where curves of one smooth surface meet, and the plane that all of their tangents lie in.
//!
//! Sources: recipe section 10, Welch 1995, section 8.3 ("like the hub of an umbrella"). Where curves cross, a smooth
//! surface asks two things of them: that their tangents lie in one plane, and that their normal curvatures belong to
//! one quadratic form. The first is kept exactly, by construction: a spoke is a clamp (see `hinge`) whose tangent is not
//! given but an unknown, and the tangents of a hub turn within a plane that tilts as a whole. (The recipe prices the
//! misfit instead; a price leaves some of it.) A plain hinge and a clamp whose tangent is free have the same energy:
//! two springs in a row. The second asks nothing: the curvature at a single point carries no part of `∫ κ² ds`, so that
//! any quadratic form is met at no cost as the samples grow dense. Two curves always agree on the first and have no hub.
//!
//! Where a surface that does not follow the curves ends at a hub, the plane is that surface's: it is held, and a single curve has
//! a hub too.

use glam::DVec3;

use crate::dense::{self, Matrix5};

/// Weight of the normal to a prescribed tangent against those that are free.
const GIVEN: f64 = 1e6;

/// Sine of an angle below which two prescribed tangents count as one.
const PARALLEL: f64 = 1e-6;

/// A curve where it passes through a hub.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rib {
    pub(super) curve: usize,
    pub(super) node: usize,
    /// Unit tangent, along the order of the nodes.
    pub(super) tangent: DVec3,
    /// Whether the tangent is prescribed.
    pub(super) is_given: bool,
}

/// The plane of a hub and the curves in it.
#[derive(Clone, Debug, Default)]
pub(super) struct Hub {
    pub(super) ribs: Vec<Rib>,
    /// Unit normal.
    pub(super) normal: DVec3,
    /// Whether the plane is prescribed: then it does not tilt.
    pub(super) is_held: bool,
}

impl Hub {
    /// Lays plane and tangents as the chords have it, one vector `b / r₋ + a / r₊` for each rib: the tangent that is
    /// best for a clamp is along it.
    pub(super) fn align(&mut self, chords: impl Iterator<Item = DVec3>) {
        for (rib, chord) in self.ribs.iter_mut().zip(chords).filter(|(rib, _)| !rib.is_given) {
            rib.tangent = chord.try_normalize().unwrap_or(DVec3::X);
        }
        if self.is_held {
            self.flatten();
            return;
        }
        let mut spread: Matrix5<f64> = [[0.0; 5]; 5];
        let is_decided = self.is_decided();
        for rib in self.ribs.iter().filter(|rib| rib.is_given || !is_decided) {
            let weight = if rib.is_given { GIVEN } else { 1.0 };
            for i in 0..3 {
                for j in 0..3 {
                    spread[i][j] += weight * rib.tangent[i] * rib.tangent[j];
                }
            }
        }
        let eigen = dense::eigen(&spread);
        let least = (0..3).fold(0, |best, k| if eigen.values[k] < eigen.values[best] { k } else { best });
        let normal = DVec3::new(eigen.vectors[0][least], eigen.vectors[1][least], eigen.vectors[2][least]);
        let given = self.given().next().filter(|_| !is_decided);
        let across = given.map_or(normal, |given| normal - given * given.dot(normal));
        self.normal = across.try_normalize().unwrap_or(DVec3::Z);
        self.flatten();
    }

    /// The directions in which the normal may tilt: two, but the plane stays on a prescribed tangent.
    pub(super) fn tilts(&self) -> Vec<DVec3> {
        match self.given().next() {
            _ if self.is_held => Vec::new(),
            None => {
                let one = self.normal.any_orthonormal_vector();
                vec![one, self.normal.cross(one)]
            }
            Some(tangent) if !self.is_decided() => vec![self.normal.cross(tangent)],
            _ => Vec::new(),
        }
    }

    /// Whether the prescribed tangents leave the plane no choice. (More than two may contradict each other: then the
    /// plane is the nearest to them all.)
    fn is_decided(&self) -> bool {
        let first = self.given().next().unwrap_or(DVec3::ZERO);
        self.given().any(|other| first.cross(other).length() > PARALLEL)
    }

    /// The hub with its plane tilted and its tangents turned, each back in the plane.
    pub(super) fn turned(&self, tilt: DVec3, turns: &[DVec3], scale: f64) -> Self {
        let mut turned = self.clone();
        turned.normal = (self.normal + tilt * scale).try_normalize().unwrap_or(self.normal);
        for (rib, turn) in turned.ribs.iter_mut().zip(turns).filter(|(rib, _)| !rib.is_given) {
            rib.tangent += *turn * scale;
        }
        turned.flatten();
        turned
    }

    /// Prescribes another plane by its unit normal, where one is prescribed; returns the angle by which that turns it.
    pub(super) fn hold(&mut self, normal: DVec3) -> f64 {
        let turned = libm::atan2(self.normal.cross(normal).length(), self.normal.dot(normal).abs());
        self.normal = normal;
        self.flatten();
        turned
    }

    fn given(&self) -> impl Iterator<Item = DVec3> + '_ {
        self.ribs.iter().filter(|rib| rib.is_given).map(|rib| rib.tangent)
    }

    /// Puts the tangents that are free into the plane.
    fn flatten(&mut self) {
        let normal = self.normal;
        for rib in self.ribs.iter_mut().filter(|rib| !rib.is_given) {
            let flat = rib.tangent - normal * normal.dot(rib.tangent);
            rib.tangent = flat.try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        }
    }
}
