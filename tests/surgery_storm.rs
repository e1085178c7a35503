//! Random acts of surgery, one after another, on small shapes of every kind: discs, a cylinder, a ball, a Möbius strip, a torus, a Klein
//! bottle.
//!
//! Every act is done or refused; a refused one changes nothing. What is done gives sound meshes, which follow their curves
//! edge by edge, of just the kinds that the act promises (`kinds` reckons them from the triangles before it); its document
//! means the same, and the last one of a sequence can be opened again; undo and redo give texts to the letter. A sequence that
//! breaks any of that is made as short as it can be and printed.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use acceptance::dice::{Dice, propose};
use acceptance::kinds::kinds;
use acceptance::round::Round;
use acceptance::shapes;
use ductile_modeler::Model;
use ductile_spec::{Document, Request, from_text, to_compact_text};
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

fn documents() -> Vec<String> {
    let klein = Document { spacing: Some(0.6), ..shapes::klein_bottle() };
    let mut texts: Vec<String> = shapes::for_surgery().iter().chain([&klein]).map(to_compact_text).collect();
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
        round.opens();
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
    let mut dice = Dice::seeded(seed);
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
        round.opens();
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
    for name in [
        "Draw", "Burn out", "Split", "Crease", "Smooth", "Glue", "Merge", "Sweep", "Expand", "Reverse",
        "Shadow",
    ] {
        assert!(tally.acts.get(name).is_some_and(|(done, _)| *done > 0), "{name} was never done");
    }
}

#[test]
fn the_shapes_of_the_storm_are_of_every_kind() {
    let of = |text: &String| kinds(&Model::from_document(from_text(text).unwrap()).unwrap());
    let all: Vec<_> =
        documents().iter().map(of).map(|list| list.into_iter().map(|(_, k)| k).collect::<Vec<_>>()).collect();
    for kind in [(1, 1, true), (0, 2, true), (2, 0, true), (0, 1, false), (0, 0, true), (0, 0, false)] {
        assert!(all.iter().flatten().any(|other| *other == kind), "{kind:?} is missing: {all:?}");
    }
}
