//! How much memory a model of a hundred thousand nodes takes in a browser: all in, from the opening of its document on.
//!
//! A program's memory in WebAssembly never shrinks, so its size at the end is the most that was ever in use.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::Bench;
use ductile_spec::{Edit, Example, GrabTarget, Request, SpacingOf};
use glam::DVec3;
use wasm_bindgen_test::console_log;
use wasm_bindgen_test::wasm_bindgen_test as test;

const MEGABYTE: usize = 1 << 20;
/// Bytes of a page of WebAssembly memory.
const PAGE: usize = 65_536;

fn used() -> usize {
    core::arch::wasm32::memory_size(0) * PAGE
}

#[test]
fn a_model_of_a_hundred_thousand_nodes_is_dragged_and_undone_within_320_megabytes() {
    let mut bench = Bench::with(Example::RaisedDisc);
    bench.edit(Edit::Spacing { of: SpacingOf::Document, spacing: Some(0.00715) });
    console_log!("opened: {:.1} MB", used() as f64 / MEGABYTE as f64);
    for _ in 0..6 {
        bench.step(None);
    }
    console_log!("relaxed: {:.1} MB", used() as f64 / MEGABYTE as f64);
    let raised = *bench.document().points.iter().find(|(_, at)| at.z > 0.1).unwrap().0;
    let home = bench.document().points[&raised];
    bench.accept(Request::Grab(GrabTarget::Point(raised)));
    for step in 0..4 {
        bench.step(Some(home + DVec3::Z * 0.02 * f64::from(step)));
    }
    bench.accept(Request::Drop);
    for _ in 0..6 {
        bench.step(None);
    }
    bench.accept(Request::Undo);
    let nodes = bench.step(None).frame.figures.nodes;
    console_log!("{nodes} nodes: {:.1} MB", used() as f64 / MEGABYTE as f64);
    assert!(nodes > 95_000, "{nodes}");
    assert!(used() <= 320 * MEGABYTE, "{} bytes", used());
}
