//! S-patches: smooth surfaces over a regular polygon that fill an n-sided hole between Bézier ribbons.
//!
//! C. Loop and T. `DeRose`, *A multisided generalization of Bézier surfaces* (1989); P. Salvi, *G1 hole filling with S-patches
//! made easy* (2020, arXiv:2002.11109), whose equations (1) to (5) are cited by number. What was derived anew and where
//! the house departs: the coordinates are Wachspress's in a form without divisions by distances; points shared by two
//! panels are compared, never overwritten; interior points come from one sparse symmetric system for each kind of patch.
//!
//! A patch of `n` sides and depth `D` has a control point for every label, that is for every way to write `D` as a sum of
//! `n` non-negative integers. Ribbons of degree `d` ask for depth `d + 3`, boundary curves alone for depth `d`.

mod build;
mod domain;
mod evaluate;
mod influence;
mod kind;
mod label;
mod masks;
mod patch;
#[cfg(test)]
mod property_test;
mod tessellation;
#[cfg(test)]
pub(crate) mod tests;

pub use build::{BuildError, Join};
pub use domain::Domain;
pub use kind::{KindError, PatchKind};
pub use label::{LabelKind, Labels, TooManyPoints};
pub use masks::{Fill, MaskCache, MaskError};
pub use patch::SPatch;
pub use tessellation::{Tessellated, Tessellation, TessellationError};
