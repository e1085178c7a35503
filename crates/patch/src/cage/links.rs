//! Which face lies beyond an edge: the connectivity of a polygon mesh, and what is wrong with one that is no surface.
//!
//! A *half-edge* is a corner of a face and stands for the edge from that corner to the next. Half-edges are numbered face by face.

use super::error::{CageError, LARGEST_COORDINATE, MOST_VALENCE};
use glam::DVec3;

/// No half-edge lies beyond: the edge is on the boundary.
const NONE: u32 = u32::MAX;

/// Connectivity of faces that are known to form an oriented surface.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Links {
    /// Where the half-edges of each face begin, and one past the last.
    start: Vec<u32>,
    /// Vertex at which each half-edge begins.
    origin: Vec<u32>,
    /// The face of each half-edge.
    face: Vec<u32>,
    /// The half-edge that runs along the same edge in the other face.
    twin: Vec<u32>,
    /// For each vertex a half-edge that begins there; on a boundary the first of its fan, counter-clockwise.
    outgoing: Vec<u32>,
    /// How many faces each vertex has.
    valence: Vec<u32>,
}

impl Links {
    /// Links faces, given as corners counter-clockwise, over that many vertices.
    pub(super) fn new(vertices: usize, faces: &[impl AsRef<[u32]>]) -> Result<Self, CageError> {
        let corners: usize = faces.iter().map(|face| face.as_ref().len()).sum();
        if u32::try_from(corners).is_err() || u32::try_from(vertices).is_err() {
            return Err(CageError::TooMany);
        }
        if faces.is_empty() {
            return Err(CageError::NoFaces);
        }
        let (mut start, mut origin, mut face_of) = (vec![0], Vec::new(), Vec::new());
        for (face, polygon) in (0_u32..).zip(faces) {
            let polygon = polygon.as_ref();
            check_face(face, polygon, vertices)?;
            origin.extend_from_slice(polygon);
            face_of.resize(origin.len(), face);
            start.push(name(origin.len()));
        }
        let twin = vec![NONE; origin.len()];
        let mut links = Self {
            start,
            origin,
            face: face_of,
            twin,
            outgoing: vec![NONE; vertices],
            valence: vec![0; vertices],
        };
        links.pair()?;
        links.find_fans()?;
        Ok(links)
    }

    pub(super) fn vertex_count(&self) -> usize {
        self.outgoing.len()
    }

    pub(super) fn half_edge_count(&self) -> usize {
        self.origin.len()
    }

    pub(super) fn face_count(&self) -> usize {
        self.start.len() - 1
    }

    /// The half-edges of a face.
    pub(super) fn half_edges(&self, face: usize) -> std::ops::Range<usize> {
        self.start[face] as usize..self.start[face + 1] as usize
    }

    pub(super) fn origin(&self, half_edge: usize) -> usize {
        self.origin[half_edge] as usize
    }

    pub(super) fn face(&self, half_edge: usize) -> usize {
        self.face[half_edge] as usize
    }

    /// The half-edge so many corners further in the same face.
    pub(super) fn after(&self, half_edge: usize, steps: usize) -> usize {
        let range = self.half_edges(self.face(half_edge));
        range.start + (half_edge - range.start + steps) % range.len()
    }

    pub(super) fn before(&self, half_edge: usize) -> usize {
        let range = self.half_edges(self.face(half_edge));
        if half_edge == range.start { range.end - 1 } else { half_edge - 1 }
    }

    pub(super) fn twin(&self, half_edge: usize) -> Option<usize> {
        Some(self.twin[half_edge]).filter(|&twin| twin != NONE).map(|twin| twin as usize)
    }

    /// The next half-edge out of the same vertex, counter-clockwise.
    pub(super) fn turn(&self, half_edge: usize) -> Option<usize> {
        self.twin(self.before(half_edge))
    }

