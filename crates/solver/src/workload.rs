//! Meshes and runs for benches and tests; not meant for a modeler.
//!
//! Everything is made by formula, so that a bench, a test and another machine see the same bits.

use glam::DVec3;

use crate::{Budget, Rings, Settings, SolverError, StepReport, SurfaceSolver};

/// Triangles, positions and fixed nodes of one shape.
#[derive(Clone, Debug)]
pub struct Workload {
    /// Where the nodes are.
    pub positions: Vec<DVec3>,
    /// Counter-clockwise seen from outside (or from +z).
    pub triangles: Vec<[u32; 3]>,
    /// Which nodes hold still.
    pub fixed: Vec<bool>,
}

impl Workload {
    /// A solver for this shape.
    pub fn solver(&self) -> Result<SurfaceSolver, SolverError> {
        let rings = Rings::from_triangles(self.positions.len(), &self.triangles)?;
        SurfaceSolver::new(rings, self.fixed.clone(), Settings::default())
    }
}

/// A deterministic stream of numbers in [0, 1), for jitter and storms.
#[derive(Clone, Debug)]
pub struct Stream(u64);

impl Stream {
    /// Starts a stream.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number (splitmix64).
    pub fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut x = self.0;
        x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        x ^= x >> 31;
        (x >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A vector with entries in [-1, 1).
    pub fn vector(&mut self) -> DVec3 {
        let mut entry = || 2.0 * self.unit() - 1.0;
        let (x, y, z) = (entry(), entry(), entry());
        DVec3::new(x, y, z)
    }
}

/// Unit disc of concentric rings, ring `k` with `6 k` nodes; rim and centre (node 0) fixed.
#[expect(clippy::cast_possible_truncation, reason = "meshes of a bench are small")]
pub fn disc(rings: usize) -> Workload {
    let mut positions = vec![DVec3::ZERO];
    let mut starts = vec![0_u32];
    for ring in 1..=rings {
        starts.push(positions.len() as u32);
        let radius = ring as f64 / rings as f64;
        for step in 0..6 * ring {
            let (sin, cos) = libm::sincos(std::f64::consts::TAU * step as f64 / (6 * ring) as f64);
            positions.push(DVec3::new(radius * cos, radius * sin, 0.0));
        }
    }
    let mut triangles = Vec::new();
    for ring in 1..=rings as u32 {
        let (inner_count, outer_count) = ((6 * (ring - 1)).max(1), 6 * ring);
        let (inner_start, outer_start) = (starts[ring as usize - 1], starts[ring as usize]);
        for sector in 0..6 {
            for step in 0..ring {
                let inner = |k: u32| inner_start + (sector * (ring - 1) + k) % inner_count;
                let outer = |k: u32| outer_start + (sector * ring + k) % outer_count;
                triangles.push([inner(step), outer(step), outer(step + 1)]);
                if step + 1 < ring {
                    triangles.push([inner(step), outer(step + 1), inner(step + 1)]);
                }
            }
        }
    }
    let rim = *starts.last().unwrap_or(&0) as usize;
    let fixed = (0..positions.len()).map(|node| node == 0 || node >= rim).collect();
    Workload { positions, triangles, fixed }
}

/// Unit sphere from a subdivided icosahedron (`10 · 4^levels + 2` nodes), nothing fixed.
pub fn sphere(levels: u32) -> Workload {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    let mut positions = Vec::new();
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        positions.push(DVec3::new(a, b, 0.0));
    }
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        positions.push(DVec3::new(0.0, a, b));
    }
    for (a, b) in [(-1.0, golden), (1.0, golden), (-1.0, -golden), (1.0, -golden)] {
        positions.push(DVec3::new(b, 0.0, a));
    }
    #[rustfmt::skip]
    let mut triangles: Vec<[u32; 3]> = vec![
        [0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2], [10, 7, 6],
        [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
        [8, 6, 7], [9, 8, 1],
    ];
    for level in 0..=levels {
        if level > 0 {
            triangles = subdivide(&mut positions, &triangles);
        }
        for position in &mut positions {
            *position = position.try_normalize().unwrap_or(DVec3::Z);
        }
    }
    let fixed = vec![false; positions.len()];
    Workload { positions, triangles, fixed }
}

/// Splits every triangle into four.
#[expect(clippy::cast_possible_truncation, reason = "meshes of a bench are small")]
fn subdivide(positions: &mut Vec<DVec3>, triangles: &[[u32; 3]]) -> Vec<[u32; 3]> {
    let mut middles = std::collections::BTreeMap::new();
    let mut fine = Vec::with_capacity(triangles.len() * 4);
    for &[a, b, c] in triangles {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(x, y)| {
            *middles.entry((x.min(y), x.max(y))).or_insert_with(|| {
                positions.push(0.5 * (positions[x as usize] + positions[y as usize]));
                positions.len() as u32 - 1
            })
        });
        fine.extend([[a, ab, ca], [b, bc, ab], [c, ca, bc], [ab, bc, ca]]);
    }
    fine
}

/// Fixes the nodes nearest to the six points (±1, 0, 0), (0, ±1, 0), (0, 0, ±1) of a closed shape.
pub fn pin_axes(shape: &mut Workload) -> [u32; 6] {
    let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
    axes.map(|axis| {
        let (mut best, mut nearest) = (0, f64::INFINITY);
        for (node, position) in (0_u32..).zip(&shape.positions) {
            let distance = position.distance_squared(axis);
            if distance < nearest {
                (best, nearest) = (node, distance);
            }
        }
        shape.fixed[best as usize] = true;
        shape.positions[best as usize] = axis;
        best
    })
}

