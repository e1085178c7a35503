//! Random acts of surgery, one after another, on small shapes of every kind: discs, a cylinder, a ball, a Möbius strip, a torus.
//!
//! Every act is done or refused; a refused one changes nothing. What is done gives sound meshes, which follow their curves
//! edge by edge, of just the kinds that the act promises (`kinds` reckons them from the triangles before it); its document
//! can be opened again and means the same; undo and redo give texts to the letter. A sequence that breaks any of that is made
//! as short as it can be and printed.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use acceptance::dice::{Dice, propose};
use acceptance::kinds::kinds;
use acceptance::promise::promise;
use acceptance::shapes;
use ductile_modeler::Model;
use ductile_spec::{Edit, PointId, Request, from_text, to_compact_text};
use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Acts of one sequence.
const LENGTH: usize = 12;
/// A shape with more nodes than this takes too long to be worth more acts.
const ENOUGH: usize = 4000;
/// Failures that are made short and printed.
const MOST_FAILURES: usize = 6;

/// What the acts did, by name: done and refused, and why.
#[derive(Default)]
struct Tally {
    acts: BTreeMap<&'static str, (u32, u32)>,
    reasons: BTreeMap<String, u32>,
}

/// A sequence on one shape.
struct Round {
    bench: Bench,
    /// The texts that undo goes back through, and which of them is now.
    texts: Vec<String>,
    now: usize,
}

impl Round {
    fn new(document: &str) -> Self {
        let mut bench = Bench::new();
        bench.accept(Request::OpenText { text: document.to_owned() });
        let texts = vec![bench.document.clone()];
        for _ in 0..4 {
            bench.step(None);
        }
        Self { bench, texts, now: 0 }
    }

    /// Asks for one thing and checks all that is promised. Gives why it was refused, if it was.
    fn ask(&mut self, request: &Request) -> Option<String> {
        match request {
            Request::Step(_) => {
                self.bench.accept(request.clone());
                follows(&self.bench);
                None
            }
            Request::Undo | Request::Redo => {
                let is_undo = matches!(request, Request::Undo);
                let there = if is_undo { self.now.checked_sub(1) } else { Some(self.now + 1) };
                let there = there.filter(|there| *there < self.texts.len());
                let reply = self.bench.send(request.clone());
                assert_eq!(reply.refused.is_none(), there.is_some(), "{request:?}");
                self.now = there.unwrap_or(self.now);
                assert_eq!(self.bench.document, self.texts[self.now], "{request:?} to the letter");
                follows(&self.bench);
                reply.refused.map(|refusal| refusal.reason)
            }
            Request::Edit(edit) => self.act(edit),
            _ => {
                self.bench.accept(request.clone());
                self.commit();
                None
            }
        }
    }

    fn commit(&mut self) {
        self.texts.truncate(self.now + 1);
        self.texts.push(self.bench.document.clone());
        self.now += 1;
    }

    fn act(&mut self, edit: &Edit) -> Option<String> {
        let before = self.bench.modeler.model().clone();
        let text = self.bench.document.clone();
        let promised = promise(&before, edit);
        let reply = self.bench.send(Request::Edit(edit.clone()));
        if let Some(refusal) = reply.refused {
            assert!(refusal.reason.len() > 10, "{refusal:?} says nothing");
            assert_eq!(self.bench.document, text, "it was refused and changed the document");
            is_untouched(&before, self.bench.modeler.model());
            return Some(refusal.reason);
        }
        let after = self.bench.document.clone();
        let model = self.bench.modeler.model();
        let mut found: Vec<_> = kinds(model).into_iter().map(|(_, kind)| kind).collect();
        found.sort_unstable();
        if let Some(all) = promised {
            assert!(all.contains(&found), "kinds {found:?}; promised was one of {all:?}");
        }
        follows(&self.bench);
        leaves_nothing_lying(&before, model, edit);
        let document = from_text(&after).unwrap();
        assert_eq!(to_compact_text(&document), after, "the text does not come round");
        match Model::from_document(document) {
            Ok(again) => {
                assert_eq!(kinds(&again), kinds(model), "the document means another surface: {after}")
            }
            Err(why) => panic!("the document cannot be opened: {why}: {after}"),
        }
        self.bench.accept(Request::Undo);
        assert_eq!(self.bench.document, text, "undo to the letter");
        is_untouched(&before, self.bench.modeler.model());
        self.bench.accept(Request::Redo);
        assert_eq!(self.bench.document, after, "redo to the letter");
        self.commit();
        None
    }
}

/// The same document, on the same shapes.
fn is_untouched(before: &Model, after: &Model) {
    assert_eq!(before.document, after.document);
    assert!(before.surfaces.keys().eq(after.surfaces.keys()) && before.curves.keys().eq(after.curves.keys()));
    for (old, new) in before.surfaces.values().zip(after.surfaces.values()) {
        assert_eq!(old.positions, new.positions);
        assert_eq!(old.embeddings, new.embeddings);
        assert_eq!(old.pins, new.pins);
    }
    for (old, new) in before.curves.values().zip(after.curves.values()) {
        assert_eq!(old.nodes, new.nodes);
    }
}

