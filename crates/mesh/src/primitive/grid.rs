//! Surfaces that are one rectangle of squares, its sides glued or left open.
//!
//! ```text
//!            row wraps, or not
//!      j   ┌──┬──┬──┬──┐
//!      ↑   │╱ │╱ │╱ │╱ │  column i meets column i + columns:
//!      │   ├──┼──┼──┼──┤  as it is (cylinder, torus) or upside down (Möbius, Klein);
//!      │   │╱ │╱ │╱ │╱ │  then the windings clash along that seam
//!      └─→ └──┴──┴──┴──┘
//!        i
//! ```

use core::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::{built, number};
use crate::Mesh;

/// How the grid's opposite sides meet.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Seam {
    Open,
    Straight,
    Turned,
}

/// Positions and triangles of a grid of `columns` × `rows` squares; `at(i, j)` places grid point (i, j).
fn grid(
    columns: usize,
    rows: usize,
    seam: Seam,
    rows_wrap: bool,
    at: impl Fn(usize, usize) -> DVec3,
) -> (Mesh, Vec<DVec3>) {
    let height = if rows_wrap { rows } else { rows + 1 };
    let width = if seam == Seam::Open { columns + 1 } else { columns };
    let point = |i: usize, j: usize| {
        let j = if rows_wrap { j % rows } else { j };
        match seam {
            Seam::Turned if i >= columns => number((rows - j) % if rows_wrap { rows } else { rows + 1 }),
            _ => number((i % width) * height + j),
        }
    };
    let mut triangles = Vec::with_capacity(2 * columns * rows);
    for i in 0..columns {
        for j in 0..rows {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    let positions =
        (0..width).flat_map(|i| (0..height).map(move |j| (i, j))).map(|(i, j)| at(i, j)).collect();
    built(&triangles, positions)
}

/// `i / n`.
#[expect(clippy::cast_precision_loss, reason = "grid sizes are far below 2^52")]
fn part(i: usize, n: usize) -> f64 {
    i as f64 / n as f64
}

/// cos and sin of `turns` full turns.
fn on_circle(turns: f64) -> DVec2 {
    DVec2::new(libm::cos(TAU * turns), libm::sin(TAU * turns))
}

/// A flat rectangle in the xy plane, corner at the origin, of `columns` × `rows` squares (at least one
/// each) of side `spacing`.
#[must_use]
pub fn plane(columns: usize, rows: usize, spacing: f64) -> (Mesh, Vec<DVec3>) {
    let (columns, rows) = (columns.max(1), rows.max(1));
    grid(columns, rows, Seam::Open, false, |i, j| DVec3::new(part(i, 1) * spacing, part(j, 1) * spacing, 0.0))
}

/// A torus around the z axis: `columns` around the axis, `rows` around the tube (at least three each).
#[must_use]
pub fn torus(columns: usize, rows: usize, ring_radius: f64, tube_radius: f64) -> (Mesh, Vec<DVec3>) {
    let (columns, rows) = (columns.max(3), rows.max(3));
    grid(columns, rows, Seam::Straight, true, |i, j| {
        let (around, tube) = (on_circle(part(i, columns)), on_circle(part(j, rows)));
        let flat = around * (ring_radius + tube_radius * tube.x);
        flat.extend(tube_radius * tube.y)
    })
}

/// A Möbius strip around the z axis: `columns` (at least five) around and `rows` (at least one) across,
/// with half a turn. The windings clash along one seam: the strip has but one side.
#[must_use]
pub fn moebius(columns: usize, rows: usize, radius: f64, width: f64) -> (Mesh, Vec<DVec3>) {
    let (columns, rows) = (columns.max(5), rows.max(1));
    grid(columns, rows, Seam::Turned, false, |i, j| {
        let turns = part(i, columns);
        let (around, half) = (on_circle(turns), on_circle(0.5 * turns));
        let across = (part(j, rows) - 0.5) * width;
        (around * (radius + across * half.x)).extend(across * half.y)
    })
}

/// A Klein bottle as a figure eight that makes half a turn while it goes around the z axis; it passes
/// through itself, which connectivity does not notice. At least five `columns` around, five `rows` across.
#[must_use]
pub fn klein_bottle(columns: usize, rows: usize, ring_radius: f64, tube_radius: f64) -> (Mesh, Vec<DVec3>) {
    let (columns, rows) = (columns.max(5), rows.max(5));
    grid(columns, rows, Seam::Turned, true, |i, j| {
        let (around, half) = (on_circle(part(i, columns)), on_circle(0.5 * part(i, columns)));
        let (once, twice) = (on_circle(part(j, rows)).y, on_circle(2.0 * part(j, rows)).y);
        let out = ring_radius + tube_radius * (half.x * once - half.y * twice);
        (around * out).extend(tube_radius * (half.y * once + half.x * twice))
    })
}
