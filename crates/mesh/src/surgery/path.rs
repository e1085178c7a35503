//! A path laid on the surface: a sequence of places becomes a chain of edges.
//!
//! Source: Welch 1995, §4.2.3 (inserting curves), by splits. First every place gets a vertex (`sites`), then consecutive ones
//! are joined leg by leg, along the channel that the straight line between them takes. An edge in the way is split where the
//! plane through the line crosses it that stands on the surface; where that is next to a vertex the chain runs through the vertex instead, so that a line
//! along edges becomes those edges. The surface stays what it is; only the chain says where the path lies.

use std::collections::BTreeMap;

use glam::DVec3;
use thiserror::Error;

use super::channel::{Crossing, Line, channel};
use super::sites::Sites;
use crate::{EdgeId, Mesh, Place, VertexId};

/// Places nearer than this to a vertex, as a share of the edge, are at the vertex; nearer to an edge, as a share of the
/// triangle's height, on the edge. Splitting there would leave a needle.
const SNAP: f64 = 0.05;
/// The same where places stand so densely that a path would touch itself: a needle is better than no path.
const FINE_SNAP: f64 = 1e-3;

/// A line that comes nearer than this to a vertex of its own path touches it; one between this and [`SNAP`] passes beside.
const TOUCH: f64 = 1e-3;

/// Why a path cannot be laid. Places are numbered as given; leg `k` leads from place `k` to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum PathError {
    /// The element that the place names does not live, or its numbers are out of range.
    #[error("place {0} is not on the surface")]
    NoPlace(usize),
    /// An open path has at least two vertices, a closed one three. Those of places that coincide count once.
    #[error("a path of {0} vertices is too short")]
    TooShort(usize),
    /// No way leads from one place to the other: they are on different pieces.
    #[error("places {0} and {1} are on different pieces of the surface")]
    Apart(usize, usize),
    /// The later leg, or the place at which it begins, would meet the earlier one. Move a place, or lay two paths.
    #[error("leg {0} of the path would touch leg {1}")]
    TouchesItself(usize, usize),
}

/// Where a path meets a control curve: a crossing, a common vertex, or one of those along which both run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meeting {
    /// The place on the surface as it was before: an edge of the curve, or a vertex on it.
    pub place: Place,
    /// Where it lies in space.
    pub position: DVec3,
    /// The vertex there now: `path.vertices[index]`.
    pub index: usize,
    /// The leg on which it lies. A place of the path counts to the leg that begins there, the end of an open one to the last.
    pub leg: usize,
}

/// A path as a chain of edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// The vertices in order. On a closed path the last is joined to the first, which is not repeated.
    pub vertices: Vec<VertexId>,
    /// The edges in order: edge `k` leads from vertex `k` to the next.
    pub edges: Vec<EdgeId>,
    /// For every place given, the index of its vertex among `vertices`. Neighbouring places that coincide share one.
    pub places: Vec<usize>,
    /// Where the path meets control curves, in order.
    pub meetings: Vec<Meeting>,
    /// The vertices that did not exist before, with their positions. Existing ones stay where they are.
    pub made: Vec<(VertexId, DVec3)>,
    /// Whether the path is closed.
    pub is_closed: bool,
}

impl Mesh {
    /// What [`Mesh::lay_path`] would do, without doing it: above all which control curves the path would meet, and where.
    ///
    /// Of the result, `meetings` name places of this mesh; new vertices and edges have the names that they would get.
    ///
    /// # Errors
    /// As [`Mesh::lay_path`].
    pub fn can_lay_path(
        &self,
        places: &[Place],
        is_closed: bool,
        positions: &[DVec3],
    ) -> Result<Path, PathError> {
        Layer::lay_apart(self, places, is_closed, positions).map(|(_, path)| path)
    }

    /// Makes a chain of edges through the places, in order; on a closed path from the last back to the first.
    ///
    /// Places within a twentieth of an edge or a triangle from a vertex or an edge are taken to be there (within a thousandth,
    /// where the path would touch itself otherwise). No tag is set
    /// and none is lost: halves of a split edge keep its tag. An open path may begin and end anywhere, also at the boundary,
    /// and run along it. `positions` guide only; where they are missing or no numbers, the chain is still one.
    ///
    /// ```
    /// use ductile_mesh::{nearest_place, primitive};
    /// use glam::DVec3;
    /// let (mut mesh, mut positions) = primitive::icosphere(2);
    /// let corners = [DVec3::X, DVec3::Y, DVec3::Z];
    /// let places = corners.map(|p| nearest_place(&mesh, &positions, p).expect("a sphere has faces"));
    /// let path = mesh.lay_path(&places, true, &positions)?;
    /// positions.resize(mesh.vertex_slots(), DVec3::ZERO);
    /// path.made.iter().for_each(|&(v, p)| positions[v.index()] = p);
    /// let cut = mesh.cut(&path.edges);
    /// assert_eq!((cut.edges.len(), ductile_mesh::summary(&mesh).components), (path.edges.len(), 2));
    /// # Ok::<(), ductile_mesh::PathError>(())
    /// ```
    ///
    /// # Errors
    /// See [`PathError`]; the mesh is then untouched.
    pub fn lay_path(
        &mut self,
        places: &[Place],
        is_closed: bool,
        positions: &[DVec3],
    ) -> Result<Path, PathError> {
        let (mesh, path) = Layer::lay_apart(self, places, is_closed, positions)?;
        *self = mesh;
        Ok(path)
    }
}

