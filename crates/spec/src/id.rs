//! Identities of the things that a designer makes. They are stable, saved in the document and never
//! reused within it; mesh handles (vertices, edges, faces) never leave the worker.

use core::fmt;
use serde::{Deserialize, Serialize};

macro_rules! identity {
    ($(#[$doc:meta])* $name:ident, $word:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
        #[serde(transparent)]
        pub struct $name(pub u32);

        impl fmt::Display for $name {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, concat!($word, " {}"), self.0)
            }
        }
    };
}

identity!(
    /// A control point.
    PointId,
    "point"
);
identity!(
    /// A control curve.
    CurveId,
    "curve"
);
identity!(
    /// A surface.
    SurfaceId,
    "surface"
);
