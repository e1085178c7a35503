//! The loops of a model's curves: its control curves, cut where they meet at control points, as a network; and what lies beside each
//! part already.

use crate::model::Model;
use ductile_patch::{Directed, NetworkEdge};
use ductile_spec::{Cage, CurveId, FillSide, PointId, SurfaceId};
use std::collections::{BTreeMap, BTreeSet};

/// The curves of a model, cut at the points where they meet or end.
pub(super) struct Curves {
    /// The parts, as a network whose nodes are control points.
    pub(super) edges: Vec<NetworkEdge>,
    /// Which part of which curve each is.
    parts: Vec<Part>,
}

/// A part of a curve between two nodes, in the sense of the curve.
#[derive(Clone, Debug)]
struct Part {
    curve: CurveId,
    /// The control points along it, both ends included.
    points: Vec<PointId>,
    /// The first sample of the curve on it, and its number of edges.
    samples: (usize, usize),
    closed: bool,
}

/// A stretch between two control points that follow one another on a curve, in the sense of the curve.
type Span = (CurveId, PointId, PointId);

impl Curves {
    /// Those of a model. Curves of which `counts` says no are left out.
    pub(super) fn of(model: &Model, counts: impl Fn(CurveId) -> bool) -> Self {
        let mut uses: BTreeMap<PointId, usize> = BTreeMap::new();
        let curves = model.document.curves.iter().filter(|(id, _)| counts(**id));
        for point in curves.clone().flat_map(|(_, curve)| &curve.through) {
            *uses.entry(*point).or_default() += 1;
        }
        let mut found = Self { edges: Vec::new(), parts: Vec::new() };
        for (id, curve) in curves {
            let Some(shape) = model.curves.get(id) else { continue };
            let count = curve.through.len();
            let is_end = |k: usize| !curve.closed && (k == 0 || k + 1 == count);
            let mut nodes: Vec<usize> = (0..count)
                .filter(|k| is_end(*k) || uses.get(&curve.through[*k]).is_some_and(|n| *n > 1))
                .collect();
            if nodes.is_empty() {
                nodes.push(0);
            }
            let next = nodes.iter().skip(1).copied().chain(curve.closed.then(|| nodes[0] + count));
            let pairs: Vec<(usize, usize)> = nodes.iter().copied().zip(next).collect();
            for (from, to) in pairs {
                let points: Vec<PointId> = (from..=to).map(|k| curve.through[k % count]).collect();
                let (Some(first), Some(last)) =
                    (shape.sample_of(points[0]), points.last().and_then(|p| shape.sample_of(*p)))
                else {
                    continue;
                };
                let nodes = shape.nodes.len();
                let edges = if curve.closed && last <= first {
                    last + nodes - first
                } else {
                    last.saturating_sub(first)
                };
                let along = (0..=edges).map(|edge| shape.nodes[(first + edge) % nodes]).collect();
                let ends = [points[0], points[points.len() - 1]].map(|point| point.0 as usize);
                found.edges.push(NetworkEdge { ends, along });
                found.parts.push(Part { curve: *id, points, samples: (first, edges), closed: curve.closed });
            }
        }
        found
    }

    /// The part of a curve on which a sample's edge lies.
    pub(super) fn part_at(&self, curve: CurveId, edge: usize, count: usize) -> Option<usize> {
        self.parts.iter().position(|part| {
            let (first, edges) = part.samples;
            part.curve == curve && (edge + count - first) % count < edges
        })
    }

    /// The parts of a curve.
    pub(super) fn parts_of(&self, curve: CurveId) -> Vec<usize> {
        (0..self.parts.len()).filter(|at| self.parts[*at].curve == curve).collect()
    }

    /// Whether a loop is a closed curve by itself.
    pub(super) fn alone(&self, found: &[Directed]) -> Option<CurveId> {
        let [only] = found else { return None };
        self.parts.get(only.edge).filter(|part| part.closed).map(|part| part.curve)
    }

