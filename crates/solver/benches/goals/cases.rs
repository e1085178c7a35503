//! What the goals a to f and j measure, natively and in a worker by the same cases.
//!
//! A case says what is got ready outside the measured time and what is measured; the figures go by the letters of
//! `docs/performance.md`.

use ductile_mesh::Mesh;
use ductile_mesh::remesh::{Ledger, Limits, Sizing, improve_changed, midpoint};
use ductile_solver::workload::{self, Workload};
use ductile_solver::{Budget, Rings, Sampling, Settings, SurfaceSolver};
use glam::DVec3;

use crate::torus;

/// One figure of the table.
#[derive(Clone, Copy)]
pub(crate) struct Goal {
    /// Its letter and size.
    pub(crate) name: &'static str,
    /// Milliseconds that it may take.
    pub(crate) most: f64,
    pub(crate) make: fn() -> Box<dyn Case>,
}

pub(crate) trait Case {
    /// What is not measured.
    fn ready(&mut self);
    /// What is measured.
    fn run(&mut self);
    /// What happened, when the last run is done.
    fn remark(&mut self) -> String;
}

/// The table. Discs of 18, 57 and 81 rings have 1,027, 9,919 and 19,927 nodes.
#[rustfmt::skip]
pub(crate) const GOALS: [Goal; 20] = [
    Goal { name: "a step 1k", most: 1.0, make: || Box::new(Steps::new(18)) },
    Goal { name: "a step 10k", most: 10.0, make: || Box::new(Steps::new(57)) },
    Goal { name: "a step 20k", most: 20.0, make: || Box::new(Steps::new(81)) },
    Goal { name: "b first frame 10k", most: 12.0, make: || Box::new(FirstFrame::new(57)) },
    Goal { name: "b ten bays 100k", most: 16.0, make: || Box::new(Asleep::new(10, 41)) },
    Goal { name: "b forty bays 100k", most: 16.0, make: || Box::new(Asleep::new(40, 10)) },
    Goal { name: "b awake ten bays 100k", most: 16.0, make: || Box::new(Awake::new(10, 41, false)) },
    Goal { name: "b awake forty bays 100k", most: 16.0, make: || Box::new(Awake::new(40, 10, false)) },
    Goal { name: "b held ten bays 100k", most: 16.0, make: || Box::new(Awake::new(10, 41, true)) },
    Goal { name: "b held forty bays 100k", most: 16.0, make: || Box::new(Awake::new(40, 10, true)) },
    Goal { name: "c to rest 1k", most: 10.0, make: || Box::new(ToRest::new(18)) },
    Goal { name: "c to rest 10k", most: 60.0, make: || Box::new(ToRest::new(57)) },
    Goal { name: "c to rest 20k", most: 120.0, make: || Box::new(ToRest::new(81)) },
    // 270 ns a node for a fit, and as much for a gradient; what is measured beside the fit fits twice and takes one gradient.
    Goal { name: "d fit 10k", most: 2.68, make: || Box::new(Sweeps::new(57, false)) },
    Goal { name: "d fit twice and gradient 10k", most: 8.03, make: || Box::new(Sweeps::new(57, true)) },
    Goal { name: "e remesh torus", most: 280.0, make: || Box::new(Remesh::new()) },
    Goal { name: "f one pass", most: 3.0, make: || Box::new(Pass::new()) },
    Goal { name: "j set-up 1k", most: 1.0, make: || Box::new(SetUp::new(18)) },
    Goal { name: "j set-up 10k", most: 8.0, make: || Box::new(SetUp::new(57)) },
    Goal { name: "j set-up 20k", most: 16.0, make: || Box::new(SetUp::new(81)) },
];

