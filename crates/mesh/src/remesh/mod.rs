//! Keeping the triangles good while the shape changes: split what is long, collapse what is crowded, flip
//! diagonals, mend valences.
//!
//! After Welch 1995, chapter 6, with thresholds measured on moving shapes. The order in a batch is split,
//! collapse, flip, repair (and then smooth, which is the solver's, for it needs the fitted surface).
//! Edges are split above 1.33 of the target length and collapsed below 0.66 of it: with the two limits
//! this far apart (more than 1 : 1.8), jitter of a handle does not make edits undo each other.
//!
//! The mesh's kind never changes, control points and pinned vertices never move or vanish, and curve edges
//! are left alone unless [`Limits`] allow otherwise. Only `positions` of new vertices are written. Every
//! pass reports what it did and which vertices have a new ring, so that only those are fitted again.
//!
//! ```
//! use ductile_mesh::{primitive, remesh};
//!
//! let (mut mesh, mut positions) = primitive::icosphere(1);
//! let mut sizing = remesh::Sizing::Uniform(0.2);
//! let limits = remesh::Limits { most_vertices: 1000, ..remesh::Limits::default() };
//! let mut on_sphere = |mesh: &ductile_mesh::Mesh, at: &[glam::DVec3], e| {
//!     let [a, b] = mesh.edge_vertices(e);
//!     (at[a.index()] + at[b.index()]).normalize_or_zero()
//! };
//! while remesh::improve(&mut mesh, &mut positions, &mut sizing, &limits, &mut on_sphere).splits > 0 {}
//! assert!(ductile_mesh::quality(&mesh, &positions).longest_edge <= 1.6 * 0.2);
//! ```

mod collapse_short;
mod diagonal;
mod flip_pass;
mod ledger;
mod potential;
mod repair_valence;
mod sizing;
mod split_long;
mod tighten;

pub use collapse_short::collapse_short;
pub use flip_pass::flip_pass;
pub use ledger::{Ledger, Seeds};
pub use repair_valence::repair_valence;
pub use sizing::Sizing;
pub use split_long::split_long;
pub use tighten::tighten;

use glam::DVec3;

use crate::{EdgeId, Mesh, VertexId};

/// Gives the position of the new vertex when an edge is split: its midpoint, a point of the fitted
/// surface, or a point of the control curve.
pub type Place<'a> = dyn FnMut(&Mesh, &[DVec3], EdgeId) -> DVec3 + 'a;

/// 15°. A flip that makes a sharper corner is no cure for a low valence, and a corner so sharp is worth a
/// low valence to be rid of. Both passes share the limit, so neither undoes the other's flips.
const LEAST_CORNER: f64 = core::f64::consts::PI / 12.0;

/// How far a pass may go.
#[derive(Clone, Copy)]
pub struct Limits<'a> {
    /// Vertices that may not vanish; control points never do anyway.
    pub is_pinned: &'a dyn Fn(VertexId) -> bool,
    /// Whether control-curve edges may be split and their vertices collapsed. In a model the curve owns
    /// its density, so the default is no.
    pub may_edit_curves: bool,
    /// The same for boundary edges that carry no curve; the default is yes.
    pub may_edit_boundary: bool,
    /// No split once the mesh has this many vertices.
    pub most_vertices: usize,
    /// The share of vertices a batch may add. A small mesh may always gain [`LEAST_GROWTH`].
    pub growth: f64,
    /// Whether vertices may be collapsed away; the default is yes.
    ///
    /// Splits and collapses answer each other, and on some meshes a few of them would go on for ever. Whoever needs rest
    /// forbids collapses after a number of batches: what is left, splits of long edges and flips that lower their
    /// potential, comes to an end.
    pub may_collapse: bool,
    /// Whether a collapse at a vertex with an edge above 1.6 of its target, which will be split in any case, may make others
    /// as long (by a tenth at most); the default is no.
    ///
    /// A pass of [`collapse_short`] so allowed, before the first batch on a mesh that is fine one way and coarse the other,
    /// takes out what would else be split across and collapsed afterwards.
    pub may_lengthen: bool,
    /// The largest ring the solver can hold; no edit makes a larger one.
    pub most_neighbours: usize,
}

/// The number of vertices a batch may add however small the mesh.
pub const LEAST_GROWTH: usize = 16;

impl Default for Limits<'_> {
    /// Nothing pinned, curves closed and boundaries open to edits, 10 % growth, rings up to 24.
    fn default() -> Self {
        Self {
            is_pinned: &|_| false,
            may_edit_curves: false,
            may_edit_boundary: true,
            most_vertices: usize::MAX,
            growth: 0.10,
            may_collapse: true,
            may_lengthen: false,
            most_neighbours: 24,
        }
    }
}

