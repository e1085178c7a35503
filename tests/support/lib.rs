//! Support for the acceptance tests: a modeler driven through its one door, with every invariant checked
//! after every request.

pub mod dice;
pub mod files;
pub mod kinds;
pub mod promise;
pub mod reference;
pub mod refined;
pub mod round;
pub mod scribble;
pub mod shapes;
pub mod solved;

use ductile_mesh::validate;
use ductile_modeler::Modeler;
use ductile_spec::{Document, Edit, Example, Reply, Request, Step, Structure, from_text};
use glam::DVec3;
use std::collections::BTreeSet;

/// A modeler whose every reply is checked.
#[derive(Debug)]
pub struct Bench {
    /// The modeler itself.
    pub modeler: Modeler,
    /// The text of the document after the last act.
    pub document: String,
    /// What the newest frame is made of.
    structure: Structure,
}

impl Default for Bench {
    fn default() -> Self {
        Self::new()
    }
}

impl Bench {
    /// An empty one.
    #[must_use]
    pub fn new() -> Self {
        Self { modeler: Modeler::new(), document: String::new(), structure: Structure::default() }
    }

    /// One with an example open.
    #[must_use]
    pub fn with(example: Example) -> Self {
        let mut bench = Self::new();
        bench.accept(Request::OpenExample(example));
        bench
    }

    /// Sends a request and checks everything that must always hold.
    ///
    /// # Panics
    /// When an invariant is broken.
    pub fn send(&mut self, request: Request) -> Reply {
        let asked = format!("{request:?}");
        let reply = self.modeler.handle(request);
        if let Some(committed) = &reply.committed {
            self.document.clone_from(&committed.document);
        }
        if let Some(structure) = &reply.structure {
            self.structure.clone_from(structure);
        }
        self.check(&asked);
        reply
    }

    /// Sends a request that must not be refused.
    ///
    /// # Panics
    /// When it is refused.
    pub fn accept(&mut self, request: Request) -> Reply {
        let reply = self.send(request);
        assert_eq!(reply.refused, None);
        reply
    }

    /// Acts.
    pub fn edit(&mut self, edit: Edit) -> Reply {
        self.accept(Request::Edit(edit))
    }

    /// Steps with the hand at a place, or without a hand.
    pub fn step(&mut self, drag: Option<DVec3>) -> Reply {
        self.accept(Request::Step(Step { drag, iterations: 20 }))
    }

    /// Steps until nothing moves; returns the energy.
    ///
    /// # Panics
    /// When that takes more than `limit` steps.
    pub fn rest(&mut self, limit: u32) -> f64 {
        for _ in 0..limit {
            let reply = self.step(None);
            if reply.frame.settled {
                return reply.frame.figures.energy;
            }
        }
        panic!("not at rest after {limit} steps: {:?}", self.modeler.relaxer().states().collect::<Vec<_>>());
    }

    /// The document as it is committed.
    ///
    /// # Panics
    /// When its text cannot be read back.
    #[must_use]
    pub fn document(&self) -> Document {
        from_text(&self.document).unwrap_or_else(|error| panic!("{error}: {}", self.document))
    }

    fn check(&self, asked: &str) {
        let model = self.modeler.model();
        assert!(
            self.modeler.floats().iter().all(|x| x.is_finite()),
            "a number of the frame is not finite after {asked}"
        );
        let vertices: usize = model.surfaces.values().map(|s| s.mesh.vertex_count()).sum();
        let samples: usize = model.curves.values().map(|c| c.nodes.len()).sum();
        let exact: usize =
            model.patches.values().map(|p| 6 * p.positions().len() + 3 * p.net().0.len()).sum();
        // A vertex is made at each foot of a displacement that stands on none, so displaced surfaces have more.
        let feet: usize = model
            .document
            .displacements
            .values()
            .flat_map(|d| &d.items)
            .map(|item| item.foot.places().len())
            .sum();
        let least = 6 * vertices + exact + 3 * samples + 3 * model.document.points.len();
        let floats = self.modeler.floats().len();
        assert_eq!(
            floats,
            self.structure.float_count(),
            "a frame is not what its structure says after {asked}"
        );
        assert!(
            (least..=least + 6 * feet).contains(&floats),
            "a frame misses something after {asked}: {floats}"
        );
        model.document.validate().unwrap_or_else(|defect| panic!("{defect} after {asked}"));
        assert!(model.curves.keys().eq(model.document.curves.keys()), "curves after {asked}");
        assert!(model.surfaces.keys().eq(model.document.surfaces.keys()), "surfaces after {asked}");
        let document = &model.document;
        let fixed = document.meshes.keys();
        let exact: BTreeSet<_> = document.cages.keys().chain(document.fills.keys()).chain(fixed).collect();
        assert!(model.patches.keys().eq(exact), "exact surfaces after {asked}");
        for (id, shape) in &model.surfaces {
            validate(&shape.mesh).unwrap_or_else(|defects| panic!("{id}: {defects:?} after {asked}"));
            for embedded in &shape.embeddings {
                assert_eq!(
                    embedded.vertices.len(),
                    model.curves[&embedded.curve].nodes.len(),
                    "{id} after {asked}"
                );
            }
        }
    }
}

/// Checksum of the exact bits of all shapes after opening an example, dragging its last point and stepping.
#[must_use]
pub fn bits_after(example: Example, steps: u32) -> u32 {
    let mut bench = Bench::with(example);
    let model = bench.modeler.model();
    let (point, at) = model
        .document
        .points
        .last_key_value()
        .map_or((ductile_spec::PointId(1), DVec3::ZERO), |(id, at)| (*id, *at));
    bench.accept(Request::Grab(ductile_spec::GrabTarget::Point(point)));
    for step in 0..steps {
        let drag = (step < 20).then(|| at + DVec3::new(0.01, 0.005, 0.02) * f64::from(step + 1));
        bench.step(drag);
    }
    let mut hasher = crc32fast::Hasher::new();
    let model = bench.modeler.model();
    let mut add = |at: DVec3| at.to_array().iter().for_each(|x| hasher.update(&x.to_bits().to_le_bytes()));
    for shape in model.surfaces.values() {
        shape.mesh.vertices().for_each(|v| add(shape.positions[v.index()]));
    }
    for shape in model.patches.values() {
        shape.positions().iter().chain(shape.normals()).for_each(|at| add(*at));
    }
    for node in model.curves.values().flat_map(|c| &c.nodes) {
        node.to_array().iter().for_each(|x| hasher.update(&x.to_bits().to_le_bytes()));
    }
    hasher.finalize()
}
