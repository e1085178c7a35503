//! A hand that means harm, and everything it can ask for: where no hand has business to be, two points at one place,
//! curves without length, directions that contradict each other, acts in the middle of a drag, drags in the middle of what an
//! act set going, and acts on the wreck that a drag left behind.
//!
//! Nothing non-finite may reach a frame or a document; what is refused changes nothing; every document that is
//! committed can be opened again; and what is undone, called off or brought home leaves no trace.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

mod contradiction;
mod stream;

use acceptance::{Bench, shapes};
use ductile_spec::{
    CurveId, Document, Example, GrabTarget, Objective, PointId, Reply, Request, from_text, to_text,
};
use glam::DVec3;
use stream::Stream;

/// Drags of one round, from taking hold to letting go.
const ROUND: u32 = 5;
/// One round in so many ends with the hand at home, held still there for as many steps as are promised to suffice.
const HOMECOMING: u32 = 100;
const STEPS_HOME: u32 = 60;

/// A storm over one shape.
struct Storm {
    bench: Bench,
    stream: Stream,
    calm: Document,
    energy: f64,
    others: Vec<DVec3>,
    /// Acts that undo has to take back until the document is as it was.
    acts: u32,
    /// What the storm met, so that it can be shown to have met it.
    met: Met,
}

/// How often each harm was done.
#[derive(Clone, Copy, Debug, Default)]
struct Met {
    drags: u32,
    refused: u32,
    done: u32,
    coincident: u32,
    contradictions: u32,
    /// Curves whose controls were all dragged to one place.
    collapsed: u32,
    /// Drags of directions instead of points.
    turned: u32,
    /// Drags begun before the shapes had taken one step after an act.
    unsettled: u32,
    fair: u32,
    /// Hands that were nowhere; each has to be counted in the figures of its frame.
    nowhere: u32,
    homecomings: u32,
    worst: f64,
}

impl Storm {
    fn new(seed: u64, document: &Document) -> Self {
        let mut bench = Bench::new();
        bench.accept(Request::OpenText { text: to_text(document) });
        let energy = bench.rest(600);
        let calm = bench.document();
        let others = calm.points.values().copied().collect();
        Self { bench, stream: Stream::new(seed), calm, energy, others, acts: 0, met: Met::default() }
    }

    /// Sends a request that may be refused, and keeps the count of what there is to undo.
    fn act(&mut self, request: Request) -> Reply {
        if matches!(request, Request::Undo) && self.acts == 0 {
            return self.bench.send(Request::Describe);
        }
        let (is_undo, asked) = (matches!(request, Request::Undo), format!("{request:?}"));
        let (before, is_question) = (self.bench.document.clone(), matches!(request, Request::Describe));
        let reply = self.bench.send(request);
        self.met.refused += u32::from(reply.refused.is_some());
        if reply.refused.is_some() {
            assert_eq!(self.bench.document, before, "{asked} was refused and changed the document");
        }
        if let (Some(committed), false) = (&reply.committed, is_question) {
            self.acts = if is_undo { self.acts - 1 } else { self.acts + 1 };
            self.met.done += 1;
            self.opens_again(&committed.document, &asked);
        }
        reply
    }

    /// Whoever journals a document can have it back.
    fn opens_again(&mut self, text: &str, asked: &str) {
        let document = from_text(text).unwrap();
        let places: Vec<DVec3> = document.points.values().copied().collect();
        self.met.coincident += u32::from((1..places.len()).any(|k| places[..k].contains(&places[k])));
        let mut other = Bench::new();
        let reply = other.send(Request::OpenText { text: text.to_owned() });
        assert_eq!(reply.refused, None, "after {asked}: {text}");
    }

    /// Moves the hand. What is no place is ignored, and the figures of the frame say so.
    fn drag(&mut self, to: DVec3) {
        self.met.drags += 1;
        if to.is_finite() {
            self.bench.step(Some(to));
            return;
        }
        self.met.nowhere += 1;
        let before = self.bench.send(Request::Describe).frame.figures.rescues;
        let after = self.bench.step(Some(to)).frame.figures.rescues;
        assert!(after > before, "the hand at {to} was not counted: {before} rescues, then {after}");
    }

    /// One round of drags; acts fall before it, into it, and upon what it leaves behind.
    fn round(&mut self, number: u32) {
        let is_homecoming = number.is_multiple_of(HOMECOMING);
        if !is_homecoming {
            self.prelude();
        }
        let document = self.bench.document();
        let points: Vec<(PointId, DVec3)> = document.points.iter().map(|(id, at)| (*id, *at)).collect();
        if !points.is_empty() {
            let (point, home) = points[self.stream.below(points.len())];
            let handle = self.stream.handle(&document, point).filter(|_| !is_homecoming);
            self.met.turned += u32::from(handle.is_some());
            let target = handle.map_or(GrabTarget::Point(point), GrabTarget::Handle);
            if self.bench.send(Request::Grab(target)).refused.is_none() {
                self.hold(is_homecoming.then_some((point, home)));
            }
        }
        for _ in 0..self.stream.below(3) {
            let request = self.stream.surgery(&self.others);
            self.act(request);
            self.bench.step(None);
        }
        while self.acts > 0 {
            self.bench.accept(Request::Undo);
            self.acts -= 1;
        }
        assert_eq!(self.bench.document(), self.calm, "round {number} left a trace");
    }

