//! Third-order fairness of a curve, `∫ |κ'|² ds`: circles and straight lines cost nothing, however they are sampled.
//!
//! Source: recipe sections 9 and 10. Between two neighbouring hinges
//!
//! ```text
//! E = Σ |K₊ - K₋|² / ds,   ds = (r₋ + r + r₊) / 3
//! ```
//!
//! with the binormals of `hinge`, between which no frame is needed. `ds` is the distance between the centroids where the
//! two curvatures are met, so that a curvature that grows linearly is seen exactly on uneven samples too; the
//! three thirds of every edge add up to its length. At a clamp both of its hinges are neighbours over an edge of
//! no length: the curvature may not jump there. Free ends have `κ' = 0`.

use glam::DVec3;

use super::Chain;
use super::hinge::{Answer, Hinge};

/// Two neighbouring hinges, by index.
#[derive(Clone, Copy, Debug)]
pub(super) struct Link {
    pub(super) first: usize,
    pub(super) second: usize,
    /// Distance between the places where their curvatures are met.
    pub(super) ds: f64,
    /// Whether they share an edge; else they share a clamped node.
    pub(super) is_edge: bool,
}

/// The pairs of neighbouring hinges that are sound.
pub(super) fn links(chain: Chain, hinges: &[Hinge]) -> impl Iterator<Item = Link> + '_ {
    let count = hinges.len();
    let pairs = if chain.closed && count > 2 { count } else { count.saturating_sub(1) };
    (0..pairs).filter_map(move |first| {
        let second = if first + 1 == count { 0 } else { first + 1 };
        let (one, other) = (&hinges[first], &hinges[second]);
        let is_edge = one.after == Some(other.node) && other.before == Some(one.node);
        let is_node = one.node == other.node;
        let shared = if is_edge { one.r_ahead } else { 0.0 };
        // 2 ds is the length of both chords of a hinge.
        let ds = (2.0 * (one.ds + other.ds) - shared) / 3.0;
        ((is_edge || is_node) && one.is_sound && other.is_sound).then_some(Link {
            first,
            second,
            ds,
            is_edge,
        })
    })
}

/// The energy.
pub(super) fn value(chain: Chain, hinges: &[Hinge]) -> f64 {
    let cost =
        |link: Link| (hinges[link.second].binormal - hinges[link.first].binormal).length_squared() / link.ds;
    links(chain, hinges).map(cost).sum()
}

/// The derivative of the energy by the binormal and the lengths of each hinge.
pub(super) fn slopes(chain: Chain, hinges: &[Hinge]) -> Vec<(DVec3, Answer)> {
    let mut slopes = vec![(DVec3::ZERO, Answer::default()); hinges.len()];
    for Link { first, second, ds, is_edge } in links(chain, hinges) {
        let difference = hinges[second].binormal - hinges[first].binormal;
        let pull = difference * (2.0 / ds);
        slopes[first].0 -= pull;
        slopes[second].0 += pull;
        let along = -difference.length_squared() / (3.0 * ds * ds);
        slopes[first].1.r_behind += along;
        slopes[second].1.r_ahead += along;
        if is_edge {
            slopes[first].1.r_ahead += along;
        }
    }
    slopes
}
