//! The preview of a curve under way: a Catmull–Rom spline through its corners (E. Catmull and R. Rom,
//! *A class of local interpolating splines*, 1974). The fair curve that the modeler makes lies near it.

use glam::Vec3;

/// Samples between two corners.
const SAMPLES: usize = 12;

/// The line through the corners, smooth, and closed if so wanted (the first place is then repeated).
#[must_use]
pub fn ghost_line(corners: &[Vec3], closed: bool) -> Vec<Vec3> {
    let count = corners.len();
    if count < 3 {
        return corners.to_vec();
    }
    let spans = if closed { count } else { count - 1 };
    let corner = |index: isize| -> Vec3 {
        let count = count as isize;
        if closed {
            return corners[index.rem_euclid(count) as usize];
        }
        if index < 0 {
            return corners[0] * 2.0 - corners[1];
        }
        if index >= count {
            return corners[corners.len() - 1] * 2.0 - corners[corners.len() - 2];
        }
        corners[index as usize]
    };
    let mut line = Vec::with_capacity(spans * SAMPLES + 1);
    for span in 0..spans {
        let i = span as isize;
        let [before, from, to, after] = [corner(i - 1), corner(i), corner(i + 1), corner(i + 2)];
        for sample in 0..SAMPLES {
            let t = sample as f32 / SAMPLES as f32;
            let linear = (to - before) * t;
            let square = (before * 2.0 - from * 5.0 + to * 4.0 - after) * (t * t);
            let cube = (from * 3.0 - before - to * 3.0 + after) * (t * t * t);
            line.push((from * 2.0 + linear + square + cube) * 0.5);
        }
    }
    line.push(corner(spans as isize));
    line
}
