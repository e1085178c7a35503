//! Parts of a surface that a tool would cut off: a region, what lies on one side of a curve, or of the lines in which it
//! meets another surface.

use crate::rim::loops;
use crate::scene::Scene;
use ductile_spec::{CurveId, SurfaceId};
use glam::Vec3;

/// How near to an edge a place must come to lie on it, in lengths of the edge: places are rounded to 32 bits.
const ON_EDGE: f32 = 1e-3;

/// Corners of the triangles of a surface, three each, and which of them a triangle of the frame is.
fn corners_of(scene: &Scene, surface: SurfaceId, triangle: u32) -> Option<(&[u32], usize)> {
    let (span, corners, _) = scene.surfaces().find(|(span, ..)| span.id == surface)?;
    let own = triangle.checked_sub(span.first_index / 3)? as usize;
    (scene.has_frame() && own < corners.len() / 3).then_some((corners, own))
}

/// The corners of the region to which a triangle of the frame belongs, three each; none if its surface is in one piece.
#[must_use]
pub fn region_around(scene: &Scene, surface: SurfaceId, triangle: u32) -> Option<Vec<u32>> {
    let region = scene.region_of(triangle)?;
    let (corners, own) = corners_of(scene, surface, triangle)?;
    let first = triangle - u32::try_from(own).ok()?;
    let same = corners.chunks_exact(3).zip(first..).filter(|(_, t)| scene.region_of(*t) == Some(region));
    Some(same.flat_map(|(corners, _)| corners.iter().copied()).collect())
}

/// The part of a surface on the side of a curve on which a triangle lies; none if the curve does not divide the surface.
#[must_use]
pub fn side_of(scene: &Scene, surface: SurfaceId, triangle: u32, curve: CurveId) -> Option<Vec<u32>> {
    let (corners, own) = corners_of(scene, surface, triangle)?;
    let bits = |at: Vec3| at.to_array().map(f32::to_bits);
    let mut line: Vec<[u32; 3]> = scene.samples(curve).map(bits).collect();
    line.sort_unstable();
    let is_on = |v: u32| line.binary_search(&bits(scene.vertex(v))).is_ok();
    let is_in = flood(corners, own, |a, b| is_on(a) && is_on(b));
    let part = corners.chunks_exact(3).zip(&is_in).filter(|(_, is_in)| **is_in);
    let part: Vec<u32> = part.flat_map(|(corners, _)| corners.iter().copied()).collect();
    (part.len() < corners.len()).then_some(part)
}

/// The triangles that can be reached from one over edges that are not barred.
fn flood(corners: &[u32], from: usize, is_barred: impl Fn(u32, u32) -> bool) -> Vec<bool> {
    let mut beside: Vec<(u32, u32, usize)> = Vec::with_capacity(corners.len());
    for (number, t) in corners.chunks_exact(3).enumerate() {
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            if !is_barred(a, b) {
                beside.push((a.min(b), a.max(b), number));
            }
        }
    }
    beside.sort_unstable();
    let mut ways: Vec<(usize, usize)> = Vec::with_capacity(beside.len());
    for same in beside.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        if let [one, other] = same {
            ways.extend([(one.2, other.2), (other.2, one.2)]);
        }
    }
    ways.sort_unstable();
    reached(corners.len() / 3, from, &ways)
}

/// What can be reached from one over ways, which are sorted.
fn reached(count: usize, from: usize, ways: &[(usize, usize)]) -> Vec<bool> {
    let (mut is_in, mut waiting) = (vec![false; count], vec![from]);
    while let Some(own) = waiting.pop() {
        if !std::mem::replace(&mut is_in[own], true) {
            let first = ways.partition_point(|way| way.0 < own);
            waiting.extend(ways[first..].iter().take_while(|way| way.0 == own).map(|way| way.1));
        }
    }
    is_in
}

/// The lines round a part along which it hangs together with the rest of its surface, as places that close.
#[must_use]
pub fn outline(scene: &Scene, surface: SurfaceId, part: &[u32]) -> Vec<Vec<Vec3>> {
    let whole = scene.surfaces().find(|(span, ..)| span.id == surface).map_or(&[][..], |found| found.1);
    let rims = loops(whole).concat();
    let is_cut = |corners: &Vec<u32>| corners.iter().any(|v| !rims.contains(v));
    let line = |corners: Vec<u32>| corners.into_iter().map(|v| scene.vertex(v)).collect();
    loops(part).into_iter().filter(is_cut).map(line).collect()
}

