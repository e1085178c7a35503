//! A hand that means harm, and everything it can ask for: where no hand has business to be, two points at one place,
//! curves without length, acts in the middle of a drag and acts on the wreck that a drag left behind.
//!
//! Nothing non-finite may reach a frame or a document; what is refused changes nothing; every document that is
//! committed can be opened again; and what is undone, called off or brought home leaves no trace.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_spec::{
    Border, CurveId, Document, Edit, Example, ExportFormat, Extent, GrabTarget, On, PointId, Reply, Request,
    SurfaceId, Through, from_text, to_text,
};
use glam::DVec3;

/// Drags of one round, from taking hold to letting go.
const ROUND: u32 = 5;
/// One round in so many ends with the hand at home, held still there for as many steps as are promised to suffice.
const HOMECOMING: u32 = 100;
const STEPS_HOME: u32 = 60;

/// Numbers from a fixed stream (splitmix64).
struct Stream(u64);

impl Stream {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^ (x >> 31)
    }

    fn below(&mut self, count: usize) -> usize {
        usize::try_from(self.next() >> 33).expect("31 bits fit") % count
    }

    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Somewhere a hand has no business to be.
    fn malice(&mut self, others: &[DVec3]) -> DVec3 {
        let direction = DVec3::new(self.unit() - 0.5, self.unit() - 0.5, self.unit() - 0.5);
        match self.below(7) {
            0 => direction * 1e9,
            1 => DVec3::new(f64::NAN, 0.0, 0.0),
            2 => DVec3::splat(f64::INFINITY) * direction,
            3 => others[self.below(others.len())],
            4 => direction * 1e-300,
            5 => direction * 1e300,
            _ => direction * 4.0,
        }
    }

    /// An act that contradicts what is there, asks for what is not, or does honest surgery at a bad moment.
    fn surgery(&mut self, others: &[DVec3]) -> Request {
        let point = PointId(u32::try_from(self.below(others.len() + 2)).unwrap() + 1);
        let other = PointId(u32::try_from(self.below(others.len())).unwrap() + 1);
        let curve = CurveId(u32::try_from(self.below(3)).unwrap() + 1);
        let surface = SurfaceId(u32::try_from(self.below(2)).unwrap() + 1);
        let (at, there) = (self.malice(others), others[self.below(others.len())]);
        let [twice, again] = [there, there].map(Through::Place);
        if self.below(3) == 0 {
            return Request::Edit(self.cutting(others, surface, curve));
        }
        Request::Edit(match self.below(16) {
            0 => Edit::Move { point, to: there },
            1 => Edit::Move { point, to: at },
            2 => Edit::Curve { through: vec![twice, again], closed: false },
            3 => Edit::Curve { through: vec![Through::Point(point), twice, again], closed: true },
            4 => Edit::Curve { through: vec![Through::Point(point), Through::Point(other)], closed: false },
            5 => Edit::Sheet { boundary: curve },
            6 => Edit::Sweep { from: curve, to: CurveId(1), stretches: [None; 2], reversed: false },
            7 => Edit::Pin { surface, at },
            8 => Edit::Insert { curve, at },
            9 => Edit::Release { point },
            10 => Edit::DeletePoint { point },
            11 => Edit::DeleteCurve { curve },
            12 => Edit::DeleteSurface { surface },
            13 => Edit::Spacing {
                of: ductile_spec::SpacingOf::Document,
                spacing: Some([0.0, f64::NAN, 1e-12, 1e9, 0.3][self.below(5)]),
            },
            14 => return Request::Export(ExportFormat::Obj),
            _ => return [Request::Undo, Request::Redo, Request::Describe][self.below(3)].clone(),
        })
    }
}

impl Stream {
    /// An act that takes surfaces apart or puts them together, at a bad place.
    fn cutting(&mut self, others: &[DVec3], surface: SurfaceId, curve: CurveId) -> Edit {
        let (at, there) = (self.malice(others), others[self.below(others.len())]);
        let (here, beyond) = (On { surface, at: there * self.unit() }, On { surface, at });
        let (skirt, reversed) = (self.below(2) == 0, self.below(2) == 0);
        let border = if skirt { Border::Curve(curve) } else { Border::Region(here) };
        match self.below(11) {
            0 => Edit::SLoop { surface, along: vec![at, there, there * 0.3], closed: skirt },
            1 => Edit::SLoop { surface, along: vec![here.at, there, -there], closed: skirt },
            // A small ring, which mostly can be drawn: the acts after it have something to cut along.
            2 | 3 => {
                let round = [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y].map(|side| here.at + side * 0.3);
                Edit::SLoop { surface, along: round.to_vec(), closed: true }
            }
            4 => Edit::Burnout { region: if skirt { here } else { beyond } },
            5 => Edit::Split { border },
            6 => Edit::Crease { border },
            7 => Edit::Smooth { curve },
            8 => Edit::Glue { from: here, to: beyond, skirt, reversed },
            9 => {
                let radius = [0.2, 0.0, f64::NAN, 1e9, 1e-12][self.below(5)];
                Edit::Merge { from: here, to: beyond, radius, keep: skirt }
            }
            _ if reversed => Edit::Reverse { surface },
            _ => Edit::Expand { curve, to: Extent::Radius([0.5, f64::INFINITY, 1e-12, 1e5][self.below(4)]) },
        }
    }
}

