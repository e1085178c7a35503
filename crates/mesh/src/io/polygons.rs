//! What files of polygons hold that a surface needs.

use glam::DVec3;

/// The positions and polygons of a file, as they stand.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polygons {
    /// All positions, used or not.
    pub positions: Vec<DVec3>,
    /// The corners of the faces, in order of the file.
    pub faces: Vec<Vec<u32>>,
}
