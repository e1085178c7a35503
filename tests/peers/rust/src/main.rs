//! Peers in Rust and our own code on the same meshes; prints one line of a table for each figure.
//!
//!     ductile-peers torus OUT.obj         writes the uneven torus of the benches, and prints its spacing
//!     ductile-peers even OUT.obj          the same made even, then one vertex in 200 moved; times one batch of ours on it
//!     ductile-peers tube OUT.obj OUT.held a tube of 96,000 nodes between 41 held circles; times frames of ours on it
//!     ductile-peers plate MESH.obj        one linear solve of the plate: faer; and our step, which is the non-linear one
//!     ductile-peers remesh                baby_shark and ours on that torus
//!     ductile-peers meet MESH.obj DX      where a closed mesh meets itself moved by DX along x
//!
//! What is timed is the least of several runs, for the machine may do other things; without reading and writing.

#[path = "../../../../crates/solver/benches/goals/torus.rs"]
#[allow(dead_code, reason = "the benches use more of it")]
mod torus;

use baby_shark::mesh::corner_table::CornerTable;
use baby_shark::remeshing::incremental::IncrementalRemesher;
use ductile_mesh::io::obj;
use ductile_mesh::remesh::{Ledger, Limits, Sizing, improve_changed, midpoint};
use ductile_mesh::{Mesh, intersections};
use ductile_solver::{Budget, Rings, Sampling, Settings, SurfaceSolver, workload};
use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Llt, SymbolicLlt};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, Side};
use glam::DVec3;
use std::collections::BTreeMap;
use std::time::Instant;

const REPEATS: usize = 15;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["torus", out] => {
            let (mesh, positions) = torus::torus();
            write(out, &mesh, &positions);
            println!("{}", torus::SPACING);
        }
        ["even", out] => even(out),
        ["tube", out, held] => tube(out, held),
        ["plate", path] => plate(path),
        ["remesh"] => remesh(),
        ["meet", path, by] => meet(path, by.parse().expect("a number")),
        _ => panic!(
            "torus OUT.obj | even OUT.obj | tube OUT.obj OUT.held | plate MESH.obj | remesh | meet MESH.obj DX"
        ),
    }
}

fn read(path: &str) -> (Mesh, Vec<DVec3>) {
    obj::read_mesh(&std::fs::read_to_string(path).expect("a file")).expect("a mesh")
}

fn write(out: &str, mesh: &Mesh, positions: &[DVec3]) {
    std::fs::write(out, obj::write(mesh, positions, None)).expect("a place to write to");
}

/// Figure f: what one batch finds on an even mesh of which something moved.
fn even(out: &str) {
    let (mut mesh, mut positions) = torus::torus();
    torus::remesh(&mut mesh, &mut positions);
    let mut ledger = Ledger::default();
    let batch = |(mesh, positions, ledger): &mut (Mesh, Vec<DVec3>, Ledger)| {
        let mut sizing = Sizing::Uniform(torus::SPACING);
        let ledger = (ledger, 0.0);
        improve_changed(mesh, positions, &mut sizing, ledger, &Limits::default(), &mut midpoint).count()
    };
    for _ in 0..10 {
        let mut given = (mesh, positions, ledger);
        batch(&mut given);
        (mesh, positions, ledger) = given;
    }
    let old = positions.clone();
    for v in mesh.vertices().step_by(200) {
        if let Some(w) = mesh.neighbours(v).next() {
            positions[v.index()] = old[v.index()].lerp(old[w.index()], 0.45);
        }
    }
    write(out, &mesh, &positions);
    let moved = (mesh, positions, ledger);
    let time = least(|| moved.clone(), |mut given| (batch(&mut given), given));
    println!("{{\"seconds\": {}, \"edits\": {}}}", 1e-3 * time, batch(&mut moved.clone()));
}

