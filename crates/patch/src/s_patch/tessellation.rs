//! Triangles over the domain, and the basis at their corners: what is the same for all patches of a kind.
//!
//! ```text
//!      *-------*-------*      one of n sectors at resolution 3; ring r has r edges along each side, so that
//!       \  / \  / \  / \      the boundary is cut evenly and the centre is a vertex
//!        *-------*---
//!         \  / \
//!          *---
//! ```
//!
//! Turning the polygon by one corner only renumbers labels, so the basis is kept for one sector: control points are
//! gathered in turned order for each of the others.

use super::domain::Domain;
use super::evaluate::for_each_basis;
use super::label::{Labels, TooManyPoints};
use super::patch::SPatch;
use crate::surface_point::unit_normal;
use glam::{DVec2, DVec3};
use thiserror::Error;

/// Why there is no such tessellation.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum TessellationError {
    /// The patch itself would be too large.
    #[error(transparent)]
    TooManyPoints(#[from] TooManyPoints),
    /// The resolution is 0, or there would be more than two million vertices.
    #[error("a resolution of {0} is not possible: at least 1, and at most two million vertices")]
    Resolution(usize),
}

const MOST_VERTICES: usize = 2_000_000;
/// Numbers of the basis that are kept (192 MB); beyond, they are worked out again whenever they are wanted.
const MOST_KEPT: usize = 8_000_000;

/// Sums that are run side by side.
const LANES: usize = 8;

/// A grid of triangles over the domain of patches with a number of sides and a depth.
#[derive(Clone, Debug)]
pub struct Tessellation {
    labels: Labels,
    domain: Domain,
    resolution: usize,
    /// Basis, and its derivatives by x and y, at the vertices of the first sector; empty when too large to keep.
    rows: Vec<[f64; 3]>,
}

/// The vertices of one patch over a [`Tessellation`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellated {
    /// Points of the surface, in model units.
    pub positions: Vec<DVec3>,
    /// Unit normals; zero where the surface has none.
    pub normals: Vec<DVec3>,
}

impl Tessellation {
    /// A grid with `resolution` edges along each side.
    ///
    /// # Errors
    /// The grid or the patch would be too large.
    pub fn new(sides: usize, depth: usize, resolution: usize) -> Result<Self, TessellationError> {
        let labels = Labels::new(sides, depth)?;
        if resolution == 0 || resolution > MOST_VERTICES || count(sides, resolution) > MOST_VERTICES {
            return Err(TessellationError::Resolution(resolution));
        }
        let mut grid = Self { labels, domain: Domain::new(sides), resolution, rows: Vec::new() };
        let sector: Vec<DVec2> = grid.sector(0).map(|(_, place)| place).collect();
        if sector.len().saturating_mul(grid.labels.len()) <= MOST_KEPT {
            let mut rows = Vec::with_capacity(sector.len() * grid.labels.len());
            sector.iter().for_each(|place| append_row(&grid, *place, &mut rows));
            grid.rows = rows;
        }
        Ok(grid)
    }

    /// Of how many sides its patches are.
    #[must_use]
    pub fn sides(&self) -> usize {
        self.labels.sides()
    }

    /// Of what depth its patches are.
    #[must_use]
    pub fn depth(&self) -> usize {
        self.labels.depth()
    }

    /// How many edges a side has.
    #[must_use]
    pub fn resolution(&self) -> usize {
        self.resolution
    }

    /// How many vertices there are.
    #[must_use]
    pub fn vertex_count(&self) -> usize {
        count(self.labels.sides(), self.resolution)
    }

    /// The number of the vertex `step` edges along a side, from 0 to the resolution.
    #[must_use]
    pub fn on_side(&self, side: usize, step: usize) -> usize {
        self.vertex(self.resolution, side, step)
    }

    fn vertex(&self, ring: usize, sector: usize, step: usize) -> usize {
        let n = self.labels.sides();
        if ring == 0 { 0 } else { 1 + n * (ring * (ring - 1) / 2) + (sector * ring + step) % (n * ring) }
    }

