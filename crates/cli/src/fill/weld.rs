//! Tessellated patches as one mesh: sewn along the sides that they share, vertex by vertex, never by distance alone.
//!
//! Two sides are one when they run through the same points in opposite directions, or in the same one (then the patches
//! face different ways). Elevation and evaluation may differ in the last bits there; the mesh has one vertex all the same,
//! and one normal for each patch.

use ductile_patch::s_patch::{Tessellated, Tessellation};
use glam::DVec3;
use serde::Serialize;
use std::fmt::Write as _;

/// The tessellation of one patch.
pub(super) struct Piece {
    found: Tessellated,
    triangles: Vec<[usize; 3]>,
    /// The vertices along each side, both corners included.
    sides: Vec<Vec<usize>>,
}

/// A side of a piece among all vertices.
struct Rim {
    patch: usize,
    vertices: Vec<usize>,
}

/// All patches as one mesh.
pub(super) struct Welded {
    pieces: Vec<Piece>,
    /// For each vertex of each piece, one after the other, its number in the mesh.
    names: Vec<usize>,
    positions: Vec<DVec3>,
    sewn_sides: usize,
}

/// How much there is in a mesh.
#[derive(Serialize)]
pub(super) struct Counts {
    vertices: usize,
    triangles: usize,
    sewn_sides: usize,
}

/// How far apart points of one side may lie, as a share of the extent of all patches.
const CLOSE: f64 = 1e-9;

impl Piece {
    pub(super) fn new(grid: &Tessellation, sides: usize, found: Tessellated) -> Self {
        let side = |side| (0..=grid.resolution()).map(|step| grid.on_side(side, step)).collect();
        Self { found, triangles: grid.triangles(), sides: (0..sides).map(side).collect() }
    }
}

/// Sews pieces of one resolution.
pub(super) fn weld(pieces: Vec<Piece>) -> Welded {
    let starts: Vec<usize> = pieces
        .iter()
        .scan(0, |next, piece| {
            let start = *next;
            *next += piece.found.positions.len();
            Some(start)
        })
        .collect();
    let all: Vec<DVec3> = pieces.iter().flat_map(|piece| piece.found.positions.iter().copied()).collect();
    let low = all.iter().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = all.iter().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    let close = CLOSE * (high - low).length();
    let sides: Vec<Rim> = pieces
        .iter()
        .zip(&starts)
        .enumerate()
        .flat_map(|(patch, (piece, start))| {
            piece.sides.iter().map(move |vertices| Rim {
                patch,
                vertices: vertices.iter().map(|vertex| start + vertex).collect(),
            })
        })
        .collect();
    // Each vertex points to an earlier one that it is sewn to, or to itself.
    let mut same: Vec<usize> = (0..all.len()).collect();
    let mut sewn_sides = 0;
    let mut by_middle: Vec<(f64, usize)> =
        sides.iter().enumerate().map(|(at, rim)| (middle(&all, &rim.vertices), at)).collect();
    by_middle.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    for (at, &(key, one)) in by_middle.iter().enumerate() {
        for &(_, other) in by_middle[at + 1..].iter().take_while(|(next, _)| *next - key <= close) {
            let (one, other) = (&sides[one.min(other)], &sides[one.max(other)]);
            let meets = |(a, b): (&usize, &usize)| all[*a].distance(all[*b]) <= close;
            let (own, there) = (&one.vertices, &other.vertices);
            if one.patch == other.patch {
                continue;
            }
            if own.iter().zip(there.iter().rev()).all(meets) {
                own.iter().zip(there.iter().rev()).for_each(|(a, b)| join(&mut same, *a, *b));
            } else if own.iter().zip(there).all(meets) {
                own.iter().zip(there).for_each(|(a, b)| join(&mut same, *a, *b));
            } else {
                continue;
            }
            sewn_sides += 1;
        }
    }
    let (names, positions) = renumbered(&all, &same);
    Welded { pieces, names, positions, sewn_sides }
}

/// The vertices that are sewn to no earlier one, and for each vertex the number of the one that stands for it.
fn renumbered(all: &[DVec3], same: &[usize]) -> (Vec<usize>, Vec<DVec3>) {
    let (mut names, mut positions) = (vec![0; all.len()], Vec::new());
    for vertex in 0..all.len() {
        let first = root(same, vertex);
        if first == vertex {
            names[vertex] = positions.len();
            positions.push(all[vertex]);
        } else {
            names[vertex] = names[first];
        }
    }
    (names, positions)
}

/// How far the middle of a side lies in a direction that no model has: sides of which this differs are different.
fn middle(all: &[DVec3], side: &[usize]) -> f64 {
    let (first, last) = (all[side[(side.len() - 1) / 2]], all[side[side.len() / 2]]);
    (0.5 * (first + last)).dot(DVec3::new(0.359_127, 0.674_313, 0.645_219))
}

fn root(same: &[usize], mut vertex: usize) -> usize {
    while same[vertex] != vertex {
        vertex = same[vertex];
    }
    vertex
}

fn join(same: &mut [usize], a: usize, b: usize) {
    let (a, b) = (root(same, a), root(same, b));
    // The earlier one keeps its place; paths stay short, since a vertex is sewn at most once for each side at it.
    same[a.max(b)] = a.min(b);
}

impl Welded {
    pub(super) fn counts(&self) -> Counts {
        Counts {
            vertices: self.positions.len(),
            triangles: self.pieces.iter().map(|piece| piece.triangles.len()).sum(),
            sewn_sides: self.sewn_sides,
        }
    }

    /// An OBJ text with a group for each patch; numbers have as many digits as bring back the same `f64`.
    pub(super) fn to_obj(&self) -> String {
        let mut text = String::new();
        // Writing to a String cannot fail, so the results are dropped.
        for p in &self.positions {
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for n in self.pieces.iter().flat_map(|piece| &piece.found.normals) {
            let _ = writeln!(text, "vn {} {} {}", n.x, n.y, n.z);
        }
        let mut start = 0;
        for (at, piece) in self.pieces.iter().enumerate() {
            let _ = writeln!(text, "g patch_{at}");
            for corners in &piece.triangles {
                let [a, b, c] = corners.map(|corner| {
                    let vertex = start + corner;
                    format!("{}//{}", self.names[vertex] + 1, vertex + 1)
                });
                let _ = writeln!(text, "f {a} {b} {c}");
            }
            start += piece.found.positions.len();
        }
        text
    }
}