/// Every surface follows its curves edge by edge and holds its control points, and is marked for nothing else.
fn follows(bench: &Bench) {
    let model = bench.modeler.model();
    for (id, curve) in &model.curves {
        let own: Vec<PointId> = curve.controls.iter().map(|(_, point)| *point).collect();
        assert_eq!(own, model.document.curves[id].through, "controls of {id}");
        assert!(curve.controls.windows(2).all(|pair| pair[0].0 < pair[1].0), "controls of {id} in order");
    }
    for (id, shape) in &model.surfaces {
        let (mut edges, mut points) = (0, 0);
        let mut tagged = vec![false; shape.mesh.vertex_slots()];
        let mut lined = tagged.clone();
        for embedded in &shape.embeddings {
            let curve = &model.curves[&embedded.curve];
            for vertex in &embedded.vertices {
                let is_second = std::mem::replace(&mut lined[vertex.index()], true);
                assert!(
                    !is_second || shape.mesh.is_source_vertex(*vertex),
                    "curves of {id} meet without a hub"
                );
            }
            for k in 0..curve.edge_count() {
                let (a, b) = curve.edge(k);
                let edge = shape.mesh.edge_between(embedded.vertices[a], embedded.vertices[b]);
                let tag = edge.and_then(|e| shape.mesh.edge_source(e)).map(|tag| tag.0);
                assert_eq!(tag, Some(embedded.curve.0), "edge {k} of {} in {id}", embedded.curve);
                edges += 1;
            }
            for (sample, point) in &curve.controls {
                let vertex = embedded.vertices[*sample as usize];
                let tag = shape.mesh.vertex_source(vertex).map(|tag| tag.0);
                assert_eq!(tag, Some(point.0), "a control of {} in {id}", embedded.curve);
                points += usize::from(!std::mem::replace(&mut tagged[vertex.index()], true));
            }
        }
        for pin in &shape.pins {
            let tag = shape.mesh.vertex_source(pin.vertex).map(|tag| tag.0);
            assert_eq!(tag, Some(pin.point.0), "a pin of {id}");
            points += usize::from(!std::mem::replace(&mut tagged[pin.vertex.index()], true));
        }
        assert_eq!(
            shape.mesh.edges().filter(|e| shape.mesh.is_source_edge(*e)).count(),
            edges,
            "lines of {id}"
        );
        let sources = shape.mesh.vertices().filter(|v| shape.mesh.is_source_vertex(*v)).count();
        assert_eq!(sources, points, "marked vertices of {id}");
        let document = &model.document.surfaces[id];
        let followed = |curve| shape.embeddings.iter().any(|e| e.curve == curve);
        assert!(document.ribbons.keys().all(|curve| followed(*curve)), "ribbons of {id}");
        assert!(document.regions.iter().all(|region| followed(region.curve)), "regions of {id}");
        assert_eq!(document.skeleton.curves.len(), shape.embeddings.len(), "curves of {id}'s skeleton");
    }
}

/// No act leaves points that nothing uses, unless it was to make one.
fn leaves_nothing_lying(before: &Model, after: &Model, edit: &Edit) {
    let unused = |model: &Model, point: PointId| {
        model.document.curves_through(point).next().is_none()
            && model.document.surfaces_through(point).next().is_none()
    };
    let is_meant = matches!(edit, Edit::Point { .. });
    for point in after.document.points.keys() {
        let was = before.document.points.contains_key(point) && unused(before, *point);
        assert!(is_meant || was || !unused(after, *point), "{point} is left lying");
    }
}

fn documents() -> Vec<String> {
    let mut texts: Vec<String> = shapes::for_surgery().iter().map(to_compact_text).collect();
    for text in &mut texts {
        let mut bench = Bench::new();
        bench.accept(Request::OpenText { text: text.clone() });
        bench.rest(900);
        text.clone_from(&bench.document);
    }
    texts
}

/// What is wrong with a sequence, if anything is.
fn fault(document: &str, script: &[Request]) -> Option<String> {
    let run = || {
        let mut round = Round::new(document);
        for request in script {
            round.ask(request);
        }
    };
    catch_unwind(AssertUnwindSafe(run)).err().map(|why| told(why.as_ref()))
}

/// The shortest script that is still wrong, which leaving out any one request would put right.
fn shrunk(document: &str, mut script: Vec<Request>) -> Vec<Request> {
    let mut k = script.len();
    while k > 0 {
        k -= 1;
        let mut shorter = script.clone();
        shorter.remove(k);
        if fault(document, &shorter).is_some() {
            script = shorter;
            k = k.min(script.len());
        }
    }
    script
}

