//! Normals at the rim of a fixed mesh, from cubics over the vertices around.
//!
//! Source: F. Cazals and M. Pouget, *Estimating differential quantities using polynomial fitting of osculating jets* (2005): a height
//! function of degree `n`, fitted by least squares to places at distances of `h`, has the slopes of the surface to order `h^n`, on
//! one side as well as all round. The solver's fits have neighbours on one side only at a rim, and for them no more than the
//! curvature along it: what the surface bends across the rim within an edge is missing in their planes, the first order in `h`.
//!
//! Here the cubic runs through the vertex, whose place is known: nine numbers, found from three rings of neighbours or more.
//! Coordinates are lengths over the mean edge at the vertex.

use ductile_mesh::{Mesh, VertexId};
use glam::DVec3;

/// Monomials of a cubic in two variables without the constant.
const SIZE: usize = 9;
/// Rings of neighbours that are taken; more, up to the second number, while there are fewer places than [`LEAST`].
const RINGS: [usize; 2] = [3, 5];
/// Fewest places. At a corner, of which the mesh has a quarter, three rings of a regular mesh have so many or 15.
const LEAST: usize = 12;
/// Most places: a fan of many triangles tells no more with all of them.
const MOST: usize = 64;
/// The most by which the slope may be off for places that are off by one, in units of the mean edge. Three rings at a straight rim have
/// about 1, at a corner 3; beyond this the places do not tell a cubic from a plane, as in a strip two triangles wide.
const NOISE: f64 = 8.0;
/// Cosine between the plane and what the rings' triangles lean at the most: beyond, they are no graph over it. 60°.
const LEANING: f64 = 0.5;
/// The cubic is off its places by less than this part of the mean edge, or there is a crease in the rings that no polynomial knows.
const OFF: f64 = 0.02;

/// Unit normals at all vertices, with better ones at the rim.
pub(super) fn with_rim(mesh: &Mesh, positions: &[DVec3], mut normals: Vec<DVec3>) -> Vec<DVec3> {
    let rim = mesh.vertices().filter(|v| mesh.is_boundary_vertex(*v));
    let better: Vec<_> = rim.filter_map(|v| Some((v, normal(mesh, positions, &normals, v)?))).collect();
    for (v, normal) in better {
        normals[v.index()] = normal;
    }
    normals
}

/// The unit normal at a vertex of the rim, near a known one; none where a cubic cannot tell.
fn normal(mesh: &Mesh, positions: &[DVec3], normals: &[DVec3], v: VertexId) -> Option<DVec3> {
    let (at, up) = (*positions.get(v.index())?, *normals.get(v.index())?);
    let (around, first) = around(mesh, v);
    let h =
        around.get(..first)?.iter().map(|w| positions[w.index()].distance(at)).sum::<f64>() / first as f64;
    let leans = |w: &VertexId| normals[w.index()].dot(up).abs() < LEANING;
    if around.len() < LEAST || h.is_nan() || h <= 0.0 || up == DVec3::ZERO || around.iter().any(leans) {
        return None;
    }
    let (x, y) = up.any_orthonormal_pair();
    let rows = around.iter().map(|w| {
        let chord = (positions[w.index()] - at) / h;
        (monomials(chord.dot(x), chord.dot(y)), chord.dot(up))
    });
    let rows: Vec<([f64; SIZE], f64)> = rows.collect();
    let factor = Factor::of(&rows)?;
    let mut right = [0.0; SIZE];
    for (row, height) in &rows {
        for (sum, term) in right.iter_mut().zip(row) {
            *sum += term * height;
        }
    }
    let cubic = factor.solved(right);
    let off = |(row, height): &([f64; SIZE], f64)| {
        (row.iter().zip(&cubic).map(|(term, c)| term * c).sum::<f64>() - height).abs()
    };
    let is_smooth = rows.iter().map(off).fold(0.0, f64::max) < OFF;
    is_smooth.then(|| up - x * cubic[0] - y * cubic[1])?.try_normalize()
}