/// One step of a leg.
#[derive(Clone, Copy, Debug)]
enum Step {
    /// Along an edge to a vertex.
    Through(VertexId),
    /// Over an edge, at a share of the way from its one end to the other.
    Across(EdgeId, [VertexId; 2], f64),
}

/// A path in the making.
struct Layer {
    sites: Sites,
    /// The chain so far, and the leg that each vertex begins or lies on.
    chain: Vec<(VertexId, usize)>,
    /// The legs of the chain's vertices and edges.
    leg_of_vertex: BTreeMap<VertexId, usize>,
    leg_of_edge: BTreeMap<EdgeId, usize>,
    /// Vertices at places that the chain has not reached, with the place's number.
    ahead: BTreeMap<VertexId, usize>,
}

impl Layer {
    /// Lays the path. Where places stand so densely that some would become one vertex though others lie between them, they
    /// are told apart more finely.
    fn lay_apart(
        mesh: &Mesh,
        places: &[Place],
        is_closed: bool,
        positions: &[DVec3],
    ) -> Result<(Mesh, Path), PathError> {
        let laid = Self::lay(mesh, places, is_closed, (positions, SNAP));
        if !matches!(laid, Err(PathError::TouchesItself(..))) {
            return laid;
        }
        Self::lay(mesh, places, is_closed, (positions, FINE_SNAP)).or(laid)
    }

    fn lay(
        mesh: &Mesh,
        places: &[Place],
        is_closed: bool,
        (positions, snap): (&[DVec3], f64),
    ) -> Result<(Mesh, Path), PathError> {
        if let Some(index) = places.iter().position(|place| !place.is_on(mesh)) {
            return Err(PathError::NoPlace(index));
        }
        let mut sites = Sites::new(mesh, positions, snap);
        let at: Vec<VertexId> = places.iter().map(|place| sites.settle(mesh, *place)).collect();
        let mut layer = Self {
            sites,
            chain: Vec::new(),
            leg_of_vertex: BTreeMap::new(),
            leg_of_edge: BTreeMap::new(),
            ahead: BTreeMap::new(),
        };
        // The legs that lead somewhere, by the places at their ends.
        let mut stops: Vec<usize> = (0..at.len()).filter(|&k| k == 0 || at[k] != at[k - 1]).collect();
        while is_closed && stops.len() > 1 && at[stops[stops.len() - 1]] == at[stops[0]] {
            stops.pop();
        }
        for &k in &stops {
            if let Some(before) = layer.ahead.insert(at[k], k) {
                return Err(PathError::TouchesItself(k, before));
            }
        }
        if stops.len() < if is_closed { 3 } else { 2 } {
            return Err(PathError::TooShort(stops.len()));
        }
        layer.enter(at[stops[0]], 0);
        for pair in stops.windows(2) {
            layer.leg(mesh, pair[1] - 1, (pair[0], at[pair[0]]), (pair[1], at[pair[1]]))?;
        }
        if is_closed {
            let (last, first) = (stops[stops.len() - 1], stops[0]);
            layer.leg(mesh, places.len() - 1, (last, at[last]), (first, at[first]))?;
        }
        layer.finish(mesh, &at, is_closed)
    }

    fn enter(&mut self, v: VertexId, leg: usize) {
        self.chain.push((v, leg));
        self.leg_of_vertex.insert(v, leg);
        self.ahead.remove(&v);
    }

