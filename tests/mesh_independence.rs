//! The first promise: the mesh is an approximation, and the shape does not depend on it.
//!
//! One document is solved at several densities. What the coarser meshes say is held against a fine one: every vertex
//! by its distance to the fine surface. The distance must fall with the spacing, and be small beside the model.

#![allow(clippy::unwrap_used, reason = "a failing test should stop where it fails")]
#![allow(clippy::print_stdout, reason = "the figures are worth seeing with --nocapture")]

use acceptance::Bench;
use ductile_spec::{
    Curve, CurveId, Document, Edit, Embedding, Example, GrabTarget, PointId, Request, Skeleton,
    SkeletonVertex, Surface, SurfaceId, to_text,
};
use glam::{DVec3, dvec3};

/// A shape at rest.
struct Solved {
    positions: Vec<DVec3>,
    triangles: Vec<[usize; 3]>,
    energy: f64,
}

/// Opens a document at a density and brings it to rest.
fn opened(document: &Document, spacing: f64) -> Bench {
    let mut document = document.clone();
    document.spacing = Some(spacing);
    let mut bench = Bench::new();
    bench.accept(Request::OpenText { text: to_text(&document) });
    bench.rest(600);
    bench
}

fn solve(document: &Document, spacing: f64) -> Solved {
    solved(&mut opened(document, spacing))
}

fn solved(bench: &mut Bench) -> Solved {
    let energy = bench.rest(600);
    let shape = bench.modeler.model().surfaces.values().next().expect("the document has a surface");
    let mut index = vec![usize::MAX; shape.mesh.vertex_slots()];
    let mut positions = Vec::new();
    for v in shape.mesh.vertices() {
        index[v.index()] = positions.len();
        positions.push(shape.positions[v.index()]);
    }
    let triangles =
        shape.mesh.faces().map(|f| shape.mesh.face_vertices(f).map(|v| index[v.index()])).collect();
    Solved { positions, triangles, energy }
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
        .unwrap()
}

/// Largest and root-mean-square distance of a shape's vertices from another surface.
fn deviation(shape: &Solved, from: &Solved) -> (f64, f64) {
    let corners: Vec<[DVec3; 3]> =
        from.triangles.iter().map(|triangle| triangle.map(|node| from.positions[node])).collect();
    let distances = shape.positions.iter().map(|&p| {
        let near = corners.iter().filter(|corners| corners[0].distance_squared(p) < 0.16);
        near.map(|&corners| nearest_on_triangle(p, corners).distance(p)).fold(f64::INFINITY, f64::min)
    });
    let (worst, sum) = distances.fold((0.0_f64, 0.0), |(worst, sum), d| (worst.max(d), sum + d * d));
    (worst, (sum / shape.positions.len() as f64).sqrt())
}

/// Solves an example at three densities and two of nearly the same spacing, so that the triangulations differ.
fn is_independent(example: Example) {
    let name = format!("{example:?}");
    let example = &ductile_modeler::example(example);
    let fine = solve(example, 0.05);
    let size = fine.positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let mut errors = Vec::new();
    for (spacing, most) in [(0.2, 0.01), (0.1, 0.004), (0.093, 0.004)] {
        let coarse = solve(example, spacing);
        let (worst, mean) = deviation(&coarse, &fine);
        let energy = (coarse.energy / fine.energy - 1.0).abs();
        println!(
            "{name} at {spacing}: {} nodes, worst {:.4} %, rms {:.4} % of the size, energy off by {:.2} %",
            coarse.positions.len(),
            100.0 * worst / size,
            100.0 * mean / size,
            100.0 * energy
        );
        assert!(worst < most * size, "{name} at {spacing}: {worst}");
        errors.push(mean);
    }
    // Halving the spacing at the least halves the error: first order, and mostly nearer the second.
    assert!(errors[0] > 2.0 * errors[1] && errors[0] > 2.0 * errors[2], "{name}: {errors:?}");
}

#[test]
fn a_raised_disc_is_the_same_on_any_mesh() {
    is_independent(Example::RaisedDisc);
}

#[test]
fn a_cylinder_is_the_same_on_any_mesh() {
    is_independent(Example::Cylinder);
}

#[test]
fn a_closed_surface_on_six_points_is_the_same_on_any_mesh() {
    is_independent(Example::Ball);
}

#[test]
fn a_saddle_is_the_same_on_any_mesh() {
    is_independent(Example::Saddle);
}

/// A torus on three of its meridians, each through four points.
fn torus() -> Document {
    let mut document = Document::default();
    let (mut triangles, mut curves) = (Vec::new(), Vec::new());
    for turn in 0..3_u32 {
        let (sin, cos) = libm::sincos(f64::from(turn) * std::f64::consts::TAU / 3.0);
        let mut through = Vec::new();
        for k in 0..4_u32 {
            let (out, up) = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][k as usize];
            let id = PointId(4 * turn + k + 1);
            let radius = 2.0 + 0.8 * out;
            document.points.insert(id, dvec3(radius * cos, radius * sin, 0.8 * up));
            through.push(id);
            let at = |turn: u32, k: u32| 4 * (turn % 3) + k % 4;
            let (a, b, c, d) = (at(turn, k), at(turn + 1, k), at(turn + 1, k + 1), at(turn, k + 1));
            triangles.extend([[a, b, d], [b, c, d]]);
        }
        document.curves.insert(CurveId(turn + 1), Curve::new(through, true));
        curves.push(Embedding { curve: CurveId(turn + 1), along: (4 * turn..4 * turn + 4).collect() });
    }
    let vertices = (1..=12).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// A saddle in a closed curve, with a control curve inside of it that bends against it.
