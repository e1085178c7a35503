//! How far a displacement would reach from where a tool points, as the modeler says. One question at a time: the newest
//! place is asked about when the answer to the last one has come, which is shown meanwhile.

use ductile_spec::{Displacing, Reach, Request, SurfaceId};
use glam::{DVec3, Vec3};
use std::rc::Rc;

/// What is known, and what was asked.
#[derive(Clone, Debug, Default)]
pub struct Reaching {
    /// Questions that wait for an answer.
    asked: u32,
    /// Whether the last question was about what a hand took hold of.
    is_of_hand: bool,
    last: Option<Displacing>,
    known: Option<SurfaceId>,
    lines: Vec<Vec<Vec3>>,
    influence: Rc<[u8]>,
}

impl Reaching {
    /// What to ask now that a tool points at a place or a curve; where on a curve it points does not matter.
    pub fn want(&mut self, trial: Displacing) -> Option<Request> {
        if self.asked > 0 { None } else { self.ask(trial, false) }
    }

    /// What to ask before a hand takes hold of it, even if an answer is due that is about another place.
    pub fn want_now(&mut self, trial: Displacing) -> Option<Request> {
        self.ask(trial, true)
    }

    fn ask(&mut self, trial: Displacing, is_of_hand: bool) -> Option<Request> {
        let trial = Displacing { at: trial.along.map_or(trial.at, |_| DVec3::ZERO), ..trial };
        self.is_of_hand = is_of_hand;
        if self.last == Some(trial) {
            return None;
        }
        self.asked += 1;
        self.last = Some(trial);
        Some(Request::Reach(trial))
    }

    /// An answer came; none where nothing can be displaced.
    pub fn came(&mut self, reach: Option<Reach>) {
        self.asked = self.asked.saturating_sub(1);
        self.known = reach.as_ref().map(|reach| reach.surface);
        let (segments, influence) = reach.map(|reach| (reach.segments, reach.influence)).unwrap_or_default();
        self.lines = segments.into_iter().map(|ends| ends.map(|at| at.as_vec3()).to_vec()).collect();
        self.influence = influence.into();
    }

    /// The shapes have moved, or are others.
    pub fn moved(&mut self) {
        self.last = None;
    }

    /// There will be no answer.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The line, in pieces; none while it is unknown.
    #[must_use]
    pub fn lines(&self, surface: SurfaceId) -> &[Vec<Vec3>] {
        if self.known == Some(surface) { &self.lines } else { &[] }
    }

    /// By how much each vertex would follow, in 255ths. While a hand holds the surface only what was asked about just then counts.
    #[must_use]
    pub fn influence(&self, is_held: bool) -> Option<(SurfaceId, Rc<[u8]>)> {
        let surface = self.known.filter(|_| !is_held || self.asked == 0 && self.is_of_hand)?;
        Some((surface, Rc::clone(&self.influence)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{CurveId, Stretch};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn one_question_at_a_time_and_none_twice() {
        let (mut reaching, one) = (Reaching::default(), SurfaceId(1));
        let at = |at, range| Displacing { surface: one, at, along: None, range, direction: None };
        assert!(reaching.want(at(DVec3::X, 0.0)).is_some());
        assert_eq!(reaching.want(at(DVec3::Y, 0.0)), None, "the last is not answered");
        reaching.came(Some(Reach {
            surface: one,
            segments: vec![[DVec3::X, DVec3::Y]],
            influence: vec![0, 255],
        }));
        assert_eq!(reaching.want(at(DVec3::X, 0.0)), None, "that is known");
        assert_eq!((reaching.lines(one).len(), reaching.lines(SurfaceId(2)).len()), (1, 0));
        let influence =
            |reaching: &Reaching, is_held| reaching.influence(is_held).map(|(id, of)| (id, of.to_vec()));
        assert_eq!(influence(&reaching, false), Some((one, vec![0, 255])));
        assert_eq!(influence(&reaching, true), None, "no hand asked");
        assert_eq!(reaching.want_now(at(DVec3::X, 0.0)), None);
        reaching.moved();
        assert_eq!(influence(&reaching, true), Some((one, vec![0, 255])), "in the drag too, while all moves");
        assert!(reaching.want_now(at(DVec3::Z, 0.0)).is_some(), "a hand takes hold elsewhere");
        assert_eq!(influence(&reaching, true), None, "of that nothing is known");
        assert!(influence(&reaching, false).is_some());
        assert!(reaching.want_now(at(DVec3::X, 0.0)).is_some(), "and at once again");
        reaching.came(Some(Reach { surface: one, segments: Vec::new(), influence: vec![1] }));
        assert_eq!(influence(&reaching, true), None, "the answer to the question before");
        reaching.came(Some(Reach { surface: one, segments: vec![[DVec3::X, DVec3::Y]], influence: vec![2] }));
        assert_eq!(influence(&reaching, true), Some((one, vec![2])));
        reaching.moved();
        assert!(reaching.want(at(DVec3::X, 0.0)).is_some(), "the shape is another");
        assert_eq!(reaching.lines(one).len(), 1, "meanwhile the last answer is shown");
        reaching.came(None);
        assert!(reaching.lines(one).is_empty());
        assert!(reaching.want(at(DVec3::X, 0.5)).is_some(), "another range");
        reaching.came(None);
        let along = |at| Displacing { along: Some(CurveId(2)), ..at };
        assert!(reaching.want(along(at(DVec3::X, 0.5))).is_some(), "a curve");
        reaching.came(None);
        assert_eq!(reaching.want(along(at(DVec3::Y, 0.5))), None, "the same curve");
        let direction = Some(Stretch { along: DVec3::X, times: 2.0 });
        assert!(reaching.want(Displacing { direction, ..at(DVec3::X, 0.5) }).is_some(), "further one way");
    }
}