    /// The vertices of a sector without those of the next one, with their places; the centre belongs to the first.
    fn sector(&self, sector: usize) -> impl Iterator<Item = (usize, DVec2)> {
        let centre = (sector == 0).then_some((0, DVec2::ZERO));
        let rings = (1..=self.resolution).flat_map(move |ring| (0..ring).map(move |step| (ring, step)));
        let inside = rings.map(move |(ring, step)| {
            let out = ring as f64 / self.resolution as f64;
            let place = self.domain.on_side(sector, step as f64 / ring as f64) * out;
            (self.vertex(ring, sector, step), place)
        });
        centre.into_iter().chain(inside)
    }

    /// The places of all vertices in the domain.
    #[must_use]
    pub fn places(&self) -> Vec<DVec2> {
        let mut places = vec![DVec2::ZERO; self.vertex_count()];
        let all = (0..self.labels.sides()).flat_map(|sector| self.sector(sector));
        all.for_each(|(vertex, place)| places[vertex] = place);
        places
    }

    /// The triangles, counter-clockwise in the domain.
    #[must_use]
    pub fn triangles(&self) -> Vec<[usize; 3]> {
        let mut triangles = Vec::with_capacity(self.labels.sides() * self.resolution * self.resolution);
        for ring in 1..=self.resolution {
            for sector in 0..self.labels.sides() {
                let outer = |step| self.vertex(ring, sector, step);
                let inner = |step| self.vertex(ring - 1, sector, step);
                for step in 0..ring {
                    triangles.push([outer(step), outer(step + 1), inner(step)]);
                    if step + 1 < ring {
                        triangles.push([inner(step), outer(step + 1), inner(step + 1)]);
                    }
                }
            }
        }
        triangles
    }

    /// The surface at all vertices; none if the patch has other sides or another depth.
    #[must_use]
    pub fn evaluate(&self, patch: &SPatch) -> Option<Tessellated> {
        if (patch.sides(), patch.depth()) != (self.labels.sides(), self.labels.depth()) {
            return None;
        }
        let zeros = vec![DVec3::ZERO; self.vertex_count()];
        let mut found = Tessellated { positions: zeros.clone(), normals: zeros };
        let vertices: Vec<Vec<(usize, DVec2)>> =
            (0..self.labels.sides()).map(|sector| self.sector(sector).collect()).collect();
        let (mut turned, mut own_row) = (patch.points().to_vec(), Vec::new());
        let mut lanes = vec![[0.0; LANES]; self.labels.len()];
        let (wide, all) = (self.labels.len(), 3 * self.labels.sides());
        let mut slopes = vec![[DVec3::ZERO; 2]; self.vertex_count()];
        // Rows are many: each is read once for as many axes of sectors as there are lanes.
        for first in (0..all).step_by(LANES) {
            let block = first..(first + LANES).min(all);
            for (lane, of) in block.clone().enumerate() {
                if lane == 0 || of % 3 == 0 {
                    self.gather(patch.points(), of / 3, &mut turned);
                }
                lanes.iter_mut().zip(&turned).for_each(|(values, point)| values[lane] = point[of % 3]);
            }
            for (at, (_, place)) in vertices[0].iter().enumerate() {
                let row = if self.rows.is_empty() {
                    own_row.clear();
                    append_row(self, *place, &mut own_row);
                    &own_row
                } else {
                    &self.rows[at * wide..(at + 1) * wide]
                };
                let [point, dx, dy] = weighed(&lanes, row);
                for (lane, of) in block.clone().enumerate() {
                    // The centre is in the row of the first sector only.
                    let own = if of < 3 { Some(at) } else { at.checked_sub(1) };
                    let Some((vertex, _)) = own.and_then(|own| vertices[of / 3].get(own)) else { continue };
                    found.positions[*vertex][of % 3] = point[lane];
                    slopes[*vertex][0][of % 3] = dx[lane];
                    slopes[*vertex][1][of % 3] = dy[lane];
                }
            }
        }
        for (normal, [dx, dy]) in found.normals.iter_mut().zip(slopes) {
            *normal = unit_normal(dx, dy).unwrap_or_default();
        }
        Some(found)
    }

