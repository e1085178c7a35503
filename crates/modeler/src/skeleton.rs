//! Skeletons: the least triangulations that hold a surface's topology and all of its controls.
//!
//! A sheet's skeleton triangulates the control points of its boundary; a sweep's zips the points of two
//! curves together; that of a surface which was edited on screen is its mesh with everything inessential
//! taken out ("dehydrated", thesis section 5.2); so is, after a move, that of one whose controls were led far.

mod carry;
mod renew;

use crate::model::{Model, round_to_digits};
use crate::shape::SurfaceShape;

use ductile_mesh::{Dehydrated, Mesh, VertexId, dehydrate};
use ductile_spec::{CurveId, Embedding, PointId, Skeleton, SkeletonVertex};
use glam::DVec3;

pub(crate) use carry::carry_free;
pub(crate) use renew::renew;

/// Above this many boundary points the cubic search is replaced by a zigzag.
const MOST_SEARCHED: usize = 250;
/// How much a long diagonal counts against a large area: enough to decide between the equal areas of the
/// triangulations of a convex plane polygon, too little to leave a concave one.
const DIAGONAL_WEIGHT: f64 = 1e-3;
/// Significant digits of the hints where free skeleton vertices lie.
const HINT_DIGITS: usize = 4;

/// The skeleton of a sheet in a loop of control points with the given curves along it.
pub(crate) fn sheet_skeleton(boundary: &[(PointId, DVec3)], curves: Vec<Embedding>) -> Skeleton {
    let corners: Vec<DVec3> = boundary.iter().map(|(_, at)| *at).collect();
    let triangles = if corners.len() > MOST_SEARCHED { zigzag(corners.len()) } else { least_area(&corners) };
    Skeleton {
        vertices: boundary.iter().map(|(id, _)| SkeletonVertex::Control(*id)).collect(),
        triangles,
        curves,
    }
}

