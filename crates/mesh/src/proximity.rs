//! How near surfaces are: a tree of boxes over the faces, the nearest place to a point, the closest pair of places of two
//! surfaces.
//!
//! Sources: Ericson, Real-Time Collision Detection (2005), §6 (bounding volume hierarchies), §5.1.9–10 (closest points of
//! segments and triangles). The tree is a flat array, split at the middle of the longer side of the centres, so that the same
//! surface gives the same tree everywhere. A search goes to the nearer box first and leaves out what cannot be nearer.

use glam::DVec3;

use crate::place::nearest_weights;
use crate::{FaceId, HalfedgeId, Mesh, Place, VertexId};

/// The pair of places nearest to each other around two given ones of the same surface, for a bridge from a surface to itself.
///
/// Around either place all that hangs together within `reach` of it in space is looked at. Where these two patches would
/// touch, both are made smaller, to a thirty-second at most, so that the pair is never one of neighbours. `None` if a place is not on
/// the mesh, `reach` is not positive, or the places are neighbours themselves.
#[must_use]
pub fn refine_pair(
    mesh: &Mesh,
    positions: &[DVec3],
    [one, other]: [Place; 2],
    reach: f64,
) -> Option<ClosestPair> {
    let centres = [one.position(mesh, positions)?, other.position(mesh, positions)?];
    let mut reach = if reach > 0.0 { reach } else { return None };
    for _ in 0..6 {
        let patches = [
            patch(mesh, positions, one, centres[0], reach),
            patch(mesh, positions, other, centres[1], reach),
        ];
        let mut is_in_one = vec![false; mesh.vertex_slots()];
        let vertices = |f: &FaceId| mesh.face_vertices(*f);
        patches[0].iter().flat_map(vertices).for_each(|v| is_in_one[v.index()] = true);
        if !patches[1].iter().flat_map(vertices).any(|v| is_in_one[v.index()]) {
            let [a, b] = patches
                .map(|patch| SurfaceTree::of_faces(mesh, positions, |f| patch.binary_search(&f).is_ok()));
            return a.closest(&b);
        }
        reach *= 0.5;
    }
    None
}

/// The faces that hang together with a place within `reach` of it, in index order.
fn patch(mesh: &Mesh, positions: &[DVec3], place: Place, centre: DVec3, reach: f64) -> Vec<FaceId> {
    let is_near = |f: FaceId| {
        let [Some(&a), Some(&b), Some(&c)] = mesh.face_vertices(f).map(|v| positions.get(v.index())) else {
            return false;
        };
        mix([a, b, c], nearest_weights(centre, [a, b, c])).distance(centre) <= reach
    };
    let mut is_seen = vec![false; mesh.face_slots()];
    let mut patch = vec![place.face(mesh)];
    is_seen[patch[0].index()] = true;
    let mut next = 0;
    while next < patch.len() {
        let around = patch[next].halfedges().into_iter().filter_map(|h| mesh.twin(h)).map(HalfedgeId::face);
        for f in around.filter(|&f| is_near(f)).collect::<Vec<_>>() {
            if !core::mem::replace(&mut is_seen[f.index()], true) {
                patch.push(f);
            }
        }
        next += 1;
    }
    patch.sort_unstable();
    patch
}

/// So many faces are looked at one by one.
const LEAF: usize = 4;

/// A box that holds faces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) low: DVec3,
    pub(crate) high: DVec3,
    /// A leaf's faces are `order[from..to]`.
    pub(crate) from: usize,
    pub(crate) to: usize,
    /// The second child, the first being the next node; 0 for a leaf.
    pub(crate) second: usize,
}

