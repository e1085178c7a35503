//! The spokes of even rings, closed and open, of every size that there is: where a neighbour nearly is in the plane.
//!
//! Directions are reckoned from them (`angle::direction_near`). Made once, by formula.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use crate::angle::Direction;
use crate::rings::MAX_RING;

/// Closed rings by degree, then open ones by degree; each has as many spokes as its degree.
static RINGS: LazyLock<Vec<Vec<Direction>>> = LazyLock::new(|| {
    let closed = (0..=MAX_RING).map(|degree| even(degree, TAU / degree.max(1) as f64));
    let open = (0..=MAX_RING).map(|degree| even(degree, PI / degree.saturating_sub(1).max(1) as f64));
    closed.chain(open).collect()
});

fn even(degree: usize, angle: f64) -> Vec<Direction> {
    (0..degree).map(|j| Direction::at(j as f64 * angle)).collect()
}

/// The spokes of the even ring of this degree and number of angles, which for an open ring is one less.
#[inline]
pub(crate) fn spokes(degree: usize, gaps: usize) -> &'static [Direction] {
    &RINGS[if gaps < degree { MAX_RING + 1 + degree } else { degree }]
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn rings_fill_the_plane_or_half_of_it() {
        let closed = spokes(6, 6);
        assert_eq!((closed.len(), closed[0].cos, closed[0].sin), (6, 1.0, 0.0));
        assert!((closed[3].cos + 1.0).abs() < 1e-15 && closed[3].sin.abs() < 1e-15);
        let open = spokes(4, 3);
        assert_eq!(open.len(), 4);
        assert!((open[3].angle - PI).abs() < 1e-15 && (open[1].cos - 0.5).abs() < 1e-15);
        assert_eq!(spokes(MAX_RING, MAX_RING).len(), MAX_RING);
    }
}
