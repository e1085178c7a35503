//! Where the two surfaces meet that a tool points at, as the modeler says: asked once for each pair, and again when the
//! shapes have moved and rest. Until the answer comes the last one of the same pair is shown.

use ductile_spec::{Meeting, Request, SurfaceId};
use glam::Vec3;

/// Two surfaces, in the order in which they were picked.
type Pair = (SurfaceId, SurfaceId);

/// What is known, and what was asked.
#[derive(Clone, Debug, Default)]
pub struct Meetings {
    asked: Option<Pair>,
    known: Option<Pair>,
    lines: Vec<Vec<Vec3>>,
    /// The shapes have moved since then.
    is_stale: bool,
}

impl Meetings {
    /// What to ask now that a tool points at two surfaces. One question at a time; while shapes move, an answer does for
    /// the pair that it is about.
    pub fn want(&mut self, pair: Pair, rests: bool) -> Option<Request> {
        let is_known = self.known == Some(pair) && (!self.is_stale || !rests);
        if is_known || self.asked.is_some() {
            return None;
        }
        self.asked = Some(pair);
        Some(Request::Meet { first: pair.0, second: pair.1 })
    }

    /// An answer came; none if there is no telling.
    pub fn came(&mut self, meeting: Option<Meeting>) {
        self.known = self.asked.take();
        self.is_stale = false;
        self.lines.clear();
        for line in meeting.into_iter().flat_map(|meeting| meeting.lines) {
            let mut places: Vec<Vec3> = line.along.iter().map(|at| at.as_vec3()).collect();
            places.extend(places.first().copied().filter(|_| line.closed));
            self.lines.push(places);
        }
    }

    /// The shapes have moved, or are others.
    pub fn moved(&mut self) {
        self.is_stale = true;
    }

    /// There will be no answer, and what is known may be of another model.
    pub fn forget(&mut self) {
        *self = Self::default();
    }

    /// The lines in which two surfaces meet, closed ones with their first place at the end; none while that is unknown.
    #[must_use]
    pub fn lines(&self, pair: Pair) -> &[Vec<Vec3>] {
        if self.known == Some(pair) { &self.lines } else { &[] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::MeetingLine;
    use glam::DVec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const PAIR: Pair = (SurfaceId(1), SurfaceId(2));
    const OTHER: Pair = (SurfaceId(1), SurfaceId(3));

    fn told(closed: bool) -> Option<Meeting> {
        let along = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        Some(Meeting { first: PAIR.0, second: PAIR.1, lines: vec![MeetingLine { along, closed }] })
    }

    #[test]
    fn a_pair_is_asked_about_once_and_again_when_moved_shapes_rest() {
        let mut meetings = Meetings::default();
        let question = Request::Meet { first: PAIR.0, second: PAIR.1 };
        assert_eq!(meetings.want(PAIR, true), Some(question.clone()));
        assert_eq!(meetings.want(PAIR, true), None, "it is on its way");
        assert_eq!(meetings.want(OTHER, true), None, "one question at a time");
        meetings.came(told(true));
        assert_eq!(meetings.want(PAIR, true), None);
        meetings.moved();
        assert_eq!(meetings.want(PAIR, false), None, "not in every frame");
        assert_eq!(meetings.lines(PAIR).len(), 1, "meanwhile the last answer is shown");
        assert_eq!(meetings.want(PAIR, true), Some(question));
        meetings.came(None);
        assert!(meetings.lines(PAIR).is_empty());
        assert_eq!(meetings.want(PAIR, true), None, "what cannot be told is not asked again and again");
        assert!(meetings.want(OTHER, true).is_some());
        meetings.forget();
        assert!(meetings.want(PAIR, true).is_some(), "a dead modeler owes nothing");
    }

    #[test]
    fn closed_lines_close_and_belong_to_their_pair() {
        let mut meetings = Meetings::default();
        for closed in [false, true] {
            meetings.moved();
            meetings.want(PAIR, true);
            meetings.came(told(closed));
            let line = &meetings.lines(PAIR)[0];
            assert_eq!(
                (line.len(), line.first() == line.last()),
                if closed { (4, true) } else { (3, false) }
            );
            assert!(meetings.lines(OTHER).is_empty());
        }
    }
}
