//! Corners at which some planes are agreed on and others come from elsewhere.

use super::valence::dome;
use super::*;
#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[test]
fn patches_that_agree_beside_one_that_went_before_join_it() {
    for spokes in [3, 4, 5, 7] {
        let mut modeler = dome(spokes);
        let at = Some(DVec3::new(0.3, 0.1, 0.35));
        edit(
            &mut modeler,
            Edit::Fill { hole: Hole::Near { curve: CurveId(1), at }, style: FillStyle::default() },
        );
        edit(&mut modeler, Edit::FillNetwork { curve: None, style: FillStyle::default() });
        rest(&mut modeler);
        let taken = modeler.model().document.fills.values().flat_map(|fill| &fill.sides);
        let taken = taken.filter(|side| side.planes.is_some()).count();
        let found = seams(&mut modeler).seams;
        let angle = found.iter().map(|seam| seam.angle).fold(0.0, f64::max);
        println!("{spokes} spokes: {angle:.4}°");
        assert_eq!((taken, found.len()), (2, spokes as usize));
        assert!(angle < 0.01, "{spokes}: {angle}");
    }
}

/// A hole in a fair surface, divided by a curve from rim to rim.
#[test]
fn two_patches_in_a_hole_of_a_fair_surface_join_where_they_meet_its_rim() {
    let (mut modeler, curves) = holed();
    let mut ends = Vec::new();
    for (curve, y) in [(curves[1], -0.6), (curves[2], 0.6)] {
        edit(&mut modeler, Edit::Insert { curve, at: DVec3::new(0.1, y, 0.1) });
        rest(&mut modeler);
        ends.push(*modeler.model().document.points.keys().next_back().unwrap());
    }
    let across = arc(&mut modeler, ends[0], ends[1], DVec3::new(0.0, 0.0, 0.1));
    rest(&mut modeler);
    edit(&mut modeler, Edit::FillNetwork { curve: Some(across), style: FillStyle::default() });
    rest(&mut modeler);
    let fills = &modeler.model().document.fills;
    let taken = fills.values().flat_map(|fill| &fill.sides).filter(|side| side.planes == Some(SurfaceId(1)));
    println!("{} fills, {} taken", fills.len(), taken.count());
    let found = seams(&mut modeler).seams;
    for seam in &found {
        println!("{:?} {}: {}°", seam.surfaces, seam.stretch.curve, seam.angle);
    }
    let between = found.iter().find(|seam| seam.stretch.curve == across).unwrap();
    assert!(between.angle < 0.01, "{between:?}");
}
