//! A solver bound to one shape and one revision of it: the bridge between mesh handles and compact nodes.

use crate::bank;
use crate::error::ModelError;
use crate::model::Model;
use crate::plane::Planes;
use crate::region::{self, Choice, solver_objective};
use crate::shape::{CurveShape, GROWN, SurfaceShape};
use ductile_mesh::VertexId;
use ductile_solver::{
    Aim, CurveSettings, CurveSolver, EdgePlaces, Predicted, Rings, Sampling, Settings, SolverError,
    SurfaceSolver,
};
use ductile_spec::{CurveId, Document, Objective, PointId, Region, SurfaceId};
use glam::DVec3;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// Jacobian of a fit from which on the mesh resolves the shape (recipe, section 7).
const RESOLVED: f64 = 0.7;
/// An edge longer than this many spacings is worn. (At rest edges are split from 1.35 on.)
const STRETCHED: f64 = 1.8;
/// An edge longer than this many spacings is about to break: what it spans is no longer the shape, however fast the hand.
const BREAKING: f64 = 2.5;

/// What the controls ask of the nodes that follow them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Motion {
    /// Node and displacement, as a predictor takes them.
    by: Vec<(u32, DVec3)>,
    /// Where each is to be: start + displacement has a rounding error, this has none.
    to: Vec<DVec3>,
}

impl Motion {
    fn add(&mut self, node: u32, from: DVec3, to: DVec3) {
        if from != to {
            self.by.push((node, to - from));
            self.to.push(to);
        }
    }

    /// How many nodes are not where they are to be.
    pub(crate) fn count(&self) -> usize {
        self.by.len()
    }

    /// Whether every control is met.
    pub(crate) fn is_empty(&self) -> bool {
        self.by.is_empty()
    }

    /// Lets a predictor carry the nodes as far as its strain limit allows. Returns whether all the way.
    fn carry(
        &self,
        positions: &mut [DVec3],
        predict: impl FnOnce(&mut [DVec3], &[(u32, DVec3)]) -> Result<Predicted, SolverError>,
    ) -> Result<bool, SolverError> {
        if self.is_empty() {
            return Ok(true);
        }
        let is_met = predict(positions, &self.by)?.fraction >= 1.0;
        if is_met {
            for ((node, _), to) in self.by.iter().zip(&self.to) {
                positions[*node as usize] = *to;
            }
        }
        Ok(is_met)
    }
}

/// A surface solver for one revision of a surface.
#[derive(Clone, Debug)]
pub struct BoundSurface {
    /// Which connectivity it was made for.
    pub(crate) revision: u64,
    /// The solver, over compact nodes.
    pub(crate) solver: SurfaceSolver,
    /// Positions by compact node; the shape's are written from these.
    pub(crate) positions: Vec<DVec3>,
    vertices: Vec<VertexId>,
    compact: Vec<u32>,
    choice: Choice,
    /// Whether it is to be fair, but not yet.
    pub(crate) is_beginning: bool,
}

impl BoundSurface {
    /// Sets up the solver for a surface as it is now.
    pub(crate) fn new(id: SurfaceId, shape: &SurfaceShape) -> Result<Self, ModelError> {
        let fail = |reason| ModelError::Unsolvable { what: id.to_string(), reason };
        let vertices: Vec<VertexId> = shape.mesh.vertices().collect();
        let mut compact = vec![u32::MAX; shape.mesh.vertex_slots()];
        for (node, v) in (0_u32..).zip(&vertices) {
            compact[v.index()] = node;
        }
        let triangles: Vec<[u32; 3]> =
            shape.mesh.faces().map(|f| shape.mesh.face_vertices(f).map(|v| compact[v.index()])).collect();
        let rings = Rings::from_triangles(vertices.len(), &triangles).map_err(|e| fail(e.into()))?;
        let mut fixed = vec![false; vertices.len()];
        for v in shape.controlled() {
            fixed[compact[v.index()] as usize] = true;
        }
        let mut settings = Settings::default();
        settings.sampling = Sampling::Inside;
        let solver = SurfaceSolver::new(rings, fixed, settings).map_err(fail)?;
        let positions: Vec<DVec3> = vertices.iter().map(|v| shape.positions[v.index()]).collect();
        let (revision, choice) = (shape.revision, Choice::default());
        Ok(Self { revision, solver, positions, vertices, compact, choice, is_beginning: false })
    }

