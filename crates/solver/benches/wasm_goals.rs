//! The same as `goals.rs` in a browser's worker, by the same cases. The lines of the table are written to the console;
//! criterion's part is only that a bench is run at all.
#![cfg(target_arch = "wasm32")]

#[path = "goals/cases.rs"]
mod cases;
#[path = "goals/torus.rs"]
mod torus;

use std::time::Duration;

use cases::GOALS;
use wasm_bindgen_test::{Criterion, Instant, wasm_bindgen_bench};

/// The browser's clock counts in tenths of a millisecond, so that many runs are measured and the least is told with the
/// median.
const MOST: usize = 100;
const LEAST: usize = 5;
const SPENT: Duration = Duration::from_secs(3);

fn measure(letter: &str) {
    for goal in GOALS.iter().filter(|goal| goal.name.starts_with(letter)) {
        let mut case = (goal.make)();
        let mut times = Vec::new();
        let mut spent = Duration::ZERO;
        while times.len() < LEAST || (times.len() < MOST && spent < SPENT) {
            case.ready();
            let begin = Instant::now();
            case.run();
            let took = begin.elapsed();
            spent += took;
            times.push(took);
        }
        times.sort_unstable();
        let [least, median] = [times[0], times[times.len() / 2]].map(|time| time.as_secs_f64() * 1e3);
        wasm_bindgen_test::console_log!(
            "| {} | {} ms | {least:.2} ms | {median:.2} ms | {} |",
            goal.name,
            goal.most,
            case.remark()
        );
    }
}

#[wasm_bindgen_bench]
fn a(_: &mut Criterion) {
    measure("a");
}

#[wasm_bindgen_bench]
fn b(_: &mut Criterion) {
    measure("b");
}

#[wasm_bindgen_bench]
fn c(_: &mut Criterion) {
    measure("c");
}

#[wasm_bindgen_bench]
fn d(_: &mut Criterion) {
    measure("d");
}

#[wasm_bindgen_bench]
fn e(_: &mut Criterion) {
    measure("e");
}

#[wasm_bindgen_bench]
fn f(_: &mut Criterion) {
    measure("f");
}

#[wasm_bindgen_bench]
fn j(_: &mut Criterion) {
    measure("j");
}
