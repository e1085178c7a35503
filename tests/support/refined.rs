//! A solution on a mesh of half the spacing: every triangle in four, relaxed by the solvers alone.
//!
//! What the modeler's mesh improvement does, and how many nodes a model may have, does not matter here.

use crate::solved::{Line, Solved};
use ductile_solver::{Budget, CurveSettings, CurveSolver, Rings, Settings, SurfaceSolver};
use glam::DVec3;
use std::collections::BTreeMap;

/// The same surface on a mesh of half the spacing, at rest.
///
/// # Panics
/// When it does not come to rest.
#[must_use]
pub fn refined(coarse: &Solved) -> Solved {
    let mut positions = coarse.positions.clone();
    let mut middles = BTreeMap::new();
    let mut middle = |a: usize, b: usize| {
        *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
            let chord = coarse.positions[b] - coarse.positions[a];
            // Half way between the middle of the chord and those of the two tangent planes there.
            let [up, down] = [a, b].map(|v| coarse.normals[v] * coarse.normals[v].dot(chord));
            positions.push(coarse.positions[a] + 0.5 * chord + 0.125 * (down - up));
            positions.len() - 1
        })
    };
    let mut triangles = Vec::with_capacity(4 * coarse.triangles.len());
    for &[a, b, c] in &coarse.triangles {
        let (ab, bc, ca) = (middle(a, b), middle(b, c), middle(c, a));
        triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
    }
    let lines: Vec<Line> = coarse.lines.iter().map(|line| refined_line(line, &positions, &middles)).collect();
    let mut fixed = vec![false; positions.len()];
    for line in &lines {
        for (&v, &at) in line.vertices.iter().zip(&line.nodes) {
            fixed[v] = true;
            positions[v] = at;
        }
    }
    coarse.pins.iter().for_each(|&v| fixed[v] = true);
    let faces: Vec<[u32; 3]> =
        triangles.iter().map(|t| t.map(|v| u32::try_from(v).expect("fewer nodes"))).collect();
    let rings = Rings::from_triangles(positions.len(), &faces).expect("a surface");
    let mut solver = SurfaceSolver::new(rings, fixed, Settings::default()).expect("it can be solved");
    // Many iterations a step, for a fit of so many nodes is dear.
    let budget = Budget { iterations: 30 };
    let is_at_rest = (0..60).any(|_| solver.step(&mut positions, budget).expect("finite positions").at_rest);
    assert!(is_at_rest, "a finer mesh of a shape at rest rests soon");
    solver.fit_all(&positions);
    let (normals, energy) = (solver.normals().to_vec(), solver.energy());
    Solved { positions, normals, triangles, lines, pins: coarse.pins.clone(), energy }
}

/// A curve with a sample more in each of its edges, at rest.
fn refined_line(line: &Line, positions: &[DVec3], middles: &BTreeMap<(usize, usize), usize>) -> Line {
    let count = line.nodes.len();
    let (mut nodes, mut vertices) = (Vec::new(), Vec::new());
    for (k, (&at, &v)) in line.nodes.iter().zip(&line.vertices).enumerate() {
        nodes.push(at);
        vertices.push(v);
        if k + 1 < count || line.closed {
            let w = line.vertices[(k + 1) % count];
            vertices.push(middles[&(v.min(w), v.max(w))]);
            nodes.push(positions[vertices[vertices.len() - 1]]);
        }
    }
    let controls: Vec<usize> = line.controls.iter().map(|k| 2 * k).collect();
    let fixed = (0..nodes.len()).map(|k| controls.contains(&k)).collect();
    let mut solver = CurveSolver::new(nodes.len(), line.closed, fixed, CurveSettings::default())
        .expect("a curve can be solved");
    let is_at_rest = (0..100).any(|_| solver.step(&mut nodes).expect("finite positions").at_rest);
    assert!(is_at_rest, "a finer polygon of a curve at rest rests soon");
    Line { nodes, vertices, closed: line.closed, controls }
}
