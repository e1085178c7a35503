//! File formats.

pub mod obj;
pub mod ply;
mod polygons;

pub use polygons::Polygons;
