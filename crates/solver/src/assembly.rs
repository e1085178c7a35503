//! Curvature rows of every neighbourhood and the matrix `A = rowsᵀ rows` they make.
//!
//! Source: recipe section 4. Per node `k` and component `c` of `L = (L11, √2 L12, L22)`:
//!
//! ```text
//! row = √a [ Σ_j Z_cj (s_kj alpha_j - alpha_k) + (L²)_c alpha_k ]        Z physical, per h²
//! ```
//!
//! `s_kj` is the sense of the spoke: `alpha_j` is measured along the neighbour's own normal, which on a surface that
//! cannot be oriented points to the other side now and then. There is no factor `n_j·n_k`. Neighbourhoods around
//! fixed nodes are assembled too; they carry smoothness across control curves. [`Rows::Field`] drops `L²` and the
//! senses: rows of a scalar field on the surface, which annihilate constants exactly (predictor, section 5).

use crate::batch::Batch;
use crate::clamp::Demand;
use crate::constraint::Planes;
use crate::fits::{Fits, Row};
use crate::lanes::Pair;
use crate::objective::Goals;
use crate::operator::{FIXED, SymmetricMatrix, Unknowns};
use crate::rings::{MAX_RING, Rings};

/// Relative shift of the diagonal: keeps a truncated solve away from exact singularity.
const DIAGONAL_SHIFT: f64 = 1e-10;

/// Which unknowns the rows act on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Rows {
    /// Normal offsets, with the `L²` term.
    Offset,
    /// A scalar field.
    Field,
}

/// The three rows of a batch's neighbourhoods: the centre first, then the neighbours.
type LocalRows = [[Pair; 3]; MAX_RING + 1];

/// Gets the rows of a batch ready; `kept` is what the fits keep of it.
#[inline(always)]
fn local_rows(rings: &Rings, goals: &Goals, kept: &[Row], batch: &Batch, kind: Rows, rows: &mut LocalRows) {
    let mut sum = [Pair::splat(0.0); 3];
    for (row, kept) in rows[1..].iter_mut().zip(&kept[1..]) {
        for c in 0..3 {
            row[c] = Pair::new(kept[c]);
            sum[c] += row[c];
        }
    }
    for c in 0..3 {
        rows[0][c] = match kind {
            Rows::Offset => Pair::new(kept[0][c]) - sum[c],
            Rows::Field => -sum[c],
        };
    }
    if kind == Rows::Offset && !goals.is_plate() {
        let prices = batch.nodes.map(|node| goals.price(node as usize));
        // A neutral node does not bend under its own offset.
        let squares = Pair::new(prices.map(|price| price.plate / price.rows().max(f64::MIN_POSITIVE)));
        let roots = Pair::new(prices.map(|price| price.rows().sqrt()));
        for c in 0..3 {
            rows[0][c] = Pair::new(kept[0][c]) * squares - sum[c];
        }
        for value in rows[..=batch.degree].iter_mut().flatten() {
            *value *= roots;
        }
    }
    if kind == Rows::Offset && rings.is_mixed() {
        let senses = batch.nodes.map(|node| rings.senses(node as usize));
        for (row, (&first, &second)) in rows[1..].iter_mut().zip(senses[0].iter().zip(senses[1])) {
            for value in row {
                *value *= Pair::new([first, second]);
            }
        }
    }
}

/// The pattern of `A` and the places its neighbourhoods scatter to.
#[derive(Clone, Debug)]
pub(crate) struct Assembly {
    matrix: SymmetricMatrix,
    /// Per batch the lower triangle of its local matrix by rows: each entry's place in the values of `matrix`.
    places: Vec<[u32; 2]>,
}

/// Where a node's pairs begin in `places`, and its lane.
type Home = (usize, usize);