    /// Takes over what the document wants minimised; returns whether that is something else than before.
    pub(crate) fn choose(&mut self, model: &Model, id: SurfaceId, shape: &SurfaceShape) -> bool {
        let regions = model.document.surfaces.get(&id).map_or(&[][..], |surface| &surface.regions);
        let of_surface = model.document.objective_of_surface(id);
        let asks = |what| of_surface == what || regions.iter().any(|region| region.objective == Some(what));
        self.is_beginning = shape.age < GROWN && asks(Objective::Fair);
        let now = |objective: Objective| match objective {
            Objective::Fair if self.is_beginning => Objective::ThinPlate,
            _ => objective,
        };
        // Only the membrane looks at the radius, which changes with every drag.
        let radius = if asks(Objective::Membrane) { model.document.extent().1 } else { 0.0 };
        let of_region =
            |region: &Region| Region { objective: region.objective.map(now), shadow: None, ..*region };
        let regions = regions.iter().map(of_region).filter(|region| !region.is_idle()).collect();
        let choice = Choice { of_surface: now(of_surface), regions, radius };
        if choice == self.choice {
            return false;
        }
        let is_new = choice.of_surface != self.choice.of_surface || choice.regions != self.choice.regions;
        // Made for the same triangles, so the lengths agree.
        let is_taken = self.solver.set_objectives(region::objectives(shape, &choice)).is_ok();
        self.choice = choice;
        is_new && is_taken
    }

    /// Takes over the tangent planes that the document prescribes; returns whether they are noticeably others than before.
    pub(crate) fn prescribe(&mut self, model: &Model, id: SurfaceId, shape: &SurfaceShape) -> bool {
        let surface = model.document.surfaces.get(&id);
        let has_planes = surface.is_some_and(|s| !(s.normals.is_empty() && s.ribbons.is_empty()))
            || bank::is_taken_from(model, id);
        if has_planes && self.solver.energy().is_nan() {
            // Which sense a normal is meant in, the surface says as it is.
            self.solver.fit_all(&self.positions);
        }
        let planes = if has_planes { self.planes(model, shape).of(id) } else { Vec::new() };
        self.solver.set_normals(&planes).unwrap_or(false)
    }