    /// Joins the vertices of two places.
    fn leg(
        &mut self,
        old: &Mesh,
        leg: usize,
        (start, from): (usize, VertexId),
        (end, to): (usize, VertexId),
    ) -> Result<(), PathError> {
        let sites = &self.sites;
        let line = Line::upright(sites.at(from), sites.at(to), [from, to].map(|v| sites.normal(old, v)));
        let across = channel(&sites.mesh, &sites.positions, from, to, line, Crossing::Curves)
            .ok_or(PathError::Apart(start, end))?;
        for step in self.steps(&across, line) {
            let before = self.last();
            let v = match step {
                Step::Across(edge, ends, share) => {
                    if let Some(&other) = self.leg_of_edge.get(&edge) {
                        return Err(PathError::TouchesItself(leg, other));
                    }
                    self.sites.split(old, edge, ends, share)
                }
                Step::Through(v) => {
                    if let Some(&other) = self.leg_of_vertex.get(&v) {
                        return Err(PathError::TouchesItself(leg, other));
                    }
                    if let Some(&place) = self.ahead.get(&v) {
                        return Err(PathError::TouchesItself(place, leg));
                    }
                    v
                }
            };
            self.connect(before, v, leg, (start, end))?;
            self.enter(v, leg);
        }
        let before = self.last();
        self.connect(before, to, leg, (start, end))?;
        // A closed path comes back to its first vertex, which is there already.
        if self.chain.first().is_none_or(|&(first, _)| first != to) {
            self.enter(to, end);
        }
        Ok(())
    }

    fn last(&self) -> Option<VertexId> {
        self.chain.last().map(|&(v, _)| v)
    }

    /// Takes the edge between two vertices of the chain for the leg.
    fn connect(
        &mut self,
        before: Option<VertexId>,
        v: VertexId,
        leg: usize,
        (start, end): (usize, usize),
    ) -> Result<(), PathError> {
        let Some(before) = before else { return Ok(()) };
        let edge = self.sites.mesh.edge_between(before, v).ok_or(PathError::Apart(start, end))?;
        match self.leg_of_edge.insert(edge, leg) {
            Some(other) => Err(PathError::TouchesItself(leg, other)),
            None => Ok(()),
        }
    }

    /// The way through a channel: edges next to whose ends the line passes give way to the vertex there.
    ///
    /// Edges of a channel that have a vertex in common follow one another, so that it is met once. A vertex that the path
    /// has met, or is to meet at a later place, is passed beside unless the line hits it.
    fn steps(&self, across: &[EdgeId], line: Line) -> Vec<Step> {
        let Sites { mesh, .. } = &self.sites;
        let at = |v: VertexId| self.sites.at(v);
        let is_taken = |v: VertexId| self.leg_of_vertex.contains_key(&v) || self.ahead.contains_key(&v);
        let mut steps: Vec<Step> = Vec::with_capacity(across.len());
        for &edge in across {
            let [a, b] = mesh.edge_vertices(edge);
            let share = line.share(at(a), at(b));
            let (near, distance) = if share < 0.5 { (a, share) } else { (b, 1.0 - share) };
            let reach = if is_taken(near) { TOUCH } else { SNAP };
            let step = match Some(near).filter(|_| distance < reach) {
                Some(v) => Step::Through(v),
                None => Step::Across(edge, [a, b], share.clamp(SNAP, 1.0 - SNAP)),
            };
            let is_repeated =
                |last: &Step| matches!((last, &step), (Step::Through(v), Step::Through(w)) if v == w);
            if !steps.last().is_some_and(is_repeated) {
                // What lies between two passages of one vertex only went round it.
                if let Step::Through(v) = step
                    && let Some(first) =
                        steps.iter().position(|old| matches!(old, Step::Through(w) if *w == v))
                {
                    steps.truncate(first + 1);
                    continue;
                }
                steps.push(step);
            }
        }
        steps
    }

    fn finish(self, old: &Mesh, at: &[VertexId], is_closed: bool) -> Result<(Mesh, Path), PathError> {
        let Self { sites, chain, .. } = self;
        let vertices: Vec<VertexId> = chain.iter().map(|&(v, _)| v).collect();
        let count = vertices.len();
        if is_closed && count < 3 {
            return Err(PathError::TooShort(count));
        }
        let mut index_of = BTreeMap::new();
        vertices.iter().enumerate().for_each(|(index, &v)| {
            index_of.insert(v, index);
        });
        let ends =
            (0..if is_closed { count } else { count - 1 }).map(|k| (vertices[k], vertices[(k + 1) % count]));
        let edges = ends.filter_map(|(v, w)| sites.mesh.edge_between(v, w)).collect();
        let last_leg = at.len().saturating_sub(if is_closed { 1 } else { 2 });
        let meetings = chain
            .iter()
            .enumerate()
            .filter(|&(_, &(v, _))| sites.mesh.is_on_source_curve(v))
            .filter_map(|(index, &(v, leg))| {
                let place = sites.origin(old, v)?;
                Some(Meeting { place, position: sites.at(v), index, leg: leg.min(last_leg) })
            })
            .collect();
        let places = at.iter().filter_map(|v| index_of.get(v).copied()).collect();
        let made = sites.made();
        Ok((sites.mesh, Path { vertices, edges, places, meetings, made, is_closed }))
    }
}

#[cfg(test)]
mod tests;
