//! What a shadow of a document must satisfy. Whether stamp and region are discs is for the modeler to say.

use crate::document::{Document, Region};
use crate::id::SurfaceId;
use crate::shadow::Shadow;
use std::collections::BTreeSet;

impl Document {
    /// What is wrong with a shadow of a surface, if anything is.
    pub(super) fn fault_of_shadow(&self, surface: SurfaceId, shadow: Shadow) -> Option<&'static str> {
        if self.kind_of(shadow.of).is_none() {
            return Some("the surface that it shadows does not exist");
        }
        if shadow.of == surface {
            return Some("a surface cannot shadow itself");
        }
        if self.is_stamped_by(shadow.of, surface) {
            return Some("what it shadows shadows it in turn: one of the two must lead");
        }
        shadow.fault()
    }

    /// Whether a surface takes its relief from another one, directly or through others.
    fn is_stamped_by(&self, surface: SurfaceId, other: SurfaceId) -> bool {
        let (mut open, mut seen) = (vec![surface], BTreeSet::new());
        while let Some(next) = open.pop() {
            if next == other {
                return true;
            }
            if seen.insert(next) {
                let regions = self.surfaces.get(&next).map_or(&[][..], |surface| &surface.regions[..]);
                open.extend(regions.iter().filter_map(shadowed));
            }
        }
        false
    }
}

fn shadowed(region: &Region) -> Option<SurfaceId> {
    region.shadow.map(|shadow| shadow.of)
}
