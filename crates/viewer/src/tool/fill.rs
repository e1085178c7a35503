//! The Fill tool: a click on a curve fills the loop through that place.

use super::{Act, Aim, Options, say};
use crate::Hit;
use ductile_spec::{CurveId, Edit, Hole};

pub(super) fn click(aim: Aim<'_>, options: &Options) -> Vec<Act> {
    let Some(Hit::Curve { id, at }) = aim.hit else {
        return say("There is no curve here. Click a curve of the loop, or a rim that a curve holds.");
    };
    let hole = Hole::Near { curve: *id, at: Some(at.as_dvec3()) };
    vec![Act::Edit(Edit::Fill { hole, style: options.fill })]
}

/// What fills all loops: of the network of a curve, or of all curves.
pub(super) fn all_loops(curve: Option<CurveId>, options: &Options) -> Edit {
    Edit::FillNetwork { curve, style: options.fill }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_spec::{FillJoin, FillStyle};
    use glam::{DVec3, Vec3};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn a_click_on_a_curve_fills_there_as_chosen_and_one_beside_it_says_why_not() {
        let style = FillStyle { degree: Some(4), join: FillJoin::Position, ..FillStyle::default() };
        let options = Options { fill: style, ..Options::default() };
        let hit = Hit::Curve { id: CurveId(3), at: Vec3::Y };
        let hole = Hole::Near { curve: CurveId(3), at: Some(DVec3::Y) };
        let aim = Aim { hit: Some(&hit), ..Aim::default() };
        assert_eq!(click(aim, &options), [Act::Edit(Edit::Fill { hole, style })]);
        assert!(matches!(click(Aim::default(), &options)[..], [Act::Say(_)]));
        assert_eq!(all_loops(None, &options), Edit::FillNetwork { curve: None, style });
    }
}
