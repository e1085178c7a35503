//! The Ribbon tool: a click on a curve of a surface prescribes how the surface leaves it, as it does at the moment; the green
//! handles turn that.

use super::{Act, Aim, Selection, Surroundings, say};
use crate::Hit;
use ductile_spec::{CurveId, Document, Edit, Handle, Leave, PointId, SurfaceId};
use glam::Vec3;

pub(super) fn click(aim: Aim<'_>, around: Surroundings<'_>) -> Vec<Act> {
    let Some(Hit::Curve { id, .. }) = aim.hit else {
        return say("There is no curve here. Click a rim, a curve in a surface, or a point in one.");
    };
    let Some(surface) = surface_of(around.document, *id, aim.surface) else {
        return say("No fair surface follows this curve. Draw one on a surface with D.");
    };
    let select = Act::Select(Selection::Curve(*id));
    let has_ribbon = around.document.surfaces.get(&surface).is_some_and(|own| own.ribbons.contains_key(id));
    if has_ribbon {
        return vec![select];
    }
    let leave = Some(Leave::Now);
    vec![Act::Edit(Edit::Ribbon { surface, curve: *id, leave }), select]
}

/// Of the surfaces that follow a curve the one that is meant: that under the pointer, or else the first that has a ribbon there,
/// or else the first.
#[must_use]
pub fn surface_of(document: &Document, curve: CurveId, meant: Option<SurfaceId>) -> Option<SurfaceId> {
    let on = || document.surfaces_on(curve);
    let has_ribbon = |id: &SurfaceId| document.surfaces[id].ribbons.contains_key(&curve);
    on().find(|id| Some(*id) == meant).or_else(|| on().find(has_ribbon)).or_else(|| on().next())
}

/// The directions that a document prescribes along a curve, of every surface that follows it, each with what turns it and where.
#[must_use]
pub fn handles_along(document: &Document, curve: CurveId) -> Vec<(Handle, PointId, Vec3)> {
    let ribbons = document.surfaces.iter().filter_map(|(id, own)| Some((*id, own.ribbons.get(&curve)?)));
    ribbons
        .flat_map(|(surface, ribbon)| {
            ribbon.cross.iter().filter_map(move |(point, cross)| {
                let handle = Handle::Ribbon { surface, curve, point: *point };
                Some((handle, *point, cross.try_normalize()?.as_vec3()))
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{Embedding, Ribbon, Skeleton, Structure, Surface};
    use glam::DVec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const CURVE: CurveId = CurveId(3);

    /// Two surfaces on one curve; the second leaves it as told, if so.
    fn two_on_a_curve(has_ribbon: bool) -> Document {
        let curves = vec![Embedding { curve: CURVE, along: vec![0, 1] }];
        let own = Surface::new(Skeleton { curves, ..Skeleton::default() });
        let mut other = own.clone();
        if has_ribbon {
            other.ribbons.insert(CURVE, Ribbon::directed([(PointId(4), DVec3::Y * 2.0)].into()));
        }
        Document { surfaces: [(SurfaceId(1), own), (SurfaceId(2), other)].into(), ..Document::default() }
    }

    fn clicked(document: &Document, hit: Option<&Hit>, surface: Option<SurfaceId>) -> Vec<Act> {
        let structure = Structure::default();
        let around =
            Surroundings { structure: &structure, document, forward: Vec3::NEG_Z, radius: 0.2, size: 0.5 };
        click(Aim { hit, surface, ..Aim::default() }, around)
    }

    #[test]
    fn a_click_prescribes_what_is_on_the_surface_that_is_meant_and_selects() {
        let hit = Hit::Curve { id: CURVE, at: Vec3::X };
        let select = Act::Select(Selection::Curve(CURVE));
        let now = |surface| {
            Act::Edit(Edit::Ribbon { surface: SurfaceId(surface), curve: CURVE, leave: Some(Leave::Now) })
        };
        let bare = two_on_a_curve(false);
        assert_eq!(clicked(&bare, Some(&hit), None), [now(1), select.clone()]);
        assert_eq!(clicked(&bare, Some(&hit), Some(SurfaceId(2))), [now(2), select.clone()]);
        let told = two_on_a_curve(true);
        assert_eq!(clicked(&told, Some(&hit), Some(SurfaceId(1))), [now(1), select.clone()]);
        assert_eq!(clicked(&told, Some(&hit), None), [select], "its handles are there already");
        assert!(matches!(clicked(&Document::default(), Some(&hit), None)[..], [Act::Say(_)]));
        assert!(matches!(clicked(&told, None, None)[..], [Act::Say(_)]));
    }

    #[test]
    fn every_direction_along_a_curve_has_a_handle() {
        let handle = Handle::Ribbon { surface: SurfaceId(2), curve: CURVE, point: PointId(4) };
        assert_eq!(handles_along(&two_on_a_curve(true), CURVE), [(handle, PointId(4), Vec3::Y)]);
        assert_eq!(handles_along(&two_on_a_curve(true), CurveId(9)), []);
    }
}
