//! Hinges: the places where a polygon bends, and how what they feel reaches the nodes.
//!
//! An inner node is a hinge between its two chords. A node with a prescribed tangent is two: one between the chord from
//! behind and the tangent, one between the tangent and the chord ahead, as if the node were doubled and an edge
//! of no length in the prescribed direction lay between. So the constraint is part of what is minimised, as a clamp is in a
//! finite element: nothing is left to satisfy, and nothing makes the matrix indefinite. The end of an open curve is a
//! hinge if it has a tangent, and none otherwise.
//!
//! With the unit chords `a` (ahead) and `b` (from behind), their lengths `r₊`, `r₋` (zero on the side of a prescribed
//! tangent) and `S = r₊ + r₋`:
//!
//! ```text
//! c_t = (r₋ a + r₊ b) / S      κ = c_tt = 2 (a - b) / S      ds = S / 2      K = 2 b × a / |r₊ a + r₋ b|
//! ```
//!
//! `κ` belongs to the quadratic through three points, exact on circles with even spacing. `K` is the binormal of the
//! circle through them (Menger), exact on every circle; it is normal to both chords, so that along an edge the
//! transport without twist leaves it as it is (Bergou et al., *Discrete elastic rods*, 2008) and the difference of
//! two neighbours needs no frame. To first order it is the curvature at the centroid of its three points.

use glam::DVec3;

use super::Chain;
use crate::barrier;

/// One hinge: what it is and what was measured there.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Hinge {
    /// The node that it stands at.
    pub(super) node: usize,
    /// The neighbour from behind; none on the side of a prescribed tangent.
    pub(super) before: Option<usize>,
    /// The neighbour ahead; none on the side of a prescribed tangent.
    pub(super) after: Option<usize>,
    /// Unit chords ahead and from behind, or the prescribed tangent.
    pub(super) ahead: DVec3,
    pub(super) behind: DVec3,
    pub(super) r_ahead: f64,
    pub(super) r_behind: f64,
    /// Length that belongs to the hinge.
    pub(super) ds: f64,
    /// `|c_t|`; at a clamp, where that sees nothing, what two like chords would have.
    pub(super) jacobian: f64,
    /// `κ`, towards the centre of curvature.
    pub(super) curvature: DVec3,
    /// `K`.
    pub(super) binormal: DVec3,
    /// Whether it has the chords it should have.
    pub(super) is_sound: bool,
}

/// What an energy feels at a hinge: its derivatives by chords and lengths.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Answer {
    pub(super) ahead: DVec3,
    pub(super) behind: DVec3,
    pub(super) r_ahead: f64,
    pub(super) r_behind: f64,
}

impl core::ops::AddAssign for Answer {
    fn add_assign(&mut self, other: Self) {
        self.ahead += other.ahead;
        self.behind += other.behind;
        self.r_ahead += other.r_ahead;
        self.r_behind += other.r_behind;
    }
}

/// The hinges of a curve, in order.
pub(super) fn hinges(chain: Chain, tangents: &[(usize, DVec3)]) -> Vec<Hinge> {
    let mut hinges = Vec::with_capacity(chain.count + tangents.len());
    let mut tangents = tangents.iter().peekable();
    for node in 0..chain.count {
        let given = tangents.next_if(|(at, _)| *at == node).map(|(_, tangent)| *tangent);
        let (before, after) = chain.sides(node);
        let plain = Hinge { node, ..Hinge::default() };
        match given {
            Some(tangent) => {
                if before.is_some() {
                    hinges.push(Hinge { before, ahead: tangent, ..plain });
                }
                if after.is_some() {
                    hinges.push(Hinge { after, behind: tangent, ..plain });
                }
            }
            None if before.is_some() && after.is_some() => hinges.push(Hinge { before, after, ..plain }),
            None => {}
        }
    }
    hinges
}

impl Hinge {
    /// Whether it stands at a prescribed tangent.
    pub(super) fn is_clamp(&self) -> bool {
        self.before.is_none() || self.after.is_none()
    }

