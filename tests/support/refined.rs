//! A solution on a mesh of half the spacing: every triangle in four, or only those at the ends of curves, relaxed by the solvers alone.
//!
//! What the modeler's mesh improvement does, and how many nodes a model may have, does not matter here.

use crate::solved::{Line, Solved};
use ductile_solver::{Budget, CurveSettings, CurveSolver, Rings, Sampling, Settings, SurfaceSolver};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};

/// The same surface on a mesh of half the spacing, at rest.
///
/// # Panics
/// When it does not come to rest.
#[must_use]
pub fn refined(coarse: &Solved) -> Solved {
    halved(coarse, |_, _| true)
}

/// The same surface with edges of half the length right around the ends of the curves inside it, at rest. Edges graded with the
/// root of the distance are a quarter as long there when all others are halved, so this goes with every [`refined`].
///
/// # Panics
/// When it does not come to rest.
#[must_use]
pub fn sharpened(coarse: &Solved) -> Solved {
    let ends: Vec<(usize, f64)> = ends(coarse).into_iter().map(|end| (end, mean_edge(coarse, end))).collect();
    if ends.is_empty() {
        return coarse.clone();
    }
    let is_near = |v: usize| {
        ends.iter().any(|&(end, edge)| coarse.positions[v].distance(coarse.positions[end]) < 1.5 * edge)
    };
    let mut is_split = BTreeSet::new();
    for &[a, b, c] in coarse.triangles.iter().filter(|corners| corners.iter().any(|&v| is_near(v))) {
        is_split.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b))));
    }
    halved(coarse, |a, b| is_split.contains(&(a.min(b), a.max(b))))
}

/// The nodes in which a curve ends that lie on no other.
fn ends(shape: &Solved) -> Vec<usize> {
    let is_alone = |rank: usize, v: usize| {
        shape.lines.iter().enumerate().all(|(other, line)| other == rank || !line.vertices.contains(&v))
    };
    let open = shape.lines.iter().enumerate().filter(|(_, line)| !line.closed);
    open.flat_map(|(rank, line)| {
        [line.vertices[0], line.vertices[line.vertices.len() - 1]].map(|v| (rank, v))
    })
    .filter(|&(rank, v)| is_alone(rank, v))
    .map(|(_, v)| v)
    .collect()
}

/// The mean length of the edges at a node.
fn mean_edge(shape: &Solved, v: usize) -> f64 {
    let at = shape.triangles.iter().filter(|corners| corners.contains(&v));
    let others: BTreeSet<usize> = at.flatten().copied().filter(|&w| w != v).collect();
    others.iter().map(|&w| shape.positions[w].distance(shape.positions[v])).sum::<f64>() / others.len() as f64
}

/// The same surface with some of its edges halved, at rest.
fn halved(coarse: &Solved, is_split: impl Fn(usize, usize) -> bool) -> Solved {
    let mut positions = coarse.positions.clone();
    let mut middles = BTreeMap::new();
    let mut middle = |a: usize, b: usize| {
        is_split(a, b).then(|| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                let chord = coarse.positions[b] - coarse.positions[a];
                // Half way between the middle of the chord and those of the two tangent planes there.
                let [up, down] = [a, b].map(|v| coarse.normals[v] * coarse.normals[v].dot(chord));
                positions.push(coarse.positions[a] + 0.5 * chord + 0.125 * (down - up));
                positions.len() - 1
            })
        })
    };
    let mut triangles = Vec::with_capacity(4 * coarse.triangles.len());
    for &[a, b, c] in &coarse.triangles {
        match [middle(a, b), middle(b, c), middle(c, a)] {
            [Some(ab), Some(bc), Some(ca)] => {
                triangles.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
            }
            [None, None, None] => triangles.push([a, b, c]),
            sides => {
                // Turned so that the first side is halved and the last is not.
                let first = (0..3).find(|&k| sides[k].is_some() && sides[(k + 2) % 3].is_none());
                let first = first.expect("some are and some are not");
                let corner = |k: usize| [a, b, c][(first + k) % 3];
                let (a, b, c) = (corner(0), corner(1), corner(2));
                match (sides[first], sides[(first + 1) % 3]) {
                    (Some(ab), Some(bc)) => triangles.extend([[ab, b, bc], [a, ab, bc], [a, bc, c]]),
                    (Some(ab), None) => triangles.extend([[a, ab, c], [ab, b, c]]),
                    (None, _) => unreachable!("the first side is halved"),
                }
            }
        }
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
    let mut settings = Settings::default();
    settings.sampling = Sampling::Inside;
    let mut solver = SurfaceSolver::new(rings, fixed, settings).expect("it can be solved");
    // Many iterations a step, for a fit of so many nodes is dear.
    let budget = Budget { iterations: 30 };
    let is_at_rest = (0..60).any(|_| solver.step(&mut positions, budget).expect("finite positions").at_rest);
    assert!(is_at_rest, "a finer mesh of a shape at rest rests soon");
    solver.fit_all(&positions);
    let (normals, energy) = (solver.normals().to_vec(), solver.energy());
    Solved { positions, normals, triangles, lines, pins: coarse.pins.clone(), energy }
}

/// A curve with a sample more in each of its edges that are halved, at rest.
fn refined_line(line: &Line, positions: &[DVec3], middles: &BTreeMap<(usize, usize), usize>) -> Line {
    let count = line.nodes.len();
    let (mut nodes, mut vertices, mut controls) = (Vec::new(), Vec::new(), Vec::new());
    for (k, (&at, &v)) in line.nodes.iter().zip(&line.vertices).enumerate() {
        if line.controls.contains(&k) {
            controls.push(nodes.len());
        }
        nodes.push(at);
        vertices.push(v);
        let w = line.vertices[(k + 1) % count];
        if let Some(&middle) = middles.get(&(v.min(w), v.max(w))).filter(|_| k + 1 < count || line.closed) {
            vertices.push(middle);
            nodes.push(positions[middle]);
        }
    }
    let fixed = (0..nodes.len()).map(|k| controls.contains(&k)).collect();
    let mut solver = CurveSolver::new(nodes.len(), line.closed, fixed, CurveSettings::default())
        .expect("a curve can be solved");
    let is_at_rest = (0..100).any(|_| solver.step(&mut nodes).expect("finite positions").at_rest);
    assert!(is_at_rest, "a finer polygon of a curve at rest rests soon");
    Line { nodes, vertices, closed: line.closed, controls }
}