    /// Control points in the order in which a sector sees them as if it were the first.
    fn gather(&self, points: &[DVec3], sector: usize, turned: &mut [DVec3]) {
        let n = self.labels.sides();
        let mut label = vec![0; n];
        for (own, slot) in self.labels.iter().zip(turned) {
            (0..n).for_each(|k| label[(k + sector) % n] = own[k]);
            *slot = points[self.labels.rank_of(&label)];
        }
    }
}

fn count(sides: usize, resolution: usize) -> usize {
    1 + sides * (resolution * (resolution + 1) / 2)
}

fn append_row(grid: &Tessellation, place: DVec2, rows: &mut Vec<[f64; 3]>) {
    let put = |_, basis: &crate::jet::Jet| rows.push([basis.value, basis.a, basis.b]);
    for_each_basis(&grid.domain, grid.labels.depth(), place, put);
}

/// The point and its two derivatives, in every lane.
fn weighed(points: &[[f64; LANES]], row: &[[f64; 3]]) -> [[f64; LANES]; 3] {
    let mut sums = [[0.0; LANES]; 3];
    for (point, weights) in points.iter().zip(row) {
        for (sum, weight) in sums.iter_mut().zip(weights) {
            for (sum, value) in sum.iter_mut().zip(point) {
                *sum += value * weight;
            }
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::super::tests::{filled, random_loop};
    use super::super::{Fill, Join};
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn vertices_are_those_of_the_surface() {
        for (n, d) in [(3, 2), (4, 3), (5, 4), (6, 2)] {
            let patch = filled(&random_loop(n, d, 7), Join::Tangent, Fill::Biharmonic);
            let mut grid = Tessellation::new(n, d + 3, 4).unwrap();
            let found = grid.evaluate(&patch).unwrap();
            let domain = Domain::new(n);
            for (vertex, place) in grid.places().into_iter().enumerate() {
                let exact = patch.at(&domain, place).unwrap();
                assert!(found.positions[vertex].distance(exact.point) < 1e-13);
                assert!(found.normals[vertex].distance(exact.normal().unwrap()) < 1e-11);
            }
            // What is not kept is the same when it is worked out again.
            grid.rows.clear();
            assert_eq!(grid.evaluate(&patch).unwrap(), found);
        }
    }

    #[test]
    fn triangles_cover_the_polygon_once() {
        for (n, k) in [(3, 1), (4, 2), (5, 5), (7, 3)] {
            let grid = Tessellation::new(n, 2, k).unwrap();
            let (places, triangles) = (grid.places(), grid.triangles());
            assert_eq!((places.len(), triangles.len()), (grid.vertex_count(), n * k * k));
            let area = |t: &[usize; 3]| (places[t[1]] - places[t[0]]).perp_dot(places[t[2]] - places[t[0]]);
            assert!(triangles.iter().all(|t| area(t) > 0.0));
            let whole = n as f64 * libm::sin(core::f64::consts::TAU / n as f64);
            assert!((triangles.iter().map(area).sum::<f64>() - whole).abs() < 1e-13);
            for side in 0..n {
                for step in 0..=k {
                    let exact = grid.domain.on_side(side, step as f64 / k as f64);
                    assert!(places[grid.on_side(side, step)].distance(exact) < 1e-15);
                }
            }
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        for resolution in [0, 3000, usize::MAX] {
            assert_eq!(
                Tessellation::new(5, 6, resolution).err(),
                Some(TessellationError::Resolution(resolution))
            );
        }
        assert!(matches!(Tessellation::new(64, 60, 4), Err(TessellationError::TooManyPoints(_))));
        let patch = filled(&random_loop(4, 3, 7), Join::Tangent, Fill::Biharmonic);
        assert_eq!(Tessellation::new(4, 5, 2).unwrap().evaluate(&patch), None);
    }
}
