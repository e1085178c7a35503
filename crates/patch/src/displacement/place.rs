//! Feet at any point of a surface: the nearest vertex, or a new vertex where the point lies.
//!
//! Source: the recipe, section 2. A triangle is cut into three; where the point lies on an edge, within a thousandth of
//! the triangle, the two triangles of the edge are cut into four instead, for three would leave a needle.

use super::error::DisplacementError;
use glam::DVec3;

/// Barycentric coordinates below this count as 0.
const NEAR: f64 = 1e-3;

/// Where a point was put.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// The vertex.
    pub vertex: usize,
    /// How far the vertex lies from the point, in units of the surface.
    pub distance: f64,
    /// Whether the vertex was made for it.
    pub is_new: bool,
}

/// Puts a point on the surface, at the nearest corner of the nearest triangle or, if `splits`, at a new vertex. New
/// vertices come last, and the others keep their indices.
///
/// # Errors
/// [`DisplacementError::BadPosition`] with the number of vertices, when the point is not finite or there are no triangles;
/// [`DisplacementError::NoVertex`] when a triangle names one that does not exist.
pub fn place(
    positions: &mut Vec<DVec3>,
    triangles: &mut Vec<[u32; 3]>,
    point: DVec3,
    splits: bool,
) -> Result<Placed, DisplacementError> {
    let count = positions.len();
    if let Some(&v) = triangles.as_flattened().iter().find(|&&v| v as usize >= count) {
        return Err(DisplacementError::NoVertex { vertex: v as usize, count });
    }
    let (index, shares) = nearest_of(positions, triangles, point)?;
    let triangle = triangles[index];
    let corners = triangle.map(|v| positions[v as usize]);
    let corner = (0..3).fold(0, |a, b| if shares[b] > shares[a] { b } else { a });
    let far: Vec<usize> = (0..3).filter(|&k| shares[k] >= NEAR).collect();
    if !splits || far.len() == 1 {
        let near = if splits { corner } else { closest_corner(corners, point) };
        let vertex = triangle[near] as usize;
        return Ok(Placed { vertex, distance: corners[near].distance(point), is_new: false });
    }
    let new = u32::try_from(count).map_err(|_| DisplacementError::TooLarge)?;
    let position = match far[..] {
        [a, b] => {
            let sum = shares[a] + shares[b];
            split_edge(triangles, [triangle[a], triangle[b]], new);
            (corners[a] * shares[a] + corners[b] * shares[b]) / sum
        }
        _ => {
            let [a, b, c] = triangle;
            triangles[index] = [a, b, new];
            triangles.extend([[b, c, new], [c, a, new]]);
            at(corners, shares)
        }
    };
    positions.push(position);
    Ok(Placed { vertex: count, distance: position.distance(point), is_new: true })
}

/// The place of a surface nearest to a point: corners of its triangle and barycentric coordinates, which sum to 1.
///
/// # Errors
/// As [`place`].
pub fn nearest_spot(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    point: DVec3,
) -> Result<([u32; 3], [f64; 3]), DisplacementError> {
    let count = positions.len();
    if let Some(&v) = triangles.as_flattened().iter().find(|&&v| v as usize >= count) {
        return Err(DisplacementError::NoVertex { vertex: v as usize, count });
    }
    let (index, shares) = nearest_of(positions, triangles, point)?;
    Ok((triangles[index], shares))
}

/// The nearest triangle and the coordinates in it; all corners exist.
fn nearest_of(
    positions: &[DVec3],
    triangles: &[[u32; 3]],
    point: DVec3,
) -> Result<(usize, [f64; 3]), DisplacementError> {
    let mut best: Option<(f64, usize, [f64; 3])> = None;
    for (index, triangle) in triangles.iter().enumerate() {
        let corners = triangle.map(|v| positions[v as usize]);
        let shares = nearest(corners, point);
        let distance = at(corners, shares).distance(point);
        if best.is_none_or(|(least, ..)| distance < least) {
            best = Some((distance, index, shares));
        }
    }
    let best = best.filter(|(distance, ..)| distance.is_finite());
    best.map(|(_, index, shares)| (index, shares)).ok_or(DisplacementError::BadPosition(positions.len()))
}