/// A solver at rest on a disc that is raised by so much, its factor in hand and nothing else of a drag.
fn rested(rings: usize, raise: f64) -> (SurfaceSolver, Vec<DVec3>) {
    let (mut leader, mut positions) = workload::raised_disc(rings, raise).expect("a disc is a surface");
    workload::relax(&mut leader, &mut positions, 60).expect("a disc can be relaxed");
    let mut solver = with(&workload::disc(rings), Settings::default());
    workload::relax(&mut solver, &mut positions, 60).expect("a disc can be relaxed");
    (solver, positions)
}

/// As the modeler makes it: bending is sampled inside held rims.
fn with(shape: &Workload, mut settings: Settings) -> SurfaceSolver {
    settings.sampling = Sampling::Inside;
    let rings = Rings::from_triangles(shape.positions.len(), &shape.triangles).expect("a surface");
    SurfaceSolver::new(rings, shape.fixed.clone(), settings).expect("the shape can be solved")
}

/// Frames of a drag to and fro, ten each way.
fn sway(frame: usize, by: f64) -> f64 {
    if (frame / 10).is_multiple_of(2) { by } else { -by }
}

/// a: the step of one frame after another of a drag, the predictor outside the measured time. The residual is that of the
/// goal, 1e-2; the modeler asks for 3e-2.
struct Steps {
    solver: SurfaceSolver,
    positions: Vec<DVec3>,
    frame: usize,
    iterations: Vec<u32>,
}

impl Steps {
    fn new(rings: usize) -> Self {
        let mut settings = Settings::default();
        settings.step_tolerance = 1e-2;
        let (mut solver, mut positions) = (with(&workload::disc(rings), settings), rested(rings, 0.3).1);
        workload::relax(&mut solver, &mut positions, 60).expect("a disc can be relaxed");
        Self { solver, positions, frame: 0, iterations: Vec::new() }
    }
}

impl Case for Steps {
    fn ready(&mut self) {
        let by = DVec3::Z * sway(self.frame, 0.02);
        let done = self.solver.predict(&mut self.positions, &[(0, by)]).expect("the centre is fixed");
        assert!(done.fraction >= 1.0, "the drag is slow");
        self.frame += 1;
    }

    fn run(&mut self) {
        let report = self.solver.step(&mut self.positions, Budget::default()).expect("a step");
        assert!(!report.damped && report.residual <= 1e-2, "{report:?}");
        self.iterations.push(report.cg_iterations);
    }

    fn remark(&mut self) -> String {
        let most = self.iterations.iter().max().map_or(0, |&most| most);
        format!("{} nodes, at most {most} iterations", self.positions.len())
    }
}

/// b: predictor and step when a control of a shape at rest begins to move.
struct FirstFrame {
    rested: (SurfaceSolver, Vec<DVec3>),
    now: (SurfaceSolver, Vec<DVec3>),
}

impl FirstFrame {
    fn new(rings: usize) -> Self {
        let rested = rested(rings, 0.3);
        Self { now: rested.clone(), rested }
    }
}

impl Case for FirstFrame {
    fn ready(&mut self) {
        self.now = self.rested.clone();
    }

    fn run(&mut self) {
        let (solver, positions) = &mut self.now;
        let done = solver.predict(positions, &[(0, DVec3::Z * 0.02)]).expect("the centre is fixed");
        assert!(done.fraction >= 1.0, "the drag is slow");
        solver.step(positions, Budget::default()).expect("a step");
    }

    fn remark(&mut self) -> String {
        format!("{} nodes", self.now.1.len())
    }
}

/// b: a frame of a drag of the first circle of a long tube, whose far bays sleep.
struct Asleep {
    solver: SurfaceSolver,
    positions: Vec<DVec3>,
    moved: Vec<u32>,
    frame: usize,
    most_awake: usize,
}

impl Asleep {
    fn new(bays: u32, along: u32) -> Self {
        let shape = workload::tube_of_bays(240, bays, along);
        let (mut solver, mut positions) = (with(&shape, Settings::default()), shape.positions);
        workload::relax(&mut solver, &mut positions, 60).expect("a tube can be relaxed");
        let mut case = Self { solver, positions, moved: (0..240).collect(), frame: 0, most_awake: 0 };
        // Until as much sleeps as will.
        for _ in 0..10 {
            case.run();
        }
        case.most_awake = 0;
        case
    }
}

