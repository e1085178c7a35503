//! Vertices for places: splits that put a vertex where a place is, several in one triangle or on one edge too.
//!
//! Places are given for a mesh that does not stay: the first split of a triangle leaves three, and the next place in it lies in
//! one of these. Which one is read off the places of their corners, all of them in weights of the old triangle, so that
//! nothing depends on where the mesh lies in space.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::{EdgeId, FaceId, Mesh, Place, VertexId, Wedge};

/// Nearer than this to a side of a part of a triangle, as a share of its height, a place is on the side.
const ON_SIDE: f64 = 0.02;

/// A mesh with vertices made at places of the mesh that it was.
pub(super) struct Sites {
    pub(super) mesh: Mesh,
    pub(super) positions: Vec<DVec3>,
    /// Where the new vertices lie on the old mesh; `None` for those on edges that it did not have.
    born: BTreeMap<VertexId, Option<Place>>,
    /// The old face of every face; those without an entry are their own.
    part_of: BTreeMap<FaceId, FaceId>,
    /// Nearer than this, as a share of an edge or a triangle, places are one.
    snap: f64,
}

impl Sites {
    pub(super) fn new(mesh: &Mesh, positions: &[DVec3], snap: f64) -> Self {
        let mut positions = positions.to_vec();
        positions.resize(mesh.vertex_slots(), DVec3::ZERO);
        Self { mesh: mesh.clone(), positions, born: BTreeMap::new(), part_of: BTreeMap::new(), snap }
    }

    pub(super) fn at(&self, v: VertexId) -> DVec3 {
        self.positions.get(v.index()).copied().unwrap_or(DVec3::ZERO)
    }

    /// The direction in which the surface faces at a vertex, in one of its two senses: that of the old mesh, between whose
    /// corners a new vertex takes the mean. Its own faces all lie in one plane, which leans over as far as the facet does.
    pub(super) fn normal(&self, old: &Mesh, v: VertexId) -> DVec3 {
        match self.born.get(&v) {
            Some(Some(Place::Face { face, weights })) => self.normal_in(old, *face, *weights),
            Some(Some(Place::Edge { edge, at })) => {
                let (face, _) = old.edge_faces(*edge);
                let [a, b] = old.edge_vertices(*edge);
                let weight = |v: VertexId| if v == a { 1.0 - at } else { *at };
                let weights = old.face_vertices(face).map(|v| if v == a || v == b { weight(v) } else { 0.0 });
                self.normal_in(old, face, weights)
            }
            Some(None) => self.normal_at(&self.mesh, v),
            None | Some(Some(Place::Vertex(_))) => self.normal_at(old, v),
        }
    }

    /// The weighted mean of the normals at the corners of an old face, in the sense of the face.
    fn normal_in(&self, old: &Mesh, face: FaceId, weights: [f64; 3]) -> DVec3 {
        let corners = old.face_vertices(face);
        let upright = |k: usize| {
            let agrees =
                old.wedges(corners[k]).find(|wedge| wedge.face() == face).is_none_or(|wedge| wedge.agrees);
            let normal = self.normal_at(old, corners[k]) * weights[k];
            if agrees { normal } else { -normal }
        };
        (upright(0) + upright(1) + upright(2)).try_normalize().unwrap_or(DVec3::ZERO)
    }

    /// The normal at a vertex in the sense of its ring, zero where there is none.
    fn normal_at(&self, mesh: &Mesh, v: VertexId) -> DVec3 {
        let upright = |wedge: Wedge| {
            let [a, b, c] = mesh.face_vertices(wedge.face()).map(|v| self.at(v));
            let normal = (b - a).cross(c - a);
            if wedge.agrees { normal } else { -normal }
        };
        mesh.wedges(v).map(upright).sum::<DVec3>().try_normalize().unwrap_or(DVec3::ZERO)
    }

