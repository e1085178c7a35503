//! The workshop: build, serve, test, layer check, size check.

fn main() {}
