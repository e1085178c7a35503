//! Any bytes at the modeler's one door, as a sequence of requests (`acceptance::scribble`): acts, drags, undo, documents with
//! scrawls in them, numbers at an edge of something, a modeler that dies. Nothing breaks a promise.
//!
//! What was worth keeping lies in `fixtures/acts`, one file of bytes each: cases that went wrong once, and a few that reach far.
//! `INPUTS=5000 SEED=2 cargo test --release -p acceptance --test fuzz_acts -- --nocapture` scrawls so many more, begins elsewhere,
//! and prints what fails, as short as it can be. A fuzzer that looks for new ways itself calls the same function (`fuzz/`).

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::dice::Dice;
use acceptance::scribble::{run, run_told};
use std::collections::BTreeMap;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Inputs that are tried where nobody asks for more.
const INPUTS: usize = 40;
/// Most bytes of a new input.
const LENGTH: usize = 160;
/// Kinds of faults that are made short and printed.
const MOST_FAULTS: usize = 6;

/// The kept inputs, by name.
fn kept() -> BTreeMap<String, Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures/acts");
    let files = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let named = |path: &Path| path.file_name().unwrap().to_str().unwrap().to_owned();
    files.map(|path| (named(&path), fs::read(&path).unwrap())).collect()
}

/// What is wrong with an input, if anything is, and the requests up to there.
fn fault(bytes: &[u8]) -> Option<(String, Vec<String>)> {
    let mut asked = Vec::new();
    let run = || run_told(bytes, |request| asked.push(format!("{request:?}")));
    let why = catch_unwind(AssertUnwindSafe(run)).err()?;
    let text = why.downcast_ref::<String>().cloned();
    Some((text.or_else(|| why.downcast_ref::<&str>().map(|s| (*s).to_owned())).unwrap_or_default(), asked))
}

/// A failure's name: what it says, without the numbers.
fn name_of(fault: &str) -> String {
    fault.lines().next().unwrap_or("").chars().filter(|c| !c.is_ascii_digit()).take(60).collect()
}

/// A new input: one that was kept, with stretches of it changed, doubled or gone, or nothing but noise.
fn scrawl(dice: &mut Dice, kept: &[Vec<u8>]) -> Vec<u8> {
    let noise = |dice: &mut Dice, count: usize| -> Vec<u8> {
        (0..count).map(|_| u8::try_from(dice.below(256)).unwrap()).collect()
    };
    if dice.below(3) == 0 {
        let count = 20 + dice.below(LENGTH - 20);
        return noise(dice, count);
    }
    let mut bytes = kept[dice.below(kept.len())].clone();
    for _ in 0..1 + dice.below(6) {
        let at = dice.below(bytes.len() + 1);
        let end = (at + 1 + dice.below(12)).min(bytes.len());
        match dice.below(4) {
            0 => drop(bytes.splice(at..at, noise(dice, end.saturating_sub(at) + 1))),
            1 => drop(bytes.drain(at..end.max(at))),
            2 => drop(bytes.splice(at..at, bytes[at..end.max(at)].to_vec())),
            _ => bytes[at..end.max(at)]
                .iter_mut()
                .for_each(|byte| *byte = u8::try_from(dice.below(256)).unwrap()),
        }
    }
    bytes.truncate(LENGTH);
    bytes
}

/// The shortest input with the same fault, which taking out any stretch of it would put right.
fn shrunk(mut bytes: Vec<u8>, name: &str) -> Vec<u8> {
    for length in [32, 8, 4, 2, 1] {
        let mut at = bytes.len();
        while at > 0 {
            at = at.saturating_sub(length);
            let mut shorter = bytes.clone();
            shorter.drain(at..(at + length).min(bytes.len()));
            if fault(&shorter).is_some_and(|(why, _)| name_of(&why) == name) {
                bytes = shorter;
            }
        }
    }
    bytes
}

#[test]
fn every_input_that_was_kept_keeps_every_promise() {
    let kept = kept();
    assert!(kept.len() >= 8, "inputs are missing");
    for (name, bytes) in kept {
        let asked = run(&bytes);
        println!("{name}: {} requests", asked.len());
        assert!(asked.len() >= 2, "{name} asks for nothing");
    }
}

#[test]
fn scrawled_inputs_keep_every_promise() {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let wanted = number("INPUTS").map_or(INPUTS, |count| usize::try_from(count).unwrap());
    let mut dice = Dice::seeded(number("SEED").unwrap_or(1));
    let kept: Vec<Vec<u8>> = kept().into_values().collect();
    if std::env::var("LOUD").is_err() {
        // Faults are caught and told, once they are as short as they can be.
        std::panic::set_hook(Box::new(|_| ()));
    }
    let mut faults: BTreeMap<String, u32> = BTreeMap::new();
    for input in 0..wanted {
        let bytes = scrawl(&mut dice, &kept);
        if let Some((why, _)) = fault(&bytes) {
            let name = name_of(&why);
            let count = faults.entry(name.clone()).or_default();
            *count += 1;
            if *count == 1 && faults.len() <= MOST_FAULTS {
                let bytes = shrunk(bytes, &name);
                let (why, asked) = fault(&bytes).unwrap();
                println!("input {input}: {why}\n{bytes:?}\n{}", asked.join("\n"));
            }
        }
        if (input + 1).is_multiple_of(100) {
            println!("{} inputs", input + 1);
        }
    }
    let _ = std::panic::take_hook();
    assert!(faults.is_empty(), "{faults:?}");
}
