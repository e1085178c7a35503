//! Places that an act or a drag names: on a displaced surface they lie on what is shown, and are carried back to the surface
//! below it, where curves, controls and cuts belong.

use super::Displacer;
use ductile_spec::{Border, Edit, GrabTarget, ObjectiveOf, SpacingOf, SurfaceId};
use glam::DVec3;

impl Displacer {
    /// An act with its places on the surfaces below. Acts on displacements name places there already.
    pub(crate) fn edit_on_base(&self, edit: &Edit) -> Edit {
        let mut edit = edit.clone();
        for (id, at) in places(&mut edit) {
            *at = self.on_base(id, *at);
        }
        edit
    }

    /// The same for what a drag takes hold of, unless it displaces.
    pub(crate) fn target_on_base(&self, target: GrabTarget) -> GrabTarget {
        match target {
            GrabTarget::Surface { surface, at } => {
                GrabTarget::Surface { surface, at: self.on_base(surface, at) }
            }
            other => other,
        }
    }
}

/// The places on surfaces that an act names.
fn places(edit: &mut Edit) -> Vec<(SurfaceId, &mut DVec3)> {
    match edit {
        Edit::SLoop { surface, along, .. } => along.iter_mut().map(|at| (*surface, at)).collect(),
        Edit::Burnout { region }
        | Edit::Shadow { region, .. }
        | Edit::Split { border: Border::Region(region) }
        | Edit::Crease { border: Border::Region(region) } => vec![(region.surface, &mut region.at)],
        Edit::Glue { from, to, .. } | Edit::Merge { from, to, .. } => {
            vec![(from.surface, &mut from.at), (to.surface, &mut to.at)]
        }
        Edit::Trim { first, second, .. } => {
            vec![(first.surface, &mut first.at), (second.surface, &mut second.at)]
        }
        Edit::Pin { surface, at }
        | Edit::Spacing { of: SpacingOf::Region { surface, at }, .. }
        | Edit::Objective { of: ObjectiveOf::Region { surface, at }, .. } => vec![(*surface, at)],
        _ => Vec::new(),
    }
}