impl Case for Asleep {
    fn ready(&mut self) {}

    fn run(&mut self) {
        let by = DVec3::X * sway(self.frame, 0.01);
        let moves: Vec<_> = self.moved.iter().map(|&node| (node, by)).collect();
        let before = self.positions.clone();
        let done = self.solver.predict(&mut self.positions, &moves).expect("circles are fixed");
        assert!(done.fraction >= 1.0, "the drag is slow");
        self.solver.step(&mut self.positions, Budget::default()).expect("a step");
        let awake = self.solver.doze(&before, &self.positions).expect("bays can sleep");
        self.most_awake = self.most_awake.max(awake);
        self.frame += 1;
    }

    fn remark(&mut self) -> String {
        format!("{} nodes, at most {} awake", self.positions.len(), self.most_awake)
    }
}

/// b: the very first frame of that drag, before which nothing sleeps: what lies far falls asleep at its beginning, or when the hand
/// takes hold, before it.
struct Awake {
    is_attended: bool,
    rested: (SurfaceSolver, Vec<DVec3>),
    now: (SurfaceSolver, Vec<DVec3>),
    moves: Vec<(u32, DVec3)>,
    awake: usize,
}

impl Awake {
    fn new(bays: u32, along: u32, is_attended: bool) -> Self {
        let shape = workload::tube_of_bays(240, bays, along);
        let (mut solver, mut positions) = (with(&shape, Settings::default()), shape.positions);
        workload::relax(&mut solver, &mut positions, 60).expect("a tube can be relaxed");
        let rested = (solver, positions);
        let moves = (0..240).map(|node| (node, DVec3::X * 0.01)).collect();
        Self { is_attended, now: rested.clone(), rested, moves, awake: 0 }
    }
}

impl Case for Awake {
    fn ready(&mut self) {
        self.now = self.rested.clone();
        if self.is_attended {
            let nodes: Vec<u32> = self.moves.iter().map(|(node, _)| *node).collect();
            self.now.0.attend(&self.now.1, &nodes).expect("circles are fixed");
        }
    }

    fn run(&mut self) {
        let (solver, positions) = &mut self.now;
        let before = positions.clone();
        let done = solver.predict(positions, &self.moves).expect("circles are fixed");
        assert!(done.fraction >= 1.0, "the drag is slow");
        solver.step(positions, Budget::default()).expect("a step");
        self.awake = solver.doze(&before, positions).expect("bays can sleep");
    }

    fn remark(&mut self) -> String {
        format!("{} nodes, {} awake after it", self.now.1.len(), self.awake)
    }
}

/// c: the centre of a flat disc jumps by half the radius; predictor and steps until the solver says that it rests.
struct ToRest {
    rested: (SurfaceSolver, Vec<DVec3>),
    now: (SurfaceSolver, Vec<DVec3>),
    /// Energy of the converged minimum of this mesh.
    least: f64,
    steps: usize,
}

impl ToRest {
    fn new(rings: usize) -> Self {
        let rested = rested(rings, 0.0);
        let mut case = Self { now: rested.clone(), rested, least: 0.0, steps: 0 };
        case.run();
        let (solver, positions) = &mut case.now;
        for _ in 0..30 {
            solver.step(positions, Budget { iterations: 40 }).expect("a step");
        }
        case.least = solver.energy();
        case
    }
}

impl Case for ToRest {
    fn ready(&mut self) {
        self.now = self.rested.clone();
    }

    fn run(&mut self) {
        let (solver, positions) = &mut self.now;
        workload::carry(solver, positions, 0, DVec3::Z * 0.5).expect("the centre is fixed");
        self.steps = workload::relax(solver, positions, 60).expect("a step").len();
    }