impl Assembly {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "pairs are fewer than 325 per node, checked when rings are made"
    )]
    pub(crate) fn new(rings: &Rings, unknowns: &Unknowns) -> Self {
        let mut homes: Vec<Home> = vec![(0, 0); rings.len()];
        for batch in rings.batches() {
            for lane in 0..batch.count {
                homes[batch.nodes[lane] as usize] = (batch.pairs().start, lane);
            }
        }
        let pairs = rings.batches().last().map_or(0, |batch| batch.pairs().end);
        let mut places = vec![[FIXED; 2]; pairs];
        // About nine columns a row lie below the diagonal of a plate.
        let mut row_starts = Vec::with_capacity(unknowns.len() + 1);
        let mut columns = Vec::with_capacity(10 * unknowns.len());
        row_starts.push(0_u32);
        // The row in which column `j` was met last, and its place there.
        let mut met = vec![(FIXED, 0_u32); unknowns.len()];
        for (row, &node) in (0_u32..).zip(&unknowns.nodes) {
            // Every neighbourhood that contains this row is told where its pairs with smaller columns go. Columns stand
            // in the order in which they are met.
            for centre in neighbourhood_of(rings, node as usize) {
                let ring = rings.ring(centre as usize);
                let mine = if centre == node { 0 } else { 1 + place_in(ring, node) };
                let (start, lane) = homes[centre as usize];
                let mut tell = |other: usize, far: u32| {
                    let column = unknowns.index[far as usize];
                    if column < row {
                        let met = &mut met[column as usize];
                        if met.0 != row {
                            *met = (row, columns.len() as u32);
                            columns.push(column);
                        }
                        let (high, low) = (mine.max(other), mine.min(other));
                        places[start + high * (high + 1) / 2 + low][lane] = met.1;
                    }
                };
                tell(0, centre);
                ring.iter().enumerate().for_each(|(place, &far)| tell(place + 1, far));
            }
            row_starts.push(columns.len() as u32);
        }
        let matrix = SymmetricMatrix::new(row_starts, columns);
        let mut assembly = Self { matrix, places };
        assembly.place_diagonal(rings, unknowns, &homes);
        assembly
    }

    /// Diagonal pairs go behind the triangle; pairs with a fixed node to the last place, which nobody reads.
    #[expect(clippy::cast_possible_truncation, reason = "as in new")]
    fn place_diagonal(&mut self, rings: &Rings, unknowns: &Unknowns, homes: &[Home]) {
        let dropped = (self.matrix.values_mut().len() - 1) as u32;
        let first = dropped - unknowns.len() as u32;
        for node in 0..rings.len() {
            let (start, lane) = homes[node];
            for (i, far) in neighbourhood_of(rings, node).enumerate() {
                let index = unknowns.index[far as usize];
                if index != FIXED {
                    self.places[start + i * (i + 1) / 2 + i][lane] = first + index;
                }
            }
        }
        for place in self.places.iter_mut().flatten().filter(|place| **place == FIXED) {
            *place = dropped;
        }
    }

    /// Computes the numbers of `A`; `mass` is added to the diagonal, per unknown.
    pub(crate) fn assemble(
        &mut self,
        rings: &Rings,
        goals: &Goals,
        fits: &Fits,
        kind: Rows,
        mass: impl Fn(usize) -> f64,
    ) {
        let values = self.matrix.values_mut();
        values.fill(0.0);
        let mut rows = [[Pair::splat(0.0); 3]; MAX_RING + 1];
        for batch in fits.active_batches(rings) {
            local_rows(rings, goals, &fits.rows[batch.rows()], batch, kind, &mut rows);
            let mut places = self.places[batch.pairs()].iter();
            for i in 0..=batch.degree {
                let a = rows[i];
                for (b, place) in rows[..=i].iter().zip(&mut places) {
                    let product = (a[0] * b[0] + a[1] * b[1] + a[2] * b[2]).to_array();
                    values[place[0] as usize] += product[0];
                    values[place[1] as usize] += product[1];
                }
            }
        }
        if kind == Rows::Offset {
            self.add_clamps(rings, goals, fits);
        }
        for (unknown, value) in self.matrix.diagonal_mut().iter_mut().enumerate() {
            *value = *value * (1.0 + DIAGONAL_SHIFT) + mass(unknown);
            // A node that no row mentions is its own equation.
            if !(*value > 0.0) {
                *value = 1.0;
            }
        }
    }

    /// What a tilt of a ring against its prescribed plane costs.
    fn add_clamps(&mut self, rings: &Rings, goals: &Goals, fits: &Fits) {
        let values = self.matrix.values_mut();
        for (plane, clamp) in goals.planes.iter().flat_map(Planes::list).zip(&fits.clamps) {
            let price = goals.price(plane.node as usize);
            let demand = Demand {
                plate: price.plate,
                tilt: price.rows(),
                variation: price.variation * fits.variation.as_ref().map_or(0.0, |variation| variation.scale),
                bending: [0.0; 3],
            };
            let (number, lane) = plane.home;
            let places = &self.places[rings.batches()[number].pairs()];
            clamp.products(&demand, rings.senses(plane.node as usize), |i, j, value| {
                values[places[i * (i + 1) / 2 + j][lane] as usize] += value;
            });
        }
    }

    /// `rhs = -A_S[:, fixed] field[fixed]` for a field given on all nodes, of which only fixed ones are not zero.
    pub(crate) fn pull_fixed(
        &self,
        rings: &Rings,
        fits: &Fits,
        unknowns: &Unknowns,
        field: &[f64],
        rhs: &mut [f64],
    ) {
        rhs.fill(0.0);
        let mut rows = [[Pair::splat(0.0); 3]; MAX_RING + 1];
        for batch in fits.active_batches(rings) {
            let lists = batch.nodes.map(|node| neighbourhood_of(rings, node as usize));
            let pairs = lists[0].clone().zip(lists[1].clone()).map(|pair| [pair.0 as usize, pair.1 as usize]);
            if pairs.clone().flatten().all(|far| field[far] == 0.0) {
                continue;
            }
            let kept = &fits.rows[batch.rows()];
            local_rows(rings, &Goals::default(), kept, batch, Rows::Field, &mut rows);
            let mut bend = [Pair::splat(0.0); 3];
            for (row, far) in rows.iter().zip(pairs.clone()) {
                let values = Pair::new(far.map(|far| field[far]));
                for c in 0..3 {
                    bend[c] += row[c] * values;
                }
            }
            for (row, far) in rows.iter().zip(pairs) {
                let pull = (row[0] * bend[0] + row[1] * bend[1] + row[2] * bend[2]).to_array();
                for lane in 0..batch.count {
                    let index = unknowns.index[far[lane]];
                    if index != FIXED {
                        rhs[index as usize] -= pull[lane];
                    }
                }
            }
        }
    }

    pub(crate) fn matrix(&self) -> &SymmetricMatrix {
        &self.matrix
    }
}

