//! Even or graded spacing between control points without changing the shape.
//!
//! Between two nodes the curve is read as the blend of both nodes' quadratics (parabolic blending, Overhauser 1968),
//! which passes through every node with a continuous tangent. New nodes are placed on it at equal arc length; fixed
//! nodes stay exactly where they are.

use glam::DVec3;

use super::Chain;
use crate::error::{SolverError, check_length, check_positions};

/// Chords in which an edge's arc length is measured.
const SUBDIVISIONS: usize = 16;
/// Most edges a single span may be cut into: a wish for more is a wrong unit.
const MAX_EDGES: f64 = 65_536.0;

/// A curve with a new number of nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Resampled {
    /// Where the nodes are.
    pub positions: Vec<DVec3>,
    /// Which of them are fixed.
    pub fixed: Vec<bool>,
    /// The old node each new one stands for, where it is the same point.
    pub source: Vec<Option<u32>>,
}

/// Spaces the nodes between control points evenly, keeping their number.
pub fn respace(positions: &mut [DVec3], closed: bool, fixed: &[bool]) -> Result<(), SolverError> {
    respace_by(positions, closed, fixed, None)
}

/// The same with edges in proportion to a wanted length at each node, which runs linearly between nodes.
///
/// Lengths that are not positive numbers are refused.
pub fn respace_graded(
    positions: &mut [DVec3],
    closed: bool,
    fixed: &[bool],
    wanted: &[f64],
) -> Result<(), SolverError> {
    check_length(positions.len(), wanted.len())?;
    if let Some(node) = wanted.iter().position(|h| !(h.is_finite() && *h > 0.0)) {
        return Err(SolverError::NotFinite(u32::try_from(node).unwrap_or(u32::MAX)));
    }
    respace_by(positions, closed, fixed, Some(wanted))
}

fn respace_by(
    positions: &mut [DVec3],
    closed: bool,
    fixed: &[bool],
    wanted: Option<&[f64]>,
) -> Result<(), SolverError> {
    let spans = Spans { wanted, ..Spans::new(positions, closed, fixed)? };
    let mut respaced = positions.to_vec();
    for span in &spans.list {
        let points = spans.points(span, span.edges);
        for (step, point) in points.into_iter().enumerate() {
            respaced[(span.first + step + 1) % positions.len()] = point;
        }
    }
    positions.copy_from_slice(&respaced);
    Ok(())
}

/// Spaces the nodes evenly, each span between control points with as many as suit `spacing`.
///
/// A span gets at least `least_edges` edges (one, if that is zero).
///
/// ```
/// use glam::DVec3;
/// let line = [DVec3::ZERO, DVec3::X, DVec3::X * 4.0];
/// let even = ductile_solver::resample(&line, false, &[true, false, true], 1.0, 1).unwrap();
/// assert_eq!(even.positions.len(), 5);
/// assert!(even.positions[1].distance(DVec3::X) < 1e-9);
/// ```
pub fn resample(
    positions: &[DVec3],
    closed: bool,
    fixed: &[bool],
    spacing: f64,
    least_edges: usize,
) -> Result<Resampled, SolverError> {
    let spans = Spans::new(positions, closed, fixed)?;
    let mut result = Resampled::default();
    for span in &spans.list {
        let first = span.first % positions.len();
        result.push(positions[first], fixed[first], u32::try_from(first).ok());
        let wanted = (spans.length(span) / spacing).round();
        let wanted = if wanted >= 1.0 { wanted.min(MAX_EDGES) } else { 1.0 };
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "between 1 and MAX_EDGES"
        )]
        let edges = (wanted as usize).max(least_edges).max(1);
        for point in spans.points(span, edges) {
            result.push(point, false, None);
        }
    }
    if !closed && let Some(&last) = positions.last() {
        let index = positions.len() - 1;
        // A single point is its own span already.
        if index > 0 {
            result.push(last, fixed[index], u32::try_from(index).ok());
        }
    }
    Ok(result)
}

impl Resampled {
    fn push(&mut self, position: DVec3, fixed: bool, source: Option<u32>) {
        self.positions.push(position);
        self.fixed.push(fixed);
        self.source.push(source);
    }
}

/// Edges from one control point (or end) to the next.
struct Span {
    first: usize,
    edges: usize,
}

struct Spans<'a> {
    positions: &'a [DVec3],
    chain: Chain,
    list: Vec<Span>,
    /// Wanted edge length by node, if edges are to differ.
    wanted: Option<&'a [f64]>,
}

