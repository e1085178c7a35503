//! Names of vertices, half-edges, edges and faces: plain `u32` indices that cannot be mixed up.
//!
//! A handle stays valid as long as its element lives; unrelated edits never renumber it. After its
//! element is removed the number may be given to a new element.
//!
//! Half-edges are the sides of triangles. Face `f` owns the half-edges `3f`, `3f + 1` and `3f + 2`, in the
//! face's own local order, so that moving within a face is arithmetic and needs no mesh:
//!
//! ```text
//!          corner 2
//!            /\
//!     h+2   /  \   h+1        h = 3 f, side k runs from corner k to corner k + 1
//!          /    \
//!         /______\
//!  corner 0   h   corner 1
//! ```

macro_rules! handle {
    ($(#[$doc:meta])* $name:ident, $letter:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub struct $name(pub(crate) u32);

        impl $name {
            /// The slot number, for indexing slices kept beside the mesh.
            #[inline]
            #[must_use]
            pub const fn index(self) -> usize {
                self.0 as usize
            }

            /// The handle of slot `index`. Whether an element lives there is for the mesh to say.
            ///
            /// # Panics
            /// When `index` does not fit in 32 bits; no mesh has so many slots.
            #[inline]
            #[must_use]
            #[expect(clippy::cast_possible_truncation, reason = "asserted on the line before")]
            pub const fn from_index(index: usize) -> Self {
                assert!(index < u32::MAX as usize, "no mesh has so many slots");
                Self(index as u32)
            }
        }

        impl core::fmt::Debug for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                write!(f, concat!($letter, "{}"), self.0)
            }
        }

        impl core::fmt::Display for $name {
            fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
                core::fmt::Debug::fmt(self, f)
            }
        }
    };
}

handle! {
    /// A vertex (the thesis's *node*).
    VertexId, "v"
}
handle! {
    /// One side of a face, directed along the face's own local order; also the corner it starts from.
    HalfedgeId, "h"
}
handle! {
    /// An undirected edge: one half-edge on the boundary, two inside.
    EdgeId, "e"
}
handle! {
    /// A triangle.
    FaceId, "f"
}

impl HalfedgeId {
    /// The face whose side this is.
    #[inline]
    #[must_use]
    pub const fn face(self) -> FaceId {
        FaceId(self.0 / 3)
    }

    /// Which side of its face this is: 0, 1 or 2.
    #[inline]
    #[must_use]
    pub const fn side(self) -> usize {
        (self.0 % 3) as usize
    }

    /// The following side of the same face.
    #[inline]
    #[must_use]
    pub const fn next(self) -> Self {
        Self(if self.0 % 3 == 2 { self.0 - 2 } else { self.0 + 1 })
    }

    /// The preceding side of the same face.
    #[inline]
    #[must_use]
    pub const fn prev(self) -> Self {
        Self(if self.0.is_multiple_of(3) { self.0 + 2 } else { self.0 - 1 })
    }
}

impl FaceId {
    /// Side `k` (0, 1 or 2) of this face.
    #[inline]
    #[must_use]
    pub const fn halfedge(self, k: usize) -> HalfedgeId {
        HalfedgeId::from_index(3 * self.index() + k % 3)
    }

    /// The three sides in local order.
    #[inline]
    #[must_use]
    pub const fn halfedges(self) -> [HalfedgeId; 3] {
        [self.halfedge(0), self.halfedge(1), self.halfedge(2)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn sides_cycle_within_their_face() {
        let f = FaceId::from_index(7);
        for (k, h) in f.halfedges().into_iter().enumerate() {
            assert_eq!(h.face(), f);
            assert_eq!(h.side(), k);
            assert_eq!(h.next().prev(), h);
            assert_eq!(h.next().next().next(), h);
            assert_eq!(h.next().side(), (k + 1) % 3);
        }
    }

    #[test]
    fn handles_print_short() {
        assert_eq!(format!("{:?} {}", VertexId::from_index(3), EdgeId::from_index(4)), "v3 e4");
    }
}
