//! The acts of surgery, each with its promise.

use ductile_mesh::{
    Bridge, EdgeId, FaceId, GlueError, Mesh, Path, Place, Seam, Sense, SourceTag, VertexId, boundary_loops,
    components, dehydrate, primitive, propagate_orientation, reverse_face,
};
use glam::DVec3;

use crate::census::Census;

/// How many kinds of acts there are.
pub(crate) const KINDS: u8 = 18;

/// A kind of act and three numbers to choose by.
pub(crate) type Act = (u8, u32, u32, u32);

/// By how much an act changes the kind of a surface, and whether all of it has two sides then.
#[derive(Debug)]
pub(crate) struct Promise {
    euler: i64,
    boundaries: i64,
    components: i64,
    is_orientable: bool,
}

pub(crate) enum Outcome {
    Done(Promise),
    Refused,
}

fn signed(n: usize) -> i64 {
    i64::try_from(n).unwrap()
}

impl Promise {
    /// The surface stays what it is.
    fn nothing(before: &Census) -> Self {
        Self::change(before, before)
    }

    /// It becomes what was reckoned.
    fn change(before: &Census, after: &Census) -> Self {
        Self {
            euler: after.euler - before.euler,
            boundaries: signed(after.boundaries) - signed(before.boundaries),
            components: signed(after.components) - signed(before.components),
            is_orientable: after.is_orientable(),
        }
    }

    pub(crate) fn check(&self, before: &Census, after: &Census, act: Act) {
        let done = Self::change(before, after);
        let kind =
            |promise: &Self| (promise.euler, promise.boundaries, promise.components, promise.is_orientable);
        assert_eq!(kind(&done), kind(self), "{act:?}: {:?} became {:?}", before.kind(), after.kind());
    }
}

/// A mesh with positions that guide, as far as there are any.
pub(crate) struct World {
    pub(crate) mesh: Mesh,
    positions: Vec<DVec3>,
    tags: u32,
}

fn hexagon() -> Vec<DVec3> {
    (0..6).map(|i| DVec3::new(f64::from(i), f64::from(i * i), 0.0)).collect()
}

fn shape(which: usize) -> (Mesh, Vec<DVec3>) {
    match which {
        0 => primitive::octahedron(),
        1 => primitive::sheet(&hexagon(), 2).unwrap(),
        2 => primitive::cylinder(&hexagon(), &hexagon()[..4], 1).unwrap(),
        3 => primitive::torus(6, 5, 2.0, 1.0),
        4 => primitive::moebius(7, 3, 2.0, 1.0),
        5 => primitive::klein_bottle(6, 5, 2.0, 1.0),
        _ => primitive::tetrahedron(),
    }
}

fn pick<T: Copy>(from: &[T], by: u32) -> Option<T> {
    from.get(by as usize % from.len().max(1)).copied()
}

/// So many vertices of a rim, in its order, whichever comes first.
fn some_of(rim: &[VertexId], by: u32, count: usize) -> Vec<VertexId> {
    let hash = |k: &usize| (by ^ u32::try_from(*k).unwrap()).wrapping_mul(0x9e37_79b9).rotate_left(15);
    let mut places: Vec<usize> = (0..rim.len()).collect();
    places.sort_by_key(|k| hash(k).wrapping_mul(0x85eb_ca6b));
    places.truncate(count);
    places.sort_unstable();
    places.rotate_left(by as usize % count);
    places.into_iter().map(|k| rim[k]).collect()
}

fn share(by: u32) -> f64 {
    f64::from(by) / f64::from(u32::MAX)
}

impl World {
    pub(crate) const STARTS: usize = 7;

    pub(crate) fn start(which: usize) -> Self {
        let (mesh, positions) = shape(which);
        Self { mesh, positions, tags: 0 }
    }

