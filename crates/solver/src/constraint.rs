//! Prescribed tangent planes: which nodes have one, where it is now and where it should come to.
//!
//! Source: Welch 1995, sections 3.2 and 5.5. A plane that is far from the one the surface has is turned there by degrees, at
//! most [`MOST_TURN`] a step, from the one that it has: a surface follows a turning rim, but laid open by a sudden one it
//! may find the other of the two ways to lie in a plane. While a plane turns it is a control that moves; each step goes
//! down the energy that belongs to the planes at that step. A plane that the surface lags behind turns more slowly.

use std::sync::Arc;

use glam::DVec3;

use crate::clamp::Clamp;
use crate::error::{SolverError, check_finite};
use crate::fits::Fits;
use crate::rings::Rings;

/// Largest angle by which a plane is turned in one step.
const MOST_TURN: f64 = 0.25;
/// How far a plane may be ahead of the surface and still turn at that speed.
const MOST_LAG: f64 = 0.3;
/// The part of it that is left to a plane that the surface does not follow (it may never: across a curve, say).
const SLOW: f64 = 0.125;
/// Angle below which a plane is where it should be.
const ARRIVED: f64 = 1e-12;
/// Change of what is asked for that needs no new proof of rest.
const SAME: f64 = 1e-9;
/// No clamp.
const NONE: u32 = u32::MAX;

/// A prescribed tangent plane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plane {
    pub(crate) node: u32,
    /// The batch of the node, and its lane.
    pub(crate) home: (usize, usize),
    /// The unit normal that is asked for.
    target: DVec3,
    /// The unit normal that is met now; none before the first fit.
    now: Option<DVec3>,
}

impl Plane {
    /// The unit normal that is met now.
    pub(crate) fn normal(&self) -> DVec3 {
        self.now.unwrap_or(self.target)
    }

    /// The angle still to go.
    fn left(&self) -> f64 {
        self.now.map_or(0.0, |now| angle(now, self.target))
    }
}

/// The prescribed tangent planes of a surface.
#[derive(Clone, Debug)]
pub(crate) struct Planes {
    /// Per node its place in the list.
    index: Arc<[u32]>,
    list: Vec<Plane>,
}

fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

impl Planes {
    /// None where nothing is asked for.
    pub(crate) fn new(
        rings: &Rings,
        fixed: &[bool],
        normals: &[(u32, DVec3)],
    ) -> Result<Option<Self>, SolverError> {
        let mut index = vec![NONE; rings.len()];
        let mut list: Vec<Plane> = Vec::new();
        for &(node, normal) in normals {
            let target = checked(rings, fixed, node, normal)?;
            let place = &mut index[node as usize];
            if *place == NONE {
                *place = u32::try_from(list.len()).unwrap_or(NONE);
                list.push(Plane { node, home: (0, 0), target, now: None });
            } else {
                list[*place as usize].target = target;
            }
        }
        if list.is_empty() {
            return Ok(None);
        }
        for (number, batch) in rings.batches().iter().enumerate() {
            for (lane, node) in batch.nodes[..batch.count].iter().enumerate() {
                if index[*node as usize] != NONE {
                    list[index[*node as usize] as usize].home = (number, lane);
                }
            }
        }
        Ok(Some(Self { index: index.into(), list }))
    }

