//! How much memory a solver of a hundred thousand nodes takes in a browser.
//!
//! A program's memory in WebAssembly never shrinks, so its size at the end is the most that was ever in use.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a failing test or bench should stop where it fails")]

use ductile_solver::{Budget, workload};
use glam::DVec3;
use wasm_bindgen_test::console_log;
use wasm_bindgen_test::wasm_bindgen_test as test;

const MEGABYTE: usize = 1 << 20;
/// Bytes of a page of WebAssembly memory.
const PAGE: usize = 65_536;

#[test]
fn a_hundred_thousand_nodes_are_led_and_relaxed_within_320_megabytes() {
    let (mut solver, mut positions) = workload::raised_disc(183, 0.2).unwrap();
    for _ in 0..3 {
        solver.predict(&mut positions, &[(0, DVec3::Z * 0.01)]).unwrap();
        solver.step(&mut positions, Budget::default()).unwrap();
    }
    let used = core::arch::wasm32::memory_size(0) * PAGE;
    console_log!("{} nodes: {:.1} MB", positions.len(), used as f64 / MEGABYTE as f64);
    assert!(positions.len() > 100_000);
    assert!(used <= 320 * MEGABYTE, "{used} bytes");
}
