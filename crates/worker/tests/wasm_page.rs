//! The core in the browser, in the page: the same bits as everywhere.
#![cfg(target_arch = "wasm32")]
#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]

mod core_in_browser;

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_browser);
