//! The Cage tool: a click where nothing is places a cage, a click on a part of a cage selects it.

use super::{Act, Aim, Options, Selection, path, say};
use crate::Hit;
use ductile_spec::{CageSource, Edit};

/// A click. `suited` is the size of a new cage while nobody has chosen another.
pub(super) fn click(aim: Aim<'_>, options: &Options, suited: f64) -> Vec<Act> {
    let place = match aim.hit {
        Some(hit @ (Hit::Point { .. } | Hit::Edge { .. } | Hit::Face { .. })) => {
            return vec![Act::Select(Selection::of(Some(hit)))];
        }
        Some(Hit::Curve { at, .. } | Hit::Surface { at, .. }) => Some(*at),
        None => aim.place,
    };
    let Some(centre) = place else { return say(path::NO_PLACE) };
    let (form, size) = (options.form, options.size.unwrap_or(suited));
    vec![Act::Edit(Edit::Cage { from: CageSource::BuiltIn { form, centre: centre.as_dvec3(), size } })]
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{CageForm, PointId, SurfaceId};
    use glam::{DVec3, Vec3};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn placed(aim: Aim<'_>, options: &Options) -> Vec<(CageForm, DVec3, f64)> {
        let built = |act| match act {
            Act::Edit(Edit::Cage { from: CageSource::BuiltIn { form, centre, size } }) => {
                (form, centre, size)
            }
            other => panic!("{other:?}"),
        };
        click(aim, options, 0.5).into_iter().map(built).collect()
    }

    #[test]
    fn a_click_where_nothing_is_places_the_chosen_cage_at_the_size_that_suits_or_was_typed() {
        let on_plane = Aim { place: Some(Vec3::X), ..Aim::default() };
        assert_eq!(placed(on_plane, &Options::default()), [(CageForm::Cube, DVec3::X, 0.5)]);
        let chosen = Options { form: CageForm::Torus, size: Some(3.0), ..Options::default() };
        assert_eq!(placed(on_plane, &chosen), [(CageForm::Torus, DVec3::X, 3.0)]);
        let hit = Hit::Surface { id: SurfaceId(1), at: Vec3::Y, normal: Vec3::Z, triangle: 0 };
        let on_surface = Aim { hit: Some(&hit), ..on_plane };
        assert_eq!(placed(on_surface, &chosen), [(CageForm::Torus, DVec3::Y, 3.0)]);
        assert_eq!(click(Aim::default(), &chosen, 0.5), say(path::NO_PLACE));
    }

    #[test]
    fn a_click_on_a_part_of_a_cage_selects_it() {
        let surface = SurfaceId(1);
        let ends = [PointId(1), PointId(2)];
        for (hit, selection) in [
            (Hit::Point { id: PointId(7), at: Vec3::X }, Selection::Point(PointId(7))),
            (Hit::Edge { surface, ends, at: Vec3::X }, Selection::Edge { surface, ends }),
            (
                Hit::Face { surface, face: 3, at: Vec3::X, normal: Vec3::Z },
                Selection::Face { surface, face: 3 },
            ),
        ] {
            let aim = Aim { hit: Some(&hit), place: Some(Vec3::Y), ..Aim::default() };
            assert_eq!(click(aim, &Options::default(), 0.5), [Act::Select(selection)]);
        }
    }
}
