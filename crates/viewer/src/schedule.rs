//! What goes to the worker next: one request at a time, in order; steps only while something relaxes.
//!
//! A drag is state: its newest target rides on the next step, so a slow worker skips targets instead of
//! falling behind. Nothing here knows a worker or a clock; times are milliseconds that the page gives.

use ductile_spec::{Edit, GrabTarget, Reply, Request, Resume, Step};
use glam::DVec3;
use std::collections::VecDeque;

/// Where the iteration budget begins and the bounds that it keeps.
const FIRST_ITERATIONS: u32 = 12;
const FEWEST_ITERATIONS: u32 = 4;
const MOST_ITERATIONS: u32 = 40;
/// A step should be over within this time: three quarters of a frame.
const STEP_MILLISECONDS: f64 = 12.0;
/// A worker that has not answered for so long hangs.
const HANG_MILLISECONDS: f64 = 20_000.0;
/// The same while it opens a document or builds everything anew: a hundred thousand nodes take their time.
const OPENING_HANG_MILLISECONDS: f64 = 90_000.0;

/// What a reply answers.
#[derive(Clone, Debug, PartialEq)]
pub enum Answered {
    /// A document was opened or begun: the view should be fitted, this is what Reset goes back to.
    Opening,
    /// An act, undo and redo included.
    Act,
    /// The beginning of a drag.
    Grab,
    /// The end of a drag.
    Release,
    /// A step.
    Step,
    /// Where two surfaces meet.
    Meeting,
    /// How far a displacement would reach.
    Reach,
    /// The loop through a place of a curve.
    Loop,
    /// How well surfaces meet.
    Seams,
    /// Anything else.
    Other,
}

/// Orders what goes to the worker.
#[derive(Debug)]
pub struct Schedule {
    queue: VecDeque<Request>,
    in_flight: Option<(Request, f64)>,
    /// The newest place of the held point, while a drag is under way.
    target: Option<DVec3>,
    /// Whether the newest place was not sent yet.
    target_is_new: bool,
    holds: bool,
    settled: bool,
    iterations: u32,
}

impl Default for Schedule {
    fn default() -> Self {
        Self {
            queue: VecDeque::new(),
            in_flight: None,
            target: None,
            target_is_new: false,
            holds: false,
            settled: true,
            iterations: FIRST_ITERATIONS,
        }
    }
}

impl Answered {
    /// Whether it answers a question that changed nothing, of which no refusal need be told: the act itself will say why.
    #[must_use]
    pub fn is_told(&self) -> bool {
        matches!(self, Self::Meeting | Self::Reach | Self::Loop | Self::Seams)
    }
}

impl Schedule {
    /// Puts a request behind all others.
    pub fn push(&mut self, request: Request) {
        self.queue.push_back(request);
    }

    /// Begins a drag.
    pub fn grab(&mut self, target: GrabTarget) {
        self.finish_drag(Request::Drop);
        self.holds = true;
        self.push(Request::Grab(target));
    }

    /// Where the held point should be now.
    pub fn drag_to(&mut self, at: DVec3) {
        if self.holds && at.is_finite() && self.target != Some(at) {
            self.target = Some(at);
            self.target_is_new = true;
        }
    }

    /// Ends the drag and keeps its result. The last place is reached first.
    pub fn drop_held(&mut self) {
        if let Some(at) = self.target.filter(|_| self.holds && self.target_is_new) {
            self.push(Request::Step(Step { drag: Some(at), iterations: self.iterations }));
        }
        self.finish_drag(Request::Drop);
    }

    /// Ends the drag and puts everything back.
    pub fn cancel_held(&mut self) {
        self.finish_drag(Request::Cancel);
    }

    /// The drag came to nothing: the modeler refused to take hold.
    pub fn forget_drag(&mut self) {
        self.holds = false;
        self.target = None;
        self.target_is_new = false;
        self.queue.retain(|request| {
            !matches!(request, Request::Drop | Request::Cancel | Request::Step(Step { drag: Some(_), .. }))
        });
    }