    /// Does an act, or another where this one would let the world grow or vanish; gives which.
    pub(crate) fn play(&mut self, (kind, a, b, c): Act) -> (u8, Outcome) {
        let pieces = components(&self.mesh).count();
        let kind = match kind {
            _ if pieces == 0 => 14,
            _ if self.mesh.vertex_count() > 110 && self.tags == 0 => 13,
            _ if self.mesh.vertex_count() > 110 => 16,
            _ if pieces > 5 => 15,
            kind => kind,
        };
        let before = Census::of(&self.mesh);
        let outcome = match kind {
            0 => self.local(a, |mesh, e| {
                mesh.split_edge(e);
                true
            }),
            1 => self.local(a, |mesh, e| {
                mesh.split_face(mesh.edge_faces(e).0);
                true
            }),
            2 => self.local(a, |mesh, e| mesh.can_flip(e).is_ok().then(|| mesh.flip(e)).is_some()),
            3 => self.local(a, |mesh, e| {
                let [v, w] = mesh.edge_vertices(e);
                mesh.can_collapse(v, w).is_ok().then(|| mesh.collapse(v, w)).is_some()
            }),
            4 => self.local(a, |mesh, e| {
                let [v, _] = mesh.edge_vertices(e);
                mesh.can_delete(v).is_ok().then(|| mesh.delete_vertex(v)).is_some()
            }),
            5 => self.insert(a, b, true),
            6 => self.insert(a, b, false),
            7 => self.lay(a, b, c).is_some(),
            8 => return (kind, self.cut(&before, a, b, c)),
            9 => return (kind, self.bridge(a, b, c)),
            10 => return (kind, self.glue(a, b, c)),
            11 => return (kind, self.sew(&before, a)),
            12 => return (kind, self.remove(&before, a, b)),
            13 => {
                let dry = dehydrate(&self.mesh, &self.positions);
                self.positions = dry.carry(&self.positions);
                self.mesh = dry.mesh;
                true
            }
            14 => return (kind, self.append(&before, a)),
            15 => return (kind, self.drop_piece(&before, a)),
            16 => {
                self.mesh.clear_sources();
                self.tags = 0;
                true
            }
            _ => {
                self.turn(a, b);
                true
            }
        };
        self.place_new();
        (kind, if outcome { Outcome::Done(Promise::nothing(&before)) } else { Outcome::Refused })
    }

    /// New vertices lie in the middle of their neighbours.
    fn place_new(&mut self) {
        let known = self.positions.len();
        self.positions.resize(self.mesh.vertex_slots(), DVec3::ZERO);
        for v in self.mesh.vertices().filter(|v| v.index() >= known) {
            let (sum, count) = self
                .mesh
                .neighbours(v)
                .fold((DVec3::ZERO, 0.0), |(sum, count), w| (sum + self.positions[w.index()], count + 1.0));
            self.positions[v.index()] = sum / count;
        }
    }

    fn vertex(&self, by: u32) -> VertexId {
        pick(&self.mesh.vertices().collect::<Vec<_>>(), by).unwrap()
    }

    fn local(&mut self, by: u32, act: impl Fn(&mut Mesh, EdgeId) -> bool) -> bool {
        let edge = pick(&self.mesh.edges().collect::<Vec<_>>(), by).unwrap();
        act(&mut self.mesh, edge)
    }

    fn insert(&mut self, a: u32, b: u32, by_flips: bool) -> bool {
        let (from, to) = (self.vertex(a), self.vertex(b));
        if by_flips {
            self.mesh.insert_edge(from, to, &self.positions).is_ok()
        } else {
            self.mesh.insert_chain(from, to, &self.positions).is_ok()
        }
    }

    fn somewhere(&self, by: u32) -> Place {
        let faces: Vec<FaceId> = self.mesh.faces().collect();
        let (face, rest) = (pick(&faces, by).unwrap(), by.rotate_left(16).wrapping_mul(0x9e37_79b9));
        let [u, v] = [share(rest), share(rest.rotate_left(11).wrapping_mul(0x85eb_ca6b))];
        let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
        Place::Face { face, weights: [1.0 - u - v, u, v] }
    }

    /// A path of two to five places; every other one becomes a control curve.
    fn lay(&mut self, a: u32, b: u32, c: u32) -> Option<Path> {
        let count = 2 + a % 4;
        let places: Vec<_> =
            (0..count).map(|k| self.somewhere(b.rotate_left(7 * k) ^ c.rotate_left(13 * k))).collect();
        let is_closed = a & 64 > 0;
        let path = self.mesh.lay_path(&places, is_closed, &self.positions).ok()?;
        self.positions.resize(self.mesh.vertex_slots(), DVec3::ZERO);
        path.made.iter().for_each(|&(v, p)| self.positions[v.index()] = p);
        if a & 128 > 0 {
            self.tags += 1;
            let tag = Some(SourceTag(self.tags));
            path.edges.iter().for_each(|&e| self.mesh.set_edge_source(e, tag));
            let ends = [path.vertices[0], path.vertices[path.vertices.len() - 1]];
            ends.into_iter().filter(|_| !is_closed).for_each(|v| self.mesh.set_vertex_source(v, tag));
        }
        Some(path)
    }

