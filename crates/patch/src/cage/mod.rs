//! Surfaces over cages: a smooth surface through all vertices of a polygon mesh, one patch for each quad.
//!
//! Source: P. Salvi, *Polyhedral design with blended n-sided interpolants*. Each vertex owns a local surface through itself and its
//! whole ring of neighbours; a quad blends the four local surfaces of its corners. Everything is linear in the vertices
//! of the cage, with weights that sum to 1 and may be negative.
//!
//! ```
//! use ductile_patch::cage::{CageSurface, Settings, Split, primitive};
//! let settings = Settings { split: Split::None, ..Settings::default() };
//! let surface = CageSurface::new(&primitive::cube(1.0)?, settings)?;
//! let corner = surface.quads()[0][0] as usize;
//! let there = surface.evaluate(0, 0.0, 0.0)?;
//! assert!(there.point.distance(surface.positions()[corner]) < 1e-12);
//! # Ok::<(), ductile_patch::cage::CageError>(())
//! ```

mod blend;
mod error;
mod interpolant;
mod kite;
mod links;
mod pattern;
mod polygons;
mod ring;
mod split;
mod surface;
mod tessellation;

pub mod edit;
pub mod primitive;

pub use blend::Blend;
pub use error::{CageError, LARGEST_COORDINATE, MOST_VALENCE};
pub use kite::{KitePoint, Map, kite};
pub use polygons::Cage;
pub use ring::Boundary;
pub use split::Split;
pub use surface::{CageSurface, Settings, SurfacePoint};
pub use tessellation::Tessellation;