/// The faces of a surface in a tree of boxes, with the positions that they had.
///
/// ```
/// use ductile_mesh::{SurfaceTree, primitive};
/// use glam::DVec3;
/// let (ball, positions) = primitive::icosphere(3);
/// let there: Vec<_> = positions.iter().map(|p| *p + DVec3::new(3.0, 0.0, 0.0)).collect();
/// let (one, other) = (SurfaceTree::new(&ball, &positions), SurfaceTree::new(&ball, &there));
/// let pair = one.closest(&other).expect("both have faces");
/// assert!((pair.distance - 1.0).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, Default)]
pub struct SurfaceTree {
    pub(crate) nodes: Vec<Node>,
    pub(crate) order: Vec<FaceId>,
    /// The corners of the faces in that order.
    pub(crate) corners: Vec<[DVec3; 3]>,
    /// The vertices at those corners.
    vertices: Vec<[VertexId; 3]>,
}

/// The closest two places of two surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPair {
    /// The place on the one.
    pub one: Place,
    /// The place on the other.
    pub other: Place,
    /// Where they lie in space.
    pub positions: [DVec3; 2],
    /// How far they are apart; 0 where the surfaces meet.
    pub distance: f64,
}

impl SurfaceTree {
    /// The tree of all faces whose corners have finite positions, and a finite sum of them.
    #[must_use]
    pub fn new(mesh: &Mesh, positions: &[DVec3]) -> Self {
        Self::of_faces(mesh, positions, |_| true)
    }

    /// The tree of some faces: a region, or one piece.
    #[must_use]
    pub fn of_faces(mesh: &Mesh, positions: &[DVec3], is_wanted: impl Fn(FaceId) -> bool) -> Self {
        let mut order = Vec::new();
        let mut corners = Vec::new();
        for f in mesh.faces().filter(|&f| is_wanted(f)) {
            let at = mesh.face_vertices(f).map(|v| positions.get(v.index()).copied());
            if let [Some(a), Some(b), Some(c)] = at
                && (a + b + c).is_finite()
            {
                order.push(f);
                corners.push([a, b, c]);
            }
        }
        let mut index: Vec<usize> = (0..order.len()).collect();
        let mut nodes = Vec::with_capacity(order.len());
        if !index.is_empty() {
            build(&corners, &mut index, 0, &mut nodes);
        }
        let order: Vec<FaceId> = index.iter().map(|&k| order[k]).collect();
        let vertices = order.iter().map(|&f| mesh.face_vertices(f)).collect();
        Self { nodes, corners: index.iter().map(|&k| corners[k]).collect(), order, vertices }
    }