/// Cuts the triangles of an edge in two.
fn split_edge(triangles: &mut Vec<[u32; 3]>, edge: [u32; 2], new: u32) {
    for index in 0..triangles.len() {
        if edge.iter().all(|end| triangles[index].contains(end)) {
            let old = triangles[index];
            let with = |replaced: u32| old.map(|v| if v == replaced { new } else { v });
            triangles[index] = with(edge[0]);
            triangles.push(with(edge[1]));
        }
    }
}

fn at(corners: [DVec3; 3], shares: [f64; 3]) -> DVec3 {
    corners[0] * shares[0] + corners[1] * shares[1] + corners[2] * shares[2]
}

fn closest_corner(corners: [DVec3; 3], point: DVec3) -> usize {
    (0..3).fold(0, |a, b| if corners[b].distance(point) < corners[a].distance(point) { b } else { a })
}

/// Barycentric coordinates of the point of a triangle nearest to a point (Ericson, *Real-Time Collision Detection*,
/// section 5.1.5), flat triangles by their sides.
fn nearest([a, b, c]: [DVec3; 3], point: DVec3) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let normal = ab.cross(ac);
    let size = normal.length_squared();
    let (y, z) = (ap.cross(ac).dot(normal) / size, ab.cross(ap).dot(normal) / size);
    if y >= 0.0 && z >= 0.0 && y + z <= 1.0 {
        return [1.0 - y - z, y, z];
    }
    let along = |from: DVec3, to: DVec3| {
        let share = (point - from).dot(to - from) / (to - from).length_squared();
        if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) }
    };
    let (ab, bc, ca) = (along(a, b), along(b, c), along(c, a));
    let sides = [[1.0 - ab, ab, 0.0], [0.0, 1.0 - bc, bc], [ca, 0.0, 1.0 - ca]];
    let distance = |shares: [f64; 3]| at([a, b, c], shares).distance_squared(point);
    sides.into_iter().reduce(|x, y| if distance(y) < distance(x) { y } else { x }).unwrap_or(sides[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::displacement::Domain;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    fn square() -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        (corners.into(), vec![[0, 1, 2], [0, 2, 3]])
    }

    #[test]
    fn snaps_to_the_nearest_corner() {
        let (mut positions, mut triangles) = square();
        let placed = place(&mut positions, &mut triangles, DVec3::new(0.9, 0.2, 0.3), false).unwrap();
        assert_eq!((placed.vertex, placed.is_new, triangles.len()), (1, false, 2));
        assert!((placed.distance - libm::sqrt(0.14)).abs() < 1e-15);
    }

    #[test]
    fn splits_triangles_edges_and_nothing() {
        for (point, faces, vertex) in [
            (DVec3::new(0.75, 0.25, 0.1), 4, 4),
            (DVec3::new(0.5, 0.5, 0.0), 4, 4),
            (DVec3::new(0.5, -1.0, 0.0), 3, 4),
            (DVec3::new(2.0, 2.0, 0.0), 2, 2),
        ] {
            let (mut positions, mut triangles) = square();
            let placed = place(&mut positions, &mut triangles, point, true).unwrap();
            assert_eq!((placed.vertex, triangles.len()), (vertex, faces), "{point}");
            let domain = Domain::new(&positions, &triangles).unwrap();
            assert_eq!(domain.held().iter().filter(|held| !**held).count(), usize::from(faces == 4));
            let area: f64 = triangles
                .iter()
                .map(|t| {
                    let [a, b, c] = t.map(|v| positions[v as usize]);
                    let twice = (b - a).cross(c - a).z;
                    assert!(twice > 0.0, "{point}: turned over");
                    0.5 * twice
                })
                .sum();
            assert!((area - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn refuses_what_has_no_place() {
        let (mut positions, mut triangles) = square();
        let nan = place(&mut positions, &mut triangles, DVec3::NAN, true);
        assert_eq!(nan.unwrap_err(), DisplacementError::BadPosition(4));
        assert!(place(&mut positions, &mut Vec::new(), DVec3::ZERO, true).is_err());
        assert!(place(&mut positions, &mut vec![[0, 1, 9]], DVec3::ZERO, true).is_err());
    }
}
