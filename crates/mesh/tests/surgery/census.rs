//! What kind of surface a list of triangles is, found by other means than the library's: sets of edges and union-find over
//! vertices and over both sides of faces.

use std::collections::BTreeMap;

use ductile_mesh::{EdgeId, FaceId, Labels, Mesh, VertexId, components, regions};

/// The kind of a surface.
#[derive(Debug)]
pub(crate) struct Census {
    pub(crate) euler: i64,
    pub(crate) boundaries: usize,
    pub(crate) components: usize,
    /// For every face in index order, whether its piece has one side only.
    pub(crate) is_one_sided: Vec<bool>,
}

struct Forest(Vec<usize>);

impl Forest {
    fn root(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    fn join(&mut self, i: usize, j: usize) {
        let (i, j) = (self.root(i), self.root(j));
        self.0[i] = j;
    }

    /// How many sets those named form.
    fn sets(&mut self, named: impl Iterator<Item = usize>) -> usize {
        let mut roots: Vec<_> = named.map(|i| self.root(i)).collect();
        roots.sort_unstable();
        roots.dedup();
        roots.len()
    }
}

/// Every edge with the faces at it, by place in the list, and whether they run along it upwards.
fn sides(triangles: &[[u32; 3]]) -> BTreeMap<(u32, u32), Vec<(usize, bool)>> {
    let mut sides: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for (f, t) in triangles.iter().enumerate() {
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            sides.entry((a.min(b), a.max(b))).or_default().push((f, a < b));
        }
    }
    sides
}

impl Census {
    pub(crate) fn of(mesh: &Mesh) -> Self {
        let triangles = mesh.to_triangles();
        let sides = sides(&triangles);
        let slots = mesh.vertex_slots();
        let (mut pieces, mut rims) = (Forest((0..slots).collect()), Forest((0..slots).collect()));
        let mut cover = Forest((0..2 * triangles.len()).collect());
        let mut on_rim = Vec::new();
        for (&(a, b), faces) in &sides {
            pieces.join(a as usize, b as usize);
            match faces[..] {
                [_] => {
                    rims.join(a as usize, b as usize);
                    on_rim.push(a as usize);
                }
                [(f, up), (g, also_up)] => {
                    // Faces that run along the edge the same way see each other's backs.
                    let turned = usize::from(up == also_up);
                    cover.join(2 * f, 2 * g + turned);
                    cover.join(2 * f + 1, 2 * g + 1 - turned);
                }
                _ => panic!("three faces at an edge"),
            }
        }
        let mut used: Vec<usize> = triangles.iter().flatten().map(|&v| v as usize).collect();
        used.sort_unstable();
        used.dedup();
        let count = |n: usize| i64::try_from(n).unwrap();
        Self {
            euler: count(used.len()) - count(sides.len()) + count(triangles.len()),
            boundaries: rims.sets(on_rim.into_iter()),
            components: pieces.sets(used.into_iter()),
            is_one_sided: (0..triangles.len()).map(|f| cover.root(2 * f) == cover.root(2 * f + 1)).collect(),
        }
    }