    /// The sides of a loop. Parts of one curve that follow one another are one side, since a curve does not turn at its points.
    pub(super) fn sides(&self, found: &[Directed]) -> Vec<FillSide> {
        let goes_on = |now: &Directed, next: &Directed| {
            let (one, other) = (&self.parts[now.edge], &self.parts[next.edge]);
            one.curve == other.curve && now.back == next.back
        };
        let count = found.len();
        // Begin where one side ends, if there is such a place.
        let start = (0..count).find(|k| !goes_on(&found[(k + count - 1) % count], &found[*k])).unwrap_or(0);
        let mut sides: Vec<FillSide> = Vec::new();
        let mut before: Option<Directed> = None;
        for k in 0..count {
            let step = found[(start + k) % count];
            let part = &self.parts[step.edge];
            let (first, last) = (part.points[0], part.points[part.points.len() - 1]);
            let (from, to) = if step.back { (last, first) } else { (first, last) };
            match sides.last_mut() {
                Some(side) if before.is_some_and(|before| goes_on(&before, &step)) => side.to = to,
                _ => sides
                    .push(FillSide { back: part.closed && step.back, ..FillSide::new(part.curve, from, to) }),
            }
            before = Some(step);
        }
        sides
    }
}

/// The spans that a side consists of.
fn spans(model: &Model, side: &FillSide) -> Vec<Span> {
    let Some(curve) = model.document.curves.get(&side.curve) else { return Vec::new() };
    let (stretch, _) = side.stretch(curve);
    let place = |point: PointId| curve.through.iter().position(|other| *other == point);
    let (Some(from), Some(to)) = (place(stretch.from), place(stretch.to)) else { return Vec::new() };
    let count = curve.through.len();
    let steps = if to > from { to - from } else { to + count - from };
    let at = |k: usize| curve.through[(from + k) % count];
    (0..steps).map(|k| (side.curve, at(k), at(k + 1))).collect()
}

/// Which surfaces end at, or run through, each span.
pub(super) struct Neighbours {
    beside: BTreeMap<Span, Vec<Beside>>,
    loops: BTreeSet<BTreeSet<Span>>,
}

/// A surface beside a span.
#[derive(Clone, Copy, Debug)]
struct Beside {
    surface: SurfaceId,
    /// Whether it ends there; otherwise it lies on both sides.
    ends: bool,
    /// Whether it has the span on its left, if it ends there and that can be told.
    left: Option<bool>,
}

impl Neighbours {
    pub(super) fn of(model: &Model) -> Self {
        let mut found = Self { beside: BTreeMap::new(), loops: BTreeSet::new() };
        for (id, shape) in &model.surfaces {
            for embedded in &shape.embeddings {
                let (Some(curve), Some(drawn)) =
                    (model.document.curves.get(&embedded.curve), model.curves.get(&embedded.curve))
                else {
                    continue;
                };
                let (count, samples) = (curve.through.len(), embedded.vertices.len());
                for k in 0..if curve.closed { count } else { count - 1 } {
                    let (from, to) = (curve.through[k], curve.through[(k + 1) % count]);
                    let Some(sample) = drawn.sample_of(from) else { continue };
                    let (a, b) = (embedded.vertices[sample], embedded.vertices[(sample + 1) % samples]);
                    let Some(edge) = shape.mesh.edge_between(a, b) else { continue };
                    let ends = shape.mesh.is_boundary_edge(edge);
                    let corners = shape.mesh.face_vertices(shape.mesh.edge_faces(edge).0);
                    let runs_along = (0..3).any(|c| corners[c] == a && corners[(c + 1) % 3] == b);
                    let beside = Beside { surface: *id, ends, left: ends.then_some(runs_along) };
                    found.beside.entry((embedded.curve, from, to)).or_default().push(beside);
                }
            }
        }
        found.add_rims(model);
        for (id, fill) in &model.document.fills {
            let mut all = BTreeSet::new();
            for side in &fill.sides {
                let runs_along =
                    model.document.curves.get(&side.curve).is_some_and(|curve| !side.stretch(curve).1);
                for span in spans(model, side) {
                    let beside = Beside { surface: *id, ends: true, left: Some(runs_along) };
                    found.beside.entry(span).or_default().push(beside);
                    all.insert(span);
                }
            }
            found.loops.insert(all);
        }
        found
    }

