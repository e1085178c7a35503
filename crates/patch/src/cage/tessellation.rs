//! Fast tessellation: positions and normals on a grid of every quad, from tables of weights.
//!
//! In a tessellation with `R` steps the local parameters of all four corners are nodes of one grid, so a vertex of the result is a
//! fixed sparse combination of vertices of the quads, and so are its two derivatives. Quads that look alike (the same valences
//! round the same corners, in the same order) share one table, see `pattern.rs`; what is left per vertex are dot products. When a
//! vertex of the cage moves, only quads whose combinations it enters are evaluated again.
//!
//! Samples on shared edges and corners belong to the first quad that has them, by edge and index and never by position: the
//! result is watertight by construction. The order is: used vertices, then `R - 1` samples for each edge, then `(R - 1)²` for
//! each quad.

use super::error::CageError;
use super::links::name;
use super::pattern::{LANES, Pattern, Tables};
use super::surface::CageSurface;
use glam::DVec3;
use std::sync::Arc;
use wide::f64x2;

/// Most samples of a tessellation.
const MOST_SAMPLES: usize = 1 << 26;

/// Samples of one quad that lie one after the other in the result and in the table.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// Their block in the table.
    block: u32,
    /// First sample.
    sample: u32,
    count: u32,
}

/// What a tessellation keeps as long as its cage has the same faces; clones share it.
#[derive(Debug)]
struct Fixed {
    resolution: usize,
    patterns: Vec<Pattern>,
    /// For each quad its pattern.
    pattern_of: Vec<u32>,
    /// For each quad where its vertices begin; they stand in the order of the pattern.
    first_slot: Vec<u32>,
    slots: Vec<u32>,
    /// For each quad where its runs begin.
    first_run: Vec<u32>,
    runs: Vec<Run>,
    /// All quads, those with the same pattern one after the other: a table is read from memory once, not for each quad.
    order: Vec<u32>,
    /// For each vertex of the quads, the quads that it enters.
    first_user: Vec<u32>,
    users: Vec<u32>,
    triangles: Vec<[u32; 3]>,
}

/// A triangulated surface over a cage, with its normals, that follows the cage. Clones share the tables.
#[derive(Clone, Debug)]
pub struct Tessellation {
    fixed: Arc<Fixed>,
    positions: Vec<DVec3>,
    normals: Vec<DVec3>,
    /// Batch in which each quad was last evaluated.
    stamp: Vec<u32>,
    batch: u32,
}

impl Tessellation {
    /// Tables for a surface with so many steps along every edge, 1 to 256, and the first evaluation.
    ///
    /// # Errors
    /// [`CageError::Resolution`], and [`CageError::TooLarge`] when the tables or the result would not fit into reasonable memory.
    pub fn new(surface: &CageSurface, resolution: usize) -> Result<Self, CageError> {
        if !(1..=256).contains(&resolution) {
            return Err(CageError::Resolution(resolution));
        }
        let samples = surface.quads().len().saturating_mul(resolution * resolution);
        if samples > MOST_SAMPLES {
            return Err(CageError::TooLarge(samples));
        }
        let mut tables = Tables::new(resolution);
        let (mut pattern_of, mut first_slot, mut slots) = (Vec::new(), vec![0], Vec::new());
        for quad in 0..surface.quads().len() {
            let (pattern, vertices) = tables.pattern_of(surface, quad)?;
            pattern_of.push(name(pattern));
            slots.extend(vertices);
            first_slot.push(name(slots.len()));
        }
        let (first_user, users) = inverse(surface.positions().len(), &first_slot, &slots);
        let layout = Layout::new(surface, resolution);
        let (first_run, runs) = layout.runs(surface);
        let triangles = layout.triangles(surface);
        let stamp = vec![0; pattern_of.len()];
        let mut order: Vec<u32> = (0..name(pattern_of.len())).collect();
        order.sort_by_key(|&quad| pattern_of[quad as usize]);
        let fixed = Fixed {
            resolution,
            patterns: tables.into_patterns(),
            pattern_of,
            first_slot,
            slots,
            first_run,
            runs,
            order,
            first_user,
            users,
            triangles,
        };
        let [positions, normals] = [(); 2].map(|()| vec![DVec3::ZERO; layout.count]);
        let mut tessellation = Self { fixed: Arc::new(fixed), positions, normals, stamp, batch: 0 };
        tessellation.evaluate(surface.positions());
        Ok(tessellation)
    }

    /// Steps along every edge.
    #[must_use]
    pub fn resolution(&self) -> usize {
        self.fixed.resolution
    }