/// The facets of the part of a surface in which a place of a triangle lies, if it is cut along lines; none where the lines do not
/// run along it or do not divide it.
#[must_use]
pub fn part_at(
    scene: &Scene,
    surface: SurfaceId,
    (triangle, at): (u32, Vec3),
    lines: &[Vec<Vec3>],
) -> Option<Vec<[Vec3; 3]>> {
    let (corners, own) = corners_of(scene, surface, triangle)?;
    let place = |v: u32| scene.vertex(v);
    let crossings = Crossings::find(corners, place, lines);
    let mut ways: Vec<(usize, usize)> = Vec::with_capacity(2 * corners.len());
    let low = *corners.iter().min()?;
    let count = (*corners.iter().max()? - low + 1) as usize;
    for (a, b) in edges(corners) {
        if crossings.on(a, b).is_none() {
            let [a, b] = [a, b].map(|v| (v - low) as usize);
            ways.extend([(a, b), (b, a)]);
        }
    }
    ways.sort_unstable();
    let own = &corners[3 * own..3 * own + 3];
    let seed = crossings.corner_beside(own, place, at);
    let is_in = reached(count, (seed - low) as usize, &ways);
    let is_kept = |v: u32| is_in[(v - low) as usize];
    let mut facets = Vec::new();
    let mut is_whole = true;
    for t in corners.chunks_exact(3) {
        // Round the triangle: its corners inside, and where an edge leads out or in.
        let mut outline = Vec::with_capacity(4);
        for (a, b) in [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])] {
            outline.extend(is_kept(a).then(|| place(a)));
            if is_kept(a) != is_kept(b) {
                outline.push(crossings.on(a, b)?);
            }
        }
        is_whole &= is_kept(t[0]) && is_kept(t[1]) && is_kept(t[2]);
        facets.extend(outline.windows(2).skip(1).map(|ends| [outline[0], ends[0], ends[1]]));
    }
    (!is_whole).then_some(facets)
}

fn edges(corners: &[u32]) -> impl Iterator<Item = (u32, u32)> + '_ {
    corners.chunks_exact(3).flat_map(|t| [(t[0], t[1]), (t[1], t[2]), (t[2], t[0])])
}

/// Where lines cross the edges of a surface, by edge in order.
struct Crossings(Vec<((u32, u32), Vec3)>);

impl Crossings {
    fn find(corners: &[u32], place: impl Fn(u32) -> Vec3, lines: &[Vec<Vec3>]) -> Self {
        // The last place of a closed line is its first once more.
        let own =
            |line: &'_ Vec<Vec3>| line.len() - usize::from(line.len() > 2 && line.first() == line.last());
        let mut places: Vec<Vec3> = lines
            .iter()
            .filter(|line| !line.is_empty())
            .flat_map(|line| line[..own(line)].to_vec())
            .collect();
        places.sort_unstable_by(|a, b| a.x.total_cmp(&b.x));
        let mut all: Vec<(u32, u32)> = edges(corners).map(|(a, b)| (a.min(b), a.max(b))).collect();
        all.sort_unstable();
        all.dedup();
        let mut found = Vec::new();
        for (a, b) in all {
            let (from, to) = (place(a), place(b));
            let (way, reach) = (to - from, ON_EDGE * from.distance(to));
            let (low, high) = (from.x.min(to.x) - reach, from.x.max(to.x) + reach);
            let first = places.partition_point(|at| at.x < low);
            let mut near = places[first..].iter().take_while(|at| at.x <= high);
            let is_on = |at: &&Vec3| {
                let t = (**at - from).dot(way) / way.length_squared();
                (0.0..=1.0).contains(&t) && at.distance(from + way * t) < reach
            };
            found.extend(near.find(is_on).map(|at| ((a, b), *at)));
        }
        Self(found)
    }

    fn on(&self, a: u32, b: u32) -> Option<Vec3> {
        let edge = (a.min(b), a.max(b));
        self.0.binary_search_by_key(&edge, |entry| entry.0).ok().map(|k| self.0[k].1)
    }

