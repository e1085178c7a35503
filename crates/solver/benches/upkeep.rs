//! What mesh improvement costs: a torus remeshed from scratch, one batch with little to do, and the set-up of a solver
//! after a change of topology. `cargo bench -p ductile-solver --bench upkeep`.

#[cfg(not(target_arch = "wasm32"))]
mod native {
    use criterion::{BatchSize, Criterion};
    use ductile_mesh::remesh::{Ledger, Limits, Sizing, improve_changed, midpoint};
    use ductile_mesh::{EdgeId, Mesh, VertexId};
    use ductile_solver::workload::{self, Stream};
    use ductile_solver::{Aim, EdgePlaces, Rings, smooth};
    use glam::DVec3;

    /// Edge length at which the torus comes out with about 10,000 nodes.
    const SPACING: f64 = 0.108;
    /// Rounds at a finer spacing first: edges of all lengths that are allowed can still make a mesh of needles.
    const FINE_ROUNDS: usize = 2;
    const FINER: f64 = 0.7;
    const ROUNDS: usize = 12;
    const SMOOTHING: f64 = 0.6;

    /// A torus of radii 2 and 1 on a grid of 400 by 25, its squares cut along random diagonals.
    fn torus() -> (Mesh, Vec<DVec3>) {
        let (around, across) = (400, 25);
        let mut stream = Stream::new(7);
        let (mut positions, mut triangles) = (Vec::new(), Vec::new());
        let turn = |part: u32, of: u32| libm::sincos(std::f64::consts::TAU * f64::from(part) / f64::from(of));
        for j in 0..across {
            for i in 0..around {
                let ((sin_u, cos_u), (sin_v, cos_v)) = (turn(i, around), turn(j, across));
                positions.push(DVec3::new((2.0 + cos_v) * cos_u, (2.0 + cos_v) * sin_u, sin_v));
                let at = |i: u32, j: u32| (j % across) * around + i % around;
                let (a, b, c, d) = (at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                let rises = stream.unit() < 0.5;
                triangles.extend(if rises { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
            }
        }
        (Mesh::from_triangles(positions.len(), &triangles).expect("a grid is a surface"), positions)
    }

    /// Rings over compact nodes, as a modeler binds them.
    struct Bound {
        rings: Rings,
        vertices: Vec<VertexId>,
        compact: Vec<u32>,
        positions: Vec<DVec3>,
    }

    impl Bound {
        fn new(mesh: &Mesh, positions: &[DVec3]) -> Self {
            let vertices: Vec<VertexId> = mesh.vertices().collect();
            let mut compact = vec![u32::MAX; mesh.vertex_slots()];
            for (node, v) in (0_u32..).zip(&vertices) {
                compact[v.index()] = node;
            }
            let triangles: Vec<[u32; 3]> =
                mesh.faces().map(|f| mesh.face_vertices(f).map(|v| compact[v.index()])).collect();
            let rings = Rings::from_triangles(vertices.len(), &triangles).expect("remeshing keeps a surface");
            let positions = vertices.iter().map(|v| positions[v.index()]).collect();
            Self { rings, vertices, compact, positions }
        }

        fn place(&self, places: &mut EdgePlaces<'_>, mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> DVec3 {
            let nodes =
                mesh.edge_vertices(e).map(|v| self.compact.get(v.index()).copied().unwrap_or(u32::MAX));
            match nodes {
                [a, b] if a != u32::MAX && b != u32::MAX && self.rings.ring(a as usize).contains(&b) => {
                    places.at(a, b)
                }
                _ => midpoint(mesh, positions, e),
            }
        }
    }

    /// Remeshes to an even spacing, new and moved vertices on the fitted quadratics, as a modeler does.
    fn remesh(mesh: &mut Mesh, positions: &mut Vec<DVec3>) {
        let limits = Limits { growth: 2.0, ..Limits::default() };
        let mut ledger = Ledger::default();
        let mut bound = Bound::new(mesh, positions);
        for round in 0..ROUNDS {
            let mut sizing = Sizing::Uniform(if round < FINE_ROUNDS { FINER * SPACING } else { SPACING });
            let mut places = EdgePlaces::new(&bound.rings, &bound.positions);
            let mut place = |mesh: &Mesh, at: &[DVec3], e| bound.place(&mut places, mesh, at, e);
            let ledger = (&mut ledger, 0.01);
            let edits = improve_changed(mesh, positions, &mut sizing, ledger, &limits, &mut place);
            if edits.count() > 0 {
                bound = Bound::new(mesh, positions);
            }
            let movable = vec![true; bound.vertices.len()];
            smooth(&bound.rings, &mut bound.positions, &movable, SMOOTHING, Aim::Shapely, None);
            for (v, at) in bound.vertices.iter().zip(&bound.positions) {
                positions[v.index()] = *at;
            }
        }
    }

    pub(crate) fn main() {
        let mut criterion = Criterion::default().sample_size(10).configure_from_args();
        let rough = torus();
        criterion.bench_function("e: remesh the anisotropic torus", |bencher| {
            bencher.iter_batched_ref(|| rough.clone(), |(mesh, at)| remesh(mesh, at), BatchSize::LargeInput);
        });

        // One vertex in two hundred has moved far enough that the mesh around it wants edits.
        let (mut mesh, mut positions) = rough;
        remesh(&mut mesh, &mut positions);
        let (mut ledger, mut sizing) = (Ledger::default(), Sizing::Uniform(SPACING));
        let limits = Limits::default();
        for _ in 0..10 {
            improve_changed(
                &mut mesh,
                &mut positions,
                &mut sizing,
                (&mut ledger, 0.0),
                &limits,
                &mut midpoint,
            );
        }
        let mut moved = positions.clone();
        for v in mesh.vertices().step_by(200) {
            if let Some(w) = mesh.neighbours(v).next() {
                moved[v.index()] = positions[v.index()].lerp(positions[w.index()], 0.45);
            }
        }
        criterion.bench_function("f: one batch, one vertex in two hundred moved", |bencher| {
            bencher.iter_batched_ref(
                || (mesh.clone(), moved.clone(), ledger.clone()),
                |(mesh, at, ledger)| {
                    let ledger = (ledger, 0.0);
                    improve_changed(mesh, at, &mut Sizing::Uniform(SPACING), ledger, &limits, &mut midpoint)
                },
                BatchSize::LargeInput,
            );
        });

        let shape = workload::disc(57);
        criterion.bench_function(&format!("j: set-up, {} nodes", shape.positions.len()), |bencher| {
            bencher.iter(|| shape.solver());
        });
        criterion.final_summary();
    }
}

fn main() {
    #[cfg(not(target_arch = "wasm32"))]
    native::main();
}