    /// Whether a drag is under way.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.holds
    }

    /// Whether nothing is asked and nothing relaxes.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.settled && self.queue.is_empty() && self.in_flight.is_none() && !self.target_is_new
    }

    /// What to send now, if anything. The caller sends it.
    pub fn next(&mut self, now: f64) -> Option<Request> {
        if self.in_flight.is_some() {
            return None;
        }
        let request = match self.queue.pop_front() {
            Some(request) => request,
            None if !self.settled || self.target_is_new => {
                self.target_is_new = false;
                Request::Step(Step { drag: self.target, iterations: self.iterations })
            }
            None => return None,
        };
        self.in_flight = Some((request.clone(), now));
        Some(request)
    }

    /// A reply came. Tells what it answers; `None` for a reply that nobody asked for.
    pub fn answered(&mut self, reply: &Reply, now: f64) -> Option<Answered> {
        let (request, since) = self.in_flight.take()?;
        self.settled = reply.frame.settled;
        Some(match request {
            Request::OpenText { .. }
            | Request::OpenLink { .. }
            | Request::OpenExample(_)
            | Request::New
            | Request::Resume(_) => Answered::Opening,
            Request::Edit(_) | Request::Import { .. } | Request::Undo | Request::Redo => Answered::Act,
            Request::Grab(_) => Answered::Grab,
            Request::Drop | Request::Cancel => Answered::Release,
            Request::Step(_) => {
                let told = reply.frame.figures.step_milliseconds;
                // A step without iterations, as when a shape settles, says nothing about what they cost.
                if reply.frame.figures.iterations > 0 {
                    self.adapt(if told > 0.0 { told } else { now - since });
                }
                Answered::Step
            }
            Request::Meet { .. } => Answered::Meeting,
            Request::Reach { .. } => Answered::Reach,
            Request::Loop { .. } => Answered::Loop,
            Request::Seams => Answered::Seams,
            Request::Export(_) | Request::Describe => Answered::Other,
        })
    }

    /// Whether the worker hangs.
    #[must_use]
    pub fn is_overdue(&self, now: f64) -> bool {
        self.in_flight.as_ref().is_some_and(|(request, since)| {
            let builds = is_opening(request) || matches!(request, Request::Edit(Edit::Spacing { .. }));
            now - since > if builds { OPENING_HANG_MILLISECONDS } else { HANG_MILLISECONDS }
        })
    }

    /// Counts the time of waiting anew, after a time when the page could not look.
    pub fn wait_anew(&mut self, now: f64) {
        if let Some((_, since)) = &mut self.in_flight {
            *since = now;
        }
    }

    /// The worker died. What was under way is given up and the work resumed before all that waits. Tells the act
    /// that is lost, if there is one.
    pub fn worker_died(&mut self, resume: Option<Resume>) -> Option<String> {
        let dragged = self.holds.then(|| "the drag".to_owned());
        let lost = match self.in_flight.take() {
            Some((Request::Edit(edit), _)) => Some(edit.label().to_owned()),
            Some((Request::Import { .. }, _)) => Some("the import".to_owned()),
            Some((Request::Undo, _)) => Some("Undo".to_owned()),
            Some((Request::Redo, _)) => Some("Redo".to_owned()),
            Some((Request::Grab(_) | Request::Drop, _)) => Some("the drag".to_owned()),
            Some((Request::Export(_), _)) => Some("the export".to_owned()),
            Some((
                Request::OpenText { .. } | Request::OpenLink { .. } | Request::OpenExample(_) | Request::New,
                _,
            )) => Some("what was being opened".to_owned()),
            _ => dragged,
        };
        self.forget_drag();
        // Undo and redo were meant for what is lost, a grab without its steps for nothing.
        let is_kept =
            |r: &Request| matches!(r, Request::Edit(_) | Request::Import { .. } | Request::Export(_));
        self.queue.retain(|r| is_kept(r) || is_opening(r));
        if let Some(resume) = resume {
            self.queue.push_front(Request::Resume(resume));
        }
        self.settled = true;
        self.iterations = FIRST_ITERATIONS;
        lost
    }

    fn finish_drag(&mut self, how: Request) {
        if self.holds {
            self.push(how);
        }
        self.holds = false;
        self.target = None;
        self.target_is_new = false;
    }

    /// Turns milliseconds into iterations: quickly down when a step was too long, slowly up.
    fn adapt(&mut self, milliseconds: f64) {
        if !milliseconds.is_finite() {
            return;
        }
        if milliseconds > STEP_MILLISECONDS {
            let ratio = (STEP_MILLISECONDS / milliseconds).max(0.5);
            let fewer =
                (0..self.iterations).rev().find(|n| f64::from(*n) <= f64::from(self.iterations) * ratio);
            self.iterations = fewer.unwrap_or(0).max(FEWEST_ITERATIONS);
        } else if milliseconds < 0.7 * STEP_MILLISECONDS {
            self.iterations = (self.iterations + 1).min(MOST_ITERATIONS);
        }
    }
}

