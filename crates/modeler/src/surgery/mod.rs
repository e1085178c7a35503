//! Surgery on shapes: what the acts have in common that cut surfaces or join them (thesis sections 4.2 and 7.3.2).
//!
//! The mesh is cut or glued first, as `ductile_mesh` does it, and everything else is found again on the new mesh: which
//! stretches of which curves are still there ([`runs`]), which pieces have come apart and what the document said of them
//! ([`pieces`]), which rims are laid on one another ([`joining`], [`rims`]), which way a curve takes over a surface ([`tracing`]),
//! with which vertices a surface follows a curve that is there already ([`following`]), and how what was joined
//! begins ([`arching`], [`easing`]).

pub(crate) mod arching;
pub(crate) mod dividing;
pub(crate) mod easing;
pub(crate) mod following;
pub(crate) mod joining;
pub(crate) mod opening;
pub(crate) mod pieces;
pub(crate) mod rims;
pub(crate) mod runs;
pub(crate) mod tracing;