    /// Whether there is no face in it.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.order.is_empty()
    }

    /// The nearest place to a point, and where that lies. `None` for an empty tree, a point that is not finite, or one so far
    /// away that the square of the distance is no number.
    ///
    /// The mesh must be the one that the tree was made for.
    #[must_use]
    pub fn nearest(&self, mesh: &Mesh, at: DVec3) -> Option<(Place, DVec3)> {
        if self.is_empty() || !at.is_finite() {
            return None;
        }
        let mut best = (f64::INFINITY, usize::MAX, [0.0; 3]);
        let mut ahead = vec![(0, self.distance_to_box(0, at))];
        while let Some((node, distance)) = ahead.pop() {
            if distance > best.0 {
                continue;
            }
            let Node { from, to, second, .. } = self.nodes[node];
            if second == 0 {
                for k in from..to {
                    let weights = nearest_weights(at, self.corners[k]);
                    let distance = mix(self.corners[k], weights).distance_squared(at);
                    // Among equals the lowest face, whatever the tree looks like.
                    let is_lower = || distance == best.0 && self.order[k] < self.order[best.1];
                    // A square that overflows is no distance: the first best is none either, and has no face.
                    if distance < best.0 || distance.is_finite() && is_lower() {
                        best = (distance, k, weights);
                    }
                }
                continue;
            }
            let mut children = [node + 1, second].map(|child| (child, self.distance_to_box(child, at)));
            if children[0].1 < children[1].1 {
                children.swap(0, 1);
            }
            ahead.extend(children);
        }
        let (_, k, weights) = best;
        let face = *self.order.get(k)?;
        Some((Place::inside(mesh, face, weights), mix(self.corners[k], weights)))
    }

    /// The closest two places of two surfaces, also of two regions of one. Faces of theirs that have a vertex in common count,
    /// so that regions that touch are nowhere apart. `None` if one of them is empty.
    ///
    /// Where the surfaces meet in many places, one of them is told.
    #[must_use]
    pub fn closest(&self, other: &Self) -> Option<ClosestPair> {
        if self.is_empty() || other.is_empty() {
            return None;
        }
        let mut best: Option<Touch> = None;
        let mut ahead = vec![(0, 0, self.distance_of_boxes(0, other, 0))];
        while let Some((a, b, distance)) = ahead.pop() {
            if distance > best.as_ref().map_or(f64::INFINITY, |best| best.squared) {
                continue;
            }
            let (one, two) = (self.nodes[a], other.nodes[b]);
            if one.second == 0 && two.second == 0 {
                for (k, l) in (one.from..one.to).flat_map(|k| (two.from..two.to).map(move |l| (k, l))) {
                    let touch = Touch::of(self.corners[k], other.corners[l], (k, l));
                    if best.as_ref().is_none_or(|best| touch.squared < best.squared) {
                        best = Some(touch);
                    }
                }
                continue;
            }
            // The larger box is opened.
            let opens_first = two.second == 0 || (one.second != 0 && size(&one) >= size(&two));
            let pairs =
                if opens_first { [(a + 1, b), (one.second, b)] } else { [(a, b + 1), (a, two.second)] };
            let mut pairs = pairs.map(|(a, b)| (a, b, self.distance_of_boxes(a, other, b)));
            if pairs[0].2 < pairs[1].2 {
                pairs.swap(0, 1);
            }
            ahead.extend(pairs);
        }
        best.map(|touch| self.told(other, &touch))
    }

    fn told(&self, other: &Self, touch: &Touch) -> ClosestPair {
        let (k, l) = touch.pair;
        let place = |tree: &Self, k: usize, weights: [f64; 3]| tree.place(k, weights);
        ClosestPair {
            one: place(self, k, touch.weights[0]),
            other: place(other, l, touch.weights[1]),
            positions: [mix(self.corners[k], touch.weights[0]), mix(other.corners[l], touch.weights[1])],
            distance: touch.squared.sqrt(),
        }
    }

    /// A place in the `k`-th face of the tree: at its corner, or in it.
    fn place(&self, k: usize, weights: [f64; 3]) -> Place {
        match weights.iter().position(|&w| w == 1.0) {
            Some(corner) => Place::Vertex(self.vertices[k][corner]),
            None => Place::Face { face: self.order[k], weights },
        }
    }

    fn distance_to_box(&self, node: usize, at: DVec3) -> f64 {
        let Node { low, high, .. } = self.nodes[node];
        at.clamp(low, high).distance_squared(at)
    }

    fn distance_of_boxes(&self, node: usize, other: &Self, theirs: usize) -> f64 {
        let (a, b) = (&self.nodes[node], &other.nodes[theirs]);
        (a.low - b.high).max(b.low - a.high).max(DVec3::ZERO).length_squared()
    }
}

fn size(node: &Node) -> f64 {
    (node.high - node.low).length_squared()
}

fn mix([a, b, c]: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    a * weights[0] + b * weights[1] + c * weights[2]
}

/// Puts the nodes over `index`, whose first face is number `from`, at the end of the list, and their faces in order.
fn build(corners: &[[DVec3; 3]], index: &mut [usize], from: usize, nodes: &mut Vec<Node>) {
    let points = || index.iter().flat_map(|&k| corners[k]);
    let low = points().fold(DVec3::INFINITY, DVec3::min);
    let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
    let here = nodes.len();
    nodes.push(Node { low, high, from, to: from + index.len(), second: 0 });
    if index.len() <= LEAF {
        return;
    }
    let centre = |k: usize| corners[k][0] + corners[k][1] + corners[k][2];
    let (least, most) = index.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(least, most), &k| {
        (least.min(centre(k)), most.max(centre(k)))
    });
    let axis = (most - least).max_position();
    // Halves of equal count, so that the depth is that of a balanced tree even where faces lie on one another.
    let middle = index.len() / 2;
    index
        .select_nth_unstable_by(middle, |&k, &l| centre(k)[axis].total_cmp(&centre(l)[axis]).then(k.cmp(&l)));
    let (first, second) = index.split_at_mut(middle);
    build(corners, first, from, nodes);
    nodes[here].second = nodes.len();
    build(corners, second, from + middle, nodes);
}

