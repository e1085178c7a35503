//! The table of goals in `docs/performance.md`, natively: `cargo bench -p ductile-solver --bench goals`.
//!
//! Prints for each figure the least and the median of many runs beside the goal. A word after `--` picks the figures that begin
//! with it, `-- --once` runs each once, for a profiler.

#![allow(clippy::print_stdout, reason = "a bench prints what it measured")]
#![allow(clippy::disallowed_methods, reason = "a bench needs a clock")]

#[cfg(not(target_arch = "wasm32"))]
#[path = "goals/cases.rs"]
mod cases;
#[cfg(not(target_arch = "wasm32"))]
#[path = "goals/torus.rs"]
mod torus;

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use crate::cases::{Case, GOALS};
    use std::time::{Duration, Instant};

    /// Time to spend on a figure, and runs that are enough or too few.
    const SPENT: Duration = Duration::from_secs(3);
    const MOST: usize = 200;
    const LEAST: usize = 5;

    /// Apart, so that a profiler can tell it from what is made ready.
    #[inline(never)]
    fn measured(case: &mut dyn Case) {
        case.run();
    }

    pub(crate) fn main() {
        let words: Vec<String> = std::env::args().skip(1).collect();
        let is_once = words.iter().any(|word| word == "--once");
        let word = words.iter().find(|word| !word.starts_with("--"));
        println!("| figure | goal | least | median | |\n| --- | --- | --- | --- | --- |");
        for goal in GOALS.iter().filter(|goal| word.is_none_or(|word| goal.name.starts_with(word.as_str()))) {
            let mut case = (goal.make)();
            let mut times = Vec::new();
            let start = Instant::now();
            while times.len() < LEAST || (times.len() < MOST && start.elapsed() < SPENT) {
                case.ready();
                let begin = Instant::now();
                measured(&mut *case);
                times.push(begin.elapsed().as_secs_f64() * 1e3);
                if is_once {
                    break;
                }
            }
            times.sort_by(f64::total_cmp);
            let (least, median, remark) = (times[0], times[times.len() / 2], case.remark());
            println!("| {} | {} ms | {least:.2} ms | {median:.2} ms | {remark} |", goal.name, goal.most);
        }
    }
}

fn main() {
    #[cfg(not(target_arch = "wasm32"))]
    native::main();
}
