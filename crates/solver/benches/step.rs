//! One full step; see `workload`.
fn main() {}
