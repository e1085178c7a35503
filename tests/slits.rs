//! A flat disc that is cut along a line stays flat, wherever the line crosses another curve: whatever the cut left of the
//! triangles beside it, what comes to rest has no fold. Two of these came to rest folded and make way for what their document opens to.

use acceptance::Bench;
use ductile_mesh::summary;
use ductile_spec::{Border, CurveId, Edit, SurfaceId, Through};
use glam::{DVec3, dvec3};

fn ring(radius: f64, count: u32) -> Vec<DVec3> {
    let turn = |k: u32| std::f64::consts::TAU * f64::from(k) / f64::from(count);
    (0..count).map(|k| dvec3(radius * libm::cos(turn(k)), radius * libm::sin(turn(k)), 0.0)).collect()
}

/// A disc of radius 1 with a closed curve inside, cut along an open one that crosses it; at rest.
fn cut(inner: Vec<DVec3>, line: [DVec3; 3]) -> (Bench, f64) {
    let mut bench = Bench::new();
    let through = ring(1.0, 4).into_iter().map(Through::Place).collect();
    bench.edit(Edit::Curve { through, closed: true });
    bench.edit(Edit::Sheet { boundary: CurveId(1) });
    bench.edit(Edit::SLoop { surface: SurfaceId(1), along: inner, closed: true });
    bench.edit(Edit::SLoop { surface: SurfaceId(1), along: line.to_vec(), closed: false });
    bench.edit(Edit::Split { border: Border::Curve(CurveId(3)) });
    let energy = bench.rest(600);
    (bench, energy)
}

#[test]
fn a_flat_disc_with_a_slit_rests_flat() {
    // Across the curve inside, near its control points and far from them.
    let lines = [
        [(0.1, 0.0), (0.3, 0.05), (0.7, 0.0)],
        [(0.1, 0.1), (0.3, 0.35), (0.6, 0.5)],
        [(0.0, -0.2), (0.1, -0.4), (0.1, -0.8)],
        [(-0.3, 0.1), (0.0, 0.2), (0.1, 0.75)],
        [(0.1, 0.0), (0.385_956, 0.119_390), (0.7, 0.3)],
        // Twice, and far from the samples that the curve inside has.
        [(-0.7, 0.03), (0.0, 0.1), (0.7, 0.03)],
    ];
    for line in lines {
        let (bench, energy) = cut(ring(0.4, 4), line.map(|(x, y)| dvec3(x, y, 0.0)));
        let shape = &bench.modeler.model().surfaces[&SurfaceId(1)];
        let height = shape.mesh.vertices().map(|v| shape.positions[v.index()].z.abs()).fold(0.0, f64::max);
        println!("{line:?}: energy {energy:e}, height {height:e}");
        assert!(energy < 1e-9 && height < 1e-6, "{line:?}: energy {energy}, height {height}");
        let kind = summary(&shape.mesh);
        assert_eq!((kind.components, kind.boundaries, kind.euler), (1, 2, 0), "{line:?}");
    }
}
