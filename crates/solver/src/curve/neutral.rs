//! The neutral curve, `κ'' = 0`: its curvature grows linearly from control point to control point.
//!
//! Source: recipe sections 0 and 9 (the surface's `ΔH = 0`) with the geometry frozen, as in Welch 1995, section 5.3: the
//! derivative of `∫ κ² ds` in which only `κ` answers to an offset. Every edge carries the shear `f = 2 ΔK × e / ds`
//! from hinge to hinge (with the lengths of `fair`), and a free node is at rest when the shears of both its edges are
//! equal. In a plane these are the splines of clothoids; circles and lines are among them. At a free end `κ = 0`, at
//! a clamp the curvature may jump. Forces add up to zero, moments do not: there is no energy behind them.

use glam::DVec3;

use super::Chain;
use super::fair::{Link, links};
use super::hinge::Hinge;

/// Adds the forces on all nodes.
pub(super) fn add_forces(chain: Chain, hinges: &[Hinge], forces: &mut [DVec3]) {
    for Link { first, second, ds, is_edge } in links(chain, hinges) {
        if is_edge {
            let (first, second) = (&hinges[first], &hinges[second]);
            let shear = (second.binormal - first.binormal).cross(first.ahead) * (2.0 / ds);
            forces[first.node] += shear;
            forces[second.node] -= shear;
        }
    }
    if chain.closed {
        return;
    }
    if let Some(hinge) = hinges.first().filter(|hinge| hinge.is_sound)
        && let Some(end) = hinge.before
    {
        let ds = (2.0 * hinge.ds + hinge.r_behind) / 3.0;
        let shear = hinge.binormal.cross(hinge.behind) * (2.0 / ds);
        forces[end] += shear;
        forces[hinge.node] -= shear;
    }
    if let Some(hinge) = hinges.last().filter(|hinge| hinge.is_sound)
        && let Some(end) = hinge.after
    {
        let ds = (2.0 * hinge.ds + hinge.r_ahead) / 3.0;
        let shear = hinge.binormal.cross(hinge.ahead) * (-2.0 / ds);
        forces[hinge.node] += shear;
        forces[end] -= shear;
    }
}
