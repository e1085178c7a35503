//! Kinds of surfaces, and what becomes of them when a surface is cut apart or faces are taken out of it: reckoned from the
//! triangles alone, by corners that hang together, so that the modeler can be held to it. (Euler characteristic, boundaries
//! and sides determine a connected surface; thesis section 4.1.)

use ductile_mesh::{EdgeId, FaceId, Mesh, VertexId, summary};
use ductile_modeler::Model;
use ductile_spec::SurfaceId;

/// Euler characteristic, number of boundaries, whether it has two sides.
pub type Kind = (i64, usize, bool);

/// The kinds of all surfaces of a model.
///
/// # Panics
/// When a surface does not hang together.
#[must_use]
pub fn kinds(model: &Model) -> Vec<(SurfaceId, Kind)> {
    let kind = |(id, shape): (&SurfaceId, &std::sync::Arc<ductile_modeler::SurfaceShape>)| {
        let summary = summary(&shape.mesh);
        assert_eq!(summary.components, 1, "{id} hangs together");
        (*id, (summary.euler, summary.boundaries, summary.is_orientable))
    };
    model.surfaces.iter().map(kind).collect()
}

/// The kinds of the pieces, sorted, into which a mesh falls when some of its edges are cut, and only some of its faces stay
/// (by face slot).
#[must_use]
pub fn pieces(mesh: &Mesh, is_cut: impl Fn(EdgeId) -> bool, stays: impl Fn(usize) -> bool) -> Vec<Kind> {
    changed(mesh, is_cut, stays, &[])
}

/// An edge by its ends, in an order.
pub type Ends = [VertexId; 2];

/// The kinds of the pieces that there are when boundary edges of a mesh are laid on others, end on end.
///
/// # Panics
/// When one of them is no boundary edge.
#[must_use]
pub fn sewn(mesh: &Mesh, seam: &[[Ends; 2]]) -> Vec<Kind> {
    changed(mesh, |_| false, |_| true, seam)
}

fn changed(
    mesh: &Mesh,
    is_cut: impl Fn(EdgeId) -> bool,
    stays: impl Fn(usize) -> bool,
    seam: &[[Ends; 2]],
) -> Vec<Kind> {
    let slots = mesh.face_slots();
    let (mut corners, mut faces, mut senses) =
        (Classes::new(3 * slots), Classes::new(slots), Classes::new(2 * slots));
    let corner = |f: FaceId, v| {
        let place =
            mesh.face_vertices(f).iter().position(|w| *w == v).expect("an edge's ends are its face's");
        3 * f.index() + place
    };
    let mut meet = |[(f, [a, b]), (g, [c, d])]: [(FaceId, Ends); 2]| {
        corners.join(corner(f, a), corner(g, c));
        corners.join(corner(f, b), corner(g, d));
        faces.join(f.index(), g.index());
        // Neighbours agree when they run along their edge in opposite senses.
        let forward = |face, [a, b]: Ends| (corner(face, b) + 3 - corner(face, a)) % 3 == 1;
        let other = usize::from(forward(f, [a, b]) == forward(g, [c, d]));
        senses.join(2 * f.index(), 2 * g.index() + other);
        senses.join(2 * f.index() + 1, 2 * g.index() + 1 - other);
    };
    let (is_sewn, pairs) = laid(mesh, seam);
    pairs.into_iter().for_each(&mut meet);
    // Sides of boundary edges, each by the corners at its ends.
    let mut sides = Vec::new();
    for e in mesh.edges().filter(|e| !is_sewn[e.index()]) {
        let [a, b] = mesh.edge_vertices(e);
        let (f, g) = mesh.edge_faces(e);
        let there = [Some(f), g].map(|face| face.filter(|f| stays(f.index())));
        if let ([Some(f), Some(g)], false) = (there, is_cut(e)) {
            meet([(f, [a, b]), (g, [a, b])]);
        } else {
            sides.extend(there.into_iter().flatten().map(|f| (f.index(), corner(f, a), corner(f, b))));
        }
    }
    let mut rims = Classes::new(3 * slots);
    for (_, a, b) in &sides {
        rims.join(corners.of(*a), corners.of(*b));
    }
    let own: Vec<usize> = mesh.faces().map(|f| f.index()).filter(|f| stays(*f)).collect();
    let mut found = Vec::new();
    for piece in own.iter().copied().filter(|f| faces.of(*f) == *f) {
        let inside: Vec<usize> = own.iter().copied().filter(|f| faces.of(*f) == piece).collect();
        let mut places: Vec<usize> =
            inside.iter().flat_map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).map(|c| corners.of(c)).collect();
        let mut loops: Vec<usize> = sides
            .iter()
            .filter(|(f, ..)| faces.of(*f) == piece)
            .map(|(_, a, _)| rims.of(corners.of(*a)))
            .collect();
        let edges = (3 * inside.len() + loops.len()) / 2;
        for list in [&mut places, &mut loops] {
            list.sort_unstable();
            list.dedup();
        }
        let count = |n: usize| i64::try_from(n).expect("meshes are small");
        let is_orientable = senses.of(2 * piece) != senses.of(2 * piece + 1);
        found.push((count(places.len()) - count(edges) + count(inside.len()), loops.len(), is_orientable));
    }
    found.sort_unstable();
    found
}

/// By edge slot, whether an edge is of a seam; and the pairs of the seam with the faces at them.
fn laid(mesh: &Mesh, seam: &[[Ends; 2]]) -> (Vec<bool>, Vec<[(FaceId, Ends); 2]>) {
    let mut is_sewn = vec![false; mesh.edge_slots()];
    let mut side = |[a, b]: Ends| {
        let edge = mesh.edge_between(a, b).filter(|e| mesh.is_boundary_edge(*e)).expect("a rim");
        is_sewn[edge.index()] = true;
        (mesh.edge_faces(edge).0, [a, b])
    };
    let pairs = seam.iter().map(|pair| pair.map(&mut side)).collect();
    (is_sewn, pairs)
}

/// Disjoint classes of numbers; the least of each is its name.
struct Classes(Vec<usize>);

impl Classes {
    fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    fn of(&self, mut k: usize) -> usize {
        while self.0[k] != k {
            k = self.0[k];
        }
        k
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.of(a), self.of(b));
        let (low, high) = (a.min(b), a.max(b));
        self.0[high] = low;
    }
}