fn told(why: &(dyn std::any::Any + Send)) -> String {
    let text = why.downcast_ref::<String>().cloned();
    text.or_else(|| why.downcast_ref::<&str>().map(|s| (*s).to_owned())).unwrap_or_default()
}

/// A failure's name: what it says, without the numbers.
fn name_of(fault: &str) -> String {
    fault.lines().next().unwrap_or("").chars().filter(|c| !c.is_ascii_digit()).take(60).collect()
}

/// One sequence from a seed. Gives how many acts it tried, or the script that failed.
fn round(document: &str, seed: u64, tally: &mut Tally) -> Result<usize, (Vec<Request>, String)> {
    let mut script: Vec<Request> = Vec::new();
    let mut acts = 0;
    let mut dice = Dice(seed);
    let run = || {
        let mut round = Round::new(document);
        while acts < LENGTH {
            let model = round.bench.modeler.model();
            if model.surfaces.is_empty() || model.node_count() > ENOUGH {
                break;
            }
            let request = propose(&mut dice, round.bench.modeler.model());
            script.push(request.clone());
            let refused = round.ask(&request);
            let name = match &request {
                Request::Edit(edit) => edit.label(),
                Request::Step(_) => continue,
                Request::Undo => "Undo",
                Request::Redo => "Redo",
                _ => "Open",
            };
            acts += 1;
            let entry = tally.acts.entry(name).or_default();
            if refused.is_none() {
                entry.0 += 1
            } else {
                entry.1 += 1
            }
            if let Some(reason) = refused {
                *tally.reasons.entry(name_of(&reason)).or_default() += 1;
            }
        }
    };
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(()) => Ok(acts.max(1)),
        Err(why) => Err((script, told(why.as_ref()))),
    }
}

/// `ACTS=100000 cargo test --release -p acceptance --test surgery_storm -- --nocapture` is the long run; `SEED` begins it elsewhere.
#[test]
fn random_surgery_keeps_every_promise() {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let (wanted, seed) = (number("ACTS").unwrap_or(2000), number("SEED").unwrap_or(1));
    let documents = documents();
    let quiet = std::env::var("LOUD").is_err();
    if quiet {
        // Faults are caught and told at the end, once they are as short as they can be.
        std::panic::set_hook(Box::new(|_| ()));
    }
    let (mut acts, mut rounds, mut tally) = (0, 0_u64, Tally::default());
    let mut faults: BTreeMap<String, (u32, String)> = BTreeMap::new();
    while acts < wanted {
        let place = usize::try_from(rounds).unwrap() % documents.len();
        let document = &documents[place];
        match round(document, seed.wrapping_mul(0x1_0000_0000).wrapping_add(rounds), &mut tally) {
            Ok(done) => acts += done as u64,
            Err((script, why)) => {
                acts += script.len() as u64;
                let entry = faults.entry(name_of(&why)).or_default();
                entry.0 += 1;
                if entry.0 == 1 {
                    let script = shrunk(document, script);
                    let why = fault(document, &script).unwrap_or(why);
                    let lines: Vec<String> =
                        script.iter().map(|request| serde_json::to_string(request).unwrap()).collect();
                    entry.1 =
                        format!("round {rounds}, shape {place}: {why}\n{document}\n{}", lines.join("\n"));
                    println!("{}", entry.1);
                    if faults.len() >= MOST_FAILURES {
                        break;
                    }
                }
            }
        }
        rounds += 1;
        if rounds.is_multiple_of(25) {
            println!("{acts} acts");
        }
    }
    let _ = std::panic::take_hook();
    println!("{acts} acts in {rounds} sequences; done and refused: {:?}", tally.acts);
    tally.reasons.iter().for_each(|(reason, count)| println!("{count:5} × {reason}"));
    let told: Vec<String> =
        faults.values().map(|(count, text)| format!("--- {count} times like this\n{text}")).collect();
    assert!(faults.is_empty(), "{} kinds of faults\n{}", faults.len(), told.join("\n"));
    for name in
        ["Draw", "Burn out", "Split", "Crease", "Smooth", "Glue", "Merge", "Sweep", "Expand", "Reverse"]
    {
        assert!(tally.acts.get(name).is_some_and(|(done, _)| *done > 0), "{name} was never done");
    }
}

#[test]
fn the_shapes_of_the_storm_are_of_every_kind() {
    let of = |text: &String| kinds(&Model::from_document(from_text(text).unwrap()).unwrap());
    let all: Vec<_> =
        documents().iter().map(of).map(|list| list.into_iter().map(|(_, k)| k).collect::<Vec<_>>()).collect();
    for kind in [(1, 1, true), (0, 2, true), (2, 0, true), (0, 1, false), (0, 0, true)] {
        assert!(all.iter().flatten().any(|other| *other == kind), "{kind:?} is missing: {all:?}");
    }
}
