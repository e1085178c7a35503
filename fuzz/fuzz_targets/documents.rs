//! Spec files, links, files of ribbons.
#![no_main]
libfuzzer_sys::fuzz_target!(|bytes: &[u8]| acceptance::files::documents(bytes));
