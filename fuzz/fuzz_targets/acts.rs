//! Sequences of requests: acts, drags, undo, a modeler that dies.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| drop(acceptance::scribble::run(bytes)));
