//! From the linear skin over a skeleton to a start that the relaxer can finish.
//!
//! The skin over a few large triangles is creased, and where its edges wind round a tube it has a waist. Relaxed at its
//! full density it may end in a crumple or in a thread, since the energy has valleys as narrow as an edge is long.
//! So it is grown: its mesh is relaxed while it is still twice as coarse, refined on the fitted surface, and relaxed a little
//! again (nested iteration). Which way of beginning leads into the right valley cannot be told beforehand; several are
//! tried, and the one is kept whose mesh resolves its shape best and, among equals, whose energy is least.

mod inflating;

use crate::bound::BoundSurface;
use crate::density;
use crate::error::ModelError;
use crate::maintain::{self, SMOOTHING};
use crate::region::{self, Choice};
use crate::shape::{CurveShape, GROWN, SurfaceShape};
use ductile_mesh::{Mesh, measure, quality, remesh};
use ductile_solver::{Budget, SolverError};
use ductile_spec::{CurveId, Document, Objective, SurfaceId};
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Steps between two improvements of the mesh.
const STEPS: usize = 3;
/// Rounds of steps and an improvement at full density.
const FINE_ROUNDS: usize = 5;
/// The same for what is to be `fair`, after those of a thin plate.
const FAIR_ROUNDS: usize = 4;
/// Iterations of the conjugate gradients in a step.
const ITERATIONS: u32 = 20;
/// Cosine of the angle between the normals of neighbours from which on they are a fold (about 170°): a skeleton's own
/// creases are blunter, and where they are not, nothing is lost.
const FOLDED: f64 = -0.985;
/// Two starts whose energies differ by no more than this part have found the same valley, and no other is looked for.
const AGREEING: f64 = 1.01;
/// Meshes with more vertices are not grown in all ways: the first way that they resolve is taken.
const LARGE: usize = 4000;
/// Rounds of relaxation of a mesh that is large and still coarse: what they do not mend the finer one would have to, at four times
/// the price.
const LARGE_ROUNDS: usize = 4;
/// Rounds of steps and an improvement at full density, after those.
const FINE_ROUNDS_OF_LARGE: usize = 2;
/// Meshes with more vertices are so large that the rounds at full density are what one waits for.
const HUGE: usize = 20_000;
/// Vertices of all ways tried together from which on no other is tried: a shape that no way resolves may be much larger each time
/// than it should be, and must not keep everybody waiting.
const ENOUGH: usize = 24_000;
/// An angle of a triangle that nothing is to be said against: 33°.
const BLUNT: f64 = 0.576;
/// A flip must make an edge shorter by this part.
const SHORTER: f64 = 0.9;
/// Flips that shorten, at most, for each edge.
const FLIPS: usize = 4;

/// What a surface begins as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Beginning {
    /// The linear skin.
    Skin,
    /// The best of several skins that were grown.
    Grown,
}

/// Where the samples of curves are put while a skeleton is cut along them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Laying {
    /// Where they belong: the skin is at once right at its curves.
    OnCurves,
    /// On the skeleton's edges, from where the relaxer carries them to their curves with all that is around. A
    /// curve that bulges into its surface, like the inner rim of a ring, would else overtake the vertices before it.
    OnEdges,
}

/// A way to begin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    /// Where the curves' samples are put.
    pub(crate) laying: Laying,
    /// Whether edges of the skeleton are flipped while that makes them shorter.
    is_shortened: bool,
    /// Rounds of relaxation at twice the spacing.
    coarse: usize,
}

const fn start(laying: Laying, is_shortened: bool, coarse: usize) -> Start {
    Start { laying, is_shortened, coarse }
}

/// The ways to begin, in the order in which they are tried.
const STARTS: [Start; 7] = [
    start(Laying::OnCurves, false, 0),
    start(Laying::OnCurves, false, 6),
    start(Laying::OnEdges, false, 0),
    start(Laying::OnCurves, false, 12),
    start(Laying::OnCurves, true, 6),
    start(Laying::OnCurves, true, 0),
    start(Laying::OnEdges, true, 0),
];

/// How good a start is.
#[derive(Clone, Copy, Debug)]
struct Score {
    /// Nodes that the mesh does not resolve, or that are not yet where they are to be.
    unresolved: usize,
    /// The energy there; not a number counts as infinite.
    energy: f64,
    /// Sharpest angle of a triangle, in radians.
    angle: f64,
}

impl Score {
    /// Less is better. Crumples and threads cost more than a shape that is merely not yet fair; what the mesh does not
    /// resolve may cost too little, so each such node counts. Of equals the better mesh is taken: what is sharp beside a
    /// curve now often stays so.
    fn cost(&self) -> f64 {
        let sharpness = (1.0 - self.angle / BLUNT).max(0.0);
        self.energy * (1.0 + self.unresolved as f64 / 20.0 + sharpness / 10.0)
    }
}