    /// A corner of a triangle on the side of its line on which a place in it lies.
    fn corner_beside(&self, t: &[u32], place: impl Fn(u32) -> Vec3, at: Vec3) -> u32 {
        for k in 0..3 {
            let [own, next, last] = [t[k], t[(k + 1) % 3], t[(k + 2) % 3]];
            if let (Some(p), Some(q)) = (self.on(own, next), self.on(own, last)) {
                let across = |v: Vec3| (q - p).cross(v - p);
                return if across(at).dot(across(place(own))) > 0.0 { own } else { next };
            }
        }
        t[0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pick::Hit;
    use crate::sample;
    use ductile_spec::{NO_REGION, RegionEntry};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const SURFACE: SurfaceId = SurfaceId(1);

    fn area(facets: &[[Vec3; 3]]) -> f32 {
        facets.iter().map(|[a, b, c]| 0.5 * (*b - *a).cross(*c - *a).length()).sum()
    }

    fn plate() -> Scene {
        let middle: Vec<Vec3> = (0..=10).map(|i| Vec3::new(0.5, i as f32 / 10.0, 0.0)).collect();
        sample::Sketch::default()
            .grid(10, |u, v| Vec3::new(u, v, 0.0), true)
            .curve(&middle, false)
            .curve(&middle[..6], false)
            .finish()
    }

    fn triangle_at(scene: &Scene, x: f32) -> (u32, Vec3) {
        match scene.hit_near(SURFACE, Vec3::new(x, 0.52, 0.0)) {
            Some(Hit::Surface { triangle, at, .. }) => (triangle, at),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_curve_from_rim_to_rim_divides_and_a_slit_does_not() {
        let scene = plate();
        let (triangle, _) = triangle_at(&scene, 0.1);
        let part = side_of(&scene, SURFACE, triangle, CurveId(1)).unwrap();
        assert_eq!(part.len(), 3 * 100);
        assert!(part.iter().all(|v| scene.vertex(*v).x < 0.5 + 1e-5));
        assert_eq!(side_of(&scene, SURFACE, triangle, CurveId(2)), None);
        assert_eq!(side_of(&scene, SurfaceId(7), triangle, CurveId(1)), None);
    }

    #[test]
    fn a_region_is_found_with_the_line_along_which_it_hangs_together() {
        let mut scene = plate();
        let (triangle, _) = triangle_at(&scene, 0.45);
        assert_eq!(region_around(&scene, SURFACE, triangle), None, "in one piece");
        let region = RegionEntry { surface: SURFACE, objective: None, spacing: None, shadow: None };
        scene.structure.regions = vec![region; 2];
        let middle = |t: &[u32]| t.iter().map(|v| scene.vertex(*v)).sum::<Vec3>() / 3.0;
        let is_inner = |t: &[u32]| (middle(t) - Vec3::new(0.5, 0.5, 0.0)).abs().max_element() < 0.2;
        let labels: Vec<u16> = scene.indices.chunks_exact(3).map(|t| u16::from(is_inner(t))).collect();
        assert!(!labels.contains(&NO_REGION));
        scene.structure.region_of_triangle = labels;
        let part = region_around(&scene, SURFACE, triangle).unwrap();
        assert_eq!(part.len(), 3 * 32);
        let lines = outline(&scene, SURFACE, &part);
        assert_eq!(lines.iter().map(Vec::len).collect::<Vec<_>>(), [16]);
        let (far, _) = triangle_at(&scene, 0.05);
        let rest = region_around(&scene, SURFACE, far).unwrap();
        assert_eq!(outline(&scene, SURFACE, &rest).len(), 1, "not the rim of the surface");
    }

    #[test]
    fn a_part_is_cut_off_exactly_along_a_line() {
        let scene = plate();
        // Every place at which the line x = 0.43 crosses an edge, as the modeler gives them, and some between.
        let line: Vec<Vec3> = (0..=20)
            .flat_map(|i| {
                let y = i as f32 / 10.0;
                [Vec3::new(0.43, y, 0.0), Vec3::new(0.43, y + 0.03, 0.0), Vec3::new(0.43, y + 0.05, 0.0)]
            })
            .filter(|at| at.y <= 1.0)
            .collect();
        for (x, wanted) in [(0.1, 0.43), (0.405, 0.43), (0.48, 0.57), (0.9, 0.57)] {
            let part = part_at(&scene, SURFACE, triangle_at(&scene, x), std::slice::from_ref(&line)).unwrap();
            assert!((area(&part) - wanted).abs() < 1e-4, "{x}: {}", area(&part));
        }
        let half: Vec<Vec3> = line.iter().copied().filter(|at| at.y < 0.6).collect();
        assert_eq!(part_at(&scene, SURFACE, triangle_at(&scene, 0.1), &[half]), None, "it divides nothing");
        assert_eq!(part_at(&scene, SURFACE, triangle_at(&scene, 0.1), &[]), None);
    }
}
