//! Shapes at rest, and how far one is from another.

use crate::Bench;
use ductile_spec::{Document, Request, to_text};
use glam::DVec3;

/// A surface at rest.
#[derive(Clone, Debug)]
pub struct Solved {
    /// Where its nodes are.
    pub positions: Vec<DVec3>,
    /// Its unit normals there.
    pub normals: Vec<DVec3>,
    /// Its triangles, over the nodes.
    pub triangles: Vec<[usize; 3]>,
    /// The curves that it follows, in the order of its embeddings.
    pub lines: Vec<Line>,
    /// The nodes that control points hold apart from curves.
    pub pins: Vec<usize>,
    /// Its energy.
    pub energy: f64,
}

/// A curve in a surface at rest.
#[derive(Clone, Debug)]
pub struct Line {
    /// Its samples.
    pub nodes: Vec<DVec3>,
    /// The nodes of the surface there.
    pub vertices: Vec<usize>,
    /// Whether the last sample joins the first.
    pub closed: bool,
    /// The samples on its control points.
    pub controls: Vec<usize>,
}

/// Opens a document at a density and brings it to rest.
///
/// # Panics
/// When it is refused or does not come to rest.
#[must_use]
pub fn opened(document: &Document, spacing: f64) -> Bench {
    let mut document = document.clone();
    document.spacing = Some(spacing);
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    bench.rest(600);
    bench
}

/// The same, and the shape.
///
/// # Panics
/// When it does not come to rest.
#[must_use]
pub fn solve(document: &Document, spacing: f64) -> Solved {
    solved(&mut opened(document, spacing))
}

/// The first surface of a bench, at rest.
///
/// # Panics
/// When there is none or it does not come to rest.
pub fn solved(bench: &mut Bench) -> Solved {
    let energy = bench.rest(600);
    let model = bench.modeler.model();
    let (id, shape) = model.surfaces.first_key_value().expect("the document has a surface");
    let mut index = vec![usize::MAX; shape.mesh.vertex_slots()];
    let mut positions = Vec::new();
    for v in shape.mesh.vertices() {
        index[v.index()] = positions.len();
        positions.push(shape.positions[v.index()]);
    }
    let triangles =
        shape.mesh.faces().map(|f| shape.mesh.face_vertices(f).map(|v| index[v.index()])).collect();
    let normals = bench.modeler.relaxer().surface(*id, shape).map(|bound| bound.normals().to_vec());
    let lines = shape.embeddings.iter().map(|embedded| {
        let curve = &model.curves[&embedded.curve];
        let vertices = embedded.vertices.iter().map(|v| index[v.index()]).collect();
        let controls = curve.controls.iter().map(|(sample, _)| *sample as usize).collect();
        Line { nodes: curve.nodes.clone(), vertices, closed: curve.closed, controls }
    });
    Solved {
        positions,
        normals: normals.expect("a surface at rest has a solver"),
        triangles,
        lines: lines.collect(),
        pins: shape.pins.iter().map(|pin| index[pin.vertex.index()]).collect(),
        energy,
    }
}

/// The point of a triangle nearest to `p`: its projection if it falls inside, else the nearest of the edges'.
fn nearest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let normal = (b - a).cross(c - a);
    let is_inside =
        [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| (to - from).cross(p - from).dot(normal) >= 0.0);
    if is_inside {
        return p - normal * ((p - a).dot(normal) / normal.length_squared());
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let along = ((p - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
        from.lerp(to, along)
    };
    [on_edge(a, b), on_edge(b, c), on_edge(c, a)]
        .into_iter()
        .min_by(|one, other| one.distance_squared(p).total_cmp(&other.distance_squared(p)))
        .unwrap_or(p)
}

/// Largest and root-mean-square distance of a shape's vertices from another surface.
#[must_use]
pub fn deviation(shape: &Solved, from: &Solved) -> (f64, f64) {
    let corners: Vec<[DVec3; 3]> =
        from.triangles.iter().map(|triangle| triangle.map(|node| from.positions[node])).collect();
    let distances = shape.positions.iter().map(|&p| {
        let near = corners.iter().filter(|corners| corners[0].distance_squared(p) < 0.16);
        near.map(|&corners| nearest_on_triangle(p, corners).distance(p)).fold(f64::INFINITY, f64::min)
    });
    let (worst, sum) = distances.fold((0.0_f64, 0.0), |(worst, sum), d| (worst.max(d), sum + d * d));
    (worst, (sum / shape.positions.len() as f64).sqrt())
}