fn ridged_saddle() -> Document {
    let mut document = Document::default();
    let mut through = Vec::new();
    for k in 0..8_u32 {
        let (sin, cos) = libm::sincos(f64::from(k) * std::f64::consts::TAU / 8.0);
        let id = PointId(k + 1);
        document.points.insert(id, dvec3(cos, sin, 0.35 * (cos * cos - sin * sin)));
        through.push(id);
    }
    let ridge = [dvec3(-0.45, 0.0, 0.1), dvec3(0.0, 0.05, 0.25), dvec3(0.45, 0.0, 0.1)];
    document.points.extend((9..).map(PointId).zip(ridge));
    document.curves.insert(CurveId(1), Curve::new(through, true));
    document.curves.insert(CurveId(2), Curve::new(vec![PointId(9), PointId(10), PointId(11)], false));
    let triangles = vec![
        [0, 1, 10],
        [1, 9, 10],
        [1, 2, 9],
        [2, 3, 9],
        [3, 8, 9],
        [3, 4, 8],
        [4, 5, 8],
        [5, 9, 8],
        [5, 6, 9],
        [6, 7, 9],
        [7, 10, 9],
        [7, 0, 10],
    ];
    let curves = vec![
        Embedding { curve: CurveId(1), along: (0..8).collect() },
        Embedding { curve: CurveId(2), along: vec![8, 9, 10] },
    ];
    let vertices = (1..=11).map(|id| SkeletonVertex::Control(PointId(id))).collect();
    document.surfaces.insert(SurfaceId(1), Surface::new(Skeleton { vertices, triangles, curves }));
    document
}

/// Leads some control points out and home again, in directions of its own for each seed. The document is as before; the
/// triangulation, edited on the way, is not.
fn scramble(bench: &mut Bench, seed: u32, reach: f64) {
    let points: Vec<_> = bench.document().points.into_iter().collect();
    for (place, (point, home)) in
        points.iter().enumerate().filter(|(place, _)| place % 3 == seed as usize % 3)
    {
        let angle = 2.4 * (f64::from(seed) + 3.0 * place as f64);
        let (sin, cos) = libm::sincos(angle);
        let out = dvec3(cos, sin, libm::sin(0.7 * angle)) * reach;
        bench.accept(Request::Grab(GrabTarget::Point(*point)));
        for step in (1..=16).chain((0..16).rev()) {
            bench.step(Some(*home + out * (f64::from(step) / 16.0)));
            bench.step(Some(*home + out * (f64::from(step) / 16.0)));
        }
        bench.accept(Request::Drop);
        bench.edit(Edit::Move { point: *point, to: *home });
    }
}

/// Solves a document at h, h/2 and h/4, and at h/2 on three scrambled triangulations.
fn is_independent_of_scrambling(name: &str, document: &Document, coarse: f64, most: f64) {
    let fine = solve(document, 0.25 * coarse);
    let size = fine.positions.iter().map(|p| p.length()).fold(0.0, f64::max);
    let measure = |shape: &Solved, what: &str| {
        let (worst, mean) = deviation(shape, &fine);
        println!(
            "{name}, {what}: {} nodes, worst {:.4} %, rms {:.4} % of the size",
            shape.positions.len(),
            100.0 * worst / size,
            100.0 * mean / size
        );
        (worst, mean)
    };
    let (_, first) = measure(&solve(document, coarse), "h");
    let mut bench = opened(document, 0.5 * coarse);
    let half = solved(&mut bench);
    let (worst, second) = measure(&half, "h/2");
    assert!(worst < most * size, "{name}: {worst}");
    assert!(first > 2.0 * second, "{name}: {first} {second}");
    for seed in 0..3 {
        scramble(&mut bench, seed, 0.2);
        let scrambled = solved(&mut bench);
        assert_ne!(scrambled.triangles, half.triangles, "{name}: nothing was scrambled");
        let (worst, mean) = measure(&scrambled, "h/2, scrambled");
        assert!(worst < most * size, "{name}: {worst}");
        assert!(first > 2.0 * mean, "{name}: {first} {mean}");
        let energy = (scrambled.energy / half.energy - 1.0).abs();
        assert!(energy < 5e-3, "{name}: energy off by {energy}");
    }
}

#[test]
fn a_torus_of_three_curves_is_the_same_on_any_mesh() {
    is_independent_of_scrambling("torus", &torus(), 0.5, 0.008);
}

#[test]
fn a_saddle_with_a_curve_inside_is_the_same_on_any_mesh() {
    is_independent_of_scrambling("ridged saddle", &ridged_saddle(), 0.16, 0.008);
}