    /// The fan of half-edges out of a vertex, counter-clockwise; empty for a vertex that no face uses.
    pub(super) fn fan(&self, vertex: usize) -> impl Iterator<Item = usize> + '_ {
        let first = Some(self.outgoing[vertex]).filter(|&h| h != NONE).map(|h| h as usize);
        std::iter::successors(first, move |&h| self.turn(h).filter(|&next| Some(next) != first))
    }

    /// Number of faces at a vertex.
    pub(super) fn valence(&self, vertex: usize) -> usize {
        self.valence[vertex] as usize
    }

    /// Whether a vertex lies on the boundary.
    pub(super) fn is_boundary(&self, vertex: usize) -> bool {
        let first = self.outgoing[vertex];
        first != NONE && self.twin(first as usize).is_none()
    }

    pub(super) fn is_closed(&self) -> bool {
        self.twin.iter().all(|&twin| twin != NONE)
    }

    /// One half-edge of every edge, in order of first sight.
    pub(super) fn edges(&self) -> impl Iterator<Item = usize> + '_ {
        (0..self.half_edge_count()).filter(|&h| self.twin(h).is_none_or(|twin| h < twin))
    }

    fn pair(&mut self) -> Result<(), CageError> {
        let ends = |h: usize| {
            let (from, to) = (self.origin(h), self.origin(self.after(h, 1)));
            (from.min(to), from.max(to), h)
        };
        let mut edges: Vec<_> = (0..self.half_edge_count()).map(ends).collect();
        edges.sort_unstable();
        for group in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            let &[(from, to, first), ref others @ ..] = group else { continue };
            let (low, high) = (name(from), name(to));
            match *others {
                [] => {}
                [(_, _, second)] if self.origin[first] == self.origin[second] => {
                    let [from, to] = if self.origin[first] == low { [low, high] } else { [high, low] };
                    let [first, second] = [first, second].map(|h| self.face[h]);
                    return Err(CageError::Winding { first, second, from, to });
                }
                [(_, _, second)] => {
                    self.twin[first] = name(second);
                    self.twin[second] = name(first);
                }
                _ => return Err(CageError::ManyFacesAtEdge { from: low, to: high, faces: group.len() }),
            }
        }
        Ok(())
    }

    fn find_fans(&mut self) -> Result<(), CageError> {
        for h in 0..self.half_edge_count() {
            let vertex = self.origin(h);
            self.valence[vertex] += 1;
            if self.outgoing[vertex] == NONE || self.twin(h).is_none() {
                self.outgoing[vertex] = name(h);
            }
        }
        for vertex in 0..self.vertex_count() {
            let valence = self.valence(vertex);
            let limit = if self.is_boundary(vertex) { MOST_VALENCE / 2 } else { MOST_VALENCE };
            let named = name(vertex);
            if self.fan(vertex).count() != valence {
                return Err(CageError::TwoFans { vertex: named });
            }
            if valence > limit {
                return Err(CageError::TooManyFaces { vertex: named, valence });
            }
            if valence > 0 && valence < 3 && !self.is_boundary(vertex) {
                return Err(CageError::TooFewFaces { vertex: named, valence });
            }
        }
        Ok(())
    }
}

fn check_face(face: u32, polygon: &[u32], vertices: usize) -> Result<(), CageError> {
    let corners = polygon.len();
    if corners < 3 {
        return Err(CageError::TooFewCorners { face, corners });
    }
    if corners > MOST_VALENCE {
        return Err(CageError::TooManyCorners { face, corners });
    }
    if let Some(&vertex) = polygon.iter().find(|&&vertex| vertex as usize >= vertices) {
        return Err(CageError::NoSuchVertex { face, vertex, count: vertices });
    }
    let mut sorted = polygon.to_vec();
    sorted.sort_unstable();
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(CageError::RepeatedVertex { face, vertex: pair[0] }),
        None => Ok(()),
    }
}

/// Refuses positions that are no numbers to reckon with.
pub(super) fn check_positions(positions: &[DVec3]) -> Result<(), CageError> {
    let is_good = |p: &DVec3| p.to_array().iter().all(|x| x.abs() <= LARGEST_COORDINATE);
    match positions.iter().position(|p| !is_good(p)) {
        Some(vertex) => Err(CageError::Position { vertex: name(vertex) }),
        None => Ok(()),
    }
}

/// An index as stored; every count was checked against `u32` when the links were made.
#[expect(clippy::cast_possible_truncation, reason = "counts were checked by Links::new")]
pub(super) fn name(index: usize) -> u32 {
    index as u32
}