impl core::fmt::Debug for Limits<'_> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Limits")
            .field("may_edit_curves", &self.may_edit_curves)
            .field("may_edit_boundary", &self.may_edit_boundary)
            .field("most_vertices", &self.most_vertices)
            .field("growth", &self.growth)
            .field("may_collapse", &self.may_collapse)
            .field("may_lengthen", &self.may_lengthen)
            .field("most_neighbours", &self.most_neighbours)
            .finish_non_exhaustive()
    }
}

impl Limits<'_> {
    /// Whether `e` may be cut or shortened: always inside, on curves and boundaries as the flags say.
    fn may_edit(&self, mesh: &Mesh, e: EdgeId) -> bool {
        if mesh.is_source_edge(e) {
            self.may_edit_curves
        } else {
            self.may_edit_boundary || !mesh.is_boundary_edge(e)
        }
    }

    /// How many vertices a batch starting with `now` vertices may add.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a share of a count")]
    fn allowance(&self, now: usize) -> usize {
        let share = self.growth.max(0.0) * f64::from(u32::try_from(now).unwrap_or(u32::MAX));
        (share as usize).max(LEAST_GROWTH).min(self.most_vertices.saturating_sub(now))
    }
}

/// What a pass did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edits {
    /// Edges split.
    pub splits: usize,
    /// Vertices collapsed away.
    pub collapses: usize,
    /// Edges flipped.
    pub flips: usize,
    /// Living vertices with a new ring, in index order. (A vertex that was merely a far end of a split
    /// edge has a new neighbour and is listed too.)
    pub touched: Vec<VertexId>,
    /// Whether a limit stopped the pass with work left; another batch would do more, or a larger target
    /// length is needed.
    pub is_cut_short: bool,
}

impl Edits {
    /// How many edits there were.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.splits + self.collapses + self.flips
    }

    /// Adds another pass's edits, made later on the same mesh.
    fn append(&mut self, later: Self, mesh: &Mesh) {
        self.splits += later.splits;
        self.collapses += later.collapses;
        self.flips += later.flips;
        self.is_cut_short |= later.is_cut_short;
        self.touched.extend(later.touched);
        self.settle(mesh);
    }

    /// Sorts the touched vertices and drops the dead.
    fn settle(&mut self, mesh: &Mesh) {
        self.touched.sort_unstable();
        self.touched.dedup();
        self.touched.retain(|&v| mesh.has_vertex(v));
    }
}

/// One batch everywhere: split, collapse, flip, repair.
pub fn improve(
    mesh: &mut Mesh,
    positions: &mut Vec<DVec3>,
    sizing: &mut Sizing,
    limits: &Limits<'_>,
    place: &mut Place<'_>,
) -> Edits {
    batch(mesh, positions, sizing, Seeds::All, limits, place)
}

/// One batch that looks only around what has changed since the last one with the same ledger.
///
/// `slack` is the part of its edge length by which a vertex may creep unseen. When a call with a slack of 0 makes no
/// edit, [`improve`] would make none.
pub fn improve_changed(
    mesh: &mut Mesh,
    positions: &mut Vec<DVec3>,
    sizing: &mut Sizing,
    (ledger, slack): (&mut Ledger, f64),
    limits: &Limits<'_>,
    place: &mut Place<'_>,
) -> Edits {
    let changed = ledger.take(mesh, positions, sizing, slack);
    if changed.is_empty() {
        return Edits::default();
    }
    // Most of them: then sorting what is near costs more than looking everywhere.
    let is_most = 4 * changed.len() > mesh.vertex_count();
    let seeds = if is_most { Seeds::All } else { Seeds::Around(&changed) };
    let edits = batch(mesh, positions, sizing, seeds, limits, place);
    ledger.note(&edits);
    edits
}

/// The passes one after the other; what one touches is among the seeds of the next.
fn batch(
    mesh: &mut Mesh,
    positions: &mut Vec<DVec3>,
    sizing: &mut Sizing,
    seeds: Seeds<'_>,
    limits: &Limits<'_>,
    place: &mut Place<'_>,
) -> Edits {
    let mut edits = split_long(mesh, positions, sizing, seeds, limits, place);
    let mut near = Vec::new();
    let later = collapse_short(mesh, positions, sizing, seeds.with(&edits, &mut near), limits);
    edits.append(later, mesh);
    let later = flip_pass(mesh, positions, sizing, seeds.with(&edits, &mut near), limits);
    edits.append(later, mesh);
    let later = repair_valence(mesh, positions, sizing, seeds.with(&edits, &mut near), limits);
    edits.append(later, mesh);
    edits
}

/// The midpoint of an edge: the plainest [`Place`].
#[must_use]
pub fn midpoint(mesh: &Mesh, positions: &[DVec3], e: EdgeId) -> DVec3 {
    let [a, b] = mesh.edge_vertices(e);
    positions[a.index()].midpoint(positions[b.index()])
}

#[cfg(test)]
mod tests;