    /// How to find what is prescribed on this mesh.
    pub(crate) fn planes<'a>(&'a self, model: &'a Model, shape: &'a SurfaceShape) -> Planes<'a> {
        let (rings, normals) = (self.solver.rings(), self.solver.normals());
        Planes { model, shape, rings, compact: &self.compact, normals }
    }

    /// The vertex of each compact node.
    #[must_use]
    pub fn vertices(&self) -> &[VertexId] {
        &self.vertices
    }

    /// The unit normal of each compact node.
    #[must_use]
    pub fn normals(&self) -> &[DVec3] {
        self.solver.normals()
    }

    /// Half the sum of the principal curvatures at a compact node, per model unit, positive where the surface bends towards
    /// its normal.
    #[must_use]
    pub fn mean_curvature(&self, node: usize) -> Option<f64> {
        self.solver.curvatures().nth(node).map(|curvature| curvature.mean)
    }

    /// The triangles, over compact nodes.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        self.solver.rings().triangles()
    }

    /// The energy of the surface as it is now.
    #[must_use]
    pub fn energy(&self) -> f64 {
        self.solver.energy()
    }

    /// How well the mesh resolves the shape: by node the angle in radians by which it turns along a mean edge, and the
    /// Jacobian of the fit. Up to 0.7 and from 0.7 on are good.
    pub fn resolution(&self) -> impl Iterator<Item = (f64, f64)> {
        let fits = self.solver.curvatures().zip(self.solver.mean_edges()).zip(self.solver.jacobians());
        fits.map(|((curvature, h), jacobian)| (curvature.largest() * h, jacobian))
    }

    /// How many free nodes sleep through the present drag.
    #[must_use]
    pub fn asleep(&self) -> usize {
        self.solver.asleep()
    }

    /// The compact node of a vertex.
    pub(crate) fn node(&self, v: VertexId) -> u32 {
        self.compact[v.index()]
    }

    /// Where the middles of edges lie on the fitted surface.
    pub(crate) fn edge_places(&self) -> EdgePlaces<'_> {
        self.solver.edge_places(&self.positions)
    }

    /// The middle of two vertices on the fitted surface, if both had a fit when the solver was bound. (A slot
    /// that was given to a new vertex since then has no neighbour here, and the plain middle comes out.)
    pub(crate) fn between(&self, places: &mut EdgePlaces<'_>, a: VertexId, b: VertexId) -> Option<DVec3> {
        let (a, b) = (self.resolved(a)?, self.resolved(b)?);
        let is_edge = self.solver.rings().ring(a as usize).contains(&b);
        is_edge.then(|| places.at(a, b))
    }

    /// The place of the fitted surface around a vertex nearest to a given one, if that vertex has a fit that tells.
    pub(crate) fn near(&self, v: VertexId, at: DVec3) -> Option<DVec3> {
        self.resolved(v).and_then(|node| self.solver.place_near(&self.positions, node, at))
    }

    /// The node of a vertex that was there when the solver was bound and whose ring the mesh resolves: a fold's
    /// quadratic says nothing about the surface around, and what is plain is safer there.
    fn resolved(&self, v: VertexId) -> Option<u32> {
        let node = self.compact.get(v.index()).copied().filter(|node| *node != u32::MAX)?;
        (self.solver.jacobian(node) >= RESOLVED).then_some(node)
    }

    /// Moves free vertices towards even spacing; returns whether any moved noticeably.
    pub(crate) fn smooth(&mut self, fraction: f64) -> bool {
        let movable: Vec<bool> = self.solver.fixed().iter().map(|fixed| !fixed).collect();
        self.solver.smooth_graded(&mut self.positions, &movable, fraction, Aim::Shapely, None).moved > 0
    }

    /// Brings fits, normals and energy up to the positions. Costs nothing when they are.
    pub(crate) fn fit(&mut self) {
        self.solver.evaluate(&self.positions);
    }

    /// Whether the mesh no longer does for the shape: an edge stretched far beyond the spacing, or a place that it
    /// does not resolve.
    pub(crate) fn is_worn(&self, spacing: f64) -> bool {
        self.solver.longest_edge() > STRETCHED * spacing || self.solver.jacobians().any(|j| j < RESOLVED)
    }

    /// Whether the mesh is stretched so far that it cannot even wait for a fast hand. What J says does not count: a fold may
    /// pass with the next frame, and a mesh stretched evenly has none.
    pub(crate) fn is_breaking(&self, spacing: f64) -> bool {
        self.solver.longest_edge() > BREAKING * spacing
    }

    /// How many nodes have a ring that the mesh does not resolve.
    pub(crate) fn unresolved(&self) -> usize {
        self.solver.jacobians().filter(|jacobian| jacobian.is_nan() || *jacobian < RESOLVED).count()
    }

    /// Writes the positions back into the shape.
    pub(crate) fn write(&self, shape: &mut SurfaceShape) {
        for (v, at) in self.vertices.iter().zip(&self.positions) {
            shape.positions[v.index()] = *at;
        }
    }

    /// Takes over positions that were changed elsewhere.
    pub(crate) fn read(&mut self, shape: &SurfaceShape) {
        for (v, at) in self.vertices.iter().zip(&mut self.positions) {
            *at = shape.positions[v.index()];
        }
    }

    /// Carries the controls as far as the strain limit allows. Returns whether all the way.
    pub(crate) fn carry(&mut self, motion: &Motion) -> Result<bool, SolverError> {
        motion.carry(&mut self.positions, |positions, by| self.solver.predict(positions, by))
    }

    /// The nodes that these curves and points hold.
    pub(crate) fn held(
        &self,
        shape: &SurfaceShape,
        curves: &BTreeSet<CurveId>,
        points: &[PointId],
    ) -> Vec<u32> {
        let embedded = shape.embeddings.iter().filter(|embedded| curves.contains(&embedded.curve));
        let on_curves = embedded.flat_map(|embedded| &embedded.vertices).copied();
        let pinned = shape.pins.iter().filter(|pin| points.contains(&pin.point)).map(|pin| pin.vertex);
        on_curves.chain(pinned).map(|v| self.node(v)).collect()
    }

    /// What the controls ask for that are not yet where the document has them.
    pub(crate) fn motion(
        &self,
        document: &Document,
        curves: &BTreeMap<CurveId, Arc<CurveShape>>,
        shape: &SurfaceShape,
    ) -> Motion {
        let mut wanted: BTreeMap<u32, DVec3> = BTreeMap::new();
        for embedded in &shape.embeddings {
            let Some(curve) = curves.get(&embedded.curve) else { continue };
            for (v, to) in embedded.vertices.iter().zip(&curve.nodes) {
                wanted.insert(self.node(*v), *to);
            }
        }
        for pin in &shape.pins {
            if let Some(to) = document.points.get(&pin.point) {
                wanted.insert(self.node(pin.vertex), *to);
            }
        }
        let mut motion = Motion::default();
        for (node, to) in wanted {
            motion.add(node, self.positions[node as usize], to);
        }
        motion
    }
}