/// What a surface grows on.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub(crate) document: &'a Document,
    pub(crate) curves: &'a BTreeMap<CurveId, Arc<CurveShape>>,
    pub(crate) id: SurfaceId,
}

impl Start {
    /// Turns edges of a skeleton before it is refined.
    pub(crate) fn turn(self, shape: &mut SurfaceShape) {
        remesh::tighten(&mut shape.mesh, &shape.positions);
        if self.is_shortened {
            shorten(&mut shape.mesh, &shape.positions);
        }
    }

    /// Relaxes a skin that is refined to a multiple of the spacing, if this is such a start or the skin is large already.
    pub(crate) fn grow(self, ground: &Ground<'_>, shape: &mut SurfaceShape, stride: usize) {
        let is_large = shape.mesh.vertex_count() > LARGE;
        let rounds = match stride {
            0 | 1 => 0,
            2 if is_large => self.coarse.max(LARGE_ROUNDS),
            2 => self.coarse,
            _ if is_large => LARGE_ROUNDS,
            _ => 0,
        };
        if rounds > 0 {
            // What cannot be relaxed now is told when it is relaxed at its spacing.
            let _ = ground.rounds(shape, stride, (rounds, Objective::ThinPlate));
        }
    }
}

impl Ground<'_> {
    /// The linear skin; with its curves' samples on the edges if it would be folded otherwise.
    ///
    /// # Errors
    /// Those of making a skin, and [`ModelError::Unsolvable`] if there is no solver for it.
    pub(crate) fn plain(
        &self,
        skin: impl Fn(Start) -> Result<SurfaceShape, ModelError>,
    ) -> Result<SurfaceShape, ModelError> {
        let mut shape = skin(start(Laying::OnCurves, false, 0))?;
        if is_folded(&shape) {
            shape = skin(start(Laying::OnEdges, false, 0))?;
        }
        BoundSurface::new(self.id, &shape)?;
        Ok(shape)
    }

    /// The linear skin if its mesh resolves it everywhere, for then there is nothing to crumple; else the best of the skins
    /// that were grown.
    ///
    /// # Errors
    /// The same, if none can be had.
    pub(crate) fn grown(
        &self,
        skin: impl Fn(Start) -> Result<SurfaceShape, ModelError>,
    ) -> Result<SurfaceShape, ModelError> {
        let plain = skin(start(Laying::OnCurves, false, 0))?;
        if self.is_resolved(&plain)? {
            return Ok(plain);
        }
        // A solver of ten thousand nodes takes ten megabytes: what is not needed any more is given back before the next one.
        drop(plain);
        let mut best: Option<(Score, SurfaceShape)> = None;
        let mut failure = ModelError::NoSurface(self.id);
        let (mut resolved, mut made) = (Vec::new(), 0);
        for start in STARTS {
            let mut shape = skin(start)?;
            inflating::inflate(&mut shape);
            let score = match self.finish(&mut shape) {
                Ok(score) => score,
                Err(reason) => {
                    failure = reason;
                    continue;
                }
            };
            let vertices = shape.mesh.vertex_count();
            resolved.extend((score.unresolved == 0).then_some(score.energy));
            if best.as_ref().is_none_or(|(least, _)| score.cost() < least.cost()) {
                best = Some((score, shape));
            }
            let least = resolved.iter().copied().fold(f64::INFINITY, f64::min);
            let agreeing = resolved.iter().filter(|energy| **energy <= AGREEING * least).count();
            made += vertices;
            if agreeing >= 2 || (agreeing == 1 && vertices > LARGE) || made > ENOUGH {
                break;
            }
        }
        best.map(|(_, shape)| shape).ok_or(failure)
    }

    /// Relaxes a skin at its spacing, and tells how good it has become.
    ///
    /// # Errors
    /// [`ModelError::Unsolvable`] if there is no solver for such a mesh.
    fn finish(&self, shape: &mut SurfaceShape) -> Result<Score, ModelError> {
        let bound = self.relaxed(shape)?;
        let score = self.score(shape, &bound);
        if score.unresolved == 0 {
            shape.age = GROWN;
        }
        Ok(score)
    }

    /// Relaxes a surface that was joined as a skin is relaxed; gives what it costs as a start.
    ///
    /// # Errors
    /// The same.
    pub(crate) fn ease(&self, shape: &mut SurfaceShape) -> Result<f64, ModelError> {
        self.finish(shape).map(|score| score.cost())
    }

    /// What a surface costs as a start, as it is.
    ///
    /// # Errors
    /// The same.
    pub(crate) fn cost(&self, shape: &SurfaceShape) -> Result<f64, ModelError> {
        let mut bound = self.bind(shape, self.document.objective_of_surface(self.id))?;
        bound.fit();
        Ok(self.score(shape, &bound).cost())
    }

    fn relaxed(&self, shape: &mut SurfaceShape) -> Result<BoundSurface, ModelError> {
        let is_huge = shape.mesh.vertex_count() > HUGE;
        let rounds = if is_huge { FINE_ROUNDS_OF_LARGE } else { FINE_ROUNDS };
        let mut bound = self.rounds(shape, 1, (rounds, Objective::ThinPlate))?;
        if self.is_fair() {
            drop(bound);
            bound = self.rounds(shape, 1, (FAIR_ROUNDS, Objective::Fair))?;
        }
        Ok(bound)
    }

    fn score(&self, shape: &SurfaceShape, bound: &BoundSurface) -> Score {
        let asked = bound.motion(self.document, self.curves, shape).count();
        let unresolved = bound.unresolved() + asked;
        let energy = bound.energy();
        let angle = quality(&shape.mesh, &shape.positions).least_angle;
        Score { unresolved, energy: if energy.is_nan() { f64::INFINITY } else { energy }, angle }
    }

    /// Whether the shape is to be `fair`. A thin plate is only its beginning then, and a long tube, say, must not go on to
    /// the plate's own shape, which is another.
    fn is_fair(&self) -> bool {
        self.document.objective_of_surface(self.id) == Objective::Fair
    }

    /// So many rounds, and as many again while the mesh does not resolve the shape.
    fn rounds(
        &self,
        shape: &mut SurfaceShape,
        stride: usize,
        (count, objective): (usize, Objective),
    ) -> Result<BoundSurface, ModelError> {
        let mut bound = self.bind(shape, objective)?;
        bound.fit();
        let least = if self.is_fair() && objective == Objective::ThinPlate { count.min(1) } else { count };
        for round in 0..2 * count {
            if round >= least && bound.unresolved() == 0 {
                break;
            }
            if stride == 1 {
                density::begin_necks(self, shape, &bound);
            }
            self.round(shape, stride, &mut bound)?;
            drop(bound);
            bound = self.bind(shape, objective)?;
            bound.fit();
        }
        Ok(bound)
    }

    fn is_resolved(&self, shape: &SurfaceShape) -> Result<bool, ModelError> {
        let mut bound = BoundSurface::new(self.id, shape)?;
        bound.fit();
        Ok(bound.unresolved() == 0)
    }

    fn bind(&self, shape: &SurfaceShape, objective: Objective) -> Result<BoundSurface, ModelError> {
        let mut bound = BoundSurface::new(self.id, shape)?;
        let choice = Choice { of_surface: objective, ..Choice::default() };
        let taken = bound.solver.set_objectives(region::objectives(shape, &choice));
        taken.map(|()| bound).map_err(|reason| self.unsolvable(reason))
    }

    /// Some steps towards the least energy and an improvement of the mesh, for which another solver is needed then.
    fn round(
        &self,
        shape: &mut SurfaceShape,
        stride: usize,
        bound: &mut BoundSurface,
    ) -> Result<(), ModelError> {
        for _ in 0..STEPS {
            // A coarse mesh follows only some samples of its curves, and those lie on them.
            if stride == 1 {
                let motion = bound.motion(self.document, self.curves, shape);
                bound.carry(&motion).map_err(|reason| self.unsolvable(reason))?;
            }
            let step = bound.solver.step(&mut bound.positions, Budget { iterations: ITERATIONS });
            step.map_err(|reason| self.unsolvable(reason))?;
        }
        bound.smooth(SMOOTHING);
        bound.fit();
        bound.write(shape);
        maintain::tend(shape, bound, stride);
        Ok(())
    }

    fn unsolvable(&self, reason: SolverError) -> ModelError {
        ModelError::Unsolvable { what: self.id.to_string(), reason }
    }
}