    /// What is done before the hand takes hold, without a step between: it finds the shapes on their way.
    fn prelude(&mut self) {
        match self.stream.below(6) {
            0 => {
                for _ in 0..3 {
                    let document = self.bench.document();
                    let request = self.stream.contradiction(&document, &self.others);
                    let is_done = request.is_some_and(|request| self.act(request).committed.is_some());
                    self.met.contradictions += u32::from(is_done);
                }
            }
            1 => {
                let request = self.stream.surgery(&self.others);
                self.met.unsettled += u32::from(self.act(request).committed.is_some());
            }
            2 => {
                let is_done = self.act(stream::objective(Objective::Fair)).committed.is_some();
                self.met.fair += u32::from(is_done);
            }
            3 if self.stream.below(4) == 0 => self.collapse(),
            _ => {}
        }
    }

    /// All controls of a curve are dragged to one place, one after the other.
    fn collapse(&mut self) {
        let document = self.bench.document();
        let ids: Vec<CurveId> = document.curves.keys().copied().collect();
        let Some(curve) = (!ids.is_empty()).then(|| ids[self.stream.below(ids.len())]) else { return };
        let place = self.others[self.stream.below(self.others.len())];
        for point in &document.curves[&curve].through {
            if self.bench.send(Request::Grab(GrabTarget::Point(*point))).refused.is_some() {
                continue;
            }
            self.drag(place);
            // The last one must not be kept: the curve would have no length. Until then it may be.
            self.act(Request::Drop);
        }
        self.met.collapsed += 1;
    }

    /// The hand holds something, does harm, and lets go or calls it off.
    fn hold(&mut self, home: Option<(PointId, DVec3)>) {
        for _ in 0..ROUND {
            let target = self.stream.malice(&self.others);
            self.drag(target);
            if self.stream.below(4) == 0 {
                let request = self.stream.surgery(&self.others);
                let is_edit = matches!(request, Request::Edit(_) | Request::Redo);
                let reply = self.act(request);
                assert!(!is_edit || reply.refused.is_some(), "an act in the middle of a drag");
            }
        }
        if let Some((point, home)) = home {
            self.comes_home(point, home);
        }
        let end = if self.stream.below(2) == 0 { Request::Cancel } else { Request::Drop };
        self.act(end);
    }

    /// The hand brings the point back and waits: the shape has to come back by itself.
    fn comes_home(&mut self, point: PointId, home: DVec3) {
        for _ in 0..STEPS_HOME {
            self.bench.step(Some(home));
        }
        let energy = self.bench.step(Some(home)).frame.figures.energy;
        let off = (energy - self.energy).abs() / self.energy.max(LEAST_ENERGY);
        self.met.worst = self.met.worst.max(off);
        self.met.homecomings += 1;
        assert!(off < 1e-6, "{point} came home: {} became {energy}", self.energy);
    }
}

/// Below this an energy is that of a flat shape, and is compared with this instead.
const LEAST_ENERGY: f64 = 1e-3;

/// How many drags there are in all.
fn drags() -> u32 {
    std::env::var("DRAGS").ok().and_then(|count| count.parse().ok()).unwrap_or(10_000_u32)
}

/// Storms over a shape with these seeds, which share so many parts in a hundred of all drags.
fn storms(name: &str, document: &Document, objective: Objective, parts: u32, seeds: &[u64]) {
    let document = Document { objective, ..document.clone() };
    for seed in seeds {
        let mut storm = Storm::new(*seed, &document);
        let wanted = drags() / 100 * parts / u32::try_from(seeds.len()).unwrap();
        let mut number = 0;
        while storm.met.drags < wanted {
            storm.round(number);
            number += 1;
            if number.is_multiple_of(10_000) {
                println!("{name}, seed {seed}: {} drags", storm.met.drags);
            }
        }
        let after = storm.bench.rest(600);
        println!("{name}, seed {seed}: {:?}", storm.met);
        let off = (after - storm.energy).abs() / storm.energy.max(LEAST_ENERGY);
        assert!(off < 1e-6, "energy {} became {after}", storm.energy);
        let Met {
            done,
            refused,
            coincident,
            contradictions,
            collapsed,
            turned,
            unsettled,
            fair,
            nowhere,
            ..
        } = storm.met;
        assert!(done > wanted / 100 && refused > wanted / 100, "{:?}", storm.met);
        let mut counts = vec![coincident, unsettled, fair, nowhere];
        // Without curves there is nothing that directions could contradict.
        if !document.curves.is_empty() {
            counts.extend([contradictions, collapsed, turned]);
        }
        assert!(counts.iter().all(|count| *count > 0), "{:?}", storm.met);
    }
}

// `DRAGS=1000000 cargo test --release -p acceptance --test storm malicious` is the long run.

fn example(of: Example, spacing: f64) -> Document {
    Document { spacing: Some(spacing), ..ductile_modeler::example(of) }
}

#[test]
fn malicious_drags_break_no_raised_disc() {
    storms("disc", &example(Example::RaisedDisc, 0.25), Objective::ThinPlate, 50, &[1, 2]);
}

#[test]
fn malicious_drags_break_no_cylinder() {
    storms("cylinder", &example(Example::Cylinder, 0.4), Objective::ThinPlate, 25, &[3]);
}

#[test]
fn malicious_drags_break_no_fair_ball() {
    storms("ball", &example(Example::Ball, 0.5), Objective::Fair, 20, &[4]);
}

/// Few, and on a coarse strip: what a drag leaves of its long free rim takes seconds to grow again.
#[test]
fn malicious_drags_break_no_moebius_strip() {
    let strip = Document { spacing: Some(0.8), ..shapes::moebius() };
    storms("strip", &strip, Objective::ThinPlate, 5, &[5]);
}
