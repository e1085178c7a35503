//! How far a displacement would reach from where a tool points, as the modeler says. One question at a time: the newest
//! place is asked about when the answer to the last one has come, which is shown meanwhile.

use ductile_spec::{Displacing, Reach, Request, SurfaceId};
use glam::{DVec3, Vec3};

/// What is known, and what was asked.
#[derive(Clone, Debug, Default)]
pub struct Reaching {
    is_asked: bool,
    last: Option<Displacing>,
    known: Option<SurfaceId>,
    lines: Vec<Vec<Vec3>>,
}

impl Reaching {
    /// What to ask now that a tool points at a place or a curve; where on a curve it points does not matter.
    pub fn want(&mut self, trial: Displacing) -> Option<Request> {
        let trial = Displacing { at: trial.along.map_or(trial.at, |_| DVec3::ZERO), ..trial };
        if self.is_asked || self.last == Some(trial) {
            return None;
        }
        self.is_asked = true;
        self.last = Some(trial);
        Some(Request::Reach(trial))
    }

    /// An answer came; none where nothing can be displaced.
    pub fn came(&mut self, reach: Option<Reach>) {
        self.is_asked = false;
        self.known = reach.as_ref().map(|reach| reach.surface);
        let segments = reach.into_iter().flat_map(|reach| reach.segments);
        self.lines = segments.map(|ends| ends.map(|at| at.as_vec3()).to_vec()).collect();
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
        reaching.came(Some(Reach { surface: one, segments: vec![[DVec3::X, DVec3::Y]] }));
        assert_eq!(reaching.want(at(DVec3::X, 0.0)), None, "that is known");
        assert_eq!((reaching.lines(one).len(), reaching.lines(SurfaceId(2)).len()), (1, 0));
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