/// Whether two triangles lie on each other, as no skin over a skeleton should.
fn is_folded(shape: &SurfaceShape) -> bool {
    let normal = |f| measure::face_normal(&shape.mesh, &shape.positions, f);
    shape.mesh.edges().any(|e| {
        let (f, Some(g)) = shape.mesh.edge_faces(e) else { return false };
        let (one, other) = (normal(f), normal(g));
        let alike = if shape.mesh.is_wound_alike(e) { one.dot(other) } else { -one.dot(other) };
        alike < FOLDED * one.length() * other.length()
    })
}

/// Flips inner edges without a tag while that makes them shorter.
fn shorten(mesh: &mut Mesh, positions: &[DVec3]) {
    let mut left = FLIPS * mesh.edge_count();
    let mut is_changed = true;
    while is_changed {
        is_changed = false;
        for e in mesh.edges().collect::<Vec<_>>() {
            if left == 0 || mesh.can_flip(e).is_err() {
                continue;
            }
            let length = |mesh: &Mesh| {
                let [a, b] = mesh.edge_vertices(e).map(|v| positions[v.index()]);
                a.distance(b)
            };
            let before = length(mesh);
            mesh.flip(e);
            if length(mesh) < SHORTER * before {
                left -= 1;
                is_changed = true;
            } else {
                mesh.flip(e);
            }
        }
    }
}