    /// Cuts along a path: along all of it that lies inside.
    fn cut(&mut self, before: &Census, a: u32, b: u32, c: u32) -> Outcome {
        let mut trial = Self { mesh: self.mesh.clone(), positions: self.positions.clone(), tags: self.tags };
        let Some(path) = trial.lay(a, b, c) else { return Outcome::Refused };
        let mesh = &trial.mesh;
        let edges: Vec<_> = path.edges.iter().copied().filter(|&e| !mesh.is_boundary_edge(e)).collect();
        if edges.is_empty() || mesh.can_cut(&edges).is_err() {
            return Outcome::Refused;
        }
        let after = Census::apart(mesh, |e| edges.contains(&e), |_| true);
        let promise = Promise::change(before, &after);
        if !path.vertices.iter().any(|v| mesh.is_boundary_vertex(*v)) {
            // A slit, or a closed curve, which has two sides or one and parts the surface or not.
            let kinds = if path.is_closed { [(0, 2), (0, 1)] } else { [(-1, 1); 2] };
            assert!(kinds.contains(&(promise.euler, promise.boundaries)), "{promise:?}");
        }
        trial.mesh.cut(&edges);
        trial.place_new();
        *self = trial;
        Outcome::Done(promise)
    }

    /// Two boundary loops, whether they are in one piece, and whether that has one side only.
    fn two_loops(&self, a: u32, b: u32) -> Option<(Vec<VertexId>, Vec<VertexId>, bool, bool)> {
        let loops = boundary_loops(&self.mesh);
        let count = u32::try_from(loops.len()).unwrap();
        if count < 2 {
            return None;
        }
        let (i, j) = (a % count, (a % count + 1 + b % (count - 1)) % count);
        let [one, other] = [i, j].map(|k| loops[k as usize].clone());
        let pieces = components(&self.mesh);
        let piece = |v: VertexId| pieces.of(self.mesh.anchor(v).face());
        let census = Census::of(&self.mesh);
        let is_one_sided =
            self.mesh.faces().zip(&census.is_one_sided).any(|(f, is)| *is && pieces.of(f) == piece(one[0]));
        Some((one.clone(), other.clone(), piece(one[0]) == piece(other[0]), is_one_sided))
    }

    /// Two boundaries less; two pieces become one, or one gets a handle or two crosscaps.
    fn joined(&self, before: &Census, is_same_piece: bool, is_one_sided: bool, is_oriented: bool) -> Promise {
        let stays = is_oriented || !is_same_piece || is_one_sided;
        let components = if is_same_piece { 0 } else { -1 };
        let is_orientable = before.is_orientable() && stays;
        Promise { euler: 0, boundaries: -2, components, is_orientable }
    }

    fn bridge(&mut self, a: u32, b: u32, c: u32) -> Outcome {
        let mut trial = self.mesh.clone();
        propagate_orientation(&mut trial);
        std::mem::swap(&mut self.mesh, &mut trial);
        let Some((one, other, is_same_piece, is_one_sided)) = self.two_loops(a, b) else {
            self.mesh = trial;
            return Outcome::Refused;
        };
        let before = Census::of(&self.mesh);
        let sense = if c.is_multiple_of(2) { Sense::Oriented } else { Sense::Reversed };
        let bridge = Bridge { one, other, nodes: Default::default(), is_closed: true, sense };
        self.mesh.make_room_to_bridge(&bridge, &self.positions).unwrap();
        self.place_new();
        self.mesh.bridge(&bridge, &self.positions).unwrap();
        Outcome::Done(self.joined(&before, is_same_piece, is_one_sided, sense == Sense::Oriented))
    }

    fn glue(&mut self, a: u32, b: u32, c: u32) -> Outcome {
        let mut trial = self.mesh.clone();
        propagate_orientation(&mut trial);
        std::mem::swap(&mut self.mesh, &mut trial);
        let Some((kept, mut gone, is_same_piece, is_one_sided)) = self.two_loops(a, b) else {
            self.mesh = trial;
            return Outcome::Refused;
        };
        let before = Census::of(&self.mesh);
        // Both run along their faces: laid against one another they keep the sense.
        let is_oriented = c.is_multiple_of(2);
        if is_oriented {
            gone.reverse();
        }
        // Some nodes of the one belong to as many of the other.
        let count = 1 + (b >> 8) as usize % kept.len().min(gone.len());
        let (own, mut theirs) = (some_of(&kept, a, count), some_of(&gone, c, count));
        let is_crossed = count > 3 && (b >> 24).is_multiple_of(8);
        if is_crossed {
            theirs.swap(0, 1);
        }
        let mut seam = Seam { kept, gone, is_closed: true };
        match self.mesh.correspond(&mut seam, [&own, &theirs]) {
            Ok(_) => assert!(!is_crossed, "{own:?} {theirs:?}"),
            Err(error) => {
                assert!(is_crossed && matches!(error, GlueError::OutOfOrder(_)), "{error}");
                self.mesh = trial;
                return Outcome::Refused;
            }
        }
        self.mesh.make_room(&seam).unwrap();
        self.mesh.glue(&seam);
        self.place_new();
        Outcome::Done(self.joined(&before, is_same_piece, is_one_sided, is_oriented))
    }