    /// The surfaces over cages whose rims are curves.
    fn add_rims(&mut self, model: &Model) {
        for (id, curve) in &model.document.curves {
            let Some(surface) = curve.rim else { continue };
            let Some(rim) = model.document.cages.get(&surface).map(Cage::rim) else { continue };
            let count = curve.through.len();
            for k in 0..if curve.closed { count } else { count - 1 } {
                let (from, to) = (curve.through[k], curve.through[(k + 1) % count]);
                // A rim has its cage on the left.
                let left = rim.get(&from).is_some_and(|edge| edge.to == to);
                let beside = Beside { surface, ends: true, left: Some(left) };
                self.beside.entry((*id, from, to)).or_default().push(beside);
            }
        }
    }

    /// Whether a fill has exactly these sides.
    pub(super) fn is_filled(&self, model: &Model, sides: &[FillSide]) -> bool {
        self.loops.contains(&sides.iter().flat_map(|side| spans(model, side)).collect())
    }

    /// How many spans of a loop have surfaces on both sides already.
    pub(super) fn crowd(&self, model: &Model, sides: &[FillSide]) -> usize {
        let banks = |span: &Span| -> usize {
            self.beside.get(span).into_iter().flatten().map(|beside| if beside.ends { 1 } else { 2 }).sum()
        };
        sides.iter().flat_map(|side| spans(model, side)).filter(|span| banks(span) > 1).count()
    }

    /// The surface that ends all along a side, if there is one; of several the first fair one, since fills follow more easily.
    pub(super) fn beside(&self, model: &Model, side: &FillSide) -> Option<SurfaceId> {
        let spans = spans(model, side);
        let ends = |span: &Span| -> BTreeSet<SurfaceId> {
            let here = self.beside.get(span).into_iter().flatten();
            here.filter(|beside| beside.ends).map(|beside| beside.surface).collect()
        };
        let all = spans.iter().map(ends).reduce(|a, b| a.intersection(&b).copied().collect())?;
        // A fill with another division of the curve has no side that could be followed.
        let is_same = |id: &SurfaceId| {
            model.document.fills.get(id).is_none_or(|fill| {
                let stretch = |side: &FillSide| {
                    model.document.curves.get(&side.curve).map(|curve| side.stretch(curve).0)
                };
                fill.sides.iter().any(|other| stretch(other) == stretch(side))
            })
        };
        let fair = all.iter().find(|id| model.surfaces.contains_key(id));
        fair.or_else(|| all.iter().find(|id| is_same(id))).copied()
    }

    /// Whether a loop would have to run the other way round to face as most of its neighbours do.
    pub(super) fn is_against(&self, model: &Model, sides: &[FillSide]) -> bool {
        let mut balance = 0_i32;
        for side in sides {
            let Some(curve) = model.document.curves.get(&side.curve) else { continue };
            let runs_along = !side.stretch(curve).1;
            for span in spans(model, side) {
                for left in self.beside.get(&span).into_iter().flatten().filter_map(|beside| beside.left) {
                    // Two surfaces that face alike have their common curve on different sides.
                    balance += if left == runs_along { 1 } else { -1 };
                }
            }
        }
        balance > 0
    }
}

/// The same loop the other way round.
pub(super) fn reversed(sides: &[FillSide], is_closed: impl Fn(CurveId) -> bool) -> Vec<FillSide> {
    let turn = |side: &FillSide| FillSide {
        from: side.to,
        to: side.from,
        back: is_closed(side.curve) && !side.back,
        turn: -side.turn,
        ..*side
    };
    sides.iter().rev().map(turn).collect()
}