    /// Rough size in memory of the tables that clones share, and of the rest, in bytes.
    #[must_use]
    pub fn bytes(&self) -> (usize, usize) {
        let numbers: usize = self.fixed.patterns.iter().map(Pattern::number_count).sum();
        let names = self.fixed.slots.len() + self.fixed.users.len() + 3 * self.fixed.triangles.len();
        (
            8 * numbers + 4 * names + 12 * self.fixed.runs.len(),
            48 * self.positions.len() + 4 * self.stamp.len(),
        )
    }

    /// Positions of all samples.
    #[must_use]
    pub fn positions(&self) -> &[DVec3] {
        &self.positions
    }

    /// Unit normals of all samples; zero where the surface has no tangent plane.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        &self.normals
    }

    /// Triangles, counter-clockwise as the faces of the cage are.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.fixed.triangles
    }

    /// Evaluates all samples from the positions of the vertices of the quads ([`CageSurface::positions`]).
    ///
    /// # Panics
    /// When there are not as many positions as the surface had.
    pub fn evaluate(&mut self, vertices: &[DVec3]) {
        let fixed = Arc::clone(&self.fixed);
        assert_eq!(vertices.len() + 1, fixed.first_user.len(), "one position for each vertex of the quads");
        self.evaluate_quads(&fixed, &fixed.order, vertices);
    }

    /// Evaluates what the moved vertices enter, and says how many samples that were. `moved` is what [`CageSurface::move_to`] says.
    ///
    /// # Panics
    /// As [`Self::evaluate`], and for a vertex that does not exist.
    pub fn update(&mut self, vertices: &[DVec3], moved: &[u32]) -> usize {
        let fixed = Arc::clone(&self.fixed);
        assert_eq!(vertices.len() + 1, fixed.first_user.len(), "one position for each vertex of the quads");
        self.batch = self.batch.wrapping_add(1);
        let mut touched = Vec::new();
        for &vertex in moved {
            let vertex = vertex as usize;
            for &quad in
                &fixed.users[fixed.first_user[vertex] as usize..fixed.first_user[vertex + 1] as usize]
            {
                let stamp = &mut self.stamp[quad as usize];
                if *stamp != self.batch {
                    *stamp = self.batch;
                    touched.push(quad);
                }
            }
        }
        touched.sort_unstable_by_key(|&quad| (fixed.pattern_of[quad as usize], quad));
        self.evaluate_quads(&fixed, &touched, vertices)
    }

    /// Evaluates the samples that belong to these quads, and says how many they are.
    fn evaluate_quads(&mut self, fixed: &Fixed, quads: &[u32], vertices: &[DVec3]) -> usize {
        let mut evaluated = 0;
        let mut entering = Vec::new();
        for &quad in quads {
            let quad = quad as usize;
            let pattern = &fixed.patterns[fixed.pattern_of[quad] as usize];
            let slots = &fixed.slots[fixed.first_slot[quad] as usize..fixed.first_slot[quad + 1] as usize];
            let runs = &fixed.runs[fixed.first_run[quad] as usize..fixed.first_run[quad + 1] as usize];
            for run in runs {
                let block = pattern.block(run.block);
                entering.clear();
                entering.extend(block.slots.iter().map(|&slot| vertices[slots[slot as usize] as usize]));
                let (from, count) = (run.sample as usize, run.count as usize);
                evaluated += count;
                let positions = self.positions[from..from + count].chunks_mut(LANES);
                let normals = self.normals[from..from + count].chunks_mut(LANES);
                for ((weights, positions), normals) in block.pairs().zip(positions).zip(normals) {
                    let sums = combine(weights, &entering);
                    let [position, normal] = [[sums[0], sums[1], sums[2]], unit_normals(&sums)].map(by_lane);
                    positions.copy_from_slice(&position[..positions.len()]);
                    normals.copy_from_slice(&normal[..normals.len()]);
                }
            }
        }
        evaluated
    }
}

/// The coordinates of two samples and of their derivatives: x, y, z, then those by `u`, then by `v`.
#[inline]
fn combine(weights: &[[f64x2; 3]], points: &[DVec3]) -> [f64x2; 9] {
    let mut sums = [f64x2::ZERO; 9];
    for (weights, point) in weights.iter().zip(points) {
        let point = point.to_array().map(f64x2::splat);
        for row in 0..9 {
            sums[row] += weights[row / 3] * point[row % 3];
        }
    }
    sums
}

/// Unit normals of two samples; zero where derivatives span no plane.
#[inline]
fn unit_normals(&[_, _, _, ux, uy, uz, vx, vy, vz]: &[f64x2; 9]) -> [f64x2; 3] {
    let cross = [uy * vz - vy * uz, uz * vx - vz * ux, ux * vy - vx * uy];
    let length = (cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]).sqrt();
    let has_plane = length.simd_gt(f64x2::ZERO);
    cross.map(|c| (c / length) & has_plane)
}

