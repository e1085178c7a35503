//! What a fuzzer does to files (`acceptance::files`), on the files that it begins with and on scrawls of them: so that its targets
//! are compiled and run wherever the tests are.
//!
//! `CORPUS=fuzz/corpus cargo test -p acceptance --test fuzz_files` writes down what the fuzzer begins with; `INPUTS=2000 SEED=2`
//! scrawls so many more.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::dice::Dice;
use acceptance::files::{documents, mesh_files, seeds};
use std::fs;
use std::path::Path;

/// Inputs that are tried where nobody asks for more.
const INPUTS: u64 = 60;

/// Files of which a fuzzer found something, for the target of that name.
const KEPT: [(&str, &[u8]); 0] = [];

fn run(target: &str, bytes: &[u8]) {
    match target {
        "documents" => documents(bytes),
        "mesh_files" => mesh_files(bytes),
        _ => panic!("{target} is no target"),
    }
}

#[test]
fn every_file_that_a_fuzzer_begins_with_keeps_every_promise() {
    let top = Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap();
    let corpus = std::env::var("CORPUS").ok().map(|folder| top.join(folder));
    for (target, name, bytes) in seeds() {
        if let Some(corpus) = &corpus {
            fs::create_dir_all(corpus.join(target)).unwrap();
            fs::write(corpus.join(target).join(name), &bytes).unwrap();
        }
        run(target, &bytes);
    }
    for (target, bytes) in KEPT {
        run(target, bytes);
    }
}

#[test]
fn scrawled_files_keep_every_promise() {
    let number = |name| std::env::var(name).ok().and_then(|text| text.parse::<u64>().ok());
    let mut dice = Dice::seeded(number("SEED").unwrap_or(1));
    let seeds = seeds();
    for _ in 0..number("INPUTS").unwrap_or(INPUTS) {
        let (target, name, bytes) = &seeds[dice.below(seeds.len())];
        let mut bytes = bytes.clone();
        for _ in 0..1 + dice.below(4) {
            let at = dice.below(bytes.len().max(1)).min(bytes.len());
            let end = (at + 1 + dice.below(8)).min(bytes.len());
            match dice.below(4) {
                0 => bytes.insert(at, u8::try_from(dice.below(256)).unwrap()),
                1 => drop(bytes.drain(at..end)),
                2 => drop(bytes.splice(at..at, bytes[at..end].to_vec())),
                _ => bytes
                    .iter_mut()
                    .skip(at)
                    .take(1)
                    .for_each(|byte| *byte = b"0-9,.e1"[usize::from(*byte) % 7]),
            }
        }
        println!("{target}, {name}: {:?}", String::from_utf8_lossy(&bytes));
        run(target, &bytes);
    }
}