/// A curve solver for one revision of a curve.
#[derive(Clone, Debug)]
pub(crate) struct BoundCurve {
    /// Which sampling it was made for.
    revision: u64,
    /// What it minimises.
    objective: Objective,
    /// Its prescribed directions, by sample.
    tangents: Vec<(u32, DVec3)>,
    /// The solver.
    pub(crate) solver: CurveSolver,
}

/// The prescribed directions of a curve, by sample.
fn tangents(document: &Document, id: CurveId, shape: &CurveShape) -> Vec<(u32, DVec3)> {
    let given = document.curves.get(&id).map(|curve| &curve.tangents);
    let at = |point: &PointId| given.and_then(|given| given.get(point)).copied();
    shape.controls.iter().filter_map(|(sample, point)| Some((*sample, at(point)?))).collect()
}

impl BoundCurve {
    /// Sets up the solver for a curve as it is now, with what the document says of it.
    pub(crate) fn new(document: &Document, id: CurveId, shape: &CurveShape) -> Result<Self, ModelError> {
        let mut fixed = vec![false; shape.nodes.len()];
        for (sample, _) in &shape.controls {
            fixed[*sample as usize] = true;
        }
        let objective = document.objective_of_curve(id);
        let tangents = tangents(document, id, shape);
        let mut settings = CurveSettings::default();
        settings.objective = solver_objective(objective);
        let fail = |reason| ModelError::Unsolvable { what: id.to_string(), reason };
        let mut solver = CurveSolver::new(shape.nodes.len(), shape.closed, fixed, settings).map_err(fail)?;
        solver.set_tangents(&tangents).map_err(fail)?;
        Ok(Self { revision: shape.revision, objective, tangents, solver })
    }

    /// Whether it is for this sampling, and for what the document says now.
    pub(crate) fn is_for(&self, document: &Document, id: CurveId, shape: &CurveShape) -> bool {
        self.revision == shape.revision
            && self.objective == document.objective_of_curve(id)
            && self.tangents == tangents(document, id, shape)
    }

    /// Carries the controls and steps once. Returns whether the controls are met and whether the curve rests.
    pub(crate) fn relax(
        &mut self,
        nodes: &mut [DVec3],
        motion: &Motion,
    ) -> Result<(bool, bool), SolverError> {
        let is_met = self.carry(nodes, motion)?;
        let report = self.solver.step(nodes)?;
        Ok((is_met, report.at_rest))
    }

    /// Carries the controls as far as the strain limit allows. Returns whether all the way.
    pub(crate) fn carry(&mut self, nodes: &mut [DVec3], motion: &Motion) -> Result<bool, SolverError> {
        motion.carry(nodes, |nodes, by| self.solver.predict(nodes, by))
    }

    /// What the control points ask for that are not yet where the document has them.
    pub(crate) fn motion(model: &Model, shape: &CurveShape) -> Motion {
        let mut motion = Motion::default();
        for (sample, point) in &shape.controls {
            if let Some(to) = model.document.points.get(point) {
                motion.add(*sample, shape.nodes[*sample as usize], *to);
            }
        }
        motion
    }
}