/// A storm over the raised disc.
struct Storm {
    bench: Bench,
    stream: Stream,
    calm: Document,
    energy: f64,
    others: Vec<DVec3>,
    /// Acts that undo has to take back until the document is as it was.
    acts: u32,
    /// What the storm met, so that it can be shown to have met it.
    refused: u32,
    done: u32,
    coincident: u32,
    homecomings: u32,
    worst: f64,
}

impl Storm {
    fn new(seed: u64) -> Self {
        let mut document = ductile_modeler::example(Example::RaisedDisc);
        document.spacing = Some(0.25);
        let mut bench = Bench::new();
        bench.accept(Request::OpenText { text: to_text(&document) });
        let energy = bench.rest(600);
        let calm = bench.document();
        let others = calm.points.values().copied().collect();
        let stream = Stream(seed);
        Self {
            bench,
            stream,
            calm,
            energy,
            others,
            acts: 0,
            refused: 0,
            done: 0,
            coincident: 0,
            homecomings: 0,
            worst: 0.0,
        }
    }

    /// Sends an act that may be refused, and keeps the count of what there is to undo.
    fn act(&mut self, request: Request) -> Reply {
        if matches!(request, Request::Undo) && self.acts == 0 {
            return self.bench.send(Request::Describe);
        }
        let (is_undo, asked) = (matches!(request, Request::Undo), format!("{request:?}"));
        let (before, is_question) = (self.bench.document.clone(), matches!(request, Request::Describe));
        let reply = self.bench.send(request);
        self.refused += u32::from(reply.refused.is_some());
        if reply.refused.is_some() {
            assert_eq!(self.bench.document, before, "{asked} was refused and changed the document");
        }
        if let (Some(committed), false) = (&reply.committed, is_question) {
            self.acts = if is_undo { self.acts - 1 } else { self.acts + 1 };
            self.done += 1;
            self.opens_again(&committed.document, &asked);
        }
        reply
    }

    /// Whoever journals a document can have it back.
    fn opens_again(&mut self, text: &str, asked: &str) {
        let document = from_text(text).unwrap();
        let places: Vec<DVec3> = document.points.values().copied().collect();
        self.coincident += u32::from((1..places.len()).any(|k| places[..k].contains(&places[k])));
        let mut other = Bench::new();
        let reply = other.send(Request::OpenText { text: text.to_owned() });
        assert_eq!(reply.refused, None, "after {asked}: {text}");
    }

    /// One round of drags; acts fall into it, and upon what it leaves behind.
    fn round(&mut self, number: u32) {
        let points: Vec<(PointId, DVec3)> = self.calm.points.iter().map(|(id, at)| (*id, *at)).collect();
        let (point, home) = points[self.stream.below(points.len())];
        self.bench.accept(Request::Grab(GrabTarget::Point(point)));
        for _ in 0..ROUND {
            let target = self.stream.malice(&self.others);
            self.bench.step(Some(target));
            if self.stream.below(4) == 0 {
                let request = self.stream.surgery(&self.others);
                let is_edit = matches!(request, Request::Edit(_) | Request::Redo);
                let reply = self.act(request);
                assert!(!is_edit || reply.refused.is_some(), "an act in the middle of a drag");
            }
        }
        if number.is_multiple_of(HOMECOMING) {
            self.comes_home(point, home);
        }
        let end = if self.stream.below(2) == 0 { Request::Cancel } else { Request::Drop };
        self.act(end);
        for _ in 0..self.stream.below(3) {
            let request = self.stream.surgery(&self.others);
            self.act(request);
            self.bench.step(None);
        }
        while self.acts > 0 {
            self.bench.accept(Request::Undo);
            self.acts -= 1;
        }
        assert_eq!(self.bench.document(), self.calm, "round {number}, {point}, left a trace");
    }

    /// The hand brings the point back and waits: the shape has to come back by itself.
    fn comes_home(&mut self, point: PointId, home: DVec3) {
        for _ in 0..STEPS_HOME {
            self.bench.step(Some(home));
        }
        let energy = self.bench.step(Some(home)).frame.figures.energy;
        self.worst = self.worst.max((energy / self.energy - 1.0).abs());
        self.homecomings += 1;
        assert!(
            (energy / self.energy - 1.0).abs() < 1e-6,
            "{point} came home: {} became {energy}",
            self.energy
        );
    }
}

/// `DRAGS=1000000 cargo test --release -p acceptance --test storm malicious` is the long run, about an hour.
#[test]
fn ten_thousand_malicious_drags_break_nothing() {
    let drags = std::env::var("DRAGS").ok().and_then(|count| count.parse().ok()).unwrap_or(10_000_u32);
    let mut storm = Storm::new(1);
    for number in 0..drags / ROUND {
        storm.round(number);
        if number % 10_000 == 9_999 {
            println!("{} drags", (number + 1) * ROUND);
        }
    }
    let after = storm.bench.rest(600);
    println!(
        "{drags} drags, {} acts done and {} refused, {} documents with coincident points, {} homecomings within {:.1e}",
        storm.done, storm.refused, storm.coincident, storm.homecomings, storm.worst
    );
    assert!((after / storm.energy - 1.0).abs() < 1e-6, "energy {} became {after}", storm.energy);
    assert!(storm.done > drags / 100 && storm.refused > drags / 100 && storm.coincident > 0);
}
