//! A fine solution as the smooth surface that it samples, so that others can be held against it.
//!
//! A facet with edges of length `h` lies up to `k h²/8` beside a surface of curvature `k`: at 10,000 nodes that is as much as the
//! error that is looked for. So a place `q` of a facet stands for the mean of itself and of its feet on the tangent planes at the
//! three corners, weighted as `q` is. This is exact for a quadratic: with `d_i = q - p_i`, `Σ b_i d_i = 0`, the facet lies
//! `½ Σ b_i d_i·H d_i` on the one side of it and the blended planes as much on the other. What is left is of third order. Curves
//! alike, with their tangents for the planes.

use crate::solved::{Line, Solved};
use ductile_mesh::{Mesh, Place, SurfaceTree, VertexId};
use glam::DVec3;

/// A fine solution, ready to be measured against.
#[derive(Debug)]
pub struct Reference<'a> {
    shape: &'a Solved,
    mesh: Mesh,
    tree: SurfaceTree,
    lines: Vec<Arcs>,
    /// Width of the shape: twice the largest distance of a vertex from the middle of the box around it.
    pub size: f64,
}

/// How far vertices are from a reference, as parts of its size.
#[derive(Clone, Copy, Debug)]
pub struct Deviation {
    /// The largest distance.
    pub worst: f64,
    /// The root of the mean square.
    pub rms: f64,
    /// The largest distance of a sample of a curve from the same curve.
    pub on_curves: f64,
}

impl<'a> Reference<'a> {
    /// # Panics
    /// When the triangles are not a surface.
    #[must_use]
    pub fn new(shape: &'a Solved) -> Self {
        let triangles: Vec<[u32; 3]> =
            shape.triangles.iter().map(|t| t.map(|node| u32::try_from(node).expect("a node"))).collect();
        let mesh = Mesh::from_triangles(shape.positions.len(), &triangles).expect("the triangles of a mesh");
        let tree = SurfaceTree::new(&mesh, &shape.positions);
        let low = shape.positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
        let high = shape.positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
        let from_middle = |p: &DVec3| p.distance(0.5 * (low + high));
        let radius = shape.positions.iter().map(from_middle).fold(0.0, f64::max);
        let lines = shape.lines.iter().map(Arcs::new).collect();
        Self { shape, mesh, tree, lines, size: 2.0 * radius }
    }

    /// The largest and the mean distance of a shape's vertices: those on curves from the same curve, the others from the surface.
    ///
    /// # Panics
    /// When the shape has other curves.
    #[must_use]
    pub fn deviation(&self, shape: &Solved) -> Deviation {
        assert_eq!(shape.lines.len(), self.lines.len(), "the same document has the same curves");
        let mut is_on_curve = vec![false; shape.positions.len()];
        let mut on_curves = Vec::new();
        for (line, arcs) in shape.lines.iter().zip(&self.lines) {
            line.vertices.iter().for_each(|&v| is_on_curve[v] = true);
            on_curves.extend(line.nodes.iter().map(|&p| arcs.distance(p)));
        }
        let inside = shape.positions.iter().zip(&is_on_curve).filter(|(_, on)| !**on);
        let distances: Vec<f64> = inside.map(|(&p, _)| self.distance(p)).chain(on_curves.clone()).collect();
        let sum: f64 = distances.iter().map(|d| d * d).sum();
        let most = |all: &[f64]| all.iter().copied().fold(0.0, f64::max) / self.size;
        Deviation {
            worst: most(&distances),
            rms: (sum / distances.len() as f64).sqrt() / self.size,
            on_curves: most(&on_curves),
        }
    }

    /// Distance of a point from the smooth surface.
    fn distance(&self, p: DVec3) -> f64 {
        let (place, foot) = self.tree.nearest(&self.mesh, p).expect("a surface has faces");
        let corners: Vec<(VertexId, f64)> = match place {
            Place::Vertex(v) => vec![(v, 1.0)],
            Place::Edge { edge, at } => {
                let [a, b] = self.mesh.edge_vertices(edge);
                vec![(a, 1.0 - at), (b, at)]
            }
            Place::Face { face, weights } => self.mesh.face_vertices(face).into_iter().zip(weights).collect(),
        };
        let on_planes = corners.into_iter().map(|(v, weight)| {
            let (at, normal) = (self.shape.positions[v.index()], self.shape.normals[v.index()]);
            (foot - normal * (foot - at).dot(normal)) * weight
        });
        (0.5 * (foot + on_planes.sum::<DVec3>())).distance(p)
    }
}

/// A sampled curve as the smooth one that it samples.
#[derive(Debug)]
struct Arcs {
    nodes: Vec<DVec3>,
    tangents: Vec<DVec3>,
    edges: usize,
}

impl Arcs {
    fn new(line: &Line) -> Self {
        let count = line.nodes.len();
        let at = |k: usize| line.nodes[k % count];
        // The circle through a sample and its neighbours.
        let through = |a: DVec3, b: DVec3, c: DVec3| {
            let (ab, bc) = (b - a, c - b);
            (ab * bc.length() / ab.length() + bc * ab.length() / bc.length()).normalize_or_zero()
        };
        let mut tangents: Vec<DVec3> =
            (0..count).map(|k| through(at(k + count - 1), at(k), at(k + 1))).collect();
        if !line.closed {
            // An arc leaves its chord by the angle at which it arrives.
            let mirrored = |tangent: DVec3, chord: DVec3| {
                let chord = chord.normalize_or_zero();
                2.0 * tangent.dot(chord) * chord - tangent
            };
            tangents[0] = mirrored(tangents[1], at(1) - at(0));
            tangents[count - 1] = mirrored(tangents[count - 2], at(count - 1) - at(count - 2));
        }
        Self { nodes: line.nodes.clone(), tangents, edges: if line.closed { count } else { count - 1 } }
    }

    fn distance(&self, p: DVec3) -> f64 {
        let near = |edge: usize| {
            let (a, b) = (edge, (edge + 1) % self.nodes.len());
            let (from, way) = (self.nodes[a], self.nodes[b] - self.nodes[a]);
            let t = ((p - from).dot(way) / way.length_squared()).clamp(0.0, 1.0);
            let foot = from + t * way;
            let on_line =
                |k: usize| self.nodes[k] + self.tangents[k] * (foot - self.nodes[k]).dot(self.tangents[k]);
            (0.5 * (foot + on_line(a) * (1.0 - t) + on_line(b) * t)).distance(p)
        };
        (0..self.edges).map(near).fold(f64::INFINITY, f64::min)
    }
}