/// The closest points of two triangles.
struct Touch {
    squared: f64,
    weights: [[f64; 3]; 2],
    pair: (usize, usize),
}

impl Touch {
    fn of(one: [DVec3; 3], two: [DVec3; 3], pair: (usize, usize)) -> Self {
        let mut best = Self { squared: f64::INFINITY, weights: [[1.0, 0.0, 0.0]; 2], pair };
        let mut offer = |weights: [[f64; 3]; 2]| {
            let squared = mix(one, weights[0]).distance_squared(mix(two, weights[1]));
            if squared < best.squared {
                best.squared = squared;
                best.weights = weights;
            }
        };
        for k in 0..3 {
            offer([corner(k), nearest_weights(one[k], two)]);
            offer([nearest_weights(two[k], one), corner(k)]);
            for l in 0..3 {
                let (s, t) = closest_on_segments([one[k], one[(k + 1) % 3]], [two[l], two[(l + 1) % 3]]);
                offer([on_side(k, s), on_side(l, t)]);
            }
            // A side that runs through the other triangle: nothing above finds that they meet.
            if let Some((s, weights)) = pierced([one[k], one[(k + 1) % 3]], two) {
                offer([on_side(k, s), weights]);
            }
            if let Some((t, weights)) = pierced([two[k], two[(k + 1) % 3]], one) {
                offer([weights, on_side(k, t)]);
            }
        }
        best
    }
}

fn corner(k: usize) -> [f64; 3] {
    let mut weights = [0.0; 3];
    weights[k] = 1.0;
    weights
}

fn on_side(k: usize, share: f64) -> [f64; 3] {
    let mut weights = [0.0; 3];
    weights[k] = 1.0 - share;
    weights[(k + 1) % 3] = share;
    weights
}

/// Where a segment runs through a triangle: the share of its length, and the weights there.
fn pierced([p, q]: [DVec3; 2], [a, b, c]: [DVec3; 3]) -> Option<(f64, [f64; 3])> {
    let normal = (b - a).cross(c - a);
    let (above, below) = (normal.dot(p - a), normal.dot(q - a));
    if (above > 0.0) == (below > 0.0) {
        return None;
    }
    let share = above / (above - below);
    if !(0.0..=1.0).contains(&share) {
        return None;
    }
    let there = p.lerp(q, share);
    let area = normal.length_squared();
    let u = normal.dot((b - there).cross(c - there)) / area;
    let v = normal.dot((c - there).cross(a - there)) / area;
    let weights = [u, v, 1.0 - u - v];
    weights.iter().all(|w| (0.0..=1.0).contains(w)).then_some((share, weights))
}

/// The shares at which two segments come closest.
fn closest_on_segments([p, q]: [DVec3; 2], [a, b]: [DVec3; 2]) -> (f64, f64) {
    let (d, e, r) = (q - p, b - a, p - a);
    let (dd, ee, de, dr, er) = (d.dot(d), e.dot(e), d.dot(e), d.dot(r), e.dot(r));
    let share = |x: f64| if x.is_finite() { x.clamp(0.0, 1.0) } else { 0.0 };
    let s = share((de * er - dr * ee) / (dd * ee - de * de));
    let t = (de * s + er) / ee;
    if t < 0.0 {
        (share(-dr / dd), 0.0)
    } else if t > 1.0 {
        (share((de - dr) / dd), 1.0)
    } else {
        (s, share(t))
    }
}

#[cfg(test)]
mod tests;
