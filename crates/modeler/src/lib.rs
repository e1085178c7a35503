//! The model and what can be done to it: one door, [`Modeler::handle`].
//!
//! The document (crate `ductile-spec`) is what the designer specified; a [`SurfaceShape`] is its current
//! approximation, a mesh that relaxes towards the fairest surface. Operations change both together, so
//! that every act is either done whole or refused with the model as it was. The same modeler runs in the
//! worker, in the command line and in the tests; it has no clock and no randomness.

mod bank;
mod bound;
mod density;
mod displaced;
mod error;
mod example;
mod frame;
mod grab;
mod growth;
mod handle;
mod history;
mod maintain;
mod model;
mod modeler;
mod network;
mod operation;
mod patch;
mod plane;
mod pull;
mod region;
mod rehydrate;
mod relax;
mod seams;
mod settle;
mod shadow;
mod shape;
mod skeleton;
mod surgery;

pub use error::{ModelError, TrimError};
pub use example::example;
pub use model::Model;
pub use modeler::Modeler;
pub use patch::{CageShape, FillError, FillShape, MeshShape, NetLines, PatchShape};
pub use relax::{Relaxation, Relaxer};
pub use shape::{CurveShape, EmbeddedCurve, Pin, SurfaceShape};
