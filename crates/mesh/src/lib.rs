//! Connectivity of a surface, orientable or not: construction, surgery, checks, remeshing, formats.
//!
//! A [`Mesh`] knows which triangles meet along which edges and nothing else. Positions are slices of
//! [`glam::DVec3`] kept beside it, indexed by [`VertexId::index`]; functions that need them say so.
//! Control points and control curves are marked by [`SourceTag`]s, and no edit of the mesh loses one.
//!
//! ```
//! use ductile_mesh::{Mesh, validate};
//!
//! let mut mesh = Mesh::from_triangles(4, &[[0, 1, 2], [2, 1, 3]])?;
//! let e = mesh.edges().find(|&e| !mesh.is_boundary_edge(e)).expect("two triangles share an edge");
//! let v = mesh.split_edge(e);
//! let mut ring = Vec::new();
//! let is_inside = mesh.ring(v, &mut ring);
//! assert!(is_inside && ring.len() == 4);
//! assert_eq!(validate(&mesh), Ok(()));
//! # Ok::<(), ductile_mesh::BuildError>(())
//! ```

mod assemble;
mod build;
mod check;
mod dehydrate;
#[cfg(test)]
mod family;
mod handle;
mod intersect;
pub mod io;
mod label;
pub mod measure;
mod orient;
mod place;
pub mod primitive;
#[cfg(test)]
mod property_test;
mod proximity;
pub mod remesh;
mod source;
mod surgery;
mod topology;
mod walk;

pub use assemble::{Appended, Extracted};
pub use build::BuildError;
pub use check::{Defect, validate, validate_curves};
pub use dehydrate::{Dehydrated, dehydrate};
pub use handle::{EdgeId, FaceId, HalfedgeId, VertexId};
pub use intersect::{CommonLine, CommonPoint, IntersectError, Placed, intersections};
pub use label::{Labels, components, regions};
pub use measure::{Summary, boundary_loops, quality, summary};
pub use orient::{is_orientable, propagate_orientation, reverse, reverse_face};
pub use place::{Place, nearest_place};
pub use proximity::{ClosestPair, SurfaceTree, refine_pair};
pub use source::SourceTag;
pub use surgery::{
    Blocked, Bridge, BridgeError, Bridged, CrossingVertex, Cut, CutError, GlueError, InsertError, Meeting,
    OnEdge, Path, PathError, Removed, Seam, Sense,
};
pub use topology::Mesh;
pub use walk::Wedge;