    /// Whether the same nodes have planes.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        self.index == other.index
    }

    /// Takes over where planes stand that were there before.
    pub(crate) fn go_on_from(&mut self, other: &Self) {
        for plane in &mut self.list {
            plane.now = other.place(plane.node as usize).and_then(|place| other.list[place].now);
        }
    }

    /// Takes over what is asked for, of the same nodes; returns whether that is noticeably something else than before.
    pub(crate) fn retarget(&mut self, other: &Self) -> bool {
        let mut is_new = false;
        for (plane, new) in self.list.iter_mut().zip(&other.list) {
            is_new |= angle(plane.target, new.target) > SAME;
            plane.target = new.target;
        }
        is_new
    }

    /// The place of a node's plane.
    #[inline]
    pub(crate) fn place(&self, node: usize) -> Option<usize> {
        let place = self.index[node];
        (place != NONE).then_some(place as usize)
    }

    pub(crate) fn has(&self, node: usize) -> bool {
        self.index[node] != NONE
    }

    pub(crate) fn list(&self) -> &[Plane] {
        &self.list
    }

    /// Whether a plane of this node is already turning or turned, so that the fit has it.
    pub(crate) fn is_begun(&self) -> bool {
        self.list.iter().all(|plane| plane.now.is_some())
    }

    /// Lets planes begin where the surface has them. The sense of the fit is kept: a plane asked for with the other one lies
    /// more than a right angle away, and is turned all the way.
    pub(crate) fn begin(&mut self, fits: &Fits) {
        for plane in self.list.iter_mut().filter(|plane| plane.now.is_none()) {
            plane.now = fits.nodes[plane.node as usize].normal.try_normalize().or(Some(plane.target));
        }
    }

    /// Every plane is where it was prescribed.
    pub(crate) fn arrive(&mut self) {
        self.list.iter_mut().for_each(|plane| plane.now = Some(plane.target));
    }

    /// Turns every plane towards what is asked for, as far as one step may; returns whether any turned.
    pub(crate) fn turn(&mut self, clamps: &[Clamp]) -> bool {
        let mut has_turned = false;
        for (plane, clamp) in self.list.iter_mut().zip(clamps) {
            let (left, now) = (plane.left(), plane.normal());
            if now == plane.target {
                continue;
            }
            has_turned = true;
            let most = if angle(clamp.follower, now) > MOST_LAG { SLOW * MOST_TURN } else { MOST_TURN };
            plane.now = Some(if left <= most { plane.target } else { turned(now, plane.target, most) });
        }
        has_turned
    }

    /// The largest angle by which a plane is not yet where it should be.
    pub(crate) fn left(&self) -> f64 {
        let left = self.list.iter().map(Plane::left).fold(0.0, f64::max);
        if left < ARRIVED { 0.0 } else { left }
    }
}

/// Refuses what cannot be met.
fn checked(rings: &Rings, fixed: &[bool], node: u32, normal: DVec3) -> Result<DVec3, SolverError> {
    if node as usize >= rings.len() {
        return Err(SolverError::UnknownNode(node));
    }
    if !fixed[node as usize] {
        return Err(SolverError::NotFixed(node));
    }
    check_finite(node, normal)?;
    // The largest coordinate first, so that neither tiny nor huge ones lose their direction.
    let size = normal.abs().max_element();
    (normal / size).try_normalize().ok_or(SolverError::NoDirection(node))
}

/// `now` turned towards `target` by an angle.
fn turned(now: DVec3, target: DVec3, by: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(by);
    let across = (target - now * now.dot(target))
        .try_normalize()
        // Straight against it no way round is better than another.
        .unwrap_or_else(|| now.any_orthonormal_vector());
    (now * cos + across * sin).try_normalize().unwrap_or(target)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A plane at the centre of a disc, asked for at an angle from where it begins; and a surface that has a normal there.
    fn asked(angle: f64, follower: DVec3) -> (Planes, Vec<Clamp>) {
        let disc = workload::disc(2);
        let rings = Rings::from_triangles(disc.positions.len(), &disc.triangles).unwrap();
        let target = DVec3::new(libm::sin(angle), 0.0, libm::cos(angle));
        let mut planes = Planes::new(&rings, &disc.fixed, &[(0, target * 7.0)]).unwrap().unwrap();
        planes.list[0].now = Some(DVec3::Z);
        (planes, vec![Clamp::following(follower)])
    }

    #[test]
    fn a_plane_turns_by_degrees_and_arrives_exactly() {
        let (mut planes, mut clamps) = asked(0.6, DVec3::Z);
        for left in [0.35, 0.1, 0.0] {
            assert!(planes.turn(&clamps));
            assert!((planes.left() - left).abs() < 1e-12, "{}", planes.left());
            clamps = vec![Clamp::following(planes.list[0].normal())];
        }
        assert_eq!(planes.list[0].normal(), planes.list[0].target);
        assert!(!planes.turn(&clamps), "it is there");
    }

    #[test]
    fn a_plane_waits_for_a_surface_that_lags_behind_but_not_for_ever() {
        let (mut planes, clamps) = asked(2.0, DVec3::Z);
        let steps = (0..200).take_while(|_| planes.turn(&clamps)).count();
        // Two quarters of a radian, then an eighth of a quarter at a time.
        assert_eq!(steps, 2 + 48);
    }

    #[test]
    fn a_plane_straight_against_the_surface_turns_some_way() {
        let (mut planes, clamps) = asked(std::f64::consts::PI, DVec3::Z);
        planes.list[0].target = DVec3::NEG_Z;
        assert!(planes.turn(&clamps));
        assert!((planes.left() - (std::f64::consts::PI - MOST_TURN)).abs() < 1e-12);
    }
}