    /// The new vertices with their positions, in order of their names.
    pub(super) fn made(&self) -> Vec<(VertexId, DVec3)> {
        self.born.keys().map(|&v| (v, self.at(v))).collect()
    }

    /// Where a vertex on a control curve lies on the old mesh.
    pub(super) fn origin(&self, old: &Mesh, v: VertexId) -> Option<Place> {
        match self.born.get(&v) {
            Some(place) => *place,
            None => old.has_vertex(v).then_some(Place::Vertex(v)),
        }
    }

    /// The vertex at a place of the old mesh, made if there is none. All places come before the first [`Sites::split`].
    pub(super) fn settle(&mut self, old: &Mesh, place: Place) -> VertexId {
        let place = place.snapped(old, self.snap);
        let position = place.position(old, &self.positions).unwrap_or(DVec3::ZERO);
        let (vertex, is_new) = match place {
            Place::Vertex(v) => (v, false),
            Place::Edge { edge, at } => self.settle_on_edge(old, edge, at),
            Place::Face { face, weights } => self.settle_in_face(old, face, weights),
        };
        if is_new {
            self.put(vertex, position, Some(place));
        }
        vertex
    }

    /// Splits an edge of the mesh as it is now, `share` of the way between these ends of it.
    pub(super) fn split(&mut self, old: &Mesh, edge: EdgeId, ends: [VertexId; 2], share: f64) -> VertexId {
        let position = self.at(ends[0]).lerp(self.at(ends[1]), share);
        let place = self.place_on_curve(old, edge, ends, share);
        let v = self.split_edge(edge);
        self.put(v, position, place);
        v
    }

    fn put(&mut self, v: VertexId, position: DVec3, place: Option<Place>) {
        if self.positions.len() <= v.index() {
            self.positions.resize(v.index() + 1, DVec3::ZERO);
        }
        self.positions[v.index()] = position;
        self.born.insert(v, place);
    }

    /// The place of a point of a tagged edge on the old mesh. A tagged edge is an old one or part of one.
    fn place_on_curve(&self, old: &Mesh, edge: EdgeId, ends: [VertexId; 2], share: f64) -> Option<Place> {
        self.mesh.edge_source(edge)?;
        let born = ends.map(|v| self.born.get(&v).copied().flatten());
        let whole = born.iter().find_map(|place| match place {
            Some(Place::Edge { edge, .. }) => Some(*edge),
            _ => None,
        });
        let whole = whole.unwrap_or(edge);
        // Splits beside an edge may turn it around: only the old mesh knows which end its shares are counted from.
        let share_of = |k: usize| match born[k] {
            Some(Place::Edge { at, .. }) => at,
            _ if ends[k] == old.edge_vertices(whole)[0] => 0.0,
            _ => 1.0,
        };
        let (from, to) = (share_of(0), share_of(1));
        Some(Place::Edge { edge: whole, at: from + (to - from) * share })
    }

    /// Splits an edge and remembers which old faces the parts of its faces belong to.
    fn split_edge(&mut self, edge: EdgeId) -> VertexId {
        let (f, g) = self.mesh.edge_faces(edge);
        let (apex, _) = self.mesh.edge_opposites(edge);
        let (of_f, of_g) = (self.whole(f), g.map(|g| self.whole(g)));
        let v = self.mesh.split_edge(edge);
        let around: Vec<FaceId> = self.mesh.wedges(v).map(|wedge| wedge.face()).collect();
        for part in around {
            let is_of_f = self.mesh.face_vertices(part).contains(&apex);
            self.part_of.insert(part, if is_of_f { of_f } else { of_g.unwrap_or(of_f) });
        }
        v
    }

    fn whole(&self, f: FaceId) -> FaceId {
        self.part_of.get(&f).copied().unwrap_or(f)
    }