/// The skeleton of a cylinder between two closed curves with the given control points, or of a strip between two open ones.
///
/// The second may begin anywhere (if it is closed) and run either way: the correspondence with the shortest edges is taken,
/// or the shortest of those the other way round.
pub(crate) fn sweep_skeleton(
    from: (CurveId, &[(PointId, DVec3)]),
    to: (CurveId, &[(PointId, DVec3)]),
    closed: bool,
    other_way: bool,
) -> Skeleton {
    let low: Vec<DVec3> = from.1.iter().map(|(_, at)| *at).collect();
    let high: Vec<DVec3> = to.1.iter().map(|(_, at)| *at).collect();
    let centre = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len().max(1) as f64;
    let shift = if closed { centre(&low) - centre(&high) } else { DVec3::ZERO };
    let best = |reversed: bool| {
        let starts = if closed { high.len() } else { 1 };
        let all = |pace: Pace| {
            let all = (0..starts).map(move |start| (start, pace));
            let zipped =
                all.map(|(start, pace)| zip((&low, &high), (closed, pace), shift, (start, reversed)));
            // Where one line has most of its points at one end of the other, the shortest edges may join a pair twice.
            let count = low.len() + high.len();
            let sound = zipped.filter(|(_, triangles)| Mesh::from_triangles(count, triangles).is_ok());
            sound.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        all(Pace::Shortest).or_else(|| all(Pace::Even)).unwrap_or_default()
    };
    let (plain, turned) = (best(false), best(true));
    let is_plain = (plain.0 <= turned.0) != other_way;
    let (_, triangles) = if is_plain { plain } else { turned };
    let count = |n: usize| u32::try_from(n).unwrap_or(u32::MAX);
    Skeleton {
        vertices: from.1.iter().chain(to.1).map(|(id, _)| SkeletonVertex::Control(*id)).collect(),
        triangles,
        curves: vec![
            Embedding { curve: from.0, along: indices(0, low.len()) },
            Embedding { curve: to.0, along: indices(count(low.len()), high.len()) },
        ],
    }
}

/// The skeleton of a surface as it is now.
pub(crate) fn skeleton_of(model: &Model, shape: &SurfaceShape) -> Skeleton {
    let Dehydrated { mesh: reduced, kept, .. } = dehydrate(&shape.mesh, &shape.positions);
    let control = |v: VertexId| shape.mesh.vertex_source(v).map(|tag| PointId(tag.0));
    // Controls first, by identity, then the rest: equal surfaces get equal skeletons.
    let mut order: Vec<(Option<PointId>, VertexId, VertexId)> = Vec::new();
    for v in shape.mesh.vertices() {
        if let Some(new) = kept[v.index()] {
            order.push((control(v), v, new));
        }
    }
    order.sort_by_key(|(point, old, _)| (point.is_none(), *point, *old));
    let mut place = vec![u32::MAX; reduced.vertex_slots()];
    for (index, (.., new)) in (0_u32..).zip(&order) {
        place[new.index()] = index;
    }
    let hint = |at: DVec3| DVec3::from_array(at.to_array().map(|x| round_to_digits(x, HINT_DIGITS)));
    let vertices = order
        .iter()
        .map(|(point, old, _)| {
            point.map_or_else(
                || SkeletonVertex::Free(hint(shape.positions[old.index()])),
                SkeletonVertex::Control,
            )
        })
        .collect();
    let triangles = reduced.faces().map(|f| reduced.face_vertices(f).map(|v| place[v.index()])).collect();
    let curves = shape
        .embeddings
        .iter()
        .map(|embedded| {
            let first = model
                .curves
                .get(&embedded.curve)
                .and_then(|c| c.controls.first())
                .map_or(0, |c| c.0 as usize);
            let (before, after) = embedded.vertices.split_at(first.min(embedded.vertices.len()));
            let along = after.iter().chain(before);
            let along = along.filter_map(|v| kept[v.index()]).map(|v| place[v.index()]).collect();
            Embedding { curve: embedded.curve, along }
        })
        .collect();
    Skeleton { vertices, triangles, curves }
}

fn indices(first: u32, count: usize) -> Vec<u32> {
    (first..).take(count).collect()
}

/// The triangulation of a closed polygon in space with the least area (Barequet and Sharir 1995), by
/// dynamic programming over its chords.
pub(crate) fn least_area(corners: &[DVec3]) -> Vec<[u32; 3]> {
    let n = corners.len();
    let mut cost = vec![0.0_f64; n * n];
    let mut apex = vec![0_usize; n * n];
    for gap in 2..n {
        for i in 0..n - gap {
            let k = i + gap;
            let mut best = f64::INFINITY;
            for j in i + 1..k {
                let (p, q, r) = (corners[i], corners[j], corners[k]);
                let area = (q - p).cross(r - p).length() * 0.5;
                let longest = (q - p).length_squared().max((r - q).length_squared());
                let total = cost[i * n + j] + cost[j * n + k] + area + DIAGONAL_WEIGHT * longest;
                if total < best {
                    best = total;
                    apex[i * n + k] = j;
                }
            }
            cost[i * n + k] = best;
        }
    }
    let mut triangles = Vec::with_capacity(n.saturating_sub(2));
    let mut chords = vec![(0, n - 1)];
    while let Some((i, k)) = chords.pop() {
        if k - i >= 2 {
            let j = apex[i * n + k];
            triangles.push([i, j, k].map(|x| u32::try_from(x).unwrap_or(u32::MAX)));
            chords.push((j, k));
            chords.push((i, j));
        }
    }
    triangles
}

fn zigzag(n: usize) -> Vec<[u32; 3]> {
    let (mut low, mut high) = (0, n - 1);
    let mut triangles = Vec::with_capacity(n.saturating_sub(2));
    let mut from_low = true;
    while high - low >= 2 {
        let apex = if from_low { low + 1 } else { high - 1 };
        triangles.push([low, apex, high].map(|x| u32::try_from(x).unwrap_or(u32::MAX)));
        if from_low {
            low += 1
        } else {
            high -= 1
        }
        from_low = !from_low;
    }
    triangles
}

/// Which of two lines goes on next when they are zipped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Pace {
    /// The one whose next point is nearer to where the other is.
    Shortest,
    /// The one that is behind, in parts of its own number of points. Loops are never joined twice then.
    Even,
}