/// A torus around the z axis on a staggered grid, nothing fixed.
pub fn torus(around: u32, across: u32, major: f64, minor: f64) -> Workload {
    let shape = |i: u32, j: u32| {
        let turn = std::f64::consts::TAU;
        let (sin_u, cos_u) = libm::sincos(turn * (f64::from(i) + 0.5 * f64::from(j)) / f64::from(around));
        let (sin_v, cos_v) = libm::sincos(turn * f64::from(j) / f64::from(across));
        let radius = major + minor * cos_v;
        DVec3::new(radius * cos_u, radius * sin_u, minor * sin_v)
    };
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    for j in 0..across {
        for i in 0..around {
            positions.push(shape(i, j));
            // The last row meets the first one shifted by half the rows.
            let shift = if j + 1 == across { across / 2 } else { 0 };
            let at = |i: u32, j: u32| (j % across) * around + i % around;
            let up = |i: u32| at(i + shift, j + 1);
            triangles.push([at(i, j), at(i + 1, j), up(i)]);
            triangles.push([at(i + 1, j), up(i + 1), up(i)]);
        }
    }
    let fixed = vec![false; positions.len()];
    Workload { positions, triangles, fixed }
}

/// A tube of radius 1 along z between two fixed circles, on a staggered grid.
pub fn cylinder(around: u32, along: u32, length: f64) -> Workload {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut fixed = Vec::new();
    for j in 0..=along {
        for i in 0..around {
            let turn = std::f64::consts::TAU * (f64::from(i) + 0.5 * f64::from(j)) / f64::from(around);
            let (sin, cos) = libm::sincos(turn);
            positions.push(DVec3::new(cos, sin, length * (f64::from(j) / f64::from(along) - 0.5)));
            fixed.push(j == 0 || j == along);
            if j < along {
                let at = |i: u32, j: u32| j * around + i % around;
                triangles.push([at(i, j), at(i + 1, j), at(i, j + 1)]);
                triangles.push([at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    Workload { positions, triangles, fixed }
}

/// A tube of radius 1 with fixed circles of so many nodes each: `bays + 1` of them, `along` rows apart.
pub fn tube_of_bays(around: u32, bays: u32, along: u32) -> Workload {
    let rows = bays * along;
    // Triangles of even sides.
    let height = std::f64::consts::TAU / f64::from(around) * 0.75_f64.sqrt();
    let mut tube = cylinder(around, rows, height * f64::from(rows));
    for (row, nodes) in (0..=rows).zip(tube.fixed.chunks_exact_mut(around as usize)) {
        nodes.fill(row.is_multiple_of(along));
    }
    tube
}

/// A Möbius strip of the given half width around the unit circle; the nodes of its one boundary are fixed.
pub fn moebius(around: u32, across: u32, half_width: f64) -> Workload {
    let mut positions = Vec::new();
    let mut triangles = Vec::new();
    let mut fixed = Vec::new();
    for i in 0..around {
        let turn = std::f64::consts::TAU * f64::from(i) / f64::from(around);
        let (sin, cos) = libm::sincos(turn);
        let (half_sin, half_cos) = libm::sincos(0.5 * turn);
        for j in 0..=across {
            let t = half_width * (2.0 * f64::from(j) / f64::from(across) - 1.0);
            positions.push(DVec3::new((1.0 + t * half_cos) * cos, (1.0 + t * half_cos) * sin, t * half_sin));
            fixed.push(j == 0 || j == across);
            if j < across {
                // The last column meets the first one upside down.
                let at = |i: u32, j: u32| if i == around { across - j } else { i * (across + 1) + j };
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                if (i + j) % 2 == 0 {
                    triangles.extend([[a, b, c], [a, c, d]]);
                } else {
                    triangles.extend([[a, b, d], [b, c, d]]);
                }
            }
        }
    }
    Workload { positions, triangles, fixed }
}

/// The raised disc of the benches, ready for its next step: `raise` of the centre is carried by the predictor.
pub fn raised_disc(rings: usize, raise: f64) -> Result<(SurfaceSolver, Vec<DVec3>), SolverError> {
    let shape = disc(rings);
    let mut solver = shape.solver()?;
    let mut positions = shape.positions;
    carry(&mut solver, &mut positions, 0, DVec3::Z * raise)?;
    Ok((solver, positions))
}

/// The closed surface of the benches: a sphere on six pins, one of them pulled out.
pub fn pulled_sphere(levels: u32, pull: f64) -> Result<(SurfaceSolver, Vec<DVec3>), SolverError> {
    let mut shape = sphere(levels);
    let pins = pin_axes(&mut shape);
    let mut solver = shape.solver()?;
    let mut positions = shape.positions;
    carry(&mut solver, &mut positions, pins[4], DVec3::Z * pull)?;
    Ok((solver, positions))
}

/// Moves one fixed node all the way, with a step after every partial move.
pub fn carry(
    solver: &mut SurfaceSolver,
    positions: &mut [DVec3],
    node: u32,
    displacement: DVec3,
) -> Result<(), SolverError> {
    let mut rest = displacement;
    for _ in 0..64 {
        let done = solver.predict(positions, &[(node, rest)])?.fraction;
        rest *= 1.0 - done;
        if done >= 1.0 {
            break;
        }
        solver.step(positions, Budget::default())?;
    }
    Ok(())
}

/// Steps until rest, at most `limit` times; every report.
pub fn relax(
    solver: &mut SurfaceSolver,
    positions: &mut [DVec3],
    limit: usize,
) -> Result<Vec<StepReport>, SolverError> {
    let mut reports = Vec::new();
    for _ in 0..limit {
        let report = solver.step(positions, Budget::default())?;
        reports.push(report);
        if report.at_rest {
            break;
        }
    }
    Ok(reports)
}