/// A node and its ring, in the order of the local rows.
fn neighbourhood_of(rings: &Rings, node: usize) -> impl Iterator<Item = u32> + Clone {
    #[expect(clippy::cast_possible_truncation, reason = "nodes are counted by u32")]
    let centre = node as u32;
    std::iter::once(centre).chain(rings.ring(node).iter().copied())
}

/// The place of a neighbour in a ring. Rings know each other, so it is there.
fn place_in(ring: &[u32], node: u32) -> usize {
    ring.iter().position(|&far| far == node).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fits::Wanted;
    use crate::lanes::Real;
    use crate::workload;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// The matrix as the sum of dense outer products.
    fn dense(rings: &Rings, fits: &Fits, unknowns: &Unknowns, kind: Rows) -> Vec<Vec<f64>> {
        let mut a = vec![vec![0.0; unknowns.len()]; unknowns.len()];
        let mut rows = [[Pair::splat(0.0); 3]; MAX_RING + 1];
        for batch in rings.batches() {
            local_rows(rings, &Goals::default(), &fits.rows[batch.rows()], batch, kind, &mut rows);
            for lane in 0..batch.count {
                let node = batch.nodes[lane] as usize;
                for (i, x) in neighbourhood_of(rings, node).enumerate() {
                    for (j, y) in neighbourhood_of(rings, node).enumerate() {
                        let (x, y) = (unknowns.index[x as usize], unknowns.index[y as usize]);
                        if x != FIXED && y != FIXED {
                            let product =
                                (0..3).map(|c| rows[i][c].lane(lane) * rows[j][c].lane(lane)).sum::<f64>();
                            a[x as usize][y as usize] += product;
                        }
                    }
                }
            }
        }
        a
    }

    #[test]
    fn scattered_matrix_equals_sum_of_outer_products() {
        let mesh = workload::disc(4);
        let rings = Rings::from_triangles(mesh.positions.len(), &mesh.triangles).unwrap();
        let goals = Goals::default();
        let mut fits = Fits::new(&rings, &goals);
        let lifted: Vec<_> = mesh.positions.iter().map(|p| *p + glam::DVec3::Z * (0.3 * p.x * p.x)).collect();
        fits.refit(&rings, &goals, &lifted, Wanted::Gradient);
        let unknowns = Unknowns::new(mesh.fixed.iter().map(|fixed| !fixed));
        let mut assembly = Assembly::new(&rings, &unknowns);
        assembly.assemble(&rings, &goals, &fits, Rows::Offset, |_| 0.0);
        let expected = dense(&rings, &fits, &unknowns, Rows::Offset);
        let mut y = vec![0.0; unknowns.len()];
        for column in 0..unknowns.len() {
            let mut x = vec![0.0; unknowns.len()];
            x[column] = 1.0;
            assembly.matrix().multiply(&x, &mut y);
            for (row, &value) in y.iter().enumerate() {
                let wanted = expected[row][column];
                assert!((value - wanted).abs() <= 1e-9 * expected[row][row].max(expected[column][column]));
            }
        }
    }

    #[test]
    fn field_rows_annihilate_constants() {
        let mesh = workload::disc(3);
        let rings = Rings::from_triangles(mesh.positions.len(), &mesh.triangles).unwrap();
        let goals = Goals::default();
        let mut fits = Fits::new(&rings, &goals);
        fits.refit(&rings, &goals, &mesh.positions, Wanted::Gradient);
        let unknowns = Unknowns::new(mesh.fixed.iter().map(|fixed| !fixed));
        let mut assembly = Assembly::new(&rings, &unknowns);
        assembly.assemble(&rings, &goals, &fits, Rows::Field, |_| 0.0);
        // A ones + pulled ones on the fixed nodes = 0
        let mut product = vec![0.0; unknowns.len()];
        assembly.matrix().multiply(&vec![1.0; unknowns.len()], &mut product);
        let field: Vec<f64> = mesh.fixed.iter().map(|&fixed| f64::from(u8::from(fixed))).collect();
        let mut rhs = vec![0.0; unknowns.len()];
        assembly.pull_fixed(&rings, &fits, &unknowns, &field, &mut rhs);
        let scale = product.iter().fold(0.0_f64, |scale, value| scale.max(value.abs()));
        assert!(product.iter().zip(&rhs).all(|(a, b)| (a - b).abs() < 1e-6 * scale.max(1.0)));
    }
}
