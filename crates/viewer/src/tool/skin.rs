//! Translucent skins that stand for surfaces to be. Only a likeness: the modeler makes the surface, and it becomes fair.

use super::preview::resampled;
use glam::Vec3;

/// A triangle of a skin.
pub type Facet = [Vec3; 3];

/// Corners of the skin in a closed curve.
const CORNERS: usize = 48;

/// The skin over lines of as many places each, from each to the next, and from the last to the first if it closes.
#[must_use]
pub fn loft(lines: &[Vec<Vec3>], closed: bool) -> Vec<Facet> {
    let count = if closed { lines.len() } else { lines.len().saturating_sub(1) };
    let pairs = lines.iter().zip(lines.iter().cycle().skip(1)).take(count);
    let quads = pairs.flat_map(|(one, other)| one.windows(2).zip(other.windows(2)));
    quads.flat_map(|(a, b)| [[a[0], a[1], b[1]], [a[0], b[1], b[0]]]).collect()
}

/// The skin in a closed curve that has the least area of all without further corners (G. Barequet and M. Sharir, *Filling gaps
/// in the boundary of a polyhedron*, 1995).
#[must_use]
pub fn least_skin(line: &[Vec3]) -> Vec<Facet> {
    if line.len() < 3 {
        return Vec::new();
    }
    let corners = if line.len() > CORNERS { resampled(line, true, CORNERS) } else { line.to_vec() };
    let count = corners.len();
    // By ends of a chord: the least area of what it cuts off, and the third corner of the triangle at it.
    let mut best = vec![(0.0_f32, 0_usize); count * count];
    for (from, to) in (2..count).flat_map(|span| (0..count - span).map(move |from| (from, from + span))) {
        let area = |k: usize| {
            let own = (corners[k] - corners[from]).cross(corners[to] - corners[from]).length();
            (own + best[from * count + k].0 + best[k * count + to].0, k)
        };
        if let Some(least) = (from + 1..to).map(area).min_by(|a, b| a.0.total_cmp(&b.0)) {
            best[from * count + to] = least;
        }
    }
    let (mut facets, mut chords) = (Vec::with_capacity(count), vec![(0, count - 1)]);
    while let Some((from, to)) = chords.pop() {
        if to - from > 1 {
            let k = best[from * count + to].1;
            facets.push([from, k, to].map(|corner| corners[corner]));
            chords.extend([(from, k), (k, to)]);
        }
    }
    facets
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn area(skin: &[Facet]) -> f32 {
        skin.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum()
    }

    #[test]
    fn the_skin_of_a_bent_outline_stays_inside_it() {
        // An L: a fan about its middle would have more than its area.
        let corners = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 3.0], [0.0, 3.0]];
        let line = corners.map(|[x, y]| Vec3::new(x, y, 0.0));
        let skin = least_skin(&line);
        assert_eq!(skin.len(), 4);
        assert!((area(&skin) - 5.0).abs() < 1e-5, "{}", area(&skin));
        assert!(least_skin(&line[..2]).is_empty());
    }

    #[test]
    fn a_long_outline_is_taken_in_fewer_corners() {
        let at = |i: u16| {
            let (s, c) = (std::f32::consts::TAU * f32::from(i) / 500.0).sin_cos();
            Vec3::new(c, s, 0.0)
        };
        let skin = least_skin(&(0..500).map(at).collect::<Vec<_>>());
        assert_eq!(skin.len(), CORNERS - 2);
        assert!((area(&skin) / std::f32::consts::PI - 1.0).abs() < 0.01);
    }

    #[test]
    fn a_loft_closes_if_it_is_told_to() {
        let lines: Vec<Vec<Vec3>> = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]
            .map(|[x, y]| vec![Vec3::new(x, y, 0.0), Vec3::new(x, y, 2.0)])
            .to_vec();
        assert!((area(&loft(&lines, false)) - 2.0 * (1.0 + 2.0_f32.sqrt())).abs() < 1e-5);
        assert!((area(&loft(&lines, true)) - 2.0 * (2.0 + 2.0_f32.sqrt())).abs() < 1e-5);
    }
}
