//! What the core must do in a browser, in the page and in a dedicated worker: the same bits as everywhere.
//!
//! Where it runs is said from outside (`cargo xtask test wasm` does both), so that one build serves both places.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

use acceptance::{Bench, bits_after};
use ductile_spec::{CurveId, Edit, Example, GrabTarget, PointId, Request, Through};
use glam::{DVec3, dvec3};
use wasm_bindgen_test::wasm_bindgen_test as test;

/// Written by the native half of this test, `tests/bits.rs`.
const BITS: &str = include_str!("../../../tests/fixtures/bits.json");

#[test]
fn examples_give_the_bits_of_the_native_program_after_200_steps() {
    let recorded: serde_json::Value = serde_json::from_str(BITS).unwrap();
    for example in Example::all() {
        let now = bits_after(example, 200);
        assert_eq!(recorded[example.word()].as_u64(), Some(u64::from(now)), "{example:?}");
    }
}

#[test]
fn a_sheet_is_drawn_skinned_dragged_and_undone() {
    let mut bench = Bench::new();
    let at = [dvec3(1., 0., 0.), dvec3(0., 1., 0.), dvec3(-1., 0., 0.), dvec3(0., -1., 0.)];
    bench.edit(Edit::Curve { through: at.map(Through::Place).to_vec(), closed: true });
    bench.edit(Edit::Sheet { boundary: CurveId(1) });
    bench.rest(300);
    let before = bench.document.clone();
    bench.accept(Request::Grab(GrabTarget::Point(PointId(2))));
    for step in 0..10 {
        bench.step(Some(at[1] + DVec3::Z * 0.05 * f64::from(step)));
    }
    bench.accept(Request::Drop);
    bench.rest(300);
    assert_ne!(bench.document, before);
    bench.accept(Request::Undo);
    assert_eq!(bench.document, before);
}

#[test]
fn hostile_input_is_refused() {
    let mut bench = Bench::with(Example::Ball);
    for text in ["", "{\"ductile\":1}x", "[[[[", "{\"ductile\":99}"] {
        assert!(bench.send(Request::OpenText { text: text.into() }).refused.is_some());
        assert!(bench.send(Request::OpenLink { link: text.into() }).refused.is_some());
    }
    assert!(bench.send(Request::Edit(Edit::Point { at: DVec3::NAN })).refused.is_some());
}