/// The vertices within so many rings, ring by ring, without the vertex itself, and how many the first ring has.
fn around(mesh: &Mesh, v: VertexId) -> (Vec<VertexId>, usize) {
    let mut found = vec![v];
    let (mut from, mut first) = (0, 0);
    for ring in 1..=RINGS[1] {
        let until = found.len();
        if ring > RINGS[0] && until > LEAST || until > MOST {
            break;
        }
        for at in from..until {
            for w in mesh.neighbours(found[at]) {
                if !found.contains(&w) {
                    found.push(w);
                }
            }
        }
        from = until;
        if ring == 1 {
            first = found.len() - 1;
        }
    }
    found.remove(0);
    found.truncate(MOST.max(first));
    (found, first)
}

fn monomials(x: f64, y: f64) -> [f64; SIZE] {
    [x, y, x * x, x * y, y * y, x * x * x, x * x * y, x * y * y, y * y * y]
}

/// The lower factor of Cholesky's of the normal matrix.
struct Factor([[f64; SIZE]; SIZE]);

impl Factor {
    /// None if the slopes are not told.
    fn of(rows: &[([f64; SIZE], f64)]) -> Option<Self> {
        let mut l = [[0.0; SIZE]; SIZE];
        for i in 0..SIZE {
            for j in 0..=i {
                let entry: f64 = rows.iter().map(|(row, _)| row[i] * row[j]).sum();
                let rest = entry - (0..j).map(|k| l[i][k] * l[j][k]).sum::<f64>();
                // What rounding leaves of a column that depends on the ones before.
                let is_regular = rest > 1e-12 * entry;
                l[i][j] = if i > j { rest / l[j][j] } else { is_regular.then(|| rest.sqrt())? };
            }
        }
        let factor = Self(l);
        // The variance of the slopes is the trace of their part of the inverse.
        let variance = |k: usize| {
            let mut unit = [0.0; SIZE];
            unit[k] = 1.0;
            factor.solved(unit)[k]
        };
        (variance(0) + variance(1) < NOISE * NOISE).then_some(factor)
    }

