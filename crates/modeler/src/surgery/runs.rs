//! Runs: the stretches of a curve that hang together in a surface which was cut.
//!
//! A cut doubles edges. Each edge of a curve then lies on one bank or on two, and at each sample the edges of one bank may
//! go on or end, because a vertex there fell apart. A run is as long as the edges go on: a whole curve, a part of one that
//! was cut across, or a closed curve gone round twice, which is what the one bank of a one-sided cut is.

use crate::shape::EmbeddedCurve;
use ductile_mesh::{EdgeId, Mesh, VertexId};
use ductile_spec::CurveId;

/// Edges of a curve that follow one another in a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Run {
    /// Of which curve.
    pub(crate) curve: CurveId,
    /// The samples, in the curve's order; a closed run does not repeat its first.
    pub(crate) samples: Vec<usize>,
    /// The vertex at each.
    pub(crate) vertices: Vec<VertexId>,
    /// Whether the last joins the first.
    pub(crate) closed: bool,
    /// Whether the curve closes, and how many edges it has.
    pub(crate) whole: (bool, usize),
}

impl Run {
    /// Whether it is the whole curve, once.
    pub(crate) fn is_whole(&self) -> bool {
        self.closed == self.whole.0 && self.edge_count() == self.whole.1
    }

    /// Whether the curve was cut along and has a single bank.
    pub(crate) fn is_one_sided(&self) -> bool {
        self.edge_count() > self.whole.1
    }

    /// Whether the curve is closed and was cut across at one place: it begins and ends there.
    pub(crate) fn is_cut_across_once(&self) -> bool {
        self.whole.0 && !self.closed && self.edge_count() == self.whole.1
    }

    pub(crate) fn edge_count(&self) -> usize {
        if self.closed { self.vertices.len() } else { self.vertices.len() - 1 }
    }
}

/// An edge of a curve on one bank, from the earlier sample to the later.
#[derive(Clone, Copy, Debug)]
struct Bank {
    from: VertexId,
    to: VertexId,
    next: Option<usize>,
    has_before: bool,
    is_used: bool,
}

/// The edges of a curve, each with its banks.
struct Lines {
    rows: Vec<Vec<Bank>>,
    is_closed: bool,
}

impl Lines {
    fn after(&self, row: usize) -> Option<usize> {
        if row + 1 < self.rows.len() { Some(row + 1) } else { self.is_closed.then_some(0) }
    }

    /// Finds what goes on where.
    fn link(&mut self) {
        for row in 0..self.rows.len() {
            let Some(next) = self.after(row) else { continue };
            for place in 0..self.rows[row].len() {
                let to = self.rows[row][place].to;
                // At the end of a slit two banks run into one edge: the first of them goes on.
                let free = self.rows[next].iter().position(|other| other.from == to && !other.has_before);
                if let Some(free) = free {
                    self.rows[next][free].has_before = true;
                    self.rows[row][place].next = Some(free);
                }
            }
        }
    }

    /// The run that begins with a bank: its samples and vertices, and whether it closes.
    fn follow(
        &mut self,
        mut row: usize,
        mut place: usize,
        count: usize,
    ) -> (Vec<usize>, Vec<VertexId>, bool) {
        let (mut samples, mut vertices) = (Vec::new(), Vec::new());
        loop {
            let following = self.after(row);
            let bank = &mut self.rows[row][place];
            bank.is_used = true;
            samples.push(row);
            vertices.push(bank.from);
            let to = bank.to;
            let Some((next, following)) = bank.next.zip(following) else {
                samples.push((row + 1) % count);
                vertices.push(to);
                return (samples, vertices, false);
            };
            if self.rows[following][next].is_used {
                return (samples, vertices, true);
            }
            (row, place) = (following, next);
        }
    }
}

/// The runs of an embedded curve in a mesh in which its edges are `banks` now: for each edge of the curve those that it has
/// become, none where it is gone. `origin` says which vertex a copy was made of.
pub(crate) fn runs(
    mesh: &Mesh,
    embedded: &EmbeddedCurve,
    is_closed: bool,
    banks: &[Vec<EdgeId>],
    origin: &dyn Fn(VertexId) -> VertexId,
) -> Vec<Run> {
    let bank = |row: usize, e: &EdgeId| {
        let [a, b] = mesh.edge_vertices(*e);
        let is_forward = origin(a) == embedded.vertices[row];
        let (from, to) = if is_forward { (a, b) } else { (b, a) };
        Bank { from, to, next: None, has_before: false, is_used: false }
    };
    let rows = banks.iter().enumerate().map(|(row, edges)| edges.iter().map(|e| bank(row, e)).collect());
    let mut lines = Lines { rows: rows.collect(), is_closed };
    lines.link();
    let whole = (is_closed, banks.len());
    let mut found = Vec::new();
    // Runs with a beginning first; what is left then are circles.
    for only_beginnings in [true, false] {
        for row in 0..lines.rows.len() {
            for place in 0..lines.rows[row].len() {
                let start = lines.rows[row][place];
                if start.is_used || (only_beginnings && start.has_before) {
                    continue;
                }
                let (samples, vertices, closed) = lines.follow(row, place, embedded.vertices.len());
                found.push(Run { curve: embedded.curve, samples, vertices, closed, whole });
            }
        }
    }
    found
}