/// Zips two lines of points together, in general along the shorter of the two possible edges; the second begins at `start` (if
/// they are loops) and may be run through backwards. Lengths are measured after moving loops' centres together, so that a
/// leaning cylinder is not twisted.
fn zip(
    (low, high): (&[DVec3], &[DVec3]),
    (closed, pace): (bool, Pace),
    shift: DVec3,
    (start, reversed): (usize, bool),
) -> (f64, Vec<[u32; 3]>) {
    let (n, m) = (low.len(), high.len());
    let there = |k: usize| match (closed, reversed) {
        (true, true) => (start + m - k % m) % m,
        (true, false) => (start + k) % m,
        (false, true) => m - 1 - k,
        (false, false) => k,
    };
    let length = |a: usize, b: usize| (low[a % n] - high[there(b)] - shift).length_squared();
    let name = |a: usize| u32::try_from(a % n).unwrap_or(u32::MAX);
    let other = |b: usize| u32::try_from(n + there(b)).unwrap_or(u32::MAX);
    let (most_low, most_high) = if closed { (n, m) } else { (n - 1, m - 1) };
    let (mut a, mut b) = (0, 0);
    let mut cost = length(0, 0);
    let mut triangles = Vec::with_capacity(n + m);
    while a < most_low || b < most_high {
        // Asked only while both can go on: beyond the ends of open lines there is nothing to measure.
        let is_lows_turn = || match pace {
            Pace::Shortest => length(a + 1, b) <= length(a, b + 1),
            Pace::Even => (2 * a + 1) * most_high <= (2 * b + 1) * most_low,
        };
        let step_low = b >= most_high || (a < most_low && is_lows_turn());
        if step_low {
            triangles.push([name(a), name(a + 1), other(b)]);
            a += 1;
        } else {
            triangles.push([name(a), other(b + 1), other(b)]);
            b += 1;
        }
        cost += length(a, b);
    }
    (cost, triangles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ductile_mesh::summary;
    use glam::dvec3;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn polygon(n: usize, z: f64) -> Vec<(PointId, DVec3)> {
        let turn = core::f64::consts::TAU / n as f64;
        (0..n)
            .map(|k| {
                let (sin, cos) = (libm::sin(k as f64 * turn), libm::cos(k as f64 * turn));
                (PointId(u32::try_from(k).unwrap() + 1), dvec3(cos, sin, z))
            })
            .collect()
    }

    #[test]
    fn a_sheet_covers_a_concave_polygon_exactly() {
        // An L of area 3.
        let at = [(0., 0.), (2., 0.), (2., 1.), (1., 1.), (1., 2.), (0., 2.)].map(|(x, y)| dvec3(x, y, 0.0));
        let triangles = least_area(&at);
        assert_eq!(triangles.len(), 4);
        let area: f64 = triangles
            .iter()
            .map(|t| {
                let [p, q, r] = t.map(|i| at[i as usize]);
                (q - p).cross(r - p).length() * 0.5
            })
            .sum();
        assert!((area - 3.0).abs() < 1e-12, "area {area}");
        Mesh::from_triangles(6, &triangles).unwrap();
    }

    #[test]
    fn sheets_and_sweeps_are_discs_and_cylinders() {
        for n in 3..12 {
            let sheet = sheet_skeleton(&polygon(n, 0.0), Vec::new());
            assert_eq!(summary(&Mesh::from_triangles(n, &sheet.triangles).unwrap()).euler, 1);
            assert_eq!(summary(&Mesh::from_triangles(n, &zigzag(n)).unwrap()).euler, 1);
            for m in 3..9 {
                let sweep = sweep_skeleton(
                    (CurveId(1), &polygon(n, 0.0)),
                    (CurveId(2), &polygon(m, 1.0)),
                    true,
                    false,
                );
                let summary = summary(&Mesh::from_triangles(n + m, &sweep.triangles).unwrap());
                assert_eq!((summary.euler, summary.boundaries), (0, 2), "{n} to {m}");
            }
        }
    }

    #[test]
    fn a_sweep_between_open_lines_is_a_strip_either_way() {
        for (n, m) in [(2, 2), (2, 5), (6, 3), (4, 4)] {
            for other_way in [false, true] {
                let (low, high) = (polygon(n, 0.0), polygon(m, 1.0));
                let sweep = sweep_skeleton((CurveId(1), &low), (CurveId(2), &high), false, other_way);
                let summary = summary(&Mesh::from_triangles(n + m, &sweep.triangles).unwrap());
                assert_eq!((summary.euler, summary.boundaries), (1, 1), "{n} {m} {other_way}");
            }
        }
    }

    #[test]
    fn a_sweep_between_unlike_loops_joins_no_pair_twice() {
        // A small triangle beside one end of a long lobed loop: its nearest point is the same for most of the lobe.
        for (offset, stretch) in [(0.0, 1.0), (1.2, 1.0), (3.0, 2.0), (8.0, 3.0), (-5.0, 0.2)] {
            let low: Vec<_> =
                polygon(3, 0.4).iter().map(|(id, at)| (*id, *at * 0.4 + DVec3::X * offset)).collect();
            let lobe = |k: usize| if k.is_multiple_of(2) { 1.65 } else { 1.2 };
            let high: Vec<_> = polygon(6, 0.0)
                .iter()
                .enumerate()
                .map(|(k, (id, at))| (*id, dvec3(at.x * lobe(k) * stretch, at.y * lobe(k), 0.0)))
                .collect();
            for other_way in [false, true] {
                let sweep = sweep_skeleton((CurveId(1), &low), (CurveId(2), &high), true, other_way);
                let summary = summary(&Mesh::from_triangles(9, &sweep.triangles).unwrap());
                assert_eq!((summary.euler, summary.boundaries), (0, 2), "{offset} {stretch}");
            }
        }
    }

    #[test]
    fn a_sweep_to_a_curve_wound_the_other_way_is_not_twisted() {
        let low = polygon(6, 0.0);
        let mut high = polygon(6, 1.0);
        high.reverse();
        let sweep = sweep_skeleton((CurveId(1), &low), (CurveId(2), &high), true, false);
        let all: Vec<DVec3> = low.iter().chain(&high).map(|(_, at)| *at).collect();
        for t in &sweep.triangles {
            let [p, q, r] = t.map(|i| all[i as usize]);
            let longest = (q - p).length().max((r - q).length()).max((p - r).length());
            assert!(longest < 1.5, "an edge of {longest} crosses the cylinder");
        }
    }
}
