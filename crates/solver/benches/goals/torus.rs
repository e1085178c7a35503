//! The torus of goals e to g: an anisotropic grid, made even by the passes of the mesh and the smoothing of the solver.
//!
//! Shared by the benches and by `tests/remeshing.rs`, which looks at the triangles.

use ductile_mesh::remesh::{Ledger, Limits, Seeds, Sizing, collapse_short, improve_changed, midpoint};
use ductile_mesh::{EdgeId, Mesh, VertexId};
use ductile_solver::workload::Stream;
use ductile_solver::{Aim, EdgePlaces, Rings, smooth};
use glam::DVec3;

/// Edge length at which the torus comes out with about 10,000 nodes.
pub(crate) const SPACING: f64 = 0.108;
/// Rounds at a finer spacing first: edges of all lengths that are allowed can still make a mesh of needles.
const FINE_ROUNDS: usize = 2;
const FINER: f64 = 0.85;
const ROUNDS: usize = 12;
const SMOOTHING: f64 = 0.6;

/// A torus of radii 2 and 1 on a grid of 400 by 25, its squares cut along random diagonals.
pub(crate) fn torus() -> (Mesh, Vec<DVec3>) {
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
        let nodes = mesh.edge_vertices(e).map(|v| self.compact.get(v.index()).copied().unwrap_or(u32::MAX));
        match nodes {
            [a, b] if a != u32::MAX && b != u32::MAX && self.rings.ring(a as usize).contains(&b) => {
                places.at(a, b)
            }
            _ => midpoint(mesh, positions, e),
        }
    }
}

/// Remeshes to an even spacing, new and moved vertices on the fitted quadratics, as a modeler does.
pub(crate) fn remesh(mesh: &mut Mesh, positions: &mut Vec<DVec3>) {
    let limits = Limits { growth: 2.0, ..Limits::default() };
    let mut ledger = Ledger::default();
    // The grid is fine one way and coarse the other: what is too many goes first, so that it is not split across.
    let first = Limits { may_lengthen: true, ..limits };
    collapse_short(mesh, positions, &Sizing::Uniform(SPACING), Seeds::All, &first);
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

/// Least angle and its first percentile over all triangles, in degrees, and the share of vertices with five to seven
/// neighbours.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangles {
    pub(crate) least: f64,
    pub(crate) percentile: f64,
    pub(crate) regular: f64,
}

impl Triangles {
    pub(crate) fn of(mesh: &Mesh, positions: &[DVec3]) -> Self {
        let mut angles: Vec<f64> = mesh
            .faces()
            .map(|face| {
                let corners = mesh.face_vertices(face).map(|v| positions[v.index()]);
                let angle = |k: usize| {
                    let (one, other) = (corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]);
                    one.angle_between(other).to_degrees()
                };
                (0..3).map(angle).fold(180.0, f64::min)
            })
            .collect();
        angles.sort_by(f64::total_cmp);
        let regular = mesh.vertices().filter(|&v| (5..=7).contains(&mesh.valence(v))).count();
        Self {
            least: angles[0],
            percentile: angles[angles.len() / 100],
            regular: regular as f64 / mesh.vertex_count() as f64,
        }
    }
}

impl std::fmt::Display for Triangles {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { least, percentile, regular } = self;
        write!(
            f,
            "least angle {least:.1}°, first percentile {percentile:.1}°, {:.1} % regular",
            100.0 * regular
        )
    }
}