    fn solved(&self, mut x: [f64; SIZE]) -> [f64; SIZE] {
        let Self(l) = self;
        for i in 0..SIZE {
            x[i] = (x[i] - (0..i).map(|k| l[i][k] * x[k]).sum::<f64>()) / l[i][i];
        }
        for i in (0..SIZE).rev() {
            x[i] = (x[i] - (i + 1..SIZE).map(|k| l[k][i] * x[k]).sum::<f64>()) / l[i][i];
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::super::normals as fitted;
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// A patch of `n` times `n` quads, each of two triangles, of places and normals at `(u, v)` in the unit square; vertices inside stand
    /// off the grid by a part of its step.
    fn patch(n: u32, at: impl Fn(f64, f64) -> (DVec3, DVec3)) -> (Mesh, Vec<DVec3>, Vec<DVec3>) {
        let shift = |i: u32, j: u32| {
            let is_inside = i > 0 && i < n;
            let turn = f64::from(7 * i * i + 13 * i * j + 5 * j);
            f64::from(i) + if is_inside { 0.25 * libm::sin(turn) } else { 0.0 }
        };
        let places = (0..=n).flat_map(|i| (0..=n).map(move |j| (i, j)));
        let of = |(i, j)| at(shift(i, j) / f64::from(n), shift(j, i) / f64::from(n));
        let (positions, exact): (Vec<DVec3>, Vec<DVec3>) = places.map(of).unzip();
        let name = |i: u32, j: u32| i * (n + 1) + j;
        let quads = (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        let halves = quads.flat_map(|(i, j)| {
            let [a, b, c, d] = [name(i, j), name(i + 1, j), name(i + 1, j + 1), name(i, j + 1)];
            [[a, b, c], [a, c, d]]
        });
        let mesh = Mesh::from_triangles(positions.len(), &halves.collect::<Vec<_>>()).unwrap();
        (mesh, positions, exact)
    }

    /// The largest angle at the rim before and after.
    fn off(n: u32, at: impl Fn(f64, f64) -> (DVec3, DVec3)) -> [f64; 2] {
        let (mesh, positions, exact) = patch(n, at);
        let before = fitted(&positions, &mesh.to_triangles(), true);
        let after = with_rim(&mesh, &positions, before.clone());
        [before, after].map(|normals| {
            let rim = mesh.vertices().filter(|v| mesh.is_boundary_vertex(*v)).map(|v| v.index());
            rim.map(|v| normals[v].cross(exact[v]).length()).fold(0.0, f64::max)
        })
    }

    fn sphere(u: f64, v: f64) -> (DVec3, DVec3) {
        let at = DVec3::new(u - 0.3, v - 0.5, 1.0).normalize_or_zero();
        (at, at)
    }

    fn torus(u: f64, v: f64) -> (DVec3, DVec3) {
        let ((sin, cos), (up, out)) = (libm::sincos(1.4 * u), libm::sincos(2.5 * v - 0.6));
        let normal = DVec3::new(cos * out, sin * out, up);
        (DVec3::new(cos, sin, 0.0) + normal * 0.4, normal)
    }

    #[test]
    fn at_a_rim_normals_are_of_the_third_order() {
        for (name, at) in [("sphere", sphere as fn(f64, f64) -> _), ("torus", torus)] {
            let off = [16, 32, 64].map(|n| off(n, at));
            println!("{name}, radians before and after: {off:?}");
            // Measured: 7.9 and 7.0 on the sphere, 8.4 and 8.4 on the torus, corners and all; 2.2 and less before.
            for pair in off.windows(2) {
                assert!(pair[0][1] > 6.0 * pair[1][1], "{name}: {off:?}");
            }
            assert!(off[1][1] < 0.05 * off[1][0], "{name}: {off:?}");
        }
    }

    #[test]
    fn a_cubic_is_met_exactly_and_noise_is_not_blown_up() {
        let cubic = |u: f64, v: f64| {
            let (x, y) = (u - 0.5, v - 0.5);
            let z = 0.3 * x * x - 0.2 * x * y + 0.4 * y * y * y - 0.3 * x * x * y;
            let slopes = [0.6 * x - 0.2 * y - 0.6 * x * y, -0.2 * x + 1.2 * y * y - 0.3 * x * x];
            (DVec3::new(x, y, z), DVec3::new(-slopes[0], -slopes[1], 1.0).normalize_or_zero())
        };
        let (mesh, positions, exact) = patch(12, cubic);
        let after = with_rim(&mesh, &positions, vec![DVec3::Z; positions.len()]);
        let mut rim = mesh.vertices().filter(|v| mesh.is_boundary_vertex(*v)).map(|v| v.index());
        assert!(rim.all(|v| after[v].distance(exact[v]) < 1e-10));
        // Places that are off by a thousandth of an edge.
        let noisy = |u: f64, v: f64| {
            let noise = libm::sin(1e4 * u + 3e4 * v) * 1e-3 / 12.0;
            (DVec3::new(u, v, noise), DVec3::Z)
        };
        let [before, after] = off(12, noisy);
        println!("noise: {before:e}, {after:e}");
        assert!(after < NOISE * 1e-3 && after < 4.0 * before, "{before:e} {after:e}");
    }

    #[test]
    fn beside_creases_and_in_narrow_strips_the_old_normals_stay() {
        // A roof whose ridge runs along the rim, one edge from it.
        let roof = |u: f64, v: f64| {
            let slope = if v < 1.5 / 12.0 { 0.5 } else { -0.5 };
            let along = DVec3::new(u, v, -0.5 * (v - 1.0 / 12.0).abs());
            (along, DVec3::new(0.0, -slope, 1.0).normalize_or_zero())
        };
        let (mesh, positions, _) = patch(12, roof);
        let before = fitted(&positions, &mesh.to_triangles(), true);
        let after = with_rim(&mesh, &positions, before.clone());
        let eaves = |v: &VertexId| positions[v.index()].y == 0.0;
        let rim: Vec<VertexId> = mesh.vertices().filter(eaves).collect();
        assert!(rim.len() == 13 && rim.iter().all(|v| after[v.index()] == before[v.index()]));
        // Three rows of vertices know no cubic across.
        let rows = (0..20_u32).flat_map(|k| (0..3_u32).map(move |row| (k, row)));
        let at = |(k, row): (u32, u32)| sphere(f64::from(k) * 0.05, f64::from(row) * 0.05).0;
        let positions: Vec<DVec3> = rows.map(at).collect();
        let quads = (0..19_u32).flat_map(|k| (0..2).map(move |row| 3 * k + row));
        let halves: Vec<[u32; 3]> = quads.flat_map(|a| [[a, a + 3, a + 4], [a, a + 4, a + 1]]).collect();
        let mesh = Mesh::from_triangles(positions.len(), &halves).unwrap();
        let before = fitted(&positions, &mesh.to_triangles(), true);
        assert_eq!(with_rim(&mesh, &positions, before.clone()), before);
    }
}
