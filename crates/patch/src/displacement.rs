//! Displacement blends: points of any surface moved by exactly what is asked, with neighbours joined as before.
//!
//! Source: P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*; each file says where it
//! departs from it and why.

mod blend;
mod erbs;

pub use blend::{Blend, BlendError, BlendFunction, Range};
pub use erbs::Erbs;