    /// Closes a boundary by sewing one half of it to the other.
    fn sew(&mut self, before: &Census, a: u32) -> Outcome {
        let mut loops = boundary_loops(&self.mesh);
        if loops.is_empty() {
            return Outcome::Refused;
        }
        let mut rim = loops.swap_remove(a as usize % loops.len());
        if rim.len() % 2 == 1 {
            let edge = self.mesh.edge_between(rim[0], rim[1]).unwrap();
            rim.insert(1, self.mesh.split_edge(edge));
        }
        let half = rim.len() / 2;
        let kept = rim[..=half].to_vec();
        let gone = [rim[0]].into_iter().chain(rim[half..].iter().rev().copied()).collect();
        let seam = Seam { kept, gone, is_closed: false };
        self.mesh.make_room(&seam).unwrap();
        self.mesh.glue(&seam);
        self.place_new();
        let is_orientable = before.is_orientable();
        Outcome::Done(Promise { euler: 1, boundaries: -1, components: 0, is_orientable })
    }

    /// A face inside goes and leaves a hole; or any faces go, and what is left is counted.
    fn remove(&mut self, before: &Census, a: u32, b: u32) -> Outcome {
        let faces: Vec<FaceId> = self.mesh.faces().collect();
        let chosen = pick(&faces, a).unwrap();
        let is_inside = !self.mesh.face_vertices(chosen).iter().any(|v| self.mesh.is_boundary_vertex(*v));
        if is_inside && !b.is_multiple_of(4) {
            let removed = self.mesh.remove_faces(|f| f == chosen);
            assert!(removed.faces == 1 && removed.gone.is_empty() && removed.split.is_empty());
            let is_orientable = before.is_orientable();
            return Outcome::Done(Promise { euler: -1, boundaries: 1, components: 0, is_orientable });
        }
        let mut around = Vec::new();
        self.mesh.ring_faces(self.mesh.face_vertices(chosen)[0], &mut around);
        let doomed: Vec<FaceId> = around.into_iter().filter(|f| (b >> (f.index() % 31)) & 1 == 0).collect();
        let is_left = |f: FaceId| !doomed.contains(&f);
        let promise = Promise::change(before, &Census::apart(&self.mesh, |_| false, is_left));
        self.mesh.remove_faces(|f| !is_left(f));
        self.place_new();
        Outcome::Done(promise)
    }

    fn append(&mut self, before: &Census, a: u32) -> Outcome {
        let (other, positions) = shape(a as usize % Self::STARTS);
        let more = Census::of(&other);
        let added = self.mesh.append(&other);
        self.positions.resize(self.mesh.vertex_slots(), DVec3::ZERO);
        for (new, p) in added.vertices.into_iter().flatten().zip(positions) {
            self.positions[new.index()] = p + DVec3::new(share(a), 0.5, 0.25);
        }
        Outcome::Done(Promise {
            euler: more.euler,
            boundaries: signed(more.boundaries),
            components: signed(more.components),
            is_orientable: before.is_orientable() && more.is_orientable(),
        })
    }

    /// A whole piece goes; as a mesh of its own it is what is missing then.
    fn drop_piece(&mut self, before: &Census, a: u32) -> Outcome {
        let pieces = components(&self.mesh);
        let gone = a as usize % pieces.count();
        let part = self.mesh.extract(|f| pieces.of(f) == gone).unwrap().mesh;
        let rest = self.mesh.extract(|f| pieces.of(f) != gone).unwrap().mesh;
        let (less, left) = (Census::of(&part), Census::of(&rest));
        assert_eq!((less.components, less.euler + left.euler), (1, before.euler));
        self.mesh.remove_faces(|f| pieces.of(f) == gone);
        Outcome::Done(Promise {
            euler: -less.euler,
            boundaries: -signed(less.boundaries),
            components: -1,
            is_orientable: left.is_orientable(),
        })
    }

    /// Some faces are turned around, or all are put right.
    fn turn(&mut self, a: u32, b: u32) {
        if a.is_multiple_of(2) {
            propagate_orientation(&mut self.mesh);
            return;
        }
        let chosen: Vec<FaceId> = self.mesh.faces().filter(|f| (b >> (f.index() % 31)) & 1 == 0).collect();
        chosen.into_iter().for_each(|f| reverse_face(&mut self.mesh, f));
    }
}