/// Figure b: a frame of a drag of the first circle, the very first one and one whose far bays sleep.
fn tube(out: &str, held: &str) {
    let shape = workload::tube_of_bays(240, 40, 10);
    let mesh = Mesh::from_triangles(shape.positions.len(), &shape.triangles).expect("a tube");
    write(out, &mesh, &shape.positions);
    let nodes = (0..shape.fixed.len()).filter(|&node| shape.fixed[node]).map(|node| node.to_string());
    std::fs::write(held, nodes.collect::<Vec<_>>().join("\n")).expect("a place to write to");
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).expect("a tube");
    let mut settings = Settings::default();
    settings.sampling = Sampling::Inside;
    let solver = SurfaceSolver::new(rings, shape.fixed.clone(), settings).expect("a tube");
    let mut rested = (solver, shape.positions.clone());
    workload::relax(&mut rested.0, &mut rested.1, 60).expect("a step");
    let frame = |(mut solver, mut positions): (SurfaceSolver, Vec<DVec3>)| {
        let before = positions.clone();
        let moves: Vec<_> = (0..240).map(|node| (node, DVec3::X * 0.01)).collect();
        solver.predict(&mut positions, &moves).expect("a held circle");
        solver.step(&mut positions, Budget::default()).expect("a step");
        solver.doze(&before, &positions).expect("bays can sleep");
        (solver, positions)
    };
    let first = least(|| rested.clone(), frame);
    for _ in 0..10 {
        rested = frame(rested);
    }
    let later = least(|| rested.clone(), frame);
    println!(
        "{{\"first\": {}, \"later\": {}, \"asleep\": {}}}",
        1e-3 * first,
        1e-3 * later,
        rested.0.asleep()
    );
}

/// Least time in milliseconds of work on what is got ready outside of it.
fn least<T, U>(mut ready: impl FnMut() -> T, mut work: impl FnMut(T) -> U) -> f64 {
    let times = (0..REPEATS).map(|_| {
        let given = ready();
        let start = Instant::now();
        let done = work(given);
        let time = start.elapsed().as_secs_f64();
        drop(done);
        1e3 * time
    });
    times.fold(f64::INFINITY, f64::min)
}

fn plate(path: &str) {
    let (mesh, positions) = read(path);
    let count = positions.len();
    let highest = (0..count).max_by(|a, b| positions[*a].z.total_cmp(&positions[*b].z)).expect("nodes");
    let mut fixed = vec![false; count];
    mesh.vertices().filter(|&v| mesh.is_boundary_vertex(v)).for_each(|v| fixed[v.index()] = true);
    fixed[highest] = true;
    let triangles = mesh.to_triangles();
    let (matrix, right) = biharmonic(&triangles, &positions, &fixed);
    let name = format!("{count} nodes");
    let symbolic = || SymbolicLlt::try_new(matrix.symbolic(), Side::Lower).expect("a pattern");
    let analysed = symbolic();
    let numeric =
        || Llt::try_new_with_symbolic(analysed.clone(), matrix.as_ref(), Side::Lower).expect("positive");
    let factor = numeric();
    line(&name, "faer: order and analyse", least(|| (), |()| symbolic()));
    line(&name, "faer: factor", least(|| (), |()| numeric()));
    line(&name, "faer: solve for x, y, z", least(|| right.clone(), |right| factor.solve(&right)));

    let rings = || Rings::from_triangles(count, &triangles).expect("a surface");
    let solver = |rings| SurfaceSolver::new(rings, fixed.clone(), Settings::default()).expect("a shape");
    line(&name, "ductile: set-up for a connectivity", least(|| (), |()| solver(rings())));
    let mut rested = (solver(rings()), positions.clone());
    for _ in 0..30 {
        rested.0.step(&mut rested.1, Budget::default()).expect("a step");
    }
    let raised = |given: &mut (SurfaceSolver, Vec<DVec3>)| {
        let held = u32::try_from(highest).expect("a node");
        given.0.predict(&mut given.1, &[(held, DVec3::Z * 0.02)]).expect("a held node");
    };
    let step = |mut given: (SurfaceSolver, Vec<DVec3>)| {
        given.0.step(&mut given.1, Budget::default()).expect("a step");
        given
    };
    let ready = || rested.clone();
    let led = || {
        let mut given = rested.clone();
        raised(&mut given);
        given
    };
    line(&name, "ductile: one non-linear step", least(led, step));
    let frame = |mut given| {
        raised(&mut given);
        step(given)
    };
    line(&name, "ductile: a frame, predictor and step", least(ready, frame));
}

fn line(mesh: &str, what: &str, milliseconds: f64) {
    println!("| {mesh} | {what} | {milliseconds:.2} ms |");
}