    fn remark(&mut self) -> String {
        let error = self.now.0.energy() / self.least - 1.0;
        assert!(error < 1e-6, "{error}");
        format!("{} nodes, {} steps, energy {error:.0e} above the least", self.now.1.len(), self.steps)
    }
}

/// d: a fit of every node; or a fit, and then the sweep that fits once more and takes the exact gradient.
struct Sweeps {
    solver: SurfaceSolver,
    /// A sweep at the places of the last one is skipped, so there are two sets of them to go between.
    sets: [Vec<DVec3>; 2],
    with_gradient: bool,
}

impl Sweeps {
    fn new(rings: usize, with_gradient: bool) -> Self {
        let (solver, positions) = rested(rings, 0.3);
        let larger = positions.iter().map(|p| 1.5 * *p).collect();
        Self { solver, sets: [positions, larger], with_gradient }
    }
}

impl Case for Sweeps {
    fn ready(&mut self) {
        self.sets.swap(0, 1);
    }

    fn run(&mut self) {
        self.solver.fit_all(&self.sets[0]);
        if self.with_gradient {
            std::hint::black_box(self.solver.gradient().len());
        }
    }

    fn remark(&mut self) -> String {
        format!("{} nodes", self.sets[0].len())
    }
}

/// e: the torus from scratch.
struct Remesh {
    rough: (Mesh, Vec<DVec3>),
    now: (Mesh, Vec<DVec3>),
}

impl Remesh {
    fn new() -> Self {
        let rough = torus::torus();
        Self { now: rough.clone(), rough }
    }
}

impl Case for Remesh {
    fn ready(&mut self) {
        self.now = self.rough.clone();
    }

    fn run(&mut self) {
        torus::remesh(&mut self.now.0, &mut self.now.1);
    }

    fn remark(&mut self) -> String {
        let triangles = torus::Triangles::of(&self.now.0, &self.now.1);
        format!("{} nodes, {triangles}", self.now.0.vertex_count())
    }
}

/// f: one batch on the even torus after one vertex in two hundred was moved.
struct Pass {
    moved: (Mesh, Vec<DVec3>, Ledger),
    now: (Mesh, Vec<DVec3>, Ledger),
    edits: usize,
}

impl Pass {
    fn new() -> Self {
        let (mut mesh, mut positions) = torus::torus();
        torus::remesh(&mut mesh, &mut positions);
        let mut case =
            Self { moved: (mesh, positions, Ledger::default()), now: Default::default(), edits: 0 };
        for _ in 0..10 {
            case.now = case.moved.clone();
            case.run();
            case.moved = case.now.clone();
        }
        let (mesh, positions, _) = &mut case.moved;
        let old = positions.clone();
        for v in mesh.vertices().step_by(200) {
            if let Some(w) = mesh.neighbours(v).next() {
                positions[v.index()] = old[v.index()].lerp(old[w.index()], 0.45);
            }
        }
        case
    }
}

impl Case for Pass {
    fn ready(&mut self) {
        self.now = self.moved.clone();
    }

    fn run(&mut self) {
        let (mesh, positions, ledger) = &mut self.now;
        let mut sizing = Sizing::Uniform(torus::SPACING);
        let edits =
            improve_changed(mesh, positions, &mut sizing, (ledger, 0.0), &Limits::default(), &mut midpoint);
        self.edits = edits.count();
    }

    fn remark(&mut self) -> String {
        let edges = self.now.0.edge_count();
        format!("{} nodes, {} edits on {edges} edges", self.now.0.vertex_count(), self.edits)
    }
}

/// j: rings, matrix and factor for a new connectivity.
struct SetUp(Workload);

impl SetUp {
    fn new(rings: usize) -> Self {
        Self(workload::disc(rings))
    }
}

impl Case for SetUp {
    fn ready(&mut self) {}

    fn run(&mut self) {
        let solver = with(&self.0, Settings::default());
        std::hint::black_box(solver.fixed().len());
    }

    fn remark(&mut self) -> String {
        format!("{} nodes", self.0.positions.len())
    }
}