impl<'a> Spans<'a> {
    fn new(positions: &'a [DVec3], closed: bool, fixed: &[bool]) -> Result<Self, SolverError> {
        check_positions(positions.len(), positions)?;
        check_length(positions.len(), fixed.len())?;
        let chain = Chain { count: positions.len(), closed };
        let edges = chain.edges().count();
        let start = if closed { fixed.iter().position(|&fixed| fixed).unwrap_or(0) } else { 0 };
        let mut list = Vec::new();
        let mut first = start;
        for node in start + 1..=start + edges {
            let is_last = node == start + edges;
            if is_last || fixed[node % positions.len()] {
                list.push(Span { first, edges: node - first });
                first = node;
            }
        }
        if list.is_empty() && !positions.is_empty() {
            list.push(Span { first: start, edges: 0 });
        }
        Ok(Self { positions, chain, list, wanted: None })
    }

    /// Inner points that cut the span into `edges` pieces of equal arc length, in units of what is wanted there.
    fn points(&self, span: &Span, edges: usize) -> Vec<DVec3> {
        let total = self.length(span);
        let mut points = Vec::with_capacity(edges.saturating_sub(1));
        let mut walked = 0.0;
        let mut next = 1;
        for edge in span.first..span.first + span.edges {
            let mut here = self.evaluate(edge, 0.0);
            for step in 1..=SUBDIVISIONS {
                let ahead = self.evaluate(edge, step as f64 / SUBDIVISIONS as f64);
                let chord = self.measure(edge, step, here.distance(ahead));
                while next < edges && total * next as f64 / edges as f64 <= walked + chord && chord > 0.0 {
                    let part = (total * next as f64 / edges as f64 - walked) / chord;
                    points.push(self.evaluate(edge, (step as f64 - 1.0 + part) / SUBDIVISIONS as f64));
                    next += 1;
                }
                walked += chord;
                here = ahead;
            }
        }
        // Rounding can hold back the last one, and a curve of no length all of them.
        while points.len() + 1 < edges {
            points.push(self.evaluate(span.first + span.edges, 0.0));
        }
        points
    }

    fn length(&self, span: &Span) -> f64 {
        let mut sum = 0.0;
        for edge in span.first..span.first + span.edges {
            let mut here = self.evaluate(edge, 0.0);
            for step in 1..=SUBDIVISIONS {
                let ahead = self.evaluate(edge, step as f64 / SUBDIVISIONS as f64);
                sum += self.measure(edge, step, here.distance(ahead));
                here = ahead;
            }
        }
        sum
    }

    /// The length of a chord in units of the length wanted at its middle.
    fn measure(&self, edge: usize, step: usize, chord: f64) -> f64 {
        let Some(wanted) = self.wanted else { return chord };
        let at = |node: usize| wanted[node % wanted.len()];
        let part = (step as f64 - 0.5) / SUBDIVISIONS as f64;
        chord / (at(edge) * (1.0 - part) + at(edge + 1) * part)
    }

    /// The curve on the edge from node `edge` to the next, at `w` in [0, 1].
    fn evaluate(&self, edge: usize, w: f64) -> DVec3 {
        let count = self.positions.len();
        let (from, to) = (edge % count, (edge + 1) % count);
        let (start, end) = (self.positions[from], self.positions[to.min(count - 1)]);
        if w == 0.0 {
            return start;
        }
        let length = start.distance(end);
        // Each quadratic's rise over the chord is c_tt t (t - r) / 2; the blend weighs it by the distance from the other end.
        let rise = |node: usize| self.second_derivative(node) * (0.5 * w * (w - 1.0) * length * length);
        start.lerp(end, w) + rise(from) * (1.0 - w) + rise(to) * w
    }

    fn second_derivative(&self, node: usize) -> DVec3 {
        let Some((before, after)) = self.chain.neighbours(node) else { return DVec3::ZERO };
        let (here, ahead, behind) = (self.positions[node], self.positions[after], self.positions[before]);
        let (r_ahead, r_behind) = (here.distance(ahead), here.distance(behind));
        if !(r_ahead > 0.0 && r_behind > 0.0) {
            return DVec3::ZERO;
        }
        ((ahead - here) / r_ahead + (behind - here) / r_behind) * (2.0 / (r_ahead + r_behind))
    }
}
