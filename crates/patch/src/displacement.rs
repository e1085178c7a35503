//! Displacement blends: points of any surface moved by exactly what is asked, with neighbours joined as before.
//!
//! Source: P. Salvi, *Editing the interior of arbitrary surfaces using C∞ displacement blends*; each file says where it
//! departs from it and why.

mod blend;
mod combine;
mod dense;
mod displaced;
mod domain;
mod erbs;
mod error;
mod extension;
mod green;
mod intrinsic;
mod item;
mod laplacian;
mod place;
mod reach;

pub use blend::{Blend, BlendError, BlendFunction, Range};
pub use combine::Combination;
pub use displaced::{Displacements, ItemReport, Settings};
pub use domain::Domain;
pub use erbs::Erbs;
pub use error::DisplacementError;
pub use item::Item;
pub use laplacian::{Direction, Laplacian};
pub use place::{Placed, nearest_spot, place};
pub use reach::Profile;

#[cfg(test)]
mod tests;