/// `K M⁻¹ K` on the free nodes with cotangents and a third of the triangles' areas, and what the held nodes put on the right.
fn biharmonic(
    triangles: &[[u32; 3]],
    positions: &[DVec3],
    fixed: &[bool],
) -> (SparseColMat<usize, f64>, Mat<f64>) {
    let mut rows: Vec<BTreeMap<usize, f64>> = vec![BTreeMap::new(); positions.len()];
    let mut areas = vec![0.0; positions.len()];
    for triangle in triangles {
        let nodes = triangle.map(|node| node as usize);
        let at = nodes.map(|node| positions[node]);
        let double = (at[1] - at[0]).cross(at[2] - at[0]).length();
        for k in 0..3 {
            let (i, j, l) = (nodes[k], nodes[(k + 1) % 3], (k + 2) % 3);
            let weight = 0.5 * (at[k] - at[l]).dot(at[(k + 1) % 3] - at[l]) / double;
            for (a, b, w) in [(i, j, -weight), (j, i, -weight), (i, i, weight), (j, j, weight)] {
                *rows[a].entry(b).or_default() += w;
            }
            areas[i] += double / 6.0;
        }
    }
    let mut index = vec![usize::MAX; positions.len()];
    let free: Vec<usize> = (0..positions.len()).filter(|&node| !fixed[node]).collect();
    free.iter().enumerate().for_each(|(k, &node)| index[node] = k);
    let mut entries = Vec::new();
    let mut right = Mat::zeros(free.len(), 3);
    for (k, &node) in free.iter().enumerate() {
        let mut row: BTreeMap<usize, f64> = BTreeMap::new();
        for (&middle, w) in &rows[node] {
            rows[middle].iter().for_each(|(&far, v)| *row.entry(far).or_default() += w * v / areas[middle]);
        }
        for (far, value) in row {
            if fixed[far] {
                positions[far]
                    .to_array()
                    .iter()
                    .enumerate()
                    .for_each(|(axis, x)| right[(k, axis)] -= value * x);
            } else {
                entries.push(Triplet::new(k, index[far], value));
            }
        }
    }
    let matrix = SparseColMat::try_new_from_triplets(free.len(), free.len(), &entries).expect("a matrix");
    (matrix, right)
}

fn remesh() {
    let (mesh, positions) = torus::torus();
    let faces: Vec<usize> = mesh.to_triangles().iter().flatten().map(|&node| node as usize).collect();
    let corners = positions.iter().map(|p| p.to_array().into());
    let table = CornerTable::<f64>::from_vertex_and_face_iters(corners, faces.iter().copied());
    let work = |mut table: CornerTable<f64>| {
        IncrementalRemesher::new().remesh(&mut table, torus::SPACING);
        table
    };
    let time = least(|| table.clone(), work);
    told("baby_shark, 10 rounds", time, &of_table(&work(table.clone())));
    let ours = |mut rough: (Mesh, Vec<DVec3>)| {
        torus::remesh(&mut rough.0, &mut rough.1);
        rough
    };
    let time = least(torus::torus, ours);
    told("ductile, 12 rounds", time, &Some(ours(torus::torus())));
}

/// The triangles of a corner table; corners at one place are one node. `None` if they are no surface.
fn of_table(table: &CornerTable<f64>) -> Option<(Mesh, Vec<DVec3>)> {
    let (mut nodes, mut positions, mut triangles) = (BTreeMap::new(), Vec::new(), Vec::new());
    for face in table.faces() {
        let at = table.face_positions(face);
        triangles.push([*at.p1(), *at.p2(), *at.p3()].map(|p| {
            *nodes.entry([p.x.to_bits(), p.y.to_bits(), p.z.to_bits()]).or_insert_with(|| {
                positions.push(DVec3::new(p.x, p.y, p.z));
                u32::try_from(positions.len() - 1).expect("a node")
            })
        }));
    }
    Some((Mesh::from_triangles(positions.len(), &triangles).ok()?, positions))
}

fn told(what: &str, milliseconds: f64, found: &Option<(Mesh, Vec<DVec3>)>) {
    match found {
        Some((mesh, positions)) => {
            let triangles = torus::Triangles::of(mesh, positions);
            println!("| {what} | {milliseconds:.0} ms | {} nodes, {triangles} |", mesh.vertex_count());
        }
        None => println!("| {what} | {milliseconds:.0} ms | no surface any more |"),
    }
}

fn meet(path: &str, by: f64) {
    let (mesh, positions) = read(path);
    let moved: Vec<DVec3> = positions.iter().map(|p| *p + DVec3::X * by).collect();
    let find = |()| intersections((&mesh, &positions), (&mesh, &moved)).expect("surfaces that meet");
    let time = least(|| (), find);
    let lines = find(());
    println!("| ductile: the lines in which they meet, natively | {time:.0} ms | {} lines |", lines.len());
}
