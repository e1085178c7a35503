//! File formats.

pub mod obj;
