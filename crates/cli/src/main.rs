//! Headless: solve, check, link, unlink.

fn main() {}
