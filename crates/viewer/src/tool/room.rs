//! Whether a tube has room for its holes, as far as the picture tells. The modeler decides; this is said before the click.

use super::Place;
use crate::{Rims, Scene};
use ductile_spec::Document;

/// Why a tube between two places would be refused; none as far as can be seen.
#[must_use]
pub fn no_room(
    scene: &Scene,
    document: &Document,
    rims: &Rims,
    ends: [Place; 2],
    radius: f64,
) -> Option<&'static str> {
    let [from, to] = ends;
    if from.surface == to.surface && from.at.as_dvec3().distance(to.at.as_dvec3()) < 2.0 * radius {
        return Some("The holes would meet: go farther, or choose a smaller radius.");
    }
    let is_near = |place: &Place| {
        let is_within = |at: glam::Vec3| at.as_dvec3().distance(place.at.as_dvec3()) < radius;
        let skeleton = document.surfaces.get(&place.surface).map(|surface| &surface.skeleton);
        let mut curves = skeleton.into_iter().flat_map(|skeleton| &skeleton.curves);
        rims.nearest(scene, place.surface, place.at).is_some_and(|rim| is_within(rim.at))
            || curves.any(|embedded| scene.samples(embedded.curve).any(is_within))
    };
    ends.iter().any(is_near).then_some("No room: a rim or a curve is too near. Choose a smaller radius.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sample;
    use glam::Vec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn holes_meet_or_run_over_a_rim_or_have_room() {
        let scene =
            sample::Sketch::default().grid(20, |u, v| Vec3::new(4.0 * u, 4.0 * v, 0.0), true).finish();
        let mut rims = Rims::default();
        rims.refresh(&scene);
        let surface = scene.structure.surfaces[0].id;
        let place = |x: f32| Place { surface, at: Vec3::new(x, 2.0, 0.0), normal: Some(Vec3::Z) };
        let why = |x, y, radius| no_room(&scene, &Document::default(), &rims, [place(x), place(y)], radius);
        assert_eq!(why(1.0, 3.0, 0.5), None);
        assert!(why(1.0, 3.0, 1.01).is_some_and(|why| why.contains("holes would meet")));
        assert!(why(0.4, 3.0, 0.5).is_some_and(|why| why.contains("rim")));
        assert!(why(1.0, 3.7, 0.5).is_some_and(|why| why.contains("rim")));
    }
}