    /// Measures it at these positions.
    pub(super) fn measure(&mut self, positions: &[DVec3]) {
        let here = positions[self.node];
        let ahead = self.after.map(|after| positions[after] - here);
        let behind = self.before.map(|before| here - positions[before]);
        self.r_ahead = ahead.map_or(0.0, DVec3::length);
        self.r_behind = behind.map_or(0.0, DVec3::length);
        let sum = self.r_ahead + self.r_behind;
        self.ds = 0.5 * sum;
        self.is_sound = (ahead.is_none() || self.r_ahead > 0.0) && (behind.is_none() || self.r_behind > 0.0);
        (self.curvature, self.binormal) = (DVec3::ZERO, DVec3::ZERO);
        if !self.is_sound {
            return;
        }
        self.ahead = ahead.map_or(self.ahead, |chord| chord / self.r_ahead);
        self.behind = behind.map_or(self.behind, |chord| chord / self.r_behind);
        self.jacobian = self.velocity().length();
        self.curvature = (self.ahead - self.behind) * (2.0 / sum);
        let across = (self.ahead * self.r_ahead + self.behind * self.r_behind).length();
        if across > 0.0 {
            self.binormal = self.behind.cross(self.ahead) * (2.0 / across);
        }
    }

    /// The unit tangent, if it has one.
    pub(super) fn tangent(&self) -> DVec3 {
        match (self.before, self.after) {
            (None, _) => self.behind,
            (_, None) => self.ahead,
            _ => self.velocity().try_normalize().unwrap_or(self.ahead),
        }
    }

    /// `c_t`; at a clamp the mean of chord and tangent.
    fn velocity(&self) -> DVec3 {
        if self.is_clamp() {
            return (self.ahead + self.behind) * 0.5;
        }
        (self.ahead * self.r_behind + self.behind * self.r_ahead) / (self.r_ahead + self.r_behind)
    }

    /// `|c_tt|² ds = 2 |a - b|² / S`.
    pub(super) fn bending(&self) -> f64 {
        2.0 * (self.ahead - self.behind).length_squared() / (self.r_ahead + self.r_behind)
    }

    /// The derivative of `share` times the bending and `fold` times the barrier.
    pub(super) fn bending_answer(&self, share: f64, fold: f64) -> Answer {
        let (a, b) = (self.ahead, self.behind);
        let sum = self.r_ahead + self.r_behind;
        let difference = a - b;
        let pull = difference * (share * 4.0 / sum);
        let along = -2.0 * share * difference.length_squared() / (sum * sum);
        let mut answer = Answer { ahead: pull, behind: -pull, r_ahead: along, r_behind: along };
        // phi(|c|), c = (r₋ a + r₊ b) / S
        let slope = fold * barrier::slope(self.jacobian);
        if slope != 0.0 {
            let velocity = self.velocity();
            let c_bar = velocity * (slope / self.jacobian);
            if self.is_clamp() {
                answer.ahead += c_bar * 0.5;
                answer.behind += c_bar * 0.5;
            } else {
                answer.ahead += c_bar * (self.r_behind / sum);
                answer.behind += c_bar * (self.r_ahead / sum);
                answer.r_ahead += c_bar.dot(b - velocity) / sum;
                answer.r_behind += c_bar.dot(a - velocity) / sum;
            }
        }
        answer
    }

    /// Adds what an energy feels that depends on `K` by `binormal_bar`.
    pub(super) fn add_binormal_answer(&self, binormal_bar: DVec3, answer: &mut Answer) {
        let (a, b) = (self.ahead, self.behind);
        // K = 2 (b × a) / |c|, c = r₊ a + r₋ b
        let c = a * self.r_ahead + b * self.r_behind;
        let across = c.length();
        if !(across > 0.0) {
            return;
        }
        let m_bar = binormal_bar * (2.0 / across);
        let c_bar = c * (-self.binormal.dot(binormal_bar) / (across * across));
        answer.ahead += m_bar.cross(b) + c_bar * self.r_ahead;
        answer.behind += a.cross(m_bar) + c_bar * self.r_behind;
        answer.r_ahead += a.dot(c_bar);
        answer.r_behind += b.dot(c_bar);
    }

    /// Hands what the hinge feels to its nodes.
    pub(super) fn scatter(&self, answer: &Answer, gradient: &mut [DVec3]) {
        let (a, b) = (self.ahead, self.behind);
        let (mut to_after, mut to_here) = (DVec3::ZERO, DVec3::ZERO);
        if let Some(after) = self.after {
            to_after = (answer.ahead - a * a.dot(answer.ahead)) / self.r_ahead + a * answer.r_ahead;
            gradient[after] += to_after;
        }
        if self.before.is_some() {
            to_here = (answer.behind - b * b.dot(answer.behind)) / self.r_behind + b * answer.r_behind;
        }
        gradient[self.node] += to_here - to_after;
        if let Some(before) = self.before {
            gradient[before] -= to_here;
        }
    }
}

#[cfg(test)]
mod tests;