    fn settle_on_edge(&mut self, old: &Mesh, edge: EdgeId, at: f64) -> (VertexId, bool) {
        let [a, b] = old.edge_vertices(edge);
        let mut stations = vec![(0.0, a), (1.0, b)];
        for (&v, place) in &self.born {
            if let Some(Place::Edge { edge: other, at }) = place
                && *other == edge
            {
                stations.push((*at, v));
            }
        }
        stations.sort_by(|one, other| one.0.total_cmp(&other.0));
        if let Some(&(_, v)) = stations.iter().find(|(there, _)| (there - at).abs() < self.snap) {
            return (v, false);
        }
        let between = stations.windows(2).find(|pair| (pair[0].0..pair[1].0).contains(&at));
        let part = between.and_then(|pair| self.mesh.edge_between(pair[0].1, pair[1].1));
        debug_assert!(part.is_some(), "the parts of an edge are edges");
        (self.split_edge(part.unwrap_or(edge)), true)
    }

    fn settle_in_face(&mut self, old: &Mesh, face: FaceId, weights: [f64; 3]) -> (VertexId, bool) {
        let mut best = (f64::NEG_INFINITY, face, [1.0 / 3.0; 3]);
        for part in self.parts(face) {
            let corners = self.mesh.face_vertices(part).map(|v| self.weights_in(old, face, v));
            let inner = weights_within(corners, weights);
            let least = inner[0].min(inner[1]).min(inner[2]);
            if least > best.0 {
                best = (least, part, inner);
            }
        }
        let (least, part, inner) = best;
        for v in self.mesh.face_vertices(part) {
            let there = self.weights_in(old, face, v);
            if (0..3).all(|k| (there[k] - weights[k]).abs() < self.snap) {
                return (v, false);
            }
        }
        let lightest = (0..3).find(|&k| inner[k] == least).unwrap_or(0);
        let side = self.mesh.edge_of(part.halfedge(lightest + 1));
        let is_inner = self
            .mesh
            .edge_faces(side)
            .1
            .is_some_and(|g| self.whole(g) == face && self.whole(self.mesh.edge_faces(side).0) == face);
        if least < ON_SIDE.min(self.snap) && is_inner {
            return (self.split_edge(side), true);
        }
        let v = self.mesh.split_face(part);
        let around: Vec<FaceId> = self.mesh.wedges(v).map(|wedge| wedge.face()).collect();
        around.into_iter().for_each(|part| {
            self.part_of.insert(part, face);
        });
        (v, true)
    }

    /// The faces that an old face consists of now.
    fn parts(&self, face: FaceId) -> Vec<FaceId> {
        let mut parts = vec![face];
        parts.extend(
            self.part_of.iter().filter(|&(&part, &whole)| whole == face && part != face).map(|(&f, _)| f),
        );
        parts
    }

    /// The place of a corner of a part of an old face, in weights of that face.
    fn weights_in(&self, old: &Mesh, face: FaceId, v: VertexId) -> [f64; 3] {
        let corners = old.face_vertices(face);
        let at_corner = |w: VertexId| [0, 1, 2].map(|k| f64::from(u8::from(corners[k] == w)));
        match self.born.get(&v) {
            Some(Some(Place::Face { weights, .. })) => *weights,
            Some(Some(Place::Edge { edge, at })) => {
                let [a, b] = old.edge_vertices(*edge).map(at_corner);
                [0, 1, 2].map(|k| a[k] + (b[k] - a[k]) * at)
            }
            _ => at_corner(v),
        }
    }
}

/// The weights of a point in a triangle, all of them in weights of a larger one; at least one is negative outside.
fn weights_within([a, b, c]: [[f64; 3]; 3], p: [f64; 3]) -> [f64; 3] {
    let area =
        |a: [f64; 3], b: [f64; 3], c: [f64; 3]| (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let whole = area(a, b, c);
    let weights = [area(p, b, c) / whole, area(a, p, c) / whole, area(a, b, p) / whole];
    if weights.iter().all(|w| w.is_finite()) { weights } else { [f64::NEG_INFINITY; 3] }
}