fn is_opening(request: &Request) -> bool {
    matches!(
        request,
        Request::OpenText { .. }
            | Request::OpenLink { .. }
            | Request::OpenExample(_)
            | Request::New
            | Request::Resume(_)
    )
}

/// What the page calls an edit that is under way, for messages.
#[must_use]
pub fn label(request: &Request) -> &'static str {
    match request {
        Request::OpenText { .. } | Request::OpenLink { .. } | Request::OpenExample(_) => "Open",
        Request::New => "New",
        Request::Import { .. } => "Import",
        Request::Resume(_) => "Resume",
        Request::Edit(edit) => Edit::label(edit),
        Request::Grab(_) | Request::Drop | Request::Cancel | Request::Step(_) => "Drag",
        Request::Undo => "Undo",
        Request::Redo => "Redo",
        Request::Export(_) => "Export",
        Request::Meet { .. } => "Meet",
        Request::Reach { .. } => "Reach",
        Request::Loop { sheet, .. } => {
            if *sheet {
                "Sheet"
            } else {
                "Fill"
            }
        }
        Request::Seams => "Seams",
        Request::Describe => "Describe",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::PointId;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const HOLD: GrabTarget = GrabTarget::Point(PointId(1));

    fn reply(settled: bool, milliseconds: f64) -> Reply {
        let mut reply = Reply::default();
        reply.frame.settled = settled;
        reply.frame.figures.step_milliseconds = milliseconds;
        reply.frame.figures.iterations = 1;
        reply
    }

    fn step_target(request: Option<Request>) -> Option<DVec3> {
        match request {
            Some(Request::Step(step)) => step.drag,
            other => panic!("a step was expected, not {other:?}"),
        }
    }

    #[test]
    fn one_request_is_in_flight_and_edits_wait_in_order() {
        let mut schedule = Schedule::default();
        assert_eq!(schedule.next(0.0), None);
        schedule.push(Request::New);
        schedule.push(Request::Undo);
        assert_eq!(schedule.next(0.0), Some(Request::New));
        assert_eq!(schedule.next(0.0), None);
        assert_eq!(schedule.answered(&reply(true, 0.0), 1.0), Some(Answered::Opening));
        assert_eq!(schedule.next(1.0), Some(Request::Undo));
    }

    #[test]
    fn steps_go_on_until_the_shape_rests_and_begin_again_with_an_edit() {
        let mut schedule = Schedule::default();
        schedule.push(Request::New);
        schedule.next(0.0);
        schedule.answered(&reply(false, 0.0), 1.0);
        assert!(matches!(schedule.next(1.0), Some(Request::Step(Step { drag: None, .. }))));
        assert_eq!(schedule.answered(&reply(true, 1.0), 2.0), Some(Answered::Step));
        assert_eq!(schedule.next(2.0), None);
        assert!(schedule.is_at_rest());
        schedule.push(Request::Edit(Edit::Release { point: PointId(1) }));
        assert!(matches!(schedule.next(3.0), Some(Request::Edit(_))));
        schedule.answered(&reply(false, 0.0), 4.0);
        assert!(matches!(schedule.next(4.0), Some(Request::Step(_))));
    }

    #[test]
    fn only_the_newest_target_of_a_drag_is_sent_and_the_last_one_before_the_drop() {
        let mut schedule = Schedule::default();
        schedule.grab(HOLD);
        schedule.drag_to(DVec3::X);
        assert_eq!(schedule.next(0.0), Some(Request::Grab(HOLD)));
        schedule.drag_to(DVec3::Y);
        schedule.drag_to(DVec3::Z);
        schedule.answered(&reply(true, 0.0), 1.0);
        assert_eq!(step_target(schedule.next(1.0)), Some(DVec3::Z));
        schedule.drag_to(DVec3::ONE);
        schedule.drop_held();
        schedule.answered(&reply(false, 1.0), 2.0);
        assert_eq!(step_target(schedule.next(2.0)), Some(DVec3::ONE));
        schedule.answered(&reply(false, 1.0), 3.0);
        assert_eq!(schedule.next(3.0), Some(Request::Drop));
        schedule.answered(&reply(false, 0.0), 4.0);
        assert_eq!(step_target(schedule.next(4.0)), None);
    }

    #[test]
    fn a_held_point_that_rests_costs_nothing() {
        let mut schedule = Schedule::default();
        schedule.grab(HOLD);
        schedule.next(0.0);
        schedule.answered(&reply(true, 0.0), 1.0);
        assert_eq!(schedule.next(1.0), None);
        schedule.drag_to(DVec3::NAN);
        assert_eq!(schedule.next(1.0), None);
        schedule.drag_to(DVec3::X);
        schedule.next(2.0);
        schedule.answered(&reply(true, 0.0), 3.0);
        schedule.drag_to(DVec3::X);
        assert_eq!(schedule.next(3.0), None, "the same place twice is one place");
    }

    #[test]
    fn a_cancelled_drag_forgets_its_target() {
        let mut schedule = Schedule::default();
        schedule.grab(HOLD);
        schedule.next(0.0);
        schedule.drag_to(DVec3::X);
        schedule.cancel_held();
        schedule.answered(&reply(false, 0.0), 1.0);
        assert_eq!(schedule.next(1.0), Some(Request::Cancel));
        schedule.answered(&reply(false, 0.0), 2.0);
        assert_eq!(step_target(schedule.next(2.0)), None);
    }

    #[test]
    fn a_refused_grab_takes_the_rest_of_the_drag_with_it() {
        let mut schedule = Schedule::default();
        schedule.grab(HOLD);
        schedule.next(0.0);
        schedule.drag_to(DVec3::X);
        schedule.drop_held();
        schedule.answered(&reply(true, 0.0), 1.0);
        schedule.forget_drag();
        assert_eq!(schedule.next(1.0), None);
    }

    #[test]
    fn the_budget_follows_the_clock_within_its_bounds() {
        let mut schedule = Schedule::default();
        let mut run = |milliseconds, times| {
            for _ in 0..times {
                schedule.settled = false;
                schedule.next(0.0);
                schedule.answered(&reply(false, milliseconds), 0.0);
            }
            schedule.iterations
        };
        assert_eq!(run(1.0, 100), MOST_ITERATIONS);
        assert_eq!(run(10.0, 10), MOST_ITERATIONS);
        assert_eq!(run(24.0, 1), MOST_ITERATIONS / 2);
        assert_eq!(run(1e6, 10), FEWEST_ITERATIONS);
        assert_eq!(run(f64::NAN, 1), FEWEST_ITERATIONS + 1, "without a figure the page's clock counts");
    }

    #[test]
    fn a_dead_worker_costs_the_act_under_way_and_nothing_else() {
        let resume = Resume { document: "{}".into(), ..Resume::default() };
        let mut schedule = Schedule::default();
        schedule.push(Request::Edit(Edit::Release { point: PointId(1) }));
        schedule.push(Request::Edit(Edit::Release { point: PointId(2) }));
        schedule.push(Request::Undo);
        schedule.next(0.0);
        assert_eq!(schedule.worker_died(Some(resume.clone())), Some("Release".into()));
        assert_eq!(schedule.next(0.0), Some(Request::Resume(resume)));
        schedule.answered(&reply(true, 0.0), 0.0);
        assert_eq!(schedule.next(0.0), Some(Request::Edit(Edit::Release { point: PointId(2) })));
        schedule.answered(&reply(true, 0.0), 0.0);
        assert_eq!(schedule.next(0.0), None);

        schedule.grab(HOLD);
        schedule.next(0.0);
        schedule.answered(&reply(false, 0.0), 0.0);
        schedule.next(0.0);
        assert_eq!(schedule.worker_died(None), Some("the drag".into()));
        assert!(!schedule.holds());
        assert!(schedule.is_at_rest());
    }

    #[test]
    fn a_worker_that_does_not_answer_hangs() {
        let mut schedule = Schedule::default();
        assert!(!schedule.is_overdue(1e9));
        schedule.push(Request::Undo);
        schedule.next(0.0);
        assert!(!schedule.is_overdue(19_000.0));
        assert!(schedule.is_overdue(21_000.0));
        schedule.wait_anew(21_000.0);
        assert!(!schedule.is_overdue(22_000.0));
        assert_eq!(schedule.answered(&reply(true, 0.0), 0.0), Some(Answered::Act));
        assert_eq!(schedule.answered(&reply(true, 0.0), 0.0), None);
    }

    #[test]
    fn a_worker_that_builds_everything_anew_is_given_more_time() {
        let of = ductile_spec::SpacingOf::Document;
        for request in [Request::New, Request::Edit(Edit::Spacing { of, spacing: Some(0.01) })] {
            let mut schedule = Schedule::default();
            schedule.push(request);
            schedule.next(0.0);
            assert!(!schedule.is_overdue(89_000.0));
            assert!(schedule.is_overdue(91_000.0));
        }
    }
}
