//! Skins over given boundaries: a sheet over one loop, a cylinder between two.
//!
//! Both are stacks of loops. Neighbouring loops of `m` and `n` points are joined by `m + n` triangles,
//! going round by whichever loop lags behind:
//!
//! ```text
//!      n = 4   •────────•────────•────────•────────•
//!              │╲      ╱ ╲      ╱│╲      ╱ ╲      ╱│
//!      m = 3   •───╲──•───────╲──•────╱──────•─────•
//! ```

use glam::DVec3;
use thiserror::Error;

use super::{built, number};
use crate::Mesh;

/// Why there is no skin over the given loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PrimitiveError {
    /// A loop needs three points, as in `sheet(&[a, b], 1)`. Add points to it.
    #[error("a loop of {0} points bounds no surface; it needs three")]
    LoopTooShort(usize),
    /// A position is infinite or not a number.
    #[error("point {0} of the loop is not finite")]
    NotFinite(usize),
}

/// How many rings make the triangles of a sheet over `n` boundary points nearly equilateral: a disc of
/// hexagons with `r` rings has 6 r points on its rim.
#[must_use]
pub const fn natural_rings(n: usize) -> usize {
    let rings = (n + 3) / 6;
    if rings == 0 { 1 } else { rings }
}

/// A disc bounded by the closed polygon `boundary`, whose points become vertices `0..n`, counter-clockwise.
///
/// `rings` loops of fewer and fewer points lie inside, the last being a single centre vertex, spaced
/// evenly between the boundary and its centroid; see [`natural_rings`]. With `rings = 0` the boundary
/// itself is triangulated without inner vertices.
///
/// # Errors
/// The boundary has less than three points, or one is not finite.
pub fn sheet(boundary: &[DVec3], rings: usize) -> Result<(Mesh, Vec<DVec3>), PrimitiveError> {
    check_loop(boundary)?;
    let n = boundary.len();
    let mut positions = boundary.to_vec();
    let mut triangles = Vec::new();
    if rings == 0 {
        strip_of_ears(n, &mut triangles);
        return Ok(built(&triangles, positions));
    }
    let centre = boundary.iter().sum::<DVec3>() / real(n);
    let mut outer = (0, n);
    for ring in (1..rings).rev() {
        let count = ((n * ring + rings / 2) / rings).max(3);
        let share = real(ring) / real(rings);
        let inner = (positions.len(), count);
        positions.extend((0..count).map(|i| centre + share * (along(boundary, i, count) - centre)));
        zip_loops(inner, outer, &mut triangles);
        outer = inner;
    }
    let hub = number(positions.len());
    positions.push(centre);
    let (first, count) = outer;
    triangles.extend((0..count).map(|i| [number(first + i), number(first + (i + 1) % count), hub]));
    Ok(built(&triangles, positions))
}

/// A skin between two closed polygons: `bottom` gives vertices `0..m`, `top` the next `n`; then come
/// `rows` loops between, evenly spaced, from bottom to top. The loops must run the same way round, and
/// their first points should face each other; counter-clockwise loops seen from the top give faces wound
/// outwards.
///
/// # Errors
/// A loop has less than three points, or one is not finite.
pub fn cylinder(bottom: &[DVec3], top: &[DVec3], rows: usize) -> Result<(Mesh, Vec<DVec3>), PrimitiveError> {
    check_loop(bottom)?;
    check_loop(top)?;
    let (m, n) = (bottom.len(), top.len());
    let mut positions = [bottom, top].concat();
    let mut triangles = Vec::new();
    let mut below = (0, m);
    for row in 1..=rows {
        let share = real(row) / real(rows + 1);
        let count = (m * (rows + 1 - row) + n * row + rows.div_ceil(2)) / (rows + 1);
        let here = (positions.len(), count.max(3));
        positions.extend((0..here.1).map(|i| along(bottom, i, here.1).lerp(along(top, i, here.1), share)));
        zip_loops(here, below, &mut triangles);
        below = here;
    }
    zip_loops((m, n), below, &mut triangles);
    Ok(built(&triangles, positions))
}

fn check_loop(points: &[DVec3]) -> Result<(), PrimitiveError> {
    if points.len() < 3 {
        return Err(PrimitiveError::LoopTooShort(points.len()));
    }
    points.iter().position(|p| !p.is_finite()).map_or(Ok(()), |i| Err(PrimitiveError::NotFinite(i)))
}

#[expect(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
const fn real(n: usize) -> f64 {
    n as f64
}

/// The point `i / count` of the way round a closed polygon, its sides counted as equally long.
fn along(points: &[DVec3], i: usize, count: usize) -> DVec3 {
    let (whole, rest) = (i * points.len() / count, i * points.len() % count);
    let next = points[(whole + 1) % points.len()];
    points[whole % points.len()].lerp(next, real(rest) / real(count))
}

/// Joins two loops, given as (first vertex, count); `outer` runs counter-clockwise around `inner`.
///
/// With at least three points on each, no two points are joined twice.
fn zip_loops(inner: (usize, usize), outer: (usize, usize), triangles: &mut Vec<[u32; 3]>) {
    let at = |(first, count): (usize, usize), i: usize| number(first + i % count);
    let (m, n) = (inner.1, outer.1);
    let (mut i, mut j) = (0, 0);
    while i < m || j < n {
        // Go on with the loop whose next side has its middle first.
        if j < n && (i == m || (2 * j + 1) * m <= (2 * i + 1) * n) {
            triangles.push([at(outer, j), at(outer, j + 1), at(inner, i)]);
            j += 1;
        } else {
            triangles.push([at(outer, j), at(inner, i + 1), at(inner, i)]);
            i += 1;
        }
    }
}

/// Triangulates the polygon `0..n` in a zigzag, so that no vertex gathers many triangles.
fn strip_of_ears(n: usize, triangles: &mut Vec<[u32; 3]>) {
    let (mut low, mut high) = (0, n - 1);
    while high - low > 1 {
        triangles.push([low, low + 1, high].map(number));
        low += 1;
        if high - low > 1 {
            triangles.push([low, high - 1, high].map(number));
            high -= 1;
        }
    }
}