    /// What a mesh is once some of its edges are cut and only some of its faces stay, reckoned without doing it: from corners of
    /// triangles that hang together, so that a vertex counts once for each fan that is left of it.
    pub(crate) fn apart(
        mesh: &Mesh,
        is_cut: impl Fn(EdgeId) -> bool,
        stays: impl Fn(FaceId) -> bool,
    ) -> Self {
        let forest = |count: usize| Forest((0..count).collect());
        let slots = mesh.face_slots();
        let (mut corners, mut pieces, mut cover) = (forest(3 * slots), forest(slots), forest(2 * slots));
        let corner = |f: FaceId, v: VertexId| {
            3 * f.index() + mesh.face_vertices(f).iter().position(|w| *w == v).unwrap()
        };
        let (mut edges, mut sides) = (0, Vec::new());
        for e in mesh.edges() {
            let [a, b] = mesh.edge_vertices(e);
            let (f, g) = mesh.edge_faces(e);
            let there: Vec<FaceId> = [Some(f), g].into_iter().flatten().filter(|f| stays(*f)).collect();
            if let ([f, g], false) = (&there[..], is_cut(e)) {
                edges += 1;
                corners.join(corner(*f, a), corner(*g, a));
                corners.join(corner(*f, b), corner(*g, b));
                pieces.join(f.index(), g.index());
                let up = |f: FaceId| (corner(f, b) + 3 - corner(f, a)) % 3 == 1;
                let turned = usize::from(up(*f) == up(*g));
                cover.join(2 * f.index(), 2 * g.index() + turned);
                cover.join(2 * f.index() + 1, 2 * g.index() + 1 - turned);
            } else {
                edges += there.len();
                sides.extend(there.into_iter().map(|f| (corner(f, a), corner(f, b))));
            }
        }
        let sides: Vec<_> = sides.into_iter().map(|(a, b)| (corners.root(a), corners.root(b))).collect();
        let mut rims = forest(3 * slots);
        sides.iter().for_each(|&(a, b)| rims.join(a, b));
        let own: Vec<usize> = mesh.faces().filter(|f| stays(*f)).map(|f| f.index()).collect();
        let count = |n: usize| i64::try_from(n).unwrap();
        let vertices = corners.sets(own.iter().flat_map(|f| [3 * f, 3 * f + 1, 3 * f + 2]));
        Self {
            euler: count(vertices) - count(edges) + count(own.len()),
            boundaries: rims.sets(sides.iter().map(|side| side.0)),
            components: pieces.sets(own.iter().copied()),
            is_one_sided: own.iter().map(|f| cover.root(2 * f) == cover.root(2 * f + 1)).collect(),
        }
    }

    pub(crate) fn is_orientable(&self) -> bool {
        !self.is_one_sided.contains(&true)
    }

    pub(crate) fn kind(&self) -> (i64, usize, usize, bool) {
        (self.euler, self.boundaries, self.components, self.is_orientable())
    }
}

/// Labels of pieces and regions must be those that a flood finds, numbered by their lowest faces.
pub(crate) fn check_labels(mesh: &Mesh) {
    let faces: Vec<FaceId> = mesh.faces().collect();
    let sides = sides(&mesh.to_triangles());
    let is_tagged = |f: usize, ends: (u32, u32)| {
        mesh.face_edges(faces[f]).into_iter().any(|e| {
            let [a, b] = mesh.edge_vertices(e).map(|v| u32::try_from(v.index()).unwrap());
            (a.min(b), a.max(b)) == ends && mesh.is_source_edge(e)
        })
    };
    let mut open = vec![Vec::new(); faces.len()];
    let mut joined = vec![Vec::new(); faces.len()];
    for (ends, at) in &sides {
        if let [(f, _), (g, _)] = at[..] {
            let is_curve = is_tagged(f, *ends);
            for (f, g) in [(f, g), (g, f)] {
                joined[f].push(g);
                if !is_curve {
                    open[f].push(g);
                }
            }
        }
    }
    let check = |labels: &Labels, beside: &[Vec<usize>]| {
        let mut label = vec![usize::MAX; faces.len()];
        let mut count = 0;
        for seed in 0..faces.len() {
            if label[seed] != usize::MAX {
                continue;
            }
            let mut ahead = vec![seed];
            label[seed] = count;
            while let Some(f) = ahead.pop() {
                for &g in &beside[f] {
                    if label[g] == usize::MAX {
                        label[g] = count;
                        ahead.push(g);
                    }
                }
            }
            count += 1;
        }
        assert_eq!(labels.count(), count);
        assert!(faces.iter().zip(&label).all(|(&f, &label)| labels.of(f) == label));
    };
    check(&components(mesh), &joined);
    check(&regions(mesh), &open);
}