#[inline]
fn by_lane([x, y, z]: [f64x2; 3]) -> [DVec3; LANES] {
    let [x, y, z] = [x, y, z].map(f64x2::to_array);
    std::array::from_fn(|lane| DVec3::new(x[lane], y[lane], z[lane]))
}

/// For each vertex the quads whose slots hold it.
fn inverse(vertices: usize, first_slot: &[u32], slots: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let mut first = vec![0_u32; vertices + 1];
    slots.iter().for_each(|&vertex| first[vertex as usize + 1] += 1);
    (0..vertices).for_each(|vertex| first[vertex + 1] += first[vertex]);
    let mut next = first.clone();
    let mut users = vec![0; slots.len()];
    for (quad, range) in (0..).zip(first_slot.windows(2)) {
        for &vertex in &slots[range[0] as usize..range[1] as usize] {
            let place = &mut next[vertex as usize];
            users[*place as usize] = quad;
            *place += 1;
        }
    }
    (first, users)
}

/// Where the samples of vertices, edges and quads stand.
struct Layout {
    resolution: usize,
    /// Sample of each vertex; without meaning for one that no quad uses.
    vertex: Vec<u32>,
    /// First sample of each half-edge's edge, and whether the half-edge runs along the samples.
    edge: Vec<(u32, bool)>,
    first_inner: usize,
    count: usize,
}

impl Layout {
    fn new(surface: &CageSurface, resolution: usize) -> Self {
        let links = &surface.links;
        let mut count = 0;
        let vertex = (0..links.vertex_count())
            .map(|vertex| {
                count += usize::from(links.valence(vertex) > 0);
                name(count).saturating_sub(1)
            })
            .collect();
        let mut edge = vec![(0, true); links.half_edge_count()];
        for h in links.edges() {
            edge[h] = (name(count), true);
            if let Some(twin) = links.twin(h) {
                edge[twin] = (name(count), false);
            }
            count += resolution - 1;
        }
        let first_inner = count;
        count += surface.quads().len() * (resolution - 1) * (resolution - 1);
        Self { resolution, vertex, edge, first_inner, count }
    }

    /// What each quad evaluates: its inside, the edges of which it has the first half-edge, and vertices that no quad before has.
    fn runs(&self, surface: &CageSurface) -> (Vec<u32>, Vec<Run>) {
        let steps = self.resolution - 1;
        let mut is_done = vec![false; self.vertex.len()];
        let (mut first, mut runs) = (vec![0], Vec::new());
        for (quad, corners) in surface.quads().iter().enumerate() {
            if steps > 0 {
                let sample = name(self.first_inner + quad * steps * steps);
                runs.push(Run { block: 0, sample, count: name(steps * steps) });
                for side in 0..4 {
                    let (sample, is_first) = self.edge[4 * quad + side];
                    if is_first {
                        runs.push(Run { block: 1 + name(side), sample, count: name(steps) });
                    }
                }
            }
            for (corner, &vertex) in corners.iter().enumerate() {
                if !std::mem::replace(&mut is_done[vertex as usize], true) {
                    let sample = self.vertex[vertex as usize];
                    runs.push(Run { block: 5 + name(corner), sample, count: 1 });
                }
            }
            first.push(name(runs.len()));
        }
        (first, runs)
    }

    /// The sample at node `(p, q)` of a quad's grid.
    fn sample(&self, corners: [u32; 4], quad: usize, p: usize, q: usize) -> u32 {
        let last = self.resolution;
        let along = |side: usize, step: usize| {
            let (first, is_along) = self.edge[4 * quad + side];
            first + name(if is_along { step - 1 } else { last - 1 - step })
        };
        let corner = |k: usize| self.vertex[corners[k] as usize];
        match (p, q) {
            (0, 0) => corner(0),
            (p, 0) if p == last => corner(1),
            (p, q) if p == last && q == last => corner(2),
            (0, q) if q == last => corner(3),
            (p, 0) => along(0, p),
            (p, q) if p == last => along(1, q),
            (p, q) if q == last => along(2, last - p),
            (0, q) => along(3, last - q),
            (p, q) => name(self.first_inner + (quad * (last - 1) + q - 1) * (last - 1) + p - 1),
        }
    }

    fn triangles(&self, surface: &CageSurface) -> Vec<[u32; 3]> {
        let mut triangles = Vec::with_capacity(2 * surface.quads().len() * self.resolution * self.resolution);
        for (quad, &corners) in surface.quads().iter().enumerate() {
            for q in 0..self.resolution {
                for p in 0..self.resolution {
                    let at = |p, q| self.sample(corners, quad, p, q);
                    let (a, b, c, d) = (at(p, q), at(p + 1, q), at(p + 1, q + 1), at(p, q + 1));
                    triangles.extend([[a, b, c], [a, c, d]]);
                }
            }
        }
        triangles
    }
}

#[cfg(test)]
mod tests;
